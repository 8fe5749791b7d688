//! Pass `segments`: linear segments of each trim curve, enough for the view.
//!
//! ```text
//!    n >= sqrt(bend . speed / chord_px)       chords within chord_px of the curve
//!    n >= lines crossed / 32                  threads of equal work
//! ```
//!
//! Reads: `frame`, `face_instances`, `faces`, `curves`, `curve_items`, `strip_starts`, `face_speeds`. Writes: `segment_counts`.
//! Twin: `src/twin/segments.rs`.

use crate::bindings::with_texels;
use crate::gpu::{Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline, Texels};
use crate::shaders;

/// Threads of a workgroup, as in the shader.
const GROUP: u32 = 64;

/// `constant_id` of `SCENE_HAS_BAYS`.
const SCENE_HAS_BAYS: u32 = 1;

/// The pass.
pub(crate) struct Segments {
    pipeline: Pipeline,
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
        let pipeline = Pipeline::compute(
            device,
            &ComputeInfo {
                name: "segments",
                spirv: shaders::SEGMENTS_COMP,
                bindings: &with_texels(1..6, 9),
                push_bytes: 0,
                constants: &[(SCENE_HAS_BAYS, u32::from(bays))],
            },
        )?;
        Ok(Self { pipeline })
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
        cmd.bind(&self.pipeline, &resources, &[]);
        cmd.dispatch(curves.div_ceil(GROUP));
    }
}
