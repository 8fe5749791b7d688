//! Twin of `glsl/solids/solid_rects.comp`: the tiles that the box around each leaf may cover.
//!
//! ```text
//!        up ▲   ┌────────┐ box in view axes         slopes at the nearest and the farthest depth, widened
//!           │ ╱ └────────┘                          by half a pixel, then whole tiles
//!       eye └─────────────▶ forward
//! ```

use crate::abi::constants::solid_rects::MARGIN_PX;
use crate::abi::{Frame, LEAF_UNBOUNDED, Leaf, Rect, TILE};

/// The rect of a leaf outside the picture.
pub const NOWHERE: Rect = Rect { first: [1; 2], last: [0; 2] };

/// Tiles across and down the picture.
pub fn tile_count(frame: &Frame) -> [u32; 2] {
    frame.size.map(|side| (side as u32).div_ceil(TILE))
}

/// One rectangle a leaf; `centres` are relative to the eye.
pub fn solid_rects(frame: &Frame, leaves: &[Leaf], centres: &[[f32; 3]]) -> Vec<Rect> {
    leaves.iter().zip(centres).map(|(leaf, centre)| rect_of(frame, leaf, *centre)).collect()
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn rect_of(frame: &Frame, leaf: &Leaf, centre: [f32; 3]) -> Rect {
    let last = tile_count(frame).map(|n| n - 1);
    let everywhere = Rect { first: [0; 2], last };
    if leaf.flags & LEAF_UNBOUNDED != 0 {
        return everywhere;
    }
    let axes = [frame.right, frame.up, frame.forward];
    let middle = axes.map(|axis| dot(axis, centre));
    let reach = axes.map(|axis| dot(axis.map(f32::abs), leaf.half_size));
    let (nearest, farthest) = (middle[2] - reach[2], middle[2] + reach[2]);
    if farthest < frame.near || nearest > frame.far {
        return NOWHERE;
    }
    let perspective = frame.perspective != 0;
    if perspective && nearest < frame.near {
        return everywhere;
    }
    let side = |k: usize| {
        let (lo, hi) = (middle[k] - reach[k], middle[k] + reach[k]);
        let (lo, hi) = match perspective {
            true => ((lo / nearest).min(lo / farthest), (hi / nearest).max(hi / farthest)),
            false => (lo, hi),
        };
        (frame.focal_px[k] * lo - MARGIN_PX, frame.focal_px[k] * hi + MARGIN_PX)
    };
    let ((left, right), (down, up)) = (side(0), side(1));
    let [across, down_to] = frame.principal_px;
    let first = [across + left, down_to - up];
    let end = [across + right, down_to - down];
    if (0..2).any(|k| end[k] < 0.0 || first[k] > frame.size[k]) {
        return NOWHERE;
    }
    let tile = |place: f32, k: usize| place.clamp(0.0, frame.size[k] - 1.0) as u32 / TILE;
    Rect { first: [tile(first[0], 0), tile(first[1], 1)], last: [tile(end[0], 0), tile(end[1], 1)] }
}
