//! Pass `segments`: linear segments of each trim curve, enough for the view.
//!
//! ```text
//!    n >= sqrt(bend . speed / chord_px)       chords within chord_px of the curve
//!    n >= lines crossed / 32                  threads of equal work
//! ```
//!
//! Reads: `frame`, `face_instances`, `faces`, `curves`, `curve_items`, `strip_starts`, `face_speeds`. Writes: `segment_counts`.
//! Twin: `src/twin/segments.rs`.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError, Texels};
use crate::shaders::{self, constant};

/// The pass.
pub(crate) struct Segments {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub face_instances: &'a Texels,
    pub faces: &'a Texels,
    pub curves: &'a Texels,
    pub curve_items: &'a Texels,
    pub strip_starts: &'a Texels,
    pub face_speeds: &'a Buffer,
    pub segment_counts: &'a Buffer,
    /// A bit for each bay of a strip, where strips have several.
    pub seen_bays: Option<&'a Buffer>,
}

impl Segments {
    /// `bays`: strips of some face have several bays.
    pub(crate) fn new(device: &Device, bays: bool) -> Result<Self, GpuError> {
        let kernel =
            Kernel::new(device, "segments", &shaders::SEGMENTS_COMP, &[(constant::SCENE_HAS_BAYS, u32::from(bays))])?;
        Ok(Self { kernel })
    }

    /// One thread for each of `curves`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, curves: u32) {
        let resources = [
            b.frame.into(),
            b.face_instances.into(),
            b.faces.into(),
            b.curves.into(),
            b.curve_items.into(),
            b.strip_starts.into(),
            b.face_speeds.into(),
            b.segment_counts.into(),
            // not read where there are none
            b.seen_bays.unwrap_or(b.frame).into(),
        ];
        self.kernel.record(cmd, &resources, curves);
    }
}
