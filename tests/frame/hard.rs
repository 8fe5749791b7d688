//! Surfaces and views with extreme numbers, against the exact reference. Others of this kind: `distance` (far from the
//! origin), `zoom` (parameters that single precision does not resolve), `room` (factors above 64).

use crate::shapes::{self, one};
use crate::support::{assert_silent, render, watched};
use glam::{DAffine3, DVec2, DVec3, DVec4};
use selvedge::model::{Camera, Face, Instance, Model, Projection, SurfaceKind};
use selvedge::picture::Picture;
use selvedge::spline::{Control, SplineError, Surface};
use selvedge_check::{JudgeOptions, Tracer, judge};

const SIZE: (u32, u32) = (160, 120);

fn face(surface: Surface) -> Model {
    let face = Face { id: 1, kind: SurfaceKind::BSpline, surface, loops: Vec::new(), same_sense: true, colour: None };
    one("hard", false, vec![face])
}

fn bezier(n: usize, k: usize, point: impl Fn(usize, usize) -> DVec4) -> Surface {
    let net = (0..=k).flat_map(|j| (0..=n).map(move |i| (i, j))).map(|(i, j)| point(i, j)).collect();
    let knots = |degree: usize| [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
    Surface::new((n, k), knots(n), knots(k), net).unwrap()
}

/// From `eye` to `target`, everything farther than `near`.
fn view(eye: DVec3, target: DVec3, near: f64) -> Camera {
    let projection = Projection::Perspective { fov_y: 0.9 };
    Camera { eye, target, up: DVec3::new(0.1, 0.2, 1.0), projection, depth_range: (near, 100.0), size: SIZE }
}

/// Every pixel is right, every number finite, nothing clamped; returns the picture.
fn draw(model: &Model, camera: &Camera) -> Picture {
    let mut renderer = watched(model);
    let picture = render(&mut renderer, camera);
    assert_eq!(picture.stats.clamps, 0);
    let j = judge(&Tracer::new(model), camera, &picture.images(), &JudgeOptions::default());
    assert_eq!((j.wrong, j.given_up), (0, 0), "{:?}", j.mismatches);
    for i in (0..picture.face.len()).filter(|&i| picture.face[i] != 0) {
        let length = picture.normal[i].iter().map(|x| x * x).sum::<f32>().sqrt();
        assert!((length - 1.0).abs() < 1e-3, "normal {:?}", picture.normal[i]);
        assert!(picture.depth[i].is_finite() && picture.uv[i].iter().all(|x| x.is_finite()));
    }
    assert_silent(renderer);
    picture
}

fn covered(picture: &Picture) -> usize {
    picture.face.iter().filter(|id| **id != 0).count()
}

/// The middle pixels show the pole: the normal there is the axis, although `S_u` vanishes.
#[test]
fn a_pole_seen_from_above() {
    let picture = draw(&shapes::sphere(), &view(DVec3::new(0.0, 0.0, 7.0), DVec3::ZERO, 0.5));
    let middle = picture.normal[(SIZE.1 / 2 * SIZE.0 + SIZE.0 / 2) as usize];
    assert!(middle[2] > 0.9999, "{middle:?}");
}

/// All control points of one side coincide, and the normal there is undefined.
#[test]
fn the_apex_of_a_cone() {
    let rim = |i: usize| [(1.0, 0.0), (1.0, 1.0), (0.0, 1.0)][i];
    let weight = [1.0, std::f64::consts::FRAC_1_SQRT_2, 1.0];
    let point = |i: usize, j: usize| {
        let r = 1.0 - j as f64;
        DVec4::from_point(DVec3::new(rim(i).0 * r, rim(i).1 * r, j as f64), weight[i])
    };
    let picture = draw(&face(bezier(2, 1, point)), &view(DVec3::new(2.0, 1.5, 1.2), DVec3::new(0.2, 0.2, 0.8), 0.1));
    assert!(covered(&picture) > 1000);
}

/// Neighbouring control points coincide inside the net and at a corner: derivatives vanish there.
#[test]
fn coincident_control_points() {
    let at = [0.0, 0.0, 1.0, 1.0];
    let point = |i: usize, j: usize| DVec4::new(at[i], at[j], if (i, j) == (2, 2) { 0.7 } else { 0.0 }, 1.0);
    let picture = draw(&face(bezier(3, 3, point)), &view(DVec3::new(0.4, -1.0, 1.2), DVec3::new(0.5, 0.5, 0.0), 0.1));
    assert!(covered(&picture) > 2000);
}

/// The net turns back over itself: two sheets and a fold between them.
#[test]
fn a_folded_patch() {
    let x = [0.0, 2.0, -1.0, 1.0];
    let point = |i: usize, j: usize| DVec4::new(x[i], j as f64 / 2.0, i as f64 * 0.15, 1.0);
    let picture = draw(&face(bezier(3, 2, point)), &view(DVec3::new(0.3, -1.0, 2.0), DVec3::new(0.5, 0.5, 0.2), 0.1));
    assert!(covered(&picture) > 1500);
}

/// Two triangles for any degree: bicubic, and flat with even control points.
#[test]
fn a_flat_patch_is_two_triangles() {
    let point = |i: usize, j: usize| DVec4::new(i as f64, j as f64, 0.5 * i as f64, 1.0);
    let picture = draw(&face(bezier(3, 3, point)), &view(DVec3::new(1.0, -3.0, 5.0), DVec3::new(1.5, 1.5, 0.5), 0.1));
    assert_eq!(picture.stats.triangles, 2);
}

/// The eye in the plate's plane, and a hair above it.
#[test]
fn seen_edge_on() {
    for height in [0.0, 1e-4, 1e-2] {
        draw(&shapes::plate(), &view(DVec3::new(0.3, -9.0, height), DVec3::ZERO, 0.5));
    }
}

/// A hill stands through the near plane.
#[test]
fn the_near_plane_through_a_patch() {
    for near in [0.5, 1.0, 1.5, 2.0] {
        let picture = draw(&shapes::wave(), &view(DVec3::new(1.5, 1.4, 3.0), DVec3::new(1.5, 1.5, 0.0), near));
        assert!(covered(&picture) > 500, "near {near}");
    }
}

/// Control points on all sides of the eye, many behind it, where `W` is negative.
#[test]
fn the_eye_inside_the_hull() {
    for (eye, target) in [
        (DVec3::new(1.5, 1.5, 0.9), DVec3::new(3.0, 1.5, 0.5)),
        (DVec3::new(1.0, 2.0, 0.2), DVec3::new(0.0, 0.0, 0.4)),
        (DVec3::new(2.0, 0.5, -0.6), DVec3::new(1.0, 3.0, -0.2)),
    ] {
        draw(&shapes::wave(), &view(eye, target, 1e-3));
    }
    let inside = draw(&shapes::sphere(), &view(DVec3::new(0.5, -0.4, 0.3), DVec3::new(1.0, 1.0, 1.0), 1e-3));
    assert_eq!(covered(&inside), (SIZE.0 * SIZE.1) as usize, "nothing but the sphere around the eye");
}

/// Most of the patch lies within a thousandth of its parameters: equal segments would be too many.
#[test]
fn weights_of_a_thousand_to_one() {
    for weights in [[1.0, 1e3, 1.0], [1.0, 1e-3, 1.0]] {
        let point = |i: usize, j: usize| {
            let p = DVec3::new(i as f64 * 1.5, j as f64 * 1.5, ((i * 7 + j * 5) % 4) as f64 * 0.5);
            DVec4::from_point(p, weights[i] * if j == 1 { 0.5 } else { 1.0 })
        };
        let picture =
            draw(&face(bezier(2, 2, point)), &view(DVec3::new(1.0, -3.0, 4.0), DVec3::new(1.5, 1.5, 0.5), 0.1));
        assert!(covered(&picture) > 1000);
    }
}

#[test]
fn weights_that_are_not_positive_are_refused() {
    for weight in [0.0, -1.0] {
        let net = vec![DVec4::new(0.0, 0.0, 0.0, weight), DVec4::W, DVec4::W, DVec4::W];
        let knots = vec![0.0, 0.0, 1.0, 1.0];
        let error = Surface::new((1, 1), knots.clone(), knots, net).unwrap_err();
        assert_eq!(error, SplineError::ControlPoint { index: 0 });
    }
}

/// 400 by 1, wavy both ways, from the side and along it.
#[test]
fn two_hundred_to_one() {
    let point =
        |i: usize, j: usize| DVec4::new(i as f64 * 40.0, j as f64 / 3.0, ((i * 3 + j * 2) % 4) as f64 * 0.4, 1.0);
    let model = face(bezier(5, 3, point));
    let side = draw(&model, &view(DVec3::new(100.0, -60.0, 30.0), DVec3::new(100.0, 0.5, 0.0), 1.0));
    let along = draw(&model, &view(DVec3::new(-1.0, 0.5, 2.5), DVec3::new(30.0, 0.5, 0.0), 0.1));
    assert!(covered(&side) > 50 && covered(&along) > 1000, "{} and {}", covered(&side), covered(&along));
}

/// Thirty by thirty patches within a few pixels, and placed a hundred times: most are left out, and no pixel is wrong.
#[test]
fn many_patches_below_a_pixel() {
    let n = 30;
    let knots: Vec<f64> = [0.0, 0.0].into_iter().chain((1..n).flat_map(|i| [f64::from(i); 2])).collect();
    let knots = [vec![0.0], knots, vec![f64::from(n); 3]].concat();
    let count = knots.len() - 3;
    let point = |i: usize, j: usize| DVec4::new(i as f64, j as f64, ((i * 5 + j * 3) % 7) as f64 * 0.01, 1.0);
    let net = (0..count).flat_map(|j| (0..count).map(move |i| (i, j))).map(|(i, j)| point(i, j)).collect();
    let mut model = face(Surface::new((2, 2), knots.clone(), knots, net).unwrap());
    let at = |k: i32| DVec3::new(f64::from(k % 10) * 80.0, f64::from(k / 10) * 80.0, 0.0);
    let placed = |k| Instance { transform: DAffine3::from_translation(at(k)), ..model.instances[0].clone() };
    model.instances = (0..100).map(placed).collect();
    let mut camera = view(DVec3::new(400.0, -500.0, 800.0), DVec3::new(400.0, 400.0, 0.0), 10.0);
    camera.depth_range.1 = 1e5;
    let picture = draw(&model, &camera);
    assert_eq!(picture.stats.patches, 90_000);
    assert!(picture.stats.sub_patches < 40_000, "{} are drawn", picture.stats.sub_patches);
    assert!(covered(&picture) > 1000);
}

/// A thousand plates with a hole, each a fifth of a pixel wide. Plates whose skirts reach no pixel's centre are left
/// out. About as many pixels show a plate as have one at their centres; not exactly as many, since the tolerance of
/// borders is much of such a plate.
#[test]
fn many_cut_patches_below_a_pixel() {
    let plate = shapes::plate();
    let n = 32;
    let step = 7.3 * shapes::PLATE_HALF; // 0.73 pixels: all phases of the grid
    let at = |k: i32| DVec3::new(f64::from(k % n), f64::from(k / n), 0.0) * step;
    let placed = |k| Instance { transform: DAffine3::from_translation(at(k)), ..plate.instances[0].clone() };
    let model = Model { instances: (0..n * n).map(placed).collect(), ..plate.clone() };
    let middle = DVec3::new(1.0, 1.0, 0.0) * step * 0.5 * f64::from(n);
    let projection = Projection::Orthographic { height: f64::from(SIZE.1) * 10.0 * shapes::PLATE_HALF };
    let depth_range = (1.0, 1e4);
    let camera = Camera { up: DVec3::Y, projection, depth_range, ..view(middle + DVec3::Z * 1e3, middle, 1.0) };
    let picture = draw(&model, &camera);
    let (patches, drawn) = (picture.stats.patches, picture.stats.sub_patches);
    assert!((0.4..0.75).contains(&(drawn as f64 / patches as f64)), "{drawn} of {patches} are drawn");
    let tracer = Tracer::new(&model);
    let pixels = (0..SIZE.0 * SIZE.1).map(|i| DVec2::new(f64::from(i % SIZE.0) + 0.5, f64::from(i / SIZE.0) + 0.5));
    let exact = pixels.filter(|&p| tracer.first(&camera, p).is_some()).count();
    assert!(
        exact > 20 && covered(&picture).abs_diff(exact) <= exact / 4,
        "{} pixels, {exact} exactly",
        covered(&picture)
    );
}
