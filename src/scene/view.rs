//! The numbers that shaders read of a camera.

use crate::abi;
use crate::model::Camera;
use glam::{DAffine3, DMat4, DVec2, DVec4};

/// The rows that map a placed part to homogeneous pixels: composed in `f64`, rounded once.
pub(crate) fn view(pixels: DMat4, placement: DAffine3) -> abi::View {
    let rows = (pixels * DMat4::from(placement)).transpose();
    let row = |r: DVec4| r.to_array().map(|x| x as f32);
    abi::View { x: row(rows.x_axis), y: row(rows.y_axis), depth: row(rows.z_axis), w: row(rows.w_axis) }
}

/// The larger of the two focal lengths, in pixels per unit slope (or per model unit), and the largest stretch towards
/// the picture's corners.
pub(crate) fn focal_and_slant(camera: &Camera) -> (f64, f64) {
    let focal = camera.focal_px().max_element();
    if !camera.is_perspective() {
        return (focal, 1.0);
    }
    let far = farthest_sides(camera) * (focal / camera.focal_px());
    let corner = far.x.hypot(far.y) / focal;
    (focal, (1.0 + corner * corner).sqrt())
}

/// The larger of left and right, and of bottom and top, measured from the view axis to the side of the picture with
/// `margin_px` more pixels: slopes, or model units in a parallel view.
pub(crate) fn half_slopes(camera: &Camera, margin_px: f64) -> DVec2 {
    (farthest_sides(camera) + margin_px) / camera.focal_px()
}

/// Pixels from the view axis to the farther of left and right, and to the farther of top and bottom.
fn farthest_sides(camera: &Camera) -> DVec2 {
    let size = DVec2::new(f64::from(camera.size.0), f64::from(camera.size.1));
    let principal = camera.principal_px();
    principal.max(size - principal)
}

/// `frame` with the constants that depend on the camera's place, direction and picture.
pub fn seen_by(camera: &Camera, frame: abi::Frame) -> abi::Frame {
    let (focal, slant) = focal_and_slant(camera);
    abi::Frame {
        size: [camera.size.0 as f32, camera.size.1 as f32],
        focal: focal as f32,
        slant: slant as f32,
        near: camera.depth_range.0 as f32,
        far: camera.depth_range.1 as f32,
        perspective: u32::from(camera.is_perspective()),
        focal_px: camera.focal_px().as_vec2().to_array(),
        principal_px: camera.principal_px().as_vec2().to_array(),
        ..frame
    }
}
