//! Parity of the pass `bound`: exact; where the GPU rounds otherwise, a factor may differ by one.

use super::Case;
use super::chain::UNTOUCHED;
use super::harness::{Gpu, Mismatch, SceneBuffers, halves, same};
use super::shapes::cases;
use crate::abi::Counters;
use crate::passes::bound::{Bindings, Bound};
use crate::twin;

fn compare(gpu: &Gpu, given: &Case, expected: &Case) -> Result<(), Mismatch> {
    let count = given.data.items.len();
    let s = SceneBuffers::new(gpu, given);
    let taus = gpu.upload("taus", &vec![UNTOUCHED; count]);
    let counters = gpu.upload("counters", &[Counters::default()]);
    let pass = Bound::new(gpu.device()).unwrap();
    let bindings = Bindings {
        frame: &s.frame,
        views: &s.views,
        instances: &s.instances,
        face_instances: &s.face_instances,
        faces: &s.faces,
        patches: &s.patches,
        items: &s.items,
        taus: &taus,
        counters: &counters,
    };
    gpu.run(|cmd| pass.record(cmd, &bindings, count as u32));
    let mut clamps = Counters::default();
    let twin = twin::bound::bound(&expected.frame, &expected.scene(), &mut clamps);
    halves("taus", &gpu.read(&taus, count), &twin, gpu.slack())?;
    same("counters", &gpu.read(&counters, 1), &[clamps])
}

#[test]
fn parity() {
    let gpu = Gpu::new();
    for case in cases() {
        compare(&gpu, &case, &case).unwrap();
        // so tight that some factors exceed what can be split
        let mut fine = case.clone();
        fine.frame.deviation_px *= 1e-6;
        let mut counters = Counters::default();
        twin::bound::bound(&fine.frame, &fine.scene(), &mut counters);
        assert!(counters.clamps > 0);
        compare(&gpu, &fine, &fine).unwrap();
    }
    gpu.finish();
}

#[test]
fn a_difference_is_seen() {
    let gpu = Gpu::new();
    let case = &cases()[0];
    let mut bent = case.clone();
    let item = 3; // of the ball, whose patches come first
    bent.data.patches[item].bend[0] *= 16.0; // four times the factor, whatever it was
    let mismatch = compare(&gpu, &bent, case).unwrap_err();
    assert_eq!((mismatch.buffer, mismatch.index), ("taus", item));
    gpu.finish();
}
