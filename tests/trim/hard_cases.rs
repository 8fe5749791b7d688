//! Numerical hard cases of trim domains, each a tiny shape whose answer is known by hand.
//!
//! A row `(u, v, w)` states the winding number `w` at `(u, v)`. Every row is put to the exact index
//! and to a table with a scan line exactly at `v`: coordinates are dyadic or one ulp from it, so
//! that chords of straight loops are exact in both.

use crate::shapes::{at, circle, closed, curve, polygon, rational, rectangle};
use selvedge::model::TrimLoop;
use selvedge::spline::{BSpline, Bezier};
use selvedge::trim::{LoopIndex, RectSide, TrimTable};
use std::slice::from_ref;

/// One ulp more, one ulp less.
const fn up(x: f64) -> f64 {
    x.next_up()
}
const fn down(x: f64) -> f64 {
    x.next_down()
}

/// Chords per curve of the tables below: a deviation of about 1e-4 for unit arcs, so tables are not
/// asked about points nearer than that to a bent curve.
const CHORDS: u32 = 64;

fn expect_winding(loops: &[TrimLoop], rows: &[(f64, f64, i32)]) {
    let index = LoopIndex::new(loops);
    for &(u, v, winding) in rows {
        assert_eq!(index.winding(at(u, v)), winding, "winding at ({u:e}, {v:e})");
    }
}

/// The table with one scan line, exactly at `v`: `0 + 2v/2`, `2v - 2v/2` and `-1 + 2/2` do not round.
fn table_at(loops: &[TrimLoop], v: f64) -> TrimTable {
    let range = if v > 0.0 {
        (0.0, 2.0 * v)
    } else if v < 0.0 {
        (2.0 * v, 0.0)
    } else {
        (-1.0, 1.0)
    };
    let table = TrimTable::new(loops, range, &[1], |c| if c.degree() == 1 { 1 } else { CHORDS });
    assert_eq!(table.row_v(0), v);
    table
}

fn expect(loops: &[TrimLoop], rows: &[(f64, f64, i32)]) {
    expect_winding(loops, rows);
    for &(u, v, winding) in rows {
        assert_eq!(table_at(loops, v).contains(u, v), winding != 0, "table at ({u:e}, {v:e})");
    }
}

// 1: scan lines through shared vertices

#[test]
fn vertex_passed() {
    let hexagon = polygon(&[(0.0, 0.0), (3.0, 0.0), (4.0, 1.0), (3.0, 2.0), (0.0, 2.0)]);
    let mut rows = vec![(4.0, down(1.0), 0), (4.0, 1.0, 0), (4.0, up(1.0), 0), (down(4.0), 1.0, 1), (up(4.0), 1.0, 0)];
    for v in [down(1.0), 1.0, up(1.0)] {
        rows.extend([(-1.0, v, 0), (0.0, v, 1), (3.5, v, 1), (5.0, v, 0)]);
    }
    expect(from_ref(&hexagon), &rows);
    let clockwise: Vec<_> = rows.iter().map(|&(u, v, w)| (u, v, -w)).collect();
    expect(&[hexagon.reversed()], &clockwise);
}

#[test]
fn vertex_touched_from_below() {
    for (tip, at_tip) in [(down(1.0), 0), (1.0, 1), (up(1.0), 1)] {
        let notched = polygon(&[(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, tip), (0.0, 2.0)]);
        expect(from_ref(&notched), &[(-1.0, 1.0, 0), (1.0, 1.0, 1), (3.0, 1.0, 1), (4.0, 1.0, 0)]);
        expect_winding(&[notched], &[(2.0, 1.0, at_tip)]); // half an ulp of u wide: no chord resolves it
    }
}

#[test]
fn vertices_at_top_and_bottom() {
    let diamond = polygon(&[(1.0, 0.0), (2.0, 1.0), (1.0, 2.0), (0.0, 1.0)]);
    let rows = [
        (1.0, 0.0, 0),
        (1.0, up(0.0), 1),
        (1.0, down(2.0), 1),
        (1.0, 2.0, 0),
        (1.0, up(2.0), 0),
        (0.5, 2.0, 0),
        (0.5, 0.0, 0),
        (-1.0, 0.0, 0),
        (-1.0, 1.0, 0),
        (0.0, 1.0, 1),
        (down(0.0), 1.0, 0),
        (down(2.0), 1.0, 1),
        (2.0, 1.0, 0),
    ];
    expect_winding(from_ref(&diamond), &rows);
    // a chord evaluated at 5e-324 rounds to its end: the table is asked 2^-30 above the tip instead
    expect(&[diamond], &[(1.0, 2f64.powi(-30), 1), (1.0, down(2.0), 1), (1.0, 2.0, 0), (0.0, 1.0, 1), (2.0, 1.0, 0)]);
}

// 2: segments along the scan line

#[test]
fn runs_of_horizontal_segments() {
    let steps = [(0., 0.), (1., 0.), (2., 0.), (3., 0.), (3., 1.), (2., 1.), (1., 1.), (1., 2.), (0., 2.)];
    let rows = [
        (0.5, 0.0, 0),
        (2.5, 0.0, 0),
        (0.5, up(0.0), 1),
        (2.5, up(0.0), 1),
        (0.5, down(1.0), 1),
        (2.0, down(1.0), 1),
        (0.5, 1.0, 1),
        (1.0, 1.0, 1),
        (2.0, 1.0, 1),
        (3.0, 1.0, 0),
        (0.5, up(1.0), 1),
        (1.0, up(1.0), 0),
        (2.0, up(1.0), 0),
        (0.5, 2.0, 1),
        (0.5, up(2.0), 0),
    ];
    expect(&[polygon(&steps)], &rows);
}

#[test]
fn nearly_horizontal_segment() {
    let rise = 1e-7;
    let middle = rise * 0.5; // exactly on the segment at u = 1/2
    let shape = [polygon(&[(0.0, 0.0), (1.0, rise), (1.0, 1.0), (0.0, 1.0)])];
    expect_winding(
        &shape,
        &[
            (0.5, down(middle), 0),
            (0.5, middle, 0),
            (down(0.5), middle, 1),
            (up(0.5), middle, 0),
            (0.5, up(middle), 1),
            (0.25, middle, 1),
            (0.75, middle, 0),
        ],
    );
    expect(&shape, &[(0.5, middle * 0.999, 0), (0.5, middle * 1.001, 1), (0.499, middle, 1), (0.501, middle, 0)]);
}

// 3: extrema of v on and between scan lines

/// `v = 1 - (u - 1)²` over `v = 0`, counter-clockwise.
fn cap() -> TrimLoop {
    closed(vec![curve(&[(2.0, 0.0), (1.0, 2.0), (0.0, 0.0)]), curve(&[(0.0, 0.0), (2.0, 0.0)])])
}

#[test]
fn extremum_on_the_scan_line() {
    expect(
        &[cap()],
        &[(0.5, 1.0, 0), (1.0, 1.0, 0), (1.5, 1.0, 0), (1.0, up(1.0), 0), (1.0, 0.0, 0), (1.0, 0.5, 1), (0.25, 0.5, 0)],
    );
    let v = 1.0 - 2f64.powi(-40); // the cap is 2^-19 wide here
    let step = 2f64.powi(-22);
    let half = 2f64.powi(-20);
    expect_winding(
        &[cap()],
        &[
            (1.0, v, 1),
            (1.0 + half - step, v, 1),
            (1.0 + half + step, v, 0),
            (1.0 - half + step, v, 1),
            (1.0 - half - step, v, 0),
        ],
    );
}

#[test]
fn cap_between_two_scan_lines() {
    // cells [0.5, 0.9) and [0.9, 1.3), rows at 0.7 and 1.1, the tip at 1: moved by less than half a cell
    let table = TrimTable::new(&[cap()], (0.5, 1.3), &[2], |_| CHORDS);
    assert_eq!((table.row(0).len(), table.row(1).len()), (2, 0));
    assert!(table.contains(1.0, 0.89));
    assert!(!table.contains(1.0, 0.91));
    assert!(LoopIndex::new(&[cap()]).contains(at(1.0, 0.91)));
}

// 4: inflections with a tangent along the scan line

#[test]
fn triple_root() {
    // v = (2t - 1)³, u = 3t; the region above it
    let wave = curve(&[(0.0, -1.0), (1.0, 1.0), (2.0, -1.0), (3.0, 1.0)]);
    let shape = [closed(vec![wave, curve(&[(3.0, 1.0), (0.0, 1.0)]), curve(&[(0.0, 1.0), (0.0, -1.0)])])];
    // 1e-4 along u is 3e-13 along v: far above the rounding; the rows one ulp off v = 0 are not
    let mut rows = vec![(1.4999, 0.0, 1), (1.5001, 0.0, 0)];
    for v in [down(0.0), 0.0, up(0.0)] {
        rows.extend([(-0.5, v, 0), (1.0, v, 1), (2.0, v, 0), (3.5, v, 0)]);
    }
    expect_winding(&shape, &rows);
    expect(&shape, &[(1.0, 0.0, 1), (2.0, 0.0, 0)]);
}

#[test]
fn triple_root_of_u() {
    let wave = curve(&[(-1.0, 0.0), (1.0, 1.0), (-1.0, 2.0), (1.0, 3.0)]);
    let shape = [closed(vec![wave, curve(&[(1.0, 3.0), (-2.0, 3.0)]), curve(&[(-2.0, 3.0), (-1.0, 0.0)])])];
    expect(&shape, &[(-0.5, 1.5, 1), (0.5, 1.5, 0), (0.5, 2.9, 1), (-0.9, 0.1, 1), (-0.75, 0.1, 0)]);
    expect_winding(&shape, &[(-1e-15, 1.5, 1), (1e-15, 1.5, 0)]);
}

// 5: cusps and self-intersections: the rule is non-zero winding

#[test]
fn cusp() {
    // c' = 0 at t = 1/2, point (0.5, 0.75); clockwise
    let spike = curve(&[(0.0, 0.0), (1.0, 1.0), (0.0, 1.0), (1.0, 0.0)]);
    let shape = [closed(vec![spike, curve(&[(1.0, 0.0), (0.0, 0.0)])])];
    expect(&shape, &[(0.5, 0.5, -1), (0.5, 0.76, 0), (0.25, 0.75, 0), (0.75, 0.75, 0), (0.1, 0.5, 0), (0.9, 0.5, 0)]);
    expect_winding(&shape, &[(0.5, 0.75 - 1e-9, -1), (0.5, up(0.75), 0), (0.4, 0.75, 0)]);
}

#[test]
fn figure_of_eight() {
    let eight = polygon(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]);
    expect(
        &[eight],
        &[(0.5, 1.0, 1), (1.5, 1.0, -1), (1.0, 1.5, 0), (1.0, 0.5, 0), (1.0, 1.0, -1), (down(1.0), 1.0, 1)],
    );
}

#[test]
fn pentagram_keeps_its_core() {
    let star = polygon(&[(0.0, 3.0), (-2.0, -3.0), (3.0, 1.0), (-3.0, 1.0), (2.0, -3.0)]);
    expect(&[star], &[(0.0, 0.0, 2), (0.0, 2.0, 1), (2.0, 0.875, 1), (0.0, -2.5, 0), (-2.5, 0.75, 1)]);
}

#[test]
fn a_loop_inside_one_cubic() {
    // the cubic crosses itself and closes its own loop
    let knot = curve(&[(0.0, 0.0), (3.0, 2.0), (-2.0, 2.0), (1.0, 0.0)]);
    let shape = [closed(vec![knot, curve(&[(1.0, 0.0), (0.0, 0.0)])])];
    expect(&shape, &[(0.5, 1.25, 1), (0.5, 0.25, -1), (0.5, 1.75, 0), (0.0, 0.75, 0)]);
}

// 6: shared, nested, duplicated

#[test]
fn squares_that_share_an_edge_tile() {
    let pair = [rectangle((0.0, 0.0), (1.0, 1.0)), rectangle((1.0, 0.0), (2.0, 1.0))];
    for u in [0.0, 0.5, down(1.0), 1.0, up(1.0), 1.5, down(2.0)] {
        expect(&pair, &[(u, 0.5, 1), (u, 1.0, 1), (u, 0.0, 0)]);
    }
    assert_eq!(table_at(&pair, 0.5).row(0), [0.0, 2.0]); // the shared edge leaves no trace
}

#[test]
fn a_slanted_shared_edge_cancels_bit_for_bit() {
    let (a, b) = ((0.1, 0.0), (0.7, 1.0));
    let pair = [polygon(&[(-1.0, 0.0), a, b, (-1.0, 1.0)]), polygon(&[a, (3.0, 0.0), (3.0, 1.0), b])];
    for i in 1..1000 {
        assert_eq!(table_at(&pair, f64::from(i) / 1000.0).row(0), [-1.0, 3.0]);
    }
}

#[test]
fn triangles_that_share_a_vertex() {
    let pair = [polygon(&[(0.0, 0.0), (1.0, 1.0), (0.0, 2.0)]), polygon(&[(1.0, 1.0), (2.0, 0.0), (2.0, 2.0)])];
    expect(&pair, &[(down(1.0), 1.0, 1), (1.0, 1.0, 1), (up(1.0), 1.0, 1), (2.0, 1.0, 0)]);
    expect_winding(&pair, &[(1.0, up(1.0), 0), (1.0, down(1.0), 0)]);
    expect(&pair, &[(1.0, 1.0 + 1e-9, 0), (1.0, 1.0 - 1e-9, 0), (0.5, 1.25, 1), (1.5, 1.25, 1)]);
    assert_eq!(table_at(&pair, 1.0).row(0), [0.0, 2.0]);
}

#[test]
fn a_hole_of_the_wrong_orientation_is_no_hole() {
    let nested = [rectangle((0.0, 0.0), (4.0, 4.0)), rectangle((1.0, 1.0), (3.0, 3.0))];
    expect(&nested, &[(0.5, 2.0, 1), (2.0, 2.0, 2), (3.5, 2.0, 1)]);
    assert_eq!(table_at(&nested, 2.0).row(0), [0.0, 4.0]);
}

#[test]
fn duplicates_keep_and_opposites_cancel() {
    let square = rectangle((0.0, 0.0), (1.0, 1.0));
    let ring = circle(at(2.0, 2.0), 1.0);
    expect(&[square.clone(), square.clone()], &[(0.5, 0.5, 2), (1.5, 0.5, 0)]);
    expect(&[square.clone(), square.clone().reversed()], &[(0.5, 0.5, 0), (0.0, 0.5, 0)]);
    expect_winding(&[ring.clone(), ring.clone().reversed()], &[(2.0, 2.0, 0), (1.0, 2.0, 0), (2.5, 2.5, 0)]);
    // conservative: a curve is a curve, even where another cancels it
    let index = LoopIndex::new(&[square.clone(), square.reversed()]);
    assert_eq!(index.classify(at(0.5, 0.5), at(1.5, 0.75)), RectSide::Boundary);
}

#[test]
fn sliver() {
    let (left, right) = (0.5, 0.5 + 1.87e-6);
    let middle = 0.5 * (left + right);
    let shape = [rectangle((left, 0.0), (right, 1.0))];
    for v in [up(0.0), 0.25, 1.0] {
        expect(&shape, &[(down(left), v, 0), (left, v, 1), (middle, v, 1), (down(right), v, 1), (right, v, 0)]);
    }
}

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

// 11: seams

#[test]
fn hole_across_a_seam() {
    // a cylinder unrolled over u in [0, 8): the hole around u = 0 is cut at the seam into two halves
    // that share the domain's borders with the outer loop
    let outer = rectangle((0.0, 0.0), (8.0, 4.0));
    let left = rectangle((0.0, 1.0), (1.0, 3.0)).reversed();
    let right = rectangle((7.0, 1.0), (8.0, 3.0)).reversed();
    let loops = [outer, left, right];
    expect(&loops, &[(0.0, 2.0, 0), (0.5, 2.0, 0), (1.0, 2.0, 1), (7.0, 2.0, 0), (7.5, 2.0, 0), (8.0, 2.0, 0)]);
    expect(&loops, &[(0.0, 0.5, 1), (0.0, 1.0, 1), (0.0, up(1.0), 0), (0.0, 3.0, 0), (0.0, up(3.0), 1)]);
}

#[test]
fn two_curves_on_one_seam_edge() {
    // the outline of a whole cylinder runs up the seam at u = 8 and down the same edge at u = 0
    let outline = closed(vec![
        curve(&[(0.0, 0.0), (8.0, 0.0)]),
        curve(&[(8.0, 0.0), (8.0, 4.0)]),
        curve(&[(8.0, 4.0), (0.0, 4.0)]),
        curve(&[(0.0, 4.0), (0.0, 0.0)]),
    ]);
    for v in [up(0.0), 2.0, 4.0] {
        expect(from_ref(&outline), &[(0.0, v, 1), (4.0, v, 1), (down(8.0), v, 1), (8.0, v, 0), (down(0.0), v, 0)]);
    }
}

// 12: on the curve, on the border of the domain, slightly outside

#[test]
fn border_of_the_domain() {
    let square = [rectangle((0.0, 0.0), (1.0, 1.0))];
    let rows = [
        (0.5, 0.5, 1),
        (0.0, 0.5, 1),
        (down(0.0), 0.5, 0),
        (1.0, 0.5, 0),
        (down(1.0), 0.5, 1),
        (0.5, 0.0, 0),
        (0.5, up(0.0), 1),
        (0.5, 1.0, 1),
        (0.5, up(1.0), 0),
        (0.0, 1.0, 1),
        (1.0, 1.0, 0),
        (0.0, 0.0, 0),
        (1.0 + 1e-7, 0.5, 0),
    ];
    expect(&square, &rows);
    // parameters slightly outside the domain, and none at all, find a row
    let table = TrimTable::new(&square, (0.0, 1.0), &[2, 2], |_| 1);
    assert_eq!((table.row_of(-1e-7), table.row_of(1.0), table.row_of(1.0 + 1e-7)), (0, 3, 3));
    assert_eq!((table.row_of(f64::NAN), table.row_of(f64::INFINITY)), (0, 3));
    let index = LoopIndex::new(&square);
    assert_eq!(index.winding(at(f64::NAN, 0.5)) + index.winding(at(0.5, f64::NAN)), 0);
    assert_eq!(index.classify(at(f64::NAN, 0.0), at(1.0, 1.0)), RectSide::Boundary);
}

#[test]
fn points_on_a_slanted_line() {
    let triangle = [polygon(&[(0.0, 0.0), (3.0, 0.0), (0.0, 1.0)])];
    let third = 1.0 / 3.0; // rounded down: the line passes v = third at u = 2 + 3 · 1.85e-17
    expect_winding(&triangle, &[(down(2.0), third, 1), (2.0, third, 1), (up(2.0), third, 0), (2.0, up(third), 0)]);
}

// 13 and 14: stale densities, and the order of work

#[test]
fn a_strip_without_votes_still_answers() {
    let table = TrimTable::new(&[rectangle((0.0, 0.0), (1.0, 1.0))], (-1.0, 3.0), &[0, 0, 5, 0], |_| 1);
    assert_eq!(table.row_count(), 8);
    assert_eq!((table.row_v(0), table.row_v(1), table.row_v(4)), (-0.5, 0.5, 1.5));
    assert!(table.contains(0.5, 0.01) && table.contains(0.5, 0.99));
    assert!(!table.contains(0.5, -0.01) && !table.contains(0.5, 1.01));
}

#[test]
fn the_table_does_not_depend_on_the_order_of_loops() {
    let a = rectangle((0.0, 0.0), (4.0, 4.0));
    let b = circle(at(2.0, 2.0), 1.0).reversed();
    let c = rectangle((1.0, 0.5), (3.0, 3.0));
    let table = |loops: &[&TrimLoop]| {
        let loops: Vec<_> = loops.iter().map(|&l| l.clone()).collect();
        TrimTable::new(&loops, (0.0, 4.0), &[7, 1, 90], |_| CHORDS)
    };
    let first = table(&[&a, &b, &c]);
    assert_eq!(first, table(&[&c, &b, &a]));
    assert_eq!(first, table(&[&b, &c, &a]));
    assert_ne!(first, table(&[&a, &b]));
}

// rectangles that touch

#[test]
fn touching_is_meeting() {
    let square = LoopIndex::new(&[rectangle((0.0, 0.0), (1.0, 1.0))]);
    for (lo, hi, side) in [
        ((1.0, 0.25), (2.0, 0.5), RectSide::Boundary),
        ((1.0, 1.0), (2.0, 2.0), RectSide::Boundary),
        ((up(1.0), 0.25), (2.0, 0.5), RectSide::Outside),
        ((0.5, 0.5), (1.0, 0.75), RectSide::Boundary),
        ((up(0.0), up(0.0)), (down(1.0), down(1.0)), RectSide::Inside),
        ((-1.0, -1.0), (2.0, 2.0), RectSide::Boundary),
        ((0.5, 0.5), (0.5, 0.5), RectSide::Inside),
        ((0.75, 0.5), (0.25, 0.75), RectSide::Boundary), // not a rectangle
    ] {
        assert_eq!(square.classify(lo.into(), hi.into()), side, "{lo:?} {hi:?}");
    }
}

/// The extrema of a bent curve are found with rounding: rectangles against the true ones must not
/// slip through.
#[test]
fn touching_an_extremum_is_meeting() {
    for k in 1..100 {
        let (centre, radius) = (at(f64::from(k % 11), f64::from(k % 7)), f64::from(k));
        let fifth = 0.2;
        let ring =
            [(0., -1., 1.), (4., -1., fifth), (2., 3., fifth), (-2., 3., fifth), (-4., -1., fifth), (0., -1., 1.)];
        let placed = ring.map(|(x, y, w)| (centre.x + radius * x, centre.y + radius * y, w));
        let index = LoopIndex::new(&[closed(vec![rational(&placed)])]);
        for (x, y) in [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)] {
            let (near, far) = (centre + radius * at(x, y), centre + 2.0 * radius * at(x, y));
            let across = 0.5 * at(y, x).abs();
            let (lo, hi) = (near.min(far) - across, near.max(far) + across);
            assert_eq!(index.classify(lo, hi), RectSide::Boundary, "{k}, side {x} {y}");
            let gap = 1e-12 * radius * at(x, y);
            assert_eq!(index.classify(lo + gap, hi + gap), RectSide::Outside, "{k}, beside {x} {y}");
        }
    }
}
