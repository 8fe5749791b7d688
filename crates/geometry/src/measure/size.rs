//! What a face or an edge has of its own: area, radius, length, in the coordinates of its part.

use super::mass;
use crate::edges::curve;
use crate::model::{Edge, Face, SurfaceKind};
use glam::DAffine3;

/// Share by which curvatures of one circle may differ: roundings of second derivatives.
const ROUND: f64 = 1e-7;

impl Face {
    /// Area inside the loops, square model units, in the coordinates of the part. Accuracy and cost are those of
    /// [`mass::area`].
    pub fn area(&self) -> f64 {
        mass::area(self, DAffine3::IDENTITY).area
    }

    /// Radius of a cylinder or sphere, and of the tube of a torus, model units, in the coordinates of the part; `None`
    /// for other kinds, and where the carrier surface is not round.
    pub fn radius(&self) -> Option<f64> {
        let ((u0, u1), (v0, v1)) = self.surface.domain();
        let at = |s: f64, t: f64| self.surface.jet2(u0 + s * (u1 - u0), v0 + t * (v1 - v0));
        // curvatures along both families of curves of constant parameter, at inner points of both
        let curvatures = |s: f64, t: f64| {
            let jet = at(s, t);
            let normal = jet.du.cross(jet.dv).normalize_or_zero();
            [(jet.duu, jet.du), (jet.dvv, jet.dv)]
                .map(|(second, first)| (second.dot(normal) / first.length_squared()).abs())
        };
        let samples = [curvatures(0.21, 0.33), curvatures(0.47, 0.59), curvatures(0.78, 0.87)];
        let constant = |k: usize| {
            let of = samples.map(|pair| pair[k]);
            let (least, most) =
                (of.iter().copied().fold(f64::INFINITY, f64::min), of.iter().copied().fold(0.0, f64::max));
            (most.is_finite() && most > 0.0 && most - least <= ROUND * most).then_some(most)
        };
        // the curves along a cylinder are straight, and the parallels of a torus change their curvature
        let round = matches!(self.kind, SurfaceKind::Cylinder | SurfaceKind::Sphere | SurfaceKind::Torus);
        let curvature = [constant(0), constant(1)].into_iter().flatten().filter(|_| round).reduce(f64::max);
        curvature.map(f64::recip)
    }
}

impl Edge {
    /// Length of the curve in space, model units, in the coordinates of the part: [`curve::length`] where it stands.
    pub fn length(&self) -> f64 {
        curve::length(self, DAffine3::IDENTITY).0
    }
}

#[cfg(test)]
mod tests;
