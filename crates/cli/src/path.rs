//! The fixed camera path of `bench`: one turn around the model, nearer and back twice.
//!
//! ```text
//!   azimuth    a = 2 pi t                     t = frame / frames in [0, 1)
//!   elevation  e = 30 deg + 20 deg sin a      the model is seen from 10 to 50 degrees above its ground
//!   distance   d = framing / zoom             zoom = 8 ^ ((1 - cos 2 a) / 2), from 1 to 8 and back, twice
//! ```
//!
//! Zoom is geometric: each frame is nearer than the one before by the same factor.

use glam::DVec3;
use selvedge::model::{Bounds, Camera};
use std::f64::consts::TAU;

/// Closest approach of the path, relative to the view of the whole model.
const LARGEST_ZOOM: f64 = 8.0;

/// Camera of frame `index` of `count`.
pub fn camera(bounds: Bounds, size: (u32, u32), index: usize, count: usize) -> Camera {
    let azimuth = TAU * index as f64 / count as f64;
    let elevation = (30.0 + 20.0 * azimuth.sin()).to_radians();
    let zoom = LARGEST_ZOOM.powf((1.0 - (2.0 * azimuth).cos()) / 2.0);
    let from = DVec3::new(azimuth.sin() * elevation.cos(), -azimuth.cos() * elevation.cos(), elevation.sin());
    let mut camera = Camera::around(bounds, from, DVec3::Z, Camera::FOV_DEG.to_radians(), size);
    // the eye comes nearer to the front of the bounding sphere, never into it
    let radius = (bounds.diagonal() * 0.5).max(1e-9);
    let distance = (camera.eye - camera.target).length();
    camera.eye = camera.target + from * (radius + (distance - radius) / zoom);
    camera.fit_depth(bounds);
    camera
}

/// Camera of frame `index` of a turn by three degrees a frame, 30 degrees above the ground: all of the model.
pub fn turned(bounds: Bounds, size: (u32, u32), index: usize) -> Camera {
    let azimuth = (3.0 * index as f64).to_radians();
    let elevation = 30f64.to_radians();
    let from = DVec3::new(azimuth.sin() * elevation.cos(), -azimuth.cos() * elevation.cos(), elevation.sin());
    Camera::around(bounds, from, DVec3::Z, Camera::FOV_DEG.to_radians(), size)
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: Bounds = Bounds { min: DVec3::new(-5.0, -1.0, 0.0), max: DVec3::new(7.0, 2.0, 3.0) };

    #[test]
    fn every_camera_is_valid_and_outside_the_model() {
        for count in [1, 7, 24] {
            for index in 0..count {
                let camera = camera(BOX, (640, 480), index, count);
                assert_eq!(camera.check(), Ok(()));
                let distance = (camera.eye - BOX.centre()).length();
                assert!(distance > BOX.diagonal() * 0.5);
            }
        }
    }

    #[test]
    fn the_path_begins_with_the_whole_model_and_comes_eight_times_nearer() {
        let gap = |index| (camera(BOX, (640, 480), index, 24).eye - BOX.centre()).length() - BOX.diagonal() * 0.5;
        assert!((gap(0) / gap(6) - LARGEST_ZOOM).abs() < 1e-9);
    }
}
