//! The eye within a solid: its walls show their backs, which no gap explains.
//!
//! ```text
//!   ┌───────────────┐
//!   │        ┌───┐··│··    beside the thing, the plane of its face goes on;
//!   │ eye    └───┘  │      the wall behind is seen
//!   └───────────────┘
//! ```

use crate::shapes;
use crate::support::{assert_silent, render, watched};
use glam::{DAffine3, DQuat, DVec2, DVec3, EulerRot};
use selvedge::model::{Camera, Instance, Model};
use selvedge_check::{JudgeOptions, Tracer, judge};

const SIZE: (u32, u32) = (240, 180);
/// Middle of the thing.
const THING: DVec3 = DVec3::new(0.3, 0.2, 0.1);

/// A cube within a cube.
fn room() -> Model {
    let mut model = shapes::cube();
    let mut thing = model.parts[0].clone();
    thing.faces.iter_mut().for_each(|face| face.id += 10);
    model.parts.push(thing);
    let turn = DQuat::from_euler(EulerRot::XYZ, 0.3, 0.5, 0.2);
    let place = DAffine3::from_scale_rotation_translation(DVec3::splat(0.12), turn, THING);
    model.instances.push(Instance { part: 1, ..shapes::placed(place, None) });
    model
}

#[test]
fn a_thing_in_a_room_ends_at_its_borders() {
    let model = room();
    let around = Camera::around(model.control_bounds(), DVec3::X, DVec3::Z, 0.8, SIZE);
    let mut camera = Camera { eye: DVec3::new(-0.9, 0.1, 0.05), target: THING, ..around };
    camera.fit_depth(model.control_bounds());
    let tracer = Tracer::new(&model);
    assert_eq!(tracer.hits(&camera, DVec2::new(120.5, 90.5)).len(), 3, "the thing, and the wall behind it");
    let mut renderer = watched(&model);
    let picture = render(&mut renderer, &camera);
    let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions::default());
    assert_eq!((j.wrong, j.given_up), (0, 0), "{:?}", j.mismatches);
    assert_silent(renderer);
}
