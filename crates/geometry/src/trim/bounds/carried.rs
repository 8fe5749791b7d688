//! A face prepared for bounds along any direction. Patches, and pieces of trim curves over them, are made where a
//! search reaches them.
//!
//! ```text
//!   cells of the domain    ┌─────┬─────┐     a cell is as high as the control points of its knot span, then as those
//!   between knots          │   ╭─┼─╮   │     of its patch
//!                          ├───┼─┼─┼───┤
//!   runs of trim curves    │   ╰─┼─╯   │     a run is as high as the cells under its box, or as the part of the
//!                          └─────┴─────┘     patch under it; a curve is cut where it passes from cell to cell
//! ```

use super::compose::{compose, in_unit_square, rectangle};
use super::curves::Curves;
use super::height::Up;
use crate::math::bernstein::sign_changes;
use crate::model::{Bounds, Face};
use crate::spline::{Bezier, Control, Patch, SurfacePatch};
use crate::trim::RectSide;
use glam::{DVec2, DVec3, DVec4};
use std::cell::OnceCell;
use std::ops::Range;

/// How far beside a curve the face is tested, in shares of the domain: a face that is nowhere so wide has no area.
const BESIDE: [f64; 2] = [1e-6, 1e-9];
/// Parameters at which it is tested.
const ASKED: [f64; 3] = [0.5, 0.21, 0.83];
/// Shortest piece of a curve, in its parameter: shorter ones are roundings of a cut.
const SHORTEST: f64 = 1e-14;
/// How far beyond the domain, in shares of it, a curve along its border may be rounded.
const ROUNDED: f64 = 1e-12;

/// A part of a trim curve over one patch.
#[derive(Debug)]
pub(super) struct Piece {
    /// Number of the cell.
    pub cell: usize,
    /// Homogeneous, in the patch's unit square.
    curve: Vec<DVec3>,
    /// The same in space.
    in_space: OnceCell<Vec<DVec4>>,
    /// Control points of the part of the patch under its box.
    around: OnceCell<Vec<DVec4>>,
    /// Whether the face lies anywhere beside it.
    beside: OnceCell<bool>,
}

impl Piece {
    fn new(cell: usize, curve: Vec<DVec3>) -> Self {
        Self { cell, curve, in_space: OnceCell::new(), around: OnceCell::new(), beside: OnceCell::new() }
    }
}

/// The part of a face's surface that its loops can reach: whole knot spans.
#[derive(Debug)]
pub(super) struct Reached {
    /// Its control points.
    points: [Range<usize>; 2],
    /// Their box.
    pub hull: Bounds,
}

impl Reached {
    pub fn new(face: &Face) -> Self {
        let boxes = face.loops.iter().map(|l| l.bounds());
        let around = boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let ((u0, u1), (v0, v1)) = face.surface.domain();
        let (lo, hi) = around.unwrap_or((DVec2::new(u0, v0), DVec2::new(u1, v1)));
        let points = face.surface.points_over(lo, hi);
        let hull = hull(face, points.clone());
        Self { points, hull }
    }
}

/// Box of some control points of a face's surface.
fn hull(face: &Face, [u, v]: [Range<usize>; 2]) -> Bounds {
    let (across, points) = (face.surface.counts().0, face.surface.points());
    let rows = v.map(|j| &points[j * across..][u.clone()]);
    rows.flatten().map(|p| p.point()).fold(Bounds::EMPTY, Bounds::with)
}

/// See the module.
#[derive(Debug)]
pub(super) struct Carried<'a> {
    face: &'a Face,
    /// Where cells begin along each parameter, and the end of the last one.
    lines: [Vec<f64>; 2],
    /// Numbers of the first control point along each parameter of each cell.
    first: [Vec<usize>; 2],
    /// Box of the control points of each cell's knot span, `u` fastest.
    pub hulls: Vec<Bounds>,
    patches: Vec<OnceCell<SurfacePatch>>,
    pub curves: Curves<'a>,
    /// Of each node of the curves.
    around: Vec<OnceCell<Vec<DVec4>>>,
    /// Of each curve.
    pieces: Vec<OnceCell<Vec<Piece>>>,
    /// No point of the face is higher than all of its trim curves. The loops are within the domain, and along one
    /// parameter the surface is one patch of degree 1, whose height is a quotient of two linear functions: monotone.
    pub is_ruled: bool,
}

fn empty<T>(count: usize) -> Vec<OnceCell<T>> {
    std::iter::repeat_with(OnceCell::new).take(count).collect()
}

impl<'a> Carried<'a> {
    pub fn new(face: &'a Face, Reached { points, .. }: &Reached) -> Self {
        let (degrees, knots) = (face.surface.degrees(), face.surface.knots());
        let along = |degree: usize, knots: &[f64], points: &Range<usize>| {
            let filled = (points.start + degree..points.end).filter(|&k| knots[k] < knots[k + 1]);
            let (lines, first): (Vec<f64>, Vec<usize>) = filled.map(|k| (knots[k], k - degree)).unzip();
            (lines.into_iter().chain([knots[points.end]]).collect::<Vec<f64>>(), first)
        };
        let (lines_u, first_u) = along(degrees.0, knots.0, &points[0]);
        let (lines_v, first_v) = along(degrees.1, knots.1, &points[1]);
        let counts = (first_u.len(), first_v.len());
        let curves = Curves::new(face);
        let is_straight = (degrees.0, counts.0) == (1, 1) || (degrees.1, counts.1) == (1, 1);
        let mut this = Self {
            face,
            lines: [lines_u, lines_v],
            first: [first_u, first_v],
            hulls: Vec::new(),
            patches: empty(counts.0 * counts.1),
            around: empty(curves.nodes.len()),
            pieces: empty(curves.all.len()),
            curves,
            is_ruled: false,
        };
        this.hulls = (0..this.patches.len()).map(|cell| hull(face, this.points(cell))).collect();
        let is_within = |(lo, hi): (DVec2, DVec2)| !this.is_beyond(lo) && !this.is_beyond(hi);
        this.is_ruled = is_straight && this.curves.around().is_some_and(is_within);
        this
    }

    /// Outside of the domain, by more than rounding.
    fn is_beyond(&self, p: DVec2) -> bool {
        let ((u0, u1), (v0, v1)) = self.face.surface.domain();
        let slack = ROUNDED * self.extent();
        (p.cmplt(DVec2::new(u0, v0) - slack) | p.cmpgt(DVec2::new(u1, v1) + slack)).any()
    }

    /// Lengths of the domain.
    fn extent(&self) -> DVec2 {
        let ((u0, u1), (v0, v1)) = self.face.surface.domain();
        DVec2::new(u1 - u0, v1 - v0)
    }

    /// The control points that act on a cell.
    fn points(&self, cell: usize) -> [Range<usize>; 2] {
        let (across, degrees) = (self.first[0].len(), self.face.surface.degrees());
        let (u, v) = (self.first[0][cell % across], self.first[1][cell / across]);
        [u..u + degrees.0 + 1, v..v + degrees.1 + 1]
    }

    /// The rectangle of the domain that a cell covers.
    pub fn rectangle(&self, cell: usize) -> (DVec2, DVec2) {
        let across = self.first[0].len();
        let [u, v] = [&self.lines[0][cell % across..], &self.lines[1][cell / across..]];
        (DVec2::new(u[0], v[0]), DVec2::new(u[1], v[1]))
    }

    /// The patch of a cell.
    pub fn patch(&self, cell: usize) -> &Patch {
        let patch = self.patches[cell].get_or_init(|| {
            let part = self.face.surface.part(self.points(cell));
            part.patches().patches.swap_remove(0)
        });
        &patch.patch
    }

    /// The cells that a box in the domain touches, along each parameter; those at the border for what is beyond it.
    fn cells(&self, lo: DVec2, hi: DVec2) -> [Range<usize>; 2] {
        [0, 1].map(|axis| {
            let lines = &self.lines[axis];
            let last = lines.len() - 2;
            let begin = (lines.partition_point(|line| *line <= lo[axis]).max(1) - 1).min(last);
            let end = lines.partition_point(|line| *line < hi[axis]).clamp(begin + 1, last + 1);
            begin..end
        })
    }

    /// A height that no trim curve of a node exceeds by more than rounding; what does not reach above the mark may have
    /// a larger one than need be.
    pub fn upper_of(&self, node: usize, up: Up, mark: f64) -> f64 {
        let (lo, hi) = (self.curves.nodes[node].lo, self.curves.nodes[node].hi);
        let (across, [u, v]) = (self.first[0].len(), self.cells(lo, hi));
        let cell = v.start * across + u.start;
        let is_one = (u.len(), v.len()) == (1, 1);
        let cells = v.flat_map(|j| u.clone().map(move |i| j * across + i));
        let upper = cells.map(|cell| up.of_box(self.hulls[cell])).fold(f64::NEG_INFINITY, f64::max);
        if upper <= mark || !is_one {
            return upper;
        }
        let points = self.around[node].get_or_init(|| {
            let (from, to) = self.rectangle(cell);
            self.part(cell, (lo - from) / (to - from), (hi - from) / (to - from))
        });
        up.upper_of(points).min(upper)
    }

    /// Control points of a patch over a box in its unit square; curves are cut there.
    fn part(&self, cell: usize, lo: DVec2, hi: DVec2) -> Vec<DVec4> {
        let [lo, hi] = [lo, hi].map(|p| p.clamp(DVec2::ZERO, DVec2::ONE));
        rectangle(self.patch(cell), (lo.x, hi.x), (lo.y, hi.y))
    }

    /// The same of a piece as [`Carried::upper_of`].
    pub fn upper_of_piece(&self, curve: usize, piece: usize, up: Up) -> f64 {
        let Piece { cell, curve, around, .. } = &self.pieces(curve)[piece];
        up.upper_of(around.get_or_init(|| {
            let all = curve.iter().map(|p| p.point());
            let (lo, hi) = all.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)));
            self.part(*cell, lo, hi)
        }))
    }

    /// The control points of a piece in space, homogeneous.
    pub fn in_space(&self, curve: usize, piece: usize) -> &[DVec4] {
        let Piece { cell, curve, in_space, .. } = &self.pieces(curve)[piece];
        in_space.get_or_init(|| compose(self.patch(*cell), curve))
    }

    /// How many pieces were tested for the face beside them, and how many are in space.
    #[cfg(test)]
    pub fn pieces_done(&self) -> (usize, usize) {
        let count = |is_done: fn(&&Piece) -> bool| {
            self.pieces.iter().filter_map(OnceCell::get).flatten().filter(is_done).count()
        };
        (count(|piece| piece.beside.get().is_some()), count(|piece| piece.in_space.get().is_some()))
    }

    /// The part of a curve over the domain, patch by patch.
    pub fn pieces(&self, curve: usize) -> &[Piece] {
        self.pieces[curve].get_or_init(|| self.cut(self.curves.all[curve].points))
    }

    fn cut(&self, points: &[DVec3]) -> Vec<Piece> {
        let mut stops = vec![0.0, 1.0];
        for (axis, lines) in self.lines.iter().enumerate() {
            let along = points.iter().map(|p| p[axis] / p.z);
            let (lo, hi) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
            let first = lines.partition_point(|line| *line <= lo);
            for &line in lines[first..].iter().take_while(|line| **line < hi) {
                let off: Vec<f64> = points.iter().map(|p| p[axis] - line * p.z).collect();
                let noise = |p: &DVec3| 4.0 * f64::EPSILON * (p[axis].abs() + line.abs() * p.z);
                stops.extend(sign_changes(&off, &points.iter().map(noise).collect::<Vec<_>>()));
            }
        }
        stops.sort_by(f64::total_cmp);
        let curve = Bezier { points: points.to_vec() };
        let spans = stops.windows(2).filter(|span| span[1] - span[0] > SHORTEST);
        spans.filter_map(|span| self.piece(&curve, span[0], span[1])).collect()
    }

    fn piece(&self, curve: &Bezier<DVec3>, from: f64, to: f64) -> Option<Piece> {
        let middle = curve.point(0.5 * (from + to));
        // a curve that runs along the domain's border is rounded to one side of it or the other
        if self.is_beyond(middle) {
            return None;
        }
        let [u, v] = self.cells(middle, middle);
        let cell = v.start * self.first[0].len() + u.start;
        let (lo, hi) = self.rectangle(cell);
        Some(Piece::new(cell, in_unit_square(&curve.segment(from, to).points, (lo.x, hi.x), (lo.y, hi.y))))
    }

    /// Whether a point belongs to the face.
    pub fn holds(&self, p: DVec2) -> bool {
        self.curves.contains(p)
    }

    /// Where a rectangle lies; `Inside` and `Outside` are certain.
    pub fn classify(&self, lo: DVec2, hi: DVec2) -> RectSide {
        self.curves.classify(lo, hi)
    }

    /// Whether the face lies anywhere beside a piece of its trim curves: loops that cancel each other bound nothing.
    pub fn is_beside(&self, curve: usize, piece: usize) -> bool {
        let piece = &self.pieces(curve)[piece];
        *piece.beside.get_or_init(|| self.asks_beside(piece))
    }

    fn asks_beside(&self, piece: &Piece) -> bool {
        let (from, to) = self.rectangle(piece.cell);
        let size = to - from;
        let curve = Bezier { points: piece.curve.clone() };
        ASKED.into_iter().any(|t| {
            let step = (curve.point((t + 1e-4).min(1.0)) - curve.point(t - 1e-4)) * size / self.extent();
            let across = step.perp().normalize_or_zero() * self.extent();
            let at = from + curve.point(t) * size;
            BESIDE.iter().flat_map(|share| [-share, *share]).any(|share| self.holds(at + across * share))
        })
    }
}
