//! When the next preview of a file that is being read is made.
//!
//! ```text
//!   begun ──FIRST──▶ made ▪▪▪▪▪ shown ──────────────────▶ made ▪▪▪▪▪▪▪▪▪ shown ──▶ …
//!                         taken       REST times taken, and until reading has taken GROWTH times as long
//! ```
//!
//! There are few previews, and while one is uploaded the view stands still: that takes a fifth of the time at most.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A file that is read in less has no preview.
const FIRST: Duration = Duration::from_millis(300);
/// Time of reading at a preview, for one at the preview before.
const GROWTH: u32 = 2;
/// Time between a preview's picture and the next preview, for one between a preview and its picture.
const REST: u32 = 4;

/// Times of the previews of a file.
#[derive(Debug)]
pub struct Schedule {
    begun: Instant,
    next: Mutex<Next>,
}

/// The next event.
#[derive(Clone, Copy, Debug)]
enum Next {
    /// A preview is made, no sooner than this.
    Made(Instant),
    /// The preview that was made at this time is shown.
    Shown(Instant),
}

impl Schedule {
    /// Reading begins.
    pub fn new(now: Instant) -> Self {
        Self { begun: now, next: Mutex::new(Next::Made(now + FIRST)) }
    }

    /// A preview is to be made.
    pub fn is_due(&self, now: Instant) -> bool {
        matches!(*self.next.lock().unwrap_or_else(PoisonError::into_inner), Next::Made(from) if from <= now)
    }

    /// A preview is made. No other one is due until it is shown.
    pub fn made(&self, now: Instant) {
        *self.next.lock().unwrap_or_else(PoisonError::into_inner) = Next::Shown(now);
    }

    /// The last preview is shown, if it was not before.
    pub fn shown(&self, now: Instant) {
        let mut next = self.next.lock().unwrap_or_else(PoisonError::into_inner);
        if let Next::Shown(made) = *next {
            let (read, taken) = (made.saturating_duration_since(self.begun), now.saturating_duration_since(made));
            *next = Next::Made((self.begun + read * GROWTH).max(now + taken * REST));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn previews_are_few_and_wait_for_the_picture_of_the_last_one() {
        let begun = Instant::now();
        let at = |ms: u64| begun + Duration::from_millis(ms);
        let schedule = Schedule::new(begun);
        assert!(!schedule.is_due(at(299)) && schedule.is_due(at(300)));
        schedule.made(at(400));
        assert!(!schedule.is_due(at(100_000)), "it is not shown yet");
        // pictures that cost little: twice the time of reading
        schedule.shown(at(450));
        assert!(!schedule.is_due(at(799)) && schedule.is_due(at(800)));
        schedule.shown(at(10_000));
        assert!(schedule.is_due(at(800)), "no preview is on its way");
        // pictures that cost much: four times their cost
        schedule.made(at(1000));
        schedule.shown(at(2000));
        assert!(!schedule.is_due(at(5999)) && schedule.is_due(at(6000)));
    }
}
