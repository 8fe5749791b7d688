//! Boolean solids against the exact reference, every pixel.

use crate::shapes::{self, solids};
use crate::support::{assert_identical, assert_silent, orthographic, perspective, render, watched};
use glam::{DAffine3, DVec3};
use selvedge::csg::Op;
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Bounds, Camera, Model, Primitive, Projection, Shape, Solid};
use selvedge::picture::{SceneSettings, SolidWay};
use selvedge_check::{JudgeOptions, Judgement, Tracer, judge};

const SIZE: (u32, u32) = (240, 160);
/// Single precision of a root on a tube a twentieth of its ring, grazed at a cosine of 0.1: a place off by 1e-7 of the
/// ring over 0.05 over 0.1, and some roundings of the quartic. Other sides are far more accurate.
const NORMAL_DEG: f64 = 0.2;

/// Most rays of a picture that pass a mesh's silhouette, entering and leaving within the rounding of a depth. Layers
/// show one of the two sides, or none; the shown side is judged.
const TIED: usize = 2;

fn has_mesh(model: &Model) -> bool {
    let shapes = model.solids.iter().flat_map(|s| s.primitives()).map(|p| &p.shape);
    shapes.into_iter().any(|shape| matches!(shape, Shape::Mesh(_)))
}

/// The faults of a picture.
pub fn faults(renderer: &mut HeadlessRenderer, tracer: &Tracer, camera: &Camera, blank: bool) -> Option<String> {
    let picture = render(renderer, camera);
    let j = judge(tracer, camera, &picture.images(), &JudgeOptions::default());
    let empty = j.normal_deg.count == 0;
    if (j.wrong, j.given_up) != (0, 0) {
        return Some(format!("{} wrong, {} given up, {:?}", j.wrong, j.given_up, j.mismatches.first()));
    }
    if empty != blank {
        return Some(format!("blank: {empty}"));
    }
    if !few_ties(&j) {
        return Some(format!("{} ties, {} agree of {}", j.ties, j.agree, j.sampled));
    }
    (j.normal_deg.worst > NORMAL_DEG).then(|| format!("normals {:?}", j.normal_deg))
}

/// Faces nearer to each other than a tie excuse few pixels.
fn few_ties(j: &Judgement) -> bool {
    j.ties * 100 <= j.sampled
}

fn all_right(cases: Vec<solids::Named>, blank: bool) {
    right_at(SIZE, cases, blank);
}

/// Every pixel of pictures of this size is right, from two eyes.
pub fn right_at(size: (u32, u32), cases: Vec<solids::Named>, blank: bool) {
    let mut renderer = watched(&Model::default());
    let mut wrong = Vec::new();
    for (name, model) in &cases {
        let tracer = Tracer::new(model);
        let views = [("perspective", perspective(model, size)), ("parallel", orthographic(model, size))];
        renderer.upload(model).unwrap();
        let mut pictures = Vec::new();
        for (view, camera) in &views {
            let fault = faults(&mut renderer, &tracer, camera, blank);
            wrong.extend(fault.map(|f| format!("{name}, {view}: {f}")));
            pictures.push(render(&mut renderer, camera));
        }
        for way in [SolidWay::Cst, SolidWay::Blister] {
            renderer.upload_with(model, SceneSettings { solids: way, ..Default::default() }).unwrap();
            for ((view, camera), events) in views.iter().zip(&pictures) {
                let other = render(&mut renderer, camera);
                let face = other.face.iter().zip(&events.face).map(|(a, b)| a != b);
                let depth = other.depth.iter().zip(&events.depth).map(|(a, b)| a.to_bits() != b.to_bits());
                let colour = other.colour.iter().zip(&events.colour).map(|(a, b)| a != b);
                let differ = face.zip(depth).zip(colour).filter(|((f, d), c)| *f || *d || *c).count();
                let tied = way == SolidWay::Blister && has_mesh(model) && differ <= TIED;
                if differ > 0 && !(tied && faults(&mut renderer, &tracer, camera, blank).is_none()) {
                    wrong.push(format!("{name}, {view}: by {} {differ} pixels are unlike", way.name()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_silent(renderer);
}

#[test]
fn coincident_faces() {
    all_right(solids::coincident(), false);
}

#[test]
fn tangents_apexes_and_thin_shells() {
    all_right(solids::delicate(), false);
}

#[test]
fn quadrics_of_every_kind() {
    all_right(solids::quadrics(), false);
}

#[test]
fn odd_transforms() {
    all_right(solids::odd(), false);
}

#[test]
fn empty_results_are_blank() {
    all_right(solids::nothing(), true);
}

/// More leaves in one tile than stored spans, than 64, and than 255.
#[test]
fn many_primitives() {
    let row = |n: u32| {
        let ball = |i: u32| solids::ball(0.5, f64::from(i) * 0.01);
        let mut all: Vec<Primitive> = (0..n).map(ball).collect();
        all.insert(0, solids::block([-1.0; 3], [1.0 + f64::from(n) * 0.01, 0.0, 1.0]));
        solids::folded(Op::Difference, all)
    };
    let cases = vec![("70 in a tile", row(70)), ("300 in a tile", row(300)), ("100 holes", solids::holes(10))];
    all_right(cases, false);
}

/// Holes that give a tile more than 1024 leaves, and 10 001 of them: few pixels, because the reference is slow.
#[test]
#[ignore = "half a minute: tools/soak"]
fn thousands_of_primitives() {
    let far_out = solids::holes_by(100, &solids::post(3.0, -5.0, 15.0));
    let cases = vec![
        ("1024 holes", solids::holes(32)),
        ("10 000 holes", solids::holes(100)),
        ("10 000 whose tools stand out", far_out),
    ];
    right_at((48, 32), cases, false);
}

/// A ray that needs more steps than the driver allows is counted, not silently drawn wrong.
#[test]
fn rays_without_an_end_are_counted() {
    let mut all: Vec<Primitive> = (0..1500).map(|i| solids::ball(0.5, f64::from(i) * 1e-4)).collect();
    all.insert(0, solids::block([-1.0; 3], [2.0, 0.1, 1.0]));
    let model = solids::folded(Op::Difference, all);
    let camera = perspective(&model, (32, 24));
    let mut renderer = watched(&model);
    let picture = render(&mut renderer, &camera);
    let j = judge(&Tracer::new(&model), &camera, &picture.images(), &JudgeOptions::default());
    assert!(j.wrong == 0 || picture.stats.clamps > 0, "{} wrong, {:?}", j.wrong, j.mismatches.first());
    assert_silent(renderer);
}

/// The eye within a solid, within a hole, on a face, and the near plane through the middle.
#[test]
fn the_near_plane_cuts() {
    let cut = solids::solid("A-B+C", vec![solids::ball(3.0, 0.0), solids::ball(2.0, 0.0), solids::ring(1.2, 0.2)]);
    let look = |eye: DVec3, near: f64| Camera {
        eye,
        target: eye + DVec3::new(1.0, 0.3, -0.2),
        up: DVec3::Z,
        projection: Projection::Perspective { fov_y: 1.2 },
        depth_range: (near, 20.0),
        size: SIZE,
    };
    let cases = [
        ("in the hole", look(DVec3::new(-1.5, 0.0, 0.3), 0.01)),
        ("in the shell", look(DVec3::new(-2.5, 0.0, 0.3), 0.01)),
        ("on the inner face", look(DVec3::new(-2.0, 0.0, 0.0), 1e-3)),
        ("within the ring", look(DVec3::new(-1.2, 0.0, 0.0), 0.01)),
        ("near plane through the middle", look(DVec3::new(-8.0, 0.0, 0.0), 7.6)),
        ("near plane within the shell", look(DVec3::new(-8.0, -2.5, 0.0), 5.5)),
    ];
    let (tracer, mut renderer) = (Tracer::new(&cut), watched(&cut));
    for way in SolidWay::ALL {
        renderer.upload_with(&cut, SceneSettings { solids: *way, ..Default::default() }).unwrap();
        for (name, camera) in &cases {
            let fault = faults(&mut renderer, &tracer, camera, false);
            assert_eq!(fault, None, "{name}, by {}", way.name());
        }
    }
    assert_silent(renderer);
}

/// Pictures repeat bit for bit, and do not depend on the order of operands, except for colours.
#[test]
fn pictures_repeat_and_operands_commute() {
    let one = |text: &str| {
        let all = vec![solids::ball(1.5, 0.0), solids::block([-1.0; 3], [1.0, 1.0, 1.3]), solids::post(0.6, -2.0, 4.0)];
        let mut model = solids::solid(text, all);
        let solid = &model.solids[0];
        let same = solid.primitives().iter().map(|p| Primitive { id: 1, ..p.clone() }).collect();
        model.solids = vec![Solid::new(same, solid.tree().clone()).unwrap()];
        model
    };
    let first = one("(A+B)-C");
    let camera = perspective(&first, SIZE);
    let mut renderer = watched(&first);
    let picture = render(&mut renderer, &camera);
    assert_identical(&picture, &render(&mut renderer, &camera), "again");
    for text in ["(B+A)-C", "!C(A+B)", "!(C+!(B+A))", "(A-C)+(B-C)"] {
        let other = one(text);
        renderer.upload(&other).unwrap();
        let drawn = render(&mut renderer, &camera);
        assert!(drawn.face == picture.face, "faces of {text}");
        // a surface uses the formula of the primitive that names it first
        let differ = drawn.depth.iter().zip(&picture.depth).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
        assert_eq!(differ, 0, "depths of {text}");
    }
    assert_silent(renderer);
}

/// Solids before and behind untrimmed patches, trimmed faces and meshes.
#[test]
fn solids_among_patches_and_meshes() {
    let through = |model: Model| {
        let bounds: Bounds = model.control_bounds();
        let (c, r) = (bounds.centre(), bounds.diagonal());
        let m = DAffine3::from_translation(c) * solids::turned(0.5, 0.4, 0.0) * DAffine3::from_scale(DVec3::splat(r));
        let mut all = solids::solid(
            "A-B",
            vec![
                solids::moved(m, solids::block([-0.6, -0.08, -0.08], [0.6, 0.08, 0.08])),
                solids::moved(m, solids::ball(0.07, 0.2)),
            ],
        );
        // ids of their own
        let solid = &all.solids[0];
        let ids = solid.primitives().iter().map(|p| Primitive { id: p.id + 1000, ..p.clone() }).collect();
        all.solids = vec![Solid::new(ids, solid.tree().clone()).unwrap()];
        Model { solids: all.solids, ..model }
    };
    let cases = vec![
        ("a whole sphere", through(shapes::sphere())),
        ("a trimmed cylinder", through(shapes::cylinder())),
        ("a trimmed plate", through(shapes::plate())),
        ("a mesh", through(shapes::tetra())),
        ("a mesh in a trimmed face", through(shapes::beside())),
        ("solids and shells before meshes", through(shapes::floor())),
    ];
    all_right(cases, false);
}
