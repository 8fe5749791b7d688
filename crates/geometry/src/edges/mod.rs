//! The edges of a part, from its faces, their loops and the shared edges that the source states.
//!
//! ```text
//!   sheet     loops of each face, in (u, v) and in space
//!   stretch   loops cut at vertices: edges of the source as they are, the rest where it passes a vertex
//!   join      stretches that are one edge: by the source, else by geometry
//!   kind      sharp, smooth, seam, border: by the angle across it
//!   mesh      creases and borders of triangles, and the sides between
//!   flatten   an edge as a line in the picture
//!   nearest   the point of an edge nearest to a pixel
//!   track     the place in a face's (u, v) next to a point of its edge
//!   curve     length and middle of an edge; the line or circle that it is
//! ```
//!
//! Edges are found on demand, not when a file is read. An import stores only data that cannot be found again: the edge
//! of the source of each trim curve. Pictures without lines do not pay for the rest. A curve found from the trimmed
//! surface lies on that surface; the curve stated by the file may lie beside it.
//!
//! Tolerances, in shares of the diagonal of the part's control points: points within `1e-5` are one; where a part should
//! be closed and is not, loops without partner may be `2e-4` apart; fits aim at `1e-8`.

pub mod curve;
mod cut;
pub mod flatten;
mod join;
mod kind;
mod mesh;
pub mod nearest;
mod sheet;
mod stretch;
mod track;
mod vertices;

pub use cut::CutCurve;
pub use sheet::Sheet;
pub use track::Track;

use crate::math::golden::section;
use crate::model::{Bounds, Edge, EdgeLimits, EdgeUse, Edges, Face, Part, SmoothSide};
use crate::spline::SplineError;
use glam::DVec3;
use join::{Boundaries, join};
use rayon::prelude::*;
use stretch::Stretch;

/// Points that are the same, in shares of the part's diagonal.
pub const REACH: f64 = 1e-5;
/// How far apart loose edges may lie that no other edge meets, in shares of the part's diagonal: a few times the gaps
/// of sloppy files. For parts that should be closed, and for pieces of one edge of the source.
pub const LOOSE: f64 = 2e-4;
/// Reach for parts that bound a volume but whose edges do not meet, in turn.
const RETRIED: [f64; 2] = [1e-5, 4e-5];
/// Aim of fitted curves, in shares of the part's diagonal.
const FIT: f64 = 1e-8;
/// Steps of a golden section.
const SECTIONS: usize = 48;

/// A face whose boundary is no curve.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the boundary of face {face} of the part: {source}")]
pub struct EdgeError {
    /// Index into the part's faces.
    pub face: usize,
    /// The reason.
    pub source: SplineError,
}

impl Part {
    /// The part's edges and vertices, by the default [`EdgeLimits`].
    ///
    /// # Errors
    /// As [`Part::edges_within`].
    pub fn edges(&self) -> Result<Edges, EdgeError> {
        self.edges_within(&EdgeLimits::default())
    }

    /// The part's edges and vertices.
    ///
    /// Each trim curve that is not a point in space belongs to one use of one edge. An edge of the source is one edge,
    /// unless the seam of a face cuts it. Edges that the source shares are not searched for.
    ///
    /// # Errors
    /// [`EdgeError`] for a face whose surface or loops overflow.
    pub fn edges_within(&self, limits: &EdgeLimits) -> Result<Edges, EdgeError> {
        let sheets: Vec<Sheet> = self.faces.par_iter().map(Sheet::new).collect();
        let size = self.faces.iter().map(Face::control_bounds).fold(Bounds::EMPTY, Bounds::union).diagonal();
        let (found, reach) = found(&sheets, self.closed, size);
        let mut edges = self.assembled(&sheets, found, (reach, size), limits)?;
        edges.of_meshes = mesh::edges(&self.meshes, limits.crease);
        Ok(edges)
    }

    /// Sides of triangles that are outlines in some views: those of two triangles with an area that turn by at most
    /// `limits.crease`. In the order of their first triangle.
    pub fn smooth_sides(&self, limits: &EdgeLimits) -> Vec<SmoothSide> {
        mesh::smooth_sides(&self.meshes, limits.crease)
    }

    fn assembled(
        &self,
        sheets: &[Sheet],
        found: Boundaries,
        (reach, size): (f64, f64),
        limits: &EdgeLimits,
    ) -> Result<Edges, EdgeError> {
        let stretches = &found.cut.stretches;
        let edge = |uses: &Vec<(usize, bool)>| {
            // the curve comes from the face on which it is exact
            let exact = |(s, _): &(usize, bool)| sheets[stretches[*s].face].is_exact(&stretches[*s].pieces);
            let base = uses.iter().position(exact).unwrap_or(0);
            let along = uses[base].1;
            let order = std::iter::once(base).chain((0..uses.len()).filter(|k| *k != base));
            let ordered: Vec<(usize, bool)> = order.map(|k| (uses[k].0, uses[k].1 == along)).collect();
            let first = &stretches[ordered[0].0];
            let error = |source| EdgeError { face: first.face, source };
            let (curve, deviation) = sheets[first.face].in_space(&first.pieces, FIT * size).map_err(error)?;
            let used = |&(s, forward): &(usize, bool)| {
                let Stretch { face, trim_loop, range, .. } = stretches[s];
                EdgeUse { face, trim_loop, range, forward }
            };
            let uses: Vec<EdgeUse> = ordered.iter().map(used).collect();
            let stated = ordered.iter().find_map(|(s, _)| stretches[*s].edge);
            let source = stated.and_then(|e| *self.stated_edges.get(e.edge as usize)?);
            let (kind, turn, apart) = kind::kind(sheets, stretches, &ordered, limits.smooth);
            Ok((Edge { curve, ends: first.ends, uses, source, kind, turn, deviation: apart }, deviation))
        };
        let all: Vec<(Edge, f64)> = found.edges.par_iter().map(edge).collect::<Result<_, EdgeError>>()?;
        let known = all.iter().map(|e| e.1).fold(found.cut.deviation, f64::max);
        let mut edges: Vec<Edge> = all.into_iter().map(|e| e.0).collect();
        // edges that the source shares are as far apart as it has them, each by itself
        edges.iter_mut().for_each(|e| e.deviation = e.deviation.max(known));
        let deviation = edges.iter().map(|e| e.deviation).fold(known, f64::max);
        let mut number = vec![None; found.cut.vertices.points.len()];
        let mut vertices: Vec<DVec3> = Vec::new();
        for end in edges.iter_mut().flat_map(|e| &mut e.ends) {
            *end = *number[*end].get_or_insert_with(|| {
                vertices.push(found.cut.vertices.points[*end]);
                vertices.len() - 1
            });
        }
        Ok(Edges { vertices, edges, of_meshes: Vec::new(), reach, deviation, lost: found.cut.lost })
    }
}

/// Stretches joined within [`REACH`]; of a part that should be closed, more loosely where that closes more.
fn found(sheets: &[Sheet], closed: bool, size: f64) -> (Boundaries, f64) {
    let mut out = (join(sheets, REACH * size, size), REACH * size);
    for reach in if closed { &RETRIED[..] } else { &[] } {
        if out.0.single() == 0 {
            break;
        }
        let mut other = join(sheets, reach * size, size);
        other.mend(sheets, LOOSE * size);
        // a reach that swallows a loop is too wide
        if out.0.kept_loops() == other.kept_loops() && other.single() < out.0.single() {
            out = (other, reach * size);
        }
    }
    out
}

/// Parameter in `[0, 1]` and distance of the point of `curve` next to `p`: the best of `samples`, which are at equal
/// steps, refined where it is within `worth`.
fn nearest(curve: &dyn Fn(f64) -> DVec3, samples: &[DVec3], p: DVec3, worth: f64) -> (f64, f64) {
    let step = 1.0 / (samples.len() - 1) as f64;
    let measured = samples.iter().enumerate().map(|(k, q)| (q.distance_squared(p), k));
    let (least, k) = measured.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, 0));
    let best = k as f64 * step;
    if least.sqrt() > worth {
        return (best, least.sqrt());
    }
    let at = |t: f64| curve(t).distance_squared(p);
    let [c, d] = section(((best - step).max(0.0), (best + step).min(1.0)), SECTIONS, at);
    let t = 0.5 * (c + d);
    let found = at(t);
    if found <= least { (t, found.sqrt()) } else { (best, least.sqrt()) }
}
