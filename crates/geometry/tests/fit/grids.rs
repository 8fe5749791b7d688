//! Surfaces from grids of points: they meet their data, bring polynomials back, and close where the data do.

use glam::DVec3;
use proptest::prelude::*;
use selvedge_geometry::construct::ConstructError;
use selvedge_geometry::construct::grid::{
    HeightField, PointGrid, approximate, height_field, interpolate, interpolate_at,
};
use std::f64::consts::{PI, TAU};

fn grid(nu: usize, nv: usize, f: impl Fn(f64, f64) -> DVec3) -> PointGrid {
    let at = |i: usize, n: usize| i as f64 / (n - 1) as f64;
    let points = (0..nv).flat_map(|j| (0..nu).map(move |i| (i, j)));
    PointGrid::new(nu, points.map(|(i, j)| f(at(i, nu), at(j, nv))).collect()).unwrap()
}

fn sphere(u: f64, v: f64) -> DVec3 {
    let (a, b) = (u * TAU, (v - 0.5) * PI);
    // a seam and poles of the same numbers, as data often have
    let a = if u == 1.0 { 0.0 } else { a };
    let c = if v == 0.0 || v == 1.0 { 0.0 } else { b.cos() };
    DVec3::new(a.cos() * c, a.sin() * c, b.sin())
}

#[test]
fn a_sphere_of_data_closes() {
    let g = grid(33, 17, sphere);
    let fit = interpolate(&g).unwrap();
    let (nu, nv) = fit.surface.counts();
    let net = fit.surface.points();
    assert!(net.chunks(nu).all(|row| row[0] == row[nu - 1]));
    for row in [0, nv - 1] {
        assert!(net[row * nu..][..nu].iter().all(|p| *p == net[row * nu]));
    }
    assert!(fit.error.most < 1e-14 && fit.error.rms <= fit.error.most, "{:?}", fit.error);
    // smooth over the seam, and near the sphere: h⁴ / 384 with h = 2 pi / 32 is 4e-6; the poles cost some
    let ((u0, u1), (v0, v1)) = fit.surface.domain();
    let (a, b) = (fit.surface.jet2(u0, 0.4 * v1), fit.surface.jet2(u1, 0.4 * v1));
    assert!(a.du.distance(b.du) < 1e-11 && a.duu.distance(b.duu) < 1e-9);
    for i in 0..50 {
        for j in 0..50 {
            let at = |a: f64, b: f64, i: i32| a + (b - a) * (f64::from(i) + 0.5) / 50.0;
            let r = fit.surface.point(at(u0, u1, i), at(v0, v1, j)).length();
            assert!((r - 1.0).abs() < 1e-4, "{r}");
        }
    }
}

#[test]
fn heights_lie_on_their_surface() {
    let field = HeightField { width: 4, x: (-1.0, 2.0), y: (10.0, 12.0), z: (-5.0, 5.0) };
    let samples: Vec<u16> = (0..12).map(|i| (i * 4937 % 65_536) as u16).chain([65_535; 4]).take(12).collect();
    let fit = height_field(&samples, &field).unwrap();
    for (i, s) in samples.iter().enumerate() {
        let (x, y) = (-1.0 + (i % 4) as f64, 12.0 - (i / 4) as f64);
        let z = -5.0 + 10.0 * f64::from(*s) / 65_535.0;
        let p = fit.surface.point(x, y);
        assert!(p.distance(DVec3::new(x, y, z)) < 1e-13, "{i}: {p}");
        // the parameters are x and y everywhere
        let q = fit.surface.point(x * 0.7, 11.3);
        assert!((q.x - x * 0.7).abs() < 1e-13 && (q.y - 11.3).abs() < 1e-13);
    }
    let bad = |samples: &[u16], f: HeightField| height_field(samples, &f).unwrap_err();
    assert!(matches!(bad(&samples[..11], field), ConstructError::Count { got: 11, needed: 12, .. }));
    assert!(matches!(bad(&samples[..4], field), ConstructError::TooFew { got: 1, .. }));
    assert!(matches!(bad(&samples, HeightField { width: 0, ..field }), ConstructError::TooFew { .. }));
    assert!(matches!(bad(&samples, HeightField { x: (1.0, 1.0), ..field }), ConstructError::Range { .. }));
    assert!(matches!(bad(&samples, HeightField { z: (f64::NAN, 1.0), ..field }), ConstructError::NotFinite { .. }));
}

/// Data from a bicubic spline space are reproduced; half of noise is removed.
#[test]
fn least_squares_reproduce_and_smooth() {
    let f = |u: f64, v: f64| DVec3::new(u, v, u * u * u - 2.0 * u * v * v + v);
    let g = grid(40, 30, f);
    // parameters are chord lengths, so the columns (straight in x, y) are not polynomials of them: close, not exact
    let fit = approximate(&g, (12, 10)).unwrap();
    assert_eq!(fit.surface.counts(), (12, 10));
    assert!(fit.error.most < 1e-3 && fit.error.rms < fit.error.most, "{:?}", fit.error);
    // more control points never fit worse, and as many as data fit exactly
    let finer = approximate(&g, (20, 16)).unwrap();
    assert!(finer.error.rms < 0.2 * fit.error.rms, "{:?} {:?}", finer.error, fit.error);
    let all = approximate(&g, (40, 30)).unwrap();
    // the normal equations square the condition of the fit: half of the digits are safe
    assert!(all.error.most < 1e-8, "{:?}", all.error);
    for (u, v, p) in [(0, 0, f(0.0, 0.0)), (11, 0, f(1.0, 0.0)), (0, 9, f(0.0, 1.0)), (11, 9, f(1.0, 1.0))] {
        assert_eq!(fit.surface.points()[v * 12 + u].truncate(), p);
    }
    // an even wave of the shortest length averages out
    let noisy = grid(41, 41, |u, v| DVec3::new(u, v, 0.0));
    let points = noisy.points().iter().enumerate();
    let points = points.map(|(i, p)| *p + DVec3::Z * if i % 2 == 0 { 1e-3 } else { -1e-3 }).collect();
    let smoothed = approximate(&PointGrid::new(41, points).unwrap(), (6, 6)).unwrap();
    let middle = smoothed.surface.point(0.5 * smoothed.parameters_u[40], 0.5 * smoothed.parameters_v[40]);
    assert!(middle.z.abs() < 2e-4, "{middle}");
    assert!(smoothed.error.rms > 8e-4 && smoothed.error.rms < 1.2e-3);
}

#[test]
fn what_is_wrong_has_a_place() {
    let plane = |u: f64, v: f64| DVec3::new(u, v, 0.0);
    let mut points = grid(4, 3, plane).points().to_vec();
    points[7].y = f64::NAN;
    assert_eq!(PointGrid::new(4, points.clone()), Err(ConstructError::PointNotFinite { row: 1, column: 3 }));
    assert!(matches!(PointGrid::new(5, points.clone()), Err(ConstructError::Count { got: 12, needed: 15, .. })));
    assert!(matches!(PointGrid::new(1, points.clone()), Err(ConstructError::TooFew { .. })));
    assert!(matches!(PointGrid::new(12, points), Err(ConstructError::TooFew { what: "rows of points", .. })));
    assert!(PointGrid::new(0, Vec::new()).is_err());
    let doubled = grid(5, 4, |u, v| DVec3::new(if u == 0.5 { 0.25 } else { u }, v, 0.0));
    assert_eq!(interpolate(&doubled), Err(ConstructError::CoincidentPoints { first: 1, second: 2 }));
    let line = grid(3, 3, |u, _| DVec3::X * u);
    assert_eq!(interpolate(&line), Err(ConstructError::ZeroLength { what: "every column of the grid" }));
    let g = grid(6, 5, plane);
    assert!(matches!(approximate(&g, (3, 5)), Err(ConstructError::TooFew { .. })));
    assert!(matches!(approximate(&g, (7, 5)), Err(ConstructError::TooMany { .. })));
    let e = interpolate_at(&g, vec![0.0, 1.0, 2.0, 2.0, 3.0, 4.0], vec![0.0, 1.0, 2.0, 3.0, 4.0]);
    assert_eq!(e, Err(ConstructError::Order { what: "parameters in u", index: 3 }));
    assert!(matches!(interpolate_at(&g, vec![0.0], vec![0.0]), Err(ConstructError::Count { .. })));
}

fn any_grid() -> impl Strategy<Value = PointGrid> {
    (2usize..9, 2usize..9).prop_flat_map(|(nu, nv)| {
        prop::collection::vec(prop::array::uniform3(-0.3f64..0.3), nu * nv).prop_map(move |offsets| {
            let points = offsets
                .iter()
                .enumerate()
                .map(|(i, o)| DVec3::new((i % nu) as f64, (i / nu) as f64, 0.0) + DVec3::from_array(*o));
            PointGrid::new(nu, points.collect()).unwrap()
        })
    })
}

proptest! {
    #[test]
    fn every_point_is_met(g in any_grid()) {
        let fit = interpolate(&g).unwrap();
        let (nu, nv) = g.counts();
        for j in 0..nv {
            for i in 0..nu {
                let p = fit.surface.point(fit.parameters_u[i], fit.parameters_v[j]);
                prop_assert!(p.distance(g.points()[j * nu + i]) < 1e-11);
            }
        }
        prop_assert!(fit.error.most < 1e-11);
        let corner = fit.surface.points()[0].truncate();
        prop_assert_eq!(corner, g.points()[0]);
    }

    /// The reported error of an approximation is that of evaluation at the parameters.
    #[test]
    fn errors_are_reported_truly(g in any_grid()) {
        let (nu, nv) = g.counts();
        prop_assume!(nu >= 4 && nv >= 4);
        let fit = approximate(&g, (4, 4)).unwrap();
        let (mut most, mut sum) = (0.0f64, 0.0);
        for j in 0..nv {
            for i in 0..nu {
                let d = fit.surface.point(fit.parameters_u[i], fit.parameters_v[j]).distance(g.points()[j * nu + i]);
                most = most.max(d);
                sum += d * d;
            }
        }
        prop_assert!((fit.error.most - most).abs() < 1e-12);
        prop_assert!((fit.error.rms - (sum / (nu * nv) as f64).sqrt()).abs() < 1e-12);
    }
}
