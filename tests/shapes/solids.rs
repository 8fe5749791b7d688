//! Boolean solids in one line each: an expression over primitives A, B, C ..., numbered from 1.

use glam::{DAffine3, DQuat, DVec3};
use selvedge::csg::{Builder, Op, parse};
use selvedge::model::{Model, Primitive, Quadric, Shape, Solid};
use std::f64::consts::FRAC_PI_2;

/// A model and its name.
pub type Named = (&'static str, Model);

pub fn at(x: f64, y: f64, z: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(x, y, z))
}

/// About x, y and z in turn.
pub fn turned(x: f64, y: f64, z: f64) -> DAffine3 {
    DAffine3::from_quat(DQuat::from_euler(glam::EulerRot::XYZ, x, y, z))
}

pub fn primitive(shape: Shape, transform: DAffine3) -> Primitive {
    Primitive { shape, transform, colour: [0.7, 0.7, 0.7, 1.0], id: 1 }
}

pub fn block(min: [f64; 3], max: [f64; 3]) -> Primitive {
    primitive(Shape::Block { min: min.into(), max: max.into() }, DAffine3::IDENTITY)
}

pub fn ball(radius: f64, x: f64) -> Primitive {
    primitive(Shape::Sphere { radius }, at(x, 0.0, 0.0))
}

pub fn post(radius: f64, z: f64, height: f64) -> Primitive {
    primitive(Shape::Cylinder { radius, height }, at(0.0, 0.0, z))
}

pub fn cone(bottom: f64, top: f64, height: f64) -> Primitive {
    primitive(Shape::Cone { bottom, top, height }, DAffine3::IDENTITY)
}

pub fn ring(major: f64, minor: f64) -> Primitive {
    primitive(Shape::Torus { major, minor }, DAffine3::IDENTITY)
}

pub fn below(normal: DVec3, offset: f64) -> Primitive {
    primitive(Shape::HalfSpace { normal, offset }, DAffine3::IDENTITY)
}

pub fn quadric(squares: [f64; 3], products: [f64; 3], linear: [f64; 3], constant: f64) -> Primitive {
    let q = Quadric { squares: squares.into(), products: products.into(), linear: linear.into(), constant };
    primitive(Shape::Quadric(q), DAffine3::IDENTITY)
}

/// Moved by a transform after its own.
pub fn moved(transform: DAffine3, p: Primitive) -> Primitive {
    Primitive { transform: transform * p.transform, ..p }
}

/// The expression over primitives A, B, C ... in order.
pub fn solid(text: &str, mut primitives: Vec<Primitive>) -> Model {
    for (id, p) in (1..).zip(&mut primitives) {
        p.id = id;
    }
    let e = parse(text).unwrap();
    let named = e.names.iter().map(|name| primitives[usize::from(name.as_bytes()[0] - b'A')].clone()).collect();
    Model { solids: vec![Solid::new(named, e.tree).unwrap()], ..Model::default() }
}

/// All of `primitives` under one operation, from the left.
pub fn folded(op: Op, mut primitives: Vec<Primitive>) -> Model {
    let mut b = Builder::new();
    for (id, p) in (1..).zip(&mut primitives) {
        p.id = id;
    }
    let leaves: Vec<u32> = (0..primitives.len() as u32).map(|p| b.leaf(p)).collect();
    let root = b.fold(op, leaves);
    Model { solids: vec![Solid::new(primitives, b.finish(root).unwrap()).unwrap()], ..Model::default() }
}

/// A plate of `n` by `n` flush holes, 10 apart.
pub fn holes(n: u32) -> Model {
    holes_by(n, &post(3.0, 0.0, 5.0))
}

/// The same holes by another tool, which is given at the origin.
pub fn holes_by(n: u32, tool: &Primitive) -> Model {
    let side = 10.0 * f64::from(n);
    let hole = |k: u32| moved(at(f64::from(k % n) * 10.0 + 5.0, f64::from(k / n) * 10.0 + 5.0, 0.0), tool.clone());
    folded(Op::Difference, [block([0.0; 3], [side, side, 5.0])].into_iter().chain((0..n * n).map(hole)).collect())
}

/// A convex stone of a hundred half-spaces, with a pit that is convex, too, and a block beside it.
pub fn stone() -> Model {
    let (mut all, mut b) = (Vec::new(), Builder::new());
    let mut convex = |count: u32, centre: DVec3, radius: f64| {
        // it cuts off the outermost corners
        let reach = DVec3::splat(1.05 * radius);
        all.push(block((centre - reach).to_array(), (centre + reach).to_array()));
        all.extend((0..count).map(|i| {
            // about as many in each direction
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
            let turn = f64::from(i) * 2.399_963_229_728_653;
            let normal = DVec3::new(turn.cos(), turn.sin(), 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z;
            below(normal, radius + normal.dot(centre))
        }));
        let first = all.len() as u32 - count - 1;
        let leaves: Vec<u32> = (first..=first + count).map(|p| b.leaf(p)).collect();
        b.fold(Op::Intersection, leaves)
    };
    let (body, pit) = (convex(100, DVec3::ZERO, 1.0), convex(20, DVec3::new(0.5, -0.6, 0.7), 0.5));
    all.push(block([0.8, -0.4, -0.4], [1.6, 0.4, 0.4]));
    let beside = b.leaf(all.len() as u32 - 1);
    let cut = b.pair(Op::Difference, body, pit);
    let root = b.pair(Op::Union, cut, beside);
    (1..).zip(&mut all).for_each(|(id, p)| p.id = id);
    Model { solids: vec![Solid::new(all, b.finish(root).unwrap()).unwrap()], ..Model::default() }
}

/// `n` by `n` blocks, 3 apart, each without its eight corners.
pub fn blunt_blocks(n: u32) -> Model {
    let (mut all, mut b, mut blocks) = (Vec::new(), Builder::new(), Vec::new());
    for k in 0..n * n {
        let centre = 3.0 * DVec3::new(f64::from(k % n), f64::from(k / n), 0.0);
        let leaf = b.leaf(all.len() as u32);
        all.push(block((centre - 1.0).to_array(), (centre + 1.0).to_array()));
        let corners = (0..8u32).map(|i| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0 } else { 1.0 }));
        let cut = corners.map(|corner| {
            let normal = DVec3::from(corner).normalize();
            all.push(below(normal, 1.3 + normal.dot(centre)));
            b.leaf(all.len() as u32 - 1)
        });
        let leaves = [leaf].into_iter().chain(cut).collect::<Vec<_>>();
        blocks.push(b.fold(Op::Intersection, leaves));
    }
    let root = b.fold(Op::Union, blocks);
    (1..).zip(&mut all).for_each(|(id, p)| p.id = id);
    Model { solids: vec![Solid::new(all, b.finish(root).unwrap()).unwrap()], ..Model::default() }
}

/// Nested balls, each subtracted from the one around it, cut open.
pub fn onion() -> Model {
    let mut b = Builder::new();
    let mut all: Vec<Primitive> = (0..20).map(|i| ball(20.0 - f64::from(i), 0.0)).collect();
    all.push(block([0.0, -30.0, 0.0], [30.0, 0.0, 30.0]));
    (1..).zip(&mut all).for_each(|(id, p)| p.id = id);
    let mut root = b.leaf(19);
    for i in (0..19).rev() {
        let outer = b.leaf(i);
        root = b.pair(Op::Difference, outer, root);
    }
    let cut = b.leaf(20);
    root = b.pair(Op::Difference, root, cut);
    Model { solids: vec![Solid::new(all, b.finish(root).unwrap()).unwrap()], ..Model::default() }
}

/// Faces that coincide.
pub fn coincident() -> Vec<Named> {
    let plate = || block([-2.0, -2.0, 0.0], [2.0, 2.0, 1.0]);
    let cube = |x: f64, y: f64, z: f64| block([x, y, z], [x + 1.0, y + 1.0, z + 1.0]);
    let tilt = turned(0.3, 0.7, 1.1);
    let six = |x: f64| format!("{x:.5e}").parse::<f64>().unwrap();
    let rounded = |m: DAffine3| DAffine3::from_cols_array(&m.to_cols_array().map(six));
    let side = |x: f64| {
        primitive(Shape::Block { min: DVec3::ZERO, max: DVec3::splat(40.0) }, rounded(tilt * at(x, 60.0, 110.0)))
    };
    let same = moved(turned(0.0, 0.0, 0.3) * DAffine3::from_scale(DVec3::new(2.0, 2.0, 3.0)), post(0.5, 0.0, 1.0));
    let gap = |g: f64| solid("A+B", vec![cube(0.0, 0.0, 0.0), cube(0.0, 0.0, 1.0 + g)]);
    vec![
        ("flush hole", solid("A-B", vec![plate(), post(1.0, 0.0, 1.0)])),
        ("blind pocket", solid("A-B", vec![plate(), post(1.0, 0.5, 0.5)])),
        ("one cylinder in another of its radius", solid("A+B", vec![post(1.0, 0.0, 1.0), post(1.0, -1.0, 3.0)])),
        ("a cylinder's end cut off", solid("B-A", vec![post(1.0, 0.0, 1.0), post(1.0, -1.0, 3.0)])),
        ("the same cylinder turned, and a ball", solid("A-B+C", vec![post(1.0, 0.0, 3.0), same, ball(0.7, 0.4)])),
        ("two cubes side by side", solid("A+B", vec![cube(0.0, 0.0, 0.0), cube(1.0, 0.0, 0.0)])),
        (
            "cubes at an edge and a vertex",
            solid("A+B+C", vec![cube(0.0, 0.0, 0.0), cube(1.0, 1.0, 0.0), cube(2.0, 0.0, 1.0)]),
        ),
        (
            "overlapping tops",
            solid("A+B", vec![block([0.0; 3], [2.0, 2.0, 1.0]), block([1.0, 0.5, 0.5], [3.0, 1.5, 1.0])]),
        ),
        ("refilled hole", solid("A-B+C", vec![plate(), post(1.0, 0.0, 1.0), post(1.0, 0.0, 1.0)])),
        ("owner beside the dead", solid("(A-B)+C", vec![plate(), moved(at(0.0, 0.0, 1.0), plate()), plate()])),
        ("a solid and itself", solid("AA+(A-A)+A!A", vec![ball(1.0, 0.0)])),
        ("six digits", Model { ..solid("A+B", vec![side(0.0), side(40.0)]) }),
        ("a gap of 1e-3", gap(1e-3)),
        ("a gap of 1e-4", gap(1e-4)),
        ("a gap of 1e-5", gap(1e-5 * 3.0)),
        ("an exclusive or", solid("A^B", vec![plate(), moved(at(1.0, 1.0, 0.0), plate())])),
        ("two solids of one model", {
            let mut model = solid("A-B", vec![plate(), post(1.0, 0.0, 1.0)]);
            model.solids.extend(solid("A", vec![block([-1.0, -3.0, 0.5], [1.0, 3.0, 1.0])]).solids);
            model
        }),
    ]
}

/// Tangents, apexes, four roots, thin shells.
pub fn delicate() -> Vec<Named> {
    let across = |p: Primitive| moved(turned(FRAC_PI_2, 0.0, 0.0), p);
    // the views' direction lies in the ring's plane: up to four crossings
    let edge_on = DQuat::from_rotation_arc(DVec3::Z, DVec3::new(1.6, 1.0, 0.0).normalize());
    let shell = |thin: f64| {
        solid("A-B-C", vec![ball(1.0, 0.0), ball(1.0 - thin, 0.0), block([0.0, -2.0, 0.0], [2.0, 0.0, 2.0])])
    };
    vec![
        ("tangent balls", solid("A+B", vec![ball(1.0, -1.0), ball(1.0, 1.0)])),
        ("a ball less a tangent one", solid("A-B", vec![ball(1.0, -1.0), ball(1.0, 1.0)])),
        (
            "tangent cylinders on a plane",
            solid(
                "A+B+C",
                vec![
                    block([-2.0, -2.0, -1.0], [4.0, 2.0, 0.0]),
                    moved(at(0.0, 1.0, 0.5), across(post(0.5, 0.0, 2.0))),
                    moved(at(1.0, 1.0, 0.5), across(post(0.5, 0.0, 2.0))),
                ],
            ),
        ),
        (
            "a torus on its tangent plane",
            solid("A+B", vec![block([-5.0, -5.0, -1.0], [5.0, 5.0, 0.0]), moved(at(0.0, 0.0, 1.0), ring(3.0, 1.0))]),
        ),
        (
            "Steinmetz, two",
            solid("AB", vec![post(1.0, -2.0, 4.0), moved(at(0.0, 2.0, 0.0), across(post(1.0, 0.0, 4.0)))]),
        ),
        (
            "Steinmetz, three",
            solid(
                "ABC",
                vec![
                    post(1.0, -2.0, 4.0),
                    moved(at(0.0, 2.0, 0.0), across(post(1.0, 0.0, 4.0))),
                    moved(turned(0.0, FRAC_PI_2, 0.0), post(1.0, -2.0, 4.0)),
                ],
            ),
        ),
        (
            "a cone's apex on a face",
            solid(
                "A+B",
                vec![
                    block([-1.0, -1.0, -1.0], [1.0, 1.0, 0.0]),
                    moved(at(0.0, 0.0, 1.0) * turned(FRAC_PI_2 * 2.0, 0.0, 0.0), cone(0.8, 0.0, 1.0)),
                ],
            ),
        ),
        ("a conical sink", solid("A-B", vec![block([-1.0, -1.0, 0.0], [1.0; 3]), cone(0.0, 0.8, 1.0)])),
        ("a ring", solid("A", vec![moved(turned(0.9, 0.3, 0.0), ring(3.0, 1.0))])),
        ("a ring edge-on", solid("A", vec![moved(DAffine3::from_quat(edge_on), ring(3.0, 1.0))])),
        ("a horn torus, whole", solid("A", vec![moved(turned(0.9, 0.3, 0.0), ring(1.0, 1.0))])),
        ("a spindle torus, whole", solid("A", vec![moved(turned(0.9, 0.3, 0.0), ring(1.0, 2.0))])),
        ("a horn torus", solid("A-B", vec![ring(1.0, 1.0), block([0.0, -3.0, 0.0], [3.0, 0.0, 3.0])])),
        ("a spindle torus", solid("A-B", vec![ring(1.0, 2.0), block([0.0, -4.0, 0.0], [4.0, 0.0, 4.0])])),
        (
            "a thin ring in a groove",
            solid(
                "A-B+C",
                vec![
                    post(3.0, 0.0, 1.0),
                    moved(at(0.0, 0.0, 1.0), ring(2.0, 0.5)),
                    moved(at(0.0, 0.0, 1.0), ring(2.0, 0.1)),
                ],
            ),
        ),
        ("nested twenty deep", onion()),
        ("a shell of 1e-2", shell(1e-2)),
        ("a shell of 1e-4", shell(1e-4)),
        (
            "a product of sums",
            solid(
                "(A+B)(C+D)(E+F)",
                vec![
                    block([-2.0, -1.0, -1.0], [2.0, 1.0, 1.0]),
                    ball(1.5, 0.0),
                    post(1.0, -3.0, 6.0),
                    ball(1.2, 1.0),
                    block([-1.0, -2.0, -2.0], [2.0, 2.0, 0.5]),
                    cone(1.0, 0.2, 1.5),
                ],
            ),
        ),
    ]
}

/// Quadrics of every kind, within a block.
pub fn quadrics() -> Vec<Named> {
    let within = |q: Primitive| solid("AB", vec![block([-2.0; 3], [2.0; 3]), moved(turned(0.4, 0.2, 0.9), q)]);
    let without = |q: Primitive| solid("A-B", vec![block([-2.0; 3], [2.0; 3]), moved(turned(0.4, 0.2, 0.9), q)]);
    let zero = [0.0; 3];
    let two_sheets = || quadric([1.0, 1.0, -1.0], zero, zero, 0.3);
    vec![
        ("an ellipsoid said by products", within(quadric([1.0, 2.0, 1.5], [0.5, 0.3, -0.4], [0.3, 0.2, 0.1], -1.0))),
        ("a hyperboloid of one sheet", within(quadric([1.0, 1.0, -1.0], zero, zero, -0.3))),
        ("a hyperboloid of two sheets", within(two_sheets())),
        ("less a hyperboloid of two sheets", without(two_sheets())),
        ("a double cone", within(quadric([1.0, 1.0, -1.0], zero, zero, 0.0))),
        ("a paraboloid", within(quadric([1.0, 1.0, 0.0], zero, [0.0, 0.0, -1.0], -0.5))),
        ("a saddle", within(quadric([0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0], 0.0))),
        ("a parabolic cylinder", within(quadric([1.0, 0.0, 0.0], zero, [0.0, 0.6, -0.8], 0.1))),
        ("a hyperbolic cylinder", within(quadric([1.0, -1.0, 0.0], zero, zero, 0.3))),
        ("a slab", within(quadric([0.0, 0.0, 1.0], zero, zero, -0.5))),
        ("two planes that cross", within(quadric([0.0; 3], [1.0, 0.0, 0.0], zero, 0.0))),
        ("a plane", within(quadric(zero, zero, [0.3, 0.5, 0.7], -0.2))),
        ("everything", within(quadric(zero, zero, zero, -1.0))),
        (
            "a ball and its hollow",
            solid(
                "AB+A!C",
                vec![
                    block([-2.0; 3], [2.0, 2.0, 0.0]),
                    quadric([1.0; 3], zero, zero, -1.0),
                    quadric([-1.0; 3], zero, zero, 1.0),
                ],
            ),
        ),
        ("almost a paraboloid", within(quadric([1.0, 1.0, 1e-5], zero, [0.0, 0.0, -1.0], -0.5))),
    ]
}

/// Transforms and units.
pub fn odd() -> Vec<Named> {
    let drilled = |m: DAffine3| {
        let all = vec![block([-2.0, -2.0, 0.0], [2.0, 2.0, 1.0]), post(1.0, 0.0, 1.0), ring(1.6, 0.3)];
        solid("A-B+C", all.into_iter().map(|p| moved(m, p)).collect())
    };
    let scaled = |x: f64, y: f64, z: f64| DAffine3::from_scale(DVec3::new(x, y, z));
    let mut sheared = DAffine3::IDENTITY;
    sheared.matrix3.z_axis = DVec3::new(0.4, 0.2, 1.0);
    let flat = moved(scaled(1.0, 1.0, 0.0), ball(1.0, 0.0));
    vec![
        ("mirrored", drilled(scaled(-1.0, 1.0, 1.0))),
        ("non-uniform", drilled(turned(0.2, 0.1, 0.3) * scaled(2.0, 0.5, 1.3))),
        ("sheared", drilled(sheared)),
        ("an offset of 1e6", drilled(at(1e6, -1e6, 1e6))),
        ("units of 1e-4", drilled(scaled(1e-4, 1e-4, 1e-4))),
        ("units of 1e5", drilled(scaled(1e5, 1e5, 1e5))),
        ("a flat ball beside a whole one", solid("A+B-C", vec![ball(1.0, 0.0), flat.clone(), flat])),
        (
            "a block cut by half-spaces",
            solid(
                "ABC",
                vec![
                    block([-2.0; 3], [2.0; 3]),
                    below(DVec3::new(1.0, 1.0, 1.0), 1.0),
                    below(DVec3::new(-1.0, 0.5, 2.0), 1.5),
                ],
            ),
        ),
        ("an unbounded wedge less a ball", {
            // a bounded primitive determines the view
            let mut model = solid("A", vec![ball(1.2, 1.0)]);
            let wedge = [
                below(DVec3::Z, 0.0),
                below(DVec3::new(1.0, 1.0, 0.0), 1.0),
                below(DVec3::new(-1.0, 0.2, 0.0), 1.0),
                ball(1.0, 0.0),
            ];
            model.solids.extend(solid("ABC-D", wedge.to_vec()).solids);
            model
        }),
        (
            "everything but a ball, and a ball",
            solid("A!B+C", vec![block([-2.0; 3], [2.0; 3]), post(1.0, -3.0, 9.0), ball(0.5, 0.0)]),
        ),
    ]
}

/// Solids without a point.
pub fn nothing() -> Vec<Named> {
    let cube = |x: f64, y: f64, z: f64| block([x, y, z], [x + 1.0, y + 1.0, z + 1.0]);
    let flat = |s: f64| moved(DAffine3::from_scale(DVec3::new(1.0, 1.0, s)), ball(1.0, 0.0));
    vec![
        ("a shared face", solid("AB", vec![cube(0.0, 0.0, 0.0), cube(1.0, 0.0, 0.0)])),
        ("a shared edge", solid("AB", vec![cube(0.0, 0.0, 0.0), cube(1.0, 1.0, 0.0)])),
        ("a shared vertex", solid("AB", vec![cube(0.0, 0.0, 0.0), cube(1.0, 1.0, 1.0)])),
        ("A - A", solid("A-A", vec![ring(2.0, 0.5)])),
        ("A * !A", solid("A!A", vec![cone(1.0, 0.5, 1.0)])),
        ("equal cylinders", solid("A-B", vec![post(1.0, 0.0, 1.0), post(1.0, -1.0, 3.0)])),
        ("A ^ A", solid("A^B", vec![ball(1.0, 0.0), ball(1.0, 0.0)])),
        ("all of space", solid("A+!A", vec![ball(1.0, 0.0)])),
        ("no height", solid("A", vec![flat(0.0)])),
        ("no number", solid("A", vec![flat(f64::NAN)])),
        ("a radius of 0", solid("A+B", vec![ball(0.0, 0.0), post(0.0, 0.0, 1.0)])),
        ("a ball at a cone's apex", solid("AB", vec![cone(1.0, 0.0, 1.0), block([-1.0, -1.0, 1.0], [1.0, 1.0, 2.0])])),
        ("a shell within the tolerance", solid("A-B", vec![ball(1.0, 0.0), ball(1.0 - 1e-6, 0.0)])),
        ("no points", solid("A", vec![quadric([1.0; 3], [0.0; 3], [0.0; 3], 1.0)])),
    ]
}
