//! Which points of a model's edges are seen: the truth that drawn lines are judged against.
//!
//! ```text
//!   edge ─▶ points on its curve ─▶ ray from the eye through each ─▶ all hits before the point
//!
//!      eye ──────×───────────────●    hit of any face before the point               hidden
//!      eye ───────────────────×──●    hit so near that it is the point: own face     visible
//!                                                               another's            unsure
//! ```
//!
//! A hit is *at* the point when the point lies within [`AT`] times the edges' stated deviation of the tangent plane of the
//! hit. Hits on solids and parts that are seen through hide nothing. Where a volume trims the model, edges outside it are
//! cut away.
//!
//! Two kinds of points are [`Visibility::Unsure`], and no judge counts them:
//!
//! * another face is at the point, or closer to it than single precision tells depths apart ([`FLUSH`]): a part that lies
//!   flush on another;
//! * an own face folds away beside the point: it would be seen if it were moved by what its place is not known to, or by
//!   [`FOLD_PX`] / 4 in the picture. Beside a fold both sheets lie within the square root of 8 deviations times the part's
//!   size, along the ray, and four times as far from each other's tangent planes as from the fold in the picture.

use super::{Hit, ON, Probe, Tracer};
use crate::model::{Camera, Edge, Edges, Model};
use crate::spline::Control;
use glam::{DAffine3, DVec2, DVec3, DVec4};
use rayon::prelude::*;
use selvedge_geometry::edges::EdgeError;
use std::borrow::Cow;

/// A hit is at a point of an edge within so many times what is known of the edge's place.
pub const AT: f64 = 4.0;
/// Of the depth: four roundings of single precision.
pub const FLUSH: f64 = 2.4e-7;
/// From the tangent plane of an own sheet before the point, pixels: the point is 1/256 px from the fold.
pub const FOLD_PX: f64 = 1.0 / 64.0;
/// What is known of a place at best, relative to the model's size.
const ROUNDING: f64 = 1e-12;
/// Points of one piece of a curve at most.
const MOST: f64 = 4096.0;

/// Whether a point of an edge is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visibility {
    /// Nothing is before it.
    Visible,
    /// A face is before it.
    Hidden,
    /// Only faces of others that are at the point, too, or a fold beside it.
    Unsure,
    /// The volume that trims the model does not hold it.
    Cut,
}

/// A point of an edge, in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgePoint {
    /// Index into [`Model::instances`].
    pub instance: usize,
    /// Index into [`Edges::edges`] of the instance's part.
    pub edge: usize,
    /// The edge's parameter: number of the piece, and fraction.
    pub parameter: f64,
    /// The point, model coordinates.
    pub point: DVec3,
    /// Its place in the picture, pixels.
    pub pixel: DVec2,
    /// Distance from the eye along the view axis, model units.
    pub depth: f64,
    /// Whether it is seen.
    pub visibility: Visibility,
}

/// The edges of a model's parts.
#[derive(Debug)]
pub struct EdgeTracer<'a> {
    model: &'a Model,
    tracer: &'a Tracer,
    parts: Cow<'a, [Edges]>,
}

impl<'a> EdgeTracer<'a> {
    /// Finds the edges of all parts; `tracer` is the model's.
    ///
    /// # Errors
    /// The part, and [`EdgeError`] for a face whose boundary is no curve.
    pub fn new(model: &'a Model, tracer: &'a Tracer) -> Result<Self, (usize, EdgeError)> {
        let edges = |(part, p): (usize, &crate::model::Part)| p.edges().map_err(|e| (part, e));
        let parts = model.parts.par_iter().enumerate().map(edges).collect::<Result<_, _>>()?;
        Ok(Self { model, tracer, parts: Cow::Owned(parts) })
    }

    /// A tracer with edges that were found before: `parts` has the edges of each of the model's parts.
    pub fn with(model: &'a Model, tracer: &'a Tracer, parts: &'a [Edges]) -> Self {
        Self { model, tracer, parts: Cow::Borrowed(parts) }
    }

    /// Instance and part of each placed body.
    pub(super) fn placed(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.tracer.placed.iter().map(|placed| (placed.instance, placed.part))
    }

    pub(super) fn transform(&self, instance: usize) -> DAffine3 {
        self.model.instances[instance].transform
    }

    pub(super) fn probe<'b>(&'b self, camera: &'b Camera) -> Probe<'b> {
        self.tracer.probe(camera)
    }

    /// The edges of each part.
    pub fn parts(&self) -> &[Edges] {
        &self.parts
    }

    /// Points of all edges of faces that lie in the picture and the depth range, at most `spacing` pixels apart along the
    /// control polygons (and no more than some thousands a piece), away from the ends of pieces. Edges of meshes have no
    /// points yet.
    pub fn points(&self, camera: &Camera, spacing: f64) -> Vec<EdgePoint> {
        let jobs: Vec<(usize, usize)> = self
            .tracer
            .placed
            .iter()
            .flat_map(|placed| (0..self.parts[placed.part].edges.len()).map(|edge| (placed.instance, edge)))
            .collect();
        jobs.into_par_iter()
            .flat_map_iter(|(instance, edge)| {
                let mut probe = self.tracer.probe(camera);
                self.points_of(instance, edge, &mut probe, spacing)
            })
            .collect()
    }

    fn points_of(&self, instance: usize, number: usize, probe: &mut Probe<'_>, spacing: f64) -> Vec<EdgePoint> {
        let placed = &self.model.instances[instance];
        let edges = &self.parts[placed.part];
        let camera = probe.camera();
        let (near, far) = camera.depth_range;
        let mut out = Vec::new();
        for (k, span) in edges.edges[number].curve.iter().enumerate() {
            let to_pixel =
                |p: &DVec4| camera.project(placed.transform.transform_point3(p.point())).map(|(pixel, _)| pixel);
            let polygon: Vec<Option<DVec2>> = span.piece.points.iter().map(to_pixel).collect();
            // behind the eye a polygon has no length: then as many as there may be
            let length = polygon.windows(2).map(|w| w[0].zip(w[1]).map_or(f64::INFINITY, |(a, b)| a.distance(b)));
            let steps = (length.sum::<f64>() / spacing).ceil().clamp(1.0, MOST) as u32;
            for i in 0..steps {
                let t = (f64::from(i) + 0.5) / f64::from(steps);
                let point = placed.transform.transform_point3(span.piece.point(t));
                let Some((pixel, depth)) = camera.project(point) else { continue };
                let (w, h) = (f64::from(camera.size.0), f64::from(camera.size.1));
                let shown = pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x <= w && pixel.y <= h;
                if !shown || depth < near || depth > far {
                    continue;
                }
                let visibility = self.visibility(instance, number, point, probe);
                let parameter = k as f64 + t;
                out.push(EdgePoint { instance, edge: number, parameter, point, pixel, depth, visibility });
            }
        }
        out
    }

    /// Whether a point of an edge of an instance, model coordinates, is seen; it lies in the picture and in front of the
    /// eye.
    ///
    /// # Panics
    /// For a point behind the eye.
    pub fn visibility(&self, instance: usize, edge: usize, point: DVec3, probe: &mut Probe<'_>) -> Visibility {
        let placed = &self.model.instances[instance];
        let edges = &self.parts[placed.part];
        let edge: &Edge = &edges.edges[edge];
        let known = edge.deviation * scale(&placed.transform);
        let own = |hit: &Hit| hit.instance == instance && edge.uses.iter().any(|u| u.face == hit.face_index);
        self.tracer.sight(point, known, &own, probe)
    }
}

impl Tracer {
    /// Whether a point is seen whose place is known to `known` and that lies on the surfaces that `own` names; in the
    /// picture and in front of the eye.
    ///
    /// # Panics
    /// For a point behind the eye.
    pub(super) fn sight(
        &self,
        point: DVec3,
        known: f64,
        own: &dyn Fn(&Hit) -> bool,
        probe: &mut Probe<'_>,
    ) -> Visibility {
        let camera = probe.camera();
        let (pixel, depth) = camera.project(point).expect("in front of the eye");
        let (origin, direction) = camera.ray(pixel);
        if self.is_cut(origin, direction, (point - origin).dot(direction)) {
            return Visibility::Cut;
        }
        let size = self.bounds.diagonal();
        let focal = camera.focal_px().min_element();
        let known = known.max(ROUNDING * size);
        let mut seen = Visibility::Visible;
        for hit in probe.hits(pixel) {
            let gap = (point - hit.point).dot(direction);
            if gap <= 0.0 || hit.depth >= depth || self.is_clear(hit) {
                continue;
            }
            let from_plane = gap * hit.normal.dot(direction).abs();
            if own(hit) && from_plane <= AT * known {
                continue;
            }
            let pixel_size = if camera.is_perspective() { depth } else { 1.0 } / focal;
            let beside_a_fold = own(hit) && (gap * gap <= 8.0 * known * size || from_plane <= FOLD_PX * pixel_size);
            let flush = !own(hit) && from_plane <= (AT * known).max(FLUSH * depth);
            if !beside_a_fold && !flush {
                return Visibility::Hidden;
            }
            seen = Visibility::Unsure;
        }
        seen
    }

    /// The volume that trims the model does not hold the point of the ray at `along`.
    pub(super) fn is_cut(&self, origin: DVec3, direction: DVec3, along: f64) -> bool {
        let on = ON * self.bounds.diagonal();
        self.trim.as_ref().is_some_and(|volume| {
            let trace = volume.trace(origin, direction);
            ![along - on, along, along + on].iter().any(|t| trace.inside(*t))
        })
    }

    /// The primitive of a hit on a Boolean solid: index into the solids' union.
    pub(super) fn primitive(&self, hit: &Hit) -> Option<usize> {
        (hit.part >= self.parts.len()).then_some(hit.face_index)
    }

    /// The hit is on a face of a solid that is drawn face by face, most of them seen through.
    pub(super) fn is_layer(&self, hit: &Hit) -> bool {
        let solids = self.solids.as_ref();
        self.primitive(hit).is_some_and(|p| solids.is_some_and(|s| s.is_of_clear(p)))
    }

    /// The hit is on a face that is seen through.
    pub(super) fn is_clear(&self, hit: &Hit) -> bool {
        let solids = self.solids.iter().filter(|_| hit.part >= self.parts.len());
        let mut primitives = solids.filter_map(|s| s.union().primitives().get(hit.face_index));
        primitives.any(|p| !p.is_opaque())
    }
}

/// By how much a transform lengthens at most, within a factor of the square root of 3.
pub(super) fn scale(transform: &DAffine3) -> f64 {
    let m = transform.matrix3;
    (m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()).sqrt()
}
