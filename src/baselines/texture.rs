//! Trim textures: M. Guthe, A. Balázs, R. Klein, *GPU-based trimming and tessellation of NURBS and
//! T-spline surfaces*, 2005.
//!
//! ```text
//!   ┌─────────┐    each placed face has a texture of one bit a texel, as fine as its nearest part needs;
//!   │ .##.... │    it is drawn again for every view
//!   │ .####.. │
//!   └─────────┘    a fan of triangles from a point at infinity to the edges of a loop inverts the texels that it
//!     ▶▶▶▶▶▶▶      covers: in each row, all texels from a crossing to the end. So a crossing inverts
//!                  one texel, and a pass along the rows accumulates the bits
//! ```
//!
//! Tuned beyond the source: 32 texels a word, the least memory for one answer a texel, and one pass along the rows
//! instead of overdraw. The error is half a texel in u and in v, and a sixteenth for the chords. If a texture is larger
//! than the device binds, no frame is drawn: [`GpuError::TooLarge`](crate::gpu::GpuError::TooLarge). Passes:
//! `src/frame/baselines/texture.rs`.

use super::{SceneOptions, TrimMethod};
use crate::abi::Frame;
use crate::model::{Camera, Model};
use crate::scene::{SceneData, SceneRequest, UndrawnSolid, seen_by, view};
use crate::twin;

/// Bytes of all textures of a view, without a limit.
///
/// # Errors
/// The model cannot be drawn.
pub fn wanted_bytes(model: &Model, camera: &Camera, eighths: u32) -> Result<f64, UndrawnSolid> {
    let baseline = SceneOptions { trim: Some(TrimMethod::Texture { eighths }), ..SceneOptions::default() };
    let data = SceneData::new(model, SceneRequest { baseline, ..SceneRequest::default() })?;
    let frame = Frame { cell_count: data.cell_instances.len() as u32, bin_count: data.bin_count, ..Frame::default() };
    let frame = seen_by(camera, frame);
    let pixels = camera.pixel_matrix();
    let views: Vec<_> = data.placements.iter().map(|p| view(pixels, *p)).collect();
    let scene = twin::Scene {
        views: &views,
        instances: &data.instances,
        face_instances: &data.face_instances,
        faces: &data.faces,
        cells: &data.cells,
        cell_instances: &data.cell_instances,
        ..twin::Scene::default()
    };
    let texels = f64::from(eighths) / 8.0;
    let bytes = |speed: &[f32; 2]| {
        let [columns, rows] = speed.map(|s| (f64::from(s) * texels).ceil());
        4.0 * (columns / 32.0).ceil() * rows
    };
    Ok(twin::density::density(&frame, &scene).face_speeds.iter().map(bytes).sum())
}
