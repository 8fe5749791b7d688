//! Tubes: the solid that a disk or a ring sweeps along a curve.
//!
//! ```text
//!   SWEPT_DISK_SOLID('',directrix,radius,inner radius or $,start or $,end or $)
//!
//!     line      ─▶ cylinder   ╭─ arc ─╮
//!     arc       ─▶ torus      │       line    pieces share the circles between them; the ends are disks or rings
//!     spline    ─▶ spline, with its error noted
//! ```
//!
//! The directrix must not turn at a corner, where a disk sweeps no surface of this kind.
//!
//! Source: ISO 10303-42, 6.4 (swept disk solid).

use super::curve::trim;
use super::entity::{Entity, Fault, Fields};
use super::face::EdgeTable;
use super::geometry::{Geometry, frame};
use super::locate;
use super::part21::Value;
use crate::brep::{Boundary, CurveGeometry, Edge, FaceGeometry, SurfaceGeometry};
use crate::construct;
use crate::spline::Control;
use glam::DVec3;

/// A smooth piece of the directrix, and where and how it begins and ends.
struct Piece {
    curve: CurveGeometry,
    ends: [(DVec3, DVec3); 2],
}

/// Cosine of the angle between tangents that are the same: 0.1 mrad.
const SMOOTH: f64 = 1.0 - 5e-9;

impl Geometry<'_> {
    /// The faces of a SWEPT_DISK_SOLID.
    pub fn swept_disk(&self, entity: Entity<'_>, table: &mut EdgeTable) -> Result<Vec<FaceGeometry>, Fault> {
        let id = entity.id();
        let fault = |what| Fault::Value { id, what };
        let fields = entity.fields("SWEPT_DISK_SOLID", 1)?;
        let outer = fields.length(1)? * self.units.length;
        let inner = match fields.value(2) {
            Some(Value::Omitted) | None => None,
            Some(_) => Some(fields.length(2)? * self.units.length),
        };
        if inner.is_some_and(|inner| inner >= outer) {
            return Err(fault("the inner radius is not below the outer one"));
        }
        let mut pieces = Vec::new();
        self.pieces(id, self.directrix(fields)?, &mut pieces)?;
        let (Some(first), Some(last)) = (pieces.first(), pieces.last()) else {
            return Err(fault("the directrix has no length"));
        };
        let meet =
            |a: (DVec3, DVec3), b: (DVec3, DVec3)| a.0.distance(b.0) <= self.units.tolerance.max(1e-9 * a.0.length());
        let smooth = |a: (DVec3, DVec3), b: (DVec3, DVec3)| a.1.dot(b.1) >= SMOOTH;
        let closed = meet(last.ends[1], first.ends[0]);
        let next = pieces.iter().skip(1).chain(Some(first).filter(|_| closed));
        for (a, b) in pieces.iter().zip(next) {
            if !meet(a.ends[1], b.ends[0]) {
                return Err(fault("the pieces of the directrix do not meet"));
            }
            if !smooth(a.ends[1], b.ends[0]) {
                return Err(fault("the directrix has a corner"));
            }
        }
        let mut joints: Vec<(DVec3, DVec3)> = pieces.iter().map(|p| p.ends[0]).collect();
        joints.extend(Some(last.ends[1]).filter(|_| !closed));
        let mut faces = Vec::new();
        let mut rims: [Vec<(usize, bool)>; 2] = Default::default();
        for (radius, out) in [(Some(outer), true), (inner, false)] {
            let Some(radius) = radius else { continue };
            let circles: Vec<usize> = joints.iter().map(|j| circle(id, *j, radius, table)).collect();
            for (i, piece) in pieces.iter().enumerate() {
                self.ledger.spend(id, 4)?;
                let surface = self.tube(id, piece, radius)?;
                let rim = |circle: usize, forward| Boundary::Edges(vec![(circle, forward)]);
                let whole = matches!(surface, SurfaceGeometry::BSpline(_)) || (closed && pieces.len() == 1);
                let ends = vec![rim(circles[i], true), rim(circles[(i + 1) % circles.len()], false)];
                let bounds = if whole { Vec::new() } else { ends };
                faces.push(FaceGeometry { id, surface, bounds, same_sense: out, ambiguous: false });
            }
            for (rim, circle) in rims.iter_mut().zip([circles[0], circles[circles.len() - 1]]) {
                rim.push((circle, out));
            }
        }
        if !closed {
            for (rim, (joint, same_sense)) in rims.into_iter().zip([(joints[0], false), (last.ends[1], true)]) {
                let surface = SurfaceGeometry::Plane { frame: frame(joint.0, joint.1, None) };
                let bounds = rim.into_iter().map(|circle| Boundary::Edges(vec![circle])).collect();
                faces.push(FaceGeometry { id, surface, bounds, same_sense, ambiguous: false });
            }
        }
        Ok(faces)
    }

    /// The part of the directrix between the parameters that are given.
    fn directrix(&self, fields: Fields<'_>) -> Result<CurveGeometry, Fault> {
        let id = fields.id;
        let curve = self.curve(fields.reference(0)?)?;
        let given = |index: usize| fields.value(index).and_then(Value::number).filter(|x| x.is_finite());
        let (first, last) = (given(3), given(4));
        if let CurveGeometry::Composite(parts) = &curve {
            let whole = first.is_none_or(|t| t == 0.0) && last.is_none_or(|t| t == parts.len() as f64);
            let kind = "a part of a composite directrix".to_owned();
            return if whole { Ok(curve) } else { Err(Fault::Unsupported { id, kind }) };
        }
        let (Some(first), Some(last)) = (first, last) else { return Ok(curve) };
        let basis = match curve {
            CurveGeometry::Trimmed { basis, .. } => *basis,
            curve => curve,
        };
        let angular = matches!(basis, CurveGeometry::Circle { .. } | CurveGeometry::Ellipse { .. });
        let unit = if angular { self.units.angle } else { 1.0 };
        trim(basis, first * unit, last * unit, first < last)
            .ok_or(Fault::Value { id, what: "the directrix has no length" })
    }

    /// Takes a directrix apart into lines, arcs and splines.
    fn pieces(&self, id: u32, curve: CurveGeometry, out: &mut Vec<Piece>) -> Result<(), Fault> {
        use CurveGeometry as C;
        let line = |p: DVec3, q: DVec3| {
            let way = (q - p).try_normalize()?;
            Some(Piece { curve: C::Line { origin: p, direction: way }, ends: [(p, way), (q, way)] })
        };
        let unsupported = |what: &str| Fault::Unsupported { id, kind: format!("a disk swept along {what}") };
        match curve {
            C::Composite(parts) => parts.into_iter().try_for_each(|part| self.pieces(id, part, out))?,
            C::Trimmed { basis, start, end, forward: false } => {
                let turned = locate::piece(*basis, end, start).ok_or(unsupported("a composite curve"))?;
                self.pieces(id, turned, out)?;
            }
            C::Trimmed { basis, start, end, .. } => match *basis {
                C::Line { origin, direction } => out.extend(line(origin + direction * start, origin + direction * end)),
                C::Circle { frame, radius } => {
                    let at = |t: f64| {
                        let (sin, cos) = t.sin_cos();
                        (frame.origin + (frame.x * cos + frame.y * sin) * radius, frame.y * cos - frame.x * sin)
                    };
                    out.push(Piece { curve: C::Circle { frame, radius }, ends: [at(start), at(end)] });
                }
                C::BSpline(spline) if spline.domain() == (start, end) => self.pieces(id, C::BSpline(spline), out)?,
                C::BSpline(_) => return Err(unsupported("a part of a spline")),
                _ => return Err(unsupported("such a curve")),
            },
            C::Circle { frame, radius } => {
                let start = (frame.origin + frame.x * radius, frame.y);
                out.push(Piece { curve: C::Circle { frame, radius }, ends: [start, start] });
            }
            C::BSpline(spline) if spline.degree() == 1 => {
                let points: Vec<DVec3> = spline.points().iter().map(|p| p.point()).collect();
                out.extend(points.windows(2).filter_map(|pair| line(pair[0], pair[1])));
            }
            C::BSpline(spline) => {
                let (a, b) = spline.domain();
                let points: Vec<DVec3> = spline.points().iter().map(|p| p.point()).collect();
                let apart = |p: DVec3, q: DVec3| (q - p).try_normalize();
                let begin = points.iter().skip(1).find_map(|q| apart(points[0], *q));
                let end = points.iter().rev().skip(1).find_map(|p| apart(*p, points[points.len() - 1]));
                let (Some(begin), Some(end)) = (begin, end) else { return Ok(()) };
                let ends = [(spline.point(a), begin), (spline.point(b), end)];
                out.push(Piece { curve: C::BSpline(spline), ends });
            }
            C::Line { .. } => return Err(Fault::Value { id, what: "the directrix has no ends" }),
            _ => return Err(unsupported("such a curve")),
        }
        Ok(())
    }

    /// The surface at `radius` around a piece; its normal points away from the piece.
    fn tube(&self, id: u32, piece: &Piece, radius: f64) -> Result<SurfaceGeometry, Fault> {
        Ok(match &piece.curve {
            CurveGeometry::Circle { frame, radius: major } => {
                if *major <= radius {
                    return Err(Fault::Value { id, what: "the tube folds: it is as wide as its arc" });
                }
                SurfaceGeometry::Torus { frame: *frame, major: *major, minor: radius }
            }
            CurveGeometry::BSpline(path) => {
                let told = |_| Fault::Value { id, what: "the tube folds, or its path is not smooth" };
                let built = construct::tube(path, radius, self.units.tolerance).map_err(told)?;
                if built.deviation > self.units.tolerance {
                    self.ledger.note("surface approximated", id, format!("to {:.1e} mm", built.deviation));
                }
                SurfaceGeometry::BSpline(built.surface)
            }
            _ => SurfaceGeometry::Cylinder { frame: frame(piece.ends[0].0, piece.ends[0].1, None), radius },
        })
    }
}

/// A circle about a point, to the right about a direction.
fn circle(id: u32, (centre, z): (DVec3, DVec3), radius: f64, table: &mut EdgeTable) -> usize {
    let frame = frame(centre, z, None);
    let start = centre + frame.x * radius;
    table.edges.push(Edge { id, curve: CurveGeometry::Circle { frame, radius }, start, end: start, same_sense: true });
    table.edges.len() - 1
}
