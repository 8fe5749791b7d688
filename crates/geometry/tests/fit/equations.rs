//! Fitted equations: the bound holds between all samples, sides meet bit for bit, errors name bad surfaces.

use glam::DVec3;
use proptest::prelude::*;
use selvedge_geometry::construct::ConstructError;
use selvedge_geometry::construct::fit::{Fit, FitOptions, Side, fit};
use std::f64::consts::{PI, TAU};

/// Largest distance at `n²` even points shifted off every symmetry and off the fit's own points.
fn worst(fit: &Fit, f: &dyn Fn(f64, f64) -> DVec3, n: usize) -> f64 {
    let ((u0, u1), (v0, v1)) = fit.surface.domain();
    let at = |(a, b): (f64, f64), i: usize| a + (b - a) * ((i as f64 + 0.382) / n as f64);
    let each = |j: usize| (0..n).map(move |i| (i, j));
    (0..n)
        .flat_map(each)
        .map(|(i, j)| (at((u0, u1), i), at((v0, v1), j)))
        .map(|(u, v)| fit.surface.point(u, v).distance(f(u, v)))
        .fold(0.0, f64::max)
}

fn sphere(u: f64, v: f64) -> DVec3 {
    DVec3::new(u.cos() * v.cos(), u.sin() * v.cos(), v.sin())
}

#[test]
fn sphere_has_a_seam_and_two_poles() {
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let fit = fit(sphere, (0.0, TAU), (-0.5 * PI, 0.5 * PI), &FitOptions::new(tolerance)).unwrap();
        let met = worst(&fit, &sphere, 301);
        assert!(met <= fit.bound && fit.bound <= tolerance, "{met:e} {:e} {tolerance:e}", fit.bound);
        // a useful bound, too: at most an order of magnitude above the truth
        assert!(fit.bound <= 12.0 * met + 1e-12, "{met:e} {:e}", fit.bound);
        assert_eq!((fit.sides.u, fit.sides.v), (Side::Periodic, Side::Open));
        assert!(fit.sides.poles[0].is_none() && fit.sides.poles[1].is_none());
        let (nu, nv) = fit.surface.counts();
        let net = fit.surface.points();
        for row in net.chunks(nu) {
            assert_eq!(row[0], row[nu - 1]);
        }
        for (row, z) in [(0, -1.0), (nv - 1, 1.0)] {
            let row = &net[row * nu..][..nu];
            assert!(row.iter().all(|p| *p == row[0]) && (row[0].truncate() - DVec3::Z * z).length() < 1e-15);
        }
        // C1 across the seam
        let (a, b) = (fit.surface.jet2(0.0, 0.4), fit.surface.jet2(TAU, 0.4));
        assert!(a.du.distance(b.du) < 1e-12 && a.duu.distance(b.duu) < 1e-9);
    }
}

#[test]
fn torus_closes_both_ways() {
    let torus = |u: f64, v: f64| {
        let r = 3.0 + v.cos();
        DVec3::new(r * u.cos(), r * u.sin(), v.sin())
    };
    let fit = fit(torus, (0.0, TAU), (0.0, TAU), &FitOptions::new(1e-5)).unwrap();
    assert_eq!((fit.sides.u, fit.sides.v), (Side::Periodic, Side::Periodic));
    let (nu, nv) = fit.surface.counts();
    assert_eq!(fit.surface.points()[..nu], fit.surface.points()[(nv - 1) * nu..]);
    assert!(worst(&fit, &torus, 211) <= fit.bound && fit.bound <= 1e-5);
}

/// A cone's seam is smooth, a drop's profile creases at its seam, a Moebius strip's sides do not meet point by point.
#[test]
fn sides_are_distinguished() {
    let options = FitOptions::new(1e-5);
    let cone = fit(|u, v| DVec3::new(v * u.cos(), v * u.sin(), v), (0.0, TAU), (0.0, 2.0), &options).unwrap();
    assert_eq!((cone.sides.u, cone.sides.poles[2]), (Side::Periodic, Some(DVec3::ZERO)));
    let drop = fit(|u, v| DVec3::new(u * (1.0 - u), u * u - u.powi(3), v), (0.0, 1.0), (0.0, 1.0), &options).unwrap();
    assert_eq!((drop.sides.u, drop.sides.v), (Side::Closed, Side::Open));
    let strip = |u: f64, v: f64| {
        let r = 2.0 + v * (0.5 * u).cos();
        DVec3::new(r * u.cos(), r * u.sin(), v * (0.5 * u).sin())
    };
    let moebius = fit(strip, (0.0, TAU), (-0.5, 0.5), &options).unwrap();
    assert_eq!(moebius.sides.u, Side::Open);
    // a turned square root has a pole with an endless slope
    let bulb = |u: f64, v: f64| {
        DVec3::new((1.0 - v * v).max(0.0).sqrt() * u.cos(), (1.0 - v * v).max(0.0).sqrt() * u.sin(), v)
    };
    let bulb_fit = fit(bulb, (0.0, TAU), (-1.0, 1.0), &FitOptions::new(1e-3)).unwrap();
    assert!(bulb_fit.sides.poles[2].is_some() && bulb_fit.sides.poles[3].is_some());
    assert!(worst(&bulb_fit, &bulb, 401) <= bulb_fit.bound);
}

/// Cubics in both parameters are in the space: one round, rounding only.
#[test]
fn bicubic_polynomials_are_exact() {
    let f = |u: f64, v: f64| DVec3::new(u * u * u - v, u * v * v * v, 1.0 + u * u * v);
    let fit = fit(f, (-1.0, 2.0), (0.0, 1.0), &FitOptions::new(1e-9)).unwrap();
    assert!(worst(&fit, &f, 97) < 1e-13);
    assert!(fit.bound < 3e-12, "{:e}", fit.bound);
}

#[test]
fn creases_along_a_parameter_are_found() {
    let f = |u: f64, v: f64| DVec3::new(u, v, (u - 0.371).abs());
    let fit = fit(f, (0.0, 1.0), (0.0, 1.0), &FitOptions::new(1e-6)).unwrap();
    assert!(worst(&fit, &f, 1009) <= fit.bound && fit.bound <= 1e-6);
    // in v nothing had to be split
    assert!(fit.surface.counts().1 <= 12, "{:?}", fit.surface.counts());
}

#[test]
fn bad_surfaces_are_named() {
    let square = ((0.0, 1.0), (0.0, 1.0));
    let run = |f: &(dyn Fn(f64, f64) -> DVec3 + Sync), tolerance: f64| {
        fit(f, square.0, square.1, &FitOptions { tolerance, most_points: 20_000 }).unwrap_err()
    };
    let plane = |u: f64, v: f64| DVec3::new(u, v, 0.0);
    assert_eq!(run(&|u, v| DVec3::new(u, 1.0 / v, 0.0), 1e-3), ConstructError::NotFiniteAt { u: 0.0, v: 0.0 });
    assert!(
        matches!(run(&|u, v| DVec3::new(u, v, (u - 0.5).ln()), 1e-3), ConstructError::NotFiniteAt { u, .. } if u < 0.5)
    );
    // a singularity between all samples: refined until it is met or the points run out
    let hidden = run(&|u, v| DVec3::new(u, v, 1.0 / (u - 0.371_234_567)), 1e-3);
    assert!(matches!(hidden, ConstructError::Bound { .. } | ConstructError::NotFiniteAt { .. }), "{hidden}");
    // a jump, and a crease across the grid
    assert!(matches!(run(&|u, v| DVec3::new(u, v, (u - 0.3).signum()), 1e-3), ConstructError::Bound { .. }));
    let diagonal = run(&|u, v| DVec3::new(u, v, (u - v).abs()), 1e-7);
    assert!(matches!(diagonal, ConstructError::Bound { asked: 1e-7, reached, .. } if reached > 1e-7));
    assert!(matches!(run(&|_, _| DVec3::ONE, 1e-3), ConstructError::ZeroLength { .. }));
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-15] {
        assert!(matches!(run(&plane, tolerance), ConstructError::Range { what: "the tolerance", .. }), "{tolerance}");
    }
    for domain in [(0.0, 0.0), (1.0, 0.0), (0.0, f64::NAN), (0.0, f64::INFINITY), (1.0, 1.0 + 1e-14)] {
        let e = fit(plane, domain, (0.0, 1.0), &FitOptions::new(0.1)).unwrap_err();
        assert!(matches!(e, ConstructError::Range { what: "the domain in u", .. }), "{domain:?}: {e}");
    }
}

/// Waves, bumps and rational terms with random amplitudes.
fn random_surface() -> impl Strategy<Value = [f64; 10]> {
    prop::array::uniform10(-1.0f64..1.0)
}

fn wavy(c: [f64; 10]) -> impl Fn(f64, f64) -> DVec3 + Sync {
    move |u, v| {
        let bump = c[0] / (1.2 + c[1] + (3.0 * (u - c[2])).powi(2) + (3.0 * (v - c[3])).powi(2));
        let wave = c[4] * (6.0 * c[5] * u + 4.0 * c[6] * v + c[9]).sin();
        DVec3::new(u + c[7] * (v * v - u), v + c[8] * u * v, bump + wave)
    }
}

fn case(c: [f64; 10], exponent: f64) {
    let f = wavy(c);
    let tolerance = 10f64.powf(exponent);
    let fit = fit(&f, (-1.0, 1.0), (-1.0, 1.0), &FitOptions::new(tolerance)).unwrap();
    let met = worst(&fit, &f, 61);
    assert!(met <= fit.bound && fit.bound <= tolerance, "{c:?}: {met:e} {:e} {tolerance:e}", fit.bound);
}

/// As many as the variable `PROPTEST_CASES` says (`tools/random_cases`), or `few`.
fn cases(few: u32) -> ProptestConfig {
    let cases = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(few);
    ProptestConfig { cases, max_global_rejects: 100 * cases, ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(cases(24))]
    #[test]
    fn the_bound_holds(c in random_surface(), exponent in -4.5f64..-1.5) {
        case(c, exponent);
    }
}

#[cfg(feature = "equations")]
#[test]
fn expressions_fit_like_closures() {
    use selvedge_geometry::construct::fit::Equation;
    let texts = ["r*cos(u)*cos(v)", "r*sin(u)*cos(v)", "r*sin(v)"];
    let equation = Equation::parse(texts, &[("r", 2.0)]).unwrap();
    let fit = fit(|u, v| equation.at(u, v), (0.0, TAU), (-0.5 * PI, 0.5 * PI), &FitOptions::new(1e-6)).unwrap();
    let met = worst(&fit, &|u, v| sphere(u, v) * 2.0, 101);
    assert!(met <= fit.bound && fit.bound <= 1e-6);
    assert_eq!(fit.sides.u, Side::Periodic);
}
