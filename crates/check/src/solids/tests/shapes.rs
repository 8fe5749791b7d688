//! Primitives and solids in one line each.

use crate::csg::parse;
use crate::math::random::Random;
use crate::model::{Bounds, Mesh};
use crate::model::{Primitive, Shape, Solid, SurfaceTable};
use crate::solids::{SolidTracer, Trace};
use glam::{DAffine3, DVec3};
use std::sync::Arc;

pub fn at(x: f64, y: f64, z: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(x, y, z))
}

pub fn placed(shape: Shape, transform: DAffine3) -> Primitive {
    Primitive { shape, transform, colour: [1.0; 4], id: 1 }
}

pub fn block(min: [f64; 3], max: [f64; 3]) -> Primitive {
    placed(Shape::Block { min: min.into(), max: max.into() }, DAffine3::IDENTITY)
}

pub fn sphere(radius: f64, x: f64) -> Primitive {
    placed(Shape::Sphere { radius }, at(x, 0.0, 0.0))
}

pub fn cylinder(radius: f64, z: f64, height: f64) -> Primitive {
    placed(Shape::Cylinder { radius, height }, at(0.0, 0.0, z))
}

/// The twelve triangles of a block.
pub fn mesh_block(min: [f64; 3], max: [f64; 3]) -> Primitive {
    let corners = Bounds { min: min.into(), max: max.into() }.corners();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let mesh = Mesh::new(1, corners.to_vec(), triangles, vec![]).unwrap();
    placed(Shape::Mesh(Arc::new(mesh)), DAffine3::IDENTITY)
}

/// The expression over primitives A, B, C ... in order.
pub fn solid(text: &str, mut primitives: Vec<Primitive>) -> Solid {
    for (id, p) in (1..).zip(&mut primitives) {
        p.id = id;
    }
    let e = parse(text).unwrap();
    let index = |name: &String| u32::from(name.as_bytes()[0] - b'A');
    let order: Vec<u32> = e.names.iter().map(index).collect();
    let primitives = order.iter().map(|i| primitives[*i as usize].clone()).collect();
    Solid::new(primitives, e.tree).unwrap()
}

pub fn tracer(text: &str, primitives: Vec<Primitive>) -> SolidTracer {
    SolidTracer::new(&solid(text, primitives), SurfaceTable::EXACT).unwrap()
}

pub fn trace(text: &str, primitives: Vec<Primitive>, o: [f64; 3], d: [f64; 3]) -> Trace {
    tracer(text, primitives).trace(o.into(), d.into())
}

/// Parameters of the boundaries and whether they enter.
pub fn stops(trace: &Trace) -> Vec<(f64, bool)> {
    trace.boundaries.iter().map(|b| (b.t, b.entering)).collect()
}

/// Volume within a square of `side` about the origin by lines along z, on a jittered grid of `n` by `n`.
pub fn volume(tracer: &SolidTracer, side: f64, n: u32) -> f64 {
    let mut random = Random::new(7);
    let cell = side / f64::from(n);
    let mut sum = 0.0;
    for i in 0..n * n {
        let mut place = |k: u32| -0.5 * side + (f64::from(k) + random.range(0.0, 1.0)) * cell;
        let o = DVec3::new(place(i % n), place(i / n), -50.0);
        sum += tracer.trace(o, DVec3::Z).thickness(0.0, 100.0);
    }
    sum * cell * cell
}

/// Random lines towards a ball of radius `reach` about the origin.
pub fn lines(seed: u64, count: u32, reach: f64) -> impl Iterator<Item = (DVec3, DVec3)> {
    let mut random = Random::new(seed);
    (0..count).map(move |_| {
        let mut point = |r: f64| DVec3::new(random.range(-r, r), random.range(-r, r), random.range(-r, r));
        let (o, target) = (point(1.0).normalize_or(DVec3::X) * reach * 4.0, point(reach));
        (o, target - o)
    })
}
