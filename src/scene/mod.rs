//! A model as GPU data: Bézier patches, trim curves, instances.
//!
//! ```text
//!   Model (f64, any size, any distance from the origin)
//!     │  face: knots inserted ──▶ Patch + points (f32, relative to the part's centre)
//!     │        loops          ──▶ Side of each patch; Curve + curve_points; Cell per patch and strip
//!     │  mesh: positions (f32, relative to the part's centre), indices, packed normals
//!     │  part: shared by its instances; sides at which its faces without trims meet ──▶ Link
//!     ▼
//!   SceneData (plain arrays)  ──upload──▶  Scene (persistent pool)
//! ```
//!
//! Single precision suffices because coordinates are small where they are seen: control points are relative to the
//! centre of their part, and the transform from there to the eye is composed in `f64` every frame. Patches with very
//! short sides have a fine net in addition (`fine.rs`).

mod after_upload;
mod arrays;
mod cells;
mod cones;
mod corners;
mod data;
mod deep_zoom;
mod edges;
mod edit;
mod exact;
mod face;
mod fine;
mod flatten;
mod fold_seeds;
mod in_sight;
mod instance;
mod join;
mod link;
mod mesh;
mod mixed;
mod neighbours;
mod operand_edges;
mod parts;
mod picking;
mod request;
mod sides;
mod solids;
mod sub_patches;
mod sun;
mod trimmed;
mod upload;
mod view;
mod view_cell;
mod way;
mod whole_view;

pub(crate) use arrays::Array;
pub(crate) use data::{Division, SceneData};
pub(crate) use deep_zoom::{Cut, DeepZoom, DeepZoomUpload};
pub(crate) use edges::EdgeData;
pub use edges::UndrawnEdges;
pub use edit::EditError;
pub(crate) use edit::{EditTarget, Write};
#[cfg(test)]
pub(crate) use exact::ExactData;
#[cfg(any(test, feature = "baselines"))]
pub(crate) use flatten::{Cuts, flattened};
pub(crate) use in_sight::{InSight, Reach};
pub use instance::InstanceError;
pub(crate) use instance::Shown;
pub(crate) use join::{FirstNumbers, Joinable};
pub(crate) use parts::Told;
pub use picking::Hit;
pub(crate) use picking::{Picked, Picking};
pub(crate) use request::SceneRequest;
pub use solids::UndrawnSolid;
pub(crate) use solids::{Asked, Blister, SolidData};
pub(crate) use trimmed::TableView;
#[cfg(feature = "baselines")]
pub(crate) use upload::BaselineScene;
#[cfg(feature = "baselines")]
pub(crate) use upload::TableScene;
pub(crate) use upload::{BoundaryOperands, EdgeBuffers, ExactScene, MeshBuffers, Scene, Solids, SunTiles};
pub use view::seen_by;
#[cfg(any(test, feature = "baselines"))]
pub(crate) use view::view;
pub(crate) use view::{focal_and_slant, half_slopes};
pub use way::trim_way;
