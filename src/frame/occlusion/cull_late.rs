//! Pass `cull_late`: finds the patches that are hidden behind the surfaces drawn so far.
//!
//! ```text
//!              hidden now                        may be visible
//!   drawn      not drawn in the next frame       drawn in the next frame
//!   hidden     not drawn in the next frame       drawn now
//! ```
//!
//! Reads: `frame`, `views`, `instances`, `face_instances`, `faces`, `patches`, `points`, `patch_instances`, `farthest`,
//! `outside`. Writes: `taus`, `hidden`, `counters`. Twin: `src/twin/occlusion.rs`.
//! Parity: with the twin in double precision, except where 0.02 pixels or a fifty-thousandth of the depth decide.

use crate::frame::common::kernel::{Kernel, Threads};
use crate::gpu::{Buffer, Commands, Device, GpuError, TexelBuffer};
use crate::shaders::{self, constant};

/// The pass.
pub(crate) struct CullLate {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub views: &'a Buffer,
    pub instances: &'a Buffer,
    pub face_instances: &'a Buffer,
    pub faces: &'a Buffer,
    pub patches: &'a TexelBuffer,
    pub points: &'a TexelBuffer,
    /// Face instance of each patch instance.
    pub patch_instances: &'a Buffer,
    /// Farthest depths of squares, then of tiles, then of blocks.
    pub farthest: &'a Buffer,
    pub taus: &'a Buffer,
    pub hidden: &'a Buffer,
    /// The cells of each patch that no part of the face covers.
    pub outside: &'a Buffer,
    /// `hidden`.
    pub counters: &'a Buffer,
    /// [`PatchRun`](crate::abi::PatchRun)s of the listed patch instances.
    pub runs: &'a Buffer,
}

impl CullLate {
    pub(crate) fn new(device: &Device, rational: bool) -> Result<Self, GpuError> {
        let kernel = Kernel::new(
            device,
            "cull late",
            &shaders::CULL_LATE_COMP,
            &[(constant::SCENE_HAS_RATIONAL, u32::from(rational))],
        )?;
        Ok(Self { kernel })
    }

    /// One thread for each listed patch instance.
    pub(crate) fn record<'t>(&self, cmd: &Commands<'_>, b: &Bindings<'_>, threads: impl Into<Threads<'t>>) {
        let resources = [
            b.frame.into(),
            b.views.into(),
            b.instances.into(),
            b.face_instances.into(),
            b.faces.into(),
            b.patches.into(),
            b.points.into(),
            b.patch_instances.into(),
            b.farthest.into(),
            b.taus.into(),
            b.hidden.into(),
            b.outside.into(),
            b.counters.into(),
            b.runs.into(),
        ];
        self.kernel.record_threads(cmd, &resources, threads.into());
    }
}
