//! `selvedge render`: one picture and the images beside it.

use crate::args::{Aov, Image, RenderArgs};
use crate::camera::CameraFile;
use crate::session::{self, FirstFrame, Session};
use crate::target::{self, JSON, NPY, PNG, Target};
use crate::{Outcome, npy, output};
use anyhow::Result;
use selvedge::model::Camera;
use selvedge::picture::{FrameStats, Outputs, Picture};
use serde::Serialize;
use std::sync::Arc;

/// Draws the picture and writes every file asked for.
pub fn run(args: &RenderArgs) -> Result<Outcome> {
    let outputs = outputs(args);
    target::check(&args.cut.inputs(&args.model), &outputs)?;
    let (import, device) =
        rayon::join(|| session::open(&args.model, &args.read, &args.subdivide), || session::device(&args.frame));
    let mut import = import?;
    target::check_read(&import, &outputs)?;
    args.cut.apply(&mut import.model, &args.read)?;
    let camera = args.camera.of(&import)?;
    // the renderer shares it: large models are there once
    let model = Arc::new(std::mem::take(&mut import.model));
    let mut session = Session::of_one(device?, &args.frame, &import, &model, &args.edges)?;
    let outputs = wanted(&args.aov);
    let picture = session.render(&camera, outputs)?;
    if args.frame.highlight {
        let stats = &picture.stats;
        tracing::warn!("{} pixels show contact, {} overlap", stats.contact_pixels, stats.overlap_pixels);
    }
    if !session.shows(&camera, &picture)? {
        session.blank(&args.model, &model, camera.size, &args.read)?;
    }
    let stats = match (&args.stats, session.first_frame()) {
        (Some(_), Some(first_frame)) => {
            Some(Stats { frame: session.measured_again(&camera, outputs, &picture.stats)?, first_frame })
        }
        _ => None,
    };
    let gpu_ms: f64 = picture.stats.passes.iter().map(|p| p.gpu_ms).sum();
    let trimmed = picture.stats.trim.map_or(String::new(), |way| format!(", trimmed by way {}", way.name()));
    tracing::info!(
        "{gpu_ms:.1} ms in {} passes of a first frame on {}{trimmed}",
        picture.stats.passes.len(),
        picture.stats.device
    );
    // to close a device takes about as long as to write a picture
    let (written, complained) = rayon::join(|| write_all(args, &camera, &picture, stats.as_ref()), || session.close());
    written?;
    Ok(if complained { Outcome::Broken } else { Outcome::Good })
}

/// Every file that is written.
fn outputs(args: &RenderArgs) -> Vec<Target> {
    let picture = Target::new(&args.output, PNG);
    let images = args.aov.iter().map(|aov| Target::new(&aov.file, NPY));
    let told = args.stats.iter().chain(&args.camera_out).map(|path| Target::new(path, JSON));
    std::iter::once(picture).chain(images).chain(told).collect()
}

/// What `--stats` writes.
#[derive(Serialize)]
struct Stats {
    #[serde(flatten)]
    frame: FrameStats,
    first_frame: FirstFrame,
}

fn write_all(args: &RenderArgs, camera: &Camera, picture: &Picture, stats: Option<&Stats>) -> Result<()> {
    output::png(&args.output, picture.size, &picture.colour)?;
    for aov in &args.aov {
        write(aov, picture)?;
    }
    args.camera_out.iter().try_for_each(|path| output::json(path, &CameraFile::from(camera)))?;
    args.stats.iter().zip(stats).try_for_each(|(path, stats)| output::json(path, stats))
}

fn wanted(aovs: &[Aov]) -> Outputs {
    let has = |image| aovs.iter().any(|a| a.image == image);
    Outputs {
        depth: has(Image::Depth),
        face: has(Image::Face),
        uv: has(Image::Uv),
        normal: has(Image::Normal),
        thickness: has(Image::Thickness),
    }
}

fn write(aov: &Aov, picture: &Picture) -> Result<()> {
    let (width, height) = (picture.size.0 as usize, picture.size.1 as usize);
    target::write(&aov.file, |mut to| {
        match aov.image {
            Image::Depth => npy::write(&mut to, &[height, width], &picture.depth)?,
            Image::Face => npy::write(&mut to, &[height, width], &picture.face)?,
            Image::Uv => npy::write(&mut to, &[height, width, 2], picture.uv.as_flattened())?,
            Image::Normal => npy::write(&mut to, &[height, width, 3], picture.normal.as_flattened())?,
            Image::Thickness => npy::write(&mut to, &[height, width], &picture.thickness)?,
        }
        Ok(())
    })
}
