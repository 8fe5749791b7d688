//! `selvedge sweep`: speed against error, over tolerances, sizes, ways to divide, zooms and numbers of copies.
//!
//! ```text
//!   model ─▶ copies ─▶ zoom ─▶ size ─▶ { every way and tolerance, in turn, frame by frame } ─▶ a row each
//! ```
//!
//! The rows of one group are measured in turn, so that other work on the machine slows all of them alike: their ratios
//! are comparable, their times are not. Slefes and lists of draws belong to the scene, so each kind has a renderer of
//! its own. The run ends with the growth of time (`growth`), with `--rate` triangles a second beside those of a plain
//! grid (`rate`); or, with `--against-fixed`, another table (`against`).

mod against;
mod divided;
mod growth;
mod rate;
mod sheet;

use crate::args::{Size, SubdivideArgs, SweepArgs};
use crate::closer::Approach;
use crate::progress::during;
use crate::target::{self, CSV, Target};
use crate::{Outcome, device, output, reading, remains, verdict};
use anyhow::{Result, bail};
use glam::{DAffine3, DVec3};
use selvedge::baselines::SceneOptions;
use selvedge::baselines::factors::Seen;
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, Model};
use selvedge::picture::{FrameSettings, FrameStats, Outputs, SceneSettings};
use selvedge_check::Tracer;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

pub use divided::Divided;

/// Frames of each way before the first measured one.
const WARM_UP_FRAMES: usize = 1;

/// One setting.
#[derive(Debug, Serialize)]
struct Row {
    model: String,
    copies: usize,
    zoom: f64,
    width: u32,
    height: u32,
    factors: String,
    tolerance_px: f64,
    patches: u64,
    sub_patches: u64,
    corner_patches: u64,
    triangles: u64,
    /// Median milliseconds of all passes, and of those in quotes in `ARCHITECTURE.md`.
    all_ms: f64,
    tessellation_ms: f64,
    visibility_ms: f64,
    resolve_ms: f64,
    persistent_bytes: u64,
    transient_bytes: u64,
    /// Pixels with something on them.
    covered: usize,
    judged: u64,
    wrong: u64,
    worst_shift_px: f64,
    /// The largest distance between triangles and surface over all patches that may be in the picture, computed, of the
    /// model as it was loaded. Infinite where a patch is clamped; not a number where nothing is judged, and in models
    /// with solids or things to see through.
    deviation_px: f64,
    clamps: u64,
}

/// A renderer for each scene, by [`Divided::scene`].
type Renderers = BTreeMap<(Option<usize>, Option<bool>), HeadlessRenderer>;

/// Sweeps every model.
pub fn run(args: &SweepArgs) -> Result<Outcome> {
    let inputs: Vec<&Path> = args.models.iter().map(PathBuf::as_path).collect();
    let outputs: Vec<_> = args.out.iter().map(|path| Target::new(path, CSV)).collect();
    target::check(&inputs, &outputs)?;
    let models = models(args, &outputs)?;
    if args.against_fixed {
        return against::run(args, &models);
    }
    let mut rows = Vec::new();
    let mut device = String::new();
    for (name, model) in &models {
        for &copies in &args.copies {
            let model = copied(model, copies, args.distinct);
            let mut renderers = during("uploading the model", || renderers(args, &model))?;
            let tracer = (args.samples > 0).then(|| Tracer::new(&model));
            for &zoom in &args.zooms {
                for &Size(width, height) in &args.sizes {
                    let camera = camera(&model, zoom, (width, height));
                    let group = Group { name, model: &model, copies, zoom, camera, tracer: tracer.as_ref() };
                    let measured = during("measuring", || group.measure(args, &mut renderers, &mut device))?;
                    rows.extend(measured);
                }
            }
        }
    }
    let print = |text: &str| output::print_beside(text, args.out.iter());
    print(&format!("{device}\n{}\n{}", table(&rows), growth::sentences(&rows)))?;
    if args.rate {
        print(&rate::sentence(args, &rows)?)?;
    }
    if let Some(path) = &args.out {
        target::write(path, |to| {
            let mut lines = csv::Writer::from_writer(to);
            rows.iter().try_for_each(|row| lines.serialize(row))?;
            Ok(lines.flush()?)
        })?;
    }
    Ok(Outcome::Good)
}

/// The models of the files, and the sheets, by name.
fn models(args: &SweepArgs, outputs: &[Target]) -> Result<Vec<(String, Model)>> {
    let mut models = Vec::new();
    for file in &args.models {
        let import = reading::open(file, &args.read, &SubdivideArgs::default())?;
        remains::judge(file, &import.model)?;
        target::check_read(&import, outputs)?;
        if import.model.trim.is_some() {
            bail!("{}: a volume trims it, and would not go with the copies", file.display());
        }
        models.push((file.file_stem().unwrap_or_default().to_string_lossy().into_owned(), import.model));
    }
    let sheets = args.degrees.iter().map(|&degree| (format!("degree {degree}"), sheet::of_degree(degree.into())));
    models.extend(sheets);
    Ok(models)
}

fn renderer(args: &SweepArgs) -> Result<HeadlessRenderer> {
    Ok(HeadlessRenderer::new(&device::options(args.device.as_deref(), false))?)
}

/// Renderers with the model, one for each kind of scene that the ways to divide need.
fn renderers(args: &SweepArgs, model: &Model) -> Result<Renderers> {
    let scenes: BTreeSet<_> = args.factors.iter().map(|divided| divided.scene()).collect();
    let uploaded = |(slefe_segments, corners)| {
        let mut renderer = renderer(args)?;
        let divided = SceneOptions { slefe_segments, corners, ..SceneOptions::default() };
        renderer.upload_baseline(model, SceneSettings::default(), divided)?;
        Ok(((slefe_segments, corners), renderer))
    };
    scenes.into_iter().map(uploaded).collect()
}

/// In a cube of copies, a tenth of the model apart.
fn copied(model: &Model, copies: usize, distinct: bool) -> Model {
    let bounds = model.bounds();
    let step = (bounds.max - bounds.min) * 1.1;
    let side = (1..).find(|n: &usize| n.pow(3) >= copies).unwrap_or(1);
    let mut all = Model { instances: Vec::new(), ..model.clone() };
    for copy in 0..copies {
        if distinct && copy > 0 {
            all.parts.extend(model.parts.iter().cloned());
        }
        let first = if distinct { copy * model.parts.len() } else { 0 };
        let place = DVec3::new((copy % side) as f64, (copy / side % side) as f64, (copy / side / side) as f64);
        let moved = DAffine3::from_translation(place * step);
        all.instances.extend(model.instances.iter().map(|i| {
            let transform = if copy == 0 { i.transform } else { moved * i.transform };
            selvedge::model::Instance { part: first + i.part, transform, ..i.clone() }
        }));
    }
    all
}

fn camera(model: &Model, zoom: f64, size: (u32, u32)) -> Camera {
    let bounds = model.bounds();
    let whole = Camera::around(bounds, Camera::FROM, DVec3::Z, Camera::FOV_DEG.to_radians(), size);
    let mut camera = if zoom > 1.0 { Approach::new(model, whole).closer(zoom) } else { whole };
    camera.fit_depth(bounds);
    camera
}

/// Settings that are measured in turn.
struct Group<'a> {
    name: &'a str,
    model: &'a Model,
    copies: usize,
    zoom: f64,
    camera: Camera,
    tracer: Option<&'a Tracer>,
}

impl Group<'_> {
    fn measure(&self, args: &SweepArgs, renderers: &mut Renderers, device: &mut String) -> Result<Vec<Row>> {
        let ways = args.factors.iter().flat_map(|f| args.tolerances.iter().map(move |t| (*f, *t)));
        let ways: Vec<(Divided, f64)> = ways.collect();
        let settings = |(factors, tolerance_px): (Divided, f64)| FrameSettings {
            tolerance_px,
            levels: factors.levels(),
            all_passes: true,
            ..FrameSettings::default()
        };
        let mut draw = |way: &(Divided, f64), outputs| {
            let renderer = renderers.get_mut(&way.0.scene()).expect("one for each way");
            renderer.render(&self.camera, &settings(*way), outputs)
        };
        let mut frames: Vec<Vec<FrameStats>> = vec![Vec::new(); ways.len()];
        for frame in 0..WARM_UP_FRAMES + args.frames {
            for (way, stats) in ways.iter().zip(&mut frames) {
                let picture = draw(way, Outputs::default())?;
                if frame >= WARM_UP_FRAMES {
                    stats.push(picture.stats);
                }
            }
        }
        let seen = self.seen(args);
        let mut rows = Vec::new();
        for (i, (way, stats)) in ways.iter().zip(&frames).enumerate() {
            let picture = draw(way, Outputs::ALL)?;
            let judged = self
                .tracer
                .map(|t| verdict::of(t, &self.camera, &picture, args.samples, way.1, self.zoom, &way.0.to_string()));
            let last = stats.last().expect("at least one frame");
            *device = format!("{} ({})", last.device, last.driver);
            let pass = |name: &str| pass_ms(stats, name);
            let pool = |name: &str| last.pools.iter().filter(|p| p.name == name).map(|p| p.bytes).sum();
            rows.push(Row {
                model: self.name.to_owned(),
                copies: self.copies,
                zoom: self.zoom,
                width: self.camera.size.0,
                height: self.camera.size.1,
                factors: way.0.to_string(),
                tolerance_px: way.1,
                patches: last.patches,
                sub_patches: last.sub_patches,
                corner_patches: last.corner_patches,
                triangles: last.triangles,
                all_ms: pass(""),
                tessellation_ms: pass("tessellation"),
                visibility_ms: pass("visibility"),
                resolve_ms: pass("resolve"),
                persistent_bytes: pool("persistent"),
                transient_bytes: pool("transient"),
                covered: picture.face.iter().filter(|id| **id != 0).count(),
                judged: judged.as_ref().map_or(0, |j| j.sampled),
                wrong: judged.as_ref().map_or(0, verdict::wrong),
                worst_shift_px: judged.as_ref().map_or(f64::NAN, verdict::worst_shift_px),
                deviation_px: seen.get(i % args.tolerances.len()).map_or(f64::NAN, |s| s.deviation_px(way.0.way())),
                clamps: last.clamps,
            });
        }
        Ok(rows)
    }

    /// The patches at each tolerance, where they are judged and all patches belong to faces that are drawn as such.
    fn seen(&self, args: &SweepArgs) -> Vec<Seen> {
        let plain = self.model.solids.is_empty() && self.model.is_opaque();
        let tolerances = args.tolerances.iter().filter(|_| self.tracer.is_some() && plain);
        tolerances.map(|t| Seen::new(self.model, &self.camera, *t)).collect()
    }
}

/// Milliseconds of the passes of that name, of all where it is empty; the median over the frames.
fn pass_ms(frames: &[FrameStats], name: &str) -> f64 {
    let of =
        |s: &FrameStats| s.passes.iter().filter(|p| name.is_empty() || p.name == name).map(|p| p.gpu_ms).sum::<f64>();
    median(frames.iter().map(of).collect())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn table(rows: &[Row]) -> String {
    let mut table = output::table([
        "model",
        "copies",
        "zoom",
        "size",
        "factors",
        "px",
        "patches",
        "by corners",
        "triangles",
        "all, ms",
        "tessellation",
        "visibility",
        "resolve",
        "bytes/patch",
        "covered",
        "judged",
        "wrong",
        "worst px",
        "deviation, px",
    ]);
    for r in rows {
        table.add_row([
            r.model.clone(),
            r.copies.to_string(),
            r.zoom.to_string(),
            format!("{}x{}", r.width, r.height),
            r.factors.clone(),
            r.tolerance_px.to_string(),
            r.patches.to_string(),
            r.corner_patches.to_string(),
            r.triangles.to_string(),
            format!("{:.2}", r.all_ms),
            format!("{:.2}", r.tessellation_ms),
            format!("{:.2}", r.visibility_ms),
            format!("{:.2}", r.resolve_ms),
            format!("{:.0}", r.persistent_bytes as f64 / r.patches.max(1) as f64),
            r.covered.to_string(),
            r.judged.to_string(),
            r.wrong.to_string(),
            format!("{:.3}", r.worst_shift_px),
            format!("{:.4}", r.deviation_px),
        ]);
    }
    table.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_stand_apart() {
        let part = selvedge::model::Part::default();
        let instance =
            selvedge::model::Instance { part: 0, transform: DAffine3::IDENTITY, colour: None, name: String::new() };
        let model = Model { parts: vec![part], instances: vec![instance], ..Model::default() };
        let shared = copied(&model, 9, false);
        assert_eq!((shared.parts.len(), shared.instances.len()), (1, 9));
        let distinct = copied(&model, 9, true);
        assert_eq!(distinct.instances.iter().map(|i| i.part).collect::<Vec<_>>(), (0..9).collect::<Vec<_>>());
    }
}
