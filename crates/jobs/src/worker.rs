//! A thread that owns a device and draws the jobs of other threads.
//!
//! ```text
//!   caller ──Job──▶ channel ──▶ Waiting ─┬ a job alone ──────────────▶ Drawer::draw ────────┬─Ticket──▶ caller
//!                                        └ jobs of different cameras ▶ Drawer::draw_stream ─┘
//! ```
//!
//! Jobs are drawn in the order in which they came, whichever threads sent them. Jobs that wait and differ in the camera
//! alone have frames in flight together: the GPU draws the next ones while this one is copied. The caller's wait is
//! independent of the driver, so a caller may handle signals while a frame is drawn.
//!
//! A stop or a limit ends the first of the pictures in flight between two of its frames. Those behind it are drawn
//! anew, each alone.

use crate::drawer::{DeviceOptions, Drawer, Drawn, Job};
use crate::error::{JobError, Stop, guarded};
use crate::limits::{Step, Work};
use selvedge::gpu::GpuError;
use std::collections::VecDeque;
use std::mem::take;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

type Answer = Result<Drawn, JobError>;

/// A job on its way.
struct Order {
    job: Box<Job>,
    stop: Stop,
    answer: Sender<Answer>,
}

impl Order {
    /// Answers it; true unless the answer is a panic, after which the device is not used again.
    fn answer(self, drawn: Answer) -> bool {
        let is_usable = !matches!(drawn, Err(JobError::Panicked(_)));
        let _ = self.answer.send(drawn); // the ticket may be dropped
        is_usable
    }

    /// Draws it and answers it, as [`answer`](Self::answer).
    fn alone(self, drawer: &mut Drawer) -> bool {
        let drawn = guarded(|| drawer.draw(&self.job, &self.stop));
        self.answer(drawn)
    }

    /// Answers it with a picture that was drawn while others were in flight, and whose time is spent.
    fn with_others(self, drawn: Drawn) {
        let tested = self.tested().map(|()| drawn);
        self.answer(tested);
    }

    /// Whether its file's limits let a picture be drawn.
    fn tested(&self) -> Result<(), JobError> {
        Ok(self.job.limits.begin(Work::Drawing).test()?)
    }

    /// Why it need not be begun.
    fn refused(&self) -> Option<JobError> {
        if self.stop.is_set() {
            return Some(JobError::Stopped);
        }
        self.tested().err().or_else(|| self.job.camera.check().err().map(JobError::from))
    }
}

/// Orders whose frames are in flight, the first one first.
struct Begun {
    orders: VecDeque<Order>,
    /// What may end the first picture. Its time runs from the picture before, as pictures in flight share the device.
    first: Option<(Stop, Step)>,
}

impl Begun {
    /// Before the first order is begun, which may prepare its model for other images.
    fn before(first: &Order) -> Self {
        Self { orders: VecDeque::new(), first: Some(Self::bounds(first)) }
    }

    fn bounds(order: &Order) -> (Stop, Step) {
        (order.stop.clone(), order.job.limits.begin(Work::Drawing))
    }

    fn push(&mut self, order: Order) {
        if self.orders.is_empty() {
            self.first = Some(Self::bounds(&order));
        }
        self.orders.push_back(order);
    }

    /// The first order; its time ends.
    fn pop(&mut self) -> Option<Order> {
        let order = self.orders.pop_front();
        self.first = self.orders.front().map(Self::bounds);
        order
    }

    /// All orders, after an error.
    fn end(&mut self) -> VecDeque<Order> {
        self.first = None;
        take(&mut self.orders)
    }

    /// Unwinds to [`guarded`] if the first picture is stopped or exceeds a limit.
    fn check(&self) {
        if let Some((stop, step)) = &self.first {
            stop.check();
            step.check();
        }
    }
}

/// The orders in flight; [`Begun::check`] unwinds while they are locked, and changes nothing.
fn locked(begun: &Mutex<Begun>) -> MutexGuard<'_, Begun> {
    begun.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Orders that are not begun.
struct Waiting {
    incoming: Receiver<Order>,
    /// The first of them, if it was received.
    first: Option<Order>,
}

impl Waiting {
    /// Waits for an order. `None` once the worker is closed and all orders were taken.
    fn next(&mut self) -> Option<Order> {
        self.first.take().or_else(|| self.incoming.recv().ok())
    }

    /// The next order, if there is one and it is a good one.
    fn next_if(&mut self, is_good: impl FnOnce(&Job) -> bool) -> Option<Order> {
        let order = self.next_now()?;
        if is_good(&order.job) {
            return Some(order);
        }
        self.first = Some(order);
        None
    }

    fn next_now(&mut self) -> Option<Order> {
        self.first.take().or_else(|| self.incoming.try_recv().ok())
    }
}

/// Draws two orders, and those like them that come while they are drawn, with frames in flight, and answers them. False
/// once the device is not used again.
fn in_flight(drawer: &mut Drawer, [first, second]: [Order; 2], waiting: &mut Waiting) -> bool {
    let upload_s = match guarded(|| drawer.load(&first.job, &first.stop)) {
        Ok(upload_s) => upload_s,
        Err(error) => return first.answer(Err(error)) && second.alone(drawer),
    };
    let (job, most_in_flight) = (Job::clone(&first.job), drawer.most_in_flight());
    let is_alike = |other: &Job| other.goes_with(&job) && other.pixels() <= most_in_flight;
    let begun = Arc::new(Mutex::new(Begun::before(&first)));
    let mut early = VecDeque::from([first, second]);
    let watched = Arc::downgrade(&begun);
    let watch = move || watched.upgrade().iter().for_each(|begun| locked(begun).check());
    let next = || {
        loop {
            let order: Order = early.pop_front().or_else(|| waiting.next_if(is_alike))?;
            if let Some(error) = order.refused() {
                order.answer(Err(error));
                continue;
            }
            let camera = order.job.camera;
            locked(&begun).push(order);
            return Some(camera);
        }
    };
    let answer = |drawn| {
        let order = locked(&begun).pop();
        if let Some(order) = order {
            order.with_others(drawn);
        }
    };
    let ended = guarded(|| drawer.draw_stream((&job, upload_s), Arc::new(watch), next, answer));
    // after an error: each is drawn alone, and has a picture or an error of its own
    let mut left = locked(&begun).end();
    left.append(&mut early);
    match ended {
        Ok(()) => true,
        Err(error @ JobError::Panicked(_)) => {
            if let Some(order) = left.pop_front() {
                order.answer(Err(error));
            }
            false
        }
        Err(error) => {
            let largest = left.iter().map(|order| order.job.pixels()).max();
            if let Some(pixels) = largest.filter(|_| is_out_of_memory(&error)) {
                drawer.did_not_fit(pixels);
            }
            left.into_iter().all(|order| order.alone(drawer))
        }
    }
}

fn is_out_of_memory(error: &JobError) -> bool {
    matches!(error, JobError::Draw(error) if error.gpu().is_some_and(GpuError::is_out_of_memory))
}

/// Draws orders until the worker is closed, or a panic.
fn draw_all(drawer: &mut Drawer, waiting: &mut Waiting) {
    while let Some(order) = waiting.next() {
        let most = drawer.most_in_flight();
        let is_alike = |next: &Job| next.goes_with(&order.job) && next.pixels().max(order.job.pixels()) <= most;
        let is_usable = match waiting.next_if(is_alike) {
            Some(next) => in_flight(drawer, [order, next], waiting),
            None => order.alone(drawer),
        };
        if !is_usable {
            return;
        }
    }
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
            Err(RecvTimeoutError::Disconnected) => Some(Err(JobError::Closed)),
        }
    }

    /// The job is not begun, or ends between two faces of its upload or between two of its frames; of jobs with frames
    /// in flight, once it is the first one. A frame that the device draws is drawn to its end.
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
    /// [`JobError::Device`].
    pub fn new(options: DeviceOptions) -> Result<Self, JobError> {
        let (orders, incoming) = mpsc::channel::<Order>();
        let (opened, answer) = mpsc::channel();
        let work = move || match guarded(|| Drawer::new(&options)) {
            Ok(mut drawer) => {
                let _ = opened.send(Ok(())); // the caller waits for it
                draw_all(&mut drawer, &mut Waiting { incoming, first: None });
            }
            Err(error) => drop(opened.send(Err(error))),
        };
        let thread = thread::Builder::new().name("selvedge".to_owned()).spawn(work);
        let thread = thread.map_err(|error| JobError::Panicked(format!("no thread: {error}")))?;
        answer.recv().unwrap_or(Err(JobError::Closed))?;
        Ok(Self { orders: Some(orders), thread: Some(thread) })
    }

    /// Sends a job; it is drawn after those sent before.
    ///
    /// # Errors
    /// [`JobError::Closed`].
    pub fn submit(&self, job: Job) -> Result<Ticket, JobError> {
        let (answer, receiver) = mpsc::channel();
        let stop = Stop::default();
        let order = Order { job: Box::new(job), stop: stop.clone(), answer };
        let orders = self.orders.as_ref().ok_or(JobError::Closed)?;
        orders.send(order).map_err(|_| JobError::Closed)?;
        Ok(Ticket { answer: receiver, stop })
    }

    /// Frees the device once the jobs sent before are drawn. Later jobs are [`JobError::Closed`].
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backdrop::Backdrop;
    use crate::limits::{Bound, Exceeded, Limits};
    use selvedge::glam::DVec3;
    use selvedge::model::{Camera, Model};
    use selvedge::picture::{FrameSettings, Outputs, SceneSettings};

    fn order(limits: &Limits) -> Order {
        let model = Arc::new(Model::default());
        let camera = Camera::around(model.control_bounds(), DVec3::X, DVec3::Z, 0.6, (16, 16));
        let (scene, frame, outputs) = (SceneSettings::default(), FrameSettings::default(), Outputs::default());
        let job = Job { model, camera, scene, frame, outputs, backdrop: Backdrop::Gradient, limits: limits.clone() };
        Order { job: Box::new(job), stop: Stop::default(), answer: mpsc::channel().0 }
    }

    fn checked(begun: &Mutex<Begun>) -> Result<(), JobError> {
        guarded(|| {
            locked(begun).check();
            Ok(())
        })
    }

    /// What stops a picture that is not the first one waits until it is.
    #[test]
    fn the_first_picture_in_flight_may_be_ended() {
        let unlimited = Limits::default();
        let none = Limits::new("none.step", Some(Duration::ZERO), None);
        let orders = [order(&unlimited), order(&unlimited), order(&none)];
        let stop = orders[1].stop.clone();
        let begun = Mutex::new(Begun::before(&orders[0]));
        assert!(checked(&begun).is_ok());
        orders.into_iter().for_each(|order| locked(&begun).push(order));
        stop.set();
        assert!(checked(&begun).is_ok(), "the second one is stopped, the third one has no time");
        drop(locked(&begun).pop());
        assert!(matches!(checked(&begun), Err(JobError::Stopped)));
        drop(locked(&begun).pop());
        thread::sleep(Duration::from_millis(1));
        let late = checked(&begun);
        assert!(matches!(late, Err(JobError::Limit(Exceeded { bound: Bound::Time(_), .. }))), "{late:?}");
        assert_eq!(locked(&begun).end().len(), 1);
        assert!(checked(&begun).is_ok());
    }

    /// Whether the picture is answered, or drawn alone after an error of another one.
    #[test]
    fn the_first_picture_in_flight_spends_its_time() {
        let brief = || Limits::new("brief.step", Some(Duration::from_millis(50)), None);
        let wait = || thread::sleep(Duration::from_millis(100));
        let (first, second) = (order(&brief()), order(&brief()));
        let mut begun = Begun::before(&first);
        begun.push(first);
        begun.push(second);
        wait();
        assert!(begun.pop().expect("the first one").tested().is_err());
        assert!(begun.orders[0].tested().is_ok(), "its time begins now");
        wait();
        assert!(begun.end()[0].tested().is_err());
    }
}
