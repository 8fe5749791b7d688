//! What one pixel of a frame shows, read back with the frame.
//!
//! ```text
//!   pick(x, y) ─▶ the next record copies 16 bytes ─▶ … the slot's fence ─▶ picked(slot) ─▶ Hit, in f64
//! ```

use super::source::Source;
use super::{FrameInput, Renderer};
use crate::frame::Frame;
use crate::frame::pick::PICK_BYTES;
use crate::gpu::{Commands, Device, GpuError, ReadBack};
use crate::model::{Camera, Model};
use crate::scene::{Hit, Picked, Picking};
use glam::{DAffine3, DVec2};
use std::sync::Arc;

/// A pixel that a slot's frame reads back.
pub(super) struct SlotPick {
    words: ReadBack,
    asked: Option<Asked>,
}

impl SlotPick {
    /// The pixel of a frame that never reached the GPU, or that is recorded again.
    pub(super) fn take_back(&mut self) -> Option<(u32, u32)> {
        self.asked.take().map(|asked| asked.at)
    }
}

struct Asked {
    at: (u32, u32),
    camera: Camera,
    picking: Arc<Picking>,
    /// Of the instances, as the frame has them.
    transforms: Vec<DAffine3>,
    /// Of the model's uploads.
    upload: u64,
}

impl Renderer {
    /// Lets the next frame recorded read back what it shows at a pixel: column and row, from the upper left corner. Once
    /// the GPU has finished that frame, [`picked`](Self::picked) has the hit. If the frame lacked room, the one recorded
    /// again into its slot reads it back. Costs 16 bytes of copies, whatever the
    /// model; a still view is not drawn anew for it. The last call before the frame counts.
    pub fn pick(&mut self, x: u32, y: u32) {
        self.pick = Some((x, y));
    }

    /// The pixel of [`pick`](Self::pick), which the next frame then does not read back.
    #[cfg(feature = "headless")]
    pub(crate) fn take_pick(&mut self) -> Option<(u32, u32)> {
        self.pick.take()
    }

    /// What the frame recorded last into `slot` shows at the pixel of [`pick`](Self::pick); it has finished on the GPU.
    /// The hit is the exact point under the pixel's centre, in double precision, of the face that the frame shows
    /// there. What is seen through is no hit: what lies behind it is. With several samples a pixel, the face is that of
    /// one of them.
    ///
    /// `None` where
    /// * the frame was recorded without a call of [`pick`](Self::pick);
    /// * the pixel shows the background or lies beside the picture;
    /// * another model was uploaded or one was removed since, or the device is lost.
    pub fn picked(&self, slot: usize) -> Option<Hit> {
        let slot = &self.slots[slot];
        let pick = slot.pick.as_ref().filter(|_| slot.recorded && !self.device.is_lost())?;
        let asked = pick.asked.as_ref()?;
        let source = self.source.as_ref().filter(|source| source.upload == asked.upload)?;
        let words = pick.words.values::<[u32; 2]>(2);
        asked.hit(&source.model, [words[0], words[1]])
    }
}

impl Asked {
    fn hit(&self, model: &Model, words: [[u32; 2]; 2]) -> Option<Hit> {
        let pixel = DVec2::new(f64::from(self.at.0), f64::from(self.at.1)) + 0.5;
        let of = Picked { model, transforms: &self.transforms, camera: &self.camera, pixel };
        self.picking.hit(&of, words)
    }
}

/// Makes what the next frame's pixel is read back to, where the host wants one.
pub(super) fn make_room(at: Option<(u32, u32)>, slot: &mut Option<SlotPick>, device: &Device) -> Result<(), GpuError> {
    if at.is_some() && slot.is_none() {
        *slot = Some(SlotPick { words: ReadBack::new(device, "pick (read back)", PICK_BYTES)?, asked: None });
    }
    Ok(())
}

/// The frame shows nothing, and reads nothing back.
pub(super) fn skip(slot: &mut Option<SlotPick>) {
    slot.iter_mut().for_each(|slot| slot.asked = None);
}

/// Records the copies, where the host wants some of this frame.
pub(super) fn record(
    at: Option<(u32, u32)>,
    slot: &mut Option<SlotPick>,
    (cmd, frame): (&Commands<'_>, &Frame<'_>),
    (source, picking, input): (&Source, &Arc<Picking>, &FrameInput<'_>),
) {
    let Some(slot) = slot else { return };
    slot.asked = None;
    let (width, height) = input.camera.size;
    let Some(at) = at.filter(|(x, y)| *x < width && *y < height) else { return };
    frame.pick(cmd, at, &slot.words);
    let transforms = source.model.instances.iter().map(|instance| instance.transform).collect();
    let (camera, picking) = (*input.camera, Arc::clone(picking));
    slot.asked = Some(Asked { at, camera, picking, transforms, upload: source.upload });
}
