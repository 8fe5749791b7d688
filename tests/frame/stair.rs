//! Untrimmed faces beside trimmed ones: `gap_fill` evaluates their surfaces at neighbouring gap candidates, and a
//! surface continues beyond its face's end.
//!
//! ```text
//!        ─────────┐ 1, trimmed
//!   ══════════════╪ ─ ─ ─ ─   3, untrimmed: its surface reaches the pixels beyond the corner
//!        ─────────┘ 2
//! ```

use crate::shapes;
use crate::support::{assert_silent, render, watched};
use glam::DVec3;
use selvedge::model::Camera;
use selvedge_check::{JudgeOptions, Tracer, judge};

/// Sides nearly parallel to the rays, thinner than a pixel at their far ends: none may be drawn beyond its end.
#[test]
fn a_face_without_trims_ends_where_its_surface_ends() {
    let model = shapes::stair();
    let tracer = Tracer::new(&model);
    let mut renderer = watched(&model);
    for from in [DVec3::new(1.0, -1.5, 1.5), DVec3::new(-0.4, -1.0, 0.35), DVec3::new(0.7, 1.0, -0.6)] {
        let camera = Camera::around(model.control_bounds(), from, DVec3::Z, 30f64.to_radians(), (480, 360));
        let picture = render(&mut renderer, &camera);
        let judgement = judge(&tracer, &camera, &picture.images(), &JudgeOptions::default());
        assert_eq!((judgement.wrong, judgement.given_up), (0, 0), "from {from}: {:?}", judgement.mismatches);
        assert!(picture.stats.gap_candidates > 100, "from {from}: there are few gap candidates");
    }
    assert_silent(renderer);
}
