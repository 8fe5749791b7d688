//! A view of a model as a drawing: edges and silhouettes as curves in the picture, hidden lines apart.
//!
//! ```text
//!   sources  edges, folds of faces, sides of triangles ─▶ paths: exact curves, followed by chords
//!   meet     where chords cross or touch ─▶ places at which visibility may change
//!   sight    exact rays ─▶ what a place on a path is
//!   runs     places, samples between them, bisection ─▶ stretches of one state
//!   fit      stretches ─▶ cubic Bézier curves, to a measured distance
//!   join     lines that continue each other ─▶ strokes
//!   judge    a picture of lines against points of all paths, and of Boolean solids against rays beside each other
//! ```
//!
//! *Accuracy.* Cubics are within [`DrawingSettings::tolerance`] of the exact curve at 15 points a piece, and
//! [`Drawing::deviation`] is the largest distance. An end lies at the crossing of two exact curves where rays 0.02 px beside it agree, else within
//! 0.005 px by bisection. Stretches between samples 3 px apart that no crossing of lines begins or ends are missed.
//!
//! A line that lies on another along a whole stretch is drawn once: the nearer one. Points flush with the face of another
//! body count as seen. In drawings, Boolean solids hide what is behind them and have no lines of their own; the judge
//! knows where theirs have to be.
//!
//! Source: A. Appel, *The notion of quantitative invisibility and the machine rendering of solids*, 1967 (visibility
//! changes where lines cross); G. Elber, E. Cohen, *Hidden curve removal for free form surfaces*, SIGGRAPH 1990.

mod changes;
mod fit;
mod join;
mod judge;
mod meet;
mod path;
mod runs;
mod sight;
mod solid_lines;
mod sources;

pub use fit::{Cubic, cubic_at};
pub use join::Stroke;
pub use judge::{LineFault, LineImage, LineJudgement, SLACK, SPACING, judge_lines};
pub use path::LineSource;

use crate::Tracer;
use crate::model::{Camera, Model};
use meet::Meetings;
use path::{Path, View};
use rayon::prelude::*;
use runs::Run;
use selvedge_geometry::edges::EdgeError;
use sight::{Sight, State};
use sources::Scene;

/// What a line is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LineKind {
    /// Faces meet at an angle.
    Sharp,
    /// A face ends.
    Border,
    /// A face turns away from the eye.
    Silhouette,
    /// Faces continue each other.
    Smooth,
    /// A closed face meets itself: no line, but where it is a silhouette.
    Seam,
}

/// Which lines are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawingSettings {
    /// Edges at an angle, and borders.
    pub sharp: bool,
    /// Edges at which faces continue each other.
    pub smooth: bool,
    /// Where faces turn away from the eye.
    pub silhouettes: bool,
    /// Also what is hidden.
    pub hidden: bool,
    /// Pixels by which a cubic may leave the exact curve.
    pub tolerance: f64,
}

impl Default for DrawingSettings {
    fn default() -> Self {
        Self { sharp: true, smooth: true, silhouettes: true, hidden: false, tolerance: 0.005 }
    }
}

impl DrawingSettings {
    fn draws(&self, kind: LineKind) -> bool {
        match kind {
            LineKind::Sharp | LineKind::Border => self.sharp,
            LineKind::Smooth => self.smooth,
            LineKind::Silhouette => self.silhouettes,
            LineKind::Seam => false,
        }
    }
}

/// Why there is no drawing.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DrawingError {
    /// A part has no edges.
    #[error("part {part}: {source}")]
    Edges {
        /// Index into [`Model::parts`]; beyond them, of an operand, that of its primitive in the solids' union.
        part: usize,
        /// What is wrong with it.
        source: EdgeError,
    },
}

/// A stretch of an edge or a silhouette in the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// What it is.
    pub kind: LineKind,
    /// Whether something is before it.
    pub hidden: bool,
    /// What it is a picture of.
    pub source: LineSource,
    /// Pixels, `y` down, end to end.
    pub curves: Vec<Cubic>,
    /// Its length, pixels.
    pub length: f64,
}

/// Lines of a view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// In the order of the model.
    pub lines: Vec<Line>,
    /// Largest distance of a cubic from the exact curve that was measured, pixels.
    pub deviation: f64,
    /// Cells of folds that are left out: see
    /// [`Silhouette::unresolved`](selvedge_geometry::silhouette::Silhouette::unresolved).
    pub unresolved: usize,
}

impl Drawing {
    /// Draws a model; `tracer` is the model's.
    ///
    /// # Errors
    /// [`DrawingError`] for a part whose faces have no boundary curves.
    pub fn new(
        model: &Model,
        tracer: &Tracer,
        camera: &Camera,
        settings: &DrawingSettings,
    ) -> Result<Self, DrawingError> {
        let scene = Scene::new(model, tracer)?;
        let view = View::new(camera);
        let found = scene.paths(&view, true);
        let paths = &found.paths[..];
        let meetings = Meetings::new(paths, &view, |kind| settings.draws(kind));
        let places = meetings.places();
        let job = |probe: &mut crate::Probe<'_>, (number, path): (usize, &Path<'_>)| {
            // a smooth edge or a seam may be a silhouette
            let may = settings.draws(path.kind)
                || settings.silhouettes && matches!(path.kind, LineKind::Smooth | LineKind::Seam);
            if !may {
                return (Vec::new(), 0.0);
            }
            let sight = Sight::new(&scene, &view, path, settings.silhouettes);
            let runs = runs::runs(number, path, &sight, &meetings, &places[number], probe);
            lines(path, &view, &runs, settings)
        };
        let drawn: Vec<(Vec<Line>, f64)> =
            paths.par_iter().enumerate().map_init(|| tracer.probe(camera), job).collect();
        let deviation = drawn.iter().map(|d| d.1).fold(0.0, f64::max);
        let lines = drawn.into_iter().flat_map(|d| d.0).collect();
        Ok(Self { lines, deviation, unresolved: found.unresolved })
    }

    /// The lines joined where they continue each other.
    pub fn strokes(&self) -> Vec<Stroke> {
        join::strokes(&self.lines)
    }
}

/// The lines of a path's stretches, and the largest distance of their curves.
fn lines(path: &Path<'_>, view: &View, runs: &[Run], settings: &DrawingSettings) -> (Vec<Line>, f64) {
    let mut worst: f64 = 0.0;
    let line = |run: &Run| {
        let (kind, hidden) = match run.state {
            State::Seen(kind) | State::Unsure(kind) => (kind, false),
            State::Hidden(kind) => (kind, true),
            State::Gone => return None,
        };
        if !settings.draws(kind) || hidden && !settings.hidden {
            return None;
        }
        let (curves, off) = fit::fit(path, view, (run.from, run.to), settings.tolerance);
        worst = worst.max(off);
        Some(Line { kind, hidden, source: path.source, curves, length: run.to - run.from })
    };
    let lines = runs.iter().filter_map(line).collect();
    (lines, worst)
}
