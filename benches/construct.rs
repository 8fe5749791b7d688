//! Throughput of constructions: control points a second of lofts, and of the cut of their surfaces into patches.
//!
//! `cargo bench --bench construct`

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::{DVec3, DVec4};
use selvedge::construct::{compatible, loft};
use selvedge::spline::{BSpline, Control};

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
        // of two kinds: their union has twice the knots
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

// fits have their own groups beside these
criterion_group!(benches, lofts, conversion);
criterion_main!(benches);
