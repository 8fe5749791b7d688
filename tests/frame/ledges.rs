//! Walls narrower than a pixel, one behind the other: a skirt hides a face, which must not be lost.
//!
//! ```text
//!            4                  skirt of the nearest wall's back: a quarter of a pixel
//!   ──────────────── 0.75       above the edge, so before the centre
//!            3
//!   ──────────────── 0.31
//!            2      ∙ centre    no other pixel shows face 2
//!   ════════════════ 0 ┄┄┄┄┄
//!            1
//! ```

use crate::shapes::{self, LEDGES};
use crate::support::{assert_silent, render, watched};
use glam::DVec3;
use selvedge::model::{Camera, Projection};

/// Pixels a side of the picture, of one unit each.
const SIZE: u32 = 12;
/// The pixel centres' height above whole units.
const CENTRE: f64 = 0.17;

/// Each row shows the wall at the height of its centres.
#[test]
fn a_wall_behind_a_skirt_is_seen() {
    let model = shapes::ledges();
    let mut renderer = watched(&model);
    let up = DVec3::Z * (CENTRE - 0.5);
    let camera = Camera {
        eye: DVec3::NEG_Y * 10.0 + up,
        target: up,
        up: DVec3::Z,
        projection: Projection::Orthographic { height: f64::from(SIZE) },
        depth_range: (5.0, 25.0),
        size: (SIZE, SIZE),
    };
    let picture = render(&mut renderer, &camera);
    for (row, faces) in picture.face.chunks(SIZE as usize).enumerate() {
        let height = f64::from(SIZE) / 2.0 - 1.0 - row as f64 + CENTRE;
        let wall = LEDGES.iter().position(|&top| height < top).expect("the last is higher than the picture");
        assert!(faces.iter().all(|&face| face == wall as u32 + 1), "at {height}: {faces:?}");
    }
    assert_silent(renderer);
}
