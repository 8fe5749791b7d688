//! Surfaces, patches and the grid of patches.

use crate::{control, gap, knots};
use glam::{DVec3, DVec4};
use proptest::prelude::*;
use selvedge_geometry::spline::{BSpline, Control, MAX_DEGREE, Patch, Surface};

fn surface(max: usize) -> impl Strategy<Value = Surface> {
    (1..=max, 1..=max).prop_flat_map(|(p, q)| (Just((p, q)), knots(p), knots(q))).prop_flat_map(|(degrees, ku, kv)| {
        let count = (ku.len() - degrees.0 - 1) * (kv.len() - degrees.1 - 1);
        prop::collection::vec(control(), count)
            .prop_map(move |points| Surface::new(degrees, ku.clone(), kv.clone(), points).expect("valid"))
    })
}

fn patch(max: usize) -> impl Strategy<Value = Patch> {
    (1..=max, 1..=max).prop_flat_map(|(degree_u, degree_v)| {
        prop::collection::vec(control(), (degree_u + 1) * (degree_v + 1)).prop_map(move |points| Patch {
            degree_u,
            degree_v,
            points,
        })
    })
}

/// The surface by de Boor's algorithm in `u`, then in `v`: no patch is made.
fn de_boor(s: &Surface, u: f64, v: f64) -> DVec4 {
    let (nu, nv) = s.counts();
    let (ku, kv) = s.knots();
    let row = |j: usize| BSpline::new(s.degrees().0, ku.to_vec(), s.points()[j * nu..(j + 1) * nu].to_vec()).unwrap();
    let column = (0..nv).map(|j| row(j).homogeneous(u)).collect();
    BSpline::new(s.degrees().1, kv.to_vec(), column).unwrap().homogeneous(v)
}

/// Eighth of the unit sphere as one rational biquadratic patch; its top edge is the pole.
fn octant() -> Patch {
    let h = std::f64::consts::FRAC_1_SQRT_2;
    let profile = [(1.0, 0.0, 1.0), (1.0, 1.0, h), (0.0, 1.0, 1.0)];
    let ring = [(1.0, 0.0, 1.0), (1.0, 1.0, h), (0.0, 1.0, 1.0)];
    let net = profile.iter().flat_map(|&(r, z, wv)| {
        ring.iter().map(move |&(x, y, wu)| DVec4::from_point(DVec3::new(r * x, r * y, z), wu * wv))
    });
    Patch { degree_u: 2, degree_v: 2, points: net.collect() }
}

#[test]
fn a_sphere_octant_is_exact() {
    let octant = octant();
    for i in 0..=20 {
        for j in 0..=20 {
            let (u, v) = (f64::from(i) / 20.0, f64::from(j) / 20.0);
            let jet = octant.jet(u, v);
            assert!((jet.point.length() - 1.0).abs() <= 2e-15, "({u}, {v})");
            assert!(
                jet.point.dot(jet.du).abs() < 1e-14 && jet.point.dot(jet.dv).abs() < 1e-14,
                "tangent at ({u}, {v})"
            );
        }
    }
    assert_eq!(octant.jet(0.3, 1.0).du, DVec3::ZERO); // the pole
    let (lo, hi) = octant.bounds();
    assert_eq!((lo, hi), (DVec3::ZERO, DVec3::ONE));
    assert!(!octant.is_polynomial());
}

/// A bilinear surface of 4 by 3 unit patches over `[0, 8] x [-3, 3]`.
fn plate() -> Surface {
    let ku = vec![0.0, 0.0, 2.0, 4.0, 6.0, 8.0, 8.0];
    let kv = vec![-3.0, -3.0, -1.0, 1.0, 3.0, 3.0];
    let net = (0..4).flat_map(|j| (0..5).map(move |i| DVec4::new(f64::from(i), f64::from(j), f64::from(i * j), 1.0)));
    Surface::new((1, 1), ku, kv, net.collect()).unwrap()
}

#[test]
fn locate_finds_every_patch_and_clamps() {
    let grid = plate().patches();
    assert_eq!((grid.count_u, grid.count_v), (4, 3));
    for j in 0..3 {
        for i in 0..4 {
            let (u, v) = (2.0 * f64::from(i), 2.0 * f64::from(j) - 3.0);
            for (du, dv) in [(0.0, 0.0), (0.5, 1.0), (1.5, 0.25), (1.75, 1.75)] {
                let (p, s, t) = grid.locate(u + du, v + dv);
                assert_eq!(((p.u.0, p.v.0), (s, t)), ((u, v), (du / 2.0, dv / 2.0)));
            }
        }
    }
    for (u, v, first, local) in [
        (-1.0, -9.0, (0.0, -3.0), (0.0, 0.0)),
        (8.0, 3.0, (6.0, 1.0), (1.0, 1.0)),
        (9.0, 4.0, (6.0, 1.0), (1.0, 1.0)),
        (-1.0, 9.0, (0.0, 1.0), (0.0, 1.0)),
    ] {
        let (p, s, t) = grid.locate(u, v);
        assert_eq!(((p.u.0, p.v.0), (s, t)), (first, local), "({u}, {v})");
    }
}

#[test]
fn derivatives_are_those_of_the_surfaces_own_parameters() {
    let jet = plate().jet(3.0, 0.0); // x = u / 2, y = (v + 3) / 2, z = x y
    assert_eq!(jet.point, DVec3::new(1.5, 1.5, 2.25));
    assert_eq!((jet.du, jet.dv), (DVec3::new(0.5, 0.0, 0.75), DVec3::new(0.0, 0.5, 0.75)));
}

#[test]
fn a_patch_of_the_largest_degree() {
    // z = x^15 + y^15: the 15th power has one Bernstein coefficient that is not zero, the last
    let n = MAX_DEGREE;
    let last = |i: usize| f64::from(u8::from(i == n));
    let share = |i: usize| i as f64 / n as f64;
    let net = (0..=n).flat_map(|j| (0..=n).map(move |i| DVec4::new(share(i), share(j), last(i) + last(j), 1.0)));
    let patch = Patch { degree_u: n, degree_v: n, points: net.collect() };
    for (u, v) in [(0.0, 0.0), (0.25, 0.75), (0.9, 0.3), (1.0, 1.0)] {
        let (u, v): (f64, f64) = (u, v);
        let jet = patch.jet(u, v);
        let power = |x: f64| x.powi(n as i32);
        assert!((jet.point - DVec3::new(u, v, power(u) + power(v))).abs().max_element() < 1e-14, "({u}, {v})");
        assert!((jet.du - DVec3::new(1.0, 0.0, 15.0 * u.powi(14))).abs().max_element() < 1e-12, "({u}, {v})");
        assert!((jet.dv - DVec3::new(0.0, 1.0, 15.0 * v.powi(14))).abs().max_element() < 1e-12, "({u}, {v})");
    }
    let clamped = |n: usize| [[0.0].repeat(n + 1), [1.0].repeat(n + 1)].concat();
    let surface = Surface::new((n, n), clamped(n), clamped(n), patch.points.clone()).unwrap();
    assert_eq!(surface.patches().patches[0].patch, patch);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn patches_are_the_surface(s in surface(5), x in prop::collection::vec((0f64..=1.0, 0f64..=1.0), 8)) {
        let grid = s.patches();
        let ((u0, u1), (v0, v1)) = s.domain();
        for (x, y) in x {
            let (u, v) = (u0 + (u1 - u0) * x, v0 + (v1 - v0) * y);
            let (p, a, b) = grid.locate(u, v);
            prop_assert!(p.u.0 <= u && u <= p.u.1 && p.v.0 <= v && v <= p.v.1);
            // spans of 0.05 beside spans of 1 amplify rounding, twice
            prop_assert!(gap(p.patch.homogeneous(a, b), de_boor(&s, u, v)) < 1e-8);
            prop_assert!((grid.point(u, v) - grid.jet(u, v).point).length() < 1e-12); // weights up to 10
        }
    }

    #[test]
    fn neighbouring_patches_share_their_border_bit_for_bit(s in surface(4), x in 0f64..=1.0) {
        let grid = s.patches();
        for j in 0..grid.count_v {
            for i in 0..grid.count_u {
                let here = &grid.patches[j * grid.count_u + i];
                if i + 1 < grid.count_u {
                    let right = &grid.patches[j * grid.count_u + i + 1];
                    prop_assert_eq!(here.u.1, right.u.0);
                    prop_assert_eq!(here.patch.homogeneous(1.0, x), right.patch.homogeneous(0.0, x));
                }
                if j + 1 < grid.count_v {
                    let above = &grid.patches[(j + 1) * grid.count_u + i];
                    prop_assert_eq!(here.v.1, above.v.0);
                    prop_assert_eq!(here.patch.row(here.patch.degree_v), above.patch.row(0));
                    prop_assert_eq!(here.patch.homogeneous(x, 1.0), above.patch.homogeneous(x, 0.0));
                }
            }
        }
    }

    #[test]
    fn halves_and_rectangles(p in patch(6), a in (0f64..0.9, 0f64..0.9), len in 0.05f64..1.0, x in 0f64..=1.0, y in 0f64..=1.0) {
        let (left, right) = p.split_u(a.0);
        prop_assert!(gap(left.homogeneous(x, y), p.homogeneous(a.0 * x, y)) < 1e-13);
        prop_assert!(gap(right.homogeneous(x, y), p.homogeneous(a.0 + (1.0 - a.0) * x, y)) < 1e-13);
        prop_assert_eq!(left.homogeneous(1.0, y), right.homogeneous(0.0, y));
        let (low, high) = p.split_v(a.1);
        prop_assert!(gap(low.homogeneous(x, y), p.homogeneous(x, a.1 * y)) < 1e-13);
        prop_assert!(gap(high.homogeneous(x, y), p.homogeneous(x, a.1 + (1.0 - a.1) * y)) < 1e-13);
        let end = |a: f64| (a + len).min(1.0);
        let part = p.rectangle((a.0, end(a.0)), (a.1, end(a.1)));
        let at = |a: f64, x: f64| a + (end(a) - a) * x;
        prop_assert!(gap(part.homogeneous(x, y), p.homogeneous(at(a.0, x), at(a.1, y))) < 1e-12);
        prop_assert_eq!(p.rectangle((0.0, 1.0), (0.0, 1.0)), p);
    }

    #[test]
    fn transposition(p in patch(7), x in 0f64..=1.0, y in 0f64..=1.0) {
        let t = p.transposed();
        prop_assert!(gap(t.homogeneous(y, x), p.homogeneous(x, y)) < 1e-13);
        prop_assert_eq!(t.transposed(), p);
    }

    #[test]
    fn derivatives_are_central_differences(p in patch(5), u in 0.01f64..0.99, v in 0.01f64..0.99) {
        let h = 1e-5;
        let (value, du, dv) = p.homogeneous_jet(u, v);
        let central = |a: DVec4, b: DVec4| (a - b) * (0.5 / h);
        prop_assert!(gap(value, p.homogeneous(u, v)) < 1e-13);
        // h² p''' / 6 with |p'''| <= 5·4·3 · 8 · 10, and the rounding of values of 10 over h
        prop_assert!(gap(du, central(p.homogeneous(u + h, v), p.homogeneous(u - h, v))) < 1e-7);
        prop_assert!(gap(dv, central(p.homogeneous(u, v + h), p.homogeneous(u, v - h))) < 1e-7);
        // the quotient rule, against the points themselves: weights from 0.1 to 10 steepen them
        let jet = p.jet(u, v);
        let slope = (p.point(u + h, v) - p.point(u - h, v)) * (0.5 / h);
        prop_assert!((jet.du - slope).length() <= 1e-4 * (1.0 + jet.du.length()), "{} {}", jet.du, slope);
        prop_assert_eq!(jet.point, value.point());
    }

    #[test]
    fn bounds_hold_the_surface(s in surface(4), x in 0f64..=1.0, y in 0f64..=1.0) {
        let ((u0, u1), (v0, v1)) = s.domain();
        let p = s.jet(u0 + (u1 - u0) * x, v0 + (v1 - v0) * y).point;
        let (lo, hi) = s.bounds();
        prop_assert!(p.cmpge(lo - 1e-9).all() && p.cmple(hi + 1e-9).all());
    }
}
