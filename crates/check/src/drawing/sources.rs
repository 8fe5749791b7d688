//! All curves of a model that a view may show as lines: edges, folds, sides of triangles.

use super::path::{Curve, LineSource, Path, View};
use super::{DrawingError, LineKind};
use crate::Tracer;
use crate::model::{Edge, EdgeKind, Edges, Model};
use glam::{DAffine3, DMat4, DVec2, DVec3};
use rayon::prelude::*;
use selvedge_geometry::edges::Sheet;
use selvedge_geometry::silhouette::{Fold, Silhouette};
use selvedge_geometry::spline::Bezier;
use selvedge_geometry::trim::LoopIndex;
use std::collections::HashMap;
use std::sync::Arc;

/// Samples of a branch of a fold, between which trims and cusps are looked for.
const SAMPLES: u32 = 24;
/// A fold this near to a trim curve, in shares of the domain, runs along it: the edge is the fold there.
const ALONG: f64 = 1e-7;
/// Share of a branch to which a cut is found.
const PLACE: f64 = 1e-10;

/// A model made ready for drawings: surfaces cut, loops indexed, edges found.
#[derive(Debug)]
pub(crate) struct Scene<'a> {
    pub model: &'a Model,
    pub tracer: &'a Tracer,
    pub sheets: Vec<Vec<Sheet<'a>>>,
    pub edges: Vec<Edges>,
    loops: Vec<Vec<LoopIndex>>,
}

/// Paths, and what was left out.
pub(crate) struct Paths<'s> {
    pub paths: Vec<Path<'s>>,
    pub unresolved: usize,
}

impl<'a> Scene<'a> {
    pub fn new(model: &'a Model, tracer: &'a Tracer) -> Result<Self, DrawingError> {
        let edges =
            |(part, p): (usize, &crate::model::Part)| p.edges().map_err(|source| DrawingError::Edges { part, source });
        let edges = model.parts.par_iter().enumerate().map(edges).collect::<Result<_, _>>()?;
        let sheets = model.parts.par_iter().map(|p| p.faces.iter().map(Sheet::new).collect()).collect();
        let loops =
            model.parts.par_iter().map(|p| p.faces.iter().map(|f| LoopIndex::new(&f.loops)).collect()).collect();
        Ok(Self { model, tracer, sheets, edges, loops })
    }

    /// All paths of a view. Paths that are not drawn are among them: they may end lines that are.
    pub fn paths(&self, view: &View, silhouettes: bool) -> Paths<'_> {
        let jobs: Vec<(usize, usize, DAffine3)> = self.instances().collect();
        let edges = jobs.par_iter().flat_map_iter(|&(instance, part, transform)| {
            let edge = move |(edge, e): (usize, &Edge)| edge_path(instance, edge, e, &transform);
            let of_meshes = self.edges[part].of_meshes.iter();
            let side = move |e: &crate::model::MeshEdge| {
                let source = LineSource::Side { instance, mesh: e.triangles[0].0 };
                segment(source, of(e.kind), e.ends, &transform)
            };
            self.edges[part].edges.iter().enumerate().map(edge).chain(of_meshes.map(side))
        });
        let mut paths: Vec<Path> = edges.collect();
        let mut unresolved = 0;
        if silhouettes {
            let faces: Vec<(usize, usize, usize, DAffine3)> = jobs
                .iter()
                .flat_map(|&(i, part, t)| (0..self.sheets[part].len()).map(move |face| (i, part, face, t)))
                .collect();
            let folds: Vec<(Vec<Path>, usize)> = faces.par_iter().map(|f| self.folds(view, *f)).collect();
            for (found, left) in folds {
                paths.extend(found);
                unresolved += left;
            }
            for (instance, part, transform) in jobs {
                self.sides(view, instance, part, transform, &mut paths);
            }
        }
        paths.par_iter_mut().for_each(|p| p.follow(view));
        Paths { paths, unresolved }
    }

    /// Instances that can be drawn, their parts and transforms.
    fn instances(&self) -> impl Iterator<Item = (usize, usize, DAffine3)> + '_ {
        let all = self.model.instances.iter().enumerate();
        all.filter(|(_, i)| i.transform.inverse().is_finite()).map(|(k, i)| (k, i.part, i.transform))
    }

    fn folds<'s>(
        &'s self,
        view: &View,
        (instance, part, face, transform): (usize, usize, usize, DAffine3),
    ) -> (Vec<Path<'s>>, usize) {
        let sheet = &self.sheets[part][face];
        if sheet.plane.is_some() {
            return (Vec::new(), 0);
        }
        let matrix = view.matrix * DMat4::from(transform);
        let found = Silhouette::new(&sheet.grid, &matrix);
        let source = LineSource::Fold { instance, face };
        let paths = found.folds.into_iter().flat_map(|fold| {
            let fold = Arc::new(fold);
            let end = fold.length() as f64;
            let curve = Curve::Fold { fold: Arc::clone(&fold), sheet, transform };
            let path = Path::new(source, LineKind::Silhouette, curve, (0.0, end));
            let kept = self.kept(&fold, sheet, &self.loops[part][face]);
            let parts = kept.into_iter().flat_map(|range| cusps(&path, view, range)).collect::<Vec<_>>();
            parts.into_iter().map(move |range| Path { range, ..path.clone() })
        });
        (paths.collect(), found.unresolved)
    }

    /// The ranges of a fold that the loops keep, away from the trim curves.
    fn kept(&self, fold: &Fold, sheet: &Sheet<'_>, loops: &LoopIndex) -> Vec<(f64, f64)> {
        let end = fold.length() as f64;
        if sheet.face.loops.is_empty() {
            return vec![(0.0, end)];
        }
        let ((u0, u1), (v0, v1)) = sheet.face.surface.domain();
        let scale = DVec2::new(u1 - u0, v1 - v0).recip();
        let inside = |s: f64| {
            let uv = fold.at(s).uv;
            loops.contains(uv) && loops.distance_scaled(uv, scale, ALONG) >= ALONG
        };
        let steps = fold.length() as u32 * SAMPLES;
        let place = |k: u32| end * f64::from(k) / f64::from(steps);
        // an end of a fold may be a point of a trim curve: halves of steps in
        let asked = |k: u32| place(k).clamp(1e-3 / f64::from(SAMPLES), end - 1e-3 / f64::from(SAMPLES));
        let mut out: Vec<(f64, f64)> = Vec::new();
        let mut start = inside(asked(0)).then_some(0.0);
        for k in 0..steps {
            let (a, b) = (asked(k), asked(k + 1));
            let now = inside(b);
            if now != start.is_some() {
                let cut = bisect(a, b, |s| inside(s) == now);
                match start.take() {
                    Some(from) => out.push((from, cut)),
                    None => start = Some(cut),
                }
            }
        }
        out.extend(start.map(|from| (from, end)));
        out.retain(|(a, b)| b - a > PLACE);
        out
    }

    /// Sides of triangles where a mesh turns away from the eye and does not crease.
    fn sides<'s>(&'s self, view: &View, instance: usize, part: usize, transform: DAffine3, out: &mut Vec<Path<'s>>) {
        let meshes = &self.model.parts[part].meshes;
        let key = |p: DVec3| (p + 0.0).to_array().map(f64::to_bits);
        let creases: std::collections::HashSet<_> = self.edges[part]
            .of_meshes
            .iter()
            .flat_map(|e| [e.ends.map(key), [key(e.ends[1]), key(e.ends[0])]])
            .collect();
        let mut half: HashMap<[[u64; 3]; 2], bool> = HashMap::new();
        for (mesh, m) in meshes.iter().enumerate() {
            for t in 0..m.triangles().len() {
                let local = m.corners(t);
                let [a, b, c] = local.map(|p| transform.transform_point3(p));
                let faces = (b - a).cross(c - a).dot(view.to_eye(a)) > 0.0;
                for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                    let side = [key(local[i]), key(local[j])];
                    if creases.contains(&side) {
                        continue;
                    }
                    match half.remove(&[side[1], side[0]]) {
                        Some(other) if other != faces => {
                            let source = LineSource::Side { instance, mesh };
                            out.push(segment(source, LineKind::Silhouette, [local[i], local[j]], &transform));
                        }
                        Some(_) => {}
                        None => {
                            half.insert(side, faces);
                        }
                    }
                }
            }
        }
    }
}

pub(super) fn of(kind: EdgeKind) -> LineKind {
    match kind {
        EdgeKind::Sharp => LineKind::Sharp,
        EdgeKind::Border => LineKind::Border,
        EdgeKind::Smooth => LineKind::Smooth,
        EdgeKind::Seam => LineKind::Seam,
    }
}

pub(super) fn edge_path<'s>(instance: usize, number: usize, edge: &Edge, transform: &DAffine3) -> Path<'s> {
    let matrix = DMat4::from(*transform);
    let pieces: Vec<_> = edge
        .curve
        .iter()
        .map(|span| Bezier { points: span.piece.points.iter().map(|p| matrix * *p).collect() })
        .collect();
    let end = pieces.len() as f64;
    Path::new(LineSource::Edge { instance, edge: number }, of(edge.kind), Curve::Chain(pieces), (0.0, end))
}

pub(super) fn segment<'s>(source: LineSource, kind: LineKind, ends: [DVec3; 2], transform: &DAffine3) -> Path<'s> {
    let [a, b] = ends.map(|p| transform.transform_point3(p));
    Path::new(source, kind, Curve::Chain(vec![Bezier::line(a, b)]), (0.0, 1.0))
}

/// Where `after` becomes true between `a` and `b`.
fn bisect(mut a: f64, mut b: f64, after: impl Fn(f64) -> bool) -> f64 {
    while b - a > PLACE {
        let middle = 0.5 * (a + b);
        if after(middle) { b = middle } else { a = middle }
    }
    0.5 * (a + b)
}

/// The range cut where the fold's picture turns back.
fn cusps(path: &Path<'_>, view: &View, (from, to): (f64, f64)) -> Vec<(f64, f64)> {
    let steps = ((to - from) * f64::from(SAMPLES)).ceil().max(8.0) as u32;
    let place = |k: u32| from + (to - from) * f64::from(k) / f64::from(steps);
    let velocity = |s: f64| path.motion(view, s).map(|m| m.1);
    // branches have parameters of their own, so that a direction counts, not a speed
    let mut cuts = vec![from];
    for k in 0..steps {
        let (a, b) = (place(k), place(k + 1));
        let Some((before, after)) = velocity(a).zip(velocity(b)) else { continue };
        if before.dot(after) < 0.0 {
            cuts.push(bisect(a, b, |s| velocity(s).is_some_and(|v| v.dot(before) < 0.0)));
        }
    }
    cuts.push(to);
    cuts.windows(2).map(|w| (w[0], w[1])).collect()
}
