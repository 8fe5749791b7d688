//! `selvedge render`: one picture and the images beside it.

use crate::args::{Aov, Image, RenderArgs};
use crate::camera::CameraFile;
use crate::session::{self, Session};
use crate::{Outcome, npy, output};
use anyhow::Result;
use selvedge::picture::{Outputs, Picture};

/// Draws the picture and writes every file asked for.
pub fn run(args: &RenderArgs) -> Result<Outcome> {
    let (import, device) = rayon::join(|| session::open(&args.model, &args.subdivide), || session::device(&args.frame));
    let mut import = import?;
    args.cut.apply(&mut import.model)?;
    let camera = args.camera.of(&import)?;
    if let Some(path) = &args.camera_out {
        output::json(path, &CameraFile::from(&camera))?;
    }
    let mut session = Session::smooth(device?, &args.frame, &import, &args.edges)?;
    let picture = session.render(&camera, wanted(&args.aov))?;
    if args.frame.highlight {
        let stats = &picture.stats;
        tracing::warn!("{} pixels show contact, {} overlap", stats.contact_pixels, stats.overlap_pixels);
    }
    let gpu_ms: f64 = picture.stats.passes.iter().map(|p| p.gpu_ms).sum();
    tracing::info!("{gpu_ms:.1} ms in {} passes on {}", picture.stats.passes.len(), picture.stats.device);
    // to close a device takes about as long as to write a picture
    let (written, complained) = rayon::join(|| write_all(args, &picture), || session.close());
    written?;
    Ok(if complained { Outcome::Broken } else { Outcome::Good })
}

fn write_all(args: &RenderArgs, picture: &Picture) -> Result<()> {
    output::png(&args.output, picture.size, &picture.colour)?;
    for aov in &args.aov {
        write(aov, picture)?;
    }
    args.stats.iter().try_for_each(|path| output::json(path, &picture.stats))
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
    output::file(&aov.file, |to| {
        match aov.image {
            Image::Depth => npy::write(to, &[height, width], &picture.depth)?,
            Image::Face => npy::write(to, &[height, width], &picture.face)?,
            Image::Uv => npy::write(to, &[height, width, 2], picture.uv.as_flattened())?,
            Image::Normal => npy::write(to, &[height, width, 3], picture.normal.as_flattened())?,
            Image::Thickness => npy::write(to, &[height, width], &picture.thickness)?,
        }
        Ok(())
    })
}
