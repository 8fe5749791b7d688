//! How many crossings of operands without equations a view is likely to have, so that its first frame has room.
//!
//! ```text
//!   mesh    each triangle's area in pixels, of the part of its box that is in the picture
//!   part    front and back of its box
//! ```

use super::SolidData;
use crate::model::Camera;
use glam::{DMat4, DVec2, DVec3};
use rayon::prelude::*;

/// Nearer than this share of the depth range counts as there: what reaches behind the eye covers the picture.
const LEAST_DEPTH: f64 = 1e-6;

impl SolidData {
    /// About how many; data that [`centres_only`](Self::centres_only) are has none.
    pub(crate) fn expected_crossings(&self, camera: &Camera) -> u64 {
        let view = View { matrix: camera.pixel_matrix(), size: DVec2::new(camera.size.0.into(), camera.size.1.into()) };
        let all = self.operands.iter().map(|operand| {
            if operand.meshes.is_empty() {
                return 2.0 * view.box_of(operand.primitive.bounds().corners().into_iter()).1;
            }
            let place = |v: u32| {
                let own = DVec3::from(self.operand_positions[v as usize].map(f64::from)) + operand.origin;
                operand.primitive.transform.transform_point3(own)
            };
            let corners = self.operand_draws[operand.meshes.clone()].iter();
            let triangles = corners.flat_map(|c| &self.operand_triangles[c.start as usize / 3..c.end as usize / 3]);
            let triangles: Vec<&[u32; 3]> = triangles.collect();
            triangles.par_iter().map(|t| view.covered(t.map(place))).sum()
        });
        all.sum::<f64>() as u64 // 0 of what is not a number
    }
}

struct View {
    matrix: DMat4,
    size: DVec2,
}

impl View {
    fn at(&self, p: DVec3) -> DVec2 {
        let q = self.matrix * p.extend(1.0);
        DVec2::new(q.x, q.y) / q.w.max(LEAST_DEPTH)
    }

    /// Area of the box around points, and of its part in the picture, square pixels.
    fn box_of(&self, points: impl Iterator<Item = DVec3>) -> (f64, f64) {
        let empty = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (lo, hi) = points.map(|p| self.at(p)).fold(empty, |(lo, hi), p| (lo.min(p), hi.max(p)));
        let area = |lo: DVec2, hi: DVec2| (hi - lo).max(DVec2::ZERO).element_product();
        (area(lo, hi), area(lo.max(DVec2::ZERO), hi.min(self.size)))
    }

    fn covered(&self, corners: [DVec3; 3]) -> f64 {
        let (whole, seen) = self.box_of(corners.into_iter());
        let [a, b, c] = corners.map(|p| self.at(p));
        let share = if whole > 0.0 { (0.5 * (b - a).perp_dot(c - a).abs() / whole).min(1.0) } else { 0.0 };
        share * seen
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Mesh, Primitive, Projection, Shape, Solid};
    use crate::picture::SolidWay;
    use crate::scene::solids::Lists;
    use glam::DAffine3;
    use std::sync::Arc;

    /// A tetrahedron of height 4 over a triangle of legs 30 and 20, seen from above with one pixel a unit.
    fn crossings(at: DVec3) -> u64 {
        let corners = [DVec3::ZERO, DVec3::X * 30.0, DVec3::Y * 20.0, DVec3::new(5.0, 5.0, 4.0)];
        let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let mesh = Mesh::new(1, corners.to_vec(), triangles, Vec::new()).unwrap();
        let shape = Shape::Mesh(Arc::new(mesh));
        let one = Primitive { id: 1, colour: [0.5; 4], shape, transform: DAffine3::from_translation(at) };
        let solid = Solid::of(one).unwrap();
        let data = SolidData::new(&Lists::union(std::slice::from_ref(&solid)), SolidWay::Events).unwrap();
        let camera = Camera {
            eye: DVec3::Z * 100.0,
            target: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Orthographic { height: 100.0 },
            depth_range: (1.0, 200.0),
            size: (160, 100),
        };
        data.expected_crossings(&camera)
    }

    /// 300 square pixels from below, and as many from above, where all of it is seen.
    #[test]
    fn front_and_back_are_counted() {
        assert!((599..=600).contains(&crossings(DVec3::ZERO)), "{}", crossings(DVec3::ZERO));
        // the picture ends at 80
        let part = crossings(DVec3::X * 65.0);
        assert!((200..500).contains(&part), "{part}");
        assert_eq!(crossings(DVec3::X * 200.0), 0);
    }
}
