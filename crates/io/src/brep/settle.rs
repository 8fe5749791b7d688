//! Edges and faces of one body that contradict each other: the majority wins.
//!
//! ```text
//!   vertices  ●────────●  on both faces      the curve misses them: the straight edge between them, or the
//!   its curve    ─────────                   circle through them, is the edge where it lies on both faces
//!
//!   ──▶ face A        both run their edge the same way: one of the two loops is the wrong way round, and
//!   ──▶ face B        on a closed surface that decides which side of it is the face
//! ```
//!
//! An edge is settled once for all its faces, so its faces still agree on it.

use super::support::Support;
use super::{Boundary, CurveGeometry, Edge, FaceGeometry, Frame, SurfaceGeometry};
use crate::spline::arc::sin_cos;
use glam::DVec3;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Share of an edge's length by which vertices may miss its curve, whatever the tolerance: too little to be seen.
const FINE: f64 = 1e-6;

/// A replacement may leave the faces by this share of the distance by which the stated curve misses its vertices.
const BETTER: f64 = 0.1;

/// Cosine of the angle between a line and the way from vertex to vertex, above which both mean the same edge.
const ALONG: f64 = 0.99;

/// How many tolerances vertices may miss a curve by without a note, where no better curve is found.
const REPORTED: f64 = 50.0;

/// Steps along an edge in which its distance from a face is measured.
const STEPS: u32 = 8;

/// Replaces lines and circles that miss their vertices. Marks the faces whose loops run against their neighbours', or
/// whose normal points into a closed body that they enclose ([`FaceGeometry::ambiguous`]). Returns notes on edges, by
/// their numbers; `tolerance` in mm.
pub fn settle(edges: &mut [Edge], faces: &mut [&mut FaceGeometry], closed: bool, tolerance: f64) -> Vec<(u32, String)> {
    let limit = |e: &Edge| tolerance.max(FINE * e.start.distance(e.end));
    let off = |(index, e): (usize, &Edge)| (missed(e) > limit(e)).then_some((index, Vec::new()));
    let mut off: BTreeMap<usize, Vec<usize>> = edges.iter().enumerate().filter_map(off).collect();
    if !off.is_empty() {
        for (at, face) in faces.iter().enumerate() {
            for (edge, _) in uses(face) {
                if let Some(users) = off.get_mut(&edge) {
                    users.push(at);
                }
            }
        }
    }
    let mut notes = Vec::new();
    for (index, users) in off {
        let Some(edge) = edges.get_mut(index) else { continue };
        let (miss, reported) = (missed(&*edge), REPORTED * limit(&*edge));
        let supports = users.iter().filter_map(|at| Support::new(&faces[*at].surface, tolerance).ok());
        let outcome = match better(&*edge, &supports.collect::<Vec<_>>(), (miss, tolerance)) {
            Some(better) => {
                *edge = better;
                ": they and its faces say where it runs"
            }
            None if miss > reported => "",
            None => continue,
        };
        notes.push((edge.id, format!("its curve misses its vertices by {miss:.3e} mm{outcome}")));
    }
    mark_ambiguous(edges, faces, closed, tolerance);
    notes
}

fn uses(face: &FaceGeometry) -> impl Iterator<Item = (usize, bool)> {
    fn edges(bound: &Boundary) -> &[(usize, bool)] {
        match bound {
            Boundary::Edges(list) => list,
            Boundary::Vertex(_) | Boundary::Natural => &[],
        }
    }
    face.bounds.iter().flat_map(edges).copied()
}

/// The curve that a trimmed one runs along.
fn basis(curve: &CurveGeometry) -> &CurveGeometry {
    match curve {
        CurveGeometry::Trimmed { basis: inner, forward: true, .. } => basis(inner),
        other => other,
    }
}

/// Distance in mm of the vertices from the line or circle of their edge; 0 for other curves.
fn missed(edge: &Edge) -> f64 {
    let off = |p: DVec3| match basis(&edge.curve) {
        CurveGeometry::Line { origin, direction } => {
            let arm = p - origin;
            (arm - *direction * (arm.dot(*direction) / direction.length_squared())).length()
        }
        CurveGeometry::Circle { frame, radius } => {
            let l = frame.local(p);
            (l.x.hypot(l.y) - radius).hypot(l.z)
        }
        _ => 0.0,
    };
    off(edge.start).max(off(edge.end))
}

/// The edge through its vertices that lies on all its faces.
fn better(edge: &Edge, faces: &[Support], (miss, tolerance): (f64, f64)) -> Option<Edge> {
    let most = tolerance.max(BETTER * miss);
    let away = |points: &mut dyn Iterator<Item = DVec3>| {
        points.flat_map(|p| faces.iter().map(move |f| f.nearest(p, None, 0.0).1)).fold(0.0, f64::max)
    };
    let steps = || (0..=STEPS).map(|i| f64::from(i) / f64::from(STEPS));
    let (start, end) = (edge.start, edge.end);
    match basis(&edge.curve) {
        _ if faces.is_empty() => None,
        CurveGeometry::Line { direction, .. } => {
            let chord = end - start;
            let along = chord.dot(*direction).abs() >= ALONG * chord.length() * direction.length();
            let fits = chord != DVec3::ZERO && along && away(&mut steps().map(|s| start + chord * s)) <= most;
            let curve = CurveGeometry::Line { origin: start, direction: chord };
            fits.then_some(Edge { curve, same_sense: true, ..*edge })
        }
        CurveGeometry::Circle { frame, radius } => {
            let level = |p: DVec3| p + frame.z * (start - p).dot(frame.z);
            let candidates = centres(edge, frame, *radius, faces).into_iter().map(level);
            let measured = candidates.filter_map(|centre| {
                let arc = Arc::new(edge, *frame, centre);
                let ends = (arc.radius - end.distance(centre)).abs().max((end - start).dot(frame.z).abs());
                let off = ends.max(away(&mut steps().map(|s| arc.point(s))));
                (off <= most && arc.radius > 0.0).then_some((off, arc))
            });
            let (_, arc) = measured.min_by(|a, b| a.0.total_cmp(&b.0))?;
            let frame = Frame { origin: arc.centre, ..*frame };
            Some(Edge { curve: CurveGeometry::Circle { frame, radius: arc.radius }, ..*edge })
        }
        _ => None,
    }
}

/// Where the centre of the circle may be: where it is stated, where one of the stated radius goes through both
/// vertices, and on the axes of the faces.
fn centres(edge: &Edge, frame: &Frame, radius: f64, faces: &[Support]) -> Vec<DVec3> {
    let mut all = vec![frame.origin];
    let chord = edge.end - edge.start;
    let rise = (radius * radius - 0.25 * chord.length_squared()).sqrt();
    if let (Some(across), true) = (frame.z.cross(chord).try_normalize(), rise.is_finite()) {
        let middle = edge.start + 0.5 * chord;
        all.extend([middle + across * rise, middle - across * rise]);
    }
    let axis = |s: &Support| s.axis().filter(|(_, z)| z.is_none_or(|z| z.cross(frame.z).length() <= 1e-6));
    all.extend(faces.iter().filter_map(axis).map(|(origin, _)| origin));
    all
}

/// A circle about `frame`'s z axis through the start of an edge, as far as the edge goes.
struct Arc {
    frame: Frame,
    centre: DVec3,
    radius: f64,
    from: f64,
    sweep: f64,
}

impl Arc {
    fn new(edge: &Edge, frame: Frame, centre: DVec3) -> Self {
        let angle = |p: DVec3| (p - centre).dot(frame.y).atan2((p - centre).dot(frame.x));
        let sign = if edge.same_sense { 1.0 } else { -1.0 };
        let ahead = (sign * (angle(edge.end) - angle(edge.start))).rem_euclid(TAU);
        let sweep = if edge.start == edge.end { TAU } else { ahead };
        Self { frame, centre, radius: edge.start.distance(centre), from: angle(edge.start), sweep: sign * sweep }
    }

    fn point(&self, s: f64) -> DVec3 {
        let (y, x) = sin_cos(self.from + self.sweep * s);
        self.centre + (self.frame.x * x + self.frame.y * y) * self.radius
    }
}

/// Marks the faces whose loops do not say reliably which side of a closed surface is meant.
fn mark_ambiguous(edges: &[Edge], faces: &mut [&mut FaceGeometry], closed: bool, tolerance: f64) {
    // uses of each edge along and against it, as seen against the normals of its faces
    let mut count = vec![[0u32; 2]; edges.len()];
    for face in faces.iter() {
        for (edge, forward) in uses(face) {
            if let Some(count) = count.get_mut(edge) {
                count[usize::from(forward == face.same_sense)] += 1;
            }
        }
    }
    for face in faces.iter_mut().map(|face| &mut **face) {
        use SurfaceGeometry as S;
        if !matches!(face.surface, S::Sphere { .. } | S::Torus { .. } | S::Revolution { .. } | S::BSpline(_)) {
            continue;
        }
        let mut mine: Vec<(usize, bool)> = uses(face).filter(|(e, _)| *e < edges.len()).collect();
        mine.sort_unstable();
        let once = mine.chunk_by(|a, b| a.0 == b.0).filter(|run| run.len() == 1).map(|run| run[0]);
        let (mut with, mut against) = (0, 0);
        for (edge, forward) in once {
            match count[edge] {
                [1, 1] => with += 1,
                both if both[usize::from(forward == face.same_sense)] == 2 => against += 1,
                _ => {}
            }
        }
        face.ambiguous |= against > with || (closed && !face.same_sense && encloses(&face.surface, edges, tolerance));
    }
}

/// All edges lie within a sphere or a torus.
fn encloses(surface: &SurfaceGeometry, edges: &[Edge], tolerance: f64) -> bool {
    if !matches!(surface, SurfaceGeometry::Sphere { .. } | SurfaceGeometry::Torus { .. }) {
        return false;
    }
    let Ok(support) = Support::new(surface, tolerance) else { return false };
    let inside = |p: DVec3| {
        let (foot, distance) = support.nearest(p, None, 0.0);
        let jet = support.jet(foot);
        distance <= tolerance || (p - jet.point).dot(jet.du.cross(jet.dv)) < 0.0
    };
    edges.iter().all(|e| inside(e.start) && inside(e.end))
}
