//! A hole that moves: a trim loop edited between two frames, without an upload.
//!
//! `cargo run --release --features headless --example edit_trim -- samples/bracket.step`

use selvedge::glam::{DVec2, DVec3};
use selvedge::headless::{HeadlessOptions, HeadlessRenderer};
use selvedge::model::{Camera, LoopAt};
use selvedge::picture::{FrameSettings, Outputs, SceneSettings};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args().nth(1).ok_or("usage: edit_trim FILE")?;
    let Edit { at, bytes, pixels } = run(file.as_ref(), (640, 480))?;
    println!("loop {} of face {} moved: {bytes} bytes copied, {pixels} pixels changed", at.trim_loop, at.face);
    Ok(())
}

/// What an edit did.
pub struct Edit {
    /// The loop.
    pub at: LoopAt,
    /// Copied to the GPU.
    pub bytes: u64,
    /// Pixels whose colour changed.
    pub pixels: usize,
}

/// Moves the first hole of the file by a tenth of its width, and back.
pub fn run(file: &Path, size: (u32, u32)) -> Result<Edit, Box<dyn Error>> {
    let model = selvedge_io::import::open(file)?.model;
    let faces = model.parts.iter().enumerate().flat_map(|(part, p)| {
        p.faces.iter().enumerate().map(move |(face, f)| (LoopAt { part, face, trim_loop: 1 }, f))
    });
    let (at, face) = faces.into_iter().find(|(_, face)| face.loops.len() > 1).ok_or("no face has a hole")?;
    let hole = &face.loops[at.trim_loop];
    let (low, high) = hole.bounds();
    let moved = hole.translated(DVec2::new(0.1 * (high.x - low.x), 0.0))?;

    let mut renderer = HeadlessRenderer::new(&HeadlessOptions::default())?;
    renderer.upload_with(&model, SceneSettings { editable: true, ..SceneSettings::default() })?;
    let camera = Camera::framing(&model, Camera::FROM, DVec3::Z, Camera::FOV_DEG.to_radians(), size);
    let draw =
        |renderer: &mut HeadlessRenderer| renderer.render(&camera, &FrameSettings::default(), Outputs::default());
    let before = draw(&mut renderer)?;
    renderer.edit_loop(at, &moved)?;
    let after = draw(&mut renderer)?;
    renderer.edit_loop(at, hole)?;
    if draw(&mut renderer)?.colour != before.colour {
        return Err("the hole is back, and the picture is not".into());
    }
    let pixels = before.colour.iter().zip(&after.colour).filter(|(a, b)| a != b).count();
    Ok(Edit { at, bytes: after.stats.edit_bytes, pixels })
}
