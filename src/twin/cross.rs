//! Twin of the pass `cross`: intersects every linear segment with every scan line that it crosses.
//!
//! ```text
//!   v ▲   ─────────── scan line        bottom-open, top-closed: v_a < v <= v_b, so a line through a
//!     │      b ●                       shared vertex counts one crossing, and a touch 0 or 2
//!     │   ────╱──────
//!     │   a ●                          v of line j of strip k:  (k + (j + 1/2) / mu_k) / strips
//! ```
//!
//! A scan line has a row in each visible bin (`u_bins.rs`).
//!
//! ```text
//!   error of u on another GPU:   point + min(|Δu|, |Δu / Δv| (line + 2 point)) + 2 d |Δu|
//!     d      error of a quotient: 2.5 units in the last place, 2.5 * 2^-23
//!     point  error of a chord's end: 0 if the curve has one chord; else 2 d along a straight line, (3 degree + 2) d
//!     line   error of a scan line's v: two quotients of numbers up to 1, 2.5 d
//! ```
//!
//! The arithmetic is `precise`: nothing is contracted, and only quotients differ. An inner point of a curve depends on
//! the quotients of its parameter, of its binomials and of its weight. The curve's speed and the spread of its control
//! points are taken as one and a half domains. `u` is clamped to the chord, so its error is at most the chord's width.
//! If a scan line is nearer to a chord's end than `line + point`, it may cross the next chord instead, and `u` has no
//! bound.
//!
//! An intercept is `u` as order-preserving bits, its lowest bit the direction: 1 upwards. The order of a row's
//! intercepts is left to the GPU; tests compare rows as sets.

use super::border_cells::columns_between;
use super::curve::curve_point;
use super::dispatch_arguments::MOST_SEGMENTS;
use super::sort::from_ordered;
use super::u_bins::{bin_of, within_bin};
use super::{Scene, strips_of};
use crate::abi::constants::border_cells::BAND_ROUNDING;
use crate::abi::{BORDER_BANDS, Frame, StripRows};

/// The number of intercepts of each of `row_capacity` rows, and, for strips with several bins, their sum of windings.
pub fn count(frame: &Frame, scene: &Scene<'_>, strips: &[StripRows], segment_starts: &[u32]) -> (Vec<u32>, Vec<i32>) {
    let mut counts = vec![0; frame.row_capacity as usize];
    let mut windings = vec![0; frame.row_capacity as usize];
    crossings(frame, scene, strips, segment_starts, |chord, (row, _), _| {
        counts[row] += 1;
        if chord.rows.bins > 1 {
            windings[row] += if chord.upwards { 1 } else { -1 };
        }
    });
    (counts, windings)
}

/// Writes the intercepts of each row from `row_starts` on, up to the capacity, and counts `row_counts` down to zero.
pub fn insert(
    frame: &Frame,
    scene: &Scene<'_>,
    (strips, segment_starts): (&[StripRows], &[u32]),
    row_starts: &[u32],
    row_counts: &mut [u32],
    intercepts: &mut [u32],
) {
    crossings(frame, scene, strips, segment_starts, |_, (row, _), intercept| {
        row_counts[row] -= 1;
        let at = (row_starts[row] + row_counts[row]) as usize;
        if at < frame.intercept_capacity as usize {
            intercepts[at] = intercept;
        }
    });
}

/// Row, intercept, and the error bound of the intercept on another GPU; infinite if another chord may have it.
#[cfg(test)]
pub fn bounded(
    frame: &Frame,
    scene: &Scene<'_>,
    strips: &[StripRows],
    segment_starts: &[u32],
) -> Vec<(usize, u32, f32)> {
    let mut all = Vec::new();
    crossings(frame, scene, strips, segment_starts, |chord, (row, v), intercept| {
        let [across, up] = [0, 1].map(|axis| (chord.high[axis] - chord.low[axis]).abs());
        let (point, line) = (chord.point_error, 2.5 * QUOTIENT_ERROR);
        let slid = (across / up * (line + 2.0 * point)).min(across);
        let is_at_end = [chord.low, chord.high].iter().any(|end| (end[1] - v).abs() <= line + point);
        let bound = if is_at_end { f32::INFINITY } else { point + slid + 2.0 * QUOTIENT_ERROR * across };
        all.push((row, intercept, bound));
    });
    all
}

/// Relative error of a quotient: 2.5 units in the last place (Vulkan 1.3, appendix A, "Precision and Operation of
/// SPIR-V Instructions").
#[cfg(test)]
const QUOTIENT_ERROR: f32 = 2.5 * f32::EPSILON;

/// Error of an inner point of a curve, in its domain.
#[cfg(test)]
fn point_error(degree: u32) -> f32 {
    if degree == 1 { 2.0 * QUOTIENT_ERROR } else { (3 * degree + 2) as f32 * QUOTIENT_ERROR }
}

/// Order-preserving bits of a number.
pub fn ordered_bits(u: f32) -> u32 {
    let bits = u.to_bits();
    if bits & 0x8000_0000 != 0 { !bits } else { bits | 0x8000_0000 }
}

/// Four words for each band of each bin: the columns that chords cross, or come nearer to than half a scan line.
pub fn border_cells(frame: &Frame, scene: &Scene<'_>, strips: &[StripRows], segment_starts: &[u32]) -> Vec<[u32; 4]> {
    let mut cells = vec![[0; 4]; (frame.bin_count * BORDER_BANDS) as usize];
    chords(frame, scene, strips, segment_starts, |chord| {
        let around = 0.5 / chord.rows.lines as f32 + BAND_ROUNDING;
        let band = |y: f32| (y * BORDER_BANDS as f32).floor().clamp(0.0, (BORDER_BANDS - 1) as f32) as u32;
        let (left, right) = chord.reach();
        let first = bin_of(left, chord.bins).max(chord.rows.first_bin);
        for bin in first..=bin_of(right, chord.bins).min(chord.rows.last_bin()) {
            let columns = columns_between(within_bin(left, bin, chord.bins), within_bin(right, bin, chord.bins));
            for k in band(chord.of_strip(chord.low) - around)..=band(chord.of_strip(chord.high) + around) {
                let words = &mut cells[((chord.bin_instance + bin) * BORDER_BANDS + k) as usize];
                words.iter_mut().zip(columns).for_each(|(word, bits)| *word |= bits);
            }
        }
    });
    cells
}

/// The part of a segment in a strip that has scan lines.
struct Chord {
    low: [f32; 2],
    high: [f32; 2],
    upwards: bool,
    /// The strip's first bin instance; the strip's number in its face.
    bin_instance: u32,
    of_face: f32,
    /// Strips of the face, and bins of each.
    strips: f32,
    bins: u32,
    rows: StripRows,
    /// Error of its ends on another GPU.
    #[cfg(test)]
    point_error: f32,
}

impl Chord {
    /// `v` relative to the strip, 0 to 1 within it.
    fn of_strip(&self, p: [f32; 2]) -> f32 {
        p[1] * self.strips - self.of_face
    }

    /// Its lowest and highest `u`.
    fn reach(&self) -> (f32, f32) {
        (self.low[0].min(self.high[0]), self.low[0].max(self.high[0]))
    }
}

/// Row, `v` of its scan line, and intercept of every crossing, segment by segment.
fn crossings(
    frame: &Frame,
    scene: &Scene<'_>,
    strips: &[StripRows],
    segment_starts: &[u32],
    mut visit: impl FnMut(&Chord, (usize, f32), u32),
) {
    chords(frame, scene, strips, segment_starts, |chord| {
        let (a, b, mu) = (chord.low, chord.high, chord.rows.lines as f32);
        let (left, right) = chord.reach();
        // one line too many on each side: the comparison below decides
        let lowest = (chord.of_strip(a) * mu - 0.5).floor();
        let highest = (chord.of_strip(b) * mu - 0.5).ceil();
        if highest < 0.0 || lowest > mu - 1.0 {
            return;
        }
        for line in lowest.max(0.0) as u32..=highest.min(mu - 1.0) as u32 {
            let v = (chord.of_face + (line as f32 + 0.5) / mu) / chord.strips;
            if !(a[1] < v && v <= b[1]) {
                continue;
            }
            let u = a[0] + (v - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            let intercept = ordered_bits(u.clamp(left, right)) & !1;
            let bin = bin_of(from_ordered(intercept), chord.bins);
            let row = chord.rows.row_of(line, bin);
            if bin > chord.rows.last_bin() || row >= frame.row_capacity {
                continue;
            }
            visit(chord, (row as usize, v), intercept | u32::from(chord.upwards));
        }
    });
}

/// Every segment in every strip, except for those right of all visible bins, and those of loops left of all visible
/// bins.
fn chords(
    frame: &Frame,
    scene: &Scene<'_>,
    strips: &[StripRows],
    segment_starts: &[u32],
    mut visit: impl FnMut(&Chord),
) {
    for curve_instance in 0..frame.curve_count as usize {
        let n = segment_starts[curve_instance + 1] - segment_starts[curve_instance];
        let (placed, face, curve) = scene.curve(curve_instance);
        // segments beyond the limit of one dispatch have no thread
        for i in 0..n.min(MOST_SEGMENTS.saturating_sub(segment_starts[curve_instance])) {
            let from = curve_point(&curve, scene.curve_points, i, n);
            let to = curve_point(&curve, scene.curve_points, i + 1, n);
            let upwards = from[1] < to[1];
            let (low, high) = if upwards { (from, to) } else { (to, from) };
            #[cfg(test)]
            let point_error = if n > 1 { point_error(curve.degree) } else { 0.0 };
            let (first, last) = strips_of(low[1], high[1], face.strip_count());
            let bins = face.bin_count();
            for k in first..=last {
                let bin_instance = placed.first_bin + k * bins;
                let rows = strips[bin_instance as usize];
                let (of_face, strip_count) = (k as f32, face.strip_count() as f32);
                let chord = Chord {
                    low,
                    high,
                    upwards,
                    bin_instance,
                    of_face,
                    strips: strip_count,
                    bins,
                    rows,
                    #[cfg(test)]
                    point_error,
                };
                let is_right = bin_of(chord.reach().0, bins) > rows.last_bin();
                let is_left = bin_of(curve.range_u[1], bins) < rows.first_bin;
                if rows.lines > 0 && !is_right && !is_left {
                    visit(&chord);
                }
            }
        }
    }
}
