//! The bound beside fixed levels with no larger error.
//!
//! ```text
//!   view of each zoom ─▶ error of the bound, of all patches ─▶ smallest level with no larger error    one a view
//!                                                                          ╰──▶ the largest of them    one a model
//! ```
//!
//! The error of a level is computed, not judged: the largest distance in pixels between triangles and surface, over all
//! patches that may be in the picture. A program with fixed levels has one level a model, for all views of a session.

use super::{FrameSettings, HeadlessRenderer, Outputs, WARM_UP_FRAMES, camera, pass_ms, renderer};
use crate::args::{Size, SweepArgs};
use crate::progress::during;
use crate::{Outcome, output};
use anyhow::Result;
use selvedge::baselines::factors::{Seen, Way};
use selvedge::model::{Camera, Model};
use selvedge::picture::{FrameStats, Levels};

/// The level that is drawn where none suffices.
const FINEST: u32 = 64;

/// A view of a model.
struct View {
    zoom: f64,
    camera: Camera,
    /// The error of the bound, pixels.
    bound_px: f64,
    /// The smallest sufficient level; where there is none, the error of the finest.
    level: Result<u32, f64>,
}

/// One table over all models.
pub fn run(args: &SweepArgs, models: &[(String, Model)]) -> Result<Outcome> {
    let head = ["model", "size", "px", "zoom", "off by, px", "ms", "triangles"];
    let own = ["level of the view", "ms", "triangles", "ratio"];
    let all = ["level of all views", "ms", "triangles", "ratio"];
    let mut table = output::table([&head[..], &own, &all].concat());
    let mut device = String::new();
    for (name, model) in models {
        let mut renderer = renderer(args)?;
        during("uploading the model", || renderer.upload(model))?;
        for &Size(width, height) in &args.sizes {
            for &tolerance_px in &args.tolerances {
                let view = |&zoom: &f64| View::new(model, zoom, (width, height), tolerance_px);
                let views: Vec<_> = during("looking for levels", || args.zooms.iter().map(view).collect());
                let most = views.iter().map(|v| v.level.unwrap_or(FINEST)).max().unwrap_or(FINEST);
                let mut sums = [0.0; 3];
                for view in &views {
                    let level = view.level.unwrap_or(FINEST);
                    let ways = [Levels::Bound, Levels::Fixed(level), Levels::Fixed(most)];
                    let frames = in_turn(&mut renderer, args.frames, &view.camera, tolerance_px, ways)?;
                    device = format!("{} ({})", frames[0][0].device, frames[0][0].driver);
                    let ms: [f64; 3] = std::array::from_fn(|i| pass_ms(&frames[i], ""));
                    (0..3).for_each(|i| sums[i] += ms[i]);
                    let triangles = |i: usize| frames[i][0].triangles.to_string();
                    let label = |level: u32| match view.level {
                        Err(px) if level == FINEST => format!("64 is off by {px:.3}"),
                        _ => level.to_string(),
                    };
                    table.add_row([
                        name.clone(),
                        format!("{width}x{height}"),
                        tolerance_px.to_string(),
                        view.zoom.to_string(),
                        format!("{:.4}", view.bound_px),
                        format!("{:.1}", ms[0]),
                        triangles(0),
                        label(level),
                        format!("{:.1}", ms[1]),
                        triangles(1),
                        format!("{:.2}", ms[1] / ms[0]),
                        label(most),
                        format!("{:.1}", ms[2]),
                        triangles(2),
                        format!("{:.2}", ms[2] / ms[0]),
                    ]);
                }
                let mut row = vec![String::new(); head.len() + own.len() + all.len()];
                (row[0], row[3]) = (name.clone(), "all".into());
                for (i, at) in [5, 8, 12].into_iter().enumerate() {
                    row[at] = format!("{:.1}", sums[i]);
                }
                (row[10], row[14]) = (format!("{:.2}", sums[1] / sums[0]), format!("{:.2}", sums[2] / sums[0]));
                table.add_row(row);
            }
        }
    }
    output::print(&format!("{device}\n{table}\n"))?;
    Ok(Outcome::Good)
}

impl View {
    fn new(model: &Model, zoom: f64, size: (u32, u32), tolerance_px: f64) -> Self {
        let camera = camera(model, zoom, size);
        let seen = Seen::new(model, &camera, tolerance_px);
        let bound_px = seen.deviation_px(Way::Bound);
        let level = seen.level(bound_px).ok_or_else(|| seen.deviation_px(Way::Fixed(FINEST as usize)));
        Self { zoom, camera, bound_px, level }
    }
}

/// Frames of each, one after the other.
fn in_turn(
    renderer: &mut HeadlessRenderer,
    count: usize,
    camera: &Camera,
    tolerance_px: f64,
    ways: [Levels; 3],
) -> Result<[Vec<FrameStats>; 3]> {
    let mut frames = [const { Vec::new() }; 3];
    for frame in 0..WARM_UP_FRAMES + count {
        for (levels, frames) in ways.into_iter().zip(&mut frames) {
            let settings = FrameSettings { tolerance_px, levels, all_passes: true, ..FrameSettings::default() };
            let stats = renderer.render(camera, &settings, Outputs::default())?.stats;
            if frame >= WARM_UP_FRAMES {
                frames.push(stats);
            }
        }
    }
    Ok(frames)
}
