//! How many gap candidates there is room for.

use super::gap_fill::PART;
use crate::abi::{Counters, GapCandidate};
use crate::frame::capacities::grown;
use crate::frame::counts::{Counts, SMALLER, TooMany};

/// In a scene with many narrow faces, one pixel of this many is a candidate.
const PIXELS_OF_A_CANDIDATE: u32 = 8;

/// Bytes of a candidate.
const BYTES: usize = size_of::<GapCandidate>();

/// Room for what only the GPU can count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Capacities {
    /// In the list of each band.
    pub candidates: u32,
}

impl Capacities {
    /// A first guess that fits most scenes in full view.
    pub(crate) fn first(counts: Counts) -> Self {
        Self { candidates: u32::from(counts.trim.is_some()) * (1 << 14) }
    }

    /// At least one candidate for every [`PIXELS_OF_A_CANDIDATE`] pixels of a band, as far as a storage buffer of
    /// `range` bytes holds them. That is most often enough.
    pub(crate) fn for_picture(self, counts: Counts, size: (u32, u32), range: u32) -> Self {
        let some = if counts.trim.is_some() { band_pixels(size, range) / PIXELS_OF_A_CANDIDATE } else { 0 };
        Self { candidates: self.candidates.max(some).min(range / BYTES as u32) }
    }

    /// What the frame that reported `c` would have needed. `size` is that of its picture.
    pub(crate) fn grown(self, c: &Counters, size: (u32, u32), range: u32) -> Result<Self, TooMany> {
        let wanted = ("pixels at gaps", c.band_gap_candidates);
        TooMany::of_bytes(wanted, BYTES, range, SMALLER).map_or(Ok(()), Err)?;
        let most = band_pixels(size, range).min(range / BYTES as u32);
        Ok(Self { candidates: grown(self.candidates, c.band_gap_candidates, most) })
    }
}

/// Rows of a band: the whole picture, or as many as a storage buffer of `range` bytes holds if every pixel is a
/// candidate. At least those of one workgroup of `gap_find`.
pub(super) fn band_rows((width, height): (u32, u32), range: u32) -> u32 {
    let rows = range / BYTES as u32 / width.max(1);
    if rows >= height { height.max(1) } else { (rows / PART[1] * PART[1]).max(PART[1]) }
}

/// Pixels of a band.
fn band_pixels(size: (u32, u32), range: u32) -> u32 {
    size.0.saturating_mul(band_rows(size, range).min(size.1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::abi::constants::scene::FAILED_GAP_CANDIDATES;

    /// The storage buffer that every device binds: it holds the candidates of 682 rows of 16384 pixels.
    const RANGE: u32 = 1 << 27;

    #[test]
    fn a_band_has_room_for_every_pixel() {
        let rows = |size| band_rows(size, RANGE);
        assert_eq!([rows((1920, 1080)), rows((3840, 2160)), rows((1, 1))], [1080, 2160, 1]);
        assert_eq!([rows((7680, 4320)), rows((16384, 16384))], [1440, 660]);
        // no fewer than a workgroup looks at
        assert_eq!(band_rows((500, 200), 12 * 500), 30);
    }

    /// Every pixel of one band is a candidate: its list holds them, and no more.
    #[test]
    fn the_fullest_band_says_how_long_lists_are() {
        let had = Capacities { candidates: 1 << 14 };
        let full = 660 * 16384;
        let c = |band_gap_candidates| Counters {
            gap_candidates: 1 << 28,
            band_gap_candidates,
            failed: FAILED_GAP_CANDIDATES,
            ..Default::default()
        };
        let grown = |wanted| had.grown(&c(wanted), (16384, 16384), RANGE).map(|grown| grown.candidates);
        assert_eq!([grown(16_000), grown(100_000), grown(full)], [Ok(1 << 14), Ok(125_000), Ok(full)]);
        let over = grown(RANGE / 12 + 1).unwrap_err();
        assert_eq!((over.what, over.most), ("pixels at gaps", RANGE / 12));
    }
}
