//! Loft, Coons and Gordon surfaces pass through their curves.

use crate::{EXACT, at, curve, fractions, line, points};
use glam::{DVec3, DVec4};
use proptest::prelude::*;
use selvedge_geometry::construct::{Boundary, ConstructError, Network, coons, gordon, loft};
use selvedge_geometry::spline::{BSpline, Control, Surface};

/// How far a loft is from a section of constant height, at the best `v` where its middle has that height.
fn off_section(s: &impl Fn(f64, f64) -> DVec3, section: &BSpline<DVec4>) -> f64 {
    const STEPS: u32 = 200;
    let height = |v: f64| s(0.5, v).z - at(section, 0.5).z;
    let off = |v: f64| fractions(20).map(|u| s(u, v).distance(at(section, u))).fold(0.0, f64::max);
    let cells = fractions(STEPS).zip(fractions(STEPS).skip(1)).filter(|(a, b)| height(*a) * height(*b) <= 0.0);
    let roots = cells.map(|(mut a, mut b)| {
        let rising = height(b) > height(a);
        for _ in 0..60 {
            let middle = 0.5 * (a + b);
            if (height(middle) < 0.0) == rising { a = middle } else { b = middle }
        }
        off(a)
    });
    roots.fold(off(0.0).min(off(1.0)), f64::min)
}

/// Sections stacked along z, so that `z` identifies the section.
fn stack(n: std::ops::Range<usize>) -> impl Strategy<Value = Vec<BSpline<DVec4>>> {
    let section = curve(4, 0.8..1.25);
    prop::collection::vec((section, 0.6..1.4f64), n).prop_map(|all| {
        let mut z = 0.0;
        all.into_iter()
            .map(|(c, step)| {
                z += step;
                let flat = c.points().iter().map(|p| DVec4::new(p.x, p.y, 2.0 * z * p.w, p.w));
                BSpline::new(c.degree(), c.knots().to_vec(), flat.collect()).unwrap()
            })
            .collect()
    })
}

proptest! {
    #![proptest_config(crate::cases(256))]

    #[test]
    fn a_loft_passes_through_its_sections(sections in stack(2..7)) {
        let built = loft(&sections, false);
        // a cubic through unequal weights may not stay positive
        let rational = sections.iter().any(|c| !c.is_polynomial());
        prop_assume!(!(rational && matches!(built, Err(ConstructError::Weights { .. }))));
        let surface = built.unwrap();
        let s = points(&surface);
        prop_assert_eq!(surface.degrees().1, 3.min(sections.len() - 1));
        for c in &sections {
            let off = off_section(&s, c);
            prop_assert!(off <= 20.0 * EXACT, "{off:e}"); // of sections stacked 17 high
        }
    }

    #[test]
    fn coons_has_the_four_curves_as_sides(mut all in prop::array::uniform4(curve(4, 0.6..1.7))) {
        // corners where the first two curves have them
        let ends = [at(&all[0], 0.0), at(&all[0], 1.0), at(&all[1], 0.0), at(&all[1], 1.0)];
        all[2] = pinned(&all[2], ends[0], ends[2]);
        all[3] = pinned(&all[3], ends[1], ends[3]);
        let [bottom, top, left, right] = &all;
        let built = coons(Boundary { bottom, top, left, right }, 1e-9);
        let Ok(surface) = built else {
            // end weights are up to 1.7 / 0.6 of those inside: the sum may have weights that are not positive
            prop_assert!(all.iter().any(|c| !c.is_polynomial()));
            return Ok(());
        };
        let s = surface.patches();
        // the change of parameter moves points along the sides: every point of a side is on its curve, and its
        // parameter is that of equal end weights
        for f in fractions(16) {
            let sides = [(s.point(f, 0.0), bottom), (s.point(f, 1.0), top), (s.point(0.0, f), left), (s.point(1.0, f), right)];
            for (p, c) in sides {
                prop_assert!(p.distance(at(c, moebius(c, f))) <= 4.0 * EXACT, "{:e}", p.distance(at(c, moebius(c, f))));
            }
        }
    }

    /// Curves of a random tensor-product surface: the network is consistent by construction.
    #[test]
    fn gordon_passes_through_every_curve(
        heights in prop::collection::vec(-1.0..1.0f64, 25), u1 in 0.2..0.45f64, u2 in 0.55..0.8f64, v1 in 0.3..0.7f64,
    ) {
        let net = heights.iter().enumerate().map(|(i, h)| DVec4::new((i % 5) as f64, (i / 5) as f64, *h, 1.0));
        let knots = vec![0.0, 0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 1.0];
        let source = Surface::new((3, 3), knots.clone(), knots, net.collect()).unwrap();
        let (u, v) = ([0.0, u1, u2, 1.0], [0.0, v1, 1.0]);
        let c: Vec<_> = v.iter().map(|v| isocurve(&source.transposed(), *v)).collect();
        let d: Vec<_> = u.iter().map(|u| isocurve(&source, *u)).collect();
        let g = gordon(Network { u_curves: &c, v_curves: &d, u: &u, v: &v }, 1e-9).unwrap().patches();
        for f in fractions(30) {
            for (v, c) in v.iter().zip(&c) {
                prop_assert!(g.point(f, *v).distance(at(c, f)) <= 10.0 * EXACT);
            }
            for (u, d) in u.iter().zip(&d) {
                prop_assert!(g.point(*u, f).distance(at(d, f)) <= 10.0 * EXACT);
            }
        }
    }
}

/// The curve along `v` at `u`.
fn isocurve(s: &Surface, u: f64) -> BSpline<DVec4> {
    BSpline::new(s.degrees().1, s.knots().1.to_vec(), s.rows().iter().map(|r| r.homogeneous(u)).collect()).unwrap()
}

/// The curve with other end points.
fn pinned(c: &BSpline<DVec4>, start: DVec3, end: DVec3) -> BSpline<DVec4> {
    let mut points = c.points().to_vec();
    let last = points.len() - 1;
    points[0] = DVec4::from_point(start, points[0].w);
    points[last] = DVec4::from_point(end, points[last].w);
    BSpline::new(c.degree(), c.knots().to_vec(), points).unwrap()
}

/// The fraction of the curve's domain that its form with end weights 1 reaches at `s`.
fn moebius(c: &BSpline<DVec4>, s: f64) -> f64 {
    let (first, last) = (c.points()[0].w, c.points()[c.points().len() - 1].w);
    let a = (first / last).powf(1.0 / c.degree() as f64);
    a * s / (1.0 + (a - 1.0) * s)
}

#[test]
fn a_closed_loft_is_smooth_where_it_began() {
    let section = |i: u32| {
        let (s, c) = (f64::from(i) * std::f64::consts::TAU / 7.0).sin_cos();
        let out = DVec3::new(c, s, 0.0);
        line(&[out * 3.0, out * (3.5 + 0.2 * f64::from(i % 3)) + DVec3::Z, out * 5.0])
    };
    let sections: Vec<_> = (0..7).map(section).collect();
    let surface = loft(&sections, true).unwrap();
    let grid = surface.patches();
    for u in fractions(10) {
        let (a, b) = (grid.jet(u, 0.0), grid.jet(u, 1.0));
        assert!(a.point.distance(b.point) <= EXACT && a.dv.distance(b.dv) <= 1e-9 * a.dv.length());
        assert!(a.point.distance(at(&sections[0], u)) <= EXACT);
        // second derivatives by differences of exact first ones: h times the third, and 1e-16 / h
        let bend = |v: f64, h: f64| (grid.jet(u, v + h).dv - grid.jet(u, v).dv) / h;
        let (start, end) = (bend(0.0, 1e-6), bend(1.0, -1e-6));
        assert!(start.distance(end) <= 1e-3 * start.length().max(1.0), "{start} {end}");
    }
}

#[test]
fn a_loft_through_circles_of_a_cone_is_round() {
    use selvedge_geometry::construct::lathe;
    let circle = |r: f64, z: f64| {
        let s = lathe(&crate::planar(&[(r, z), (r, z + 1.0)]), std::f64::consts::TAU).unwrap();
        s.rows()[0].clone()
    };
    // written with other weights, the same circle
    let scaled = |c: BSpline<DVec4>, by: f64| {
        BSpline::new(2, c.knots().to_vec(), c.points().iter().map(|p| *p * by).collect()).unwrap()
    };
    let sections = [circle(1.0, 0.0), scaled(circle(2.0, 1.0), 7.0), circle(3.0, 2.0), scaled(circle(4.0, 3.0), 0.1)];
    let s = points(&loft(&sections, false).unwrap());
    for u in fractions(30) {
        for v in fractions(10) {
            let p = s(u, v);
            assert!((p.truncate().length() - 1.0 - p.z).abs() <= 10.0 * EXACT, "{p}");
        }
    }
}

#[test]
fn coons_of_straight_sides_is_bilinear_and_of_a_point_a_triangle() {
    let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 1.0)];
    let (bottom, top, left, right) = (line(&[a, b]), line(&[c, d]), line(&[a, c]), line(&[b, d]));
    let s = points(&coons(Boundary { bottom: &bottom, top: &top, left: &left, right: &right }, 0.0).unwrap());
    for u in fractions(5) {
        for v in fractions(5) {
            assert!(s(u, v).distance(DVec3::new(u, v, u * v)) <= EXACT);
        }
    }
    let (point, right) = (line(&[c, c]), line(&[b, c]));
    let s = points(&coons(Boundary { bottom: &bottom, top: &point, left: &left, right: &right }, 0.0).unwrap());
    assert!(s(0.3, 1.0).distance(c) <= EXACT && s(0.5, 0.0).distance(b * 0.5) <= EXACT);
}
