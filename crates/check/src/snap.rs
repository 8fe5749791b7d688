//! Points of a model to snap to: visible points near a pixel.
//!
//! ```text
//!    vertex   an edge's end                   ●──────   exact rays see the point
//!    centre   of a round edge                  ( · )    exact rays see a point of the edge
//!    edge     its point nearest to the pixel  ──•──     exact rays see the point; else the edge is followed from there
//! ```
//!
//! Every candidate lies within the radius in the picture. A vertex is preferred to a centre, and both to an edge;
//! within a kind the nearest visible candidate is taken. Where the nearest point of an edge is hidden, the edge is
//! followed both ways, in steps of [`STEP_PX`], to where it becomes visible; that place is halved to [`PLACE_PX`]. So
//! visible stretches that are shorter than a step may be missed, and branches of the edge that come back into the
//! radius are. Edges of meshes have no points.
//!
//! Accuracy: points are within [`Edges::deviation`] of the edges; rays are as exact as those of [`EdgeTracer`]. Cost:
//! the boxes of all edges, and a ray for each candidate up to the first visible one. A centre takes up to 16 rays, an
//! edge whose nearest point is hidden up to a ray a step.

use super::{EdgeTracer, Probe, Visibility};
use crate::model::{Camera, Edge, Edges};
use glam::{DAffine3, DMat4, DVec2, DVec3, Vec4Swizzles};
use selvedge_geometry::edges::curve::{CurveShape, shape};
use selvedge_geometry::edges::nearest::nearest;

/// The kinds of points, the preferred one first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SnapKind {
    /// Where an edge begins or ends.
    Vertex,
    /// The centre of an edge that is a circle or an arc of one.
    Centre,
    /// A point on an edge.
    Edge,
}

/// A point near a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Snap {
    /// The kind of the point.
    pub kind: SnapKind,
    /// Index into [`Model::instances`](crate::model::Model::instances).
    pub instance: usize,
    /// Index into [`Model::parts`](crate::model::Model::parts).
    pub part: usize,
    /// Index into [`Edges::edges`] of the part: the edge, or one that ends at the vertex.
    pub edge: usize,
    /// Index into [`Edges::vertices`] of the part, for a vertex only.
    pub vertex: Option<usize>,
    /// The point, model coordinates.
    pub point: DVec3,
    /// Position in the picture.
    pub pixel: DVec2,
    /// Distance from the given pixel, pixels.
    pub distance_px: f64,
    /// Distance from the eye along the view axis, model units.
    pub depth: f64,
}

/// Pixels between the points of an edge that are tested beside a hidden one.
const STEP_PX: f64 = 0.25;
/// Pixels to which the place is found where an edge comes to be seen.
const PLACE_PX: f64 = 1.0 / 64.0;
/// Points of a round edge that are tested; its centre counts if one of them is visible.
const LOOKS: u32 = 16;

impl EdgeTracer<'_> {
    /// The preferred visible point of these kinds within `radius_px` of `pixel`. The first pixel's centre is (0.5,
    /// 0.5). `None` if there is no such point, if the radius is not a finite number above 0, or if `pixel` is not
    /// finite.
    pub fn snap(&self, camera: &Camera, pixel: DVec2, radius_px: f64, kinds: &[SnapKind]) -> Option<Snap> {
        if !(radius_px > 0.0 && radius_px.is_finite() && pixel.is_finite()) {
            return None;
        }
        let (near, far) = camera.depth_range;
        let size = DVec2::new(f64::from(camera.size.0), f64::from(camera.size.1));
        let mut found = Vec::new();
        for (instance, part) in self.placed() {
            let (edges, transform) = (&self.parts()[part], self.transform(instance));
            let to_pixels = camera.pixel_matrix() * DMat4::from(transform);
            for (number, edge) in edges.edges.iter().enumerate() {
                let of = |kind, vertex, point| Candidate { kind, instance, part, edge: number, vertex, point };
                let candidates = candidates(edge, edges, transform, kinds, &of, || {
                    let at = nearest(edge, to_pixels, pixel, radius_px)?;
                    let piece = (at.parameter as usize).min(edge.curve.len() - 1);
                    Some(transform.transform_point3(edge.curve[piece].piece.point(at.parameter - piece as f64)))
                });
                found.extend(candidates.into_iter().filter_map(|candidate| {
                    let (at, depth) = camera.project(candidate.point)?;
                    let distance_px = at.distance(pixel);
                    let inside = at.cmpge(DVec2::ZERO).all() && at.cmple(size).all() && depth >= near && depth <= far;
                    (inside && distance_px <= radius_px).then(|| candidate.at(at, depth, distance_px))
                }));
            }
        }
        found.sort_by(|a: &Snap, b| a.kind.cmp(&b.kind).then(a.distance_px.total_cmp(&b.distance_px)));
        let mut probe = self.probe(camera);
        let before = |a: &Snap, b: &Snap| (a.kind, a.distance_px) < (b.kind, b.distance_px);
        let mut best: Option<Snap> = None;
        for snap in found {
            if best.is_some_and(|best| before(&best, &snap)) {
                break;
            }
            let seen = match snap.kind {
                _ if self.is_seen(&snap, &mut probe) => Some(snap),
                SnapKind::Edge => self.seen_beside(&snap, (pixel, radius_px), &mut probe),
                SnapKind::Vertex | SnapKind::Centre => None,
            };
            best = seen.filter(|seen| best.is_none_or(|best| before(seen, &best))).or(best);
        }
        best
    }

    /// The visible point of the snap's edge nearest to the pixel: the edge is followed both ways from the snap's point.
    fn seen_beside(&self, snap: &Snap, (pixel, radius_px): (DVec2, f64), probe: &mut Probe<'_>) -> Option<Snap> {
        let camera = *probe.camera();
        let transform = self.transform(snap.instance);
        let curve = &self.parts()[snap.part].edges[snap.edge].curve;
        let to_pixels = camera.pixel_matrix() * DMat4::from(transform);
        let size = DVec2::new(f64::from(camera.size.0), f64::from(camera.size.1));
        // the point at a parameter, and by how much the parameter grows a pixel
        let at = |parameter: f64| {
            let piece = (parameter as usize).min(curve.len() - 1);
            let (h, dh) = curve[piece].piece.jet(parameter - piece as f64);
            let (q, dq) = (to_pixels * h, to_pixels * dh);
            let speed = ((dq.xy() - q.xy() / q.w * dq.w) / q.w).length();
            let point = transform.transform_point3(h.xyz() / h.w);
            let (place, depth) = camera.project(point)?;
            let (near, far) = camera.depth_range;
            let inside = place.cmpge(DVec2::ZERO).all() && place.cmple(size).all() && depth >= near && depth <= far;
            let distance_px = place.distance(pixel);
            (inside && distance_px <= radius_px)
                .then_some((Snap { point, pixel: place, distance_px, depth, ..*snap }, speed.recip()))
        };
        let start = nearest(&self.parts()[snap.part].edges[snap.edge], to_pixels, pixel, radius_px)?.parameter;
        let end = curve.len() as f64;
        let follow = |way: f64, probe: &mut Probe<'_>| {
            let mut hidden = start;
            let most = (4.0 * radius_px / STEP_PX).ceil() as u32;
            for _ in 0..most {
                let (_, a_pixel) = at(hidden)?;
                let next = (hidden + way * (STEP_PX * a_pixel).min(0.5)).clamp(0.0, end);
                let (mut seen, _) = at(next).filter(|_| next != hidden)?;
                if !self.is_seen(&seen, probe) {
                    hidden = next;
                    continue;
                }
                let (mut low, mut high) = (hidden, next);
                while (high - low).abs() > PLACE_PX * a_pixel {
                    let middle = 0.5 * (low + high);
                    match at(middle).filter(|(snap, _)| self.is_seen(snap, probe)) {
                        Some((snap, _)) => (seen, high) = (snap, middle),
                        None => low = middle,
                    }
                }
                return Some(seen);
            }
            None
        };
        let found = [-1.0, 1.0].map(|way| follow(way, probe));
        found.into_iter().flatten().min_by(|a, b| a.distance_px.total_cmp(&b.distance_px))
    }

    fn is_seen(&self, snap: &Snap, probe: &mut Probe<'_>) -> bool {
        let camera = *probe.camera();
        let mut sees = |point: DVec3| {
            let visibility = self.visibility(snap.instance, snap.edge, point, probe);
            matches!(visibility, Visibility::Visible | Visibility::Unsure)
        };
        if snap.kind != SnapKind::Centre {
            return sees(snap.point);
        }
        let (curve, transform) = (&self.parts()[snap.part].edges[snap.edge].curve, self.transform(snap.instance));
        let points = (0..LOOKS).map(|look| {
            let t = (f64::from(look) + 0.5) / f64::from(LOOKS) * curve.len() as f64;
            let piece = (t as usize).min(curve.len() - 1);
            transform.transform_point3(curve[piece].piece.point(t - piece as f64))
        });
        points.filter(|p| camera.project(*p).is_some_and(|(_, depth)| depth > 0.0)).any(sees)
    }
}

/// A point that may be snapped to.
struct Candidate {
    kind: SnapKind,
    instance: usize,
    part: usize,
    edge: usize,
    vertex: Option<usize>,
    point: DVec3,
}

impl Candidate {
    fn at(self, pixel: DVec2, depth: f64, distance_px: f64) -> Snap {
        let Self { kind, instance, part, edge, vertex, point } = self;
        Snap { kind, instance, part, edge, vertex, point, pixel, distance_px, depth }
    }
}

/// The candidates of one edge; `on_edge` finds its point nearest to the pixel.
fn candidates(
    edge: &Edge,
    edges: &Edges,
    transform: DAffine3,
    kinds: &[SnapKind],
    of: &dyn Fn(SnapKind, Option<usize>, DVec3) -> Candidate,
    on_edge: impl FnOnce() -> Option<DVec3>,
) -> Vec<Candidate> {
    let wanted = |kind| kinds.contains(&kind);
    let mut all = Vec::new();
    if wanted(SnapKind::Vertex) {
        let placed = |v: usize| transform.transform_point3(edges.vertices[v]);
        all.extend(edge.ends.iter().map(|v| of(SnapKind::Vertex, Some(*v), placed(*v))));
    }
    if wanted(SnapKind::Centre)
        && let CurveShape::Circle(circle) = shape(edge, transform)
    {
        all.push(of(SnapKind::Centre, None, circle.centre));
    }
    if wanted(SnapKind::Edge) {
        all.extend(on_edge().map(|point| of(SnapKind::Edge, None, point)));
    }
    all
}
