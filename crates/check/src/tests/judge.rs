//! The judge on pictures whose error is known.

use super::shapes::*;
use crate::Picture;
use crate::model::{Camera, Model};
use crate::{Class, JudgeOptions, Judgement, Tracer, judge};
use glam::{DAffine3, DVec2, DVec3};
use std::sync::atomic::{AtomicU64, Ordering};

/// A sphere (1), a torus (2) and a plane with a hole (3).
fn scene() -> Model {
    let plane = rectangle(DVec3::new(-1.6, -1.6, -0.3), DVec3::X * 3.2, DVec3::Y * 3.2);
    let border = polygon(&[DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y]);
    let floor = face(3, plane, vec![border, hole(DVec2::new(0.7, 0.3), 0.12)]);
    let mut scene = model(vec![face(2, torus(1.0, 0.3), vec![]), floor], &[DAffine3::IDENTITY]);
    let ball = model(vec![face(1, sphere(), vec![])], &[DAffine3::from_scale(DVec3::splat(0.5))]);
    scene.parts.extend(ball.parts);
    scene.instances.extend(ball.instances);
    scene.instances[1].part = 1;
    scene
}

fn camera() -> Camera {
    view(DVec3::new(2.0, 2.5, 2.2))
}

/// The true picture displaced by `shift` pixels.
fn shifted(tracer: &Tracer, camera: &Camera, shift: DVec2) -> Picture {
    let mut picture = tracer.picture(camera, &|_| {});
    let mut probe = tracer.probe(camera);
    for y in 0..camera.size.1 {
        for x in 0..camera.size.0 {
            let i = (y * camera.size.0 + x) as usize;
            let hit = probe.first(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) + shift);
            picture.face[i] = hit.map_or(0, |h| h.face);
            picture.depth[i] = hit.map_or(f32::INFINITY, |h| h.depth as f32);
            picture.normal[i] = hit.map_or([0.0; 3], |h| h.normal.as_vec3().to_array());
        }
    }
    picture
}

fn total(j: &Judgement) -> u64 {
    j.agree + j.ties + j.gross + j.unsearched + j.shifts.iter().map(|b| b.pixels).sum::<u64>()
}

#[test]
fn a_perfect_picture_is_right() {
    let (tracer, camera) = (Tracer::new(&scene()), camera());
    let picture = tracer.picture(&camera, &|_| {});
    assert_eq!(picture.face.iter().collect::<std::collections::BTreeSet<_>>().len(), 4, "all faces are in view");
    let done = AtomicU64::new(0);
    let progress = |n: u64| {
        done.fetch_add(n, Ordering::Relaxed);
    };
    let j =
        judge(&tracer, &camera, &picture.images(), &JudgeOptions { progress: Some(&progress), ..Default::default() });
    assert_eq!((j.sampled, j.agree, j.wrong, j.gross, j.ties, j.given_up), (8000, 8000, 0, 0, 0, 0));
    assert_eq!(done.into_inner(), 8000);
    // the rest is the f32 of the images: 2^-24 of a depth near 4, and of a unit vector
    assert!(j.depth_all.model.worst < 4e-7 && j.depth_all.model.worst > 1e-9, "{:?}", j.depth_all);
    assert!(j.normal_deg.worst < 1e-5 && j.normal_deg.count > 4000, "{:?}", j.normal_deg);
    assert!(j.depth_regular.px.worst < 1e-4 && j.depth_regular.px.count == j.normal_deg.count);
}

#[test]
fn a_shift_is_measured() {
    let (tracer, camera) = (Tracer::new(&scene()), camera());
    for (shift, right) in [
        (DVec2::new(0.3, 0.0), true),
        (DVec2::new(0.0, -0.3), true),
        (DVec2::new(0.33, 0.33), true),
        (DVec2::new(-0.8, 0.0), false),
        (DVec2::new(0.9, -1.2), false),
    ] {
        let picture = shifted(&tracer, &camera, shift);
        let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions::default());
        assert_eq!(total(&j), 8000);
        assert_eq!((j.gross, j.unsearched), (0, 0));
        let s = shift.length();
        assert!(j.worst_shift_px <= s + 0.01 && j.worst_shift_px > s - 0.06, "{shift}: {}", j.worst_shift_px);
        assert_eq!(j.wrong == 0, right, "{shift}: {} wrong", j.wrong);
        assert_eq!(j.mismatches.is_empty(), right);
        assert_eq!((j.folds.wrong_depth, j.folds.unsearched), (0, 0), "{shift}");
        let far = j.classes.iter().filter(|c| matches!(c, Class::Far(_))).count() as u64;
        assert_eq!(far, j.wrong);
        if let Some(m) = j.mismatches.first() {
            assert_eq!(m.shift_px, Some(j.worst_shift_px));
        }
    }
}

#[test]
fn a_flooded_face_is_gross() {
    let (tracer, camera) = (Tracer::new(&scene()), camera());
    let truth = tracer.picture(&camera, &|_| {});
    let mut picture = truth.clone();
    // the sphere's id all over a strip, and an id that is in no model
    for i in 0..1000 {
        picture.face[i] = 1;
    }
    picture.face[4040] = 99;
    let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions::default());
    assert_eq!((j.gross, j.wrong, total(&j)), (1001, 1001, 8000));
    assert_eq!((j.mismatches.len(), j.mismatches[0].drawn, j.mismatches[0].gross), (16, 1, true));
    // nothing drawn at all: background is searched, finds no gap, and the budget holds
    picture.face.fill(0);
    let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions { searches: 50, ..Default::default() });
    assert!(j.unsearched > 1000 && j.gross > 10 && j.wrong == j.unsearched + j.gross + far(&j), "{j:?}");
}

fn far(j: &Judgement) -> u64 {
    j.classes.iter().filter(|c| matches!(c, Class::Far(_))).count() as u64
}

#[test]
fn wrong_depths_and_normals_are_seen() {
    let (tracer, camera) = (Tracer::new(&scene()), camera());
    let truth = tracer.picture(&camera, &|_| {});
    let mut picture = truth.clone();
    let hit = (0..8000).find(|&i| truth.face[i..i + 3] == [3; 3]).expect("the floor is in view");
    picture.depth[hit] += 1e-3;
    picture.normal[hit] = [1.0, 0.0, 0.0];
    let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions::default());
    let at = [hit as u32 % 100, hit as u32 / 100];
    assert_eq!((j.depth_regular.model.worst_at, j.normal_deg.worst_at), (at, at));
    assert!((j.depth_regular.model.worst - 1e-3).abs() < 1e-6);
    assert!((j.normal_deg.worst - 90.0).abs() < 1e-9);
    let pixel = f64::from(truth.depth[hit]) * 2.0 * 20f64.to_radians().tan() / 80.0;
    assert!((j.depth_regular.px.worst - 1e-3 / pixel).abs() < 1e-4);
    // off by more than any slope explains, and NaN: wrong, and separate from the regular ones
    picture.depth[hit] += 1.0;
    picture.depth[hit + 1] = f32::NAN;
    let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions::default());
    assert_eq!((j.folds.wrong_depth, j.wrong), (2, 0));
    assert!(j.depth_regular.model.worst < 1e-5 && j.depth_all.model.worst.is_infinite());
}

#[test]
fn coincident_faces_tie() {
    let sheet = |z: f64| rectangle(DVec3::new(-0.5, -0.5, z), DVec3::X, DVec3::Y);
    let camera = view(DVec3::new(0.3, 0.2, 3.0));
    for (gap, tie) in [(0.0, true), (1e-7, true), (1e-4, false)] {
        let model = model(vec![face(1, sheet(0.0), vec![]), face(2, sheet(-gap), vec![])], &[DAffine3::IDENTITY]);
        let tracer = Tracer::new(&model);
        let mut picture = tracer.picture(&camera, &|_| {});
        let drawn = picture.face.iter_mut().filter(|f| **f == 1).map(|f| *f = 2).count() as u64;
        let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions::default());
        assert!(drawn > 500);
        if tie {
            assert_eq!((j.ties, j.wrong), (drawn, 0));
        } else {
            assert!(j.ties == 0 && j.gross > 0 && j.wrong + 200 > drawn, "{j:?}");
        }
    }
}

/// Two sheets with a strip between them, all facing the eye; the strip is `width` pixels wide and `behind`
/// the sheets. A renderer with an error of `limit_px` may draw it two pixels wide, and `aside` pixels to the right of
/// its place: the worst shift is nearly `aside + 1` pixels.
fn strip(ids: [u32; 3], width: f64, behind: f64, aside: usize, limit_px: f64) -> Judgement {
    let mut camera = parallel(DVec3::new(0.0, 0.0, 3.0));
    camera.up = DVec3::Y;
    let wide = width * 3.0 / 80.0;
    let sheet =
        |x0: f64, x1: f64, z: f64| rectangle(DVec3::new(x0, -1.0, z), DVec3::X * (x1 - x0), DVec3::new(0.05, 2.0, 0.0));
    let faces = vec![
        face(ids[0], sheet(-1.0, 0.0, 0.0), vec![]),
        face(ids[1], sheet(-behind, wide + behind, -behind), vec![]),
        face(ids[2], sheet(wide, 1.0, 0.0), vec![]),
    ];
    let tracer = Tracer::new(&model(faces, &[DAffine3::IDENTITY]));
    let mut picture = tracer.picture(&camera, &|_| {});
    for y in 20..60 {
        // the middle of the strip leans: x = 0.025 (z = 0 plane) at y = 0
        let height = (39.5 - f64::from(y)) * 3.0 / 80.0;
        let centre = (0.025 * (1.0 + height) + wide * 0.5) * 80.0 / 3.0 + 50.0;
        let left = (centre - 0.5).floor() as usize + aside;
        picture.face[y as usize * 100 + left] = ids[1];
        picture.face[y as usize * 100 + left + 1] = ids[1];
    }
    judge(&tracer, &camera, &picture.images(), &JudgeOptions { limit_px, ..Default::default() })
}

#[test]
fn slivers_and_slits_are_found() {
    // a face of 1/1000 px between two others, and a slit of 1/40 px in one face with another behind it; the same with a
    // slit of 1/10 px that is drawn beyond the least reach of the search
    for (ids, width, behind, aside) in
        [([1, 2, 3], 0.001, 0.0, 0), ([1, 2, 1], 0.025, 0.5, 0), ([1, 2, 1], 0.1, 0.5, 3)]
    {
        let most = aside as f64 + 1.0;
        let j = strip(ids, width, behind, aside, most);
        assert_eq!((j.wrong, j.gross, total(&j)), (0, 0, 8000), "{ids:?}");
        let shifted: u64 = j.shifts.iter().map(|b| b.pixels).sum();
        assert!((70..=80).contains(&shifted), "{shifted} of 80 pixels are off the strip");
        assert!(j.worst_shift_px > most - 0.2 && j.worst_shift_px <= most, "{}", j.worst_shift_px);
    }
}

/// Two sheets that meet at 50.3 px; the right one is drawn four columns too wide. The centres of these columns are 0.8,
/// 1.8, 2.8 and 3.8 px from the border.
#[test]
fn a_larger_limit_is_searched_as_far() {
    let mut camera = parallel(DVec3::new(0.0, 0.0, 3.0));
    camera.up = DVec3::Y;
    let sheet = |x: f64| rectangle(DVec3::new(x, -1.0, 0.0), DVec3::X, DVec3::Y * 2.0);
    let border = 0.3 * 3.0 / 80.0;
    let faces = vec![face(1, sheet(border - 1.0), vec![]), face(2, sheet(border), vec![])];
    let tracer = Tracer::new(&model(faces, &[DAffine3::IDENTITY]));
    let mut picture = tracer.picture(&camera, &|_| {});
    for y in 20..60 {
        picture.face[y * 100 + 46..y * 100 + 50].fill(2);
    }
    let judged =
        |limit_px| judge(&tracer, &camera, &picture.images(), &JudgeOptions { limit_px, ..Default::default() });
    let j = judged(4.0);
    assert_eq!((j.agree, j.wrong, j.gross, total(&j)), (8000 - 160, 0, 0, 8000));
    assert!((j.worst_shift_px - 3.8).abs() < 0.01, "{}", j.worst_shift_px);
    assert_eq!(
        j.shifts.iter().filter(|b| b.up_to_px > 2.0).map(|b| (b.up_to_px, b.pixels)).collect::<Vec<_>>(),
        [(4.0, 80)]
    );
    // the fourth column is beyond this limit, and the last two beyond the reach of a small one
    let j = judged(3.0);
    assert_eq!((j.wrong, j.gross, total(&j)), (40, 40, 8000));
    let j = judged(0.4);
    assert_eq!((j.wrong, j.gross, total(&j)), (160, 80, 8000));
}

#[test]
fn samples_are_spread_and_follow_the_edges() {
    let (tracer, camera) = (Tracer::new(&scene()), camera());
    let mut picture = tracer.picture(&camera, &|_| {});
    picture.face[4040] = 99;
    let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions { samples: Some(200), ..Default::default() });
    assert!(j.sampled > 500 && j.sampled < 4000, "{}", j.sampled);
    assert_eq!(j.gross, 1, "a single wrong pixel has an edge around it");
    let painted = j.paint();
    let reds = painted.iter().filter(|c| **c == [220, 0, 0, 255]).count();
    let unsampled = painted.iter().filter(|c| **c == [90, 90, 90, 255]).count() as u64;
    assert_eq!((painted.len(), reds, unsampled), (8000, 1, 8000 - j.sampled));
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    let again = one_thread.install(|| {
        judge(&tracer, &camera, &picture.images(), &JudgeOptions { samples: Some(200), ..Default::default() })
    });
    assert_eq!(j, again, "the result does not depend on the threads");
}
