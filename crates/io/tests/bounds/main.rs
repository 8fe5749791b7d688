//! Boxes of faces with closed-form equations: their extent is known.

#[path = "../../../geometry/tests/trim/bounds/support.rs"]
mod support;

use glam::DVec3;
use selvedge_geometry::model::{Bounds, Face};
use selvedge_geometry::trim::ANALYTIC;
use selvedge_io::brep::{Boundary, CurveGeometry, Edge, FaceGeometry, Frame, SurfaceGeometry, build_face};
use selvedge_io::import::step;
use std::f64::consts::{FRAC_PI_2, TAU};
use support::{assert_box, assert_support};

/// Edges of one face, in the order of its loop.
#[derive(Default)]
struct Edges(Vec<Edge>);

impl Edges {
    fn add(&mut self, curve: CurveGeometry, start: DVec3, end: DVec3, forward: bool) -> (usize, bool) {
        let id = 101 + self.0.len() as u32;
        self.0.push(Edge { id, curve, start, end, same_sense: true });
        (self.0.len() - 1, forward)
    }

    fn line(&mut self, start: DVec3, end: DVec3) -> (usize, bool) {
        self.add(CurveGeometry::Line { origin: start, direction: end - start }, start, end, true)
    }

    /// The arc of a circle between two angles, from the second to the first where it is not forward.
    fn arc(&mut self, frame: Frame, radius: f64, (a, b): (f64, f64), forward: bool) -> (usize, bool) {
        let at = |t: f64| frame.origin + radius * (frame.x * t.cos() + frame.y * t.sin());
        let end = if b - a == TAU { at(a) } else { at(b) };
        self.add(CurveGeometry::Circle { frame, radius }, at(a), end, forward)
    }

    /// The face, and how far its trims may be off.
    fn face(&self, surface: SurfaceGeometry, bounds: Vec<Vec<(usize, bool)>>) -> (Face, f64) {
        let bounds = bounds.into_iter().map(Boundary::Edges).collect();
        let built =
            build_face(&FaceGeometry { id: 7, surface, bounds, same_sense: true, ambiguous: false }, &self.0, 1e-6)
                .unwrap();
        (built.face, built.deviation)
    }
}

fn frame_at(origin: DVec3) -> Frame {
    Frame { origin, ..Frame::WORLD }
}

/// The plane through the z axis at an angle.
fn meridian(angle: f64, out: f64) -> Frame {
    let x = DVec3::new(angle.cos(), angle.sin(), 0.0);
    Frame { origin: x * out, x, y: DVec3::Z, z: x.cross(DVec3::Z) }
}

/// Shares of a face's diagonal: the promise, and what its trims are off.
fn share((face, deviation): &(Face, f64)) -> f64 {
    2.0 * ANALYTIC + deviation / face.bounds().diagonal()
}

#[test]
fn an_octant_of_a_sphere() {
    const R: f64 = 3.0;
    let mut edges = Edges::default();
    let quarter = (0.0, FRAC_PI_2);
    let loops = vec![
        edges.arc(Frame::WORLD, R, quarter, true),
        edges.arc(meridian(FRAC_PI_2, 0.0), R, quarter, true),
        edges.arc(meridian(0.0, 0.0), R, quarter, false),
    ];
    let octant = edges.face(SurfaceGeometry::Sphere { frame: Frame::WORLD, radius: R }, vec![loops]);
    // the nearest direction within the octant
    let support = |d: DVec3| {
        let inside = d.max(DVec3::ZERO).length();
        R * if inside > 0.0 { inside } else { d.max_element() }
    };
    assert_support(&octant.0, support, share(&octant));
    let corner = Bounds { min: DVec3::ZERO, max: DVec3::splat(R) };
    assert_box(octant.0.bounds(), corner, share(&octant));
}

#[test]
fn a_piece_of_a_torus() {
    const MAJOR: f64 = 4.0;
    const MINOR: f64 = 1.0;
    let ((a, b), (c, d)) = ((0.3, 1.1), (-0.5, 0.9));
    let mut edges = Edges::default();
    let ring = |v: f64| (frame_at(DVec3::Z * MINOR * v.sin()), MAJOR + MINOR * v.cos());
    let loops = vec![
        edges.arc(ring(c).0, ring(c).1, (a, b), true),
        edges.arc(meridian(b, MAJOR), MINOR, (c, d), true),
        edges.arc(ring(d).0, ring(d).1, (a, b), false),
        edges.arc(meridian(a, MAJOR), MINOR, (c, d), false),
    ];
    let surface = SurfaceGeometry::Torus { frame: Frame::WORLD, major: MAJOR, minor: MINOR };
    let piece = edges.face(surface, vec![loops]);
    let (outer, inner) = (MAJOR + MINOR, MAJOR + MINOR * d.cos());
    let expected = Bounds {
        min: DVec3::new(inner * b.cos(), inner * a.sin(), MINOR * c.sin()),
        max: DVec3::new(outer * a.cos(), outer * b.sin(), MINOR * d.sin()),
    };
    assert_box(piece.0.bounds(), expected, share(&piece));
    // the control points are far from that
    assert!(piece.0.control_bounds().diagonal() > 1.05 * expected.diagonal());
}

/// z from 0 to the plane z = 3 + x / 2.
#[test]
fn a_cylinder_cut_on_a_slant() {
    const R: f64 = 2.0;
    let mut edges = Edges::default();
    let bottom = edges.arc(Frame::WORLD, R, (0.0, TAU), true);
    let slant = DVec3::new(1.0, 0.0, 0.5);
    let x = slant.normalize();
    let frame = Frame { origin: DVec3::Z * 3.0, x, y: DVec3::Y, z: x.cross(DVec3::Y) };
    let ellipse = CurveGeometry::Ellipse { frame, semi_x: R * slant.length(), semi_y: R };
    let tip = frame.origin + R * slant;
    let top = edges.add(ellipse, tip, tip, false);
    let surface = SurfaceGeometry::Cylinder { frame: Frame::WORLD, radius: R };
    let cut = edges.face(surface, vec![vec![bottom], vec![top]]);
    let support = |d: DVec3| {
        let below = R * d.truncate().length();
        below.max(3.0 * d.z + R * (d.x + 0.5 * d.z).hypot(d.y))
    };
    assert_support(&cut.0, support, share(&cut));
}

#[test]
fn a_cone_between_two_circles() {
    let (low, high, height): (f64, f64, f64) = (1.0, 3.0, 2.0);
    let mut edges = Edges::default();
    let bottom = edges.arc(Frame::WORLD, low, (0.0, TAU), true);
    let top = edges.arc(frame_at(DVec3::Z * height), high, (0.0, TAU), false);
    let half_angle = ((high - low) / height).atan();
    let surface = SurfaceGeometry::Cone { frame: Frame::WORLD, radius: low, half_angle };
    let cone = edges.face(surface, vec![vec![bottom], vec![top]]);
    let support = |d: DVec3| {
        let around = d.truncate().length();
        (low * around).max(high * around + height * d.z)
    };
    assert_support(&cone.0, support, share(&cone));
}

/// The surface is a parallelogram, half of which the loop leaves.
#[test]
fn a_triangle_of_a_plane() {
    let corners = [DVec3::ZERO, DVec3::new(4.0, 1.0, 0.0), DVec3::new(1.0, 5.0, 2.0)];
    let across = corners[1].cross(corners[2]);
    let mut edges = Edges::default();
    let loops = (0..3).map(|i| edges.line(corners[i], corners[(i + 1) % 3])).collect();
    let frame = Frame::new(corners[0], across, corners[1]).unwrap();
    let triangle = edges.face(SurfaceGeometry::Plane { frame }, vec![loops]);
    let support = |d: DVec3| corners.map(|c| d.dot(c)).into_iter().fold(f64::NEG_INFINITY, f64::max);
    assert_support(&triangle.0, support, 1e-12);
}

#[test]
fn files_whose_control_points_reach_farther() {
    let bounds = |text: &[u8]| step(text, "t").unwrap().model.bounds();
    let tetrahedron = Bounds { min: DVec3::ZERO, max: DVec3::splat(10.0) };
    assert_box(bounds(include_bytes!("tetrahedron.stp")), tetrahedron, 1e-12);
    let apple = DVec3::new(14.0, 14.0, 10.0);
    assert_box(bounds(include_bytes!("apple.stp")), Bounds { min: -apple, max: apple }, ANALYTIC);
}
