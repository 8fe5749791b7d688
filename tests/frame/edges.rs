//! What pixels with an edge should show: from exact rays, and from the same frame sixteen times as large.

use glam::{DVec2, DVec3};
use selvedge::headless::HeadlessRenderer;
use selvedge::model::Camera;
use selvedge::picture::{FrameSettings, Outputs, Picture};
use selvedge_check::Tracer;

/// Rays, and smaller pixels, to a pixel's side.
pub const FINE: u32 = 16;
/// Linear contrast in a pixel from which its error is compared.
const CONTRAST: f64 = 0.1;
/// An edge's step between smaller pixels, as a part of the pixel's range. A shade that spans the pixel evenly has steps of
/// a sixteenth.
const STEP: f64 = 0.25;

/// Linear, of an sRGB picture.
pub fn linear(colour: [u8; 4]) -> DVec3 {
    let one = |c: u8| {
        let c = f64::from(c) / 255.0;
        if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    };
    DVec3::new(one(colour[0]), one(colour[1]), one(colour[2]))
}

pub fn root_mean_square(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}

/// Of each pixel the share of exact rays that meet something: of [`FINE`] x [`FINE`], but for pixels of which 4 x 4 agree.
pub fn covered(tracer: &Tracer, camera: &Camera) -> Vec<f64> {
    let (width, height) = camera.size;
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| DVec2::new(f64::from(x), f64::from(y))));
    pixels
        .map(|corner| {
            let hit = |i: u32, n: u32| {
                let at = DVec2::new(f64::from(i % n), f64::from(i / n)) + 0.5;
                usize::from(tracer.first(camera, corner + at / f64::from(n)).is_some())
            };
            let few = (0..16).map(|i| hit(i, 4)).sum::<usize>();
            match few {
                0 | 16 => few as f64 / 16.0,
                _ => (0..FINE * FINE).map(|i| hit(i, FINE)).sum::<usize>() as f64 / f64::from(FINE * FINE),
            }
        })
        .collect()
}

/// Of a thing of one colour before white: the share that is seen less the true one, of pixels that it covers in part.
pub fn coverage_errors(picture: &Picture, truth: &[f64]) -> Vec<f64> {
    // the first of them may be covered but for a corner
    let whole = (0..truth.len()).filter(|&i| truth[i] == 1.0);
    let ink = whole.map(|i| 1.0 - linear(picture.colour[i]).x).fold(0.0, f64::max);
    let shown = |i: usize| (1.0 - linear(picture.colour[i]).x) / ink;
    (0..truth.len()).filter(|&i| truth[i] > 0.0 && truth[i] < 1.0).map(|i| shown(i) - truth[i]).collect()
}

/// Linear colours in a pixel, of the same frame [`FINE`] times as large.
pub struct Block {
    mean: DVec3,
    range: DVec3,
    /// Largest difference between neighbours, in any channel.
    step: f64,
}

impl Block {
    /// Whether an edge runs through the pixel. A shade has contrast, too, but no step.
    fn has_edge(&self) -> bool {
        let range = self.range.max_element();
        range > CONTRAST && self.step > STEP * range
    }
}

/// Those of each pixel. `outputs` are those of the renderer's other pictures: for others it would upload the model anew.
pub fn blocks(renderer: &mut HeadlessRenderer, camera: &Camera, outputs: Outputs) -> Vec<Block> {
    let (width, height) = camera.size;
    let large = Camera { size: (FINE * width, FINE * height), ..*camera };
    let picture = renderer.render(&large, &FrameSettings::default(), outputs).unwrap();
    (0..width * height)
        .map(|i| {
            let (x, y) = (i % width * FINE, i / width * FINE);
            let at = |k: u32| ((y + k / FINE) * large.size.0 + x + k % FINE) as usize;
            let all: Vec<DVec3> = (0..FINE * FINE).map(|k| linear(picture.colour[at(k)])).collect();
            let low = all.iter().fold(DVec3::INFINITY, |a, b| a.min(*b));
            let high = all.iter().fold(DVec3::ZERO, |a, b| a.max(*b));
            let fine = FINE as usize;
            let across = (0..all.len()).filter(|k| k % fine > 0).map(|k| all[k] - all[k - 1]);
            let up = (fine..all.len()).map(|k| all[k] - all[k - fine]);
            let step = across.chain(up).fold(0.0f64, |most, d| most.max(d.abs().max_element()));
            Block { mean: all.iter().sum::<DVec3>() / all.len() as f64, range: high - low, step }
        })
        .collect()
}

/// Distance from the mean as a part of the range, of pixels with an edge.
pub fn contrast_errors(picture: &Picture, blocks: &[Block]) -> Vec<f64> {
    (blocks.iter().zip(&picture.colour))
        .filter(|(block, _)| block.has_edge())
        .map(|(block, colour)| (linear(*colour) - block.mean).length() / block.range.length())
        .collect()
}
