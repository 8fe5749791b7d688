//! Sweeps and tubes against a frame integrated by Runge and Kutta's method.

use crate::{EXACT, at, fractions, line, planar, points};
use glam::{DVec2, DVec3, DVec4};
use proptest::prelude::*;
use selvedge_geometry::construct::{ConstructError, Sweep, tube};
use selvedge_geometry::spline::{BSpline, Control};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Point, first and second derivative by a parameter over `[0, 1]`, by differences of control points.
fn derivatives(c: &BSpline<DVec4>, t: f64) -> [DVec3; 3] {
    let (a, b) = c.domain();
    let x = a + (b - a) * t;
    let spans = c.beziers();
    let s = spans.iter().rev().find(|s| s.start <= x).unwrap_or(&spans[0]);
    let (length, p) = (s.end - s.start, &s.piece.points);
    let value = |points: &[DVec4]| {
        let mut work = points.to_vec();
        while work.len() > 1 {
            work = work.windows(2).map(|w| w[0].lerp(w[1], (x - s.start) / length)).collect();
        }
        work[0]
    };
    let slope = |p: &[DVec4]| -> Vec<DVec4> {
        let scale = (p.len() - 1) as f64 * (b - a) / length;
        p.windows(2).map(|w| (w[1] - w[0]) * scale).collect()
    };
    let (d, dd) = (slope(p), slope(&slope(p)));
    let (h, h1, h2) = (value(p), value(&d), if dd.is_empty() { DVec4::ZERO } else { value(&dd) });
    let point = h.truncate() / h.w;
    let first = (h1.truncate() - point * h1.w) / h.w;
    let second = (h2.truncate() - first * (2.0 * h1.w) - point * h2.w) / h.w;
    [point, first, second]
}

/// Reference vector and length at each of `steps` even parameters, by the differential equation of the frame of
/// least turning, `r' = -(r · t') t`.
fn integrated(c: &BSpline<DVec4>, r: DVec3, steps: usize) -> Vec<(DVec3, f64)> {
    let rate = |t: f64, r: DVec3| {
        let [_, d, dd] = derivatives(c, t);
        let tangent = d.normalize();
        tangent * -r.dot((dd - tangent * dd.dot(tangent)) / d.length())
    };
    let speed = |t: f64| derivatives(c, t)[1].length();
    let h = 1.0 / steps as f64;
    let mut all = vec![(r, 0.0)];
    for k in 0..steps {
        let (r, length) = all[k];
        // steps end at knots: derivatives from inside
        let t = (k as f64 + 1e-9) * h;
        let end = (k as f64 + 1.0 - 1e-9) * h;
        let k1 = rate(t, r);
        let k2 = rate(t + 0.5 * h, r + k1 * (0.5 * h));
        let k3 = rate(t + 0.5 * h, r + k2 * (0.5 * h));
        let k4 = rate(end, r + k3 * h);
        let next = r + (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0);
        all.push((next.normalize(), length + h / 6.0 * (speed(t) + 4.0 * speed(t + 0.5 * h) + speed(end))));
    }
    all
}

const STEPS: usize = 600;
/// Of the integration, at 600 steps of paths of length 10.
const INTEGRATED: f64 = 1e-8;

/// Curvature vectors before and after parameter `t`: two at a knot, and the sharpest of a piece is often at its end.
fn bends(path: &BSpline<DVec4>, t: f64) -> [DVec3; 2] {
    [t - 1e-9, t + 1e-9].map(|t| {
        let [_, d, dd] = derivatives(path, t.clamp(0.0, 1.0 - 1e-12));
        (dd - d * (dd.dot(d) / d.length_squared())) / d.length_squared()
    })
}

/// A placed frame of a sweep as described: parameter, point, axes of the profile (scaled), and the path's curvature
/// vectors.
struct Placed {
    v: f64,
    centre: DVec3,
    x: DVec3,
    y: DVec3,
    bends: [DVec3; 2],
}

/// The frames of a sweep at all steps.
fn frames(sweep: &Sweep) -> Vec<Placed> {
    let up = sweep.up.unwrap();
    let [_, d, _] = derivatives(sweep.path, 0.0);
    let t = d.normalize();
    let r = (up - t * up.dot(t)).normalize();
    let all = integrated(sweep.path, r, STEPS);
    let (last, length) = all[STEPS];
    let closed = at(sweep.path, 0.0).distance(at(sweep.path, 1.0)) < 1e-9;
    let holonomy = if closed { last.dot(t.cross(r)).atan2(last.dot(r)) } else { 0.0 };
    let placed = |(k, (r, so_far)): (usize, &(DVec3, f64))| {
        let v = k as f64 / STEPS as f64;
        let [centre, d, _] = derivatives(sweep.path, v.min(1.0 - 1e-12));
        let share = so_far / length;
        let angle = (sweep.twist - holonomy) * share;
        let t = d.normalize();
        let scale = sweep.scale.0 + (sweep.scale.1 - sweep.scale.0) * share;
        let x = *r * angle.cos() + t.cross(*r) * angle.sin();
        Placed { v, centre, x: x * scale, y: t.cross(x) * scale, bends: bends(sweep.path, v) }
    };
    all.iter().enumerate().map(placed).collect()
}

/// Largest distance between a sweep and its description, at all steps.
fn deviation(sweep: &Sweep, surface: &selvedge_geometry::spline::Surface) -> f64 {
    let s = points(surface);
    let (a, b) = sweep.profile.domain();
    let mut most: f64 = 0.0;
    for f in frames(sweep) {
        for u in fractions(6) {
            let p = sweep.profile.point(a + (b - a) * u);
            most = most.max(s(u, f.v).distance(f.centre + f.x * p.x + f.y * p.y));
        }
    }
    most
}

/// How near the profile comes to a centre of curvature of the path: at 1 it is there, and the surface folds.
fn fold(sweep: &Sweep) -> f64 {
    let (a, b) = sweep.profile.domain();
    let profile: Vec<DVec2> = fractions(60).map(|u| sweep.profile.point(a + (b - a) * u)).collect();
    let near = |f: &Placed, bend: DVec3| profile.iter().map(|p| (f.x * p.x + f.y * p.y).dot(bend)).fold(0.0, f64::max);
    frames(sweep).iter().flat_map(|f| f.bends.map(|bend| near(f, bend))).fold(0.0, f64::max)
}

/// Of [`fold`], by its steps.
const FOLD_SEEN: f64 = 0.02;

/// A sweep is refused for a fold if and only if it folds; `None` where it is.
fn unfolded(sweep: &Sweep) -> Option<selvedge_geometry::construct::Built> {
    let built = sweep.build();
    let fold = fold(sweep);
    if matches!(built, Err(ConstructError::Folds { .. })) {
        assert!(fold >= 1.0 - FOLD_SEEN, "refused, and it comes to {fold} of the radius only");
        return None;
    }
    assert!(fold <= 1.0 + FOLD_SEEN, "made, though it comes to {fold} of the radius");
    Some(built.unwrap())
}

/// A rational half loop of size 0.2 or so.
fn profile(size: f64, weight: f64) -> BSpline<DVec3> {
    let corners = [(1.0, 0.2), (0.8, 1.3), (-0.5, 0.9), (-1.2, -0.3), (0.1, -0.8)];
    let point = |(i, &(x, y)): (usize, &(f64, f64))| {
        DVec3::from_point(DVec2::new(x, y) * size, if i == 2 { weight } else { 1.0 })
    };
    let knots = vec![0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0];
    BSpline::new(2, knots, corners.iter().enumerate().map(point).collect()).unwrap()
}

/// An open path that wanders forward; knots at multiples of a step of the integration.
fn path() -> impl Strategy<Value = BSpline<DVec4>> {
    let step = (0.8..1.6f64, -0.7..0.7f64, -0.7..0.7f64, 0.7..1.4f64);
    (2..=4usize, prop::collection::vec(step, 7), any::<bool>()).prop_map(|(degree, steps, rational)| {
        let mut p = DVec3::ZERO;
        let points: Vec<DVec4> = steps
            .iter()
            .map(|&(x, y, z, w)| {
                p += DVec3::new(x, y, z);
                DVec4::from_point(p, if rational { w } else { 1.0 })
            })
            .collect();
        let inside = points.len() - degree;
        let knots = (0..=inside).map(|k| k as f64 * 12.0);
        let ends = |x: f64| std::iter::repeat_n(x, degree);
        BSpline::new(degree, ends(0.0).chain(knots).chain(ends(inside as f64 * 12.0)).collect(), points).unwrap()
    })
}

/// A closed cubic path around the z axis, its knots even.
fn ring() -> impl Strategy<Value = BSpline<DVec4>> {
    prop::collection::vec((1.6..2.4f64, -0.8..0.8f64), 6).prop_map(|all| {
        let corner = |i: usize| {
            let (r, z) = all[i % 6];
            let p = DVec2::from_angle((i % 6) as f64 * TAU / 6.0) * r;
            p.extend(z).extend(1.0)
        };
        BSpline::new(3, (0..13).map(f64::from).collect(), (0..9).map(corner).collect()).unwrap()
    })
}

proptest! {
    #[test]
    fn a_sweep_keeps_its_tolerance(
        path in path(), size in 0.05..0.3f64, weight in 0.5..2.0f64, twist in -4.0..4.0f64, end in 0.5..1.5f64,
        digits in 2.0..5.0f64, plain in any::<bool>(),
    ) {
        let (profile, tolerance) = (profile(size, weight), 10f64.powf(-digits));
        let mut sweep = Sweep { up: Some(DVec3::new(0.1, 0.2, 1.0)), ..Sweep::new(&profile, &path, tolerance) };
        if !plain {
            (sweep.twist, sweep.scale) = (twist, (1.0, end));
        }
        let Some(built) = unfolded(&sweep) else { return Ok(()) };
        prop_assert!(built.deviation <= tolerance);
        let off = deviation(&sweep, &built.surface);
        prop_assert!(off <= built.deviation + INTEGRATED, "{off:e} of {:e}", built.deviation);
    }

    #[test]
    fn a_sweep_around_a_ring_closes(path in ring(), size in 0.05..0.3f64, turns in -1..=1i32, digits in 2.0..5.0f64) {
        let (profile, tolerance) = (profile(size, 1.0), 10f64.powf(-digits));
        let twist = f64::from(turns) * TAU;
        let sweep = Sweep { up: Some(DVec3::Z), twist, ..Sweep::new(&profile, &path, tolerance) };
        let Some(built) = unfolded(&sweep) else { return Ok(()) };
        prop_assert!(built.deviation <= tolerance);
        let off = deviation(&sweep, &built.surface);
        prop_assert!(off <= built.deviation + INTEGRATED, "{off:e} of {:e}", built.deviation);
        let grid = built.surface.patches();
        for u in fractions(8) {
            let (a, b) = (grid.jet(3.0 * u, 0.0), grid.jet(3.0 * u, 1.0));
            prop_assert_eq!(a.point, b.point);
            prop_assert!(a.dv.angle_between(b.dv) <= 1e-6, "no crease at the seam");
        }
    }

    #[test]
    fn a_tube_keeps_its_distance(path in path(), radius in 0.05..0.3f64, digits in 2.0..5.0f64) {
        let tolerance = 10f64.powf(-digits);
        let built = tube(&path, radius, tolerance);
        let sharpest = radius * fractions(600).flat_map(|v| bends(&path, v)).map(DVec3::length).fold(0.0, f64::max);
        if matches!(built, Err(ConstructError::Folds { .. })) {
            prop_assert!(sharpest >= 1.0 - FOLD_SEEN, "refused, and the bend is {sharpest} of the radius only");
            return Ok(());
        }
        prop_assert!(sharpest <= 1.0 + FOLD_SEEN, "made, and the bend is {sharpest} of the radius");
        let built = built.unwrap();
        prop_assert!(built.deviation <= tolerance);
        let s = points(&built.surface);
        for v in fractions(120) {
            let [c, d, _] = derivatives(&path, v.min(1.0 - 1e-12));
            for u in fractions(8) {
                let arm = s(u, v) - c;
                let off = (arm.length() - radius).abs().max(arm.dot(d.normalize()).abs());
                prop_assert!(off <= built.deviation + EXACT * 10.0, "{off:e} of {:e}", built.deviation);
            }
        }
    }
}

#[test]
fn along_a_line_it_is_exact() {
    let profile = profile(1.0, 2.0);
    // a straight path of uneven speed
    let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
    let ends = [DVec3::ZERO, DVec3::Z * 3.0, DVec3::Z * 4.0].map(|p| DVec4::from_point(p, 1.0));
    let path = BSpline::new(2, knots, ends.to_vec()).unwrap();
    let sweep = Sweep { up: Some(DVec3::X), scale: (1.0, 0.5), ..Sweep::new(&profile, &path, 1e-3) };
    let built = sweep.build().unwrap();
    assert_eq!((built.deviation, built.surface.degrees()), (0.0, (2, 1)));
    let s = points(&built.surface);
    for u in fractions(20) {
        let p = profile.point(3.0 * u);
        for v in fractions(5) {
            let expected = (p * (1.0 - 0.5 * v)).extend(4.0 * v);
            assert!(s(u, v).distance(expected) <= 4.0 * EXACT);
        }
    }
}

/// A quarter of a circle of radius 5 about `y`, from `x` towards `-z`.
fn quarter() -> BSpline<DVec4> {
    let h = std::f64::consts::FRAC_1_SQRT_2;
    let points = [(5.0, 0.0, 1.0), (5.0, -5.0, h), (0.0, -5.0, 1.0)];
    let points = points.iter().map(|&(x, z, w)| DVec4::from_point(DVec3::new(x, 0.0, z), w)).collect();
    BSpline::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], points).unwrap()
}

#[test]
fn along_a_circle_it_is_a_torus() {
    let built = tube(&quarter(), 1.0, 1e-3).unwrap();
    assert_eq!((built.deviation, built.surface.degrees()), (0.0, (2, 2)));
    let s = points(&built.surface);
    for u in fractions(20) {
        for v in fractions(20) {
            let p = s(u, v);
            let off = DVec2::new(DVec2::new(p.x, p.z).length() - 5.0, p.y).length() - 1.0;
            assert!(off.abs() <= 6.0 * EXACT);
        }
        assert!(s(u, 0.0).z.abs() <= 6.0 * EXACT && s(u, 1.0).x.abs() <= 6.0 * EXACT, "ends across the path");
    }
    // outward: along the path and counter-clockwise around it
    let jet = built.surface.jet(0.3, 0.4);
    let foot = DVec3::new(jet.point.x, 0.0, jet.point.z).normalize() * 5.0;
    assert!(jet.du.cross(jet.dv).dot(jet.point - foot) > 0.0);
    // twisted, it is fitted, and must agree with itself untwisted for a round profile
    let path = quarter();
    let round = tube(&path, 1.0, 1e-6).unwrap().surface.rows()[0].clone();
    assert!((round.point(1.0) - DVec3::new(5.0, 0.0, 0.0)).length() - 1.0 <= EXACT);
    let profile = profile(0.5, 1.0);
    let sweep = Sweep { up: Some(DVec3::Y), twist: FRAC_PI_2, ..Sweep::new(&profile, &path, 1e-5) };
    let twisted = sweep.build().unwrap();
    assert!(twisted.deviation > 0.0 && deviation(&sweep, &twisted.surface) <= twisted.deviation + INTEGRATED);
}

#[test]
fn what_cannot_be_swept() {
    let square = planar(&[(-0.1, -0.1), (0.1, -0.1), (0.1, 0.1)]);
    let path = line(&[DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0)]);
    let corner = Sweep::new(&square, &path, 1e-3).build();
    assert_eq!(corner, Err(ConstructError::Corner { what: "the path", parameter: 0.5 }));
    let nothing = line(&[DVec3::X, DVec3::X]);
    assert_eq!(Sweep::new(&square, &nothing, 1e-3).build(), Err(ConstructError::ZeroLength { what: "the path" }));
    let straight = line(&[DVec3::ZERO, DVec3::X]);
    for bad in [
        Sweep::new(&square, &straight, 0.0),
        Sweep::new(&square, &straight, f64::NAN),
        Sweep { scale: (1.0, 0.0), ..Sweep::new(&square, &straight, 1e-3) },
    ] {
        assert!(matches!(bad.build(), Err(ConstructError::Range { .. })));
    }
    let twisted = Sweep { twist: f64::NAN, ..Sweep::new(&square, &straight, 1e-3) };
    assert!(matches!(twisted.build(), Err(ConstructError::NotFinite { .. })));
    let point = planar(&[(1.0, 1.0), (1.0, 1.0)]);
    assert_eq!(Sweep::new(&point, &straight, 1e-3).build(), Err(ConstructError::ZeroLength { what: "the profile" }));
    let twisted = Sweep { twist: 1e4, ..Sweep::new(&square, &straight, 1e-9) };
    assert!(matches!(twisted.build(), Err(ConstructError::Bound { .. })), "more pieces than are allowed");
    let stops = [DVec3::ZERO, DVec3::ZERO, DVec3::X, DVec3::ONE].map(|p| DVec4::from_point(p, 1.0)).to_vec();
    let stops = BSpline::new(3, vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0], stops).unwrap();
    assert_eq!(
        Sweep::new(&square, &stops, 1e-3).build(),
        Err(ConstructError::Cusp { what: "the path", parameter: 0.0 })
    );
}

#[test]
fn a_tube_wider_than_its_bend_is_refused() {
    let Err(ConstructError::Folds { radius, .. }) = tube(&quarter(), 5.5, 1e-3) else { panic!("it folds") };
    assert!((radius - 5.0).abs() < 1e-9);
    assert!(tube(&quarter(), 4.5, 1e-3).is_ok());
    assert!(matches!(tube(&quarter(), -1.0, 1e-3), Err(ConstructError::Range { .. })));
    // a sweep whose profile is inside the circle of the bend on one side only
    let parabola = [DVec3::new(-2.0, 4.0, 0.0), DVec3::new(0.0, -4.0, 0.0), DVec3::new(2.0, 4.0, 0.0)];
    let points = parabola.map(|p| DVec4::from_point(p, 1.0)).to_vec();
    let path = BSpline::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], points).unwrap();
    let side = |x: f64| planar(&[(x, -0.1), (x, 0.1)]);
    let (inner, outer) = (side(0.6), side(-0.6)); // the bend's radius is 1/2
    let sweep = |p| Sweep { up: Some(DVec3::new(-1.0, 0.5, 0.0)), ..Sweep::new(p, &path, 1e-3) }.build();
    let folds = [sweep(&inner), sweep(&outer)].map(|s| matches!(s, Err(ConstructError::Folds { .. })));
    assert!(folds[0] != folds[1], "{folds:?}");
}
