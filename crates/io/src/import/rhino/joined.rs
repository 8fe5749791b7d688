//! Splines that are joined of rational pieces: where weights differ at a joint, its knot is repeated once too often.
//!
//! ```text
//!   pieces of a profile ─▶ one curve: the joint twice, with the weight of either piece ─▶ turned surface, likewise
//! ```
//!
//! The decoder joins pieces so, and its turned surfaces have such a joint along a whole row.

use crate::import::torn::{Part, mend};
use crate::spline::{BSpline, SplineError, Surface};
use glam::DVec4;

/// Distance in millimetres up to which both ends at a joint are the same: rounding.
const MEET: f64 = 1e-9;

/// A curve.
pub(super) fn curve(degree: usize, knots: Vec<f64>, points: Vec<DVec4>) -> Result<BSpline<DVec4>, SplineError> {
    let torn = match BSpline::new(degree, knots.clone(), points.clone()) {
        Err(torn @ SplineError::Multiplicity { .. }) => torn,
        other => return other,
    };
    let rows = points.into_iter().map(|p| vec![p]).collect();
    let Some(whole) = whole(degree, Part { knots, rows }) else { return Err(torn) };
    BSpline::new(degree, whole.knots, whole.rows.into_iter().flatten().collect())
}

/// A surface; its net runs along `u` fastest.
pub(super) fn surface(
    degrees: (usize, usize),
    (knots_u, knots_v): (Vec<f64>, Vec<f64>),
    net: Vec<DVec4>,
) -> Result<Surface, SplineError> {
    let torn = match Surface::new(degrees, knots_u.clone(), knots_v.clone(), net.clone()) {
        Err(torn @ SplineError::Multiplicity { .. }) => torn,
        other => return other,
    };
    let count_u = knots_u.len().saturating_sub(degrees.0 + 1);
    if net.is_empty() || count_u == 0 || !net.len().is_multiple_of(count_u) {
        return Err(torn);
    }
    let columns = (0..count_u).map(|i| net[i..].iter().step_by(count_u).copied().collect()).collect();
    let Some(along_u) = whole(degrees.0, Part { knots: knots_u, rows: columns }) else { return Err(torn) };
    let rows = (0..net.len() / count_u).map(|k| along_u.rows.iter().map(|column| column[k]).collect()).collect();
    let Some(along_v) = whole(degrees.1, Part { knots: knots_v, rows }) else { return Err(torn) };
    Surface::new(degrees, along_u.knots, along_v.knots, along_v.rows.into_iter().flatten().collect())
}

/// The spline, if it is one piece.
fn whole(degree: usize, part: Part) -> Option<Part> {
    let (mut parts, _) = mend(degree, part, MEET);
    let last = parts.pop()?;
    parts.is_empty().then_some(last)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spline::Control;
    use glam::DVec3;

    /// Half a circle of radius 5 in the plane y = 0, of two quarters; the second has other weights.
    fn profile(gap: f64, side: f64) -> (Vec<f64>, Vec<DVec4>) {
        let corner = 0.5f64.sqrt();
        let first = [(0.0, -5.0, 1.0), (5.0, -5.0, corner), (5.0, 0.0, 1.0)];
        let second = [(5.0 + gap, 0.0, side), (5.0, 5.0, side * corner), (0.0, 5.0, side)];
        let point = |(x, z, w): (f64, f64, f64)| DVec4::from_point(DVec3::new(x, 0.0, z), w);
        ([[0.0; 3], [1.0; 3], [3.0; 3]].concat(), first.into_iter().chain(second).map(point).collect())
    }

    /// A quarter turn of the profile about the z axis, and its knots along `u` and `v`.
    fn turned((knots, points): (Vec<f64>, Vec<DVec4>)) -> ((Vec<f64>, Vec<f64>), Vec<DVec4>) {
        let corner = 0.5f64.sqrt();
        let arm = [(1.0, 0.0, 1.0), (1.0, 1.0, corner), (0.0, 1.0, 1.0)];
        let at = |p: &DVec4, (x, y, w): (f64, f64, f64)| DVec4::new(p.x * x * w, p.x * y * w, p.z * w, p.w * w);
        let net = points.iter().flat_map(|p| arm.map(|a| at(p, a))).collect();
        ((vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], knots), net)
    }

    #[test]
    fn a_turned_profile_of_pieces_is_one_surface() {
        for side in [1.0, 0.4] {
            let (knots, points) = profile(0.0, side);
            let arc = curve(2, knots, points).unwrap();
            assert_eq!((arc.points().len(), arc.domain()), (5, (0.0, 3.0)));
            let (knots, net) = turned(profile(0.0, side));
            let ball = surface((2, 2), knots.clone(), net.clone()).unwrap();
            let sideways: Vec<DVec4> = (0..3).flat_map(|i| (0..6).map(move |k| 3 * k + i)).map(|k| net[k]).collect();
            let other = surface((2, 2), (knots.1, knots.0), sideways).unwrap();
            assert_eq!((ball.counts(), other.counts()), ((3, 5), (5, 3)));
            let (grid, turned) = (ball.patches(), other.patches());
            for k in 0..=30 {
                let (u, v) = (f64::from(k % 7) / 6.0, f64::from(k) / 10.0);
                let points = [arc.point(v), grid.point(u, v), turned.point(v, u)];
                assert!(points.iter().all(|p| (p.length() - 5.0).abs() < 1e-14), "{v}: {points:?}");
                assert!(points[1].distance(points[2]) < 1e-14 && (points[0].z - points[1].z).abs() < 1e-14, "{v}");
            }
        }
    }

    #[test]
    fn pieces_that_do_not_meet_are_refused() {
        let torn = SplineError::Multiplicity { value: 1.0, multiplicity: 3, degree: 2 };
        let (knots, points) = profile(1e-6, 0.4);
        assert_eq!(curve(2, knots, points).unwrap_err(), torn);
        let (knots, net) = turned(profile(1e-6, 0.4));
        assert_eq!(surface((2, 2), knots, net).unwrap_err(), torn);
        // a net that does not fit its knots
        let (knots, mut net) = turned(profile(0.0, 0.4));
        net.pop();
        assert!(surface((2, 2), knots.clone(), net).is_err());
        assert!(surface((2, 2), knots, Vec::new()).is_err());
    }
}
