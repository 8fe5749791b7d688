//! Visibility of edges of convex bodies, which their normals tell, and of what stands before or flush with others.

use super::shapes::{face, model, parallel, rectangle, view};
use crate::model::{Camera, Instance, Model, Part, Primitive, Shape, Solid};
use crate::{EdgePoint, EdgeTracer, Tracer, Visibility};
use glam::{DAffine3, DVec3};
use selvedge_geometry::construct::shapes;

fn points(model: &Model, camera: &Camera, spacing: f64) -> Vec<EdgePoint> {
    let tracer = Tracer::new(model);
    let edges = EdgeTracer::new(model, &tracer).unwrap();
    let points = edges.points(camera, spacing);
    assert_eq!(tracer.given_up(), 0);
    points
}

fn of(part: Part, transforms: &[DAffine3]) -> Model {
    let closed = part.closed;
    let mut model = model(part.faces, transforms);
    model.parts[0].closed = closed;
    model
}

/// Towards the eye.
fn to_eye(camera: &Camera, p: DVec3) -> DVec3 {
    if camera.is_perspective() { camera.eye - p } else { camera.eye - camera.target }
}

/// All points, and how many of them are visible; each as the normals of its faces say.
#[track_caller]
fn convex(model: &Model, camera: &Camera, normals: impl Fn(DVec3) -> Vec<DVec3>) -> (usize, usize) {
    let points = points(model, camera, 3.0);
    for p in &points {
        let v = to_eye(camera, p.point);
        let faces = normals(p.point).iter().any(|n| n.dot(v) > 0.0);
        let wanted = if faces { Visibility::Visible } else { Visibility::Hidden };
        assert_eq!(p.visibility, wanted, "{p:?}");
    }
    (points.len(), points.iter().filter(|p| p.visibility == Visibility::Visible).count())
}

#[test]
fn a_block_hides_its_far_edges() {
    let model = of(shapes::block(-DVec3::ONE * 0.5, DVec3::ONE * 0.5).unwrap().part, &[DAffine3::IDENTITY]);
    let normals = |p: DVec3| {
        let side = |x: f64, n: DVec3| (x.abs() > 0.5 - 1e-9).then_some(n * x.signum());
        [side(p.x, DVec3::X), side(p.y, DVec3::Y), side(p.z, DVec3::Z)].into_iter().flatten().collect()
    };
    for eye in [DVec3::new(3.0, 2.0, 1.5), DVec3::new(-1.0, 4.0, -2.0), DVec3::new(0.1, 0.2, -5.0)] {
        for camera in [view(eye), parallel(eye)] {
            let (all, visible) = convex(&model, &camera, normals);
            assert!(all > 60 && visible > all / 2 && visible < all, "{visible} of {all}");
        }
    }
}

#[test]
fn a_ball_hides_the_far_half_of_its_seam() {
    let model = of(shapes::sphere(1.0).unwrap().part, &[DAffine3::from_scale(DVec3::splat(0.7))]);
    let (all, visible) = convex(&model, &view(DVec3::new(2.0, 1.5, 2.0)), |p| vec![p]);
    assert!(visible > 10 && visible < all, "{visible} of {all}");
}

/// The far half of a cylinder's rim lies behind its own side, the near half of the lower one before it.
#[test]
fn a_cylinder_hides_half_a_rim() {
    let model = of(shapes::cylinder(0.8, 1.0).unwrap().part, &[DAffine3::IDENTITY]);
    let normals = |p: DVec3| {
        let radial = DVec3::new(p.x, p.y, 0.0);
        let side = (radial.length() > 0.8 - 1e-9).then_some(radial);
        let cap = if p.z > 1.0 - 1e-9 { Some(DVec3::Z) } else { (p.z < 1e-9).then_some(-DVec3::Z) };
        side.into_iter().chain(cap).collect()
    };
    let (all, visible) = convex(&model, &view(DVec3::new(2.0, 1.0, 2.5)), normals);
    assert!(visible > 50 && visible < all, "{visible} of {all}");
}

/// One of two instances stands before the other.
#[test]
fn what_stands_before_hides() {
    let square = rectangle(DVec3::new(-0.2, -0.2, 0.0), DVec3::X * 0.4, DVec3::Y * 0.4);
    let camera = Camera { up: DVec3::Y, ..view(DVec3::Z * 3.0) };
    let before = DAffine3::from_scale_rotation_translation(
        DVec3::new(1.5, 0.5, 1.0),
        glam::DQuat::IDENTITY,
        DVec3::new(0.0, 0.0, 1.0),
    );
    let model = model(vec![face(1, square, vec![])], &[DAffine3::IDENTITY, before]);
    let points = points(&model, &camera, 0.5);
    for p in &points {
        // as the eye sees it, the front one is half as large again and covers this much of the plane of the other
        let covered = p.instance == 0 && p.point.x.abs() < 0.45 && p.point.y.abs() < 0.15;
        let wanted = if covered { Visibility::Hidden } else { Visibility::Visible };
        assert_eq!(p.visibility, wanted, "{p:?}");
    }
    let count = |v: Visibility| points.iter().filter(|p| p.visibility == v).count();
    assert!(count(Visibility::Hidden) > 20 && count(Visibility::Visible) > 100);
}

/// A label on a wall has the wall's depth: visibility of its edges is unsure. A label before the wall is visible.
#[test]
fn what_lies_flush_is_unsure() {
    let camera = Camera { up: DVec3::Y, ..view(DVec3::new(0.3, 0.2, 3.0)) };
    let flush = |gap: f64| {
        let wall = Part {
            faces: vec![face(1, rectangle(-DVec3::ONE, DVec3::X * 2.0, DVec3::Y * 2.0), vec![])],
            ..Part::default()
        };
        let label = rectangle(DVec3::new(-0.2, -0.2, -1.0 + gap), DVec3::X * 0.4, DVec3::Y * 0.4);
        let label = Part { faces: vec![face(2, label, vec![])], ..Part::default() };
        let instances =
            (0..2).map(|part| Instance { part, transform: DAffine3::IDENTITY, colour: None, name: String::new() });
        let model = Model { instances: instances.collect(), parts: vec![wall, label], ..Model::default() };
        points(&model, &camera, 1.0).into_iter().filter(|p| p.instance == 1).map(|p| p.visibility).collect::<Vec<_>>()
    };
    // rounding may put the wall behind its label
    assert!(flush(0.0).iter().all(|v| matches!(v, Visibility::Unsure | Visibility::Visible)));
    assert!(flush(-1e-12).iter().all(|v| *v == Visibility::Unsure));
    assert!(flush(1e-6).iter().all(|v| *v == Visibility::Visible));
    assert!(flush(-1e-6).iter().all(|v| *v == Visibility::Hidden));
}

/// A cylinder's rim just behind its side's fold: unsure to 1/256 px from the fold, hidden farther away.
#[test]
fn a_rim_beside_its_fold_is_unsure() {
    let model = of(shapes::cylinder(0.8, 1.0).unwrap().part, &[DAffine3::IDENTITY]);
    let camera = parallel(DVec3::new(3.0, 0.0, 1.5));
    let tracer = Tracer::new(&model);
    let edges = EdgeTracer::new(&model, &tracer).unwrap();
    let rim = |e: &crate::model::Edge| e.curve.iter().all(|span| span.piece.point(0.5).z.abs() < 1e-9);
    let lower = edges.parts()[0].edges.iter().position(rim).unwrap();
    let mut probe = tracer.probe(&camera);
    let pixel = 1.0 / camera.focal_px().x;
    // pixels behind the fold, whose sides are y = 0.8 and y = -0.8
    let mut at = |px: f64| {
        let y = 0.8 - px * pixel;
        edges.visibility(0, lower, DVec3::new(-(0.64 - y * y).sqrt(), y, 0.0), &mut probe)
    };
    assert_eq!(at(1.0 / 300.0), Visibility::Unsure);
    assert_eq!(at(1.0 / 200.0), Visibility::Hidden);
    assert_eq!(at(1.0), Visibility::Hidden);
}

/// A ball before a square hides it, one of glass does not; and a volume that trims cuts edges away.
#[test]
fn glass_hides_nothing_and_volumes_cut() {
    let square = rectangle(DVec3::new(-0.2, -0.2, 0.0), DVec3::X * 0.4, DVec3::Y * 0.4);
    let camera = Camera { up: DVec3::Y, ..view(DVec3::Z * 3.0) };
    let plain = model(vec![face(1, square, vec![])], &[DAffine3::IDENTITY]);
    let ball = |z: f64, radius: f64, opacity: f32| {
        let transform = DAffine3::from_translation(DVec3::Z * z);
        let colour = [0.5, 0.5, 0.5, opacity];
        Solid::of(Primitive { shape: Shape::Sphere { radius }, transform, colour, id: 9 }).unwrap()
    };
    let seen = |model: &Model| points(model, &camera, 1.0).iter().map(|p| p.visibility).collect::<Vec<_>>();
    for (opacity, wanted) in [(1.0, Visibility::Hidden), (0.5, Visibility::Visible)] {
        let model = Model { solids: vec![ball(1.0, 0.6, opacity)], ..plain.clone() };
        let seen = seen(&model);
        assert!(seen.len() > 20 && seen.iter().all(|v| *v == wanted), "{opacity}: {seen:?}");
    }
    let mut cut = plain;
    cut.trim_by(&ball(0.0, 0.25, 1.0)).unwrap();
    for p in points(&cut, &camera, 0.2) {
        let wanted = if p.point.length() < 0.25 { Visibility::Visible } else { Visibility::Cut };
        assert_eq!(p.visibility, wanted, "{p:?}");
    }
}
