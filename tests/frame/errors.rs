//! Models that cannot be drawn are rejected with an error, and the renderer still works.

use crate::shapes;
use crate::support::{assert_identical, assert_silent, perspective, render, watched};
use glam::DVec3;
use selvedge::headless::{HeadlessError, HeadlessRenderer};
use selvedge::model::{Camera, CameraError, Model, Projection};
use selvedge::picture::{FrameSettings, Outputs};
use selvedge::renderer::{RenderError, UndrawnSolid};

fn refusal(renderer: &mut HeadlessRenderer, camera: &Camera, tolerance_px: f64) -> RenderError {
    let settings = FrameSettings { tolerance_px, ..FrameSettings::default() };
    match renderer.render(camera, &settings, Outputs::ALL) {
        Err(HeadlessError::Render(error)) => error,
        Err(error) => panic!("another error: {error}"),
        Ok(_) => panic!("{camera:?} at {tolerance_px} px was drawn"),
    }
}

#[test]
fn a_camera_that_shows_nothing() {
    let model = shapes::sphere();
    let mut renderer = watched(&model);
    let good = perspective(&model, (64, 48));
    let before = render(&mut renderer, &good);
    let lens = |fov_y| Projection::Perspective { fov_y };
    let parallel = |height| Projection::Orthographic { height };
    let bad = [
        (Camera { eye: DVec3::NAN, ..good }, CameraError::NotFinite),
        (Camera { target: DVec3::INFINITY, ..good }, CameraError::NotFinite),
        (Camera { target: good.eye, ..good }, CameraError::NoDirection),
        (Camera { up: good.target - good.eye, ..good }, CameraError::UpAlongAxis),
        (Camera { up: DVec3::ZERO, ..good }, CameraError::UpAlongAxis),
        (Camera { projection: lens(0.0), ..good }, CameraError::Projection),
        (Camera { projection: lens(4.0), ..good }, CameraError::Projection),
        (Camera { projection: lens(f64::NAN), ..good }, CameraError::Projection),
        (Camera { projection: parallel(-1.0), ..good }, CameraError::Projection),
        (Camera { projection: parallel(f64::INFINITY), ..good }, CameraError::Projection),
        (Camera { projection: lens(1e-300), ..good }, CameraError::Narrow),
        (Camera { projection: parallel(1e-300), ..good }, CameraError::Scale),
        (Camera { projection: parallel(1e-11), eye: DVec3::splat(5.0), ..good }, CameraError::Small),
        (Camera { depth_range: (1e-300, 1e300), ..good }, CameraError::Scale),
        (Camera { target: DVec3::splat(1e16), ..good }, CameraError::Scale),
        (Camera { target: DVec3::splat(1e200), ..good }, CameraError::Scale),
        (Camera { up: good.up * 1e200, ..good }, CameraError::Scale),
        (Camera { up: good.up * 1e-200, ..good }, CameraError::Scale),
        (Camera { eye: DVec3::ZERO, target: DVec3::X * 1e-200, ..good }, CameraError::Scale),
        (Camera { depth_range: (0.0, 1.0), ..good }, CameraError::DepthRange),
        (Camera { depth_range: (2.0, 1.0), ..good }, CameraError::DepthRange),
        (Camera { depth_range: (1.0, f64::INFINITY), ..good }, CameraError::DepthRange),
        (Camera { depth_range: (f64::NAN, 1.0), ..good }, CameraError::DepthRange),
        (Camera { size: (0, 48), ..good }, CameraError::Size),
        (Camera { size: (64, 20_000), ..good }, CameraError::Size),
    ];
    for (camera, expected) in bad {
        match refusal(&mut renderer, &camera, 0.5) {
            RenderError::Camera(error) => assert_eq!(error, expected, "{camera:?}"),
            error => panic!("{camera:?}: {error}"),
        }
    }
    assert_identical(&before, &render(&mut renderer, &good), "after errors");
    assert_silent(renderer);
}

#[test]
fn a_tolerance_that_single_precision_cannot_keep() {
    let model = shapes::plate();
    let mut renderer = watched(&model);
    let camera = perspective(&model, (64, 48));
    let before = render(&mut renderer, &camera);
    for tolerance in [0.0, -1.0, 0.099, f64::NAN, f64::INFINITY] {
        match refusal(&mut renderer, &camera, tolerance) {
            RenderError::Tolerance(said) => assert_eq!(said.to_bits(), tolerance.to_bits()),
            error => panic!("{tolerance}: {error}"),
        }
    }
    assert_identical(&before, &render(&mut renderer, &camera), "after errors");
    assert_silent(renderer);
}

#[test]
fn a_model_that_is_none() {
    let model = shapes::plate();
    let mut renderer = watched(&model);
    let camera = perspective(&model, (64, 48));
    let before = render(&mut renderer, &camera);
    let changed = |change: &dyn Fn(&mut Model)| {
        let mut model = model.clone();
        change(&mut model);
        model
    };
    let bad = [
        (changed(&|m| m.instances[0].part = 999), "instance 0 is of part 999"),
        (changed(&|m| m.instances[0].transform.translation.y = f64::NAN), "the transform of instance 0"),
        (changed(&|m| m.instances[0].colour = Some([f32::NAN; 4])), "the colour of instance 0"),
        (changed(&|m| m.parts[0].faces[0].id = 0), "face 0 of part 0 has number 0"),
    ];
    for (model, sentence) in bad {
        match renderer.upload(&model) {
            Err(HeadlessError::Render(error @ RenderError::Model(_))) => {
                assert!(error.to_string().starts_with(&format!("model: {sentence}")), "{error}");
            }
            Err(error) => panic!("{sentence}: another error: {error}"),
            Ok(()) => panic!("{sentence}: uploaded"),
        }
        assert!(!model.bounds().diagonal().is_nan(), "{sentence}"); // framing it must not panic, either
    }
    assert_identical(&before, &render(&mut renderer, &camera), "after errors");
    assert_silent(renderer);
}

#[test]
fn a_volume_without_equations() {
    let model = shapes::plate();
    let mut renderer = watched(&model);
    let camera = perspective(&model, (64, 48));
    let before = render(&mut renderer, &camera);
    let ball = shapes::operands::mesh(shapes::ball_mesh(1));
    let volume = shapes::solids::solid("A", vec![ball]).solids.remove(0);
    match renderer.upload(&Model { trim: Some(volume), ..model }) {
        Err(HeadlessError::Render(RenderError::Solid(error))) => assert_eq!(error, UndrawnSolid::Volume),
        Err(error) => panic!("another error: {error}"),
        Ok(()) => panic!("uploaded"),
    }
    assert_identical(&before, &render(&mut renderer, &camera), "after the error");
    assert_silent(renderer);
}
