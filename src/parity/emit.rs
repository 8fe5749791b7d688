//! Parity of the pass `emit`: exact. Its atomics are sums, maxima and minima.

use super::chain::{Chain, UNTOUCHED_SUB_PATCH};
use super::harness::{Gpu, Mismatch, same};
use super::shapes::{cases, four_lists};
use crate::abi::{Counters, Frame, PatchRun};
use crate::frame::tessellation::emit::{Bindings, Emit};
use crate::twin;

fn compare(gpu: &Gpu, frame: &Frame, given: &Chain, expected: &Chain) -> Result<(), Mismatch> {
    let list = vec![UNTOUCHED_SUB_PATCH; frame.sub_patch_capacity as usize];
    let (empty, zero) = twin::reset::reset(frame);
    let frame_buffer = gpu.upload("frame", &[*frame]);
    let factors = gpu.upload("factors", &given.split.factors);
    let sub_patch_starts = gpu.upload("sub-patch starts", &given.sub_patch_starts);
    let vertex_starts = gpu.upload("vertex starts", &given.vertex_starts);
    let sub_patches = gpu.upload("sub-patches", &list);
    let draws = gpu.upload("draws", &empty);
    let counters = gpu.upload("counters", &[zero]);
    let pass = Emit::new(gpu.device()).unwrap();
    let bindings = Bindings {
        frame: &frame_buffer,
        factors: &factors,
        sub_patch_starts: &sub_patch_starts,
        vertex_starts: &vertex_starts,
        sub_patches: &sub_patches,
        draws: &draws,
        counters: &counters,
        runs: &gpu.upload("runs of patch instances", &[PatchRun::default()]),
    };
    gpu.run(|cmd| pass.record(cmd, &bindings, frame.listed_patch_instances));
    let (mut twin_list, mut twin_draws, mut twin_counters) = (list, empty, Counters::default());
    twin::emit::emit(
        frame,
        &expected.split.factors,
        &expected.sub_patch_starts,
        &expected.vertex_starts,
        (&mut twin_list, &mut twin_draws),
        &mut twin_counters,
    );
    same("sub-patches", &gpu.read(&sub_patches, twin_list.len()), &twin_list)?;
    same("draws", &gpu.read(&draws, twin_draws.len()), &twin_draws)?;
    same("counters", &gpu.read(&counters, 1), &[twin_counters])
}

#[test]
fn parity() {
    for gpu in Gpu::all() {
        for case in cases() {
            let chain = Chain::new(&case);
            compare(&gpu, &case.frame, &chain, &chain).unwrap();
        }
        gpu.finish();
    }
}

/// With lists of patches that are drawn by their corners: one draw a list, many, and no room.
#[test]
fn parity_of_four_lists() {
    let gpu = Gpu::new();
    let (case, taus) = four_lists();
    let (chain, n) = (Chain::of_taus(&case, &taus), taus.len());
    let corners = chain.sub_patch_starts[4 * n] - chain.sub_patch_starts[2 * n];
    assert!(corners > 5, "{corners} patches drawn by their corners");
    let total = chain.sub_patch_starts[4 * n];
    for (draw_vertices, sub_patch_capacity) in
        [(u32::MAX, 1 << 16), (5000, 1 << 16), (25, 1 << 16), (u32::MAX, total - 3)]
    {
        let frame = Frame { draw_vertices, sub_patch_capacity, ..case.frame };
        compare(&gpu, &frame, &chain, &chain).unwrap();
    }
    // later corner patches come one draw later
    let frame = Frame { draw_vertices: 25, ..case.frame };
    let slot = (2 * n..4 * n).find(|slot| chain.split.sub_patch_counts[*slot] > 0).unwrap();
    let mut other = chain.clone();
    other.vertex_starts[slot + 1..].iter_mut().for_each(|start| *start += frame.draw_vertices);
    assert_eq!(compare(&gpu, &frame, &other, &chain).unwrap_err().buffer, "draws");
    gpu.finish();
}

#[test]
fn a_difference_is_seen() {
    let gpu = Gpu::new();
    let frame = &cases()[1].frame;
    let chain = Chain::new(&cases()[1]);
    // a patch instance in several sub-patches, plain or trimmed
    let slot = chain.split.sub_patch_counts.iter().position(|&count| count > 1).unwrap();
    let mut other = chain.clone();
    other.split.factors[slot % frame.listed_patch_instances as usize].splits += 1;
    assert_eq!(compare(&gpu, frame, &other, &chain).unwrap_err().buffer, "sub-patches");
    let mut other = chain.clone();
    // all later patch instances come one draw later
    other.vertex_starts[slot + 1..].iter_mut().for_each(|start| *start += frame.draw_vertices);
    assert_eq!(compare(&gpu, frame, &other, &chain).unwrap_err().buffer, "draws");
    gpu.finish();
}
