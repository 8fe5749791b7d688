//! Solids that a plane area sweeps, as faces with shared edges.
//!
//! ```text
//!   EXTRUDED_AREA_SOLID('',area,direction,depth)     EXTRUDED_FACE_SOLID('',face,direction,depth)
//!   REVOLVED_AREA_SOLID('',area,axis,angle)          REVOLVED_FACE_SOLID('',face,axis,angle)
//!       area: CURVE_BOUNDED_SURFACE, face: FACE_SURFACE, both of a plane
//!
//!        ┌─ last ──┐     the area moved, unless a whole turn brings it back
//!        rail   rail     where a vertex goes: a line, an arc; nothing on the axis
//!        └─ first ─┘     the area, and a side for each of its edges
//! ```
//!
//! A line across the axis of a turn draws a plane. An edge of several straight pieces (a polyline) sweeps a side for each. SWEPT_DISK_SOLID: see `disk`.
//!
//! Source: ISO 10303-42, 6.4 (solid model).

use super::entity::{Entity, Fault};
use super::face::EdgeTable;
use super::geometry::Geometry;
use super::replica::Similarity;
use crate::brep::{Boundary, CurveGeometry, Edge, FaceGeometry, Frame, SurfaceGeometry};
use crate::spline::Control;
use glam::{DAffine3, DMat3, DVec3};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Solids that sweep an area, a face or a disk.
pub(super) const SWEPT: [&str; 5] =
    ["EXTRUDED_AREA_SOLID", "EXTRUDED_FACE_SOLID", "REVOLVED_AREA_SOLID", "REVOLVED_FACE_SOLID", "SWEPT_DISK_SOLID"];

/// How the area moves.
#[derive(Clone, Copy)]
enum Motion {
    Along(DVec3),
    /// By an angle above 0.
    Around {
        origin: DVec3,
        axis: DVec3,
        angle: f64,
    },
}

impl Motion {
    /// Where the area ends; `None` when that is where it began.
    fn end(self) -> Option<DAffine3> {
        match self {
            Self::Along(way) => Some(DAffine3::from_translation(way)),
            Self::Around { angle, .. } if angle >= TAU => None,
            Self::Around { origin, axis, angle } => {
                let turn = DMat3::from_axis_angle(axis, angle);
                Some(DAffine3::from_mat3_translation(turn, origin - turn * origin))
            }
        }
    }

    /// The direction in which a point sets out; not of unit length, and 0 on the axis.
    fn way(self, p: DVec3) -> DVec3 {
        match self {
            Self::Along(way) => way,
            Self::Around { origin, axis, .. } => axis.cross(p - origin),
        }
    }

    /// What a point draws; `None` where it stays.
    fn rail(self, id: u32, p: DVec3, still: f64) -> Option<Edge> {
        match self {
            Self::Along(way) => {
                let curve = CurveGeometry::Line { origin: p, direction: way };
                Some(Edge { id, curve, start: p, end: p + way, same_sense: true })
            }
            Self::Around { origin, axis, .. } => {
                let out = (p - origin).reject_from_normalized(axis);
                let radius = out.length();
                if radius <= still {
                    return None;
                }
                let circle = Frame { origin: p - out, x: out / radius, y: axis.cross(out / radius), z: axis };
                let end = self.end().map_or(p, |end| end.transform_point3(p));
                let curve = CurveGeometry::Circle { frame: circle, radius };
                Some(Edge { id, curve, start: p, end, same_sense: true })
            }
        }
    }

    /// The plane that a line across the axis draws, with the normal of [`Motion::side`].
    fn flat(self, curve: &CurveGeometry, from: DVec3, to: DVec3) -> Option<SurfaceGeometry> {
        let Self::Around { origin, axis, .. } = self else { return None };
        let way = (to - from).try_normalize().filter(|_| is_straight(curve))?;
        if way.dot(axis).abs() > 1e-12 {
            return None;
        }
        let middle = 0.5 * (from + to) - origin;
        let out = middle.reject_from_normalized(axis).try_normalize()?;
        let z = -axis * way.dot(out).signum();
        let frame = Frame { origin: origin + axis * middle.dot(axis), x: out, y: z.cross(out), z };
        Some(SurfaceGeometry::Plane { frame })
    }

    /// What a curve draws.
    fn side(self, profile: CurveGeometry) -> SurfaceGeometry {
        let profile = Box::new(profile);
        match self {
            Self::Along(way) => SurfaceGeometry::Extrusion { profile, direction: way.normalize() },
            Self::Around { origin, axis, .. } => SurfaceGeometry::Revolution { profile, origin, axis },
        }
    }
}

impl Geometry<'_> {
    /// The faces of one of [`SWEPT`].
    pub fn swept(&self, entity: Entity<'_>, table: &mut EdgeTable) -> Result<Vec<FaceGeometry>, Fault> {
        let id = entity.id();
        let Some(kind) = SWEPT[..4].iter().copied().find(|k| entity.is(k)) else {
            return self.swept_disk(entity, table);
        };
        let fields = entity.fields(kind, 1)?;
        let area = self.entity(fields.reference(0)?)?;
        let area = if area.is("CURVE_BOUNDED_SURFACE") {
            self.bounded_surface(area, table)?
        } else {
            self.face(area.id(), table)?
        };
        let motion = if kind.starts_with("EXTRUDED") {
            let depth = fields.real(2)? * self.units.length;
            if depth == 0.0 {
                return Err(Fault::Value { id, what: "the depth is 0" });
            }
            Motion::Along(self.direction(fields.reference(1)?)? * depth)
        } else {
            let (origin, axis) = self.axis(fields.reference(1)?)?;
            let angle = fields.real(2)? * self.units.angle;
            if angle == 0.0 {
                return Err(Fault::Value { id, what: "the angle is 0" });
            }
            // a whole turn as degrees of a rounded factor have it
            let whole = angle.abs() > TAU * (1.0 - 1e-9);
            let angle = if whole { TAU.copysign(angle) } else { angle };
            Motion::Around { origin, axis: axis * angle.signum(), angle: angle.abs() }
        };
        self.sweep(id, area, motion, table)
    }

    fn sweep(
        &self,
        id: u32,
        area: FaceGeometry,
        motion: Motion,
        table: &mut EdgeTable,
    ) -> Result<Vec<FaceGeometry>, Fault> {
        let SurfaceGeometry::Plane { frame: plane } = area.surface else {
            return Err(Fault::Value { id, what: "what is swept is not plane" });
        };
        let fault = |what| Fault::Value { id, what };
        let bounds = area.bounds.iter().map(|bound| match bound {
            Boundary::Edges(uses) => Ok(straightened(uses, table)),
            Boundary::Vertex(_) | Boundary::Natural => Err(fault("what is swept has no edges")),
        });
        let bounds = bounds.collect::<Result<Vec<_>, _>>()?;
        let uses = || bounds.iter().flatten();
        let start = uses().map(|(edge, _)| table.edges[*edge].start);
        // the way of the whole area: all of it lies on one side of an axis
        let heading: DVec3 = start.map(|p| motion.way(p)).sum();
        let up = heading.dot(plane.z);
        if uses().next().is_none() || up.abs() <= 1e-9 * heading.length() {
            return Err(fault("what is swept moves within its own plane"));
        }
        let ahead = up > 0.0;
        if let Motion::Around { .. } = motion {
            let across = |p: DVec3| motion.way(p).dot(plane.z) * up.signum();
            if up.abs() < (1.0 - 1e-6) * heading.length() {
                return Err(fault("the axis does not lie in the plane of what turns"));
            }
            if uses().any(|(edge, _)| across(table.edges[*edge].start) < -self.units.tolerance) {
                return Err(fault("the axis crosses what turns"));
            }
        }
        let end = motion.end();
        let mut swept =
            Sweep { id, motion, end: end.map(Similarity::new), table, rails: HashMap::new(), lasts: HashMap::new() };
        let mut faces = Vec::new();
        let mut last = Vec::new();
        for bound in &bounds {
            let mut moved = Vec::new();
            for &(edge, forward) in bound {
                self.ledger.spend(id, 4)?;
                faces.extend(
                    swept.side(edge, forward == ahead, self.units.tolerance).ok_or(fault("a side is not finite"))?,
                );
                moved.push((swept.last(edge).ok_or(fault("a side is not finite"))?, forward));
            }
            last.push(Boundary::Edges(moved));
        }
        if let Some(end) = end {
            let surface = SurfaceGeometry::Plane { frame: plane };
            let (moved, _) = Similarity::new(end).surface(surface.clone()).ok_or(fault("a side is not finite"))?;
            let first = bounds.into_iter().map(Boundary::Edges).collect();
            faces.push(FaceGeometry { id, surface, bounds: first, same_sense: !ahead, doubtful: false });
            faces.push(FaceGeometry { id, surface: moved, bounds: last, same_sense: ahead, doubtful: false });
        }
        Ok(faces)
    }
}

struct Sweep<'t> {
    id: u32,
    motion: Motion,
    end: Option<Similarity>,
    table: &'t mut EdgeTable,
    /// Edges that vertices draw, by the bits of the vertex.
    rails: HashMap<[u64; 3], Option<usize>>,
    /// The edge at the end, by that at the beginning.
    lasts: HashMap<usize, usize>,
}

impl Sweep<'_> {
    fn add(&mut self, edge: Edge) -> usize {
        self.table.edges.push(edge);
        self.table.edges.len() - 1
    }

    fn rail(&mut self, p: DVec3, still: f64) -> Option<usize> {
        let key = p.to_array().map(|x| (x + 0.0).to_bits());
        if let Some(known) = self.rails.get(&key) {
            return *known;
        }
        let rail = self.motion.rail(self.id, p, still).map(|edge| self.add(edge));
        self.rails.insert(key, rail);
        rail
    }

    /// The edge that an edge of the area becomes; itself after a whole turn. `None` if it is not finite.
    fn last(&mut self, edge: usize) -> Option<usize> {
        let Some(end) = self.end else { return Some(edge) };
        if let Some(known) = self.lasts.get(&edge) {
            return Some(*known);
        }
        let Edge { curve, start, end: stop, same_sense, .. } = self.table.edges[edge].clone();
        let (curve, [start, stop]) = (end.curve(curve)?, [start, stop].map(|p| end.point(p)));
        let last = self.add(Edge { id: self.id, curve, start, end: stop, same_sense });
        self.lasts.insert(edge, last);
        Some(last)
    }

    /// The side that an edge draws; `ahead`: seen against the way of the area, the edge runs with the area on its left.
    /// No face for an edge on the axis, `None` for one that is not finite.
    fn side(&mut self, edge: usize, ahead: bool, still: f64) -> Option<Option<FaceGeometry>> {
        let Edge { curve, start, end, same_sense, .. } = self.table.edges[edge].clone();
        // in the direction of the curve
        let (from, to) = if same_sense { (start, end) } else { (end, start) };
        let rails = [self.rail(from, still), self.rail(to, still)];
        let flat = self.motion.flat(&curve, from, to);
        let surface = flat.unwrap_or_else(|| self.motion.side(curve.clone()));
        let around = matches!(self.motion, Motion::Around { .. });
        // a line on the axis
        if rails == [None, None] && is_straight(&curve) {
            return Some(None);
        }
        let last = self.last(edge)?;
        let whole = self.end.is_none();
        let (along, back) = ((edge, same_sense), (last, !same_sense));
        let bounds = match rails {
            // a whole turn: rims, which a closed profile has none of
            [a, b] if whole && a == b && a.is_some() => Vec::new(),
            [a, b] if whole => {
                let rim = |edge: usize, forward| Boundary::Edges(vec![(edge, forward)]);
                let rims = [a.map(|a| rim(a, true)), b.map(|b| rim(b, false))];
                // a plane has no pole
                let tips = [from, to].map(|p| Some(Boundary::Vertex(p)).filter(|_| !is_plane(&surface)));
                rims.into_iter().zip(tips).filter_map(|(rim, tip)| rim.or(tip)).collect()
            }
            // u along the curve, v along the way
            [a, b] if !around => {
                let up = b.map(|b| (b, true));
                let down = a.map(|a| (a, false));
                vec![Boundary::Edges([Some(along), up, Some(back), down].into_iter().flatten().collect())]
            }
            // u along the way, v along the curve
            [a, b] => {
                let (first, second) = (a.map(|a| (a, true)), b.map(|b| (b, false)));
                let (up, down) = ((last, same_sense), (edge, !same_sense));
                vec![Boundary::Edges([first, Some(up), second, Some(down)].into_iter().flatten().collect())]
            }
        };
        // u and v change places between the two surfaces
        let outward = (ahead == same_sense) != around;
        Some(Some(FaceGeometry { id: self.id, surface, bounds, same_sense: outward, doubtful: false }))
    }
}

fn is_plane(surface: &SurfaceGeometry) -> bool {
    matches!(surface, SurfaceGeometry::Plane { .. })
}

fn is_straight(curve: &CurveGeometry) -> bool {
    match curve {
        CurveGeometry::Trimmed { basis, .. } => is_straight(basis),
        CurveGeometry::BSpline(spline) => spline.degree() == 1 && spline.points().len() == 2,
        curve => matches!(curve, CurveGeometry::Line { .. }),
    }
}

/// Edges with those of several straight pieces taken apart; new edges are added to the table.
fn straightened(uses: &[(usize, bool)], table: &mut EdgeTable) -> Vec<(usize, bool)> {
    let mut all = Vec::new();
    for &(index, forward) in uses {
        let edge = &table.edges[index];
        let points = match &edge.curve {
            CurveGeometry::BSpline(spline) if spline.degree() == 1 && spline.points().len() > 2 => {
                spline.points().iter().map(|p| p.point()).collect::<Vec<DVec3>>()
            }
            _ => {
                all.push((index, forward));
                continue;
            }
        };
        let (id, same) = (edge.id, edge.same_sense == forward);
        let mut pieces = table.chain(id, &points);
        if !same {
            pieces.reverse();
        }
        all.extend(pieces.into_iter().map(|piece| (piece, same)));
    }
    all
}
