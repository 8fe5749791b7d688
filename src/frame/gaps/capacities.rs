//! How many gap candidates there is room for.

use crate::abi::{Counters, GapCandidate};
use crate::frame::capacities::grown;
use crate::frame::counts::{Counts, SMALLER, TooMany};

/// In a scene with many narrow faces, one pixel of this many is a candidate.
const PIXELS_OF_A_CANDIDATE: u64 = 8;

/// Room for what only the GPU can count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Capacities {
    pub candidates: u32,
}

impl Capacities {
    /// A first guess that fits most scenes in full view.
    pub(crate) fn first(counts: Counts) -> Self {
        Self { candidates: u32::from(counts.trim.is_some()) * (1 << 14) }
    }

    /// At least one candidate for every [`PIXELS_OF_A_CANDIDATE`] pixels of a picture, as far as a storage buffer of
    /// `range` bytes holds them. That is most often enough.
    pub(crate) fn for_picture(self, counts: Counts, size: (u32, u32), range: u32) -> Self {
        let some = u64::from(size.0) * u64::from(size.1) / PIXELS_OF_A_CANDIDATE;
        let most = range / size_of::<GapCandidate>() as u32;
        let some = if counts.trim.is_some() { some.min(most.into()) as u32 } else { 0 };
        Self { candidates: self.candidates.max(some) }
    }

    /// What the frame that reported `c` would have needed.
    pub(crate) fn grown(self, c: &Counters, range: u32) -> Result<Self, TooMany> {
        let (wanted, bytes) = (("pixels at gaps", c.gap_candidates), size_of::<GapCandidate>());
        TooMany::of_bytes(wanted, bytes, range, SMALLER).map_or(Ok(()), Err)?;
        Ok(Self { candidates: grown(self.candidates, c.gap_candidates, range / bytes as u32) })
    }
}
