//! How many chords of lines there is room for, and how many pixels to look at.

use crate::abi::constants::edges::LINE_SOLID;
use crate::abi::{Chord, Counters, LineList};
use crate::frame::capacities::grown;
use crate::frame::common::line_items::item_bytes;
use crate::frame::counts::{Counts, SMALLER, TooMany};

/// Chords of `n` curved pieces over the root of the picture's diagonal in pixels and over n to the power of 3/4: pieces of
/// a part in full view have lengths like n to the power of -1/2, and a curve has chords like the root of its length.
/// framework_printable_case_full.stp has 6.25 at 820 x 756 and 6.2 at 1920 x 1080, the bearing of zoo_ball_bearing.step 5.1
/// and 4.8.
const CHORDS: f64 = 7.0;

/// Pixels that lines cover, those beside which a fold is looked for from an edge, and those around that see a face which may
/// fold, over the picture's diagonal in pixels: lines are long, not wide. Three parts in full view have the most, at 820 x
/// 756: framework_printable_case_full.stp 152, nist_pmi_2.stp 156, occt_linkrods.step 68.
const OF_DIAGONAL: [f64; 3] = [256.0, 192.0, 80.0];
/// In a small picture, as many pixels as one of those.
const PIXELS_OF_ONE: u64 = 3;
/// Bytes of an entry of these lists, and what it is.
const LISTS: [(&str, usize); 3] = [
    ("pixels of lines", item_bytes(false)),
    ("pixels beside smooth edges", item_bytes(true)),
    ("pixels around curved faces", item_bytes(true)),
];

/// Most chords in a storage buffer of so many bytes.
fn most(range: u32) -> u32 {
    (range / size_of::<Chord>() as u32).min(LINE_SOLID)
}

/// Room for what only the GPU can count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Capacities {
    pub chords: u32,
    /// Pixels that lines cover.
    pub points: u32,
    /// Pixels beside which folds are looked for from edges.
    pub seeds: u32,
    /// The same from pixels around.
    pub starts: u32,
}

/// Most entries of a list in a storage buffer of so many bytes.
fn most_of(list: usize, range: u32) -> u32 {
    range.saturating_sub(size_of::<LineList>() as u32) / LISTS[list].1 as u32
}

impl Capacities {
    /// A chord for each piece.
    pub(crate) fn first(counts: Counts) -> Self {
        Self { chords: counts.piece_instances.min(LINE_SOLID), points: 0, seeds: 0, starts: 0 }
    }

    /// At least what most scenes in full view need in a picture of this size, as far as a storage buffer of `range` bytes
    /// holds them.
    pub(crate) fn for_picture(self, counts: Counts, size: (u32, u32), range: u32) -> Self {
        let diagonal = f64::from(size.0).hypot(size.1.into());
        let root = f64::from(counts.curved_piece_instances).sqrt();
        let of_curved = CHORDS * root * root.sqrt() * diagonal.sqrt();
        let some = counts.piece_instances.saturating_add(of_curved as u32);
        let pixels = u64::from(size.0) * u64::from(size.1);
        let of_lists = |list: usize, had: u32| {
            let some = ((OF_DIAGONAL[list] * diagonal) as u64).min(pixels / PIXELS_OF_ONE);
            had.max(if counts.lines { some as u32 } else { 0 }).min(most_of(list, range))
        };
        Self {
            chords: self.chords.max(some).min(most(range)),
            points: of_lists(0, self.points),
            seeds: of_lists(1, self.seeds),
            starts: of_lists(2, self.starts),
        }
    }

    /// What the frame that reported `c` would have needed.
    pub(crate) fn grown(self, c: &Counters, range: u32) -> Result<Self, TooMany> {
        let (wanted, help) = (("chords of edges", c.edge_chords), "draw lines along fewer edges");
        let over = TooMany::of_numbers(wanted.0, wanted.1, LINE_SOLID, help)
            .or_else(|| TooMany::of_bytes(wanted, size_of::<Chord>(), range, help));
        over.map_or(Ok(()), Err)?;
        let of_lists = |list: usize, had: u32, wanted: u32| {
            let (what, bytes) = LISTS[list];
            TooMany::of_bytes((what, wanted), bytes, range, SMALLER).map_or(Ok(()), Err)?;
            Ok(grown(had, wanted, most_of(list, range)))
        };
        Ok(Self {
            chords: grown(self.chords, c.edge_chords, most(range)),
            points: of_lists(0, self.points, c.line_points)?,
            seeds: of_lists(1, self.seeds, c.line_seeds)?,
            starts: of_lists(2, self.starts, c.fold_starts)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::abi::constants::scene::FAILED_LINES;

    /// The storage buffer that every device binds.
    const RANGE: u32 = 1 << 27;

    fn lists(c: Capacities) -> [u32; 3] {
        [c.points, c.seeds, c.starts]
    }

    /// Scenes without lines have no lists.
    #[test]
    fn lists_have_room_by_the_picture() {
        let of = |lines, size, range| {
            let counts = Counts { lines, ..Default::default() };
            lists(Capacities::first(counts).for_picture(counts, size, range))
        };
        assert_eq!(of(true, (3000, 4000), RANGE), [1_280_000, 960_000, 400_000]);
        assert_eq!(of(true, (30, 40), RANGE), [400; 3]);
        assert_eq!(of(false, (3000, 4000), RANGE), [0; 3]);
        // eight bytes an entry, and 36 a fold
        let most = [RANGE / 8 - 4, (RANGE - 32) / 44, (RANGE - 32) / 44];
        assert_eq!(of(true, (1 << 16, 1 << 16), RANGE), most);
        assert_eq!(of(true, (640, 480), 16), [0; 3]);
    }

    #[test]
    fn lists_grow_to_what_was_wanted_and_a_quarter() {
        let had = Capacities { chords: 1, points: 1000, seeds: 1000, starts: 1000 };
        let c = |line_points, line_seeds, fold_starts| Counters {
            line_points,
            line_seeds,
            fold_starts,
            failed: FAILED_LINES,
            ..Default::default()
        };
        assert_eq!(had.grown(&c(900, 2000, 4000), RANGE).map(lists).ok(), Some([1000, 2500, 5000]));
        let over = had.grown(&c(0, RANGE / 40, 0), RANGE).unwrap_err();
        assert_eq!((over.what, over.most), ("pixels beside smooth edges", RANGE / 44));
    }
}
