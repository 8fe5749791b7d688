//! Snapping on a cylinder and a cube, whose vertices, edges and centres have closed forms.

use super::shapes;
use crate::model::{Camera, Instance, Model, Part, Primitive, Shape, Solid};
use crate::{EdgeTracer, Snap, SnapKind, Tracer};
use glam::{DAffine3, DVec2, DVec3};
use selvedge_geometry::construct::shapes as bodies;

const ALL: [SnapKind; 3] = [SnapKind::Vertex, SnapKind::Centre, SnapKind::Edge];
/// Edges lie on their surfaces within this.
const OFF: f64 = 1e-7;

fn view(eye: DVec3) -> Camera {
    Camera { size: (800, 600), ..shapes::view(eye) }
}

fn alone(part: Part) -> Model {
    let instance = Instance { part: 0, transform: DAffine3::IDENTITY, colour: None, name: String::new() };
    Model { parts: vec![part], instances: vec![instance], ..Model::default() }
}

fn snap(model: &Model, camera: &Camera, pixel: DVec2, radius: f64, kinds: &[SnapKind]) -> Option<Snap> {
    let tracer = Tracer::new(model);
    EdgeTracer::new(model, &tracer).unwrap().snap(camera, pixel, radius, kinds)
}

/// The seven visible corners of a cube are found; the eighth is hidden.
#[test]
fn vertices_are_found_where_they_are_seen() {
    let model = alone(bodies::block(-DVec3::ONE, DVec3::ONE).unwrap().part);
    let camera = view(DVec3::new(5.0, -6.0, 7.0));
    let mut hidden = 0;
    for k in 0..8u32 {
        let corner = DVec3::from_array([0, 1, 2].map(|a| if k >> a & 1 == 0 { -1.0 } else { 1.0 }));
        let (at, depth) = camera.project(corner).unwrap();
        let found = snap(&model, &camera, at + DVec2::new(1.5, -1.0), 4.0, &[SnapKind::Vertex]);
        let is_hidden = corner == DVec3::new(-1.0, 1.0, -1.0);
        let Some(found) = found else {
            assert!(is_hidden, "{corner}");
            hidden += 1;
            continue;
        };
        assert!(!is_hidden && found.kind == SnapKind::Vertex, "{found:?}");
        assert!(found.point.distance(corner) < OFF && (found.depth - depth).abs() < OFF, "{found:?}");
        assert!((found.distance_px - 1.5f64.hypot(1.0)).abs() < 1e-4, "{found:?}");
        assert_eq!(snap(&model, &camera, at + DVec2::new(9.0, 0.0), 4.0, &[SnapKind::Vertex]), None);
    }
    assert_eq!(hidden, 1);
}

#[test]
fn points_on_edges_and_centres_are_exact_and_kinds_have_their_order() {
    let model = alone(bodies::cylinder(0.8, 1.0).unwrap().part);
    let camera = view(DVec3::new(1.0, -5.0, 4.0));
    let (top, depth) = camera.project(DVec3::Z).unwrap();
    let centre = snap(&model, &camera, top + DVec2::new(0.5, 0.5), 3.0, &ALL).expect("the top's centre");
    assert!(centre.kind == SnapKind::Centre && centre.point.distance(DVec3::Z) < OFF, "{centre:?}");
    assert!((centre.depth - depth).abs() < OFF);
    // the front half of the bottom's rim is visible, so its centre is found though the body hides it
    let (bottom, _) = camera.project(DVec3::ZERO).unwrap();
    let centre = snap(&model, &camera, bottom, 2.0, &[SnapKind::Centre]).expect("the bottom's centre");
    assert!(centre.point.length() < OFF, "{centre:?}");

    for degrees in [10.0f64, 95.0, 215.0, 290.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let on = DVec3::new(0.8 * cos, 0.8 * sin, 1.0);
        let (at, _) = camera.project(on).unwrap();
        let found = snap(&model, &camera, at, 3.0, &[SnapKind::Edge]).expect("the rim");
        assert!(found.kind == SnapKind::Edge && found.point.distance(on) < 1e-6, "{degrees}: {found:?}");
        // the bottom's rim is found only where it lies in front of the body
        let below = DVec3::new(0.8 * cos, 0.8 * sin, 0.0);
        let (at, _) = camera.project(below).unwrap();
        let seen = sin < -0.3;
        let found = snap(&model, &camera, at, 1.0, &[SnapKind::Edge]).map(|found| found.point.distance(below) < 1e-6);
        assert_eq!(found.unwrap_or(false), seen, "{degrees}");
    }
}

/// A solid bar, which has no edges, before the middle of a square's lower edge: from a pixel over the bar, the edge is found
/// where it comes out.
#[test]
fn an_edge_is_found_where_it_comes_out_from_behind() {
    let camera = Camera { up: DVec3::Y, ..view(DVec3::Z * 5.0) };
    let square = shapes::rectangle(DVec3::new(-1.0, -1.0, 0.0), DVec3::X * 2.0, DVec3::Y * 2.0);
    let bar = Shape::Block { min: DVec3::new(-0.1, -1.5, 0.9), max: DVec3::new(0.1, 1.5, 1.0) };
    let bar = Primitive { shape: bar, transform: DAffine3::IDENTITY, colour: [1.0; 4], id: 9 };
    let part = Part { faces: vec![shapes::face(1, square, vec![])], ..Part::default() };
    let model = Model { solids: vec![Solid::of(bar).unwrap()], ..alone(part) };
    // as the eye sees it, the bar's side x = 0.1 at z = 1 is before this point
    let (side, _) = camera.project(DVec3::new(0.125, -1.0, 0.0)).unwrap();
    let pixel = side - DVec2::new(4.0, 0.0);
    let found = |radius: f64| snap(&model, &camera, pixel, radius, &[SnapKind::Edge]);
    assert_eq!(found(3.9), None);
    let out = found(4.1).expect("the edge beside the bar");
    assert!((out.pixel - side).length() < 1.0 / 32.0, "{out:?} {side}");
    let (at, _) = camera.project(out.point).unwrap();
    assert!(at.distance(out.pixel) < 1e-9 && (out.distance_px - 4.0).abs() < 1.0 / 32.0, "{out:?}");
}

#[test]
fn what_is_no_radius_finds_nothing() {
    let model = alone(bodies::block(-DVec3::ONE, DVec3::ONE).unwrap().part);
    let camera = view(DVec3::new(5.0, -6.0, 7.0));
    let (at, _) = camera.project(DVec3::ONE).unwrap();
    assert!(snap(&model, &camera, at, 3.0, &ALL).is_some());
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(snap(&model, &camera, at, radius, &ALL), None);
    }
    assert_eq!(snap(&model, &camera, DVec2::splat(f64::NAN), 3.0, &ALL), None);
    assert_eq!(snap(&model, &camera, at, 3.0, &[]), None);
}
