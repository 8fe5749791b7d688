//! The guarantee of [`factor`](super) put to the test: from a model in `f64` through the scene's single
//! precision and the twin of pass `bound` to pixels.
//!
//! ```text
//!   ●───┬───┬───┬───●      every cell of the triangulation, cut by either diagonal, on a lattice of
//!   ├───┼───┼───┼───┤      quarters: S exactly, T linear in space between the triangle's vertices
//!   ├───┼───┼───┼───┤      (what a rasteriser interpolates with perspective correction)
//!   ├───┼───┼───┼───┤
//!   ●───┴───┴───┴───●      |pixel(T) - pixel(S)| <= deviation_px where T is in the picture
//! ```

use crate::abi::Counters;
use crate::model::{Camera, Projection};
use crate::parity::{Case, Random, placed, untrimmed};
use crate::spline::{Bezier, Control, Surface};
use crate::twin::MOST_SEGMENTS;
use crate::twin::bound::bound;
use glam::{DAffine3, DMat3, DMat4, DQuat, DVec2, DVec3, DVec4};
use rayon::prelude::*;
use std::f64::consts::TAU;

const PATCHES: u64 = 3000;
/// Lattice intervals along one side of a cell.
const FINENESS: usize = 4;
/// Cells along each side that are measured; of a finer triangulation, a random window.
const WINDOW: usize = 40;

/// A patch seen by a camera, and what pass `bound` makes of it.
struct Trial {
    surface: Surface,
    rational: bool,
    case: Case,
    /// Part to homogeneous pixels.
    to_pixels: DMat4,
    tau: [usize; 2],
    /// More segments would have been needed than a patch can have.
    clamped: bool,
}

/// What the lattice shows.
#[derive(Clone, Copy, Default)]
struct Deviation {
    /// The largest in pixels where the triangle is in the picture.
    px: f64,
    /// Points compared.
    points: usize,
    /// Every cell was measured and is in the picture.
    whole: bool,
}

impl Trial {
    fn new(seed: u64) -> Self {
        let r = &mut Random::new(seed);
        let rational = r.integer(0, 2) > 0;
        let surface = random_surface(r, rational);
        let transform = random_transform(r);
        let model = placed(vec![untrimmed(surface.clone())], transform);
        let bounds = model.bounds();
        let radius = bounds.diagonal() / 2.0;
        let direction = random_rotation(r) * DVec3::Z;
        let distance = radius * r.range(0.6f64.ln(), 12f64.ln()).exp();
        let aside = random_rotation(r) * DVec3::X * (radius * r.range(0.0, 0.6));
        let size = (r.integer(200, 2000), r.integer(200, 2000));
        let projection = match r.integer(0, 7) {
            0 => Projection::Orthographic { height: radius * r.range(0.5, 4.0) },
            _ => Projection::Perspective { fov_y: r.range(0.2, 1.6) },
        };
        let eye = bounds.centre() + direction * distance;
        let depth_range = (distance * r.range(0.02, 0.3), distance + 3.0 * radius);
        let up = random_rotation(r) * DVec3::Y;
        let camera = Camera { eye, target: bounds.centre() + aside, up, projection, depth_range, size };
        let mut case = Case::new(&model, &camera, r.pick(&[0.125, 0.5, 0.5, 2.0]));
        let mut counters = Counters::default();
        let tau = bound(&case.frame, &case.scene(), &mut counters)[0];
        // the scene cuts curved surfaces into flatter patches: the first one stands for all
        let [_, _, width, height] = case.data.patches[0].domain;
        let surface = first_piece(&surface, (1.0 / width).round() as usize, (1.0 / height).round() as usize);
        case.data.drop_uploaded();
        let tau = [tau & 0xffff, tau >> 16].map(|t| t as usize);
        let to_pixels = camera.pixel_matrix() * DMat4::from(transform);
        Self { surface, rational, case, to_pixels, tau, clamped: tau.contains(&(MOST_SEGMENTS as usize)) }
    }

    /// Homogeneous pixels `(X, Y, D, W)` of `S`, unit weight, at the lattice of `cells` cells from `first`.
    fn lattice(&self, tau: [usize; 2], first: [usize; 2], cells: [usize; 2]) -> Vec<Vec<DVec4>> {
        let grid = self.surface.patches();
        let patch = &grid.patches[0].patch;
        let at = |axis: usize, i: usize| (first[axis] * FINENESS + i) as f64 / (tau[axis] * FINENESS) as f64;
        let rows: Vec<_> = (0..=patch.degree_v).map(|j| Bezier { points: patch.row(j).to_vec() }).collect();
        let column = |i: usize| {
            let across = Bezier { points: rows.iter().map(|row| row.homogeneous(at(0, i))).collect() };
            let point = |j: usize| self.to_pixels * across.homogeneous(at(1, j)).point().extend(1.0);
            (0..=cells[1] * FINENESS).map(point).collect()
        };
        (0..=cells[0] * FINENESS).map(column).collect()
    }

    /// In the picture, between the near and the far plane.
    fn seen(&self, q: DVec4) -> bool {
        let frame = &self.case.frame;
        let inside = |x: f64, size: f32| (0.0..=f64::from(size) * q.w).contains(&x);
        let depth = f64::from(frame.near)..=f64::from(frame.far);
        q.w > 0.0 && inside(q.x, frame.size[0]) && inside(q.y, frame.size[1]) && depth.contains(&q.z)
    }

    /// Compares the triangulation of `tau` segments with the surface.
    fn measure(&self, tau: [usize; 2]) -> Deviation {
        let r = &mut Random::new(tau[0] as u64);
        let cells = tau.map(|t| t.min(WINDOW));
        let first = [0, 1].map(|a| r.integer(0, (tau[a] - cells[a]) as u32) as usize);
        let s = self.lattice(tau, first, cells);
        let mut most = Deviation { whole: cells == tau, ..Default::default() };
        for (i, j) in (0..cells[0]).flat_map(|i| (0..cells[1]).map(move |j| (i * FINENESS, j * FINENESS))) {
            let corners = [s[i][j], s[i + FINENESS][j], s[i][j + FINENESS], s[i + FINENESS][j + FINENESS]];
            for (a, b) in (0..=FINENESS).flat_map(|a| (0..=FINENESS).map(move |b| (a, b))) {
                let exact = s[i + a][j + b];
                for t in triangles_at(corners, a as f64 / FINENESS as f64, b as f64 / FINENESS as f64) {
                    if self.seen(t) && exact.w > 0.0 {
                        most.px = most.px.max(pixel(t).distance(pixel(exact)));
                        most.points += 1;
                    } else {
                        most.whole = false;
                    }
                }
            }
        }
        most
    }

    /// The deviation allowed; across the near plane, with the factor that the derivation states.
    fn allowed(&self) -> f64 {
        let frame = &self.case.frame;
        let deviation = f64::from(frame.deviation_px);
        let points = self.surface.points().iter().map(|p| (self.to_pixels * p.point().extend(1.0)).z);
        let crosses = frame.perspective != 0 && points.fold(f64::INFINITY, f64::min) < f64::from(frame.near);
        if crosses { deviation / (1.0 - deviation / f64::from(frame.focal)) } else { deviation }
    }
}

fn pixel(q: DVec4) -> DVec2 {
    DVec2::new(q.x, q.y) / q.w
}

/// The point of the cell's triangles at `(s, t)`, for one diagonal and for the other.
fn triangles_at([a, b, c, d]: [DVec4; 4], s: f64, t: f64) -> [DVec4; 2] {
    let rising = if t <= s { a + (b - a) * s + (d - b) * t } else { a + (c - a) * t + (d - c) * s };
    let falling =
        if s + t <= 1.0 { a + (b - a) * s + (c - a) * t } else { d + (c - d) * (1.0 - s) + (b - d) * (1.0 - t) };
    [rising, falling]
}

/// Degrees 1 to 5; nets from nearly flat to wild; weights up to 5 : 1.
fn random_surface(r: &mut Random, rational: bool) -> Surface {
    let (n, k) = (r.integer(1, 5) as usize, r.integer(1, 5) as usize);
    let (noise, ratio) = (r.pick(&[0.05, 0.3, 1.0]), r.pick(&[1.2f64, 5.0]));
    let mut point = |i: usize, j: usize| {
        let on_plane = DVec3::new(i as f64 / n as f64, j as f64 / k as f64, 0.0);
        let off = [0; 3].map(|_| r.range(-noise, noise));
        let weight = if rational { ratio.powf(r.range(0.0, 1.0)) } else { 1.0 };
        DVec4::from_point(on_plane + DVec3::from(off), weight)
    };
    let points = (0..=k).flat_map(|j| (0..=n).map(move |i| (i, j))).map(|(i, j)| point(i, j)).collect();
    let knots = |degree: usize| [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
    Surface::new((n, k), knots(n), knots(k), points).unwrap()
}

/// The patch at the origin of the domain when each side is cut into so many.
fn first_piece(surface: &Surface, along_u: usize, along_v: usize) -> Surface {
    let patch = &surface.patches().patches[0].patch;
    let piece = patch.rectangle((0.0, 1.0 / along_u as f64), (0.0, 1.0 / along_v as f64));
    let knots = |degree: usize| [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
    let (n, k) = surface.degrees();
    Surface::new((n, k), knots(n), knots(k), piece.points).unwrap()
}

fn random_rotation(r: &mut Random) -> DQuat {
    let (a, b, c) = (r.range(0.0, 1.0), r.range(0.0, TAU), r.range(0.0, TAU));
    let (s, t) = ((1.0 - a).sqrt(), a.sqrt());
    DQuat::from_xyzw(s * b.sin(), s * b.cos(), t * c.sin(), t * c.cos()) // K. Shoemake, 1992
}

/// Turned, moved, and as often stretched unevenly or mirrored as not.
fn random_transform(r: &mut Random) -> DAffine3 {
    let scale = if r.integer(0, 1) == 0 { DVec3::splat(r.range(0.5, 20.0)) } else { DVec3::new(2.0, -0.5, 1.0) };
    let linear = DMat3::from_quat(random_rotation(r)) * DMat3::from_diagonal(scale);
    DAffine3 { matrix3: linear, translation: DVec3::new(r.range(-9.0, 9.0), 3.0, r.range(-9.0, 9.0)) }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// 0 violations; and how much finer than needed: the square root of allowed over measured deviation,
/// which is by how much both factors could shrink.
#[test]
fn no_patch_deviates_by_more_than_the_budget() {
    let trials: Vec<(Trial, Deviation)> = (0..PATCHES)
        .into_par_iter()
        .map(|seed| {
            let trial = Trial::new(seed);
            let unseen = trial.tau[0] == 0;
            let deviation = trial.measure(if unseen { [16; 2] } else { trial.tau });
            // a patch that is left out has no point in the picture
            assert!(!unseen || deviation.points == 0, "seed {seed}: left out, but seen");
            let kept = unseen || trial.clamped || deviation.px <= trial.allowed();
            assert!(kept, "seed {seed}: {} px", deviation.px);
            (trial, deviation)
        })
        .collect();
    let drawn = trials.iter().filter(|(trial, d)| trial.tau[0] > 0 && !trial.clamped && d.points > 0).count();
    let clamped = trials.iter().filter(|(trial, _)| trial.clamped).count();
    let points: usize = trials.iter().map(|(_, d)| d.points).sum();
    assert!(drawn > 2000 && clamped < 30, "only {drawn} patches are in the picture, {clamped} clamped");
    let finer = |rational: bool| {
        let all = trials.iter().filter(|(t, d)| t.rational == rational && d.whole && t.tau != [1, 1]);
        median(all.map(|(t, d)| (t.allowed() / d.px).sqrt()).collect())
    };
    let (polynomial, rational) = (finer(false), finer(true));
    println!(
        "{drawn} patches, {points} points, {clamped} clamped, 0 violations; finer than needed: {polynomial:.2} polynomial, {rational:.2} rational"
    );
    assert!(polynomial < 2.5 && rational < 4.0, "{polynomial}, {rational}");
}

/// The test above can fail: at half the factors, many patches break the budget.
#[test]
fn half_the_factor_breaks_the_budget() {
    let broken = |seed| {
        let trial = Trial::new(seed);
        let coarse = trial.tau.map(|t| t.div_ceil(2));
        trial.tau[0] > 0 && !trial.clamped && trial.measure(coarse).px > trial.allowed()
    };
    let count = (0..300u64).into_par_iter().filter(|&seed| broken(seed)).count();
    assert!(count > 30, "only {count} of 300 patches deviate by more");
}
