//! Reads back the visibility words of one pixel.
//!
//! ```text
//!   visibility, others ──a pixel of each──▶ host, after the fence
//! ```

use super::Frame;
use crate::gpu::{Access, Commands, ReadBack, barrier};

/// Bytes of a pixel of one of the images.
const PIXEL_BYTES: u64 = 8;
/// Bytes of a pixel of both images.
pub(crate) const PICK_BYTES: u64 = 2 * PIXEL_BYTES;

impl Frame<'_> {
    /// After the frame: copies the words of a pixel. The next frame may reuse the images.
    pub(crate) fn pick(&self, cmd: &Commands<'_>, at: (u32, u32), into: &ReadBack) {
        let read = Access::COMPUTE_READ | Access::FRAGMENT_READ;
        let v = &self.stages.visibility;
        barrier::memory(cmd, read, Access::TRANSFER_READ);
        into.record_pixels(cmd, &[&v.image, v.of_meshes_and_solids()], at, PIXEL_BYTES);
        barrier::memory(cmd, Access::TRANSFER_READ, read);
    }
}
