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

use super::border_cells::columns_between;
use super::curve::curve_point;
use super::sizes::MOST_SEGMENTS;
use super::{Scene, strips_of};
use crate::abi::{BORDER_BANDS, Frame};

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

/// Four words for each band of each strip: the columns of it that chords pass, or come nearer to than half a scan line.
pub fn border_cells(frame: &Frame, scene: &Scene<'_>, line_starts: &[u32], segment_starts: &[u32]) -> Vec<[u32; 4]> {
    let mut cells = vec![[0; 4]; (frame.strip_count * BORDER_BANDS) as usize];
    chords(frame, scene, line_starts, segment_starts, |chord| {
        let columns = columns_between(chord.low[0].min(chord.high[0]), chord.low[0].max(chord.high[0]));
        let around = 0.5 / chord.lines as f32 + BAND_ROUNDING;
        let band = |y: f32| (y * BORDER_BANDS as f32).floor().clamp(0.0, (BORDER_BANDS - 1) as f32) as u32;
        for k in band(chord.of_strip(chord.low) - around)..=band(chord.of_strip(chord.high) + around) {
            let words = &mut cells[(chord.strip * BORDER_BANDS + k) as usize];
            words.iter_mut().zip(columns).for_each(|(word, bits)| *word |= bits);
        }
    });
    cells
}

/// Of a strip: more than `v` times the number of strips is rounded, at most 2^-24 of 128.
const BAND_ROUNDING: f32 = 1e-4;

/// A segment where it passes a strip that has scan lines.
struct Chord {
    low: [f32; 2],
    high: [f32; 2],
    upwards: bool,
    /// Of all strips, and of the face's.
    strip: u32,
    of_face: f32,
    /// Of the face.
    strips: f32,
    first_row: u32,
    lines: u32,
}

impl Chord {
    /// Where `v` is in the strip, 0 to 1 within it.
    fn of_strip(&self, p: [f32; 2]) -> f32 {
        p[1] * self.strips - self.of_face
    }
}

/// Row and intercept of every crossing, segment by segment.
fn crossings(
    frame: &Frame,
    scene: &Scene<'_>,
    line_starts: &[u32],
    segment_starts: &[u32],
    mut visit: impl FnMut(usize, u32),
) {
    chords(frame, scene, line_starts, segment_starts, |chord| {
        let (a, b, mu) = (chord.low, chord.high, chord.lines as f32);
        // one line too many on each side: the comparison below decides
        let lowest = (chord.of_strip(a) * mu - 0.5).floor();
        let highest = (chord.of_strip(b) * mu - 0.5).ceil();
        if highest < 0.0 || lowest > mu - 1.0 {
            return;
        }
        for line in lowest.max(0.0) as u32..=highest.min(mu - 1.0) as u32 {
            let v = (chord.of_face + (line as f32 + 0.5) / mu) / chord.strips;
            let row = chord.first_row + line;
            if !(a[1] < v && v <= b[1]) || row >= frame.row_capacity {
                continue;
            }
            let u = a[0] + (v - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            let u = u.clamp(a[0].min(b[0]), a[0].max(b[0]));
            visit(row as usize, (ordered_bits(u) & !1) | u32::from(chord.upwards));
        }
    });
}

/// Every segment in every strip.
fn chords(
    frame: &Frame,
    scene: &Scene<'_>,
    line_starts: &[u32],
    segment_starts: &[u32],
    mut visit: impl FnMut(&Chord),
) {
    for item in 0..frame.curve_count as usize {
        let n = segment_starts[item + 1] - segment_starts[item];
        let (placed, face, curve) = scene.curve(item);
        // segments beyond what one dispatch can hold get no thread
        for i in 0..n.min(MOST_SEGMENTS.saturating_sub(segment_starts[item])) {
            let from = curve_point(&curve, scene.curve_points, i, n);
            let to = curve_point(&curve, scene.curve_points, i + 1, n);
            let upwards = from[1] < to[1];
            let (low, high) = if upwards { (from, to) } else { (to, from) };
            let (first, last) = strips_of(low[1], high[1], face.strip_count);
            for k in first..=last {
                let strip = placed.first_strip + k;
                let first_row = line_starts[strip as usize];
                let lines = line_starts[strip as usize + 1] - first_row;
                let (of_face, strips) = (k as f32, face.strip_count as f32);
                if lines > 0 {
                    visit(&Chord { low, high, upwards, strip, of_face, strips, first_row, lines });
                }
            }
        }
    }
}
