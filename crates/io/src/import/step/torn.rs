//! Splines with interior knots repeated more often than the degree: they may break there.
//!
//! ```text
//!   degree 2, knots 0 0 0 1 1 1 2 2 2      points p0 p1 p2 │ p3 p4 p5
//!                                          p2 = p3: one point too many, taken out
//!                                          else:    two splines, 0 0 0 1 1 1 and 1 1 1 2 2 2
//! ```

use crate::spline::Control;
use glam::DVec4;

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
        let ends = rest.rows[first - 1].iter().zip(&rest.rows[after]);
        let gap = ends.map(|(p, q)| p.point().distance(q.point())).fold(0.0, f64::max);
        if gap <= tolerance {
            closed = closed.max(gap);
            rest.rows.drain(first..=after);
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

    #[test]
    fn what_is_no_spline_is_left_to_its_checks() {
        let short = part(&[0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 2.0], &[0.0, 1.0]);
        assert_eq!(mend(1, short.clone(), 1e-6), (vec![short], 0.0));
    }
}
