//! Calibrated cameras with oblong pixels, and with a view axis in a corner of the picture or outside of it. Pixels and
//! lines are judged by exact rays of the same camera: trimmed faces, silhouettes, edges and solids.

use crate::edge_lines::{WIDTH, draw_next, lines, with};
use crate::shapes::{self, solids};
use crate::support::{assert_identical, assert_silent, perspective, render, watched};
use crate::watched::renderer;
use glam::{DQuat, DVec2};
use selvedge::model::{Camera, Model, Projection};
use selvedge_check::drawing::{DrawingSettings, LineImage, judge_lines};
use selvedge_check::{JudgeOptions, Tracer, judge};

const SIZE: (u32, u32) = (160, 120);
/// Focal lengths as multiples of the view's, and the principal point.
const LENSES: [(DVec2, DVec2); 4] = [
    (DVec2::new(1.0, 0.8), DVec2::new(80.0, 60.0)),
    (DVec2::new(1.0, 1.0), DVec2::new(3.25, 118.5)),
    (DVec2::new(0.9, 1.1), DVec2::new(-70.0, 40.0)),
    (DVec2::new(1.2, 1.0), DVec2::new(400.5, -90.25)),
];

/// The view from the same eye through another lens, turned until its target is in the middle again.
pub fn through(view: &Camera, (share, principal): (DVec2, DVec2)) -> Camera {
    let camera = Camera { projection: Projection::Pinhole { focal: view.focal_px() * share, principal }, ..*view };
    let (_, towards) = camera.ray(DVec2::new(f64::from(view.size.0), f64::from(view.size.1)) * 0.5);
    let (_, up, forward) = camera.axes();
    let turn = DQuat::from_rotation_arc(towards, forward);
    let distance = view.eye.distance(view.target);
    Camera { target: view.eye + turn * forward * distance, up: turn * up, ..camera }
}

/// All of the model.
fn whole(model: &Model, lens: (DVec2, DVec2)) -> Camera {
    let mut camera = through(&perspective(model, SIZE), lens);
    camera.fit_depth(model.control_bounds());
    camera
}

#[test]
fn every_pixel_is_the_exact_one() {
    let mut renderer = watched(&Model::default());
    for (nth, shape) in shapes::all().into_iter().enumerate() {
        if shape.name == "ledges" {
            continue; // walls without thickness: pixels are wrong through any lens; ledges.rs draws a parallel view
        }
        let camera = whole(&shape.model, LENSES[nth % LENSES.len()]);
        let tracer = Tracer::new(&shape.model);
        renderer.upload(&shape.model).unwrap();
        let picture = render(&mut renderer, &camera);
        let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions::default());
        assert_eq!((j.wrong, j.given_up), (0, 0), "{}: {:?}", shape.name, j.mismatches);
        let is_empty = shape.model.instances.is_empty();
        assert_eq!(j.normal_deg.count > 100, !is_empty, "{}: {} pixels", shape.name, j.normal_deg.count);
    }
    assert_silent(renderer);
}

#[test]
fn solids_are_cut_where_rays_say() {
    let mut renderer = watched(&Model::default());
    for (nth, (name, model)) in solids::quadrics().into_iter().chain(solids::odd()).enumerate() {
        let camera = whole(&model, LENSES[nth % LENSES.len()]);
        renderer.upload(&model).unwrap();
        let fault = crate::solids::faults(&mut renderer, &Tracer::new(&model), &camera, false);
        assert_eq!(fault, None, "{name}");
    }
    assert_silent(renderer);
}

/// The judge takes points beside the picture, too: through these lenses, edges leave it.
#[test]
fn lines_are_where_rays_see_them() {
    let settings = DrawingSettings { silhouettes: false, ..DrawingSettings::default() };
    let mut renderer = renderer();
    for (shape, model) in [shapes::cube(), shapes::plate(), shapes::cylinder()].into_iter().enumerate() {
        let tracer = Tracer::new(&model);
        for (lens, number) in LENSES.into_iter().zip(0..) {
            let camera = whole(&model, lens);
            let picture = draw_next(&mut renderer, (&model, with(lines())), &camera);
            let image = LineImage { lines: &picture.edge, width: WIDTH, section_width: 2.0 * WIDTH };
            let found = judge_lines(&model, &tracer, &camera, &settings, image).unwrap();
            assert!(found.visible > 100, "shape {shape}, lens {number}: {found:?}");
            assert_eq!((found.missing, found.stray), (0, 0), "shape {shape}, lens {number}: {found:?}");
        }
    }
    assert_silent(renderer);
}

/// A calibrated camera with square pixels and its axis in the middle draws the same picture as the field of view.
#[test]
fn a_centred_lens_draws_the_same_picture() {
    let model = shapes::plate();
    let view = perspective(&model, SIZE);
    let focal = view.focal_px();
    let lens = Camera { projection: Projection::Pinhole { focal, principal: DVec2::new(80.0, 60.0) }, ..view };
    let mut renderer = watched(&model);
    let [a, b] = [view, lens].map(|camera| render(&mut renderer, &camera));
    assert_identical(&a, &b, "through a lens");
    assert_silent(renderer);
}
