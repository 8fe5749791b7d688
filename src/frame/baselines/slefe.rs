//! Pass `baseline_slefe`, in place of `bound`: patches are divided by slefes, in scenes that ask for it.
//!
//! ```text
//!    box of the patch ──▶ outside the picture, turned away? ──▶ tau = 0   as in pass `bound`
//!         │
//!         ▼
//!    slefe boxes of the net ──▶ largest extent e in pixels ──▶ tau = m sqrt(e / deviation), in both directions
//! ```
//!
//! Degrees above the table's, and boxes that reach the near plane, have no answer: a clamp. Weights are left out of
//! account, as in the source.
//!
//! Reads: `frame`, `views`, `instances`, `face_instances`, `faces`, `patches`, `items`, `cones`, `points`, `slefes`. Writes:
//! `taus`, `counters`. The same in `f64`: `Way::Ipass` of `src/baselines/factors`.

use crate::bindings::Bounded;
use crate::gpu::{Binding, Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline};
use crate::shaders;

/// The pass.
pub(crate) struct BaselineSlefe {
    pipeline: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub bounded: Bounded<'a>,
    /// Segments, and bounds of the basis functions on them.
    pub slefes: &'a Buffer,
}

impl BaselineSlefe {
    /// `cones`: some closed part has no trims.
    pub(crate) fn new(device: &Device, cones: bool) -> Result<Self, GpuError> {
        let mut bindings = Bounded::bindings();
        bindings.push(Binding::Storage);
        let pipeline = Pipeline::compute(
            device,
            &ComputeInfo {
                name: "baseline slefe",
                spirv: shaders::BASELINE_SLEFE_COMP,
                bindings: &bindings,
                push_bytes: 0,
                constants: &Bounded::constants(cones),
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One thread for each of `items`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, items: u32) {
        let resources = [b.bounded.resources().as_slice(), &[b.slefes.into()]].concat();
        cmd.bind(&self.pipeline, &resources, &[]);
        cmd.dispatch(items.div_ceil(Bounded::GROUP));
    }
}
