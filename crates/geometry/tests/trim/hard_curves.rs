//! Hard cases of number and form: many loops, high degree, wild weights, degenerate curves.

use crate::check::{down, expect, expect_winding, table_at, up};
use crate::shapes::{at, circle, closed, curve, polygon, rational, rectangle};
use selvedge_geometry::model::TrimLoop;
use selvedge_geometry::spline::{BSpline, Bezier};
use selvedge_geometry::trim::{LoopIndex, RectSide, TrimTable};
use std::slice::from_ref;

// 7: many and tiny

#[test]
fn ten_thousand_holes() {
    let mut loops = vec![rectangle((0.0, 0.0), (100.0, 100.0))];
    for i in 0..100 {
        for j in 0..100 {
            let (u, v) = (f64::from(i), f64::from(j));
            loops.push(rectangle((u + 0.25, v + 0.25), (u + 0.75, v + 0.75)).reversed());
        }
    }
    let index = LoopIndex::new(&loops);
    for i in 0..100 {
        for j in 0..100 {
            let (u, v) = (f64::from(i), f64::from(j));
            assert_eq!(index.winding(at(u + 0.5, v + 0.5)), 0);
            assert_eq!(index.winding(at(u + 0.125, v + 0.5)), 1);
            assert_eq!(index.winding(at(u + 0.5, v + 0.25)), 1); // bottom of the hole: still face
            assert_eq!(index.winding(at(u + 0.5, v + 0.75)), 0);
        }
    }
    assert_eq!(index.classify(at(41.3, 56.3), at(41.7, 56.7)), RectSide::Outside);
    assert_eq!(index.classify(at(41.8, 56.8), at(42.2, 57.2)), RectSide::Inside);
    assert_eq!(table_at(&loops, 50.5).row(0).len(), 202);
}

#[test]
fn comb_with_ten_thousand_intercepts_on_a_row() {
    let teeth = 5000;
    let mut corners = Vec::new();
    for i in 0..teeth {
        let u = f64::from(2 * i);
        corners.extend([(u, 2.0), (u, 1.0), (u + 1.0, 1.0), (u + 1.0, 2.0)].map(|(u, v)| (u, 3.0 - v)));
    }
    corners.extend([(2.0 * f64::from(teeth), 1.0), (2.0 * f64::from(teeth), 0.0), (0.0, 0.0)]);
    let comb = [polygon(&corners).reversed()];
    let table = table_at(&comb, 1.5);
    assert_eq!(table.row(0).len(), 2 * teeth as usize);
    let index = LoopIndex::new(&comb);
    for i in 0..2 * teeth {
        let u = f64::from(i) + 0.5;
        assert_eq!((index.contains(at(u, 1.5)), table.contains(u, 1.5)), (i % 2 == 0, i % 2 == 0), "{u}");
    }
}

#[test]
fn slit_thinner_than_a_cell() {
    let slit = [rectangle((0.0, 0.0), (1.0, 1.0)), rectangle((0.25, 0.5), (0.75, 0.5 + 1e-9)).reversed()];
    expect_winding(&slit, &[(0.5, 0.5, 1), (0.5, up(0.5), 0), (0.5, 0.5 + 1e-9, 0), (0.5, up(0.5 + 1e-9), 1)]);
    let table = TrimTable::new(&slit, (0.0, 1.0), &[4], |_| 1);
    assert!(table.contains(0.5, 0.5 + 5e-10)); // between two scan lines it is not seen
}

// 8: high degree, wild weights

/// Inside, outside and within 1e-13 of the unit circle, all around.
fn expect_unit_circle(shape: &[TrimLoop], winding: i32) {
    let index = LoopIndex::new(shape);
    for i in 0..360 {
        let (sin, cos) = f64::from(i).to_radians().sin_cos();
        for (radius, expected) in [(0.5, winding), (1.0 - 1e-13, winding), (1.0 + 1e-13, 0), (1.5, 0)] {
            assert_eq!(index.winding(at(cos, sin) * radius), expected, "{i}° at {radius}");
        }
    }
}

#[test]
fn circle_of_degree_five() {
    let fifth = 0.2;
    let points = [(0., -1., 1.), (4., -1., fifth), (2., 3., fifth), (-2., 3., fifth), (-4., -1., fifth), (0., -1., 1.)];
    expect_unit_circle(&[closed(vec![rational(&points)])], 1);
}

#[test]
fn circle_elevated_to_degree_fifteen() {
    let raise = |c: Bezier<_>| (2..15).fold(c, |c, _| c.elevated());
    let arcs: Vec<_> = circle(at(0.0, 0.0), 1.0).curves().map(raise).collect();
    assert_eq!(arcs[0].degree(), 15);
    expect_unit_circle(&[closed(arcs)], 1);
}

#[test]
fn weight_ratio_of_a_million() {
    // w_i c^i draws the same arc with other speed: weights from 1e-3 to 1e3
    let bend = |mut c: Bezier<glam::DVec3>| {
        c.points[0] *= 1e-3;
        c.points[2] *= 1e3;
        c
    };
    let arcs: Vec<_> = circle(at(0.0, 0.0), 1.0).curves().map(bend).collect();
    expect_unit_circle(&[TrimLoop::new(arcs, glam::DVec2::splat(1e-15)).unwrap().reversed()], -1);
}

// 9: degenerate representations

#[test]
fn zero_length_curves_and_repeated_control_points() {
    let shape = closed(vec![
        curve(&[(0.0, 0.0), (0.0, 0.0), (1.0, 0.0), (1.0, 0.0)]),
        curve(&[(1.0, 0.0), (1.0, 0.0)]),
        curve(&[(1.0, 0.0), (1.0, 1.0), (1.0, 1.0)]),
        rational(&[(1.0, 1.0, 1.0), (1.0, 1.0, 0.125), (1.0, 1.0, 8.0)]),
        curve(&[(1.0, 1.0), (0.0, 1.0), (0.0, 0.0)]),
    ]);
    // the last curve is a parabola: u = (1 - t)², v = 1 - t²
    expect(
        &[shape],
        &[(0.5, 0.5, 1), (0.5, 0.0, 0), (0.125, 0.125, 1), (0.125, 0.875, 0), (0.75, 0.96875, 1), (0.75, 0.99, 0)],
    );
}

#[test]
fn lines_stored_as_cubics_are_exact() {
    let cubic = |a: (f64, f64), b: (f64, f64)| {
        let along = |t: f64| (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
        curve(&[a, along(0.25), along(0.875), b])
    };
    let corners = [(1.0, 0.0), (2.0, 1.0), (1.0, 2.0), (0.0, 1.0)];
    let diamond = closed((0..4).map(|i| cubic(corners[i], corners[(i + 1) % 4])).collect());
    expect_winding(
        &[diamond],
        &[
            (down(0.5), 0.5, 0),
            (0.5, 0.5, 1),
            (0.5, down(0.5), 0),
            (1.5, 0.5, 0),
            (down(1.5), 0.5, 1),
            (1.5, up(0.5), 1),
        ],
    );
}

#[test]
fn knot_span_of_a_billionth() {
    let points = [(2.0, 0.0), (2.0, 1.0), (1.0, 1.5), (0.0, 1.0), (0.0, 0.0)];
    let points = points.map(|(u, v)| glam::DVec3::new(u, v, 1.0)).to_vec();
    let spline = BSpline::new(2, vec![0.0, 0.0, 0.0, 0.5, 0.5 + 1e-9, 1.0, 1.0, 1.0], points).unwrap();
    let mut curves: Vec<_> = spline.beziers().into_iter().map(|s| s.piece).collect();
    assert_eq!(curves.len(), 3);
    curves.push(curve(&[(0.0, 0.0), (2.0, 0.0)]));
    let shape = [closed(curves)];
    let index = LoopIndex::new(&shape);
    for i in 1..1000 {
        let t = f64::from(i) / 1000.0;
        let p = spline.point(t);
        let inner = at(1.0, 0.5) - p;
        let step = inner / inner.length() * 1e-12;
        assert_eq!((index.winding(p + step), index.winding(p - step)), (1, 0), "t = {t}");
    }
    expect(&shape, &[(1.0, 1.0, 1), (1.0, 1.5, 0)]);
}

#[test]
fn weights_that_break_the_bits_of_a_vertex() {
    // (u w) / w is not u for these weights: the chain must be closed all the same
    let points = [(0.1, 0.0), (0.9, 0.3), (0.7, 0.9), (0.2, 0.7)];
    let sides = (0..4).map(|i| {
        let (a, b) = (points[i], points[(i + 1) % 4]);
        rational(&[(a.0, a.1, 0.1 + 0.7 * i as f64), (b.0, b.1, 0.3 + 0.9 * i as f64)])
    });
    let index = LoopIndex::new(&[closed(sides.collect())]);
    for (_, v) in points {
        for v in [down(down(v)), down(v), v, up(v), up(up(v))] {
            assert_eq!((index.winding(at(-1.0, v)), index.winding(at(2.0, v))), (0, 0), "v = {v}");
        }
    }
    assert_eq!(index.winding(at(0.5, 0.5)), 1);
}

// 10: gaps, orientation, order, borders

#[test]
fn small_gaps_are_closed_and_large_ones_refused() {
    let open = |gap: f64| {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let sides = (0..4).map(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % 4]);
            curve(&[(a.0, a.1 + gap), b])
        });
        TrimLoop::new(sides.collect(), glam::DVec2::splat(1e-5))
    };
    let snapped = open(1e-6).unwrap();
    expect_winding(&[snapped], &[(-1.0, 5e-7, 0), (-1.0, 1.0, 0), (0.5, 0.5, 1), (2.0, 1.0 + 5e-7, 0)]);
    assert!(open(1e-3).is_err());
}

#[test]
fn orientation_and_order_of_loops_do_not_matter_to_membership() {
    let outer = rectangle((0.0, 0.0), (4.0, 4.0));
    let hole = circle(at(2.0, 2.0), 1.0).reversed();
    let rows = [(0.5, 2.0, 1), (2.0, 2.0, 0), (3.5, 2.0, 1), (5.0, 2.0, 0)];
    expect(&[hole.clone(), outer.clone()], &rows);
    expect(&[hole.reversed(), outer.reversed()], &rows.map(|(u, v, w)| (u, v, -w)));
}

#[test]
fn no_loop_keeps_the_whole_domain() {
    let index = LoopIndex::new(&[]);
    assert!(index.contains(at(0.3, 0.7)));
    assert_eq!(index.classify(at(0.0, 0.0), at(1.0, 1.0)), RectSide::Inside);
    assert_eq!(index.distance(at(0.0, 0.0), 9.0), 9.0);
    assert!(TrimTable::new(&[], (0.0, 1.0), &[3, 0], |_| 1).contains(0.3, 0.7));
}

#[test]
fn a_loop_of_no_extent_keeps_nothing() {
    let point = closed(vec![curve(&[(0.5, 0.5), (0.5, 0.5)])]);
    let line = polygon(&[(0.0, 0.0), (1.0, 1.0)]);
    expect(from_ref(&point), &[(0.5, 0.5, 0), (0.0, 0.5, 0)]);
    expect(&[line], &[(0.5, 0.5, 0), (down(0.5), 0.5, 0), (0.5, 1.0, 0)]);
    assert!(!LoopIndex::new(&[point]).contains(at(0.5, 0.5)));
}
