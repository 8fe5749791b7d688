//! Hard cases of crossings: vertices, tangents, cusps, shared and duplicated loops. Each is a tiny
//! shape whose answer is known by hand.

use crate::check::{CHORDS, down, expect, expect_winding, table_at, up};
use crate::shapes::{at, circle, closed, curve, polygon, rectangle};
use selvedge_geometry::model::TrimLoop;
use selvedge_geometry::trim::{LoopIndex, RectSide, TrimTable};
use std::slice::from_ref;

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
    // conservative: a curve counts even where another one cancels it
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
