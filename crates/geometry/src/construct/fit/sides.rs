//! Seams and poles: which sides of a surface meet or collapse.
//!
//! ```text
//!     v1 ──────pole──────      every point of the side is one point
//!        │              │
//!        u0  =  seam   u1      S(u0, v) = S(u1, v) for all v
//!        │              │
//!     v0 ────────────────
//! ```

use crate::construct::ConstructError;
use glam::DVec3;
use rayon::prelude::*;

/// How the two sides of one parameter meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// They are apart.
    Open,
    /// They are one curve; the surface has a crease there.
    Closed,
    /// They are one curve, and the surface runs on smoothly.
    Periodic,
}

/// The sides of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sides {
    /// The sides `u = u0` and `u = u1`.
    pub u: Side,
    /// The sides `v = v0` and `v = v1`.
    pub v: Side,
    /// The points that the sides `u0`, `u1`, `v0`, `v1` are collapsed to.
    pub poles: [Option<DVec3>; 4],
}

impl Sides {
    /// Makes the sides of a grid or control net of `count_u` columns the same numbers.
    pub(super) fn close(&self, net: &mut [DVec3], count_u: usize) {
        let count_v = net.len() / count_u;
        if self.u != Side::Open {
            for row in net.chunks_exact_mut(count_u) {
                row[count_u - 1] = row[0];
            }
        }
        if self.v != Side::Open {
            net.copy_within(0..count_u, (count_v - 1) * count_u);
        }
        for (side, pole) in self.poles.iter().enumerate() {
            let Some(pole) = *pole else { continue };
            match side {
                0 => net.iter_mut().step_by(count_u).for_each(|p| *p = pole),
                1 => net.iter_mut().skip(count_u - 1).step_by(count_u).for_each(|p| *p = pole),
                2 => net[..count_u].fill(pole),
                _ => net[(count_v - 1) * count_u..].fill(pole),
            }
        }
    }
}

/// The surface described, over its domain, with its values checked.
pub(super) struct Sampler<'a> {
    f: &'a (dyn Fn(f64, f64) -> DVec3 + Sync),
    /// Domain in `u` and in `v`.
    pub domain: [(f64, f64); 2],
}

impl<'a> Sampler<'a> {
    pub fn new(f: &'a (dyn Fn(f64, f64) -> DVec3 + Sync), u: (f64, f64), v: (f64, f64)) -> Self {
        Self { f, domain: [u, v] }
    }

    /// # Errors
    /// [`ConstructError::NotFiniteAt`].
    pub fn at(&self, u: f64, v: f64) -> Result<DVec3, ConstructError> {
        let p = (self.f)(u, v);
        // the squares of lengths must be finite too
        if p.is_finite() && p.abs().max_element() < 1e150 { Ok(p) } else { Err(ConstructError::NotFiniteAt { u, v }) }
    }

    /// Values on a grid, `u` fastest.
    pub fn grid(&self, us: &[f64], vs: &[f64]) -> Result<Vec<DVec3>, ConstructError> {
        let row = |v: &f64| us.iter().map(|u| self.at(*u, *v)).collect::<Result<Vec<_>, _>>();
        let rows: Result<Vec<Vec<DVec3>>, _> = vs.par_iter().map(row).collect();
        Ok(rows?.concat())
    }

    /// With `axis` 1 the parameters change places.
    fn swapped(&self, axis: usize, a: f64, b: f64) -> Result<DVec3, ConstructError> {
        if axis == 0 { self.at(a, b) } else { self.at(b, a) }
    }
}

/// Points along each side; odd, so that they do not fall on the symmetries of most equations.
const ALONG: usize = 37;

/// The sides, and the largest distance of a sampled point from the origin.
pub(super) fn find(s: &Sampler<'_>, tolerance: f64) -> Result<(Sides, f64), ConstructError> {
    let spread = |(a, b): (f64, f64)| -> Vec<f64> {
        (0..=ALONG).map(|i| if i == ALONG { b } else { a + (b - a) * (i as f64 / ALONG as f64) }).collect()
    };
    let [us, vs] = s.domain.map(spread);
    let sample = s.grid(&us, &vs)?;
    let size = sample.iter().map(|p| p.length()).fold(0.0, f64::max);
    let extent = sample.iter().map(|p| p.distance(sample[0])).fold(0.0, f64::max);
    if extent <= 1e-13 * size || extent == 0.0 {
        return Err(ConstructError::ZeroLength { what: "the surface" });
    }
    // the rounding of angles like 2 pi, but never so much that closing spends the tolerance
    let same = (1e-9 * extent).max(1e-14 * size).min(0.125 * tolerance);
    let mut sides = Sides { u: Side::Open, v: Side::Open, poles: [None; 4] };
    for axis in 0..2 {
        let ((a, b), others) = (s.domain[axis], if axis == 0 { &vs } else { &us });
        let side = |at: f64| others.iter().map(|o| s.swapped(axis, at, *o)).collect::<Result<Vec<_>, _>>();
        let (first, last) = (side(a)?, side(b)?);
        let one_point = |side: &[DVec3]| side.iter().all(|p| p.distance(side[0]) <= same).then_some(side[0]);
        sides.poles[2 * axis] = one_point(&first);
        sides.poles[2 * axis + 1] = one_point(&last);
        let meets = first.iter().zip(&last).all(|(p, q)| p.distance(*q) <= same);
        if meets && sides.poles[2 * axis].is_none() {
            let smooth = runs_on(s, axis, others)?;
            let found = if smooth { Side::Periodic } else { Side::Closed };
            if axis == 0 { sides.u = found } else { sides.v = found }
        }
    }
    Ok((sides, size))
}

/// The first derivative across the seam is the same on both sides, by one-sided differences of fourth order.
fn runs_on(s: &Sampler<'_>, axis: usize, others: &[f64]) -> Result<bool, ConstructError> {
    /// Step as a share of the domain: truncation `h⁴` and rounding `ε / h` both near 1e-12.
    const STEP: f64 = 1e-3;
    /// Larger differences are creases; smaller ones cost some refinement at the seam at most.
    const SAME: f64 = 1e-5;
    let (a, b) = s.domain[axis];
    let h = (b - a) * STEP;
    let slope = |at: f64, h: f64, other: f64| -> Result<DVec3, ConstructError> {
        let weights = [-25.0, 48.0, -36.0, 16.0, -3.0];
        let mut sum = DVec3::ZERO;
        for (i, w) in weights.iter().enumerate() {
            sum += s.swapped(axis, at + h * i as f64, other)? * *w;
        }
        Ok(sum / (12.0 * h))
    };
    let (mut worst, mut scale): (f64, f64) = (0.0, 0.0);
    for other in others {
        let (start, end) = (slope(a, h, *other)?, slope(b, -h, *other)?);
        worst = worst.max(start.distance(end));
        scale = scale.max(start.length()).max(end.length());
    }
    Ok(worst <= SAME * scale)
}
