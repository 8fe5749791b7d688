//! Derivatives against difference quotients, curvature against closed forms, normals where derivatives vanish.

use glam::{DVec3, DVec4};
use proptest::prelude::*;
use selvedge_geometry::spline::{Control, Patch, Surface, arc};
use std::f64::consts::{FRAC_PI_2, TAU};

/// A sphere of radius `r` as a half circle turned about z.
fn sphere(r: f64) -> Surface {
    let half = [-FRAC_PI_2, 0.0, FRAC_PI_2];
    let spans: Vec<_> = half
        .windows(2)
        .map(|k| selvedge_geometry::spline::Span {
            start: k[0],
            end: k[1],
            piece: arc::arc(DVec3::ZERO, DVec3::X * r, DVec3::Z * r, k[0], k[1]),
        })
        .collect();
    let (degree, knots, points) = arc::assemble(&spans);
    arc::revolve((degree, knots, &points), (DVec3::ZERO, DVec3::Z), &arc::pieces(0.0, TAU, FRAC_PI_2)).unwrap()
}

#[test]
fn a_sphere_has_its_normal_and_curvature_everywhere() {
    let s = sphere(2.5);
    let grid = s.patches();
    for i in 0..=24 {
        let u = TAU * f64::from(i) / 24.0;
        for v in [-FRAC_PI_2, -FRAC_PI_2 + 1e-9, -1.5, -0.7, 0.0, 0.3, 1.57, FRAC_PI_2 - 1e-6, FRAC_PI_2] {
            let n = grid.normal(u, v).unwrap();
            let p = s.point(u, v);
            // u runs east, v north: outwards
            // at a pole and away from it to rounding; very near, where S_u is mostly rounding, to its square root
            let near = p.truncate().length() < 1e-5 && p.truncate().length() > 1e-15;
            assert!(n.distance(p / 2.5) < if near { 1e-7 } else { 1e-9 }, "({u}, {v}): {n} at {p}");
            assert!((n.length() - 1.0).abs() < 1e-14);
        }
        for v in [-1.4, -0.7, 0.2, 1.3] {
            let c = s.curvature(u, v).unwrap();
            assert!((c.most + 0.4).abs() < 1e-10 && (c.least + 0.4).abs() < 1e-10, "{c:?}");
            assert!((c.gaussian() - 0.16).abs() < 1e-10 && (c.mean() + 0.4).abs() < 1e-10);
        }
    }
    assert!(s.curvature(0.3, FRAC_PI_2).is_none() && s.curvature(0.3, -FRAC_PI_2).is_none());
}

/// A cone's tip has a limit on every generator, and it is the generator's own normal.
#[test]
fn a_cones_tip_has_the_generators_normal() {
    let line = [DVec4::new(0.0, 0.0, 1.0, 1.0), DVec4::new(1.0, 0.0, 0.0, 1.0)];
    let angles = arc::pieces(0.0, TAU, FRAC_PI_2);
    let s = arc::revolve((1, vec![0.0, 0.0, 1.0, 1.0], &line), (DVec3::ZERO, DVec3::Z), &angles).unwrap();
    let grid = s.patches();
    for i in 0..=20 {
        let u = TAU * f64::from(i) / 20.0;
        let (tip, below) = (grid.normal(u, 0.0).unwrap(), grid.normal(u, 0.5).unwrap());
        assert!(tip.distance(below) < 1e-9, "{tip} {below}");
        let c = s.jet2(u, 0.5).curvature().unwrap();
        // down the generator straight; across it 1 / (distance to the axis along the normal)
        assert!(c.most.abs().min(c.least.abs()) < 1e-10);
        assert!((c.most.abs().max(c.least.abs()) - std::f64::consts::FRAC_1_SQRT_2 / 0.5).abs() < 1e-9, "{c:?}");
    }
}

/// A torus: curvature `cos v / (R + r cos v)` around, `1 / r` across.
#[test]
fn a_torus_bends_as_it_should() {
    let (major, minor) = (3.0, 1.0);
    let ring = arc::pieces(0.0, TAU, FRAC_PI_2);
    let spans: Vec<_> = ring
        .windows(2)
        .map(|k| selvedge_geometry::spline::Span {
            start: k[0],
            end: k[1],
            piece: arc::arc(DVec3::X * major, DVec3::X * minor, DVec3::Z * minor, k[0], k[1]),
        })
        .collect();
    let (degree, knots, points) = arc::assemble(&spans);
    let s = arc::revolve((degree, knots, &points), (DVec3::ZERO, DVec3::Z), &ring).unwrap();
    for i in 0..40 {
        let (u, v) = (0.157 * f64::from(i), 0.151 * f64::from(i));
        let p = s.point(u, v);
        let cos = (p.truncate().length() - major) / minor;
        let expected = [-1.0 / minor, -cos / (major + minor * cos)];
        let c = s.jet2(u, v).curvature().unwrap();
        assert!((c.least - expected[0].min(expected[1])).abs() < 1e-9);
        assert!((c.most - expected[0].max(expected[1])).abs() < 1e-9);
    }
}

/// Sides collapsed twice over, parallel tangents at a corner, collapsed patches.
#[test]
fn degenerate_corners() {
    let polynomial = |n: usize, k: usize, points: &[[f64; 3]]| Patch {
        degree_u: n,
        degree_v: k,
        points: points.iter().map(|p| DVec3::from_array(*p).extend(1.0)).collect(),
    };
    // both tangents at the first corner run along x: the limit along the diagonal is still z
    let parallel = polynomial(
        2,
        2,
        &[
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [2.0, -1.0, 0.0],
            [1.0, 0.0, 0.0],
            [2.0, 0.5, 0.0],
            [3.0, 0.0, 0.0],
            [2.0, 1.0, 0.0],
            [3.0, 1.5, 0.0],
            [4.0, 2.0, 0.0],
        ],
    );
    assert!(parallel.normal(0.0, 0.0).unwrap().distance(DVec3::Z) < 1e-9);
    // the first two rows are one point: S_u, S_v and S_uv vanish on the side
    let twice = polynomial(1, 2, &[[0.0; 3], [0.0; 3], [0.0; 3], [0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    for u in [0.0, 0.3, 1.0] {
        let n = twice.normal(u, 0.0).unwrap();
        assert!(n.distance(-DVec3::Z) < 1e-9 || n.distance(DVec3::Z) < 1e-9, "{n}");
        assert!(n.distance(twice.normal(u, 0.7).unwrap()) < 1e-9);
    }
    // the last row is one point, seen from its end
    let fan = polynomial(
        2,
        1,
        &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.5], [2.0, 0.0, 0.0], [1.0, 2.0, 0.0], [1.0, 2.0, 0.0], [1.0, 2.0, 0.0]],
    );
    for u in [0.0, 0.25, 0.5, 0.9, 1.0] {
        let (limit, near) = (fan.normal(u, 1.0).unwrap(), fan.normal(u, 0.999).unwrap());
        assert!(limit.distance(near) < 1e-9, "{u}: {limit} {near}");
    }
    let point = polynomial(1, 1, &[[1.0; 3]; 4]);
    assert_eq!(point.normal(0.5, 0.5), None);
    let line = polynomial(1, 1, &[[0.0; 3], [1.0, 1.0, 0.0], [2.0, 2.0, 0.0], [3.0, 3.0, 0.0]]);
    assert_eq!(line.normal(0.2, 0.5), None);
}

fn any_surface() -> impl Strategy<Value = Surface> {
    (super::knots(3), super::knots(2)).prop_flat_map(|(ku, kv)| {
        let (nu, nv) = (ku.len() - 4, kv.len() - 3);
        let point = (prop::array::uniform3(-1.0f64..1.0), 0.4f64..2.5);
        prop::collection::vec(point, nu * nv).prop_map(move |points| {
            let points = points.into_iter().map(|(p, w)| DVec4::from_point(DVec3::from_array(p), w)).collect();
            Surface::new((3, 2), ku.clone(), kv.clone(), points).unwrap()
        })
    })
}

proptest! {
    /// First derivatives against the Bézier patches, second ones against differences of first ones.
    #[test]
    fn second_derivatives_are_differences_of_first(s in any_surface(), a in 0.0f64..1.0, b in 0.0f64..1.0) {
        let ((u0, u1), (v0, v1)) = s.domain();
        let (u, v) = (u0 + (u1 - u0) * a, v0 + (v1 - v0) * b);
        let grid = s.patches();
        let (patch, x, y) = grid.locate(u, v);
        let h = 1e-6;
        // inside one patch, away from its border
        prop_assume!(x > 0.01 && x < 0.99 && y > 0.01 && y < 0.99);
        prop_assume!(patch.u.1 - patch.u.0 > 0.04 && patch.v.1 - patch.v.0 > 0.04);
        let (jet, first) = (s.jet2(u, v), grid.jet(u, v));
        let scale = 1.0 + jet.duu.length() + jet.dvv.length() + jet.duv.length();
        prop_assert!(jet.point.distance(first.point) < 1e-12);
        prop_assert!(jet.du.distance(first.du) < 1e-10 * scale && jet.dv.distance(first.dv) < 1e-10 * scale);
        let (e, w) = (grid.jet(u + h, v), grid.jet(u - h, v));
        let (n, o) = (grid.jet(u, v + h), grid.jet(u, v - h));
        // rounding over h, and h² times a fourth derivative
        prop_assert!(jet.duu.distance((e.du - w.du) / (2.0 * h)) < 1e-5 * scale);
        prop_assert!(jet.duv.distance((e.dv - w.dv) / (2.0 * h)) < 1e-5 * scale);
        prop_assert!(jet.duv.distance((n.du - o.du) / (2.0 * h)) < 1e-5 * scale);
        prop_assert!(jet.dvv.distance((n.dv - o.dv) / (2.0 * h)) < 1e-5 * scale);
    }

    /// A side collapsed to a point: the normal is there, of unit length, and the limit from inside.
    #[test]
    fn collapsed_sides_have_normals(s in any_surface(), a in 0.01f64..0.99) {
        let grid = s.patches();
        let mut patch = grid.patches[0].patch.clone();
        let n = patch.degree_u + 1;
        let tip = DVec3::new(0.3, -0.2, 2.0);
        patch.points[..n].iter_mut().for_each(|p| *p = DVec4::from_point(tip, p.w));
        let Some(limit) = patch.normal(a, 0.0) else { return Err(TestCaseError::fail("no normal")) };
        prop_assert!((limit.length() - 1.0).abs() < 1e-12);
        let at = |v: f64| { let j = patch.jet(a, v); j.du.cross(j.dv).normalize() };
        // the difference to the limit falls with the distance
        let (near, nearer) = (limit.distance(at(1e-3)), limit.distance(at(1e-4)));
        prop_assume!(near < 0.3); // else a sharp turn close to the tip
        prop_assert!(nearer <= 0.2 * near + 1e-6, "{} {}", near, nearer);
    }
}
