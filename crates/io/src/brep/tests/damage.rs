//! Nonsense in, an error or a sound face out: never a panic, never endless work.

use super::*;
use crate::spline::{BSpline, Surface};
use glam::DVec4;
use proptest::prelude::*;

/// Ordinary numbers with a share of those that break programs.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => -4.0..4.0f64,
        2 => (-4i32..5).prop_map(f64::from),
        1 => prop::sample::select(vec![0.0, 1e-12, -1e-7, 1e9, 1e150, f64::NAN, f64::INFINITY]),
    ]
}

fn point() -> impl Strategy<Value = DVec3> {
    (number(), number(), number()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn frame() -> impl Strategy<Value = Frame> {
    (point(), point(), point()).prop_map(|(o, z, x)| Frame::new(o, z, x).unwrap_or(Frame::WORLD))
}

fn spline() -> impl Strategy<Value = CurveGeometry> {
    prop::collection::vec((point(), 0.1..3.0f64), 4..8).prop_map(|points| {
        let n = points.len();
        let inside = (1..n - 3).map(|i| i as f64);
        let end = (n - 3) as f64;
        let knots = [0.0; 4].into_iter().chain(inside).chain([end; 4]).collect();
        let points = points.into_iter().map(|(p, w)| DVec4::from_point(p, w)).collect();
        let line = CurveGeometry::Line { origin: DVec3::ZERO, direction: DVec3::X };
        BSpline::new(3, knots, points).map_or(line, CurveGeometry::BSpline)
    })
}

fn curve() -> impl Strategy<Value = CurveGeometry> {
    let leaf = prop_oneof![
        (point(), point()).prop_map(|(origin, direction)| CurveGeometry::Line { origin, direction }),
        (frame(), number()).prop_map(|(frame, radius)| CurveGeometry::Circle { frame, radius }),
        (frame(), number(), number()).prop_map(|(frame, semi_x, semi_y)| CurveGeometry::Ellipse {
            frame,
            semi_x,
            semi_y
        }),
        (frame(), number(), number()).prop_map(|(frame, semi_x, semi_y)| CurveGeometry::Hyperbola {
            frame,
            semi_x,
            semi_y
        }),
        (frame(), number()).prop_map(|(frame, focal)| CurveGeometry::Parabola { frame, focal }),
        spline(),
    ];
    leaf.prop_recursive(2, 6, 3, |inner| {
        let trimmed = (inner.clone(), number(), number(), any::<bool>()).prop_map(|(basis, start, end, forward)| {
            CurveGeometry::Trimmed { basis: Box::new(basis), start, end, forward }
        });
        prop_oneof![trimmed, prop::collection::vec(inner, 0..3).prop_map(CurveGeometry::Composite)]
    })
}

fn surface() -> impl Strategy<Value = SurfaceGeometry> {
    let patch = prop::collection::vec((point(), 0.2..2.0f64), 9).prop_map(|points| {
        let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        let points = points.into_iter().map(|(p, w)| DVec4::from_point(p, w)).collect();
        let plane = SurfaceGeometry::Plane { frame: Frame::WORLD };
        Surface::new((2, 2), knots.clone(), knots, points).map_or(plane, SurfaceGeometry::BSpline)
    });
    prop_oneof![
        frame().prop_map(|frame| SurfaceGeometry::Plane { frame }),
        (frame(), number()).prop_map(|(frame, radius)| SurfaceGeometry::Cylinder { frame, radius }),
        (frame(), number(), number()).prop_map(|(frame, radius, half_angle)| SurfaceGeometry::Cone {
            frame,
            radius,
            half_angle
        }),
        (frame(), number()).prop_map(|(frame, radius)| SurfaceGeometry::Sphere { frame, radius }),
        (frame(), number(), number()).prop_map(|(frame, major, minor)| SurfaceGeometry::Torus { frame, major, minor }),
        (curve(), point(), point()).prop_map(|(profile, origin, axis)| SurfaceGeometry::Revolution {
            profile: Box::new(profile),
            origin,
            axis
        }),
        (curve(), point())
            .prop_map(|(profile, direction)| SurfaceGeometry::Extrusion { profile: Box::new(profile), direction }),
        patch,
    ]
}

/// Closed chains of edges whose vertices lie on the surface's frame now and then.
fn edges() -> impl Strategy<Value = Vec<Edge>> {
    let vertices = prop::collection::vec(point(), 5);
    (vertices, prop::collection::vec((curve(), 0..5usize, 0..5usize, any::<bool>()), 1..5)).prop_map(|(v, list)| {
        let edge = |(i, (curve, a, b, same_sense))| Edge { id: i as u32, curve, start: v[a], end: v[b], same_sense };
        list.into_iter().enumerate().map(edge).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn nonsense_is_an_error_or_a_sound_face(
        surface in surface(),
        edges in edges(),
        loops in prop::collection::vec(prop::collection::vec((0..5usize, any::<bool>()), 0..4), 0..3),
        vertex in prop::option::of(point()),
        tolerance in number(),
    ) {
        let bounds = loops.into_iter().map(Boundary::Edges).chain(vertex.map(Boundary::Vertex)).collect();
        if let Ok(built) = build_face(&face(surface, bounds), &edges, tolerance) {
            for l in &built.face.loops {
                let (lo, hi) = l.bounds();
                prop_assert!(lo.is_finite() && hi.is_finite());
            }
            prop_assert!(built.face.surface.points().iter().all(|p| p.finite() && p.w > 0.0));
        }
    }
}
