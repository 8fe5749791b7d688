//! The resolution and the effects of pictures while the view moves: the next one is ready in time.
//!
//! ```text
//!   still     every pixel, every effect                      once, then nothing is drawn
//!   moving    the finest of these steps that takes at most BUDGET:
//!
//!     of the pixels along a side   1   3/4   1/2   3/8   3/8    3/8    3/8    3/8   1/4   3/16
//!     left out                                           ● ─────────────────────────────────▶   smooth borders
//!                                                               ● ──────────────────────────▶   ambient occlusion
//!                                                                      ● ───────────────────▶   shadows
//!                                                                             ● ────────────▶   lines
//! ```
//!
//! Time grows with the number of pixels, from a constant part. The cost of an effect is measured where two pictures
//! differ by it alone. A picture of fewer pixels satisfies the accuracy promise at its own size: resolution and effects
//! fall, correctness does not. Steps exist only for the effects that the scene has.

use selvedge::picture::Effects;
use std::time::Duration;

/// Time for one frame of a moving view: 25 in a second, and room for the panels.
pub const BUDGET: Duration = Duration::from_millis(40);
/// Parts of the pixels along each side, from fine to coarse.
pub const SCALES: [f64; 6] = [1.0, 0.75, 0.5, 0.375, 0.25, 0.1875];
/// The coarsest picture with effects: in a coarser one they would be too blurred to be worth their time.
pub const LEAST_WITH_EFFECTS: f64 = SCALES[3];
/// A finer step is taken only if it needs at most this share of the budget: the picture does not flicker between two.
const SURE: f64 = 0.75;
/// The time with an effect over the time without it, until it is measured.
const ASSUMED: f64 = 1.5;
/// The scale of the first moving picture: neither stalls a slow device nor blurs a fast one for long.
const FIRST: f64 = SCALES[2];

/// A size and effects of a moving picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Share of the pixels along each side.
    pub scale: f64,
    /// Effects that are left out.
    pub without: Effects,
}

impl Step {
    /// A still picture: every pixel, every effect.
    pub const STILL: Self = Self { scale: 1.0, without: Effects::NONE };
}

/// The effects in the order in which they fall; numbers of [`Pacing`]'s costs.
const BORDERS: usize = 0;
const AMBIENT: usize = 1;
const SHADOWS: usize = 2;
const LINES: usize = 3;
/// How many they are.
const EFFECTS: usize = 4;

/// The step, and the effect by which it is coarser than the step before; `None`: by its scale.
type Rung = (Step, Option<usize>);

/// Steps from fine to coarse, of a scene with these effects.
fn ladder(present: Effects) -> Vec<Rung> {
    let mut without = Effects::NONE;
    let mut ladder = Vec::new();
    for scale in SCALES {
        ladder.push((Step { scale, without }, None));
        if scale != LEAST_WITH_EFFECTS {
            continue;
        }
        let Effects { borders, ambient, lines, shadows } = present;
        let effects: [_; EFFECTS] = [(BORDERS, borders), (AMBIENT, ambient), (SHADOWS, shadows), (LINES, lines)];
        for (effect, is_there) in effects {
            if is_there {
                match effect {
                    BORDERS => without.borders = true,
                    AMBIENT => without.ambient = true,
                    SHADOWS => without.shadows = true,
                    _ => without.lines = true,
                }
                ladder.push((Step { scale, without }, Some(effect)));
            }
        }
    }
    ladder
}

/// Chooses the step of moving pictures from the time that they took.
#[derive(Clone, Debug)]
pub struct Pacing {
    present: Effects,
    ladder: Vec<Rung>,
    at: usize,
    /// The last picture: its step and its time.
    last: Option<(usize, Duration)>,
    /// Of each effect, the time with it over the time without it.
    costs: [f64; EFFECTS],
}

impl Default for Pacing {
    /// Of a scene without effects.
    fn default() -> Self {
        let ladder = ladder(Effects::NONE);
        let at = place(&ladder, FIRST);
        Self { present: Effects::NONE, ladder, at, last: None, costs: [ASSUMED; EFFECTS] }
    }
}

/// The finest step of a scale.
fn place(ladder: &[Rung], scale: f64) -> usize {
    ladder.iter().position(|(step, _)| step.scale == scale).unwrap_or_default()
}

impl Pacing {
    /// The step of the next moving picture.
    pub fn step(&self) -> Step {
        self.ladder[self.at].0
    }

    /// The step of the first picture of all, as soon as may be: without effects.
    pub fn first(&self) -> Step {
        Step { without: self.present, ..self.step() }
    }

    /// The scene has these effects. Where they are others than before, the scale stays.
    pub fn set_effects(&mut self, present: Effects) {
        if present != self.present {
            let scale = self.step().scale;
            *self = Self { present, ladder: ladder(present), ..Self::default() };
            self.at = place(&self.ladder, scale);
        }
    }

    /// Records that a picture of this step took so long. The coarser step is the finest one that would do if all of the
    /// time grew with the pixels and effects cost what they did; a finer one is one step away.
    pub fn took(&mut self, step: Step, time: Duration) {
        if step != self.step() {
            // a still picture: the hand rests, and may see something else when it goes on
            self.last = None;
            self.costs = self.costs.map(|cost| 0.5 * (cost + ASSUMED));
            return;
        }
        self.learn(time);
        self.last = Some((self.at, time));
        if time > BUDGET {
            let mut expected = time.as_secs_f64();
            let would_do = |next: &usize| {
                expected /= self.growth(*next);
                expected <= BUDGET.as_secs_f64()
            };
            self.at = (self.at + 1..self.ladder.len()).find(would_do).unwrap_or(self.ladder.len() - 1);
        } else if self.at > 0 && time.mul_f64(self.growth(self.at)) < BUDGET.mul_f64(SURE) {
            self.at -= 1;
        }
    }

    /// The time of the step before `rung` over the time of `rung`, if all of it grows with the pixels.
    fn growth(&self, rung: usize) -> f64 {
        let (step, effect) = self.ladder[rung];
        match effect {
            Some(effect) => self.costs[effect],
            None => (self.ladder[rung - 1].0.scale / step.scale).powi(2),
        }
    }

    /// The cost of an effect, if the last picture differs by it alone.
    fn learn(&mut self, time: Duration) {
        let Some((last, before)) = self.last.filter(|(last, _)| last.abs_diff(self.at) == 1) else { return };
        let Some(effect) = self.ladder[last.max(self.at)].1 else { return };
        let (with, left_out) = if last < self.at { (before, time) } else { (time, before) };
        // no effect makes a picture quicker
        self.costs[effect] = (with.as_secs_f64() / left_out.as_secs_f64().max(1e-9)).max(1.0);
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

    const ALL: Effects = Effects { borders: true, ambient: true, lines: true, shadows: true };

    /// A device that needs `fixed` and `each` milliseconds for all pixels, and for each effect a share of `each` more.
    #[derive(Clone, Copy)]
    struct Device {
        fixed: f64,
        each: f64,
        /// In the order in which they fall.
        effects: [f64; EFFECTS],
    }

    impl Device {
        fn time(&self, step: Step) -> f64 {
            let Effects { borders, ambient, lines, shadows } = step.without;
            let shown =
                [borders, ambient, shadows, lines].into_iter().zip(self.effects).filter(|(left_out, _)| !left_out);
            self.fixed + self.each * step.scale.powi(2) * (1.0 + shown.map(|(_, share)| share).sum::<f64>())
        }

        fn draw(&self, pacing: &mut Pacing) -> Step {
            let step = pacing.step();
            pacing.took(step, Duration::from_secs_f64(self.time(step) * 1e-3));
            step
        }

        /// The step after a while, which is that of the rest of the move.
        fn settled(&self, pacing: &mut Pacing) -> Step {
            let seen: Vec<Step> = (0..60).map(|_| self.draw(pacing)).collect();
            assert!(seen[30..].iter().all(|step| *step == seen[30]), "it flickers: {seen:?}");
            seen[30]
        }
    }

    fn paced(present: Effects) -> Pacing {
        let mut pacing = Pacing::default();
        pacing.set_effects(present);
        pacing
    }

    /// On a scene without effects.
    fn settled(fixed: f64, each: f64) -> (f64, f64) {
        let device = Device { fixed, each, effects: [0.0; EFFECTS] };
        let step = device.settled(&mut Pacing::default());
        (step.scale, device.time(step))
    }

    fn at(scale: f64) -> Step {
        Step { scale, without: Effects::NONE }
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
        pacing.took(at(0.5), Duration::from_millis(150));
        assert_eq!(pacing.step(), at(0.25));
        pacing.took(at(0.25), Duration::from_millis(41));
        assert_eq!(pacing.step(), at(0.1875));
        pacing.took(at(0.1875), Duration::from_millis(1));
        assert_eq!(pacing.step(), at(0.25));
    }

    /// Whatever an effect costs, and at every speed, the step stays once it is found, keeps the rate where any step
    /// does, and an effect falls only after the resolution and those before it.
    #[test]
    fn effects_fall_after_the_resolution_and_none_flickers() {
        let shares = [
            [0.1; 4],
            [1.0, 0.3, 0.2, 0.2],
            [0.2, 3.0, 0.4, 0.1],
            [8.0, 0.5, 1.0, 2.0],
            [0.3, 0.1, 4.0, 0.2],
            [0.0; 4],
        ];
        for effects in shares {
            let mut coarsest = 0;
            for each in (0..60).map(|i| 2.0 * 1.13f64.powi(i)) {
                let device = Device { fixed: 3.0, each, effects };
                let mut pacing = paced(ALL);
                let step = device.settled(&mut pacing);
                let last = ladder(ALL).len() - 1;
                assert!(device.time(step) <= 40.0 || pacing.at == last, "{} ms at {step:?}", device.time(step));
                let Effects { borders, ambient, lines, shadows } = step.without;
                assert!(!borders || step.scale <= LEAST_WITH_EFFECTS, "{step:?}");
                assert!((borders || !ambient) && (ambient || !shadows) && (shadows || !lines), "{step:?}");
                assert!(step.scale >= LEAST_WITH_EFFECTS || step.without == ALL, "{step:?}");
                coarsest = coarsest.max(pacing.at);
            }
            assert_eq!(coarsest, ladder(ALL).len() - 1, "the slowest device needs every step");
        }
    }

    #[test]
    fn effects_come_back_when_there_is_time() {
        let mut pacing = paced(ALL);
        let slow = Device { fixed: 3.0, each: 400.0, effects: [0.5; EFFECTS] };
        assert_eq!(slow.settled(&mut pacing).without, ALL);
        let fast = Device { fixed: 1.0, each: 8.0, effects: [0.5; EFFECTS] };
        assert_eq!(fast.settled(&mut pacing), Step::STILL);
    }

    /// One that turns out too dear is tried once, and after a rest again.
    #[test]
    fn a_dear_effect_is_tried_once_in_a_move() {
        // 16 ms without smooth borders, 160 ms with them
        let device = Device { fixed: 0.0, each: 16.0 / LEAST_WITH_EFFECTS.powi(2), effects: [9.0, 0.0, 0.0, 0.0] };
        let borders = Effects { borders: true, ..Effects::NONE };
        let mut pacing = paced(borders);
        let tried = |pacing: &mut Pacing| {
            let seen: Vec<Step> = (0..30).map(|_| device.draw(pacing)).collect();
            assert!(seen[8..].iter().all(|step| step.without == borders), "{seen:?}");
            seen.iter().filter(|step| **step == at(LEAST_WITH_EFFECTS)).count()
        };
        assert_eq!(tried(&mut pacing), 1);
        assert_eq!(tried(&mut pacing), 0);
        for _ in 0..8 {
            pacing.took(Step::STILL, Duration::from_millis(500));
        }
        assert_eq!((tried(&mut pacing), pacing.step().without), (1, borders));
    }

    #[test]
    fn a_scene_without_an_effect_has_no_step_for_it() {
        let count = |present: Effects| ladder(present).len();
        assert_eq!((count(Effects::NONE), count(ALL)), (SCALES.len(), SCALES.len() + EFFECTS));
        let mut pacing = paced(Effects { lines: true, ..Effects::NONE });
        pacing.took(at(0.5), Duration::from_millis(60));
        pacing.took(at(0.375), Duration::from_millis(50));
        assert_eq!(pacing.step().without, Effects { lines: true, ..Effects::NONE });
        pacing.set_effects(Effects::NONE);
        assert_eq!(pacing.step(), at(0.375), "the scale stays");
    }

    #[test]
    fn sizes_have_pixels() {
        assert_eq!(Pacing::size(0.25, (1280, 801)), (320, 200));
        assert_eq!(Pacing::size(0.1875, (2, 1)), (1, 1));
    }

    #[test]
    fn times_of_other_pictures_do_not_count() {
        let mut pacing = Pacing::default();
        pacing.took(at(1.0), Duration::from_secs(1));
        assert_eq!(pacing.step(), at(0.5));
    }
}
