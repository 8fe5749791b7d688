//! A triangle mesh: facets of the source, drawn as they are.
//!
//! ```text
//!   positions: p0 p1 p2 p3 ...        one per vertex, part coordinates
//!   triangles: (0 1 2) (2 1 3) ...    counter-clockwise from outside
//!   normals:   one per corner, or none: then each triangle is flat
//! ```

use super::{Bounds, Colour};
use glam::DVec3;
#[cfg(feature = "serde")]
use serde::Deserialize;

/// Triangles that share vertices. Valid by construction: see [`Mesh::new`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "MeshData"))]
pub struct Mesh {
    /// Number in the source, written to the face-id image. Never 0.
    pub id: u32,
    /// The mesh's own colour, if it has one.
    pub colour: Option<Colour>,
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    normals: Vec<[DVec3; 3]>,
}

/// Why triangles do not make a mesh.
#[allow(missing_docs)] // the messages say what each field is
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} names vertex {vertex} of {vertices}")]
    Vertex { triangle: usize, vertex: u32, vertices: usize },
    /// A coordinate is not finite.
    #[error("vertex {vertex} is not finite")]
    Position { vertex: usize },
    /// Normals that do not fit the triangles, or are not finite.
    #[error("{normals} normals for {triangles} triangles, or one that is not finite")]
    Normals { normals: usize, triangles: usize },
}

/// The stored form of a [`Mesh`], before it is checked.
#[cfg(feature = "serde")]
#[derive(Deserialize)]
struct MeshData {
    id: u32,
    colour: Option<Colour>,
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    normals: Vec<[DVec3; 3]>,
}

#[cfg(feature = "serde")]
impl TryFrom<MeshData> for Mesh {
    type Error = MeshError;

    fn try_from(data: MeshData) -> Result<Self, MeshError> {
        let mesh = Self::new(data.id, data.positions, data.triangles, data.normals)?;
        Ok(Self { colour: data.colour, ..mesh })
    }
}

impl Mesh {
    /// Checks and keeps the triangles; `normals` has one triple a triangle (towards the side from which
    /// the triangle runs counter-clockwise, of any length) or is empty.
    ///
    /// # Errors
    /// [`MeshError`] names the first vertex or triangle that is wrong.
    pub fn new(
        id: u32,
        positions: Vec<DVec3>,
        triangles: Vec<[u32; 3]>,
        normals: Vec<[DVec3; 3]>,
    ) -> Result<Self, MeshError> {
        if let Some(vertex) = positions.iter().position(|p| !p.is_finite()) {
            return Err(MeshError::Position { vertex });
        }
        let vertices = positions.len();
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= vertices) {
                return Err(MeshError::Vertex { triangle, vertex, vertices });
            }
        }
        let fit = normals.is_empty() || normals.len() == triangles.len();
        if !fit || normals.iter().flatten().any(|n| !n.is_finite()) {
            return Err(MeshError::Normals { normals: normals.len(), triangles: triangles.len() });
        }
        Ok(Self { id, colour: None, positions, triangles, normals })
    }

    /// Vertex positions in part coordinates.
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Vertex indices, counter-clockwise from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Normals of each triangle's corners; empty when the triangles are flat.
    pub fn normals(&self) -> &[[DVec3; 3]] {
        &self.normals
    }

    /// Corners of one triangle.
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|v| self.positions[v as usize])
    }

    /// Box of the triangles. Vertices that no triangle has do not count.
    pub fn bounds(&self) -> Bounds {
        self.triangles.iter().flatten().map(|v| self.positions[*v as usize]).fold(Bounds::EMPTY, Bounds::with)
    }
}
