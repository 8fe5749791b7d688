//! How many chords of lines there is room for.

use crate::abi::constants::edges::LINE_SOLID;
use crate::abi::{Chord, Counters};
use crate::frame::capacities::grown;
use crate::frame::counts::{Counts, TooMany};

/// Room for what only the GPU can count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Capacities {
    pub chords: u32,
}

impl Capacities {
    /// A first guess that fits most scenes in full view.
    pub(crate) fn first(counts: Counts) -> Self {
        let some = counts.piece_instances.saturating_mul(6).saturating_add(1 << 10).min(LINE_SOLID);
        Self { chords: if counts.piece_instances > 0 { some } else { 0 } }
    }

    /// What the frame that reported `c` would have needed.
    pub(crate) fn grown(self, c: &Counters, range: u32) -> Result<Self, TooMany> {
        let most = (range / size_of::<Chord>() as u32).min(LINE_SOLID);
        let (wanted, help) = (("chords of edges", c.edge_chords), "draw lines along fewer edges");
        let over = TooMany::of_numbers(wanted.0, wanted.1, LINE_SOLID, help)
            .or_else(|| TooMany::of_bytes(wanted, size_of::<Chord>(), range, help));
        over.map_or(Ok(()), Err)?;
        Ok(Self { chords: grown(self.chords, c.edge_chords, most) })
    }
}
