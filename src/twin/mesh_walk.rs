//! Twin of `glsl/include/mesh_walk.glsl`: across a mesh, from one of its triangles to the one that a point of the
//! picture sees.
//!
//! ```text
//!        c                 weights of the point, one a corner: all at least 0 within the triangle. The walk crosses
//!       ╱ ╲    · point     the side opposite to the corner of the least. It ends at a border, and where the mesh
//!      ╱   ╲  ╱            folds back: there the weight of the corner beyond that side is below 0, too
//!     a ── b ╱
//! ```
//!
//! ```text
//!   error on another GPU, whose quotients s and t are off by d = 2.5 * 2^-23:
//!     weight   d (|s| + |t|), and the roundings of 1 - s - t
//!     depth    d (|s b.z| + |t c.z|), and the roundings of a.z + s b.z + t c.z
//! ```
//!
//! The arithmetic is `precise`: nothing is contracted, and only quotients differ.

use super::view::to_pixel;
use crate::abi::View;
pub use crate::abi::constants::mesh_walk::{MOST_CROSSED, NO_TRIANGLE, WEIGHT_ROUNDING};
use crate::abi::constants::mesh_walk::{WALK_GONE, WALK_MET, WALK_TOO_FAR};

/// Triangles, and which of them share sides.
#[derive(Clone, Copy, Debug)]
pub struct Meshes<'a> {
    /// Indices of corners.
    pub triangles: &'a [[u32; 3]],
    /// Corners, part coordinates.
    pub positions: &'a [[f32; 3]],
    /// Three for each triangle. Beyond the side opposite to a corner: the corner opposite to it, as 3 times its
    /// triangle + its place there; [`NO_TRIANGLE`] where there is none or several.
    pub neighbours: &'a [u32],
}

/// How a walk ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum End {
    /// At the triangle that the point sees.
    Met = WALK_MET,
    /// The mesh ends or folds before the point.
    Gone = WALK_GONE,
    /// After [`MOST_CROSSED`] triangles.
    TooFar = WALK_TOO_FAR,
}

/// Where a walk ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// How.
    pub end: End,
    /// The last triangle.
    pub triangle: u32,
    /// Of the plane that was looked at last, at the point; along the view axis.
    pub depth: f32,
}

/// A triangle as a pixel's middle sees it: homogeneous pixels `(X, Y, D, W)` of a corner and of the sides from there,
/// relative to the middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facing {
    a: [f32; 4],
    b: [f32; 4],
    c: [f32; 4],
}

fn cross(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[1] - a[1] * b[0]
}

/// Homogeneous pixels relative to a place.
fn relative(q: [f32; 4], place: [f32; 2]) -> [f32; 2] {
    [q[0] - place[0] * q[3], q[1] - place[1] * q[3]]
}

impl Meshes<'_> {
    /// A triangle as the middle of a pixel sees it.
    pub fn facing(&self, triangle: u32, view: &View, middle: [f32; 2]) -> Facing {
        let [a, b, c] = self.triangles[triangle as usize].map(|corner| self.positions[corner as usize]);
        let of = |p: [f32; 3], w: f32| {
            let q = to_pixel(view, [p[0], p[1], p[2], w]);
            let [x, y] = relative(q, middle);
            [x, y, q[2], q[3]]
        };
        let side = |end: [f32; 3]| std::array::from_fn(|k| end[k] - a[k]);
        Facing { a: of(a, 1.0), b: of(side(b), 0.0), c: of(side(c), 0.0) }
    }

    /// From a triangle to a pixel position; the triangle's plane there is nearer than `nearest`, or the walk ends at
    /// once.
    pub fn walk(&self, triangle: u32, view: &View, pixel: [f32; 2], nearest: f32) -> Met {
        let mut met = Met { end: End::TooFar, triangle, depth: 0.0 };
        let (mut back, mut before) = (None, None);
        for i in 0..=MOST_CROSSED {
            let (w, depth) = self.facing(met.triangle, view, pixel).weights([0.0; 2]);
            met.depth = depth;
            let least = if w[0] <= w[1] {
                if w[0] <= w[2] { 0 } else { 2 }
            } else if w[1] <= w[2] {
                1
            } else {
                2
            };
            let is_finite = depth.is_finite() && w.iter().all(|w| w.is_finite());
            let folds = back.is_some_and(|corner: usize| w[corner] < -WEIGHT_ROUNDING);
            let next = self.neighbours[3 * met.triangle as usize + least];
            let is_shared = next != NO_TRIANGLE;
            if !is_finite || folds || i == 0 && depth >= nearest {
                met.end = End::Gone;
            } else if w[least] >= -WEIGHT_ROUNDING || is_shared && Some(next / 3) == before {
                met.end = End::Met;
            } else if !is_shared {
                met.end = End::Gone;
            }
            if met.end != End::TooFar {
                break;
            }
            before = Some(met.triangle);
            met.triangle = next / 3;
            back = Some(next as usize % 3);
        }
        met
    }
}

impl Facing {
    /// Where the ray through a point, so far from the middle, meets the triangle's plane: weights of the corners, and
    /// the depth; no numbers if the triangle is edge-on.
    pub fn weights(&self, point: [f32; 2]) -> ([f32; 3], f32) {
        let [a, b, c] = [self.a, self.b, self.c].map(|q| relative(q, point));
        let area = cross(b, c);
        let (s, t) = (cross(c, a) / area, cross(a, b) / area);
        ([1.0 - s - t, s, t], self.a[2] + s * self.b[2] + t * self.c[2])
    }

    /// Error bounds of a weight, and of the depth, on another GPU.
    #[cfg(all(test, feature = "headless"))]
    pub fn bounds(&self, point: [f32; 2]) -> (f32, f32) {
        const D: f32 = 2.5 * f32::EPSILON;
        let ([_, s, t], _) = self.weights(point);
        let (s, t) = (s.abs(), t.abs());
        let depth = self.a[2].abs() + s * self.b[2].abs() + t * self.c[2].abs();
        (2.0 * D * (1.0 + s + t), 2.0 * D * depth)
    }
}
