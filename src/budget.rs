//! The error budget: the tolerance, half a pixel, is divided among the steps that cause errors.
//!
//! ```text
//!   true border of a face                          border as one face is drawn
//!        │◀─ deviation ─▶│◀─ row / 2 ─▶│◀─ chord ─▶│        error <= e, either side
//!        │
//!        ├──────── gap radius g ────────▶                 where gaps are looked for
//!
//!   e = deviation + row / 2 + chord                every gap is found:            g >= e
//!                                                  nothing is off by more than:   e + g <= tolerance
//!   where one of two faces that meet sticks out by e, and the other falls short by row / 2 + chord,
//!   the eight points of the circle must reach it:  g cos(pi / 8) >= e + row / 2 + chord
//!   three scan lines that reach as far end at most g cos(pi / 8) / cos(pi / 6) away (glsl/include/border_lines.glsl)
//!   trims that are exact spend no row and no chord: a square does, of 0.8 g (glsl/include/border_arcs.glsl)
//! ```
//!
//! * *deviation*: the tessellation's point at (u, v) lies this close to the exact surface at (u, v)
//!   on the screen ([`twin::factor`](crate::twin::factor)), so a trim decided at that (u, v) is off by
//!   no more.
//! * *row*: the trim test takes the nearest scan line.
//! * *chord*: trim curves are crossed as chords.
//! * *gap radius*: a face that looks away, or one of an open shell, is drawn this far beyond its border;
//!   pass `gap_fill` decides who is seen there.

/// The shares, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Budget {
    pub deviation: f64,
    pub row: f64,
    pub chord: f64,
    pub gap_radius: f64,
}

impl Budget {
    /// Shares of a tolerance: a quarter to the rows' spacing, a sixteenth to the chords (halving them
    /// costs only segments), one half to the gap radius.
    ///
    /// The surface gets a twelfth although a quarter would do for the sums: a deviation in depth hides
    /// or shows a grazing surface behind a low bulge, and moves that border by more than itself. On
    /// ten CAD files in three views, 8, 1 and 0 pixels of one file were off by more than the tolerance
    /// with a quarter, an eighth and a twelfth; a twelfth costs 1.7 times the triangles of an eighth. Polynomial patches
    /// that bend towards the eye may be off in space by an eighth: of impeller, tigl_d150_fuselage and gpucast_part_a, in
    /// three views of 1920 x 1080 each, 5 pixels are off then, and 6 were before.
    ///
    /// Rows farther apart would be cheaper, and the first two sums have room for twice as far. The third has not: of the
    /// open shells of impeller and gpucast_part_a, in three views of 1280 x 720 each, 0 and 3 pixels were off
    /// with a quarter, 10 and 5 with a half; with a wider gap radius, of 0.655 and rows of 0.39, 4 and 6.
    pub(crate) fn of(tolerance_px: f64) -> Self {
        Self {
            deviation: tolerance_px / 12.0,
            row: tolerance_px / 4.0,
            chord: tolerance_px / 16.0,
            gap_radius: tolerance_px / 2.0,
        }
    }

    /// How far beside the picture pass `density` looks: skirts reach there, and samples by half a pixel.
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
