//! The reference for boxes.

use glam::{DAffine3, DQuat, DVec3};
use selvedge_geometry::model::{Bounds, Face, Instance, Model, Part};

/// The box with these largest heights along an axis or against it.
pub fn of_support(height: impl Fn(DVec3) -> f64) -> Bounds {
    let max = DVec3::new(height(DVec3::X), height(DVec3::Y), height(DVec3::Z));
    let below = DVec3::new(height(DVec3::NEG_X), height(DVec3::NEG_Y), height(DVec3::NEG_Z));
    Bounds { min: -below, max }
}

/// Each side is where it should be, to a share of the diagonal.
#[track_caller]
pub fn assert_box(found: Bounds, expected: Bounds, share: f64) {
    let off = (found.min - expected.min).abs().max((found.max - expected.max).abs()).max_element();
    assert!(off <= share * expected.diagonal(), "off by {off:e}: {found:?} instead of {expected:?}");
}

/// The face as the one part of a model, placed.
pub fn placed(face: &Face, transform: DAffine3) -> Model {
    let part = Part { faces: vec![face.clone()], ..Part::default() };
    let instance = Instance { part: 0, transform, colour: None, name: String::new() };
    Model { parts: vec![part], instances: vec![instance], ..Model::default() }
}

/// Turned about axes that are along nothing, and moved.
pub fn turns() -> Vec<DAffine3> {
    let turn = |axis: [f64; 3], angle: f64, to: [f64; 3]| {
        DAffine3::from_rotation_translation(DQuat::from_axis_angle(DVec3::from(axis).normalize(), angle), to.into())
    };
    vec![
        DAffine3::IDENTITY,
        turn([1.0, 2.0, -0.5], 0.7, [3.0, -20.0, 7.0]),
        turn([-0.3, 0.2, 1.0], 2.9, [0.0, 0.0, 1000.0]),
        // mirrored, and longer one way
        turn([0.0, 1.0, 0.4], -1.3, [1.0, 1.0, 1.0]) * DAffine3::from_scale(DVec3::new(-1.0, 1.0, 2.5)),
    ]
}

/// The face has the box that a support says, however it is placed.
#[track_caller]
pub fn assert_support(face: &Face, support: impl Fn(DVec3) -> f64, share: f64) {
    assert_box(face.bounds(), of_support(&support), share);
    for transform in turns() {
        let height = |e: DVec3| support(transform.matrix3.transpose() * e) + e.dot(transform.translation);
        assert_box(placed(face, transform).bounds(), of_support(height), share);
    }
}
