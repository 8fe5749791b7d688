//! A CAD file, drawn from in front, the right and above, into a PNG.
//!
//! `cargo run --release --features headless --example render_to_png -- samples/bracket.step bracket.png`

use selvedge::glam::DVec3;
use selvedge::headless::{HeadlessOptions, HeadlessRenderer};
use selvedge::model::Camera;
use selvedge::picture::{FrameSettings, Outputs};
use std::error::Error;
use std::fs::File;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [file, png] = &args[..] else { return Err("usage: render_to_png FILE PNG".into()) };
    run(file.as_ref(), png.as_ref(), (1920, 1080))
}

/// Draws `file` in so many pixels.
pub fn run(file: &Path, png: &Path, size: (u32, u32)) -> Result<(), Box<dyn Error>> {
    let read = selvedge_io::import::open(file)?;
    read.warnings.iter().for_each(|warning| eprintln!("{warning}"));
    let mut renderer = HeadlessRenderer::new(&HeadlessOptions::default())?;
    renderer.upload(&read.model)?;
    let camera = Camera::framing(&read.model, Camera::FROM, DVec3::Z, Camera::FOV_DEG.to_radians(), size);
    let picture = renderer.render(&camera, &FrameSettings::default(), Outputs::default())?;
    let mut encoder = png::Encoder::new(File::create(png)?, size.0, size.1);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header()?.write_image_data(picture.colour.as_flattened())?;
    Ok(())
}
