//! From a CAD file to pictures in memory: the common part of the program, the C library and the Python package.
//!
//! ```text
//!   path, bytes ──read──▶ Loaded { model, warnings, … } ──┐
//!                         directions, views ──▶ Camera ───┼─▶ Job ──Worker, a thread with a device──▶ Picture
//!                         outputs, backdrop ──────────────┘                     images ─▶ arrays, PNG
//! ```
//!
//! A [`Worker`] draws the pictures of its jobs in order, and pictures of one model with frames in flight. Its caller
//! may wait for each, and read the next file meanwhile. A flag ends an import where it reports progress, and an upload
//! between two faces; so do [`Limits`] of time and memory.
#![warn(missing_docs)]
#![forbid(unsafe_code)]

mod ambient;
mod backdrop;
mod camera;
mod directions;
mod drawer;
mod error;
mod images;
mod legend;
mod limits;
mod lines;
mod png;
mod read;
mod smooth;
mod snap;
mod tree;
mod verdict;
mod worker;

pub use ambient::Ambient;
pub use backdrop::{Backdrop, colour};
pub use camera::{CameraFile, Lens, Pinhole, Viewpoint, bounds, fitted, whole};
pub use directions::{Direction, Directions, NAMED};
pub use drawer::{DeviceOptions, Drawer, Drawn, Job, MOST_IN_FLIGHT};
pub use error::{JobError, Stop, guarded};
pub use images::{Image, Values};
pub use legend::legend;
pub use limits::{Bound, Exceeded, Limits, Step, Work, resident};
pub use lines::lines;
pub use png::{save as save_png, write as write_png};
pub use read::{Loaded, ReadOptions, Source, import_within, memory, read};
pub use smooth::smooth;
pub use snap::{SNAP_KINDS, Snapped, Snapper};
pub use tree::{Body, Node};
pub use verdict::{Verdict, worst_shift_px, wrong};
pub use worker::{Ticket, Worker};
