//! The error budget: divides the tolerance, half a pixel, among the steps that cause errors.
//!
//! ```text
//!   true border of a face                          border as one face is drawn
//!        │◀─ deviation ─▶│◀─ row / 2 ─▶│◀─ chord ─▶│        error <= e, either side
//!        │
//!        ├──────── gap radius g ────────▶                 where gaps are looked for
//!
//!   e = deviation + row / 2 + chord                every gap is found:            g >= e
//!                                                  nothing is off by more than:   e + g <= tolerance
//!   if one of two faces that meet sticks out by e, and the other falls short by row / 2 + chord,
//!   the eight points of the circle must reach it:  g cos(pi / 8) >= e + row / 2 + chord
//!   three scan lines that reach as far end at most g cos(pi / 8) / cos(pi / 6) away (glsl/include/border_lines.glsl)
//!   exact trims have no error of row and chord: a square of 0.8 g suffices (glsl/include/border_arcs.glsl)
//! ```
//!
//! * *deviation*: on the screen, the tessellation's point at (u, v) is this close to the exact surface at (u, v)
//!   ([`twin::factor`](crate::twin::factor)), so a trim decided at that (u, v) is off by no more.
//! * *row*: the trim test takes the nearest scan line.
//! * *chord*: trim curves are crossed as chords.
//! * *gap radius*: a face that is turned away, or one of an open shell, is drawn this far beyond its border; pass
//!   `gap_fill` decides which face is visible there.

/// The shares, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Budget {
    pub deviation: f64,
    pub row: f64,
    pub chord: f64,
    pub gap_radius: f64,
}

impl Budget {
    /// Shares of a tolerance: a quarter to the rows' spacing, a sixteenth to the chords (halving them costs only
    /// segments), one half to the gap radius.
    ///
    /// The surface gets a twelfth although the sums would allow a quarter: a deviation in depth hides or shows a
    /// grazing surface behind a low bulge, and moves that border by more than itself. Polynomial patches that bend
    /// towards the eye may deviate in space by an eighth.
    ///
    /// The first two sums would allow rows twice as far apart. The third does not: borders of open shells would then be
    /// off by more than the tolerance, even with a wider gap radius.
    pub(crate) fn of(tolerance_px: f64) -> Self {
        Self {
            deviation: tolerance_px / 12.0,
            row: tolerance_px / 4.0,
            chord: tolerance_px / 16.0,
            gap_radius: tolerance_px / 2.0,
        }
    }

    /// Distance beside the picture that pass `density` covers: skirts reach that far, and samples by half a pixel.
    pub(crate) fn beside(&self) -> f64 {
        self.gap_radius + 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shares_close_gaps_and_keep_the_promise() {
        for tolerance in [0.1, 0.5, 2.0] {
            let b = Budget::of(tolerance);
            let error = b.deviation + b.row / 2.0 + b.chord;
            assert!(b.gap_radius >= error, "two neighbours may leave a gap");
            let apart = error + b.row / 2.0 + b.chord;
            assert!(
                b.gap_radius * (std::f64::consts::PI / 8.0).cos() >= apart,
                "who sticks out may not find its neighbour"
            );
            let corner = b.gap_radius * (std::f64::consts::PI / 8.0).cos() / (std::f64::consts::PI / 6.0).cos();
            assert!(error + corner <= tolerance, "a border may be off by more than the tolerance");
            let square = 0.8 * b.gap_radius; // SQUARE, glsl/include/gap_radius.glsl
            assert!(square >= 2.0 * b.deviation, "exact: who sticks out may not find its neighbour");
            assert!(b.deviation + square * std::f64::consts::SQRT_2 <= tolerance, "exact: a border may be off by more");
        }
    }
}
