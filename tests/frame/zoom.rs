//! Deep zoom against the exact reference: a thousand and a million times closer, at the origin and far from it; and an
//! eye close to a curved face.

use crate::off_centre::through;
use crate::shapes::borders;
use crate::support::{assert_identical, assert_silent, render, watched};
use crate::watched::{renderer, sample};
use glam::{DAffine3, DVec2, DVec3};
use selvedge::model::{Camera, Model, Projection};
use selvedge::picture::Picture;
use selvedge_check::{JudgeOptions, Tracer, judge};

const SIZE: (u32, u32) = (160, 120);

/// A view `times` closer to the point of a face at (u, v), shares of its domain; or to the start of its first loop.
fn closer(model: &Model, face: usize, at: Option<DVec2>, times: f64) -> Camera {
    let mut camera = Camera::around(model.control_bounds(), DVec3::new(1.0, -1.6, 1.1), DVec3::Z, 0.6, SIZE);
    let instance = &model.instances[0];
    let face = &model.parts[instance.part].faces[face];
    let ((u0, u1), (v0, v1)) = face.surface.domain();
    let start = || face.loops[0].curves().next().unwrap().point(0.0);
    let uv = at.map_or_else(start, |s| DVec2::new(u0 + (u1 - u0) * s.x, v0 + (v1 - v0) * s.y));
    let jet = face.surface.jet(uv.x, uv.y);
    let point = instance.transform.transform_point3(jet.point);
    // from outside, a little aside
    let sense = if face.same_sense { 1.0 } else { -1.0 };
    let normal = instance.transform.transform_vector3(jet.du.cross(jet.dv)).normalize() * sense;
    let distance = (camera.eye - camera.target).length() / times;
    camera.target = point;
    camera.eye = point + (normal + 0.4 * DVec3::new(0.3, 0.5, -0.6)).normalize() * distance;
    camera.depth_range = (distance * 0.1, camera.depth_range.1);
    camera
}

/// Moved by `by` in each coordinate.
fn moved(mut model: Model, by: f64) -> Model {
    for instance in &mut model.instances {
        instance.transform = DAffine3::from_translation(DVec3::splat(by)) * instance.transform;
    }
    model
}

fn keeps_the_promise(model: &Model, times: f64) {
    keeps_it_through(model, times, |camera| camera);
}

fn keeps_it_through(model: &Model, times: f64, lens: impl Fn(Camera) -> Camera) {
    let tracer = Tracer::new(model);
    let mut renderer = watched(model);
    let faces = model.parts[model.instances[0].part].faces.len();
    let (mut seen, mut clamps) = (0, 0);
    for face in (0..faces).step_by(faces.div_ceil(4)) {
        for at in [Some(DVec2::new(0.37, 0.61)), None] {
            let face_has_loops = !model.parts[model.instances[0].part].faces[face].loops.is_empty();
            if at.is_none() && !face_has_loops {
                continue;
            }
            let camera = lens(closer(model, face, at, times));
            let picture = render(&mut renderer, &camera);
            // a tie at the whole model's scale is not a tie here
            let options = JudgeOptions { tie: 1e-6 / times, ..JudgeOptions::default() };
            let j = judge(&tracer, &camera, &picture.images(), &options);
            assert_eq!((j.wrong, j.given_up), (0, 0), "face {face}, {at:?}: {:?}", j.mismatches);
            clamps += picture.stats.clamps;
            seen += picture.face.iter().filter(|id| **id != 0).count();
        }
    }
    assert!(seen > 3 * 160 * 120, "only {seen} pixels show a face");
    // known exception: a million times closer to the start of face 0, one strip of its trim table needs more lines than
    // possible
    assert!(clamps <= u64::from(times > 1e5), "{clamps} clamps");
    assert_silent(renderer);
}

#[test]
fn bracket_a_thousand_times_closer() {
    keeps_the_promise(&sample("bracket.step"), 1e3);
}

#[test]
fn bracket_a_million_times_closer() {
    keeps_the_promise(&sample("bracket.step"), 1e6);
}

/// Close views whose axis lies in a corner of the picture, and outside it.
#[test]
fn bracket_closer_through_lenses_off_centre() {
    let bracket = sample("bracket.step");
    let lens = |x, y| move |camera: Camera| through(&camera, (DVec2::new(1.0, 0.9), DVec2::new(x, y)));
    keeps_it_through(&bracket, 1e3, lens(2.0, 119.0));
    keeps_it_through(&bracket, 1e6, lens(-150.0, 40.0));
}

#[test]
fn bracket_a_million_times_closer_and_a_million_units_away() {
    keeps_the_promise(&moved(sample("bracket.step"), 1e6), 1e6);
}

/// While a view hardly moves, nothing is cut, uploaded or made into a table; its picture is that of a new upload.
#[test]
fn a_view_from_near_by_shares_what_was_cut() {
    let model = sample("bracket.step");
    let fov_y = 6e-4;
    let start = Camera { projection: Projection::Perspective { fov_y }, ..closer(&model, 0, None, 1.0) };
    let pixel = start.eye.distance(start.target) * fov_y / f64::from(SIZE.1);
    let mut viewer = watched(&model);
    let first = render(&mut viewer, &start);
    let makes_a_table = |picture: &Picture| picture.stats.passes.iter().any(|pass| pass.name == "trim table");
    assert!(makes_a_table(&first));
    let (mut shared, mut fresh) = (0, renderer());
    for step in 1..=6 {
        let by = DVec3::new(0.2, 0.3, 0.1) * pixel * f64::from(step);
        let camera = Camera { eye: start.eye + by, target: start.target + by, ..start };
        let picture = render(&mut viewer, &camera);
        fresh.upload(&model).unwrap();
        assert_identical(&picture, &render(&mut fresh, &camera), &format!("step {step}"));
        shared += usize::from(!makes_a_table(&picture));
    }
    assert!(shared >= 4, "{shared} of six");
    assert_silent(viewer);
    assert_silent(fresh);
}

/// An eye beside the side of a drum, within the boxes of its pieces but not at it, that looks along it and across. Rows
/// of the trim table follow the distance of the side, not of the box.
#[test]
fn an_eye_beside_a_bent_face_is_near_no_more_than_that() {
    let model = borders::drum(20.0, 50.0);
    let tracer = Tracer::new(&model);
    let mut renderer = watched(&model);
    for k in 0..12 {
        let turn = 0.4 + 0.52 * f64::from(k);
        let out = DVec3::new(turn.cos(), turn.sin(), 0.0);
        let (beside, height) = (DVec3::new(-out.y, out.x, 0.0), DVec3::Z * (10.0 + 3.0 * f64::from(k)));
        let eye = 20.3 * out + height;
        let target = eye + beside - 0.4 * out + 0.3 * DVec3::Z;
        let mut camera =
            Camera { eye, target, ..Camera::around(model.control_bounds(), DVec3::X, DVec3::Z, 0.6, SIZE) };
        camera.fit_depth(model.control_bounds());
        let picture = render(&mut renderer, &camera);
        let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions::default());
        assert_eq!((j.wrong, picture.stats.clamps), (0, 0), "view {k}: {} rows", picture.stats.trim_rows);
        assert!(picture.stats.trim_rows > 0, "view {k}");
    }
    assert_silent(renderer);
}
