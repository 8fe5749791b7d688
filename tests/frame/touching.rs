//! A front just before another solid's back: every pixel above the strip is a candidate, and most of them have only
//! candidates as neighbours.
//!
//! ```text
//!        eye
//!         │
//!   ══════╪══════════ 1, faces up         the gap is a fiftieth of a pixel, and fronts are moved back by a
//!        ─▼──         2, faces down       twelfth: the strip wins every pixel that it covers
//! ```
//!
//! And solids welded together, whose faces coincide.

use crate::shapes::{self, PLATE_HALF, TOUCHING_END, TOUCHING_GAP, TOUCHING_STRIP};
use crate::support::{assert_silent, orthographic, perspective, render, watched, watched_with};
use glam::{DAffine3, DMat3, DVec3};
use selvedge::construct::shapes::{block, cylinder, tube};
use selvedge::model::{Camera, Instance, Model, Projection};
use selvedge::picture::{Picture, SceneSettings, TrimWay};
use selvedge_check::{JudgeOptions, Tracer, judge};

/// Pixels a side of the picture.
const SIZE: u32 = 64;

const PIXEL: f64 = 0.15;

fn from_straight_above(model: &Model) -> Picture {
    let mut renderer = watched(model);
    let camera = Camera {
        eye: DVec3::Z * 10.0,
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: PIXEL * f64::from(SIZE) },
        depth_range: (5.0, 15.0),
        size: (SIZE, SIZE),
    };
    const { assert!(TOUCHING_GAP < PIXEL / 24.0, "the strip must win before gaps are filled") };
    let picture = render(&mut renderer, &camera);
    assert_silent(renderer);
    picture
}

/// Number of pixels of a face, and between two x across the plate; all borders run between pixel centres.
fn counts<const N: usize>(picture: &Picture, widths: [(u32, f64); N]) -> [(usize, usize); N] {
    let side = |length: f64| (length / PIXEL).round() as usize;
    let count = |id: u32| picture.face.iter().filter(|&&f| f == id).count();
    widths.map(|(id, width)| (count(id), side(width) * side(2.0 * PLATE_HALF)))
}

/// The strip is not visible: face 1 has each pixel whose centre is above it.
#[test]
fn a_strip_just_below_a_face_is_not_seen() {
    const { assert!(TOUCHING_STRIP > 2.0 * PIXEL, "some gap candidate must have no other neighbour") };
    let picture = from_straight_above(&shapes::touching());
    for (pixels, expected) in counts(&picture, [(1, 2.0 * PLATE_HALF), (2, 0.0)]) {
        assert_eq!(pixels, expected);
    }
}

/// Where face 1 ends with the strip, neighbouring pixels show the floor, which the strip hides, and face 1 is farther
/// away.
#[test]
fn nor_is_the_floor_below_it() {
    let picture = from_straight_above(&shapes::touching_at_its_end());
    let (plate, floor) = (PLATE_HALF + TOUCHING_END, PLATE_HALF - TOUCHING_END);
    for (pixels, expected) in counts(&picture, [(1, plate), (2, 0.0), (3, floor)]) {
        assert_eq!(pixels, expected);
    }
}

/// A plate in a turned frame, with stacks of pipes, posts and blocks on it, each welded to the one below: an end face lies
/// in another solid's face, and where radii are equal the sides go on, too.
fn welded() -> Model {
    let post = |radius: f64, height| cylinder(radius, height).unwrap();
    let pipe = |radius: f64, height| tube(radius, 0.7 * radius, height).unwrap();
    let cube = |half: f64, height| block(DVec3::new(-half, -half, 0.0), DVec3::new(half, half, height)).unwrap();
    let stacks = [
        ((-10.0, -8.0), vec![(pipe(5.3, 7.1), 7.1), (pipe(5.3, 4.7), 4.7), (post(3.1, 2.9), 2.9)]),
        ((9.0, -9.0), vec![(post(6.4, 5.2), 5.2), (post(6.4, 3.3), 3.3), (cube(4.1, 6.0), 6.0)]),
        ((-9.0, 10.0), vec![(cube(5.7, 3.9), 3.9), (pipe(5.7, 8.2), 8.2)]),
        ((10.0, 9.0), vec![(post(4.4, 6.6), 6.6), (cube(4.4, 2.2), 2.2), (pipe(4.4, 5.1), 5.1)]),
    ];
    let turned = DMat3::from_rotation_z(0.7) * DMat3::from_rotation_y(0.4) * DMat3::from_rotation_x(1.1);
    let plate = block(DVec3::new(-18.0, -18.0, -3.0), DVec3::new(18.0, 18.0, 0.0)).unwrap();
    let mut placed = vec![(DVec3::ZERO, plate)];
    for ((x, y), stack) in stacks {
        let mut z = 0.0;
        for (body, height) in stack {
            placed.push((DVec3::new(x, y, z), body));
            z += height;
        }
    }
    let mut model = Model::default();
    let mut id = 0;
    for (at, body) in placed {
        let mut part = body.part;
        for face in &mut part.faces {
            id += 1;
            face.id = id;
        }
        let transform = DAffine3::from_mat3_translation(turned, turned * at);
        model.instances.push(Instance { part: model.parts.len(), transform, colour: None, name: String::new() });
        model.parts.push(part);
    }
    model
}

/// Both of two faces that coincide are right where they are seen; of what is drawn no pixel is off by more than half.
#[test]
fn welded_solids_are_right() {
    let model = welded();
    let tracer = Tracer::new(&model);
    for trim in [TrimWay::Table, TrimWay::Exact] {
        let mut renderer = watched_with(&model, SceneSettings { trim, ..SceneSettings::default() });
        for camera in [perspective(&model, (240, 135)), orthographic(&model, (320, 180))] {
            let picture = render(&mut renderer, &camera);
            let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions::default());
            assert_eq!((j.wrong, j.unsearched), (0, 0), "{trim:?}: {:?}", j.mismatches);
            assert!(j.agree > 5000, "{trim:?}: {} pixels agree", j.agree);
        }
        assert_silent(renderer);
    }
}
