//! `selvedge check`: tests the accuracy promise on the pictures that this machine draws.

use crate::args::CheckArgs;
use crate::camera::{CameraFile, View};
use crate::model_renderer::{self, ModelRenderer};
use crate::progress::during;
use crate::target::{self, JSON, PNG, Target};
use crate::{Outcome, output, reading, verdict};
use anyhow::Result;
use glam::DAffine3;
use selvedge::picture::{EdgeSettings, FrameStats, Outputs, TangentEdges};
use selvedge_check::drawing::LineJudgement;
use selvedge_check::{EXACT_DEPTH_PX, EXACT_NORMAL_DEG, Judgement, SunJudgement, SunTracer, Tracer};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// The judgement of one view.
#[derive(Debug, Serialize)]
struct Verdict {
    view: String,
    camera: CameraFile,
    tolerance_px: f64,
    kept: bool,
    /// Whether some pixel shows the model: if not, there was nothing to judge.
    seen: bool,
    judgement: Judgement,
    sun: Option<SunJudgement>,
    lines: Option<LineJudgement>,
    stats: FrameStats,
}

/// Draws and judges each view.
pub fn run(args: &CheckArgs) -> Result<Outcome> {
    let inputs = args.cut.inputs(&args.model);
    let json = args.json.iter().map(|path| Target::new(path, JSON));
    let difference = args.difference.iter().map(|path| Target::new(path, PNG));
    target::check(&inputs, &difference.chain(json.clone()).collect::<Vec<_>>())?;
    let mut import = reading::open(&args.model, &args.read, &args.subdivide)?;
    let missing = Some(import.summary()).filter(|summary| !summary.is_complete());
    if let Some(by) = args.moved {
        let by = DAffine3::from_translation(by);
        import.model.instances.iter_mut().for_each(|i| i.transform = by * i.transform);
    }
    args.cut.apply(&mut import.model, &args.read)?;
    let views = match args.zoom.as_slice() {
        [] => args.camera.views(args.views, &import)?,
        times => args.camera.zooms(times, &import)?,
    };
    let pictures: Vec<PathBuf> = args.difference.iter().flat_map(|path| differences(path, &views)).collect();
    let outputs: Vec<_> = pictures.iter().map(|path| Target::new(path, PNG)).chain(json).collect();
    target::check(&inputs, &outputs)?;
    target::check_read(&import, &outputs)?;
    let height = views.iter().map(|view| view.camera.size.1).min().unwrap_or(1);
    let lines = args.edges.then(|| judged_lines(height, args.silhouettes));
    let images = Outputs { edge: args.edges, ..Outputs::ALL };
    let mut renderer = ModelRenderer::with_lines(&args.frame, &import, lines, images)?;
    let tracer = during("preparing the exact model", || Tracer::new(&import.model));
    let sun =
        model_renderer::sun(&args.frame, &import).map(|towards| SunTracer::new(&import.model, towards)).transpose()?;
    let tolerance_px = args.frame.tolerance;
    let mut verdicts = Vec::new();
    for (index, View { name, camera }) in views.iter().enumerate() {
        let times = args.zoom.get(index).copied().unwrap_or(1.0);
        let picture = renderer.render(camera, images)?;
        let judgement = verdict::of(&tracer, camera, &picture, args.samples, tolerance_px, times, name);
        if let Some(path) = pictures.get(index) {
            output::png(path, picture.size, &judgement.paint())?;
        }
        let sun = sun.as_ref().map(|sun| verdict::of_sun(&tracer, sun, camera, &picture, args.samples, tolerance_px));
        let drawn = lines.as_ref().map(|lines| verdict::of_lines(&import.model, &tracer, camera, &picture, lines));
        let drawn = drawn.transpose()?;
        let wrong = verdict::wrong(&judgement) + sun.map_or(0, |sun| sun.wrong);
        let wrong = wrong + drawn.as_ref().map_or(0, |lines| lines.missing + lines.stray);
        let kept = wrong == 0 && picture.stats.clamps == 0;
        let (camera, seen, stats) = (camera.into(), model_renderer::shows(&picture), picture.stats);
        verdicts.push(Verdict {
            view: name.clone(),
            camera,
            tolerance_px,
            kept,
            seen,
            judgement,
            sun,
            lines: drawn,
            stats,
        });
    }
    let print = |text: &str| output::print_beside(text, pictures.iter().chain(&args.json));
    print(&table(&verdicts, tolerance_px))?;
    if let Some(missing) = missing {
        print(&format!("judged without what the file holds beside: {missing}"))?;
    }
    if let Some(path) = &args.json {
        output::json(path, &verdicts)?;
    }
    let blank = |v: &&Verdict| v.kept && !v.seen;
    if verdicts.iter().all(|v| blank(&v)) {
        renderer.blank(&args.model, &import.model, views[0].camera.size, &args.read)?;
    }
    for Verdict { view, .. } in verdicts.iter().filter(blank) {
        tracing::warn!("view {view}: no pixel shows anything of the model: nothing was judged");
    }
    let complained = renderer.complaints();
    Ok(if complained || verdicts.iter().any(|v| !v.kept) { Outcome::Broken } else { Outcome::Good })
}

/// Lines along all edges, and outlines where they are wanted, as wide in a picture of `height` pixels as they are at
/// 1080: thinner ones cover too little of a pixel to be judged.
fn judged_lines(height: u32, silhouettes: bool) -> EdgeSettings {
    let usual = EdgeSettings::default();
    let larger = (EdgeSettings::HEIGHT / f64::from(height)).max(1.0);
    let [width, section_width] =
        [usual.width, usual.section_width].map(|width| (width * larger).min(EdgeSettings::MOST_WIDTH));
    EdgeSettings { tangent: TangentEdges::Full, silhouettes, width, section_width, ..usual }
}

fn table(verdicts: &[Verdict], tolerance_px: f64) -> String {
    let wrong = format!("wrong > {tolerance_px} px");
    let lit = verdicts.iter().any(|v| v.sun.is_some());
    let light = lit.then_some("light: wrong, deviated, worst shift, px");
    let beyond = format!("> {EXACT_DEPTH_PX} px, {EXACT_NORMAL_DEG} deg");
    let regular = ["regular: depth, px: worst, mean", "normal, deg: worst", &beyond, "not regular"];
    let shape = ["view", "judged", &wrong, "worst shift, px"].into_iter().chain(regular);
    let drawn = verdicts.iter().any(|v| v.lines.is_some());
    let drawn = drawn.then_some("lines: points seen, missing, unsure; pixels, stray");
    let mut table = output::table(shape.chain(light).chain(drawn).chain(["clamps", "promise"]));
    for Verdict { view, judgement, sun, lines, stats, kept, seen, .. } in verdicts {
        let exact = &judgement.exact;
        let shape = [
            view.clone(),
            judgement.sampled.to_string(),
            verdict::wrong(judgement).to_string(),
            format!("{:.3}", verdict::worst_shift_px(judgement)),
            format!("{:.4}, {:.1e}", exact.depth_px.worst, exact.depth_px.mean),
            format!("{:.4}", exact.normal_deg.worst),
            exact.beyond.to_string(),
            exact.irregular.to_string(),
        ];
        let light = sun.map(|sun| format!("{}, {}, {:.3}", sun.wrong, sun.deviated, sun.worst_shift_px));
        let drawn = lines
            .as_ref()
            .map(|l| format!("{}, {}, {}; {}, {}", l.visible, l.missing, l.unsure, l.line_pixels, l.stray));
        let promise = match (kept, seen) {
            (true, true) => "kept",
            (true, false) => "nothing seen",
            (false, _) => "BROKEN",
        };
        let end = [stats.clamps.to_string(), promise.to_string()];
        table.add_row(shape.into_iter().chain(light).chain(drawn).chain(end));
    }
    table.to_string()
}

/// The file for the picture of the verdicts of each view; with several views, each with the view's name. Several
/// pictures to `-` are refused.
fn differences(path: &Path, views: &[View]) -> Vec<PathBuf> {
    let named = |view: &View| match views.len() > 1 && !target::is_standard(path) {
        true => target::with_name(path, &format!("-{}", view.name)),
        false => path.to_owned(),
    };
    views.iter().map(named).collect()
}
