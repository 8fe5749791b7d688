//! Points in images made by exact rays, against closed forms.

use super::*;
use crate::pick::PickFilter;
use crate::session::World;
use glam::DQuat;
use selvedge::construct::shapes;
use selvedge::model::{Camera, Instance, Model, Part, Projection};
use selvedge_check::Tracer;
use std::collections::BTreeSet;

/// Tolerance of points with coordinates up to 10: some operations of 2⁻⁵² each.
const ROUNDING: f64 = 1e-13;
/// Radius and height of the cylinder.
const ROUND: (f64, f64) = (2.5, 7.0);

fn askew() -> DAffine3 {
    DAffine3::from_rotation_translation(
        DQuat::from_rotation_x(0.4) * DQuat::from_rotation_y(1.1),
        DVec3::new(3.0, -7.0, 20.0),
    )
}

/// A part that is placed askew.
fn world(mut part: Part) -> World {
    (1..).zip(&mut part.faces).for_each(|(id, face)| face.id = id);
    let placed = Instance { part: 0, transform: askew(), colour: None, name: String::new() };
    let mut world = World::default();
    world.model = Model { parts: vec![part], instances: vec![placed], ..Model::default() };
    world.bounds = world.model.bounds();
    world.find_edges();
    world
}

/// From a direction of the part.
fn camera(world: &World, from: DVec3) -> Camera {
    let up = DVec3::new(0.3, 0.4, 0.9);
    let [from, up] = [from, up].map(|direction| askew().transform_vector3(direction));
    Camera::around(world.bounds, from, up, 0.6, (400, 300))
}

/// Where a point of the part is in the picture, and its depth.
fn place(camera: &Camera, own: DVec3) -> (DVec2, f64) {
    camera.project(askew().transform_point3(own)).expect("in front")
}

/// The images around a place: hits of exact rays, and numbers of edges that pass so near and are not hidden.
fn images(world: &World, camera: &Camera, at: DVec2) -> Samples {
    const LINE_PX: f64 = 0.75;
    const SIDE: u32 = 17;
    let tracer = Tracer::new(&world.model);
    let slack = 0.03 * world.bounds.diagonal();
    let points = |edge: &Edge| -> Vec<(DVec2, f64)> {
        let each = |i: i32| f64::from(i) / 256.0;
        let own = edge.curve.iter().flat_map(|span| (0..=256).map(move |i| span.piece.point(each(i))));
        own.map(|p| place(camera, p)).collect()
    };
    let lines: Vec<_> = world.edges_of(0).expect("found").edges.iter().map(points).collect();
    let corner = (at.x as u32 - SIDE / 2, at.y as u32 - SIDE / 2);
    let sample = |i: u32| {
        let pixel = DVec2::new(f64::from(corner.0 + i % SIDE), f64::from(corner.1 + i / SIDE)) + 0.5;
        let hit = tracer.first(camera, pixel);
        let deepest = hit.map_or(f64::INFINITY, |hit| hit.depth) + slack;
        let is_seen = |line: &Vec<(DVec2, f64)>| {
            line.iter().any(|(place, depth)| place.distance(pixel) <= LINE_PX && *depth <= deepest)
        };
        let edge = lines.iter().position(is_seen).map_or(0, |number| number as u32 + 1);
        let nothing =
            Sample { depth: f32::INFINITY, face: 0, uv: [f32::NAN; 2], normal: [0.0; 3], edge, part: 0, instance: 0 };
        hit.map_or(nothing, |hit| {
            let (depth, uv) = (hit.depth as f32, [hit.uv.x as f32, hit.uv.y as f32]);
            Sample { depth, face: hit.face, uv, part: 1, instance: 1, ..nothing }
        })
    };
    Samples { corner, width: SIDE, samples: (0..SIDE * SIDE).map(sample).collect() }
}

fn pick(world: &World, camera: &Camera, at: DVec2, hidden: &[usize]) -> Option<Picked> {
    let (placement, hidden): (_, BTreeSet<usize>) = (|_: usize| askew(), hidden.iter().copied().collect());
    let seen = Seen { world, instances: &[0], hidden: &hidden, placement: &placement, camera };
    images(world, camera, at).pick(&seen, at, PickFilter::Points).picked
}

/// The place of a picked point of this kind, part coordinates.
fn point(picked: Option<Picked>, wanted: PointKind) -> DVec3 {
    match picked {
        Some(Picked::Point { instance: 0, kind, at, .. }) if kind == wanted => at,
        other => panic!("{other:?} instead of {wanted:?}"),
    }
}

#[test]
fn vertices_come_first_and_then_the_nearest_and_what_is_in_front() {
    let point = |kind, distance_px: f64, depth: f64| {
        let picked = Picked::Point { instance: 0, kind, of: 0, at: DVec3::new(distance_px, depth, 0.0) };
        Candidate { picked, distance_px, depth }
    };
    let vertex = Candidate { picked: Picked::Vertex { instance: 0, vertex: 3 }, distance_px: 6.9, depth: 9.0 };
    let (face, edge) = (point(PointKind::OnFace, 0.0, 1.0), point(PointKind::OnEdge, 2.0, 1.0));
    let (middle, centre) = (point(PointKind::Middle, 5.0, 3.0), point(PointKind::Centre, 3.0, 4.0));
    assert_eq!(choose(&[face, edge, middle, vertex, centre]), Some(vertex.picked));
    assert_eq!(choose(&[face, edge, middle, centre]), Some(centre.picked), "it is nearer by two pixels");
    assert_eq!(choose(&[face, edge, middle]), Some(middle.picked));
    assert_eq!(choose(&[face, edge]), Some(edge.picked));
    assert_eq!(choose(&[face]), Some(face.picked));
    assert_eq!(choose(&[]), None);
    let behind = point(PointKind::Centre, 2.5, 8.0);
    assert_eq!(choose(&[behind, centre]), Some(centre.picked), "at the same place, and in front");
    let nearer = point(PointKind::Centre, 1.0, 8.0);
    assert_eq!(choose(&[nearer, centre]), Some(nearer.picked));
}

/// Of a block seen from above a corner, seven corners and nine edges are seen.
#[test]
fn corners_and_middles_that_are_seen_are_found_beside_the_cursor() {
    let world = world(shapes::block(DVec3::ZERO, DVec3::new(3.0, 2.0, 1.5)).expect("a block").part);
    let camera = camera(&world, DVec3::new(1.0, -1.6, 1.1));
    let tracer = Tracer::new(&world.model);
    let is_hidden = |own: DVec3| {
        let (pixel, depth) = place(&camera, own);
        tracer.first(&camera, pixel).is_some_and(|hit| hit.depth < depth - 1e-3)
    };
    let edges = world.edges_of(0).expect("found");
    let mut seen = (0, 0);
    for (vertex, own) in edges.vertices.iter().enumerate() {
        let found = pick(&world, &camera, place(&camera, *own).0 + DVec2::new(-3.0, 4.0), &[]);
        let expected = Some(Picked::Vertex { instance: 0, vertex });
        assert_eq!(found == expected, !is_hidden(*own), "{own}: {found:?}");
        seen.0 += usize::from(found == expected);
    }
    for (number, edge) in edges.edges.iter().enumerate() {
        let [from, to] = edge.ends.map(|end| edges.vertices[end]);
        let middle = 0.5 * (from + to);
        let found = pick(&world, &camera, place(&camera, middle).0 + DVec2::new(2.0, -1.5), &[]);
        let is_it = matches!(found, Some(Picked::Point { kind: PointKind::Middle, of, .. }) if of == number);
        assert_eq!(is_it, !is_hidden(middle), "{middle}: {found:?}");
        if is_it {
            assert!(point(found, PointKind::Middle).distance(middle) < ROUNDING);
            seen.1 += 1;
        }
    }
    assert_eq!(seen, (7, 9));
}

#[test]
fn a_hole_s_centre_is_found_in_the_air_and_a_hidden_one_is_not() {
    let tube = world(shapes::tube(4.0, 1.25, ROUND.1).expect("a tube").part);
    let through = camera(&tube, DVec3::new(0.02, 0.01, 1.0));
    let top = DVec3::Z * ROUND.1;
    // the centre of the other end is seen through the hole, on the other side of this one
    let [near, far] = [top, DVec3::ZERO].map(|p| place(&through, p).0);
    let at = near + 4.0 * (near - far).normalize();
    let found = point(pick(&tube, &through, at, &[]), PointKind::Centre);
    assert!(found.distance(top) < ROUNDING, "{found}");
    assert_eq!(pick(&tube, &through, at, &[0]), None, "a part that is not shown has no centres");

    let world = world(shapes::cylinder(ROUND.0, ROUND.1).expect("a cylinder").part);
    let camera = camera(&world, DVec3::new(0.15, 0.1, 1.0));
    let found = point(pick(&world, &camera, place(&camera, top).0 + 2.0, &[]), PointKind::Centre);
    assert!(found.distance(top) < ROUNDING, "{found}");
    // the other end lies behind the solid
    let found = pick(&world, &camera, place(&camera, DVec3::ZERO).0, &[]);
    assert!(matches!(found, Some(Picked::Point { kind: PointKind::OnFace, .. })), "{found:?}");
}

#[test]
fn points_on_faces_and_edges_are_exact_and_under_the_cursor() {
    let world = world(shapes::cylinder(ROUND.0, ROUND.1).expect("a cylinder").part);
    let towards = DVec2::from_angle(0.9);
    let camera = camera(&world, DVec3::new(towards.x, towards.y, 0.3));
    let round = |angle: f64, z: f64| (DVec2::from_angle(angle) * ROUND.0).extend(z);
    for (angle, z) in [(0.7, 3.0), (0.9, 3.5), (1.2, 4.0)] {
        let at = place(&camera, round(angle, z)).0 + DVec2::new(0.3, -0.2);
        let found = point(pick(&world, &camera, at, &[]), PointKind::OnFace);
        assert!((found.truncate().length() - ROUND.0).abs() < ROUNDING, "{found}");
        // single precision alone would be off by 1e-5 pixels and more
        assert!(place(&camera, found).0.distance(at) < 1e-8, "{found}");
    }
    for angle in [0.5, 1.4, 2.0] {
        let at = place(&camera, round(angle, ROUND.1)).0 + DVec2::new(-0.5, 2.0);
        let found = point(pick(&world, &camera, at, &[]), PointKind::OnEdge);
        assert!((found.truncate().length() - ROUND.0).abs() < ROUNDING && (found.z - ROUND.1).abs() < ROUNDING);
        let all = (0..20_000).map(|i| round(f64::from(i) / 20_000.0 * std::f64::consts::TAU, ROUND.1));
        let least = all.map(|p| place(&camera, p).0.distance(at)).fold(f64::INFINITY, f64::min);
        assert!(place(&camera, found).0.distance(at) < least + 1e-9, "{found}");
    }
}

/// A rim seen edge-on has two points at each place of the picture.
#[test]
fn of_two_points_at_one_place_the_one_in_front_is_found() {
    let world = world(shapes::cylinder(ROUND.0, ROUND.1).expect("a cylinder").part);
    let towards = DVec2::from_angle(0.9);
    let projection = Projection::Orthographic { height: world.bounds.diagonal() };
    let camera = Camera { projection, ..camera(&world, towards.extend(0.0)) };
    for turn in [-0.6, -0.2, 0.3, 0.7] {
        let front = (DVec2::from_angle(0.9 + turn) * ROUND.0).extend(ROUND.1);
        let found = point(pick(&world, &camera, place(&camera, front).0 + 0.8, &[]), PointKind::OnEdge);
        assert!(found.truncate().dot(towards) > 0.5 * ROUND.0, "{turn}: {found}");
    }
}
