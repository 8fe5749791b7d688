//! Pass `cross`: intersects every linear segment of a trim curve with every scan line that it crosses.
//!
//! ```text
//!   count    row_counts[row] += 1, border cells marked           one thread a segment; pass `dispatch_arguments` found
//!   (scan)   row_starts = sums                                   their number
//!   insert   intercepts[row_starts[row] + place] = u, direction
//! ```
//!
//! Reads: `frame`, `face_instances`, `faces`, `curves`, `curve_points`, `curve_instances`, `strips`,
//! `segment_starts`, `row_starts`, `dispatches`. Writes: `row_counts` (zero before
//! counting and again after inserting),
//! `intercepts`, `border_cells` and `row_windings` (zero before counting). Twin: `src/twin/cross.rs`.
//! Parity: exact, rows as sets; on a GPU with other quotients within the bound in the twin's header.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError, TexelBuffer};
use crate::shaders::{self, constant};

/// The pass, in its two roles.
pub(crate) struct Cross {
    count: Kernel,
    insert: Kernel,
}

/// Its buffers in binding order, and the dispatches.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub face_instances: &'a TexelBuffer,
    pub faces: &'a TexelBuffer,
    pub curves: &'a TexelBuffer,
    pub curve_points: &'a TexelBuffer,
    pub curve_instances: &'a TexelBuffer,
    pub strips: &'a TexelBuffer,
    pub segment_starts: &'a TexelBuffer,
    pub row_starts: &'a TexelBuffer,
    pub row_counts: &'a Buffer,
    pub intercepts: &'a Buffer,
    /// `glsl/include/border_cells.glsl`.
    pub border_cells: &'a Buffer,
    /// The sum of each row's crossings, if strips have several bins.
    pub row_windings: Option<&'a Buffer>,
    /// Written by pass `dispatch_arguments`; the first is that of this pass.
    pub dispatches: &'a Buffer,
}

impl Cross {
    /// `bins`: strips of some face have several bins. `marks`: some pass reads the cells that curves cross.
    pub(crate) fn new(device: &Device, bins: bool, marks: bool) -> Result<Self, GpuError> {
        let kernel = |name, insert: bool| {
            let roles =
                [(constant::INSERT, insert), (constant::SCENE_HAS_BINS, bins), (constant::MARKS_BORDERS, marks)];
            Kernel::new(device, name, &shaders::CROSS_COMP, &roles.map(|(name, flag)| (name, u32::from(flag))))
        };
        Ok(Self { count: kernel("cross (count)", false)?, insert: kernel("cross (insert)", true)? })
    }

    /// Counts the intercepts of each row.
    pub(crate) fn count(&self, cmd: &Commands<'_>, b: &Bindings<'_>) {
        Self::record(cmd, &self.count, b);
    }

    /// Stores the intercepts.
    pub(crate) fn insert(&self, cmd: &Commands<'_>, b: &Bindings<'_>) {
        Self::record(cmd, &self.insert, b);
    }

    fn record(cmd: &Commands<'_>, kernel: &Kernel, b: &Bindings<'_>) {
        let resources = [
            b.frame.into(),
            b.face_instances.into(),
            b.faces.into(),
            b.curves.into(),
            b.curve_points.into(),
            b.curve_instances.into(),
            b.strips.into(),
            b.segment_starts.into(),
            b.row_starts.into(),
            b.row_counts.into(),
            b.intercepts.into(),
            b.border_cells.into(),
            // not written without bins
            b.row_windings.unwrap_or(b.frame).into(),
        ];
        kernel.record_indirect(cmd, &resources, (b.dispatches, 0));
    }
}
