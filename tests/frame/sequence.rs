//! Pictures in flight: those of one after another, bit for bit.

use crate::hidden::crowd;
use crate::shapes;
use crate::support::{assert_identical, assert_silent, watched, watched_with};
use glam::DVec3;
use selvedge::model::{Camera, Model};
use selvedge::picture::{FrameSettings, Outputs, Picture, SceneSettings, TrimWay};

/// Around the model, nearer and nearer.
fn turn(model: &Model, count: u32, size: (u32, u32)) -> Vec<Camera> {
    let of = |nth: u32| {
        let (sin, cos) = (0.4 * f64::from(nth)).sin_cos();
        let camera = Camera::around(model.control_bounds(), DVec3::new(cos, sin, 0.7), DVec3::Z, 0.6, size);
        let nearer = 1.0 - 0.1 * f64::from(nth % 8);
        Camera { eye: camera.target + nearer * (camera.eye - camera.target), depth_range: (0.1, 1e3), ..camera }
    };
    (0..count).map(of).collect()
}

fn check(model: &Model, settings: SceneSettings, count: u32) {
    let cameras = turn(model, count, (160, 120));
    let settings_of_frame = FrameSettings::default();
    let mut one_by_one = watched_with(model, settings);
    let mut in_flight = watched_with(model, settings);
    let mut taken = 0;
    in_flight
        .render_sequence(&cameras, &settings_of_frame, Outputs::ALL, |nth, seen| {
            assert_eq!(nth, taken, "in their order");
            let expected = one_by_one.render(&cameras[nth], &settings_of_frame, Outputs::ALL).unwrap();
            let picture = Picture {
                colour: seen.colour.to_vec(),
                depth: seen.depth.to_vec(),
                face: seen.face.to_vec(),
                uv: seen.uv.to_vec(),
                normal: seen.normal.iter().map(|n| [n[0], n[1], n[2]]).collect(),
                ..expected.clone()
            };
            assert_eq!(seen.size, expected.size);
            assert_identical(&picture, &expected, &format!("picture {nth}"));
            taken += 1;
        })
        .unwrap();
    assert_eq!(taken, cameras.len());
    // and the renderer goes on
    let camera = &cameras[0];
    let again = in_flight.render(camera, &settings_of_frame, Outputs::ALL).unwrap();
    let expected = one_by_one.render(camera, &settings_of_frame, Outputs::ALL).unwrap();
    assert_identical(&again, &expected, "afterwards");
    [one_by_one, in_flight].into_iter().for_each(assert_silent);
}

#[test]
fn patches_that_lie_behind_others() {
    check(&crowd(), SceneSettings { trim: TrimWay::Exact, ..SceneSettings::default() }, 9);
}

#[test]
fn fewer_than_fly() {
    check(&shapes::pair(), SceneSettings::default(), 2);
}

#[test]
fn nothing_is_a_sequence() {
    let mut renderer = watched(&shapes::cube());
    renderer.render_sequence(&[], &FrameSettings::default(), Outputs::default(), |_, _| panic!("a picture")).unwrap();
    assert_silent(renderer);
}
