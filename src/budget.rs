//! How the promise of half a pixel is shared out among the steps that can spend it.
//!
//! ```text
//!   true border of a face                          border as one face is drawn
//!        │◀─ deviation ─▶│◀─ row / 2 ─▶│◀─ chord ─▶│        error <= e, either side
//!        │
//!        ├──────────── ring ────────────▶                 taken where nothing else is drawn
//!
//!   e = deviation + row / 2 + chord                two neighbours leave no gap:   ring >= e
//!                                                  nothing is off by more than:   e + ring <= tolerance
//! ```
//!
//! * *deviation*: the tessellation's point at (u, v) lies this close to the exact surface at (u, v)
//!   on the screen ([`twin::factor`](crate::twin::factor)), so a trim decided at that (u, v) is off by
//!   no more.
//! * *row*: the trim test takes the nearest scan line.
//! * *chord*: trim curves are crossed as chords.

/// The shares, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Budget {
    pub deviation: f64,
    pub row: f64,
    pub chord: f64,
    pub ring: f64,
}

impl Budget {
    /// Shares of a tolerance: a quarter each to the surface and to the rows' spacing, a sixteenth to
    /// the chords (halving them costs only segments), one half to the ring.
    pub(crate) fn of(tolerance_px: f64) -> Self {
        Self {
            deviation: tolerance_px / 4.0,
            row: tolerance_px / 4.0,
            chord: tolerance_px / 16.0,
            ring: tolerance_px / 2.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shares_close_gaps_and_keep_the_promise() {
        for tolerance in [0.125, 0.5, 2.0] {
            let b = Budget::of(tolerance);
            let error = b.deviation + b.row / 2.0 + b.chord;
            assert!(b.ring >= error, "two neighbours may leave a gap");
            assert!(error + b.ring <= tolerance, "a border may be off by more than the tolerance");
        }
    }
}
