//! B-spline curves and surfaces in all their spellings.
//!
//! ```text
//!   simple    B_SPLINE_CURVE_WITH_KNOTS('',3,(#1,…),.UNSPECIFIED.,.F.,.F.,(4,4),(0.,1.),.UNSPECIFIED.)
//!             BEZIER_CURVE, QUASI_UNIFORM_CURVE, UNIFORM_CURVE ('',3,(#1,…),.UNSPECIFIED.,.F.,.F.)
//!   complex   (B_SPLINE_CURVE(3,(…),…) B_SPLINE_CURVE_WITH_KNOTS((4,4),(0.,1.),…)
//!              RATIONAL_B_SPLINE_CURVE((1.,…)) …)
//! ```
//!
//! Source: ISO 10303-42, 4.4.33 to 4.4.40 and `default_b_spline_knots`.

use super::entity::{Entity, Fault, Fields};
use super::geometry::Geometry;
use crate::spline::{BSpline, Control, MAX_DEGREE, Surface};
use glam::DVec4;

const SPACINGS: [(&str, &str, Spacing); 3] = [
    ("BEZIER_CURVE", "BEZIER_SURFACE", Spacing::Bezier),
    ("UNIFORM_CURVE", "UNIFORM_SURFACE", Spacing::Uniform),
    ("QUASI_UNIFORM_CURVE", "QUASI_UNIFORM_SURFACE", Spacing::QuasiUniform),
];

/// A knot vector that the entity's type implies.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Spacing {
    /// Ends repeated `degree + 1` times, interior knots once.
    QuasiUniform,
    /// Every knot once; the curve does not reach its end points.
    Uniform,
    /// Interior knots repeated `degree` times: Bézier pieces.
    Bezier,
}

/// The names of B-spline curve entities.
pub(super) fn is_curve(kind: &str) -> bool {
    matches!(kind, "B_SPLINE_CURVE" | "B_SPLINE_CURVE_WITH_KNOTS" | "RATIONAL_B_SPLINE_CURVE")
        || SPACINGS.iter().any(|s| s.0 == kind)
}

/// The names of B-spline surface entities.
pub(super) fn is_surface(kind: &str) -> bool {
    matches!(kind, "B_SPLINE_SURFACE" | "B_SPLINE_SURFACE_WITH_KNOTS" | "RATIONAL_B_SPLINE_SURFACE")
        || SPACINGS.iter().any(|s| s.1 == kind)
}

impl Geometry<'_> {
    /// Any B-spline curve.
    pub fn bspline_curve(&self, entity: Entity<'_>) -> Result<BSpline<DVec4>, Fault> {
        let id = entity.id();
        let base = base(entity, is_curve, "B_SPLINE_CURVE")?;
        let degree = degree(base, 0)?;
        let mut points = Vec::new();
        for point in base.references(1)? {
            self.ledger.spend(id, 1)?;
            points.push(self.point(point?)?.extend(1.0));
        }
        if let Ok(rational) = entity.fields("RATIONAL_B_SPLINE_CURVE", 6) {
            weigh(id, &mut points, &rational.reals(0)?)?;
        }
        let knots = match entity.fields("B_SPLINE_CURVE_WITH_KNOTS", 6) {
            Ok(fields) => expand(fields, 0, 1, degree, points.len())?,
            Err(_) => spaced(spacing(entity), degree, points.len()),
        };
        BSpline::new(degree, knots, points).map_err(|source| Fault::Spline { id, source })
    }

    /// Any B-spline surface.
    pub fn bspline_surface(&self, entity: Entity<'_>) -> Result<Surface, Fault> {
        let id = entity.id();
        let base = base(entity, is_surface, "B_SPLINE_SURFACE")?;
        let degrees = (degree(base, 0)?, degree(base, 1)?);
        let ragged = || Fault::Value { id, what: "the rows of control points differ in length" };
        // the file runs along v fastest, the engine along u
        let mut columns: Vec<Vec<DVec4>> = Vec::new();
        for row in base.list(2)? {
            let row = row.list().ok_or_else(ragged)?;
            let mut column = Vec::new();
            for point in row {
                self.ledger.spend(id, 1)?;
                let point = point.reference().ok_or(Fault::Attribute { id, index: 3, wanted: "a net of points" })?;
                column.push(self.point(point)?.extend(1.0));
            }
            columns.push(column);
        }
        if let Ok(rational) = entity.fields("RATIONAL_B_SPLINE_SURFACE", 8) {
            let rows: Vec<_> = rational.list(0)?.collect();
            if rows.len() != columns.len() {
                return Err(ragged());
            }
            for (column, row) in columns.iter_mut().zip(rows) {
                let weights: Option<Vec<f64>> = row.list().and_then(|r| r.map(|w| w.number()).collect());
                weigh(id, column, &weights.ok_or_else(ragged)?)?;
            }
        }
        let (count_u, count_v) = (columns.len(), columns.first().map_or(0, Vec::len));
        if columns.iter().any(|c| c.len() != count_v) {
            return Err(ragged());
        }
        let (knots_u, knots_v) = match entity.fields("B_SPLINE_SURFACE_WITH_KNOTS", 8) {
            Ok(f) => (expand(f, 0, 2, degrees.0, count_u)?, expand(f, 1, 3, degrees.1, count_v)?),
            Err(_) => {
                let s = spacing(entity);
                (spaced(s, degrees.0, count_u), spaced(s, degrees.1, count_v))
            }
        };
        let points = (0..count_v).flat_map(|j| columns.iter().map(move |c| c[j])).collect();
        Surface::new(degrees, knots_u, knots_v, points).map_err(|source| Fault::Spline { id, source })
    }
}

/// Where degree and control points stand: behind the name of a simple instance, or in `complex`.
fn base<'a>(entity: Entity<'a>, is: impl Fn(&str) -> bool, complex: &'static str) -> Result<Fields<'a>, Fault> {
    entity.fields(complex, 1).or_else(|_| {
        let simple = entity.kinds().count() == 1 && entity.kinds().all(&is);
        if simple { Ok(entity.all().after_name()) } else { Err(entity.not(complex)) }
    })
}

fn degree(fields: Fields<'_>, index: usize) -> Result<usize, Fault> {
    let wanted = "a degree from 1 to 15";
    let fault = Fault::Attribute { id: fields.id, index: index + 1, wanted };
    fields.count(index).ok().filter(|d| (1..=MAX_DEGREE).contains(d)).ok_or(fault)
}

fn weigh(id: u32, points: &mut [DVec4], weights: &[f64]) -> Result<(), Fault> {
    if points.len() != weights.len() {
        return Err(Fault::Value { id, what: "weights and control points differ in number" });
    }
    points.iter_mut().zip(weights).for_each(|(p, &w)| *p = DVec4::from_point(p.point(), w));
    Ok(())
}

fn spacing(entity: Entity<'_>) -> Spacing {
    SPACINGS.iter().find(|s| entity.is(s.0) || entity.is(s.1)).map_or(Spacing::QuasiUniform, |s| s.2)
}

fn spaced(spacing: Spacing, degree: usize, points: usize) -> Vec<f64> {
    let repeat = if spacing == Spacing::Bezier { degree } else { 1 };
    let spans = (points.max(degree + 1) - 1 - degree) / repeat + 1;
    (0..points + degree + 1)
        .map(|i| match spacing {
            Spacing::Uniform => i as f64 - degree as f64,
            // knot `degree` starts the domain; `repeat` knots later the next span does
            _ => ((i + repeat).saturating_sub(degree + 1) / repeat).min(spans) as f64,
        })
        .collect()
}

/// Knots repeated by their multiplicities. Knots beyond what the control points need would only be
/// allocated to be refused, so counting comes first.
fn expand(fields: Fields<'_>, mults: usize, knots: usize, degree: usize, points: usize) -> Result<Vec<f64>, Fault> {
    let id = fields.id;
    let wanted = "a list of multiplicities";
    let bad = Fault::Attribute { id, index: mults + 1, wanted };
    let mults: Vec<usize> = fields.list(mults)?.map(|v| v.count()).collect::<Option<_>>().ok_or(bad)?;
    let knots = fields.reals(knots)?;
    if mults.len() != knots.len() {
        return Err(Fault::Value { id, what: "knots and multiplicities differ in number" });
    }
    let count = mults.iter().fold(0usize, |n, &m| n.saturating_add(m));
    if count != points + degree + 1 {
        return Err(Fault::Value { id, what: "the knots do not fit the control points" });
    }
    Ok(knots.iter().zip(mults).flat_map(|(&k, m)| std::iter::repeat_n(k, m)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn implied_knots() {
        // ISO 10303-42 default_b_spline_knots: degree 2, 5 points
        assert_eq!(spaced(Spacing::QuasiUniform, 2, 5), [0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0]);
        assert_eq!(spaced(Spacing::Uniform, 2, 5), [-2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        assert_eq!(spaced(Spacing::Bezier, 2, 5), [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
        assert_eq!(spaced(Spacing::Bezier, 3, 4), [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]);
        assert_eq!(spaced(Spacing::Bezier, 1, 3), [0.0, 0.0, 1.0, 2.0, 2.0]);
    }
}
