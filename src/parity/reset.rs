//! Parity of the pass `reset`: exact.

use super::chain::UNTOUCHED;
use super::harness::{Gpu, Mismatch, same};
use super::shapes::cases;
use crate::abi::{Counters, Frame};
use crate::frame::common::reset::{Bindings, Reset};
use crate::twin;
use crate::twin::emit::Draw;

fn compare(gpu: &Gpu, draws_only: bool, given: &Frame, expected: &Frame) -> Result<(), Mismatch> {
    let count = (expected.patch_lists() * expected.draw_capacity) as usize;
    let old = [Draw { vertex_count: UNTOUCHED, ..Default::default() }].repeat(count);
    let words = [UNTOUCHED; size_of::<Counters>() / 4];
    let old_counters: Counters = bytemuck::pod_read_unaligned(bytemuck::cast_slice(&words));
    let (frame, draws) = (gpu.upload("frame", &[*given]), gpu.upload("draws", &old));
    let counters = gpu.upload("counters", &[old_counters]);
    let pass = Reset::new(gpu.device(), draws_only).unwrap();
    let bindings = Bindings { frame: &frame, draws: &draws, counters: &counters };
    gpu.run(|cmd| pass.record(cmd, &bindings, count as u32));
    let (empty, zero) = twin::reset::reset(expected);
    let none = Counters { plain_draws: 0, trimmed_draws: 0, corner_draws: 0, trimmed_corner_draws: 0, ..old_counters };
    let left = if draws_only { none } else { zero };
    same("draws", &gpu.read(&draws, count), &empty)?;
    same("counters", &gpu.read(&counters, 1), &[left])
}

#[test]
fn parity_is_exact_and_sees_a_difference() {
    let gpu = Gpu::new();
    let case = cases().swap_remove(0);
    for (draws_only, corner_lists) in [(false, 0), (true, 0), (false, 1), (true, 2)] {
        let frame = Frame { corner_lists, ..case.frame };
        compare(&gpu, draws_only, &frame, &frame).unwrap();
        let fewer = Frame { draw_capacity: frame.draw_capacity - 1, ..frame };
        let mismatch = compare(&gpu, draws_only, &fewer, &frame).unwrap_err();
        let first = (fewer.patch_lists() * fewer.draw_capacity) as usize;
        assert_eq!((mismatch.buffer, mismatch.index), ("draws", first));
    }
    gpu.finish();
}
