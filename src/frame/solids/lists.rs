//! The number of rows of tiles whose lists way `events` makes at a time.
//!
//! ```text
//!   picture  ┌────────────┐
//!            │ row 0      │  lists made, rays followed     as many rows at a time as fit; if all rows fit,
//!            │ row 1      │                                one band: the whole picture
//!            ├────────────┤
//!            │ row 2      │  the same buffers again
//!            └────────────┘
//! ```
//!
//! A frame counts the entries of all rows, of the largest band and of the largest row. If one band does not suffice,
//! the next guess uses the mean of all rows, which the densest rows may exceed. The guess after that uses the largest
//! row and suffices.

use crate::abi::{Fragment, TILE, TileLeaf};
use crate::frame::common::scan;
use crate::frame::counts::{SMALLER, TooMany};
use crate::gpu::Buffer;

/// Rows of tiles of a single band.
pub(crate) const WHOLE: u32 = u32::MAX;

/// Limits of the lists' sizes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Limits {
    /// Most bytes of one storage buffer.
    pub range: u32,
    /// Most bytes of all lists of a band.
    pub budget: u64,
}

/// Numbers of entries of the lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Entries {
    pub tile_leaves: u64,
    pub fragments: u64,
}

impl Entries {
    pub const NONE: Self = Self { tile_leaves: 0, fragments: 0 };

    /// `by / of` times as many, rounded up.
    pub fn times(self, by: u32, of: u32) -> Self {
        let times = |n: u64| (n * u64::from(by)).div_ceil(u64::from(of.max(1)));
        Self { tile_leaves: times(self.tile_leaves), fragments: times(self.fragments) }
    }

    /// A quarter more.
    pub fn with_spare(self) -> Self {
        Self { tile_leaves: self.tile_leaves + self.tile_leaves / 4, fragments: self.fragments + self.fragments / 4 }
    }

    /// The larger of `self` and, where it does not suffice, `wanted` and a quarter more.
    pub fn grown(self, wanted: Self) -> Self {
        let spare = wanted.with_spare();
        let one = |had: u64, wanted: u64, spare: u64| if wanted > had { spare } else { had };
        Self {
            tile_leaves: one(self.tile_leaves, wanted.tile_leaves, spare.tile_leaves),
            fragments: one(self.fragments, wanted.fragments, spare.fragments),
        }
    }

    /// At most as many as a storage buffer of `range` bytes holds.
    pub fn within(self, range: u32) -> Self {
        let most = |bytes: usize| u64::from(range) / bytes as u64;
        Self {
            tile_leaves: self.tile_leaves.min(most(size_of::<TileLeaf>())),
            fragments: self.fragments.min(most(size_of::<Fragment>())),
        }
    }

    /// Whether these suffice.
    pub fn hold(self, wanted: Self) -> bool {
        self.tile_leaves >= wanted.tile_leaves && self.fragments >= wanted.fragments
    }

    fn bytes(self) -> [u64; 2] {
        [self.tile_leaves * size_of::<TileLeaf>() as u64, self.fragments * size_of::<Fragment>() as u64]
    }
}

/// The lists of a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lists {
    pub size: (u32, u32),
    /// Fragments are counted for each pixel.
    pub has_fragments: bool,
    pub limits: Limits,
}

impl Lists {
    /// Rows of tiles in the picture.
    pub fn rows(&self) -> u32 {
        self.size.1.div_ceil(TILE)
    }

    /// Bytes of the counters of each tile and pixel of `rows` rows, and of the entries and squares of all tiles: see
    /// `TileBuffers` and `FragmentBuffers`.
    fn counted_bytes(&self, rows: u32) -> u64 {
        let words = |n: u64| (n * size_of::<u32>() as u64).next_multiple_of(Buffer::LEAST_BYTES);
        let of_row = u64::from(self.size.0.div_ceil(TILE));
        let tiles = of_row * u64::from(rows.min(self.rows()));
        let pixels = self.pixels(rows);
        let of_pixels = if self.has_fragments { words(pixels) + words(pixels + 1) } else { 0 };
        words(tiles) + words(tiles + 1) + 2 * words(of_row * u64::from(self.rows())) + of_pixels
    }

    fn pixels(&self, rows: u32) -> u64 {
        u64::from(self.size.0) * u64::from(rows.saturating_mul(TILE).min(self.size.1))
    }

    /// Whether lists of so many rows fit into the limits.
    pub fn hold(&self, rows: u32, entries: Entries) -> bool {
        let [leaves, fragments] = entries.bytes();
        let range = u64::from(self.limits.range);
        // one word a pixel: its number of crossings, or the point where its ray resumes
        let counted = self.pixels(rows) < u64::from(scan::MAX_COUNT)
            && size_of::<u32>() as u64 * (self.pixels(rows) + 1) <= range;
        counted && leaves.max(fragments) <= range && self.counted_bytes(rows) + leaves + fragments <= self.limits.budget
    }

    /// The most rows that fit if each needs `row`; 0 if not even one fits.
    pub fn most_rows(&self, row: Entries) -> u32 {
        (1..=self.rows()).rev().find(|rows| self.hold(*rows, row.times(*rows, 1))).unwrap_or(0)
    }

    /// Rows of a band, if the picture is divided into equal bands of at most `rows` rows.
    pub fn even(&self, rows: u32) -> u32 {
        self.rows().div_ceil(self.rows().div_ceil(rows.max(1)).max(1)).min(rows)
    }

    /// Room for the wanted entries. If not all fit, as much as there is, in proportion.
    pub fn shared(&self, rows: u32, wanted: Entries) -> Entries {
        let [leaves, fragments] = wanted.bytes();
        let left = self.limits.budget.saturating_sub(self.counted_bytes(rows)).min(leaves + fragments);
        let share = |bytes: u64| {
            let share = u128::from(left) * u128::from(bytes) / u128::from((leaves + fragments).max(1));
            (share as u64).min(u64::from(self.limits.range))
        };
        Entries {
            tile_leaves: share(leaves) / size_of::<TileLeaf>() as u64,
            fragments: share(fragments) / size_of::<Fragment>() as u64,
        }
    }

    /// The error for a row that does not fit.
    pub fn no_room(&self, row: Entries) -> TooMany {
        let counted = |n: u64| u32::try_from(n).unwrap_or(u32::MAX);
        let [leaves, fragments] = row.bytes();
        let range = u64::from(self.limits.range);
        let over = |what, wanted: u64, of_one: usize| TooMany {
            what,
            count: counted(wanted),
            most: self.limits.range / of_one as u32,
            bytes: Some((wanted * of_one as u64, range)),
            help: SMALLER,
        };
        if fragments > range {
            return over("crossings of operands in one row of tiles", row.fragments, size_of::<Fragment>());
        }
        if leaves > range {
            return over("primitives in the tiles of one row", row.tile_leaves, size_of::<TileLeaf>());
        }
        let bytes = self.counted_bytes(1) + leaves + fragments;
        TooMany {
            what: "bytes for the lists of one row of tiles",
            count: counted(bytes),
            most: counted(self.limits.budget),
            bytes: None,
            help: "give a larger solid budget, or draw a smaller picture",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::abi::Counters;
    use crate::frame::counts::Counts;
    use crate::frame::solids::Capacities;

    const LISTS: Lists =
        Lists { size: (160, 120), has_fragments: true, limits: Limits { range: 1 << 27, budget: 60_000 } };

    #[test]
    fn rows_that_have_room_are_within_the_budget_and_one_more_is_not() {
        for row in
            [Entries::NONE, Entries { tile_leaves: 300, fragments: 20 }, Entries { tile_leaves: 3, fragments: 700 }]
        {
            let most = LISTS.most_rows(row);
            assert!(most > 0 && most < LISTS.rows(), "{most}");
            assert!(LISTS.hold(most, row.times(most, 1)) && !LISTS.hold(most + 1, row.times(most + 1, 1)));
            // 10 tiles and 16 rows of 160 pixels, with 2 words each; one word at each list's end, and two for each of
            // 80 tiles; each list of words is a whole number of texels of four
            let words = |n: u64| n.div_ceil(4) * 16;
            let bytes = |rows: u64| {
                let counted = [10 * rows, 10 * rows + 1, 80, 80, 2560 * rows, 2560 * rows + 1].map(words);
                counted.iter().sum::<u64>() + rows * 16 * (row.tile_leaves + row.fragments)
            };
            assert!(bytes(u64::from(most)) <= 60_000 && bytes(u64::from(most) + 1) > 60_000);
        }
        assert_eq!(LISTS.most_rows(Entries { tile_leaves: 0, fragments: 2470 }), 0);
        let no_room = LISTS.no_room(Entries { tile_leaves: 0, fragments: 2470 });
        assert_eq!((no_room.count, no_room.most), (60_752, 60_000));
    }

    #[test]
    fn one_buffer_is_a_limit_too() {
        let wide = Lists { size: (1 << 14, 1 << 14), limits: Limits { range: 1 << 27, budget: u64::MAX }, ..LISTS };
        // 2^25 words of 2^18 pixels a row, and one word more
        assert_eq!(wide.most_rows(Entries::NONE), 127);
        let row = Entries { tile_leaves: 0, fragments: 1 << 21 };
        assert_eq!(wide.most_rows(row), 4);
        let over = wide.no_room(row.times(5, 1));
        assert_eq!((over.what, over.most), ("crossings of operands in one row of tiles", 1 << 23));
        let over = wide.no_room(Entries { tile_leaves: 1 << 24, fragments: 0 });
        assert_eq!((over.what, over.count), ("primitives in the tiles of one row", 1 << 24));
    }

    #[test]
    fn shares_are_in_proportion_and_no_more_than_wanted() {
        let wanted = Entries { tile_leaves: 100, fragments: 200 };
        assert_eq!(LISTS.shared(1, wanted), wanted);
        let shared = LISTS.shared(2, wanted.times(20, 1));
        let [leaves, fragments] = shared.bytes();
        let left = 60_000 - LISTS.counted_bytes(2);
        assert!(leaves + fragments <= left && leaves + fragments + 40 > left, "{shared:?}");
        let [one, other] = wanted.bytes();
        assert!((leaves * other).abs_diff(fragments * one) < 40 * other, "{shared:?}");
    }

    const RANGE: u32 = 1 << 20;
    const SIZE: (u32, u32) = (160, 480);

    /// The counters of a frame whose rows of tiles need these leaves and fragments.
    fn drawn(had: Capacities, rows: &[(u32, u32)]) -> Counters {
        let sum = |rows: &[(u32, u32)]| rows.iter().fold((0, 0), |(a, b), (c, d)| (a + c, b + d));
        let most = |all: &[(u32, u32)]| all.iter().fold((0, 0), |(a, b): (u32, u32), (c, d)| (a.max(*c), b.max(*d)));
        let bands: Vec<_> = rows.chunks(had.band_rows.min(rows.len() as u32) as usize).map(sum).collect();
        let (all, band, row) = (sum(rows), most(&bands), most(rows));
        let failed = u32::from(band.0 > had.tile_leaves) * 64 + u32::from(band.1 > had.fragments) * 128;
        Counters {
            tile_leaves: all.0,
            band_tile_leaves: band.0,
            row_tile_leaves: row.0,
            fragments: all.1,
            band_fragments: band.1,
            row_fragments: row.1,
            failed,
            ..Counters::default()
        }
    }

    /// Records until the frame is complete; also returns the number of recordings.
    fn settled(mut had: Capacities, counts: Counts, rows: &[(u32, u32)]) -> Result<(Capacities, u32), TooMany> {
        for recorded in 1..9 {
            had = had.for_picture(counts, SIZE, RANGE)?;
            let lists = counts.lists(SIZE, RANGE);
            let room = Entries { tile_leaves: had.tile_leaves.into(), fragments: had.fragments.into() };
            assert!(lists.hold(had.band_rows.min(lists.rows()), room), "{had:?} is more than there is");
            let c = drawn(had, rows);
            let next = had.grown(&c, counts, SIZE, RANGE)?;
            if c.failed == 0 {
                let kept = next.for_picture(counts, SIZE, RANGE)?;
                assert_eq!(kept.takes_as_much(had), next.band_rows == had.band_rows, "{had:?} {c:?} {kept:?}");
                return Ok((had, recorded));
            }
            had = next;
        }
        panic!("not settled: {had:?}");
    }

    /// Any rows need at most three recordings, unless one row alone does not fit.
    #[test]
    fn frames_settle_within_their_limits() {
        let counts =
            |solid_budget| Counts { leaves: 40, boundary_operands: 1, events: true, solid_budget, ..Counts::default() };
        let mut seed = 1u64;
        let mut random = |most: u32| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((seed >> 33) as u32) % most.max(1)
        };
        let (mut banded, mut refused) = (0, 0);
        for case in 0..600 {
            let budget = [None, Some(60_000), Some(400_000), Some(3_000_000)][case % 4];
            let scale = [40, 400, 4000, 40_000][case / 4 % 4];
            let rows: Vec<(u32, u32)> = (0..30)
                .map(|row| if case % 3 == 0 && row != 7 { (1, 0) } else { (random(scale / 2), random(scale)) })
                .collect();
            let counts = counts(budget);
            let lists = counts.lists(SIZE, RANGE);
            let entries = |(a, b): (u32, u32)| Entries { tile_leaves: a.into(), fragments: b.into() };
            let fits = |row: &(u32, u32)| lists.hold(1, entries(*row));
            match settled(Capacities::first(counts), counts, &rows) {
                Err(_) => {
                    // the most leaves and the most fragments may be in different rows
                    let most = drawn(Capacities::first(counts), &rows);
                    assert!(!lists.hold(1, entries((most.row_tile_leaves, most.row_fragments))), "{case}");
                    refused += 1;
                }
                Ok((settled_at, recorded)) => {
                    assert!(recorded <= 3 && rows.iter().all(fits), "{case}: {recorded}");
                    let all = rows.iter().fold((0, 0), |(a, b), (c, d)| (a + c, b + d));
                    let whole = settled_at.band_rows >= 30;
                    assert_eq!(whole, lists.hold(30, entries(all)), "{case}: {settled_at:?}");
                    banded += u32::from(!whole);
                    // an empty view is one band again
                    if !whole && lists.hold(30, Entries::NONE) {
                        let nothing = drawn(settled_at, &[(0, 0); 30]);
                        assert!(settled_at.grown(&nothing, counts, SIZE, RANGE).unwrap().band_rows >= 30, "{case}");
                    }
                }
            }
        }
        assert!(banded > 100 && refused > 30, "{banded} in bands, {refused} refused");
    }

    /// If the counters exceed 32 bits, the largest row suffices to choose bands.
    #[test]
    fn what_cannot_be_counted_is_drawn_in_bands_that_can() {
        let counts = Counts { leaves: 4, boundary_operands: 1, events: true, ..Counts::default() };
        let c = Counters {
            fragments: 17,
            band_fragments: u32::MAX,
            row_fragments: 30_000,
            failed: 128,
            ..Counters::default()
        };
        let next = Capacities::first(counts).grown(&c, counts, SIZE, RANGE).unwrap();
        assert_eq!((next.band_rows, next.fragments), (2, 1 << 16));
        let c = Counters { row_fragments: 70_000, ..c };
        let refused = Capacities::first(counts).grown(&c, counts, SIZE, RANGE).unwrap_err();
        assert_eq!((refused.what, refused.most), ("crossings of operands in one row of tiles", 1 << 16));
    }
}
