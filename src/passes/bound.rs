//! Pass `bound`: which patches can be seen, and how finely each must be divided.
//!
//! ```text
//!    box of the patch ──▶ outside the picture? all of it turned away? ──▶ tau = 0
//!         │
//!         ▼ smallest W
//!    second derivatives x pixels per unit ──▶ (tau_u, tau_v), the guaranteed factor
//! ```
//!
//! The factor is derived in [`twin::factor`](crate::twin::factor).
//!
//! Reads: `frame`, `views`, `instances`, `face_instances`, `faces`, `patches`, `items`, `cones`. Writes: `taus`, `counters`.
//! Twin: `src/twin/bound.rs`.

use crate::bindings::with_constants;
use crate::gpu::{Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline};
use crate::shaders;

/// Threads of a workgroup, as in the shader.
const GROUP: u32 = 64;
/// `constant_id` of `SCENE_HAS_CONES`.
const SCENE_HAS_CONES: u32 = 1;

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
    /// Of each patch's normals, where some closed part has no trims.
    pub cones: Option<&'a Buffer>,
}

impl Bound {
    /// `cones`: some closed part has no trims.
    pub(crate) fn new(device: &Device, cones: bool) -> Result<Self, GpuError> {
        let pipeline = Pipeline::compute(
            device,
            &ComputeInfo {
                name: "bound",
                spirv: shaders::BOUND_COMP,
                bindings: &with_constants(10),
                push_bytes: 0,
                constants: &[(SCENE_HAS_CONES, u32::from(cones))],
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One thread for each of `items`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, items: u32) {
        let cones = b.cones.unwrap_or(b.frame); // not read then
        let resources =
            [b.frame, b.views, b.instances, b.face_instances, b.faces, b.patches, b.items, b.taus, b.counters, cones]
                .map(Into::into);
        cmd.bind(&self.pipeline, &resources, &[]);
        cmd.dispatch(items.div_ceil(GROUP));
    }
}
