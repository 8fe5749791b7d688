//! Depth and normal are exact where patches are narrow, where they are small beside their part, and where pixels'
//! centres lie just beside an edge between patches.

use crate::shapes::one;
use crate::support::{assert_silent, render, watched};
use glam::{DVec3, DVec4};
use selvedge::model::{Camera, Face, Model, Projection, SurfaceKind};
use selvedge::spline::{Control, Surface};
use selvedge_check::{JudgeOptions, Tracer, judge};

const SIDE: f64 = 2_000.0;

fn uniform(spans: usize) -> Vec<f64> {
    let inner = (1..spans).map(|k| k as f64 / spans as f64);
    [0.0; 4].into_iter().chain(inner).chain([1.0; 4]).collect()
}

/// Uniform knots between 0 and 1, each followed by another one at the distance `apart`.
fn paired(spans: usize, apart: f64) -> Vec<f64> {
    let inner = (1..spans).map(|k| k as f64 / spans as f64).flat_map(|k| [k, k + apart]);
    [0.0; 4].into_iter().chain(inner).chain([1.0; 4]).collect()
}

/// A wavy sheet, face 1, at one end of a part `2 far` long, with a flat one at the other.
fn sheet(far: f64, knots_u: Vec<f64>) -> Model {
    let knots_v = vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    let count = knots_u.len() - 4;
    let mean = |i: usize| knots_u[i + 1..i + 4].iter().sum::<f64>() / 3.0; // Greville's
    let mut points = Vec::new();
    for j in 0..4 {
        for i in 0..count {
            let (u, v) = (mean(i), f64::from(j) / 3.0);
            let height = (std::f64::consts::TAU * 3.0 * u).sin() * 60.0 + v * v * 200.0;
            points.push(DVec4::from_point(DVec3::new(far + SIDE * u, SIDE * v, height), 1.0));
        }
    }
    let sheet = Surface::new((3, 3), knots_u, knots_v, points).unwrap();
    let flat = [(0.0, 0.0), (10.0, 0.0), (0.0, 10.0), (10.0, 10.0)];
    let flat = flat.map(|(x, y)| DVec4::from_point(DVec3::new(-far + x, y, 0.0), 1.0)).to_vec();
    let flat = Surface::new((1, 1), vec![0.0, 0.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0], flat).unwrap();
    let face = |id, kind, surface| Face { id, kind, surface, loops: Vec::new(), same_sense: true, colour: None };
    one("sheet", false, vec![face(1, SurfaceKind::BSpline, sheet), face(2, SurfaceKind::Plane, flat)])
}

/// A camera in the direction `from` of `target`, with a field of view of 35 degrees.
fn view(target: DVec3, from: DVec3) -> Camera {
    Camera {
        eye: target + from,
        target,
        up: DVec3::Z,
        projection: Projection::Perspective { fov_y: 35f64.to_radians() },
        depth_range: (10.0, 1e5),
        size: (480, 360),
    }
}

/// Judges every pixel; at least `regular` are on regular surface.
fn judged_exact(model: &Model, camera: &Camera, regular: u64) {
    let mut renderer = watched(model);
    let picture = render(&mut renderer, camera);
    assert_silent(renderer);
    let options = JudgeOptions { samples: None, ..JudgeOptions::default() };
    let j = judge(&Tracer::new(model), camera, &picture.images(), &options);
    let exact = &j.exact;
    println!("{:?}, {:?}; {} beyond", exact.depth_px, exact.normal_deg, exact.beyond);
    assert_eq!((j.wrong, exact.beyond), (0, 0), "{:?}", exact.normal_deg);
    assert!(exact.depth_px.count > regular, "{} of {}", exact.depth_px.count, j.sampled);
}

/// Pixels are 3 mm wide.
fn assert_exact(far: f64, knots_u: Vec<f64>) {
    let target = DVec3::new(far + 0.5 * SIDE, 0.5 * SIDE, 50.0);
    judged_exact(&sheet(far, knots_u), &view(target, DVec3::new(300.0, -900.0, 1500.0)), 150_000);
}

/// Every second patch is 2 mm wide, and the surface behind it turns differently than the surface before it.
#[test]
fn a_pixel_sees_its_own_patch_where_others_are_narrow() {
    assert_exact(0.0, paired(12, 1e-3));
}

/// Patches of 40 mm in a part as long as an aircraft, where single precision resolves 2e-3 mm.
#[test]
fn normals_of_small_patches_far_from_the_part_s_middle() {
    assert_exact(18_000.0, uniform(50));
}

/// A side drawn together to a fifth of a millimetre, as far from the middle. Pixels are 0.65 mm wide: in a closer view,
/// the sheet would be cut out of the part, with a centre of its own.
#[test]
fn normals_beside_a_side_that_is_drawn_together() {
    let far = 18_000.0;
    let mut model = sheet(far, uniform(1));
    let fan = |k: u32| {
        let (i, j) = (f64::from(k % 4) / 3.0, f64::from(k / 4) / 3.0);
        let width = 0.2 + 300.0 * j;
        let at = DVec3::new(far / 3.0 + width * (i - 0.5), far / 7.0 + 490.0 * j, far + 0.1 * width * i * (1.0 - i));
        DVec4::from_point(at, 1.0)
    };
    let surface = Surface::new((3, 3), uniform(1), uniform(1), (0..16).map(fan).collect()).unwrap();
    let tip = surface.patches().patches[0].patch.points[0].truncate();
    model.parts[0].faces[0].surface = surface;
    judged_exact(&model, &view(tip + DVec3::Y * 50.0, DVec3::new(100.0, -200.0, 300.0)), 5_000);
}

/// A row of flat patches, each turned by a fifth of a degree, with edges at most a thousandth of a pixel beside pixels'
/// centres, on either side.
#[test]
fn a_pixel_sees_the_right_side_of_a_slight_edge() {
    const EDGES: usize = 40;
    let x = |k: usize| 6.0 * k as f64 + 0.5 + [2e-4, -2e-4, 4e-4, -4e-4][k % 4] * f64::from(k != 0 && k != EDGES);
    let mut points = Vec::new();
    for y in [0.0, 100.0] {
        let mut height = 0.0;
        for k in 0..=EDGES {
            points.push(DVec4::from_point(DVec3::new(x(k), y, height), 1.0));
            let slope = 0.2f64.to_radians() * if k.is_multiple_of(2) { 1.0 } else { 0.0 };
            height += slope * 6.0;
        }
    }
    let knots_u = [0.0].into_iter().chain((0..=EDGES).map(|k| k as f64)).chain([EDGES as f64]).collect();
    let surface = Surface::new((1, 1), knots_u, vec![0.0, 0.0, 1.0, 1.0], points).unwrap();
    let facets = Face { id: 1, kind: SurfaceKind::BSpline, surface, loops: Vec::new(), same_sense: true, colour: None };
    let model = one("facets", false, vec![facets]);
    let size = (6 * EDGES as u32 + 20, 60);
    let target = DVec3::new(f64::from(size.0) / 2.0 - 10.0, 50.0, 0.0);
    let camera = Camera {
        eye: target + DVec3::Z * 100.0,
        target,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: f64::from(size.1) },
        depth_range: (10.0, 200.0),
        size,
    };
    judged_exact(&model, &camera, 13_000);
}
