//! How many chords of lines there is room for.

use crate::abi::constants::edges::LINE_CHORD;
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
        let some = counts.edge_items.saturating_mul(6).saturating_add(1 << 10).min(LINE_CHORD);
        Self { chords: if counts.edge_items > 0 { some } else { 0 } }
    }

    /// What the frame that reported `c` would have needed.
    pub(crate) fn grown(self, c: &Counters, range: u32) -> Result<Self, TooMany> {
        let most = (range / size_of::<Chord>() as u32).min(LINE_CHORD);
        if c.edge_chords > most {
            let help = "draw lines along fewer edges";
            return Err(TooMany { what: "chords of edges", count: c.edge_chords, most, help });
        }
        Ok(Self { chords: grown(self.chords, c.edge_chords, most) })
    }
}
