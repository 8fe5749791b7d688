//! Curves in space.
//!
//! ```text
//!   TRIMMED_CURVE('',basis,(trim 1),(trim 2),sense,master)
//!
//!     closed basis    sense .T.: from trim 1 up to trim 2, over the seam if need be
//!                     sense .F.: from trim 1 down to trim 2
//!     open basis      from trim 1 to trim 2: the order of the parameters says which way
//! ```
//!
//! The result always runs forward, from `start` up to `end`: a basis that the file runs through downwards
//! is turned round first. Parameters of circles and ellipses are in the context's plane angle unit.
//!
//! SURFACE_CURVE, SEAM_CURVE and INTERSECTION_CURVE give their curve in space; their (u, v) curves are
//! not used.
//!
//! Source: ISO 10303-42, 4.4.

use super::entity::{Entity, Fault, Fields};
use super::geometry::Geometry;
use super::locate;
use super::part21::Value;
use super::spline;
use crate::brep::CurveGeometry;
use crate::spline::BSpline;
use glam::DVec4;
use std::f64::consts::TAU;

impl Geometry<'_> {
    /// The curve `#id`.
    pub fn curve(&self, id: u32) -> Result<CurveGeometry, Fault> {
        self.ledger.nested(id, || {
            let entity = self.entity(id)?;
            let kind = entity.kinds().find(|k| KINDS.contains(k) || spline::is_curve(k));
            match kind.unwrap_or_default() {
                "LINE" => {
                    let fields = entity.fields("LINE", 1)?;
                    let (origin, direction) = (self.point(fields.reference(0)?)?, self.vector(fields.reference(1)?)?);
                    Ok(CurveGeometry::Line { origin, direction })
                }
                "CIRCLE" | "ELLIPSE" | "HYPERBOLA" | "PARABOLA" => self.conic(entity),
                "POLYLINE" => self.polyline(entity.fields("POLYLINE", 1)?),
                "TRIMMED_CURVE" => self.trimmed(entity.fields("TRIMMED_CURVE", 1)?),
                "COMPOSITE_CURVE" | "BOUNDARY_CURVE" | "OUTER_BOUNDARY_CURVE" | "COMPOSITE_CURVE_ON_SURFACE" => {
                    let directed = |s: Segment| match s.forward {
                        true => Ok(s.curve),
                        false => {
                            locate::reversed(s.curve).ok_or(Fault::Value { id: s.id, what: "a segment without ends" })
                        }
                    };
                    let curves = self.segments(entity)?.into_iter().map(directed);
                    Ok(CurveGeometry::Composite(curves.collect::<Result<_, _>>()?))
                }
                "SURFACE_CURVE" | "SEAM_CURVE" | "INTERSECTION_CURVE" | "BOUNDED_SURFACE_CURVE" => {
                    self.curve(space_curve(entity)?)
                }
                kind if spline::is_curve(kind) => Ok(CurveGeometry::BSpline(self.bspline_curve(entity)?)),
                _ => Err(Fault::Unsupported { id, kind: entity.name() }),
            }
        })
    }

    fn conic(&self, entity: Entity<'_>) -> Result<CurveGeometry, Fault> {
        let kind =
            entity.kinds().find_map(|k| ["CIRCLE", "ELLIPSE", "HYPERBOLA", "PARABOLA"].into_iter().find(|c| *c == k));
        let kind = kind.ok_or_else(|| entity.not("a conic"))?;
        let fields = entity.fields(kind, 1)?;
        // a complex instance keeps the position in the part CONIC
        let (position, first) = match entity.fields("CONIC", 1) {
            Ok(conic) => (conic.reference(0)?, 0),
            Err(_) => (fields.reference(0)?, 1),
        };
        let frame = self.frame(position)?;
        let length = |index: usize| Ok(fields.length(first + index)? * self.units.length);
        Ok(match kind {
            "CIRCLE" => CurveGeometry::Circle { frame, radius: length(0)? },
            "ELLIPSE" => CurveGeometry::Ellipse { frame, semi_x: length(0)?, semi_y: length(1)? },
            "HYPERBOLA" => CurveGeometry::Hyperbola { frame, semi_x: length(0)?, semi_y: length(1)? },
            _ => CurveGeometry::Parabola { frame, focal: length(0)? },
        })
    }

    /// A B-spline of degree 1 with one unit of parameter a segment.
    fn polyline(&self, fields: Fields<'_>) -> Result<CurveGeometry, Fault> {
        let id = fields.id;
        let mut points: Vec<DVec4> = Vec::new();
        for point in fields.references(0)? {
            self.ledger.spend(id, 1)?;
            points.push(self.point(point?)?.extend(1.0));
        }
        let last = points.len().saturating_sub(1) as f64;
        let knots = (0..points.len() + 2).map(|i| (i as f64 - 1.0).clamp(0.0, last)).collect();
        BSpline::new(1, knots, points).map(CurveGeometry::BSpline).map_err(|source| Fault::Spline { id, source })
    }

    fn trimmed(&self, fields: Fields<'_>) -> Result<CurveGeometry, Fault> {
        let id = fields.id;
        let basis = self.curve(fields.reference(0)?)?;
        let sense = fields.flag(3);
        if matches!(basis, CurveGeometry::Composite(_)) {
            // its parameters mean nothing elsewhere; the ends of the edge say which part is meant
            let turned = if sense { Some(basis) } else { locate::reversed(basis) };
            return turned.ok_or(Fault::Value { id, what: "a composite curve without ends" });
        }
        let by_point = matches!(fields.value(4), Some(Value::Enumeration("CARTESIAN")));
        let first = self.trim(fields, 1, &basis, by_point)?;
        let last = self.trim(fields, 2, &basis, by_point)?;
        trim(basis, first, last, sense).ok_or(Fault::Value { id, what: "the trimmed curve has no length" })
    }

    /// Parameter of one end: the one that the master representation names, else the other.
    fn trim(&self, fields: Fields<'_>, index: usize, basis: &CurveGeometry, by_point: bool) -> Result<f64, Fault> {
        let (mut parameter, mut point) = (None, None);
        for value in fields.list(index)? {
            match value {
                Value::Reference(id) => point = Some(self.point(id)?),
                value => parameter = value.number().filter(|x| x.is_finite()),
            }
        }
        let angular = matches!(basis, CurveGeometry::Circle { .. } | CurveGeometry::Ellipse { .. });
        let parameter = parameter.map(|t| if angular { t * self.units.angle } else { t });
        let located = point.and_then(|p| locate::parameter(basis, p));
        let (first, second) = if by_point { (located, parameter) } else { (parameter, located) };
        first.or(second).ok_or(Fault::Attribute {
            id: fields.id,
            index: index + 1,
            wanted: "a trimming parameter or point",
        })
    }

    /// The segments of a composite curve, in its order.
    pub fn segments(&self, entity: Entity<'_>) -> Result<Vec<Segment>, Fault> {
        let names = ["COMPOSITE_CURVE", "COMPOSITE_CURVE_ON_SURFACE", "BOUNDARY_CURVE", "OUTER_BOUNDARY_CURVE"];
        let fields = names.iter().find_map(|n| entity.fields(n, 1).ok().filter(|f| f.list(0).is_ok()));
        let fields = fields.ok_or_else(|| entity.not("a composite curve"))?;
        let mut segments = Vec::new();
        for segment in fields.references(0)? {
            let segment = self.entity(segment?)?;
            self.ledger.spend(segment.id(), 1)?;
            let other = "REPARAMETRISED_COMPOSITE_CURVE_SEGMENT";
            let segment = segment.fields("COMPOSITE_CURVE_SEGMENT", 0).or_else(|_| segment.fields(other, 0))?;
            let id = segment.reference(2)?;
            segments.push(Segment { id, forward: segment.flag(1), curve: self.curve(id)? });
        }
        if segments.is_empty() {
            return Err(Fault::Value { id: entity.id(), what: "a composite curve without segments" });
        }
        Ok(segments)
    }
}

/// One curve of a composite.
pub(super) struct Segment {
    /// Number of the curve's entity.
    pub id: u32,
    /// The composite runs along the curve.
    pub forward: bool,
    /// The curve.
    pub curve: CurveGeometry,
}

const KINDS: [&str; 15] = [
    "LINE",
    "CIRCLE",
    "ELLIPSE",
    "HYPERBOLA",
    "PARABOLA",
    "POLYLINE",
    "TRIMMED_CURVE",
    "COMPOSITE_CURVE",
    "COMPOSITE_CURVE_ON_SURFACE",
    "BOUNDARY_CURVE",
    "OUTER_BOUNDARY_CURVE",
    "SURFACE_CURVE",
    "SEAM_CURVE",
    "INTERSECTION_CURVE",
    "BOUNDED_SURFACE_CURVE",
];

/// Number of the curve in space of a SURFACE_CURVE or one of its subtypes.
fn space_curve(entity: Entity<'_>) -> Result<u32, Fault> {
    let names = ["SURFACE_CURVE", "SEAM_CURVE", "INTERSECTION_CURVE", "BOUNDED_SURFACE_CURVE"];
    let curve = names.iter().find_map(|n| entity.fields(n, 1).ok()?.optional(0));
    curve.ok_or_else(|| entity.not("a curve on a surface with a curve in space"))
}

/// The part of `basis` that runs from parameter `first` to `last`.
fn trim(basis: CurveGeometry, first: f64, last: f64, sense: bool) -> Option<CurveGeometry> {
    if let CurveGeometry::BSpline(spline) = &basis {
        let (a, b) = spline.domain();
        let (first, last) = (first.clamp(a, b), last.clamp(a, b));
        let closed = (spline.point(a) - spline.point(b)).length() <= 1e-9 * (1.0 + spline.point(a).length());
        if !closed || sense == (first < last) {
            return locate::piece(basis, first, last);
        }
        // over the seam: two pieces, in the order in which they are run through
        let (seam, start) = if sense { (b, a) } else { (a, b) };
        let parts = [locate::piece(basis.clone(), first, seam), locate::piece(basis, start, last)];
        let mut parts: Vec<_> = parts.into_iter().flatten().collect();
        return if parts.len() < 2 { parts.pop() } else { Some(CurveGeometry::Composite(parts)) };
    }
    if !matches!(basis, CurveGeometry::Circle { .. } | CurveGeometry::Ellipse { .. }) {
        return locate::piece(basis, first, last);
    }
    let sign = if sense { 1.0 } else { -1.0 };
    // a turn and a rounding error is no turn
    let turn = (sign * (last - first)).rem_euclid(TAU);
    let span = if turn < 1e-12 || TAU - turn < 1e-12 { TAU } else { turn };
    locate::piece(basis, first, first + sign * span)
}
