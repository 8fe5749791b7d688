//! The point under the cursor to measure from or to.
//!
//! ```text
//!   edges seen within SNAP_PX   ─▶ their ends                          vertex   ┐
//!                               ─▶ their middles                       middle   │ within SNAP_PX of the cursor,
//!   round edges of the picture  ─▶ their centres                       centre   │ and nothing in front of them
//!   edges seen within EDGE_PX   ─▶ their points nearest to the cursor  on edge  ┘
//!   face of the cursor's pixel  ─▶ where the ray meets its surface     on face
//! ```
//!
//! A vertex is preferred to a centre and to a middle, these to a point on an edge, and that to a point on a face; within
//! a kind the nearest one is taken. The images say which edges and faces there are and what is hidden. All points come
//! from the model's curves and surfaces, in `f64`. Cost: that of a pick, and a product of a matrix and a vector for each
//! round edge of the picture.

use super::{EDGE_PX, Sample, Samples, Seen, towards};
use crate::session::{Picked, PointKind};
use glam::{DAffine3, DMat4, DVec2, DVec3, Vec4Swizzles};
use selvedge::model::Edge;
use selvedge_geometry::edges::curve;

/// Pixels from the cursor within which a point is taken.
pub const SNAP_PX: f64 = 7.0;
/// Points that are so many pixels farther than the nearest one are as near: the one in front is taken. The test for
/// what is hidden is as coarse.
const SAME_PX: f64 = 1.5;
/// Pixels that the point of a face may be off the cursor: the picture is right within half of one.
const FACE_PX: f64 = 1.0;
/// Depths of the picture are roundings of single precision, of a few operations: a share of the depth.
const DEPTH: f64 = 1e-6;
/// Parts of a piece of an edge between which the nearest point is searched.
const LOOKS: usize = 16;
/// Steps of Gauss and Newton's method.
const STEPS: usize = 24;

/// A point that may be taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// The point.
    pub picked: Picked,
    /// From the cursor.
    pub distance_px: f64,
    /// Along the view axis.
    pub depth: f64,
}

/// The order of kinds, the preferred one first.
fn rank(picked: &Picked) -> u8 {
    match picked {
        Picked::Vertex { .. } => 0,
        Picked::Point { kind: PointKind::Centre | PointKind::Middle, .. } => 1,
        Picked::Point { kind: PointKind::OnEdge, .. } => 2,
        _ => 3,
    }
}

/// The candidate to take: of the preferred kind the nearest to the cursor, and of those at about the same place the one
/// in front.
pub fn choose(candidates: &[Candidate]) -> Option<Picked> {
    let preferred = candidates.iter().map(|c| rank(&c.picked)).min()?;
    let of_kind = || candidates.iter().filter(move |c| rank(&c.picked) == preferred);
    let nearest = of_kind().map(|c| c.distance_px).fold(f64::INFINITY, f64::min);
    let same = of_kind().filter(|c| c.distance_px <= nearest + SAME_PX);
    same.min_by(|a, b| a.depth.total_cmp(&b.depth)).map(|c| c.picked)
}

/// The cursor over a picture.
struct Cursor<'a> {
    samples: &'a Samples,
    seen: &'a Seen<'a>,
    at: DVec2,
}

impl Samples {
    /// The point under a cursor, pixels of the picture; `face` has instance and face of its pixel.
    pub(super) fn snap(&self, seen: &Seen<'_>, at: DVec2, face: Option<(usize, usize)>) -> Option<Picked> {
        let cursor = Cursor { samples: self, seen, at };
        let mut all = cursor.on_edges();
        all.extend(cursor.centres());
        all.extend(face.and_then(|(instance, face)| cursor.on_face(instance, face)));
        choose(&all)
    }

    /// Whether the picture shows nothing in front of a point at `depth`. Within the 3 x 3 pixels around it surfaces may
    /// be inclined: the point may be as far behind the deepest of them as that is behind the nearest.
    fn shows(&self, pixel: DVec2, depth: f64) -> bool {
        let (x, y) = (pixel.x.floor() as i64, pixel.y.floor() as i64);
        let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy)));
        let samples = around.filter_map(|(x, y)| self.at((u32::try_from(x).ok()?, u32::try_from(y).ok()?)));
        let depths: Vec<f64> = samples.map(|sample| f64::from(sample.depth)).collect();
        let nearest = depths.iter().copied().fold(f64::INFINITY, f64::min);
        let deepest = depths.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let is_background = deepest == f64::INFINITY;
        !depths.is_empty() && (is_background || depth <= deepest + (deepest - nearest) + DEPTH * deepest.abs())
    }
}

impl Cursor<'_> {
    /// A point of a placed part, if it is near and seen.
    fn candidate(&self, picked: Picked, transform: DAffine3, own: DVec3) -> Option<Candidate> {
        let (pixel, depth) = self.seen.camera.project(transform.transform_point3(own))?;
        let distance_px = pixel.distance(self.at);
        (distance_px <= SNAP_PX && self.samples.shows(pixel, depth)).then_some(Candidate { picked, distance_px, depth })
    }

    /// Ends, middles and nearest points of the edges that are seen near the cursor.
    fn on_edges(&self) -> Vec<Candidate> {
        let Seen { world, placement, camera, .. } = *self.seen;
        let with_edge = self.samples.pixels().filter(|(_, sample)| sample.edge != 0);
        let mut near: Vec<(f64, DVec2, &Sample)> =
            with_edge.map(|(pixel, sample)| (pixel.distance(self.at), pixel, sample)).collect();
        near.retain(|(distance, ..)| *distance <= SNAP_PX);
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut found, mut all) = (Vec::new(), Vec::new());
        for (distance, pixel, sample) in near {
            let Some((instance, part, number)) = self.samples.edge_at(self.seen, sample, pixel) else { continue };
            if found.contains(&(instance, number)) {
                continue;
            }
            found.push((instance, number));
            let Some(edges) = world.edges_of(part) else { continue };
            let Some(edge) = edges.edges.get(number) else { continue };
            let transform = placement(instance);
            let point = |kind, at| self.candidate(Picked::Point { instance, kind, of: number, at }, transform, at);
            let end = |vertex: usize| {
                self.candidate(Picked::Vertex { instance, vertex }, transform, *edges.vertices.get(vertex)?)
            };
            all.extend(edge.ends.iter().filter_map(|vertex| end(*vertex)));
            // a closed edge has no middle
            let middle = (edge.ends[0] != edge.ends[1]).then(|| curve::middle(edge, transform)).flatten();
            all.extend(middle.and_then(|at| point(PointKind::Middle, at)));
            if distance <= EDGE_PX {
                let to_pixels = camera.pixel_matrix() * DMat4::from(transform);
                let nearest = nearest_points(edge, to_pixels, self.at);
                all.extend(nearest.into_iter().filter_map(|at| point(PointKind::OnEdge, at)));
            }
        }
        all
    }

    /// Centres of round edges near the cursor.
    fn centres(&self) -> Vec<Candidate> {
        let Seen { world, instances, hidden, placement, camera } = *self.seen;
        let camera_pixels = camera.pixel_matrix();
        let mut all = Vec::new();
        for &instance in instances.iter().filter(|instance| !hidden.contains(*instance)) {
            let transform = placement(instance);
            let to_pixels = camera_pixels * DMat4::from(transform);
            for &(edge, centre) in world.centres_of(world.model.instances[instance].part) {
                let q = to_pixels * centre.extend(1.0);
                if q.w > 0.0 && (q.xy() - self.at * q.w).length() <= SNAP_PX * q.w {
                    let picked = Picked::Point { instance, kind: PointKind::Centre, of: edge, at: centre };
                    all.extend(self.candidate(picked, transform, centre));
                }
            }
        }
        all
    }

    /// The point of a face under the cursor.
    fn on_face(&self, instance: usize, face: usize) -> Option<Candidate> {
        let Seen { world, placement, camera, .. } = *self.seen;
        let sample = self.samples.under(self.at)?;
        let surface = &world.model.parts[world.model.instances[instance].part].faces[face].surface;
        let transform = placement(instance);
        let back = transform.inverse();
        let direction = camera.ray(self.at).1;
        let near = super::near(camera, self.at, sample.depth);
        let ray = (back.transform_point3(near), back.transform_vector3(direction));
        let uv = DVec2::new(f64::from(sample.uv[0]), f64::from(sample.uv[1]));
        let (_, at, _) = towards(surface, ray, uv)?;
        let (pixel, depth) = camera.project(transform.transform_point3(at))?;
        let distance_px = pixel.distance(self.at);
        let picked = Picked::Point { instance, kind: PointKind::OnFace, of: face, at };
        (distance_px <= FACE_PX).then_some(Candidate { picked, distance_px, depth })
    }
}

/// The points of an edge, part coordinates, that are nearer to a pixel than those beside them: one on each branch of it
/// in the picture. `to_pixels` takes the part to homogeneous pixels.
fn nearest_points(edge: &Edge, to_pixels: DMat4, pixel: DVec2) -> Vec<DVec3> {
    let pieces = edge.curve.len();
    if pieces == 0 {
        return Vec::new();
    }
    let count = pieces * LOOKS;
    // the piece that a parameter lies in, and the place in it
    let place = |parameter: f64| {
        let number = (parameter as usize).min(pieces - 1);
        (&edge.curve[number].piece, parameter - number as f64)
    };
    let distance = |parameter: f64| {
        let (piece, t) = place(parameter);
        let q = to_pixels * piece.homogeneous(t);
        if q.w > 0.0 { (q.xy() / q.w).distance(pixel) } else { f64::INFINITY }
    };
    let parameter = |look: usize| look as f64 / LOOKS as f64;
    let looks: Vec<f64> = (0..=count).map(|look| distance(parameter(look))).collect();
    let is_least = |look: &usize| {
        let (before, after) = (look.saturating_sub(1), (look + 1).min(count));
        looks[*look].is_finite() && looks[*look] <= looks[before] && looks[*look] <= looks[after]
    };
    let refined = |look: usize| {
        let (low, high) = (parameter(look.saturating_sub(1)), parameter((look + 1).min(count)));
        let mut at = parameter(look);
        let mut best = (looks[look], at);
        for _ in 0..STEPS {
            let (piece, t) = place(at);
            let (h, dh) = piece.jet(t);
            let (q, dq) = (to_pixels * h, to_pixels * dh);
            let there = q.xy() / q.w;
            let along = (dq.xy() - there * dq.w) / q.w;
            let step = (pixel - there).dot(along) / along.length_squared();
            let next = (at + step).clamp(low, high);
            if !step.is_finite() || next == at {
                break;
            }
            at = next;
            let away = distance(at);
            if away < best.0 {
                best = (away, at);
            }
        }
        let (piece, t) = place(best.1);
        piece.point(t)
    };
    (0..=count).filter(is_least).map(refined).collect()
}

#[cfg(test)]
mod tests;
