//! Twin of the pass [`cross`](crate::passes): every linear segment meets every scan line that it
//! crosses.
//!
//! ```text
//!   v ▲   ─────────── scan line        bottom-open, top-closed: v_a < v <= v_b, so a line through a
//!     │      b ●                       shared vertex counts one crossing, and a touch 0 or 2
//!     │   ────╱──────
//!     │   a ●                          v of line j of strip k:  (k + (j + 1/2) / mu_k) / strips
//! ```
//!
//! An intercept is `u` as order-preserving bits, its lowest bit the direction: 1 upwards. In which
//! order a row receives its intercepts is left to the GPU; the rows compare as sets.

use super::curve::curve_point;
use super::sizes::MOST_SEGMENTS;
use super::{Scene, strips_of};
use crate::abi::Frame;

/// Intercepts of each of `row_capacity` rows.
pub fn count(frame: &Frame, scene: &Scene<'_>, line_starts: &[u32], segment_starts: &[u32]) -> Vec<u32> {
    let mut counts = vec![0; frame.row_capacity as usize];
    crossings(frame, scene, line_starts, segment_starts, |row, _| counts[row] += 1);
    counts
}

/// Writes the intercepts of each row from `row_starts` on, as far as there is room, and counts
/// `row_counts` down to zero.
pub fn insert(
    frame: &Frame,
    scene: &Scene<'_>,
    (line_starts, segment_starts): (&[u32], &[u32]),
    row_starts: &[u32],
    row_counts: &mut [u32],
    intercepts: &mut [u32],
) {
    crossings(frame, scene, line_starts, segment_starts, |row, intercept| {
        row_counts[row] -= 1;
        let at = (row_starts[row] + row_counts[row]) as usize;
        if at < frame.intercept_capacity as usize {
            intercepts[at] = intercept;
        }
    });
}

/// Order-preserving bits of a number.
pub fn ordered_bits(u: f32) -> u32 {
    let bits = u.to_bits();
    if bits & 0x8000_0000 != 0 { !bits } else { bits | 0x8000_0000 }
}

/// Row and intercept of every crossing, segment by segment.
fn crossings(
    frame: &Frame,
    scene: &Scene<'_>,
    line_starts: &[u32],
    segment_starts: &[u32],
    mut visit: impl FnMut(usize, u32),
) {
    for item in 0..frame.curve_count as usize {
        let n = segment_starts[item + 1] - segment_starts[item];
        let (placed, face, curve) = scene.curve(item);
        let strips = face.strip_count as f32;
        // segments beyond what one dispatch can hold get no thread
        for i in 0..n.min(MOST_SEGMENTS.saturating_sub(segment_starts[item])) {
            let from = curve_point(&curve, scene.curve_points, i, n);
            let to = curve_point(&curve, scene.curve_points, i + 1, n);
            let upwards = from[1] < to[1];
            let (a, b) = if upwards { (from, to) } else { (to, from) };
            let (first, last) = strips_of(a[1], b[1], face.strip_count);
            for k in first..=last {
                let base = line_starts[(placed.first_strip + k) as usize];
                let count = line_starts[(placed.first_strip + k + 1) as usize] - base;
                let mu = count as f32;
                // one line too many on each side: the comparison below decides
                let lowest = ((a[1] * strips - k as f32) * mu - 0.5).floor();
                let highest = ((b[1] * strips - k as f32) * mu - 0.5).ceil();
                if count == 0 || highest < 0.0 || lowest > mu - 1.0 {
                    continue;
                }
                for line in lowest.max(0.0) as u32..=highest.min(mu - 1.0) as u32 {
                    let v = (k as f32 + (line as f32 + 0.5) / mu) / strips;
                    let row = base + line;
                    if !(a[1] < v && v <= b[1]) || row >= frame.row_capacity {
                        continue;
                    }
                    let u = a[0] + (v - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
                    let u = u.clamp(a[0].min(b[0]), a[0].max(b[0]));
                    visit(row as usize, (ordered_bits(u) & !1) | u32::from(upwards));
                }
            }
        }
    }
}
