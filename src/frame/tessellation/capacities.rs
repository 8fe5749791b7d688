//! Sizes of the lists of sub-patches and draws.

use crate::abi::constants::scene::FAILED_DRAWS;
use crate::abi::{Counters, SubPatch};
use crate::frame::capacities::grown;
use crate::frame::counts::{Counts, FEWER_PARTS, TooMany};

/// Vertices of a patch instance in a view of the whole scene, where most patch instances are one sub-patch of few
/// segments.
const VERTICES_OF_A_PATCH: u64 = 16;

/// The sizes of lists whose length only the GPU computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Capacities {
    pub sub_patches: u32,
    pub draws: u32,
}

impl Capacities {
    /// A first guess that fits most scenes in full view.
    pub(crate) fn first(counts: Counts) -> Self {
        Self { sub_patches: counts.patch_instances.saturating_add(256), draws: 256 }
    }

    /// The same, with room for the draws of a scene whose patch instances have a few vertices each. `draw_vertices`:
    /// vertices of one draw.
    pub(crate) fn drawn_by(self, counts: Counts, draw_vertices: u32) -> Self {
        let draws = u64::from(counts.patch_instances) * VERTICES_OF_A_PATCH / u64::from(draw_vertices);
        Self { draws: self.draws.max(draws as u32), ..self }
    }

    /// The sizes that the frame with counters `c` needed.
    pub(crate) fn grown(self, c: &Counters, range: u32) -> Result<Self, TooMany> {
        let wanted = c.plain.saturating_add(c.trimmed);
        let bytes = size_of::<SubPatch>();
        TooMany::of_bytes(("parts of patches", wanted), bytes, range, FEWER_PARTS).map_or(Ok(()), Err)?;
        let more_draws = if c.failed & FAILED_DRAWS != 0 { 4 } else { 1 };
        Ok(Self {
            sub_patches: grown(self.sub_patches, wanted, range / bytes as u32),
            draws: self.draws.saturating_mul(more_draws),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A driver with few vertices a draw gets many draws of a large scene at once.
    #[test]
    fn draws_follow_the_scene() {
        let counts = Counts { patch_instances: 1 << 20, ..Default::default() };
        let draws = |draw_vertices| Capacities::first(counts).drawn_by(counts, draw_vertices).draws;
        assert_eq!((draws(u32::MAX), draws(1 << 12)), (Capacities::first(counts).draws, 1 << 12));
    }
}
