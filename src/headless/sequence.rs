//! Pictures one after another, several in flight.
//!
//! ```text
//!   flight 0   record 0 ─▶ GPU ─────▶ take 0 ─▶ record 3 ─▶ …
//!   flight 1      record 1 ─▶ ……… GPU ─────▶ take 1 ─▶ record 4 ─▶ …
//!   flight 2         record 2 ─▶ …………………… GPU ─────▶ take 2 ─▶ …
//! ```
//!
//! While the GPU draws a picture, the CPU takes the one before and records the one after. Each flight is a frame slot of
//! the renderer with a command buffer, images and host memory of its own, so a picture is read where the GPU copied it.
//! A frame that lacked room, or that copied a part of the scene instead of drawing it, is drawn again before its picture is
//! taken; frames that are in flight by then go on.

use super::images::{Kind, PictureView, TargetImages};
use super::queue::Submission;
use super::{HeadlessDevice, HeadlessError, HeadlessRenderer};
use crate::gpu::GpuError;
use crate::model::Camera;
use crate::picture::{FrameSettings, FrameStats, Outputs};
use crate::renderer::RenderError;
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

/// A frame is recorded again when a buffer was too small; each time they grow to what was needed, so
/// more than a few rounds mean that something else is wrong.
const MOST_RETRIES: u32 = 8;
/// Pictures in flight: one is taken, one is drawn, one waits, so that the GPU is never idle.
const MOST_FLIGHTS: usize = 3;

/// A frame slot's command buffer and images. Dropped in this order: the GPU finishes first.
pub(super) struct Flight {
    submission: Submission,
    images: Option<TargetImages>,
}

impl Flight {
    pub(super) fn new(device: &HeadlessDevice) -> Result<Self, GpuError> {
        Ok(Self { submission: device.submission()?, images: None })
    }
}

/// What a frame shows.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) camera: &'a Camera,
    pub(super) settings: &'a FrameSettings,
    pub(super) outputs: Outputs,
}

fn checked(camera: &Camera) -> Result<(), HeadlessError> {
    Ok(camera.check().map_err(RenderError::from)?)
}

impl HeadlessRenderer {
    /// Renders a picture for each camera with several frames in flight, and hands each picture to `take` with its
    /// index, in the order of the cameras. The pictures are those of [`render`](Self::render), bit for bit. A pixel of
    /// [`pick`](Self::pick) waits for the next `render`.
    ///
    /// Three pictures are in memory at a time, each in an image on the device and in a buffer that the CPU caches. `take`
    /// reads the buffer itself; [`PictureView::to_picture`] copies it once. While `take` runs, the GPU draws the next
    /// two pictures. Then the memory of all but one is freed.
    ///
    /// # Errors
    /// [`HeadlessError`], or that of `take`. The sequence then ends: pictures before were taken, no later one is, and the
    /// GPU has finished every frame.
    ///
    /// # Panics
    /// When no model was uploaded.
    ///
    /// # Example
    /// ```no_run
    /// use selvedge::headless::{HeadlessError, HeadlessRenderer};
    /// use selvedge::picture::{FrameSettings, Outputs};
    /// # fn brightest(renderer: &mut HeadlessRenderer, cameras: &[selvedge::model::Camera]) -> Result<(), HeadlessError> {
    /// let mut means = Vec::new();
    /// renderer.render_sequence(cameras, &FrameSettings::default(), Outputs::default(), |_, picture| {
    ///     let green: u64 = picture.colour.iter().map(|pixel| u64::from(pixel[1])).sum();
    ///     means.push(green / picture.colour.len() as u64);
    ///     Ok::<_, HeadlessError>(())
    /// })?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn render_sequence<E: From<HeadlessError>>(
        &mut self,
        cameras: &[Camera],
        settings: &FrameSettings,
        outputs: Outputs,
        take: impl FnMut(usize, &PictureView<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        cameras.iter().try_for_each(checked)?;
        let mut left = cameras.iter().copied();
        self.fly(MOST_FLIGHTS.min(cameras.len()), (settings, outputs), || left.next(), take)
    }

    /// As [`render_sequence`](Self::render_sequence), of cameras that come while pictures are drawn. `next` returns the
    /// camera of the next picture, or `None` if there is none yet. It is called before each picture is waited for,
    /// until three are in flight. The sequence ends when `next` returns `None` and no picture is in flight.
    ///
    /// # Errors
    /// [`HeadlessError`], or that of `take`. The sequence then ends: pictures in flight are finished and not taken.
    ///
    /// # Panics
    /// When no model was uploaded.
    pub fn render_stream<E: From<HeadlessError>>(
        &mut self,
        settings: &FrameSettings,
        outputs: Outputs,
        next: impl FnMut() -> Option<Camera>,
        take: impl FnMut(usize, &PictureView<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.fly(MOST_FLIGHTS, (settings, outputs), next, take)
    }

    /// Draws pictures with so many flights. Then frees all but one; also if the watch, `next` or `take` unwinds.
    fn fly<E: From<HeadlessError>>(
        &mut self,
        flights: usize,
        (settings, outputs): (&FrameSettings, Outputs),
        next: impl FnMut() -> Option<Camera>,
        take: impl FnMut(usize, &PictureView<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let pick = self.renderer.take_pick();
        let drawn = catch_unwind(AssertUnwindSafe(|| self.sequence(flights, (settings, outputs), next, take)));
        let landed = self.land();
        if let Some((x, y)) = pick {
            self.renderer.pick(x, y);
        }
        match drawn {
            Ok(drawn) => drawn?,
            Err(cause) => resume_unwind(cause),
        }
        Ok(landed?)
    }

    fn sequence<E: From<HeadlessError>>(
        &mut self,
        flights: usize,
        (settings, outputs): (&FrameSettings, Outputs),
        mut next: impl FnMut() -> Option<Camera>,
        mut take: impl FnMut(usize, &PictureView<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.prepare(outputs)?;
        self.add_flights(flights)?;
        // the n-th picture is drawn in flight n % flights
        let (mut begun, mut in_flight) = (0, VecDeque::with_capacity(flights));
        loop {
            while in_flight.len() < flights {
                let Some(camera) = next() else { break };
                checked(&camera)?;
                self.start(begun % flights, View { camera: &camera, settings, outputs })?;
                in_flight.push_back(camera);
                begun += 1;
            }
            let nth = begun - in_flight.len();
            let Some(camera) = in_flight.pop_front() else { return Ok(()) };
            let stats = self.finish(nth % flights, View { camera: &camera, settings, outputs })?;
            take(nth, &self.view(nth % flights, outputs, stats))?;
        }
    }

    /// Makes flights up to this number.
    fn add_flights(&mut self, count: usize) -> Result<(), HeadlessError> {
        self.noting(|this| {
            while this.flights.len() < count {
                let flight = Flight::new(&this.device)?;
                this.flights.push(flight);
            }
            Ok(this.renderer.set_slots(this.flights.len())?)
        })
    }

    /// Waits for every flight, and frees all but the first.
    pub(super) fn land(&mut self) -> Result<(), HeadlessError> {
        self.noting(|this| {
            // all are waited for, whatever becomes of one: on a lost device that ends, too (Vulkan 1.3, section 5.2.3)
            let waited: Vec<_> = this.flights.iter_mut().map(|flight| flight.submission.finish()).collect();
            this.flights.truncate(1);
            this.renderer.set_slots(1)?;
            Ok(waited.into_iter().collect::<Result<(), _>>()?)
        })
    }

    /// Records a flight's frame and submits it. The frame before in it has finished.
    pub(super) fn start(&mut self, flight: usize, view: View<'_>) -> Result<(), HeadlessError> {
        let kind = Kind { size: view.camera.size, formats: self.formats, thickness: view.outputs.thickness };
        self.noting(|this| {
            let Flight { submission, images } = &mut this.flights[flight];
            let images = TargetImages::fitting(images, this.device.device(), kind)?;
            let renderer = &mut *this.renderer;
            let submitted = submission.start(|cmd| images.record(renderer, cmd, (view.camera, view.settings), flight));
            if submitted.is_err() {
                this.renderer.discard(flight);
            }
            Ok(submitted??)
        })
    }

    /// Waits for a flight's frame. While one lacked room, or the scene was copied first, it is drawn again.
    pub(super) fn finish(&mut self, flight: usize, view: View<'_>) -> Result<FrameStats, HeadlessError> {
        let (mut retries, mut edit_bytes) = (0, 0);
        loop {
            let report = self.noting(|this| {
                this.flights[flight].submission.finish()?;
                Ok(this.renderer.report(flight)?.expect("a frame was recorded"))
            })?;
            edit_bytes += report.stats.edit_bytes;
            if report.complete {
                return Ok(FrameStats { retries, edit_bytes, ..report.stats });
            }
            // each frame of copies leaves less to copy
            retries += u32::from(report.waiting.is_none());
            if retries > MOST_RETRIES {
                return Err(HeadlessError::NeverComplete);
            }
            self.pause();
            self.start(flight, view)?;
        }
    }

    /// A flight's picture, which has finished.
    pub(super) fn view(&self, flight: usize, outputs: Outputs, stats: FrameStats) -> PictureView<'_> {
        let Some(images) = &self.flights[flight].images else { unreachable!("drawn before") };
        let has_sun = self.renderer.source().is_some_and(|source| source.request().sun.is_some());
        images.view(outputs, stats, has_sun)
    }

    /// Remembers an error that the device does not survive.
    pub(super) fn noting<T>(
        &mut self,
        make: impl FnOnce(&mut Self) -> Result<T, HeadlessError>,
    ) -> Result<T, HeadlessError> {
        let made = make(self);
        made.inspect_err(|error| error.gpu().into_iter().for_each(|error| self.device.device().note(error)))
    }
}
