//! Splines with interior knots repeated more often than the degree: they may break there.
//!
//! ```text
//!   degree 2, knots 0 0 0 1 1 1 2 2 2      points p0 p1 p2 │ p3 p4 p5
//!                                          p2 = p3: one point too many, taken out
//!                                          else:    two splines, 0 0 0 1 1 1 and 1 1 1 2 2 2
//! ```
//!
//! Equal points may have different weights. Weights of the points behind are then scaled, all by one factor, which moves
//! no point. Where a row of a surface would need several factors, the surface is two.

use crate::spline::Control;
use glam::DVec4;

/// Largest relative difference of factors along a row that is rounding.
const EVEN: f64 = 1e-12;

/// A part of a spline: its knots, and for each knot step the control points that go with it (one for a
/// curve, a row for a surface).
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Part {
    pub knots: Vec<f64>,
    pub rows: Vec<Vec<DVec4>>,
}

/// The parts between breaks, and the largest gap in mm that was closed. Ends within `tolerance` mm of one another are
/// joined: the first one counts. A spline without such knots, or an invalid one, comes back unchanged.
pub(super) fn mend(degree: usize, part: Part, tolerance: f64) -> (Vec<Part>, f64) {
    let (mut parts, mut closed) = (Vec::new(), 0f64);
    let mut rest = part;
    while let Some((first, count)) = tear(degree, &rest) {
        let after = first + count - degree - 1;
        let ends = || rest.rows[first - 1].iter().zip(&rest.rows[after]);
        let gap = ends().map(|(p, q)| p.point().distance(q.point())).fold(0.0, f64::max);
        let factor = even(ends().map(|(p, q)| p.w / q.w)).filter(|_| gap <= tolerance);
        if let Some(factor) = factor {
            closed = closed.max(gap);
            rest.rows.drain(first..=after);
            rest.rows[first..].iter_mut().flatten().for_each(|p| *p *= factor);
            rest.knots.drain(first..first + count - degree);
        } else {
            let next = Part { knots: rest.knots[after..].to_vec(), rows: rest.rows[after..].to_vec() };
            rest.rows.truncate(first);
            rest.knots.truncate(first + degree + 1);
            parts.push(std::mem::replace(&mut rest, next));
        }
    }
    parts.push(rest);
    (parts, closed)
}

/// The one value that all factors have; `None` where they differ, or where one is not positive.
fn even(factors: impl Iterator<Item = f64>) -> Option<f64> {
    let (low, high) = factors.fold((f64::INFINITY, 0.0), |(low, high), f| (f.min(low), f.max(high)));
    (low > 0.0 && low.is_finite() && high.is_finite() && high - low <= EVEN * high).then_some(low)
}

/// The first interior knot repeated more often than the degree: where its run begins, and how long it is.
fn tear(degree: usize, part: &Part) -> Option<(usize, usize)> {
    let Part { knots, rows } = part;
    if degree == 0 || rows.len() <= degree || knots.len() != rows.len() + degree + 1 {
        return None;
    }
    let (a, b) = (knots[degree], knots[rows.len()]);
    let mut at = 0;
    for run in knots.chunk_by(|x, y| x == y) {
        if run[0] > a && run[0] < b && run.len() > degree {
            return Some((at, run.len()));
        }
        at += run.len();
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(knots: &[f64], xs: &[f64]) -> Part {
        Part { knots: knots.to_vec(), rows: xs.iter().map(|x| vec![DVec4::new(*x, 0.0, 0.0, 1.0)]).collect() }
    }

    #[test]
    fn touching_ends_are_one_point() {
        let torn = part(&[0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0], &[0.0, 1.0, 2.0, 2.0, 3.0, 4.0]);
        let whole = part(&[0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0], &[0.0, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!(mend(2, torn, 1e-6), (vec![whole.clone()], 0.0));
        assert_eq!(mend(2, whole.clone(), 1e-6), (vec![whole], 0.0));
    }

    #[test]
    fn parts_that_do_not_touch_are_two() {
        let torn = part(&[0.0, 0.0, 1.0, 1.0, 2.0, 2.0], &[0.0, 1.0, 9.0, 5.0]);
        let [left, right] = [part(&[0.0, 0.0, 1.0, 1.0], &[0.0, 1.0]), part(&[1.0, 1.0, 2.0, 2.0], &[9.0, 5.0])];
        assert_eq!(mend(1, torn, 1e-6), (vec![left.clone(), right.clone()], 0.0));
        // a third knot: the point between the parts belongs to neither
        let spare = part(&[0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 2.0], &[0.0, 1.0, 7.0, 9.0, 5.0]);
        assert_eq!(mend(1, spare, 1e-6), (vec![left, right], 0.0));
    }

    /// Half a circle of two quarters, the second with all its weights three times as large: the joint is a point of it.
    #[test]
    fn weights_behind_a_joint_are_scaled() {
        let knots = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0];
        let (corner, side) = (0.5f64.sqrt(), 3.0);
        let row = |x: f64, y: f64, w: f64| vec![DVec4::from_point(glam::DVec3::new(x, y, 0.0), w)];
        let quarters = [(1.0, 0.0, 1.0), (1.0, 1.0, corner), (0.0, 1.0, 1.0)];
        let second = [(0.0, 1.0, side), (-1.0, 1.0, side * corner), (-1.0, 0.0, side)];
        let rows: Vec<_> = quarters.into_iter().chain(second).map(|(x, y, w)| row(x, y, w)).collect();
        let (parts, closed) = mend(2, Part { knots: knots.to_vec(), rows: rows.clone() }, 1e-6);
        let [half] = &parts[..] else { panic!("{parts:?}") };
        assert_eq!((half.rows.len(), half.knots.len(), closed), (5, 8, 0.0));
        let points = half.rows.iter().flatten().copied().collect();
        let curve = crate::spline::BSpline::new(2, half.knots.clone(), points).unwrap();
        for k in 0..=40 {
            let p = curve.point(f64::from(k) / 20.0);
            assert!((p.length() - 1.0).abs() < 1e-14 && (k <= 20) == (p.x > -1e-15), "{k}: {p}");
        }
        // a row whose points need two factors
        let wide = |(i, r): (usize, Vec<DVec4>)| vec![r[0], if i < 3 { r[0] } else { r[0] * 2.0 }];
        let wide = Part { knots: knots.to_vec(), rows: rows.into_iter().enumerate().map(wide).collect() };
        let (parts, closed) = mend(2, wide.clone(), 1e-6);
        assert_eq!((parts.len(), closed), (2, 0.0));
        assert_eq!([&parts[0].rows[..], &parts[1].rows[..]].concat(), wide.rows);
        // a weight of 0 is no point
        let mut none = part(&knots, &[0.0, 1.0, 2.0, 2.0, 3.0, 4.0]);
        none.rows[3][0] = DVec4::ZERO;
        assert_eq!(mend(2, none, 1e-6).0.len(), 2);
    }

    #[test]
    fn what_is_no_spline_is_left_to_its_checks() {
        let short = part(&[0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 2.0], &[0.0, 1.0]);
        assert_eq!(mend(1, short.clone(), 1e-6), (vec![short], 0.0));
    }
}
