//! The errors of constructions, each with the name of its construction.

use crate::math::banded::Singular;
use crate::model::FaceError;
use crate::spline::SplineError;

/// Why nothing was built. Distances are in model units, parameters those of the curve that is named.
#[allow(missing_docs)] // the messages say what each field is
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConstructError {
    /// A NaN or an infinity.
    #[error("{what} is not a finite number")]
    NotFinite { what: &'static str },
    /// A number outside its range.
    #[error("{what} is {value}, but must be {must}")]
    Range { what: &'static str, value: f64, must: &'static str },
    /// Fewer points (curves, sections) than the construction needs.
    #[error("{got} {what}, but at least {needed} are needed")]
    TooFew { what: &'static str, got: usize, needed: usize },
    /// More than the engine is prepared to hold.
    #[error("{got} {what}, but at most {most} are taken")]
    TooMany { what: &'static str, got: usize, most: usize },
    /// Lists that belong together differ in length.
    #[error("{got} {what}, but {needed} are needed")]
    Count { what: &'static str, got: usize, needed: usize },
    /// Parameters that do not increase.
    #[error("{what} {index} is not larger than the one before it")]
    Order { what: &'static str, index: usize },
    /// Two neighbours are one point.
    #[error("points {first} and {second} coincide")]
    CoincidentPoints { first: usize, second: usize },
    /// Two neighbouring sections are one curve.
    #[error("sections {first} and {second} coincide")]
    CoincidentSections { first: usize, second: usize },
    /// A path, direction, axis or curve without length.
    #[error("{what} has no length")]
    ZeroLength { what: &'static str },
    /// A closed curve, or several, with nothing inside.
    #[error("{what} encloses no area")]
    NoArea { what: &'static str },
    /// Something that must be closed is not.
    #[error("{what} is open by {gap:e}")]
    Open { what: &'static str, gap: f64 },
    /// Something that must lie in a plane does not.
    #[error("{what} is {gap:e} out of its plane")]
    NotPlanar { what: &'static str, gap: f64 },
    /// A curve that meets itself.
    #[error("{what} crosses itself at parameters {first} and {second}")]
    SelfCrossing { what: &'static str, first: f64, second: f64 },
    /// A tangent or normal that jumps.
    #[error("{what} has a corner at {parameter}")]
    Corner { what: &'static str, parameter: f64 },
    /// A derivative that vanishes where a direction is needed.
    #[error("{what} stands still at {parameter}")]
    Cusp { what: &'static str, parameter: f64 },
    /// A lathe's profile on both sides of the axis.
    #[error("the profile crosses the axis at {parameter}")]
    CrossesAxis { parameter: f64 },
    /// A lathe's profile on the axis alone.
    #[error("the profile lies on the axis")]
    OnAxis,
    /// Boundary curves that do not meet in a corner.
    #[error("boundary curves are {gap:e} apart at corner {corner} (0 to 3: u0v0, u1v0, u0v1, u1v1)")]
    CornerMismatch { corner: usize, gap: f64 },
    /// Curves of a network that do not meet where they should.
    #[error("curve {u_curve} along u and curve {v_curve} along v are {gap:e} apart where they should meet")]
    NetworkMismatch { u_curve: usize, v_curve: usize, gap: f64 },
    /// Rational curves whose weights do not blend into positive weights.
    #[error("the weights of the curves do not blend: {what}")]
    Weights { what: &'static str },
    /// A surface that would fold over itself.
    #[error("the surface folds at {parameter}: it reaches {reach:e} towards a centre of curvature {radius:e} away")]
    Folds { parameter: f64, reach: f64, radius: f64 },
    /// The same, at a point of a surface.
    #[error("the surface folds at ({u}, {v}): it reaches {reach:e} towards a centre of curvature {radius:e} away")]
    FoldsAt { u: f64, v: f64, reach: f64, radius: f64 },
    /// A line that does not meet the surface, or touches it only.
    #[error("{what} misses the surface, or reaches its border or outline, at {parameter}")]
    Misses { what: &'static str, parameter: f64 },
    /// A tolerance that the largest allowed number of pieces does not reach.
    #[error("a deviation of {asked:e} was asked for and {reached:e} reached with {pieces} pieces")]
    Bound { asked: f64, reached: f64, pieces: usize },
    /// A surface without a finite value.
    #[error("the surface has no finite value at (u, v) = ({u}, {v})")]
    NotFiniteAt { u: f64, v: f64 },
    /// A surface whose tangents span no plane, nor do they in a limit.
    #[error("the surface has no normal at (u, v) = ({u}, {v})")]
    NoNormal { u: f64, v: f64 },
    /// A point of a grid that is a NaN or an infinity.
    #[error("the point in row {row}, column {column} of the grid (from 0) is not finite")]
    PointNotFinite { row: usize, column: usize },
    /// An expression that cannot be read.
    #[error("{expression}, column {column}: {message}")]
    Expression { expression: &'static str, column: usize, message: String },
    /// A table or a picture that holds no grid; `source_name` says where.
    #[error("{source_name}: {message}")]
    Data { source_name: String, message: String },
    /// A vertex of a control mesh.
    #[error("vertex {vertex} of the mesh (from 0) {what}")]
    Vertex { vertex: usize, what: &'static str },
    /// An edge of a control mesh.
    #[error("the edge between vertices {first} and {second} of the mesh (from 0) {what}")]
    Edge { first: u32, second: u32, what: &'static str },
    /// A face of a control mesh.
    #[error("face {face} of the mesh (from 0) {what}")]
    Polygon { face: usize, what: &'static str },
    /// Parameters so uneven that rounding leaves no solution.
    #[error(transparent)]
    System(#[from] Singular),
    /// The numbers do not make a spline.
    #[error(transparent)]
    Spline(#[from] SplineError),
    /// The curves do not make a trim loop.
    #[error(transparent)]
    Face(#[from] FaceError),
}
