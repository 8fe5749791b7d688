//! Edits of trim loops, before everything else of a frame.
//!
//! ```text
//!   frames before ──read──▶ patches, cells, curves, control points ◀──copies of what was edited
//! ```

use super::Frame;
use crate::gpu::{Access, Buffer, Commands, GpuError, Uploads, barrier};
use crate::scene::{EditTarget, Scene, Trims, Write};

impl Frame<'_> {
    /// Records the copies. The returned [`Uploads`] must live until the GPU has made them.
    pub(crate) fn edit(cmd: &Commands<'_>, scene: &Scene, writes: &[Write]) -> Result<Uploads, GpuError> {
        let mut uploads = Uploads::new();
        let reads = Access::COMPUTE_READ | Access::VERTEX_READ | Access::FRAGMENT_READ;
        let copied = Access { layout: reads.layout, ..Access::TRANSFER_WRITE };
        barrier::memory(cmd, reads, copied);
        for write in writes {
            if let Some(target) = target(scene, write.to) {
                uploads.write(cmd, target, write.offset, &write.bytes)?;
            }
        }
        uploads.finish(cmd, reads);
        Ok(uploads)
    }
}

/// `None` where another way than the table trims: such a scene is never edited.
fn target(scene: &Scene, to: EditTarget) -> Option<&Buffer> {
    let Some(Trims::Table(trims)) = &scene.trims else { return None };
    Some(match to {
        EditTarget::Patches => &scene.patches,
        EditTarget::Cells => &trims.cells,
        EditTarget::Curves => &trims.curves,
        EditTarget::CurvePoints => &trims.curve_points,
    })
}
