//! Parity of the pass `reset`: exact.

use super::chain::UNTOUCHED;
use super::harness::{Gpu, Mismatch, same};
use super::shapes::cases;
use crate::abi::{Counters, Frame};
use crate::passes::reset::{Bindings, Reset};
use crate::twin;
use crate::twin::emit::Draw;

fn compare(gpu: &Gpu, given: &Frame, expected: &Frame) -> Result<(), Mismatch> {
    let count = 2 * expected.draw_capacity as usize;
    let old = [Draw { vertex_count: UNTOUCHED, ..Default::default() }].repeat(count);
    let (frame, draws) = (gpu.upload("frame", &[*given]), gpu.upload("draws", &old));
    let counters = gpu.upload("counters", &[UNTOUCHED; size_of::<Counters>() / 4]);
    let pass = Reset::new(gpu.device(), false).unwrap();
    let bindings = Bindings { frame: &frame, draws: &draws, counters: &counters };
    gpu.run(|cmd| pass.record(cmd, &bindings, count as u32));
    let (empty, zero) = twin::reset::reset(expected);
    same("draws", &gpu.read(&draws, count), &empty)?;
    same("counters", &gpu.read(&counters, 1), &[zero])
}

#[test]
fn parity_is_exact_and_sees_a_difference() {
    let gpu = Gpu::new();
    let frame = cases()[0].frame;
    compare(&gpu, &frame, &frame).unwrap();
    let fewer = Frame { draw_capacity: frame.draw_capacity - 1, ..frame };
    let mismatch = compare(&gpu, &fewer, &frame).unwrap_err();
    assert_eq!((mismatch.buffer, mismatch.index), ("draws", 2 * fewer.draw_capacity as usize));
    gpu.finish();
}
