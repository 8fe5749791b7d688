//! `selvedge check`: the accuracy promise, tested on the pictures that this machine draws.
//!
//! The promise: a pixel shows what the exact model shows at a point at most half a pixel away. The
//! judge asks [`selvedge::reference`], which intersects rays with the exact surfaces and classifies the hits
//! against the exact trim curves in double precision, and shares no code with the GPU passes.

use crate::args::CheckArgs;
use crate::camera::{CameraFile, View};
use crate::progress::during;
use crate::session::{self, Session};
use crate::{Outcome, output};
use anyhow::Result;
use comfy_table::{Table, presets};
use selvedge::picture::{FrameStats, Outputs, Picture};
use selvedge::reference::{JudgeOptions, Judgement, Tracer, judge};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// What was found in one view.
#[derive(Debug, Serialize)]
struct Verdict {
    view: &'static str,
    camera: CameraFile,
    kept: bool,
    judgement: Judgement,
    stats: FrameStats,
}

/// Draws and judges each view.
pub fn run(args: &CheckArgs) -> Result<Outcome> {
    let import = session::open(&args.model)?;
    let views = args.camera.views(args.views, &import.model)?;
    let mut session = Session::new(&args.frame, &import)?;
    let tracer = during("preparing the exact model", || Tracer::new(&import.model));
    let options = JudgeOptions { samples: args.samples, ..JudgeOptions::default() };
    let mut verdicts = Vec::new();
    for View { name, camera } in &views {
        let picture = session.render(camera, Outputs::ALL)?;
        let judgement = during(&format!("judging {name}"), || judge(&tracer, camera, &picture, &options));
        if let Some(path) = &args.difference {
            let path = if views.len() > 1 { with_name(path, name) } else { path.clone() };
            output::png(&path, picture.size, &difference(&picture, &judgement))?;
        }
        let kept = judgement.wrong == 0 && picture.stats.clamps == 0;
        verdicts.push(Verdict { view: name, camera: camera.into(), kept, judgement, stats: picture.stats });
    }
    output::print(&table(&verdicts))?;
    if let Some(path) = &args.json {
        output::json(path, &verdicts)?;
    }
    let complained = session.complaints();
    Ok(if complained || verdicts.iter().any(|v| !v.kept) { Outcome::Broken } else { Outcome::Good })
}

fn table(verdicts: &[Verdict]) -> String {
    let mut table = Table::new();
    table.load_preset(presets::UTF8_HORIZONTAL_ONLY);
    table.set_header([
        "view",
        "judged",
        "wrong > 0.5 px",
        "worst shift, px",
        "depth error: worst, mean, mm",
        "normal, deg",
        "clamps",
        "promise",
    ]);
    for Verdict { view, judgement: j, stats, kept, .. } in verdicts {
        table.add_row([
            (*view).to_string(),
            j.samples.to_string(),
            j.wrong.to_string(),
            format!("{:.3}", j.worst_shift_px),
            format!("{:.2e}, {:.2e}", j.worst_depth, j.mean_depth),
            format!("{:.3}", j.worst_normal_deg),
            stats.clamps.to_string(),
            if *kept { "kept" } else { "BROKEN" }.to_string(),
        ]);
    }
    table.to_string()
}

/// The picture faded to grey, with the wrong pixels in red.
fn difference(picture: &Picture, judgement: &Judgement) -> Vec<[u8; 4]> {
    let fade = |[r, g, b, _]: [u8; 4]| {
        let grey = (u16::from(r) + u16::from(g) + u16::from(b)) / 3;
        let light = 128 + (grey / 2) as u8;
        [light, light, light, 255]
    };
    let mut pixels: Vec<[u8; 4]> = picture.colour.iter().map(|&c| fade(c)).collect();
    for &(x, y) in &judgement.failures {
        pixels[y as usize * picture.size.0 as usize + x as usize] = [220, 0, 0, 255];
    }
    pixels
}

/// `out.png` becomes `out-close.png`.
fn with_name(path: &Path, view: &str) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let end = path.extension().map_or(String::new(), |e| format!(".{}", e.to_string_lossy()));
    path.with_file_name(format!("{stem}-{view}{end}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn view_names_go_before_the_extension() {
        assert_eq!(with_name(Path::new("a/b.c.png"), "close"), Path::new("a/b.c-close.png"));
        assert_eq!(with_name(Path::new("plain"), "whole"), Path::new("plain-whole"));
    }
}
