//! Smooth borders: pixels at the borders of faces, silhouettes and folds, against exact rays and against the same frame
//! sixteen times as large.
//!
//! A pixel mixes only surfaces that it or its neighbours see. Corners smaller than a pixel, and holes that no pixel's
//! centre sees through, are missing.

use crate::edges::{blocks, contrast_errors, coverage_errors, covered, root_mean_square};
use crate::shapes;
use crate::support::{assert_identical, assert_silent, orthographic, perspective, render, render_next, watched_for};
use crate::watched::{limited, renderer};
use glam::DVec3;
use selvedge::construct::lathe;
use selvedge::gpu::LowerLimits;
use selvedge::model::{Camera, Model, Projection, SurfaceKind};
use selvedge::picture::{FrameSettings, Outputs, Picture, Samples, SceneSettings, Smooth, TrimWay};
use selvedge::spline::BSpline;
use selvedge_check::Tracer;
use std::f64::consts::TAU;

const SIZE: (u32, u32) = (96, 72);

fn settings(smooth: Smooth, trim: TrimWay) -> SceneSettings {
    SceneSettings { smooth, trim, ..SceneSettings::default() }
}

/// A plate with a round hole: straight and bent trims before nothing.
#[test]
fn outlines_cover_what_exact_rays_say() {
    let model = shapes::plate();
    let tracer = Tracer::new(&model);
    let mut renderer = renderer();
    for camera in [perspective(&model, SIZE), orthographic(&model, SIZE)] {
        let truth = covered(&tracer, &camera);
        for way in TrimWay::ALL.iter().copied() {
            let mut errors =
                |smooth| coverage_errors(&render_next(&mut renderer, &model, settings(smooth, way), &camera), &truth);
            let (rough, smooth) = (errors(Smooth::None), errors(Smooth::Borders));
            let mean = smooth.iter().map(|e| e.abs()).sum::<f64>() / smooth.len() as f64;
            let far = smooth.iter().filter(|e| e.abs() > 0.125).count();
            let (rough, rms) = (root_mean_square(&rough), root_mean_square(&smooth));
            println!("{way:?}: {rough:.4}, {rms:.4}; mean {mean:.4}, {far} of {}", smooth.len());
            assert!(smooth.len() > 60 && rough > 0.2, "{rough}");
            // coverage by sixteen points is least exact for lines along rows of pixels, which the plate has; colours
            // add the rounding to eight bits
            let bound = 1.0 / 24.0;
            assert!(mean <= bound && far == 0, "{way:?}: {rms} of {rough}, mean {mean}, {far} far off");
        }
    }
    assert_silent(renderer);
}

/// The middle of the parallel view: half as wide and high, and as many pixels to a length.
fn middle(model: &Model) -> Camera {
    let height = 0.5 * model.control_bounds().diagonal();
    let projection = Projection::Orthographic { height };
    Camera { projection, ..perspective(model, (SIZE.0 / 2, SIZE.1 / 2)) }
}

/// Faces that meet, hide each other and themselves.
#[test]
fn borders_are_as_the_frame_sixteen_times_as_large() {
    let mut cube = shapes::cube();
    for (i, face) in cube.parts[0].faces.iter_mut().enumerate() {
        let on = |bit: usize| if (i + 1) & bit != 0 { 0.9 } else { 0.1 };
        face.colour = Some([on(1), on(2), on(4), 1.0]);
    }
    let ground = shapes::solids::solid(
        "A - B",
        vec![shapes::solids::block([-1.0; 3], [1.0, 1.0, 0.4]), shapes::solids::ball(0.9, 0.6)],
    );
    let models = [
        (cube, 0.2),
        (shapes::cylinder(), 0.25),
        (shapes::wave(), 0.25),
        // a face and a mesh, a mesh that hides itself, one of many facets, and a Boolean solid
        (shapes::beside(), 0.25),
        (shapes::whole_mesh("torus", shapes::torus_mesh(24)), 0.25),
        (shapes::whole_mesh("ball", shapes::ball_mesh(5)), 0.25),
        (ground, 0.25),
    ];
    let mut renderer = renderer();
    for (model, bound) in models {
        // the large picture is what this test costs: the parallel view of meshes is a quarter as large
        let has_meshes = model.parts.iter().any(|part| !part.meshes.is_empty());
        let parallel = if has_meshes { middle(&model) } else { orthographic(&model, SIZE) };
        for camera in [perspective(&model, SIZE), parallel] {
            renderer.upload_with(&model, settings(Smooth::None, TrimWay::Auto)).unwrap();
            let blocks = blocks(&mut renderer, &camera, Outputs::ALL);
            let rough = contrast_errors(&render(&mut renderer, &camera), &blocks);
            let smooth = render_next(&mut renderer, &model, settings(Smooth::Borders, TrimWay::Auto), &camera);
            let smooth = contrast_errors(&smooth, &blocks);
            let pixels = rough.len();
            let (rough, smooth) = (root_mean_square(&rough), root_mean_square(&smooth));
            println!("{}: {rough:.4}, smooth {smooth:.4}, {pixels} pixels", model.name);
            assert!(pixels > 50 && smooth <= bound * rough, "{}: {smooth} of {rough}", model.name);
        }
    }
    assert_silent(renderer);
}

/// A grip: a cubic profile of four pieces, turned, with a pole at its end.
fn grip() -> Model {
    let corners = [(3.0, 6.0), (6.57, 6.71), (6.66, 15.9), (9.69, 25.1), (6.36, 35.5), (4.35, 40.0), (0.0, 40.0)];
    let knots = vec![0.0, 0.0, 0.0, 0.0, 8.9, 21.0, 31.3, 38.6, 38.6, 38.6, 38.6];
    let points = corners.map(|(radius, height)| DVec3::new(radius, height, 1.0)).to_vec();
    let profile = BSpline::new(3, knots, points).expect("a profile");
    let surface = lathe(&profile, TAU).expect("a surface");
    shapes::one("grip", false, vec![shapes::face(1, SurfaceKind::Revolution, surface)])
}

/// Where one patch of a face folds, the patch before it may go on beyond the fold: that is not the face. If it counted,
/// the worst errors of these views would be 0.83 and 0.69, and 0.15 and 0.17 in the mean.
#[test]
fn a_patch_is_not_followed_into_the_next_one() {
    let model = grip();
    let mut renderer = renderer();
    let target = DVec3::new(0.0, 0.0, 23.0);
    for from in [DVec3::new(-0.4752, -0.044, 0.8787), DVec3::new(0.3002, -0.2279, 0.9263)] {
        let mut camera = Camera { eye: target + 80.0 * from, target, ..perspective(&model, SIZE) };
        camera.fit_depth(model.control_bounds());
        renderer.upload_with(&model, settings(Smooth::None, TrimWay::Auto)).unwrap();
        let blocks = blocks(&mut renderer, &camera, Outputs::ALL);
        let smooth = render_next(&mut renderer, &model, settings(Smooth::Borders, TrimWay::Auto), &camera);
        let errors = contrast_errors(&smooth, &blocks);
        let (worst, mean) = (errors.iter().copied().fold(0.0, f64::max), root_mean_square(&errors));
        println!("from {from}: {worst:.3}, {mean:.3} in the mean of {} pixels", errors.len());
        // sixteen points measure a straight line to 0.14 at worst, and each may be off by an eighth of a pixel
        assert!(errors.len() > 50 && worst <= 0.4 && mean <= 0.1, "from {from}: {worst}, {mean}");
    }
    assert_silent(renderer);
}

/// All images but the colour are the same with and without smooth borders, bit for bit. The colour stays at pixels that
/// see nothing, as their eight neighbours do, and at pixels whose neighbours see the same face in a nearly straight
/// slope. Of a mesh or a solid, which have creases, the neighbours must have one colour, too.
#[test]
fn nothing_else_changes() {
    let (width, height) = (SIZE.0 as usize, SIZE.1 as usize);
    let (mut alone, mut on_faces) = (0, 0);
    let mut renderer = renderer();
    for shape in shapes::all() {
        let camera = perspective(&shape.model, SIZE);
        let [before, after] = [Smooth::None, Smooth::Borders]
            .map(|smooth| render_next(&mut renderer, &shape.model, settings(smooth, TrimWay::Exact), &camera));
        let same_colour = Picture { colour: before.colour.clone(), stats: before.stats.clone(), ..after.clone() };
        assert_identical(&before, &same_colour, shape.name);
        let has_creases =
            !shape.model.solids.is_empty() || shape.model.parts.iter().any(|part| !part.meshes.is_empty());
        let straight = |i: usize| {
            [1, width - 1, width, width + 1].iter().all(|way| {
                let [a, b] = [before.depth[i - way], before.depth[i + way]].map(|depth| depth - before.depth[i]);
                (a + b).abs() <= 0.25 * (b - a).abs()
            })
        };
        for (x, y) in (1..height - 1).flat_map(|y| (1..width - 1).map(move |x| (x, y))) {
            let i = y * width + x;
            let around = (0..9).map(|k| before.face[(y + k / 3 - 1) * width + x + k % 3 - 1]);
            let same = around.into_iter().all(|face| face == before.face[i]);
            // placed copies share the number of a face, so models with several are left out
            let one = before.face[i] == 0 || shape.model.instances.len() == 1 && straight(i);
            let even = (0..9).all(|k| before.colour[(y + k / 3 - 1) * width + x + k % 3 - 1] == before.colour[i]);
            if same && one && (even || !has_creases) {
                alone += 1;
                on_faces += usize::from(before.face[i] != 0);
                assert_eq!(before.colour[i], after.colour[i], "{}: pixel {x} {y}", shape.name);
            }
        }
    }
    assert!(alone > 10_000 && on_faces > 1000, "{alone}, {on_faces} of them on faces");
    assert_silent(renderer);
}

/// Passes, images and lists exist where borders are smoothed, and there are faces; several samples need none.
#[test]
fn only_smooth_borders_have_what_they_need() {
    let of_borders = |model: &Model, settings: SceneSettings| {
        let mut renderer = watched_for(Outputs::default(), model, settings);
        renderer.render(&perspective(model, SIZE), &FrameSettings::default(), Outputs::default()).unwrap();
        let objects = renderer.objects();
        assert_silent(renderer);
        let of_all = ["resolved", "linear_show"];
        objects
            .iter()
            .filter(|o| o.starts_with("border ") && *o != "border depths" || of_all.contains(&o.as_str()))
            .count()
    };
    let smooth = settings(Smooth::Borders, TrimWay::Auto);
    // four passes, the image, the list and its grids
    assert_eq!(of_borders(&planes(), smooth), 7);
    assert_eq!(of_borders(&shapes::plate(), smooth), 7);
    // two passes more, and three lists
    assert_eq!(of_borders(&shapes::wave(), smooth), 12);
    assert_eq!(of_borders(&shapes::plate(), settings(Smooth::None, TrimWay::Auto)), 0);
    assert_eq!(of_borders(&shapes::plate(), SceneSettings { samples: Samples::Four, ..smooth }), 0);
    // no patches, but a mesh or a solid, the mean of the points, and these
    let mesh = shapes::whole_mesh("ball", shapes::ball_mesh(1));
    assert_eq!(of_borders(&shapes::solids::holes(2), smooth), 9);
    assert_eq!(of_borders(&mesh, smooth), 9);
    assert_eq!(of_borders(&mesh, settings(Smooth::None, TrimWay::Auto)), 0);
    // a plane and a mesh; a curved face and a mesh, whose points have one pass and two lists
    let mut beside = planes();
    beside.parts[0].meshes = vec![shapes::block_mesh(DVec3::splat(-0.5), DVec3::splat(1.2), 7)];
    assert_eq!(of_borders(&beside, smooth), 10);
    assert_eq!(of_borders(&shapes::beside(), smooth), 13);
}

/// Faces of one plane patch each, without trims.
fn planes() -> Model {
    let mut model = shapes::cube();
    model.parts[0].closed = false;
    model.parts[0].faces.iter_mut().for_each(|face| face.loops.clear());
    model
}

/// Less room than a list of the whole picture takes: rows of it one after another, the same bit for bit.
#[test]
fn bands_make_the_same_picture() {
    let size = (500, 80);
    let solid = shapes::solids::holes(2);
    let mesh = shapes::whole_mesh("torus", shapes::torus_mesh(24));
    let mut unlimited = renderer();
    // `bytes` hold 40 rows, and a band takes 32 of them. At least `least` pixels are mixed: the spline torus has fewer,
    // because it has outlines alone.
    for (model, bytes, least) in [
        (shapes::plate(), 12 * 500 * 40, 200),
        (shapes::torus(), 12 * 500 * 40, 100),
        (shapes::beside(), 128 * 500 * 40, 200),
        (mesh, 128 * 500 * 40, 200),
        (solid, 128 * 500 * 40, 200),
    ] {
        let camera = perspective(&model, size);
        let smooth = settings(Smooth::Borders, TrimWay::Exact);
        let mut in_bands = limited(LowerLimits { storage_range: Some(bytes), ..LowerLimits::NONE });
        in_bands.upload_with(&model, smooth).unwrap();
        let banded = render(&mut in_bands, &camera);
        let pixels = in_bands.objects().iter().filter(|name| *name == "border pixels").count();
        assert_eq!(pixels, 2, "{}: as many lists", model.name);
        assert_silent(in_bands);
        let whole = render_next(&mut unlimited, &model, smooth, &camera);
        assert_identical(&whole, &banded, &model.name);
        let rough = render_next(&mut unlimited, &model, settings(Smooth::None, TrimWay::Exact), &camera);
        let mixed = whole.colour.iter().zip(&rough.colour).filter(|(a, b)| a != b).count();
        assert!(mixed > least, "{}: {mixed} pixels are mixed", model.name);
    }
    assert_silent(unlimited);
}
