//! Picks from hand-made images.

use super::*;
use crate::session::{Loaded, World};
use std::path::Path;
use std::sync::Arc;

fn world() -> World {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/bracket.step");
    let import = selvedge_io::import::open(&path).expect("a sample");
    let world = World::new(&[Arc::new(Loaded { path, import, partial: false })]);
    world.find_edges();
    world
}

const NOTHING: Sample =
    Sample { depth: f32::INFINITY, face: 0, uv: [f32::NAN; 2], normal: [0.0; 3], edge: 0, part: 0, instance: 0 };

/// A view of the middle of a face, its pixel, and the values that the engine would write there.
fn over_face(world: &World, face: usize) -> (Camera, DVec2, Sample, DVec3) {
    let surface = &world.model.parts[0].faces[face].surface;
    let ((u0, u1), (v0, v1)) = surface.domain();
    let uv = DVec2::new(0.3 * u0 + 0.7 * u1, 0.6 * v0 + 0.4 * v1);
    let jet = surface.jet2(uv.x, uv.y);
    let normal = jet.du.cross(jet.dv).normalize();
    let mut camera =
        Camera::around(world.bounds, normal + DVec3::splat(0.05), DVec3::new(0.3, 0.4, 0.9), 0.6, (200, 150));
    let shift = jet.point - camera.target;
    (camera.eye, camera.target) = (camera.eye + shift, camera.target + shift);
    let (pixel, depth) = camera.project(jet.point).expect("in front");
    let id = world.model.parts[0].faces[face].id;
    let uv = [uv.x as f32 + 1e-4, uv.y as f32];
    let sample = Sample { depth: depth as f32, face: id, uv, normal: [0.0; 3], edge: 0, part: 1, instance: 1 };
    (camera, pixel, sample, jet.point)
}

fn one(pixel: DVec2, sample: Sample) -> Samples {
    let corner = (pixel.x as u32 - 4, pixel.y as u32 - 4);
    Samples { corner, width: 9, samples: vec![sample; 81] }
}

/// Picks in a picture of the world as it is.
fn pick(samples: &Samples, world: &World, camera: &Camera, at: DVec2, filter: PickFilter) -> Hit {
    let placement = |instance: usize| world.model.instances[instance].transform;
    samples.pick(&Seen { world, instances: &[0], hidden: &BTreeSet::new(), placement: &placement, camera }, at, filter)
}

#[test]
fn the_point_under_the_cursor_is_exact() {
    let world = world();
    for face in 0..world.model.parts[0].faces.len() {
        let (camera, pixel, sample, point) = over_face(&world, face);
        let hit = pick(&one(pixel, sample), &world, &camera, pixel, PickFilter::Any);
        let Some(Picked::Face { instance: 0, face: found, uv }) = hit.picked else { panic!("{hit:?}") };
        assert_eq!(found, face);
        let off = hit.point.expect("a point").distance(point);
        // (u, v) of single precision was off by 1e-4; the ray goes through the point within the rounding of a pixel
        assert!(off < 1e-9 * world.bounds.diagonal(), "face {face}: {off}");
        let surface = &world.model.parts[0].faces[face].surface;
        assert_eq!(surface.jet2(uv.x, uv.y).point, hit.point.expect("a point"));
    }
}

/// An exploded view moves an instance with its points.
#[test]
fn the_point_of_a_moved_instance_moves_with_it() {
    let world = world();
    let (mut camera, pixel, sample, point) = over_face(&world, 0);
    let by = DVec3::new(30.0, -20.0, 11.0);
    (camera.eye, camera.target) = (camera.eye + by, camera.target + by);
    let placement = |instance: usize| DAffine3::from_translation(by) * world.model.instances[instance].transform;
    let hidden = BTreeSet::new();
    let seen = Seen { world: &world, instances: &[0], hidden: &hidden, placement: &placement, camera: &camera };
    let hit = one(pixel, sample).pick(&seen, pixel, PickFilter::Any);
    let off = hit.point.expect("a point").distance(point + by);
    // as exact as where nothing is moved
    assert!(off < 1e-9 * world.bounds.diagonal(), "{off}");
    let Some(Picked::Face { uv, .. }) = hit.picked else { panic!("{hit:?}") };
    let own = world.model.parts[0].faces[0].surface.point(uv.x, uv.y);
    assert!(own.distance(point) < 1e-9 * world.bounds.diagonal());
}

#[test]
fn edges_go_before_faces_and_their_ends_before_them() {
    let world = world();
    let edges = world.edges_of(0).expect("found");
    let (camera, pixel, sample, _) = over_face(&world, 0);
    let mut samples = one(pixel, sample);
    // two pixels to the right
    samples.samples[4 * 9 + 6].edge = 3;
    let pick = |samples: &Samples, camera: &Camera, at, filter| pick(samples, &world, camera, at, filter).picked;
    assert_eq!(pick(&samples, &camera, pixel, PickFilter::Any), Some(Picked::Edge { instance: 0, edge: 2 }));
    assert!(matches!(pick(&samples, &camera, pixel, PickFilter::Faces), Some(Picked::Face { .. })));
    assert_eq!(pick(&samples, &camera, pixel, PickFilter::Parts), Some(Picked::Instance(0)));
    assert_eq!(pick(&samples, &camera, pixel, PickFilter::Vertices), None);
    samples.samples[4 * 9 + 6].edge = 0;
    samples.samples[8].edge = 3; // too far
    assert_eq!(pick(&samples, &camera, pixel, PickFilter::Edges), None);
    // over the end of the edge
    let vertex = edges.edges[2].ends[0];
    let mut camera = camera;
    let shift = edges.vertices[vertex] - camera.target;
    (camera.eye, camera.target) = (camera.eye + shift, camera.target + shift);
    let (at, _) = camera.project(camera.target).expect("in front");
    let mut samples = one(at, sample);
    samples.samples[40].edge = 3;
    let found = pick(&samples, &camera, at + 2.0, PickFilter::Any);
    assert_eq!(found, Some(Picked::Vertex { instance: 0, vertex }));
}

#[test]
fn the_background_and_numbers_without_a_part_are_reported() {
    let world = world();
    let (camera, pixel, sample, _) = over_face(&world, 0);
    let hit = pick(&one(pixel, NOTHING), &world, &camera, pixel, PickFilter::Any);
    assert_eq!(hit, Hit { picked: None, point: None });
    let solid = Sample { face: 77, part: 0, instance: 0, ..sample };
    let hit = pick(&one(pixel, solid), &world, &camera, pixel, PickFilter::Any);
    assert_eq!(hit.picked, Some(Picked::Number { instance: None, id: 77 }));
    assert!(hit.point.is_some());
    // beside the copied pixels
    let hit = pick(&one(pixel, sample), &world, &camera, pixel + 40.0, PickFilter::Any);
    assert_eq!(hit.picked, None);
}

/// From afar, and beside the border, where the nearest point of the border's line is taken.
#[test]
fn the_hand_is_followed_to_the_border_of_a_surface() {
    let world = world();
    for face in &world.model.parts[0].faces {
        let surface = &face.surface;
        let ((u0, u1), (v0, v1)) = surface.domain();
        let at = |a: f64, b: f64| DVec2::new(u0 + (u1 - u0) * a, v0 + (v1 - v0) * b);
        let (from, to) = (at(0.4, 0.45), at(0.5, 0.55));
        let jet = surface.jet2(to.x, to.y);
        let Some(normal) = surface.normal(to.x, to.y) else { continue };
        let (_, point, distance) = towards(surface, (jet.point + normal, -normal), from).expect("numbers");
        assert!(distance < 1e-9 && point.distance(jet.point) < 1e-8, "face {}: {distance}", face.id);
        // half a domain beyond the border
        let corner = surface.jet2(u1, v1);
        let beyond = corner.point + corner.du * (0.5 * (u1 - u0)) + corner.dv * (0.5 * (v1 - v0));
        let Some(normal) = surface.normal(u1, v1) else { continue };
        let (uv, ..) = towards(surface, (beyond + normal, -normal), from).expect("numbers");
        assert!(uv.x >= u0 && uv.x <= u1 && uv.y >= v0 && uv.y <= v1);
        let start = surface.point(from.x, from.y).reject_from(normal);
        let end = surface.point(uv.x, uv.y).reject_from(normal);
        let beyond = beyond.reject_from(normal);
        assert!(end.distance(beyond) < start.distance(beyond), "face {}", face.id);
    }
}

#[test]
fn the_loop_nearest_to_a_point_passes_there() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/panel.step");
    let import = selvedge_io::import::open(&path).expect("a sample");
    let face = &import.model.parts[0].faces[0];
    assert!(face.loops.len() > 2);
    for (nth, trim_loop) in face.loops.iter().enumerate().take(12) {
        // between two samples of the curve
        let uv = trim_loop.curves().next().expect("a curve").point(0.31);
        assert_eq!(nearest_loop(&face.surface, &face.loops, uv), Some(nth));
    }
    assert_eq!(nearest_loop(&face.surface, std::iter::empty::<&TrimLoop>(), DVec2::ZERO), None);
}

#[test]
fn a_chord_ends_at_its_ends() {
    let (a, b) = (DVec3::ZERO, DVec3::X * 2.0);
    assert_eq!(to_chord(DVec3::new(1.0, 3.0, 0.0), a, b), 3.0);
    assert_eq!(to_chord(DVec3::new(5.0, 0.0, 4.0), a, b), 5.0);
    assert_eq!(to_chord(DVec3::new(0.0, 0.0, 4.0), a, a), 4.0);
}
