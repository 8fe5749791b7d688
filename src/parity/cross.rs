//! Parity of the pass `cross`, both roles, and so of `curve.glsl`: exact, the rows as sets. Where the
//! GPU rounds otherwise, `u` within 24 units in the last place, and the direction bit exact.

use super::Case;
use super::chain::{Chain, UNTOUCHED};
use super::harness::{Gpu, Mismatch, SceneBuffers, floats, same};
use super::shapes::cases;
use crate::frame::trim::cross::{Bindings, Cross};
use crate::gpu::Texel;
use crate::twin::sort::from_ordered;

/// What the pass leaves.
struct Left {
    row_counts: Vec<u32>,
    intercepts: Vec<u32>,
    border_cells: Vec<[u32; 4]>,
    row_windings: Vec<i32>,
}

/// One role of the pass on the GPU.
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
        curve_items: &s.curve_items,
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

/// The GPU gets `given`; the twins' results for the true case are in `chain`.
fn compare(gpu: &Gpu, given: &Case, chain: &Chain) -> Result<(), Mismatch> {
    let counted = on_gpu(gpu, given, chain, false);
    same("row counts", &counted.row_counts, &chain.row_counts)?;
    same("intercepts before inserting", &counted.intercepts, &vec![UNTOUCHED; chain.intercepts.len()])?;
    same("border cells", &counted.border_cells, &chain.border_cells)?;
    same("row windings", &counted.row_windings, &chain.rows_add_up)?;

    let left = on_gpu(gpu, given, chain, true);
    same("row counts after inserting", &left.row_counts, &vec![0; chain.row_counts.len()])?;
    let (on_gpu, twin) = (rows_sorted(chain, left.intercepts), rows_sorted(chain, chain.intercepts.clone()));
    let directions = |words: &[u32]| words.iter().map(|w| w & 1).collect::<Vec<_>>();
    let u = |words: &[u32]| words.iter().map(|w| from_ordered(w & !1)).collect::<Vec<_>>();
    same("directions", &directions(&on_gpu), &directions(&twin))?;
    floats("intercepts", &u(&on_gpu), &u(&twin), gpu.slack())
}

/// The rows that have room, each in order, and nothing else.
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

#[test]
fn parity() {
    let gpu = Gpu::new();
    for case in cases() {
        let chain = Chain::new(&case);
        let intercepts = rows_sorted(&chain, chain.intercepts.clone()).len();
        assert!(intercepts > 100, "only {intercepts} to compare");
        compare(&gpu, &case, &chain).unwrap();
    }
    gpu.finish();
}

#[test]
fn a_difference_is_seen() {
    let gpu = Gpu::new();
    let case = &cases()[0];
    let chain = Chain::new(case);
    let cubic = *case.data.curves.iter().find(|c| c.degree == 3).unwrap();
    let mut moved = case.clone();
    moved.data.curve_points[cubic.first as usize + 3] += 1e-6; // u of the second control point
    assert_eq!(compare(&gpu, &moved, &chain).unwrap_err().buffer, "intercepts");
    let mut moved = case.clone();
    moved.data.curve_points[cubic.first as usize + 4] += 0.1; // and v: other lines are crossed
    assert_eq!(compare(&gpu, &moved, &chain).unwrap_err().buffer, "row counts");
    gpu.finish();
}
