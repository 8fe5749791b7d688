//! Pass `rival_slefe`, in place of `bound`: patches are divided by slefes, in scenes that ask for it.
//!
//! ```text
//!    box of the patch ──▶ outside the picture? ──▶ tau = 0                as in pass `bound`
//!         │
//!         ▼
//!    slefe boxes of the net ──▶ largest extent e in pixels ──▶ tau = m sqrt(e / deviation), in both directions
//! ```
//!
//! Degrees above the table's, and boxes that reach the near plane, have no answer: a clamp. Weights are left out of
//! account, as in the source.
//!
//! Reads: `frame`, `views`, `instances`, `face_instances`, `faces`, `patches`, `items`, `points`, `slefes`. Writes:
//! `taus`, `counters`. The same in `f64`: `Way::Ipass` of `src/rivals/factors`.

use crate::bindings::with_constants;
use crate::gpu::{Binding, Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline, Resource, Texels};
use crate::shaders;

/// Threads of a workgroup, as in the shader.
const GROUP: u32 = 64;

/// The pass.
pub(crate) struct RivalSlefe {
    pipeline: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub views: &'a Buffer,
    pub instances: &'a Buffer,
    pub face_instances: &'a Buffer,
    pub faces: &'a Buffer,
    pub patches: &'a Buffer,
    pub items: &'a Buffer,
    /// `tau_u | tau_v << 16` per item.
    pub taus: &'a Buffer,
    /// `clamps`.
    pub counters: &'a Buffer,
    pub points: &'a Texels,
    /// Segments, and bounds of the basis functions on them.
    pub slefes: &'a Buffer,
}

impl RivalSlefe {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let mut bindings = with_constants(11);
        bindings[9] = Binding::Texels;
        let pipeline = Pipeline::compute(
            device,
            &ComputeInfo {
                name: "rival slefe",
                spirv: shaders::RIVAL_SLEFE_COMP,
                bindings: &bindings,
                push_bytes: 0,
                constants: &[],
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One thread for each of `items`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, items: u32) {
        let resources: [Resource<'_>; 11] = [
            b.frame.into(),
            b.views.into(),
            b.instances.into(),
            b.face_instances.into(),
            b.faces.into(),
            b.patches.into(),
            b.items.into(),
            b.taus.into(),
            b.counters.into(),
            b.points.into(),
            b.slefes.into(),
        ];
        cmd.bind(&self.pipeline, &resources, &[]);
        cmd.dispatch(items.div_ceil(GROUP));
    }
}
