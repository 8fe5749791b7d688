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
    let mut tables = [0, 0]; // of one view, of many
    for camera in &cameras {
        for tolerance_px in [0.5, 3.0] {
            let mut case = Case::cut(&model, camera, tolerance_px);
            case.frame.table_density = case.data.table_density(camera).unwrap_or(0.0);
            tables[usize::from(case.frame.table_density > 0.0)] += 1;
            let chain = Chain::new(&case).counters;
            let settings = FrameSettings { tolerance_px, ..Default::default() };
            let stats = renderer.render(camera, &settings, Outputs::default()).unwrap().stats;
            let on_gpu = [stats.sub_patches, stats.trim_rows, stats.trim_intercepts, stats.clamps];
            let twin = [chain.plain + chain.trimmed, chain.rows, chain.intercepts, chain.clamps].map(u64::from);
            // where a count may differ by one, a hundred rows may differ by a few
            let near = |(g, t): (&u64, &u64)| g.abs_diff(*t) <= u64::from(slack.count) * (t / 50 + 1);
            assert!(on_gpu.iter().zip(&twin).all(near), "GPU {on_gpu:?}, twins {twin:?}");
        }
    }
    assert!(tables.iter().all(|count| *count > 0), "tables of one view and of many: {tables:?}");
    let messages = renderer.shutdown();
    assert!(messages.is_empty(), "{messages:#?}");
}
