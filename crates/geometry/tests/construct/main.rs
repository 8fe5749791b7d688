//! Surfaces made from curves: the points and curves that they pass through, their errors, and refused input.
//!
//! `tools/random_cases` runs 10,000 random cases of each; see [`cases`].

mod degenerate;
mod errors;
mod exact;
mod offsets;
mod projected;
mod skins;
mod solids;
mod subdivision;
mod sweeps;

use glam::{DVec2, DVec3, DVec4};
use proptest::prelude::*;
use selvedge_geometry::spline::{BSpline, Control, Surface};

/// Rounding of an exact construction, of the size.
pub const EXACT: f64 = 1e-12;

/// As many random cases as the variable `PROPTEST_CASES` says, or `few`.
pub fn cases(few: u32) -> ProptestConfig {
    let cases = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(few);
    ProptestConfig { cases, max_global_rejects: 100 * cases, ..ProptestConfig::default() }
}

/// A clamped knot vector over a random domain: interior knots of any multiplicity below the degree.
pub fn knots(degree: usize) -> impl Strategy<Value = Vec<f64>> {
    let interior = prop::collection::vec((0.1..1.0f64, 1..=degree.max(2) - 1), 0..4);
    (-2.0..2.0f64, interior).prop_map(move |(start, interior)| {
        let mut knots = vec![start; degree + 1];
        let mut at = start;
        for (gap, multiplicity) in interior {
            at += gap;
            knots.extend(std::iter::repeat_n(at, multiplicity));
        }
        knots.extend(std::iter::repeat_n(at + 0.5, degree + 1));
        knots
    })
}

/// A curve of degree 1 to `max` in a box of side 2, its weights from `weights`, or all 1.
pub fn curve(max: usize, weights: std::ops::Range<f64>) -> impl Strategy<Value = BSpline<DVec4>> {
    ((1..=max), any::<bool>()).prop_flat_map(|(p, r)| (Just(p), knots(p), Just(r))).prop_flat_map(
        move |(degree, knots, rational)| {
            let weight = if rational { weights.clone() } else { 1.0..1.000_000_000_000_001 };
            let point = (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64, weight);
            prop::collection::vec(point, knots.len() - degree - 1).prop_map(move |points| {
                let one = |w: f64| if rational { w } else { 1.0 };
                let points = points.iter().map(|&(x, y, z, w)| DVec4::from_point(DVec3::new(x, y, z), one(w)));
                BSpline::new(degree, knots.clone(), points.collect()).expect("valid by construction")
            })
        },
    )
}

/// A polyline.
pub fn line(points: &[DVec3]) -> BSpline<DVec4> {
    let n = points.len();
    let knots = [0].into_iter().chain(0..n).chain([n - 1]).map(|k| k as f64).collect();
    BSpline::new(1, knots, points.iter().map(|p| DVec4::from_point(*p, 1.0)).collect()).unwrap()
}

/// A planar polyline.
pub fn planar(points: &[(f64, f64)]) -> BSpline<DVec3> {
    let n = points.len();
    let knots = [0].into_iter().chain(0..n).chain([n - 1]).map(|k| k as f64).collect();
    let homogeneous = |&(x, y): &(f64, f64)| DVec3::from_point(DVec2::new(x, y), 1.0);
    BSpline::new(1, knots, points.iter().map(homogeneous).collect()).unwrap()
}

/// The point at a fraction of the domain.
pub fn at(c: &BSpline<DVec4>, f: f64) -> DVec3 {
    let (a, b) = c.domain();
    c.point(if f == 1.0 { b } else { a + (b - a) * f })
}

/// Points of a surface at fractions of its domain.
pub fn points(s: &Surface) -> impl Fn(f64, f64) -> DVec3 + use<> {
    let grid = s.patches();
    let ((u0, u1), (v0, v1)) = s.domain();
    move |u, v| grid.point(u0 + (u1 - u0) * u, v0 + (v1 - v0) * v)
}

/// Fractions from 0 to 1.
pub fn fractions(n: u32) -> impl Iterator<Item = f64> + Clone {
    (0..=n).map(move |i| f64::from(i) / f64::from(n))
}
