//! Edges, where the faces of a part meet or end, and vertices, where edges meet.
//!
//! ```text
//!            ●───────── curve in space ────────●        Edge: a chain of rational Bézier pieces
//!     face A │  loop 0, curves 2 to 3, forward  │        EdgeUse: one a face (a seam: two of one face)
//!     ───────●──────────────────────────────────●──
//!     face B │  loop 1, curves 5 to 7.25, back  │        kind: sharp, smooth, seam, border
//! ```
//!
//! A [`Part`](super::Part) stores only data on its edges that cannot be found again: which trim curves are pieces of
//! which edge of the source ([`TrimLoop::edges`](super::TrimLoop::edges)), and that edge's number there.
//! [`Part::edges`](super::Part::edges) finds the rest.

use crate::spline::{Bezier, Span};
use glam::{DVec3, DVec4};
use std::fmt;

/// Where an edge stands in its source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EdgeSource {
    /// STEP: the number of the `EDGE_CURVE`. IGES: the directory entry of the edge list (type 504).
    pub entity: u32,
    /// IGES: the place in the list, from 1.
    pub item: Option<u32>,
}

impl fmt::Display for EdgeSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.item {
            Some(item) => write!(f, "#{}, item {item}", self.entity),
            None => write!(f, "#{}", self.entity),
        }
    }
}

/// The edge of the source that a trim curve is a piece of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EdgeRef {
    /// In [`Part::stated_edges`](super::Part::stated_edges).
    pub edge: u32,
    /// The trim curve runs along the edge, not against it.
    pub forward: bool,
}

/// The kind of an edge, by the angle across it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum EdgeKind {
    /// Two or more faces meet at an angle somewhere along it; so does one face with itself.
    Sharp,
    /// Faces that meet without a visible angle.
    Smooth,
    /// A closed face meets itself without a visible angle.
    Seam,
    /// One face ends.
    Border,
}

/// One use of an edge by a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeUse {
    /// Index into the part's faces.
    pub face: usize,
    /// Index into the face's loops; `None`: the border of a face without loops, whose curves are the sides of the
    /// surface's domain, counter-clockwise from its smallest `(u, v)`.
    pub trim_loop: Option<usize>,
    /// From where to where the loop runs along the edge: whole part the index of a curve, fraction its parameter. The
    /// end is larger than the start; beyond the number of curves the loop begins again.
    pub range: (f64, f64),
    /// The loop runs along the edge's curve, not against it.
    pub forward: bool,
}

/// An edge of a part, part coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// The curve in space: pieces end to end, along the first use. Where that face is a plane or the edge a line of
    /// constant parameter it is exact, else fitted within [`Edge::deviation`] of the trimmed surface.
    pub curve: Vec<Span<Bezier<DVec4>>>,
    /// Indices into [`Edges::vertices`]; the same twice for a closed edge.
    pub ends: [usize; 2],
    /// The faces that end here. The curve is the first one's.
    pub uses: Vec<EdgeUse>,
    /// Where it stands in the source, if it does.
    pub source: Option<EdgeSource>,
    /// What it is to the eye.
    pub kind: EdgeKind,
    /// Largest angle, in radians, by which the surface turns across it: 0 where it continues, π where it folds back.
    /// NaN for borders.
    pub turn: f64,
    /// Largest distance found, in model units, between its uses, and by which fits and joins of the part may be off.
    pub deviation: f64,
}

/// A side of triangles where a surface made of facets creases or ends.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshEdge {
    /// Its ends, part coordinates.
    pub ends: [DVec3; 2],
    /// The triangles that have this side: index into the part's meshes, and of the triangle in its mesh.
    pub triangles: Vec<(usize, usize)>,
    /// [`EdgeKind::Sharp`] or [`EdgeKind::Border`].
    pub kind: EdgeKind,
}

/// A side of two triangles across which a mesh does not crease. It is an outline where one of them faces the eye and the
/// other does not: where both lie on one side of it in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothSide {
    /// Its ends, part coordinates.
    pub ends: [DVec3; 2],
    /// The third corners of both triangles.
    pub beside: [DVec3; 2],
}

/// Edges and vertices of a part.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Edges {
    /// Where edges begin and end.
    pub vertices: Vec<DVec3>,
    /// Where faces meet or end.
    pub edges: Vec<Edge>,
    /// Where facets crease or end.
    pub of_meshes: Vec<MeshEdge>,
    /// Points nearer to each other than this, in model units, are one. Pieces of loops within it are points and belong
    /// to no edge.
    pub reach: f64,
    /// The largest [`Edge::deviation`], in model units: between curves that are taken as one edge, which are loops that
    /// were joined or that the source shares, and curves fitted to them.
    pub deviation: f64,
    /// Faces with loops that lie within [`Edges::reach`] of a point and have no edge, and how many loops.
    pub lost: Vec<(usize, usize)>,
}

/// The angles from which an edge is sharp, and a side of triangles a crease.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeLimits {
    /// Radians: an edge across which the surface nowhere turns more is smooth.
    pub smooth: f64,
    /// Radians: a side across which facets turn more is a crease.
    pub crease: f64,
}

impl Default for EdgeLimits {
    /// 1 degree, and 20 degrees.
    fn default() -> Self {
        Self { smooth: 1.0_f64.to_radians(), crease: 20.0_f64.to_radians() }
    }
}

/// How many edges of each kind there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct EdgeCounts {
    /// [`EdgeKind::Sharp`]
    pub sharp: usize,
    /// [`EdgeKind::Smooth`]
    pub smooth: usize,
    /// [`EdgeKind::Seam`]
    pub seams: usize,
    /// [`EdgeKind::Border`]
    pub borders: usize,
    /// Vertices of edges.
    pub vertices: usize,
    /// Creases of meshes.
    pub mesh_creases: usize,
    /// Borders of meshes.
    pub mesh_borders: usize,
}

impl Edges {
    /// How many there are of each kind.
    pub fn counts(&self) -> EdgeCounts {
        let of = |kind: EdgeKind| self.edges.iter().filter(|e| e.kind == kind).count();
        let of_meshes = |kind: EdgeKind| self.of_meshes.iter().filter(|e| e.kind == kind).count();
        EdgeCounts {
            sharp: of(EdgeKind::Sharp),
            smooth: of(EdgeKind::Smooth),
            seams: of(EdgeKind::Seam),
            borders: of(EdgeKind::Border),
            vertices: self.vertices.len(),
            mesh_creases: of_meshes(EdgeKind::Sharp),
            mesh_borders: of_meshes(EdgeKind::Border),
        }
    }

    /// Edges of one face, used once: where the part is open.
    pub fn single(&self) -> usize {
        self.edges.iter().filter(|e| e.uses.len() == 1).count()
    }

    /// Every edge joins exactly two uses: the faces bound a volume, or several.
    pub fn closed(&self) -> bool {
        self.edges.iter().all(|e| e.uses.len() == 2)
    }
}

impl std::ops::AddAssign for EdgeCounts {
    fn add_assign(&mut self, other: Self) {
        self.sharp += other.sharp;
        self.smooth += other.smooth;
        self.seams += other.seams;
        self.borders += other.borders;
        self.vertices += other.vertices;
        self.mesh_creases += other.mesh_creases;
        self.mesh_borders += other.mesh_borders;
    }
}
