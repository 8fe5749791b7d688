//! Tests of the guarantee of [`factor`](super), by [`trial`](crate::fixtures).
//! `cargo bench --bench factors --features baselines` tests any number of patches, and compares other ways.

use crate::fixtures::{Emit, Kind, Trial};
use crate::twin::bound::DEPTH_SHARE;
use rayon::prelude::*;

const PATCHES: u64 = 300;
/// Lattice intervals along one side of a cell.
const FINENESS: usize = 4;
/// Degrees 1 to 5, weights up to 5 : 1.
const KIND: Kind = Kind { degrees: (1, 5), ratios: &[1.2, 5.0], tolerances: &[0.125, 0.5, 0.5, 2.0] };

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// 0 violations; and a measure of the excess: the ratio to the smallest sufficient factors of the same proportion.
#[test]
fn no_patch_deviates_by_more_than_the_budget() {
    let trials: Vec<_> = (0..PATCHES)
        .into_par_iter()
        .map(|seed| {
            let trial = Trial::random(seed, KIND);
            let unseen = trial.tau[0] == 0;
            let deviation = trial.measure(if unseen { [16; 2] } else { trial.tau }, FINENESS, Emit::Point);
            // no point of a patch that is left out is in the picture
            assert!(!unseen || deviation.points == 0, "seed {seed}: left out, but seen");
            let kept = unseen || trial.clamped() || deviation.px <= trial.allowed();
            assert!(kept, "seed {seed}: {} px", deviation.px);
            let deep = unseen || trial.clamped() || deviation.space_px <= f64::from(DEPTH_SHARE) * trial.allowed();
            assert!(deep, "seed {seed}: {} px in space", deviation.space_px);
            (trial, deviation)
        })
        .collect();
    let drawn = trials.iter().filter(|(trial, d)| trial.tau[0] > 0 && !trial.clamped() && d.points > 0).count();
    let clamped = trials.iter().filter(|(trial, _)| trial.clamped()).count();
    assert!(drawn > 220 && clamped < 10, "only {drawn} patches are in the picture, {clamped} clamped");
    let finer = |rational: bool| {
        let all = trials.par_iter().filter(|(t, d)| t.rational() == rational && d.whole && t.tau != [1, 1]);
        let quads = |[u, v]: [usize; 2]| (u * v) as f64;
        let finer = |t: &Trial| (quads(t.tau) / quads(t.smallest(t.tau, FINENESS, Emit::Point, |d| d.px))).sqrt();
        median(all.map(|(t, _)| finer(t)).collect())
    };
    let (polynomial, rational) = (finer(false), finer(true));
    println!("{drawn} patches, {clamped} clamped, 0 violations; finer than needed: {polynomial:.2}, {rational:.2}");
    assert!(polynomial < 1.5 && rational < 2.0, "{polynomial}, {rational}");
}

/// The test above can fail: with half the factors, many patches exceed the budget.
#[test]
fn half_the_factor_breaks_the_budget() {
    let broken = |seed| {
        let trial = Trial::random(seed, KIND);
        let coarse = trial.tau.map(|t| t.div_ceil(2));
        trial.tau[0] > 0 && !trial.clamped() && trial.measure(coarse, FINENESS, Emit::Point).px > trial.allowed()
    };
    let count = (0..100u64).into_par_iter().filter(|&seed| broken(seed)).count();
    assert!(count > 10, "only {count} of 100 patches deviate by more");
}
