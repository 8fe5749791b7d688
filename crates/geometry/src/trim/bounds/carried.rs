//! A face prepared for bounds along any direction: its trim curves cut where they pass from patch to patch.

use super::height::in_unit_square;
use crate::math::bernstein::sign_changes;
use crate::model::Face;
use crate::spline::{Bezier, PatchGrid, SurfacePatch};
use crate::trim::{LoopIndex, RectSide};
use glam::{DVec2, DVec3};
use std::cell::OnceCell;

/// How far beside a curve the face is tested, in shares of the domain: a face that is nowhere so wide has no area.
const BESIDE: [f64; 2] = [1e-6, 1e-9];
/// Parameters at which it is tested.
const ASKED: [f64; 3] = [0.5, 0.21, 0.83];
/// Shortest piece of a curve, in its parameter: shorter ones are roundings of a cut.
const SHORTEST: f64 = 1e-14;

/// A part of a trim curve over one patch.
#[derive(Debug)]
pub(super) struct Piece {
    /// Number of the patch.
    pub patch: usize,
    /// Homogeneous, in the patch's unit square.
    pub curve: Vec<DVec3>,
    /// Whether the face lies anywhere beside it.
    beside: OnceCell<bool>,
}

/// See the module.
#[derive(Debug)]
pub(super) struct Carried<'a> {
    face: &'a Face,
    pub grid: PatchGrid,
    /// Box of the loops' control points; `None` where there are no loops.
    around: Option<(DVec2, DVec2)>,
    index: OnceCell<LoopIndex>,
    pub pieces: Vec<Piece>,
}

impl<'a> Carried<'a> {
    pub fn new(face: &'a Face) -> Self {
        let grid = face.surface.patches();
        let boxes = face.loops.iter().map(|l| l.bounds());
        let around = boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let domain = face.surface.domain();
        let lines = [lines(&grid, 0, domain.0.1), lines(&grid, 1, domain.1.1)];
        let mut this = Self { face, grid, around, index: OnceCell::new(), pieces: Vec::new() };
        let curves = face.loops.iter().flat_map(|l| l.curves());
        this.pieces = curves.flat_map(|curve| this.cut(&curve, &lines)).collect();
        this
    }

    /// Lengths of the domain.
    fn extent(&self) -> DVec2 {
        let ((u0, u1), (v0, v1)) = self.face.surface.domain();
        DVec2::new(u1 - u0, v1 - v0)
    }

    /// The part of a curve over the domain, patch by patch.
    fn cut(&self, curve: &Bezier<DVec3>, lines: &[Vec<f64>; 2]) -> Vec<Piece> {
        let mut stops = vec![0.0, 1.0];
        for (axis, lines) in lines.iter().enumerate() {
            let along = curve.points.iter().map(|p| p[axis] / p.z);
            let (lo, hi) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
            for &line in lines.iter().filter(|line| lo < **line && **line < hi) {
                let off: Vec<f64> = curve.points.iter().map(|p| p[axis] - line * p.z).collect();
                let noise = |p: &DVec3| 4.0 * f64::EPSILON * (p[axis].abs() + line.abs() * p.z);
                stops.extend(sign_changes(&off, &curve.points.iter().map(noise).collect::<Vec<_>>()));
            }
        }
        stops.sort_by(f64::total_cmp);
        let spans = stops.windows(2).filter(|span| span[1] - span[0] > SHORTEST);
        spans.filter_map(|span| self.piece(curve, span[0], span[1])).collect()
    }

    fn piece(&self, curve: &Bezier<DVec3>, from: f64, to: f64) -> Option<Piece> {
        let ((u0, u1), (v0, v1)) = self.face.surface.domain();
        let middle = curve.point(0.5 * (from + to));
        // a curve that runs along the domain's border is rounded to one side of it or the other
        let slack = 1e-12 * self.extent();
        let beside = middle.cmplt(DVec2::new(u0, v0) - slack) | middle.cmpgt(DVec2::new(u1, v1) + slack);
        if beside.any() {
            return None;
        }
        let patch = self.grid.index(middle.x, middle.y);
        let SurfacePatch { u, v, .. } = &self.grid.patches[patch];
        let curve = in_unit_square(&curve.segment(from, to).points, *u, *v);
        Some(Piece { patch, curve, beside: OnceCell::new() })
    }

    fn index(&self) -> &LoopIndex {
        self.index.get_or_init(|| LoopIndex::new(&self.face.loops))
    }

    /// Whether a point belongs to the face.
    pub fn holds(&self, p: DVec2) -> bool {
        match self.around {
            None => true,
            Some((lo, hi)) => p.cmpge(lo).all() && p.cmple(hi).all() && self.index().contains(p),
        }
    }

    /// Whether the loops' box and a rectangle have a point in common.
    pub fn may_meet(&self, lo: DVec2, hi: DVec2) -> bool {
        self.around.is_none_or(|(from, to)| lo.cmple(to).all() && hi.cmpge(from).all())
    }

    pub fn classify(&self, lo: DVec2, hi: DVec2) -> RectSide {
        if self.around.is_none() { RectSide::Inside } else { self.index().classify(lo, hi) }
    }

    /// Whether the face lies anywhere beside a piece of its trim curves: loops that cancel each other bound nothing.
    pub fn is_beside(&self, piece: usize) -> bool {
        let piece = &self.pieces[piece];
        *piece.beside.get_or_init(|| self.asks_beside(piece))
    }

    fn asks_beside(&self, piece: &Piece) -> bool {
        let SurfacePatch { u, v, .. } = &self.grid.patches[piece.patch];
        let (from, size) = (DVec2::new(u.0, v.0), DVec2::new(u.1 - u.0, v.1 - v.0));
        let curve = Bezier { points: piece.curve.clone() };
        ASKED.into_iter().any(|t| {
            let step = (curve.point((t + 1e-4).min(1.0)) - curve.point(t - 1e-4)) * size / self.extent();
            let across = step.perp().normalize_or_zero() * self.extent();
            let at = from + curve.point(t) * size;
            BESIDE.iter().flat_map(|share| [-share, *share]).any(|share| self.holds(at + across * share))
        })
    }
}

/// Where patches meet along a parameter, and both ends of the domain.
fn lines(grid: &PatchGrid, axis: usize, end: f64) -> Vec<f64> {
    let starts: Vec<f64> = match axis {
        0 => grid.patches[..grid.count_u].iter().map(|p| p.u.0).collect(),
        _ => grid.patches.iter().step_by(grid.count_u).map(|p| p.v.0).collect(),
    };
    starts.into_iter().chain([end]).collect()
}
