//! A curve in space cast onto a surface along a direction, as curves in the surface's `(u, v)`.
//!
//! ```text
//!       ╭───╮    outline P(t)             where the line P(t) + s d, coming from far behind, first meets the
//!       ╰─┬─╯                             surface, and from there on without a jump
//!         │ d
//!     ────▼────  surface S(u, v)          (S(u, v) - P(t)) × d = 0: two equations for u and v
//!       (( ))    projection
//! ```
//!
//! The solution's derivative comes from the same equations, so the curve is marched along. A cubic through the points
//! and tangents of both ends of a step is compared with the solution between them, at equal `t`. The step is halved
//! until the distance in space is small enough. The error of such a cubic has one hump, `x² (1 - x)²`.

use super::ConstructError;
use crate::spline::{BSpline, Bezier, Control, PatchGrid, Surface};
use glam::{DMat2, DVec2, DVec3, DVec4};

/// A projected curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Projected {
    /// End to end, one for each piece of the march, over `[0, 1]`.
    pub curves: Vec<BSpline<DVec3>>,
    /// Largest distance on the surface, in model units, from the exact projection at equal parameters; measured.
    pub deviation: f64,
}

/// Samples of the error in a step; the nearest of them reaches 99 % of the hump.
const SAMPLES: u32 = 8;
/// Factor for the error between the samples.
const MARGIN: f64 = 1.1;
/// Shortest step, of a Bézier piece of the outline.
const SHORTEST: f64 = 1.0 / 65536.0;
/// Most steps.
const MOST_STEPS: usize = 1 << 14;
/// Seeds in each patch, in each direction, for the first point.
const SEEDS: u32 = 6;
/// Most patches that are searched for the first point.
const MOST_PATCHES: usize = 1 << 16;
/// Share of the size that rounding leaves of a solution.
const ROUNDING: f64 = 1e-11;
const WHAT: &str = "the projected outline";

/// The projection of `outline`, curves that follow one another, on `surface` along `direction`; within `tolerance`
/// on the surface.
///
/// # Errors
/// A direction or tolerance that is not finite and positive; a line that misses the surface, runs along it or reaches its border; a tolerance that is not reached.
pub fn project(
    surface: &Surface,
    outline: &[BSpline<DVec4>],
    direction: DVec3,
    tolerance: f64,
) -> Result<Projected, ConstructError> {
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(ConstructError::Range { what: "the tolerance", value: tolerance, must: "positive" });
    }
    if !direction.is_finite() {
        return Err(ConstructError::NotFinite { what: "the direction of a projection" });
    }
    let Some(along) = direction.try_normalize() else {
        return Err(ConstructError::ZeroLength { what: "the direction of a projection" });
    };
    let pieces: Vec<Bezier<DVec4>> = outline.iter().flat_map(BSpline::beziers).map(|s| s.piece).collect();
    let Some(first) = pieces.first() else {
        return Err(ConstructError::TooFew { what: "curves of an outline", got: 0, needed: 1 });
    };
    let (e, f) = along.any_orthonormal_pair();
    let (lo, hi) = surface.bounds();
    let cast = Cast { grid: surface.patches(), domain: surface.domain(), along, e, f, size: lo.distance(hi) };
    let mut at = cast.first(first.point(0.0))?;
    let mut out = Projected { curves: Vec::new(), deviation: 0.0 };
    let mut parameter = 0.0;
    for piece in &pieces {
        at = cast.march(piece, at, (parameter, tolerance), &mut out)?;
        parameter += 1.0;
    }
    Ok(out)
}

/// The constants of the march.
struct Cast {
    grid: PatchGrid,
    domain: ((f64, f64), (f64, f64)),
    along: DVec3,
    e: DVec3,
    f: DVec3,
    size: f64,
}

impl Cast {
    fn clamp(&self, p: DVec2) -> DVec2 {
        let ((u0, u1), (v0, v1)) = self.domain;
        p.clamp(DVec2::new(u0, v0), DVec2::new(u1, v1))
    }

    /// The components across the direction.
    fn across(&self, v: DVec3) -> DVec2 {
        DVec2::new(self.e.dot(v), self.f.dot(v))
    }

    /// The offset of the surface's point from `p` across the direction, and its derivatives.
    fn residual(&self, uv: DVec2, p: DVec3) -> (DVec2, DMat2) {
        let jet = self.grid.jet(uv.x, uv.y);
        (self.across(jet.point - p), DMat2::from_cols(self.across(jet.du), self.across(jet.dv)))
    }

    /// The inverse, unless the direction runs along the surface there.
    fn inverse(&self, m: &DMat2) -> Option<DMat2> {
        let flat = m.determinant().abs() <= 1e-9 * m.x_axis.length() * m.y_axis.length();
        (!flat).then(|| m.inverse()).filter(DMat2::is_finite)
    }

    /// Newton's method from `uv`; `None` where it does not settle.
    fn solve(&self, mut uv: DVec2, p: DVec3) -> Option<DVec2> {
        for _ in 0..24 {
            let (r, m) = self.residual(uv, p);
            let next = self.clamp(uv - self.inverse(&m)? * r);
            let step = (next - uv).abs();
            uv = next;
            if (step.cmple(DVec2::splat(1e-15) * uv.abs().max(DVec2::splat(1e-3)))).all() {
                break;
            }
        }
        (self.residual(uv, p).0.length() <= ROUNDING * (self.size + p.length())).then_some(uv)
    }

    /// The nearest point of the surface on the line through `p`, counted along the direction.
    fn first(&self, p: DVec3) -> Result<DVec2, ConstructError> {
        let patches = &self.grid.patches;
        if patches.len() > MOST_PATCHES {
            return Err(ConstructError::TooMany { what: "patches", got: patches.len(), most: MOST_PATCHES });
        }
        let mut best: Option<(f64, DVec2)> = None;
        for patch in patches {
            // the patch lies in the box of its points: a line outside the box misses it
            let net = patch.patch.points.iter().map(|q| self.across(q.point() - p));
            let (lo, hi) = net.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), q| (a.min(q), b.max(q)));
            if lo.max_element() > 1e-9 * self.size || hi.min_element() < -1e-9 * self.size {
                continue;
            }
            for k in 0..SEEDS * SEEDS {
                let share = |i: u32| (f64::from(i) + 0.5) / f64::from(SEEDS);
                let lerp = |(a, b): (f64, f64), x: f64| a + (b - a) * x;
                let seed = DVec2::new(lerp(patch.u, share(k % SEEDS)), lerp(patch.v, share(k / SEEDS)));
                let Some(uv) = self.solve(seed, p) else { continue };
                let depth = self.along.dot(self.grid.point(uv.x, uv.y) - p);
                if best.is_none_or(|b| depth < b.0) {
                    best = Some((depth, uv));
                }
            }
        }
        best.map(|b| b.1).ok_or(ConstructError::Misses { what: WHAT, parameter: 0.0 })
    }

    /// Derivative of the solution along the outline.
    fn slope(&self, uv: DVec2, piece: &Bezier<DVec4>, t: f64) -> Option<DVec2> {
        let (h, d) = piece.jet(t);
        let velocity = (d.truncate() - h.point() * d.w) / h.w;
        Some(self.inverse(&self.residual(uv, h.point()).1)? * self.across(velocity))
    }

    /// Along one piece, whose first parameter is `from` in messages; returns the solution at its end.
    fn march(
        &self,
        piece: &Bezier<DVec4>,
        mut at: DVec2,
        (from, tolerance): (f64, f64),
        out: &mut Projected,
    ) -> Result<DVec2, ConstructError> {
        let misses = |t: f64| ConstructError::Misses { what: WHAT, parameter: from + t };
        let (mut t, mut step) = (0.0, 0.25);
        let mut slope = self.slope(at, piece, 0.0).ok_or_else(|| misses(0.0))?;
        let mut reached;
        while t < 1.0 {
            let end = if t + step > 1.0 - 0.5 * SHORTEST { 1.0 } else { t + step };
            match self.step(piece, (t, at, slope), end) {
                Some((next, after, error)) if error <= tolerance => {
                    let h = (end - t) / 3.0;
                    let points = [at, at + slope * h, next - after * h, next].map(|p| DVec3::from_point(p, 1.0));
                    out.curves.push(BSpline::from_bezier(Bezier { points: points.to_vec() }, 0.0, 1.0)?);
                    out.deviation = out.deviation.max(error);
                    if out.curves.len() > MOST_STEPS {
                        return Err(ConstructError::Bound { asked: tolerance, reached: error, pieces: MOST_STEPS });
                    }
                    (t, at, slope, step) = (end, next, after, 2.0 * (end - t));
                    continue;
                }
                // the reason of a step that stays too short: its error, or that the line meets nothing
                found => reached = found.map_or(f64::INFINITY, |f| f.2),
            }
            step = 0.5 * (end - t);
            if step < SHORTEST {
                return Err(if reached.is_finite() {
                    ConstructError::Bound { asked: tolerance, reached, pieces: out.curves.len() }
                } else {
                    misses(t)
                });
            }
        }
        Ok(at)
    }

    /// Solution and slope at `end`, and the error of the cubic from `(t, uv, slope)` to there.
    fn step(
        &self,
        piece: &Bezier<DVec4>,
        (t, uv, slope): (f64, DVec2, DVec2),
        end: f64,
    ) -> Option<(DVec2, DVec2, f64)> {
        let h = end - t;
        let next = self.solve(self.clamp(uv + slope * h), piece.point(end))?;
        let after = self.slope(next, piece, end)?;
        let mut worst: f64 = 0.0;
        for k in 1..SAMPLES {
            let x = f64::from(k) / f64::from(SAMPLES);
            let y = 1.0 - x;
            let cubic = uv * (y * y * (1.0 + 2.0 * x))
                + next * (x * x * (1.0 + 2.0 * y))
                + (slope * (x * y * y) - after * (x * x * y)) * h;
            let cubic = self.clamp(cubic);
            let exact = self.solve(cubic, piece.point(t + h * x))?;
            worst = worst.max(self.grid.point(cubic.x, cubic.y).distance(self.grid.point(exact.x, exact.y)));
        }
        Some((next, after, MARGIN * worst))
    }
}
