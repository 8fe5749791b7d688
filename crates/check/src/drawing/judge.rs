//! Judges drawn lines against exact rays.
//!
//! ```text
//!      ──●────●────●────◌────◌──      points of an edge or silhouette, SPACING px apart: ● seen, ◌ hidden
//!      ▒▒▒▒▒▒▒▒▒▒▒▒▒▒                 pixels of lines
//!
//!   missing   a point that is seen, and no pixel of a line has its centre within half a width + 0.5 px of it
//!   stray     a pixel of a line whose centre is farther than that from all that is seen
//! ```
//!
//! What is seen is taken to reach from point to point, to the first point that is hidden, and to the end of the edge: where
//! visibility changes is known to [`SPACING`]. Beside what would be a stray pixel, edges are looked at again, every 1/32 px:
//! of an edge that touches a surface from behind, less than [`SPACING`] may be seen. Points flush with the face of another
//! body or beside a fold ([`Visibility::Unsure`](crate::Visibility)) need no line and excuse one; they are counted. Points
//! just beside the picture excuse lines at its border.
//!
//! Of Boolean solids, `solid_lines.rs` says where the surface that is seen changes between the centres of pixels: such
//! a place is a point here.

use super::path::View;
use super::sight::{Sight, State};
use super::solid_lines::{self, Place};
use super::sources::Scene;
use super::{DrawingError, DrawingSettings, LineKind, LineSource, Path};
use crate::model::{Camera, Model};
use crate::{Probe, Tracer};
use glam::DVec2;
use rayon::prelude::*;
use serde::Serialize;

/// Pixels between points.
pub const SPACING: f64 = 0.5;
/// Beside half the width, how far a line may be off: pixels.
pub const SLACK: f64 = 0.5;
/// Points asked between two points, where a pixel of a line would be stray: 1/32 px apart.
const LOOKS: u32 = 16;
/// Most faults that the report lists with their places.
const TOLD: usize = 16;

/// A picture of lines.
#[derive(Clone, Copy, Debug)]
pub struct LineImage<'i> {
    /// For each pixel, row 0 on top, a number of the line that covers it, 0 for none; as many as the camera has pixels.
    pub lines: &'i [u32],
    /// Width of the lines, pixels.
    pub width: f64,
    /// Width of the outlines of sections through Boolean solids, pixels.
    pub section_width: f64,
}

/// A place where a picture of lines is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LineFault {
    /// In the picture: of a missing line the point, of a stray one the centre of its pixel.
    pub pixel: [f64; 2],
    /// Of a missing line: the instance.
    pub instance: Option<usize>,
    /// Of a missing line: the edge, or the face that folds, or the mesh; without an instance, the primitive in the union
    /// of all Boolean solids.
    pub index: Option<usize>,
}

/// What was found.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct LineJudgement {
    /// Points asked, in the picture.
    pub points: u64,
    /// Those that are seen.
    pub visible: u64,
    /// Those flush with something else.
    pub unsure: u64,
    /// Points that are seen and have no line.
    pub missing: u64,
    /// Pixels of lines.
    pub line_pixels: u64,
    /// Those without anything seen that they could be a line of.
    pub stray: u64,
    /// Some of the missing.
    pub missing_at: Vec<LineFault>,
    /// Some of the stray.
    pub stray_at: Vec<LineFault>,
}

/// Whether a line has to be at a point.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Need {
    Must,
    /// Flush with something else.
    Unsure,
    /// A dashed line.
    May,
    No,
    /// Seen or unsure, beside the picture: excuses lines.
    Beside,
    /// An end of the path, which is not asked, or hidden beside the picture.
    End,
}

/// A point and what it needs.
#[derive(Clone, Copy)]
struct Sample {
    pixel: DVec2,
    parameter: f64,
    need: Need,
}

/// Judges a picture of the lines that `settings` ask for. Where these ask for hidden lines too, such lines need not be
/// there, for they are dashed.
///
/// # Errors
/// [`DrawingError`] for a part, or an operand of a Boolean solid, whose faces have no boundary curves.
///
/// # Panics
/// When the image is not as large as the camera says, or a width is no number above 0.
pub fn judge_lines(
    model: &Model,
    tracer: &Tracer,
    camera: &Camera,
    settings: &DrawingSettings,
    image: LineImage<'_>,
) -> Result<LineJudgement, DrawingError> {
    let (width, height) = (camera.size.0 as usize, camera.size.1 as usize);
    assert_eq!(image.lines.len(), width * height, "a number for each pixel");
    let is_width = |width: f64| width > 0.0 && width.is_finite();
    assert!(is_width(image.width) && is_width(image.section_width), "a line has a width");
    let scene = Scene::new(model, tracer)?;
    let reach = 0.5 * image.width + SLACK;
    let view = View::new(camera).with_beyond(reach);
    let paths = scene.paths(&view, settings.silhouettes).paths;
    let sampled: Vec<(&Path<'_>, Vec<Vec<Sample>>)> = paths
        .par_iter()
        .map_init(|| tracer.probe(camera), |probe, path| (path, samples(&scene, &view, path, settings, probe)))
        .collect();
    let mut raster = Raster { width, height, reach, near: vec![false; width * height] };
    let mut out = LineJudgement::default();
    for (path, runs) in &sampled {
        for run in runs {
            for (k, sample) in run.iter().enumerate().filter(|(_, sample)| sample.need != Need::End) {
                out.points += u64::from(sample.need != Need::Beside);
                out.unsure += u64::from(sample.need == Need::Unsure);
                if sample.need == Need::No {
                    continue;
                }
                for other in [k.checked_sub(1), Some(k), Some(k + 1)].into_iter().flatten().filter_map(|k| run.get(k)) {
                    raster.mark(sample.pixel, other.pixel);
                }
                if sample.need != Need::Must {
                    continue;
                }
                out.visible += 1;
                if !raster.pixels(sample.pixel, sample.pixel).any(|at| image.lines[at] != 0) {
                    out.missing += 1;
                    if out.missing_at.len() < TOLD {
                        let (instance, index) = numbers(path.source);
                        let fault = LineFault { pixel: sample.pixel.into(), instance, index };
                        out.missing_at.push(fault);
                    }
                }
            }
        }
    }
    for place in &solid_lines::places(model, tracer, &view, camera, settings)? {
        let width = if place.is_outline { image.section_width } else { image.width };
        raster.judge(place, 0.5 * width + SLACK, image.lines, &mut out);
    }
    let stray = |at: usize| image.lines[at] != 0 && !raster.near[at];
    let again = |probe: &mut Probe<'_>, (path, runs): &(&Path<'_>, Vec<Vec<Sample>>)| {
        let pairs = runs.iter().flat_map(|run| run.windows(2));
        let pairs = pairs.filter(|pair| raster.pixels(pair[0].pixel, pair[1].pixel).any(stray));
        seen_between(&Sight::new(&scene, &view, path, settings.silhouettes), (path, &view), pairs, settings, probe)
    };
    let found: Vec<Vec<DVec2>> = sampled.par_iter().map_init(|| tracer.probe(camera), again).collect();
    for place in found.into_iter().flatten() {
        raster.mark(place, place);
    }
    for at in (0..image.lines.len()).filter(|at| image.lines[*at] != 0) {
        out.line_pixels += 1;
        if !raster.near[at] {
            out.stray += 1;
            if out.stray_at.len() < TOLD {
                let pixel = [(at % width) as f64 + 0.5, (at / width) as f64 + 0.5];
                out.stray_at.push(LineFault { pixel, instance: None, index: None });
            }
        }
    }
    Ok(out)
}

fn numbers(source: LineSource) -> (Option<usize>, Option<usize>) {
    let (instance, index) = match source {
        LineSource::Edge { instance, edge } => (instance, edge),
        LineSource::Fold { instance, face } => (instance, face),
        LineSource::Side { instance, mesh } => (instance, mesh),
    };
    (Some(instance), Some(index))
}

/// Points of a path, those of one stretch in the picture together.
fn samples(
    scene: &Scene<'_>,
    view: &View,
    path: &Path<'_>,
    settings: &DrawingSettings,
    probe: &mut Probe<'_>,
) -> Vec<Vec<Sample>> {
    let contour = matches!(path.kind, LineKind::Smooth | LineKind::Seam) && settings.silhouettes;
    let length = path.length();
    if !(settings.draws(path.kind) || contour) || length <= 0.0 {
        return Vec::new();
    }
    let sight = Sight::new(scene, view, path, settings.silhouettes);
    let count = (length / SPACING).ceil().max(1.0) as usize;
    let end = |parameter: f64| {
        path.spot(view, parameter).map(|spot| Sample { pixel: spot.pixel, parameter, need: Need::End })
    };
    let (from, to) = path.range;
    let mut runs: Vec<Vec<Sample>> = vec![end(from).into_iter().collect()];
    for k in 0..count {
        let parameter = path.parameter(length * (k as f64 + 0.5) / count as f64);
        let (kind, need) = match sight.state(parameter, probe) {
            State::Gone => (None, Need::No),
            State::Seen(kind) => (Some(kind), Need::Must),
            State::Unsure(kind) => (Some(kind), Need::Unsure),
            State::Hidden(kind) => (Some(kind), if settings.hidden { Need::May } else { Need::No }),
        };
        match (kind.filter(|kind| settings.draws(*kind)), path.spot(view, parameter)) {
            (Some(_), Some(spot)) => {
                let need = match need {
                    _ if view.holds(spot.pixel, 0.0) => need,
                    Need::Must | Need::Unsure => Need::Beside,
                    _ => Need::End,
                };
                runs.last_mut().expect("one at least").push(Sample { pixel: spot.pixel, parameter, need });
            }
            _ => runs.push(Vec::new()),
        }
    }
    runs.last_mut().expect("one at least").extend(end(to));
    runs
}

/// What may be seen of a path between neighbouring points: places in the picture.
fn seen_between<'s>(
    sight: &Sight<'_>,
    (path, view): (&Path<'_>, &View),
    pairs: impl Iterator<Item = &'s [Sample]>,
    settings: &DrawingSettings,
    probe: &mut Probe<'_>,
) -> Vec<DVec2> {
    let inner = |pair: &[Sample]| {
        let (a, b) = (pair[0].parameter, pair[1].parameter);
        (1..LOOKS).map(move |k| a + (b - a) * f64::from(k) / f64::from(LOOKS))
    };
    let seen = |parameter: &f64| match sight.state(*parameter, probe) {
        State::Seen(kind) | State::Unsure(kind) => settings.draws(kind),
        State::Gone | State::Hidden(_) => false,
    };
    let places = pairs.flat_map(inner).filter(seen).filter_map(|parameter| path.spot(view, parameter));
    places.map(|spot| spot.pixel).collect()
}

/// Pixels near to what is seen.
struct Raster {
    width: usize,
    height: usize,
    reach: f64,
    near: Vec<bool>,
}

impl Raster {
    /// Indices of the pixels whose centres are within reach of a segment.
    fn pixels(&self, a: DVec2, b: DVec2) -> impl Iterator<Item = usize> + use<> {
        self.within(a, b, self.reach)
    }

    /// Those within another reach.
    fn within(&self, a: DVec2, b: DVec2, reach: f64) -> impl Iterator<Item = usize> + use<> {
        let width = self.width;
        let low = (a.min(b) - reach - 0.5).ceil().max(DVec2::ZERO);
        let size = DVec2::new(self.width as f64, self.height as f64);
        let high = (a.max(b) + reach - 0.5).floor().min(size - 1.0);
        let rows = low.y as usize..(high.y + 1.0).max(0.0) as usize;
        let columns = low.x as usize..(high.x + 1.0).max(0.0) as usize;
        rows.flat_map(move |y| columns.clone().map(move |x| (x, y))).filter_map(move |(x, y)| {
            let centre = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
            let along = b - a;
            let share = ((centre - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            let off = centre.distance(if share.is_nan() { a } else { a + along * share });
            (off <= reach).then_some(y * width + x)
        })
    }

    fn mark(&mut self, a: DVec2, b: DVec2) {
        for at in self.pixels(a, b) {
            self.near[at] = true;
        }
    }

    /// A place of a Boolean solid, with lines that reach so far.
    fn judge(&mut self, place: &Place, reach: f64, lines: &[u32], out: &mut LineJudgement) {
        let [a, b] = place.ends;
        for at in self.within(a, b, reach + place.off) {
            self.near[at] = true;
        }
        let is_known = match place.need {
            solid_lines::Need::Must => true,
            solid_lines::Need::Unsure => false,
            solid_lines::Need::May => return,
        };
        out.points += 1;
        out.visible += u64::from(is_known);
        out.unsure += u64::from(!is_known);
        if is_known && !self.within(a, b, reach).any(|at| lines[at] != 0) {
            out.missing += 1;
            if out.missing_at.len() < TOLD {
                out.missing_at.push(LineFault { pixel: a.into(), instance: None, index: Some(place.primitive) });
            }
        }
    }
}
