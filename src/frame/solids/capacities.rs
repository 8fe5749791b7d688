//! Sizes of the lists of Boolean solids and of their counters.

use super::lists::{Entries, Lists, WHOLE};
use crate::abi::constants::scene::{FAILED_FRAGMENTS, FAILED_LAYERS, FAILED_RAY_SEGMENTS, FAILED_TILE_LEAVES};
use crate::abi::{BLOCK, Counters, TILE, TileLeaf};
use crate::frame::capacities::grown;
use crate::frame::counts::{Counts, SMALLER, TooMany};

/// First guess of the leaves in a tile.
const LEAVES_IN_A_TILE: u32 = 16;
/// Fewest crossings of operands for which there is room.
const FEWEST_FRAGMENTS: u32 = 1 << 14;
/// Fewest layers of faces that are recorded.
const FEWEST_LAYERS: u32 = 4;
/// Most layers of faces; each layer tests every primitive.
const MOST_LAYERS: u32 = 1 << 10;
/// Most segments of a ray, each as long as the driver's limit on loops. Rays not finished by then are counted as
/// clamps.
pub(crate) const MOST_RAY_SEGMENTS: u32 = 64;

/// The sizes of lists whose length only the GPU computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Capacities {
    pub block_leaves: u32,
    pub tile_leaves: u32,
    pub fragments: u32,
    /// Rows of tiles in a band, for which the two lists have room; [`WHOLE`]: one band.
    pub band_rows: u32,
    /// Layers that way `blister` peels.
    pub layers: u32,
    /// Segments of each ray of way `events`, one after the other.
    pub ray_segments: u32,
}

impl Capacities {
    /// A first guess that fits most scenes in full view.
    pub(crate) fn first(counts: Counts) -> Self {
        Self {
            block_leaves: counts.leaves.saturating_mul(4),
            tile_leaves: counts.leaves.saturating_mul(16),
            fragments: if counts.has_fragments() { FEWEST_FRAGMENTS } else { 0 },
            band_rows: WHOLE,
            layers: if counts.blister { FEWEST_LAYERS } else { 0 },
            ray_segments: 1,
        }
    }

    /// The same, with room for `crossings` crossings of operands and a quarter more.
    pub(crate) fn expecting(self, crossings: u64, counts: Counts) -> Self {
        let wanted = u32::try_from(crossings + crossings / 4).unwrap_or(u32::MAX);
        Self { fragments: if counts.has_fragments() { self.fragments.max(wanted) } else { 0 }, ..self }
    }

    /// The same, with room for a few leaves in every tile of the picture, if a storage buffer of `range` bytes and the
    /// budget allow it; mostly that suffices at once.
    pub(crate) fn for_picture(self, counts: Counts, size: (u32, u32), range: u32) -> Result<Self, TooMany> {
        let lists = counts.lists(size, range);
        let mut band_rows = self.band_rows;
        if counts.events && !lists.hold(band_rows.min(lists.rows()), Entries::NONE) {
            band_rows = lists.even(lists.most_rows(Entries::NONE));
            if band_rows == 0 {
                return Err(lists.no_room(Entries::NONE));
            }
        }
        let rows = band_rows.min(lists.rows());
        let few = counts.leaves.min(LEAVES_IN_A_TILE);
        let within = |side, down: u32| few.saturating_mul(size.0.div_ceil(side).saturating_mul(down));
        let few = within(TILE, rows);
        let block_leaves = self.block_leaves.max(within(TILE * BLOCK, size.1.div_ceil(TILE * BLOCK)));
        let room = |tile_leaves: u32| {
            Entries { tile_leaves: tile_leaves.into(), fragments: self.fragments.into() }.within(range)
        };
        let (wanted, had) = (room(self.tile_leaves.max(few)), room(self.tile_leaves));
        let room = if !counts.events || lists.hold(rows, wanted) {
            wanted
        } else if lists.hold(rows, had) {
            had
        } else {
            lists.shared(rows, wanted)
        };
        Ok(Self { block_leaves, band_rows, ..self }.with(room))
    }

    fn with(self, room: Entries) -> Self {
        // lengths of lists in one storage buffer are 32-bit numbers
        Self { tile_leaves: room.tile_leaves as u32, fragments: room.fragments as u32, ..self }
    }

    /// Rows of tiles in a band, and room for their lists, after a frame with counters `c`.
    fn banded(self, c: &Counters, lists: &Lists) -> Result<Self, TooMany> {
        let entries =
            |tile_leaves: u32, fragments: u32| Entries { tile_leaves: tile_leaves.into(), fragments: fragments.into() };
        let row = entries(c.row_tile_leaves, c.row_fragments);
        let (all, rows) = (entries(c.tile_leaves, c.fragments), lists.rows());
        let failed = c.failed & (FAILED_TILE_LEAVES | FAILED_FRAGMENTS) != 0;
        let counted = c.band_tile_leaves.max(c.band_fragments) < u32::MAX;
        let is_whole = self.band_rows >= rows;
        if !lists.hold(1, row) {
            return Err(lists.no_room(row));
        }
        if is_whole && !failed {
            return Ok(self);
        }
        let had = entries(self.tile_leaves, self.fragments);
        let grown = if is_whole { had.grown(all) } else { all.with_spare() };
        if counted && lists.hold(rows, grown) {
            return Ok(Self { band_rows: WHOLE, ..self }.with(grown));
        }
        if is_whole && counted && lists.hold(rows, all) {
            return Ok(self.with(lists.shared(rows, all.with_spare())));
        }
        let sure = lists.even(lists.most_rows(row));
        let band_rows = match (is_whole, failed) {
            (true, _) if counted => {
                let mean = |n: &u32| lists.hold(*n, all.times(*n, rows));
                lists.even((sure..rows).rev().find(mean).unwrap_or(sure))
            }
            (false, false) => self.band_rows.max(lists.even(lists.most_rows(row.with_spare()))),
            _ => sure,
        };
        if band_rows == self.band_rows && !failed {
            return Ok(self);
        }
        let wanted = row.times(band_rows, 1);
        let room = lists.shared(band_rows, wanted.with_spare());
        let room = if lists.hold(band_rows, wanted) && !room.hold(wanted) { wanted } else { room };
        Ok(Self { band_rows, ..self }.with(room))
    }

    /// Four times as many ray segments if they did not suffice. Otherwise the smallest of 1, 4, 16, … whose last
    /// segment was unused, at most [`MOST_RAY_SEGMENTS`]. Unchanged if lists overflowed, since rays were then
    /// incomplete.
    fn ray_segments(self, c: &Counters, size: (u32, u32), range: u32) -> Result<u32, TooMany> {
        let grown = match c.failed {
            0 => (0..)
                .map(|n| 4u32.pow(n))
                .find(|ray_segments| *ray_segments > c.ray_segments)
                .unwrap_or(MOST_RAY_SEGMENTS),
            FAILED_RAY_SEGMENTS => 4 * self.ray_segments,
            _ => self.ray_segments,
        };
        let rows = self.band_rows.saturating_mul(TILE).min(size.1);
        let pixels = size.0.saturating_mul(rows);
        if grown > 1 {
            let help = "draw a smaller picture, or by a smaller solid budget";
            let wanted = ("pixels whose rays go on in segments", pixels);
            TooMany::of_bytes(wanted, size_of::<u32>(), range, help).map_or(Ok(()), Err)?;
        }
        Ok(grown.min(MOST_RAY_SEGMENTS))
    }

    /// Whether buffers made for `self` have the same sizes as buffers made for `others`.
    pub(crate) fn takes_as_much(self, others: Self) -> bool {
        let ray_segments =
            if (self.ray_segments > 1) == (others.ray_segments > 1) { others.ray_segments } else { self.ray_segments };
        Self { layers: others.layers, ray_segments, ..self } == others
    }

    /// The sizes that the frame with counters `c` needed; see
    /// [`Capacities::grown`](crate::frame::capacities::Capacities::grown).
    pub(crate) fn grown(self, c: &Counters, counts: Counts, size: (u32, u32), range: u32) -> Result<Self, TooMany> {
        let most_leaves = range / size_of::<TileLeaf>() as u32;
        if !counts.events {
            let wanted = ("primitives in tiles", c.band_tile_leaves);
            TooMany::of_bytes(wanted, size_of::<TileLeaf>(), range, SMALLER).map_or(Ok(()), Err)?;
        }
        if c.failed & FAILED_LAYERS != 0 && self.layers >= MOST_LAYERS {
            let help = "draw the solids by the way `events`";
            return Err(TooMany { what: "layers of faces", count: c.layers, most: MOST_LAYERS, bytes: None, help });
        }
        let lists = match counts.events {
            true => self.banded(c, &counts.lists(size, range))?,
            false => Self { tile_leaves: grown(self.tile_leaves, c.tile_leaves, most_leaves), ..self },
        };
        Ok(Self {
            block_leaves: grown(self.block_leaves, c.block_leaves, range / size_of::<u32>() as u32),
            layers: match self.layers {
                0 => 0,
                had if c.failed & FAILED_LAYERS != 0 => 2 * had,
                _ => (c.layers + 1).max(FEWEST_LAYERS),
            },
            ray_segments: self.ray_segments(c, size, range)?,
            ..lists
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The storage buffer range that every Vulkan device supports.
    const RANGE: u32 = 1 << 27;

    fn first() -> Capacities {
        Capacities::first(Counts::default())
    }

    fn grown(had: Capacities, c: &Counters) -> Result<Capacities, TooMany> {
        had.grown(c, Counts::default(), (640, 480), RANGE)
    }

    /// One layer more than needed, which must be empty; twice as many if layers were missing.
    #[test]
    fn layers_follow_the_view() {
        let peels = Capacities::first(Counts { leaves: 3, blister: true, ..Default::default() });
        assert_eq!((first().layers, peels.layers), (0, FEWEST_LAYERS));
        let of = |had: Capacities, c| grown(had, &c).map(|c| c.layers);
        let more = Capacities { layers: 16, ..peels };
        assert_eq!(
            of(peels, Counters { layers: 5, failed: FAILED_LAYERS, ..Default::default() }),
            Ok(2 * FEWEST_LAYERS)
        );
        assert_eq!(of(more, Counters { layers: 9, ..Default::default() }), Ok(10));
        assert_eq!(of(more, Counters::default()), Ok(FEWEST_LAYERS));
        assert!(more.takes_as_much(peels) && !Capacities { block_leaves: 1, ..more }.takes_as_much(peels));
        let most = Capacities { layers: MOST_LAYERS, ..peels };
        let c = Counters { layers: MOST_LAYERS + 1, failed: FAILED_LAYERS, ..Default::default() };
        assert!(matches!(of(most, c), Err(TooMany { what: "layers of faces", .. })));
    }

    #[test]
    fn legs_follow_the_view() {
        let ended = Counters { failed: FAILED_RAY_SEGMENTS, ..Default::default() };
        let mut had = first();
        for ray_segments in [4, 16, 64, MOST_RAY_SEGMENTS] {
            had = grown(had, &ended).unwrap();
            assert_eq!(had.ray_segments, ray_segments);
        }
        // as many as the view needs
        let of = |c| grown(had, &c).unwrap().ray_segments;
        assert_eq!(of(Counters { ray_segments: 63, ..Default::default() }), MOST_RAY_SEGMENTS);
        assert_eq!(of(Counters { ray_segments: 64, ..Default::default() }), MOST_RAY_SEGMENTS);
        assert_eq!(of(Counters { ray_segments: 3, ..Default::default() }), 4);
        assert_eq!(of(Counters { ray_segments: 1, ..Default::default() }), 4);
        assert_eq!(of(Counters::default()), 1);
        // after an overflow, counts of ray segments are meaningless
        let both = Counters { failed: FAILED_RAY_SEGMENTS | FAILED_TILE_LEAVES, tile_leaves: 99, ..Default::default() };
        assert_eq!(grown(first(), &both).unwrap().ray_segments, 1);
        assert!(had.takes_as_much(Capacities { ray_segments: 4, ..had }) && !had.takes_as_much(first()));
        let large = first().grown(&ended, Counts::default(), (16_384, 16_384), RANGE);
        assert!(matches!(large, Err(TooMany { what: "pixels whose rays go on in segments", .. })));
    }
}
