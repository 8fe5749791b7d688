//! Cameras that show all of a model: against the points of models whose points are known.

use super::support::turns;
use crate::shapes::{at, circle};
use glam::{DAffine3, DVec2, DVec3, DVec4};
use selvedge_geometry::csg::{Builder, Op};
use selvedge_geometry::model::{
    Camera, Face, Instance, Mesh, Model, Part, Primitive, Shape, Solid, SurfaceKind, TrimLoop,
};
use selvedge_geometry::spline::Surface;
use std::f64::consts::TAU;

const SIZES: [(u32, u32); 3] = [(1920, 1080), (300, 900), (64, 64)];
const FROM: [DVec3; 4] =
    [DVec3::new(1.0, -1.6, 1.1), DVec3::NEG_Y, DVec3::new(0.3, 0.2, -2.0), DVec3::new(-1.0, 0.0, 0.1)];

/// How much of each side of the picture the points cover from its middle, with sign: right, left, up, down.
fn covered(camera: &Camera, points: &[DVec3]) -> [f64; 4] {
    let size = DVec2::new(f64::from(camera.size.0), f64::from(camera.size.1));
    let seen = |p: &DVec3| 2.0 * (camera.project(*p).expect("in front of the eye").0 / size) - 1.0;
    points
        .iter()
        .map(seen)
        .fold([-1.0; 4], |far, q| [far[0].max(q.x), far[1].max(-q.x), far[2].max(-q.y), far[3].max(q.y)])
}

/// Nine tenths of the tighter side, in the middle of both; `slack`: how much less of the picture the points may cover
/// than the model.
#[track_caller]
fn assert_framed(model: &Model, points: &[DVec3], slack: f64) {
    for size in SIZES {
        for from in FROM {
            let camera = Camera::framing(model, from, DVec3::Z, 0.6, size);
            assert_eq!(camera.check(), Ok(()));
            let [right, left, up, down] = covered(&camera, points);
            let tight = right.max(left).max(up).max(down);
            // a search may end 1e-6 of the diagonal off, which an eye at a hundredth of it sees as 1e-4 of the picture
            assert!((0.9 - slack - 1e-3..0.9 + 1e-3).contains(&tight), "{tight} of {size:?} from {from}");
            let off = (right - left).abs().max((up - down).abs());
            assert!(off < slack + 4e-3, "off the middle by {off} of {size:?} from {from}");
            let depths = points.iter().map(|p| camera.project(*p).expect("in front").1);
            let (near, far) = camera.depth_range;
            assert!(depths.into_iter().all(|d| near <= d && d <= far));
        }
    }
}

fn placed(part: Part, transform: DAffine3) -> Model {
    let instance = Instance { part: 0, transform, colour: None, name: String::new() };
    Model { parts: vec![part], instances: vec![instance], ..Model::default() }
}

fn disc(radius: f64) -> Face {
    let points = (0..4).map(|k| DVec4::new(f64::from(4 * (k % 2)), f64::from(4 * (k / 2)), 0.0, 1.0)).collect();
    let knots = vec![0.0, 0.0, 4.0, 4.0];
    let surface = Surface::new((1, 1), knots.clone(), knots, points).unwrap();
    let loops: Vec<TrimLoop> = vec![circle(at(2.0, 2.0), radius)];
    Face { id: 1, kind: SurfaceKind::Plane, surface, loops, same_sense: true, colour: None }
}

fn primitive(shape: Shape) -> Primitive {
    Primitive { shape, transform: DAffine3::IDENTITY, colour: [0.5; 4], id: 1 }
}

#[test]
fn a_trimmed_face_fills_the_picture_however_it_is_placed() {
    for radius in [1.9, 0.01] {
        for transform in turns() {
            let circle = (0..3600).map(|k| {
                let (sin, cos) = (TAU * f64::from(k) / 3600.0).sin_cos();
                transform.transform_point3(DVec3::new(2.0 + radius * cos, 2.0 + radius * sin, 0.0))
            });
            let part = Part { faces: vec![disc(radius)], ..Part::default() };
            assert_framed(&placed(part, transform), &circle.collect::<Vec<_>>(), 0.0);
        }
    }
}

#[test]
fn a_long_mesh_fills_the_picture_end_on_too() {
    let corners: Vec<DVec3> =
        (0..8).map(|k| DVec3::new(f64::from(100 * (k & 1)), f64::from(k >> 1 & 1), f64::from(k >> 2))).collect();
    let triangles = vec![[0, 1, 3], [0, 3, 2], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4]];
    let mesh = Mesh::new(1, corners.clone(), triangles, Vec::new()).unwrap();
    assert_framed(&placed(Part { meshes: vec![mesh], ..Part::default() }, DAffine3::IDENTITY), &corners, 0.0);
}

#[test]
fn a_drilled_ball_fills_the_picture() {
    let mut builder = Builder::new();
    let leaves = [builder.leaf(0), builder.leaf(1)];
    let root = builder.pair(Op::Difference, leaves[0], leaves[1]);
    let primitives =
        vec![primitive(Shape::Sphere { radius: 2.0 }), primitive(Shape::Cylinder { radius: 0.1, height: 9.0 })];
    let solid = Solid::new(primitives, builder.finish(root).unwrap()).unwrap();
    // a point each degree: by 1 - cos 0.7 degrees less than the ball, and by 1 - cos 2.9 degrees where it is drilled,
    // which does not change its box
    let ball = (-90..=90).flat_map(|latitude| {
        let (z, r) = f64::from(latitude).to_radians().sin_cos();
        (0..360).map(move |k| {
            let (sin, cos) = f64::from(k).to_radians().sin_cos();
            2.0 * DVec3::new(r * cos, r * sin, z)
        })
    });
    let drilled = |p: &DVec3| p.z < 0.0 || p.truncate().length() > 0.1;
    let points: Vec<DVec3> = ball.filter(drilled).collect();
    let model = Model { solids: vec![solid], ..Model::default() };
    assert_framed(&model, &points, 2e-3);
}

#[test]
fn what_has_no_size_has_a_camera() {
    let point = Mesh::new(1, vec![DVec3::ONE; 3], vec![[0, 1, 2]], Vec::new());
    let part = Part { meshes: point.into_iter().collect(), ..Part::default() };
    for model in [Model::default(), placed(part, DAffine3::IDENTITY)] {
        let camera = Camera::framing(&model, DVec3::X, DVec3::Z, 0.6, (640, 480));
        assert_eq!(camera.check(), Ok(()));
    }
}
