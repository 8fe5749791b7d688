//! Times one step of one instance in a scene that is drawn already: the call that moves the instance, and the call that
//! records the frame after it. In samples/assembly.step the move should take less than a millisecond.
//!
//! `cargo bench --features headless --bench moving -- [FILE ...]`

#[path = "../examples/host_engine/picture.rs"]
mod picture;
#[path = "../examples/host_engine/vulkan.rs"]
mod vulkan;

use glam::{DAffine3, DVec3};
use selvedge::ash::vk::ImageLayout;
use selvedge::model::Camera;
use selvedge::picture::FrameSettings;
use selvedge::renderer::{FrameInput, Renderer, TargetFormats, Targets};
use std::path::{Path, PathBuf};
use std::time::Instant;

const SIZE: (u32, u32) = (480, 270);
const STEPS: usize = 60;

/// Median and worst, milliseconds.
fn spread(times: &mut [f64]) -> String {
    times.sort_by(f64::total_cmp);
    format!("{:.3} | {:.3}", times[times.len() / 2], times[times.len() - 1])
}

fn row(file: &Path) -> String {
    let model = selvedge_io::import::open(file).expect("a model").model;
    let instances = model.instances.len();
    let bounds = model.bounds();
    let engine = vulkan::Engine::new(SIZE).expect("a device");
    // SAFETY: the engine's device meets the requirements and outlives the renderer.
    let renderer = unsafe { Renderer::new(engine.lend(), TargetFormats::new(picture::FORMAT), vulkan::SLOTS) };
    let mut renderer = renderer.expect("a renderer");
    renderer.upload(&model).expect("uploaded");
    let camera = Camera::framing(&model, DVec3::new(1.0, -1.6, 1.1), DVec3::Z, 0.6, SIZE);
    let (mut changes, mut records) = (Vec::new(), Vec::new());
    for step in 0..STEPS {
        let slot = step % vulkan::SLOTS;
        engine.wait(slot).expect("waited");
        let moved = instances - 1;
        let by = DAffine3::from_translation(DVec3::X * (1e-3 * step as f64 * bounds.diagonal()));
        let begin = Instant::now();
        renderer.set_transform(moved, by * model.instances[moved].transform).expect("it may move");
        let changed = begin.elapsed();
        let cmd = engine.begin(slot).expect("recording");
        let before = if step == 0 { ImageLayout::UNDEFINED } else { ImageLayout::COLOR_ATTACHMENT_OPTIMAL };
        engine.order_drawing(cmd, before);
        let targets = Targets::new(&engine.colour);
        let input = FrameInput { camera: &camera, settings: FrameSettings::default(), slot, targets };
        let begin = Instant::now();
        // SAFETY: recording; the slot was waited for.
        unsafe { renderer.record(cmd, &input) }.expect("recorded");
        let recorded = begin.elapsed();
        engine.submit(slot).expect("submitted");
        // the first frames upload the scene and size its lists
        if step >= 10 {
            changes.push(changed.as_secs_f64() * 1e3);
            records.push(recorded.as_secs_f64() * 1e3);
        }
    }
    (0..vulkan::SLOTS).for_each(|slot| engine.wait(slot).expect("waited"));
    let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    format!("| {name} | {instances} | {} | {} |", spread(&mut changes), spread(&mut records))
}

fn main() {
    let files: Vec<PathBuf> = std::env::args().skip(1).filter(|w| w != "--bench").map(PathBuf::from).collect();
    let assembly = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples/assembly.step");
    println!(
        "| file | instances | change, ms: median | worst | record, ms: median | worst |\n|---|---:|---:|---:|---:|---:|"
    );
    for file in if files.is_empty() { vec![assembly] } else { files } {
        println!("{}", row(&file));
    }
}
