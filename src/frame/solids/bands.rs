//! Bands of rows of tiles, whose lists are made one band at a time.
//!
//! ```text
//!   one band     lists ─▶ solid_events                    …  resolve ─▶ solid_layers
//!   several      lists ─▶ solid_events, rows 0 to 31      …  resolve ─▶ lists ─▶ solid_layers, rows 0 to 31
//!                lists ─▶ solid_events, rows 32 to 63                   lists ─▶ solid_layers, rows 32 to 63
//! ```

use super::Solids;
use crate::abi;
use crate::frame::{Frame, WRITE_TO_READ};
use crate::gpu::{Access, Buffer, Commands, barrier};
use std::mem::offset_of;
use std::ops::Range;

/// The rows of pixels of one band.
#[derive(Clone, Debug)]
pub(crate) struct Band {
    pub rows: Range<u32>,
    /// The band is the whole picture.
    pub is_whole: bool,
}

/// Accesses that read lists.
fn readers() -> Access {
    Access::COMPUTE_READ | Access::VERTEX_READ | Access::FRAGMENT_READ
}

/// Accesses to constants. They are also bound in place of absent lists, which no shader reads.
fn of_constants() -> Access {
    Access::UNIFORM_READ | readers()
}

impl Frame<'_> {
    /// All bands, from the top down.
    pub(crate) fn bands(&self) -> impl Iterator<Item = Band> + use<> {
        let height = self.stages.visibility.image.size().1;
        let each = self.stages.solids.as_ref().map_or(height, |solids| solids.band_rows * abi::TILE);
        (0..height)
            .step_by(each as usize)
            .map(move |top| Band { rows: top..(top + each).min(height), is_whole: each >= height })
    }

    /// The band's tiles, numbered through the picture.
    pub(crate) fn tiles_of(&self, band: &Band) -> Range<u32> {
        let across = self.stages.visibility.image.size().0.div_ceil(abi::TILE);
        across * (band.rows.start / abi::TILE)..across * band.rows.end.div_ceil(abi::TILE)
    }

    /// Writes the band's place for the passes. The passes of the last band must have read their lists.
    pub(crate) fn begin_band(&self, cmd: &Commands<'_>, solids: &Solids, band: &Band) {
        if band.is_whole {
            return;
        }
        let w = WRITE_TO_READ.0;
        let (tiles, fragments) = (solids.tiles(), solids.fragments());
        let lists = tiles.into_iter();
        let lists: Vec<&Buffer> =
            lists.flat_map(|t| [&t.tile_counts, &t.tile_starts, &t.tile_leaves, &t.tile_entries]).collect();
        let mut before: Vec<_> = lists.into_iter().map(|list| (list, readers(), w)).collect();
        before.push((self.constants, of_constants(), Access::TRANSFER_WRITE));
        if let Some(f) = fragments {
            before.push((&f.counts, readers() | Access::TRANSFER_WRITE, Access::TRANSFER_WRITE));
        }
        barrier::buffers(cmd, &before);
        cmd.fill_word(self.constants, (offset_of!(abi::Frame, band_top) / size_of::<u32>()) as u64, band.rows.start);
        if let Some(f) = fragments {
            cmd.fill(&f.counts, 0);
        }
        barrier::buffers(cmd, &[(self.constants, Access::TRANSFER_WRITE, of_constants())]);
    }

    /// Clears the lists' counters, before the lists of all bands are made again.
    pub(crate) fn count_bands_again(&self, cmd: &Commands<'_>) {
        let counters = &self.stages.common.counters;
        let counted = Access::COMPUTE_WRITE | Access::INDIRECT_READ;
        barrier::buffers(cmd, &[(counters, counted, Access::TRANSFER_WRITE)]);
        let sums = [
            offset_of!(abi::Counters, tile_leaves),
            offset_of!(abi::Counters, fragments),
            offset_of!(abi::Counters, mended),
            offset_of!(abi::Counters, unpaired),
        ];
        for at in sums {
            cmd.fill_word(counters, (at / size_of::<u32>()) as u64, 0);
        }
        barrier::buffers(cmd, &[(counters, Access::TRANSFER_WRITE, counted)]);
    }
}
