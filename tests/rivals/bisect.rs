//! Bisection of monotone pieces against exact winding numbers.

use glam::{DVec2, Vec2};
use selvedge::model::{Face, Model};
use selvedge::picture::Sorted;
use selvedge::rivals::bisect::{Bisect, STEPS};
use selvedge::rivals::many_holes;
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

/// Points on the wrong side, and the farthest of them from a curve, in units of the domain.
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

#[test]
fn each_step_is_worth_its_name() {
    let model = many_holes(2);
    let off = |steps| disagreements(face(&model), (steps, Sorted::Tuned), 200_000).1;
    // a chord of a quarter circle of radius r bulges by 0.293 r, of a half of it by a quarter of that; equal
    // steps of the parameter are unequal arcs, so a little more
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
