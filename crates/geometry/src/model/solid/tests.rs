//! Coincident surfaces: which faces share one, and which way round.

use crate::csg::{Builder, Node, Op, Tree};
use crate::math::random::Random;
use crate::model::{Bounds, Model, Primitive, Quadric, Shape, Solid, SurfaceTable};
use glam::{DAffine3, DQuat, DVec3};

fn table(shapes: Vec<(Shape, DAffine3)>, tolerance: f64) -> SurfaceTable {
    let mut b = Builder::new();
    let leaves: Vec<u32> = (0..shapes.len() as u32).map(|p| b.leaf(p)).collect();
    let root = b.fold(Op::Union, leaves);
    let place = |(shape, transform)| Primitive { shape, transform, colour: [1.0; 4], id: 1 };
    let solid = Solid::new(shapes.into_iter().map(place).collect(), b.finish(root).unwrap()).unwrap();
    SurfaceTable::new(&solid, tolerance)
}

fn block(min: [f64; 3], max: [f64; 3]) -> (Shape, DAffine3) {
    (Shape::Block { min: min.into(), max: max.into() }, DAffine3::IDENTITY)
}

#[test]
fn touching_blocks_share_a_flipped_plane() {
    let t = table(vec![block([0.0; 3], [1.0; 3]), block([1.0, 0.0, 0.0], [2.0, 3.0, 1.0])], SurfaceTable::EXACT);
    // 12 faces: x = 1 met from both sides, y = 0, z = 0 and z = 1 from the same side
    assert_eq!(t.surfaces().len(), 8);
    let (a, b) = (t.faces(0), t.faces(1));
    assert_eq!((b[0].surface, b[0].flipped), (a[1].surface, true));
    assert_eq!([b[2], b[4], b[5]], [a[2], a[4], a[5]]);
}

/// One surface in different forms: turned, scaled, and as ten coefficients of either sign.
#[test]
fn the_same_surface_in_other_words() {
    let move_ = DAffine3::from_rotation_translation(DQuat::from_rotation_x(0.8), DVec3::new(3.0, -2.0, 7.0));
    let scale = |s: f64| move_ * DAffine3::from_rotation_z(1.0) * DAffine3::from_scale(DVec3::splat(s));
    let ball = Quadric { squares: DVec3::ONE, constant: -4.0, ..Quadric::default() };
    let hollow = Quadric { squares: DVec3::NEG_ONE, constant: 4.0, ..Quadric::default() };
    let cases = [
        (Shape::Sphere { radius: 2.0 }, Shape::Sphere { radius: 1.0 }, 2.0, false),
        (Shape::Sphere { radius: 2.0 }, Shape::Quadric(ball), 1.0, false),
        (Shape::Sphere { radius: 2.0 }, Shape::Quadric(hollow), 1.0, true),
        (Shape::Torus { major: 3.0, minor: 1.0 }, Shape::Torus { major: 1.5, minor: 0.5 }, 2.0, false),
        (Shape::Cylinder { radius: 2.0, height: 1.0 }, Shape::Cylinder { radius: 1.0, height: 4.0 }, 2.0, false),
        (
            Shape::Cone { bottom: 2.0, top: 0.0, height: 2.0 },
            Shape::Cone { bottom: 1.0, top: 0.5, height: 0.5 },
            2.0,
            false,
        ),
    ];
    for (a, b, size, flipped) in cases {
        let t = table(vec![(a.clone(), move_), (b.clone(), scale(size))], SurfaceTable::EXACT);
        assert_eq!((t.faces(1)[0].surface, t.faces(1)[0].flipped), (0, flipped), "{a:?} {b:?}");
    }
}

#[test]
fn near_surfaces_stay_apart() {
    let far = |s: Shape, x: f64| (s, DAffine3::from_translation(DVec3::new(x, 0.0, 0.0)));
    let ball = || Shape::Sphere { radius: 1.0 };
    for (a, b, x) in [
        (ball(), ball(), 1e-4),
        (ball(), Shape::Sphere { radius: 1.0001 }, 0.0),
        (ball(), Shape::Cylinder { radius: 1.0, height: 1.0 }, 0.0),
        (Shape::Torus { major: 3.0, minor: 1.0 }, Shape::Torus { major: 3.0, minor: 1.0001 }, 0.0),
        (Shape::Torus { major: 3.0, minor: 1.0 }, Shape::Sphere { radius: 4.0 }, 0.0),
    ] {
        for tolerance in [SurfaceTable::EXACT, SurfaceTable::ROUNDED] {
            let t = table(vec![far(a.clone(), 0.0), far(b.clone(), x)], tolerance);
            assert_ne!(t.faces(0)[0].surface, t.faces(1)[0].surface, "{a:?} {b:?}");
        }
    }
}

/// A grid of 10^5 posts on one plate: caps are two planes, walls their own, in time for a test.
#[test]
fn a_hundred_thousand_posts() {
    let post = |i: u32| {
        let at = DVec3::new(f64::from(i % 1000), f64::from(i / 1000), 0.0);
        (Shape::Cylinder { radius: 0.3, height: 1.0 }, DAffine3::from_translation(at))
    };
    let t = table((0..100_000).map(post).collect(), SurfaceTable::ROUNDED);
    assert_eq!(t.surfaces().len(), 100_002);
}

/// A small ball in a large model, as a quadric: few lines through the model meet any point of it.
#[test]
fn small_quadrics_are_met() {
    let at = DVec3::new(31.0, 12.0, -7.0);
    let ball =
        Quadric { squares: DVec3::ONE, linear: -2.0 * at, constant: at.length_squared() - 0.25, ..Quadric::default() };
    let beside = DAffine3::from_translation(at + DVec3::X * 1e-5);
    let shapes = vec![
        block([-50.0; 3], [50.0; 3]),
        (Shape::Quadric(ball), DAffine3::IDENTITY),
        (Shape::Sphere { radius: 0.5 }, beside),
    ];
    let t = table(shapes, SurfaceTable::ROUNDED);
    assert_eq!((t.surfaces().len(), t.faces(2)[0].surface), (7, t.faces(1)[0].surface));
}

#[test]
fn empty_primitives_have_no_faces() {
    let flat = (Shape::Sphere { radius: 1.0 }, DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.0)));
    let t = table(vec![flat, block([0.0; 3], [1.0, 1.0, 0.0]), block([0.0; 3], [1.0; 3])], SurfaceTable::EXACT);
    assert_eq!([0, 1, 2].map(|p| t.faces(p).len()), [0, 0, 6]);
}

/// A written solid is read again; indices out of range, radii below 0 and trees in a ring are refused.
#[cfg(feature = "serde")]
#[test]
fn solids_are_written_and_read() {
    let mut b = Builder::new();
    let (x, y) = (b.leaf(0), b.leaf(1));
    let root = b.pair(Op::Difference, x, y);
    let place = |shape, id| Primitive { shape, transform: DAffine3::from_rotation_z(0.1), colour: [0.1; 4], id };
    let quadric = Quadric { squares: DVec3::ONE, constant: -0.7, ..Quadric::default() };
    let primitives = vec![place(Shape::Sphere { radius: 1.5 }, 3), place(Shape::Quadric(quadric), 4)];
    let solid = Solid::new(primitives, b.finish(root).unwrap()).unwrap();
    let model = Model { solids: vec![solid], ..Model::default() };
    let text = serde_json::to_string(&model).unwrap();
    assert_eq!(serde_json::from_str::<Model>(&text).unwrap(), model);
    let changes = [
        ("\"Leaf\":1", "\"Leaf\":2", "primitive 2 of 2"),
        ("\"radius\":1.5", "\"radius\":-1.5", "negative"),
        ("[\"Difference\",0,1]", "[\"Difference\",0,2]", "node 2"),
    ];
    for (old, new, message) in changes {
        assert!(text.contains(old), "{text}");
        let error = serde_json::from_str::<Model>(&text.replace(old, new)).unwrap_err();
        assert!(error.to_string().contains(message), "{error}");
    }
}

/// Whether a point is in a box, rims included.
fn holds(b: Bounds, p: DVec3) -> bool {
    p.cmpge(b.min).all() && p.cmple(b.max).all()
}

/// Neighbours joined at random until one is left, some of them complemented.
fn expression(random: &mut Random, leaves: u32, primitives: u32) -> Tree {
    let ops = [Op::Union, Op::Intersection, Op::Difference, Op::SymmetricDifference];
    let mut b = Builder::new();
    let mut parts: Vec<u32> = (0..leaves).map(|_| b.leaf(random.integer(0, primitives - 1))).collect();
    while parts.len() > 1 {
        let at = random.integer(0, parts.len() as u32 - 2) as usize;
        if random.integer(0, 4) == 0 {
            parts[at] = b.push(Node::Complement(parts[at]));
        }
        parts[at] = b.push(Node::Pair(random.pick(&ops), parts[at], parts[at + 1]));
        parts.remove(at + 1);
    }
    b.finish(parts[0]).unwrap()
}

/// Any primitives whose reach does not hold a point may be taken as absent there. Boxes of whole numbers and points
/// between them, so that nothing is rounded; half-spaces reach as far as the primitives that they are cut with.
#[test]
fn beyond_their_reach_primitives_do_not_matter() {
    let mut random = Random::new(71);
    let (mut left_out, mut smaller) = (0, 0);
    for _ in 0..3000 {
        let count = random.integer(1, 9);
        let repeated = random.integer(0, 1) == 1;
        let primitives = if repeated { count.div_ceil(2) } else { count };
        let tree = expression(&mut random, count, primitives);
        let whole = |random: &mut Random, lo, hi| f64::from(random.integer(lo, hi));
        let shapes = (0..primitives).map(|_| {
            let min = DVec3::from_array(std::array::from_fn(|_| whole(&mut random, 0, 6)));
            let size = DVec3::from_array(std::array::from_fn(|_| whole(&mut random, 1, 4)));
            match random.integer(0, 5) {
                0 => Shape::HalfSpace { normal: DVec3::X, offset: min.x },
                1 => Shape::Torus { major: 1.0, minor: 0.0 }, // nothing
                _ => Shape::Block { min, max: min + size },
            }
        });
        let place = |shape| Primitive { shape, transform: DAffine3::IDENTITY, colour: [1.0; 4], id: 1 };
        let solid = Solid::new(shapes.map(place).collect(), tree).unwrap();
        let reaches = solid.reaches();
        for (reach, primitive) in reaches.iter().zip(solid.primitives()) {
            let all = primitive.bounds();
            assert!(reach.is_empty() || holds(all, reach.min) && holds(all, reach.max), "{reach:?} {all:?}");
            smaller += u32::from(*reach != all);
        }
        for _ in 0..40 {
            let p = DVec3::from_array(std::array::from_fn(|_| whole(&mut random, 0, 12) - 0.5));
            let inside: Vec<bool> = solid
                .primitives()
                .iter()
                .map(|q| match q.shape {
                    Shape::HalfSpace { normal, offset } => p.dot(normal) <= offset,
                    _ => holds(q.bounds(), p),
                })
                .collect();
            let kept: Vec<bool> = reaches.iter().map(|r| holds(*r, p) || random.integer(0, 2) == 0).collect();
            left_out += inside.iter().zip(&kept).filter(|(inside, kept)| **inside && !**kept).count();
            let value = solid.tree().contains(|q| inside[q as usize]);
            let without = solid.tree().contains(|q| inside[q as usize] && kept[q as usize]);
            assert_eq!(value, without, "{p} in {:?}", solid.tree());
            assert!(!value || holds(solid.bounds(), p), "{p} beyond {:?}", solid.bounds());
        }
    }
    assert!(left_out > 5000 && smaller > 3000, "{left_out} {smaller}");
}

/// A primitive cut with a block, or subtracted from one, reaches no farther than it; a united one does.
#[test]
fn reach_of_what_is_cut() {
    let sphere =
        Primitive { shape: Shape::Sphere { radius: 2.0 }, transform: DAffine3::IDENTITY, colour: [1.0; 4], id: 1 };
    let half = Primitive { shape: Shape::HalfSpace { normal: DVec3::Z, offset: 0.0 }, ..sphere.clone() };
    let reach = |op: Op| {
        let mut b = Builder::new();
        let (s, h) = (b.leaf(0), b.leaf(1));
        let root = b.push(Node::Pair(op, s, h));
        Solid::new(vec![sphere.clone(), half.clone()], b.finish(root).unwrap()).unwrap().reaches()
    };
    let ball = Bounds { min: DVec3::splat(-2.0), max: DVec3::splat(2.0) };
    let all = Bounds { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
    assert_eq!(reach(Op::Intersection), [ball, ball]);
    assert_eq!(reach(Op::Difference), [ball, ball]);
    assert_eq!(reach(Op::Union), [ball, all]);
    assert_eq!(reach(Op::SymmetricDifference), [ball, all]);
}
