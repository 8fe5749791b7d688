//! Pass `sizes`: where the rows of each v-strip are; rows and segments of the whole trim table, and the dispatches that
//! follow from them.
//!
//! Reads: `frame`, `strip_starts`, `segment_starts`. Writes: `dispatches`, `strips`, `counters`.
//! Twin: `src/twin/sizes.rs`.

use crate::bindings::with_constants;
use crate::gpu::{Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline};
use crate::shaders;

/// Threads of a workgroup, as in the shader.
const GROUP: u32 = 64;

/// `constant_id` of `SCENE_HAS_BAYS`.
const SCENE_HAS_BAYS: u32 = 1;

/// The pass.
pub(crate) struct Sizes {
    pipeline: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub strip_starts: &'a Buffer,
    pub segment_starts: &'a Buffer,
    /// Of passes cross and sort.
    pub dispatches: &'a Buffer,
    /// Where the rows of each are, at its first bay.
    pub strips: &'a Buffer,
    pub counters: &'a Buffer,
    /// A bit for each bay of a strip, where strips have several.
    pub seen_bays: Option<&'a Buffer>,
}

impl Sizes {
    /// `bays`: strips of some face have several bays.
    pub(crate) fn new(device: &Device, bays: bool) -> Result<Self, GpuError> {
        let pipeline = Pipeline::compute(
            device,
            &ComputeInfo {
                name: "sizes",
                spirv: shaders::SIZES_COMP,
                bindings: &with_constants(7),
                push_bytes: 0,
                constants: &[(SCENE_HAS_BAYS, u32::from(bays))],
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One thread for each of `bays`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, bays: u32) {
        // not read where there are none
        let seen_bays = b.seen_bays.unwrap_or(b.frame);
        let resources = [b.frame, b.strip_starts, b.segment_starts, b.dispatches, b.strips, b.counters, seen_bays];
        let resources = resources.map(Into::into);
        cmd.bind(&self.pipeline, &resources, &[]);
        cmd.dispatch(bays.div_ceil(GROUP));
    }
}
