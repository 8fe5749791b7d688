//! Against closed forms, on solids whose dimensions are known, placed askew.

use super::*;
use glam::DQuat;
use selvedge::construct::shapes;
use selvedge::model::{Instance, Part};
use std::f64::consts::PI;

/// Tolerance of numbers that are roundings of their true values: some hundred operations of 2⁻⁵² each.
const ROUNDING: f64 = 1e-13;
/// Tolerance of integrals.
const INTEGRAL: f64 = 1e-11;

fn askew() -> DAffine3 {
    DAffine3::from_rotation_translation(
        DQuat::from_rotation_x(0.4) * DQuat::from_rotation_y(1.1),
        DVec3::new(3.0, -7.0, 20.0),
    )
}

fn placed(transform: DAffine3) -> Instance {
    Instance { part: 0, transform, colour: None, name: String::new() }
}

fn close(found: f64, expected: f64, share: f64) {
    assert!((found - expected).abs() <= share * expected.abs(), "{found} instead of {expected}");
}

fn solid(part: &Part, area: f64, volume: f64, centre: DVec3) {
    let mass = mass::mass(part, &placed(askew()));
    close(mass.area.area, area, INTEGRAL);
    close(mass.volume, volume, INTEGRAL);
    assert!(mass.centre.distance(askew().transform_point3(centre)) < 1e-9, "{}", mass.centre);
    assert!(mass.error <= INTEGRAL * volume && mass.area.error <= INTEGRAL * area, "{mass:?}");
}

#[test]
fn areas_and_volumes_are_those_of_the_formulas() {
    let (r, h, big, small) = (2.5, 7.0, 4.0, 1.25);
    solid(&shapes::sphere(r).unwrap().part, 4.0 * PI * r * r, 4.0 / 3.0 * PI * r.powi(3), DVec3::ZERO);
    let torus = shapes::torus(big, small).unwrap().part;
    solid(&torus, 4.0 * PI * PI * big * small, 2.0 * PI * PI * big * small * small, DVec3::ZERO);
    let tube = shapes::tube(big, small, h).unwrap().part;
    let ring = PI * (big * big - small * small);
    let bounds = tube.bounds();
    solid(&tube, 2.0 * ring + 2.0 * PI * (big + small) * h, ring * h, bounds.centre());
    let block = shapes::block(DVec3::new(-1.0, 0.0, 2.0), DVec3::new(2.0, 1.0, 7.0)).unwrap().part;
    solid(&block, 2.0 * (3.0 + 15.0 + 5.0), 15.0, DVec3::new(0.5, 0.5, 4.5));
}

/// A mirrored part has the same volume, not its opposite.
#[test]
fn a_mirror_turns_nothing_inside_out() {
    let block = shapes::block(DVec3::ZERO, DVec3::new(2.0, 3.0, 5.0)).unwrap().part;
    let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    close(mass::mass(&block, &placed(mirror)).volume, 30.0, INTEGRAL);
}

#[test]
fn surfaces_are_known_with_their_dimensions() {
    let of = |part: Part, face: usize| surface::shape(&part.faces[face], askew());
    let axis = askew().transform_vector3(DVec3::Z);
    let along = |found: DVec3| assert!(found.cross(axis).length() < 1e-9, "{found} is not along {axis}");
    let part = shapes::cylinder(2.5, 7.0).unwrap().part;
    let shapes_of = |part: &Part| (0..part.faces.len()).map(|f| of(part.clone(), f)).collect::<Vec<_>>();
    let mut kinds = [0; 3];
    for shape in shapes_of(&part) {
        match shape {
            SurfaceShape::Plane { normal, .. } => {
                kinds[0] += 1;
                along(normal);
            }
            SurfaceShape::Cylinder { axis, radius, .. } => {
                kinds[1] += 1;
                along(axis);
                close(radius, 2.5, ROUNDING);
            }
            _ => kinds[2] += 1,
        }
    }
    assert_eq!(kinds, [2, 1, 0]);
    let SurfaceShape::Sphere { centre, radius } = of(shapes::sphere(2.5).unwrap().part, 0) else { panic!("a sphere") };
    close(radius, 2.5, ROUNDING);
    assert!(centre.distance(askew().translation) < 1e-12);
    let cones = shapes_of(&shapes::cone(4.0, 1.0, 5.0).unwrap().part);
    let cone = cones.into_iter().find(|s| matches!(s, SurfaceShape::Cone { .. })).expect("a cone");
    let SurfaceShape::Cone { axis: of_cone, half_angle, .. } = cone else { unreachable!() };
    along(of_cone);
    close(half_angle, (3.0_f64 / 5.0).atan(), 1e-12);
    let SurfaceShape::Torus { axis: of_torus, centre, major, minor } = of(shapes::torus(4.0, 1.25).unwrap().part, 0)
    else {
        panic!("a torus")
    };
    along(of_torus);
    // the axis is the least of six eigenvalues
    close(major, 4.0, 1e-11);
    close(minor, 1.25, 1e-11);
    assert!(centre.distance(askew().translation) < 1e-10);
}

fn apart(a: (&Part, usize, DAffine3), b: (&Part, usize, DAffine3)) -> Distance {
    let sampled =
        |(part, face, transform): (&'static Part, usize, DAffine3)| Sampled::face(&part.faces[face], transform);
    let still = |(part, face, transform): (&Part, usize, DAffine3)| {
        let part: &'static Part = Box::leak(Box::new(part.clone()));
        sampled((part, face, transform))
    };
    distance::smallest(&still(a), &still(b)).expect("both have points")
}

#[test]
fn distances_between_round_faces_are_those_of_the_formulas() {
    let (sphere, torus) = (shapes::sphere(2.5).unwrap().part, shapes::torus(4.0, 1.25).unwrap().part);
    for i in 0..12 {
        let turn = f64::from(i);
        let place = DVec3::new(9.0 * turn.cos(), 9.0 * turn.sin(), 2.0 + turn);
        let there = DAffine3::from_translation(place);
        let found = apart((&sphere, 0, there), (&torus, 0, DAffine3::IDENTITY));
        let to_ring = (place.truncate().length() - 4.0).hypot(place.z);
        close(found.distance, to_ring - 1.25 - 2.5, 1e-12);
        close(found.points[0].distance(found.points[1]), found.distance, 1e-12);
        let both = apart((&sphere, 0, there), (&sphere, 0, DAffine3::IDENTITY));
        close(both.distance, place.length() - 5.0, 1e-12);
    }
}

/// The nearest points lie on borders: inside of neither plane.
#[test]
fn distances_end_at_borders() {
    let block = shapes::block(DVec3::ZERO, DVec3::ONE).unwrap().part;
    let there = DAffine3::from_translation(DVec3::new(3.0, 4.0, 0.5));
    // the tops, and the left side of one above the right side of the other
    close(
        apart((&block, 5, there), (&block, 5, DAffine3::IDENTITY)).distance,
        DVec3::new(2.0, 3.0, 0.5).length(),
        ROUNDING,
    );
    close(apart((&block, 0, there), (&block, 1, DAffine3::IDENTITY)).distance, 2.0_f64.hypot(3.0), ROUNDING);
    // a disc above a hole: rim to rim
    let tube = shapes::tube(4.0, 1.25, 7.0).unwrap().part;
    let disc = shapes::cylinder(1.0, 1.0).unwrap().part;
    let flat = |part: &Part, z: f64| {
        let at = |f: &selvedge::model::Face| f.bounds();
        part.faces
            .iter()
            .position(|f| (at(f).min.z - z).abs() < 1e-9 && (at(f).max.z - z).abs() < 1e-9)
            .expect("a plane")
    };
    let (top, bottom) = (tube.bounds().max.z, disc.bounds().min.z);
    let above = DAffine3::from_translation(DVec3::Z * (top - bottom + 0.75));
    let found = apart((&disc, flat(&disc, bottom), above), (&tube, flat(&tube, top), DAffine3::IDENTITY));
    close(found.distance, 0.75_f64.hypot(0.25), 1e-12);
}

#[test]
fn lines_and_points_have_nearest_points() {
    let (p, q) = between(DVec3::ZERO, Some(DVec3::X), DVec3::new(5.0, 3.0, 2.0), Some(DVec3::Y)).expect("two lines");
    assert!(p.distance(DVec3::new(5.0, 0.0, 0.0)) < 1e-14 && q.distance(DVec3::new(5.0, 0.0, 2.0)) < 1e-14);
    let (p, q) = between(DVec3::ZERO, Some(DVec3::X), DVec3::new(5.0, 3.0, 4.0), Some(DVec3::X)).expect("parallel");
    close(p.distance(q), 5.0, 1e-14);
    let (p, q) = between(DVec3::ONE, None, DVec3::new(9.0, 0.0, 0.0), Some(DVec3::X)).expect("a point and a line");
    assert_eq!((p, q), (DVec3::ONE, DVec3::X));
}

#[test]
fn a_measurement_is_text_and_a_table() {
    let mut all = Measurement { title: "edge \"1\"".to_owned(), ..Measurement::default() };
    all.add("length", 1.0 / 3.0, 1e-16, "mm");
    all.points.push(("centre", DVec3::new(1.0, 2.5, -3.0)));
    assert_eq!(all.text(), "edge \"1\"\nlength: 0.333333333333 mm\ncentre: 1, 2.5, -3");
    let rows = "\"edge \"\"1\"\"\",length,0.3333333333333333,0.0000000000000001,mm\n\"edge \"\"1\"\"\",centre x,1,0,mm\n\
                \"edge \"\"1\"\"\",centre y,2.5,0,mm\n\"edge \"\"1\"\"\",centre z,-3,0,mm\n";
    assert_eq!(all.csv(), rows);
}
