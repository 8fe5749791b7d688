use super::*;
use crate::model::TrimLoop;
use crate::spline::{Bezier, Surface};
use glam::DVec3;

/// The square from (0, 0) to (100, 100); its parameters equal its coordinates.
fn square() -> PatchGrid {
    let point = |i: usize| DVec4::new(100.0 * (i % 2) as f64, 100.0 * (i / 2) as f64, 0.0, 1.0);
    let knots = vec![0.0, 0.0, 100.0, 100.0];
    Surface::new((1, 1), knots.clone(), knots, (0..4).map(point).collect()).unwrap().patches()
}

fn polygon(corners: &[(f64, f64)]) -> TrimLoop {
    let at = |&(x, y): &(f64, f64)| DVec3::new(x, y, 1.0);
    let next = corners.iter().cycle().skip(1);
    let sides = corners.iter().zip(next).map(|(a, b)| Bezier { points: vec![at(a), at(b)] });
    TrimLoop::new(sides.collect(), DVec2::ZERO).unwrap()
}

fn rectangle((x0, y0): (f64, f64), (x1, y1): (f64, f64)) -> TrimLoop {
    polygon(&[(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
}

/// The share of the square covered by patches of this kind.
fn share(grid: &PatchGrid, sides: &[Side], which: Side) -> f64 {
    let area = |p: &SurfacePatch| (p.u.1 - p.u.0) * (p.v.1 - p.v.0) / 1e4;
    grid.patches.iter().zip(sides).filter(|(_, side)| **side == which).map(|(p, _)| area(p)).sum()
}

/// An L with a hole, in a scene not much larger. The sides of the pieces are correct at every point, most of the square
/// needs no test, and every line saves more than it costs.
#[test]
fn most_of_a_large_face_needs_no_test() {
    let ell = [(0.0, 0.0), (100.0, 0.0), (100.0, 45.0), (45.0, 45.0), (45.0, 100.0), (0.0, 100.0)];
    let loops = [polygon(&ell), rectangle((20.0, 20.0), (24.0, 24.0))];
    let index = LoopIndex::new(&loops);
    let whole = square();
    let SubPatches { grid, sides, .. } = sub_patches(whole.clone(), &index, 200.0);
    for (p, side) in grid.patches.iter().zip(&sides) {
        for k in 0..64 {
            let at = |(a, b): (f64, f64), k: i32| a + (b - a) * (f64::from(k) + 0.5) / 8.0;
            let inside = index.contains(DVec2::new(at(p.u, k % 8), at(p.v, k / 8)));
            assert!(*side == Side::Boundary || inside == (*side == Side::Inside), "{side:?} at {:?}, {:?}", p.u, p.v);
        }
    }
    let [tested, inside, outside] = [Side::Boundary, Side::Inside, Side::Outside].map(|s| share(&grid, &sides, s));
    assert!((tested + inside + outside - 1.0).abs() < 1e-12);
    assert!(tested < 0.3 && inside > 0.5 && outside > 0.2, "{tested} tested, {inside} inside, {outside} outside");
    let px = VIEW_PX / 200.0;
    let price = |grid: &PatchGrid, sides: &[Side]| -> f64 {
        let of = |(p, side): (&SurfacePatch, &Side)| cost(*side, size(p).0 * size(p).1 * px * px);
        grid.patches.iter().zip(sides).map(of).sum()
    };
    assert!(price(&grid, &sides) < 0.5 * price(&whole, &[Side::Boundary]));
    assert!(grid.patches.len() < 150, "{} pieces", grid.patches.len());
}

#[test]
fn a_face_that_is_small_in_its_scene_stays_whole() {
    let loops = [rectangle((10.0, 10.0), (90.0, 90.0))];
    let index = LoopIndex::new(&loops);
    for extent in [2e4, f64::INFINITY, 0.0] {
        assert_eq!(sub_patches(square(), &index, extent), SubPatches::whole(square(), vec![Side::Boundary]));
    }
}

/// A patch whose holes are as dense as the finest pieces is not split.
#[test]
fn what_curves_pass_everywhere_stays_whole() {
    let hole = |n: usize| {
        let corner = DVec2::new((n % 50) as f64, (n / 50) as f64) * 2.0 + 0.5;
        rectangle(corner.into(), (corner + 1.0).into())
    };
    let loops: Vec<TrimLoop> =
        std::iter::once(rectangle((0.0, 0.0), (100.0, 100.0))).chain((0..2500).map(hole)).collect();
    assert_eq!(
        sub_patches(square(), &LoopIndex::new(&loops), 200.0),
        SubPatches::whole(square(), vec![Side::Boundary])
    );
}

/// A piece is tested if a curve is so near to it that a pixel's circle may meet the curve.
#[test]
fn pieces_beside_a_curve_are_tested() {
    // a piece ends in the middle, whatever the number of pieces
    for x in [50.0, 50.0 - 1e-3, 50.0 + 1e-3] {
        let loops = [rectangle((0.0, 0.0), (x, 100.0))];
        let SubPatches { grid, sides, .. } = sub_patches(square(), &LoopIndex::new(&loops), 200.0);
        let beside = |p: &SurfacePatch| p.u.0 <= 50.0 && p.u.1 >= 50.0;
        let all: Vec<_> = grid.patches.iter().zip(&sides).filter(|(p, _)| beside(p)).collect();
        assert!(grid.patches.len() > 4 && all.len() >= 2 && all.iter().all(|(_, side)| **side == Side::Boundary));
    }
}

/// Several patches whose ends are never removed.
#[test]
fn patches_are_cut_each_for_itself() {
    let point = |i: usize| DVec4::new([0.0, 1.0, 100.0][i % 3], 100.0 * (i / 3) as f64, 0.0, 1.0);
    let knots = vec![0.0, 0.0, 30.0, 100.0, 100.0];
    let surface = Surface::new((1, 1), knots, vec![0.0, 0.0, 1.0, 1.0], (0..6).map(point).collect()).unwrap();
    let loops = [rectangle((0.0, 0.0), (98.0, 1.0))];
    let SubPatches { grid, sides, shares } = sub_patches(surface.patches(), &LoopIndex::new(&loops), 200.0);
    assert_eq!(grid.patches.len(), sides.len());
    assert_eq!(shares.each_ref().map(Vec::len), [grid.count_u, grid.count_v]);
    for (p, share) in grid.patches.iter().zip(&shares[0]) {
        let whole = if p.u.1 <= 30.0 { 30.0 } else { 70.0 };
        assert!((p.u.1 - p.u.0 - whole * share).abs() < 1e-12, "{share} of {whole} at {:?}", p.u);
    }
    let ends: Vec<f64> = grid.patches[..grid.count_u].iter().map(|p| p.u.1).collect();
    assert!(ends[0] == 30.0 && ends.len() > 2 && ends.last() == Some(&100.0), "{ends:?}");
    assert!(ends.is_sorted() && sides.contains(&Side::Inside));
}
