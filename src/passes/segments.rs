//! Pass `segments`: linear segments of each trim curve, enough for the view.
//!
//! ```text
//!    n >= sqrt(bend . speed / chord_px)       chords within chord_px of the curve
//!    n >= lines crossed / 256                 threads of equal work
//! ```
//!
//! Reads: `frame`, `face_instances`, `faces`, `curves`, `curve_items`, `face_speeds`, `line_starts`. Writes: `segment_counts`.
//! Twin: `src/twin/segments.rs`.

use crate::bindings::with_constants;
use crate::gpu::{Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline};
use crate::shaders;

/// Threads of a workgroup, as in the shader.
const GROUP: u32 = 64;

/// The pass.
pub(crate) struct Segments {
    pipeline: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub face_instances: &'a Buffer,
    pub faces: &'a Buffer,
    pub curves: &'a Buffer,
    pub curve_items: &'a Buffer,
    pub face_speeds: &'a Buffer,
    pub line_starts: &'a Buffer,
    pub segment_counts: &'a Buffer,
}

impl Segments {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let pipeline = Pipeline::compute(
            device,
            &ComputeInfo {
                name: "segments",
                spirv: shaders::SEGMENTS_COMP,
                bindings: &with_constants(8),
                push_bytes: 0,
                constants: &[],
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One thread for each of `curves`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, curves: u32) {
        let resources = [
            b.frame,
            b.face_instances,
            b.faces,
            b.curves,
            b.curve_items,
            b.face_speeds,
            b.line_starts,
            b.segment_counts,
        ]
        .map(Into::into);
        cmd.bind(&self.pipeline, &resources, &[]);
        cmd.dispatch(curves.div_ceil(GROUP));
    }
}
