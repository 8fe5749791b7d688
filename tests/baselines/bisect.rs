//! Bisection of monotone pieces against exact winding numbers.

use glam::{DVec2, Vec2};
use selvedge::baselines::Sorted;
use selvedge::baselines::bisect::{Bisect, STEPS};
use selvedge::baselines::many_holes;
use selvedge::model::{Face, Model, TrimLoop};
use selvedge::spline::Bezier;
use selvedge::trim::LoopIndex;

fn face(model: &Model) -> &Face {
    &model.parts[0].faces[0]
}

/// Points of a low-discrepancy sequence. Source: M. Roberts, *The unreasonable effectiveness of
/// quasirandom sequences*, 2018 (R2).
fn points(count: u32) -> impl Iterator<Item = Vec2> {
    let at = |k: u32, step: f64| (f64::from(k) * step).fract() as f32;
    (0..count).map(move |k| Vec2::new(at(k, 0.754_877_666_246_692_7), at(k, 0.569_840_290_998_053_2)))
}

/// The number of points on the wrong side, and the largest distance of one from a curve, in units of the domain.
fn disagreements(face: &Face, (steps, sorted): (u32, Sorted), count: u32) -> (usize, f64) {
    let mut bisect = Bisect::default();
    bisect.push(face, steps, sorted);
    let index = LoopIndex::new(&face.loops);
    let ((u0, u1), (v0, v1)) = face.surface.domain();
    let size = DVec2::new(u1 - u0, v1 - v0);
    let mut wrong = (0, 0.0f64);
    for p in points(count) {
        let uv = DVec2::new(u0, v0) + p.as_dvec2() * size;
        if bisect.contains(0, p) != index.contains(uv) {
            wrong = (wrong.0 + 1, wrong.1.max(index.distance_scaled(uv, 1.0 / size, 1.0)));
        }
    }
    wrong
}

#[test]
fn sixteen_steps_are_as_exact_as_single_precision() {
    for sorted in [Sorted::Source, Sorted::Tuned] {
        for across in [1, 2, 9, 30] {
            let (_, off) = disagreements(face(&many_holes(across)), (STEPS, sorted), 100_000);
            // a few units in the last place of coordinates up to 1
            assert!(off < 4.0 * f64::from(f32::EPSILON), "{off} with {across} holes a row, {sorted:?}");
        }
    }
}

/// A quadrilateral, in shares of the sheet's side.
fn quad(side: f64, corners: [DVec2; 4]) -> TrimLoop {
    let curves = (0..4).map(|k| Bezier::line(corners[k] * side, corners[(k + 1) % 4] * side)).collect();
    TrimLoop::new(curves, DVec2::splat(1e-12)).expect("closed")
}

/// Horizontal borders within bands separate the points above from the points below.
#[test]
fn level_borders_within_bands() {
    let mut model = many_holes(9);
    let side = model.parts[0].faces[0].surface.domain().0.1;
    for k in 0..7 {
        let [lo, hi] = [0.11, 0.83].map(|x| DVec2::new(x, x) + 0.013 * f64::from(k) * DVec2::new(1.0, -0.7));
        let corners = [lo, DVec2::new(hi.x, lo.y), hi, DVec2::new(lo.x, hi.y)];
        model.parts[0].faces[0].loops.push(quad(side, corners));
    }
    let [source, tuned] = [Sorted::Source, Sorted::Tuned].map(|sorted| {
        let mut bisect = Bisect::default();
        bisect.push(face(&model), STEPS, sorted);
        bisect
    });
    assert!(tuned.bands.len() < source.bands.len());
    for p in points(100_000) {
        assert_eq!(source.contains(0, p), tuned.contains(0, p), "{p}");
    }
}

/// A border that rises by less than single precision resolves, with ends of other pieces at its height: with both ways
/// to sort, the same pieces are tested against a point.
#[test]
fn nearly_level_borders_are_sorted_as_they_are_rounded() {
    const ULP: f64 = f32::EPSILON as f64 / 2.0; // of a number from 0.5 to 1
    let mut model = many_holes(1);
    let side = model.parts[0].faces[0].surface.domain().0.1;
    // it lies 0.4 units above its rounded place
    let height = f64::from(0.6f32);
    let top = |x: f64, units: f64| DVec2::new(x, height + units * ULP);
    let mut loops = vec![quad(side, [DVec2::splat(0.1), DVec2::new(0.5, 0.1), top(0.5, 3.4), top(0.1, 0.4)])];
    // small ones beside it, whose ends are ends of bands at the heights between
    for k in [1.0, 2.0] {
        let corner = top(0.6 + 0.1 * k, k);
        loops.push(quad(
            side,
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| corner + 0.05 * DVec2::new(x, y)),
        ));
    }
    model.parts[0].faces[0].loops = loops;
    let [source, tuned] = [Sorted::Source, Sorted::Tuned].map(|sorted| {
        let mut bisect = Bisect::default();
        bisect.push(face(&model), STEPS, sorted);
        bisect
    });
    for step in -8..=8 {
        for k in 0..1000u16 {
            let p = Vec2::new(f32::from(k) / 1000.0, (height + f64::from(step) * ULP) as f32);
            assert_eq!(source.contains(0, p), tuned.contains(0, p), "{p}, {step} units from the border");
        }
    }
}

#[test]
fn each_step_is_worth_its_name() {
    let model = many_holes(2);
    let off = |steps| disagreements(face(&model), (steps, Sorted::Tuned), 200_000).1;
    // a chord of a quarter circle of radius r bulges by 0.293 r, of half of it by a quarter of that; equal steps of the
    // parameter are unequal arcs, so a little more
    let radius = 0.3 / 2.0;
    for steps in 0..4u32 {
        let bulge = radius * 0.35 / 4f64.powi(steps as i32);
        let off = off(steps);
        assert!(off <= bulge && off > bulge / 8.0, "{off} with {steps} steps, not up to {bulge}");
    }
}

#[test]
fn the_structure_stays_small() {
    let mut bisect = Bisect::default();
    bisect.push(face(&many_holes(50)), STEPS, Sorted::Tuned);
    assert_eq!(bisect.pieces.len(), 4 * 2501);
    // each piece and its control points, and twice as much for the search
    assert!(bisect.bytes() < 3 * 10_000 * (24 + 36), "{}", bisect.bytes());
}
