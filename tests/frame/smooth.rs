//! Pixels of four and eight samples, against exact coverage and against the same frame sixteen times as large.
//!
//! An edge that is straight within a pixel covers `a` of it, and `k` of its `n` samples. Over all edges that cross the
//! pixel, `k / n - a` has a root mean square that depends on the places of the samples: [`expected`] integrates it, for
//! one sample 0.247, for four 0.092, for eight 0.057 of the contrast. In addition, fronts of trimmed solids are drawn
//! an eighth of the tolerance too large ([`GROWTH_PX`]). The bound is the sum of both, times [`MORE`].

use crate::edges::{blocks, contrast_errors, coverage_errors, covered, root_mean_square};
use crate::shapes::{self, solids};
use crate::support::{assert_identical, assert_silent, perspective, watched_for};
use glam::{DVec2, DVec3};
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, Model};
use selvedge::picture::{FrameSettings, Outputs, Picture, Samples, SceneSettings};
use selvedge_check::Tracer;

const SIZE: (u32, u32) = (64, 48);
/// Growth of solids' faces over their borders: a quarter of the gap radius, which is half the tolerance.
const GROWTH_PX: f64 = 0.5 * 0.5 * 0.25;
/// Factor on the expected error, for corners and curves within a pixel, eight bits of colour, and because one picture
/// has only a few hundred edges in few directions.
const MORE: f64 = 1.15;
const ALL: [Samples; 3] = [Samples::One, Samples::Four, Samples::Eight];

/// Vulkan's standard sample locations, sixteenths of a pixel from its centre.
fn places(samples: Samples) -> &'static [[i32; 2]] {
    match samples {
        Samples::One => &[[0, 0]],
        Samples::Four => &[[-2, -6], [6, -2], [-6, 2], [2, 6]],
        Samples::Eight => &[[1, -3], [-1, 3], [5, 1], [-3, -5], [-5, 5], [-7, -1], [3, 7], [7, -7]],
    }
}

/// Root mean square of covered samples less covered area, over straight edges through a pixel, with equal density in
/// angle and distance.
fn expected(samples: Samples) -> f64 {
    let places = places(samples);
    let (mut sum, mut weight) = (0.0, 0.0);
    for angle in (0..180).map(|i| (f64::from(i) + 0.5) * std::f64::consts::TAU / 180.0) {
        let normal = DVec2::from_angle(angle);
        let reach = 0.5 * (normal.x.abs() + normal.y.abs());
        for step in 0..200 {
            let offset = reach * (f64::from(step) / 100.0 - 0.995);
            let inside = |x: f64, y: f64| normal.dot(DVec2::new(x, y)) <= offset;
            let hit = |p: &&[i32; 2]| inside(f64::from(p[0]) / 16.0, f64::from(p[1]) / 16.0);
            let share = places.iter().filter(hit).count() as f64 / places.len() as f64;
            sum += reach * (share - area(normal.abs(), offset)).powi(2);
            weight += reach;
        }
    }
    (sum / weight).sqrt()
}

/// The bound, with the frame's own error.
fn bound(samples: Samples) -> f64 {
    MORE * expected(samples).hypot(GROWTH_PX)
}

/// Area of the part of the unit square around the origin within `offset` along `normal`, whose coordinates are not
/// negative.
fn area(normal: DVec2, offset: f64) -> f64 {
    let (small, large) = (normal.min_element(), normal.max_element());
    let from_corner = 0.5 * (small + large) - offset.abs();
    let cut = if from_corner < small {
        from_corner.powi(2) / (2.0 * small * large)
    } else {
        (from_corner - 0.5 * small) / large
    };
    if offset < 0.0 { cut } else { 1.0 - cut }
}

fn renderer(model: &Model, samples: Samples, outputs: Outputs) -> HeadlessRenderer {
    watched_for(outputs, model, with(samples))
}

fn with(samples: Samples) -> SceneSettings {
    SceneSettings { samples, ..SceneSettings::default() }
}

fn draw(renderer: &mut HeadlessRenderer, camera: &Camera, outputs: Outputs) -> Picture {
    renderer.render(camera, &FrameSettings::default(), outputs).unwrap()
}

/// A plate of one colour with a round hole, trimmed: a pixel's colour shows its coverage, which 16 x 16 exact rays
/// give, too.
#[test]
fn coverage_is_as_right_as_so_many_samples_can_be() {
    let model = shapes::plate();
    let tracer = Tracer::new(&model);
    let mut camera = perspective(&model, SIZE);
    camera.eye += DVec3::new(0.2, -0.4, 2.5);
    let truth = covered(&tracer, &camera);
    assert!(truth.iter().filter(|t| **t == 1.0).count() > 100);
    let errors = ALL.map(|samples| {
        let mut renderer = renderer(&model, samples, Outputs::default());
        let picture = draw(&mut renderer, &camera, Outputs::default());
        assert_silent(renderer);
        let edges = coverage_errors(&picture, &truth);
        assert!(edges.len() > 100);
        let error = root_mean_square(&edges);
        println!("{samples:?}: {error:.4} of {:.4}, {} pixels", bound(samples), edges.len());
        assert!(error <= bound(samples), "{samples:?}: {error} of {}", bound(samples));
        error
    });
    assert!(errors[1] < 0.5 * errors[0] && errors[2] < 0.8 * errors[1], "{errors:?}");
}

/// Silhouettes, creases and trims of all kinds of things: against the frame at 16 x 16 times its size, averaged in
/// linear colour.
#[test]
fn as_the_frame_sixteen_times_as_large() {
    let ball = solids::solid("A - B", vec![solids::ball(2.0, 0.0), solids::block([-3.0, -3.0, 0.3], [3.0, 3.0, 3.0])]);
    let models = [shapes::cube(), shapes::cylinder(), shapes::beside(), ball];
    for model in models {
        let camera = perspective(&model, SIZE);
        let mut renderer = renderer(&model, Samples::One, Outputs::default());
        let blocks = blocks(&mut renderer, &camera, Outputs::default());
        for samples in ALL {
            renderer.upload_with(&model, with(samples)).unwrap();
            let picture = draw(&mut renderer, &camera, Outputs::default());
            let errors = contrast_errors(&picture, &blocks);
            assert!(errors.len() > 50, "{}: {} pixels", model.name, errors.len());
            let (error, bound) = (root_mean_square(&errors), bound(samples));
            println!("{}, {samples:?}: {error:.4} of {bound:.4}, {} pixels", model.name, errors.len());
            assert!(error <= bound, "{}, {samples:?}: {error} of {bound}", model.name);
        }
        assert_silent(renderer);
    }
}

/// Images other than colour are the centre's, bit for bit; with one sample there are no objects of samples.
#[test]
fn other_images_are_the_centres() {
    let model = shapes::beside();
    let camera = perspective(&model, SIZE);
    let pictures = ALL.map(|samples| {
        let mut renderer = renderer(&model, samples, Outputs::ALL);
        let picture = draw(&mut renderer, &camera, Outputs::ALL);
        let of_samples = renderer.objects().iter().filter(|name| name.contains("sample") || *name == "average").count();
        assert_eq!(of_samples > 0, samples != Samples::One, "{:?}", renderer.objects());
        assert_silent(renderer);
        picture
    });
    for other in &pictures[1..] {
        assert!(other.colour != pictures[0].colour);
        let same_colour = Picture { colour: pictures[0].colour.clone(), ..other.clone() };
        assert_identical(&pictures[0], &same_colour, "with more samples");
    }
}
