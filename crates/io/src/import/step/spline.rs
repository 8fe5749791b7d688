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
use crate::brep::CurveGeometry;
use crate::import::torn::{Part, mend};
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
    /// Any B-spline curve; where it breaks, its parts as a composite.
    pub fn bspline_curve(&self, entity: Entity<'_>) -> Result<CurveGeometry, Fault> {
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
        let parts = self.mended(id, degree, Part { knots, rows: points.into_iter().map(|p| vec![p]).collect() });
        let curve = |part: Part| {
            let points = part.rows.into_iter().flatten().collect();
            let spline = BSpline::new(degree, part.knots, points).map_err(|source| Fault::Spline { id, source })?;
            Ok(CurveGeometry::BSpline(spline))
        };
        let mut curves = parts.into_iter().map(curve).collect::<Result<Vec<_>, _>>()?;
        let last = curves.pop().ok_or_else(|| entity.not("a curve"))?;
        Ok(if curves.is_empty() { last } else { CurveGeometry::Composite([curves, vec![last]].concat()) })
    }

    /// Any B-spline surface; where it breaks, its parts.
    pub fn bspline_surface(&self, entity: Entity<'_>) -> Result<Vec<Surface>, Fault> {
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
        let mut surfaces = Vec::new();
        for strip in self.mended(id, degrees.0, Part { knots: knots_u, rows: columns }) {
            let part = Part { knots: knots_v.clone(), rows: turned(&strip.rows) };
            for part in self.mended(id, degrees.1, part) {
                let points = part.rows.into_iter().flatten().collect();
                let surface = Surface::new(degrees, strip.knots.clone(), part.knots, points);
                surfaces.push(surface.map_err(|source| Fault::Spline { id, source })?);
            }
        }
        Ok(surfaces)
    }

    /// The parts of a spline between breaks, with a note where there were any.
    fn mended(&self, id: u32, degree: usize, part: Part) -> Vec<Part> {
        let knots = part.knots.len();
        let (parts, closed) = mend(degree, part, self.units.tolerance);
        if parts.len() > 1 {
            self.ledger.note("torn spline", id, format!("cut into {} parts where it breaks", parts.len()));
        } else if parts[0].knots.len() < knots {
            self.ledger.note("torn spline", id, format!("joined over a gap of {closed:.1e} mm"));
        }
        parts
    }
}

/// Rows as columns.
fn turned(rows: &[Vec<DVec4>]) -> Vec<Vec<DVec4>> {
    (0..rows.first().map_or(0, Vec::len)).map(|k| rows.iter().map(|r| r[k]).collect()).collect()
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
