//! Silhouettes of a face: curves along which it folds in a view.
//!
//! ```text
//!   Q = (X, Y, W) in homogeneous pixels       f(u, v) = det [Q, Q_u, Q_v] = 0   where the picture of the face folds
//!
//!      ┌───────┬───────┐    one sign of all coefficients of f        no fold: left out, with proof
//!      │   +   │  ╱ f_u│    one sign of f_u (or f_v)                 a fold is a graph over v (over u): its ends are
//!      │       │ ╱  >0 │                                             roots of f on the cell's sides
//!      ├───────┼╱──────┤    else                                     divided
//!      │       ╱   -   │
//!      └──────╱┴───────┘    branches that meet are one [`Fold`]
//! ```
//!
//! `f` is a Bernstein polynomial, and its coefficients bound it: small closed folds are not missed, and samples are not
//! needed to find a start. A point of a fold is the root of `f` on a line across the cell, exact to rounding. Where a
//! side of a patch is a point in space (a pole), `f` has the side as a factor, which is divided out. Where a fold runs
//! along a side of a patch inside the surface, the side is the fold. Along the surface's own border the fold is an edge
//! of the face, and not found here.
//!
//! Source: G. Elber, E. Cohen, *Hidden curve removal for free form surfaces*, SIGGRAPH 1990 (folds as zeros of a spline);
//! T. W. Sederberg, R. J. Meyers, *Loop detection in surface patch intersections*, CAGD 5, 1988 (division until no closed
//! loop fits in a cell).

mod chain;
mod net;
mod trace;

use crate::spline::PatchGrid;
use chain::chains;
use glam::{DMat4, DVec2, DVec3};
use net::FoldNet;
use std::sync::Arc;

/// The folds of a face.
#[derive(Clone, Debug, Default)]
pub struct Silhouette {
    /// Each a chain of branches; a closed fold begins and ends at the same point.
    pub folds: Vec<Fold>,
    /// Cells that are smaller than a five-hundredth of a pixel and still hold more than one branch: crossings of folds.
    pub unresolved: usize,
}

/// One fold: branches end to end.
#[derive(Clone, Debug)]
pub struct Fold {
    branches: Vec<(Branch, bool)>,
}

/// A point of a fold, and the fold's direction there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoldPoint {
    /// In the surface's domain.
    pub uv: DVec2,
    /// Derivative of `uv` by the fold's parameter.
    pub along: DVec2,
}

/// A fold in a cell, as a graph: one parameter over the other.
#[derive(Clone, Debug)]
struct Branch {
    net: Arc<FoldNet>,
    /// `u` over `v`; else `v` over `u`.
    over_v: bool,
    /// From where to where, in the patch's unit square.
    range: (f64, f64),
    /// Bounds of the other parameter; a point where the branch is a side of the patch.
    bracket: (f64, f64),
}

impl Silhouette {
    /// The folds of a surface in the view of `matrix`, which maps the surface's coordinates to homogeneous pixels, as
    /// [`Camera::pixel_matrix`](crate::model::Camera::pixel_matrix) does. Loops are not applied.
    ///
    /// Cost: microseconds a patch that has no fold, some milliseconds a patch that has.
    pub fn new(grid: &PatchGrid, matrix: &DMat4) -> Self {
        Self::traced(grid, trace::branches(grid, false, |patch| FoldNet::new(patch, matrix)))
    }

    /// Where the plane `normal · p = offset` cuts a surface: the same method, with `f = normal · S - offset`. A side of a patch that
    /// lies in the plane is a cut, of both patches; where a whole patch does, there is none.
    pub fn cut(grid: &PatchGrid, normal: DVec3, offset: f64) -> Self {
        let plane = normal.extend(-offset);
        Self::traced(grid, trace::branches(grid, true, |patch| FoldNet::of_plane(patch, plane)))
    }

    fn traced(grid: &PatchGrid, traced: trace::Traced) -> Self {
        let ((u0, v0), (u1, v1)) = {
            let (first, last) = (&grid.patches[0], &grid.patches[grid.patches.len() - 1]);
            ((first.u.0, first.v.0), (last.u.1, last.v.1))
        };
        let folds = chains(traced.branches, DVec2::new(u1 - u0, v1 - v0));
        Self { folds, unresolved: traced.unresolved }
    }
}

impl Fold {
    /// The number of branches: the end of the parameter.
    pub fn length(&self) -> usize {
        self.branches.len()
    }

    /// The point at a parameter: number of the branch, and fraction.
    pub fn at(&self, parameter: f64) -> FoldPoint {
        let k = (parameter.max(0.0) as usize).min(self.branches.len() - 1);
        let (branch, reversed) = &self.branches[k];
        let t = (parameter - k as f64).clamp(0.0, 1.0);
        let point = branch.at(if *reversed { 1.0 - t } else { t });
        if *reversed { FoldPoint { along: -point.along, ..point } } else { point }
    }
}

impl Branch {
    fn at(&self, t: f64) -> FoldPoint {
        let (a, b) = self.range;
        let x = a + (b - a) * t;
        let y = self.net.root(self.over_v, x, self.bracket);
        let local = if self.over_v { DVec2::new(y, x) } else { DVec2::new(x, y) };
        let slope = if self.bracket.0 == self.bracket.1 { 0.0 } else { self.net.slope(self.over_v, local) };
        let step = if self.over_v { DVec2::new(slope, 1.0) } else { DVec2::new(1.0, slope) };
        FoldPoint { uv: self.net.low + self.net.side * local, along: self.net.side * step * (b - a) }
    }

    /// Its ends in the surface's domain.
    fn ends(&self) -> [DVec2; 2] {
        [self.at(0.0).uv, self.at(1.0).uv]
    }
}
