//! Closed polygons: exact predicates, limits of subdivision, edits.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use selvedge_geometry::construct::ConstructError;
use selvedge_geometry::construct::curve::Parameters;
use selvedge_geometry::construct::polyloop::{PolyLoop, Winding};
use selvedge_geometry::spline::BSpline;

fn p(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

fn square() -> PolyLoop {
    PolyLoop::new(vec![p(0.0, 0.0), p(2.0, 0.0), p(2.0, 2.0), p(0.0, 2.0)]).unwrap()
}

/// An L: one turn to the right, at (1, 1).
fn ell() -> PolyLoop {
    PolyLoop::new(vec![p(0.0, 0.0), p(2.0, 0.0), p(2.0, 1.0), p(1.0, 1.0), p(1.0, 2.0), p(0.0, 2.0)]).unwrap()
}

/// Derivatives of a chain on both sides of the parameter `i`, from its Bézier pieces.
fn sides(curve: &BSpline<DVec3>, i: usize) -> [[DVec2; 3]; 2] {
    let pieces = curve.beziers();
    let n = pieces.len();
    let before: Vec<DVec2> = pieces[(i + n - 1) % n].piece.points.iter().map(|p| p.truncate()).collect();
    let after: Vec<DVec2> = pieces[i % n].piece.points.iter().map(|p| p.truncate()).collect();
    [
        [before[3], before[3] - before[2], before[3] - before[2] * 2.0 + before[1]],
        [after[0], after[1] - after[0], after[0] - after[1] * 2.0 + after[2]],
    ]
}

#[test]
fn turns_inflections_convexity() {
    let ell = ell();
    let signs: Vec<f64> = (0..6).map(|i| ell.turn(i).signum()).collect();
    assert_eq!(signs, [1.0, 1.0, 1.0, -1.0, 1.0, 1.0]);
    assert_eq!(ell.inflection_edges(), [2, 3]);
    assert!(!ell.is_convex() && ell.winding() == Winding::CounterClockwise);
    assert_eq!(ell.clone().reversed().winding(), Winding::Clockwise);
    assert!(square().is_convex() && square().reversed().is_convex());
    assert!(square().inflection_edges().is_empty());
    // a vertex straight on does not count; an S through one does, once
    let mut straight = square();
    straight.insert(1, p(1.0, 0.0)).unwrap();
    assert!(straight.is_convex() && straight.turn(1) == 0.0);
    // a pentagram turns left everywhere but goes around twice
    let star = (0..5).map(|i| DVec2::from_angle(f64::from(i) * 0.8 * std::f64::consts::PI)).collect();
    let star = PolyLoop::new(star).unwrap();
    assert!((0..5).all(|i| star.turn(i) > 0.0) && !star.is_convex());
    let flat = PolyLoop::new(vec![p(0.0, 0.0), p(1.0, 1.0), p(3.0, 3.0)]).unwrap();
    assert!(!flat.is_convex() && flat.winding() == Winding::Flat && flat.inflection_edges().is_empty());
}

/// One unit in the last place decides.
#[test]
fn signs_are_exact() {
    let h = 2f64.powi(-52);
    for (y, sign) in [(1.0 + h, 1.0), (1.0, 0.0), (1.0 - 0.5 * h, -1.0)] {
        let l = PolyLoop::new(vec![p(0.1, 0.1), p(0.5, 0.5), p(1.0, y), p(-3.0, 7.0)]).unwrap();
        let turn = l.turn(1);
        assert_eq!(if turn == 0.0 { 0.0 } else { turn.signum() }, sign, "{y}");
    }
}

#[test]
fn edits_keep_the_loop_whole() {
    let mut l = square();
    l.insert(4, p(-1.0, 1.0)).unwrap();
    l.move_to(0, p(-0.5, -0.5)).unwrap();
    l.remove(2).unwrap();
    assert_eq!(l.vertices(), [p(-0.5, -0.5), p(2.0, 0.0), p(0.0, 2.0), p(-1.0, 1.0)]);
    let before = l.clone();
    assert_eq!(l.insert(1, p(2.0, 0.0)), Err(ConstructError::CoincidentPoints { first: 1, second: 2 }));
    assert_eq!(l.move_to(3, p(-0.5, -0.5)), Err(ConstructError::CoincidentPoints { first: 3, second: 0 }));
    assert_eq!(l.insert(0, p(f64::NAN, 0.0)), Err(ConstructError::NotFinite { what: "a vertex" }));
    assert!(matches!(l.insert(5, p(9.0, 9.0)), Err(ConstructError::Range { .. })));
    assert!(matches!(l.remove(4), Err(ConstructError::Range { .. })));
    assert_eq!(l, before);
    l.remove(0).unwrap();
    assert_eq!(l.remove(0), Err(ConstructError::TooFew { what: "vertices", got: 2, needed: 3 }));
    assert!(square().four_points(0.2, 1).is_err() && square().four_points(f64::NAN, 1).is_err());
    assert!(square().interpolating(1.5).is_err());
    assert!(matches!(square().cut_corners(40), Err(ConstructError::TooMany { .. })));
    assert!(matches!(square().cut_corners(64), Err(ConstructError::TooMany { .. })));
}

/// The four-point scheme's slope at a vertex for the tension 1/16 (Dyn, Levin, Gregory 1987): it reproduces cubics.
#[test]
fn four_points_reproduce_cubics() {
    let f = |t: f64| p(t, 0.5 * t * t * t - t * t + 2.0);
    let mut vertices: Vec<DVec2> = (0..8).map(|i| f(f64::from(i))).collect();
    vertices.push(p(9.0, -50.0));
    let fine = PolyLoop::new(vertices).unwrap().four_points(0.0625, 4).unwrap();
    // between vertices 2 and 5 the scheme uses vertices of the cubic only
    for i in 2 * 16..=5 * 16 {
        let expected = f(i as f64 / 16.0);
        assert!(fine.vertices()[i].distance(expected) < 1e-12, "{i}");
    }
}

fn any_loop() -> impl Strategy<Value = PolyLoop> {
    prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0), 3..12)
        .prop_filter_map("neighbours coincide", |v| PolyLoop::new(v.into_iter().map(|(x, y)| p(x, y)).collect()).ok())
}

/// Vertices at whole numbers, all different, none straight on: every predicate has an exact answer in integers.
fn whole_loop() -> impl Strategy<Value = Vec<[i64; 2]>> {
    prop::collection::vec(prop::array::uniform2(-6i64..7), 3..9).prop_filter("straight on, or twice", |v| {
        let n = v.len();
        (0..n).all(|i| cross(v, i) != 0 && v[..i].iter().all(|p| *p != v[i]))
    })
}

/// `cross(AB, BC)` about vertex `i`.
fn cross(v: &[[i64; 2]], i: usize) -> i64 {
    let n = v.len();
    side(v[(i + n - 1) % n], v[i], v[(i + 1) % n])
}

/// Where `c` lies of the line from `a` to `b`: positive on its left.
fn side(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

proptest! {
    /// Left turns, inflection edges and convexity agree with integers: a loop is convex when no vertex lies on the
    /// other side of any edge. Orientation is the sign of the area of a loop around a point that all edges see.
    #[test]
    fn turns_inflections_and_convexity_by_integers(v in whole_loop()) {
        let n = v.len();
        let l = PolyLoop::new(v.iter().map(|[x, y]| p(*x as f64, *y as f64)).collect()).unwrap();
        for i in 0..n {
            prop_assert_eq!(l.turn(i), cross(&v, i) as f64);
        }
        let bends = (0..n).filter(|i| (cross(&v, *i) > 0) != (cross(&v, (i + 1) % n) > 0)).collect::<Vec<_>>();
        prop_assert_eq!(l.inflection_edges(), bends);
        let sides = |i: usize| (0..n).map(move |k| (i, k)).map(|(i, k)| side(v[i], v[(i + 1) % n], v[k]));
        let hull = [1, -1].iter().any(|s| (0..n).all(|i| sides(i).all(|x| x * s >= 0)));
        prop_assert_eq!(l.is_convex(), hull);
        let area = |c: [i64; 2]| (0..n).map(|i| side(c, v[i], v[(i + 1) % n])).collect::<Vec<_>>();
        let seen = area([0, 0]);
        // once around the origin, always the same way: a star, and its orientation that of any of its triangles
        let round: f64 = (0..n).map(|i| l.vertices()[i].angle_to(l.vertices()[(i + 1) % n])).sum();
        if seen.iter().all(|a| *a > 0) && round < 7.0 {
            prop_assert_eq!(l.winding(), Winding::CounterClockwise);
        } else if seen.iter().all(|a| *a < 0) && round > -7.0 {
            prop_assert_eq!(l.winding(), Winding::Clockwise);
        }
        let r = l.reversed();
        prop_assert!((0..n).all(|i| r.turn(i) == -(cross(&v, (n - i) % n) as f64)));
    }

    /// The approximating curve is C² and is the limit of corner cutting: limit points of every round lie on it.
    #[test]
    fn corner_cutting_ends_in_the_spline(l in any_loop()) {
        let curve = l.approximating().unwrap();
        let n = l.vertices().len();
        for i in 0..n {
            let [a, b] = sides(&curve, i);
            for order in 0..3 {
                prop_assert!(a[order].distance(b[order]) < 1e-14, "order {}", order);
            }
        }
        let rounds = 3;
        let fine = l.cut_corners(rounds).unwrap();
        let q = fine.vertices();
        let m = q.len();
        for i in 0..m {
            let limit = (q[(i + m - 1) % m] + q[i] * 4.0 + q[(i + 1) % m]) / 6.0;
            let on_curve = curve.point(i as f64 / f64::from(1 << rounds));
            prop_assert!(limit.distance(on_curve) < 1e-14);
        }
        prop_assert_eq!(curve.point(0.0), curve.point(n as f64));
    }

    /// A vertex that is moved moves four segments of the approximating curve; inserting a vertex and removing it again
    /// restores the loop.
    #[test]
    fn edits_are_local_and_can_be_undone(l in any_loop(), at in 0usize..12, to in (-1.0f64..1.0, -1.0f64..1.0)) {
        let n = l.vertices().len();
        let (at, to) = (at % n, p(to.0, to.1));
        let mut edited = l.clone();
        edited.insert(at, to).unwrap();
        edited.remove(at).unwrap();
        prop_assert_eq!(&edited, &l);
        edited.move_to(at, to).unwrap();
        let (before, after) = (l.approximating().unwrap(), edited.approximating().unwrap());
        for i in 0..n {
            // segment i runs from vertex i: it depends on vertices i - 1 to i + 2
            let near = (0..4).any(|k| (i + n - 1 + k) % n == at);
            let t = i as f64 + 0.37;
            let moved = before.point(t).distance(after.point(t));
            prop_assert!(if near { moved > 0.0 } else { moved < 1e-15 * 8.0 }, "segment {i} of {n}: {moved:e}");
        }
    }

    #[test]
    fn interpolating_curves_go_through_the_vertices(l in any_loop(), tension in -0.5f64..1.0, w in 0.0f64..0.125) {
        let n = l.vertices().len();
        let curve = l.interpolating(tension).unwrap();
        let smooth = l.interpolating_smoothly(&Parameters::Uniform).unwrap();
        let fine = l.four_points(w, 3).unwrap();
        for i in 0..n {
            let v = l.vertices()[i];
            prop_assert!(curve.point(i as f64).distance(v) < 1e-14);
            prop_assert!(smooth.point(i as f64).distance(v) < 1e-12);
            prop_assert_eq!(fine.vertices()[8 * i], v);
            let [a, b] = sides(&curve, i);
            prop_assert!(a[1].distance(b[1]) < 1e-14);
            let [a, b] = sides(&smooth, i);
            prop_assert!(a[1].distance(b[1]) < 1e-11 && a[2].distance(b[2]) < 1e-11);
        }
        prop_assert_eq!(curve.point(0.0), curve.point(n as f64));
        prop_assert_eq!(smooth.point(0.0), smooth.point(n as f64));
    }

    /// Tension 1 is the polygon; tension 0 of the four-point scheme too.
    #[test]
    fn full_tension_is_the_polygon(l in any_loop(), t in 0.0f64..1.0) {
        let curve = l.interpolating(1.0).unwrap();
        let (a, b) = (l.vertices()[0], l.vertices()[1]);
        let q = curve.point(t);
        prop_assert!((b - a).perp_dot(q - a).abs() < 1e-14);
        let fine = l.four_points(0.0, 1).unwrap();
        prop_assert!(fine.vertices()[1].distance((a + b) * 0.5) < 1e-15);
    }

    /// Around a convex loop every rotation and reversal gives the same result; the hull contains the approximating
    /// curve.
    #[test]
    fn regular_polygons_are_convex(n in 3usize..40, start in 0.0f64..6.0, shift in 0usize..40, t in 0.0f64..1.0) {
        let mut v: Vec<DVec2> =
            (0..n).map(|i| DVec2::from_angle(start + i as f64 / n as f64 * std::f64::consts::TAU)).collect();
        v.rotate_left(shift % n);
        let l = PolyLoop::new(v).unwrap();
        prop_assert!(l.is_convex() && l.winding() == Winding::CounterClockwise);
        prop_assert!(l.approximating().unwrap().point(t * n as f64).length() <= 1.0);
        let r = l.reversed();
        prop_assert!(r.is_convex() && r.winding() == Winding::Clockwise);
    }
}
