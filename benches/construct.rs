//! Throughput of constructions: control points a second of lofts, and of the cut of their surfaces into patches; faces
//! a second of subdivision surfaces and of export.
//!
//! `cargo bench --bench construct`

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::{DAffine3, DVec3, DVec4};
use selvedge::construct::shapes::SpurGear;
use selvedge::construct::subdivide::{ControlMesh, Scheme, subdivide};
use selvedge::construct::{compatible, loft};
use selvedge::model::{Instance, Model};
use selvedge::spline::{BSpline, Control};
use selvedge_io::export;
use std::f64::consts::TAU;

/// A wavy section of `count` control points at height `z`; degrees and knots change from one to the next.
fn section(z: usize, count: usize) -> BSpline<DVec4> {
    let degree = 2 + z % 2;
    let inside = count - degree;
    let skew = 1.0 + 0.05 * (z % 5) as f64;
    let knot = |k: usize| (k as f64 / inside as f64).powf(skew);
    let knots = [0.0].repeat(degree).into_iter().chain((0..=inside).map(knot)).chain([1.0].repeat(degree)).collect();
    let point = |i: usize| {
        let x = i as f64 / count as f64;
        DVec4::from_point(DVec3::new(10.0 * x, (7.0 * x + z as f64).sin(), z as f64), 1.0)
    };
    BSpline::new(degree, knots, (0..count).map(point).collect()).expect("knots fit the points")
}

fn lofts(c: &mut Criterion) {
    let mut group = c.benchmark_group("loft");
    for (sections, count) in [(10, 20), (50, 50), (200, 100)] {
        // sections of two kinds: the union of their knots is twice as long
        let all: Vec<_> = (0..sections).map(|k| section(k % 2 + 10 * (k / 2), count)).collect();
        let surface = loft(&all, false).expect("sections at different heights");
        let (nu, nv) = surface.counts();
        group.throughput(Throughput::Elements((nu * nv) as u64));
        group.bench_with_input(BenchmarkId::from_parameter(format!("{nu}x{nv}")), &all, |b, all| {
            b.iter(|| loft(all, false))
        });
    }
    group.finish();
}

fn conversion(c: &mut Criterion) {
    let mut group = c.benchmark_group("conversion");
    let all: Vec<_> = (0..50).map(|k| section(k % 2 + 10 * (k / 2), 50)).collect();
    group.throughput(Throughput::Elements(all.iter().map(|c| c.points().len() as u64).sum()));
    group.bench_function("compatible", |b| b.iter(|| compatible(&all)));
    let surface = loft(&all, false).expect("sections at different heights");
    group.throughput(Throughput::Elements(surface.patches().patches.len() as u64));
    group.bench_function("patches", |b| b.iter(|| surface.patches()));
    group.finish();
}

/// A torus of `n` by `n` quadrilaterals, or of twice as many triangles. With `odd`, a corner of one quadrilateral in 16
/// is moved to a neighbour's, which makes vertices with 3 and 5 edges.
fn torus(n: u32, triangles: bool, odd: bool) -> ControlMesh {
    let point = |k: u32| {
        let [(s, c), (t, d)] = [k % n, k / n].map(|i| (TAU * f64::from(i) / f64::from(n)).sin_cos());
        DVec3::new((3.0 + d) * c, (3.0 + d) * s, t)
    };
    let at = |i: u32, j: u32| (j % n) * n + i % n;
    let cell = |(i, j): (u32, u32)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        match (triangles, odd && i % 4 == 0 && j % 4 == 0) {
            (false, false) => vec![vec![a, b, c, d]],
            (true, true) => vec![vec![a, b, c], vec![a, c, d]],
            _ => vec![vec![a, b, d], vec![b, c, d]],
        }
    };
    let cells = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
    ControlMesh {
        positions: (0..n * n).map(point).collect(),
        faces: cells.flat_map(cell).collect(),
        ..Default::default()
    }
}

fn subdivision(c: &mut Criterion) {
    let mut group = c.benchmark_group("subdivision");
    group.sample_size(10);
    for (name, scheme, triangles, odd) in [
        ("catmull_clark_regular", Scheme::CatmullClark, false, false),
        ("catmull_clark_irregular", Scheme::CatmullClark, false, true),
        ("loop_regular", Scheme::Loop, true, false),
        ("loop_irregular", Scheme::Loop, true, true),
    ] {
        let mesh = torus(64, triangles, odd);
        group.throughput(Throughput::Elements(mesh.faces.len() as u64));
        group.bench_function(name, |b| b.iter(|| subdivide(&mesh, scheme, 1e-4)));
    }
    group.finish();
}

fn written(c: &mut Criterion) {
    let mut group = c.benchmark_group("export");
    group.sample_size(10);
    let gear = SpurGear::new(1.0, 100, 5.0, 10.0).build().expect("a gear").part;
    let smooth = subdivide(&torus(16, false, false), Scheme::CatmullClark, 1e-4).expect("a torus").part;
    for (name, part) in [("gear", gear), ("subdivided", smooth)] {
        let instance = Instance { part: 0, transform: DAffine3::IDENTITY, colour: None, name: String::new() };
        group.throughput(Throughput::Elements(part.faces.len() as u64));
        let model = Model { parts: vec![part], instances: vec![instance], ..Model::default() };
        group.bench_function(name, |b| b.iter(|| export::step(&model, &mut Vec::new())));
    }
    group.finish();
}

// fits are timed in their own benchmark
criterion_group!(benches, lofts, conversion, subdivision, written);
criterion_main!(benches);
