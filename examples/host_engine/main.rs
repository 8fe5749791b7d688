//! A small engine of its own, in plain ash. It clears its picture, lets the renderer draw over it, and moves one instance
//! a frame, two frames in flight.
//!
//! `cargo run --release --features headless --example host_engine -- samples/assembly.step 1000`

mod picture;
mod pixels;
mod vulkan;

use picture::FORMAT;
use selvedge::ash::vk;
use selvedge::glam::{DAffine3, DVec3};
use selvedge::model::Camera;
use selvedge::picture::FrameSettings;
use selvedge::renderer::{FrameInput, Renderer, TargetFormats, Targets};
use std::error::Error;
use std::path::Path;
use std::time::{Duration, Instant};
use vulkan::{Engine, SLOTS};

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [file, frames] = &args[..] else { return Err("usage: host_engine FILE FRAMES".into()) };
    let Run { changing, recording, whole, .. } = run(file.as_ref(), frames.parse()?, (320, 240))?;
    println!("one step of one instance: {changing:.1} us to change it, {recording:.1} us to record the frame");
    println!("{whole} of {frames} frames were whole");
    Ok(())
}

/// Of all frames.
pub struct Run {
    /// Microseconds a step takes to change the instance.
    pub changing: f64,
    /// And to record the frame.
    pub recording: f64,
    /// Frames that had room for all they wanted.
    pub whole: usize,
    /// The picture of the last one, row 0 on top: sRGB and opacity.
    pub pixels: Vec<[u8; 4]>,
}

/// Draws so many frames of a file, at least one.
pub fn run(file: &Path, frames: usize, size: (u32, u32)) -> Result<Run, Box<dyn Error>> {
    if frames == 0 {
        return Err("there is no picture of no frame".into());
    }
    let model = selvedge_io::import::open(file)?.model;
    let engine = Engine::new(size)?;
    // SAFETY: the device meets the requirements, and outlives the renderer.
    let mut renderer = unsafe { Renderer::new(engine.lend(), TargetFormats::new(FORMAT), SLOTS)? };
    renderer.upload(&model)?;
    let camera = Camera::framing(&model, Camera::FROM, DVec3::Z, Camera::FOV_DEG.to_radians(), size);
    let settings = FrameSettings { background: None, ..FrameSettings::default() };
    let (mut changing, mut recording, mut whole) = (Duration::ZERO, Duration::ZERO, 0);
    for frame in 0..frames + SLOTS {
        let slot = frame % SLOTS;
        engine.wait(slot)?;
        // where it is not whole, the frame recorded next into the slot has room
        whole += usize::from(renderer.report(slot)?.is_some_and(|before| before.complete));
        if frame >= frames {
            continue; // the last frames have reported
        }
        let cmd = engine.begin(slot)?;
        own_pass(&engine, cmd);
        let start = Instant::now();
        let step = DAffine3::from_translation(DVec3::Z * (frame % 10) as f64);
        renderer.set_transform(0, step * model.instances[0].transform)?;
        changing += start.elapsed();
        let targets = Targets::new(&engine.colour);
        // SAFETY: recording; the slot's frame before has finished.
        unsafe { renderer.record(cmd, &FrameInput { camera: &camera, settings, slot, targets })? };
        recording += start.elapsed();
        engine.submit(slot)?;
    }
    let each = |all: Duration| all.as_secs_f64() * 1e6 / frames as f64;
    let pixels = pixels::pixels(&engine)?;
    Ok(Run { changing: each(changing), recording: each(recording - changing), whole, pixels })
}

/// The engine's own pass: blue, where the model is not. The renderer draws after it.
fn own_pass(engine: &Engine, cmd: vk::CommandBuffer) {
    let layout = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
    engine.order_drawing(cmd, vk::ImageLayout::UNDEFINED);
    let blue = vk::ClearValue { color: vk::ClearColorValue { float32: [0.1, 0.2, 0.6, 1.0] } };
    let attachments = [vk::RenderingAttachmentInfo::default()
        .image_view(engine.colour.view())
        .image_layout(layout)
        .load_op(vk::AttachmentLoadOp::CLEAR)
        .clear_value(blue)];
    let (width, height) = engine.colour.size();
    let area = vk::Extent2D { width, height }.into();
    let rendering = vk::RenderingInfo::default().render_area(area).layer_count(1).color_attachments(&attachments);
    // SAFETY: recording; the image is in the layout of an attachment.
    unsafe {
        engine.device.cmd_begin_rendering(cmd, &rendering);
        engine.device.cmd_end_rendering(cmd);
    }
    engine.order_drawing(cmd, layout);
}
