//! Copies edits of trim loops and of placed parts, and models that join the scene, at the beginning of a frame.
//!
//! ```text
//!   frames before ──read──▶ the scene's arrays ◀──copies of edited data, and of models that join
//!                                │                                 ▲
//!                                ╰──copy, where there is no room──▶ larger arrays
//! ```

use crate::frame::Frame;
use crate::gpu::{Access, Commands, GpuError, Staging, Uploads, barrier};
use crate::scene::{Array, Scene, Write};

impl Frame<'_> {
    /// Records copies of the first bytes of the writes, at most `most`. The returned [`Staging`], and the arrays that
    /// larger ones replaced, must live until the GPU has made them. After an error the scene is as it was. Writes to
    /// arrays that the scene does not have are passed over.
    pub(crate) fn edit<'w>(
        cmd: &Commands<'_>,
        scene: &mut Scene,
        writes: impl Iterator<Item = &'w Write> + Clone,
        most: u64,
    ) -> Result<(Staging, Vec<Array>), GpuError> {
        let larger = scene.larger(writes.clone())?;
        let mut uploads = Uploads::new();
        let reads = Access::COMPUTE_READ | Access::VERTEX_READ | Access::FRAGMENT_READ;
        let copied = Access::TRANSFER_WRITE;
        if larger.is_empty() {
            barrier::memory(cmd, reads, copied);
        } else {
            barrier::memory(cmd, reads | copied, copied | Access::TRANSFER_READ);
        }
        for (of, array) in &larger {
            let before = scene.buffer(*of).into_iter();
            before.for_each(|before| cmd.copy(before, 0, array.buffer(), 0, before.bytes()));
        }
        if !larger.is_empty() {
            // the last bytes of what was copied are beyond its end, and are written below
            barrier::memory(cmd, copied, copied);
        }
        let target = |write: &Write| larger.get(&write.to).map(Array::buffer).or_else(|| scene.buffer(write.to));
        for (target, write) in writes.filter_map(|write| Some((target(write)?, write))) {
            uploads.write(target, write.offset, &write.bytes);
        }
        let staging = uploads.record(cmd, "edits", most)?;
        staging.finish(cmd, reads);
        let replaced = larger.into_iter().map(|(of, array)| scene.replace(of, array)).collect();
        Ok((staging, replaced))
    }
}
