//! Fits of equations and grids: throughput in points of the surface or of the data.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use selvedge::construct::fit::{FitOptions, fit};
use selvedge::construct::grid::{PointGrid, approximate, interpolate};
use std::f64::consts::{PI, TAU};

fn wave(u: f64, v: f64) -> DVec3 {
    DVec3::new(u, v, (6.0 * u).sin() * (4.0 * v).cos())
}

fn data(n: usize) -> PointGrid {
    let at = |i: usize| i as f64 / (n - 1) as f64;
    PointGrid::new(n, (0..n * n).map(|i| wave(at(i % n), at(i / n))).collect()).expect("a full grid")
}

fn equations(c: &mut Criterion) {
    let mut group = c.benchmark_group("fit_sphere");
    group.sample_size(10);
    for exponent in [3, 6, 9] {
        let options = FitOptions::new(10f64.powi(-exponent));
        let sphere = |u: f64, v: f64| DVec3::new(u.cos() * v.cos(), u.sin() * v.cos(), v.sin());
        let run = || fit(sphere, (0.0, TAU), (-0.5 * PI, 0.5 * PI), &options).expect("a smooth surface");
        group.throughput(Throughput::Elements(run().surface.points().len() as u64));
        group.bench_function(BenchmarkId::from_parameter(format!("1e-{exponent}")), |b| b.iter(run));
    }
    group.finish();
}

fn grids(c: &mut Criterion) {
    let mut group = c.benchmark_group("grid");
    group.sample_size(10);
    for n in [100, 1000] {
        let grid = data(n);
        group.throughput(Throughput::Elements((n * n) as u64));
        group.bench_function(BenchmarkId::new("interpolate", n), |b| b.iter(|| interpolate(&grid)));
        group.bench_function(BenchmarkId::new("approximate", n), |b| b.iter(|| approximate(&grid, (n / 5, n / 5))));
    }
    group.finish();
}

criterion_group!(benches, equations, grids);
criterion_main!(benches);
