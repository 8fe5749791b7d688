//! Solids have the right volume, which fails for any normal that points inwards, and close.

use crate::{EXACT, fractions, planar};
use glam::{DVec2, DVec3};
use selvedge_geometry::construct::{Chain, ConstructError, extruded_solid, lathed_solid};
use selvedge_geometry::model::{Face, FaceError, Part, SurfaceKind};
use selvedge_geometry::spline::{BSpline, Control};
use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

/// A third of the flux of position through a face without loops, by the midpoint rule in every patch.
fn flux(face: &Face) -> f64 {
    const N: u32 = 60;
    let mut sum = 0.0;
    for p in face.surface.patches().patches {
        for j in 0..N {
            for i in 0..N {
                let jet = p.patch.jet((f64::from(i) + 0.5) / f64::from(N), (f64::from(j) + 0.5) / f64::from(N));
                sum += jet.point.dot(jet.du.cross(jet.dv)) / f64::from(N * N);
            }
        }
    }
    if face.same_sense { sum / 3.0 } else { -sum / 3.0 }
}

/// The same for a plane with loops: the distance to its plane is constant.
fn cap(face: &Face) -> f64 {
    let ((u, _), (v, _)) = face.surface.domain();
    let jet = face.surface.jet(u, v);
    let area: f64 = face.loops.iter().map(|l| 0.5 * l.signed_area()).sum();
    assert!(area > 0.0, "outer loops run counter-clockwise");
    let flux = jet.point.dot(jet.du.cross(jet.dv)) * area / 3.0;
    if face.same_sense { flux } else { -flux }
}

fn volume(part: &Part) -> f64 {
    assert!(part.closed && part.faces.iter().enumerate().all(|(i, f)| f.id == i as u32 + 1));
    part.faces.iter().map(|f| if f.loops.is_empty() { flux(f) } else { cap(f) }).sum()
}

fn circle(centre: DVec2, r: f64) -> Chain {
    let corners = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
    let point = |(i, &(x, y)): (usize, &(i32, i32))| {
        let w = if i % 2 == 0 { 1.0 } else { FRAC_1_SQRT_2 };
        DVec3::from_point(centre + DVec2::new(f64::from(x), f64::from(y)) * r, w)
    };
    let knots = [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0];
    vec![BSpline::new(2, knots.to_vec(), corners.iter().enumerate().map(point).collect()).unwrap()]
}

fn square(a: f64, b: f64) -> Chain {
    let corners = [(a, a), (b, a), (b, b), (a, b), (a, a)];
    corners.windows(2).map(planar).collect()
}

fn backwards(chain: &Chain) -> Chain {
    chain.iter().rev().map(BSpline::reversed).collect()
}

/// Of the midpoint rule and of the polygon of 16 chords a quarter that measures the caps.
const MEASURED: f64 = 1e-3;

#[test]
fn an_extruded_plate_with_a_hole_and_an_island() {
    let centre = DVec2::new(1.0, 1.0);
    let loops = [square(-2.0, 4.0), circle(centre, 2.0), circle(centre, 1.0)];
    let expected = (36.0 - PI * 4.0 + PI) * 0.5;
    // in any order, running any way, up and down, and aslant
    let other = [backwards(&loops[1]), loops[2].clone(), backwards(&loops[0])];
    for loops in [&loops, &other] {
        for vector in [DVec3::Z * 0.5, DVec3::Z * -0.5, DVec3::new(3.0, 1.0, 0.5)] {
            let part = extruded_solid(loops, vector).unwrap();
            assert_eq!(part.faces.len(), 8);
            let found = volume(&part);
            assert!((found - expected).abs() <= MEASURED * 36.0, "{found} for {expected}");
        }
    }
}

/// The trim loops of the caps are the ends of the sides.
#[test]
fn caps_and_sides_meet() {
    let vector = DVec3::new(0.3, 0.2, 1.5);
    let part = extruded_solid(&[circle(DVec2::new(3.0, 1.0), 2.0)], vector).unwrap();
    let [side, bottom, top] = &part.faces[..] else { panic!("one side, two caps") };
    assert_eq!([side.kind, bottom.kind, top.kind], [SurfaceKind::Extrusion, SurfaceKind::Plane, SurfaceKind::Plane]);
    let grid = side.surface.patches();
    for (k, curve) in bottom.loops[0].curves().enumerate() {
        for t in fractions(10) {
            let uv = curve.point(t);
            let u = k as f64 + t;
            assert!(bottom.surface.jet(uv.x, uv.y).point.distance(grid.point(u, 0.0)) <= 5.0 * EXACT);
            assert!(top.surface.jet(uv.x, uv.y).point.distance(grid.point(u, 1.0)) <= 5.0 * EXACT);
        }
    }
}

#[test]
fn lathed_solids() {
    // a cone of radius 2 and height 3: two sides, the axis makes none
    let cone = |flip: f64| -> Chain {
        let corners = [(0.0, 0.0), (2.0 * flip, 0.0), (0.0, 3.0), (0.0, 0.0)];
        corners.windows(2).map(planar).collect()
    };
    for (chain, angle, faces) in [
        (cone(1.0), TAU, 2),
        (backwards(&cone(1.0)), TAU, 2),
        (cone(-1.0), TAU, 2),
        (cone(1.0), 2.0, 4),
        (cone(-1.0), 2.0, 4),
    ] {
        let part = lathed_solid(&[chain], angle).unwrap();
        assert_eq!(part.faces.len(), faces);
        let (found, expected) = (volume(&part), 4.0 * PI * angle / TAU);
        assert!((found - expected).abs() <= MEASURED * expected, "{found} for {expected}");
    }
    // a hollow ring
    let ring = [circle(DVec2::new(5.0, 0.0), 2.0), circle(DVec2::new(5.0, 0.5), 1.0)];
    let part = lathed_solid(&ring, TAU).unwrap();
    let expected = 2.0 * PI * 5.0 * (PI * 4.0 - PI);
    assert!((volume(&part) - expected).abs() <= MEASURED * expected);
}

#[test]
fn what_is_no_solid() {
    let bow: Chain = [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0), (0.0, 0.0)].windows(2).map(planar).collect();
    let refused = extruded_solid(&[bow], DVec3::Z);
    let Err(ConstructError::SelfCrossing { first, second, .. }) = refused else { panic!("{refused:?}") };
    assert_eq!((first, second), (0.0, 2.0));
    let two = [circle(DVec2::ZERO, 1.0), circle(DVec2::X, 1.0)];
    assert!(matches!(extruded_solid(&two, DVec3::Z), Err(ConstructError::SelfCrossing { .. })));
    let open: Chain = [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0)].windows(2).map(planar).collect();
    let refused = extruded_solid(&[open], DVec3::Z);
    assert!(matches!(refused, Err(ConstructError::Face(FaceError::OpenLoop { .. }))));
    assert!(matches!(extruded_solid(&[square(0.0, 1.0)], DVec3::X), Err(ConstructError::ZeroLength { .. })));
    assert!(matches!(extruded_solid(&[square(0.0, 1.0)], DVec3::NAN), Err(ConstructError::NotFinite { .. })));
    assert!(matches!(extruded_solid(&[], DVec3::Z), Err(ConstructError::TooFew { .. })));
    let across = lathed_solid(&[circle(DVec2::X * 0.5, 1.0)], TAU);
    assert!(matches!(across, Err(ConstructError::CrossesAxis { .. })));
    assert!(matches!(lathed_solid(&[square(1.0, 2.0)], 9.0), Err(ConstructError::Range { .. })));
}
