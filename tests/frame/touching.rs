//! A front just before another solid's back: every pixel above the strip is a candidate, and most of them have only
//! candidates as neighbours.
//!
//! ```text
//!        eye
//!         │
//!   ══════╪══════════ 1, faces up         the gap is a fiftieth of a pixel, and fronts are moved back by a
//!        ─▼──         2, faces down       twelfth: the strip wins every pixel that it covers
//! ```

use crate::shapes::{self, PLATE_HALF, TOUCHING_END, TOUCHING_GAP, TOUCHING_STRIP};
use crate::support::{assert_silent, render, watched};
use glam::DVec3;
use selvedge::model::{Camera, Model, Projection};
use selvedge::picture::Picture;

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
