//! Pass `bound`: which patches can be seen, and how finely each must be divided.
//!
//! ```text
//!    box of the patch ──▶ outside the picture? ──▶ tau = 0
//!         │
//!         ▼ smallest W
//!    second derivatives x pixels per unit ──▶ (tau_u, tau_v), the guaranteed factor
//! ```
//!
//! The factor is derived in [`twin::factor`](crate::twin::factor).
//!
//! Reads: `frame`, `views`, `instances`, `face_instances`, `faces`, `patches`, `items`. Writes: `taus`, `counters`.
//! Twin: `src/twin/bound.rs`.

use crate::bindings::with_constants;
use crate::gpu::{Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline};
use crate::shaders;

/// Threads of a workgroup, as in the shader.
const GROUP: u32 = 64;

/// The pass.
pub(crate) struct Bound {
    pipeline: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    /// The frame.
    pub frame: &'a Buffer,
    /// Part to pixel, per instance.
    pub views: &'a Buffer,
    pub instances: &'a Buffer,
    pub face_instances: &'a Buffer,
    pub faces: &'a Buffer,
    pub patches: &'a Buffer,
    /// Face instance of each item.
    pub items: &'a Buffer,
    /// `tau_u | tau_v << 16` per item.
    pub taus: &'a Buffer,
    /// `clamps`.
    pub counters: &'a Buffer,
}

impl Bound {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let pipeline = Pipeline::compute(
            device,
            &ComputeInfo {
                name: "bound",
                spirv: shaders::BOUND_COMP,
                bindings: &with_constants(9),
                push_bytes: 0,
                constants: &[],
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One thread for each of `items`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, items: u32) {
        let resources =
            [b.frame, b.views, b.instances, b.face_instances, b.faces, b.patches, b.items, b.taus, b.counters]
                .map(Into::into);
        cmd.bind(&self.pipeline, &resources, &[]);
        cmd.dispatch(items.div_ceil(GROUP));
    }
}
