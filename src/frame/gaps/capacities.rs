//! How many gap candidates there is room for.

use crate::abi::{Counters, GapCandidate};
use crate::frame::capacities::grown;
use crate::frame::counts::{Counts, SMALLER, TooMany};

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

    /// What the frame that reported `c` would have needed.
    pub(crate) fn grown(self, c: &Counters, range: u32) -> Result<Self, TooMany> {
        let (wanted, bytes) = (("pixels at gaps", c.gap_candidates), size_of::<GapCandidate>());
        TooMany::of_bytes(wanted, bytes, range, SMALLER).map_or(Ok(()), Err)?;
        Ok(Self { candidates: grown(self.candidates, c.gap_candidates, range / bytes as u32) })
    }
}
