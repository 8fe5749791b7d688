//! Tolerances other than half a pixel, from the least allowed one, are held as well.

use crate::shapes;
use crate::support::{assert_silent, perspective, watched};
use selvedge::model::Model;
use selvedge::picture::{FrameSettings, Outputs};
use selvedge_check::{JudgeOptions, Judgement, Tracer, judge};

/// Pictures of the model at each tolerance; every pixel at a change of faces is judged by the tolerance in `limits`.
fn judged(model: &Model, tolerances: &[f64], limits: &[f64]) -> Vec<Judgement> {
    let mut renderer = watched(model);
    let (tracer, camera) = (Tracer::new(model), perspective(model, (320, 240)));
    let one = |(&tolerance_px, &limit_px): (&f64, &f64)| {
        let settings = FrameSettings { tolerance_px, ..FrameSettings::default() };
        let picture = renderer.render(&camera, &settings, Outputs::ALL).unwrap();
        assert_eq!(picture.stats.clamps, 0);
        judge(&tracer, &camera, &picture.images(), &JudgeOptions { limit_px, ..JudgeOptions::default() })
    };
    let all = tolerances.iter().zip(limits).map(one).collect();
    assert_silent(renderer);
    all
}

#[test]
fn every_tolerance_is_kept() {
    let tolerances = [FrameSettings::LEAST_TOLERANCE_PX, 0.2, 1.0, 4.0];
    for shape in shapes::all().iter().filter(|s| ["torus", "cylinder", "plate", "cube", "wave"].contains(&s.name)) {
        for (tolerance, j) in tolerances.iter().zip(judged(&shape.model, &tolerances, &tolerances)) {
            let worst = j.worst_shift_px.max(j.folds.worst_shift_px);
            assert_eq!(j.wrong + j.folds.beyond, 0, "{} at {tolerance} px: {worst} px", shape.name);
        }
    }
}

/// The same judge reports faults in a picture with a larger tolerance.
#[test]
fn a_coarse_picture_does_not_keep_the_least_tolerance() {
    let j = judged(&shapes::plate(), &[4.0], &[FrameSettings::LEAST_TOLERANCE_PX]);
    assert!(j[0].wrong > 0, "worst {} px", j[0].worst_shift_px);
}
