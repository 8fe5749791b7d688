//! Surfaces from equations: `S(u, v)` as a closure, fitted by a C² bicubic spline within a bound.
//!
//! ```text
//!    ┌─┬─┬──┬────┐   lines of data in u and v, split where the error is large
//!    ├─┼─┼──┼────┤   each cell: 8 x 8 Chebyshev points compared with S, at equal (u, v)
//!    ├─┼─┼──┼────┤        │
//!    │ │ │  │    │        ▼  as a Chebyshev series  e = Σ c_kl T_k(u) T_l(v)
//!    │ │ │  │    │   k, l <= 4: the error of a cubic on a smooth surface      ─▶ bound 2 max |e| (Ehlich, Zeller)
//!    └─┴─┴──┴────┘   the rest ρ = Σ |c_kl|: how far from smooth the cell is  ─▶ added four times
//! ```
//!
//! **The bound.** A polynomial of degree 4 in each variable, known at the 8 x 8 Chebyshev points, is nowhere larger
//! than `1 / cos²(4 π / 16) = 2` times its largest value there. The error is the sum of three parts: such a polynomial,
//! at most `E + ρ` at the points; a rest of at most `ρ`, which the points see; a part that they do not see, taken as
//! `ρ`, too. So `bound = 2 (E + ρ) + 2 ρ`. Only the last part is an assumption: the series of the error falls, so that
//! the terms above degree 7 weigh no more than those of degrees 5 to 7. A feature that lies between all points (a spike
//! narrower than a hundredth of a cell of the first 8 x 8) breaks it; no method by samples would find that. Both
//! surfaces are compared at equal parameters, so the bound holds for the distance from either to the other.
//!
//! Seams and poles are found first ([`Side`]); both ends of each then have the same numbers.
//!
//! Sources: H. Ehlich, K. Zeller, *Schwankung von Polynomen zwischen Gitterpunkten*, Math. Z. 86, 1964; the tail as
//! a measure of resolution from L. N. Trefethen, *Approximation Theory and Approximation Practice*, 2013, chapter 3;
//! C. de Boor, *A Practical Guide to Splines*, 2001, chapter XVII.

mod cells;
#[cfg(feature = "equations")]
mod equation;
mod mesh;
mod sides;

#[cfg(feature = "equations")]
pub use equation::Equation;
pub use sides::{Side, Sides};

use super::{Built, ConstructError};
use crate::spline::Surface;
use crate::spline::cubic::{Cubic, Ends, tensor};
use glam::{DVec3, DVec4};

/// The accuracy that a fit has to reach, and its largest size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitOptions {
    /// Largest distance from the surface described, in model units.
    pub tolerance: f64,
    /// Most control points; each costs about 64 evaluations of the surface a round.
    pub most_points: usize,
}

impl FitOptions {
    /// The tolerance, and up to 262,144 control points.
    pub fn new(tolerance: f64) -> Self {
        Self { tolerance, most_points: 1 << 18 }
    }
}

/// A fitted surface and its error.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The C² bicubic spline over the given domain.
    pub surface: Surface,
    /// Upper bound of the distance at equal parameters; never above the tolerance. See the module for its assumption.
    pub bound: f64,
    /// Largest distance at a sample.
    pub measured: f64,
    /// How the sides meet or end.
    pub sides: Sides,
}

impl From<Fit> for Built {
    fn from(fit: Fit) -> Self {
        Self { surface: fit.surface, deviation: fit.bound }
    }
}

/// Spans at the start, in each direction.
const FIRST: usize = 8;
/// Rounds of refinement; a round splits by up to 4, so even a square root's branch point is done earlier.
const ROUNDS: usize = 48;
/// Share of the size that rounding alone costs.
const ROUNDING: f64 = 1e-13;

/// Fits `f` over `u` x `v`.
///
/// # Errors
/// [`ConstructError::Range`] for an empty domain, a tolerance that is not positive or below the rounding of the
/// surface's size; [`ConstructError::NotFiniteAt`] where `f` has no finite value; [`ConstructError::ZeroLength`]
/// when the whole surface is one point; [`ConstructError::Bound`] when `most_points` do not reach the tolerance.
pub fn fit(
    f: impl Fn(f64, f64) -> DVec3 + Sync,
    u: (f64, f64),
    v: (f64, f64),
    options: &FitOptions,
) -> Result<Fit, ConstructError> {
    for (what, (a, b)) in [("the domain in u", u), ("the domain in v", v)] {
        // at least some thousand parameters that differ
        if !(a.is_finite() && b.is_finite() && b - a > 1e-10 * a.abs().max(b.abs()) && (b - a).is_finite()) {
            return Err(ConstructError::Range { what, value: b - a, must: "a finite length that is not rounding" });
        }
    }
    let tolerance = options.tolerance;
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(ConstructError::Range { what: "the tolerance", value: tolerance, must: "positive" });
    }
    let sampler = sides::Sampler::new(&f, u, v);
    let (sides, size) = sides::find(&sampler, tolerance)?;
    if tolerance < ROUNDING * size {
        return Err(ConstructError::Range {
            what: "the tolerance",
            value: tolerance,
            must: "at least 1e-13 of the surface's distance from the origin",
        });
    }
    let even = |(a, b): (f64, f64)| -> Vec<f64> {
        let inner = (0..FIRST).map(|i| a + (b - a) * (i as f64 / FIRST as f64));
        inner.chain([b]).collect()
    };
    let mut lines = [even(u), even(v)];
    let (mut reached, mut pieces) = (f64::INFINITY, 0);
    for _ in 0..ROUNDS {
        let [lu, lv] = &lines;
        if (lu.len() + 2).saturating_mul(lv.len() + 2) > options.most_points {
            break;
        }
        let surface = interpolate(&sampler, &sides, lu, lv)?;
        let report = cells::check(&sampler, &surface, lu, lv, ROUNDING * size)?;
        (reached, pieces) = (report.bound, (lu.len() - 1) * (lv.len() - 1));
        if report.bound <= tolerance {
            return Ok(Fit { surface, bound: report.bound, measured: report.measured, sides });
        }
        let Some(next) = mesh::refined(&lines, &report.cells, tolerance) else { break };
        lines = next;
    }
    Err(ConstructError::Bound { asked: tolerance, reached, pieces })
}

/// The spline through the surface's points on the lines; seams and poles are the same numbers on both ends.
fn interpolate(sampler: &sides::Sampler<'_>, sides: &Sides, lu: &[f64], lv: &[f64]) -> Result<Surface, ConstructError> {
    let system = |lines: &[f64], side: Side| {
        let ends = if side == Side::Periodic { Ends::Periodic } else { Ends::NotAKnot };
        Cubic::new(lines, ends)
    };
    let (cu, cv) = (system(lu, sides.u)?, system(lv, sides.v)?);
    let mut values = sampler.grid(lu, lv)?;
    sides.close(&mut values, lu.len());
    let mut net = tensor(&cu, &cv, &values);
    sides.close(&mut net, cu.count());
    let points: Vec<DVec4> = net.iter().map(|p| p.extend(1.0)).collect();
    Ok(Surface::new((cu.degree(), cv.degree()), cu.knots().to_vec(), cv.knots().to_vec(), points)?)
}
