//! Parity of the pass `lines`: exact; if the GPU rounds differently, a count may differ by one.

use super::chain::{Chain, UNTOUCHED};
use super::harness::{Gpu, Mismatch, counts, same};
use super::shapes::cases;
use crate::abi::{Counters, Frame};
use crate::frame::trim::lines::{Bindings, Lines};
use crate::twin;

fn compare(gpu: &Gpu, frame: &Frame, seen: &[u32], given: &[f32], expected: &[f32]) -> Result<(), Mismatch> {
    let frame_buffer = gpu.upload("frame", &[*frame]);
    let strip_heights = gpu.upload("strip heights", given);
    let strip_counts = gpu.upload("strip counts", &vec![UNTOUCHED; given.len()]);
    let counters = gpu.upload("counters", &[Counters::default()]);
    let seen_bins = gpu.upload("seen bins", seen);
    let pass = Lines::new(gpu.device(), true).unwrap();
    let bindings = Bindings {
        frame: &frame_buffer,
        strip_heights: &strip_heights,
        strip_counts: &strip_counts,
        counters: &counters,
        seen_bins: Some(&seen_bins),
    };
    gpu.run(|cmd| pass.record(cmd, &bindings, given.len() as u32));
    let mut clamps = Counters::default();
    let twin = twin::lines::lines(frame, expected, seen, &mut clamps);
    counts("strip counts", &gpu.read(&strip_counts, given.len()), &twin, gpu.slack())?;
    same("counters", &gpu.read(&counters, 1), &[clamps])
}

#[test]
fn parity() {
    let gpus = Gpu::all();
    for case in cases() {
        let density = Chain::new(&case).density;
        let seen = density.seen_bins;
        for gpu in &gpus {
            let mut heights = density.strip_heights.clone();
            compare(gpu, &case.frame, &seen, &heights, &heights).unwrap();
            heights[0] = 1e6; // more than a strip may have
            // the most that it may have; a wrong quotient may give one too many
            heights[1] = if gpu.is_exact() { 65536.0 } else { 65534.5 } * case.frame.row_px;
            compare(gpu, &case.frame, &seen, &heights, &heights).unwrap();
        }
    }
    gpus.into_iter().for_each(Gpu::finish);
}

#[test]
fn a_difference_is_seen() {
    let gpu = Gpu::new();
    let case = &cases()[0];
    let density = Chain::new(case).density;
    let (heights, seen) = (density.strip_heights, density.seen_bins);
    let mut other = heights.clone();
    other[4] += 2.0 * case.frame.row_px;
    let mismatch = compare(&gpu, &case.frame, &seen, &other, &heights).unwrap_err();
    assert_eq!((mismatch.buffer, mismatch.index), ("strip counts", 4));
    gpu.finish();
}
