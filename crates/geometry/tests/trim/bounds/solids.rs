//! Boolean solids: the guarantees of their boxes.

use super::support::{assert_box, turns};
use glam::{DAffine3, DVec3};
use selvedge_geometry::csg::{Builder, Op};
use selvedge_geometry::model::{Bounds, Camera, Instance, Mesh, Model, Part, Primitive, Quadric, Shape, Solid};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4};

fn primitive(shape: Shape, transform: DAffine3) -> Primitive {
    Primitive { shape, transform, colour: [0.5; 4], id: 1 }
}

fn block(min: [f64; 3], max: [f64; 3]) -> Primitive {
    primitive(Shape::Block { min: min.into(), max: max.into() }, DAffine3::IDENTITY)
}

fn model(solid: Solid) -> Model {
    Model { solids: vec![solid], ..Model::default() }
}

fn pair(op: Op, a: Primitive, b: Primitive) -> Model {
    let mut builder = Builder::new();
    let leaves = [builder.leaf(0), builder.leaf(1)];
    let root = builder.pair(op, leaves[0], leaves[1]);
    model(Solid::new(vec![a, b], builder.finish(root).unwrap()).unwrap())
}

fn of(min: [f64; 3], max: [f64; 3]) -> Bounds {
    Bounds { min: min.into(), max: max.into() }
}

/// Against points of the shape's border, by its own equation.
#[test]
fn turned_primitives_are_tight() {
    let ring = |r: f64, z: f64| (0..3600).map(move |k| (DVec3::new(r, 0.0, z), f64::from(k) * 0.1f64.to_radians()));
    let turned = |(p, angle): (DVec3, f64)| DVec3::new(p.x * angle.cos(), p.x * angle.sin(), p.z);
    let torus = (0..360).flat_map(|k| {
        let (sin, cos) = f64::from(k).to_radians().sin_cos();
        ring(3.0 + cos, sin).step_by(10)
    });
    let sphere = (-90..=90).flat_map(|k| {
        let (sin, cos) = f64::from(k).to_radians().sin_cos();
        ring(2.0 * cos, 2.0 * sin).step_by(10)
    });
    // 4 x² + y² + z² - 4 y <= 0: semi-axes 1, 2, 2 about (0, 2, 0)
    let quadric = Quadric { squares: DVec3::new(4.0, 1.0, 1.0), linear: DVec3::Y * -4.0, ..Quadric::default() };
    let egg = sphere.clone().map(turned).map(|p| DVec3::new(0.5 * p.x, p.y + 2.0, p.z));
    let cases: Vec<(Shape, Vec<DVec3>)> = vec![
        (Shape::Sphere { radius: 2.0 }, sphere.map(turned).collect()),
        (Shape::Cylinder { radius: 1.0, height: 5.0 }, ring(1.0, 0.0).chain(ring(1.0, 5.0)).map(turned).collect()),
        (
            Shape::Cone { bottom: 2.0, top: 0.5, height: 3.0 },
            ring(2.0, 0.0).chain(ring(0.5, 3.0)).map(turned).collect(),
        ),
        (Shape::Torus { major: 3.0, minor: 1.0 }, torus.map(turned).collect()),
        (Shape::Quadric(quadric), egg.collect()),
    ];
    for (shape, points) in cases {
        for transform in turns() {
            let expected = points.iter().map(|p| transform.transform_point3(*p)).fold(Bounds::EMPTY, Bounds::with);
            let found = model(Solid::of(primitive(shape.clone(), transform)).unwrap()).bounds();
            // degrees between the points: 1 - cos 0.5°
            assert_box(found, expected, 1e-4);
            let holds = |p: &DVec3| (p.cmpge(found.min - 1e-9) & p.cmple(found.max + 1e-9)).all();
            assert!(expected.corners().iter().all(holds), "{shape:?}: {expected:?} is not within {found:?}");
        }
    }
}

#[test]
fn expressions_of_blocks() {
    let (a, b) = (|| block([0.0; 3], [4.0, 4.0, 4.0]), || block([3.0, -1.0, -1.0], [9.0, 5.0, 5.0]));
    assert_eq!(pair(Op::Union, a(), b()).bounds(), of([0.0, -1.0, -1.0], [9.0, 5.0, 5.0]));
    assert_eq!(pair(Op::Intersection, a(), b()).bounds(), of([3.0, 0.0, 0.0], [4.0, 4.0, 4.0]));
    // right through, and at an end
    assert_eq!(pair(Op::Difference, a(), b()).bounds(), of([0.0; 3], [3.0, 4.0, 4.0]));
    // through the middle, or not right through: all ends stay
    for hole in [block([1.0, -1.0, -1.0], [2.0, 5.0, 5.0]), block([3.0, 0.5, -1.0], [9.0, 5.0, 5.0])] {
        assert_eq!(pair(Op::Difference, a(), hole).bounds(), of([0.0; 3], [4.0; 3]));
    }
    assert_eq!(pair(Op::Difference, a(), block([-1.0; 3], [5.0; 3])).bounds(), Bounds::EMPTY);
    // a turned block goes through nowhere for certain
    let turned = Primitive { transform: DAffine3::from_rotation_z(0.1), ..b() };
    assert_eq!(pair(Op::Difference, a(), turned).bounds(), of([0.0; 3], [4.0; 3]));
}

/// The intersection of a wide block and the half-spaces `normal · x <= offset`, less others, as one expression.
fn cut_block(block: Primitive, kept: &[([f64; 3], f64)], taken: &[([f64; 3], f64)]) -> Solid {
    let transform = block.transform;
    let half = |(normal, offset): &([f64; 3], f64)| {
        primitive(Shape::HalfSpace { normal: (*normal).into(), offset: *offset }, transform)
    };
    let mut primitives = vec![block];
    primitives.extend(kept.iter().chain(taken).map(half));
    let mut builder = Builder::new();
    let leaves: Vec<u32> = (0..primitives.len() as u32).map(|i| builder.leaf(i)).collect();
    let (kept, taken) = leaves.split_at(1 + kept.len());
    let whole = builder.fold(Op::Intersection, kept.iter().copied());
    let root = taken.iter().fold(whole, |all, leaf| builder.pair(Op::Difference, all, *leaf));
    Solid::new(primitives, builder.finish(root).unwrap()).unwrap()
}

/// Against the corners of an octahedron and of what is left of it. Its block is a tenth of its diagonal wider.
#[test]
fn blocks_that_half_spaces_cut_are_tight() {
    let sides: Vec<_> = (0..8).map(|i| ([0, 1, 2].map(|k| if i >> k & 1 == 0 { 1.0 } else { -1.0 }), 2.0)).collect();
    let tips = [DVec3::X, DVec3::Y, DVec3::Z].map(|e| [2.0 * e, -2.0 * e]).concat();
    // where z is at most 1, the tip becomes a square
    let cut = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]].map(|[x, y]| DVec3::new(x, y, 1.0));
    let below: Vec<DVec3> = tips.iter().copied().filter(|p| p.z < 1.0).chain(cut).collect();
    let wide = || block([-2.6; 3], [2.6; 3]);
    for transform in turns() {
        let placed = || Primitive { transform, ..wide() };
        let moved =
            |points: &[DVec3]| points.iter().map(|p| transform.transform_point3(*p)).fold(Bounds::EMPTY, Bounds::with);
        let whole = cut_block(placed(), &sides, &[]);
        assert_box(model(whole.clone()).bounds(), moved(&tips), 1e-11);
        let cut = model(cut_block(placed(), &sides, &[([0.0, 0.0, -1.0], -1.0)]));
        assert_box(cut.bounds(), moved(&below), 1e-11);
        // twice the same side, and one that cuts nothing
        let more = [&sides[..], &[sides[0], ([1.0, 0.3, 0.2], 50.0)]].concat();
        assert_box(model(cut_block(placed(), &more, &[])).bounds(), moved(&tips), 1e-11);
        // a part of a union, and the first part of a difference
        let ball = primitive(Shape::Sphere { radius: 1.0 }, DAffine3::from_translation(transform.translation));
        let both = Solid::union(&[whole, Solid::of(ball).unwrap()]).unwrap();
        assert_box(model(both).bounds(), moved(&tips), 1e-11);
        // sides that leave nothing
        assert_eq!(model(cut_block(placed(), &sides, &[([1.0, 1.0, 1.0], 2.5)])).bounds(), Bounds::EMPTY);
    }
    // a block that a turned one cuts: |x - 3| + |y - 3| <= 3.25 where y is at most 2.6
    let half = 3.25 * FRAC_1_SQRT_2;
    let diamond = Primitive {
        transform: DAffine3::from_translation(DVec3::new(3.0, 3.0, 0.0)) * DAffine3::from_rotation_z(FRAC_PI_4),
        ..block([-half; 3], [half; 3])
    };
    let both = pair(Op::Intersection, wide(), diamond);
    assert_box(both.bounds(), of([0.15, 0.15, -half], [2.6, 2.6, half]), 1e-11);
}

/// A tetrahedron of four half-spaces, without a block; with one of them away it is open.
#[test]
fn half_spaces_that_enclose_something_are_tight() {
    let planes = [([-1.0, 0.0, 0.0], -1.0), ([0.0, -1.0, 0.0], -1.0), ([0.0, 0.0, -1.0], -1.0), ([1.0; 3], 6.0)];
    let corners = [[1.0, 1.0, 1.0], [4.0, 1.0, 1.0], [1.0, 4.0, 1.0], [1.0, 1.0, 4.0]].map(DVec3::from);
    let ball = || primitive(Shape::Sphere { radius: 2.0 }, DAffine3::IDENTITY);
    for transform in turns() {
        let half = |(normal, offset): &([f64; 3], f64)| {
            primitive(Shape::HalfSpace { normal: (*normal).into(), offset: *offset }, transform)
        };
        let part = |planes: &[([f64; 3], f64)]| {
            let solids: Vec<Solid> = planes.iter().map(|plane| Solid::of(half(plane)).unwrap()).collect();
            solids[1..].iter().fold(solids[0].clone(), |all, solid| all.intersection(solid).unwrap())
        };
        let expected = corners.map(|p| transform.transform_point3(p)).into_iter().fold(Bounds::EMPTY, Bounds::with);
        assert_box(model(part(&planes)).bounds(), expected, 1e-10);
        assert_eq!(model(part(&planes[1..])).bounds(), Bounds::EMPTY);
        // nothing is left: no box either
        let empty = [&planes[..], &[([1.0; 3], 2.5)]].concat();
        assert_eq!(model(part(&empty)).bounds(), Bounds::EMPTY);
        // an open part without a plane across an axis takes nothing from the box of what it is cut with
        if transform != DAffine3::IDENTITY {
            let cut = part(&planes[1..]).intersection(&Solid::of(ball()).unwrap()).unwrap();
            assert_box(model(cut).bounds(), of([-2.0; 3], [2.0; 3]), 1e-12);
        }
    }
}

/// A quadric that is a cylinder without ends, between two planes across it: tight along the axes, and elsewhere the box
/// of a turned box, which a camera sees. With a plane away it is open.
#[test]
fn cylinders_between_planes_have_boxes() {
    let squares = DVec3::new(1.0, 4.0, 0.0);
    // (x - 1)² + 4 y² <= 4
    let quadric = Quadric { squares, linear: DVec3::X * -2.0, constant: -3.0, ..Quadric::default() };
    let own = of([-1.0, -1.0, 0.0], [3.0, 1.0, 5.0]);
    let ends = [([0.0, 0.0, -1.0], 0.0), ([0.0, 0.0, 2.0], 10.0)];
    for transform in turns() {
        let solid = |ends: &[([f64; 3], f64)]| {
            let half =
                |(normal, offset): &([f64; 3], f64)| Shape::HalfSpace { normal: (*normal).into(), offset: *offset };
            let shapes = std::iter::once(Shape::Quadric(quadric)).chain(ends.iter().map(half));
            let solids: Vec<Solid> = shapes.map(|shape| Solid::of(primitive(shape, transform)).unwrap()).collect();
            model(solids[1..].iter().fold(solids[0].clone(), |all, solid| all.intersection(solid).unwrap()))
        };
        let found = solid(&ends).bounds();
        let around = own.corners().map(|p| transform.transform_point3(p)).into_iter().fold(Bounds::EMPTY, Bounds::with);
        if transform == DAffine3::IDENTITY {
            assert_box(found, own, 1e-12);
            let camera = |model: &Model| Camera::framing(model, DVec3::new(1.0, 0.7, 0.4), DVec3::Z, 0.5, (640, 480));
            let boxed = camera(&model(Solid::of(block(own.min.into(), own.max.into())).unwrap()));
            let off = camera(&solid(&ends)).eye.distance(boxed.eye);
            assert!(off < 0.02 * own.diagonal(), "{off} from {boxed:?}");
        }
        // the rim: points of both ends
        for k in 0..720 {
            let (sin, cos) = f64::from(k).to_radians().sin_cos();
            let p = transform.transform_point3(DVec3::new(1.0 + 2.0 * cos, sin, if k < 360 { 0.0 } else { 5.0 }));
            let holds = p.cmpge(found.min - 1e-9) & p.cmple(found.max + 1e-9);
            assert!(holds.all(), "{p} is outside {found:?}");
        }
        assert!(found.diagonal() < 3.0 * around.diagonal(), "{found:?} for {around:?}");
        // frames have no other box of it
        assert_eq!(solid(&ends).control_bounds(), found);
        let open = solid(&ends[1..]);
        assert_eq!([open.bounds(), open.control_bounds()], [Bounds::EMPTY; 2]);
    }
}

/// A camera sees the corners, not the block.
#[test]
fn framing_follows_the_corners() {
    let sides: Vec<_> = (0..8).map(|i| ([0, 1, 2].map(|k| if i >> k & 1 == 0 { 1.0 } else { -1.0 }), 2.0)).collect();
    let solid = cut_block(block([-9.0; 3], [9.0; 3]), &sides, &[]);
    let camera = |model: &Model| Camera::framing(model, DVec3::new(1.0, 0.7, 0.4), DVec3::Z, 0.5, (640, 480));
    let facets = {
        let tips = [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z].map(|p| 2.0 * p);
        let upper = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
        let mesh = Mesh::new(1, tips.to_vec(), upper.to_vec(), Vec::new()).unwrap();
        let part = Part { meshes: vec![mesh], ..Part::default() };
        let instance = Instance { part: 0, transform: DAffine3::IDENTITY, colour: None, name: String::new() };
        Model { parts: vec![part], instances: vec![instance], ..Model::default() }
    };
    let (found, expected) = (camera(&model(solid)), camera(&facets));
    assert!(found.eye.distance(expected.eye) < 1e-3, "{found:?} instead of {expected:?}");
}

#[test]
fn half_spaces_across_an_axis_cut() {
    let half = |normal: [f64; 3], offset: f64| {
        primitive(Shape::HalfSpace { normal: normal.into(), offset }, DAffine3::IDENTITY)
    };
    let ball = || primitive(Shape::Sphere { radius: 2.0 }, DAffine3::IDENTITY);
    let below = of([-2.0; 3], [2.0, 2.0, 1.0]);
    assert_eq!(pair(Op::Intersection, ball(), half([0.0, 0.0, 2.0], 2.0)).bounds(), below);
    let above = of([-2.0, -2.0, 1.0], [2.0; 3]);
    assert_eq!(pair(Op::Difference, ball(), half([0.0, 0.0, 2.0], 2.0)).bounds(), above);
    // on a slant it may leave any end
    assert_eq!(pair(Op::Intersection, ball(), half([0.0, 1.0, 1.0], 1.0)).bounds(), of([-2.0; 3], [2.0; 3]));
    // without an end there is no box
    assert_eq!(model(Solid::of(half([0.0, 0.0, 1.0], 1.0)).unwrap()).bounds(), Bounds::EMPTY);
}

/// No box is larger than that of control points, which frames store.
#[test]
fn boxes_are_within_those_of_control_points() {
    for transform in turns() {
        let torus = primitive(Shape::Torus { major: 3.0, minor: 1.0 }, transform);
        for op in [Op::Union, Op::Intersection, Op::Difference, Op::SymmetricDifference] {
            let model = pair(op, torus.clone(), block([-2.0; 3], [3.0; 3]));
            let (found, kept) = (model.bounds(), model.control_bounds());
            let margin = 1e-12 * kept.diagonal();
            let is_within = found.min.cmpge(kept.min - margin) & found.max.cmple(kept.max + margin);
            assert!(found.is_empty() || is_within.all(), "{op:?}: {found:?} beyond {kept:?}");
        }
    }
}
