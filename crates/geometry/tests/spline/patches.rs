//! Properties of every patch: bilinear, bicubic, any degree, polynomial and rational.

use glam::{DVec3, DVec4};
use proptest::prelude::*;
use selvedge_geometry::spline::{Bezier, Control, Patch};

fn vector() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-1.0f64..1.0).prop_map(DVec3::from_array)
}

fn polynomial(n: usize, k: usize, points: &[DVec3]) -> Patch {
    Patch { degree_u: n, degree_v: k, points: points.iter().map(|p| p.extend(1.0)).collect() }
}

fn any_patch() -> impl Strategy<Value = Patch> {
    (1usize..6, 1usize..6).prop_flat_map(|(n, k)| {
        prop::collection::vec((vector(), 0.3f64..3.0), (n + 1) * (k + 1)).prop_map(move |points| Patch {
            degree_u: n,
            degree_v: k,
            points: points.into_iter().map(|(p, w)| DVec4::from_point(p, w)).collect(),
        })
    })
}

/// de Casteljau's triangle, written anew.
fn casteljau<P: Control>(points: &[P], t: f64) -> P {
    let mut work = points.to_vec();
    while work.len() > 1 {
        work = work.windows(2).map(|w| w[0] * (1.0 - t) + w[1] * t).collect();
    }
    work[0]
}

fn row(p: &Patch, j: usize) -> Vec<DVec4> {
    p.points[j * (p.degree_u + 1)..][..p.degree_u + 1].to_vec()
}

fn column(p: &Patch, i: usize) -> Vec<DVec4> {
    (0..=p.degree_v).map(|j| p.points[j * (p.degree_u + 1) + i]).collect()
}

proptest! {
    /// `lerp(v, lerp(u, p0, p1), lerp(u, p2, p3))`, in either order.
    #[test]
    fn bilinear_is_lerp_in_either_order(p in prop::array::uniform4(vector()), u in 0.0f64..1.0, v in 0.0f64..1.0) {
        let patch = polynomial(1, 1, &p);
        let u_first = p[0].lerp(p[1], u).lerp(p[2].lerp(p[3], u), v);
        let v_first = p[0].lerp(p[2], v).lerp(p[1].lerp(p[3], v), u);
        prop_assert!(u_first.distance(v_first) < 1e-15 * 4.0);
        prop_assert!(patch.point(u, v).distance(u_first) < 1e-15 * 4.0);
    }

    /// Planar if and only if the four points are: all points lie in the plane of three exactly when the fourth does.
    #[test]
    fn bilinear_is_planar_iff_its_points_are(p in prop::array::uniform3(vector()), a in -1.0f64..1.0, b in -1.0f64..1.0, lift in 0.01f64..1.0) {
        let normal = (p[1] - p[0]).cross(p[2] - p[0]);
        prop_assume!(normal.length() > 0.05);
        let normal = normal.normalize();
        let flat = p[0] + (p[1] - p[0]) * a + (p[2] - p[0]) * b;
        let heights = |last: DVec3| -> f64 {
            let patch = polynomial(1, 1, &[p[0], p[1], p[2], last]);
            (0..=100).map(|i| patch.point(f64::from(i % 11) / 10.0, f64::from(i / 11) / 9.1)).map(|q| (q - p[0]).dot(normal).abs()).fold(0.0, f64::max)
        };
        prop_assert!(heights(flat) < 1e-14);
        prop_assert!(heights(flat + normal * lift) > 0.5 * lift);
    }

    /// A saddle that is not planar is ruled twice, and nowhere curved to one side: K = -M² / (EG - F²) < 0.
    #[test]
    fn bilinear_saddle_is_doubly_ruled(p in prop::array::uniform4(vector()), u in 0.0f64..1.0, v in 0.0f64..1.0) {
        let volume = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]);
        prop_assume!(volume.abs() > 0.02);
        let patch = polynomial(1, 1, &p);
        let straight = |a: DVec3, b: DVec3, c: DVec3| (b - a).cross(c - a).length();
        prop_assert!(straight(patch.point(0.0, v), patch.point(u, v), patch.point(1.0, v)) < 1e-14);
        prop_assert!(straight(patch.point(u, 0.0), patch.point(u, v), patch.point(u, 1.0)) < 1e-14);
        let knots = vec![0.0, 0.0, 1.0, 1.0];
        let s = selvedge_geometry::spline::Surface::new((1, 1), knots.clone(), knots, patch.points.clone()).unwrap();
        let jet = s.jet2(u, v);
        if let Some(c) = jet.curvature() {
            prop_assert!(c.gaussian() < 0.0, "{}", c.gaussian());
            // closed form: L = N = 0
            let n = jet.du.cross(jet.dv);
            let m = (p[0] - p[1] - p[2] + p[3]).dot(n.normalize());
            let expected = -m * m / n.length_squared();
            prop_assert!((c.gaussian() - expected).abs() < 1e-9 * expected.abs() * (1.0 + c.most.abs().max(-c.least) / m.abs()));
        }
    }

    /// Four u-curves at u and the v-curve through the results, or the other way round.
    #[test]
    fn curves_first_in_either_direction(patch in any_patch(), u in 0.0f64..1.0, v in 0.0f64..1.0) {
        let across: Vec<DVec4> = (0..=patch.degree_v).map(|j| casteljau(&row(&patch, j), u)).collect();
        let along: Vec<DVec4> = (0..=patch.degree_u).map(|i| casteljau(&column(&patch, i), v)).collect();
        let (a, b) = (casteljau(&across, v), casteljau(&along, u));
        prop_assert!((a - b).max_abs() < 1e-14);
        prop_assert!((patch.homogeneous(u, v) - a).max_abs() < 1e-13);
        prop_assert!(patch.point(u, v).distance(b.point()) < 1e-13);
    }

    #[test]
    fn bicubic_in_either_order(points in prop::collection::vec(vector(), 16), u in 0.0f64..1.0, v in 0.0f64..1.0) {
        let patch = polynomial(3, 3, &points);
        // the weight of p_ij is B_i(u) B_j(v)
        let b = |t: f64| { let s = 1.0 - t; [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t] };
        let (bu, bv) = (b(u), b(v));
        let sum: DVec3 = (0..16).map(|i| points[i] * (bu[i % 4] * bv[i / 4])).sum();
        prop_assert!(patch.point(u, v).distance(sum) < 1e-14);
        prop_assert!(patch.transposed().point(v, u).distance(sum) < 1e-14);
    }

    /// Moving control point `(i, j)` moves the surface by `B_i(u) B_j(v)` of that: its weight in the tensor product.
    #[test]
    fn weights_are_products(n in 1usize..6, k in 1usize..6, at in (0usize..6, 0usize..6), points in prop::collection::vec(vector(), 36), d in vector(), u in 0.0f64..1.0, v in 0.0f64..1.0) {
        let (i, j) = (at.0.min(n), at.1.min(k));
        let before = polynomial(n, k, &points[..(n + 1) * (k + 1)]);
        let mut after = before.clone();
        after.points[j * (n + 1) + i] += d.extend(0.0);
        // Bernstein polynomials by Pascal's triangle
        let bernstein = |n: usize, i: usize, t: f64| {
            let choose = (0..i).fold(1.0, |c, m| c * (n - m) as f64 / (m + 1) as f64);
            choose * t.powi(i as i32) * (1.0 - t).powi((n - i) as i32)
        };
        let expected = d * (bernstein(n, i, u) * bernstein(k, j, v));
        prop_assert!((after.point(u, v) - before.point(u, v)).distance(expected) < 1e-14);
    }

    /// Along any direction the patch does not pass its farthest control point: it lies in the convex hull.
    #[test]
    fn convex_hull(patch in any_patch(), u in 0.0f64..1.0, v in 0.0f64..1.0, d in vector()) {
        let farthest = patch.points.iter().map(|p| p.point().dot(d)).fold(f64::NEG_INFINITY, f64::max);
        prop_assert!(patch.point(u, v).dot(d) <= farthest + 1e-14);
    }

    #[test]
    fn corners_are_met_bit_for_bit(patch in any_patch()) {
        let (n, k) = (patch.degree_u, patch.degree_v);
        for (u, v, i) in [(0.0, 0.0, 0), (1.0, 0.0, n), (0.0, 1.0, k * (n + 1)), (1.0, 1.0, (n + 1) * (k + 1) - 1)] {
            prop_assert_eq!(patch.homogeneous(u, v), patch.points[i]);
        }
    }

    /// Boundary curves are the Bézier curves of the boundary points, whatever the others are.
    #[test]
    fn boundaries_are_bezier(patch in any_patch(), t in 0.0f64..1.0) {
        let (n, k) = (patch.degree_u, patch.degree_v);
        let sides = [
            (row(&patch, 0), patch.homogeneous(t, 0.0)),
            (row(&patch, k), patch.homogeneous(t, 1.0)),
            (column(&patch, 0), patch.homogeneous(0.0, t)),
            (column(&patch, n), patch.homogeneous(1.0, t)),
        ];
        for (points, value) in sides {
            let curve = Bezier { points };
            prop_assert!((curve.homogeneous(t) - value).max_abs() < 1e-14);
            prop_assert!((casteljau(&curve.points, t) - value).max_abs() < 1e-13);
        }
    }

    /// At fixed `u` the patch is the Bézier curve of degree `degree_v` whose points are the rows' values at `u`.
    #[test]
    fn isoparametric_curves_are_bezier(patch in any_patch(), u in 0.0f64..1.0, t in 0.0f64..1.0) {
        let at_u = Bezier { points: (0..=patch.degree_v).map(|j| casteljau(&row(&patch, j), u)).collect() };
        prop_assert!(at_u.point(t).distance(patch.point(u, t)) < 1e-13);
        let at_v = Bezier { points: (0..=patch.degree_u).map(|i| casteljau(&column(&patch, i), u)).collect() };
        prop_assert!(at_v.point(t).distance(patch.point(t, u)) < 1e-13);
    }

    /// Partial derivatives are themselves Bézier: the patch of `n (p_{i+1,j} - p_ij)`, one degree lower.
    #[test]
    fn tangents_are_bezier(n in 2usize..5, k in 2usize..5, points in prop::collection::vec(vector(), 25), u in 0.0f64..1.0, v in 0.0f64..1.0) {
        let patch = polynomial(n, k, &points[..(n + 1) * (k + 1)]);
        let differences = |p: &Patch| {
            let points = (0..=p.degree_v).flat_map(|j| {
                let r = row(p, j);
                r.windows(2).map(|w| ((w[1] - w[0]) * p.degree_u as f64).truncate().extend(1.0)).collect::<Vec<_>>()
            });
            Patch { degree_u: p.degree_u - 1, degree_v: p.degree_v, points: points.collect() }
        };
        let jet = patch.jet(u, v);
        prop_assert!(differences(&patch).point(u, v).distance(jet.du) < 1e-12);
        prop_assert!(differences(&patch.transposed()).point(v, u).distance(jet.dv) < 1e-12);
    }

    /// Exchanging the parameters, or running one backwards, turns the normal over; doing both does not.
    #[test]
    fn the_order_fixes_the_side(patch in any_patch(), u in 0.05f64..0.95, v in 0.05f64..0.95) {
        let jet = patch.jet(u, v);
        prop_assume!(jet.du.cross(jet.dv).length() > 0.05);
        let normal = patch.normal(u, v).unwrap();
        prop_assert!(normal.distance(jet.du.cross(jet.dv).normalize()) < 1e-12);
        let turned = patch.transposed();
        prop_assert!(turned.normal(v, u).unwrap().distance(-normal) < 1e-9);
        let mut mirrored = patch.clone();
        mirrored.points.chunks_mut(patch.degree_u + 1).for_each(<[DVec4]>::reverse);
        prop_assert!(mirrored.normal(1.0 - u, v).unwrap().distance(-normal) < 1e-9);
        prop_assert!(mirrored.transposed().normal(v, 1.0 - u).unwrap().distance(normal) < 1e-9);
    }
}
