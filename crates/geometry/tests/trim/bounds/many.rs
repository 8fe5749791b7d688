//! Faces with very many loops, and ruled faces, which are highest on their trim curves.

use super::support::{assert_box, assert_support};
use crate::shapes::{circle, polygon, rectangle};
use glam::{DVec2, DVec3, DVec4};
use selvedge_geometry::model::{Bounds, Face, SurfaceKind, TrimLoop};
use selvedge_geometry::spline::Surface;
use selvedge_geometry::trim::OTHER;

/// Holes along each side: their curves are more than a search may examine one by one.
const ACROSS: u32 = 130;

fn face(kind: SurfaceKind, surface: Surface, loops: Vec<TrimLoop>) -> Face {
    Face { id: 1, kind, surface, loops, same_sense: true, colour: None }
}

/// The square from 0 to 4 in a plane, with its coordinates as parameters.
fn flat() -> Surface {
    let points = (0..4).map(|k| DVec4::new(f64::from(4 * (k % 2)), f64::from(4 * (k / 2)), 0.0, 1.0)).collect();
    let knots = vec![0.0, 0.0, 4.0, 4.0];
    Surface::new((1, 1), knots.clone(), knots, points).unwrap()
}

/// Holes of two fifths of a cell's width in a square from -1 to 1, and the square's border.
fn perforated() -> Vec<TrimLoop> {
    let cell = 2.0 / f64::from(ACROSS);
    let hole = |k: u32| {
        let place = DVec2::new(f64::from(k % ACROSS), f64::from(k / ACROSS)) + 0.5;
        circle(place * cell - 1.0, 0.2 * cell).reversed()
    };
    std::iter::once(rectangle((-1.0, -1.0), (1.0, 1.0))).chain((0..ACROSS * ACROSS).map(hole)).collect()
}

/// `(x, y, -(x² + y²))`, whose middle control point is at a height of 2. The number of holes along a side is even, so
/// the top is between four of them.
#[test]
fn a_dome_with_many_holes_is_not_as_high_as_its_control_points() {
    let (line, square) = ([-1.0, 0.0, 1.0], [-1.0, 1.0, -1.0]);
    let point = |i: usize, j: usize| DVec4::new(line[i], line[j], square[i] + square[j], 1.0);
    let points = (0..9).map(|k| point(k % 3, k / 3)).collect();
    let knots = vec![-1.0, -1.0, -1.0, 1.0, 1.0, 1.0];
    let surface = Surface::new((2, 2), knots.clone(), knots, points).unwrap();
    let dome = face(SurfaceKind::BSpline, surface, perforated());
    let expected = Bounds { min: DVec3::new(-1.0, -1.0, -2.0), max: DVec3::new(1.0, 1.0, 0.0) };
    assert_box(dome.bounds(), expected, OTHER);
}

/// The plane over the square from -1 to 1, on a slant.
#[test]
fn a_plane_with_many_holes_has_the_box_of_its_border_however_it_is_placed() {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.5 * x - y));
    let points = corners.map(|p| p.extend(1.0)).to_vec();
    let knots = vec![-1.0, -1.0, 1.0, 1.0];
    let surface = Surface::new((1, 1), knots.clone(), knots, points).unwrap();
    let plane = face(SurfaceKind::Plane, surface, perforated());
    let support = |d: DVec3| corners.map(|c| d.dot(c)).into_iter().fold(f64::NEG_INFINITY, f64::max);
    assert_support(&plane, support, 1e-12);
}

/// `(x, y, -x²)`, highest along the y axis, which ends in the middle of two tongues. Beside them notches cancel the
/// border where it is tested whether the face is there, so both ends of the face are left out.
#[test]
fn a_ruled_face_is_searched_inside_where_most_of_its_ends_is_cancelled() {
    let point = |k: usize| DVec4::new([-1.0, 1.0, 3.0][k % 3], [0.0, 4.0][k / 3], [-1.0, 3.0, -9.0][k % 3], 1.0);
    let knots_u = vec![-1.0, -1.0, -1.0, 3.0, 3.0, 3.0];
    let surface = Surface::new((2, 1), knots_u, vec![0.0, 0.0, 4.0, 4.0], (0..6).map(point).collect()).unwrap();
    let notch = |u: (f64, f64), v: (f64, f64)| rectangle((u.0, v.0), (u.1, v.1)).reversed();
    let sides = [(-1.0, -0.12), (0.16, 3.0)];
    let notches = sides.into_iter().flat_map(|u| [(0.0, 0.5), (3.5, 4.0)].map(|v| notch(u, v)));
    let loops = std::iter::once(rectangle((-1.0, 0.0), (3.0, 4.0))).chain(notches).collect();
    let expected = Bounds { min: DVec3::new(-1.0, 0.0, -9.0), max: DVec3::new(3.0, 4.0, 0.0) };
    assert_box(face(SurfaceKind::Extrusion, surface, loops).bounds(), expected, OTHER);
}

/// Loops around the whole domain: the face ends at the border of its surface.
#[test]
fn a_ruled_face_without_a_curve_in_its_domain_is_its_surface() {
    let all = face(SurfaceKind::Plane, flat(), vec![polygon(&[(-9.0, -9.0), (20.0, -9.0), (-9.0, 20.0)])]);
    assert_eq!(all.bounds(), Bounds { min: DVec3::ZERO, max: DVec3::new(4.0, 4.0, 0.0) });
}
