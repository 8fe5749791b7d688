//! Twin of the pass [`density`](crate::passes): pixels that each v-strip of a trimmed face can cover.
//!
//! ```text
//!   |S_v| <= speed_v  and  W >= w over the cell   =>   strip height in pixels <= speed_v pixels / strips
//! ```
//!
//! A strip that is seen at an angle has fewer. With the pixel `x = X / W`, where `X` and `W` are linear in the point,
//!
//! ```text
//!   W x_v = (X - x W) · S_v        |S_v - c| <= r        =>    W |x_v| <= |(X - x W) · c| + |X - x W| r
//! ```
//!
//! whose right side is convex in `x`, so the ends of what the cell may cover of the picture suffice; `y` alike. Of the two
//! the hypotenuse is taken, since the row that is looked up is off along both.

use super::Scene;
use super::view::{Seen, far_of, pixels_per_unit, see};
use crate::abi::{Cell, Frame, View};

/// Of the bound in all directions: the rounding of one in a direction.
const SPEED_ROUNDING: f32 = 1e-4;

/// What the pass writes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Density {
    /// Height of each placed strip in pixels, at its first bay; 0 for one that cannot be seen.
    pub strip_heights: Vec<f32>,
    /// Largest pixels per unit of `u` and of `v` of each placed face.
    pub face_speeds: Vec<[f32; 2]>,
    /// A bit for each bay that can be seen of each placed strip, at its first bay.
    pub seen_bays: Vec<u32>,
}

/// The largest over the visible cells of each strip and of each face.
pub fn density(frame: &Frame, scene: &Scene<'_>) -> Density {
    let mut out = Density {
        strip_heights: vec![0.0; frame.bay_count as usize],
        face_speeds: vec![[0.0; 2]; scene.face_instances.len()],
        seen_bays: vec![0; frame.bay_count as usize],
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
        let (margin, far) = (frame.ring_px + 1.0, far_of(&face, frame));
        let Some(seen) = see(view, frame, cell.box_min, cell.box_max, margin, far) else { continue };
        let pixels = pixels_per_unit(frame, &scene.instances[placed.instance as usize], &seen);
        let bay = cell.bay % face.bay_count();
        let strip = (placed.first_bay + cell.bay - bay) as usize;
        out.seen_bays[strip] |= 1 << bay;
        let height = &mut out.strip_heights[strip];
        // a visible strip gets a scan line, however flat it is seen
        let speed = speed_on_screen(view, frame, &seen, &cell, cell.speed_v * pixels);
        *height = height.max((speed / face.strip_count() as f32).max(1e-6));
        let speeds = &mut out.face_speeds[placed_index];
        *speeds = [speeds[0].max(cell.speed_u * pixels), speeds[1].max(cell.speed_v * pixels)];
    }
    out
}

/// Pixels to the right and down per unit of `v`, at most, of what is in the picture; `most` holds in all directions.
fn speed_on_screen(view: &View, frame: &Frame, seen: &Seen, cell: &Cell, most: f32) -> f32 {
    let margin = frame.ring_px + 1.0;
    let [slope_x, slope_y, slope_z] = cell.slope_v;
    let axis = |row: [f32; 4], low: f32, high: f32, size: f32| {
        [low, high].into_iter().fold(0.0f32, |speed, pixel| {
            let pixel = pixel.clamp(-margin, size + margin);
            let [x, y, z]: [f32; 3] = std::array::from_fn(|k| row[k] - pixel * view.w[k]);
            let along = x * slope_x + y * slope_y + z * slope_z;
            speed.max(along.abs() + (x * x + y * y + z * z).sqrt() * cell.spread_v)
        })
    };
    let x = axis(view.x, seen.low[0], seen.high[0], frame.size[0]);
    let y = axis(view.y, seen.low[1], seen.high[1], frame.size[1]);
    ((x * x + y * y).sqrt() / seen.w + SPEED_ROUNDING * most).min(most)
}
