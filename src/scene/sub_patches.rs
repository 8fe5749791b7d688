//! Splits the patches of solids' trimmed faces, so that most of their pixels need no trim test.
//!
//! ```text
//!   ┌─────────────────┐           ┌───┬─────┬───────┐
//!   │                 │           │ i │  i  │   i   │      i  inside: drawn as a face without trims
//!   │     ╭──╮        │           ├───┼─────┼───────┤      o  outside: never drawn
//!   │     ╰──╯        │   ─────▶  │ i │  t  │   i   │      t  a trim curve passes: each pixel is tested
//!   │              ╭──┤           ├───┼─────┼───────┤
//!   │              │  │           │ i │  i  │   t   │
//!   └──────────────┴──┘           └───┴─────┴───────┘
//! ```
//!
//! The split is made once, for no particular view. It weighs the cost of a piece in each frame against the trim tests
//! that it saves if the whole scene is [`VIEW_PX`] wide. It starts from the finest grid of lines and removes the least
//! useful line until every line saves more than it costs. Closer views save more. A cut for a close view
//! (`scene/deep_zoom`) has one size of view, and is split for that.

use super::flatten::divided;
use crate::abi::Side;
use crate::spline::{Control, Patch, PatchGrid, SurfacePatch};
use crate::trim::{LoopIndex, RectSide};
use glam::{DVec2, DVec4};
use std::ops::Range;

/// Width of the scene, in pixels, for which lines are chosen. A larger value makes frames of whole scenes slower and
/// close ones hardly faster.
pub(super) const VIEW_PX: f64 = 2000.0;
/// Cost of drawing a piece, in tested pixels.
const PIECE_PX: f64 = 150.0;
/// Cost of a pixel without a test, in tested pixels.
const PLAIN_PX: f64 = 0.3;
/// Most halvings of a patch along each parameter.
const MOST_HALVINGS: u32 = 5;
/// Least width of a piece, in pixels.
const LEAST_PX: f64 = 12.0;
/// Margin on each side, as a share of a piece's width, that no curve may cross either. Skirts reach beyond their
/// pieces, and only tested pieces are tested there.
const MARGIN: f64 = 0.25;

/// How each patch lies to the loops.
fn sides(grid: &PatchGrid, index: &LoopIndex) -> Vec<Side> {
    grid.patches.iter().map(|p| side(p, index, 0.0)).collect()
}

/// A grid of patches, split or not.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SubPatches {
    pub grid: PatchGrid,
    /// How each patch lies to the loops.
    pub sides: Vec<Side>,
    /// The share of its original patch that each column, and each row, covers.
    pub shares: [Vec<f64>; 2],
}

impl SubPatches {
    /// A grid that is not split.
    pub(super) fn whole(grid: PatchGrid, sides: Vec<Side>) -> Self {
        let shares = [grid.count_u, grid.count_v].map(|count| vec![1.0; count]);
        Self { grid, sides, shares }
    }
}

/// Splits the grid where that saves time; `extent` is the scene's, in the face's units.
pub(super) fn sub_patches(grid: PatchGrid, index: &LoopIndex, extent: f64) -> SubPatches {
    let px = VIEW_PX / extent;
    let cuts = finest(&grid, if px.is_finite() { px } else { 0.0 });
    if cuts.iter().flatten().all(|ends| ends.len() == 2) {
        let sides = sides(&grid, index);
        return SubPatches::whole(grid, sides);
    }
    let mut lines = Lines::new(&divided(grid.clone(), &cuts), index, px, &cuts);
    lines.merge();
    let kept = lines.kept(&cuts);
    let shares = kept.each_ref().map(|ends| ends.iter().flat_map(|e| e.windows(2).map(|w| w[1] - w[0])).collect());
    SubPatches { grid: divided(grid, &kept), sides: lines.sides(), shares }
}

/// The finest split of each column and row: equal pieces, none narrower than [`LEAST_PX`].
fn finest(grid: &PatchGrid, px: f64) -> [Vec<Vec<f64>>; 2] {
    let (size_u, size_v): (Vec<f64>, Vec<f64>) = grid.patches.iter().map(size).unzip();
    let largest = |sizes: &mut dyn Iterator<Item = &f64>| sizes.fold(0.0, |m: f64, x| m.max(*x));
    let ends = |size: f64| -> Vec<f64> {
        let halvings = ((size * px / LEAST_PX).log2().max(0.0) as u32).min(MOST_HALVINGS);
        (0..=1u32 << halvings).map(|k| f64::from(k) / f64::from(1u32 << halvings)).collect()
    };
    let across = (0..grid.count_u).map(|i| ends(largest(&mut size_u[i..].iter().step_by(grid.count_u))));
    let up = (0..grid.count_v).map(|j| ends(largest(&mut size_v[j * grid.count_u..][..grid.count_u].iter())));
    [across.collect(), up.collect()]
}

/// Approximate lengths of a patch along u and v.
fn size(p: &SurfacePatch) -> (f64, f64) {
    let length = |row: &[DVec4]| row.windows(2).map(|w| w[0].point().distance(w[1].point())).sum::<f64>();
    let mean = |p: &Patch| (0..=p.degree_v).map(|j| length(p.row(j))).sum::<f64>() / (p.degree_v + 1) as f64;
    (mean(&p.patch), mean(&p.patch.transposed()))
}

/// How a patch with a margin lies to the loops; `margin` is a share of its width on each side.
fn side(p: &SurfacePatch, index: &LoopIndex, margin: f64) -> Side {
    let (lo, hi) = (DVec2::new(p.u.0, p.v.0), DVec2::new(p.u.1, p.v.1));
    let around = margin * (hi - lo);
    match index.classify(lo - around, hi + around) {
        RectSide::Inside => Side::Inside,
        RectSide::Outside => Side::Outside,
        RectSide::Boundary => Side::Boundary,
    }
}

/// The cost of a piece of `px` pixels.
fn cost(side: Side, px: f64) -> f64 {
    match side {
        Side::Outside => 0.0,
        Side::Inside => PIECE_PX + PLAIN_PX * px,
        Side::Boundary => PIECE_PX + px,
    }
}

/// The lines between the finest pieces that are not removed yet.
struct Lines {
    /// A summed-area table: for each corner, all finest pieces below it in u and in v, along u fastest.
    below: Vec<Sum>,
    /// Number of corners along u.
    corners_u: usize,
    /// The ends of the spans between lines, along u and along v.
    ends: [Vec<End>; 2],
}

/// Sums over some of the finest pieces.
#[derive(Clone, Copy, Default)]
struct Sum {
    px: f64,
    inside: i64,
    outside: i64,
}

/// The end of a span of the finest pieces.
#[derive(Clone, Copy)]
struct End {
    /// The first piece after it.
    at: usize,
    /// An original patch ends here; the line is never removed.
    fixed: bool,
}

impl Lines {
    fn new(fine: &PatchGrid, index: &LoopIndex, px: f64, cuts: &[Vec<Vec<f64>>; 2]) -> Self {
        let corners_u = fine.count_u + 1;
        let mut below = vec![Sum::default(); corners_u * (fine.count_v + 1)];
        for (n, p) in fine.patches.iter().enumerate() {
            let ((u, v), side) = (size(p), side(p, index, MARGIN));
            let at = (n / fine.count_u + 1) * corners_u + n % fine.count_u + 1;
            let (left, under, both) = (below[at - 1], below[at - corners_u], below[at - corners_u - 1]);
            below[at] = Sum {
                px: u * v * px * px + left.px + under.px - both.px,
                inside: i64::from(side == Side::Inside) + left.inside + under.inside - both.inside,
                outside: i64::from(side == Side::Outside) + left.outside + under.outside - both.outside,
            };
        }
        let ends = cuts.each_ref().map(|cuts| {
            let last = cuts.iter().flat_map(|ends| (1..ends.len()).map(|k| k + 1 == ends.len()));
            last.enumerate().map(|(n, fixed)| End { at: n + 1, fixed }).collect()
        });
        Self { below, corners_u, ends }
    }

    /// Removes the least useful line, while one costs more than it saves.
    fn merge(&mut self) {
        loop {
            let all = (0..2).flat_map(|axis| (0..self.ends[axis].len()).map(move |k| (axis, k)));
            let free = all.filter(|&(axis, k)| !self.ends[axis][k].fixed);
            let worth = free.map(|(axis, k)| (self.worth(axis, k), axis, k));
            match worth.min_by(|a, b| a.0.total_cmp(&b.0)) {
                Some((worth, axis, k)) if worth <= 0.0 => self.ends[axis].remove(k),
                _ => return,
            };
        }
    }

    /// The finest pieces of span `k` along an axis.
    fn span(&self, axis: usize, k: usize) -> Range<usize> {
        let start = if k == 0 { 0 } else { self.ends[axis][k - 1].at };
        start..self.ends[axis][k].at
    }

    /// The cost saved by the line at the end of span `k` along an axis.
    fn worth(&self, axis: usize, k: usize) -> f64 {
        let (low, high) = (self.span(axis, k), self.span(axis, k + 1));
        let of = |own: Range<usize>, other: &Range<usize>| {
            let other = other.clone();
            let (side, px) = if axis == 0 { self.merged(own, other) } else { self.merged(other, own) };
            cost(side, px)
        };
        let others = (0..self.ends[1 - axis].len()).map(|k| self.span(1 - axis, k));
        others.map(|other| of(low.start..high.end, &other) - of(low.clone(), &other) - of(high.clone(), &other)).sum()
    }

    /// The finest pieces of a rectangle as one piece: how it lies to the loops, and its pixels.
    fn merged(&self, u: Range<usize>, v: Range<usize>) -> (Side, f64) {
        let count = (u.len() * v.len()) as i64;
        let below = |i: usize, j: usize| self.below[j * self.corners_u + i];
        let [all, left, under, both] =
            [below(u.end, v.end), below(u.start, v.end), below(u.end, v.start), below(u.start, v.start)];
        let of = |x: fn(Sum) -> i64| x(all) - x(left) - x(under) + x(both);
        let side = if of(|s| s.inside) == count {
            Side::Inside
        } else if of(|s| s.outside) == count {
            Side::Outside
        } else {
            Side::Boundary
        };
        (side, all.px - left.px - under.px + both.px)
    }

    /// How the pieces between the remaining lines lie to the loops.
    fn sides(&self) -> Vec<Side> {
        let spans = |axis: usize| (0..self.ends[axis].len()).map(move |k| self.span(axis, k));
        spans(1).flat_map(|v| spans(0).map(move |u| self.merged(u, v.clone()).0)).collect()
    }

    /// The cuts of the remaining lines.
    fn kept(&self, cuts: &[Vec<Vec<f64>>; 2]) -> [Vec<Vec<f64>>; 2] {
        std::array::from_fn(|axis| {
            let mut kept = self.ends[axis].iter().map(|end| end.at).peekable();
            let mut first = 0;
            let of_patch = |ends: &Vec<f64>| {
                let next = first + ends.len() - 1;
                let mut out = vec![0.0];
                while let Some(at) = kept.next_if(|at| *at <= next) {
                    out.push(ends[at - first]);
                }
                first = next;
                out
            };
            cuts[axis].iter().map(of_patch).collect()
        })
    }
}

#[cfg(test)]
mod tests;
