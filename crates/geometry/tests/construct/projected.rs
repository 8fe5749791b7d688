//! Outlines cast on surfaces: on the surface they lie on the cylinder that the outline sweeps.

use glam::{DVec2, DVec3, DVec4};
use proptest::prelude::*;
use selvedge_geometry::construct::curve::circle;
use selvedge_geometry::construct::{ConstructError, project};
use selvedge_geometry::spline::{BSpline, Control, Surface};

/// A bicubic patch over about [-1, 1]² whose slopes stay so small that no direction used here runs along it.
fn patch() -> impl Strategy<Value = Surface> {
    let point = (-0.1..0.1f64, -0.1..0.1f64, -0.15..0.15f64);
    prop::collection::vec(point, 16).prop_map(|points| {
        let place = |(i, (x, y, z)): (usize, (f64, f64, f64))| {
            let even = |k: usize| 2.0 * k as f64 / 3.0 - 1.0;
            DVec4::from_point(DVec3::new(even(i % 4) + x, even(i / 4) + y, z), 1.0)
        };
        let knots = || vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
        Surface::new((3, 3), knots(), knots(), points.into_iter().enumerate().map(place).collect()).unwrap()
    })
}

/// Distance across the direction from the axis of the cylinder.
fn from_axis(p: DVec3, centre: DVec3, along: DVec3) -> f64 {
    (p - centre).reject_from(along).length()
}

proptest! {
    #[test]
    fn a_circle_becomes_where_its_cylinder_meets_the_surface(
        s in patch(),
        aim in (-0.25..0.25f64, -0.25..0.25f64),
        tilt in (-0.3..0.3f64, -0.3..0.3f64),
        radius in 0.05..0.35f64,
        digits in 2..8i32,
    ) {
        let along = DVec3::new(tilt.0, tilt.1, -1.0);
        let centre = DVec3::new(aim.0, aim.1, 0.0) - along * 2.0;
        let ring = circle(centre, along, DVec3::X, radius, std::f64::consts::TAU).unwrap();
        let tolerance = 10f64.powi(-digits);
        let cast = project(&s, &[ring], along, tolerance).unwrap();
        prop_assert!(cast.deviation <= tolerance);
        let grid = s.patches();
        let mut last: Option<DVec2> = None;
        for c in &cast.curves {
            for k in 0..=16 {
                let uv = c.point(f64::from(k) / 16.0);
                let off = (from_axis(grid.point(uv.x, uv.y), centre, along) - radius).abs();
                // beside the bound, the rounding of the outline itself
                prop_assert!(off <= cast.deviation + 1e-12, "{off:e} of {:e}", cast.deviation);
            }
            let (a, b) = (c.point(0.0), c.point(1.0));
            prop_assert!(last.is_none_or(|l| l.distance(a) < 1e-12));
            last = Some(b);
        }
        // it closes
        prop_assert!(cast.curves[0].point(0.0).distance(last.unwrap()) < 1e-9);
    }
}

fn flat() -> Surface {
    let net = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
    let points = net.iter().map(|(x, y)| DVec4::new(*x, *y, 0.0, 1.0)).collect();
    let knots = || vec![0.0, 0.0, 1.0, 1.0];
    Surface::new((1, 1), knots(), knots(), points).unwrap()
}

#[test]
fn curves_that_cannot_be_cast_are_reported() {
    let ring = |x: f64, r: f64| circle(DVec3::new(x, 0.0, 1.0), DVec3::Z, DVec3::X, r, std::f64::consts::TAU).unwrap();
    let cast = |ring: BSpline<DVec4>, along: DVec3| project(&flat(), &[ring], along, 1e-6);
    let misses = |r: Result<_, ConstructError>, from: f64, to: f64| match r {
        Err(ConstructError::Misses { parameter, .. }) => assert!((from..=to).contains(&parameter), "{parameter}"),
        other => panic!("{other:?}"),
    };
    misses(cast(ring(5.0, 1.0), DVec3::NEG_Z), 0.0, 0.0); // beside it from the start
    misses(cast(ring(-0.5, 0.8), DVec3::NEG_Z), 1.0, 2.0); // leaves it in its second quarter
    misses(cast(ring(0.0, 0.5), DVec3::X), 0.0, 0.0); // along it
    assert!(matches!(cast(ring(0.0, 0.5), DVec3::ZERO), Err(ConstructError::ZeroLength { .. })));
    assert!(matches!(project(&flat(), &[], DVec3::Z, 1e-6), Err(ConstructError::TooFew { .. })));
    assert!(matches!(project(&flat(), &[ring(0.0, 0.5)], DVec3::Z, f64::NAN), Err(ConstructError::Range { .. })));
}
