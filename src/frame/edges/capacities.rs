//! How many chords of lines there is room for.

use crate::abi::constants::edges::LINE_SOLID;
use crate::abi::{Chord, Counters};
use crate::frame::capacities::grown;
use crate::frame::counts::{Counts, TooMany};

/// Chords of a curved piece over the root of the picture's diagonal in pixels. Those of a part in full view, nist_pmi_2.stp,
/// have 0.57 at 410 x 378 and 0.54 at 3840 x 2160.
const CHORDS: f64 = 5.0 / 8.0;

/// Most chords in a storage buffer of so many bytes.
fn most(range: u32) -> u32 {
    (range / size_of::<Chord>() as u32).min(LINE_SOLID)
}

/// Room for what only the GPU can count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Capacities {
    pub chords: u32,
}

impl Capacities {
    /// A chord for each piece.
    pub(crate) fn first(counts: Counts) -> Self {
        Self { chords: counts.piece_instances.min(LINE_SOLID) }
    }

    /// At least what most scenes in full view need in a picture of this size, as far as a storage buffer of `range` bytes
    /// holds them.
    pub(crate) fn for_picture(self, counts: Counts, size: (u32, u32), range: u32) -> Self {
        let diagonal = f64::from(size.0).hypot(size.1.into());
        let of_curved = f64::from(counts.curved_piece_instances) * CHORDS * diagonal.sqrt();
        let some = counts.piece_instances.saturating_add(of_curved as u32);
        Self { chords: self.chords.max(some).min(most(range)) }
    }

    /// What the frame that reported `c` would have needed.
    pub(crate) fn grown(self, c: &Counters, range: u32) -> Result<Self, TooMany> {
        let (wanted, help) = (("chords of edges", c.edge_chords), "draw lines along fewer edges");
        let over = TooMany::of_numbers(wanted.0, wanted.1, LINE_SOLID, help)
            .or_else(|| TooMany::of_bytes(wanted, size_of::<Chord>(), range, help));
        over.map_or(Ok(()), Err)?;
        Ok(Self { chords: grown(self.chords, c.edge_chords, most(range)) })
    }
}
