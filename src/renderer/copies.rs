//! Copies of the scene's arrays and of edits that are more than staging memory holds.
//!
//! ```text
//!   record ──▶ all that waits fits ──▶ the copies, and the frame
//!        ╰───▶ it does not ──────────▶ as many copies as fit, and the background ──▶ report: waiting ──▶ record …
//! ```
//!
//! All frames in flight share the staging memory: each has the same part of it, so every frame copies something, and
//! none waits. A frame that fails has copied nothing: its copies wait on.

use super::{FrameInput, Loaded, Renderer, Retired, constants, pick, rectangle};
use crate::frame::Frame;
use crate::frame::counts::Counts;
use crate::gpu::{Access, Buffer, Commands, GpuError, Staging, Uploads};
use crate::scene::{Scene, Write};

/// Copies that a frame has recorded.
pub(super) struct Copied {
    new: Option<NewScene>,
    staging: Staging,
    /// Bytes that wait on.
    waiting: u64,
}

/// A scene whose buffers were just made, and the copies that wait on.
pub(super) type NewScene = (Scene, Uploads<'static>);

impl Copied {
    /// Not all arrays are in the copies.
    pub(super) fn waits(&self) -> bool {
        self.waiting > 0
    }

    /// What is left of `most` bytes of staging memory, a multiple of [`Buffer::LEAST_BYTES`] as `most` is.
    pub(super) fn left(&self, most: u64) -> u64 {
        most.saturating_sub(self.staging.bytes().next_multiple_of(Buffer::LEAST_BYTES))
    }

    pub(super) fn into_parts(self) -> (Option<NewScene>, Staging) {
        (self.new, self.staging)
    }
}

impl Loaded {
    /// Records copies of arrays that the GPU does not have yet, at most `most` bytes; makes their buffers, where there
    /// are none.
    pub(super) fn copy(&self, cmd: &Commands<'_>, most: u64) -> Result<Copied, GpuError> {
        let record = |uploads: &Uploads<'_>| {
            let staging = uploads.record(cmd, "scene", most)?;
            staging.finish(cmd, Access::COMPUTE_READ | Access::VERTEX_READ | Access::FRAGMENT_READ);
            Ok::<_, GpuError>(staging)
        };
        if self.scene.is_some() {
            let staging = record(&self.waiting)?;
            let waiting = self.waiting.bytes() - staging.bytes();
            return Ok(Copied { new: None, staging, waiting });
        }
        let (scene, mut uploads) = Scene::new(cmd.device(), &self.data)?;
        let staging = record(&uploads)?;
        uploads.advance(&staging);
        let waiting = uploads.bytes();
        Ok(Copied { new: Some((scene, uploads.into_owned())), staging, waiting })
    }

    /// The frame with these copies is recorded.
    pub(super) fn keep(&mut self, new: Option<NewScene>, recorded: &Staging) {
        match new {
            None => self.waiting.advance(recorded),
            Some((scene, waiting)) => {
                (self.scene, self.waiting) = (Some(scene), waiting);
                self.data.drop_uploaded();
            }
        }
    }

    /// Bytes of edits and changes that the GPU does not have yet.
    pub(super) fn edit_bytes(&self) -> u64 {
        self.edits.iter().chain(self.changes.values()).map(|write| write.bytes.len() as u64).sum()
    }
}

impl Renderer {
    /// Most bytes of staging memory of one frame.
    pub(super) fn most_staging(&self) -> u64 {
        let share = self.device.staging_bytes() / self.slots.len() as u64;
        (share / Buffer::LEAST_BYTES).max(1) * Buffer::LEAST_BYTES
    }

    /// Records a frame of copies that draws the background alone. Where no arrays wait, it copies edits, at most `most`
    /// bytes of them.
    pub(super) fn record_copies(
        &mut self,
        cmd: &Commands<'_>,
        input: &FrameInput<'_>,
        copied: Copied,
        most: u64,
    ) -> Result<(), GpuError> {
        let Some(loaded) = &mut self.loaded else { unreachable!("its arrays are copied") };
        let slot = &mut self.slots[input.slot];
        let (new, staging) = copied.into_parts();
        slot.edit_bytes = 0;
        if let (Some(scene), None, 0) = (&mut loaded.scene, &new, staging.bytes()) {
            // in the order in which they would be copied with a frame
            loaded.edits.extend(std::mem::take(&mut loaded.changes).into_values());
            let (recorded, replaced) = Frame::edit(cmd, scene, loaded.edits.iter(), most)?;
            forget(&mut loaded.edits, scene, recorded.bytes());
            slot.edit_bytes = recorded.bytes();
            slot.retired.push(Retired::Staging(recorded));
            slot.retired.extend(replaced.into_iter().map(Retired::Array));
        }
        // nothing fails from here on
        loaded.keep(new, &staging);
        slot.retired.push(Retired::Staging(staging));
        slot.copies = Some(loaded.waiting.bytes() + loaded.edit_bytes());
        // the frame after it draws anew, and checks first that its lists have room
        loaded.history = None;
        slot.times.reset(cmd);
        let background = input.settings.background.map(|_| constants::background(input, &self.formats));
        match self.viewport.as_ref().zip(input.targets.corner) {
            None => input.targets.clear(cmd, background),
            Some((viewport, corner)) => {
                let pairs = viewport.pairs(&input.targets);
                rectangle::begin(cmd, &pairs, corner, background.is_none());
                viewport.targets(&input.targets).clear(cmd, background);
                rectangle::end(cmd, &pairs, corner);
            }
        }
        pick::skip(&mut slot.pick);
        (slot.recorded, slot.reused, slot.capacities) = (true, false, None);
        (slot.size, slot.counts) = (input.camera.size, Counts::default());
        (slot.shadow_deviation, slot.bands, slot.solid_bytes) = (0.0, 0, Vec::new());
        self.order.retain(|slot| *slot != input.slot);
        self.order.push(input.slot);
        Ok(())
    }
}

/// Takes the first bytes, which were recorded, from the writes, and writes to arrays that the scene does not have.
fn forget(edits: &mut Vec<Write>, scene: &Scene, recorded: u64) {
    let mut left = recorded as usize;
    edits.retain_mut(|write| {
        let length = scene.buffer(write.to).map_or(0, |_| write.bytes.len());
        let done = length.min(left);
        left -= done;
        write.bytes.drain(..done);
        write.offset += done as u64;
        done < length
    });
}
