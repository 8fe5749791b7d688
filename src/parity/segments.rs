//! Parity of the pass `segments`: exact; if the GPU rounds differently, a count may differ by one.

use super::Case;
use super::chain::{Chain, UNTOUCHED};
use super::harness::{Gpu, Mismatch, SceneBuffers, counts};
use super::shapes::cases;
use crate::frame::trim::segments::{Bindings, Segments};
use crate::gpu::Texel;
use crate::twin;

fn compare(gpu: &Gpu, given: &Case, expected: &Case, chain: &Chain) -> Result<(), Mismatch> {
    let n = given.data.curve_instances.len();
    let s = SceneBuffers::new(gpu, given);
    let face_speeds = gpu.upload("face speeds", &chain.density.face_speeds);
    let strip_starts = gpu.upload_texels("strip starts", &chain.strip_starts, Texel::Words);
    let segment_counts = gpu.upload("segment counts", &vec![UNTOUCHED; n]);
    let bins = !given.data.wide_strips.is_empty();
    let seen_bins = gpu.upload("seen bins", &chain.density.seen_bins);
    let pass = Segments::new(gpu.device(), bins).unwrap();
    let bindings = Bindings {
        frame: &s.frame,
        face_instances: &s.face_instances,
        faces: &s.faces,
        curves: &s.curves,
        curve_instances: &s.curve_instances,
        strip_starts: &strip_starts,
        face_speeds: &face_speeds,
        segment_counts: &segment_counts,
        seen_bins: bins.then_some(&seen_bins),
    };
    gpu.run(|cmd| pass.record(cmd, &bindings, n as u32));
    let scene = expected.scene();
    let twin = twin::segments::segments(&expected.frame, &scene, &chain.density, &chain.strip_starts);
    counts("segment counts", &gpu.read(&segment_counts, n), &twin, gpu.slack())
}

#[test]
fn parity() {
    let gpus = Gpu::all();
    for case in cases() {
        let chain = Chain::new(&case);
        let mut fine = case.clone(); // more segments than a curve may have
        fine.frame.chord_px *= 1e-12;
        for gpu in &gpus {
            compare(gpu, &case, &case, &chain).unwrap();
            compare(gpu, &fine, &fine, &chain).unwrap();
        }
    }
    gpus.into_iter().for_each(Gpu::finish);
}

#[test]
fn a_difference_is_seen() {
    let gpu = Gpu::new();
    let case = &cases()[0];
    let mut bent = case.clone();
    let curve_instance = case.data.curves.iter().position(|c| c.degree == 3).unwrap();
    bent.data.curves[curve_instance].bend[0] *= 4.0;
    let mismatch = compare(&gpu, &bent, case, &Chain::new(case)).unwrap_err();
    assert_eq!(mismatch.index, curve_instance);
    gpu.finish();
}
