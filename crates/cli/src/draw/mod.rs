//! `selvedge draw`: the lines of a view as curves in an SVG file.

mod svg;

use crate::args::{DrawArgs, DrawnEdges, TangentEdges};
use crate::directions::Direction;
use crate::progress::during;
use crate::render::{VIEW, is_pattern, named};
use crate::target::{self, SVG, Target};
use crate::{Outcome, session};
use anyhow::{Result, bail};
use selvedge::model::{Camera, Projection};
use selvedge_check::Tracer;
use selvedge_check::drawing::{Drawing, DrawingSettings};
use std::path::PathBuf;
use std::time::Instant;
use svg::Page;

/// Draws the views and writes a file each.
pub fn run(args: &DrawArgs) -> Result<Outcome> {
    let sheets = sheets(args)?;
    let outputs: Vec<Target> = sheets.iter().map(|(_, path)| Target::new(path, SVG)).collect();
    target::check(&args.cut.inputs(&args.model), &outputs)?;
    let mut import = session::open(&args.model, &args.read, &args.subdivide)?;
    target::check_read(&import, &outputs)?;
    args.cut.apply(&mut import.model, &args.read)?;
    let cameras = sheets.iter().map(|(direction, _)| args.camera.parallel(*direction, &import));
    let cameras = cameras.collect::<Result<Vec<_>>>()?;
    let pages = cameras.iter().map(|camera| page(args, camera)).collect::<Result<Vec<_>>>()?;
    let model = &import.model;
    if !model.solids.is_empty() {
        tracing::warn!("{} Boolean solids hide what is behind them and have no lines of their own", model.solids.len());
    }
    let settings = DrawingSettings {
        sharp: args.edges != DrawnEdges::None,
        smooth: args.edges == DrawnEdges::All && args.tangent_edges != TangentEdges::None,
        silhouettes: args.silhouettes,
        hidden: args.hidden_lines,
        ..DrawingSettings::default()
    };
    let start = Instant::now();
    let tracer = during("preparing faces", || Tracer::new(model));
    for (((_, path), camera), page) in sheets.iter().zip(&cameras).zip(&pages) {
        let drawing = during("drawing", || Drawing::new(model, &tracer, camera, &settings))?;
        let strokes = drawing.strokes();
        if strokes.is_empty() {
            bail!("{}: nothing to draw: no line of the kinds asked for is in the picture", session::named(&args.model));
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
        target::write(path, |to| Ok(svg::write(to, page, &model.name, &strokes, full)?))?;
    }
    Ok(Outcome::Good)
}

/// Each view and its file.
fn sheets(args: &DrawArgs) -> Result<Vec<(Option<Direction>, PathBuf)>> {
    let Some(views) = &args.view else {
        if is_pattern(&args.output) {
            bail!("{}: {VIEW} stands for the view's name: --view says which", args.output.display());
        }
        return Ok(vec![(None, args.output.clone())]);
    };
    let several = views.0.len() > 1;
    let sheet = |direction: &Direction| {
        let apart = several || is_pattern(&args.output);
        let path = if apart { named(&args.output, &direction.to_string())? } else { args.output.clone() };
        Ok((Some(*direction), path))
    };
    views.0.iter().map(sheet).collect()
}

/// The paper of a picture.
fn page(args: &DrawArgs, camera: &Camera) -> Result<Page> {
    let (width, height) = (f64::from(camera.size.0), f64::from(camera.size.1));
    let per_pixel = match (args.scale, camera.projection) {
        (None, _) => args.width / width,
        (Some(scale), Projection::Orthographic { height: seen }) => scale * seen / height,
        (Some(_), Projection::Perspective { .. }) => {
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
