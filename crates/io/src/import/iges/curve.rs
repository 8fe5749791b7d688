//! Curves: what the standard calls a curve, as a chain of segments.
//!
//! ```text
//!   100 arc         t = angle from x, counter-clockwise        110 line      t in [0, 1]
//!   104 conic       see `conic`                                112, 126      see `spline`
//!   102 composite   its members in order                       106 polyline  one unit a side
//!   130 offset      C(t) + d V × T(t)
//! ```
//!
//! A segment keeps the parameter of the standard, because surfaces made from curves inherit it.

use super::entity::{Entity, Fault};
use super::fit::fit;
use super::geometry::{Geometry, finite, similarity};
use crate::brep::{CurveGeometry, Edge};
use crate::import::locate;
use crate::spline::{BSpline, Control};
use glam::{DAffine3, DVec2, DVec3, DVec4};
use std::f64::consts::TAU;

/// The part of a curve from `start` to `end`, `start < end`, in millimetres.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Segment {
    /// The entity that it came from.
    pub id: u32,
    /// Never trimmed, never composite.
    pub curve: CurveGeometry,
    /// First parameter.
    pub start: f64,
    /// Last parameter.
    pub end: f64,
}

impl Segment {
    /// The point at `t`.
    pub fn point(&self, t: f64) -> DVec3 {
        locate::point(&self.curve, t).unwrap_or(DVec3::NAN)
    }

    /// First and last point.
    pub fn ends(&self) -> (DVec3, DVec3) {
        (self.point(self.start), self.point(self.end))
    }

    /// Run backwards.
    pub fn reversed(self) -> Self {
        match locate::turned(self.curve.clone()) {
            Some((curve, sum)) => Self { curve, start: sum - self.end, end: sum - self.start, ..self },
            None => self,
        }
    }

    /// `count + 1` points from end to end.
    pub fn samples(&self, count: usize) -> impl Iterator<Item = DVec3> + use<'_> {
        let at = move |i: usize| self.start + (self.end - self.start) * i as f64 / count as f64;
        (0..=count).map(move |i| self.point(at(i)))
    }

    /// As an edge between its ends; one that closes has one vertex.
    pub fn edge(&self) -> Edge {
        let (start, mut end) = self.ends();
        let size = self.samples(8).map(|p| p.distance(start)).fold(0.0, f64::max);
        if start.distance(end) <= 1e-9 * size {
            end = start;
        }
        Edge { id: self.id, curve: self.curve.clone(), start, end, same_sense: true }
    }

    /// As the profile of a surface.
    pub fn trimmed(&self) -> CurveGeometry {
        let basis = Box::new(self.curve.clone());
        CurveGeometry::Trimmed { basis, start: self.start, end: self.end, forward: true }
    }
}

impl<'a> Geometry<'a> {
    /// The segments of the curve `#id`, in order.
    pub fn segments(&self, id: u32, outer: &DAffine3) -> Result<Vec<Segment>, Fault> {
        self.nested(id, |entity| {
            let map = self.placed(entity, outer)?;
            if entity.kind() == 102 {
                let mut all = Vec::new();
                for index in 2..2 + entity.count(1, 1)? {
                    let member = entity.pointer(index)?;
                    // a composite may hold points as anchors of other entities; they are no segments
                    if Entity::find(self.file, member)?.kind() != 116 {
                        all.extend(self.segments(member, &map)?);
                    }
                }
                return if all.is_empty() {
                    Err(Fault::Value { id, what: "a composite without curves" })
                } else {
                    Ok(all)
                };
            }
            let segment = match entity.kind() {
                100 => self.arc(entity, &map),
                104 => self.conic(entity, &map),
                106 => self.polyline(entity, &map),
                110 => self.line(entity, &map),
                112 => self.parametric_curve(entity, &map),
                126 => self.bspline_curve(entity, &map),
                130 => return self.offset_curve(entity, &map),
                _ => Err(entity.unsupported()),
            }?;
            let (a, b) = segment.ends();
            finite(id, a)?;
            finite(id, b)?;
            Ok(vec![segment])
        })
    }

    /// 100: centre, start and end in a plane parallel to xy.
    fn arc(&self, entity: Entity<'a>, map: &DAffine3) -> Result<Segment, Fault> {
        let id = entity.id();
        let at = |i: usize| Ok(DVec2::new(entity.real(i)?, entity.real(i + 1)?));
        let (centre, start, end) = (at(2)?, at(4)?, at(6)?);
        let (from, to) = (start - centre, end - centre);
        let origin = map.transform_point3(centre.extend(entity.real(1)?));
        let placed = self.frame(id, map, origin, (DVec3::Z, Some(DVec3::X)))?;
        // rounding of either end moves the other less than their middle
        let radius = 0.5 * (from.length() + to.length()) * placed.scale;
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(Fault::Value { id, what: "an arc needs a radius above 0" });
        }
        let first = from.to_angle().rem_euclid(TAU);
        let sweep = (to.to_angle() - first).rem_euclid(TAU);
        // ends that coincide, as far as the file's digits tell, are a whole circle
        let whole = start.distance(end) <= 1e-10 * from.length();
        let last = first + if whole { TAU } else { sweep };
        Ok(Segment { id, curve: CurveGeometry::Circle { frame: placed.frame, radius }, start: first, end: last })
    }

    fn line(&self, entity: Entity<'a>, map: &DAffine3) -> Result<Segment, Fault> {
        let (origin, end) = (map.transform_point3(entity.triple(1)?), map.transform_point3(entity.triple(4)?));
        let id = entity.id();
        let direction = end - origin;
        if !(direction.length() > 0.0 && direction.is_finite()) {
            return Err(Fault::Value { id, what: "a line without length" });
        }
        Ok(Segment { id, curve: CurveGeometry::Line { origin, direction }, start: 0.0, end: 1.0 })
    }

    /// 106: points joined by straight lines, whatever the form says of them.
    fn polyline(&self, entity: Entity<'a>, map: &DAffine3) -> Result<Segment, Fault> {
        let id = entity.id();
        let (each, first) = match entity.integer(1)? {
            1 => (2, 4),
            2 => (3, 3),
            3 => (6, 3),
            _ => return Err(Fault::Parameter { id, index: 1, wanted: "1, 2 or 3" }),
        };
        let count = entity.count(2, each)?;
        let numbers = entity.reals(first, count * each)?;
        let height = if each == 2 { entity.real(3)? } else { 0.0 };
        let mut points: Vec<DVec4> = Vec::with_capacity(count + 1);
        for p in numbers.chunks_exact(each) {
            let p = if each == 2 { DVec3::new(p[0], p[1], height) } else { DVec3::new(p[0], p[1], p[2]) };
            points.push(map.transform_point3(p).extend(1.0));
        }
        if entity.entry.form == 63 {
            points.extend(points.first().copied());
        }
        points.dedup();
        let last = points.len().saturating_sub(1) as f64;
        let knots = (0..points.len() + 2).map(|i| (i as f64 - 1.0).clamp(0.0, last)).collect();
        let spline = BSpline::new(1, knots, points).map_err(|source| Fault::Spline { id, source })?;
        Ok(Segment { id, curve: CurveGeometry::BSpline(spline), start: 0.0, end: last })
    }

    /// 130: exact for lines and arcs, else fitted to `1e-10` of its box.
    fn offset_curve(&self, entity: Entity<'a>, map: &DAffine3) -> Result<Vec<Segment>, Fault> {
        let id = entity.id();
        if entity.integer(2)? != 1 {
            return Err(entity.unsupported());
        }
        let mirrored = if map.matrix3.determinant() < 0.0 { -1.0 } else { 1.0 };
        let scale = similarity(&map.matrix3).ok_or(Fault::Value { id, what: "the matrix distorts an offset" })?;
        let distance = entity.real(6)? * scale * mirrored;
        let normal = map.transform_vector3(entity.triple(10)?).try_normalize();
        let normal = normal.ok_or(Fault::Value { id, what: "the offset has no plane" })?;
        let mut out = Vec::new();
        for segment in self.segments(entity.pointer(1)?, map)? {
            self.spend(id, 1)?;
            out.push(offset(segment, normal, distance).ok_or(Fault::Value { id, what: "the offset has no curve" })?);
        }
        // the range is that of the one curve behind it
        let (from, to) = (entity.real(13)?, entity.real(14)?);
        if let [only] = &mut out[..]
            && from < to
        {
            (only.start, only.end) = (from.max(only.start), to.min(only.end));
            if only.start >= only.end {
                return Err(Fault::Value { id, what: "the range of the offset is empty" });
            }
        }
        Ok(out)
    }
}

/// `segment` moved by `distance` along `normal × tangent`.
fn offset(segment: Segment, normal: DVec3, distance: f64) -> Option<Segment> {
    let curve = match &segment.curve {
        CurveGeometry::Line { origin, direction } => {
            let by = normal.cross(direction.try_normalize()?) * distance;
            CurveGeometry::Line { origin: *origin + by, direction: *direction }
        }
        CurveGeometry::Circle { frame, radius } if frame.z.cross(normal).length() <= 1e-9 => {
            let radius = radius - distance * frame.z.dot(normal).signum();
            (radius > 0.0).then_some(CurveGeometry::Circle { frame: *frame, radius })?
        }
        CurveGeometry::BSpline(spline) => {
            let spans = spline.beziers();
            let at = |t: f64| {
                let i = spans.partition_point(|s| s.start <= t).clamp(1, spans.len()) - 1;
                let (s, length) = (&spans[i], spans[i].end - spans[i].start);
                let (p, d) = s.piece.jet((t - s.start) / length);
                let point = p.point();
                let tangent = (d.truncate() - point * d.w).normalize_or_zero();
                point + normal.cross(tangent) * distance
            };
            let inside = spans.iter().map(|s| s.start).filter(|t| *t > segment.start && *t < segment.end);
            let breaks: Vec<f64> = [segment.start].into_iter().chain(inside).chain([segment.end]).collect();
            CurveGeometry::BSpline(fit(at, &breaks)?)
        }
        _ => return None,
    };
    Some(Segment { curve, ..segment })
}
