//! Parity of the pass `lines`: exact; where the GPU rounds otherwise, a count may differ by one.

use super::chain::{Chain, UNTOUCHED};
use super::harness::{Gpu, Mismatch, counts, same};
use super::shapes::cases;
use crate::abi::{Counters, Frame};
use crate::passes::lines::{Bindings, Lines};
use crate::twin;

fn compare(gpu: &Gpu, frame: &Frame, given: &[f32], expected: &[f32]) -> Result<(), Mismatch> {
    let frame_buffer = gpu.upload("frame", &[*frame]);
    let strip_heights = gpu.upload("strip heights", given);
    let line_counts = gpu.upload("line counts", &vec![UNTOUCHED; given.len()]);
    let counters = gpu.upload("counters", &[Counters::default()]);
    let pass = Lines::new(gpu.device()).unwrap();
    let bindings = Bindings {
        frame: &frame_buffer,
        strip_heights: &strip_heights,
        line_counts: &line_counts,
        counters: &counters,
    };
    gpu.run(|cmd| pass.record(cmd, &bindings, given.len() as u32));
    let mut clamps = Counters::default();
    let twin = twin::lines::lines(frame, expected, &mut clamps);
    counts("line counts", &gpu.read(&line_counts, given.len()), &twin, gpu.slack())?;
    same("counters", &gpu.read(&counters, 1), &[clamps])
}

#[test]
fn parity() {
    let gpu = Gpu::new();
    for case in cases() {
        let mut heights = Chain::new(&case).density.strip_heights;
        compare(&gpu, &case.frame, &heights, &heights).unwrap();
        heights[0] = 1e6; // more than a strip can have
        heights[1] = 65536.0 * case.frame.row_px; // as many as it can have
        compare(&gpu, &case.frame, &heights, &heights).unwrap();
    }
    gpu.finish();
}

#[test]
fn a_difference_is_seen() {
    let gpu = Gpu::new();
    let case = &cases()[0];
    let heights = Chain::new(case).density.strip_heights;
    let mut other = heights.clone();
    other[4] += 2.0 * case.frame.row_px;
    let mismatch = compare(&gpu, &case.frame, &other, &heights).unwrap_err();
    assert_eq!((mismatch.buffer, mismatch.index), ("line counts", 4));
    gpu.finish();
}
