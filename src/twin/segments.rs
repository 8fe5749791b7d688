//! Twin of the pass `segments`: linear segments of each trim curve.
//!
//! ```text
//!   n >= sqrt(bend . speed / chord_px)        chords within chord_px of the curve on the screen
//!   n >= scan lines that it may cross / 32    threads of equal work in pass `cross`
//!   n  = 0                                    no scan line has a row there: not visible, or right of all visible bins
//! ```

use super::density::Density;
use super::u_bins::{bin_of, seen_range};
use super::{Scene, strips_of};
use crate::abi::Frame;
use crate::abi::constants::segments::{LINES_PER_SEGMENT, MAX_SEGMENTS};

/// Segments of each curve instance; `strip_starts` holds the rows before each strip, and the total.
pub fn segments(frame: &Frame, scene: &Scene<'_>, density: &Density, strip_starts: &[u32]) -> Vec<u32> {
    (0..frame.curve_count as usize)
        .map(|curve_instance| {
            let (placed, face, curve) = scene.curve(curve_instance);
            let (lo, hi) = strips_of(curve.range_v[0], curve.range_v[1], face.strip_count());
            // in bins between the curve's lowest u and its loop's highest
            let [from, to] = curve.range_u.map(|u| bin_of(u, face.bin_count()));
            let of_strip = |strip: u32| {
                let bin_instance = (placed.first_bin + strip * face.bin_count()) as usize;
                let (first, bins) = seen_range(density.seen_bins[bin_instance]);
                let is_met = from < first + bins && to >= first;
                if is_met { (strip_starts[bin_instance + 1] - strip_starts[bin_instance]) / bins } else { 0 }
            };
            let lines: u32 = (lo..=hi).map(of_strip).sum();
            if lines == 0 {
                return 0;
            }
            let speed = density.face_speeds[scene.curve_instances[curve_instance] as usize];
            let deviation = curve.bend[0] * speed[0] + curve.bend[1] * speed[1];
            let for_chords = (deviation / frame.chord_px).sqrt().ceil();
            let for_lines = lines.div_ceil(LINES_PER_SEGMENT) as f32;
            for_chords.max(for_lines).clamp(1.0, MAX_SEGMENTS) as u32
        })
        .collect()
}
