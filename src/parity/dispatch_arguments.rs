//! Parity of the pass `dispatch_arguments`: exact.

use super::chain::{Chain, UNTOUCHED};
use super::harness::{Gpu, Mismatch, same};
use super::shapes::cases;
use crate::abi::{Counters, Frame};
use crate::frame::trim::dispatch_arguments::{Bindings, DispatchArguments};
use crate::twin;
use crate::twin::dispatch_arguments::MOST_SEGMENTS;

fn compare(gpu: &Gpu, frame: &Frame, seen: &[u32], given: [&[u32]; 2], expected: [&[u32]; 2]) -> Result<(), Mismatch> {
    // as earlier passes may leave them
    let before = Counters { clamps: 3, failed: 1, plain: 9, ..Default::default() };
    let frame_buffer = gpu.upload("frame", &[*frame]);
    let strip_starts = gpu.upload("strip starts", given[0]);
    let segment_starts = gpu.upload("segment starts", given[1]);
    let dispatches = gpu.upload("dispatches", &[UNTOUCHED; 9]);
    let strips = gpu.upload("strips", &vec![UNTOUCHED; 4 * frame.bin_count as usize]);
    let counters = gpu.upload("counters", &[before]);
    let seen_bins = gpu.upload("seen bins", seen);
    let pass = DispatchArguments::new(gpu.device(), true).unwrap();
    let bindings = Bindings {
        frame: &frame_buffer,
        strip_starts: &strip_starts,
        segment_starts: &segment_starts,
        dispatches: &dispatches,
        strips: &strips,
        counters: &counters,
        seen_bins: Some(&seen_bins),
    };
    gpu.run(|cmd| pass.record(cmd, &bindings, frame.bin_count));
    let mut after = before;
    let twin = twin::dispatch_arguments::dispatch_arguments(frame, expected[0], expected[1], &mut after);
    let of_strips = twin::dispatch_arguments::strips(expected[0], seen);
    same("strips", &gpu.read(&strips, of_strips.len()), &of_strips)?;
    same("dispatches", &gpu.read(&dispatches, 3), &twin)?;
    same("counters", &gpu.read(&counters, 1), &[after])
}

#[test]
fn parity() {
    let (gpus, cases) = (Gpu::all(), cases());
    let chains: Vec<_> = cases.iter().map(|case| (case, Chain::new(case))).collect();
    for gpu in &gpus {
        for (case, chain) in &chains {
            let starts = [chain.strip_starts.as_slice(), chain.segment_starts.as_slice()];
            compare(gpu, &case.frame, &chain.density.seen_bins, starts, starts).unwrap();
            // more segments than fit in one row of a dispatch, and more than 32 bits number
            for segments in [9_000_000, MOST_SEGMENTS + 1] {
                let mut many = chain.segment_starts.clone();
                *many.last_mut().unwrap() = segments;
                for most_groups in [7, 1 << 16, u32::MAX] {
                    let frame = Frame { most_groups, ..case.frame };
                    compare(gpu, &frame, &chain.density.seen_bins, [starts[0], &many], [starts[0], &many]).unwrap();
                }
            }
            let mut wrapped = chain.strip_starts.clone();
            *wrapped.last_mut().unwrap() = 0;
            compare(gpu, &case.frame, &chain.density.seen_bins, [&wrapped, starts[1]], [&wrapped, starts[1]]).unwrap();
        }
    }
    gpus.into_iter().for_each(Gpu::finish);
}

#[test]
fn a_difference_is_seen() {
    let gpu = Gpu::new();
    let case = &cases()[0];
    let chain = Chain::new(case);
    let starts = [chain.strip_starts.as_slice(), chain.segment_starts.as_slice()];
    let mut other = chain.segment_starts.clone();
    *other.last_mut().unwrap() += 1;
    let mismatch = compare(&gpu, &case.frame, &chain.density.seen_bins, [starts[0], &other], starts).unwrap_err();
    assert_eq!(mismatch.buffer, "counters");
    let mut other = chain.strip_starts.clone();
    other[1] += 1;
    let mismatch = compare(&gpu, &case.frame, &chain.density.seen_bins, [&other, starts[1]], starts).unwrap_err();
    assert_eq!(mismatch.buffer, "strips");
    gpu.finish();
}
