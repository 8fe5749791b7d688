//! A front just before another solid's back: every pixel above the strip is doubtful, and most of them have
//! doubtful neighbours only.
//!
//! ```text
//!        eye
//!         │
//!   ══════╪══════════ 1, looks up         the gap is a fiftieth of a pixel, and fronts stand back by a
//!        ─▼──         2, looks down       twelfth: the strip wins every pixel that it covers
//! ```

use crate::shapes::{self, PLATE_HALF, TOUCHING_GAP, TOUCHING_STRIP};
use crate::support::{assert_silent, render, watched};
use glam::DVec3;
use selvedge::model::{Camera, Projection};

/// Pixels a side of the picture.
const SIZE: u32 = 64;

/// From straight above nothing of the strip is seen: face 1 has each pixel whose centre is above it.
#[test]
fn a_strip_just_below_a_face_is_not_seen() {
    let model = shapes::touching();
    let mut renderer = watched(&model);
    let pixel = 0.15;
    let camera = Camera {
        eye: DVec3::Z * 10.0,
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: pixel * f64::from(SIZE) },
        depth_range: (5.0, 15.0),
        size: (SIZE, SIZE),
    };
    assert!(TOUCHING_GAP < pixel / 24.0, "the strip must win before it is healed");
    assert!(TOUCHING_STRIP > 2.0 * pixel, "some doubtful pixel must have no other neighbour");
    let picture = render(&mut renderer, &camera);
    let count = |id: u32| picture.face.iter().filter(|&&f| f == id).count();
    // all borders run between pixel centres
    let side = (2.0 * PLATE_HALF / pixel).round() as usize;
    assert_eq!((count(1), count(2)), (side * side, 0));
    assert_silent(renderer);
}
