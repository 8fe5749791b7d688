//! The resolution of pictures while the view moves: the next one is ready in time.
//!
//! ```text
//!   still     every pixel                                    once, then nothing is drawn
//!   moving    one of SCALES of the pixels along each side    the finest that takes at most BUDGET
//! ```
//!
//! Time grows with the number of pixels, from a constant part. A picture of fewer pixels satisfies the accuracy promise
//! at its own size: resolution falls, correctness does not.

use std::time::Duration;

/// Time for one frame of a moving view: 25 in a second, and room for the panels.
pub const BUDGET: Duration = Duration::from_millis(40);
/// Parts of the pixels along each side, from fine to coarse.
pub const SCALES: [f64; 6] = [1.0, 0.75, 0.5, 0.375, 0.25, 0.1875];
/// A finer scale is taken only if it needs at most this share of the budget: the scale does not flicker between two.
const SURE: f64 = 0.75;

/// Chooses the scale of moving pictures from the time that they took.
#[derive(Clone, Copy, Debug)]
pub struct Pacing {
    scale: usize,
}

impl Default for Pacing {
    /// Begins in the middle: neither stalls a slow device nor blurs a fast one for long.
    fn default() -> Self {
        Self { scale: 2 }
    }
}

impl Pacing {
    /// Share of the pixels along each side.
    pub fn scale(&self) -> f64 {
        SCALES[self.scale]
    }

    /// Records that a picture of this scale took so long. A coarser scale is one step away, or the finest that would do
    /// if all of the time grew with the pixels; a finer one is one step away.
    pub fn took(&mut self, scale: f64, time: Duration) {
        if scale != self.scale() {
            return;
        }
        if time > BUDGET {
            let would_do = |next: &usize| time.mul_f64((SCALES[*next] / scale).powi(2)) <= BUDGET;
            self.scale = (self.scale + 1..SCALES.len()).find(would_do).unwrap_or(SCALES.len() - 1);
        } else if let Some(finer) = self.scale.checked_sub(1) {
            let growth = (SCALES[finer] / scale).powi(2);
            if time.mul_f64(growth) < BUDGET.mul_f64(SURE) {
                self.scale = finer;
            }
        }
    }

    /// Width and height of a picture for a view of so many pixels.
    pub fn size(scale: f64, view: (u32, u32)) -> (u32, u32) {
        let scaled = |side: u32| ((f64::from(side) * scale).round() as u32).clamp(1, 16384);
        (scaled(view.0), scaled(view.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A device that needs `fixed` and `each` milliseconds for all pixels.
    fn settled(fixed: f64, each: f64) -> (f64, f64) {
        let mut pacing = Pacing::default();
        let time = |scale: f64| fixed + each * scale * scale;
        let mut seen = Vec::new();
        for _ in 0..20 {
            let scale = pacing.scale();
            seen.push(scale);
            pacing.took(scale, Duration::from_secs_f64(time(scale) * 1e-3));
        }
        assert!(seen[10..].iter().all(|s| *s == seen[10]), "it flickers: {seen:?}");
        (seen[10], time(seen[10]))
    }

    #[test]
    fn a_fast_device_draws_every_pixel_and_a_slow_one_keeps_the_rate() {
        assert_eq!(settled(1.0, 5.0).0, 1.0);
        for each in [60.0, 200.0, 500.0] {
            let (scale, time) = settled(4.0, each);
            assert!(time <= 40.0, "{time} ms at {scale}");
        }
        assert_eq!(settled(500.0, 10.0).0, SCALES[5]);
    }

    #[test]
    fn a_picture_that_took_much_too_long_skips_scales() {
        let mut pacing = Pacing::default();
        pacing.took(0.5, Duration::from_millis(150));
        assert_eq!(pacing.scale(), 0.25);
        pacing.took(0.25, Duration::from_millis(41));
        assert_eq!(pacing.scale(), 0.1875);
        pacing.took(0.1875, Duration::from_millis(1));
        assert_eq!(pacing.scale(), 0.25);
    }

    #[test]
    fn sizes_have_pixels() {
        assert_eq!(Pacing::size(0.25, (1280, 801)), (320, 200));
        assert_eq!(Pacing::size(0.1875, (2, 1)), (1, 1));
    }

    #[test]
    fn times_of_other_pictures_do_not_count() {
        let mut pacing = Pacing::default();
        pacing.took(1.0, Duration::from_secs(1));
        assert_eq!(pacing.scale(), 0.5);
    }
}
