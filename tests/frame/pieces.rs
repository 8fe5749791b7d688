//! Scenes and edits of more bytes than staging memory holds. Every image is the same bit for bit as where the copies are
//! made at once.

use crate::living::{SIZE, assert_all_identical, camera, draw, scene, step, ways};
use crate::shapes::{self, solids};
use crate::support::{assert_silent, watched, watched_for, watched_with};
use crate::watched::limited;
use glam::{DAffine3, DVec3};
use selvedge::gpu::LowerLimits;
use selvedge::headless::{HeadlessError, HeadlessRenderer};
use selvedge::model::{Camera, Model};
use selvedge::picture::{FrameSettings, Outputs, SceneSettings, TrimWay};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

const TABLE: TrimWay = TrimWay::Table;

/// A watched renderer with so many bytes of staging memory.
fn with_staging(bytes: u64, model: &Model, settings: SceneSettings) -> HeadlessRenderer {
    let mut renderer = limited(LowerLimits { staging: Some(bytes), ..LowerLimits::NONE });
    renderer.upload_with(model, settings).unwrap();
    renderer
}

#[test]
fn a_scene_in_pieces_draws_the_same() {
    let of_solids = (solids::holes(3), "solids", SceneSettings::default(), 256);
    // the last piece is as long as the others, or shorter
    let of_ways = (0..)
        .zip(ways().into_iter().step_by(2))
        .map(|(nth, (way, settings))| (scene(), way, settings, 4096 + 912 * (nth % 2)));
    for (model, way, settings, bytes) in of_ways.chain([of_solids]) {
        let (mut pieces, mut whole) = (with_staging(bytes, &model, settings), watched_with(&model, settings));
        let camera = camera(&model);
        let expected = draw(&mut whole, &camera);
        let seen = expected.face.iter().position(|face| *face != 0).expect("something is seen") as u32;
        let pick = |renderer: &mut HeadlessRenderer| {
            renderer.pick(seen % SIZE.0, seen / SIZE.0);
            (draw(renderer, &camera), renderer.picked())
        };
        let ((picture, picked), (again, expected_pick)) = (pick(&mut pieces), pick(&mut whole));
        assert_all_identical(&picture, &expected, way);
        assert_all_identical(&again, &expected, way);
        assert_eq!(picture.stats.retries, expected.stats.retries, "{way}: frames of copies are no retries");
        assert_eq!(picked, expected_pick, "{way}: the pick waits for the scene");
        assert!(picked.is_some() || way == "solids", "{way}: nothing was picked");
        assert_silent(pieces);
        assert_silent(whole);
    }
}

/// A watch is called between two faces and between two frames, and ends the picture at the first and at the last call.
#[test]
fn a_watch_ends_a_picture_between_two_steps() {
    let model = shapes::plate();
    let camera = camera(&model);
    let mut whole = watched(&model);
    let expected = draw(&mut whole, &camera);
    assert_silent(whole);
    // draws with a watch that ends the picture at this call, and counts the calls
    let draw_until = |last: usize| {
        let mut renderer = with_staging(256, &model, SceneSettings::default());
        let calls = Arc::new(AtomicUsize::new(0));
        let counted = Arc::clone(&calls);
        renderer.set_watch(Some(Arc::new(move || {
            if counted.fetch_add(1, Ordering::Relaxed) + 1 == last {
                resume_unwind(Box::new("ended"));
            }
        })));
        let drawn = catch_unwind(AssertUnwindSafe(|| draw(&mut renderer, &camera)));
        (renderer, drawn, calls.load(Ordering::Relaxed))
    };
    let (renderer, drawn, calls) = draw_until(usize::MAX);
    assert_all_identical(&drawn.expect("nothing ends it"), &expected, "watched");
    assert_silent(renderer);
    assert!(calls > 2, "{calls} calls");
    for last in [1, calls] {
        let (mut renderer, drawn, called) = draw_until(last);
        assert!(drawn.is_err() && called == last, "ended at call {called} of {last}");
        renderer.set_watch(None);
        assert_all_identical(&draw(&mut renderer, &camera), &expected, "the next picture");
        assert_silent(renderer);
    }
}

/// An upload for the images of the next pictures prepares nothing for the first of them: the watch is called only between
/// frames. Without `expect` it is also called between two faces that the picture prepares anew.
#[test]
fn expected_images_are_made_with_the_upload() {
    let model = shapes::cube();
    let camera = camera(&model);
    let numbers = Outputs { edge: true, part: true, instance: true, ..Outputs::ALL };
    let [anew, once] = [Outputs::ALL, numbers].map(|expected| {
        let mut renderer = watched_for(expected, &model, SceneSettings::default());
        let calls = Arc::new(AtomicUsize::new(0));
        let counted = Arc::clone(&calls);
        renderer.set_watch(Some(Arc::new(move || {
            counted.fetch_add(1, Ordering::Relaxed);
        })));
        let picture = draw(&mut renderer, &camera);
        assert_silent(renderer);
        (calls.load(Ordering::Relaxed) - picture.stats.retries as usize, picture)
    });
    assert!(anew.0 > 0 && once.0 == 0, "{} and {} calls between faces", anew.0, once.0);
    assert_all_identical(&once.1, &anew.1, "made once");
}

/// The same of a sequence, with frames in flight. What further flights had is freed, and the pixel to be read back
/// waits for the next picture.
#[test]
fn a_watch_ends_a_sequence() {
    let model = shapes::plate();
    let camera = camera(&model);
    let mut whole = watched(&model);
    let expected = draw(&mut whole, &camera);
    let seen = expected.face.iter().position(|face| *face != 0).expect("something is seen") as u32;
    let (x, y) = (seen % SIZE.0, seen / SIZE.0);
    whole.pick(x, y);
    draw(&mut whole, &camera);
    let hit = whole.picked();
    assert!(hit.is_some(), "nothing was picked");
    assert_silent(whole);
    // draws with a watch that ends the sequence at this call, and counts the calls and the pictures
    let draw_until = |last: usize| {
        let mut renderer = with_staging(256, &model, SceneSettings::default());
        renderer.pick(x, y);
        let calls = Arc::new(AtomicUsize::new(0));
        let counted = Arc::clone(&calls);
        renderer.set_watch(Some(Arc::new(move || {
            if counted.fetch_add(1, Ordering::Relaxed) + 1 == last {
                resume_unwind(Box::new("ended"));
            }
        })));
        let mut taken = 0;
        let drawn = catch_unwind(AssertUnwindSafe(|| {
            renderer.render_sequence(&[camera; 5], &FrameSettings::default(), Outputs::ALL, |_, _| {
                taken += 1;
                Ok::<_, HeadlessError>(())
            })
        }));
        renderer.set_watch(None);
        (renderer, drawn, calls.load(Ordering::Relaxed), taken)
    };
    let (renderer, drawn, calls, taken) = draw_until(usize::MAX);
    assert!(drawn.is_ok_and(|drawn| drawn.is_ok()) && taken == 5 && calls > 2, "{taken} pictures, {calls} calls");
    assert_silent(renderer);
    for last in [1, calls] {
        let (mut renderer, drawn, called, taken) = draw_until(last);
        assert!(drawn.is_err() && called == last && taken < 5, "ended at call {called} of {last}, {taken} pictures");
        let flights = renderer.objects().iter().filter(|name| *name == "colour (read back)").count();
        assert!(flights <= 1, "{flights} flights");
        assert_all_identical(&draw(&mut renderer, &camera), &expected, "the next picture");
        assert_eq!(renderer.picked(), hit, "its pixel");
        assert_silent(renderer);
    }
}

/// Changes of many instances, and models that join a scene, so that buffers grow.
#[test]
fn edits_in_pieces_draw_the_same() {
    const MOST: u64 = 256;
    type Edit = fn(&mut HeadlessRenderer);
    let (model, settings) = (scene(), SceneSettings { trim: TABLE, ..SceneSettings::default() });
    let (mut pieces, mut whole) = (with_staging(MOST, &model, settings), watched_with(&model, settings));
    let camera = camera(&model);
    let mut before = draw(&mut whole, &camera);
    assert_all_identical(&draw(&mut pieces, &camera), &before, "before");
    let edits: [(&str, Edit); 4] = [
        ("40 moved", |renderer| {
            for nth in 0..40 {
                let placed = renderer.model().unwrap().instances[nth].transform;
                let by = DAffine3::from_translation(DVec3::new(0.4, 0.3, 0.2));
                renderer.set_transform(nth, by * placed).unwrap();
            }
        }),
        ("a wave", |renderer| {
            renderer.add(&shapes::wave()).unwrap();
        }),
        ("a plate, moved", |renderer| {
            let id = renderer.add(&shapes::plate()).unwrap();
            let nth = renderer.instances_of(id).unwrap().start;
            renderer.set_transform(nth, step(2)).unwrap();
            (0..40).for_each(|nth| renderer.set_visible(nth, nth % 3 > 0).unwrap());
        }),
        ("a cube", |renderer| {
            renderer.add(&shapes::cube()).unwrap();
        }),
    ];
    for (what, edit) in edits {
        [&mut pieces, &mut whole].into_iter().for_each(edit);
        let (picture, expected) = (draw(&mut pieces, &camera), draw(&mut whole, &camera));
        assert_all_identical(&picture, &expected, what);
        assert_eq!(picture.stats.edit_bytes, expected.stats.edit_bytes, "{what}: each byte once");
        assert!(expected.stats.edit_bytes > MOST, "{what}: {} bytes fit", expected.stats.edit_bytes);
        let changed = expected.face != before.face || expected.stats.patches > before.stats.patches;
        assert!(changed, "{what}: nothing changed");
        assert_all_identical(&draw(&mut pieces, &camera), &picture, what);
        before = expected;
    }
    assert_silent(pieces);
    assert_silent(whole);
}

/// Frames in flight share the staging memory.
#[test]
fn a_sequence_in_pieces_draws_the_same() {
    let (model, settings) = (scene(), SceneSettings { trim: TABLE, ..SceneSettings::default() });
    let (mut pieces, mut whole) = (with_staging(4096, &model, settings), watched_with(&model, settings));
    let at = camera(&model);
    let cameras = [0.0, 0.1, 0.2, 0.3].map(|by| Camera { eye: at.eye + by * DVec3::Z, ..at });
    let frame = FrameSettings::default();
    let mut next = 0;
    let taken = pieces.render_sequence(&cameras, &frame, Outputs::ALL, |nth, picture| {
        assert_eq!(nth, next);
        next += 1;
        let expected = whole.render(&cameras[nth], &frame, Outputs::ALL).unwrap();
        assert_all_identical(&picture.to_picture(), &expected, &format!("picture {nth}"));
        Ok::<_, HeadlessError>(())
    });
    taken.unwrap();
    assert_eq!(next, cameras.len());
    assert_silent(pieces);
    assert_silent(whole);
}
