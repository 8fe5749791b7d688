//! The sizes of a frame's lists: from the scene's counts, and from the counters of the previous frame.
//!
//! ```text
//!   Counts       of the scene     ──first──▶ Capacities ──Stages──▶ a frame ──▶ Counters
//!                                                  ▲                                  │ failed
//!                                                  └──────────────── grown ◀──────────┘
//! ```

use super::counts::{Counts, TooMany};
use super::{antialiasing, edges, gaps, solids, tessellation, trim};
use crate::abi::Counters;
use crate::gpu::{Device, Texel};

/// The sizes of lists whose length only the GPU computes, for each stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Capacities {
    pub tessellation: tessellation::Capacities,
    pub trim: trim::Capacities,
    pub gaps: gaps::Capacities,
    pub solids: solids::Capacities,
    pub edges: edges::Capacities,
    pub antialiasing: antialiasing::Capacities,
}

/// If `wanted` is more than `had`: `wanted` and a quarter more, but no spare room beyond `most`. Else `had`.
pub(super) fn grown(had: u32, wanted: u32, most: u32) -> u32 {
    let spare = wanted.saturating_add(wanted / 4).min(most);
    if wanted > had { spare.max(wanted) } else { had }
}

impl Capacities {
    /// A first guess that fits most scenes in full view. `draw_vertices`: vertices of one draw.
    pub(crate) fn first(counts: Counts, draw_vertices: u32) -> Self {
        Self {
            tessellation: tessellation::Capacities::first(counts).drawn_by(counts, draw_vertices),
            trim: trim::Capacities::first(counts),
            gaps: gaps::Capacities::first(counts),
            solids: solids::Capacities::first(counts),
            edges: edges::Capacities::first(counts),
            antialiasing: antialiasing::Capacities::first(counts),
        }
    }

    /// The same with at least the first guess for a scene of more parts.
    pub(crate) fn for_more(self, counts: Counts, draw_vertices: u32) -> Self {
        let (had, first) = (self, Self::first(counts, draw_vertices));
        let tessellation = tessellation::Capacities {
            sub_patches: had.tessellation.sub_patches.max(first.tessellation.sub_patches),
            draws: had.tessellation.draws.max(first.tessellation.draws),
        };
        let trim = trim::Capacities {
            rows: had.trim.rows.max(first.trim.rows),
            intercepts: had.trim.intercepts.max(first.trim.intercepts),
        };
        Self { tessellation, trim, ..had }
    }

    /// See [`solids::Capacities::expecting`].
    pub(crate) fn expecting(self, crossings: u64, counts: Counts) -> Self {
        Self { solids: self.solids.expecting(crossings, counts), ..self }
    }

    /// See [`solids::Capacities::for_picture`], [`gaps::Capacities::for_picture`], [`edges::Capacities::for_picture`] and
    /// [`antialiasing::Capacities::for_picture`].
    pub(crate) fn for_picture(self, counts: Counts, size: (u32, u32), ranges: Ranges) -> Result<Self, TooMany> {
        let range = ranges.quads;
        let gaps = self.gaps.for_picture(counts, size, range);
        let edges = self.edges.for_picture(counts, size, range);
        let antialiasing = self.antialiasing.for_picture(counts, size, range);
        Ok(Self { gaps, edges, antialiasing, solids: self.solids.for_picture(counts, size, range)?, ..self })
    }

    /// Whether buffers made for `self` have the same sizes as buffers made for `others`.
    pub(crate) fn takes_as_much(self, others: Self) -> bool {
        self.solids.takes_as_much(others.solids) && Self { solids: others.solids, ..self } == others
    }

    /// The sizes that the frame with counters `c` needed, with a quarter to spare if a list may have it; unchanged if
    /// they sufficed. `size` is that of the picture.
    pub(crate) fn grown(self, c: &Counters, counts: Counts, size: (u32, u32), ranges: Ranges) -> Result<Self, TooMany> {
        let range = ranges.quads;
        Ok(Self {
            tessellation: self.tessellation.grown(c, range)?,
            trim: self.trim.grown(c, counts, ranges.pairs)?,
            gaps: self.gaps.grown(c, size, range)?,
            solids: self.solids.grown(c, counts, size, range)?,
            edges: self.edges.grown(c, range)?,
            antialiasing: self.antialiasing.grown(c, range)?,
        })
    }
}

/// Most bytes of a list. Shaders read the longest lists as texels, so the device's limit on texels bounds them, too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Ranges {
    /// Of a list read as texels of two words: the trim table.
    pub pairs: u32,
    /// Of a list read as texels of four words, or as structs.
    pub quads: u32,
}

impl Ranges {
    pub(crate) fn of(device: &Device) -> Self {
        let limits = device.limits();
        Self { pairs: Texel::U32x2.range(limits), quads: Texel::U32x4.range(limits) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::counts::{MOST_SEEN, MOST_TRIANGLES};
    use super::*;
    use crate::abi::constants::scene::FAILED_DRAWS;
    use crate::picture::TakenWay;

    /// The storage buffer range that every Vulkan device supports.
    const RANGE: u32 = 1 << 27;

    fn both(range: u32) -> Ranges {
        Ranges { pairs: range, quads: range }
    }

    fn first() -> Capacities {
        let counts = Counts { patch_instances: 1000, bins: 8, trim: Some(TakenWay::Table), ..Default::default() };
        Capacities::first(counts, u32::MAX)
    }

    fn grown(had: Capacities, c: &Counters) -> Result<Capacities, TooMany> {
        had.grown(c, Counts::default(), (640, 480), both(RANGE))
    }

    #[test]
    fn what_sufficed_stays() {
        let c = Counters {
            plain: 900,
            trimmed: 100,
            rows: 65_536,
            wanted_rows: 65_536,
            intercepts: 262_144,
            ..Default::default()
        };
        assert_eq!(grown(first(), &c).unwrap(), first());
    }

    #[test]
    fn what_did_not_gets_what_it_wanted_and_a_quarter() {
        let c = Counters { plain: 2000, wanted_rows: 100_000, failed: FAILED_DRAWS | 1 | 4, ..Default::default() };
        let had = grown(first(), &c).unwrap();
        assert_eq!((had.tessellation.sub_patches, had.trim.rows), (2500, 125_000));
        let first = first();
        assert_eq!(had.tessellation.draws, 4 * first.tessellation.draws);
        assert_eq!(had.trim.intercepts, first.trim.intercepts);
        assert!(!had.takes_as_much(first));
        // a storage buffer has no room for a quarter more
        let c = Counters { intercepts: RANGE / 4 - 1, failed: 8, ..Default::default() };
        assert_eq!(grown(first, &c).unwrap().trim.intercepts, RANGE / 4);
    }

    /// Scenes without curved faces have no such list.
    #[test]
    fn points_that_follow_surfaces_have_room_by_the_picture() {
        let of = |follows_borders: bool, size| {
            let counts = Counts { follows_borders, ..Default::default() };
            let first = Capacities::first(counts, u32::MAX);
            first.for_picture(counts, size, both(RANGE)).unwrap().antialiasing.followed
        };
        assert_eq!([of(false, (4096, 4096)), of(true, (64, 64)), of(true, (4096, 4096))], [0, 1 << 15, 1 << 20]);
        assert_eq!(of(true, (600, 800)), 64_000);
        assert_eq!(of(true, (1 << 15, 1 << 15)), RANGE / 12);
        let counts = Counts { follows_borders: true, ..Default::default() };
        let c = Counters { followed_points: 100_000, failed: 2048, ..Default::default() };
        let had = Capacities::first(counts, u32::MAX);
        let more = had.grown(&c, counts, (640, 480), both(RANGE)).unwrap();
        assert_eq!((had.antialiasing.followed, more.antialiasing.followed), (1 << 15, 125_000));
        assert!(!more.takes_as_much(had));
    }

    /// Lists by the picture's size stay within the storage buffer that every device binds.
    #[test]
    fn lists_of_the_largest_picture_fit_into_every_device() {
        let counts = Counts { follows_borders: true, trim: Some(TakenWay::Exact), ..Default::default() };
        let of = |size| {
            let Capacities { gaps, antialiasing, .. } =
                Capacities::first(counts, u32::MAX).for_picture(counts, size, both(RANGE)).unwrap();
            (gaps.candidates, antialiasing.followed)
        };
        // a band of the larger picture has 660 rows, and room for one candidate in eight pixels
        assert_eq!((of((640, 480)), of((16384, 16384))), ((38_400, 51_200), (660 * 2048, RANGE / 12)));
    }

    /// A straight piece is one chord; a curved one has more in a larger picture, and fewer among many.
    #[test]
    fn chords_have_room_by_the_picture() {
        let counts = Counts { piece_instances: 3000, curved_piece_instances: 625, ..Default::default() };
        let of = |counts, size| {
            let had = Capacities::first(counts, u32::MAX).for_picture(counts, size, both(RANGE)).unwrap();
            had.edges.chords
        };
        // seven of 125 times the root of the diagonal, 8 and 16
        assert_eq!([of(counts, (64, 0)), of(counts, (0, 256))], [3000 + 7000, 3000 + 14_000]);
        let one = Counts { piece_instances: 1, curved_piece_instances: 1, ..counts };
        assert_eq!(of(one, (64, 0)), 1 + 7 * 8);
        assert_eq!(of(Counts::default(), (256, 256)), 0);
        let many = Counts { piece_instances: 1 << 24, ..counts };
        assert_eq!(of(many, (256, 256)), RANGE / size_of::<crate::abi::Chord>() as u32);
    }

    #[test]
    fn more_than_can_be_counted_is_an_error() {
        let over = |counts: Counts| counts.check(u32::MAX).err().map(|error| (error.what, error.most, error.bytes));
        let counts = Counts { mesh_instances: 1 << 26, triangles: u32::MAX / 12, ..Default::default() };
        assert_eq!(over(counts), None);
        let more = Counts { triangles: MOST_TRIANGLES + 1, ..counts };
        assert_eq!(over(more), Some(("triangles", MOST_TRIANGLES, None)));
        let more = Counts { mesh_instances: MOST_SEEN + 1, ..counts };
        assert_eq!(over(more), Some(("placed meshes", MOST_SEEN, None)));
    }

    /// A hundred million patches and scan lines fit if the device binds such buffers.
    #[test]
    fn what_no_buffer_holds_says_how_much_it_wants() {
        const HUNDRED_MILLION: u32 = 100_000_000;
        let counts = Counts { patch_instances: HUNDRED_MILLION, trim: Some(TakenWay::Table), ..Default::default() };
        let rows = Counters { wanted_rows: HUNDRED_MILLION, failed: 4, ..Default::default() };
        assert!(counts.check(u32::MAX).is_ok());
        let grown = |range| first().grown(&rows, counts, (640, 480), both(range));
        assert!(grown(u32::MAX).unwrap().trim.rows > HUNDRED_MILLION);
        let over = counts.check(RANGE).unwrap_err();
        assert_eq!((over.count, over.most), (HUNDRED_MILLION, RANGE / 16));
        assert_eq!(
            over.to_string(),
            "100000000 patches are too many: at most 8388608 can be drawn, because they want 1600000000 bytes in one \
             buffer, and this device binds 134217728 (maxStorageBufferRange, maxTexelBufferElements); draw fewer parts \
             at once, or place fewer copies, or take a device or driver that binds more"
        );
        let over = grown(RANGE).unwrap_err();
        assert_eq!((over.what, over.most, over.bytes), ("scan lines", RANGE / 8, Some((800_000_000, RANGE.into()))));
        assert!(over.is_of_table());
        let more = Counters { plain: RANGE / 8 + 1, failed: 1, ..Default::default() };
        let over = first().grown(&more, counts, (640, 480), both(RANGE)).unwrap_err();
        assert_eq!((over.what, over.most), ("parts of patches", RANGE / 8));
        let more = Counters { band_gap_candidates: RANGE / 12 + 1, failed: 16, ..Default::default() };
        let over = first().grown(&more, counts, (640, 480), both(RANGE)).unwrap_err();
        assert_eq!((over.what, over.most), ("pixels at gaps", RANGE / 12));
        let more = Counters { followed_points: RANGE / 12 + 1, failed: 2048, ..Default::default() };
        let over = first().grown(&more, counts, (640, 480), both(RANGE)).unwrap_err();
        assert_eq!((over.what, over.most), ("points at borders of curved faces", RANGE / 12));
    }
}
