//! The hit of a pick, against exact rays: the same face, and the same point in double precision.

use crate::hidden::crowd;
use crate::room::plates;
use crate::shapes::{self, operands, solids};
use crate::support::{assert_silent, orthographic, perspective, watched, watched_with};
use crate::watched::renderer;
use glam::{DAffine3, DVec2, DVec3};
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, Model};
use selvedge::picture::{EdgeSettings, FrameSettings, Outputs, SceneSettings, TrimWay};
use selvedge_check::Tracer;

const SIZE: (u32, u32) = (60, 48);
const ALL: Outputs = Outputs { part: true, instance: true, ..Outputs::ALL };

/// Results of picks: background; the face and the point of the ray through the pixel's centre; or another face, beside
/// a border.
#[derive(Debug, Default)]
struct Picks {
    none: usize,
    same: usize,
    beside: usize,
}

/// Picks every seventh pixel, a frame for each. A point of Boolean solids is as exact as their depth image.
fn picks(renderer: &mut HeadlessRenderer, model: &Model, camera: &Camera) -> Picks {
    let tracer = Tracer::new(model);
    let settings = FrameSettings::default();
    let picture = renderer.render(camera, &settings, ALL).unwrap();
    let mut found = Picks::default();
    for at in (0..SIZE.0 * SIZE.1).step_by(7) {
        let (x, y) = (at % SIZE.0, at / SIZE.0);
        renderer.pick(x, y);
        renderer.render(camera, &settings, ALL).unwrap();
        let hit = renderer.picked();
        let at = at as usize;
        assert_eq!(hit.map_or(0, |hit| hit.id), picture.face[at], "{x}, {y}");
        let Some(hit) = hit else {
            found.none += 1;
            continue;
        };
        assert_eq!(hit.instance.map_or(0, |i| i as u32 + 1), picture.instance[at], "{x}, {y}");
        assert_eq!(hit.part.map_or(0, |i| i as u32 + 1), picture.part[at], "{x}, {y}");
        let near = |a: f64, b: f64, unit: f64| (a - b).abs() <= 1e-4 * unit;
        let pixel = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
        let exact = tracer.first(camera, pixel).filter(|exact| exact.face == hit.id);
        let Some(exact) = exact.filter(|exact| near(exact.depth, hit.depth, hit.depth)) else {
            found.beside += 1;
            continue;
        };
        // a millionth of a pixel; depths of solids are those of the image, and those of their mesh operands are the
        // rasteriser's
        let (unit, off) = if hit.instance.is_some() { (1e-8, 1e-6) } else { (1e-5, 1e-3) };
        assert!(hit.point.distance(exact.point) <= unit * hit.depth, "{x}, {y}: {hit:?} {exact:?}");
        if let Some(normal) = hit.normal.filter(|_| model.parts.iter().all(|part| part.meshes.is_empty())) {
            assert!(normal.distance(exact.normal) < off, "{x}, {y}: {hit:?} {exact:?}");
        }
        if let (Some(face), Some(uv)) = (hit.face, hit.uv) {
            assert_eq!(face, exact.face_index, "{x}, {y}");
            let part = &model.parts[exact.part];
            let p = part.faces[face].surface.jet(uv.x, uv.y).point;
            let p = model.instances[exact.instance].transform.transform_point3(p);
            assert!(p.distance(exact.point) <= unit * hit.depth, "{x}, {y}: {hit:?} {exact:?}");
        }
        if let Some((mesh, _)) = hit.triangle {
            assert_eq!(model.parts[exact.part].faces.len() + mesh, exact.face_index, "{x}, {y}");
            assert!(hit.uv.unwrap().distance(exact.uv) < 1e-6, "{x}, {y}: {hit:?} {exact:?}");
        }
        found.same += 1;
    }
    found
}

fn check(renderer: &mut HeadlessRenderer, name: &str, model: &Model, cameras: &[Camera]) {
    renderer.expect(ALL);
    renderer.upload(model).unwrap();
    for camera in cameras {
        let found = picks(renderer, model, camera);
        assert!(found.same > 40 && found.beside <= found.same / 8, "{name}: {found:?}");
    }
}

#[test]
fn faces_are_picked_exactly() {
    let (mut renderer, model) = (renderer(), crowd());
    check(&mut renderer, "crowd", &model, &[perspective(&model, SIZE), orthographic(&model, SIZE)]);
    let mirrored = shapes::mirrored();
    check(&mut renderer, "mirrored", &mirrored, &[perspective(&mirrored, SIZE)]);
    assert_silent(renderer);
}

#[test]
fn triangles_and_solids_are_picked() {
    let (mut renderer, globe) = (renderer(), shapes::globe());
    check(&mut renderer, "globe", &globe, &[perspective(&globe, SIZE), orthographic(&globe, SIZE)]);
    let holes = solids::holes(3);
    check(&mut renderer, "holes", &holes, &[perspective(&holes, SIZE)]);
    for (name, model) in operands::meshes().into_iter().chain(operands::splines()).take(4) {
        check(&mut renderer, name, &model, &[perspective(&model, SIZE)]);
    }
    assert_silent(renderer);
}

/// In a close view, which draws a cut of the model, (u, v) are those of the whole face.
#[test]
fn a_face_is_picked_close_up() {
    let model = shapes::ripple();
    let mut camera = perspective(&model, SIZE);
    let target = model.parts[0].faces[0].surface.jet(0.4, 0.6).point;
    let distance = 1e-4;
    camera.eye = target + (camera.eye - camera.target).normalize() * distance;
    (camera.target, camera.depth_range) = (target, (0.1 * distance, 10.0));
    let mut renderer = renderer();
    check(&mut renderer, "close", &model, &[camera]);
    assert_silent(renderer);
}

/// The hit is that of the frame, whatever moves later. No hit without a call, beside the picture, or after another
/// model.
#[test]
fn a_pick_is_of_its_frame() {
    let model = shapes::sphere();
    let mut renderer = watched(&model);
    let camera = perspective(&model, SIZE);
    let settings = FrameSettings::default();
    let draw = |renderer: &mut HeadlessRenderer| drop(renderer.render(&camera, &settings, ALL).unwrap());
    draw(&mut renderer);
    assert_eq!(renderer.picked(), None, "nobody asked");
    renderer.pick(30, 24);
    draw(&mut renderer);
    let hit = renderer.picked().unwrap();
    assert!((hit.point.length() - shapes::SPHERE_RADIUS).abs() < 1e-9, "{hit:?}");
    let up = DVec3::new(0.0, 0.0, 0.5);
    renderer.set_transform(0, DAffine3::from_translation(up)).unwrap();
    assert_eq!(renderer.picked(), Some(hit), "it is of the frame before");
    renderer.pick(30, 24);
    draw(&mut renderer);
    let moved = renderer.picked().unwrap();
    assert!(((moved.point - up).length() - shapes::SPHERE_RADIUS).abs() < 1e-9, "{moved:?}");
    draw(&mut renderer);
    assert_eq!(renderer.picked(), None, "nobody asked again");
    for (x, y) in [(SIZE.0, 0), (0, SIZE.1), (0, 0)] {
        renderer.pick(x, y);
        draw(&mut renderer);
        assert_eq!(renderer.picked(), None, "{x}, {y}");
    }
    renderer.pick(30, 24);
    draw(&mut renderer);
    assert!(renderer.picked().is_some());
    renderer.upload(&shapes::cube()).unwrap();
    assert_eq!(renderer.picked(), None, "of another model");
    assert_silent(renderer);
}

/// Where a line is drawn over a face, the hit has an edge. It is the edge of the image of edges, except in pixels
/// between two lines. Away from lines the hit has no edge.
#[test]
fn a_hit_has_the_edge_whose_line_is_there() {
    let lines = EdgeSettings { width: 2.5 * EdgeSettings::HEIGHT / f64::from(SIZE.1), ..EdgeSettings::default() };
    for model in [shapes::cube(), shapes::plate(), shapes::cylinder()] {
        let mut renderer = watched_with(&model, SceneSettings { edges: Some(lines), ..SceneSettings::default() });
        let camera = perspective(&model, SIZE);
        let settings = FrameSettings::default();
        let outputs = Outputs { edge: true, ..ALL };
        let picture = renderer.render(&camera, &settings, outputs).unwrap();
        let edge = |x: u32, y: u32| picture.edge[(y * SIZE.0 + x) as usize];
        let (mut same, mut other, mut away) = (0, 0, 0);
        for (x, y) in (1..SIZE.1 - 1).flat_map(|y| (1..SIZE.0 - 1).map(move |x| (x, y))) {
            let beside = || (0..9).map(|k| edge(x + k % 3 - 1, y + k / 3 - 1));
            if !(x + 3 * y).is_multiple_of(if edge(x, y) == 0 { 17 } else { 2 }) {
                continue;
            }
            renderer.pick(x, y);
            renderer.render(&camera, &settings, outputs).unwrap();
            let Some(hit) = renderer.picked() else { continue };
            match (edge(x, y), hit.edge) {
                (0, None) => away += 1,
                (0, Some(_)) => assert!(beside().any(|edge| edge != 0), "{x}, {y}: {hit:?}"),
                (number, Some(found)) if number == found as u32 + 1 => same += 1,
                // of two lines, or of a neighbour's line over this face
                (_, Some(_)) => other += 1,
                (number, None) => {
                    let (part, face) = (hit.part.unwrap(), hit.face.unwrap());
                    let found = model.parts[part].edges().unwrap();
                    let is_own = found.edges[number as usize - 1].uses.iter().any(|u| u.face == face);
                    assert!(!is_own, "{x}, {y}: line {number}, {hit:?}");
                }
            }
        }
        assert!(same > 30 && other * 8 < same && away > 10, "{same} the same, {other} others, {away} away");
        assert_silent(renderer);
    }
}

/// The first frame has more scan lines than its table and is drawn again, by a new renderer for its images.
#[test]
fn a_frame_that_is_drawn_again_picks_again() {
    let (model, camera) = plates();
    let settings = SceneSettings { trim: TrimWay::Table, ..SceneSettings::default() };
    let frame = FrameSettings { tolerance_px: 0.125, ..FrameSettings::default() };
    let [mut before, mut renderer] = [0; 2].map(|_| watched_with(&model, settings));
    let face = before.render(&camera, &frame, ALL).unwrap().face;
    let at = face.len() / 2 + face[face.len() / 2..].iter().position(|face| *face != 0).unwrap();
    renderer.pick(at as u32 % camera.size.0, at as u32 / camera.size.0);
    let picture = renderer.render(&camera, &frame, ALL).unwrap();
    assert!(picture.stats.retries > 0);
    assert_eq!(renderer.picked().map_or(0, |hit| hit.id), face[at]);
    [before, renderer].into_iter().for_each(assert_silent);
}
