//! The number of chords that a rational Bézier curve needs: guaranteed, in arithmetic that a shader repeats.
//!
//! A chord of the curve is the image of the linear interpolant of the *homogeneous* curve
//! `(X, Y, W)`. Let `q` be its abscissa at parameter `t` and `L = X - q W`. The interpolant of `L`
//! vanishes at `t`, and `L = W (x - q)`, so with `s` equal parts of `[0, 1]`
//!
//! ```text
//!               |L''| / s²     n (n - 1)  max_i |Δ² w_i (x_i - q)|
//!   |x - q|  ≤  ──────────  ≤  ────────────────────────────────────
//!                  8 W                   8 s² W_min
//! ```
//!
//! The right side is convex in `q`, which lies between the smallest and the largest `x_i`: its
//! maximum is at one of the two. The same for `y`; both hold at the same `t`, so the point is within
//! the hypotenuse of the two bounds of the chord.
//!
//! Source: D. Filip, R. Magedson, R. Markot, *Surface algorithms using bounds on derivatives*, 1986,
//! carried to the homogeneous curve.

use crate::spline::{Bezier, Control};
use glam::{DVec2, DVec3};

/// Number of equal-parameter chords that keep every point of `curve` within `eps` of its chord, with
/// `u` measured in units of `1 / scale.x` and `v` in units of `1 / scale.y`.
///
/// `eps` must be positive; the count saturates at `u32::MAX`. 1 for a straight line in its natural
/// parametrisation. A parabola attains the bound; `W_min` makes it loose where weights differ much.
pub fn segment_count(curve: &Bezier<DVec3>, scale: DVec2, eps: f64) -> u32 {
    ((chord_bend(curve) * scale).length() / eps).sqrt().ceil().max(1.0) as u32
}

/// With `s` equal-parameter chords, `curve` stays within `chord_bend / s²` of them, in `u` and in `v`.
pub fn chord_bend(curve: &Bezier<DVec3>) -> DVec2 {
    let n = curve.degree() as f64;
    let least_weight = curve.points.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    let bend = DVec2::new(second_difference(curve, |p| p.x), second_difference(curve, |p| p.y));
    bend * (n * (n - 1.0) / (8.0 * least_weight))
}

/// `max |Δ² w_i (x_i - q)|` over the control points and over `q` in `{min x_i, max x_i}`.
fn second_difference(curve: &Bezier<DVec3>, axis: impl Fn(DVec2) -> f64) -> f64 {
    let x = |p: &DVec3| axis(p.point());
    let lo = curve.points.iter().map(x).fold(f64::INFINITY, f64::min);
    let hi = curve.points.iter().map(x).fold(f64::NEG_INFINITY, f64::max);
    let at = |q: f64| {
        let l = |p: &DVec3| p.z * (x(p) - q);
        curve.points.windows(3).map(|w| (l(&w[0]) - 2.0 * l(&w[1]) + l(&w[2])).abs()).fold(0.0, f64::max)
    };
    at(lo).max(at(hi))
}

/// The `segments + 1` points of `curve` at equal parameters; both ends are the curve's own.
pub fn polyline(curve: &Bezier<DVec3>, segments: u32) -> impl Iterator<Item = DVec2> + '_ {
    let segments = segments.max(1);
    (0..=segments).map(move |i| curve.point(f64::from(i) / f64::from(segments)))
}
