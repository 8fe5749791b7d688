//! Pass `segments`: the number of linear segments of each trim curve that the view needs.
//!
//! ```text
//!    n >= sqrt(bend . speed / chord_px)       chords within chord_px of the curve
//!    n >= lines crossed / 32                  threads of equal work
//! ```
//!
//! Reads: `frame`, `face_instances`, `faces`, `curves`, `curve_instances`, `strip_starts`, `face_speeds`. Writes:
//! `segment_counts`. Twin: `src/twin/segments.rs`.
//! Parity: exact; on a GPU with other quotients and roots a count may differ by one.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError, TexelBuffer};
use crate::shaders::{self, constant};

/// The pass.
pub(crate) struct Segments {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub face_instances: &'a TexelBuffer,
    pub faces: &'a TexelBuffer,
    pub curves: &'a TexelBuffer,
    pub curve_instances: &'a TexelBuffer,
    pub strip_starts: &'a TexelBuffer,
    pub face_speeds: &'a Buffer,
    pub segment_counts: &'a Buffer,
    /// One bit for each bin of a strip, if strips have several.
    pub seen_bins: Option<&'a Buffer>,
}

impl Segments {
    /// `bins`: strips of some face have several bins.
    pub(crate) fn new(device: &Device, bins: bool) -> Result<Self, GpuError> {
        let kernel =
            Kernel::new(device, "segments", &shaders::SEGMENTS_COMP, &[(constant::SCENE_HAS_BINS, u32::from(bins))])?;
        Ok(Self { kernel })
    }

    /// One thread for each of `curves`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, curves: u32) {
        let resources = [
            b.frame.into(),
            b.face_instances.into(),
            b.faces.into(),
            b.curves.into(),
            b.curve_instances.into(),
            b.strip_starts.into(),
            b.face_speeds.into(),
            b.segment_counts.into(),
            // not read without bins
            b.seen_bins.unwrap_or(b.frame).into(),
        ];
        self.kernel.record(cmd, &resources, curves);
    }
}
