//! After a failed frame, colour and depth of the next picture are right, bit for bit.

use crate::driver::{Driver, Fault};
use crate::shapes;
use ash::vk;
use glam::{DAffine3, DVec2, DVec3};
use selvedge::gpu::LowerLimits;
use selvedge::headless::{HeadlessDevice, HeadlessOptions, HeadlessRenderer};
use selvedge::model::{Camera, LoopAt, Model};
use selvedge::picture::{FrameSettings, Outputs, Picture, SceneSettings};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

const SIZE: (u32, u32) = (48, 32);

fn draw(renderer: &mut HeadlessRenderer, camera: &Camera) -> Result<Picture, String> {
    renderer.render(camera, &FrameSettings::default(), Outputs::ALL).map_err(|error| error.to_string())
}

fn bits(picture: &Picture) -> (Vec<[u8; 4]>, Vec<u32>) {
    (picture.colour.clone(), picture.depth.iter().map(|d| d.to_bits()).collect())
}

fn opened(driver: &Driver) -> HeadlessRenderer {
    limited(driver, LowerLimits::NONE)
}

fn limited(driver: &Driver, lower: LowerLimits) -> HeadlessRenderer {
    let device = HeadlessDevice::of_entry(driver.entry(), &HeadlessOptions::default(), lower).unwrap();
    HeadlessRenderer::on(device).unwrap()
}

const AT: LoopAt = LoopAt { part: 0, face: 0, trim_loop: 1 };

/// A model before and after an edit that shows.
fn edited() -> [Model; 2] {
    let before = shapes::plate();
    let mut after = before.clone();
    let hole = &mut after.parts[0].faces[0].loops[AT.trim_loop];
    *hole = hole.translated(DVec2::new(0.25, 0.125)).unwrap();
    [before, after]
}

fn editable() -> SceneSettings {
    SceneSettings { editable: true, ..SceneSettings::default() }
}

/// The first, the middle and the last call of each name in a run.
fn turns(calls: BTreeMap<&'static str, u32>) -> Vec<(&'static str, u32)> {
    let thrice =
        |(call, count): (_, u32)| BTreeSet::from([0, count / 2, count - 1]).into_iter().map(move |n| (call, n));
    calls.into_iter().flat_map(thrice).collect()
}

#[test]
fn memory_that_ends_once_leaves_no_mark() {
    let driver = Driver::new(false);
    let [before, after] = edited();
    let camera = Camera::around(before.control_bounds(), DVec3::new(0.3, -0.6, 1.1), DVec3::Z, 0.6, SIZE);
    let mut renderer = opened(&driver);
    renderer.upload_with(&after, editable()).unwrap();
    let of_after = bits(&draw(&mut renderer, &camera).unwrap());
    renderer.upload_with(&before, editable()).unwrap();
    driver.plan(None);
    let of_before = bits(&draw(&mut renderer, &camera).unwrap());
    let of_first = turns(driver.calls());
    assert_ne!(of_before, of_after, "the edit shows");
    let next = &after.parts[0].faces[0].loops[AT.trim_loop];
    renderer.edit_loop(AT, next).unwrap();
    driver.plan(None);
    assert_eq!(bits(&draw(&mut renderer, &camera).unwrap()), of_after);
    let of_edit = turns(driver.calls());
    assert!(of_first.len() >= 20 && of_edit.len() >= 10, "{of_first:?}, {of_edit:?}");
    let failing = |renderer: &mut HeadlessRenderer, (call, nth), right: &_| {
        let fault = Fault { call, nth, result: vk::Result::ERROR_OUT_OF_DEVICE_MEMORY };
        driver.plan(Some(fault));
        let failed = draw(renderer, &camera);
        assert_eq!(driver.injected(), 1, "{fault:?}");
        driver.plan(None);
        let drawn = draw(renderer, &camera).unwrap_or_else(|error| panic!("{error} after {fault:?}"));
        assert!(bits(&drawn) == *right, "another picture after {fault:?}, {:?}", failed.err());
    };
    for turn in of_first {
        renderer.upload_with(&before, editable()).unwrap();
        failing(&mut renderer, turn, &of_before);
    }
    for turn in of_edit {
        renderer.upload_with(&before, editable()).unwrap();
        draw(&mut renderer, &camera).unwrap();
        renderer.edit_loop(AT, next).unwrap();
        failing(&mut renderer, turn, &of_after);
    }
    drop(renderer);
    assert!(driver.living().is_empty(), "{:?}", driver.living());
}

/// Little staging memory: several frames copy the scene, and memory ends in each of them.
#[test]
fn memory_that_ends_amid_the_copies_leaves_no_mark() {
    let driver = Driver::new(false);
    let [model, _] = edited();
    let camera = Camera::around(model.control_bounds(), DVec3::new(0.3, -0.6, 1.1), DVec3::Z, 0.6, SIZE);
    let draw = |renderer: &mut HeadlessRenderer| draw(renderer, &camera).map(|picture| bits(&picture));
    let mut whole = opened(&driver);
    whole.upload_with(&model, editable()).unwrap();
    let right = draw(&mut whole).unwrap();
    drop(whole);
    let mut renderer = limited(&driver, LowerLimits { staging: Some(256), ..LowerLimits::NONE });
    renderer.upload_with(&model, editable()).unwrap();
    draw(&mut renderer).unwrap();
    // the first upload takes memory that later ones find there
    renderer.upload_with(&model, editable()).unwrap();
    driver.plan(None);
    assert!(draw(&mut renderer).as_ref() == Ok(&right));
    let frames = driver.calls()["vkQueueSubmit2"];
    assert!(frames > 3, "{frames} frames");
    for (call, nth) in turns(driver.calls()) {
        renderer.upload_with(&model, editable()).unwrap();
        let fault = Fault { call, nth, result: vk::Result::ERROR_OUT_OF_DEVICE_MEMORY };
        driver.plan(Some(fault));
        let failed = draw(&mut renderer);
        assert_eq!(driver.injected(), 1, "{fault:?}");
        driver.plan(None);
        assert!(draw(&mut renderer).as_ref() == Ok(&right), "another picture after {fault:?}, {:?}", failed.err());
    }
    drop(renderer);
    assert!(driver.living().is_empty(), "{:?}", driver.living());
}

/// A model that joins a scene, so that buffers grow, and its first frame. A change of it meanwhile is not lost, either.
#[test]
fn memory_that_ends_once_leaves_no_mark_on_a_model_that_joins() {
    let driver = Driver::new(false);
    let [plate, _] = edited();
    let mut other = plate.clone();
    other.instances[0].transform = DAffine3::from_translation(DVec3::new(0.5, 0.5, 1.0));
    let camera = Camera::around(plate.control_bounds(), DVec3::new(0.3, -0.6, 1.1), DVec3::Z, 0.6, SIZE);
    let red = Some([0.8, 0.1, 0.1, 1.0]);
    let mut renderer = opened(&driver);
    // after a frame without the model
    let joined = |renderer: &mut HeadlessRenderer, fault: Option<Fault>| {
        renderer.upload(&plate).unwrap();
        let before = bits(&draw(renderer, &camera).unwrap());
        driver.plan(fault);
        let id = renderer.add(&other).or_else(|_| renderer.add(&other)).unwrap();
        let first = draw(renderer, &camera);
        renderer.set_colour(renderer.instances_of(id).unwrap().start, red).unwrap();
        (before, first, draw(renderer, &camera).map(|picture| bits(&picture)))
    };
    let (before, _, right) = joined(&mut renderer, None);
    let right = right.unwrap();
    // what frames write is as large as it gets
    assert!(joined(&mut renderer, None).2 == Ok(right.clone()));
    let turns = turns(driver.calls());
    assert!(turns.len() >= 10 && before != right, "{turns:?}");
    for (call, nth) in turns {
        let fault = Fault { call, nth, result: vk::Result::ERROR_OUT_OF_DEVICE_MEMORY };
        let (_, first, second) = joined(&mut renderer, Some(fault));
        assert_eq!(driver.injected(), 1, "{fault:?}");
        driver.plan(None);
        let second = second.or_else(|_| draw(&mut renderer, &camera).map(|picture| bits(&picture)));
        assert!(second.as_ref() == Ok(&right), "another picture after {fault:?}, {:?}", first.err());
    }
    drop(renderer);
    assert!(driver.living().is_empty(), "{:?}", driver.living());
}

#[test]
fn a_new_device_takes_the_model_of_a_lost_one() {
    let driver = Driver::new(false);
    let [before, after] = edited();
    let camera = Camera::around(before.control_bounds(), DVec3::new(0.3, -0.6, 1.1), DVec3::Z, 0.6, SIZE);
    let mut renderer = opened(&driver);
    renderer.upload_with(&before, editable()).unwrap();
    draw(&mut renderer, &camera).unwrap();
    renderer.edit_loop(AT, &after.parts[0].faces[0].loops[AT.trim_loop]).unwrap();
    let right = bits(&draw(&mut renderer, &camera).unwrap());
    for call in ["vkQueueSubmit2", "vkWaitForFences", "vkGetQueryPoolResults"] {
        driver.plan(Some(Fault { call, nth: 0, result: vk::Result::ERROR_DEVICE_LOST }));
        let error = draw(&mut renderer, &camera).unwrap_err();
        assert!(error.starts_with(&format!("{call} failed for")) && error.contains("lost"), "{error}");
        let model = Arc::clone(renderer.model().expect("it was uploaded"));
        drop(renderer);
        assert!(driver.living().is_empty(), "{:?}", driver.living());
        driver.plan(None);
        renderer = opened(&driver);
        renderer.upload_shared(model, editable(), &|_| ()).unwrap();
        assert!(bits(&draw(&mut renderer, &camera).unwrap()) == right, "{call}");
    }
}
