//! Pass `density`: the pixels that each v-strip of a trimmed face can cover.
//!
//! ```text
//!    cell = part of a patch in a bin of a strip:   |S_v| x pixels per unit / strips  = height_px
//!    strip height = largest of its visible cells; 0 when none is visible
//! ```
//!
//! Reads: `frame`, `views`, `instances`, `face_instances`, `faces`, `cells`, `cell_instances`. Writes: `strip_heights`,
//! `face_speeds`, `seen_bins`. `frame` and `views` are those of the view for which the table is made: this view, or a
//! wider one that serves all views of its cell (`src/scene/view_cell.rs`). Twin: `src/twin/density.rs`.
//! Parity: exact; on a GPU with other quotients and roots within 24 units in the last place, three for each of eight
//! operations.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders::{self, constant};

/// The pass.
pub(crate) struct Density {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub views: &'a Buffer,
    pub instances: &'a Buffer,
    pub face_instances: &'a Buffer,
    pub faces: &'a Buffer,
    pub cells: &'a Buffer,
    /// Face instance of each cell.
    pub cell_instances: &'a Buffer,
    /// Float bits; cleared before.
    pub strip_heights: &'a Buffer,
    /// Float bits of pixels per unit of u and v; cleared before.
    pub face_speeds: &'a Buffer,
    /// One bit for each bin of a strip, if strips have several; cleared before.
    pub seen_bins: Option<&'a Buffer>,
}

impl Density {
    /// `bins`: strips of some face have several bins.
    pub(crate) fn new(device: &Device, bins: bool) -> Result<Self, GpuError> {
        let kernel =
            Kernel::new(device, "density", &shaders::DENSITY_COMP, &[(constant::SCENE_HAS_BINS, u32::from(bins))])?;
        Ok(Self { kernel })
    }

    /// One thread for each of `cells`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, cells: u32) {
        let resources = [
            b.frame,
            b.views,
            b.instances,
            b.face_instances,
            b.faces,
            b.cells,
            b.cell_instances,
            b.strip_heights,
            b.face_speeds,
            // neither read nor written without bins
            b.seen_bins.unwrap_or(b.frame),
        ]
        .map(Into::into);
        self.kernel.record(cmd, &resources, cells);
    }
}
