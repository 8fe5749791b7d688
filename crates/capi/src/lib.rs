//! The C library: files to models, models to images in memory.
//!
//! ```text
//!   selvedge_open ──▶ SelvedgeModel ────┐
//!   selvedge_renderer_new ──▶ SelvedgeRenderer ──selvedge_render──▶ SelvedgePicture ──▶ SelvedgeImage: pointer, size, kind
//!   selvedge_host_new on the host's device ──▶ SelvedgeHost ──selvedge_host_record──▶ the host's command buffer
//! ```
//!
//! Every call that may fail returns a `SelvedgeStatus`; `selvedge_last_error` has the sentence. No panic crosses the
//! border. Every struct begins with its size as the caller knows it, so that a program built against an older header
//! runs with a newer library: fields that it does not know have their defaults. `include/selvedge.h` is made from these
//! files by cbindgen.
#![warn(missing_docs)]

mod border;
mod host;
mod model;
mod picture;
mod renderer;
mod scene;
mod snap;
