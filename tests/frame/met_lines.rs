//! Lines where a Boolean solid meets a face or mesh that is of no solid: circles, in closed form.

use crate::edge_lines::centres;
use crate::shapes::solids::{ball, block, solid};
use crate::shapes::{SPHERE_RADIUS, block_mesh, one, placed, sphere, whole_mesh};
use crate::solid_lines::{HALF, OFF, SIZE, SOLID, away, draw_next, lines, with};
use crate::support::{assert_silent, orthographic};
use crate::watched::renderer;
use glam::{DAffine3, DVec2, DVec3, DVec4};
use selvedge::model::{Camera, Face, Model, Projection, SurfaceKind};
use selvedge::picture::{EdgeChoice, EdgeSettings, Picture};
use selvedge::spline::Surface;
use selvedge_check::Tracer;
use selvedge_check::drawing::{DrawingSettings, LineImage, judge_lines};
use std::f64::consts::TAU;

/// Beyond the picture.
const FAR: f64 = 20.0;
const RADIUS: f64 = 0.8;
/// Of the plane that cuts the ball.
const HEIGHT: f64 = 0.2;
/// Cosine of the ball's normal with the way to the eye. Points of the circle with more than the first are seen, with
/// less than the second hidden; between, within a pixel of the outline, neither is tested.
const SEEN: f64 = 0.15;
const HIDDEN: f64 = -0.15;

/// A plane of one patch.
fn floor() -> Model {
    let at = |x: f64, y: f64| DVec4::new(x * FAR, y * FAR, HEIGHT, 1.0);
    let points = vec![at(-1.0, -1.0), at(1.0, -1.0), at(-1.0, 1.0), at(1.0, 1.0)];
    let knots = || vec![0.0, 0.0, 1.0, 1.0];
    let surface = Surface::new((1, 1), knots(), knots(), points).unwrap();
    let face = Face { id: 9, kind: SurfaceKind::Plane, surface, loops: Vec::new(), same_sense: true, colour: None };
    one("floor", false, vec![face])
}

/// The solids of one model and the parts of another.
fn both(solids: Model, parts: Model) -> Model {
    Model { solids: solids.solids, ..parts }
}

/// The ball by an equation in a floor of a patch, and of triangles; and a block around a ball of patches.
fn models() -> [(&'static str, Model); 3] {
    let round = placed(DAffine3::from_scale(DVec3::splat(RADIUS / SPHERE_RADIUS)), None);
    let by_equation = || solid("A", vec![ball(RADIUS, 0.0)]);
    let mesh = block_mesh(DVec3::new(-FAR, -FAR, -0.3), DVec3::new(FAR, FAR, HEIGHT), 9);
    let block = solid("A", vec![block([-FAR, -FAR, -1.5], [FAR, FAR, HEIGHT])]);
    [
        ("a patch", both(by_equation(), floor())),
        ("a mesh", both(by_equation(), whole_mesh("floor", mesh))),
        ("a ball of patches", both(block, Model { instances: vec![round], ..sphere() })),
    ]
}

/// The ball fills most of the picture.
fn camera_of(model: &Model) -> Camera {
    let camera = orthographic(model, SIZE);
    let middle = camera.target;
    let projection = Projection::Orthographic { height: 2.2 };
    Camera { eye: camera.eye - middle, target: DVec3::ZERO, projection, ..camera }
}

/// Points of the circle, and the share of the ball's normal that is turned to the eye.
fn circle(camera: &Camera) -> Vec<(DVec2, f64)> {
    let to_eye = (camera.eye - camera.target).normalize();
    let round = (RADIUS * RADIUS - HEIGHT * HEIGHT).sqrt();
    let point = |k: u32| {
        let (sin, cos) = (f64::from(k) * TAU / 4000.0).sin_cos();
        DVec3::new(round * cos, round * sin, HEIGHT)
    };
    (0..4000).map(point).map(|p| (camera.project(p).unwrap().0, p.dot(to_eye) / RADIUS)).collect()
}

/// `selvedge check --edges` looks for these lines, too, and counts the missing ones.
#[test]
fn lines_are_where_solids_meet_faces() {
    let mut renderer = renderer();
    for (name, model) in models() {
        let camera = camera_of(&model);
        let settings = EdgeSettings { which: EdgeChoice::Sharp, silhouettes: false, ..lines() };
        let picture = draw_next(&mut renderer, (&model, with(settings)), &camera);
        assert_on_the_circle(name, &camera, &picture);
        let picture = draw_next(&mut renderer, (&model, with(EdgeSettings { silhouettes: false, ..lines() })), &camera);
        assert_the_judge_sees_them(name, &model, &camera, &picture);
    }
    assert_silent(renderer);
}

fn assert_on_the_circle(name: &str, camera: &Camera, picture: &Picture) {
    let marked: Vec<DVec2> = centres(picture).map(|(at, _)| at).collect();
    assert!(picture.edge.iter().all(|edge| [0, SOLID].contains(edge)), "{name}: a line of another kind");
    let circle = circle(camera);
    let of = |least: f64| circle.iter().filter(move |(_, turned)| *turned > least).map(|(p, _)| *p);
    let (seen, may): (Vec<DVec2>, Vec<DVec2>) = (of(SEEN).collect(), of(HIDDEN).collect());
    let bare = seen.iter().filter(|p| away(**p, &marked) > HALF + 0.5).count();
    let stray = marked.iter().filter(|p| away(**p, &may) > HALF + 0.5 + OFF).count();
    assert!(seen.len() > 1500 && marked.len() > 80, "{name}: {} points, {} pixels", seen.len(), marked.len());
    assert_eq!((bare, stray), (0, 0), "{name}: of {} points and {} pixels", seen.len(), marked.len());
}

fn assert_the_judge_sees_them(name: &str, model: &Model, camera: &Camera, picture: &Picture) {
    let settings = DrawingSettings { silhouettes: false, ..DrawingSettings::default() };
    let tracer = Tracer::new(model);
    let judged = |lines: &[u32]| {
        let image = LineImage { lines, width: 2.0 * HALF, section_width: 4.0 * HALF };
        judge_lines(model, &tracer, camera, &settings, image).unwrap()
    };
    let found = judged(&picture.edge);
    assert!(found.visible > 50 && (found.missing, found.stray) == (0, 0), "{name}: {found:?}");
    let without = judged(&vec![0; picture.edge.len()]);
    assert!(without.missing > 50 && without.stray == 0, "{name}: {without:?}");
}
