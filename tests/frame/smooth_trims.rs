//! Smooth trims: coverage of pixels at trim curves, against exact rays and against the same frame sixteen times as large.
//!
//! The share is exact except for the errors that `src/twin/coverage.rs` states. The remaining error is that of
//! eight-bit colours, of the reference's own 16 x 16 points, and of pixels with more than one border of the face at
//! their centre.

use crate::edges::{blocks, contrast_errors, coverage_errors, covered, linear, root_mean_square};
use crate::shapes;
use crate::support::{
    assert_identical, assert_silent, orthographic, perspective, plain, render, render_next, render_with, watched_for,
};
use crate::watched::renderer;
use glam::{DVec2, DVec3};
use selvedge::headless::{HeadlessError, HeadlessOptions, HeadlessRenderer};
use selvedge::model::{Camera, LoopAt, Model, Projection, TrimLoop};
use selvedge::picture::{FrameSettings, Highlight, Outputs, Picture, Samples, SceneSettings, Smooth, TrimWay};
use selvedge::renderer::RenderError;
use selvedge::spline::{Bezier, Control};
use selvedge_check::Tracer;

const SIZE: (u32, u32) = (64, 48);

const PLAIN: SceneSettings = plain(TrimWay::Exact);
const SMOOTH: SceneSettings = SceneSettings { smooth: Smooth::Trims, ..PLAIN };

/// The plate's outline, and round holes: centre and radius.
fn holes(holes: &[(DVec2, f64)]) -> Model {
    let mut model = shapes::plate();
    let loops = &mut model.parts[0].faces[0].loops;
    let (lo, hi) = loops[1].bounds();
    let (centre, radius) = (0.5 * (lo + hi), 0.5 * (hi.x - lo.x));
    let hole = loops.remove(1);
    loops.extend(holes.iter().map(|&(at, size)| {
        let moved = |p: &DVec3| DVec3::from_point(at + (p.point() - centre) * (size / radius), p.z);
        let curves = hole.curves().map(|c| Bezier { points: c.points.iter().map(moved).collect() });
        TrimLoop::new(curves.collect(), DVec2::splat(1e-12)).unwrap()
    }));
    model
}

/// Views from above, from the side, from near, and in parallel.
fn views(model: &Model) -> Vec<(&'static str, Camera)> {
    let above = perspective(model, SIZE);
    let moved = |by: DVec3| Camera { eye: above.eye + by, ..above };
    let near = Camera { projection: Projection::Perspective { fov_y: 0.3 }, ..above };
    vec![
        ("above", moved(DVec3::new(0.2, -0.4, 2.5))),
        ("beside", moved(DVec3::new(0.7, 0.3, -0.9))),
        ("near", near),
        ("parallel", orthographic(model, SIZE)),
    ]
}

/// A plate with a round hole, straight and curved borders. For comparison, eight samples are off by 0.06 (`smooth.rs`).
#[test]
fn a_plates_borders_cover_what_exact_rays_say() {
    let model = shapes::plate();
    let tracer = Tracer::new(&model);
    let mut renderer = renderer();
    for (name, camera) in views(&model) {
        let truth = covered(&tracer, &camera);
        let mut error = |settings| {
            let errors = coverage_errors(&render_next(&mut renderer, &model, settings, &camera), &truth);
            (root_mean_square(&errors), errors.iter().fold(0.0f64, |a, e| a.max(e.abs())), errors.len())
        };
        let (rough, (smooth, worst, pixels)) = (error(PLAIN).0, error(SMOOTH));
        println!("{name}: {rough:.4}, smooth {smooth:.4}, worst {worst:.3}, {pixels} pixels");
        assert!(pixels > 60 && rough > 0.2, "{name}: {rough}, {pixels}");
        assert!(smooth <= 0.02, "{name}: {smooth}");
    }
    assert_silent(renderer);
}

/// Faces of a solid that meet at an edge, each with its own colour; borders without a trim curve stay as they are.
#[test]
fn solids_are_as_the_frame_sixteen_times_as_large() {
    let mut cube = shapes::cube();
    for (i, face) in cube.parts[0].faces.iter_mut().enumerate() {
        let on = |bit: usize| if (i + 1) & bit != 0 { 0.9 } else { 0.1 };
        face.colour = Some([on(1), on(2), on(4), 1.0]);
    }
    let mut renderer = renderer();
    for (model, bound) in [(cube, 0.1), (shapes::cylinder(), 0.8), (shapes::beside(), 0.95)] {
        for camera in [perspective(&model, SIZE), orthographic(&model, SIZE)] {
            renderer.upload_with(&model, PLAIN).unwrap();
            let blocks = blocks(&mut renderer, &camera, Outputs::ALL);
            let rough = contrast_errors(&render(&mut renderer, &camera), &blocks);
            let smooth = contrast_errors(&render_next(&mut renderer, &model, SMOOTH, &camera), &blocks);
            let worse = rough.iter().zip(&smooth).fold(0.0f64, |a, (r, s)| a.max(s - r));
            let pixels = rough.len();
            let (rough, smooth) = (root_mean_square(&rough), root_mean_square(&smooth));
            println!("{}: {rough:.4}, smooth {smooth:.4}, {pixels} pixels, worse by {worse:.3}", model.name);
            assert!(pixels > 50 && smooth <= bound * rough, "{}: {smooth} of {rough}", model.name);
            assert!(worse < 0.1, "{}: a pixel is worse by {worse}", model.name);
        }
    }
    assert_silent(renderer);
}

/// Holes of half a pixel to one and a half, 5 x 5 of each size; holes without a pixel's centre are not visible.
#[test]
fn small_holes() {
    let mut renderer = renderer();
    for (radius, bound) in [(0.5, 0.15), (1.0, 0.08), (1.5, 0.08)] {
        let camera = |model: &Model| {
            Camera::around(model.control_bounds(), DVec3::new(0.1, -0.2, 1.0), DVec3::Y, 0.6, (160, 120))
        };
        let model = shapes::plate();
        let px = {
            let camera = camera(&model);
            let pixel = |p: DVec3| camera.project(p).expect("in front of the eye").0;
            pixel(DVec3::X * 0.01).distance(pixel(DVec3::ZERO)) / 0.01
        };
        let at = |i: i32| DVec2::new(f64::from(i % 5 - 2) * 1.137, f64::from(i / 5 - 2) * 1.129);
        let model = holes(&(0..25).map(|i| (at(i), radius / px)).collect::<Vec<_>>());
        let camera = camera(&model);
        let truth = covered(&Tracer::new(&model), &camera);
        let mut error = |settings| {
            root_mean_square(&coverage_errors(&render_next(&mut renderer, &model, settings, &camera), &truth))
        };
        let (rough, smooth) = (error(PLAIN), error(SMOOTH));
        println!("radius {radius} px ({px:.1} px a unit): {rough:.4}, smooth {smooth:.4}");
        assert!(smooth <= bound && smooth <= rough, "{radius}: {smooth} of {rough}");
    }
    assert_silent(renderer);
}

/// Images other than colour are as without smoothing, bit for bit, and so is the colour of pixels farther than 1.5 px
/// from another face: pixels whose eight neighbours show the same face.
#[test]
fn nothing_else_changes() {
    let mut renderer = renderer();
    for shape in shapes::all() {
        let cameras = [perspective(&shape.model, SIZE), orthographic(&shape.model, SIZE)];
        let [before, after] = [PLAIN, SMOOTH].map(|settings| {
            renderer.upload_with(&shape.model, settings).unwrap();
            cameras.map(|camera| render(&mut renderer, &camera))
        });
        for (before, after) in before.into_iter().zip(after) {
            let same_colour = Picture { colour: before.colour.clone(), stats: before.stats.clone(), ..after.clone() };
            assert_identical(&before, &same_colour, shape.name);
            let (width, height) = (SIZE.0 as i32, SIZE.1 as i32);
            let mut changed = 0;
            for (i, face) in before.face.iter().enumerate() {
                let (x, y) = (i as i32 % width, i as i32 / width);
                let beside = (0..9).map(|k| (x + k % 3 - 1, y + k / 3 - 1));
                let mut beside = beside.filter(|(x, y)| (0..width).contains(x) && (0..height).contains(y));
                let alone = beside.all(|(x, y)| before.face[(y * width + x) as usize] == *face);
                // several placed copies have one face's number
                let copies = shape.model.instances.len() > 1;
                assert!(!alone || copies || before.colour[i] == after.colour[i], "{}: pixel {x} {y}", shape.name);
                changed += usize::from(before.colour[i] != after.colour[i]);
            }
            if !shape.trimmed {
                assert_eq!(changed, 0, "{}", shape.name);
            }
        }
    }
    assert_silent(renderer);
}

/// Image, pass and pipeline exist if trims are smoothed and there are some.
#[test]
fn only_smooth_trims_have_what_they_need() {
    let camera = |model: &Model| perspective(model, SIZE);
    for (model, settings, has) in
        [(shapes::plate(), SMOOTH, true), (shapes::plate(), PLAIN, false), (shapes::wave(), SMOOTH, false)]
    {
        let mut renderer = watched_for(Outputs::default(), &model, settings);
        renderer.render(&camera(&model), &FrameSettings::default(), Outputs::default()).unwrap();
        let objects = renderer.objects();
        let of_coverage: Vec<_> =
            objects.iter().filter(|o| *o == "coverage" || *o == "resolved" || o.contains("unmixed")).collect();
        // the pass, its image, and the pipeline that draws into it
        assert_eq!(of_coverage.len(), if has { 3 } else { 0 }, "{}: {of_coverage:?}", model.name);
        assert_silent(renderer);
    }
}

#[test]
fn a_loop_that_is_edited_is_smooth_at_once() {
    let model = holes(&[(DVec2::new(0.3, 0.6), 0.9)]);
    let edited = holes(&[(DVec2::new(-0.6, 0.3), 1.2)]);
    let camera = perspective(&model, SIZE);
    let settings = SceneSettings { editable: true, ..SMOOTH };
    let mut renderer = watched_for(Outputs::default(), &model, settings);
    renderer.render(&camera, &FrameSettings::default(), Outputs::default()).unwrap();
    let at = LoopAt { part: 0, face: 0, trim_loop: 1 };
    renderer.edit_loop(at, &edited.parts[0].faces[0].loops[1]).unwrap();
    let after = renderer.render(&camera, &FrameSettings::default(), Outputs::ALL).unwrap();
    assert_silent(renderer);
    assert_identical(&render_with(&edited, settings, &camera), &after, "after the edit");
    assert!(after.colour.iter().any(|c| (0.3..0.9).contains(&linear(*c).x)));
}

#[test]
fn what_does_not_go_with_it_is_refused() {
    let mut renderer = HeadlessRenderer::new(&HeadlessOptions::default()).unwrap();
    let mut refused = |settings: SceneSettings| match renderer.upload_with(&shapes::beside(), settings) {
        Err(HeadlessError::Render(RenderError::SmoothTrims(what))) => what.to_owned(),
        other => panic!("{other:?}"),
    };
    assert!(refused(SceneSettings { samples: Samples::Four, ..SMOOTH }).contains("samples"));
    assert!(refused(SceneSettings { trim: TrimWay::Table, ..SMOOTH }).contains("exact"));
    let marked = SceneSettings { highlight: Some(Highlight::default()), ..SMOOTH };
    let refused = renderer.upload_with(&shapes::solids::holes(2), marked);
    assert!(matches!(refused, Err(HeadlessError::Render(RenderError::SmoothTrims(what))) if what.contains("mark")));
    renderer.upload_with(&shapes::beside(), SceneSettings { trim: TrimWay::Auto, ..SMOOTH }).unwrap();
}
