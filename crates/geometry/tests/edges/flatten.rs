//! Lines against dense samples of their curves.

use glam::{DVec2, DVec3, DVec4};
use selvedge_geometry::construct::curve;
use selvedge_geometry::edges::flatten::{Flattening, Lines};
use selvedge_geometry::model::{Camera, Edge, EdgeKind, Projection};
use selvedge_geometry::spline::{BSpline, Bezier, Control, Span};

const TOLERANCE: f64 = 0.1;
/// Pixels around the picture.
const MARGIN: f64 = 2.0;

fn edge(curve: &BSpline<DVec4>) -> Edge {
    Edge {
        curve: curve.beziers(),
        ends: [0, 0],
        uses: Vec::new(),
        source: None,
        kind: EdgeKind::Border,
        turn: f64::NAN,
        deviation: 0.0,
    }
}

fn of(points: Vec<DVec4>) -> Edge {
    let piece = Bezier { points };
    Edge {
        curve: vec![Span { start: 0.0, end: 1.0, piece }],
        ends: [0, 0],
        uses: Vec::new(),
        source: None,
        kind: EdgeKind::Border,
        turn: f64::NAN,
        deviation: 0.0,
    }
}

/// Looks along -z at the origin from `distance`; one model unit there is `pixels` pixels.
fn camera(at: DVec3, distance: f64, pixels: f64) -> Camera {
    let fov_y = 2.0 * (300.0 / (pixels * distance)).atan();
    Camera {
        eye: at + DVec3::Z * distance,
        target: at,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y },
        depth_range: (1e-3 * distance, 100.0 * distance),
        size: (800, 600),
    }
}

fn distance(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let t = (p - a).dot(along) / along.length_squared();
    p.distance(a + along * if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) })
}

/// Every point of the curve that the picture shows is near the line, and every point of the line near the curve; the
/// largest distance found.
#[track_caller]
fn compare(edge: &Edge, camera: &Camera, lines: &Lines, parameters: impl Iterator<Item = f64>) -> f64 {
    assert_eq!(lines.unresolved, 0);
    let inside = |p: DVec2| p.x >= 0.0 && p.y >= 0.0 && p.x <= 800.0 && p.y <= 600.0;
    let at = |t: f64| {
        let k = (t as usize).min(edge.curve.len() - 1);
        camera.project(edge.curve[k].piece.point(t - k as f64))
    };
    let mut worst: f64 = 0.0;
    for t in parameters {
        let Some((pixel, depth)) = at(t) else { continue };
        if !inside(pixel) || depth < camera.depth_range.0 || depth > camera.depth_range.1 {
            continue;
        }
        let chords = lines.lines.iter().flat_map(|l| l.windows(2));
        let near = chords.filter(|w| t >= w[0].parameter && t <= w[1].parameter);
        let off = near.map(|w| distance(pixel, w[0].pixel(), w[1].pixel())).fold(f64::INFINITY, f64::min);
        worst = worst.max(off);
    }
    for w in lines.lines.iter().flat_map(|l| l.windows(2)) {
        for k in 0..=8 {
            let s = f64::from(k) / 8.0;
            let h = w[0].position.lerp(w[1].position, s);
            let pixel = DVec2::new(h.x, h.y) / h.w;
            if inside(pixel) {
                let (exact, _) = at(w[0].parameter + (w[1].parameter - w[0].parameter) * s).unwrap();
                worst = worst.max(exact.distance(pixel));
            }
        }
    }
    worst
}

fn dense(edge: &Edge, count: usize) -> impl Iterator<Item = f64> + use<> {
    let pieces = edge.curve.len() as f64;
    (0..=count).map(move |k| pieces * k as f64 / count as f64)
}

#[test]
fn a_circle_is_within_a_tenth_of_a_pixel() {
    let circle = edge(&curve::circle(DVec3::ZERO, DVec3::Z, DVec3::X, 1.0, std::f64::consts::TAU).unwrap());
    let camera = camera(DVec3::ZERO, 5.0, 250.0);
    let lines = Flattening::new(&camera, TOLERANCE, MARGIN).edge(&circle);
    let worst = compare(&circle, &camera, &lines, dense(&circle, 20_000));
    // the tolerance is used, not undercut by far
    assert!(worst <= TOLERANCE && worst > 0.1 * TOLERANCE, "{worst}");
    assert_eq!(lines.lines.len(), 1);
    let coarse = Flattening::new(&camera, 1.0, MARGIN).edge(&circle);
    let worst = compare(&circle, &camera, &coarse, dense(&circle, 20_000));
    assert!(worst <= 1.0 && worst > TOLERANCE, "{worst}");
}

/// A million times as large, at a point of the circle: a few chords, as exact as before.
#[test]
fn a_million_times_as_large() {
    let circle = edge(&curve::circle(DVec3::ZERO, DVec3::Z, DVec3::X, 1.0, std::f64::consts::TAU).unwrap());
    for angle in [0.3_f64, 2.0, 5.5] {
        let at = DVec3::new(angle.cos(), angle.sin(), 0.0);
        let camera = camera(at, 5.0, 250e6);
        let lines = Flattening::new(&camera, TOLERANCE, MARGIN).edge(&circle);
        assert_eq!(lines.lines.len(), 1);
        let line = &lines.lines[0];
        assert!(line.len() < 40, "{}", line.len());
        let (a, b) = (line[0].parameter, line[line.len() - 1].parameter);
        let worst = compare(&circle, &camera, &lines, (0..=5000).map(|k| a + (b - a) * f64::from(k) / 5000.0));
        assert!(worst <= TOLERANCE, "{worst}");
        // it crosses the picture: the ends are outside it
        let outside = |p: DVec2| p.x < 0.0 || p.y < 0.0 || p.x > 800.0 || p.y > 600.0;
        assert!(outside(line[0].pixel()) && outside(line[line.len() - 1].pixel()));
        // no point of the circle within the picture is left out
        let near = (0..=2000).map(|k| angle + (f64::from(k) / 1000.0 - 1.0) * 2e-6);
        for angle in near {
            let Some((pixel, _)) = camera.project(DVec3::new(angle.cos(), angle.sin(), 0.0)) else { panic!() };
            if !outside(pixel) {
                let off = line.windows(2).map(|w| distance(pixel, w[0].pixel(), w[1].pixel())).fold(f64::MAX, f64::min);
                assert!(off <= TOLERANCE, "{off}");
            }
        }
    }
}

/// Weights far apart, every degree, seen aslant: the bound holds.
#[test]
fn wild_curves_keep_the_bound() {
    let mut random = selvedge_geometry::math::random::Random::new(7);
    let mut number = |a: f64, b: f64| random.range(a, b);
    for degree in 1..=9 {
        for _ in 0..6 {
            let points = (0..=degree).map(|_| {
                let p = DVec3::new(number(-1.5, 1.5), number(-1.0, 1.0), number(-2.0, 2.0));
                DVec4::from_point(p, number(0.2, 5.0))
            });
            let edge = of(points.collect());
            let camera = camera(DVec3::ZERO, 4.0, 250.0);
            let lines = Flattening::new(&camera, TOLERANCE, MARGIN).edge(&edge);
            let worst = compare(&edge, &camera, &lines, dense(&edge, 4000));
            assert!(worst <= TOLERANCE, "degree {degree}: {worst}");
        }
    }
}

/// A line beside the eye, and through the eye's plane: shown as far as it is in front of the near plane.
#[test]
fn a_line_past_the_eye_is_cut_at_the_near_plane() {
    let line = of([DVec3::new(0.1, 0.1, -4.0), DVec3::new(0.1, 0.1, 8.0)].map(|p| p.extend(1.0)).to_vec());
    let mut camera = camera(DVec3::ZERO, 4.0, 250.0);
    camera.depth_range = (1.0, 100.0);
    let lines = Flattening::new(&camera, TOLERANCE, MARGIN).edge(&line);
    assert_eq!((lines.lines.len(), lines.unresolved), (1, 0));
    let last = lines.lines[0].last().unwrap();
    assert!((last.position.z - 1.0).abs() < 1e-12, "{}", last.position.z);
    // behind the eye, and beyond the farthest depth
    camera.eye.z = -10.0;
    camera.target.z = -20.0;
    assert!(Flattening::new(&camera, TOLERANCE, MARGIN).edge(&line).lines.is_empty());
    camera.eye.z = 200.0;
    camera.target.z = 0.0;
    assert!(Flattening::new(&camera, TOLERANCE, MARGIN).edge(&line).lines.is_empty());
}

#[test]
fn a_parallel_view_keeps_the_bound() {
    let circle =
        edge(&curve::circle(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0), DVec3::X, 1.0, std::f64::consts::TAU).unwrap());
    let mut camera = camera(DVec3::ZERO, 5.0, 250.0);
    camera.projection = Projection::Orthographic { height: 2.2 };
    let lines = Flattening::new(&camera, TOLERANCE, MARGIN).edge(&circle);
    let worst = compare(&circle, &camera, &lines, dense(&circle, 20_000));
    assert!(worst <= TOLERANCE && worst > 0.1 * TOLERANCE, "{worst}");
}
