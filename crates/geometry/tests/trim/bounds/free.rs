//! Spline faces: a dome with holes, and random ones against a search that shares no code with the box's.

use super::support::{assert_box, assert_support, placed};
use crate::shapes::{at, circle, rectangle};
use glam::{DAffine3, DQuat, DVec2, DVec3, DVec4};
use proptest::prelude::*;
use selvedge_geometry::model::{Bounds, Face, SurfaceKind, TrimLoop};
use selvedge_geometry::spline::{Bezier, Control, PatchGrid, Surface};
use selvedge_geometry::trim::{LoopIndex, OTHER};
use std::f64::consts::TAU;

fn face(surface: Surface, loops: Vec<TrimLoop>) -> Face {
    Face { id: 1, kind: SurfaceKind::BSpline, surface, loops, same_sense: true, colour: None }
}

/// `(x, y, -(x² + y²))` over the square from -1 to 1.
fn dome(loops: Vec<TrimLoop>) -> Face {
    // the products of (-1, 0, 1), and the sums of (-1, 1, -1) for -x², Bernstein coefficients of degree 2
    let (line, square) = ([-1.0, 0.0, 1.0], [-1.0, 1.0, -1.0]);
    let point = |i: usize, j: usize| DVec4::new(line[i], line[j], square[i] + square[j], 1.0);
    let points = (0..9).map(|k| point(k % 3, k / 3)).collect();
    let knots = vec![-1.0, -1.0, -1.0, 1.0, 1.0, 1.0];
    face(Surface::new((2, 2), knots.clone(), knots, points).unwrap(), loops)
}

fn dome_box(radius: f64, top: f64) -> Bounds {
    Bounds { min: DVec3::new(-radius, -radius, -2.0 * radius * radius), max: DVec3::new(radius, radius, top) }
}

#[test]
fn holes_cut_the_top_away() {
    let outer = || rectangle((-0.9, -0.9), (0.9, 0.9));
    let cases = [
        (vec![], 1.0, 0.0),
        (vec![outer()], 0.9, 0.0),
        (vec![outer(), circle(at(0.0, 0.0), 0.4).reversed()], 0.9, -0.16),
        // a square hole is nearest to the top in the middle of its sides
        (vec![outer(), rectangle((-0.3, -0.5), (0.5, 0.5)).reversed()], 0.9, -0.09),
        // beside the top, and with its rim through it
        (vec![outer(), circle(at(0.5, 0.1), 0.2).reversed()], 0.9, 0.0),
        (vec![outer(), circle(at(0.4, 0.0), 0.4).reversed()], 0.9, 0.0),
    ];
    for (loops, radius, top) in cases {
        assert_box(dome(loops).bounds(), dome_box(radius, top), OTHER);
    }
}

/// `d · x` on the disc is highest where the dome is level, or else on the rim.
#[test]
fn a_round_piece_of_a_dome_in_every_direction() {
    const R: f64 = 0.8;
    let support = |d: DVec3| {
        let across = d.truncate();
        let level = across / (2.0 * d.z);
        if d.z > 0.0 && level.length() < R {
            across.length_squared() / (4.0 * d.z)
        } else {
            R * across.length() - d.z * R * R
        }
    };
    assert_support(&dome(vec![circle(at(0.0, 0.0), R)]), support, OTHER);
}

/// Loops may lie beyond the surface: it ends at its own border.
#[test]
fn a_loop_beyond_the_domain_ends_at_its_border() {
    let found = dome(vec![rectangle((-3.0, -0.5), (0.25, 7.0))]).bounds();
    let expected = Bounds { min: DVec3::new(-1.0, -0.5, -2.0), max: DVec3::new(0.25, 1.0, 0.0) };
    assert_box(found, expected, OTHER);
}

/// A ridge where patches meet is highest without being level.
#[test]
fn a_roof_of_two_patches() {
    let profile = [(0.0, 0.0), (1.0, 2.0), (2.0, 1.0)];
    let points = [0.0, 5.0].into_iter().flat_map(|y| profile.map(|(x, z)| DVec4::new(x, y, z, 1.0))).collect();
    let surface = Surface::new((1, 1), vec![0.0, 0.0, 1.0, 2.0, 2.0], vec![0.0, 0.0, 1.0, 1.0], points).unwrap();
    let roof = face(surface, vec![rectangle((0.25, 0.25), (1.75, 0.75))]);
    let expected = Bounds { min: DVec3::new(0.25, 1.25, 0.5), max: DVec3::new(1.75, 3.75, 2.0) };
    assert_box(roof.bounds(), expected, 1e-12);
}

/// Bicubic, rational, two by two patches that meet smoothly.
fn random_surface() -> impl Strategy<Value = Surface> {
    let bump = prop::collection::vec((-1f64..1.0, prop_oneof![Just(1.0), 0.3f64..3.0]), 25);
    bump.prop_map(|bumps| {
        let point = |k: usize| {
            let (z, w) = bumps[k];
            DVec4::from_point(DVec3::new((k % 5) as f64, (k / 5) as f64, z), w)
        };
        let knots = vec![0.0, 0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 1.0];
        Surface::new((3, 3), knots.clone(), knots, (0..25).map(point).collect()).unwrap()
    })
}

/// A star around a place, of cubic arcs.
fn star(centre: DVec2, radii: &[f64]) -> TrimLoop {
    let n = radii.len();
    let at = |i: usize, share: f64| {
        let angle = TAU * (i as f64 + share) / n as f64;
        centre + (radii[i % n] * (1.0 - share) + radii[(i + 1) % n] * share) * DVec2::from_angle(angle)
    };
    let arc = |i: usize| {
        let next = (i + 1) % n;
        let points = [at(i, 0.0), at(i, 0.3) * 1.1 - 0.1 * centre, at(i, 0.6), at(next, 0.0)];
        Bezier { points: points.map(|p| DVec3::from_point(p, 1.0)).to_vec() }
    };
    TrimLoop::new((0..n).map(arc).collect(), DVec2::splat(1e-12)).unwrap()
}

fn random_loops() -> impl Strategy<Value = Vec<TrimLoop>> {
    let outer = prop::collection::vec(0.2f64..0.6, 3..7);
    let hole = prop::collection::vec(0.03f64..0.15, 3..5);
    (outer, prop::option::of(hole)).prop_map(|(outer, hole)| {
        let rim = star(DVec2::splat(0.5), &outer);
        [rim].into_iter().chain(hole.map(|hole| star(DVec2::new(0.45, 0.5), &hole).reversed())).collect()
    })
}

/// The highest point of the face along a direction, by steps uphill from the best of many starts.
struct Climb<'a> {
    grid: &'a PatchGrid,
    index: &'a LoopIndex,
    along: DVec3,
}

impl Climb<'_> {
    fn height(&self, p: DVec2) -> f64 {
        self.along.dot(self.grid.point(p.x, p.y))
    }

    fn keeps(&self, p: DVec2) -> bool {
        p.cmpge(DVec2::ZERO).all() && p.cmple(DVec2::ONE).all() && self.index.contains(p)
    }

    fn over(&self, mut p: DVec2, mut step: f64) -> f64 {
        let mut best = self.height(p);
        while step > 1e-9 {
            let steps = (0..8).map(|k| p + step * DVec2::from_angle(TAU * f64::from(k) / 8.0));
            let higher =
                steps.filter(|q| self.keeps(*q)).map(|q| (self.height(q), q)).max_by(|a, b| a.0.total_cmp(&b.0));
            match higher {
                Some((height, q)) if height > best => (best, p) = (height, q),
                _ => step *= 0.5,
            }
        }
        best
    }

    fn along(&self, curve: &Bezier<DVec3>, mut t: f64, mut step: f64) -> f64 {
        let height = |t: f64| {
            let p = curve.point(t);
            let on = p.cmpge(DVec2::ZERO).all() && p.cmple(DVec2::ONE).all();
            if on { self.height(p) } else { f64::NEG_INFINITY }
        };
        let mut best = height(t);
        while step > 1e-9 {
            let higher =
                [t - step, t + step].into_iter().filter(|t| (0.0..=1.0).contains(t)).find(|t| height(*t) > best);
            match higher {
                Some(at) => (best, t) = (height(at), at),
                None => step *= 0.5,
            }
        }
        best
    }
}

const SIDE: u32 = 24;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// No point inside the loops is beyond the box, and each side touches one.
    #[test]
    fn boxes_hold_and_touch(surface in random_surface(), loops in random_loops(), angle in 0f64..TAU, tilt in -1f64..1.0) {
        let turn = DAffine3::from_quat(DQuat::from_rotation_z(angle) * DQuat::from_rotation_x(tilt));
        let face = face(surface, loops);
        let bounds = placed(&face, turn).bounds();
        let off = OTHER * bounds.diagonal();
        let (grid, index) = (face.surface.patches(), LoopIndex::new(&face.loops));
        for axis in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z] {
            let climb = Climb { grid: &grid, index: &index, along: turn.matrix3.transpose() * axis };
            let side = if axis.element_sum() > 0.0 { bounds.max.dot(axis) } else { bounds.min.dot(axis) };
            let share = |k: u32| (f64::from(k) + 0.5) / f64::from(SIDE);
            let starts = (0..SIDE * SIDE).map(|k| DVec2::new(share(k % SIDE), share(k / SIDE)));
            let mut starts: Vec<(f64, DVec2)> = starts.filter(|p| climb.keeps(*p)).map(|p| (climb.height(p), p)).collect();
            starts.sort_by(|a, b| b.0.total_cmp(&a.0));
            let inner = starts.iter().take(8).map(|s| climb.over(s.1, 0.5 / f64::from(SIDE)));
            let curves: Vec<Bezier<DVec3>> = face.loops.iter().flat_map(|l| l.curves()).collect();
            let rim = curves.iter().flat_map(|c| (0..=32).map(|k| climb.along(c, f64::from(k) / 32.0, 1.0 / 64.0)));
            let highest = inner.chain(rim).fold(f64::NEG_INFINITY, f64::max);
            prop_assert!(highest <= side + off, "{} is beyond {} along {}", highest, side, axis);
            prop_assert!(highest >= side - 2.0 * off, "nothing is near {} along {}, but {}", side, axis, highest);
        }
    }
}
