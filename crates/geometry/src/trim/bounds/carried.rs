//! A face prepared for bounds along any direction: its trim curves cut where they pass from patch to patch.
//!
//! Many pieces are searched by groups, which are halved down to a few pieces:
//!
//! ```text
//!   pieces over one patch   ─────────────────────────      a group is as high as the patch over the box of its pieces
//!   groups                  ────────────┬────────────      in the patch's unit square
//!                           ──────┬─────┴──────┬─────
//! ```

use super::compose::{compose, in_unit_square};
use super::height::Up;
use crate::math::bernstein::sign_changes;
use crate::model::{Bounds, Face, TrimLoop};
use crate::spline::{Bezier, Control, PatchGrid, Surface, SurfacePatch};
use crate::trim::{LoopIndex, RectSide};
use glam::{DVec2, DVec3, DVec4};
use std::borrow::Cow;
use std::cell::{Cell, OnceCell};
use std::ops::Range;

/// How far beside a curve the face is tested, in shares of the domain: a face that is nowhere so wide has no area.
const BESIDE: [f64; 2] = [1e-6, 1e-9];
/// Parameters at which it is tested.
const ASKED: [f64; 3] = [0.5, 0.21, 0.83];
/// Shortest piece of a curve, in its parameter: shorter ones are roundings of a cut.
const SHORTEST: f64 = 1e-14;
/// How far beyond the domain, in shares of it, a curve along its border may be rounded.
const ROUNDED: f64 = 1e-12;
/// Pieces of a face that are searched without groups: so few cost less than the boxes of groups.
const FEW: usize = 256;
/// Pieces of the smallest groups, at most.
const LEAST_GROUP: usize = 16;
/// A box of a loop takes this share of the time of a curve in an index of loops.
const BOX_SHARE: usize = 16;

/// A part of a trim curve over one patch.
#[derive(Debug)]
pub(super) struct Piece {
    /// Number of the patch.
    pub patch: usize,
    /// Homogeneous, in the patch's unit square.
    curve: Vec<DVec3>,
    /// The same in space, for all directions.
    in_space: OnceCell<Vec<DVec4>>,
    /// Whether the face lies anywhere beside it.
    beside: OnceCell<bool>,
}

/// Pieces over one patch, one behind the other.
#[derive(Debug)]
pub(super) struct Group {
    /// Number of the patch.
    patch: usize,
    /// Box of their control points in the patch's unit square.
    lo: DVec2,
    hi: DVec2,
    pub parts: Parts,
}

/// The parts of a group.
#[derive(Debug)]
pub(super) enum Parts {
    Pieces(Range<usize>),
    Groups([usize; 2]),
}

/// The part of a face's surface that its loops can reach: whole knot spans.
#[derive(Debug)]
pub(super) struct Reached<'a> {
    face: &'a Face,
    surface: Cow<'a, Surface>,
    /// Box of the control points of each loop.
    boxes: Vec<(DVec2, DVec2)>,
    /// Box of all of them; `None` where there are no loops.
    around: Option<(DVec2, DVec2)>,
    /// Box of the part's control points.
    pub hull: Bounds,
}

impl<'a> Reached<'a> {
    pub fn new(face: &'a Face) -> Self {
        let boxes: Vec<(DVec2, DVec2)> = face.loops.iter().map(TrimLoop::bounds).collect();
        let around = boxes.iter().copied().reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let part = around.and_then(|(lo, hi)| face.surface.spans_over(lo, hi));
        let surface = part.map_or(Cow::Borrowed(&face.surface), Cow::Owned);
        let (min, max) = surface.bounds();
        Self { face, surface, boxes, around, hull: Bounds { min, max } }
    }
}

/// See the module.
#[derive(Debug)]
pub(super) struct Carried<'a> {
    face: &'a Face,
    /// Of the part that the loops can reach.
    pub grid: PatchGrid,
    /// Box of the control points of each patch.
    pub hulls: Vec<Bounds>,
    /// Box of the control points of each loop.
    boxes: Vec<(DVec2, DVec2)>,
    /// Box of all of them; `None` where there are no loops.
    around: Option<(DVec2, DVec2)>,
    index: OnceCell<LoopIndex>,
    /// The work on points while there is no index: as many curves in an index take as long.
    spent: Cell<usize>,
    pub pieces: Vec<Piece>,
    /// Of many pieces, in the order of their patches.
    pub groups: Vec<Group>,
    /// The group of all pieces of a patch, patch by patch.
    pub tops: Vec<(usize, usize)>,
    /// No point of the face is higher than all of its trim curves. The loops are within the domain, and along one
    /// parameter the surface is one patch of degree 1, whose height is a quotient of two linear functions: monotone.
    pub is_ruled: bool,
}

impl<'a> Carried<'a> {
    pub fn new(reached: &Reached<'a>) -> Self {
        let (face, surface) = (reached.face, &reached.surface);
        let grid = surface.patches();
        let domain = surface.domain();
        let lines = [lines(&grid, 0, domain.0.1), lines(&grid, 1, domain.1.1)];
        let hull = |patch: &SurfacePatch| {
            let (min, max) = patch.patch.bounds();
            Bounds { min, max }
        };
        let mut this = Self {
            face,
            hulls: grid.patches.iter().map(hull).collect(),
            grid,
            boxes: reached.boxes.clone(),
            around: reached.around,
            index: OnceCell::new(),
            spent: Cell::new(0),
            pieces: Vec::new(),
            groups: Vec::new(),
            tops: Vec::new(),
            is_ruled: false,
        };
        let curves = face.loops.iter().flat_map(|l| l.curves());
        this.pieces = curves.flat_map(|curve| this.cut(&curve, &lines)).collect();
        this.group();
        let degrees = surface.degrees();
        let counts = (this.grid.count_u, this.grid.count_v);
        let is_straight = (degrees.0, counts.0) == (1, 1) || (degrees.1, counts.1) == (1, 1);
        this.is_ruled = is_straight && this.around.is_some_and(|(lo, hi)| !this.is_beyond(lo) && !this.is_beyond(hi));
        this
    }

    /// Outside of the domain, by more than rounding.
    fn is_beyond(&self, p: DVec2) -> bool {
        let ((u0, u1), (v0, v1)) = self.face.surface.domain();
        let slack = ROUNDED * self.extent();
        (p.cmplt(DVec2::new(u0, v0) - slack) | p.cmpgt(DVec2::new(u1, v1) + slack)).any()
    }

    /// Groups many pieces.
    fn group(&mut self) {
        if self.pieces.len() <= FEW {
            return;
        }
        self.pieces.sort_by_key(|piece| piece.patch);
        let mut first = 0;
        while let Some(Piece { patch, .. }) = self.pieces.get(first) {
            let patch = *patch;
            let end = first + self.pieces[first..].partition_point(|piece| piece.patch == patch);
            let top = self.halved(patch, first..end);
            self.tops.push((patch, top));
            first = end;
        }
    }

    /// Adds the group of some pieces, behind its halves; its number.
    fn halved(&mut self, patch: usize, pieces: Range<usize>) -> usize {
        let (lo, hi, parts) = if pieces.len() > LEAST_GROUP {
            let middle = pieces.start + pieces.len() / 2;
            let halves = [pieces.start..middle, middle..pieces.end].map(|half| self.halved(patch, half));
            let [a, b] = halves.map(|half| &self.groups[half]);
            (a.lo.min(b.lo), a.hi.max(b.hi), Parts::Groups(halves))
        } else {
            let points = self.pieces[pieces.clone()].iter().flat_map(|piece| &piece.curve).map(|p| p.point());
            let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
            let (lo, hi) = points.fold(none, |(lo, hi), p| (lo.min(p), hi.max(p)));
            (lo, hi, Parts::Pieces(pieces))
        };
        self.groups.push(Group { patch, lo, hi, parts });
        self.groups.len() - 1
    }

    /// A height that no piece of a group exceeds by more than rounding.
    pub fn upper_of(&self, group: usize, up: Up) -> f64 {
        let Group { patch, lo, hi, .. } = &self.groups[group];
        // pieces are within their patch, whatever their control points
        let [lo, hi] = [*lo, *hi].map(|p| p.clamp(DVec2::ZERO, DVec2::ONE));
        up.upper_of(&self.grid.patches[*patch].patch.rectangle((lo.x, hi.x), (lo.y, hi.y)).points)
    }

    /// The control points of a piece in space, homogeneous.
    pub fn in_space(&self, piece: usize) -> &[DVec4] {
        let Piece { patch, curve, in_space, .. } = &self.pieces[piece];
        in_space.get_or_init(|| compose(&self.grid.patches[*patch].patch, curve))
    }

    /// A height that no point of a patch exceeds by more than rounding; what does not reach above the mark may have a
    /// larger one than need be.
    pub fn upper_of_patch(&self, patch: usize, up: Up, mark: f64) -> f64 {
        let upper = up.of_box(self.hulls[patch]);
        if upper > mark { up.upper_of(&self.grid.patches[patch].patch.points).min(upper) } else { upper }
    }

    /// How many pieces were tested for the face beside them.
    #[cfg(test)]
    pub fn pieces_tested(&self) -> usize {
        self.pieces.iter().filter(|piece| piece.beside.get().is_some()).count()
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
            let first = lines.partition_point(|line| *line <= lo);
            for &line in lines[first..].iter().take_while(|line| **line < hi) {
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
        let middle = curve.point(0.5 * (from + to));
        // a curve that runs along the domain's border is rounded to one side of it or the other
        if self.is_beyond(middle) {
            return None;
        }
        let patch = self.grid.index(middle.x, middle.y);
        let SurfacePatch { u, v, .. } = &self.grid.patches[patch];
        let curve = in_unit_square(&curve.segment(from, to).points, *u, *v);
        Some(Piece { patch, curve, in_space: OnceCell::new(), beside: OnceCell::new() })
    }

    fn index(&self) -> &LoopIndex {
        self.index.get_or_init(|| LoopIndex::new(&self.face.loops))
    }

    /// Whether a point belongs to the face.
    pub fn holds(&self, p: DVec2) -> bool {
        match self.around {
            None => true,
            Some(around) => is_in(p, around) && self.is_kept(p),
        }
    }

    /// Whether the loops keep a point. A loop whose box does not hold it does not wind around it: for a few points,
    /// indices of the other loops cost less than one of all.
    fn is_kept(&self, p: DVec2) -> bool {
        if self.index.get().is_none() {
            let near = self.face.loops.iter().zip(&self.boxes).filter(|(_, bounds)| is_in(p, **bounds)).map(|(l, _)| l);
            let curves: usize = near.clone().map(|l| l.curves().len()).sum();
            self.spent.set(self.spent.get() + curves + self.boxes.len() / BOX_SHARE);
            if 2 * self.spent.get() < self.pieces.len() {
                let near: Vec<TrimLoop> = near.cloned().collect();
                return !near.is_empty() && LoopIndex::new(&near).contains(p);
            }
        }
        self.index().contains(p)
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

fn is_in(p: DVec2, (lo, hi): (DVec2, DVec2)) -> bool {
    p.cmpge(lo).all() && p.cmple(hi).all()
}

/// Where patches meet along a parameter, and both ends of the domain.
fn lines(grid: &PatchGrid, axis: usize, end: f64) -> Vec<f64> {
    let starts: Vec<f64> = match axis {
        0 => grid.patches[..grid.count_u].iter().map(|p| p.u.0).collect(),
        _ => grid.patches.iter().step_by(grid.count_u).map(|p| p.v.0).collect(),
    };
    starts.into_iter().chain([end]).collect()
}
