//! Solids that a plane area sweeps, as faces with shared edges.
//!
//! ```text
//!        ┌─ last ──┐     the area moved, unless a whole turn brings it back
//!        rail   rail     where a vertex goes: a line, an arc; nothing on the axis
//!        └─ first ─┘     the area, and a side for each of its edges
//! ```
//!
//! A line across the axis of a turn draws a plane. An edge of several straight pieces (a polyline) sweeps a side for each.

use super::edge::EdgeCurve;
use super::{Boundary, CurveGeometry, Edge, FaceGeometry, Frame, Similarity, SurfaceGeometry};
use crate::spline::arc::assemble;
use crate::spline::{BSpline, Control};
use glam::{DAffine3, DMat3, DVec3};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// How the area moves.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub enum Motion {
    /// By a vector, in millimetres.
    Along(DVec3),
    /// By an angle above 0 about a unit axis, in radians; `TAU` or more is a whole turn.
    Around { origin: DVec3, axis: DVec3, angle: f64 },
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

    /// The edge that a point draws; `None` where the point stays.
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

    /// The surface that a curve draws.
    fn side(self, profile: CurveGeometry) -> SurfaceGeometry {
        let profile = Box::new(profile);
        match self {
            Self::Along(way) => SurfaceGeometry::Extrusion { profile, direction: way.normalize() },
            Self::Around { origin, axis, .. } => SurfaceGeometry::Revolution { profile, origin, axis },
        }
    }
}

/// The faces of the solid that a plane `area` draws; its edges are among `edges`, and new ones are added there. `still`:
/// points as near to the axis stay where they are, in millimetres.
///
/// # Errors
/// Why there is no such solid.
pub fn sweep(
    area: FaceGeometry,
    motion: Motion,
    edges: &mut Vec<Edge>,
    still: f64,
) -> Result<Vec<FaceGeometry>, &'static str> {
    let id = area.id;
    let SurfaceGeometry::Plane { frame: plane } = area.surface else { return Err("what is swept is not plane") };
    let bounds = area.bounds.iter().map(|bound| match bound {
        Boundary::Edges(uses) => Ok(straightened(uses, edges)),
        Boundary::Vertex(_) | Boundary::Natural => Err("what is swept has no edges"),
    });
    let bounds = bounds.collect::<Result<Vec<_>, _>>()?;
    let outline: Vec<DVec3> = bounds.iter().flatten().flat_map(|(edge, _)| samples(&edges[*edge], still)).collect();
    let ways = || outline.iter().map(|p| motion.way(*p));
    if let Motion::Around { .. } = motion {
        let (along, whole) = ways().fold((0.0, 0.0), |(a, w), v| (a + v.dot(plane.z).abs(), w + v.length()));
        if along < (1.0 - 1e-6) * whole {
            return Err("the axis does not lie in the plane of what turns");
        }
        if ways().any(|v| v.dot(plane.z) > still) && ways().any(|v| v.dot(plane.z) < -still) {
            return Err("the axis crosses what turns");
        }
    }
    // the way of the whole area: all of it lies on one side of an axis, on which its vertices may lie
    let heading: DVec3 = ways().sum();
    let up = heading.dot(plane.z);
    if outline.is_empty() || up.abs() <= 1e-9 * heading.length() {
        return Err("what is swept moves within its own plane");
    }
    let ahead = up > 0.0;
    let end = motion.end();
    let far = "a side is not finite";
    let (rails, lasts) = (HashMap::new(), HashMap::new());
    let mut swept = Sweep { id, motion, still, end: end.map(Similarity::new), edges, rails, lasts };
    let mut faces = Vec::new();
    let mut last = Vec::new();
    for bound in &bounds {
        let mut moved = Vec::new();
        for &(edge, forward) in bound {
            faces.extend(swept.side(edge, forward == ahead).ok_or(far)?);
            moved.push((swept.last(edge).ok_or(far)?, forward));
        }
        last.push(Boundary::Edges(moved));
    }
    if let Some(end) = end {
        let surface = SurfaceGeometry::Plane { frame: plane };
        let (moved, _) = Similarity::new(end).surface(surface.clone()).ok_or(far)?;
        let first = bounds.into_iter().map(Boundary::Edges).collect();
        faces.push(FaceGeometry { id, surface, bounds: first, same_sense: !ahead, ambiguous: false });
        faces.push(FaceGeometry { id, surface: moved, bounds: last, same_sense: ahead, ambiguous: false });
    }
    Ok(faces)
}

/// Points of an edge; its start where it is no longer than `still`.
fn samples(edge: &Edge, still: f64) -> Vec<DVec3> {
    const EACH: u32 = 16;
    match EdgeCurve::new(edge, true, still) {
        Ok(Some(curve)) => (0..EACH).map(|k| curve.point(f64::from(k) / f64::from(EACH))).collect(),
        _ => vec![edge.start],
    }
}

struct Sweep<'t> {
    id: u32,
    motion: Motion,
    still: f64,
    end: Option<Similarity>,
    edges: &'t mut Vec<Edge>,
    /// Edges that vertices draw, by the bits of the vertex.
    rails: HashMap<[u64; 3], Option<usize>>,
    /// The edge at the end, by that at the beginning.
    lasts: HashMap<usize, usize>,
}

impl Sweep<'_> {
    fn add(&mut self, edge: Edge) -> usize {
        self.edges.push(edge);
        self.edges.len() - 1
    }

    fn rail(&mut self, p: DVec3) -> Option<usize> {
        let key = p.to_array().map(|x| (x + 0.0).to_bits());
        if let Some(known) = self.rails.get(&key) {
            return *known;
        }
        let rail = self.motion.rail(self.id, p, self.still).map(|edge| self.add(edge));
        self.rails.insert(key, rail);
        rail
    }

    /// The edge that an edge of the area becomes; itself after a whole turn. `None` if it is not finite.
    fn last(&mut self, edge: usize) -> Option<usize> {
        let Some(end) = self.end else { return Some(edge) };
        if let Some(known) = self.lasts.get(&edge) {
            return Some(*known);
        }
        let Edge { curve, start, end: stop, same_sense, .. } = self.edges[edge].clone();
        let (curve, [start, stop]) = (end.curve(curve)?, [start, stop].map(|p| end.point(p)));
        let last = self.add(Edge { id: self.id, curve, start, end: stop, same_sense });
        self.lasts.insert(edge, last);
        Some(last)
    }

    /// The curve that turns. A closed curve is cut to the part from point to point: the rest draws the same surface
    /// inside out.
    fn profile(&self, curve: &CurveGeometry, from: DVec3, to: DVec3) -> CurveGeometry {
        let basis = if let CurveGeometry::Trimmed { basis, .. } = curve { basis } else { curve };
        let closed = matches!(basis, CurveGeometry::Circle { .. } | CurveGeometry::Ellipse { .. });
        if matches!(self.motion, Motion::Around { .. }) && closed && from != to {
            let edge = Edge { id: self.id, curve: curve.clone(), start: from, end: to, same_sense: true };
            let part = EdgeCurve::new(&edge, true, self.still).ok().flatten();
            let spline = part.and_then(|part| {
                let (degree, knots, points) = assemble(&part.curve.beziers(part.t0, part.t1));
                BSpline::new(degree, knots, points).ok()
            });
            return spline.map_or_else(|| curve.clone(), CurveGeometry::BSpline);
        }
        curve.clone()
    }

    /// The side that an edge draws; `ahead`: seen against the way of the area, the edge runs with the area on its left.
    /// No face for an edge on the axis, `None` for one that is not finite.
    fn side(&mut self, edge: usize, ahead: bool) -> Option<Option<FaceGeometry>> {
        let Edge { curve, start, end, same_sense, .. } = self.edges[edge].clone();
        // in the direction of the curve
        let (from, to) = if same_sense { (start, end) } else { (end, start) };
        let rails = [self.rail(from), self.rail(to)];
        let flat = self.motion.flat(&curve, from, to);
        let profile = self.profile(&curve, from, to);
        let surface = flat.unwrap_or_else(|| self.motion.side(profile));
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
        Some(Some(FaceGeometry { id: self.id, surface, bounds, same_sense: outward, ambiguous: false }))
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

/// Edges with those of several straight pieces taken apart; new edges are added to the list.
fn straightened(uses: &[(usize, bool)], edges: &mut Vec<Edge>) -> Vec<(usize, bool)> {
    let mut all = Vec::new();
    for &(index, forward) in uses {
        let edge = &edges[index];
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
        let mut pieces = Edge::chain(id, &points, edges);
        if !same {
            pieces.reverse();
        }
        all.extend(pieces.into_iter().map(|piece| (piece, same)));
    }
    all
}
