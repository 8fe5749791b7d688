//! Operands without equations, *boundary operands*: meshes as arrays; spline parts as faces that the scene places
//! later.
//!
//! ```text
//!   mesh   triangle ──▶ corners, whose plane it has; or a Surface, shared with coinciding faces
//!   part   faces ──▶ FaceData, like those of any part, with the primitive's id and colour
//! ```

use super::{SolidData, surface};
use crate::abi;
use crate::model::{Face, Mesh, Part, Primitive, Shape};
use glam::DVec3;
use std::ops::Range;

/// An operand that is not placed yet.
#[derive(Clone, Debug)]
pub(in crate::scene) struct Operand {
    pub primitive: Primitive,
    pub number: u32,
    /// Middle of its box, in its own coordinates.
    pub origin: DVec3,
    /// Its range of [`SolidData::operand_meshes`].
    pub meshes: Range<usize>,
    /// Once it is placed: its instance in the scene, and its first face.
    pub placed: Option<(u32, usize)>,
}

impl Operand {
    /// The faces of a spline part; none for meshes.
    pub fn faces(&self) -> &[Face] {
        match &self.primitive.shape {
            Shape::Part(part) => &part.faces,
            _ => &[],
        }
    }
}

/// Whether the primitive is drawn as fragments: a mesh or part with volume.
pub(super) fn is_boundary_operand(primitive: &Primitive) -> bool {
    !primitive.shape.is_analytic() && !primitive.bounds().is_empty()
}

/// Triangles so thin that rounding their corners to single precision would turn their planes by more than 0.07°: a
/// third of a step of light in eight bits. Such triangles have a [`Surface`](super::Surface), made in double precision.
pub(super) struct Thin {
    height: f64,
}

/// Least height of a triangle, as a share of half the diagonal of the operand's box; two corners are rounded by 2⁻²⁴ of
/// that.
const THIN: f64 = 1e-4;

impl Thin {
    pub fn of(primitive: &Primitive) -> Self {
        Self { height: 0.5 * THIN * primitive.shape.bounds().diagonal() }
    }

    pub fn is(&self, [a, b, c]: [DVec3; 3]) -> bool {
        let longest = [b - a, c - b, a - c].map(DVec3::length).into_iter().fold(0.0, f64::max);
        // also true for triangles without area
        (b - a).cross(c - a).length() <= self.height * longest
    }
}

impl SolidData {
    /// Adds a primitive as the next operand. `surfaces` are those of a mesh's triangles; `leaf` is the first that shows
    /// it. Returns the operand's number.
    pub(super) fn push_boundary_operand(
        &mut self,
        surfaces: impl Iterator<Item = u32>,
        primitive: &Primitive,
        leaf: u32,
    ) -> u32 {
        let number = self.operand_leaves.len() as u32;
        self.operand_leaves.push(leaf);
        self.operand_boxes.push(primitive.bounds());
        let origin = primitive.shape.bounds().centre();
        let first = self.operand_meshes.len();
        match &primitive.shape {
            Shape::Mesh(mesh) => {
                // a surface that is only nearly a plane does not serve a triangle, whose corners are used instead
                let is_plane = |number: &u32| self.places.get(*number as usize).is_some_and(|p| p.surface().is_none());
                let planes: Vec<u32> = surfaces.map(|s| if is_plane(&s) { s } else { abi::NO_PLANE }).collect();
                self.operand_planes.extend(planes);
                self.push_mesh(mesh, origin, (number, leaf), primitive);
            }
            // faces bound the part if it has any, else meshes
            Shape::Part(part) if part.faces.is_empty() => self.push_meshes(part, origin, (number, leaf), primitive),
            _ => {}
        }
        let meshes = first..self.operand_meshes.len();
        self.operands.push(Operand { primitive: primitive.clone(), number, origin, meshes, placed: None });
        number
    }

    /// Meshes of a part share no surface with other primitives.
    fn push_meshes(&mut self, part: &Part, origin: DVec3, of: (u32, u32), primitive: &Primitive) {
        let thin = Thin::of(primitive);
        for mesh in part.meshes.iter().filter(|m| !m.triangles().is_empty()) {
            let near = primitive.bounds().centre();
            for corners in (0..mesh.triangles().len()).map(|t| mesh.corners(t)) {
                let placed = thin.is(corners).then(|| surface::of_triangle(primitive, corners, near)).flatten();
                let plane = self.push_surface(placed);
                self.operand_planes.push(plane);
            }
            self.push_mesh(mesh, origin, of, primitive);
        }
    }

    /// The surface of a mesh's triangle, if it has one that others may share.
    pub(in crate::scene) fn plane_of(&self, mesh: &abi::OperandMesh, triangle: u32) -> Option<u32> {
        let planes = self.operand_planes.get(mesh.first_plane as usize..)?;
        Some(planes[(triangle - mesh.first_triangle) as usize]).filter(|plane| *plane != abi::NO_PLANE)
    }

    /// Adds a mesh whose planes are already in `operand_planes`.
    fn push_mesh(&mut self, mesh: &Mesh, origin: DVec3, (operand, leaf): (u32, u32), of: &Primitive) {
        let planes = self.operand_planes.len() - mesh.triangles().len();
        let shares = self.operand_planes[planes..].iter().any(|plane| *plane != abi::NO_PLANE);
        if !shares {
            self.operand_planes.truncate(planes);
        }
        let first = self.operand_positions.len() as u32;
        let corners = 3 * self.operand_triangles.len() as u32;
        self.operand_meshes.push(abi::OperandMesh {
            operand,
            instance: 0, // set when it is placed
            first_triangle: self.operand_triangles.len() as u32,
            first_plane: if shares { planes as u32 } else { abi::NO_PLANE },
            mirrored: u32::from(of.transform.matrix3.determinant() < 0.0),
            leaf,
        });
        self.operand_positions.extend(mesh.positions().iter().map(|p| (*p - origin).as_vec3().to_array()));
        self.operand_triangles.extend(mesh.triangles().iter().map(|t| t.map(|v| first + v)));
        self.operand_draws.push(corners..3 * self.operand_triangles.len() as u32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Mesh, Solid, SurfaceTable};
    use crate::picture::SolidWay;
    use crate::scene::solids::Lists;
    use glam::DAffine3;
    use std::sync::Arc;

    const TETRA: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    fn of(corners: &[[f64; 3]], triangles: Vec<[u32; 3]>) -> Mesh {
        Mesh::new(1, corners.iter().copied().map(DVec3::from).collect(), triangles, Vec::new()).unwrap()
    }

    fn tetra(width: f64) -> Mesh {
        of(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, width]], TETRA.to_vec())
    }

    fn data(shapes: Vec<Shape>) -> SolidData {
        let one = |shape| Primitive { id: 1, colour: [0.5; 4], shape, transform: DAffine3::IDENTITY };
        let solids: Vec<Solid> = shapes.into_iter().map(|shape| Solid::of(one(shape)).unwrap()).collect();
        SolidData::new(&Lists::union(&solids), SurfaceTable::ROUNDED, SolidWay::Events).unwrap()
    }

    fn mesh(mesh: Mesh) -> Shape {
        Shape::Mesh(Arc::new(mesh))
    }

    #[test]
    fn triangles_by_themselves_are_their_corners() {
        let d = data(vec![mesh(tetra(1.0))]);
        assert_eq!((d.places.len(), d.leaf_surfaces.len(), d.operand_planes.len()), (0, 0, 0));
        assert_eq!((d.operand_meshes[0].first_plane, d.operand_meshes[0].leaf), (abi::NO_PLANE, 0));
    }

    /// The bottoms of the block and of the tetrahedron lie in one plane; the tetrahedron has one triangle there.
    #[test]
    fn planes_that_others_share_are_surfaces() {
        let below = || Shape::Block { min: DVec3::new(-3.0, -3.0, -1.0), max: DVec3::new(-2.0, -2.0, 0.0) };
        for shapes in [vec![mesh(tetra(1.0)), below()], vec![below(), mesh(tetra(1.0))]] {
            let d = data(shapes);
            let shared: Vec<u32> = d.operand_planes.iter().copied().filter(|p| *p != abi::NO_PLANE).collect();
            assert_eq!((d.places.len(), d.leaf_surfaces.len(), shared.len()), (6, 6, 1));
            assert_eq!(d.operand_planes[0], shared[0], "the triangle at the bottom is the first");
            assert!(d.leaf_surfaces.iter().any(|side| side.surface >> abi::SIDE_SHIFT == shared[0]));
        }
        // a mesh whose own triangles share planes: all four twice, in both orientations
        let twice = TETRA.into_iter().chain(TETRA.map(|[a, b, c]| [b, a, c])).collect();
        let d = data(vec![mesh(of(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], twice))]);
        assert_eq!((d.places.len(), d.operand_planes), (4, vec![0, 1, 2, 3, 0, 1, 2, 3]));
    }

    /// A height of a 50,000th of the length: single precision would turn the planes.
    #[test]
    fn thin_triangles_keep_their_planes() {
        let thin = || tetra(2e-5);
        // the two triangles along the short edge; the other two are large
        let d = data(vec![mesh(thin())]);
        assert_eq!((d.places.len(), d.operand_planes.len()), (2, 4));
        let part = Part { meshes: vec![tetra(1.0), thin()], closed: true, ..Part::default() };
        let d = data(vec![Shape::Part(Arc::new(part))]);
        assert_eq!((d.places.len(), d.operand_planes.len()), (2, 4));
        assert_eq!([0, 1].map(|m| d.operand_meshes[m].first_plane), [abi::NO_PLANE, 0]);
    }
}
