//! Trim textures: M. Guthe, A. Balázs, R. Klein, *GPU-based trimming and tessellation of NURBS and
//! T-spline surfaces*, 2005.
//!
//! ```text
//!   ┌─────────┐    each placed face has a texture of one bit a texel, as fine as the nearest part of it
//!   │ .##.... │    is seen; drawn anew in every view
//!   │ .####.. │
//!   └─────────┘    a fan of triangles from a point at infinity to the edges of a loop, each inverting
//!     ▶▶▶▶▶▶▶      what it covers, is in each row a run from a crossing to the end: so a crossing inverts
//!                  one texel, and a pass along the rows inverts what follows
//! ```
//!
//! Tuned beyond the source: 32 texels a word, which is the least memory that an exact answer a texel can
//! take, and one pass along the rows instead of the runs' overdraw. Off by half a texel in u and in v, and by
//! a sixteenth for the chords. A texture larger than the device binds does not fit, and no frame is drawn:
//! [`GpuError::TooLarge`](crate::gpu::GpuError::TooLarge). Passes: `src/frame/baselines/texture.rs`.

use super::{SceneOptions, TrimMethod};
use crate::abi::Frame;
use crate::model::{Camera, Model};
use crate::scene::{SceneData, SceneRequest, UndrawnSolid, seen_by, view};
use crate::twin;

/// Bytes that all textures take in a view, had they room: what the passes count, without their limits.
///
/// # Errors
/// The model cannot be drawn at all.
pub fn wanted_bytes(model: &Model, camera: &Camera, eighths: u32) -> Result<f64, UndrawnSolid> {
    let baseline = SceneOptions { trim: Some(TrimMethod::Texture { eighths }), ..SceneOptions::default() };
    let data = SceneData::new(model, SceneRequest { baseline, ..SceneRequest::default() })?;
    let frame = Frame { cell_count: data.cell_items.len() as u32, bin_count: data.bin_count, ..Frame::default() };
    let frame = seen_by(camera, frame);
    let pixels = camera.pixel_matrix();
    let views: Vec<_> = data.placements.iter().map(|p| view(pixels, *p)).collect();
    let scene = twin::Scene {
        views: &views,
        instances: &data.instances,
        face_instances: &data.face_instances,
        faces: &data.faces,
        cells: &data.cells,
        cell_items: &data.cell_items,
        ..twin::Scene::default()
    };
    let texels = f64::from(eighths) / 8.0;
    let bytes = |speed: &[f32; 2]| {
        let [columns, rows] = speed.map(|s| (f64::from(s) * texels).ceil());
        4.0 * (columns / 32.0).ceil() * rows
    };
    Ok(twin::density::density(&frame, &scene).face_speeds.iter().map(bytes).sum())
}
