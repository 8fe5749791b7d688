//! What shaders are told of a camera.

use crate::abi;
use crate::model::{Camera, Projection};
use glam::{DAffine3, DMat4, DVec4};

/// The rows that take a placed part to homogeneous pixels: composed in `f64`, rounded once.
pub(crate) fn view(pixels: DMat4, placement: DAffine3) -> abi::View {
    let rows = (pixels * DMat4::from(placement)).transpose();
    let row = |r: DVec4| r.to_array().map(|x| x as f32);
    abi::View { x: row(rows.x_axis), y: row(rows.y_axis), depth: row(rows.z_axis), w: row(rows.w_axis) }
}

/// Pixels per unit slope (or per model unit), and the largest stretch towards the picture's corners.
pub(crate) fn focal_and_slant(camera: &Camera) -> (f64, f64) {
    let (w, h) = (f64::from(camera.size.0), f64::from(camera.size.1));
    match camera.projection {
        Projection::Perspective { fov_y } => {
            let focal = h * 0.5 / (fov_y * 0.5).tan();
            let corner = (w * 0.5).hypot(h * 0.5) / focal;
            (focal, (1.0 + corner * corner).sqrt())
        }
        Projection::Orthographic { height } => (h / height, 1.0),
    }
}

/// `frame` as the camera sees it: those of its constants that say where what it shows is, and how large.
pub(crate) fn seen_by(camera: &Camera, frame: abi::Frame) -> abi::Frame {
    let (focal, slant) = focal_and_slant(camera);
    abi::Frame {
        size: [camera.size.0 as f32, camera.size.1 as f32],
        focal: focal as f32,
        slant: slant as f32,
        near: camera.depth_range.0 as f32,
        far: camera.depth_range.1 as f32,
        perspective: u32::from(matches!(camera.projection, Projection::Perspective { .. })),
        ..frame
    }
}
