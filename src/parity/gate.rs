//! Parity of the pass `gate`: exact.

use super::harness::{Gpu, Mismatch, same};
use crate::abi::Counters;
use crate::frame::common::gate::Gate;
use crate::twin;

fn compare(gpu: &Gpu, given: Counters, expected: Counters) -> Result<(), Mismatch> {
    let counters = gpu.upload("counters", &[given]);
    let pass = Gate::new(gpu.device()).unwrap();
    gpu.run(|cmd| pass.record(cmd, &counters));
    same("counters", &gpu.read(&counters, 1), &[twin::gate::gate(expected)])
}

#[test]
fn parity_is_exact_and_sees_a_difference() {
    let gpu = Gpu::new();
    let words: Vec<u32> = (1..).take(size_of::<Counters>() / 4).collect();
    let full: Counters = bytemuck::pod_read_unaligned(bytemuck::cast_slice(&words));
    for failed in [0, 1, 2, 4, 8, 1024, u32::MAX] {
        let given = Counters { failed, ..full };
        compare(&gpu, given, given).unwrap();
        let other = Counters { failed: u32::from(failed == 0), ..full };
        assert_eq!(compare(&gpu, other, given).unwrap_err().buffer, "counters");
    }
    gpu.finish();
}
