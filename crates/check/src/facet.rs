//! Triangles of meshes: an exact hit test, so that no ray passes between two neighbours.
//!
//! ```text
//!            c          the corners, seen along the ray, are points of a plane in which the ray is the
//!           ╱ ╲         origin; triangles that share a corner compute its place from the same numbers,
//!          ╱ · ╲        and the signs of the three turns around the origin are exact: it lies in the
//!         a─────b       triangle or in a neighbour, on their common side in both
//! ```
//!
//! Source: S. Woop, C. Benthin, I. Wald, *Watertight Ray/Triangle Intersection*, Journal of Computer
//! Graphics Techniques 2 (1), 2013, with exact signs instead of a second try in higher precision.

use super::leaf::{Meeting, Ray};
use crate::math::orientation::orientation;
use crate::model::{Bounds, Mesh};
use glam::{DVec2, DVec3};

/// The meshes of one part.
#[derive(Debug, Default)]
pub(super) struct Facets {
    meshes: Vec<Mesh>,
    /// Mesh and triangle.
    all: Vec<(u32, u32)>,
}

impl Facets {
    /// Every triangle with its box.
    pub fn new(meshes: &[Mesh]) -> (Self, Vec<Bounds>) {
        let of_mesh = |(index, m): (u32, &Mesh)| (0..m.triangles().len() as u32).map(move |t| (index, t));
        let facets = Self { meshes: meshes.to_vec(), all: (0..).zip(meshes).flat_map(of_mesh).collect() };
        let bounds = |&(m, t): &(u32, u32)| {
            let corners = facets.meshes[m as usize].corners(t as usize);
            corners.into_iter().fold(Bounds::EMPTY, Bounds::with)
        };
        let boxes = facets.all.iter().map(bounds).collect();
        (facets, boxes)
    }

    /// The meshes.
    pub fn meshes(&self) -> &[Mesh] {
        &self.meshes
    }

    /// Where the ray meets a triangle, and the index of its mesh. `(u, v)` are the barycentric weights of
    /// the second and the third corner. A triangle seen edge-on is not met.
    pub fn meet(&self, ray: &Ray, facet: usize) -> Option<(usize, Meeting)> {
        let (index, triangle) = self.all[facet];
        let mesh = &self.meshes[index as usize];
        let corners = mesh.corners(triangle as usize);
        let [a, b, c] = corners.map(|p| ray.across(p));
        let turn = |p: DVec2, q: DVec2| orientation(p, q, DVec2::ZERO);
        let turns = [turn(b, c), turn(c, a), turn(a, b)];
        let area = turns[0] + turns[1] + turns[2];
        let inside = turns.iter().all(|t| *t >= 0.0) || turns.iter().all(|t| *t <= 0.0);
        if !inside || area == 0.0 {
            return None;
        }
        let weights = turns.map(|t| t / area);
        let mixed = |of: [DVec3; 3]| of[0] * weights[0] + of[1] * weights[1] + of[2] * weights[2];
        // from the first corner, so that a triangle far from its part's origin loses no digits
        let (ab, ac) = (corners[1] - corners[0], corners[2] - corners[0]);
        let point = corners[0] + ab * weights[1] + ac * weights[2];
        let flat = ab.cross(ac);
        let normal = match mesh.normals().get(triangle as usize) {
            Some(of) => mixed(of.map(|n| n.try_normalize().unwrap_or(flat.normalize_or_zero()))),
            None => flat,
        };
        let meeting =
            Meeting { t: ray.parameter(point), uv: DVec2::new(weights[1], weights[2]), point, normal, spread: 0.0 };
        Some((index as usize, meeting))
    }
}
