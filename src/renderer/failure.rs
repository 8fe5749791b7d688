//! What a renderer does after the loss of a device or of a frame.
//!
//! ```text
//!   a call returns DEVICE_LOST ─▶ every later call returns GpuError::DeviceLost; drop frees handles and host memory
//!   the handle is not valid    ─▶ abandon: drop frees only host memory
//!   a frame was not submitted  ─▶ discard: the next frame loads the model anew
//! ```

use super::pick::SlotPick;
use super::{Loaded, RenderError, Renderer};

impl Renderer {
    /// A call of the host's own returned `VK_ERROR_DEVICE_LOST`: every later call returns
    /// [`GpuError::DeviceLost`](crate::gpu::GpuError::DeviceLost). The host need not report errors of the renderer's
    /// calls.
    ///
    /// The drop of the renderer then only frees handles. Vulkan allows that on a lost device, and demands it before
    /// `vkDestroyDevice` (1.3, section 5.2.3, "Lost Device").
    pub fn device_lost(&mut self) {
        self.device.set_lost("a call of the host", "device");
    }

    /// The device's handle is not valid any more. From now on the drop of the renderer makes no Vulkan call and frees
    /// only host memory.
    pub fn abandon(&mut self) {
        self.device_lost();
        self.device.abandon();
    }

    /// The frame recorded last, into `slot`, never reached the GPU: the host reset its command buffer, or the
    /// submission failed. The next [`record`](Self::record) loads the model anew, with every edit and change so far,
    /// because the GPU does not have what the frame would have copied. It also reads back the pixel of a
    /// [`pick`](Self::pick) that the frame would have read back.
    ///
    /// # Panics
    /// When the slot does not exist.
    pub fn discard(&mut self, slot: usize) {
        let discarded = &mut self.slots[slot];
        discarded.recorded = false;
        discarded.capacities = None;
        self.stale = self.source.is_some();
        let asked = discarded.pick.as_mut().and_then(SlotPick::take_back);
        self.pick = self.pick.or(asked);
        self.order.retain(|other| *other != slot);
        // frames in flight may use what it replaced
        let retired = std::mem::take(&mut self.slots[slot].retired);
        retired.into_iter().for_each(|what| self.retire(what));
    }

    /// Loads the source anew, where a frame was discarded.
    pub(super) fn reload(&mut self) -> Result<(), RenderError> {
        self.device.alive()?;
        let (true, Some(source)) = (self.stale, &mut self.source) else { return Ok(()) };
        let loaded = Loaded::new(&self.device, self.formats, source, (None, source.request), &|_| ())?;
        source.is_whole();
        self.replace(loaded);
        self.stale = false;
        Ok(())
    }

    /// Remembers an error that the device does not survive.
    pub(super) fn noting<T>(&self, result: Result<T, RenderError>) -> Result<T, RenderError> {
        result.inspect_err(|error| error.gpu().into_iter().for_each(|error| self.device.note(error)))
    }
}
