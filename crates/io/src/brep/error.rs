//! Why a face could not be built.

use crate::model::FaceError;
use crate::spline::SplineError;

/// Why a face could not be built. Numbers are those of the source; lengths are millimetres.
#[allow(missing_docs)] // the messages say what each field is
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// A radius that is not positive, a zero direction, a profile that cannot be used.
    #[error("surface of face #{face}: {reason}")]
    Surface { face: u32, reason: &'static str },
    /// A curve with impossible numbers, or one that cannot carry its edge.
    #[error("curve of edge #{edge}: {reason}")]
    Curve { edge: u32, reason: &'static str },
    /// A loop names an edge that is not in the list.
    #[error("face #{face} names edge number {index}, which does not exist")]
    EdgeIndex { face: u32, index: usize },
    /// A loop whose edges all have zero length.
    #[error("face #{face} has a loop without any length")]
    EmptyLoop { face: u32 },
    /// An edge does not begin where the one before it ends.
    #[error("face #{face}: edge #{edge} begins {gap:e} mm from the end of the edge before it")]
    OpenLoop { face: u32, edge: u32, gap: f64 },
    /// A face without loops on a surface that has no end.
    #[error("face #{face} has no loop and its surface is not closed")]
    Unbounded { face: u32 },
    /// A loop runs around a closed surface, and no other loop closes the other side.
    #[error("face #{face}: a loop runs around the surface and no other loop or pole closes it")]
    OpenRim { face: u32 },
    /// A loop that runs more than once around, or around both ways.
    #[error("face #{face}: a loop runs {u} times around in u and {v} times in v")]
    Winding { face: u32, u: i32, v: i32 },
    /// Loops that cross one another on the line where the surface is cut open.
    #[error("face #{face}: its loops cross one another")]
    Tangled { face: u32 },
    /// The loops enclose nothing.
    #[error("face #{face}: a loop encloses no area")]
    NoArea { face: u32 },
    /// The finished trim loop is invalid.
    #[error("face #{face}: {source}")]
    Loop { face: u32, source: FaceError },
    /// The finished carrier surface is invalid.
    #[error("carrier of face #{face}: {source}")]
    Carrier { face: u32, source: SplineError },
}
