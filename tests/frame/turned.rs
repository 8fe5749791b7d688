//! Patches of closed parts without trims that are turned away are left out, which changes no picture. The same surface
//! around a speck whose sides are not linked has nothing left out, and the same picture.

use crate::support::{assert_silent, perspective, render};
use crate::watched::renderer;
use crate::{cages, shapes};
use glam::{DAffine3, DVec3};
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, Face, Model, Projection};
use selvedge::picture::Picture;
use selvedge::spline::Surface;

const SIZE: (u32, u32) = (160, 120);
const VIEWS: u32 = 12;

/// The same part with a speck of a face just below its first one.
fn with_a_speck(model: &Model) -> Model {
    let mut model = model.clone();
    let size = model.parts[0].control_bounds().diagonal();
    let first = &model.parts[0].faces[0];
    let jet = first.surface.patches().patches[0].patch.jet(0.4, 0.3);
    let outwards = jet.du.cross(jet.dv).normalize() * if first.same_sense { 1.0 } else { -1.0 };
    let at = |x: f64, y: f64| (jet.point - outwards * 0.01 * size + DVec3::new(x, y, 0.0) * 1e-6 * size).extend(1.0);
    let corners = vec![at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0), at(1.0, 1.0)];
    let knots = || vec![0.0, 0.0, 1.0, 1.0];
    let surface = Surface::new((1, 1), knots(), knots(), corners).unwrap();
    let speck = Face { id: 999, surface, loops: Vec::new(), ..first.clone() };
    model.parts[0].faces.push(speck);
    model
}

/// Around the model, every third view parallel.
fn views(model: &Model) -> Vec<Camera> {
    let view = |k: u32| {
        let (a, b) = (f64::from(k) * 2.399_963, (f64::from(k) + 0.5) * 2.0 / f64::from(VIEWS) - 1.0);
        let from = DVec3::new(a.cos() * (1.0 - b * b).sqrt(), a.sin() * (1.0 - b * b).sqrt(), b);
        let camera = Camera::around(model.control_bounds(), from, DVec3::new(0.3, 0.5, 0.7), 0.6, SIZE);
        let height = model.control_bounds().diagonal();
        if k.is_multiple_of(3) { Camera { projection: Projection::Orthographic { height }, ..camera } } else { camera }
    };
    (0..VIEWS).map(view).collect()
}

/// The size of a pixel at the model.
fn pixel(model: &Model, camera: &Camera) -> f64 {
    match camera.projection {
        Projection::Orthographic { height } => height / f64::from(SIZE.1),
        _ => model.control_bounds().diagonal() / f64::from(SIZE.1),
    }
}

/// The same face in every pixel, at the same depth within `slack`: a side shared with a patch that is left out may have
/// fewer segments, and beside a silhouette the point under a pixel depends on them.
fn assert_same(a: &Picture, b: &Picture, slack: f64, what: &str) {
    assert!(a.face == b.face, "face {what}");
    for (i, (a, b)) in a.depth.iter().zip(&b.depth).enumerate() {
        assert!(a == b || f64::from((a - b).abs()) <= slack, "depth {what}, pixel {i}: {a} and {b}");
    }
}

fn two() -> [HeadlessRenderer; 2] {
    [(); 2].map(|()| renderer())
}

/// Compares pictures of both in all views; returns the numbers of their triangles.
fn same(renderers: &mut [HeadlessRenderer; 2], name: &str, model: &Model, views: &[Camera]) -> [u64; 2] {
    renderers[0].upload(model).unwrap();
    renderers[1].upload(&with_a_speck(model)).unwrap();
    let mut triangles = [0; 2];
    for (k, camera) in views.iter().enumerate() {
        let pictures = renderers.each_mut().map(|renderer| render(renderer, camera));
        assert_same(&pictures[0], &pictures[1], 0.1 * pixel(model, camera), &format!("{name}, view {k}"));
        triangles = [0, 1].map(|i: usize| triangles[i] + pictures[i].stats.triangles);
    }
    triangles
}

#[test]
fn no_picture_shows_it() {
    let (sphere, torus) = (shapes::sphere(), shapes::torus());
    let closed = cages::all();
    let all = [("sphere", &sphere), ("torus", &torus)].into_iter().chain(closed.iter().map(|c| (c.name, &c.model)));
    let (mut renderers, mut shares) = (two(), Vec::new());
    for (name, model) in all {
        let [drawn, others] = same(&mut renderers, name, model, &views(model));
        assert!(drawn <= others, "{name}: {drawn} triangles, {others} with a speck");
        shares.push((name, drawn as f64 / others as f64));
    }
    renderers.into_iter().for_each(assert_silent);
    let fine = |&(name, _): &&(&str, f64)| ["fine", "torus", "triangles"].contains(name);
    assert!(shares.iter().filter(fine).all(|&(_, share)| share < 0.8), "shares of the triangles: {shares:?}");
}

/// The same with mirrored, stretched and moved parts.
#[test]
fn nor_where_the_part_is_placed_otherwise() {
    let mut model = cages::a_box().model;
    let stretched = DAffine3::from_scale(DVec3::new(-1.0, 2.0, 0.5)) * DAffine3::from_rotation_x(0.7);
    model.instances[0].transform = DAffine3::from_translation(DVec3::new(30.0, -4.0, 9.0)) * stretched;
    let mut renderers = two();
    let [drawn, others] = same(&mut renderers, "a stretched box", &model, &views(&model));
    renderers.into_iter().for_each(assert_silent);
    assert!(drawn * 10 < others * 9, "{drawn} triangles, {others} with a speck");
}

/// The inside is visible if the near plane cuts the nearer part away, and from an eye inside.
#[test]
fn the_inside_is_seen() {
    let model = cages::a_box().model;
    let whole = perspective(&model, SIZE);
    let middle = (whole.eye - whole.target).length();
    let cut = Camera { depth_range: (middle, whole.depth_range.1), ..whole };
    let within = Camera { eye: whole.target, target: whole.target + DVec3::X, depth_range: (0.01, 10.0), ..whole };
    let mut renderers = two();
    let [drawn, others] = same(&mut renderers, "a box from within", &model, &[cut, within]);
    assert!(drawn <= others && others <= drawn + 4, "{drawn} triangles, {others} with a speck");
    let from_within = |picture: &Picture| picture.face.iter().filter(|&&id| id != 0).count();
    assert!(from_within(&render(&mut renderers[0], &cut)) > 500);
    assert_eq!(from_within(&render(&mut renderers[0], &within)), (SIZE.0 * SIZE.1) as usize);
    renderers.into_iter().for_each(assert_silent);
}

/// Parts that are declared closed, and are not.
#[test]
fn what_only_says_that_it_is_closed_stays() {
    let (whole, mut inverted) = (cages::a_box().model, cages::a_box().model);
    inverted.parts[0].faces.iter_mut().for_each(|face| face.same_sense = !face.same_sense);
    let (mut one_inverted, mut torn) = (whole.clone(), whole.clone());
    one_inverted.parts[0].faces[7].same_sense = !one_inverted.parts[0].faces[7].same_sense;
    torn.parts[0].faces.remove(7);
    let mut renderers = two();
    for (name, model) in [("inverted", &inverted), ("one inverted", &one_inverted), ("torn", &torn)] {
        let [drawn, others] = same(&mut renderers, name, model, &views(model));
        assert!(
            drawn <= others && others <= drawn + 2 * views(model).len() as u64,
            "{name}: {drawn}, {others} with a speck"
        );
        // nothing of a part that is not declared closed is left out, with or without the speck
        let mut open = model.clone();
        open.parts[0].closed = false;
        renderers[0].upload(&open).unwrap();
        let all: u64 = views(model).iter().map(|camera| render(&mut renderers[0], camera).stats.triangles).sum();
        assert_eq!(drawn, all, "{name}");
    }
    renderers.into_iter().for_each(assert_silent);
}
