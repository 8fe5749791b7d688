//! What became of a frame, once the GPU has finished it.

use super::Renderer;
use crate::abi::Counters;
use crate::gpu::GpuError;
use crate::picture::{FrameStats, PassTime, PoolBytes, TakenWay};

/// What became of a frame.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FrameReport {
    /// Every buffer sufficed, and the scene was there; otherwise record the frame again.
    pub complete: bool,
    /// The frame drew the background alone, because arrays of the scene were copied first: these bytes waited still after
    /// it. Staging memory is bounded, so a large scene or edit takes several such frames. `None`: the scene was drawn.
    pub waiting: Option<u64>,
    /// What it cost.
    pub stats: FrameStats,
}

impl Renderer {
    /// What became of the frame recorded last into `slot`, which has finished on the GPU; `None`
    /// when there was none.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn report(&self, slot: usize) -> Result<Option<FrameReport>, GpuError> {
        self.device.alive()?;
        let slot = &self.slots[slot];
        if !slot.recorded {
            return Ok(None);
        }
        let c = if slot.copies.is_none() { slot.read_counters() } else { Counters::default() };
        let listed = match (slot.copies, slot.counts.hides_parts) {
            (Some(_), _) => 0,
            (None, true) => c.listed_patches,
            (None, false) => slot.patch_instances_in_sight,
        };
        let scopes = slot.times.read().inspect_err(|error| self.device.note(error))?;
        let stats = FrameStats {
            passes: scopes.iter().map(|s| PassTime { name: s.name.clone(), gpu_ms: s.gpu_ms }).collect(),
            reused: slot.reused,
            trim: slot.counts.trim.and_then(TakenWay::reported),
            patches: u64::from(slot.counts.patch_instances),
            triangles: scopes.iter().filter_map(|s| s.statistics).map(|s| s.triangles).sum(),
            sub_patches: u64::from(c.plain) + u64::from(c.trimmed),
            corner_patches: u64::from(c.corners),
            trim_rows: u64::from(c.rows),
            trim_segments: u64::from(c.segments),
            trim_intercepts: u64::from(c.intercepts),
            gap_candidates: u64::from(c.gap_candidates),
            clamps: u64::from(c.clamps),
            hidden_patches: u64::from(c.hidden),
            hidden_parts: u64::from(c.hidden_parts),
            listed_patches: u64::from(listed),
            fragments: u64::from(c.fragments),
            mended: u64::from(c.mended),
            unpaired: u64::from(c.unpaired),
            contact_pixels: u64::from(c.contacts),
            overlap_pixels: u64::from(c.overlaps),
            open_clear: u64::from(slot.counts.open),
            shadowless: u64::from(slot.counts.shadowless),
            shadow_deviation: slot.shadow_deviation,
            edge_chords: u64::from(c.edge_chords),
            layers: u64::from(c.layers),
            bands: slot.bands,
            solid_bytes: slot.solid_bytes.clone(),
            retries: 0,
            edit_bytes: slot.edit_bytes,
            pools: self.device.pool_bytes().map(|(p, bytes)| PoolBytes { name: p.name().to_owned(), bytes }).to_vec(),
            device: self.device.name().to_owned(),
            driver: self.device.driver().to_owned(),
        };
        Ok(Some(FrameReport { complete: c.failed == 0 && slot.copies.is_none(), waiting: slot.copies, stats }))
    }
}
