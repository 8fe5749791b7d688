//! Sizes of the trim table: scan lines, and their crossings.

use crate::abi::Counters;
use crate::frame::capacities::grown;
use crate::frame::common::kernel::MOST_THREADS;
use crate::frame::counts::{Counts, EXACT, TooMany};
use crate::picture::TakenWay;

/// The first flip and the number of flips.
type Row = [u32; 2];

/// The sizes of lists whose length only the GPU computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Capacities {
    pub rows: u32,
    pub intercepts: u32,
}

impl Capacities {
    /// A first guess that fits most scenes in full view.
    pub(crate) fn first(counts: Counts) -> Self {
        let table = u32::from(counts.trim == Some(TakenWay::Table));
        let counted = table.max(u32::from(counts.trim.is_some_and(TakenWay::is_texture)));
        Self {
            rows: table * (1 << 16).max(2 * counts.bins).min(MOST_THREADS),
            intercepts: counted * (1 << 18).max(4 * counts.bins),
        }
    }

    /// The sizes that the frame with counters `c` needed.
    pub(crate) fn grown(self, c: &Counters, counts: Counts, range: u32) -> Result<Self, TooMany> {
        let rows = ("scan lines", c.wanted_rows);
        let intercepts = ("crossings of scan lines", c.intercepts);
        let over = TooMany::of_numbers(rows.0, rows.1, MOST_THREADS, EXACT)
            .or_else(|| TooMany::of_bytes(rows, size_of::<Row>(), range, EXACT));
        let has_table = counts.trim == Some(TakenWay::Table);
        let over = over.or_else(|| TooMany::of_bytes(intercepts, size_of::<u32>(), range, EXACT).filter(|_| has_table));
        over.map_or(Ok(()), Err)?;
        let most = |bytes: usize| range / bytes as u32;
        // rows without room were not counted: assume that they have as many crossings as the other rows
        let share = u64::from(c.wanted_rows) * u64::from(c.intercepts) / u64::from(c.rows.max(1));
        let most_intercepts = most(size_of::<u32>());
        let intercepts = if c.wanted_rows > c.rows { share.min(most_intercepts.into()) as u32 } else { c.intercepts };
        Ok(Self {
            rows: grown(self.rows, c.wanted_rows, most(size_of::<Row>()).min(MOST_THREADS)),
            intercepts: grown(self.intercepts, intercepts, most_intercepts),
        })
    }
}
