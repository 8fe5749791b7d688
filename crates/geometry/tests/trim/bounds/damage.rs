//! Faces that loops leave nearly empty or empty, and numbers that are not finite.

use super::support::{assert_box, placed};
use crate::shapes::{at, circle, polygon, rectangle};
use glam::{DAffine3, DVec2, DVec3, DVec4};
use selvedge_geometry::model::{Bounds, Face, FaceError, Instance, Mesh, Model, Part, SurfaceKind, TrimLoop};
use selvedge_geometry::spline::{Bezier, SplineError, Surface};

/// The square from 0 to 4 at a height.
fn square(loops: Vec<TrimLoop>, z: f64) -> Face {
    let points = (0..4).map(|k| DVec4::new(f64::from(4 * (k % 2)), f64::from(4 * (k / 2)), z, 1.0)).collect();
    let knots = vec![0.0, 0.0, 4.0, 4.0];
    let surface = Surface::new((1, 1), knots.clone(), knots, points).unwrap();
    Face { id: 1, kind: SurfaceKind::Plane, surface, loops, same_sense: true, colour: None }
}

#[test]
fn of_nothing_there_is_no_box() {
    let disc = || circle(at(2.0, 2.0), 1.0);
    let nothing = [
        vec![disc(), disc().reversed()],
        // there and back again
        vec![polygon(&[(1.0, 1.0), (3.0, 2.0)])],
        vec![rectangle((5.0, 5.0), (6.0, 6.0))],
    ];
    for loops in nothing {
        let face = square(loops, 0.0);
        assert_eq!(face.bounds(), Bounds::EMPTY);
        assert_eq!(placed(&face, DAffine3::IDENTITY).bounds(), Bounds::EMPTY);
    }
    assert_eq!(Part::default().bounds(), Bounds::EMPTY);
    assert_eq!(Model::default().bounds(), Bounds::EMPTY);
}

/// The remaining part of a face counts, and loops that cancel do not.
#[test]
fn loops_that_cancel_bound_nothing() {
    let far = || rectangle((3.0, 3.0), (3.9, 3.9));
    let face = square(vec![rectangle((1.0, 1.0), (2.0, 2.5)), far(), far().reversed()], 0.0);
    let expected = Bounds { min: DVec3::new(1.0, 1.0, 0.0), max: DVec3::new(2.0, 2.5, 0.0) };
    assert_box(face.bounds(), expected, 1e-12);
}

#[test]
fn a_sliver_is_as_long_as_it_is() {
    let face = square(vec![rectangle((0.5, 1.0), (3.5, 1.0 + 1.87e-6))], 0.0);
    let expected = Bounds { min: DVec3::new(0.5, 1.0, 0.0), max: DVec3::new(3.5, 1.0 + 1.87e-6, 0.0) };
    assert_box(face.bounds(), expected, 1e-12);
}

/// Far from the origin the error is the rounding of coordinates.
#[test]
fn a_small_face_far_away() {
    let by = DVec3::new(1e7, -3e6, 2e6);
    let disc = square(vec![circle(at(2.0, 2.0), 1e-3)], 0.0);
    let found = placed(&disc, DAffine3::from_translation(by)).bounds();
    let expected = Bounds { min: by + DVec3::new(1.999, 1.999, 0.0), max: by + DVec3::new(2.001, 2.001, 0.0) };
    let off = (found.min - expected.min).abs().max((found.max - expected.max).abs()).max_element();
    assert!(off <= 1e7 * 64.0 * f64::EPSILON, "{off:e}: {found:?}");
}

#[test]
fn what_is_no_number_is_no_face() {
    let knots = || vec![0.0, 0.0, 1.0, 1.0];
    for bad in [DVec4::new(f64::NAN, 0.0, 0.0, 1.0), DVec4::new(1.0, 1.0, 0.0, f64::INFINITY), DVec4::ZERO] {
        let points = vec![DVec4::W, DVec4::W, DVec4::W, bad];
        let error = Surface::new((1, 1), knots(), knots(), points).unwrap_err();
        assert!(matches!(error, SplineError::ControlPoint { index: 3 }), "{error:?}");
    }
    let line = Bezier { points: vec![DVec3::Z, DVec3::new(f64::NAN, 0.0, 1.0)] };
    assert!(matches!(TrimLoop::new(vec![line], DVec2::ONE), Err(FaceError::ControlPoint { curve: 0 })));
}

/// Placements are plain data: one that is not finite places nothing, and does not affect the others.
#[test]
fn a_placement_that_is_no_number_places_nothing() {
    let mut model = placed(&square(vec![], 1.0), DAffine3::IDENTITY);
    let alone = model.bounds();
    for bad in [f64::NAN, f64::INFINITY] {
        let transform = DAffine3::from_translation(DVec3::new(0.0, bad, 0.0));
        model.instances.push(Instance { transform, ..model.instances[0].clone() });
    }
    assert_eq!(model.bounds(), alone);
    assert_eq!(alone, Bounds { min: DVec3::Z, max: DVec3::new(4.0, 4.0, 1.0) });
}

/// Numbers at the end of their range end the search, too.
#[test]
fn huge_coordinates_end() {
    let points = (0..4).map(|k| DVec4::new(1e308 * f64::from(k % 2), -1e308 * f64::from(k / 2), 1e308, 1.0)).collect();
    let knots = vec![0.0, 0.0, 4.0, 4.0];
    let surface = Surface::new((1, 1), knots.clone(), knots, points).unwrap();
    let face = Face { surface, ..square(vec![circle(at(2.0, 2.0), 1.0)], 0.0) };
    let turned = DAffine3::from_rotation_z(0.3);
    assert!(!face.bounds().max.is_nan() && !placed(&face, turned).bounds().max.is_nan());
}

/// A mesh has the box of its triangles; a vertex of none does not count.
#[test]
fn meshes_are_their_triangles() {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::splat(100.0)];
    let mesh = Mesh::new(1, positions, vec![[0, 1, 2]], Vec::new()).unwrap();
    let part = Part { meshes: vec![mesh], ..Part::default() };
    assert_eq!(part.bounds(), Bounds { min: DVec3::ZERO, max: DVec3::new(1.0, 1.0, 0.0) });
}
