//! Folds of surfaces against the sign of `n · v` on a fine grid, and closed forms.

use glam::{DVec2, DVec3, DVec4};
use proptest::prelude::*;
use selvedge_geometry::construct::shapes;
use selvedge_geometry::model::{Camera, Projection};
use selvedge_geometry::silhouette::{Fold, Silhouette};
use selvedge_geometry::spline::{Control, PatchGrid, Surface};

fn parallel(from: DVec3) -> Camera {
    Camera {
        eye: from.normalize() * 10.0,
        target: DVec3::ZERO,
        up: from.any_orthogonal_vector(),
        projection: Projection::Orthographic { height: 3.0 },
        depth_range: (0.1, 100.0),
        size: (600, 600),
    }
}

fn points(fold: &Fold) -> Vec<DVec2> {
    (0..=fold.length() * 32).map(|k| fold.at(k as f64 / 32.0).uv).collect()
}

/// `n · v` of the surface, unit normal.
fn facing(grid: &PatchGrid, uv: DVec2, v: DVec3) -> f64 {
    let jet = grid.jet(uv.x, uv.y);
    jet.du.cross(jet.dv).normalize_or_zero().dot(v)
}

/// From a point to the stretch between two others.
fn from_side(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let share = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    p.distance(a + along * if share.is_nan() { 0.0 } else { share })
}

/// Every side of a grid across which the sign of `n · v` changes has a fold beside it, and every fold point is one.
#[track_caller]
fn as_a_grid_has_it(surface: &Surface, from: DVec3, cells: u32) -> usize {
    let grid = surface.patches();
    let found = Silhouette::new(&grid, &parallel(from).pixel_matrix());
    let v = from.normalize();
    let all: Vec<DVec2> = found.folds.iter().flat_map(points).collect();
    for uv in &all {
        assert!(facing(&grid, *uv, v).abs() < 1e-6, "{uv}: {}", facing(&grid, *uv, v));
    }
    let ((u0, u1), (v0, v1)) = surface.domain();
    let size = DVec2::new(u1 - u0, v1 - v0);
    let at = |i: u32, j: u32| DVec2::new(u0, v0) + size * DVec2::new(f64::from(i), f64::from(j)) / f64::from(cells);
    let step = size / f64::from(cells);
    // points of a steep branch are farther apart than cells: the stretches between them count
    let lines: Vec<Vec<DVec2>> =
        found.folds.iter().map(|fold| points(fold).iter().map(|uv| *uv / step).collect()).collect();
    let from_fold = |p: DVec2| {
        let sides = lines.iter().flat_map(|line| line.windows(2));
        sides.map(|side| from_side(p, side[0], side[1])).fold(f64::INFINITY, f64::min)
    };
    for (i, j) in (0..cells * cells).map(|k| (k % cells, k / cells)) {
        let here = at(i, j);
        for other in [at(i + 1, j), at(i, j + 1)] {
            let (a, b) = (facing(&grid, here, v), facing(&grid, other, v));
            if a * b < 0.0 {
                let middle = 0.5 * (here + other);
                assert!(from_fold(middle / step) < 1.5, "no fold beside {middle}: {a} and {b}");
            }
        }
    }
    found.folds.len()
}

#[test]
fn a_ball_folds_once_around() {
    let part = shapes::sphere(1.0).unwrap().part;
    let surface = &part.faces[0].surface;
    for from in [DVec3::new(1.0, 2.0, 0.7), DVec3::new(-0.3, 0.2, 0.1)] {
        let folds = Silhouette::new(&surface.patches(), &parallel(from).pixel_matrix()).folds;
        let grid = surface.patches();
        for p in folds.iter().flat_map(points).map(|uv| grid.point(uv.x, uv.y)) {
            assert!(p.dot(from.normalize()).abs() < 1e-12 && (p.length() - 1.0).abs() < 1e-12, "{p}");
        }
        as_a_grid_has_it(surface, from, 60);
    }
    // from above the fold is the equator, which is the side of all patches
    let folds = Silhouette::new(&surface.patches(), &parallel(DVec3::Z).pixel_matrix()).folds;
    let grid = surface.patches();
    let length: f64 = folds
        .iter()
        .map(|f| {
            points(f).windows(2).map(|w| grid.point(w[0].x, w[0].y).distance(grid.point(w[1].x, w[1].y))).sum::<f64>()
        })
        .sum();
    assert!((length - std::f64::consts::TAU).abs() < 1e-2, "{length}");
}

/// A bicubic sheet, flat but for its height at one control point.
fn bump(height: f64) -> Surface {
    let count = 24;
    let knots: Vec<f64> =
        [vec![0.0; 3], (0..=count - 3).map(|k| k as f64).collect(), vec![(count - 3) as f64; 3]].concat();
    let point = |i: usize, j: usize| {
        let z = if (i, j) == (15, 9) { height } else { 0.0 };
        DVec4::from_point(DVec3::new(i as f64 / 12.0 - 1.0, j as f64 / 12.0 - 1.0, z), 1.0)
    };
    let points = (0..count).flat_map(|j| (0..count).map(move |i| point(i, j))).collect();
    Surface::new((3, 3), knots.clone(), knots, points).unwrap()
}

/// The loop is a two-hundredth of the sheet; from a little higher it is not there.
#[test]
fn a_small_closed_fold_is_not_missed() {
    let surface = bump(0.08);
    let steepness = (1..40).map(|k| f64::from(k) * 0.05).find(|z| {
        Silhouette::new(&surface.patches(), &parallel(DVec3::new(1.0, 0.3, *z)).pixel_matrix()).folds.is_empty()
    });
    let none = steepness.expect("seen from high above nothing folds");
    // between the last view with a fold and the first without there is one with as small a fold as we like
    let (mut low, mut high) = (none - 0.05, none);
    for _ in 0..14 {
        let middle = 0.5 * (low + high);
        let found = Silhouette::new(&surface.patches(), &parallel(DVec3::new(1.0, 0.3, middle)).pixel_matrix());
        if found.folds.is_empty() { high = middle } else { low = middle }
    }
    let from = DVec3::new(1.0, 0.3, low);
    let found = Silhouette::new(&surface.patches(), &parallel(from).pixel_matrix());
    assert_eq!((found.folds.len(), found.unresolved), (1, 0));
    let all = points(&found.folds[0]);
    assert_eq!(all[0], all[all.len() - 1], "closed");
    let (lo, hi) = all.iter().fold((all[0], all[0]), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
    assert!((hi - lo).max_element() < 0.21, "{}: a hundredth of the domain", hi - lo);
    let grid = surface.patches();
    assert!(all.iter().all(|uv| facing(&grid, *uv, from.normalize()).abs() < 1e-9));
}

/// The same bump from the side has a fold as the grid has it.
#[test]
fn a_bump_folds_as_a_grid_has_it() {
    for z in [0.05, 0.1, 0.2] {
        assert!(as_a_grid_has_it(&bump(0.3), DVec3::new(1.0, 0.3, z), 210) >= 1);
    }
}

#[test]
fn what_is_seen_edge_on_or_faces_the_eye_has_no_fold() {
    let flat = bump(0.0);
    for from in [DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Z, DVec3::new(1.0, 2.0, 3.0)] {
        let found = Silhouette::new(&flat.patches(), &parallel(from).pixel_matrix());
        assert_eq!((found.folds.len(), found.unresolved), (0, 0), "{from}");
    }
    // a cylinder along the view is edge-on as well
    let part = shapes::cylinder(0.8, 1.0).unwrap().part;
    for face in &part.faces {
        assert!(Silhouette::new(&face.surface.patches(), &parallel(DVec3::Z).pixel_matrix()).folds.is_empty());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]
    /// Rational patches of any degree that bend both ways.
    #[test]
    fn patches_fold_as_a_grid_has_it(
        (n, k) in (2..=4usize, 2..=4usize), rational in any::<bool>(),
        moved in prop::collection::vec((-0.2..0.2f64, -0.2..0.2f64, -0.8..0.8f64, 0.5..2.0f64), 25),
        from in (-1.0..1.0f64, -1.0..1.0f64, 0.05..1.0f64),
    ) {
        let point = |(c, &(x, y, z, w)): (usize, &(f64, f64, f64, f64))| {
            let (i, j) = ((c % (n + 1)) as f64, (c / (n + 1)) as f64);
            let at = DVec3::new(2.0 * i / n as f64 - 1.0 + x, 2.0 * j / k as f64 - 1.0 + y, z);
            DVec4::from_point(at, if rational { w } else { 1.0 })
        };
        let points: Vec<DVec4> = moved.iter().take((n + 1) * (k + 1)).enumerate().map(point).collect();
        let knots = |d: usize| [vec![0.0; d + 1], vec![1.0; d + 1]].concat();
        let surface = Surface::new((n, k), knots(n), knots(k), points).unwrap();
        as_a_grid_has_it(&surface, DVec3::new(from.0, from.1, from.2), 80);
    }
}
