//! Whole frames by the renderer, with its barriers and its own constants, against the chain of twins:
//! what the counters say is the same.

use super::Case;
use super::chain::Chain;
use super::harness::Gpu;
use super::shapes::model_and_cameras;
use crate::headless::{HeadlessOptions, HeadlessRenderer};
use crate::picture::{FrameSettings, Outputs};

#[test]
fn a_frame_counts_what_the_twins_count() {
    let gpu = Gpu::new();
    let slack = gpu.slack();
    gpu.finish();
    let options = HeadlessOptions { device: None, validation: true };
    let mut renderer = HeadlessRenderer::new(&options).unwrap();
    let (model, cameras) = model_and_cameras();
    renderer.upload(&model).unwrap();
    for camera in &cameras {
        for tolerance_px in [0.5, 3.0] {
            let chain = Chain::new(&Case::cut(&model, camera, tolerance_px)).counters;
            let settings = FrameSettings { tolerance_px, ..Default::default() };
            let stats = renderer.render(camera, &settings, Outputs::default()).unwrap().stats;
            let on_gpu = [stats.sub_patches, stats.trim_rows, stats.trim_intercepts, stats.clamps];
            let twin = [chain.plain + chain.trimmed, chain.rows, chain.intercepts, chain.clamps].map(u64::from);
            // where a count may differ by one, a hundred rows may differ by a few
            let near = |(g, t): (&u64, &u64)| g.abs_diff(*t) <= u64::from(slack.count) * (t / 50 + 1);
            assert!(on_gpu.iter().zip(&twin).all(near), "GPU {on_gpu:?}, twins {twin:?}");
        }
    }
    let messages = renderer.shutdown();
    assert!(messages.is_empty(), "{messages:#?}");
}
