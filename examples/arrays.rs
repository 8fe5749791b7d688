//! Images of depth, faces and normals as plain arrays, and what they say of a part.
//!
//! `cargo run --release --features headless --example arrays -- samples/bracket.step`

use selvedge::glam::DVec3;
use selvedge::headless::{HeadlessOptions, HeadlessRenderer};
use selvedge::model::Camera;
use selvedge::picture::{FrameSettings, Outputs};
use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args().nth(1).ok_or("usage: arrays FILE")?;
    for (face, seen) in run(file.as_ref(), (640, 480))? {
        println!("face {face}: {} pixels, {:.3} to {:.3} away", seen.pixels, seen.nearest, seen.farthest);
    }
    Ok(())
}

/// What a picture shows of a face.
pub struct Seen {
    /// How many pixels see it.
    pub pixels: usize,
    /// Smallest and largest depth, model units.
    pub nearest: f32,
    /// See `nearest`.
    pub farthest: f32,
}

/// Every face that is seen, by its number.
pub fn run(file: &Path, size: (u32, u32)) -> Result<BTreeMap<u32, Seen>, Box<dyn Error>> {
    let model = selvedge_io::import::open(file)?.model;
    let mut renderer = HeadlessRenderer::new(&HeadlessOptions::default())?;
    let outputs = Outputs { depth: true, face: true, ..Outputs::default() };
    renderer.expect(outputs);
    renderer.upload(&model)?;
    let camera = Camera::framing(&model, Camera::FROM, DVec3::Z, Camera::FOV_DEG.to_radians(), size);
    let picture = renderer.render(&camera, &FrameSettings::default(), outputs)?;
    let mut faces = BTreeMap::new();
    // row after row from the top; background has face 0 and an infinite depth
    for (face, depth) in picture.face.iter().zip(&picture.depth).filter(|(face, _)| **face != 0) {
        let none = Seen { pixels: 0, nearest: f32::INFINITY, farthest: 0.0 };
        let seen = faces.entry(*face).or_insert(none);
        seen.pixels += 1;
        (seen.nearest, seen.farthest) = (seen.nearest.min(*depth), seen.farthest.max(*depth));
    }
    Ok(faces)
}
