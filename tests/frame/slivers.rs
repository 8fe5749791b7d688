//! Faces narrower than a pixel along a border: pixels far from where their centres see them mix them, too.

use crate::edges::covered;
use crate::shapes;
use crate::support::assert_silent;
use crate::watched::renderer;
use glam::{DVec3, DVec4};
use selvedge::construct::{extrude, lathe};
use selvedge::model::{Camera, Model, Projection, SurfaceKind};
use selvedge::picture::{FrameSettings, Outputs, SceneSettings, Smooth, TrimWay};
use selvedge::spline::{BSpline, Surface};
use selvedge_check::Tracer;
use std::f64::consts::FRAC_PI_2;

const SIZE: (u32, u32) = (64, 48);
/// Units of the model that a pixel shows.
const PIXEL: f64 = 0.1;
/// Half the length of the faces, along z.
const HALF: f64 = 1.5;
/// Sixteen points beside a straight line are 0.14 off at worst. Where rows of a sliver are missing the error is its width,
/// 0.6.
const WORST: f64 = 0.15;
const MEAN: f64 = 0.05;

/// The rectangle beside x = `x` and between `from` and `to` along y.
fn strip(x: f64, from: f64, to: f64) -> Surface {
    let corner = |y: f64| DVec4::new(x, y, -HALF, 1.0);
    let side = BSpline::new(1, vec![0.0, 0.0, 1.0, 1.0], vec![corner(from), corner(to)]).expect("a side");
    extrude(&side, DVec3::Z * (2.0 * HALF)).expect("a strip")
}

/// A quarter of a cylinder about the z axis, from x to y.
fn fillet(radius: f64) -> Surface {
    let end = |z: f64| DVec3::new(radius, z, 1.0);
    let side = BSpline::new(1, vec![0.0, 0.0, 1.0, 1.0], vec![end(-HALF), end(HALF)]).expect("a side");
    lathe(&side, FRAC_PI_2).expect("a fillet")
}

/// A wide strip, and beyond its side a sliver, flat or bent away.
fn models() -> [Model; 3] {
    let width = 0.6 * PIXEL;
    let of = |name, sliver, kind| {
        let wide = shapes::face(1, SurfaceKind::Plane, strip(width, -1.0, 0.0));
        shapes::one(name, false, vec![wide, shapes::face(2, kind, sliver)])
    };
    let flat = || strip(width, 0.0, width);
    let mut beside = of("a flat sliver, and a mesh behind it", flat(), SurfaceKind::Plane);
    beside.parts[0].meshes = vec![shapes::block_mesh(DVec3::new(-0.6, -0.7, -0.4), DVec3::new(-0.5, -0.3, 0.4), 7)];
    [of("a flat sliver", flat(), SurfaceKind::Plane), of("a fillet", fillet(width), SurfaceKind::Cylinder), beside]
}

/// The sliver leans one pixel in eight, so runs of three rows or columns see none of it.
#[test]
fn a_sliver_between_rows_that_see_it_is_mixed() {
    let mut renderer = renderer();
    for model in models() {
        let tracer = Tracer::new(&model);
        for (kind, up) in [("rows", DVec3::new(0.0, 0.125, 1.0)), ("columns", DVec3::new(0.0, 1.0, 0.125))] {
            let camera = Camera {
                eye: DVec3::new(5.0, 0.0, 0.0),
                target: DVec3::ZERO,
                up,
                projection: Projection::Orthographic { height: PIXEL * f64::from(SIZE.1) },
                depth_range: (1.0, 10.0),
                size: SIZE,
            };
            let truth = covered(&tracer, &camera);
            for trim in [TrimWay::Table, TrimWay::Exact] {
                let settings = SceneSettings { smooth: Smooth::Borders, trim, ..SceneSettings::default() };
                renderer.upload_with(&model, settings).unwrap();
                let clear = FrameSettings { background: Some([0.0; 4]), ..FrameSettings::default() };
                let picture = renderer.render(&camera, &clear, Outputs::ALL).unwrap();
                let partly = (0..truth.len()).filter(|&i| truth[i] > 0.0 && truth[i] < 1.0);
                let errors: Vec<_> = partly.map(|i| f64::from(picture.colour[i][3]) / 255.0 - truth[i]).collect();
                let mean = errors.iter().map(|e| e.abs()).sum::<f64>() / errors.len() as f64;
                let worst = errors.iter().map(|e| e.abs()).fold(0.0, f64::max);
                println!("{}, {kind}, {trim:?}: mean {mean:.4}, worst {worst:.4} of {}", model.name, errors.len());
                let is_mixed = errors.len() > 60 && mean <= MEAN && worst <= WORST;
                assert!(is_mixed, "{}, {kind}, {trim:?}: mean {mean}, worst {worst}", model.name);
            }
        }
    }
    assert_silent(renderer);
}
