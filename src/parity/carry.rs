//! Parity of the pass `carry`: exact.

use super::Case;
use super::chain::Chain;
use super::harness::{Gpu, Mismatch, same};
use super::shapes::cases;
use crate::frame::trim::carry::{Bindings, Carry};
use crate::gpu::Texel;
use crate::twin;

fn compare(gpu: &Gpu, case: &Case, chain: &Chain, given: &[i32], expected: &[i32]) -> Result<(), Mismatch> {
    let frame = gpu.upload("frame", &[case.frame]);
    let strips = gpu.upload_texels("strips", &chain.strips, Texel::U32x4);
    let wide_strips = gpu.upload("wide strips", &case.data.wide_strips);
    let row_windings = gpu.upload("row windings", given);
    let pass = Carry::new(gpu.device()).unwrap();
    let bindings = Bindings { frame: &frame, strips: &strips, wide_strips: &wide_strips, row_windings: &row_windings };
    gpu.run(|cmd| pass.record(cmd, &bindings, case.data.wide_strips.len() as u32));
    let mut twin = expected.to_vec();
    twin::carry::carry(&case.frame, &chain.strips, &case.data.wide_strips, &mut twin);
    same("row windings", &gpu.read(&row_windings, twin.len()), &twin)
}

#[test]
fn parity() {
    let (gpus, mut carried) = (Gpu::all(), 0);
    for case in cases().into_iter().filter(|case| !case.data.wide_strips.is_empty()) {
        let chain = Chain::new(&case);
        carried += chain.row_windings.iter().filter(|&&winding| winding != 0).count();
        for gpu in &gpus {
            compare(gpu, &case, &chain, &chain.rows_add_up, &chain.rows_add_up).unwrap();
        }
    }
    assert!(carried > 100, "only {carried} rows begin inside");
    gpus.into_iter().for_each(Gpu::finish);
}

#[test]
fn a_difference_is_seen() {
    let gpu = Gpu::new();
    let case = cases().into_iter().find(|case| !case.data.wide_strips.is_empty()).expect("a case with bins");
    let chain = Chain::new(&case);
    let mut other = chain.rows_add_up.clone();
    let first = chain.strips.iter().find(|rows| rows.bins > 1).expect("a strip with bins").first as usize;
    other[first] += 1;
    assert!(compare(&gpu, &case, &chain, &other, &chain.rows_add_up).is_err());
    gpu.finish();
}
