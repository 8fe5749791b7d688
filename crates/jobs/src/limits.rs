//! Bounds of the work on a file: its time, and the memory of the process meanwhile, with that of a program that runs.
//!
//! ```text
//!   Limits ─ begin(Reading)   ─▶ Step: check, check, … ─▶ drop
//!          ─ begin(Preparing) ─▶ Step: check, check, … ─▶ drop        time between the steps does not count
//!          ─ begin(Drawing)   ─▶ Step: test, test      ─▶ drop
//! ```
//!
//! The work tests them itself: where reading reports progress, between two faces of an upload, between two frames, and
//! before and after a picture. A frame that the device has begun is drawn to its end.

use selvedge_io::import::Stage;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use sysinfo::{Pid, Process, ProcessRefreshKind, ProcessesToUpdate, System};

/// Nanoseconds between two measurements of memory. One takes some tens of microseconds, and a face often takes less.
const BETWEEN: u64 = 5_000_000;

/// The same where another program runs: all processes are looked at, which takes some milliseconds.
const BETWEEN_ALL: u64 = 50_000_000;

/// A part of the work on a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// The file becomes a model.
    Reading,
    /// The model is uploaded.
    Preparing,
    /// Pictures are drawn and written.
    Drawing,
}

impl Work {
    /// The work so far, with its verb.
    fn words(self) -> &'static str {
        match self {
            Self::Reading => "reading it takes",
            Self::Preparing => "reading and preparing it take",
            Self::Drawing => "reading, preparing and drawing it take",
        }
    }
}

/// A limit, as it is exceeded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// Most time.
    Time(Duration),
    /// Most memory.
    Memory {
        /// The limit, bytes.
        most: u64,
        /// Bytes that the process holds, and with it a program that it runs.
        held: u64,
    },
}

impl Bound {
    /// What the work takes beyond it.
    fn words(self) -> String {
        match self {
            Self::Time(most) => format!("longer than the limit of {most:?}"),
            Self::Memory { most, held } => {
                let [most, held] = [most, held].map(|bytes| bytes as f64 / f64::from(1 << 20));
                format!("more memory than the limit of {most:.1} MiB: {held:.1} MiB")
            }
        }
    }
}

/// The work on a file exceeds a limit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}: {} {}", .work.words(), .bound.words())]
pub struct Exceeded {
    /// The file.
    pub file: String,
    /// What was being done.
    pub work: Work,
    /// The limit.
    pub bound: Bound,
}

/// Most time and memory for a file; the default has no limits. Clones share the time that was spent.
#[derive(Clone, Debug, Default)]
pub struct Limits {
    file: String,
    most_time: Option<Duration>,
    most_memory: Option<u64>,
    /// Nanoseconds of the steps that ended.
    spent: Arc<AtomicU64>,
}

impl Limits {
    /// Of a file, by its name in messages. The memory is what the process holds, in bytes; where the system does not
    /// tell, it is not bounded.
    pub fn new(file: &str, most_time: Option<Duration>, most_memory: Option<u64>) -> Self {
        Self { file: file.to_owned(), most_time, most_memory, spent: Arc::default() }
    }

    /// Work begins, and ends when the step is dropped.
    pub fn begin(&self, work: Work) -> Step {
        let limits = self.clone();
        Step { limits, work, begun: Instant::now(), due: AtomicU64::new(0), held: AtomicU64::new(0) }
    }

    /// Counts the time of work that had no step.
    pub fn spend(&self, time: Duration) {
        self.spent.fetch_add(nanoseconds(time), Ordering::Relaxed);
    }
}

/// Work within [`Limits`].
#[derive(Debug)]
pub struct Step {
    limits: Limits,
    work: Work,
    begun: Instant,
    /// When memory is measured next, nanoseconds after the beginning.
    due: AtomicU64,
    /// Most bytes that were measured.
    held: AtomicU64,
}

impl Step {
    /// Whether the work may go on.
    ///
    /// # Errors
    /// [`Exceeded`].
    pub fn test(&self) -> Result<(), Exceeded> {
        self.test_with(None)
    }

    /// The same with the memory of a program, by the number of its process, and of all that it has started.
    fn test_with(&self, program: Option<u32>) -> Result<(), Exceeded> {
        let Limits { file, most_time, most_memory, spent } = &self.limits;
        let exceeded = |bound| Err(Exceeded { file: file.clone(), work: self.work, bound });
        let time = self.begun.elapsed() + Duration::from_nanos(spent.load(Ordering::Relaxed));
        if let Some(most) = most_time.filter(|most| time > *most) {
            return exceeded(Bound::Time(most));
        }
        let Some(most) = *most_memory else { return Ok(()) };
        let held = self.held(program);
        if held > most { exceeded(Bound::Memory { most, held }) } else { Ok(()) }
    }

    /// Unwinds to [`guarded`](crate::guarded) if a limit is exceeded: progress callbacks cannot return an error.
    pub fn check(&self) {
        unwind(self.test());
    }

    /// The same at a stage of an import: the memory of a program that it runs counts.
    pub fn check_at(&self, stage: Stage) {
        unwind(self.test_with(if let Stage::Program { process } = stage { Some(process) } else { None }));
    }

    /// Most bytes that were held, measured now and then: every thread sees that a limit was exceeded.
    fn held(&self, program: Option<u32>) -> u64 {
        let now = nanoseconds(self.begun.elapsed());
        let due = self.due.load(Ordering::Relaxed);
        let next = now.saturating_add(if program.is_some() { BETWEEN_ALL } else { BETWEEN });
        let is_due = now >= due;
        if is_due && self.due.compare_exchange(due, next, Ordering::Relaxed, Ordering::Relaxed).is_ok() {
            let beside = program.and_then(resident_of_all).unwrap_or(0);
            self.held.fetch_max(resident().unwrap_or(0) + beside, Ordering::Relaxed);
        }
        self.held.load(Ordering::Relaxed)
    }
}

impl Drop for Step {
    fn drop(&mut self) {
        self.limits.spend(self.begun.elapsed());
    }
}

fn nanoseconds(time: Duration) -> u64 {
    u64::try_from(time.as_nanos()).unwrap_or(u64::MAX)
}

/// Unwinds with the error, if there is one.
fn unwind(within: Result<(), Exceeded>) {
    if let Err(exceeded) = within {
        resume_unwind(Box::new(exceeded));
    }
}

/// Bytes of memory that the process holds; `None` where the system does not tell.
pub fn resident() -> Option<u64> {
    let own = sysinfo::get_current_pid().ok()?;
    measured(ProcessesToUpdate::Some(&[own])).process(own).map(Process::memory)
}

/// Bytes that a process holds, and with it all that it has started; `None` where there is no such process.
fn resident_of_all(process: u32) -> Option<u64> {
    let system = measured(ProcessesToUpdate::All);
    let first = system.process(Pid::from_u32(process))?;
    let (mut held, mut parents) = (0, vec![first]);
    // parents that changed while they were read may form a ring
    let mut left: Vec<&Process> = system.processes().values().filter(|other| other.pid() != first.pid()).collect();
    while let Some(parent) = parents.pop() {
        held += parent.memory();
        let (children, others): (Vec<_>, Vec<_>) =
            left.into_iter().partition(|other| other.parent() == Some(parent.pid()));
        left = others;
        parents.extend(children);
    }
    Some(held)
}

fn measured(processes: ProcessesToUpdate<'_>) -> System {
    let mut system = System::new();
    let memory = ProcessRefreshKind::nothing().with_memory().without_tasks();
    system.refresh_processes_specifics(processes, false, memory);
    system
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{JobError, guarded};
    use std::thread;

    const HOUR: Duration = Duration::from_secs(3600);

    #[test]
    fn all_work_on_a_file_counts_and_no_wait() {
        let limits = Limits::new("a.step", Some(Duration::from_millis(200)), None);
        thread::sleep(Duration::from_millis(250)); // it waits for its turn
        assert_eq!(limits.begin(Work::Reading).test(), Ok(()));
        let step = limits.clone().begin(Work::Preparing);
        thread::sleep(Duration::from_millis(250));
        let late = step.test().expect_err("a quarter of a second");
        assert_eq!(late.to_string(), "a.step: reading and preparing it take longer than the limit of 200ms");
        drop(step);
        let late = limits.begin(Work::Drawing).test().expect_err("it was spent before");
        assert_eq!((late.work, late.bound), (Work::Drawing, Bound::Time(Duration::from_millis(200))));

        let long = Limits::new("a.step", Some(HOUR), None);
        long.spend(HOUR / 2);
        assert_eq!(long.begin(Work::Drawing).test(), Ok(()));
        long.spend(HOUR);
        assert!(long.begin(Work::Drawing).test().is_err());
        assert_eq!(Limits::default().begin(Work::Drawing).test(), Ok(()));
    }

    #[test]
    fn a_check_unwinds_to_the_guard() {
        let step = Limits::new("a.step", Some(Duration::ZERO), None).begin(Work::Reading);
        let ended: Result<(), JobError> = guarded(|| {
            step.check();
            Ok(())
        });
        assert!(matches!(ended, Err(JobError::Limit(Exceeded { work: Work::Reading, .. }))));
    }
}
