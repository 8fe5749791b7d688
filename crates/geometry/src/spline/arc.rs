//! Circular arcs and surfaces of revolution as rational quadratics, exactly.
//!
//! ```text
//!           top: weight cos h, where the end tangents meet
//!            ╱╲
//!        ╱        ╲           an arc of width 2 h <= 90 degrees
//!     P ·── arc ───· P'       weights (1, cos h, 1)
//!     angle a      angle b
//! ```
//!
//! Source: L. Piegl, W. Tiller, *The NURBS Book*, 1997, sections 7.3 and 8.5.

use super::{Bezier, Control, Span, SplineError, Surface};
use glam::{DVec3, DVec4};
use std::f64::consts::{FRAC_PI_2, TAU};

/// `(sin x, cos x)`, exact at multiples of a quarter turn, so that poles and seams meet bit for bit.
pub fn sin_cos(x: f64) -> (f64, f64) {
    let quarters = x / FRAC_PI_2;
    let nearest = quarters.round();
    if (quarters - nearest).abs() > 1e-15 * quarters.abs().max(1.0) {
        return x.sin_cos();
    }
    match nearest.rem_euclid(4.0) as u8 {
        0 => (0.0, 1.0),
        1 => (1.0, 0.0),
        2 => (0.0, -1.0),
        _ => (-1.0, 0.0),
    }
}

/// Ends of equal pieces of `[lo, hi]`, none wider than `widest` (beyond a rounding of `1e-9` of it).
pub fn pieces(lo: f64, hi: f64, widest: f64) -> Vec<f64> {
    let count = ((hi - lo) / widest - 1e-9).ceil().max(1.0) as usize;
    let mut knots: Vec<f64> = (0..count).map(|i| lo + (hi - lo) * (i as f64 / count as f64)).collect();
    knots.push(hi);
    knots
}

/// `centre + cos t x + sin t y` over `[a, b]`, less than half a turn, as one rational quadratic.
pub fn arc(centre: DVec3, x: DVec3, y: DVec3, a: f64, b: f64) -> Bezier<DVec4> {
    let at = |t: f64, weight: f64| {
        let (s, c) = sin_cos(t);
        (centre * weight + x * c + y * s).extend(weight)
    };
    let half = 0.5 * (b - a);
    let top = at(0.5 * (a + b), half.cos());
    Bezier { points: vec![at(a, 1.0), top, at(b, 1.0)] }
}

/// A profile turned about the axis through `origin` along the unit vector `axis`: `u` is the angle, with double
/// knots at `angles` (ends of pieces, each at most a quarter turn), `v` the profile's parameter.
///
/// Accuracy: rounding, below `1e-14` of the distance to `origin`. Over a full turn the first and last columns of the
/// net are the same numbers; a control point on the axis (within `1e-15` of the farthest one's distance to
/// `origin`) becomes a pole.
///
/// # Errors
/// The profile's knots do not fit its points.
pub fn revolve(
    (degree, knots, profile): (usize, Vec<f64>, &[DVec4]),
    (origin, axis): (DVec3, DVec3),
    angles: &[f64],
) -> Result<Surface, SplineError> {
    let arm = |p: &DVec4| p.truncate() - origin * p.w;
    let reach = profile.iter().map(|p| arm(p).length()).fold(0.0, f64::max);
    let (first_angle, last_angle) = (angles[0], angles[angles.len() - 1]);
    let full = (last_angle - first_angle - TAU).abs() <= 1e-12;
    let mut points = Vec::with_capacity(profile.len() * (2 * angles.len() - 1));
    for p in profile {
        let axial = axis * arm(p).dot(axis);
        let mut radial = arm(p) - axial;
        if radial.length() <= 1e-15 * reach {
            radial = DVec3::ZERO; // a pole: one point, not a circle of rounding errors
        }
        let across = axis.cross(radial);
        let centre = origin * p.w + axial;
        // weight w is that of the point (centre + spoke / w): on the circle for w = 1, where the end tangents meet for
        // w = cos h
        let at = |angle: f64, w: f64| {
            let (s, c) = sin_cos(angle);
            (centre * w + radial * c + across * s).extend(p.w * w)
        };
        let first = at(first_angle, 1.0);
        points.push(first);
        for (i, k) in angles.windows(2).enumerate() {
            points.push(at(0.5 * (k[0] + k[1]), (0.5 * (k[1] - k[0])).cos()));
            points.push(if full && i + 2 == angles.len() { first } else { at(k[1], 1.0) });
        }
    }
    let knots_u = [first_angle].into_iter().chain(angles.iter().flat_map(|k| [*k, *k])).chain([last_angle]).collect();
    Surface::new((2, degree), knots_u, knots, points)
}

/// Pieces as one spline: a common degree, weights scaled so that neighbours share their joint bit for bit (the
/// earlier piece's end is taken). Returns the degree, the knot vector and the control points. `spans` is not empty.
pub fn assemble<P: Control>(spans: &[Span<Bezier<P>>]) -> (usize, Vec<f64>, Vec<P>) {
    let degree = spans.iter().map(|s| s.piece.degree()).max().unwrap_or(1);
    let mut knots = vec![spans[0].start; degree + 1];
    let mut points: Vec<P> = Vec::new();
    for s in spans {
        let mut piece = s.piece.clone();
        while piece.degree() < degree {
            piece = piece.elevated();
        }
        if let Some(last) = points.last().copied() {
            let scale = last.weight() / piece.points[0].weight();
            points.extend(piece.points[1..].iter().map(|p| *p * scale));
        } else {
            points = piece.points;
        }
        knots.extend([s.end].repeat(degree));
    }
    knots.push(spans[spans.len() - 1].end);
    (degree, knots, points)
}
