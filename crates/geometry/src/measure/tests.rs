//! Against closed forms, on solids whose dimensions are known, placed askew.

use super::*;
use crate::construct::shapes;
use crate::model::EdgeKind;
use glam::DQuat;
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

fn close(found: f64, expected: f64, share: f64) {
    assert!((found - expected).abs() <= share * expected.abs(), "{found} instead of {expected}");
}

fn solid(part: &Part, area: f64, volume: f64, centre: DVec3) {
    let mass = mass::mass(part, askew());
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
    close(mass::mass(&block, mirror).volume, 30.0, INTEGRAL);
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
    let [a, b] = [a, b].map(|(part, face, transform)| Pieces::face(&part.faces[face], transform));
    distance::smallest(&a, &b).expect("both have points")
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
        let at = |f: &crate::model::Face| f.bounds();
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
    let (p, q) = between(DVec3::ZERO, Some(DVec3::X), DVec3::new(5.0, 3.0, 2.0), Some(DVec3::Y));
    assert!(p.distance(DVec3::new(5.0, 0.0, 0.0)) < 1e-14 && q.distance(DVec3::new(5.0, 0.0, 2.0)) < 1e-14);
    let (p, q) = between(DVec3::ZERO, Some(DVec3::X), DVec3::new(5.0, 3.0, 4.0), Some(DVec3::X));
    close(p.distance(q), 5.0, 1e-14);
    assert_eq!(between(DVec3::ONE, None, DVec3::new(9.0, 0.0, 0.0), Some(DVec3::X)), (DVec3::ONE, DVec3::X));
}

fn number(measured: &Measured, what: &str) -> f64 {
    measured.values.iter().find(|value| value.what == what).expect(what).value
}

/// A rim as it is, and in two pieces that do not follow each other, as the seam of another face may leave it.
#[test]
fn an_edge_in_pieces_is_one_edge() {
    let part = shapes::cylinder(2.5, 7.0).unwrap().part;
    let found = part.edges().expect("edges");
    let rim = found.edges.iter().find(|edge| edge.kind == EdgeKind::Sharp).expect("a rim");
    assert!(rim.curve.len() > 1, "a rim is no single piece");
    let (head, tail) = rim.curve.split_at(1);
    let [head, tail] = [head, tail].map(|curve| Edge { curve: curve.to_vec(), ..rim.clone() });
    for edges in [vec![rim], vec![&tail, &head]] {
        let measured = one(&Item::Edge(edges, askew())).expect("an edge");
        close(number(&measured, "length"), 5.0 * PI, INTEGRAL);
        close(number(&measured, "radius"), 2.5, INTEGRAL);
    }
}

#[test]
fn two_items_have_a_distance_and_a_part_has_none() {
    let sphere = shapes::sphere(2.5).unwrap().part;
    let (point, still) = (Item::Point(DVec3::new(2.0, 3.0, 6.0)), DAffine3::IDENTITY);
    let measured = two(&point, &Item::Face(&sphere.faces[0], still)).expect("both have points");
    close(number(&measured, "distance"), 4.5, 1e-12);
    close(number(&measured, "between centres"), 7.0, 1e-12);
    assert_eq!(two(&point, &Item::Part(&sphere, still)), None);
}

#[test]
fn two_points_have_one_distance_and_its_parts() {
    let measured = two(&Item::Point(DVec3::new(1.0, 2.0, 3.0)), &Item::Point(DVec3::new(3.0, 5.0, -3.0)));
    let measured = measured.expect("points");
    let all: Vec<(&str, f64)> = measured.values.iter().map(|v| (v.what, v.value)).collect();
    assert_eq!(all, [("distance", 7.0), ("along x", 2.0), ("along y", 3.0), ("along z", -6.0)]);
    assert_eq!(measured.dimensions.len(), 1, "a distance between centres would be the same line again");
}

#[test]
fn planes_and_axes_have_angles() {
    let (block, can) = (shapes::block(DVec3::ZERO, DVec3::ONE).unwrap().part, shapes::cylinder(1.0, 1.0).unwrap().part);
    let still = DAffine3::IDENTITY;
    let turn = DQuat::from_rotation_x(PI / 6.0);
    let turned = DAffine3::from_rotation_translation(turn, DVec3::X * 10.0);
    let is_round = |face: &&Face| matches!(surface::shape(face, still), SurfaceShape::Cylinder { .. });
    let side = Item::Face(can.faces.iter().find(is_round).expect("a side"), turned);
    let plane = |face: &Face| match surface::shape(face, still) {
        SurfaceShape::Plane { normal, .. } => normal,
        other => panic!("{other:?} is no plane"),
    };
    let first = &block.faces[0];
    for face in &block.faces {
        let angle = |other: &Item<'_>| number(&two(&Item::Face(face, still), other).expect("points"), "angle");
        // the axis is a line, and a plane's angle to a line is no more than a right one
        let expected = plane(face).dot(turn * DVec3::Z).abs().asin().to_degrees();
        assert!((angle(&side) - expected).abs() < 1e-9, "{expected}");
        let expected = if plane(face).dot(plane(first)).abs() > 0.5 { 0.0 } else { 90.0 };
        assert!((angle(&Item::Face(first, still)) - expected).abs() < 1e-9, "{expected}");
    }
}
