//! Models: faces, solids, instances. Plain `f64` data, valid by construction.
//!
//! ```text
//!   Model ── parts: [Part]            one rigid body of faces in its own coordinates
//!         │            ├─ faces: [Face]
//!         │            │       ├─ surface: Surface      rational B-spline over (u, v)
//!         │            │       └─ loops:   [TrimLoop]   closed chains of rational Bézier curves in (u, v)
//!         │            │       │              └─ edges      the edge of the source of each curve
//!         │            ├─ meshes: [Mesh]                facets of the source
//!         │            └─ stated_edges                  numbers of the source's edges; Part::edges finds them
//!         ├─ solids: [Solid]          Boolean: primitives and an expression over them
//!         └─ instances: [Instance]    part index, transform to model space, colour
//! ```
//!
//! A point of a face's domain belongs to the face when the winding number of its loops around the point is not zero; a
//! face without loops is its whole surface. Outer loops run counter-clockwise in `(u, v)`, holes clockwise: the
//! importers orient them, so parity and winding agree.
//!
//! Lengths are millimetres where the source file has a unit, else the file's own numbers.
//!
//! A plate of 2 by 1 with a square hole:
//!
//! ```
//! use selvedge_geometry::glam::{DAffine3, DVec2, DVec3, DVec4};
//! use selvedge_geometry::model::{Face, Instance, Model, Part, SurfaceKind, TrimLoop};
//! use selvedge_geometry::spline::{Bezier, Surface};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let net = [[0.0, 0.0], [2.0, 0.0], [0.0, 1.0], [2.0, 1.0]].map(|[x, y]| DVec4::new(x, y, 0.0, 1.0));
//! let knots = vec![0.0, 0.0, 1.0, 1.0];
//! let surface = Surface::new((1, 1), knots.clone(), knots, net.to_vec())?; // x = 2 u, y = v
//! let polygon = |corners: [[f64; 2]; 4]| {
//!     let side = |i: usize| Bezier::<DVec3>::line(corners[i].into(), corners[(i + 1) % 4].into());
//!     TrimLoop::new((0..4).map(side).collect(), DVec2::ZERO)
//! };
//! let border = polygon([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])?;
//! let hole = polygon([[0.25, 0.25], [0.25, 0.75], [0.75, 0.75], [0.75, 0.25]])?;
//! assert!(border.signed_area() > 0.0 && hole.signed_area() < 0.0);
//! let loops = vec![border, hole];
//! let face = Face { id: 1, kind: SurfaceKind::Plane, surface, loops, same_sense: true, colour: None };
//! let part = Part { faces: vec![face], ..Part::default() };
//! let placed = Instance { part: 0, transform: DAffine3::IDENTITY, colour: None, name: String::new() };
//! let model = Model { parts: vec![part], instances: vec![placed], ..Model::default() };
//! model.check()?;
//! # Ok(())
//! # }
//! ```

mod camera;
mod check;
mod curvature;
mod edge;
mod face;
mod images;
mod items;
mod mesh;
mod section;
mod solid;
pub mod srgb;
#[cfg(feature = "serde")]
mod stored;
mod xray;

pub use camera::{Camera, CameraError, Projection};
pub use check::{Coloured, ModelError};
pub use edge::{Edge, EdgeCounts, EdgeKind, EdgeLimits, EdgeRef, EdgeSource, EdgeUse, Edges, MeshEdge, SmoothSide};
pub use face::{Face, FaceError, LoopAt, SurfaceKind, TrimLoop};
pub use images::Images;
pub use items::Items;
pub use mesh::{Mesh, MeshError};
pub(crate) use solid::{Boxes, meet};
pub use solid::{
    CarriedFace, Carrier, Isolated, Primitive, Quadric, Shape, ShapeError, Solid, SolidError, Surface as SolidSurface,
    SurfaceTable, oriented_outwards,
};
pub use xray::UnknownName;

use glam::{DAffine3, DVec3};

/// Red, green, blue, opacity in linear light, each in `[0, 1]`.
pub type Colour = [f32; 4];

/// Colour of faces without a colour in the source.
pub const GREY: Colour = [0.262, 0.262, 0.262, 1.0];

/// The content of a file or scene.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "stored::ModelData"))]
pub struct Model {
    /// The file's or product's name.
    pub name: String,
    /// Distinct bodies.
    pub parts: Vec<Part>,
    /// Placed bodies; a part without an instance is not drawn.
    pub instances: Vec<Instance>,
    /// Boolean solids, in model coordinates. The opaque ones are drawn as their union, each transparent one by itself:
    /// [`Model::items`].
    pub solids: Vec<Solid>,
    /// The volume within which faces and meshes are drawn: see [`Model::trim_by`]. `None`: everywhere.
    pub trim: Option<Solid>,
    /// Length unit of the source, for the record; coordinates are already millimetres.
    pub unit: String,
    /// Faces of Boolean solids that are nearer to each other than this share of the solids' diagonal are one face, as
    /// [`Model::coincidence`] says; `None`: [`SurfaceTable::ROUNDED`].
    pub coincident: Option<f64>,
    /// Numbers of the primitives whose faces are cuts: those that [`Model::section`] made. Not stored.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub cuts: Vec<u32>,
}

/// One body: a closed solid, or an open shell.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Part {
    /// Name in the source, or empty.
    pub name: String,
    /// Its faces.
    pub faces: Vec<Face>,
    /// Its facets, where the source has no exact faces.
    pub meshes: Vec<Mesh>,
    /// The faces (or the meshes) bound a volume and their normals point out of it.
    pub closed: bool,
    /// Edges that the source states and that faces may share, indexed by [`EdgeRef::edge`]: the place of each in the
    /// source, `None` where it has no number there. Empty where the source states no shared edges.
    pub stated_edges: Vec<Option<EdgeSource>>,
}

/// A part placed in the model.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Instance {
    /// Index into [`Model::parts`].
    pub part: usize,
    /// Part coordinates to model coordinates: finite, not flat, with factors of lengths from 1e-30 to 1e30.
    pub transform: DAffine3,
    /// Overrides the colours of the faces.
    pub colour: Option<Colour>,
    /// Name of the occurrence, or empty.
    pub name: String,
}

/// An axis-aligned box; empty when `min > max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub min: DVec3,
    /// Largest coordinates.
    pub max: DVec3,
}

impl Bounds {
    /// The empty box.
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
    /// All of space.
    pub const ALL: Self = Self { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };

    /// Grown to hold `p`.
    pub fn with(self, p: DVec3) -> Self {
        Self { min: self.min.min(p), max: self.max.max(p) }
    }

    /// Grown to hold `other`.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Holds nothing.
    pub fn is_empty(self) -> bool {
        !(self.min.cmple(self.max)).all()
    }

    /// Middle of the box.
    pub fn centre(self) -> DVec3 {
        (self.min + self.max) * 0.5
    }

    /// Length of the diagonal; 0 when empty.
    pub fn diagonal(self) -> f64 {
        if self.is_empty() { 0.0 } else { (self.max - self.min).length() }
    }

    /// The eight corners.
    pub fn corners(self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, lo: f64, hi: f64| if i >> bit & 1 == 0 { lo } else { hi };
            DVec3::new(
                pick(0, self.min.x, self.max.x),
                pick(1, self.min.y, self.max.y),
                pick(2, self.min.z, self.max.z),
            )
        })
    }
}

impl Part {
    /// Box of the control points of its faces (see [`Face::control_bounds`]) and of its meshes, part coordinates: it
    /// contains the part, and costs little.
    pub fn control_bounds(&self) -> Bounds {
        let faces = self.faces.iter().map(Face::control_bounds);
        faces.chain(self.meshes.iter().map(Mesh::bounds)).fold(Bounds::EMPTY, Bounds::union)
    }
}

impl Model {
    /// Largest share of their diagonal by which faces of Boolean solids may be apart and yet be one face, as in
    /// [`SurfaceTable::new`]: [`coincident`](Self::coincident), between [`SurfaceTable::FINEST`] and
    /// [`SurfaceTable::COARSEST`]; [`SurfaceTable::ROUNDED`] by default.
    pub fn coincidence(&self) -> f64 {
        let said = self.coincident.filter(|share| !share.is_nan());
        said.map_or(SurfaceTable::ROUNDED, |share| share.clamp(SurfaceTable::FINEST, SurfaceTable::COARSEST))
    }

    /// Instances with their parts. Instances of parts that do not exist are left out; [`Model::check`] names them.
    pub fn placed_parts(&self) -> impl Iterator<Item = (&Instance, &Part)> {
        self.instances.iter().filter_map(|instance| Some((instance, self.parts.get(instance.part)?)))
    }

    /// Distinct faces.
    pub fn face_count(&self) -> usize {
        self.parts.iter().map(|p| p.faces.len()).sum()
    }

    /// Placed faces: each instance counts its part's faces.
    pub fn face_instance_count(&self) -> usize {
        self.placed_parts().map(|(_, part)| part.faces.len()).sum()
    }
}
