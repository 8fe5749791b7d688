//! Whole frames by the renderer, with its barriers and its own constants, against the chain of twins: the counters are
//! equal.

use super::Case;
use super::chain::Chain;
use super::harness::Gpu;
use super::shapes::model_and_cameras;
use crate::budget::Budget;
use crate::headless::{HeadlessOptions, HeadlessRenderer};
use crate::model::{Camera, Projection};
use crate::picture::{FrameSettings, Outputs};
use crate::scene::TableView;

#[test]
fn a_frame_counts_what_the_twins_count() {
    let gpu = Gpu::new();
    let slack = gpu.slack();
    gpu.finish();
    let options = HeadlessOptions { validation: true, ..Default::default() };
    let mut renderer = HeadlessRenderer::new(&options).unwrap();
    let (model, mut cameras) = model_and_cameras();
    let narrow = Camera { projection: Projection::Perspective { fov_y: 0.1 }, ..cameras[0] };
    cameras.push(narrow);
    renderer.upload(&model).unwrap();
    let mut tables = [0; 3]; // for one view, for many views, for a view cell
    for camera in &cameras {
        for tolerance_px in [0.5, 3.0] {
            let mut case = Case::cut(&model, camera, tolerance_px);
            let table = case.data.table_view(camera, Budget::of(tolerance_px).beside()).expect("faces are trimmed");
            case.frame.table_density = table.density();
            let wider = match &table {
                TableView::Of(wider) if wider != camera => Some(Case::cut(&model, wider, tolerance_px)),
                _ => None,
            };
            tables[if wider.is_some() { 2 } else { usize::from(table.density() > 0.0) }] += 1;
            let chain = Chain::with_table_of(&case, wider.as_ref().unwrap_or(&case)).counters;
            let settings = FrameSettings { tolerance_px, ..Default::default() };
            let stats = renderer.render(camera, &settings, Outputs::default()).unwrap().stats;
            let on_gpu = [stats.sub_patches, stats.trim_rows, stats.trim_intercepts, stats.clamps];
            let twin = [chain.plain + chain.trimmed, chain.rows, chain.intercepts, chain.clamps].map(u64::from);
            // if a count may differ by one, a hundred rows may differ by a few
            let near = |(g, t): (&u64, &u64)| g.abs_diff(*t) <= u64::from(slack.count) * (t / 50 + 1);
            assert!(on_gpu.iter().zip(&twin).all(near), "GPU {on_gpu:?}, twins {twin:?}");
        }
    }
    assert!(tables.iter().all(|count| *count > 0), "tables of one view, of many, of those near by: {tables:?}");
    let messages = renderer.shutdown();
    assert!(messages.is_empty(), "{messages:#?}");
}
