//! `selvedge draw`: the lines of a view as curves in an SVG file.

mod svg;

use crate::args::DrawArgs;
use crate::camera::CameraFile;
use crate::progress::during;
use crate::render::named_for;
use crate::target::{self, JSON, SVG, Target};
use crate::{Outcome, output, reading};
use anyhow::{Result, bail};
use selvedge::model::{Camera, Projection};
use selvedge::picture::{EdgeChoice, TangentEdges};
use selvedge_check::Tracer;
use selvedge_check::drawing::{Drawing, DrawingSettings};
use selvedge_jobs::Direction;
use std::path::PathBuf;
use std::time::Instant;
use svg::Page;

/// Draws the views and writes a file each.
pub fn run(args: &DrawArgs) -> Result<Outcome> {
    let sheets = sheets(args)?;
    let outputs: Vec<Target> = sheets.iter().flat_map(Sheet::outputs).collect();
    target::check(&args.cut.inputs(&args.model), &outputs)?;
    let mut import = reading::open(&args.model, &args.read, &args.subdivide)?;
    target::check_read(&import, &outputs)?;
    args.cut.apply(&mut import.model, &args.read)?;
    let cameras = sheets.iter().map(|sheet| args.camera.parallel(sheet.direction, &import));
    let cameras = cameras.collect::<Result<Vec<_>>>()?;
    let pages = cameras.iter().map(|camera| page(args, camera)).collect::<Result<Vec<_>>>()?;
    let model = &import.model;
    if !model.solids.is_empty() {
        tracing::warn!("{} Boolean solids hide what is behind them and have no lines of their own", model.solids.len());
    }
    let settings = DrawingSettings {
        sharp: args.edges != EdgeChoice::None,
        smooth: args.edges == EdgeChoice::All && args.tangent_edges != TangentEdges::None,
        silhouettes: args.silhouettes,
        hidden: args.hidden_lines,
        ..DrawingSettings::default()
    };
    let start = Instant::now();
    let tracer = during("preparing faces", || Tracer::new(model));
    for ((sheet, camera), page) in sheets.iter().zip(&cameras).zip(&pages) {
        let drawing = during("drawing", || Drawing::new(model, &tracer, camera, &settings))?;
        let strokes = drawing.strokes();
        if strokes.is_empty() {
            bail!("{}: nothing to draw: no line of the kinds asked for is in the picture", reading::named(&args.model));
        }
        if drawing.unresolved > 0 {
            tracing::warn!("{} places where silhouettes cross each other are left open", drawing.unresolved);
        }
        if tracer.given_up() > 0 {
            tracing::warn!(
                "{} rays were not followed to their ends: lines may end at the wrong place",
                tracer.given_up()
            );
        }
        let (count, off) = (strokes.len(), drawing.deviation);
        tracing::info!("{count} lines in {:.2?}, curves within {off:.4} px", start.elapsed());
        let full = args.tangent_edges == TangentEdges::Full;
        target::write(&sheet.output, |to| Ok(svg::write(to, page, &model.name, &strokes, full)?))?;
        sheet.camera_out.iter().try_for_each(|path| output::json(path, &CameraFile::from(camera)))?;
    }
    Ok(Outcome::Good)
}

/// A view, and the files of it.
struct Sheet {
    direction: Option<Direction>,
    output: PathBuf,
    camera_out: Option<PathBuf>,
}

impl Sheet {
    fn outputs(&self) -> impl Iterator<Item = Target> {
        let camera = self.camera_out.iter().map(|path| Target::new(path, JSON));
        std::iter::once(Target::new(&self.output, SVG)).chain(camera)
    }
}

/// One for each view; of several, each file has the view's name.
fn sheets(args: &DrawArgs) -> Result<Vec<Sheet>> {
    let directions = args.view.as_ref().map_or(vec![None], |views| views.0.iter().copied().map(Some).collect());
    let several = directions.len() > 1;
    let sheet = |direction: Option<Direction>| {
        let path = |path: &PathBuf| named_for(path, direction, several);
        let camera_out = args.camera_out.as_ref().map(path).transpose()?;
        Ok(Sheet { direction, output: path(&args.output)?, camera_out })
    };
    directions.into_iter().map(sheet).collect()
}

/// The paper of a picture.
fn page(args: &DrawArgs, camera: &Camera) -> Result<Page> {
    let (width, height) = (f64::from(camera.size.0), f64::from(camera.size.1));
    let per_pixel = match (args.scale, camera.projection) {
        (None, _) => args.width / width,
        (Some(scale), Projection::Orthographic { height: seen }) => scale * seen / height,
        (Some(_), _) => {
            bail!("--scale wants a parallel view: no --fov, --eye or --camera")
        }
    };
    let size = (width * per_pixel, height * per_pixel);
    if !(size.0 >= 1e-3 && size.1 >= 1e-3 && size.0.max(size.1) <= 1e6) {
        bail!(
            "--scale makes a sheet of {:.3e} x {:.3e} millimetres: from 0.001 to 1000000 is possible",
            size.0,
            size.1
        );
    }
    Ok(Page { size, per_pixel })
}
