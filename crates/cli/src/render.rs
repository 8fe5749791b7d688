//! `selvedge render`: pictures of views, one or several, and the images beside them.

use crate::args::{Aov, Image, RenderArgs};
use crate::camera::CameraFile;
use crate::directions::{Direction, NAMED};
use crate::session::{self, Measured, Session};
use crate::sheet::Sheet;
use crate::target::{self, JSON, NPY, PNG, Target};
use crate::{Outcome, npy, output};
use anyhow::{Result, bail};
use selvedge::model::Camera;
use selvedge::picture::{Outputs, Picture};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Draws the pictures and writes every file asked for.
pub fn run(args: &RenderArgs) -> Result<Outcome> {
    let shots = shots(args)?;
    let sheet = args.contact_sheet.then(|| Target::new(&args.output, PNG));
    let outputs: Vec<Target> = sheet.into_iter().chain(shots.iter().flat_map(Shot::outputs)).collect();
    target::check(&args.cut.inputs(&args.model), &outputs)?;
    let (import, device) =
        rayon::join(|| session::open(&args.model, &args.read, &args.subdivide), || session::device(&args.frame));
    let mut import = import?;
    target::check_read(&import, &outputs)?;
    args.cut.apply(&mut import.model, &args.read)?;
    let size = args.camera.pixels(&import);
    let mut sheet = args.contact_sheet.then(|| Sheet::new(size, shots.len())).transpose()?;
    let size = sheet.as_ref().map_or(size, Sheet::tile);
    let camera = |shot: &Shot| match shot.direction {
        Some(direction) => args.camera.standard(direction, &import, size),
        None => args.camera.of(&import),
    };
    let cameras = shots.iter().map(camera).collect::<Result<Vec<_>>>()?;
    // the renderer shares it: large models are there once
    let model = Arc::new(std::mem::take(&mut import.model));
    let mut session = Session::of_one(device?, &args.frame, &import, &model, (&args.edges, args.lines.settings()?))?;
    let backdrop = args.look.backdrop(&import);
    session.look(backdrop.colour(), args.look.style);
    for (index, (shot, camera)) in shots.iter().zip(&cameras).enumerate() {
        let mut picture = session.render(camera, wanted(&shot.aovs))?;
        tell(args, &picture);
        if !session.shows(camera, &picture)? {
            session.blank(&args.model, &model, camera.size, &args.read)?;
        }
        match &mut sheet {
            Some(sheet) => sheet.put(index, &picture),
            None => {
                backdrop.under(picture.size, &mut picture.colour);
                let stats = shot.stats.as_ref().map(|_| session.measured(camera, wanted(&shot.aovs), &picture.stats));
                shot.write(camera, &picture, stats.transpose()?.as_ref())?;
            }
        }
    }
    if let Some(mut sheet) = sheet {
        backdrop.under(sheet.size, &mut sheet.pixels);
        output::png(&args.output, sheet.size, &sheet.pixels)?;
    }
    Ok(if session.close() { Outcome::Broken } else { Outcome::Good })
}

/// What the frame cost, and what it marks.
fn tell(args: &RenderArgs, picture: &Picture) {
    let stats = &picture.stats;
    if args.frame.highlight {
        tracing::warn!("{} pixels show contact, {} overlap", stats.contact_pixels, stats.overlap_pixels);
    }
    let gpu_ms: f64 = stats.passes.iter().map(|p| p.gpu_ms).sum();
    let trimmed = stats.trim.map_or(String::new(), |way| format!(", trimmed by way {}", way.name()));
    tracing::info!("{gpu_ms:.1} ms in {} passes on {}{trimmed}", stats.passes.len(), stats.device);
}

/// A picture, and the files of it.
struct Shot {
    direction: Option<Direction>,
    /// `None` on a contact sheet.
    output: Option<PathBuf>,
    aovs: Vec<Aov>,
    stats: Option<PathBuf>,
    camera_out: Option<PathBuf>,
}

/// One for each view; of several, each file has the view's name.
fn shots(args: &RenderArgs) -> Result<Vec<Shot>> {
    let mut directions: Vec<_> = args.view.iter().flat_map(|views| &views.0).copied().map(Some).collect();
    if directions.is_empty() {
        directions = if args.contact_sheet { NAMED.map(Some).to_vec() } else { vec![None] };
    }
    let several = directions.len() > 1;
    let shot = |direction: Option<Direction>| {
        let path = |path: &PathBuf| named_for(path, direction, several);
        let optional = |of: &Option<PathBuf>| of.as_ref().map(path).transpose();
        let output = if args.contact_sheet { None } else { Some(path(&args.output)?) };
        let aov = |aov: &Aov| Ok(Aov { file: path(&aov.file)?, ..aov.clone() });
        let aovs = args.aov.iter().map(aov).collect::<Result<_>>()?;
        Ok(Shot { direction, output, aovs, stats: optional(&args.stats)?, camera_out: optional(&args.camera_out)? })
    };
    directions.into_iter().map(shot).collect()
}

/// Where the view's name goes in a path.
const VIEW: &str = "{view}";

fn is_pattern(path: &Path) -> bool {
    path.to_string_lossy().contains(VIEW)
}

/// A path as it is for a view, one of several or not.
pub fn named_for(path: &Path, direction: Option<Direction>, several: bool) -> Result<PathBuf> {
    match direction {
        Some(direction) if several || is_pattern(path) => named(path, &direction.to_string()),
        None if is_pattern(path) => {
            bail!("{}: {VIEW} stands for the view's name: --view says which", path.display())
        }
        _ => Ok(path.to_owned()),
    }
}

/// The path of a view's file: the name in the pattern's place, or before the ending.
fn named(path: &Path, view: &str) -> Result<PathBuf> {
    if target::is_standard(path) {
        bail!("several pictures do not go to standard output: --contact-sheet makes one of them");
    }
    let text = path.to_string_lossy();
    Ok(match text.contains(VIEW) {
        true => PathBuf::from(text.replace(VIEW, view)),
        false => target::with_name(path, &format!("_{view}")),
    })
}

impl Shot {
    fn outputs(&self) -> impl Iterator<Item = Target> {
        let picture = self.output.iter().map(|path| Target::new(path, PNG));
        let images = self.aovs.iter().map(|aov| Target::new(&aov.file, NPY));
        let told = self.stats.iter().chain(&self.camera_out).map(|path| Target::new(path, JSON));
        picture.chain(images).chain(told)
    }

    fn write(&self, camera: &Camera, picture: &Picture, stats: Option<&Measured>) -> Result<()> {
        self.output.iter().try_for_each(|path| output::png(path, picture.size, &picture.colour))?;
        self.aovs.iter().try_for_each(|aov| write(aov, picture))?;
        self.camera_out.iter().try_for_each(|path| output::json(path, &CameraFile::from(camera)))?;
        self.stats.iter().zip(stats).try_for_each(|(path, stats)| output::json(path, stats))
    }
}

fn wanted(aovs: &[Aov]) -> Outputs {
    let has = |image| aovs.iter().any(|a| a.image == image);
    Outputs {
        depth: has(Image::Depth),
        face: has(Image::Face),
        uv: has(Image::Uv),
        normal: has(Image::Normal),
        thickness: has(Image::Thickness),
        edge: has(Image::Edge),
        part: has(Image::Part),
        instance: has(Image::Instance),
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
            Image::Edge => npy::write(&mut to, &[height, width], &picture.edge)?,
            Image::Part => npy::write(&mut to, &[height, width], &picture.part)?,
            Image::Instance => npy::write(&mut to, &[height, width], &picture.instance)?,
        }
        Ok(())
    })
}
