//! A profile turned about an axis.
//!
//! ```text
//!       z
//!       │╲  profile (radius, height)       u: the angle, 0 along x, counter-clockwise from above
//!       │ ╲                                v: the profile's parameter
//!       │  │
//!       ●──╯   touches the axis: a pole
//!       └─────▶ x
//! ```

use super::ConstructError;
use crate::spline::arc::{pieces, revolve};
use crate::spline::{BSpline, Bezier, Control, Surface};
use glam::{DVec3, DVec4};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Share of the profile's size below which a radius is 0: a point meant to be on the axis becomes a pole.
const ON_AXIS: f64 = 1e-12;
/// Halvings in search of a point on the other side of the axis.
const MAX_DEPTH: u32 = 50;

/// The planar `profile` `(radius, height)` turned about `z` by `angle`, in radians: exact.
///
/// `u` is the angle, in rational quadratic pieces of at most a quarter turn; over a full turn the first and last
/// columns of the net are the same numbers. Points of the profile on the axis are poles. All radii may be negative:
/// the half plane opposite is turned.
///
/// # Errors
/// The angle is not in `(0, 2π]`; the profile crosses the axis, or lies on it.
pub fn lathe(profile: &BSpline<DVec3>, angle: f64) -> Result<Surface, ConstructError> {
    if !(angle > 0.0 && angle <= TAU * (1.0 + 1e-14)) {
        return Err(ConstructError::Range { what: "the angle of a lathe", value: angle, must: "in (0, 2 pi]" });
    }
    let extent = profile.points().iter().map(|p| p.point().abs().max_element()).fold(0.0, f64::max);
    let axis = ON_AXIS * extent;
    match (beyond(profile, 1.0, axis), beyond(profile, -1.0, axis)) {
        (None, None) => return Err(ConstructError::OnAxis),
        (Some(a), Some(b)) => return Err(ConstructError::CrossesAxis { parameter: a.max(b) }),
        _ => {}
    }
    let snapped = |p: &DVec3| {
        let radius = if (p.x / p.z).abs() <= axis { 0.0 } else { p.x };
        DVec4::new(radius, 0.0, p.y, p.z)
    };
    let points: Vec<DVec4> = profile.points().iter().map(snapped).collect();
    let angles = pieces(0.0, angle.min(TAU), FRAC_PI_2);
    Ok(revolve((profile.degree(), profile.knots().to_vec(), &points), (DVec3::ZERO, DVec3::Z), &angles)?)
}

/// A parameter at which `sign` times the radius is more than `axis`: the first that is found.
fn beyond(profile: &BSpline<DVec3>, sign: f64, axis: f64) -> Option<f64> {
    fn search(piece: &Bezier<DVec3>, outside: &impl Fn(DVec3) -> bool, depth: u32) -> Option<f64> {
        if !piece.points.iter().any(|p| outside(*p)) {
            return None;
        }
        let end = piece.points.len() - 1;
        if outside(piece.points[0]) {
            return Some(0.0);
        }
        if outside(piece.points[end]) {
            return Some(1.0);
        }
        if depth == 0 {
            return None;
        }
        let (left, right) = piece.split(0.5);
        let half = |t: f64, shift: f64| 0.5 * t + shift;
        search(&left, outside, depth - 1)
            .map(|t| half(t, 0.0))
            .or_else(|| search(&right, outside, depth - 1).map(|t| half(t, 0.5)))
    }
    let outside = |p: DVec3| sign * p.x > axis * p.z;
    let found = |s: &crate::spline::Span<Bezier<DVec3>>| {
        search(&s.piece, &outside, MAX_DEPTH).map(|t| s.start + (s.end - s.start) * t)
    };
    profile.beziers().iter().find_map(found)
}
