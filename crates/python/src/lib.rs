//! The native half of the Python package: files to models, models to NumPy arrays.
//!
//! ```text
//!   selvedge/__init__.py   signatures, `open`, shapes of other kernels, jobs in flight, files with a manifest
//!     └ _native            this: Model, Face, Edge, Camera, Renderer, Picture, Limits
//!         └ selvedge-jobs
//! ```
//!
//! Work that takes time runs in threads of its own. The caller's thread waits without the interpreter's lock and looks
//! after signals, so that Ctrl-C ends it.

mod camera;
mod error;
mod model;
mod picture;
mod renderer;
mod shape;
mod waiting;

/// What `import selvedge` builds on; not meant to be imported by itself.
#[pyo3::pymodule]
mod _native {
    #[pymodule_export]
    use super::camera::Camera;
    #[pymodule_export]
    use super::model::{Instance, Model, Part, Warning, open};
    #[pymodule_export]
    use super::picture::Picture;
    #[pymodule_export]
    use super::renderer::{Limits, Pending, Renderer, check, validate};
    #[pymodule_export]
    use super::shape::{Edge, Face};
}
