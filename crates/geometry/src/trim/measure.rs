//! Areas of faces, radii of round ones, lengths of edges.
//!
//! ```text
//!   area = ∬ |S_u × S_v| du dv  over the points that the loops keep
//!        = ∮ F dv  along the loops,   F(u, v) = ∫ |S_u × S_v| du  from the domain's start to u      (Green)
//! ```
//!
//! Outer loops run counter-clockwise and holes clockwise, so the sum over all loops is the area. Both integrals are
//! sums of Gauss-Legendre rules, those along curves halved until two halves agree with the whole to [`AGREE`]. Smooth
//! integrands give 1e-9 of the value or better; a loop that crosses itself counts by its winding number.

use crate::math::gauss::{integrate, rule, within};
use crate::model::{Edge, Face, SurfaceKind};
use crate::spline::{Bezier, Surface};
use glam::{DVec3, DVec4};

/// Share of the whole by which a rule and its two halves may differ.
const AGREE: f64 = 1e-10;
/// Halvings of one curve at most: a kink at a knot line is then within a millionth of the curve.
const MOST_HALVINGS: u32 = 20;
/// Share by which curvatures of one circle may differ: roundings of second derivatives.
const ROUND: f64 = 1e-7;

/// `F(u, v)`, with a rule a knot span.
fn strip(surface: &Surface, spans: &[f64], u: f64, v: f64) -> f64 {
    let density = |u: f64| {
        let jet = surface.jet2(u, v);
        [jet.du.cross(jet.dv).length()]
    };
    let ends = |pair: &[f64]| (pair[0], pair[1].min(u));
    spans.windows(2).map(ends).filter(|(a, b)| b > a).map(|(a, b)| rule(&density, a, b)[0]).sum()
}

impl Face {
    /// Area inside the loops, squares of model units, in the coordinates of the part.
    ///
    /// Cost: some hundred evaluations of the surface for each trim curve and each knot span in u.
    pub fn area(&self) -> f64 {
        let ((u0, u1), (v0, v1)) = self.surface.domain();
        let mut spans: Vec<f64> = self.surface.knots().0.iter().copied().filter(|u| (u0..=u1).contains(u)).collect();
        spans.dedup();
        let up_to = |u: f64, v: f64| strip(&self.surface, &spans, u, v);
        let mut rows: Vec<f64> = self.surface.knots().1.iter().copied().filter(|v| (v0..=v1).contains(v)).collect();
        rows.dedup();
        let row = |pair: &[f64]| rule(&|v| [up_to(u1, v)], pair[0], pair[1])[0];
        let whole: f64 = rows.windows(2).map(row).sum();
        if self.loops.is_empty() {
            return whole;
        }
        let along = |curve: Bezier<DVec3>| {
            let f = |t: f64| {
                let (p, d) = curve.jet(t);
                let (u, v) = (p.x / p.z, p.y / p.z);
                let inside = v >= v0 && v <= v1;
                [if inside { up_to(u.min(u1), v) * (d.y - v * d.z) / p.z } else { 0.0 }]
            };
            within(&f, (0.0, 1.0), [AGREE * whole], MOST_HALVINGS).0[0]
        };
        self.loops.iter().flat_map(|l| l.curves()).map(along).sum::<f64>().abs()
    }

    /// Radius of a cylinder or sphere, and of the tube of a torus, model units, in the coordinates of the part; `None` for
    /// other kinds, and where the carrier surface is not round.
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
    /// Length of the curve in space, model units, in the coordinates of the part.
    pub fn length(&self) -> f64 {
        let of = |curve: &Bezier<DVec4>| {
            let speed = |t: f64| {
                let (p, d) = curve.jet(t);
                let point = p.truncate() / p.w;
                [((d.truncate() - point * d.w) / p.w).length()]
            };
            integrate(&speed, (0.0, 1.0), AGREE).0[0]
        };
        self.curve.iter().map(|span| of(&span.piece)).sum()
    }
}

#[cfg(test)]
mod tests;
