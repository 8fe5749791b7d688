//! Twin of the pass `density`: pixels that each v-strip of a trimmed face can cover.
//!
//! ```text
//!   |S_v| <= speed_v  and  W >= w over the cell   =>   strip height in pixels <= speed_v pixels / strips
//! ```

use super::Scene;
use super::view::{far_of, nearest_in_slab, pixels_per_unit, see};
use crate::abi::{Cell, Face, FaceInstance, Frame};
use crate::math::octahedral;

/// The results of the pass.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Density {
    /// Height of each placed strip in pixels, at its first bin; 0 if it is not visible.
    pub strip_heights: Vec<f32>,
    /// Largest pixels per unit of `u` and of `v` of each placed face.
    pub face_speeds: Vec<[f32; 2]>,
    /// A bit for each visible bin of each placed strip, at its first bin.
    pub seen_bins: Vec<u32>,
}

/// Pixels that one unit of a cell can cover; `None` if the cell is not visible.
fn pixels_of(frame: &Frame, scene: &Scene<'_>, placed: FaceInstance, face: &Face, cell: &Cell) -> Option<f32> {
    let instance = &scene.instances[placed.instance as usize];
    if frame.table_density > 0.0 {
        return Some(frame.table_density * instance.scale);
    }
    let view = &scene.views[placed.instance as usize];
    let (margin, far) = (frame.gap_radius_px + 1.0, far_of(face, frame));
    let mut seen = see(view, frame, cell.box_min, cell.box_max, margin, far)?;
    if frame.perspective != 0 {
        let normal = octahedral::unpack(cell.normal);
        seen.w = seen.w.max(nearest_in_slab(view, frame, normal, (cell.low, cell.high), margin));
    }
    Some(pixels_per_unit(frame, instance, &seen))
}

/// The largest values over the visible cells of each strip and of each face.
pub fn density(frame: &Frame, scene: &Scene<'_>) -> Density {
    let mut out = Density {
        strip_heights: vec![0.0; frame.bin_count as usize],
        face_speeds: vec![[0.0; 2]; scene.face_instances.len()],
        seen_bins: vec![0; frame.bin_count as usize],
    };
    for cell_instance in 0..frame.cell_count as usize {
        let placed_index = scene.cell_instances[cell_instance] as usize;
        let placed = scene.face_instances[placed_index];
        let face = scene.faces[placed.face as usize];
        let cell = scene.cells[face.first_cell as usize + cell_instance - placed.first_cell as usize];
        if cell.speed_v < 0.0 {
            continue;
        }
        let Some(pixels) = pixels_of(frame, scene, placed, &face, &cell) else { continue };
        let bin = cell.bin % face.bin_count();
        let strip = (placed.first_bin + cell.bin - bin) as usize;
        out.seen_bins[strip] |= 1 << bin;
        let height = &mut out.strip_heights[strip];
        // a visible strip gets a scan line, even if it is nearly parallel to the rays
        *height = height.max((cell.speed_v * pixels / face.strip_count() as f32).max(1e-6));
        let speeds = &mut out.face_speeds[placed_index];
        *speeds = [speeds[0].max(cell.speed_u * pixels), speeds[1].max(cell.speed_v * pixels)];
    }
    out
}
