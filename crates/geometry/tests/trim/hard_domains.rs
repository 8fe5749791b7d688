//! Hard cases of the domain: seams, borders, stale densities, touching rectangles.

use crate::check::{CHORDS, down, expect, expect_winding, up};
use crate::shapes::{at, circle, closed, curve, polygon, rational, rectangle};
use selvedge_geometry::model::TrimLoop;
use selvedge_geometry::trim::{LoopIndex, RectSide, TrimTable};
use std::slice::from_ref;

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
