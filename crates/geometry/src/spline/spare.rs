//! Knots whose multiplicity exceeds the degree, in a spline that is one piece.
//!
//! ```text
//!   degree 2, knots ... 3 3 3 ...      before the knot the curve ends in P_l, behind it the curve begins in P_r
//!
//!        P_l == P_r   one point too many, and one knot: the same curve without them
//!        P_l != P_r   two curves: no spline
//! ```
//!
//! Writers that join pieces of curves and surfaces leave such knots. Points between `P_l` and `P_r`, of even higher
//! multiplicity, have no effect.
//!
//! Source: L. Piegl, W. Tiller, *The NURBS Book*, 2nd edition, 1997, section 2.2, property P2.3.

use std::ops::Range;

/// The points without effect, and as many knots from the same place on; `same` compares two points.
pub(super) fn spare(degree: usize, knots: &[f64], same: impl Fn(usize, usize) -> bool) -> Vec<Range<usize>> {
    let points = knots.len().saturating_sub(degree.saturating_add(1));
    if degree == 0 || points <= degree || !knots.is_sorted() {
        return Vec::new();
    }
    let (a, b) = (knots[degree], knots[points]);
    let mut out = Vec::new();
    let mut first = 0;
    for run in knots.chunk_by(|x, y| x == y) {
        // the first knot after the run belongs to the point on the far side
        let behind = first + run.len().saturating_sub(degree);
        if run.len() > degree && run[0] > a && run[0] < b && same(first - 1, behind - 1) {
            out.push(first..behind);
        }
        first += run.len();
    }
    out
}

/// The rest without the ranges, which ascend.
pub(super) fn without<T: Copy>(all: &[T], ranges: &[Range<usize>]) -> Vec<T> {
    let kept = |i: &usize| !ranges.iter().any(|r| r.contains(i));
    (0..all.len()).filter(kept).map(|i| all[i]).collect()
}

#[cfg(test)]
mod tests {
    use crate::spline::{BSpline, SplineError, Surface};
    use glam::DVec4;

    fn point(x: f64, y: f64) -> DVec4 {
        DVec4::new(x, y, 0.0, 1.0)
    }

    /// Two parabolas, and the point where they meet as often as the knot asks for.
    fn joined(times: usize, second: DVec4) -> Result<BSpline<DVec4>, SplineError> {
        let mut knots = vec![0.0; 3];
        knots.extend([3.0].repeat(times));
        knots.extend([5.0; 3]);
        let mut points = vec![point(0.0, 0.0), point(1.0, 2.0), point(2.0, 0.0)];
        points.extend([point(9.0, 9.0)].repeat(times - 3));
        points.extend([second, point(3.0, -2.0), point(4.0, 0.0)]);
        BSpline::new(2, knots, points)
    }

    #[test]
    fn a_point_stated_twice() {
        for times in 3..6 {
            let curve = joined(times, point(2.0, 0.0)).unwrap();
            assert_eq!((curve.points().len(), curve.knots().len()), (5, 8), "{times}");
            for (t, x, y) in [(0.0, 0.0, 0.0), (1.5, 1.0, 1.0), (3.0, 2.0, 0.0), (4.0, 3.0, -1.0), (5.0, 4.0, 0.0)] {
                assert!((curve.point(t) - glam::DVec3::new(x, y, 0.0)).length() < 1e-15, "{times}: {t}");
            }
        }
    }

    #[test]
    fn a_curve_that_is_torn() {
        let error = joined(3, point(2.0, 1e-9)).unwrap_err();
        assert_eq!(error, SplineError::Multiplicity { value: 3.0, multiplicity: 3, degree: 2 });
        // the same place with another weight is another point of the same space, and another curve
        let error = joined(4, point(2.0, 0.0) * 2.0).unwrap_err();
        assert_eq!(error, SplineError::Multiplicity { value: 3.0, multiplicity: 4, degree: 2 });
    }

    #[test]
    fn the_pieces_of_a_torn_curve() {
        // parabola, a gap of 1 upwards, parabola, a gap of 1 to the right, line
        let knots = [[0.0; 3], [3.0; 3], [5.0; 3], [6.0; 3]].concat();
        let points = [
            (0.0, 0.0),
            (1.0, 2.0),
            (2.0, 0.0),
            (2.0, 1.0),
            (3.0, -1.0),
            (4.0, 1.0),
            (5.0, 1.0),
            (6.0, 1.0),
            (7.0, 1.0),
        ];
        let points: Vec<DVec4> = points.into_iter().map(|(x, y)| point(x, y)).collect();
        let all = BSpline::pieces(2, knots.clone(), points.clone()).unwrap();
        let domains: Vec<_> = all.iter().map(BSpline::domain).collect();
        assert_eq!(domains, [(0.0, 3.0), (3.0, 5.0), (5.0, 6.0)]);
        for (i, t, x, y) in
            [(0, 1.5, 1.0, 1.0), (0, 3.0, 2.0, 0.0), (1, 3.0, 2.0, 1.0), (1, 4.0, 3.0, 0.0), (2, 5.5, 6.0, 1.0)]
        {
            assert!((all[i].point(t) - glam::DVec3::new(x, y, 0.0)).length() < 1e-15, "{i}: {t}");
        }
        // a whole curve is one piece, and other faults stay faults
        assert_eq!(BSpline::pieces(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], points[..3].to_vec()).unwrap().len(), 1);
        let mut turned = knots;
        turned[4] = 9.0;
        assert_eq!(BSpline::pieces(2, turned, points), Err(SplineError::KnotOrder { index: 5 }));
    }

    /// A sheet folded at u = 3, whose fold is stated twice; the same one with u and v exchanged.
    #[test]
    fn a_row_stated_twice() {
        let (ku, kv) = (vec![0.0, 0.0, 3.0, 3.0, 4.0, 4.0], vec![0.0, 0.0, 1.0, 1.0]);
        let row = |v: f64| [(0.0, 0.0), (3.0, 1.0), (3.0, 1.0), (4.0, 0.0)].map(|(x, z)| DVec4::new(x, v, z, 1.0));
        let net: Vec<DVec4> = [0.0, 7.0].into_iter().flat_map(row).collect();
        let sheet = Surface::new((1, 1), ku.clone(), kv.clone(), net.clone()).unwrap();
        assert_eq!(sheet.counts(), (3, 2));
        let turned: Vec<DVec4> = (0..4).flat_map(|i| [net[i], net[4 + i]]).collect();
        let turned = Surface::new((1, 1), kv.clone(), ku.clone(), turned).unwrap();
        assert_eq!(turned, sheet.transposed());
        for (u, z) in [(1.5, 0.5), (3.0, 1.0), (3.5, 0.5)] {
            assert_eq!(sheet.jet(u, 0.5).point, glam::DVec3::new(u, 3.5, z));
        }
        // one of the two rows is torn
        let mut torn = net;
        torn[6].z = 2.0;
        let error = Surface::new((1, 1), ku, kv, torn).unwrap_err();
        assert_eq!(error, SplineError::Multiplicity { value: 3.0, multiplicity: 2, degree: 1 });
    }
}
