//! Meshes as arrays. Positions are single precision relative to the part's centre, like control points.
//!
//! ```text
//!   part with 2 meshes, placed 3 times         mesh instances: A0 A1 A2 B0 B1 B2
//!                                              draws: (corners of A, 0..3) (corners of B, 3..6)
//! ```

use super::face::{DEFAULT_COLOUR, pack_colour};
use super::neighbours::neighbours;
use crate::abi;
use crate::math::octahedral;
use crate::model::{Mesh, Model};
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

/// The meshes of all placed parts, and their instances.
#[derive(Clone, Debug, Default)]
pub(crate) struct Meshes {
    pub meshes: Vec<abi::Mesh>,
    /// Grouped by mesh.
    pub instances: Vec<abi::MeshInstance>,
    pub positions: Vec<[f32; 3]>,
    /// Indices into `positions`.
    pub triangles: Vec<[u32; 3]>,
    /// Three for each triangle, if borders are smooth ([`neighbours`](super::neighbours)).
    pub neighbours: Vec<u32>,
    /// Octahedral normals, one a corner of a triangle; empty for meshes without normals.
    pub normals: Vec<u32>,
    /// The corners of each mesh's triangles, and the mesh's range of `instances`.
    pub draws: Vec<(Range<u32>, Range<u32>)>,
    /// The first triangle of each mesh of each part that is placed.
    pub first_triangles: Vec<Vec<u32>>,
    /// The number, in its part, of each mesh that belongs to a part.
    pub numbers: Vec<u32>,
    /// From this draw on, only triangles that face the eye are drawn: meshes of Boolean solids.
    pub outward: usize,
}

impl Meshes {
    /// `origins` has the centre of each part. `open`: a volume cuts the scene open.
    pub(super) fn new(model: &Model, origins: &[DVec3], open: bool) -> Self {
        let mut placed = vec![Vec::new(); model.parts.len()];
        (0..).zip(&model.instances).for_each(|(index, i)| placed[i.part].push(index));
        let mut all = Self::default();
        for ((part, &origin), placed) in model.parts.iter().zip(origins).zip(&placed) {
            let mut first_triangles = Vec::with_capacity(part.meshes.len());
            for (number, mesh) in (0..).zip(&part.meshes) {
                first_triangles.push(all.triangles.len() as u32);
                if !mesh.triangles().is_empty() && !placed.is_empty() {
                    all.numbers.push(number);
                    all.push(mesh, origin, part.closed && !open, placed);
                }
            }
            all.first_triangles.push(first_triangles);
        }
        all.outward = all.draws.len();
        all
    }

    /// Adds a mesh of which only outer faces are drawn.
    pub(super) fn push_outward(&mut self, mesh: &Mesh, origin: DVec3, instance: u32) {
        self.push(mesh, origin, true, &[instance]);
    }

    /// Finds which triangles share sides.
    pub(super) fn find_neighbours(&mut self) {
        self.neighbours = neighbours(&self.positions, &self.triangles, &self.meshes);
    }

    fn push(&mut self, mesh: &Mesh, origin: DVec3, solid: bool, placed: &[u32]) {
        let flag = |on: bool, bit: u32| if on { bit } else { 0 };
        let smooth = !mesh.normals().is_empty();
        let number = self.meshes.len() as u32;
        let first = self.positions.len();
        let (corners, instances) = (3 * self.triangles.len(), self.instances.len());
        self.meshes.push(abi::Mesh {
            first_triangle: self.triangles.len() as u32,
            first_normal: self.normals.len() as u32,
            flags: flag(solid, abi::MESH_SOLID) | flag(smooth, abi::MESH_NORMALS),
            id: mesh.id,
            colour: mesh.colour.map_or(DEFAULT_COLOUR, pack_colour),
        });
        self.instances.extend(placed.iter().map(|&instance| abi::MeshInstance { mesh: number, instance }));
        self.positions.par_extend(mesh.positions().par_iter().map(|p| (*p - origin).as_vec3().to_array()));
        self.triangles.par_extend(mesh.triangles().par_iter().map(|t| t.map(|v| (first + v as usize) as u32)));
        self.normals.par_extend((0..mesh.normals().len()).into_par_iter().flat_map_iter(|t| corner_normals(mesh, t)));
        let range = |from: usize, to: usize| from as u32..to as u32;
        self.draws.push((range(corners, 3 * self.triangles.len()), range(instances, self.instances.len())));
    }
}

/// The normals of a triangle's corners; a corner without one gets the triangle's.
fn corner_normals(mesh: &Mesh, triangle: usize) -> [u32; 3] {
    let [a, b, c] = mesh.corners(triangle);
    let flat = (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Z);
    mesh.normals()[triangle].map(|n| octahedral::pack(n.try_normalize().unwrap_or(flat)))
}
