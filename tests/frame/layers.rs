//! Transparent solids against the exact reference, every pixel.

use crate::shapes::operands::{mesh, part};
use crate::shapes::solids::{ball, block, moved, post, turned};
use crate::shapes::{ball_mesh, sphere};
use crate::support::{assert_identical, assert_silent, orthographic, perspective, render, watched, watched_with};
use glam::{DVec2, DVec3, DVec4};
use selvedge::csg::{Builder, Op};
use selvedge::model::{Camera, Colour, Model, Primitive, Projection, Shape, Solid};
use selvedge::picture::{FrameSettings, Outputs, Picture, Samples, SceneSettings};
use selvedge_check::solids::LayerTracer;
use selvedge_check::{JudgeOptions, Tracer, judge};

pub const SIZE: (u32, u32) = (160, 120);
/// Allowed steps of eight-bit colours: roundings of lit colours and of blending.
const STEPS: f64 = 1.0;
/// A pixel is at an edge if rays this far beside its centre meet other faces. A ray's direction and a surface's place
/// are rounded to 1e-7 of a picture 160 pixels wide, so the drawn edge is within a thousandth.
pub const EDGE_PX: f64 = 0.01;
/// The same for spline parts, whose silhouettes may be off by a twelfth of the tolerance of half a pixel, plus
/// rounding.
const SPLINE_EDGE_PX: f64 = 0.5 / 12.0 + EDGE_PX;
/// Largest share of a picture's pixels that may lie at edges: one in so many.
const EDGES: usize = 12;

const GREEN: Colour = [0.1, 0.7, 0.2, 0.3];
const RED: Colour = [0.8, 0.1, 0.1, 0.5];
pub const BLUE: Colour = [0.1, 0.2, 0.9, 0.25];
pub const STEEL: Colour = [0.5, 0.5, 0.55, 1.0];

pub fn painted(colour: Colour, p: Primitive) -> Primitive {
    Primitive { colour, ..p }
}

/// One solid that combines primitives by an operation.
fn of(op: Op, all: Vec<Primitive>) -> Solid {
    let mut b = Builder::new();
    let leaves: Vec<u32> = (0..all.len() as u32).map(|p| b.leaf(p)).collect();
    let root = b.fold(op, leaves);
    Solid::new(all, b.finish(root).unwrap()).unwrap()
}

/// A model of solids whose primitives are numbered in order.
pub fn model(solids: Vec<Solid>) -> Model {
    let mut id = 0;
    let solids = solids.iter().map(|solid| {
        let numbered = solid.primitives().iter().map(|p| {
            id += 1;
            Primitive { id, ..p.clone() }
        });
        Solid::new(numbered.collect(), solid.tree().clone()).unwrap()
    });
    Model { solids: solids.collect(), ..Model::default() }
}

pub fn one(p: Primitive) -> Solid {
    Solid::of(p).unwrap()
}

pub fn glass(colour: Colour, min: [f64; 3], max: [f64; 3]) -> Solid {
    one(painted(colour, block(min, max)))
}

/// A toothed wheel: a disc, teeth, a hole.
pub fn gear() -> Solid {
    let tooth = |k: u32| {
        moved(turned(0.0, 0.0, f64::from(k) * 0.785), painted(STEEL, block([0.6, -0.12, -0.2], [1.0, 0.12, 0.2])))
    };
    let teeth = of(Op::Union, (0..8).map(tooth).chain([painted(STEEL, post(0.75, -0.2, 0.4))]).collect());
    let hole = one(painted(STEEL, post(0.25, -0.5, 1.0)));
    let all = [teeth.primitives(), hole.primitives()].concat();
    let mut b = Builder::new();
    let leaves: Vec<u32> = (0..all.len() as u32).map(|p| b.leaf(p)).collect();
    let (last, first) = leaves.split_last().unwrap();
    let union = b.fold(Op::Union, first.iter().copied());
    let root = b.pair(Op::Difference, union, *last);
    Solid::new(all, b.finish(root).unwrap()).unwrap()
}

pub fn tracer(model: &Model) -> LayerTracer {
    LayerTracer::new(&model.items(false).unwrap(), model.coincidence()).unwrap()
}

fn encoded(c: f64) -> f64 {
    255.0 * if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

/// The faces that a ray meets, in order.
fn faces(layers: &LayerTracer, camera: &Camera, pixel: DVec2) -> Vec<(usize, u32, bool)> {
    let (o, d) = camera.ray(pixel);
    let (_, _, forward) = camera.axes();
    let (found, opaque) = layers.layers(o, d, camera.depth_range.0 / d.dot(forward));
    let clear = found.iter().map(|l| (l.item, l.boundary.id, l.boundary.entering));
    clear.chain(opaque.first(camera.depth_range.0 / d.dot(forward)).map(|b| (usize::MAX, b.id, true))).collect()
}

pub fn centre(i: usize, size: (u32, u32)) -> DVec2 {
    DVec2::new((i as u32 % size.0) as f64 + 0.5, (i as u32 / size.0) as f64 + 0.5)
}

/// The four sides of a pixel.
pub const AROUND: [DVec2; 4] = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];

pub fn is_at_edge(layers: &LayerTracer, camera: &Camera, at: DVec2, far: f64) -> bool {
    let here = faces(layers, camera, at);
    AROUND.iter().any(|d| faces(layers, camera, at + *d * far) != here)
}

/// Compares the colour of every pixel except those at edges; returns the number of pixels that show something.
fn assert_colours(model: &Model, camera: &Camera, picture: &Picture, background: Colour, what: &str) -> usize {
    let layers = tracer(model);
    let has_splines = model.solids.iter().flat_map(Solid::primitives).any(|p| matches!(p.shape, Shape::Part(_)));
    let edge_px = if has_splines { SPLINE_EDGE_PX } else { EDGE_PX };
    let (mut edges, mut seen) = (0, 0);
    for (i, drawn) in picture.colour.iter().enumerate() {
        let at = centre(i, picture.size);
        if is_at_edge(&layers, camera, at, edge_px) {
            edges += 1;
            continue;
        }
        let truly = |at: DVec2| {
            let c: DVec4 = layers.colour(camera, at, background);
            [encoded(c.x), encoded(c.y), encoded(c.z), 255.0 * c.w]
        };
        let truth = truly(at);
        let differs = |other: [f64; 4]| truth.iter().zip(other).map(|(t, d)| (t - d).abs()).fold(0.0, f64::max);
        let off = differs(drawn.map(f64::from));
        // so near, another triangle or a face that turns away may be visible instead
        let near = AROUND.map(|d| differs(truly(at + d * edge_px))).into_iter().fold(0.0, f64::max);
        assert!(
            off <= STEPS + near,
            "{what}: at {at} drawn {drawn:?}, truly {truth:?}: {:?}",
            faces(&layers, camera, at)
        );
        seen += usize::from(!faces(&layers, camera, at).is_empty());
    }
    assert!(edges * EDGES < picture.colour.len(), "{what}: {edges} pixels at edges");
    seen
}

/// Judges faces of transparent solids like all others.
fn assert_judged(model: &Model, camera: &Camera, picture: &Picture, what: &str) {
    let j = judge(&Tracer::new(model), camera, &picture.images(), &JudgeOptions::default());
    assert_eq!((j.wrong, j.given_up), (0, 0), "{what}: {:?}", j.mismatches.first());
}

/// All images of scenes of solids, in both projections.
fn all_right(cases: Vec<(&str, Model)>) {
    right_at(SIZE, cases);
}

fn right_at(size: (u32, u32), cases: Vec<(&str, Model)>) {
    let mut renderer = watched(&Model::default());
    for (name, model) in &cases {
        renderer.upload(model).unwrap();
        for (view, camera) in [("perspective", perspective(model, size)), ("parallel", orthographic(model, size))] {
            let what = format!("{name}, {view}");
            let picture = render(&mut renderer, &camera);
            assert_eq!(picture.stats.clamps, 0, "{what}");
            let seen = assert_colours(model, &camera, &picture, [1.0; 4], &what);
            assert!(seen * 12 > picture.colour.len(), "{what}: only {seen} pixels show something");
            assert_judged(model, &camera, &picture, &what);
            assert_identical(&picture, &render(&mut renderer, &camera), &what);
        }
    }
    assert_silent(renderer);
}

pub fn in_glass() -> Model {
    model(vec![glass(BLUE, [-1.3, -1.3, -0.6], [1.3, 1.3, 0.6]), gear()])
}

#[test]
fn a_gear_in_a_glass_block_is_seen_through_it() {
    all_right(vec![("gear in glass", in_glass())]);
    // opaque glass is not transparent
    let camera = perspective(&in_glass(), SIZE);
    let mut model = in_glass();
    let mut renderer = watched(&model);
    let steel = |p: &Picture| p.colour.iter().filter(|c| c[0].abs_diff(c[2]) < 60 && c[0] < 250).count();
    assert!(steel(&render(&mut renderer, &camera)) > 0);
    model.solids[0] = glass([0.1, 0.2, 0.9, 1.0], [-1.3, -1.3, -0.6], [1.3, 1.3, 0.6]);
    renderer.upload(&model).unwrap();
    let opaque = render(&mut renderer, &camera);
    let gear: Vec<u32> = model.solids[1].primitives().iter().map(|p| p.id).collect();
    assert!(!opaque.face.iter().any(|id| gear.contains(id)));
    assert_silent(renderer);
}

/// The union of both in a file is not another scene: operands are distinguished by their transparency.
#[test]
fn an_operand_of_glass_swallows_nothing() {
    let apart = in_glass();
    let mut together = apart.clone();
    together.solids = vec![Solid::union(&apart.solids).unwrap()];
    let camera = perspective(&apart, SIZE);
    let mut renderer = watched(&apart);
    let picture = render(&mut renderer, &camera);
    renderer.upload(&together).unwrap();
    assert_identical(&picture, &render(&mut renderer, &camera), "as one solid");
    assert_silent(renderer);
}

#[test]
fn faces_that_coincide() {
    let inlay =
        |colour| model(vec![glass(BLUE, [-1.0; 3], [1.0; 3]), glass(colour, [-0.5, -1.0, -0.5], [0.5, 0.2, 0.5])]);
    all_right(vec![
        (
            "two that touch",
            model(vec![glass(BLUE, [-1.0; 3], [0.0, 1.0, 1.0]), glass(RED, [0.0, -1.0, -1.0], [1.0; 3])]),
        ),
        (
            "one on an opaque one",
            model(vec![glass(GREEN, [-1.0, -1.0, 0.0], [1.0; 3]), glass(STEEL, [-2.0, -2.0, -0.5], [2.0, 2.0, 0.0])]),
        ),
        (
            "an opaque one on one",
            model(vec![
                glass(GREEN, [-1.0, -1.0, -1.0], [1.0, 1.0, 0.0]),
                glass(STEEL, [-0.5, -0.5, 0.0], [0.5, 0.5, 0.5]),
            ]),
        ),
        ("an inlay of glass", inlay(RED)),
        ("an opaque inlay", inlay(STEEL)),
        ("the same twice", model(vec![glass(BLUE, [-1.0; 3], [1.0; 3]), glass(RED, [-1.0; 3], [1.0; 3])])),
        (
            "a plug in its hole",
            model(vec![
                of(
                    Op::Difference,
                    vec![painted(BLUE, block([-1.0, -1.0, 0.0], [1.0, 1.0, 1.0])), painted(BLUE, post(0.5, 0.0, 1.0))],
                ),
                one(painted(RED, post(0.5, 0.0, 1.0))),
            ]),
        ),
    ]);
}

#[test]
fn shells_opacities_and_operations() {
    let shell =
        |r: f64, colour| of(Op::Difference, vec![painted(colour, ball(r, 0.0)), painted(colour, ball(r - 0.1, 0.0))]);
    let clear = |a: f32| [0.2, 0.5, 0.4, a];
    all_right(vec![
        (
            "nested shells",
            model(vec![shell(1.0, BLUE), shell(0.8, RED), shell(0.6, GREEN), one(painted(STEEL, ball(0.3, 0.1)))]),
        ),
        (
            "wholly clear before red",
            model(vec![glass(clear(0.0), [-1.0; 3], [1.0; 3]), one(painted(RED, ball(0.7, 0.0)))]),
        ),
        (
            "opaque walls of a hole in glass",
            model(vec![of(
                Op::Difference,
                vec![painted(BLUE, block([-1.0; 3], [1.0; 3])), painted(STEEL, post(0.5, -2.0, 4.0))],
            )]),
        ),
        (
            "clear walls of a hole in steel",
            model(vec![of(
                Op::Difference,
                vec![painted(STEEL, block([-1.0; 3], [1.0; 3])), painted(RED, post(0.5, -2.0, 4.0))],
            )]),
        ),
        (
            "what meets",
            model(vec![
                of(Op::Intersection, vec![painted(RED, ball(1.0, -0.3)), painted(BLUE, ball(1.0, 0.3))]),
                glass(GREEN, [-0.2; 3], [0.9; 3]),
            ]),
        ),
    ]);
}

/// More items than stored spans, and more layers than bits in a word.
#[test]
fn a_hundred_plates() {
    let plate = |i: u32| {
        let x = f64::from(i) * 0.02;
        glass([0.2, 0.5, 0.4, 0.02], [x, 0.0, 0.0], [x + 0.01, 1.0, 1.0])
    };
    right_at((48, 36), vec![("plates", model((0..100).map(plate).collect()))]);
}

/// Operands without equations, of one colour each, because the reference has no colours of faces.
#[test]
fn meshes_and_spline_parts() {
    let round = || painted(RED, mesh(ball_mesh(3)));
    all_right(vec![
        ("a ball in a mesh", model(vec![one(round()), one(painted(STEEL, ball(0.4, 0.0)))])),
        (
            "a mesh less a block",
            model(vec![of(Op::Difference, vec![round(), painted(BLUE, block([0.0; 3], [2.0; 3]))])]),
        ),
        ("a spline sphere in glass", model(vec![one(painted(RED, part(sphere()))), glass(BLUE, [-1.5; 3], [1.5; 3])])),
    ]);
}

/// A camera in glass, and a near plane that cuts glass and steel.
#[test]
fn the_near_plane_cuts() {
    let m = model(vec![
        one(painted(BLUE, ball(3.0, 0.0))),
        one(painted(RED, ball(1.0, 1.0))),
        one(painted(STEEL, block([1.5, -4.0, -0.2], [2.0, 4.0, 0.2]))),
    ]);
    let look = |eye: DVec3, near: f64| Camera {
        eye,
        target: eye + DVec3::new(1.0, 0.1, -0.05),
        up: DVec3::Z,
        projection: Projection::Perspective { fov_y: 1.0 },
        depth_range: (near, 20.0),
        size: SIZE,
    };
    let mut renderer = watched(&m);
    for (name, camera) in [
        ("in glass", look(DVec3::new(-2.0, 0.0, 0.1), 0.01)),
        ("in both", look(DVec3::new(0.5, 0.0, 0.1), 0.01)),
        ("through glass", look(DVec3::new(-8.0, 0.0, 0.1), 7.7)),
        ("through steel", look(DVec3::new(-8.0, -1.0, 0.1), 9.7)),
    ] {
        let picture = render(&mut renderer, &camera);
        assert_colours(&m, &camera, &picture, [1.0; 4], name);
        assert_judged(&m, &camera, &picture, name);
    }
    assert_silent(renderer);
}

/// With a transparent background, too.
#[test]
fn opacity_is_kept() {
    let m = in_glass();
    let camera = perspective(&m, SIZE);
    let mut renderer = watched(&m);
    for background in [[0.0; 4], [0.2, 0.4, 0.6, 0.5]] {
        let settings = FrameSettings { background: Some(background), ..FrameSettings::default() };
        let picture = renderer.render(&camera, &settings, Outputs::ALL).unwrap();
        assert_colours(&m, &camera, &picture, background, "background");
    }
    assert_silent(renderer);
}

/// The mean of four samples, away from edges of each of them.
#[test]
fn samples_are_averaged() {
    let m = in_glass();
    let layers = tracer(&m);
    let camera = perspective(&m, SIZE);
    let mut renderer = watched_with(&m, SceneSettings { samples: Samples::Four, ..SceneSettings::default() });
    let picture = render(&mut renderer, &camera);
    assert_judged(&m, &camera, &picture, "the centre's images");
    let mut compared = 0;
    for (i, drawn) in picture.colour.iter().enumerate() {
        let at = centre(i, SIZE);
        let places = [[-0.125, -0.375], [0.375, -0.125], [-0.375, 0.125], [0.125, 0.375]].map(DVec2::from_array);
        let here = faces(&layers, &camera, at);
        if places
            .iter()
            .any(|p| is_at_edge(&layers, &camera, at + *p, EDGE_PX) || faces(&layers, &camera, at + *p) != here)
        {
            continue;
        }
        let truth = places.iter().map(|p| layers.colour(&camera, at + *p, [1.0; 4])).sum::<DVec4>() / 4.0;
        let truth = [truth.x, truth.y, truth.z].map(encoded);
        let off = truth.iter().zip(drawn).map(|(t, d)| (t - f64::from(*d)).abs()).fold(0.0, f64::max);
        assert!(off <= STEPS, "at {at} drawn {drawn:?}, truly {truth:?}");
        compared += usize::from(!here.is_empty());
    }
    assert!(compared > 3000, "{compared}");
    assert_identical(&picture, &render(&mut renderer, &camera), "again");
    assert_silent(renderer);
}

/// The order of solids changes no bit, unless faces of two with the same orientation coincide.
#[test]
fn solids_may_be_swapped() {
    let forth = vec![
        glass(BLUE, [-1.0; 3], [1.0; 3]),
        one(painted(RED, ball(0.9, 0.6))),
        glass(GREEN, [1.0, -1.0, -1.0], [2.0, 1.0, 1.0]),
        gear(),
    ];
    let all: Vec<Solid> = model(forth).solids;
    let mut m = Model { solids: all.clone(), ..Model::default() };
    let camera = perspective(&m, SIZE);
    let mut renderer = watched(&m);
    let picture = render(&mut renderer, &camera);
    for order in [[3, 2, 1, 0], [1, 3, 0, 2], [2, 0, 3, 1]] {
        m.solids = order.map(|k: usize| all[k].clone()).to_vec();
        renderer.upload(&m).unwrap();
        let swapped = render(&mut renderer, &camera);
        assert!(swapped.colour == picture.colour && swapped.face == picture.face, "{order:?}");
    }
    assert_silent(renderer);
}

/// Closed parts with transparent colours are transparent; open ones are drawn opaque, and counted.
#[test]
fn parts_of_glass() {
    let placed = sphere();
    let mut m = model(vec![one(painted(STEEL, ball(0.4, 0.3)))]);
    (m.parts, m.instances) = (placed.parts, placed.instances);
    m.instances[0].colour = Some(RED);
    // for the reference, the part is a primitive of that colour
    let as_solid = model(vec![m.solids[0].clone(), one(painted(RED, part(sphere())))]);
    let camera = perspective(&m, SIZE);
    let mut renderer = watched(&m);
    let picture = render(&mut renderer, &camera);
    assert_eq!(picture.stats.open_clear, 0);
    assert!(assert_colours(&as_solid, &camera, &picture, [1.0; 4], "a part") > 3000);
    assert_judged(&m, &camera, &picture, "a part");
    m.parts[0].closed = false;
    renderer.upload(&m).unwrap();
    let open = render(&mut renderer, &camera);
    assert_eq!(open.stats.open_clear, 1);
    m.instances[0].colour = Some([RED[0], RED[1], RED[2], 1.0]);
    renderer.upload(&m).unwrap();
    assert_identical(&open, &render(&mut renderer, &camera), "drawn opaque");
    assert_silent(renderer);
}
