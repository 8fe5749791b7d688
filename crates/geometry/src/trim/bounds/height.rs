//! Heights over a plane, of patches and of curves on them, as quotients of Bernstein polynomials.
//!
//! ```text
//!   height · weight = Σ B_i B_j (along · P_ij + offset w_ij)        a patch: one net of pairs (height · weight, weight)
//! ```
//!
//! *A quotient whose weights are positive is nowhere above the largest quotient of its coefficients.* The differences
//! of `height · weight - h weight` along one parameter say whether there is a critical point of height `h`: where all
//! have one sign, there is none. The quotient's derivative, times the weight, is a mean of them there.

use crate::model::Bounds;
use crate::spline::{Net, Patch};
use glam::{DVec2, DVec3, DVec4};

/// Pairs of height times weight, and weight.
pub(super) type Height = Net<DVec2>;

/// Rounding of heights: each is a sum of a few rounded products.
pub(super) const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The upward direction, and the height of the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Up {
    pub along: DVec3,
    pub offset: f64,
}

impl Up {
    pub fn of_point(&self, p: DVec3) -> f64 {
        self.along.dot(p) + self.offset
    }

    /// The largest height of a box; negative infinity for an empty box.
    pub fn of_box(&self, around: Bounds) -> f64 {
        if around.is_empty() {
            return f64::NEG_INFINITY;
        }
        self.of_point(DVec3::select(self.along.cmpgt(DVec3::ZERO), around.max, around.min))
    }

    fn of_control(&self, p: DVec4) -> DVec2 {
        DVec2::new(self.along.dot(p.truncate()) + self.offset * p.w, p.w)
    }

    pub fn of_patch(&self, patch: &Patch) -> Height {
        let n = patch.degree_u + 1;
        Net::build(patch.degree_u, patch.degree_v, |i, j| self.of_control(patch.points[j * n + i]))
    }

    /// A curve in space, homogeneous: a net of degree 0 along `v`.
    pub fn of_curve(&self, points: &[DVec4]) -> Height {
        Net::build(points.len() - 1, 0, |i, _| self.of_control(points[i]))
    }

    /// What [`Height::upper`] says of a patch or curve with these control points.
    pub fn upper_of(&self, points: &[DVec4]) -> f64 {
        points.iter().map(|p| bound(self.of_control(*p))).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// Height of a pair.
pub(super) fn quotient(pair: DVec2) -> f64 {
    pair.x / pair.y
}

/// The same, infinite where the weight is not positive.
fn bound(pair: DVec2) -> f64 {
    if pair.y > 0.0 { quotient(pair) } else { f64::INFINITY }
}

impl Height {
    /// An upper bound of the height; infinite where a weight is not positive.
    pub(super) fn upper(&self) -> f64 {
        self.all().iter().map(|pair| bound(*pair)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// A lower bound of the height; infinite where a weight is not positive.
    pub(super) fn lower(&self) -> f64 {
        let bound = |pair: &DVec2| if pair.y > 0.0 { quotient(*pair) } else { f64::NEG_INFINITY };
        self.all().iter().map(bound).fold(f64::INFINITY, f64::min)
    }

    /// Whether it may have a critical point whose height is between two that are finite.
    pub(super) fn may_turn(&self, low: f64, high: f64) -> bool {
        let largest = self.all().iter().fold(DVec2::ZERO, |all, pair| all.max(pair.abs()));
        let noise = ROUNDING * (largest.x + low.abs().max(high.abs()) * largest.y);
        let signs = |a: DVec2, b: DVec2| {
            let step = b - a;
            let (at_low, at_high) = (step.x - low * step.y, step.x - high * step.y);
            (at_low.min(at_high) > noise, at_low.max(at_high) < -noise)
        };
        let one_sign = |pairs: &mut dyn Iterator<Item = (DVec2, DVec2)>| {
            let (mut any, mut rises, mut falls) = (false, true, true);
            for (a, b) in pairs {
                let (up, down) = signs(a, b);
                (any, rises, falls) = (true, rises && up, falls && down);
                if !rises && !falls {
                    return false;
                }
            }
            any
        };
        let (n, k) = (self.n, self.k);
        let mut along_u = (0..=k).flat_map(|j| (0..n).map(move |i| (self.at(i, j), self.at(i + 1, j))));
        let mut along_v = (0..=n).flat_map(|i| (0..k).map(move |j| (self.at(i, j), self.at(i, j + 1))));
        !one_sign(&mut along_u) && !one_sign(&mut along_v)
    }

    /// Whether its second derivatives, or else its first, are larger along `v` than along `u` about a height.
    pub(super) fn is_steeper_in_v(&self, height: f64) -> bool {
        let at = |i: usize, j: usize| self.at(i, j).x - height * self.at(i, j).y;
        let (n, k) = (self.n, self.k);
        let largest = |all: &mut dyn Iterator<Item = f64>| all.map(f64::abs).fold(0.0, f64::max);
        let bend_u = largest(
            &mut (0..=k).flat_map(|j| (1..n.max(1)).map(move |i| at(i - 1, j) - 2.0 * at(i, j) + at(i + 1, j))),
        );
        let bend_v = largest(
            &mut (0..=n).flat_map(|i| (1..k.max(1)).map(move |j| at(i, j - 1) - 2.0 * at(i, j) + at(i, j + 1))),
        );
        if bend_u > 0.0 || bend_v > 0.0 {
            return bend_v > bend_u;
        }
        let step_u = largest(&mut (0..=k).flat_map(|j| (0..n).map(move |i| at(i + 1, j) - at(i, j))));
        let step_v = largest(&mut (0..=n).flat_map(|i| (0..k).map(move |j| at(i, j + 1) - at(i, j))));
        step_v > step_u
    }

    /// The line of the net at one end of `u`, as a net of degree 0 along `u`.
    pub(super) fn side_u(&self, last: bool) -> Self {
        Self::build(0, self.k, |_, j| self.at(if last { self.n } else { 0 }, j))
    }

    /// The same at one end of `v`.
    pub(super) fn side_v(&self, last: bool) -> Self {
        Self::build(self.n, 0, |i, _| self.at(i, if last { self.k } else { 0 }))
    }
}
