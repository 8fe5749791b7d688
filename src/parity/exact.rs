//! The exact trim test: its twin against the loops in `f64`, and parity of `exact.glsl` with its twin.

use super::Random;
use super::hard;
use crate::abi::CELL_SPLIT;
use crate::model::TrimLoop;
use crate::scene::ExactData;
use crate::spline::{Bezier, Control};
use crate::trim::{ExactTrim, LoopIndex};
use crate::twin::exact::Exact;
use glam::{DVec2, DVec3};

/// Largest distance, in the unit domain, at which the result may differ from that in `f64`: four roundings of a
/// coordinate below 1 (of a joint, and of its difference from a point, in u and in v). The error of the curve's
/// evaluation is far smaller: it is relative to the arc, and matters only near its ends.
const TOLERANCE: f64 = 4.0 / 16_777_216.0;

pub(super) fn twin(data: &ExactData) -> Exact<'_> {
    Exact { faces: &data.faces, cells: &data.cells, arcs: &data.arcs }
}

fn data(faces: &[Vec<TrimLoop>]) -> ExactData {
    let mut data = ExactData::default();
    for loops in faces {
        data.push(&ExactTrim::new(loops, DVec2::ZERO, DVec2::ONE), false);
    }
    data
}

/// A closed chain of one to five curves of degree 1 to 9. Some control points repeat and some joints share a
/// coordinate, which gives degenerate forms.
pub(super) fn random_loop(random: &mut Random) -> TrimLoop {
    let grid = random.integer(0, 3) == 0;
    let coordinate = |random: &mut Random| {
        let x = random.range(0.05, 0.95);
        if grid { (x * 16.0).round() / 16.0 } else { x }
    };
    let count = random.integer(1, 5) as usize;
    let mut curves: Vec<Vec<DVec3>> = Vec::new();
    for _ in 0..count {
        let degree = random.integer(1, 9);
        let rational = random.integer(0, 1) == 0;
        let mut points = Vec::new();
        for _ in 0..degree {
            let weight = if rational { 2f64.powf(random.range(-3.0, 3.0)) } else { 1.0 };
            let p = DVec2::new(coordinate(random), coordinate(random));
            let p = if random.integer(0, 9) == 0 { points.last().map_or(p, |q: &DVec3| q.point()) } else { p };
            points.push(DVec3::from_point(p, weight));
        }
        curves.push(points);
    }
    for i in 0..count {
        let next = curves[(i + 1) % count][0];
        curves[i].push(next);
    }
    let curves = curves.into_iter().map(|points| Bezier { points }).collect();
    TrimLoop::new(curves, DVec2::splat(1e-14)).expect("closed by construction")
}

/// Largest distance from a loop at which the twin differs from the exact loops, and the number of tested points.
fn worst_difference(seed: u64, faces: usize, points: usize) -> (f64, usize) {
    let mut random = Random::new(seed);
    let mut worst = 0.0f64;
    for _ in 0..faces {
        let loops: Vec<TrimLoop> = (0..random.integer(1, 3)).map(|_| random_loop(&mut random)).collect();
        let (index, data) = (LoopIndex::new(&loops), data(std::slice::from_ref(&loops)));
        let curves: Vec<_> = loops.iter().flat_map(TrimLoop::curves).collect();
        for k in 0..points {
            // half of them within a few 1e-6 of a curve, where results may differ
            let p = if k % 2 == 0 {
                DVec2::new(random.range(-0.05, 1.05), random.range(-0.05, 1.05))
            } else {
                let near = curves[random.integer(0, curves.len() as u32 - 1) as usize].point(random.range(0.0, 1.0));
                near + DVec2::new(random.range(-1.0, 1.0), random.range(-1.0, 1.0)) * 1e-5
            };
            let uv = p.as_vec2().to_array();
            let p = DVec2::from(uv.map(f64::from));
            let (found, exact) = (twin(&data).winding(0, uv), index.winding(p));
            if found != exact {
                let off = index.distance(p, 1.0);
                assert!(off <= TOLERANCE, "{p}: {found}, not {exact}, {off:e} from the nearest loop of {loops:?}");
                worst = worst.max(off);
            }
        }
    }
    (worst, faces * points)
}

#[test]
fn the_twin_decides_as_the_exact_loops_do() {
    let (worst, asked) = worst_difference(1, 400, 60);
    assert!(asked == 24_000 && worst > 0.0, "points next to a curve must show the rounding of single precision");
}

/// Arcs with a corner next to one of their ends, where the sides of the triangle differ by up to 2^20: points beside
/// them are as accurate as others.
#[test]
fn uneven_corners_cost_no_accuracy() {
    let mut random = Random::new(12);
    let mut asked = 0;
    for k in 0..2000 {
        let point = |random: &mut Random| DVec2::new(random.range(0.05, 0.95), random.range(0.05, 0.95));
        let (a, b, third) = (point(&mut random), point(&mut random), point(&mut random));
        let share = 2f64.powf(-random.range(1.0, 20.0));
        let share = if k % 2 == 0 { share } else { 1.0 - share };
        // within the box of both ends, so the arc is one monotone piece
        let turn = if random.integer(0, 1) == 0 { DVec2::new(a.x, b.y) } else { DVec2::new(b.x, a.y) };
        let corner = a.lerp(b, share).lerp(turn, 2f64.powf(-random.range(0.0, 10.0)));
        let weight = 2f64.powf(random.range(-3.0, 3.0));
        let points = [(a, 1.0), (corner, weight), (b, 1.0)].map(|(p, w)| DVec3::from_point(p, w));
        let arc = Bezier { points: points.to_vec() };
        let closed = vec![arc.clone(), Bezier::line(b, third), Bezier::line(third, a)];
        let loops = [TrimLoop::new(closed, DVec2::splat(1e-14)).expect("closed")];
        let (index, data) = (LoopIndex::new(&loops), data(&[loops.to_vec()]));
        for _ in 0..60 {
            let off = DVec2::new(random.range(-1.0, 1.0), random.range(-1.0, 1.0)) * 2e-6;
            let uv = (arc.point(random.range(0.0, 1.0)) + off).as_vec2().to_array();
            let p = DVec2::from(uv.map(f64::from));
            let (found, exact) = (twin(&data).winding(0, uv), index.winding(p));
            let off = index.distance(p, 1.0);
            assert!(found == exact || off <= TOLERANCE, "{p}: {found}, not {exact}, {off:e} from {loops:?}");
            asked += usize::from(off > TOLERANCE);
        }
    }
    assert!(asked > 60_000, "{asked} points are at stake");
}

/// A list is valid for every point of its box: it gives the same result as the list of the point's own cell, and as the
/// exact loops, except next to a curve, where each may round. At least a third of the points use lists of another cell,
/// and a tenth use lists with arcs; otherwise the test covers little. Most faces have split cells.
#[test]
fn lists_hold_within_their_boxes() {
    let mut random = Random::new(11);
    let (mut others, mut beside, mut asked) = (0, 0, 0);
    let mut split = 0;
    for _ in 0..300 {
        let loops: Vec<TrimLoop> = (0..random.integer(1, 3)).map(|_| random_loop(&mut random)).collect();
        let (index, data) = (LoopIndex::new(&loops), data(std::slice::from_ref(&loops)));
        split += u32::from(data.cells.iter().any(|cell| cell.first & CELL_SPLIT != 0));
        let twin = twin(&data);
        for _ in 0..100 {
            let centre = [random.range(-0.1, 1.1) as f32, random.range(-0.1, 1.1) as f32];
            let list = twin.list(0, centre);
            let [lo, hi, margin] = [list.lo, list.hi, list.margin].map(|p| DVec2::from(p.map(f64::from)));
            let [lo, hi] = [lo - margin, hi + margin].map(|p| p.clamp(DVec2::splat(-0.2), DVec2::splat(1.2)));
            // two of three in the margin
            let share = DVec2::new(random.range(0.0, 1.0), random.range(0.0, 1.0));
            let share = if random.integer(0, 2) == 0 {
                share
            } else {
                share.map(|x| if x < 0.5 { 0.3 * x } else { 1.0 - 0.3 * (1.0 - x) })
            };
            let p = (lo + share * (hi - lo)).as_vec2().to_array();
            let found = twin.winding_in(&list, p);
            let p64 = DVec2::from(p.map(f64::from));
            let off = index.distance(p64, 1.0);
            let all = [found, twin.winding(0, p), index.winding(p64)];
            assert!(off <= TOLERANCE || all == [found; 3], "{p:?} by {list:?}: {all:?}, {off:e} off {loops:?}");
            asked += 1;
            others += usize::from(twin.list(0, p) != list);
            beside += usize::from(data.arcs[list.first as usize].low != data.arcs[list.first as usize].high);
        }
    }
    assert!(split > 200, "{split} faces with split cells");
    assert!(
        3 * others > asked && 10 * beside > asked,
        "{others} by another cell's list, {beside} beside arcs, of {asked}"
    );
}

/// `tools/soak a_hundred_thousand_loops` prints the figures.
#[test]
#[ignore = "minutes: tools/soak"]
fn a_hundred_thousand_loops() {
    use rayon::prelude::*;
    let all = (0..1000u64).into_par_iter().map(|seed| worst_difference(1000 + seed, 50, 200));
    let (worst, asked) = all.reduce(|| (0.0, 0), |a, b| (a.0.max(b.0), a.1 + b.1));
    println!("{asked} points: answers differ at most {worst:e} from a loop");
}

/// Every hard case, and again with every joint moved by one unit of single precision in each direction.
#[test]
fn hard_cases() {
    for case in hard::all() {
        for (du, dv) in [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1)] {
            let loops: Vec<_> = case.loops.iter().map(|l| hard::moved(l, (du, dv))).collect();
            let (index, data) = (LoopIndex::new(&loops), data(std::slice::from_ref(&loops)));
            let mut judged = 0;
            for &(u, v, winding) in &case.rows {
                let uv = [u as f32, v as f32];
                // a row on or next to a curve is compared only where the curve is as stated
                let far = index.distance(DVec2::new(u, v), 1.0) > 1e-6;
                if (du, dv) == (0, 0) || far {
                    assert_eq!(twin(&data).winding(0, uv), winding, "{} moved {du} {dv} at ({u:e}, {v:e})", case.name);
                    judged += 1;
                }
            }
            assert!(judged > 0, "{} has no row away from its loops", case.name);
        }
    }
}

/// Lists are linear in the number of arcs, even if all arcs cross each other; and 10^4 holes take little memory.
#[test]
fn memory_is_linear_in_arcs() {
    let bytes = |loops: &[TrimLoop]| {
        let trim = ExactTrim::new(loops, DVec2::ZERO, DVec2::ONE);
        trim.bytes() as f64 / trim.arcs.len() as f64
    };
    let mut random = Random::new(7);
    let mut polygon = |corners: usize| {
        let points: Vec<DVec2> =
            (0..corners).map(|_| DVec2::new(random.range(0.0, 1.0), random.range(0.0, 1.0))).collect();
        let side = |i: usize| Bezier::line(points[i], points[(i + 1) % corners]);
        TrimLoop::new((0..corners).map(side).collect(), DVec2::ZERO).unwrap()
    };
    let (few, many) = (bytes(&[polygon(100)]), bytes(&[polygon(2000)]));
    assert!(few < 1500.0 && many < 1500.0, "{few} and {many} bytes a side of a wild polygon");
    let holes = hard::all().into_iter().find(|case| case.name == "7 holes").unwrap();
    let each = bytes(&holes.loops);
    assert!(each < 250.0, "{each} bytes a quarter circle");
}

/// `tests/gpu/glsl/exact.comp` wraps the include.
#[cfg(feature = "headless")]
mod parity {
    use super::super::harness::{Gpu, Mismatch, same};
    use super::*;
    use crate::twin::exact::FAR;

    /// Points of each face on the GPU, with the data of `given`, against the twin with `expected`.
    fn compare(gpu: &Gpu, given: &ExactData, expected: &ExactData, points: &[Vec<[f32; 2]>]) -> Result<(), Mismatch> {
        let spirv = include_bytes!("../../tests/gpu/spirv/exact.comp.spv");
        let answers = gpu.answers("exact", spirv, given, (points, [99i32; 2]));
        for ((face, points), answers) in points.iter().enumerate().zip(answers) {
            let twin: Vec<_> = (0..points.len()).map(|i| answer(twin(expected), face, points, i)).collect();
            same("answers", &answers, &twin)?;
        }
        Ok(())
    }

    /// As in `exact.comp`.
    fn answer(twin: Exact<'_>, face: usize, points: &[[f32; 2]], i: usize) -> [i32; 2] {
        let (p, q) = (points[i], points[(i + 1).min(points.len() - 1)]);
        let list = twin.list(face, if p.iter().all(|x| x.abs() < FAR) { p } else { [0.0; 2] });
        [twin.winding(face, p), if list.holds_for(q) { twin.winding_in(&list, q) } else { 99 }]
    }

    /// Rows of the hard cases, points beside the curves, and NaN.
    fn faces() -> (Vec<Vec<TrimLoop>>, Vec<Vec<[f32; 2]>>) {
        let mut random = Random::new(3);
        let mut faces: Vec<Vec<TrimLoop>> = Vec::new();
        let mut points = Vec::new();
        for case in hard::all() {
            let mut all: Vec<[f32; 2]> = case.rows.iter().map(|&(u, v, _)| [u as f32, v as f32]).collect();
            all.extend([[f32::NAN, 0.5], [0.5, f32::NAN], [-1.0, 2.0], [f32::INFINITY, 0.5]]);
            faces.push(case.loops);
            points.push(all);
        }
        faces.extend((0..30).map(|_| vec![random_loop(&mut random), random_loop(&mut random)]));
        points.resize(faces.len(), Vec::new());
        for (loops, points) in faces.iter().zip(&mut points) {
            let curves: Vec<_> = loops.iter().flat_map(TrimLoop::curves).collect();
            for _ in 0..200 {
                let curve = &curves[random.integer(0, curves.len() as u32 - 1) as usize];
                let reach = DVec2::new(random.range(-1e-3, 1e-3), random.range(-1e-3, 1e-3));
                points.push((curve.point(random.range(0.0, 1.0)) + reach * reach.x.abs()).as_vec2().to_array());
            }
        }
        (faces, points)
    }

    #[test]
    fn parity() {
        for gpu in Gpu::all() {
            let (faces, points) = faces();
            let data = data(&faces);
            compare(&gpu, &data, &data, &points).unwrap();
            gpu.finish();
        }
    }

    #[test]
    fn a_difference_is_seen() {
        let gpu = Gpu::new();
        let (faces, points) = faces();
        let data = data(&faces);
        let mut other = data.clone();
        let arc = other.arcs.iter().position(|arc| arc.fullness > 0.0).unwrap();
        other.arcs[arc].shape ^= crate::abi::ARC_UP;
        assert!(compare(&gpu, &other, &data, &points).is_err());
        gpu.finish();
    }
}
