//! Loops to test with. `w u, w v, w` control points are written as Euclidean points and weights.

use glam::{DVec2, DVec3};
use selvedge_geometry::model::TrimLoop;
use selvedge_geometry::spline::{Bezier, Control};

/// A point.
pub fn at(u: f64, v: f64) -> DVec2 {
    DVec2::new(u, v)
}

/// A polynomial curve.
pub fn curve(points: &[(f64, f64)]) -> Bezier<DVec3> {
    Bezier { points: points.iter().map(|&(u, v)| DVec3::new(u, v, 1.0)).collect() }
}

/// A rational curve of `(u, v, weight)`.
pub fn rational(points: &[(f64, f64, f64)]) -> Bezier<DVec3> {
    Bezier { points: points.iter().map(|&(u, v, w)| DVec3::from_point(at(u, v), w)).collect() }
}

/// A loop that must close bit for bit.
pub fn closed(curves: Vec<Bezier<DVec3>>) -> TrimLoop {
    TrimLoop::new(curves, DVec2::splat(1e-15)).expect("the shape is closed")
}

/// A closed polygon through `corners`.
pub fn polygon(corners: &[(f64, f64)]) -> TrimLoop {
    let next = corners.iter().cycle().skip(1);
    closed(corners.iter().zip(next).map(|(&a, &b)| Bezier::line(a.into(), b.into())).collect())
}

/// A counter-clockwise rectangle.
pub fn rectangle(lo: (f64, f64), hi: (f64, f64)) -> TrimLoop {
    polygon(&[lo, (hi.0, lo.1), hi, (lo.0, hi.1)])
}

/// A counter-clockwise circle of four quadratic arcs.
pub fn circle(centre: DVec2, radius: f64) -> TrimLoop {
    let diagonal = std::f64::consts::FRAC_1_SQRT_2;
    let ring = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
    let point = |i: usize| centre + radius * at(f64::from(ring[i].0), f64::from(ring[i].1));
    let arc = |i: usize| {
        let weighted = [(i, 1.0), (i + 1, diagonal), (i + 2, 1.0)];
        Bezier { points: weighted.iter().map(|&(k, w)| DVec3::from_point(point(k), w)).collect() }
    };
    closed([0, 2, 4, 6].map(arc).to_vec())
}
