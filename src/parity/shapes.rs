//! A small model with everything that passes treat differently, and views of it.
//!
//! ```text
//!   ball     8 rational patches, closed in u, poles         drawn plain
//!   drop     1 cubic patch whose sides u = 0, 1 coincide    drawn plain, its own neighbour
//!   sheet    3 x 2 bicubic patches, 3 loops: a rational     plain, trimmed and absent patches
//!            hole, and a cubic hole that overlaps it
//!   sieve    replaces the sheet in another model: 600 holes, so that its strips have several bins
//!   plate    1 bilinear patch, a square with a round hole   trimmed
//!
//!   placed as they are, and once mirrored, stretched and aside
//! ```

use super::Case;
use crate::model::{Camera, Face, Instance, Model, Part, Projection, SurfaceKind, TrimLoop};
use crate::spline::{Bezier, Control, Surface};
use glam::{DAffine3, DVec2, DVec3, DVec4};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

/// A circle as quarter arcs from the positive x axis: `(x, y, weight)`.
const CIRCLE: [(f64, f64, f64); 9] = [
    (1.0, 0.0, 1.0),
    (1.0, 1.0, FRAC_1_SQRT_2),
    (0.0, 1.0, 1.0),
    (-1.0, 1.0, FRAC_1_SQRT_2),
    (-1.0, 0.0, 1.0),
    (-1.0, -1.0, FRAC_1_SQRT_2),
    (0.0, -1.0, 1.0),
    (1.0, -1.0, FRAC_1_SQRT_2),
    (1.0, 0.0, 1.0),
];

/// Knots of quadratic pieces of length 1 that meet with double knots.
fn arcs(pieces: usize) -> Vec<f64> {
    let inner = (0..=pieces).flat_map(|k| [k as f64 * FRAC_PI_2; 2]);
    std::iter::once(0.0).chain(inner).chain([pieces as f64 * FRAC_PI_2]).collect()
}

fn ball(radius: f64) -> Surface {
    let rows = &CIRCLE[..5];
    let points = rows.iter().flat_map(|&(z, r, wv)| {
        CIRCLE.map(|(x, y, wu)| DVec4::from_point(DVec3::new(x * r, y * r, -z) * radius, wu * wv))
    });
    Surface::new((2, 2), arcs(4), arcs(2), points.collect()).unwrap()
}

/// A cubic that returns to its start, extruded along z.
fn drop() -> Surface {
    let section = [(0.0, 0.0), (4.0, 1.0), (1.0, 4.0), (0.0, 0.0)];
    let points = [-1.0, 2.0].iter().flat_map(|&z| section.map(|(x, y)| DVec4::new(x - 9.0, y, z, 1.0)));
    let (cubic, line) = (vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0]);
    Surface::new((3, 1), cubic, line, points.collect()).unwrap()
}

fn sheet() -> Surface {
    let point = |i: usize, j: usize| {
        let (x, y) = (i as f64 * 4.0 - 10.0, j as f64 * 4.0 - 8.0);
        DVec4::new(x, y, 5.0 + 1.5 * (0.4 * x).sin() * (0.3 * y).cos(), 1.0)
    };
    let points = (0..5).flat_map(|j| (0..6).map(move |i| point(i, j)));
    let (u, v) = ([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 2.0]);
    let clamped = |knots: &[f64]| {
        let (first, last) = (knots[0], knots[knots.len() - 1]);
        [&[first; 3], knots, &[last; 3]].concat()
    };
    Surface::new((3, 3), clamped(&u), clamped(&v), points.collect()).unwrap()
}

fn plate() -> Surface {
    let corners = [(-10.0, -10.0), (10.0, -10.0), (-10.0, 10.0), (10.0, 10.0)];
    let knots = vec![-10.0, -10.0, 10.0, 10.0];
    let points = corners.map(|(x, y)| DVec4::new(x, y, -5.0, 1.0)).to_vec();
    Surface::new((1, 1), knots.clone(), knots, points).unwrap()
}

fn polygon(corners: &[(f64, f64)]) -> TrimLoop {
    let at = |k: usize| DVec2::from(corners[k % corners.len()]);
    TrimLoop::new((0..corners.len()).map(|k| Bezier::line(at(k), at(k + 1))).collect(), DVec2::ZERO).unwrap()
}

/// Clockwise: a hole.
fn round_hole(centre: DVec2, radius: f64) -> TrimLoop {
    let at = |&(x, y, w): &(f64, f64, f64)| DVec3::from_point(centre + DVec2::new(x, y) * radius, w);
    let arcs = (0..4).map(|k| Bezier { points: CIRCLE[2 * k..2 * k + 3].iter().map(at).collect() });
    TrimLoop::new(arcs.collect(), DVec2::splat(1e-12)).unwrap().reversed()
}

/// Two cubics, clockwise.
fn bean(centre: DVec2, size: f64) -> TrimLoop {
    let at = |(x, y): (f64, f64)| (centre + DVec2::new(x, y) * size).extend(1.0);
    let curves =
        [[(-1.0, 0.0), (-0.8, 1.4), (0.6, -0.2), (1.0, 0.4)], [(1.0, 0.4), (1.2, -1.0), (-1.2, -1.3), (-1.0, 0.0)]];
    let curves = curves.map(|c| Bezier { points: c.map(at).to_vec() }).to_vec();
    TrimLoop::new(curves, DVec2::ZERO).unwrap()
}

pub(super) fn sheet_loops() -> Vec<TrimLoop> {
    vec![
        polygon(&[(0.1, 0.05), (1.9, 0.05), (1.9, 1.2), (0.9, 1.95), (0.1, 1.95)]),
        round_hole(DVec2::new(0.6, 0.6), 0.3),
        bean(DVec2::new(0.85, 0.75), 0.3),
    ]
}

/// Loops that replace those of the sheet.
pub(super) fn sieve_loops() -> Vec<TrimLoop> {
    let holes = (0..600).map(|k| {
        let at = DVec2::new(0.12 + 0.071 * f64::from(k % 40), 0.1 + 0.125 * f64::from(k / 40));
        round_hole(at, 0.03)
    });
    std::iter::once(polygon(&[(0.03, 0.02), (2.97, 0.05), (2.96, 1.97), (0.04, 1.96)])).chain(holes).collect()
}

pub(super) fn sheet_face() -> Face {
    face(3, SurfaceKind::BSpline, sheet(), sheet_loops())
}

fn face(id: u32, kind: SurfaceKind, surface: Surface, loops: Vec<TrimLoop>) -> Face {
    Face { id, kind, surface, loops, same_sense: true, colour: None }
}

/// A part of these faces, placed once.
pub(crate) fn placed(faces: Vec<Face>, transform: DAffine3) -> Model {
    Model {
        parts: vec![Part { faces, ..Default::default() }],
        instances: vec![Instance { part: 0, transform, colour: None, name: String::new() }],
        ..Default::default()
    }
}

/// A face without loops.
pub(crate) fn untrimmed(surface: Surface) -> Face {
    face(1, SurfaceKind::BSpline, surface, Vec::new())
}

fn everything() -> Model {
    let square = polygon(&[(-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0)]);
    let faces = vec![
        face(1, SurfaceKind::Sphere, ball(3.0), Vec::new()),
        face(2, SurfaceKind::Extrusion, drop(), Vec::new()),
        sheet_face(),
        face(4, SurfaceKind::Plane, plate(), vec![square, round_hole(DVec2::new(2.0, 1.0), 4.0)]),
    ];
    let mut model = placed(faces, DAffine3::IDENTITY);
    let aside = DAffine3::from_scale_rotation_translation(
        DVec3::new(-0.7, 0.9, 0.8),
        glam::DQuat::from_rotation_z(0.4),
        DVec3::new(25.0, 3.0, 1.0),
    );
    model.instances.push(Instance { transform: aside, ..model.instances[0].clone() });
    model
}

/// The model, and cameras: all of it; between ball and sheet, across the near plane; parallel.
pub(super) fn model_and_cameras() -> (Model, Vec<Camera>) {
    let model = everything();
    let bounds = model.bounds();
    let all = Camera::around(bounds, DVec3::new(1.0, -2.0, 1.5), DVec3::Z, 0.6, (480, 360));
    let mut close = all;
    (close.eye, close.target, close.size) = (DVec3::new(-5.0, -4.0, 4.5), DVec3::new(0.0, 2.0, 5.0), (320, 240));
    close.depth_range = (0.5, 100.0);
    let parallel = Camera { projection: Projection::Orthographic { height: 30.0 }, size: (300, 450), ..all };
    (model, vec![all, close, parallel])
}

/// The model with the sieve instead of the sheet.
pub(super) fn model_with_sieve() -> Model {
    let (mut model, _) = model_and_cameras();
    model.parts[0].faces[2].loops = sieve_loops();
    model
}

/// The model with each camera, then with a loose tolerance, then with no room in any list. The model with the sieve
/// follows: all of it, a part of its bins, and with too few rows. The last is the model with split patches.
pub(super) fn cases() -> Vec<Case> {
    let (model, cameras) = model_and_cameras();
    let mut cases: Vec<Case> = cameras.iter().map(|camera| Case::new(&model, camera, 0.5)).collect();
    cases.push(Case::new(&model, &cameras[0], 4.0));
    let mut tight = cases[1].clone();
    tight.frame.sub_patch_capacity = 20;
    tight.frame.draw_capacity = 2;
    tight.frame.row_capacity = 2_000;
    tight.frame.intercept_capacity = 900;
    cases.push(tight);
    let sieve = model_with_sieve();
    cases.extend(cameras[..2].iter().map(|camera| Case::new(&sieve, camera, 0.5)));
    let mut tight = cases[6].clone();
    tight.frame.row_capacity = 500;
    cases.push(tight);
    // patches of open shells are not split
    let mut solid = model;
    solid.parts.iter_mut().for_each(|part| part.closed = true);
    let cut = Case::cut(&solid, &cameras[0], 0.5);
    assert!(cut.data.patches.len() > cases[0].data.patches.len(), "nothing was cut");
    cases.push(cut);
    cases
}

/// The first case with lists of corner patches, and segments that give all four lists members: one segment for most
/// faces, many for the others, and some patches out of sight.
#[cfg(feature = "headless")]
pub(super) fn four_lists() -> (Case, Vec<u32>) {
    let mut case = cases().swap_remove(0);
    case.frame.corner_lists = 2;
    // the drop and the second ball are plain, the second plate is trimmed
    let tau = |(nth, face): (usize, &u32)| match (nth % 7, face % 3) {
        (0, _) => 0,
        (_, 1) => 3 | 70 << 16,
        _ if nth % 40 == 3 => 3 | 2 << 16,
        _ => 1 | 1 << 16,
    };
    let taus = case.data.patch_instances.iter().enumerate().map(tau).collect();
    (case, taus)
}

#[cfg(test)]
mod tests {
    use super::super::chain::Chain;
    use super::*;
    use crate::abi::{self, Side};

    /// The model is as in the figure, and each view tests something different in the passes.
    #[test]
    fn the_cases_hold_what_the_passes_tell_apart() {
        let cases = cases();
        let d = &cases[0].data;
        let sides = |side| d.patches.iter().filter(|p| p.side() == side).count();
        assert!(sides(Side::Inside) >= 9 && sides(Side::Boundary) >= 3 && sides(Side::Outside) >= 1);
        assert!(d.has_plain && d.has_trimmed && d.has_rational);
        let closed: Vec<bool> = d.faces.iter().map(|f| f.flags & abi::FACE_CLOSED_U != 0).collect();
        assert_eq!(closed, [true, true, false, false]);
        let degrees: Vec<u32> = d.curves.iter().map(|c| c.degree).collect();
        assert!([1, 2, 3].iter().all(|degree| degrees.contains(degree)));

        let chains: Vec<Chain> = cases.iter().map(Chain::new).collect();
        for chain in &chains[..4] {
            assert_eq!((chain.counters.failed, chain.counters.clamps), (0, 0), "room for everything");
            assert!(chain.counters.plain > 0 && chain.counters.trimmed > 0 && chain.counters.rows > 100);
        }
        assert!(chains[1].taus.contains(&0), "the close view leaves patches out");
        assert!(chains[1].split.factors.iter().any(|f| f.splits != 1 | 1 << 16), "and splits some");
        assert!(chains[1].counters.plain_draws > 1, "and needs several draws");
        assert_eq!(chains[4].counters.failed, 15, "every buffer of the tight case is too small");
        let seen = |chain: &Chain| chain.strips.iter().filter(|rows| rows.lines > 0).map(|rows| rows.bins).max();
        assert_eq!(cases[5].data.faces[2].bin_count(), 4);
        assert_eq!(seen(&chains[5]), Some(4), "all bins of the sieve");
        let is_part = |rows: &abi::StripRows| rows.lines > 0 && (rows.first_bin > 0 || rows.bins < 4);
        let wide =
            |chain: &Chain| cases[6].data.wide_strips.iter().any(|&strip| is_part(&chain.strips[strip as usize]));
        assert!(wide(&chains[6]), "the close view sees some of them");
        assert_eq!(chains[7].counters.failed, crate::twin::FAILED_ROWS, "too few rows");
    }
}
