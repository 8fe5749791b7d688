//! Faces that end at their surfaces' ends, from many sides.
//!
//! ```text
//!     ╭──╮   drum: a silhouette meets the border, where no step across      ─────┬─────   abutting: two tops in one
//!     │  │   the border is short on the screen                              left │ right  plane, walls that coincide
//!     ╰──╯                                                                       │        below their edge
//! ```

use crate::shapes::borders;
use crate::support::{assert_silent, render, watched, watched_with};
use glam::DVec3;
use selvedge::model::{Camera, Model, Projection};
use selvedge::picture::{SceneSettings, TrimWay};
use selvedge_check::{JudgeOptions, Tracer, judge};
use std::ops::Range;

const SIZE: (u32, u32) = (160, 120);

/// Number of views, spread over the sphere on a spiral.
const VIEWS: u32 = 100;

fn view(model: &Model, k: u32) -> Camera {
    let (a, b) = (f64::from(k) * 2.399_963, (f64::from(k) + 0.5) * 2.0 / f64::from(VIEWS) - 1.0);
    let from = DVec3::new(a.cos() * (1.0 - b * b).sqrt(), a.sin() * (1.0 - b * b).sqrt(), b);
    Camera::around(model.control_bounds(), from, DVec3::Z, 35f64.to_radians(), SIZE)
}

/// Each pixel of these views is within the tolerance.
fn keeps_the_promise(model: &Model, views: Range<u32>) {
    keeps_it_by(TrimWay::Table, model, views);
}

fn keeps_it_by(way: TrimWay, model: &Model, views: Range<u32>) {
    let tracer = Tracer::new(model);
    let mut renderer = watched_with(model, SceneSettings { trim: way, ..SceneSettings::default() });
    let mut faults = Vec::new();
    for k in views {
        let camera = view(model, k);
        let picture = render(&mut renderer, &camera);
        let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions::default());
        assert_eq!((picture.stats.clamps, j.given_up), (0, 0), "view {k}");
        if j.wrong + j.folds.beyond + j.folds.wrong_depth + j.exact.beyond > 0 {
            faults.push(format!("view {k}: {:?} {:?} {:?}", j.mismatches, j.folds, j.exact));
        }
    }
    assert_silent(renderer);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// If borders were pushed by the distance that moves them across themselves, a pixel of view 25 would be 0.8 px off.
#[test]
fn a_silhouette_that_meets_a_border_is_not_drawn_beyond_it() {
    keeps_the_promise(&borders::drum(1.5, 4.0), 15..45);
}

#[test]
fn a_wall_that_two_tops_hide_is_not_seen_between_them() {
    keeps_the_promise(&borders::abutting(), 50..70);
}

/// The mantle and an end meet in a silhouette; the mantle hides the end up to there. Two faults are possible. The end
/// is drawn beyond the silhouette, because its continued plane is nearer than the continued mantle. Or it is drawn
/// beside the mantle's silhouette, which is drawn narrower than it is and has no skirt.
#[test]
fn a_face_hidden_up_to_a_silhouette_is_not_seen_beyond_it() {
    let mut drum = borders::drum(1.5, 0.7);
    drum.parts[0].closed = false; // each face has a skirt, on both sides
    for &way in TrimWay::ALL {
        keeps_it_by(way, &drum, 0..VIEWS);
    }
}

/// An open shell's face has no known front. The end behind must not be drawn beyond the silhouette where its normal
/// points to the viewer.
#[test]
fn nor_where_an_open_shell_s_normals_look_inwards() {
    let mut drum = borders::drum(1.5, 0.7);
    drum.parts[0].closed = false;
    drum.parts[0].faces.iter_mut().for_each(|face| face.same_sense = !face.same_sense);
    for &way in TrimWay::ALL {
        keeps_it_by(way, &drum, 0..VIEWS);
    }
}

/// Both silhouettes are drawn narrower than they are, by less than the tolerance, and pixels' centres lie where they
/// meet: no crack, but background is visible.
#[test]
fn no_background_where_two_silhouettes_meet() {
    let size = (161, 121); // its middle column's centre is at x = 0
    let height = 3.0;
    let model = borders::drums_in_line(0.002 * height / f64::from(size.1));
    let mut renderer = watched(&model);
    let mut camera = Camera::around(model.control_bounds(), DVec3::NEG_Y, DVec3::Z, 35f64.to_radians(), size);
    camera.projection = Projection::Orthographic { height };
    camera.target = DVec3::new(0.0, 0.0, 2.0);
    camera.eye = camera.target - DVec3::Y * 10.0;
    camera.fit_depth(model.control_bounds());
    let picture = render(&mut renderer, &camera);
    let column = picture.face.iter().skip(size.0 as usize / 2).step_by(size.0 as usize);
    assert_eq!(column.filter(|&&face| face == 0).count(), 0);
    let j = judge(&Tracer::new(&model), &camera, &picture.images(), &JudgeOptions::default());
    assert_eq!((j.wrong, j.given_up), (0, 0), "{:?}", j.mismatches);
    assert_silent(renderer);
}

/// Beyond a pole, a continued face folds over: pixels there must not count as its back.
#[test]
fn a_pole_is_not_taken_for_the_face_s_back() {
    let model = borders::seamed_ball();
    let mut renderer = watched(&model);
    let mut seen = 0;
    for k in 0..12 {
        let tilt = DVec3::new(0.05 * f64::from(k), 0.02 * f64::from(k % 5), 1.0);
        let mut camera = Camera::around(model.control_bounds(), tilt, DVec3::Y, 35f64.to_radians(), SIZE);
        // so near that the picture contains no outline
        camera.projection = Projection::Perspective { fov_y: 12f64.to_radians() };
        let picture = render(&mut renderer, &camera);
        assert_eq!(picture.stats.gap_candidates, 0, "view {k}");
        seen += picture.face.iter().filter(|&&face| face == 1).count();
    }
    assert_eq!(seen, 12 * (SIZE.0 * SIZE.1) as usize);
    assert_silent(renderer);
}

/// A bar that hides a neighbour is no evidence for the drum's end.
#[test]
fn the_floor_is_not_seen_through_a_gap_beside_a_bar() {
    keeps_the_promise(&borders::barred(), 60..100);
}
