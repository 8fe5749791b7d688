//! Pass `split`: one number of segments per shared side, and enough sub-patches that none exceeds the
//! hardware's factor of 64.
//!
//! ```text
//!         A (tau 100, 2 sub-patches)        B (tau 30)
//!    ┌───────────┬───────────┐
//!    │    64     │    64     │      the side that A and B share gets 128 segments in both,
//!    ├───────────┴───────────┤      so B is cut in two as well: 64 + 64
//!    │    64     │    64     │
//!    └───────────┴───────────┘
//! ```
//!
//! Reads: `frame`, `face_instances`, `faces`, `patches`, `patch_instances`, `taus`, `runs`, `links`.
//! Writes: `factors`, `sub_patch_counts`, `vertex_counts`.
//! Twin: `src/twin/split.rs`.
//! Parity: exact.

use crate::frame::common::kernel::{Kernel, Threads};
use crate::gpu::{Buffer, Commands, Device, GpuError, Resource, TexelBuffer};
use crate::shaders;

/// The pass.
pub(crate) struct Split {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub face_instances: &'a Buffer,
    pub faces: &'a Buffer,
    pub patches: &'a TexelBuffer,
    pub patch_instances: &'a Buffer,
    pub taus: &'a Buffer,
    /// [`Factors`](crate::abi::Factors) per patch instance.
    pub factors: &'a Buffer,
    /// For each patch instance in sight, list by list: plain, trimmed, by its corners.
    pub sub_patch_counts: &'a Buffer,
    /// Vertices, likewise.
    pub vertex_counts: &'a Buffer,
    /// [`PatchRun`](crate::abi::PatchRun)s of the listed patch instances.
    pub runs: &'a Buffer,
    /// Sides that faces share; `None` without any.
    pub links: Option<&'a Buffer>,
}

impl Split {
    /// `linked`: faces share sides.
    pub(crate) fn new(device: &Device, linked: bool) -> Result<Self, GpuError> {
        let kernel = Kernel::new(
            device,
            if linked { "split (linked)" } else { "split" },
            if linked { &shaders::SPLIT_LINKED_COMP } else { &shaders::SPLIT_COMP },
            &[],
        )?;
        Ok(Self { kernel })
    }

    /// One thread for each listed patch instance.
    pub(crate) fn record<'t>(&self, cmd: &Commands<'_>, b: &Bindings<'_>, threads: impl Into<Threads<'t>>) {
        let written = [b.factors, b.sub_patch_counts, b.vertex_counts];
        let resources: Vec<_> = [b.frame, b.face_instances, b.faces]
            .map(Resource::from)
            .into_iter()
            .chain([b.patches.into()])
            .chain(
                [b.patch_instances, b.taus].into_iter().chain(written).chain([b.runs]).chain(b.links).map(Into::into),
            )
            .collect();
        self.kernel.record_threads(cmd, &resources, threads.into());
    }
}
