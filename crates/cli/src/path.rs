//! The fixed camera paths of `bench`: one turn around the model, nearer and back twice; turns around all of it, around a
//! corner of it, and from its middle.
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

/// The same of a corner of the model's bounding box: a quarter of each of its sides is in view, and what lies behind.
pub fn around_a_corner(bounds: Bounds, size: (u32, u32), index: usize) -> Camera {
    let Bounds { min, max } = bounds;
    let quarter = 0.25 * (max - min);
    // right, in front and above: nothing of the model is before it in the first thirty frames
    let corner = Bounds {
        min: DVec3::new(max.x - quarter.x, min.y, max.z - quarter.z),
        max: DVec3::new(max.x, min.y + quarter.y, max.z),
    };
    let mut camera = turned(corner, size, index);
    camera.fit_depth(bounds);
    camera
}

/// Camera of frame `index` of a turn by three degrees a frame in the middle of the model.
pub fn from_within(bounds: Bounds, size: (u32, u32), index: usize) -> Camera {
    let azimuth = (3.0 * index as f64).to_radians();
    let back = DVec3::new(azimuth.sin(), -azimuth.cos(), 0.0);
    let mut camera = Camera::around(bounds, back, DVec3::Z, Camera::FOV_DEG.to_radians(), size);
    let ahead = camera.target - camera.eye;
    camera.eye = camera.target;
    camera.target += ahead;
    camera.fit_depth(bounds);
    camera
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

    /// Where a camera sees a point, pixels right and down.
    fn seen_at(camera: &Camera, point: DVec3) -> (f64, f64) {
        let q = camera.pixel_matrix() * point.extend(1.0);
        assert!(q.w > 0.0, "{point} is behind the eye");
        (q.x / q.w, q.y / q.w)
    }

    #[test]
    fn around_a_corner_the_opposite_one_is_beside_the_picture() {
        for index in 0..=30 {
            let camera = around_a_corner(BOX, (640, 480), index);
            assert_eq!(camera.check(), Ok(()));
            let (x, y) = seen_at(&camera, DVec3::new(7.0, -1.0, 3.0));
            assert!(x > 0.0 && x < 640.0 && y > 0.0 && y < 480.0, "frame {index}: ({x}, {y})");
            assert!(camera.eye.x > 7.0 || camera.eye.y < -1.0 || camera.eye.z > 3.0, "frame {index}: {}", camera.eye);
        }
        let (x, _) = seen_at(&around_a_corner(BOX, (640, 480), 0), DVec3::new(-5.0, 2.0, 0.0));
        assert!(x < 0.0, "{x}");
    }

    #[test]
    fn from_within_the_eye_is_in_the_middle() {
        for index in 0..120 {
            let camera = from_within(BOX, (640, 480), index);
            assert_eq!(camera.check(), Ok(()));
            assert_eq!(camera.eye, BOX.centre());
            assert!(camera.depth_range.1 > 0.5 * BOX.diagonal(), "frame {index}: {:?}", camera.depth_range);
        }
    }

    #[test]
    fn the_path_begins_with_the_whole_model_and_comes_eight_times_nearer() {
        let gap = |index| (camera(BOX, (640, 480), index, 24).eye - BOX.centre()).length() - BOX.diagonal() * 0.5;
        assert!((gap(0) / gap(6) - LARGEST_ZOOM).abs() < 1e-9);
    }
}
