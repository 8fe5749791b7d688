//! Selected items of the model.

use glam::{DVec2, DVec3};

/// An item of the model; numbers are those of the session's model, from 0 on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Picked {
    /// A face of a placed part.
    Face {
        /// In the model's instances.
        instance: usize,
        /// In the part's faces.
        face: usize,
        /// Where it was picked, in the face's domain.
        uv: DVec2,
    },
    /// An edge of a placed part.
    Edge {
        /// In the model's instances.
        instance: usize,
        /// In the part's edges.
        edge: usize,
    },
    /// An end of edges of a placed part.
    Vertex {
        /// In the model's instances.
        instance: usize,
        /// In the part's vertices.
        vertex: usize,
    },
    /// A point of a placed part that is no vertex, to measure from or to.
    Point {
        /// In the model's instances.
        instance: usize,
        /// Its kind.
        kind: PointKind,
        /// In the part's faces for a point on a face, else in the part's edges.
        of: usize,
        /// Part coordinates.
        at: DVec3,
    },
    /// A placed part.
    Instance(usize),
    /// A face of which only the number is known: of a Boolean solid, a section or a mesh.
    Number {
        /// Its placed part, if it has one.
        instance: Option<usize>,
        /// As in `Sample::face`.
        id: u32,
    },
}

/// The kinds of points of a placed part that are no vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointKind {
    /// The centre of an edge that is a circle or an arc of one.
    Centre,
    /// The point of an edge with half of its length on each side.
    Middle,
    /// Another point of an edge.
    OnEdge,
    /// A point of a face.
    OnFace,
}

impl Picked {
    /// Whether it is a vertex or another point.
    pub fn is_point(&self) -> bool {
        matches!(self, Self::Vertex { .. } | Self::Point { .. })
    }

    /// Whether both are the same item, wherever it was picked.
    pub fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Face { instance: a, face: f, .. }, Self::Face { instance: b, face: g, .. }) => a == b && f == g,
            (a, b) => a == b,
        }
    }

    /// Its placed part.
    pub fn instance(&self) -> Option<usize> {
        match *self {
            Self::Face { instance, .. } | Self::Edge { instance, .. } | Self::Vertex { instance, .. } => Some(instance),
            Self::Point { instance, .. } | Self::Instance(instance) => Some(instance),
            Self::Number { instance, .. } => instance,
        }
    }
}
