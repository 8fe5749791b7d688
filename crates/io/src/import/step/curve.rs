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
//! SURFACE_CURVE, SEAM_CURVE and INTERSECTION_CURVE give their curve in space; their (u, v) curves are used only
//! without one. A PCURVE that stands alone becomes a curve in space: exact in a plane, fitted on other surfaces; so
//! does OFFSET_CURVE_3D. A CURVE_REPLICA is an exact copy.
//!
//! Source: ISO 10303-42, 4.4.

use super::entity::{Entity, Fault, Fields};
use super::geometry::Geometry;
use super::locate;
use super::part21::Value;
use super::spline;
use super::units::Units;
use crate::brep::{self, CurveGeometry, Frame, Similarity, SurfaceGeometry};
use crate::spline::BSpline;
use glam::{DAffine3, DMat3, DVec2, DVec4};
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
                "PCURVE" | "BOUNDED_PCURVE" | "CURVE_REPLICA" | "OFFSET_CURVE_3D" => self.derived_curve(entity),
                kind if spline::is_curve(kind) => self.bspline_curve(entity),
                _ => Err(Fault::Unsupported { id, kind: entity.name() }),
            }
        })
    }

    /// A curve that is defined by another one.
    fn derived_curve(&self, entity: Entity<'_>) -> Result<CurveGeometry, Fault> {
        let id = entity.id();
        if let Ok(fields) = entity.fields("CURVE_REPLICA", 1) {
            let parent = self.curve(fields.reference(0)?)?;
            let copy = Similarity::new(self.transform(fields.reference(1)?)?).curve(parent);
            return copy.ok_or(Fault::Value { id, what: "the copy has a coordinate that is not finite" });
        }
        let (curve, error) = if let Ok(fields) = entity.fields("OFFSET_CURVE_3D", 1) {
            let basis = self.curve(fields.reference(0)?)?;
            let (distance, reference) = (fields.real(1)? * self.units.length, self.direction(fields.reference(3)?)?);
            let offset = brep::offset_curve(&basis, distance, reference, self.units.tolerance);
            offset.map_err(|what| Fault::Value { id, what })?
        } else {
            self.curve_on_surface(entity)?
        };
        if error > self.units.tolerance {
            self.ledger.note("curve approximated", id, format!("to {error:.1e} mm"));
        }
        Ok(curve)
    }

    /// PCURVE('',surface,#r) with #r = DEFINITIONAL_REPRESENTATION('',(curve in (u, v)),context).
    fn curve_on_surface(&self, entity: Entity<'_>) -> Result<(CurveGeometry, f64), Fault> {
        let id = entity.id();
        let fields = entity.fields("PCURVE", 1)?;
        let surface = self.surface(fields.reference(0)?)?.surface;
        let representation = self.entity(fields.reference(1)?)?;
        let items = representation.fields("REPRESENTATION", 0).unwrap_or_else(|_| representation.all());
        let curve = items.list(1)?.find_map(Value::reference).ok_or_else(|| representation.not("a curve in (u, v)"))?;
        // coordinates there are parameters, not lengths
        let flat = Units { length: 1.0, ..self.units.clone() };
        let curve = Geometry { units: &flat, ..*self }.curve(curve)?;
        if let SurfaceGeometry::Plane { frame } = surface {
            let axes = DMat3::from_cols(frame.x, frame.y, frame.z) * self.units.length;
            let copy = Similarity::new(DAffine3::from_mat3_translation(axes, frame.origin)).curve(curve);
            let copy = copy.ok_or(Fault::Value { id, what: "the curve has a coordinate that is not finite" })?;
            return Ok((copy, 0.0));
        }
        let [su, sv] = self.parameter_units(&surface);
        let ends = |curve: &CurveGeometry| match curve {
            CurveGeometry::Trimmed { start, end, .. } => Some((*start, *end)),
            CurveGeometry::BSpline(spline) => Some(spline.domain()),
            CurveGeometry::Circle { .. } | CurveGeometry::Ellipse { .. } => Some((0.0, TAU)),
            _ => None,
        };
        let parts = if let CurveGeometry::Composite(parts) = curve { parts } else { vec![curve] };
        let (mut curves, mut worst) = (Vec::new(), 0f64);
        for part in parts {
            let range = ends(&part).ok_or(Fault::Value { id, what: "its curve in (u, v) has no ends" })?;
            let knots = match &part {
                CurveGeometry::BSpline(spline) => spline.knots().to_vec(),
                _ => (1..4).map(|i| range.0 + (range.1 - range.0) * f64::from(i) * 0.25).collect(),
            };
            let uv = |t: f64| locate::point(&part, t).map_or(DVec2::NAN, |p| DVec2::new(p.x * su, p.y * sv));
            let fit = brep::curve_on_surface(&surface, &uv, &knots, range, self.units.tolerance);
            let (curve, error) = fit.map_err(|what| Fault::Value { id, what })?;
            worst = worst.max(error);
            curves.push(curve);
        }
        let alone = curves.len() == 1;
        let curve = if alone { curves.pop() } else { Some(CurveGeometry::Composite(curves)) };
        Ok((curve.ok_or_else(|| entity.not("a curve on a surface"))?, worst))
    }

    /// Radians or millimetres in one unit of each parameter of a surface, as the file counts them.
    pub fn parameter_units(&self, surface: &SurfaceGeometry) -> [f64; 2] {
        fn profile(curve: &CurveGeometry, angle: f64) -> f64 {
            match curve {
                CurveGeometry::Trimmed { basis, .. } => profile(basis, angle),
                CurveGeometry::Circle { .. } | CurveGeometry::Ellipse { .. } => angle,
                _ => 1.0,
            }
        }
        let (length, angle) = (self.units.length, self.units.angle);
        match surface {
            SurfaceGeometry::Plane { .. } => [length; 2],
            SurfaceGeometry::Cylinder { .. } | SurfaceGeometry::Cone { .. } => [angle, length],
            SurfaceGeometry::Sphere { .. } | SurfaceGeometry::Torus { .. } => [angle; 2],
            SurfaceGeometry::Revolution { profile: p, .. } => [angle, profile(p, angle)],
            SurfaceGeometry::Extrusion { profile: p, .. } => [profile(p, angle), 1.0],
            SurfaceGeometry::BSpline(_) => [1.0; 2],
            SurfaceGeometry::Window { basis, .. } => self.parameter_units(basis),
        }
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
        let length = |index: usize| Ok(fields.radius(first + index)? * self.units.length);
        let a = length(0)?;
        let b = if matches!(kind, "ELLIPSE" | "HYPERBOLA") { length(1)? } else { a };
        // the same points with lengths above 0: each axis follows the sign of its length
        let frame =
            Frame { x: frame.x * a.signum(), y: frame.y * b.signum(), z: frame.z * (a.signum() * b.signum()), ..frame };
        let (a, b) = (a.abs(), b.abs());
        Ok(match kind {
            "CIRCLE" => CurveGeometry::Circle { frame, radius: a },
            "ELLIPSE" => CurveGeometry::Ellipse { frame, semi_x: a, semi_y: b },
            "HYPERBOLA" => CurveGeometry::Hyperbola { frame, semi_x: a, semi_y: b },
            _ => CurveGeometry::Parabola { frame, focal: a },
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
            // its parameters are not used elsewhere; the ends of the edge select the part
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

const KINDS: [&str; 19] = [
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
    "PCURVE",
    "BOUNDED_PCURVE",
    "CURVE_REPLICA",
    "OFFSET_CURVE_3D",
];

/// Number of the curve in space of a SURFACE_CURVE or one of its subtypes.
fn space_curve(entity: Entity<'_>) -> Result<u32, Fault> {
    let names = ["SURFACE_CURVE", "SEAM_CURVE", "INTERSECTION_CURVE", "BOUNDED_SURFACE_CURVE"];
    let fields = || names.iter().filter_map(|n| entity.fields(n, 1).ok());
    // without a curve in space, the first one in (u, v)
    let curve = fields().find_map(|f| f.optional(0));
    let curve = curve.or_else(|| fields().find_map(|f| f.list(1).ok()?.find_map(Value::reference)));
    curve.ok_or_else(|| entity.not("a curve on a surface with a curve in space"))
}

/// The part of `basis` that runs from parameter `first` to `last`.
pub(super) fn trim(basis: CurveGeometry, first: f64, last: f64, sense: bool) -> Option<CurveGeometry> {
    if let CurveGeometry::BSpline(spline) = &basis {
        let (a, b) = spline.domain();
        let (first, last) = (first.clamp(a, b), last.clamp(a, b));
        let closed = (spline.point(a) - spline.point(b)).length() <= 1e-9 * (1.0 + spline.point(a).length());
        // ends at one point, as far as points are located on the curve, are all of a closed curve
        let around = (first - last).abs() <= 1e-9 * (b - a);
        if !closed || (!around && sense == (first < last)) {
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
    // a turn and a rounding error is an empty piece
    let turn = (sign * (last - first)).rem_euclid(TAU);
    let span = if turn < 1e-12 || TAU - turn < 1e-12 { TAU } else { turn };
    locate::piece(basis, first, first + sign * span)
}
