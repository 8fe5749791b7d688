//! Where a plane cuts the faces of a part: curves in space.
//!
//! ```text
//!   n . S(u, v) = d   ──branches in (u, v)──▶ those inside the loops ──▶ cubic Hermite pieces, halved until within reach
//!      ╭──────╮
//!      │ ╱    │       a stretch ends where it crosses a loop: found by halving, where two of `SAMPLES` places on a branch
//!      ╰╱─────╯       differ
//! ```
//!
//! Accuracy: `FIT` of the part's size. Faces that lie in the plane are not cut. Source: as `silhouette`.

use crate::model::{Face, Mesh, Part};
use crate::silhouette::{Fold, Silhouette};
use crate::spline::{Bezier, PatchGrid};
use crate::trim::LoopIndex;
use glam::{DVec3, DVec4};
use rayon::prelude::*;

/// Largest distance of a piece from its curve, relative to the part's size.
const FIT: f64 = 1e-8;
/// Halvings of a branch.
const HALVINGS: u32 = 10;
/// Places on a branch that are tested against the loops.
const SAMPLES: u32 = 16;
/// Halvings to where a branch crosses a loop: all digits.
const BISECTIONS: u32 = 50;

/// A stretch of a cut.
#[derive(Clone, Debug)]
pub struct CutCurve {
    /// Which face is cut; `None` of a mesh.
    pub face: Option<usize>,
    /// End to end.
    pub pieces: Vec<Bezier<DVec4>>,
}

impl Part {
    /// Curves in which the plane `normal · p = offset`, part coordinates, cuts the faces, or the meshes of a part without
    /// faces.
    pub fn cut(&self, normal: DVec3, offset: f64) -> Vec<CutCurve> {
        let size = self.control_bounds().diagonal();
        let faces = self.faces.par_iter().enumerate();
        let of_faces: Vec<Vec<CutCurve>> = faces
            .map(|(nth, face)| {
                let chains = cut_face(face, (normal, offset), FIT * size).into_iter();
                chains.map(|pieces| CutCurve { face: Some(nth), pieces }).collect()
            })
            .collect();
        let meshes = self.meshes.iter().filter(|_| self.faces.is_empty());
        of_faces.into_iter().flatten().chain(meshes.flat_map(|mesh| mesh.cut(normal, offset))).collect()
    }
}

impl Mesh {
    /// The same of its triangles, a stretch each.
    pub fn cut(&self, normal: DVec3, offset: f64) -> Vec<CutCurve> {
        let height = |p: DVec3| normal.dot(p) - offset;
        let triangles = (0..self.triangles().len()).map(|t| self.corners(t));
        let stretch = |[a, b, c]: [DVec3; 3]| {
            let crossed = |(a, b): (DVec3, DVec3)| {
                let (h, k) = (height(a), height(b));
                ((h < 0.0) != (k < 0.0)).then(|| a.lerp(b, h / (h - k)))
            };
            let ends: Vec<DVec3> = [(a, b), (b, c), (c, a)].into_iter().filter_map(crossed).collect();
            let [from, to] = ends.try_into().ok()?;
            Some(CutCurve { face: None, pieces: vec![Bezier::line(from, to)] })
        };
        triangles.filter_map(stretch).collect()
    }
}

fn cut_face(face: &Face, plane: (DVec3, f64), reach: f64) -> Vec<Vec<Bezier<DVec4>>> {
    let (low, high) = {
        let heights = face.control_bounds().corners().map(|c| plane.0.dot(c) - plane.1);
        heights.into_iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)))
    };
    if !(low < 0.0 && high > 0.0) {
        return Vec::new();
    }
    let (grid, loops) = (face.surface.patches(), LoopIndex::new(&face.loops));
    let cuts = Silhouette::cut(&grid, plane.0, plane.1).folds;
    let inside = |cut: &Fold, at: f64| loops.contains(cut.at(at).uv);
    cuts.iter()
        .flat_map(|cut| kept(cut, |at| inside(cut, at)).into_iter().map(|range| pieces(&grid, cut, range, reach)))
        .collect()
}

/// The ranges of a cut that are inside.
fn kept(cut: &Fold, inside: impl Fn(f64) -> bool) -> Vec<(f64, f64)> {
    let steps = cut.length() as u32 * SAMPLES;
    let place = |k: u32| f64::from(k) / f64::from(SAMPLES);
    let mut out = Vec::new();
    let mut start = inside(0.0).then_some(0.0);
    for k in 0..steps {
        let (mut a, mut b) = (place(k), place(k + 1));
        let now = inside(b);
        if now == start.is_some() {
            continue;
        }
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (a + b);
            if inside(middle) == now { b = middle } else { a = middle }
        }
        match start.take() {
            Some(from) => out.push((from, b)),
            None => start = Some(b),
        }
    }
    out.extend(start.map(|from| (from, f64::from(steps) / f64::from(SAMPLES))));
    out
}

fn pieces(grid: &PatchGrid, cut: &Fold, (from, to): (f64, f64), reach: f64) -> Vec<Bezier<DVec4>> {
    let mut out = Vec::new();
    let mut at = from;
    while at < to {
        // a piece is of one branch
        let end = (at.floor() + 1.0).min(to);
        halved(grid, cut, (at, end), (reach, HALVINGS), &mut out);
        at = end;
    }
    out
}

fn halved(grid: &PatchGrid, cut: &Fold, (a, b): (f64, f64), (reach, left): (f64, u32), out: &mut Vec<Bezier<DVec4>>) {
    // just within the branch: at its very end another branch may be nearer
    let end = |at: f64, inner: f64| {
        let at = at + (inner - at) * 1e-12;
        let p = cut.at(at);
        let jet = grid.jet(p.uv.x, p.uv.y);
        (jet.point, (jet.du * p.along.x + jet.dv * p.along.y) * ((b - a) / 3.0))
    };
    let middle = 0.5 * (a + b);
    let ((p, along), (q, back)) = (end(a, middle), end(b, middle));
    let points = [p, p + along, q - back, q];
    let piece = Bezier { points: points.map(|p| p.extend(1.0)).to_vec() };
    let there = cut.at(middle).uv;
    let off = piece.point(0.5).distance(grid.point(there.x, there.y));
    if off <= reach || left == 0 {
        out.push(piece);
        return;
    }
    halved(grid, cut, (a, middle), (reach, left - 1), out);
    halved(grid, cut, (middle, b), (reach, left - 1), out);
}
