//! Two views of one upload: a model is uploaded once, and seen from in front and from above, in pictures of two sizes.
//! Between them one instance moves.
//!
//! `cargo run --release --features headless --example two_views -- samples/assembly.step`

use selvedge::glam::{DAffine3, DVec3};
use selvedge::headless::{HeadlessOptions, HeadlessRenderer};
use selvedge::model::{Camera, Projection};
use selvedge::picture::{FrameSettings, Outputs, Picture};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args().nth(1).ok_or("usage: two_views FILE")?;
    for (step, views) in run(file.as_ref(), 3)?.iter().enumerate() {
        let seen = views.each_ref().map(|view| view.face.iter().filter(|face| **face != 0).count());
        println!("step {step}: {} pixels from in front, {} from above", seen[0], seen[1]);
    }
    Ok(())
}

/// Both views of each step.
pub fn run(file: &Path, steps: u32) -> Result<Vec<[Picture; 2]>, Box<dyn Error>> {
    let model = selvedge_io::import::open(file)?.model;
    let mut renderer = HeadlessRenderer::new(&HeadlessOptions::default())?;
    renderer.upload(&model)?;
    let bounds = model.control_bounds();
    let front = Camera::framing(&model, DVec3::NEG_Y, DVec3::Z, 0.6, (320, 240));
    let height = 1.2 * bounds.diagonal();
    let above = Camera {
        projection: Projection::Orthographic { height },
        ..Camera::around(bounds, DVec3::Z, DVec3::Y, 0.6, (200, 200))
    };
    let settings = FrameSettings::default();
    let mut views = Vec::new();
    for step in 0..steps {
        let up = DAffine3::from_translation(DVec3::Z * (0.02 * bounds.diagonal() * f64::from(step)));
        renderer.set_transform(0, up * model.instances[0].transform)?;
        let mut view = |camera| renderer.render(camera, &settings, Outputs::ALL);
        views.push([view(&front)?, view(&above)?]);
    }
    Ok(views)
}
