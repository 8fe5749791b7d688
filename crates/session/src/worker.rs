//! A thread that owns a device and draws one job after another.
//!
//! ```text
//!   caller ──Job──▶ channel ──▶ thread: upload if the model or its scene is another; draw ──Ticket──▶ caller
//! ```
//!
//! Jobs are drawn in the order in which they came, whichever threads sent them. The caller's wait is independent of the
//! driver, so a caller may handle signals while a frame is drawn.

use crate::backdrop::Backdrop;
use crate::error::{SessionError, Stop, guarded};
use selvedge::headless::{HeadlessOptions, HeadlessRenderer};
use selvedge::model::{Camera, Model};
use selvedge::picture::{FrameSettings, Outputs, Picture, SceneSettings};
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// The device, and its validation.
pub type DeviceOptions = HeadlessOptions;

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
}

/// A device, and the model that it holds.
pub struct Drawer {
    renderer: HeadlessRenderer,
    loaded: Option<(Arc<Model>, SceneSettings)>,
    /// Messages of the validation layer that were reported.
    told: usize,
}

impl Drawer {
    /// Opens the device.
    ///
    /// # Errors
    /// [`SessionError::Device`].
    pub fn new(options: &DeviceOptions) -> Result<Self, SessionError> {
        Ok(Self { renderer: HeadlessRenderer::new(options).map_err(SessionError::Device)?, loaded: None, told: 0 })
    }

    /// Draws one picture. [`Stop`] is tested before it begins and between two faces of an upload. A message of the
    /// validation layer is an error.
    ///
    /// # Errors
    /// [`SessionError`]; the next job is drawn all the same.
    pub fn draw(&mut self, job: &Job, stop: &Stop) -> Result<Picture, SessionError> {
        job.camera.check()?;
        if stop.is_set() {
            return Err(SessionError::Stopped);
        }
        let scene = SceneSettings { thickness: job.scene.thickness || job.outputs.thickness, ..job.scene };
        let is_there = |(model, known): &(Arc<Model>, SceneSettings)| Arc::ptr_eq(model, &job.model) && *known == scene;
        if !self.loaded.as_ref().is_some_and(is_there) {
            self.loaded = None;
            self.renderer.upload_shared(Arc::clone(&job.model), scene, &|_| stop.check())?;
            self.loaded = Some((Arc::clone(&job.model), scene));
        }
        let frame = FrameSettings { background: Some(job.backdrop.colour()), ..job.frame };
        let mut picture = self.renderer.render(&job.camera, &frame, job.outputs)?;
        job.backdrop.under(picture.size, &mut picture.colour);
        let messages = self.renderer.messages();
        let new = messages.get(self.told..).filter(|new| !new.is_empty()).map(|new| new.join("; "));
        self.told = messages.len();
        new.map_or(Ok(picture), |new| Err(SessionError::Validation(new)))
    }
}

type Answer = Result<Picture, SessionError>;

/// A job on its way.
struct Order {
    job: Box<Job>,
    stop: Stop,
    answer: Sender<Answer>,
}

/// A picture that is not drawn yet.
#[derive(Debug)]
pub struct Ticket {
    answer: Receiver<Answer>,
    stop: Stop,
}

impl Ticket {
    /// Waits at most so long; `None` when the picture was not ready.
    pub fn wait(&self, at_most: Duration) -> Option<Answer> {
        match self.answer.recv_timeout(at_most) {
            Ok(answer) => Some(answer),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => Some(Err(SessionError::Closed)),
        }
    }

    /// The job is not begun, or ends between two faces of its upload; a frame that the device draws is drawn to its end.
    pub fn stop(&self) {
        self.stop.set();
    }
}

/// A thread with a [`Drawer`].
#[derive(Debug)]
pub struct Worker {
    orders: Option<Sender<Order>>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    /// Starts the thread and opens the device.
    ///
    /// # Errors
    /// [`SessionError::Device`].
    pub fn new(options: DeviceOptions) -> Result<Self, SessionError> {
        let (orders, incoming) = mpsc::channel::<Order>();
        let (opened, answer) = mpsc::channel();
        let work = move || {
            let mut drawer = match guarded(|| Drawer::new(&options)) {
                Ok(drawer) => {
                    let _ = opened.send(Ok(())); // the caller waits for it
                    drawer
                }
                Err(error) => return drop(opened.send(Err(error))),
            };
            for Order { job, stop, answer } in incoming {
                let drawn = guarded(|| drawer.draw(&job, &stop));
                let is_lost = matches!(drawn, Err(SessionError::Panicked(_)));
                let _ = answer.send(drawn); // the ticket may be dropped
                if is_lost {
                    break; // after a panic the device is not used again
                }
            }
        };
        let thread = thread::Builder::new().name("selvedge".to_owned()).spawn(work);
        let thread = thread.map_err(|error| SessionError::Panicked(format!("no thread: {error}")))?;
        answer.recv().unwrap_or(Err(SessionError::Closed))?;
        Ok(Self { orders: Some(orders), thread: Some(thread) })
    }

    /// Sends a job; it is drawn after those sent before.
    ///
    /// # Errors
    /// [`SessionError::Closed`].
    pub fn submit(&self, job: Job) -> Result<Ticket, SessionError> {
        let (answer, receiver) = mpsc::channel();
        let stop = Stop::default();
        let order = Order { job: Box::new(job), stop: stop.clone(), answer };
        let orders = self.orders.as_ref().ok_or(SessionError::Closed)?;
        orders.send(order).map_err(|_| SessionError::Closed)?;
        Ok(Ticket { answer: receiver, stop })
    }

    /// Frees the device once the jobs sent before are drawn. Later jobs are [`SessionError::Closed`].
    pub fn close(&mut self) {
        self.orders = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join(); // its panics were answers
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.close();
    }
}
