//! The pixels in which a view sees operands without equations, and an estimate of the crossings that its first frame
//! stores.
//!
//! ```text
//!   crossings    mesh    sum of its triangles' areas in pixels, scaled by the part of each box in the picture
//!                part    front and back of its box
//! ```

use super::SolidData;
use crate::model::Camera;
use glam::{DMat4, DVec2, DVec3};
use rayon::prelude::*;
use std::ops::Range;

/// Least depth along the view axis, model units. Points nearer to the eye, or behind it, are moved to this depth.
const LEAST_DEPTH: f64 = 1e-6;

/// Pixels beside its box in which an operand may still cross rays: samples lie up to half a pixel off, and faces are
/// drawn beyond their borders. This is far more than both.
const BESIDE_PX: f64 = 8.0;

impl SolidData {
    /// Columns and rows of the pixels whose rays may cross operands.
    pub(crate) fn operand_pixels(&self, camera: &Camera) -> [Range<u32>; 2] {
        let view = View::new(camera);
        let corners = || self.operand_boxes.iter().flat_map(|b| b.corners());
        if corners().any(|p| !view.is_before(p)) {
            return [0..camera.size.0, 0..camera.size.1];
        }
        let (lo, hi) = view.ends(corners());
        let range = |lo: f64, hi: f64, size: u32| {
            // infinite coordinates, and those of no points, become the picture's ends
            let [first, end] = [lo - BESIDE_PX, hi + BESIDE_PX + 1.0].map(|x| x.clamp(0.0, size.into()) as u32);
            first..end.max(first)
        };
        [range(lo.x, hi.x, camera.size.0), range(lo.y, hi.y, camera.size.1)]
    }

    /// An estimate; 0 for data of [`centres_only`](Self::centres_only).
    pub(crate) fn expected_crossings(&self, camera: &Camera) -> u64 {
        let view = View::new(camera);
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
        all.sum::<f64>() as u64 // NaN gives 0
    }
}

struct View {
    matrix: DMat4,
    size: DVec2,
}

impl View {
    fn new(camera: &Camera) -> Self {
        Self { matrix: camera.pixel_matrix(), size: DVec2::new(camera.size.0.into(), camera.size.1.into()) }
    }

    /// Whether the point has a place in the picture's plane.
    fn is_before(&self, p: DVec3) -> bool {
        (self.matrix * p.extend(1.0)).w > LEAST_DEPTH
    }

    fn at(&self, p: DVec3) -> DVec2 {
        let q = self.matrix * p.extend(1.0);
        DVec2::new(q.x, q.y) / q.w.max(LEAST_DEPTH)
    }

    /// Smallest and largest coordinates of points, in pixels.
    fn ends(&self, points: impl Iterator<Item = DVec3>) -> (DVec2, DVec2) {
        let empty = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        points.map(|p| self.at(p)).fold(empty, |(lo, hi), p| (lo.min(p), hi.max(p)))
    }

    /// Area of the box around points, and of its part in the picture, square pixels.
    fn box_of(&self, points: impl Iterator<Item = DVec3>) -> (f64, f64) {
        let (lo, hi) = self.ends(points);
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
    use crate::model::{Mesh, Primitive, Projection, Shape, Solid, SurfaceTable};
    use crate::picture::SolidWay;
    use crate::scene::solids::Lists;
    use glam::DAffine3;
    use std::sync::Arc;

    /// A tetrahedron of height 4 over a right triangle with sides 30 and 20, seen from above at one pixel a unit.
    fn seen(at: DVec3) -> (u64, [Range<u32>; 2]) {
        let corners = [DVec3::ZERO, DVec3::X * 30.0, DVec3::Y * 20.0, DVec3::new(5.0, 5.0, 4.0)];
        let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let mesh = Mesh::new(1, corners.to_vec(), triangles, Vec::new()).unwrap();
        let shape = Shape::Mesh(Arc::new(mesh));
        let one = Primitive { id: 1, colour: [0.5; 4], shape, transform: DAffine3::from_translation(at) };
        let solid = Solid::of(one).unwrap();
        let data = SolidData::new(&Lists::union(std::slice::from_ref(&solid)), SurfaceTable::ROUNDED, SolidWay::Events)
            .unwrap();
        let camera = Camera {
            eye: DVec3::Z * 100.0,
            target: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Orthographic { height: 100.0 },
            depth_range: (1.0, 200.0),
            size: (160, 100),
        };
        let pixels = data.operand_pixels(&camera);
        assert_eq!(data.clone().centres_only().operand_pixels(&camera), pixels);
        (data.expected_crossings(&camera), pixels)
    }

    /// 300 square pixels from below, and as many from above, if the whole tetrahedron is in the picture.
    #[test]
    fn front_and_back_are_counted() {
        let (crossings, pixels) = seen(DVec3::ZERO);
        assert!((599..=600).contains(&crossings), "{crossings}");
        assert_eq!(pixels, [72..119, 22..59]);
        // the picture ends at 80
        let (crossings, pixels) = seen(DVec3::X * 65.0);
        assert!((200..500).contains(&crossings), "{crossings}");
        assert_eq!(pixels, [137..160, 22..59]);
        let (crossings, [columns, _]) = seen(DVec3::X * 200.0);
        assert!(crossings == 0 && columns.is_empty());
    }
}
