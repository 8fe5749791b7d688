//! Carriers against the formulas of ISO 10303-42, at random frames, radii and ranges.

use super::super::support::Support;
use super::*;
use crate::spline::BSpline;
use glam::DVec4;
use proptest::prelude::*;

fn any_frame() -> impl Strategy<Value = Frame> {
    let v = || (-1.0..1.0, -1.0..1.0, -1.0..1.0).prop_map(|(x, y, z)| DVec3::new(x, y, z));
    (v(), v(), v())
        .prop_filter_map("axis too short", |(o, z, x)| (z.length() > 0.1).then(|| Frame::new(o * 50.0, z, x)).flatten())
}

/// The point of the standard's formula.
fn formula(s: &SurfaceGeometry, u: f64, v: f64) -> DVec3 {
    let turned = |f: &Frame, rho: f64, z: f64| f.world(DVec3::new(rho * u.cos(), rho * u.sin(), z));
    match s {
        SurfaceGeometry::Plane { frame } => frame.world(DVec3::new(u, v, 0.0)),
        SurfaceGeometry::Cylinder { frame, radius } => turned(frame, *radius, v),
        SurfaceGeometry::Cone { frame, radius, half_angle } => turned(frame, radius + v * half_angle.tan(), v),
        SurfaceGeometry::Sphere { frame, radius } => turned(frame, radius * v.cos(), radius * v.sin()),
        SurfaceGeometry::Torus { frame, major, minor } => turned(frame, major + minor * v.cos(), minor * v.sin()),
        _ => unreachable!("only elementary surfaces here"),
    }
}

/// Carrier and formula agree at matching parameters, everywhere on the box, and the corners are
/// where the box says.
fn agrees(s: &SurfaceGeometry, u: (f64, f64), v: (f64, f64), size: f64) {
    let support = Support::new(s, 1e-9).unwrap();
    let carrier = support.carrier([u, v]).unwrap();
    assert_eq!(carrier.surface.domain(), (u, v));
    let grid = carrier.surface.patches();
    for i in 0..=12 {
        for j in 0..=12 {
            let at = |(a, b): (f64, f64), k: i32| a + (b - a) * f64::from(k) / 12.0;
            let native = DVec2::new(at(u, i), at(v, j));
            let mapped = DVec2::new(carrier.axes[0].to_carrier(native.x), carrier.axes[1].to_carrier(native.y));
            let expected = formula(s, native.x, native.y);
            let error = grid.point(mapped.x, mapped.y).distance(expected);
            assert!(error <= 1e-12 * size, "{error:e} at {native}");
            let back = DVec2::new(carrier.axes[0].to_native(mapped.x), carrier.axes[1].to_native(mapped.y));
            assert!((back - native).abs().max_element() < 1e-12 * (1.0 + native.abs().max_element()));
        }
    }
}

proptest! {
    #[test]
    fn elementary_carriers_are_exact(
        frame in any_frame(),
        radius in 0.1..40.0f64,
        ratio in 1.01..5.0f64,
        half_angle in 0.05..1.4f64,
        start in -7.0..7.0f64,
        sweep in 0.01..TAU,
        low in -20.0..20.0f64,
        height in 0.01..30.0f64,
        latitude in (0.0..1.0f64, 0.01..1.0f64),
    ) {
        let (u, v) = ((start, start + sweep), (low, low + height));
        let size = 100.0 + radius * ratio + 60.0 * half_angle.tan();
        agrees(&SurfaceGeometry::Plane { frame }, v, u, size);
        agrees(&SurfaceGeometry::Cylinder { frame, radius }, u, v, size);
        agrees(&SurfaceGeometry::Cone { frame, radius, half_angle }, u, v, size);
        let south = -FRAC_PI_2 + latitude.0 * 3.0;
        let north = south + latitude.1 * (FRAC_PI_2 - south);
        agrees(&SurfaceGeometry::Sphere { frame, radius }, u, (south, north), size);
        agrees(&SurfaceGeometry::Torus { frame, major: radius * ratio, minor: radius }, u, (low, low + sweep), size);
    }

    #[test]
    fn inversion_undoes_evaluation(
        frame in any_frame(),
        u in 0.01..6.27f64,
        v in -1.5..1.5f64,
        radius in 0.5..20.0f64,
    ) {
        let profile = Box::new(CurveGeometry::Ellipse {
            frame: moved(meridian_frame(frame, 0.3), [3.0 * radius, 0.0, 0.0]),
            semi_x: radius,
            semi_y: 0.6 * radius,
        });
        for s in [
            SurfaceGeometry::Cylinder { frame, radius },
            SurfaceGeometry::Cone { frame, radius: 2.0 * radius, half_angle: 0.4 },
            SurfaceGeometry::Sphere { frame, radius },
            SurfaceGeometry::Torus { frame, major: 2.0 * radius, minor: radius },
            SurfaceGeometry::Revolution { profile: profile.clone(), origin: frame.origin, axis: frame.z },
            SurfaceGeometry::Extrusion { profile, direction: DVec3::new(0.1, 0.2, 0.9) + frame.y },
        ] {
            let support = Support::new(&s, 1e-9).unwrap();
            let at = DVec2::new(u, v);
            let back = support.invert(support.point(at), Some(at + DVec2::new(0.05, -0.04)), 1e-11);
            prop_assert!((back - at).abs().max_element() < 1e-8, "{back} for {at} on {s:?}");
        }
    }
}

#[test]
fn full_turns_share_their_seam_bit_for_bit() {
    let f = odd_frame();
    for s in [
        SurfaceGeometry::Sphere { frame: f, radius: 3.3 },
        SurfaceGeometry::Torus { frame: f, major: 5.1, minor: 1.7 },
        SurfaceGeometry::Torus { frame: f, major: 1.0, minor: 1.7 },
    ] {
        let built = build(s, Vec::new(), &[]);
        assert!(built.face.loops.is_empty());
        let (nu, nv) = built.face.surface.counts();
        let p = built.face.surface.points();
        for j in 0..nv {
            assert_eq!(p[j * nu], p[j * nu + nu - 1]);
        }
    }
}

#[test]
fn a_sphere_has_one_point_at_each_pole() {
    let built = build(SurfaceGeometry::Sphere { frame: odd_frame(), radius: 3.3 }, Vec::new(), &[]);
    let (nu, nv) = built.face.surface.counts();
    let p = built.face.surface.points();
    for row in [0, nv - 1] {
        for i in 1..nu {
            let gap = p[row * nu].point().distance(p[row * nu + i].point());
            assert!(gap < 1e-14 * 15.0, "{gap:e}");
        }
    }
}

#[test]
fn whole_surfaces_have_their_area() {
    let f = odd_frame();
    assert_area(&build(SurfaceGeometry::Sphere { frame: f, radius: 3.0 }, Vec::new(), &[]), 36.0 * PI, 1e-10);
    let torus = SurfaceGeometry::Torus { frame: f, major: 5.0, minor: 2.0 };
    assert_area(&build(torus, Vec::new(), &[]), 4.0 * PI * PI * 10.0, 1e-10);
    // the outer part of a torus that meets its axis: 4 π r (R w + r sin w), cos w = -R / r
    let (major, minor): (f64, f64) = (1.0, 2.0);
    let w = (-major / minor).acos();
    let apple = build(SurfaceGeometry::Torus { frame: f, major, minor }, Vec::new(), &[]);
    assert_area(&apple, 4.0 * PI * minor * (major * w + minor * w.sin()), 1e-10);
}

#[test]
fn a_sphere_stated_as_a_turned_circle_is_covered_once() {
    let f = odd_frame();
    let profile = Box::new(circle(meridian_frame(f, 0.0), 3.0));
    let s = SurfaceGeometry::Revolution { profile, origin: f.origin, axis: f.z };
    assert_area(&build(s, Vec::new(), &[]), 36.0 * PI, 1e-10);
}

#[test]
fn impossible_surfaces_are_named() {
    let f = odd_frame();
    for s in [
        SurfaceGeometry::Cylinder { frame: f, radius: -1.0 },
        SurfaceGeometry::Sphere { frame: f, radius: 0.0 },
        SurfaceGeometry::Torus { frame: f, major: 3.0, minor: f64::NAN },
        SurfaceGeometry::Cone { frame: f, radius: 1.0, half_angle: 0.0 },
        SurfaceGeometry::Plane { frame: Frame { x: f.z, ..f } },
    ] {
        let error = build_face(&face(s, Vec::new()), &[], TOLERANCE).unwrap_err();
        assert!(matches!(error, BuildError::Surface { face: 7, .. }), "{error}");
    }
    let unbounded = build_face(&face(SurfaceGeometry::Plane { frame: f }, Vec::new()), &[], TOLERANCE);
    assert_eq!(unbounded.unwrap_err(), BuildError::Unbounded { face: 7 });
}

#[test]
fn composite_and_conic_profiles_become_exact_splines() {
    let f = Frame::WORLD;
    let hyperbola = CurveGeometry::Hyperbola { frame: f, semi_x: 2.0, semi_y: 1.5 };
    let parabola = CurveGeometry::Parabola { frame: f, focal: 0.7 };
    let spline = CurveGeometry::BSpline(
        BSpline::new(
            2,
            vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
            vec![DVec4::new(0.0, 0.0, 0.0, 1.0), DVec4::new(1.0, 2.0, 0.0, 1.0), DVec4::new(3.0, 0.0, 0.0, 1.0)],
        )
        .unwrap(),
    );
    for (g, on_curve) in [
        (hyperbola, (|p: DVec3| (p.x / 2.0).powi(2) - (p.y / 1.5).powi(2) - 1.0) as fn(DVec3) -> f64),
        (parabola, |p: DVec3| p.x - p.y * p.y / (4.0 * 0.7)),
        (spline, |p: DVec3| p.z),
    ] {
        let c = super::super::curve::Curve::new(&g, 1e-9).unwrap();
        let (a, b) = c.domain().unwrap_or((-1.3, 2.9));
        for s in c.beziers(a, b) {
            for k in 0..=16 {
                let p = s.piece.point(f64::from(k) / 16.0);
                assert!(on_curve(p).abs() < 1e-11 * (1.0 + p.length_squared()));
            }
            assert!(s.piece.point(0.0).distance(c.point(s.start)) < 1e-12 * (1.0 + c.point(s.start).length()));
            let middle = c.closest(s.piece.point(0.37));
            assert!(c.point(middle).distance(s.piece.point(0.37)) < 1e-11);
        }
    }
}
