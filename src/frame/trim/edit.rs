//! Copies edits of trim loops and of placed parts, at the beginning of a frame.
//!
//! ```text
//!   frames before ──read──▶ patches, curves, arcs and their cells; placed parts ◀──copies of edited data
//! ```

use crate::frame::Frame;
use crate::gpu::{Access, Buffer, Commands, GpuError, Uploads, barrier};
use crate::scene::{EditTarget, Scene, Trims, Write};

impl Frame<'_> {
    /// Records the copies. The returned [`Uploads`] must live until the GPU has made them.
    pub(crate) fn edit(cmd: &Commands<'_>, scene: &Scene, writes: &[Write]) -> Result<Uploads, GpuError> {
        let mut uploads = Uploads::new();
        let reads = Access::COMPUTE_READ | Access::VERTEX_READ | Access::FRAGMENT_READ;
        let copied = Access::TRANSFER_WRITE;
        barrier::memory(cmd, reads, copied);
        let copies = writes.iter().filter_map(|w| Some((target(scene, w.to)?, w.offset, w.bytes.as_slice())));
        uploads.scatter(cmd, "edits", &copies.collect::<Vec<_>>())?;
        uploads.finish(cmd, reads);
        Ok(uploads)
    }
}

/// The buffer to write; `None` if the scene uses another way to trim than the edit's, which does not happen.
fn target(scene: &Scene, to: EditTarget) -> Option<&Buffer> {
    if to == EditTarget::Instances {
        return Some(&scene.instances);
    }
    match (to, scene.trims.as_ref()?) {
        (EditTarget::Patches, _) => Some(&scene.patches),
        (EditTarget::Cells, Trims::Table(trims)) => Some(&trims.cells),
        (EditTarget::Curves, Trims::Table(trims)) => Some(&trims.curves),
        (EditTarget::CurvePoints, Trims::Table(trims)) => Some(&trims.curve_points),
        (EditTarget::Exact(array), Trims::Exact(trims)) => Some(*trims.all().get(array)?),
        _ => None,
    }
}
