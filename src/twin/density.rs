//! Twin of the pass [`density`](crate::passes): pixels that each v-strip of a trimmed face can cover.
//!
//! ```text
//!   |S_v| <= speed_v  and  W >= w over the cell   =>   strip height in pixels <= speed_v pixels / strips
//! ```

use super::Scene;
use super::view::{pixels_per_unit, see};
use crate::abi::Frame;

/// What the pass writes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Density {
    /// Height of each placed strip in pixels; 0 for one that cannot be seen.
    pub strip_heights: Vec<f32>,
    /// Largest pixels per unit of `u` and of `v` of each placed face.
    pub face_speeds: Vec<[f32; 2]>,
}

/// The largest over the visible cells of each strip and of each face.
pub fn density(frame: &Frame, scene: &Scene<'_>) -> Density {
    let mut out = Density {
        strip_heights: vec![0.0; frame.strip_count as usize],
        face_speeds: vec![[0.0; 2]; scene.face_instances.len()],
    };
    for item in 0..frame.cell_count as usize {
        let placed_index = scene.cell_items[item] as usize;
        let placed = scene.face_instances[placed_index];
        let face = scene.faces[placed.face as usize];
        let cell = scene.cells[face.first_cell as usize + item - placed.first_cell as usize];
        if cell.speed_v < 0.0 {
            continue;
        }
        let view = &scene.views[placed.instance as usize];
        let Some(seen) = see(view, frame, cell.box_min, cell.box_max, frame.ring_px + 1.0) else { continue };
        let pixels = pixels_per_unit(frame, &scene.instances[placed.instance as usize], &seen);
        let height = &mut out.strip_heights[(placed.first_strip + cell.strip) as usize];
        // a visible strip gets a scan line, however flat it is seen
        *height = height.max((cell.speed_v * pixels / face.strip_count as f32).max(1e-6));
        let speeds = &mut out.face_speeds[placed_index];
        *speeds = [speeds[0].max(cell.speed_u * pixels), speeds[1].max(cell.speed_v * pixels)];
    }
    out
}
