//! A surface through sections.
//!
//! ```text
//!   c3 ────────────── v3          column i of the net: the cubic spline through
//!   c2 ──────────     v2          the control points i of all sections
//!   c1 ─────────────  v1
//!   c0 ────────       v0 = 0      v_k: chord lengths between sections, averaged over the columns
//! ```
//!
//! Rational sections are interpolated in homogeneous coordinates. A curve's weights may have any common factor: each
//! section is scaled so that the mean of its weights is 1, so the result does not depend on that factor.
//!
//! Source: L. Piegl, W. Tiller, *The NURBS Book*, 1997, section 10.3.

use super::ConstructError;
use super::compat::{apart, compatible, size};
use crate::spline::cubic::{Cubic, Ends};
use crate::spline::{BSpline, Control, Surface};
use glam::DVec4;

/// Share of the size below which neighbouring sections coincide.
pub(super) const SAME_SECTION: f64 = 1e-12;

/// The surface through `sections` at increasing `v`, over the unit square; `u` runs along the sections.
///
/// It passes through every section to rounding (`1e-12` of the size). Along `v` it is a C² cubic (`Ends::NotAKnot`),
/// a parabola through three sections, ruled between two; `closed` goes on from the last to the first, C² there too.
/// Along `u` it has at each knot the continuity of the roughest section. Sections should begin at corresponding
/// points: equal fractions of their domains are joined.
///
/// # Errors
/// Fewer than two sections (three when closed); neighbours that coincide; weights so different that the interpolated
/// ones are not positive.
pub fn loft(sections: &[BSpline<DVec4>], closed: bool) -> Result<Surface, ConstructError> {
    let needed = if closed { 3 } else { 2 };
    if sections.len() < needed {
        return Err(ConstructError::TooFew { what: "sections", got: sections.len(), needed });
    }
    let mut rows = compatible(sections)?.iter().map(scaled).collect::<Result<Vec<_>, _>>()?;
    if closed {
        rows.push(rows[0].clone());
    }
    let fine = SAME_SECTION * size(sections);
    for (k, pair) in rows.windows(2).enumerate() {
        if apart(&pair[0], &pair[1]) <= fine {
            return Err(ConstructError::CoincidentSections { first: k, second: (k + 1) % sections.len() });
        }
    }
    let across = Cubic::new(&heights(&rows, fine), if closed { Ends::Periodic } else { Ends::NotAKnot })?;
    skin(&rows, &across)
}

/// The surface through compatible `rows` at the parameters of `across`.
pub(super) fn skin(rows: &[BSpline<DVec4>], across: &Cubic) -> Result<Surface, ConstructError> {
    let (nu, nv) = (rows[0].points().len(), across.count());
    let polynomial = rows.iter().flat_map(BSpline::points).all(|p| p.w == 1.0);
    let mut net = vec![DVec4::ZERO; nu * nv];
    for i in 0..nu {
        let column: Vec<DVec4> = rows.iter().map(|r| r.points()[i]).collect();
        for (j, p) in across.control(&column, (DVec4::ZERO, DVec4::ZERO)).into_iter().enumerate() {
            net[j * nu + i] = if polynomial { p.with_w(1.0) } else { p };
        }
    }
    positive(&net)?;
    Ok(Surface::new((rows[0].degree(), across.degree()), rows[0].knots().to_vec(), across.knots().to_vec(), net)?)
}

/// Weights that a spline may have.
pub(super) fn positive(net: &[DVec4]) -> Result<(), ConstructError> {
    if net.iter().any(|p| p.w <= 0.0) {
        return Err(ConstructError::Weights { what: "a blended weight is not positive" });
    }
    Ok(())
}

/// The same curve, its weights 1 on average; exactly 1 when they are equal.
pub(super) fn scaled(curve: &BSpline<DVec4>) -> Result<BSpline<DVec4>, ConstructError> {
    let points = curve.points();
    let mean = points.iter().map(|p| p.w).sum::<f64>() / points.len() as f64;
    let even = |p: &DVec4| DVec4::from_point(p.point(), 1.0);
    let scale = |p: &DVec4| *p * (1.0 / mean);
    let scaled =
        if curve.is_polynomial() { points.iter().map(even).collect() } else { points.iter().map(scale).collect() };
    Ok(BSpline::new(curve.degree(), curve.knots().to_vec(), scaled)?)
}

/// Parameters of the sections from 0 to 1: chord lengths, averaged over the columns that have a length.
fn heights(rows: &[BSpline<DVec4>], fine: f64) -> Vec<f64> {
    let step = |k: usize, i: usize| rows[k].points()[i].point().distance(rows[k + 1].points()[i].point());
    let gaps = rows.len() - 1;
    let mut sums = vec![0.0; gaps];
    for i in 0..rows[0].points().len() {
        let column: Vec<f64> = (0..gaps).map(|k| step(k, i)).collect();
        let length: f64 = column.iter().sum();
        if length > fine {
            sums.iter_mut().zip(&column).for_each(|(s, c)| *s += c / length);
        }
    }
    let total: f64 = sums.iter().sum();
    let mut at = vec![0.0];
    for s in &sums[..gaps - 1] {
        at.push(at[at.len() - 1] + s / total);
    }
    at.push(1.0);
    at
}
