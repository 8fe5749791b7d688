//! Twin of the pass [`segments`](crate::passes): linear segments of each trim curve.
//!
//! ```text
//!   n >= sqrt(bend . speed / chord_px)        chords within chord_px of the curve on the screen
//!   n >= lines that it may cross / 32         threads of equal work in pass `cross`
//!   n  = 0                                    no scan line where the curve is: nobody sees it
//! ```

use super::{Scene, strips_of};
use crate::abi::Frame;

const LINES_PER_SEGMENT: u32 = 32;
const MAX_SEGMENTS: f32 = 65536.0;

/// Segments of each curve item; `line_starts` holds the rows before each strip, and the total.
pub fn segments(frame: &Frame, scene: &Scene<'_>, face_speeds: &[[f32; 2]], line_starts: &[u32]) -> Vec<u32> {
    (0..frame.curve_count as usize)
        .map(|item| {
            let (placed, face, curve) = scene.curve(item);
            let (lo, hi) = strips_of(curve.range_v[0], curve.range_v[1], face.strip_count);
            let start = |strip: u32| line_starts[(placed.first_strip + strip) as usize];
            let lines = start(hi + 1) - start(lo);
            if lines == 0 {
                return 0;
            }
            let speed = face_speeds[scene.curve_items[item] as usize];
            let deviation = curve.bend[0] * speed[0] + curve.bend[1] * speed[1];
            let for_chords = (deviation / frame.chord_px).sqrt().ceil();
            let for_lines = lines.div_ceil(LINES_PER_SEGMENT) as f32;
            for_chords.max(for_lines).clamp(1.0, MAX_SEGMENTS) as u32
        })
        .collect()
}
