//! A device, the model that it holds, and pictures of it: one at a time, or several in flight.
//!
//! ```text
//!   draw          load the model, if it is another ─▶ render ─▶ backdrop
//!   draw_stream   next ─▶ frame ─▶ GPU ─▶ backdrop ─▶ take
//!                    next ─▶ frame ─▶ ……… GPU ─▶ backdrop ─▶ take      jobs that differ in the camera alone
//! ```

use crate::backdrop::Backdrop;
use crate::error::{JobError, Stop};
use crate::limits::{Limits, Step, Work};
use selvedge::headless::{HeadlessError, HeadlessOptions, HeadlessRenderer, Watch};
use selvedge::model::{Camera, Model};
use selvedge::picture::{FrameSettings, Outputs, Picture, SceneSettings};
use std::sync::Arc;
use std::time::Instant;

/// The device, and its validation.
pub type DeviceOptions = HeadlessOptions;

/// Larger pictures, in pixels, are drawn one at a time: with all images, three of this size take 2.4 GiB on the device
/// and in host memory.
pub const MOST_IN_FLIGHT: u64 = 1 << 24;

/// One picture to be drawn.
#[derive(Clone, Debug)]
pub struct Job {
    /// The model. A model that is drawn again in the same scene settings is not uploaded again.
    pub model: Arc<Model>,
    /// The camera.
    pub camera: Camera,
    /// How the model is prepared.
    pub scene: SceneSettings,
    /// How the frame is drawn; its background is that of [`Job::backdrop`].
    pub frame: FrameSettings,
    /// Images beside the colour.
    pub outputs: Outputs,
    /// The background.
    pub backdrop: Backdrop,
    /// Bounds of the work on the model's file, which its jobs share. They are tested where [`Stop`] is, and after the
    /// picture; of pictures in flight, those of the first one.
    pub limits: Limits,
}

impl Job {
    fn scene_settings(&self) -> SceneSettings {
        SceneSettings { thickness: self.scene.thickness || self.outputs.thickness, ..self.scene }
    }

    fn frame_settings(&self) -> FrameSettings {
        FrameSettings { background: Some(self.backdrop.colour()), ..self.frame }
    }

    /// Whether its picture, on nothing but the background's colour, certainly shows nothing.
    fn is_blank(&self, picture: &Picture) -> bool {
        if self.outputs.face {
            return picture.face.iter().all(|face| *face == 0);
        }
        self.backdrop.colour()[3] == 0.0 && picture.colour.iter().all(|[.., opacity]| *opacity == 0)
    }

    /// Pixels of the picture.
    pub(crate) fn pixels(&self) -> u64 {
        u64::from(self.camera.size.0) * u64::from(self.camera.size.1)
    }

    /// Whether the two differ in the camera alone, so that their frames may be in flight together.
    pub(crate) fn goes_with(&self, other: &Self) -> bool {
        let of = |job: &Self| (job.scene, job.frame, job.outputs, job.backdrop);
        Arc::ptr_eq(&self.model, &other.model) && of(self) == of(other)
    }
}

/// A picture, and the time that it took.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The picture.
    pub picture: Picture,
    /// Seconds of its model's upload, before the model's first picture.
    pub upload_s: f64,
    /// Seconds of the picture; with frames in flight, since the picture before.
    pub draw_s: f64,
    /// No pixel shows anything of the model. Known where the picture has the image of faces, or a background that hides
    /// nothing; else `false`.
    pub blank: bool,
}

/// A model that the renderer holds.
struct Uploaded {
    model: Arc<Model>,
    scene: SceneSettings,
    seconds: f64,
}

/// A device, and the model that it holds.
pub struct Drawer {
    renderer: HeadlessRenderer,
    loaded: Option<Uploaded>,
    /// Messages of the validation layer that were reported.
    told: usize,
    /// Larger pictures are drawn one at a time.
    most_in_flight: u64,
}

impl Drawer {
    /// Opens the device.
    ///
    /// # Errors
    /// [`JobError::Device`].
    pub fn new(options: &DeviceOptions) -> Result<Self, JobError> {
        let renderer = HeadlessRenderer::new(options).map_err(JobError::Device)?;
        // messages of the layer name no picture: what is said while one is drawn alone is about that one
        let most_in_flight = if options.validation { 0 } else { MOST_IN_FLIGHT };
        Ok(Self { renderer, loaded: None, told: 0, most_in_flight })
    }

    /// Draws one picture. [`Stop`] is tested before it begins, between two faces of an upload and between two frames of a
    /// picture that needs several: it unwinds to [`guarded`](crate::guarded). A message of the validation layer is an
    /// error.
    ///
    /// # Errors
    /// [`JobError`]; the next job is drawn all the same.
    pub fn draw(&mut self, job: &Job, stop: &Stop) -> Result<Drawn, JobError> {
        job.camera.check()?;
        if stop.is_set() {
            return Err(JobError::Stopped);
        }
        let upload_s = self.load(job, stop)?;
        let step = Arc::new(job.limits.begin(Work::Drawing));
        step.test()?;
        self.watch(stop, &step);
        let begun = Instant::now();
        let mut picture = self.renderer.render(&job.camera, &job.frame_settings(), job.outputs)?;
        step.test()?;
        let blank = job.is_blank(&picture);
        job.backdrop.under(picture.size, &mut picture.colour);
        let drawn = Drawn { picture, upload_s, draw_s: begun.elapsed().as_secs_f64(), blank };
        let messages = self.renderer.messages();
        let new = messages.get(self.told..).filter(|new| !new.is_empty()).map(|new| new.join("; "));
        self.told = messages.len();
        new.map_or(Ok(drawn), |new| Err(JobError::Validation(new)))
    }

    /// Lets a picture unwind to [`guarded`](crate::guarded) between two of its frames.
    fn watch(&mut self, stop: &Stop, step: &Arc<Step>) {
        // the step ends with the picture
        let (stop, step) = (stop.clone(), Arc::downgrade(step));
        self.renderer.set_watch(Some(Arc::new(move || {
            stop.check();
            step.upgrade().iter().for_each(|step| step.check());
        })));
    }

    /// Uploads the job's model, if it is not there; returns the seconds that its upload took.
    ///
    /// # Errors
    /// [`JobError::Draw`], [`JobError::Limit`].
    pub(crate) fn load(&mut self, job: &Job, stop: &Stop) -> Result<f64, JobError> {
        self.renderer.set_watch(None); // that of the picture before
        let scene = job.scene_settings();
        let is_there = |loaded: &&Uploaded| Arc::ptr_eq(&loaded.model, &job.model) && loaded.scene == scene;
        if let Some(loaded) = self.loaded.as_ref().filter(is_there) {
            return Ok(loaded.seconds);
        }
        self.loaded = None;
        let step = job.limits.begin(Work::Preparing);
        step.test()?;
        let begun = Instant::now();
        let between_faces = |_: usize| {
            stop.check();
            step.check();
        };
        self.renderer.expect(job.outputs);
        self.renderer.upload_shared(Arc::clone(&job.model), scene, &between_faces)?;
        let seconds = begun.elapsed().as_secs_f64();
        self.loaded = Some(Uploaded { model: Arc::clone(&job.model), scene, seconds });
        Ok(seconds)
    }

    /// Most pixels of pictures that are in flight together; 0: all pictures are drawn one at a time.
    pub(crate) fn most_in_flight(&self) -> u64 {
        self.most_in_flight
    }

    /// Pictures of so many pixels did not fit into memory together.
    pub(crate) fn did_not_fit(&mut self, pixels: u64) {
        self.most_in_flight = self.most_in_flight.min(pixels.saturating_sub(1));
    }

    /// Draws pictures like that of `job`, whose model is [loaded](Self::load), with frames in flight: see
    /// [`HeadlessRenderer::render_stream`]. `watch` may unwind to [`guarded`](crate::guarded) between two frames of a
    /// picture.
    ///
    /// # Errors
    /// [`JobError::Draw`]; pictures in flight are not taken.
    pub(crate) fn draw_stream(
        &mut self,
        (job, upload_s): (&Job, f64),
        watch: Watch,
        next: impl FnMut() -> Option<Camera>,
        mut take: impl FnMut(Drawn),
    ) -> Result<(), JobError> {
        self.renderer.set_watch(Some(watch));
        let mut begun = Instant::now();
        self.renderer.render_stream(&job.frame_settings(), job.outputs, next, |_, view| {
            let mut picture = view.to_picture();
            let blank = job.is_blank(&picture);
            job.backdrop.under(picture.size, &mut picture.colour);
            take(Drawn { picture, upload_s, draw_s: begun.elapsed().as_secs_f64(), blank });
            begun = Instant::now();
            Ok::<_, HeadlessError>(())
        })?;
        Ok(())
    }
}
