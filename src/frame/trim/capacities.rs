//! How many scan lines, and crossings of them, the trim table has room for.

use crate::abi::Counters;
use crate::frame::capacities::grown;
use crate::frame::counts::{Counts, EXACT, MOST_GROUPS, TooMany};
use crate::picture::TakenWay;

/// Rows that pass `sort` takes, 128 to a workgroup.
pub(crate) const MOST_ROWS: u32 = MOST_GROUPS * 128;

/// Room for what only the GPU can count.
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
            rows: table * (1 << 16).max(2 * counts.bins).min(MOST_ROWS),
            intercepts: counted * (1 << 18).max(4 * counts.bins),
        }
    }

    /// What the frame that reported `c` would have needed.
    pub(crate) fn grown(self, c: &Counters, counts: Counts, range: u32) -> Result<Self, TooMany> {
        if c.wanted_rows > MOST_ROWS {
            return Err(TooMany { what: "scan lines", count: c.wanted_rows, most: MOST_ROWS, help: EXACT });
        }
        let most_intercepts = range / size_of::<u32>() as u32;
        if counts.trim == Some(TakenWay::Table) && c.intercepts > most_intercepts {
            let what = "crossings of scan lines";
            return Err(TooMany { what, count: c.intercepts, most: most_intercepts, help: EXACT });
        }
        Ok(Self {
            rows: grown(self.rows, c.wanted_rows, MOST_ROWS),
            intercepts: grown(self.intercepts, c.intercepts, most_intercepts),
        })
    }
}
