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

use crate::drawer::{DeviceOptions, Drawer, Drawn, Job};
use crate::error::{SessionError, Stop, guarded};
use crate::limits::Work;
use selvedge::gpu::GpuError;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::Duration;

type Answer = Result<Drawn, SessionError>;

/// A job on its way.
struct Order {
    job: Box<Job>,
    stop: Stop,
    answer: Sender<Answer>,
}

impl Order {
    /// Answers it; true unless the answer is a panic, after which the device is not used again.
    fn answer(self, drawn: Answer) -> bool {
        let is_usable = !matches!(drawn, Err(SessionError::Panicked(_)));
        let _ = self.answer.send(drawn); // the ticket may be dropped
        is_usable
    }

    /// Draws it and answers it, as [`answer`](Self::answer).
    fn alone(self, drawer: &mut Drawer) -> bool {
        let drawn = guarded(|| drawer.draw(&self.job, &self.stop));
        self.answer(drawn)
    }

    /// Answers it with a picture that was drawn while others were in flight.
    fn with_others(self, drawn: Drawn) {
        self.job.limits.spend(Duration::from_secs_f64(drawn.draw_s));
        let tested = self.tested().map(|()| drawn);
        self.answer(tested);
    }

    /// Whether its file's limits let a picture be drawn.
    fn tested(&self) -> Result<(), SessionError> {
        Ok(self.job.limits.begin(Work::Drawing).test()?)
    }

    /// Why it need not be begun.
    fn refused(&self) -> Option<SessionError> {
        if self.stop.is_set() {
            return Some(SessionError::Stopped);
        }
        self.tested().err().or_else(|| self.job.camera.check().err().map(SessionError::from))
    }
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
    let mut early = VecDeque::from([first, second]);
    let begun = RefCell::new(VecDeque::new());
    let next = || {
        loop {
            let order: Order = early.pop_front().or_else(|| waiting.next_if(is_alike))?;
            if let Some(error) = order.refused() {
                order.answer(Err(error));
                continue;
            }
            let camera = order.job.camera;
            begun.borrow_mut().push_back(order);
            return Some(camera);
        }
    };
    let take = |drawn| {
        if let Some(order) = begun.borrow_mut().pop_front() {
            order.with_others(drawn);
        }
    };
    let ended = guarded(|| drawer.draw_stream((&job, upload_s), next, take));
    // after an error: each is drawn alone, and has a picture or an error of its own
    let mut left = begun.into_inner();
    left.append(&mut early);
    match ended {
        Ok(()) => true,
        Err(error @ SessionError::Panicked(_)) => {
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

fn is_out_of_memory(error: &SessionError) -> bool {
    matches!(error, SessionError::Draw(error) if error.gpu().is_some_and(GpuError::is_out_of_memory))
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
            Err(RecvTimeoutError::Disconnected) => Some(Err(SessionError::Closed)),
        }
    }

    /// The job is not begun, or ends between two faces of its upload or between two of its frames. A frame that the
    /// device draws is drawn to its end.
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
        let work = move || match guarded(|| Drawer::new(&options)) {
            Ok(mut drawer) => {
                let _ = opened.send(Ok(())); // the caller waits for it
                draw_all(&mut drawer, &mut Waiting { incoming, first: None });
            }
            Err(error) => drop(opened.send(Err(error))),
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
