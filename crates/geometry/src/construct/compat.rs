//! Curves of any degree and knots brought to a common degree and knot vector, exactly.
//!
//! ```text
//!   degree 1   ├──────────────┤          degree 3   ├────┬────┬────┤
//!   degree 3   ├────┬─────────┤    ──▶              ├────┬────┬────┤      every domain [0, 1]
//!   degree 2   ├─────────┬────┤                     ├────┬────┬────┤
//! ```
//!
//! The net of a surface through the curves can then be made column by column.

use super::ConstructError;
use crate::model::Bounds;
use crate::spline::{BSpline, Control, Surface};
use glam::DVec4;

/// Knots of different curves nearer than this, of a domain of length 1, are one knot: the curve between them moves by
/// no more than this share of its length.
const SAME_KNOT: f64 = 1e-13;

/// The curves over `[0, 1]` with the largest of their degrees and all of their knots.
///
/// # Errors
/// A knot vector that cannot be scaled to `[0, 1]`.
pub fn compatible(curves: &[BSpline<DVec4>]) -> Result<Vec<BSpline<DVec4>>, ConstructError> {
    let families = curves.iter().map(|c| vec![c.clone()]).collect();
    Ok(unify(families)?.into_iter().flatten().collect())
}

/// The same for families whose members share degree and knots.
fn unify(mut families: Vec<Vec<BSpline<DVec4>>>) -> Result<Vec<Vec<BSpline<DVec4>>>, ConstructError> {
    let degree = families.iter().flatten().map(BSpline::degree).max().unwrap_or(1);
    for curve in families.iter_mut().flatten() {
        *curve = curve.over(0.0, 1.0)?.elevated_to(degree)?;
    }
    let mut all: Vec<f64> = families.iter().filter_map(|f| f.first()).flat_map(|c| c.knots().to_vec()).collect();
    all.sort_by(f64::total_cmp);
    let mut distinct: Vec<f64> = Vec::new();
    for x in all {
        if distinct.last().is_none_or(|last| x - last > SAME_KNOT) {
            distinct.push(x);
        }
    }
    if let Some(last) = distinct.last_mut().filter(|last| 1.0 - **last <= SAME_KNOT) {
        *last = 1.0;
    }
    let snapped = |x: f64| {
        let i = distinct.partition_point(|d| *d < x - SAME_KNOT);
        distinct.get(i).copied().unwrap_or(x)
    };
    for curve in families.iter_mut().flatten() {
        let knots = curve.knots().iter().map(|k| snapped(*k)).collect();
        *curve = BSpline::new(degree, knots, curve.points().to_vec())?;
    }
    let copies = |c: &BSpline<DVec4>, x: f64| c.knots().iter().filter(|k| **k == x).count();
    let most: Vec<(f64, usize)> = distinct
        .iter()
        .map(|&x| (x, families.iter().filter_map(|f| f.first()).map(|c| copies(c, x)).max().unwrap_or(0)))
        .collect();
    for family in &mut families {
        let Some(first) = family.first() else { continue };
        let missing: Vec<f64> =
            most.iter().flat_map(|&(x, n)| std::iter::repeat_n(x, n.saturating_sub(copies(first, x)))).collect();
        family.iter_mut().for_each(|c| *c = c.with_knots(&missing));
    }
    Ok(families)
}

/// Surfaces over the unit square with common degrees and knots.
pub(super) fn compatible_surfaces(surfaces: &[Surface]) -> Result<Vec<Surface>, ConstructError> {
    let along_u = |surfaces: &[Surface]| -> Result<Vec<Surface>, ConstructError> {
        let families = unify(surfaces.iter().map(Surface::rows).collect())?;
        let back = families.iter().zip(surfaces);
        back.map(|(rows, s)| Ok(Surface::from_rows(rows, s.degrees().1, s.knots().1.to_vec())?)).collect()
    };
    let turned = |surfaces: Vec<Surface>| surfaces.iter().map(Surface::transposed).collect::<Vec<_>>();
    Ok(turned(along_u(&turned(along_u(surfaces)?))?))
}

/// Diagonal of the box of the control points.
pub(super) fn size<'a>(curves: impl IntoIterator<Item = &'a BSpline<DVec4>>) -> f64 {
    let points = curves.into_iter().flat_map(BSpline::points);
    points.fold(Bounds::EMPTY, |b, p| b.with(p.point())).diagonal()
}

/// Largest distance between control points of compatible curves: 0 for one curve.
pub(super) fn apart(a: &BSpline<DVec4>, b: &BSpline<DVec4>) -> f64 {
    a.points().iter().zip(b.points()).map(|(p, q)| p.point().distance(q.point())).fold(0.0, f64::max)
}

/// The curve over `[0, 1]` with weight 1 at both ends: the same points in the same order, reached at other
/// parameters where the end weights differ.
///
/// ```text
///   t = a s / (1 + (a - 1) s)      control point i times Π (1 + (a - 1) s_{i+j}), j = 1 … p
/// ```
///
/// Source: G. Farin, *Curves and Surfaces for CAGD*, 2002, section 13.6, by polar forms for B-splines.
pub(super) fn unit_ends(curve: &BSpline<DVec4>) -> Result<BSpline<DVec4>, ConstructError> {
    let c = curve.over(0.0, 1.0)?.clamped();
    let (p, first, last) = (c.degree(), c.points()[0].w, c.points()[c.points().len() - 1].w);
    let a = if (first - last).abs() <= 1e-14 * first { 1.0 } else { (first / last).powf(1.0 / p as f64) };
    let knots: Vec<f64> =
        c.knots().iter().map(|&t| if a == 1.0 || t == 0.0 || t == 1.0 { t } else { t / (a + (1.0 - a) * t) }).collect();
    let factor = |i: usize| knots[i + 1..=i + p].iter().map(|s| 1.0 + (a - 1.0) * s).product::<f64>() / first;
    let points = c.points().iter().enumerate().map(|(i, q)| *q * factor(i)).collect();
    Ok(BSpline::new(p, knots, points)?)
}
