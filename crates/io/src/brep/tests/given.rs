//! Loops that a source states in the parameters of its own spline.

use super::*;
use crate::spline::{BSpline, Bezier, Surface};
use glam::DVec4;

/// A sheet of 10 by 10 mm over `[0, 2] x [0, 5]`: 5 mm a unit of `u`, 2 mm a unit of `v`.
fn sheet() -> Surface {
    let corner = |x: f64, y: f64| DVec4::new(x, y, 0.0, 1.0);
    let points = vec![corner(0.0, 0.0), corner(10.0, 0.0), corner(0.0, 10.0), corner(10.0, 10.0)];
    Surface::new((1, 1), vec![0.0, 0.0, 2.0, 2.0], vec![0.0, 0.0, 5.0, 5.0], points).unwrap()
}

fn line(a: (f64, f64), b: (f64, f64)) -> CurveGeometry {
    let (origin, direction) = (DVec3::new(a.0, a.1, 0.0), DVec3::new(b.0 - a.0, b.1 - a.1, 0.0));
    let basis = Box::new(CurveGeometry::Line { origin, direction });
    CurveGeometry::Trimmed { basis, start: 0.0, end: 1.0, forward: true }
}

fn polygon(points: &[(f64, f64)]) -> Vec<CurveGeometry> {
    (0..points.len()).map(|i| line(points[i], points[(i + 1) % points.len()])).collect()
}

fn given(surface: &Surface, loops: &[Vec<CurveGeometry>]) -> Result<BuiltFace, BuildError> {
    let map = SurfaceMap::new(&SurfaceGeometry::BSpline(surface.clone()), TOLERANCE).unwrap();
    face_in_parameters(7, (surface, &map), loops, TOLERANCE)
}

#[test]
fn curves_are_taken_as_they_are() {
    // a rational cubic with unequal weights, its chord, and a hole; both clockwise in the source
    let arc = [(0.5, 1.0, 1.0), (0.4, 3.0, 0.7), (1.2, 4.5, 2.0), (1.7, 4.0, 1.3)];
    let points: Vec<DVec4> = arc.iter().map(|&(u, v, w)| DVec4::new(u * w, v * w, 0.0, w)).collect();
    let spline = BSpline::from_bezier(Bezier { points: points.clone() }, 3.0, 8.0).unwrap();
    let outer = vec![CurveGeometry::BSpline(spline), line((1.7, 4.0), (0.5, 1.0))];
    let hole = polygon(&[(0.9, 2.5), (0.9, 2.6), (1.0, 2.6)]);
    let built = given(&sheet(), &[hole, outer]).unwrap();
    assert_eq!((built.deviation, built.gap, built.notes.len()), (0.0, 0.0, 0));
    let areas: Vec<f64> = built.face.loops.iter().map(TrimLoop::signed_area).collect();
    assert!((areas[0] + 0.01).abs() < 1e-14 && areas[1] > 0.0, "holes run clockwise: {areas:?}");
    let drawn = built.face.loops[1].curves().find(|c| c.degree() == 3).unwrap();
    let stated = Bezier { points: points.iter().rev().map(|p| DVec3::new(p.x, p.y, p.w)).collect() };
    assert!(drawn.points.iter().zip(&stated.points).all(|(p, q)| p.distance(*q) < 1e-15), "{drawn:?}");
}

#[test]
fn short_misses_move_a_curve_and_long_ones_take_a_piece() {
    let corners = [(0.5, 1.0), (1.5, 1.0), (1.5, 4.0)];
    // in u, where 5 mm are a unit: half the tolerance, and a hundred times
    for (miss, pieces) in [(0.1 * TOLERANCE, 3), (20.0 * TOLERANCE, 4)] {
        let mut curves = polygon(&corners);
        curves[1] = line((1.5 + miss, 1.0), corners[2]);
        let built = given(&sheet(), &[curves]).unwrap();
        assert_eq!(built.face.loops[0].curves().len(), pieces, "{miss:e}");
        let moved = if pieces == 3 { 5.0 * miss } else { 0.0 };
        assert!((built.deviation - moved).abs() < 1e-15, "{:e}", built.deviation);
        let told = built.notes.iter().filter(|n| n.contains("a gap of 1.000e-4 mm between edges was closed")).count();
        assert_eq!(told, usize::from(pieces == 4), "{:?}", built.notes);
    }
    // more than a twentieth of the face
    let mut curves = polygon(&corners);
    curves[1] = line((1.5, 1.5), corners[2]);
    assert!(matches!(given(&sheet(), &[curves]), Err(BuildError::OpenLoop { face: 7, gap, .. }) if gap == 1.0));
}

#[test]
fn curves_beyond_the_border_are_put_on_it() {
    // 2e-6 units of v are 4e-6 mm
    let beyond = |by: f64| polygon(&[(0.5, -by), (1.5, -by), (1.5, 4.0)]);
    let built = given(&sheet(), &[beyond(2e-6)]).unwrap();
    assert!((built.gap - 4e-6).abs() < 1e-15 && built.deviation == 0.0, "{:e}", built.gap);
    assert!(built.face.loops[0].bounds().0.y == 0.0);
    // a hundred-thousandth of the face's diagonal of 9.4 mm
    assert!(matches!(given(&sheet(), &[beyond(6e-5)]), Err(BuildError::Surface { face: 7, .. })));
}

#[test]
fn what_bounds_nothing_is_no_face() {
    let there = (0.5, 1.0);
    let back = polygon(&[there, (1.5, 2.0)]);
    assert!(matches!(given(&sheet(), &[back]), Err(BuildError::NoArea { face: 7 })));
    let point = vec![CurveGeometry::BSpline(
        BSpline::new(1, vec![0.0, 0.0, 1.0, 1.0], vec![DVec4::new(0.5, 1.0, 0.0, 1.0); 2]).unwrap(),
    )];
    assert!(matches!(given(&sheet(), &[point]), Err(BuildError::EmptyLoop { face: 7 })));
}

/// A tube that closes in `u`: its rims are whole turns, and no loops in `(u, v)` by themselves.
#[test]
fn rims_of_a_tube_are_no_loops() {
    let ring: Vec<(f64, f64)> = vec![(3.0, 0.0), (0.0, 3.0), (-3.0, 0.0), (0.0, -3.0), (3.0, 0.0)];
    let row = |z: f64| ring.iter().map(move |&(x, y)| DVec4::new(x, y, z, 1.0)).collect::<Vec<_>>();
    let knots = vec![0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 4.0];
    let tube = Surface::new((1, 1), knots, vec![0.0, 0.0, 1.0, 1.0], [row(0.0), row(5.0)].concat()).unwrap();
    let rim = |v: f64| vec![line((0.0, v), (4.0, v))];
    assert!(matches!(given(&tube, &[rim(0.0), rim(1.0)]), Err(BuildError::OpenRim { face: 7 })));
    // with its seam there and back they are one
    let built = given(&tube, &[polygon(&[(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (0.0, 1.0)])]).unwrap();
    assert_eq!(built.face.loops[0].signed_area(), 8.0);
}
