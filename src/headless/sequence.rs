//! Pictures one after another, several of them in flight.
//!
//! ```text
//!   slot 0   record 0 ─▶ GPU ─────▶ take 0   record 3 ─▶ …
//!   slot 1      record 1 ─▶ ……… GPU ───▶ take 1   record 4 ─▶ …
//!   slot 2         record 2 ─▶ ………………… GPU ──▶ take 2
//! ```
//!
//! While the GPU draws one picture, the CPU records the next ones and its caller takes the one before, from the memory that
//! the GPU has copied it to. The pictures are those of [`HeadlessRenderer::render`], bit for bit.

use super::renderer::{MOST_RETRIES, TargetImages};
use super::{HeadlessError, HeadlessRenderer, Queue};
use crate::gpu::ReadBack;
use crate::model::Camera;
use crate::picture::{FrameSettings, FrameStats, Outputs};
use crate::renderer::RenderError;

/// Pictures in flight: one that is drawn, one that is recorded, one that is taken.
const IN_FLIGHT: usize = 3;

/// A picture where the GPU has copied it: what it has is empty where it was not wanted.
#[derive(Debug)]
pub struct PictureView<'a> {
    /// Width and height.
    pub size: (u32, u32),
    /// sRGB and opacity, as [`Picture::colour`](crate::picture::Picture::colour).
    pub colour: &'a [[u8; 4]],
    /// As [`Picture::depth`](crate::picture::Picture::depth).
    pub depth: &'a [f32],
    /// As [`Picture::face`](crate::picture::Picture::face).
    pub face: &'a [u32],
    /// As [`Picture::uv`](crate::picture::Picture::uv).
    pub uv: &'a [[f32; 2]],
    /// As [`Picture::normal`](crate::picture::Picture::normal), and 1; 0 for background and where
    /// [`sun`](crate::picture::SceneSettings::sun) does not reach.
    pub normal: &'a [[f32; 4]],
    /// What it cost.
    pub stats: FrameStats,
}

/// A frame slot with a command buffer and images of its own.
struct Flight {
    queue: Queue,
    images: TargetImages,
}

impl HeadlessRenderer {
    /// Renders a picture for each camera, several in flight, and hands each to `take` in their order, with its number. All
    /// are of one size.
    ///
    /// # Errors
    /// [`HeadlessError`]; pictures before were taken.
    ///
    /// # Panics
    /// When no model was uploaded, cameras are of several sizes, or `outputs` has thickness, edges, parts or instances.
    pub fn render_sequence(
        &mut self,
        cameras: &[Camera],
        settings: &FrameSettings,
        outputs: Outputs,
        mut take: impl FnMut(usize, &PictureView<'_>),
    ) -> Result<(), HeadlessError> {
        let Some(first) = cameras.first() else { return Ok(()) };
        assert!(cameras.iter().all(|camera| camera.size == first.size), "cameras of one size");
        assert!(!outputs.thickness && !outputs.has_numbers(), "colour, depth, face, (u, v) and normal alone");
        cameras.iter().try_for_each(|camera| camera.check().map_err(RenderError::from))?;
        self.prepare(first.size, outputs)?;
        self.renderer.add_slots(IN_FLIGHT)?;
        let slots = IN_FLIGHT.min(cameras.len());
        let mut flights = Vec::with_capacity(slots);
        for _ in 0..slots {
            let images = TargetImages::new(self.device.device(), first.size, self.formats, false)?;
            flights.push(Flight { queue: self.device.another_queue()?, images });
        }
        for next in 0..cameras.len() + slots {
            if let Some(nth) = next.checked_sub(slots) {
                let stats = self.finish(&mut flights, nth, (&cameras[nth], settings))?;
                take(nth, &flights[nth % slots].images.view(first.size, outputs, stats));
            }
            if let Some(camera) = cameras.get(next) {
                self.start(&mut flights, next, (camera, settings))?;
            }
        }
        Ok(())
    }

    /// Submits a picture's frame.
    fn start(
        &mut self,
        flights: &mut [Flight],
        nth: usize,
        (camera, settings): (&Camera, &FrameSettings),
    ) -> Result<(), HeadlessError> {
        let slot = nth % flights.len();
        let Flight { queue, images } = &mut flights[slot];
        let (renderer, device) = (&mut *self.renderer, self.device.device());
        queue.start(device, |cmd| images.record(renderer, cmd, (camera, settings), slot))??;
        Ok(())
    }

    /// Waits for it; where something had no room, draws it once more.
    fn finish(
        &mut self,
        flights: &mut [Flight],
        nth: usize,
        view: (&Camera, &FrameSettings),
    ) -> Result<FrameStats, HeadlessError> {
        let slot = nth % flights.len();
        for retries in 0..=MOST_RETRIES {
            flights[slot].queue.finish()?;
            let report = self.renderer.report(slot)?.expect("a frame was recorded");
            if report.complete {
                return Ok(FrameStats { retries, ..report.stats });
            }
            self.start(flights, nth, view)?;
        }
        flights[slot].queue.finish()?;
        Err(HeadlessError::NeverComplete)
    }
}

impl TargetImages {
    fn view(&self, size: (u32, u32), outputs: Outputs, stats: FrameStats) -> PictureView<'_> {
        let count = size.0 as usize * size.1 as usize;
        let aov = |i: usize, wanted: bool| self.aovs.as_ref().map(|aovs| &aovs[i].1).filter(|_| wanted);
        fn slice<T: bytemuck::Pod>(read: Option<&ReadBack>, count: usize) -> &[T] {
            read.map_or(&[], |read| read.slice(count))
        }
        PictureView {
            size,
            colour: self.colour.1.slice(count),
            depth: slice(aov(0, outputs.depth), count),
            face: slice(aov(1, outputs.face), count),
            uv: slice(aov(2, outputs.uv), count),
            normal: slice(aov(3, outputs.normal), count),
            stats,
        }
    }
}
