//! Numerical hard cases of trim domains, each as a tiny shape with the answer known by hand.

use crate::shapes::{at, circle, polygon, rectangle};
use selvedge::trim::{LoopIndex, RectSide};

#[test]
fn a_square_keeps_its_left_and_top_border() {
    let index = LoopIndex::new(&[rectangle((0.0, 0.0), (1.0, 1.0))]);
    for (u, v, inside) in [
        (0.5, 0.5, true),
        (0.0, 0.5, true),
        (1.0, 0.5, false),
        (0.5, 0.0, false),
        (0.5, 1.0, true),
        (0.0, 1.0, true),
        (1.0, 1.0, false),
        (0.0, 0.0, false),
    ] {
        assert_eq!(index.contains(at(u, v)), inside, "({u}, {v})");
    }
}

#[test]
fn a_hole_is_outside() {
    let index = LoopIndex::new(&[rectangle((0.0, 0.0), (4.0, 4.0)), circle(at(2.0, 2.0), 1.0).reversed()]);
    assert!(index.contains(at(0.5, 2.0)));
    assert!(!index.contains(at(2.0, 2.0)));
    assert!(index.contains(at(3.5, 2.0)));
    assert_eq!(index.classify(at(0.1, 0.1), at(0.9, 3.9)), RectSide::Inside);
    assert_eq!(index.classify(at(1.8, 1.8), at(2.2, 2.2)), RectSide::Outside);
    assert_eq!(index.classify(at(0.1, 0.1), at(2.2, 2.2)), RectSide::Boundary);
    assert!((index.distance(at(2.0, 2.0), 10.0) - 1.0).abs() < 1e-3);
}

#[test]
fn a_scan_line_through_shared_vertices() {
    // a diamond: both outer vertices on v = 1, passing; the top and bottom ones touching
    let index = LoopIndex::new(&[polygon(&[(1.0, 0.0), (2.0, 1.0), (1.0, 2.0), (0.0, 1.0)])]);
    assert_eq!(index.winding(at(1.0, 1.0)), 1);
    assert_eq!(index.winding(at(-1.0, 1.0)), 0);
    assert_eq!(index.winding(at(-1.0, 2.0)), 0);
    assert_eq!(index.winding(at(-1.0, 0.0)), 0);
}
