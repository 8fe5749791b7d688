//! Trim textures: one bit a texel for each visible placed face, at the resolution of this view.
//!
//! ```text
//!   face speeds ──sizes──▶ words ──(prefix sum)──▶ starts
//!   curves ──flip──▶ a bit where a row meets a curve ──fill──▶ parity of the bits up to each texel
//! ```
//!
//! Writes: `sizes`: `words`, `counters`; `flip`: `texels`, `counters`; `fill`: `texels`, `places`. The caller records
//! the barriers between the steps. `src/baselines/texture.rs` describes the method.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError, Resource, TexelBuffer};
use crate::shaders;

/// Workgroups that share the rows of one face in the third step.
const ROW_GROUPS: u32 = 16;

/// The steps.
pub(crate) struct BaselineTexture {
    sizes: Kernel,
    flip: Kernel,
    fill: Kernel,
}

/// The buffers of all steps.
pub(crate) struct Bindings<'a> {
    pub knob: &'a Buffer,
    pub frame: &'a Buffer,
    pub face_instances: &'a TexelBuffer,
    pub faces: &'a TexelBuffer,
    pub curves: &'a TexelBuffer,
    pub curve_points: &'a TexelBuffer,
    pub curve_instances: &'a TexelBuffer,
    pub face_speeds: &'a Buffer,
    pub words: &'a Buffer,
    pub starts: &'a Buffer,
    pub places: &'a Buffer,
    pub texels: &'a Buffer,
    pub counters: &'a Buffer,
}

impl BaselineTexture {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let kernel = |name, shader| Kernel::new(device, name, shader, &[]);
        Ok(Self {
            sizes: kernel("baseline texture (sizes)", &shaders::BASELINE_TEXTURE_SIZES_COMP)?,
            flip: kernel("baseline texture (flip)", &shaders::BASELINE_TEXTURE_FLIP_COMP)?,
            fill: kernel("baseline texture (fill)", &shaders::BASELINE_TEXTURE_FILL_COMP)?,
        })
    }

    /// Computes the words of each of `placed` faces.
    pub(crate) fn sizes(&self, cmd: &Commands<'_>, b: &Bindings<'_>, placed: u32) {
        self.sizes.record(cmd, &[b.knob, b.face_speeds, b.words, b.counters].map(Into::into), placed);
    }

    /// Sets the bits along each of `curves`.
    pub(crate) fn flip(&self, cmd: &Commands<'_>, b: &Bindings<'_>, curves: u32) {
        let resources: [Resource<'_>; 11] = [
            b.frame.into(),
            b.knob.into(),
            b.face_instances.into(),
            b.faces.into(),
            b.curves.into(),
            b.curve_points.into(),
            b.curve_instances.into(),
            b.face_speeds.into(),
            b.starts.into(),
            b.texels.into(),
            b.counters.into(),
        ];
        self.flip.record_grid(cmd, &resources, grid(curves, 1));
    }

    /// Computes the parities along the rows of each of `placed` faces.
    pub(crate) fn fill(&self, cmd: &Commands<'_>, b: &Bindings<'_>, placed: u32) {
        let resources =
            [b.knob, b.face_speeds, b.starts, b.texels, b.counters, &**b.face_instances, &**b.faces, b.places];
        self.fill.record_grid(cmd, &resources.map(Into::into), grid(placed, ROW_GROUPS));
    }
}

/// A grid of `columns` workgroups in each row. Columns beyond the limit of the first dimension go into the third.
fn grid(columns: u32, rows: u32) -> [u32; 3] {
    const MOST: u32 = 65_535;
    [columns.min(MOST), rows, columns.div_ceil(MOST)]
}
