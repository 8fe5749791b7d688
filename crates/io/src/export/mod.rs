//! [`Model`](crate::model::Model)s out, as CAD files.
//!
//! ```text
//!   model ──Part::edges─▶ edges that two faces share ──step──▶ ISO 10303-21 text
//!   solid ──operand────▶ primitives as placed ───────┤
//!         ──expression─▶ unions, intersections, differences
//! ```
//!
//! Faces keep their exact rational surfaces, and so do the faces of a solid that is one primitive; a Boolean solid stays
//! an expression over exact primitives. Anything that the format cannot express is left out, and an [`ExportWarning`]
//! names it.

mod expression;
mod operand;
mod step;

pub use step::step;

use crate::model::{Face, Part};
use glam::DAffine3;
use std::fmt;

/// A part or a solid of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Item {
    /// Index into [`Model::parts`](crate::model::Model::parts).
    Part(usize),
    /// Index into [`Model::solids`](crate::model::Model::solids).
    Solid(usize),
}

impl fmt::Display for Item {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Part(i) => write!(f, "part {i}"),
            Self::Solid(i) => write!(f, "solid {i}"),
        }
    }
}

/// Something of a model that is not in the file as it was in the model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExportWarning {
    /// The part or solid.
    pub item: Item,
    /// What was wrong and what was done.
    pub message: String,
}

/// Why no file was written, or not all of it.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // the messages say what each field is
#[non_exhaustive]
pub enum ExportError {
    /// The operating system refused.
    #[error("{0}")]
    Write(#[from] std::io::Error),
    /// An instance names a part that does not exist.
    #[error("instance {instance} names part {part} of {parts}")]
    Part { instance: usize, part: usize, parts: usize },
    /// An instance's transform is not finite.
    #[error("instance {instance} has a transform that is not finite or has no inverse")]
    Transform { instance: usize },
    /// A loop that cannot be a curve.
    #[error("{item}, face #{face}: {source}")]
    Face { item: Item, face: u32, source: crate::spline::SplineError },
}

/// The faces of a part with a transform carried out; its meshes are left behind.
fn baked(part: &Part, transform: &DAffine3) -> Part {
    let mirrored = transform.matrix3.determinant() < 0.0;
    let face = |f: &Face| Face {
        surface: f.surface.transformed(transform),
        same_sense: f.same_sense != mirrored,
        ..f.clone()
    };
    Part { faces: part.faces.iter().map(face).collect(), meshes: Vec::new(), ..part.clone() }
}
