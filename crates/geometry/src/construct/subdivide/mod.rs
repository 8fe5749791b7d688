//! Subdivision surfaces: a control mesh to faces, exact where the mesh is regular, else within a measured bound.
//!
//! ```text
//!   ┌───┬───┬───┐     regular: its polynomial patch      near an irregular vertex: rings of exact patches,
//!   │   │   │   │                                        each half as wide as the one before, and a cap
//!   ├───┼───┼───┤                                        ┌───────┬───┐
//!   │   │ r │   │     r: one bicubic patch               │       │   │   after k rings the cap is 2^-k wide;
//!   ├───┼───┼───┤                                        ├───┬───┤   │   it goes through the limit point,
//!   │   │   │   │                                        │cap├───┼───┤   tangent to the limit plane
//!   └───┴───┴───┘                                        └───┴───┴───┘
//! ```
//!
//! | scheme | mesh | a regular face becomes | of an irregular one |
//! |---|---|---|---|
//! | Catmull-Clark | any polygons | one bicubic face | one bicubic face of several patches |
//! | Loop | triangles | one biquartic face, collapsed at a corner | four faces and three more a ring |
//!
//! Meshes whose irregular vertices share faces, and meshes with polygons, are first refined by one or two steps of the
//! scheme, which does not change the surface.
//!
//! **The bound.** A cap is compared with the exact rings within it, control point by control point, down to a remainder
//! of a thousandth of the largest distance so far; the control points around the remainder bound it. So
//! [`Subdivided::deviation`] bounds the distance between cap and limit surface at equal parameters; all else is exact
//! to rounding.
//!
//! **Sharing.** Faces that meet along a side have the same control points there, bit for bit. Where one of them is
//! cut finer, its control points are those of de Casteljau's algorithm at the other one's.
//!
//! **Borders and creases.** A border becomes the uniform cubic B-spline of its vertices; a border's vertex with one
//! face is a corner and stays. A crease is a border of both sides; three of them, or one at a border, make a corner.

mod caps;
mod limit;
mod mesh;
mod quads;
mod quartic;
mod triangles;

pub use limit::Limit;
pub use mesh::ControlMesh;

use super::ConstructError;
use crate::model::{Bounds, Part, SurfaceKind};
use mesh::Topology;

/// Share of a cap's deviation below which the remainder near the vertex is not refined.
const NEGLIGIBLE: f64 = 1e-3;

/// How a control mesh is made smooth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheme {
    /// Bicubic, for any polygons.
    CatmullClark,
    /// Quartic, for triangles.
    Loop,
}

/// A subdivision surface as faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Subdivided {
    /// Closed when the mesh has no border.
    pub part: Part,
    /// Bound on the distance of the faces from the limit surface, in model units.
    pub deviation: f64,
    /// Vertices around which faces are not exact, after the steps.
    pub irregular: usize,
    /// Most rings around one of them.
    pub rings: usize,
    /// Steps of the scheme that parted irregular vertices.
    pub steps: usize,
}

/// The bound of a scheme's surfaces.
#[derive(Clone, Copy, Debug, Default)]
struct Bound {
    deviation: f64,
    irregular: usize,
    rings: usize,
    steps: usize,
}

impl Bound {
    fn add(&mut self, deviation: f64, rings: usize) {
        self.deviation = self.deviation.max(deviation);
        self.rings = self.rings.max(rings);
        self.irregular += 1;
    }
}

/// The surface of `mesh` under `scheme`, within `tolerance` of the limit surface.
///
/// Cost: linear in the faces; near irregular vertices some 100 µs each. A Catmull-Clark face there has
/// `(rings + 1)²` patches.
///
/// # Errors
/// * A mesh that is no manifold: an edge of three faces, faces that turn against each other, faces that meet in a
///   vertex alone.
/// * A vertex that is not finite, or an index without a vertex.
/// * A polygon of fewer than three corners; for Loop's scheme, of more.
/// * A crease along no edge, or one that ends inside.
/// * A tolerance that is not positive, or that 32 rings do not reach.
pub fn subdivide(mesh: &ControlMesh, scheme: Scheme, tolerance: f64) -> Result<Subdivided, ConstructError> {
    if tolerance.is_nan() || tolerance <= 0.0 {
        return Err(ConstructError::Range { what: "the tolerance", value: tolerance, must: "positive" });
    }
    let (topology, closed) = Topology::new(mesh)?;
    let size = mesh.positions.iter().copied().fold(Bounds::EMPTY, Bounds::with).diagonal();
    if size == 0.0 {
        return Err(ConstructError::ZeroLength { what: "the control mesh" });
    }
    let (surfaces, bound) = match scheme {
        Scheme::CatmullClark => quads::surfaces(topology, tolerance)?,
        Scheme::Loop => triangles::surfaces(topology, tolerance)?,
    };
    let mut part = Part { closed, ..Part::default() };
    for surface in surfaces {
        part.add(SurfaceKind::BSpline, surface, Vec::new(), true);
    }
    let Bound { deviation, irregular, rings, steps } = bound;
    Ok(Subdivided { part, deviation, irregular, rings, steps })
}

/// The limit of each vertex of a mesh, in closed form; `None` for one that no face uses. For a crease's vertices, the
/// limit of its first side.
///
/// # Errors
/// As [`subdivide`]; polygons other than quadrilaterals (other than triangles, for Loop's scheme), for which there is
/// no such form.
pub fn limits(mesh: &ControlMesh, scheme: Scheme) -> Result<Vec<Option<Limit>>, ConstructError> {
    let (topology, _) = Topology::new(mesh)?;
    let (corners, what) = match scheme {
        Scheme::CatmullClark => (4, "is no quadrilateral, which the closed form needs"),
        Scheme::Loop => (3, "is no triangle, which Loop's scheme needs"),
    };
    if let Some(face) = mesh.faces.iter().position(|f| f.len() != corners) {
        return Err(ConstructError::Polygon { face, what });
    }
    let limit = |v: usize| topology.used(v).then(|| Limit::of(scheme, &topology, &topology.fan(v)));
    Ok((0..mesh.positions.len()).map(limit).collect())
}
