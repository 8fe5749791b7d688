//! Operands without equations, *shells*: meshes as arrays, spline parts as what the scene places later.
//!
//! ```text
//!   mesh   triangle ──▶ LeafSurface ──▶ Surface: its plane, shared with faces that coincide
//!   part   faces ──▶ FaceData, as of a part that is drawn by itself, with the primitive's id and colour
//! ```

use super::{SolidData, SurfaceTable};
use crate::abi;
use crate::model::{Face, Mesh, Part, Primitive, Shape};
use glam::DVec3;
use std::ops::Range;
use std::sync::Arc;

/// A shell that still has to be placed.
#[derive(Clone, Debug)]
pub(in crate::scene) struct Operand {
    pub primitive: Primitive,
    pub shell: u32,
    /// Middle of its box, own coordinates.
    pub origin: DVec3,
    /// Of [`SolidData::operand_meshes`].
    pub meshes: Range<usize>,
}

impl Operand {
    /// The faces that bound it, if any do.
    pub fn faces(&self) -> &[Face] {
        match &self.primitive.shape {
            Shape::Part(part) => &part.faces,
            _ => &[],
        }
    }
}

/// Whether the primitive needs fragments: a mesh or part that has a volume.
pub(super) fn is_shell(primitive: &Primitive) -> bool {
    !primitive.shape.is_analytic() && !primitive.bounds().is_empty()
}

impl SolidData {
    /// Adds primitive `p` as the next shell; `leaf` is the first that shows it. Returns its number.
    pub(super) fn push_shell(&mut self, table: &SurfaceTable, p: u32, primitive: &Primitive, leaf: u32) -> u32 {
        let shell = self.shell_leaves.len() as u32;
        self.shell_leaves.push(leaf);
        let origin = primitive.shape.bounds().centre();
        let first = self.operand_meshes.len();
        match &primitive.shape {
            Shape::Mesh(mesh) => {
                let sides = table.faces(p).iter().map(|f| f.surface << 1 | u32::from(f.flipped)).collect();
                self.push_mesh(mesh, origin, shell, leaf, sides, primitive);
            }
            // the faces bound the part, or else its meshes do
            Shape::Part(part) if part.faces.is_empty() => self.push_meshes(part, origin, shell, leaf, primitive),
            _ => {}
        }
        let meshes = first..self.operand_meshes.len();
        self.operands.push(Operand { primitive: primitive.clone(), shell, origin, meshes });
        shell
    }

    /// Meshes of a part share no surface with other primitives.
    fn push_meshes(&mut self, part: &Arc<Part>, origin: DVec3, shell: u32, leaf: u32, primitive: &Primitive) {
        for mesh in part.meshes.iter().filter(|m| !m.triangles().is_empty()) {
            let shape = Shape::Mesh(Arc::new(mesh.clone()));
            let alone = Primitive { shape, ..primitive.clone() };
            let first = self.surfaces.len() as u32;
            let near = primitive.bounds().centre();
            for placed in super::sides_of(&alone, near) {
                self.surfaces.push(placed.surface);
                self.surface_centres.push(placed.centre);
            }
            let sides = (first..self.surfaces.len() as u32).map(|s| s << 1).collect();
            self.push_mesh(mesh, origin, shell, leaf, sides, primitive);
        }
    }

    fn push_mesh(&mut self, mesh: &Mesh, origin: DVec3, shell: u32, leaf: u32, sides: Vec<u32>, of: &Primitive) {
        let first = self.operand_positions.len() as u32;
        let corners = 3 * self.operand_triangles.len() as u32;
        self.operand_meshes.push(abi::OperandMesh {
            shell,
            instance: 0, // when it is placed
            first_triangle: self.operand_triangles.len() as u32,
            first_side: self.leaf_surfaces.len() as u32,
            mirrored: u32::from(of.transform.matrix3.determinant() < 0.0),
        });
        self.leaf_surfaces.extend(sides.into_iter().map(|surface| abi::LeafSurface { surface, leaf }));
        self.operand_positions.extend(mesh.positions().iter().map(|p| (*p - origin).as_vec3().to_array()));
        self.operand_triangles.extend(mesh.triangles().iter().map(|t| t.map(|v| first + v)));
        self.operand_draws.push(corners..3 * self.operand_triangles.len() as u32);
    }
}
