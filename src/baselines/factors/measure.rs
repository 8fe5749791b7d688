//! Measures how often each way exceeds the budget, and how much finer than necessary it divides.

use super::Way;
use crate::fixtures::{Deviation, Emit, Kind, Trial};
use crate::model::{Camera, Model};
use rayon::prelude::*;

/// Lattice intervals along one side of a cell: the deviation is largest at the middle of the diagonal.
const FINENESS: usize = 2;
/// Longest side, in segments, of triangulations for which the smallest sufficient one is searched.
const MOST_SEARCHED: usize = 64;
/// The hardware's largest tessellation level.
const MOST_LEVEL: u32 = 64;
/// A budget of half a pixel for the tessellation alone; see `Budget`.
const TOLERANCE_PX: f64 = 6.0;

/// The result of one way on one patch.
struct Outcome {
    rational: bool,
    answered: bool,
    /// Deviation over budget; at most 1 if the budget holds.
    excess: f64,
    quads: f64,
    /// Factors over the smallest sufficient ones of the same ratio, if these were searched.
    finer: Option<f64>,
    /// The same with deviations in depth; for ways that emit points.
    finer_in_space: Option<f64>,
}

/// Statistics of a set of numbers; NaN for an empty set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Half of them are no larger.
    pub median: f64,
    /// Nine in ten are no larger.
    pub most: f64,
}

impl Spread {
    fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let at = |share: f64| values.get((values.len() as f64 * share) as usize).copied().unwrap_or(f64::NAN);
        Self { median: at(0.5), most: at(0.9) }
    }
}

/// All results of one way.
#[derive(Clone, Debug)]
pub struct Ways {
    /// The way.
    pub way: Way,
    /// Patches in the picture.
    pub patches: usize,
    /// Patches for which the way gives no factor below 4096 segments.
    pub unanswered: usize,
    /// Patches that deviate by more than half a pixel.
    pub violations: usize,
    /// The largest deviation over the budget.
    pub worst: f64,
    /// Quads of all patches together.
    pub quads: f64,
    /// Factor over smallest sufficient factor, polynomial patches.
    pub finer_polynomial: Spread,
    /// The same, rational patches.
    pub finer_rational: Spread,
    /// Factor over the smallest one that holds the budget in space, including depth; polynomial patches, ways that emit
    /// points.
    pub space_polynomial: Spread,
    /// The same, rational patches.
    pub space_rational: Spread,
}

/// Random patches of degrees 2 to 7 with weights to 100 : 1, in perspective and through the near plane. The smallest
/// sufficient factors are searched for the first `searched` patches.
pub fn of_random(count: u64, searched: u64, ways: &[Way]) -> Vec<Ways> {
    let kind = Kind { degrees: (2, 7), ratios: &[1.5, 5.0, 100.0], tolerances: &[TOLERANCE_PX] };
    let outcomes = (0..count).into_par_iter().map(|seed| on(&Trial::random(seed, kind), ways, seed < searched));
    summaries(ways, &outcomes.collect::<Vec<_>>())
}

/// Every patch of a model in one view.
pub fn of_model(model: &Model, camera: &Camera, ways: &[Way]) -> Vec<Ways> {
    let trials = Trial::of_model(model, camera, TOLERANCE_PX);
    let outcomes: Vec<_> = trials.par_iter().map(|trial| on(trial, ways, true)).collect();
    summaries(ways, &outcomes)
}

/// The visible patches of a model in one view, for measuring deviations.
pub struct Seen {
    trials: Vec<Trial>,
}

impl Seen {
    /// The patches that the camera may see; the tessellation gets its share of `tolerance_px`.
    pub fn new(model: &Model, camera: &Camera, tolerance_px: f64) -> Self {
        let mut trials = Trial::of_model(model, camera, tolerance_px);
        trials.retain(|trial| trial.tau[0] > 0);
        Self { trials }
    }

    /// The largest deviation in pixels over all patches, including their trimmed parts.
    pub fn deviation_px(&self, way: Way) -> f64 {
        let off =
            |trial: &Trial| way.factors(trial).map_or(f64::INFINITY, |t| trial.measure(t, FINENESS, way.emits()).px);
        self.trials.par_iter().map(off).reduce(|| 0.0, f64::max)
    }

    /// The smallest level up to 64 with at most this deviation; `None` if there is none.
    pub fn level(&self, px: f64) -> Option<u32> {
        let kept = |level: u32| self.deviation_px(Way::Fixed(level as usize)) <= px;
        let (mut low, mut high) = (0, MOST_LEVEL);
        if !kept(high) {
            return None;
        }
        while high - low > 1 {
            let middle = (low + high) / 2;
            if kept(middle) { high = middle } else { low = middle }
        }
        Some(high)
    }
}

/// One result for each way; none for a patch that is not visible.
fn on(trial: &Trial, ways: &[Way], search: bool) -> Vec<Outcome> {
    if trial.tau[0] == 0 || trial.measure([8; 2], 1, Emit::Point).points == 0 {
        return Vec::new();
    }
    ways.iter().map(|way| outcome(trial, *way, search)).collect()
}

fn outcome(trial: &Trial, way: Way, search: bool) -> Outcome {
    let (rational, emit) = (trial.rational(), way.emits());
    let Some(tau) = way.factors(trial) else {
        return Outcome { rational, answered: false, excess: 0.0, quads: 0.0, finer: None, finer_in_space: None };
    };
    let deviation = trial.measure(tau, FINENESS, emit);
    let allowed = trial.allowed();
    let count = |[u, v]: [usize; 2]| (u * v) as f64;
    let quads = count(tau);
    let kept = deviation.px <= allowed;
    let searched = search && kept && deviation.whole && tau != [1, 1] && tau[0].max(tau[1]) <= MOST_SEARCHED;
    let over = |of: fn(Deviation) -> f64| (quads / count(trial.smallest(tau, FINENESS, emit, of))).sqrt();
    let finer = searched.then(|| over(|d| d.px));
    let in_space = searched && emit == Emit::Point && deviation.space_px <= allowed;
    let finer_in_space = in_space.then(|| over(|d| d.space_px));
    Outcome { rational, answered: true, excess: deviation.px / allowed, quads, finer, finer_in_space }
}

fn summaries(ways: &[Way], outcomes: &[Vec<Outcome>]) -> Vec<Ways> {
    let seen: Vec<_> = outcomes.iter().filter(|all| !all.is_empty()).collect();
    let summary = |(k, way): (usize, &Way)| {
        let all = || seen.iter().map(|outcomes| &outcomes[k]);
        let finer = |rational: bool, of: fn(&Outcome) -> Option<f64>| {
            Spread::of(all().filter(|o| o.rational == rational).filter_map(of).collect())
        };
        Ways {
            way: *way,
            patches: seen.len(),
            unanswered: all().filter(|o| !o.answered).count(),
            violations: all().filter(|o| o.excess > 1.0).count(),
            worst: all().map(|o| o.excess).fold(0.0, f64::max),
            quads: all().map(|o| o.quads).sum(),
            finer_polynomial: finer(false, |o| o.finer),
            finer_rational: finer(true, |o| o.finer),
            space_polynomial: finer(false, |o| o.finer_in_space),
            space_rational: finer(true, |o| o.finer_in_space),
        }
    };
    ways.iter().enumerate().map(summary).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For the median of random patches the bound uses at most half as many segments again as the smallest sufficient
    /// factors of its ratio; for rational patches at most twice as many.
    #[test]
    fn the_bound_divides_little_too_finely() {
        let bound = &of_random(400, 400, &[Way::Bound])[0];
        assert!(bound.patches > 300 && bound.violations == 0, "{bound:?}");
        assert!(bound.finer_polynomial.median <= 1.5 && bound.finer_rational.median <= 2.0, "{bound:?}");
    }

    /// 120 random patches: ways with a proof never exceed the budget; the plain slefe and a fixed level do.
    #[test]
    fn proofs_hold_and_habits_do_not() {
        let ways = [
            Way::Bound,
            Way::Homogeneous { cuts: 2 },
            Way::Corrected { segments: 3 },
            Way::Ipass { segments: 3 },
            Way::Fixed(16),
        ];
        let all = of_random(120, 0, &ways);
        assert!(all[0].patches > 80, "{all:?}");
        for proved in &all[..3] {
            assert_eq!(proved.violations, 0, "{proved:?}");
            assert!(proved.unanswered * 10 < proved.patches, "{proved:?}");
        }
        for habit in &all[3..] {
            assert!(habit.violations * 10 > habit.patches, "{habit:?}");
        }
    }
}
