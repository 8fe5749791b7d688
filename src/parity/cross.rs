//! Parity of the pass `cross`, in both steps, and so of `curve.glsl`: exact, with rows compared as sets. If the GPU
//! rounds quotients differently: within the bound of `twin::cross`, plus the lowest bit, which is the direction.

use super::Case;
use super::chain::{Chain, UNTOUCHED};
use super::harness::{Gpu, Mismatch, SceneBuffers, same};
use super::shapes::cases;
use crate::frame::trim::cross::{Bindings, Cross};
use crate::gpu::Texel;
use crate::twin;
use crate::twin::sort::from_ordered;

/// The results of the pass.
struct Left {
    row_counts: Vec<u32>,
    intercepts: Vec<u32>,
    border_cells: Vec<[u32; 4]>,
    row_windings: Vec<i32>,
}

/// One step of the pass on the GPU.
fn on_gpu(gpu: &Gpu, case: &Case, chain: &Chain, insert: bool) -> Left {
    let s = SceneBuffers::new(gpu, case);
    let before = if insert { chain.row_counts.clone() } else { vec![0; chain.row_counts.len()] };
    let starts = |name: &str, words: &[u32]| gpu.upload_texels(name, words, Texel::Words);
    let strips = gpu.upload_texels("strips", &chain.strips, Texel::U32x4);
    let segment_starts = starts("segment starts", &chain.segment_starts);
    let row_starts = starts("row starts", &chain.row_starts);
    let row_counts = gpu.upload("row counts", &before);
    let intercepts = gpu.upload("intercepts", &vec![UNTOUCHED; chain.intercepts.len()]);
    let border_cells = gpu.upload("border cells", &vec![[0u32; 4]; chain.border_cells.len()]);
    let bins = !case.data.wide_strips.is_empty();
    let row_windings = gpu.upload("row windings", &vec![0i32; chain.rows_add_up.len()]);
    let dispatches = gpu.upload("dispatches", chain.dispatches.as_flattened());
    let bindings = Bindings {
        frame: &s.frame,
        face_instances: &s.face_instances,
        faces: &s.faces,
        curves: &s.curves,
        curve_points: &s.curve_points,
        curve_instances: &s.curve_instances,
        strips: &strips,
        segment_starts: &segment_starts,
        row_starts: &row_starts,
        row_counts: &row_counts,
        intercepts: &intercepts,
        border_cells: &border_cells,
        row_windings: bins.then_some(&row_windings),
        dispatches: &dispatches,
    };
    let pass = Cross::new(gpu.device(), bins, true).unwrap();
    gpu.run(|cmd| if insert { pass.insert(cmd, &bindings) } else { pass.count(cmd, &bindings) });
    Left {
        row_counts: gpu.read(&row_counts, before.len()),
        intercepts: gpu.read(&intercepts, chain.intercepts.len()),
        border_cells: gpu.read(&border_cells, chain.border_cells.len()),
        row_windings: gpu.read(&row_windings, chain.rows_add_up.len()),
    }
}

/// The GPU gets `given`; `chain` has the twins' results for `expected`.
fn compare(gpu: &Gpu, given: &Case, (expected, chain): (&Case, &Chain)) -> Result<(), Mismatch> {
    let counted = on_gpu(gpu, given, chain, false);
    same("row counts", &counted.row_counts, &chain.row_counts)?;
    same("intercepts before inserting", &counted.intercepts, &vec![UNTOUCHED; chain.intercepts.len()])?;
    same("border cells", &counted.border_cells, &chain.border_cells)?;
    same("row windings", &counted.row_windings, &chain.rows_add_up)?;

    let left = on_gpu(gpu, given, chain, true);
    same("row counts after inserting", &left.row_counts, &vec![0; chain.row_counts.len()])?;
    let (on_gpu, twin) = (rows_sorted(chain, left.intercepts), rows_sorted(chain, chain.intercepts.clone()));
    if gpu.is_exact() {
        return same("intercepts", &on_gpu, &twin);
    }
    near(&on_gpu, &twin, &bounds(chain, twin.len(), expected))
}

fn u_of(intercept: u32) -> f32 {
    from_ordered(intercept & !1)
}

/// Allowed difference of each intercept of the sorted rows: the largest bound in its row.
fn bounds(chain: &Chain, used: usize, case: &Case) -> Vec<f32> {
    let (frame, scene) = (&case.frame, &case.scene());
    let mut of_row = vec![0.0f32; chain.row_counts.len()];
    for (row, intercept, bound) in twin::cross::bounded(frame, scene, &chain.strips, &chain.segment_starts) {
        // the lowest bit of u holds the direction
        let bound = bound + 2.0 * f32::EPSILON * u_of(intercept).abs();
        of_row[row] = of_row[row].max(bound);
    }
    let counts = chain.row_counts.iter().map(|count| *count as usize);
    let all = of_row.iter().zip(counts).flat_map(|(bound, count)| std::iter::repeat_n(*bound, count));
    all.take(used).collect()
}

/// Whether `u` is within its bound. Directions are compared in order, except for intercepts that may be interchanged
/// within their bounds.
fn near(gpu: &[u32], twin: &[u32], bounds: &[f32]) -> Result<(), Mismatch> {
    assert_eq!((gpu.len(), bounds.len()), (twin.len(), twin.len()), "intercepts");
    let off = |i: usize| (u_of(gpu[i]) - u_of(twin[i])).abs();
    let is_alone = |i: usize| {
        let beside = [i.checked_sub(1), Some(i + 1)].into_iter().flatten().filter_map(|k| twin.get(k));
        beside.into_iter().all(|other| (u_of(*other) - u_of(twin[i])).abs() > 2.0 * bounds[i])
    };
    let wrong = |i: &usize| (off(*i) > bounds[*i] || off(*i).is_nan()) || gpu[*i] & 1 != twin[*i] & 1 && is_alone(*i);
    match (0..twin.len()).find(wrong) {
        None => Ok(()),
        Some(index) => {
            let values = format!("GPU {}, twin {}, {:e} off", u_of(gpu[index]), u_of(twin[index]), off(index));
            Err(Mismatch { buffer: "intercepts", index, values })
        }
    }
}

/// The rows within the capacity, each sorted.
fn rows_sorted(chain: &Chain, mut intercepts: Vec<u32>) -> Vec<u32> {
    let room = intercepts.len();
    let ends = chain.row_starts.iter().skip(1).chain([&chain.row_total]).map(|&end| end as usize);
    let mut used = 0;
    for (&start, end) in chain.row_starts.iter().zip(ends).take_while(|&(_, end)| end <= room) {
        intercepts[start as usize..end].sort_unstable();
        used = end;
    }
    intercepts.truncate(used);
    intercepts
}

/// Moves the loops up a little, by an irregular share of their domains. Then no scan line touches a flat border or a
/// turning point of a loop, where another arithmetic may count two crossings more or less, and both are correct.
fn nudged(mut case: Case) -> Case {
    const BY: f32 = 3.77e-4;
    for curve in &mut case.data.curves {
        curve.start[1] += BY;
        curve.end[1] += BY;
    }
    // u, v and 1 times the weight
    for point in case.data.curve_points.chunks_exact_mut(3) {
        point[1] += BY * point[2];
    }
    case
}

#[test]
fn parity() {
    let gpu = Gpu::new();
    for case in cases() {
        let case = if gpu.is_exact() { case } else { nudged(case) };
        let chain = Chain::new(&case);
        let intercepts = rows_sorted(&chain, chain.intercepts.clone()).len();
        assert!(intercepts > 100, "only {intercepts} to compare");
        compare(&gpu, &case, (&case, &chain)).unwrap();
    }
    gpu.finish();
}

/// One control point is moved so that some intercept leaves its bound, another so that different lines are crossed.
#[test]
fn a_difference_is_seen() {
    let case = &nudged(cases().remove(0));
    let chain = Chain::new(case);
    let twin = rows_sorted(&chain, chain.intercepts.clone());
    let cubic = *case.data.curves.iter().find(|c| c.degree == 3).unwrap();
    let bounds = bounds(&chain, twin.len(), case);
    let second = |by: f32| {
        let mut moved = case.clone();
        moved.data.curve_points[cubic.first as usize + 3] += by;
        moved
    };
    // the smallest of these steps that moves the twin's own intercepts beyond their bounds
    let is_beyond = |by: &f32| {
        let chain = Chain::new(&second(*by));
        near(&rows_sorted(&chain, chain.intercepts.clone()), &twin, &bounds).is_err()
    };
    let beyond = (0..16).map(|k| 2f32.powi(k - 20)).find(is_beyond).expect("a step of 1/32 is seen");
    for gpu in Gpu::all() {
        let by = if gpu.is_exact() { 1e-6 } else { 2.0 * beyond };
        assert_eq!(compare(&gpu, &second(by), (case, &chain)).unwrap_err().buffer, "intercepts");
        let mut moved = case.clone();
        moved.data.curve_points[cubic.first as usize + 4] += 0.1; // and v: other lines are crossed
        assert_eq!(compare(&gpu, &moved, (case, &chain)).unwrap_err().buffer, "row counts");
        gpu.finish();
    }
}

/// Imitations change intercepts within the bounds, and most bounds are small. An imitation changes all quotients at
/// once, so an intercept near a border of bins may be counted in another row; therefore only intercepts are compared.
#[test]
fn other_arithmetic_makes_other_intercepts() {
    let case = &nudged(cases().remove(0));
    let chain = Chain::new(case);
    let twin = rows_sorted(&chain, chain.intercepts.clone());
    let bounds = bounds(&chain, twin.len(), case);
    // the others are in rows at ends of chords, and along flat chords
    let narrow = bounds.iter().filter(|bound| **bound < 1e-4).count();
    assert!(10 * narrow > 9 * bounds.len(), "{narrow} of {} bounds are small", bounds.len());
    for gpu in Gpu::all().into_iter().filter(|gpu| !gpu.is_exact()) {
        let left = rows_sorted(&chain, on_gpu(&gpu, case, &chain, true).intercepts);
        let others = left.iter().zip(&twin).filter(|(gpu, twin)| gpu != twin).count();
        let most = left.iter().zip(&twin).zip(&bounds).map(|((g, t), bound)| (u_of(*g) - u_of(*t)).abs() / bound);
        let most = most.fold(0.0, f32::max);
        assert!(most <= 1.0, "{others} of {} intercepts differ, by up to {most} of their bounds", twin.len());
        assert!(others > 0 || !gpu.device().driver().contains("llvmpipe"), "nothing is imitated");
        gpu.finish();
    }
}
