//! Parts that touch: ties between their faces, and nothing else, are excused.
//!
//! ```text
//!            ┌────────┐
//!     eye    │  part  │      the part's lower face lies within the block's upper one; it is seen
//!      ╲     │        │      in the rim alone, where it meets the wall and the upper face
//!    ───┴────┴════════┴────
//!            block
//! ```

use super::shapes::*;
use crate::model::{Camera, Instance, Model, Part};
use crate::{JudgeOptions, Judgement, Picture, TOUCHING, Tracer, judge};
use glam::{DAffine3, DVec2, DVec3};
use selvedge_geometry::construct::shapes as bodies;

/// The block's upper face.
const TOP: u32 = 6;
/// Added to the numbers of the other part's faces.
const OTHER: u32 = 10;
/// How far outside of the rim pixels are changed, model units: less than half a pixel of some 0.0067.
const BESIDE: f64 = 0.003;

/// A block whose upper face is at 0, and a part whose lower face is at `lift`.
fn stacked(mut part: Part, lift: f64) -> Model {
    part.faces.iter_mut().for_each(|face| face.id += OTHER);
    let block = bodies::block(DVec3::new(-0.6, -0.6, -0.3), DVec3::new(0.6, 0.6, 0.0)).unwrap().part;
    let place = |(part, z)| {
        let transform = DAffine3::from_translation(DVec3::Z * z);
        Instance { part, transform, colour: None, name: String::new() }
    };
    let instances = [(0, 0.0), (1, lift)].map(place).to_vec();
    Model { parts: vec![block, part], instances, ..Model::default() }
}

/// A part that stands on a plate, the number of its lower face, and the way outwards from its footprint to a point
/// beside it.
type Standing = (Part, u32, fn(DVec2) -> DVec2);

/// A block and a cylinder.
fn parts() -> [Standing; 2] {
    let block = bodies::block(DVec3::new(-0.3, -0.3, 0.0), DVec3::new(0.3, 0.3, 0.4)).unwrap().part;
    let cylinder = bodies::cylinder(0.3, 0.4).unwrap().part;
    let beside_block: fn(DVec2) -> DVec2 = |p| p - p.clamp(DVec2::splat(-0.3), DVec2::splat(0.3));
    let beside_cylinder: fn(DVec2) -> DVec2 = |p| p - p.normalize_or_zero() * p.length().min(0.3);
    [(block, OTHER + 5, beside_block), (cylinder, OTHER + 1, beside_cylinder)]
}

fn camera() -> Camera {
    Camera { size: (400, 320), ..view(DVec3::new(1.2, -2.0, 1.8)) }
}

/// The true picture, but for pixels that `changed` changes by their hits; their number.
fn painted(tracer: &Tracer, camera: &Camera, changed: impl Fn(&crate::Hit) -> Option<(u32, f64)>) -> (Picture, u64) {
    let mut picture = tracer.picture(camera, &|_| {});
    let mut probe = tracer.probe(camera);
    let mut count = 0;
    for i in 0..picture.face.len() {
        let (x, y) = (i as u32 % camera.size.0, i as u32 / camera.size.0);
        let hit = probe.first(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
        if let Some((face, depth)) = hit.and_then(|hit| changed(&hit)) {
            (picture.face[i], picture.depth[i]) = (face, depth as f32);
            count += 1;
        }
    }
    (picture, count)
}

/// The part's lower face drawn just outside of its rim on the side of the eye, `off` behind the upper face.
fn with_rim(lift: f64, off: f64) -> [(Judgement, u64); 2] {
    parts().map(|(part, lower, outwards)| {
        let (tracer, camera) = (Tracer::new(&stacked(part, lift)), camera());
        let at_rim = |hit: &crate::Hit| {
            let way = outwards(hit.point.truncate());
            let towards_eye = way.dot(camera.eye.truncate()) > 0.5 * way.length() * camera.eye.truncate().length();
            let is_at = hit.face == TOP && way.length() > 0.0 && way.length() < BESIDE && towards_eye;
            is_at.then_some((lower, hit.depth + off))
        };
        let (picture, count) = painted(&tracer, &camera, at_rim);
        assert!(count >= 8, "{count} pixels at the rim");
        (judge(&tracer, &camera, &picture.images(), &JudgeOptions::default()), count)
    })
}

#[test]
fn a_face_within_another_part_s_face_is_right_at_the_rim() {
    for (j, count) in with_rim(0.0, 0.0) {
        assert_eq!((j.ties, j.wrong, j.gross), (count, 0, 0), "{j:?}");
    }
}

/// Most are gross; now and then a place that is tested lies where the wall ends, as near as its lower face.
#[track_caller]
fn assert_wrong(judged: [(Judgement, u64); 2]) {
    for (j, count) in judged {
        assert!(j.gross > count / 2 && j.ties + j.gross == count, "{count}: {j:?}");
    }
}

/// By more than ten times the tolerance, a sixtieth of a pixel.
#[test]
fn a_face_just_above_another_part_s_face_is_not() {
    assert_wrong(with_rim(1e-4, 0.0));
}

/// At another depth than that of the contact.
#[test]
fn nor_is_one_at_another_depth() {
    assert_wrong(with_rim(0.0, 0.3));
}

/// Fifteen pixels outside of the rim.
#[test]
fn nor_is_one_beside_the_rim() {
    for (part, lower, outwards) in parts() {
        let (tracer, camera) = (Tracer::new(&stacked(part, 0.0)), camera());
        let beside = |hit: &crate::Hit| {
            let way = outwards(hit.point.truncate()).length();
            (hit.face == TOP && way > 0.15 && way < 0.151).then_some((lower, hit.depth))
        };
        let (picture, count) = painted(&tracer, &camera, beside);
        let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions::default());
        assert!(count >= 8);
        assert_eq!((j.gross, j.ties), (count, 0), "{j:?}");
    }
}

/// Two sheets, one behind the other by more than a tie and less than what touches: told apart in one part alone.
#[test]
fn faces_of_two_parts_tie_within_more() {
    let gap = 0.5 * (1.0 + TOUCHING) * JudgeOptions::default().tie * 2f64.sqrt();
    let sheet = |id: u32, z: f64| face(id, rectangle(DVec3::new(-0.5, -0.5, z), DVec3::X, DVec3::Y), vec![]);
    let one = model(vec![sheet(1, 0.0), sheet(2, -gap)], &[DAffine3::IDENTITY]);
    let mut two = model(vec![sheet(1, 0.0)], &[DAffine3::IDENTITY; 2]);
    two.parts.push(Part { faces: vec![sheet(2, -gap)], ..Part::default() });
    two.instances[1].part = 1;
    let camera = view(DVec3::new(0.3, 0.2, 3.0));
    for (model, tie) in [(one, false), (two, true)] {
        let tracer = Tracer::new(&model);
        let (picture, count) = painted(&tracer, &camera, |hit| (hit.face == 1).then_some((2, hit.depth)));
        // all that are wrong need not be searched
        let searches = if tie { 50_000 } else { 50 };
        let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions { searches, ..JudgeOptions::default() });
        assert!(count > 500);
        assert_eq!((j.ties, j.wrong == 0), if tie { (count, true) } else { (0, false) }, "{j:?}");
    }
}

/// A sheet and its copy turned over lie in each other: either normal is right. Of the sheet alone only its own.
#[test]
fn copies_of_a_part_that_touch_have_two_normals() {
    let sheet = face(1, rectangle(DVec3::new(-0.5, -0.5, 0.0), DVec3::X, DVec3::Y), vec![]);
    let over = DAffine3::from_rotation_x(std::f64::consts::PI);
    let camera = view(DVec3::new(0.3, 0.2, 3.0));
    for (transforms, worst) in [(&[DAffine3::IDENTITY, over][..], 0.0), (&[DAffine3::IDENTITY][..], 180.0)] {
        let tracer = Tracer::new(&model(vec![sheet.clone()], transforms));
        let mut picture = tracer.picture(&camera, &|_| {});
        for turned in [false, true] {
            let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions::default());
            let expected = if turned { worst } else { 0.0 };
            assert!(j.normal_deg.count > 500 && (j.normal_deg.worst - expected).abs() < 1e-3, "{:?}", j.normal_deg);
            assert_eq!(j.wrong, 0);
            picture.normal.iter_mut().for_each(|normal| *normal = normal.map(|x| -x));
        }
    }
}
