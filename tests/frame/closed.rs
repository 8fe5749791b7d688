//! Closed surfaces without trims from many sides: nothing behind them is visible where their patches and faces meet.
//! The reference decides what is there. Judging every pixel would also work, but takes too long for many views.

use crate::support::{assert_silent, render};
use crate::watched::renderer;
use crate::{cages, shapes};
use glam::{DVec2, DVec3};
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, Model};
use selvedge::picture::Picture;
use selvedge_check::Tracer;

const SIZE: (u32, u32) = (160, 120);

/// Number of views of each surface: `SELVEDGE_VIEWS`, or 24.
fn views() -> u32 {
    std::env::var("SELVEDGE_VIEWS").map_or(24, |n| n.parse().expect("SELVEDGE_VIEWS is a number"))
}

/// The `k`th of `n` views, spread over the sphere on a spiral.
fn view(model: &Model, k: u32, n: u32) -> Camera {
    let (a, b) = (f64::from(k) * 2.399_963, (f64::from(k) + 0.5) * 2.0 / f64::from(n) - 1.0);
    let from = DVec3::new(a.cos() * (1.0 - b * b).sqrt(), a.sin() * (1.0 - b * b).sqrt(), b);
    Camera { up: DVec3::new(0.3, 0.5, 0.7), ..Camera::around(model.control_bounds(), from, DVec3::Z, 0.6, SIZE) }
}

/// Pixels that may show a point behind the surface: background, or deeper than the pixels on both sides.
fn suspects(picture: &Picture, slack: f32) -> Vec<(u32, u32)> {
    let depth = |x: u32, y: u32| picture.depth[(y * SIZE.0 + x) as usize];
    let behind = |x: u32, y: u32| {
        let (inner_x, inner_y) = ((1..SIZE.0 - 1).contains(&x), (1..SIZE.1 - 1).contains(&y));
        let here = depth(x, y) - slack;
        inner_x && here > depth(x - 1, y).max(depth(x + 1, y)) || inner_y && here > depth(x, y - 1).max(depth(x, y + 1))
    };
    let all = (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y)));
    all.filter(|&(x, y)| depth(x, y).is_infinite() || behind(x, y)).collect()
}

/// Draws every view of the model; returns pixels that show something behind its surface, and the number of pixels that
/// show it.
fn cracks(renderer: &mut HeadlessRenderer, name: &str, model: &Model) -> (Vec<String>, usize) {
    let tracer = Tracer::new(model);
    renderer.upload(model).unwrap();
    let (mut wrong, mut covered) = (Vec::new(), 0);
    let slack = 0.01 * model.control_bounds().diagonal();
    for k in 0..views() {
        let camera = view(model, k, views());
        let picture = render(renderer, &camera);
        for (x, y) in suspects(&picture, slack as f32) {
            let shown = f64::from(picture.depth[(y * SIZE.0 + x) as usize]);
            let (x, y) = (f64::from(x), f64::from(y));
            let nearer = |(dx, dy): (f64, f64)| {
                tracer.first(&camera, DVec2::new(x + dx, y + dy)).is_some_and(|hit| hit.depth < shown - slack)
            };
            // corners and centre: within half a pixel of the outline, either is right
            if [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (0.5, 0.5)].into_iter().all(nearer) {
                wrong.push(format!("{name}, view {k}: pixel {x}, {y} shows what is {shown} away"));
            }
        }
        covered += picture.face.iter().filter(|id| **id != 0).count();
    }
    (wrong, covered)
}

fn nothing_shows_through<'a>(surfaces: impl IntoIterator<Item = (&'a str, &'a Model)>) {
    let (mut renderer, mut all) = (renderer(), Vec::new());
    for (name, model) in surfaces {
        let (wrong, covered) = cracks(&mut renderer, name, model);
        assert!(covered > 1500 * views() as usize, "{name}: {covered} pixels");
        all.extend(wrong);
    }
    assert_silent(renderer);
    assert!(all.is_empty(), "{} pixels:\n{}", all.len(), all.join("\n"));
}

/// Between the patches of one face.
#[test]
fn nothing_shows_through_one_face() {
    let (sphere, torus) = (shapes::sphere(), shapes::torus());
    nothing_shows_through([("sphere", &sphere), ("torus", &torus)]);
}

/// Between faces that share sides, one to one and in halves.
#[test]
fn nothing_shows_through_faces_that_share_sides() {
    let closed = cages::all();
    nothing_shows_through(closed.iter().map(|c| (c.name, &c.model)));
}
