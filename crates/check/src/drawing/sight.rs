//! What a place on a path is to the eye.
//!
//! ```text
//!   edge    the exact ray through its point, as edges.rs has it
//!   fold    the face covers one side of its picture: the ray passes BESIDE it on the other
//!
//!             ┊ ray        any hit before the fold's depth hides it; the face itself is not hit there,
//!        ╱────●            unless it folds back in front
//!      face    BESIDE px
//! ```

use super::LineKind;
use super::path::{Curve, LineSource, Path, Spot, View};
use super::sources::Scene;
use crate::edges::scale;
use crate::{Hit, Probe, Visibility};
use glam::{DAffine3, DVec3};
use selvedge_geometry::edges::{Sheet, Track};

/// Pixels by which a ray passes a fold.
const BESIDE: f64 = 1e-3;
/// A hit hides a fold only if it lies before it by this share of the model's size.
const BEFORE: f64 = 1e-9;
/// Sine below which a face is seen edge-on.
const EDGE_ON: f64 = 1e-6;
/// Sine above which neighbours that meet smoothly are both seen from the same side.
const CLEARLY: f64 = 0.03;

/// What a place is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum State {
    /// Outside of the picture, cut away, or no line of this kind.
    Gone,
    Seen(LineKind),
    Hidden(LineKind),
    /// Flush with something else.
    Unsure(LineKind),
}

/// A use of an edge, to find the face's normal at a point.
struct Side<'s> {
    sheet: &'s Sheet<'s>,
    track: Track,
}

impl Side<'_> {
    /// The unit outward normal next to a point, part coordinates.
    fn normal(&self, p: DVec3) -> Option<DVec3> {
        let uv = self.track.place(self.sheet, p)?;
        let normal = self.sheet.grid.normal(uv.x, uv.y)?;
        Some(if self.sheet.face.same_sense { normal } else { -normal })
    }
}

/// Decides which stretches of one path are seen.
pub(crate) struct Sight<'s> {
    scene: &'s Scene<'s>,
    view: &'s View,
    path: &'s Path<'s>,
    /// Of edges that may be silhouettes without an angle.
    sides: Vec<Side<'s>>,
}

impl<'s> Sight<'s> {
    /// `contours`: smooth edges and seams count as silhouettes where the surface folds along them.
    pub fn new(scene: &'s Scene<'s>, view: &'s View, path: &'s Path<'s>, contours: bool) -> Self {
        let sides = match path.source {
            LineSource::Edge { instance, edge }
                if contours && matches!(path.kind, LineKind::Smooth | LineKind::Seam) =>
            {
                let part = scene.model.instances[instance].part;
                let edges = &scene.edges[part];
                let side = |used: &crate::model::EdgeUse| {
                    let sheet = &scene.sheets[part][used.face];
                    Side { sheet, track: Track::new(sheet, used, edges.reach) }
                };
                edges.edges[edge].uses.iter().map(side).collect()
            }
            _ => Vec::new(),
        };
        Self { scene, view, path, sides }
    }

    /// The state at a parameter.
    pub fn state(&self, parameter: f64, probe: &mut Probe<'_>) -> State {
        let Some(spot) = self.path.spot(self.view, parameter).filter(|s| self.view.shows(s)) else {
            return State::Gone;
        };
        let kind = match self.path.kind {
            LineKind::Smooth | LineKind::Seam if self.is_contour(&spot) => LineKind::Silhouette,
            LineKind::Seam => return State::Gone,
            kind => kind,
        };
        let seen = match (self.path.source, &self.path.curve) {
            (LineSource::Edge { instance, edge }, _) => self.of_edge((instance, edge), spot.point, probe),
            (LineSource::Side { instance, mesh }, _) => self.of_side((instance, mesh), spot.point, probe),
            (LineSource::Fold { .. }, Curve::Fold { .. }) => self.of_fold(parameter, &spot, probe),
            (LineSource::Fold { .. }, Curve::Chain(_)) => unreachable!("folds have curves of their own"),
        };
        match seen {
            Visibility::Visible => State::Seen(kind),
            Visibility::Hidden => State::Hidden(kind),
            Visibility::Unsure => State::Unsure(kind),
            Visibility::Cut => State::Gone,
        }
    }

    fn transform(&self, instance: usize) -> (usize, DAffine3) {
        let i = &self.scene.model.instances[instance];
        (i.part, i.transform)
    }

    fn of_edge(&self, (instance, edge): (usize, usize), point: DVec3, probe: &mut Probe<'_>) -> Visibility {
        let (part, transform) = self.transform(instance);
        let edge = &self.scene.edges[part].edges[edge];
        let own = |hit: &Hit| hit.instance == instance && edge.uses.iter().any(|u| u.face == hit.face_index);
        self.scene.tracer.sight(point, edge.deviation * scale(&transform), &own, probe)
    }

    fn of_side(&self, (instance, mesh): (usize, usize), point: DVec3, probe: &mut Probe<'_>) -> Visibility {
        let (part, _) = self.transform(instance);
        let number = self.scene.model.parts[part].faces.len() + mesh;
        let own = |hit: &Hit| hit.instance == instance && hit.face_index == number;
        self.scene.tracer.sight(point, 0.0, &own, probe)
    }

    fn of_fold(&self, parameter: f64, spot: &Spot, probe: &mut Probe<'_>) -> Visibility {
        let Curve::Fold { fold, sheet, transform } = &self.path.curve else { return Visibility::Visible };
        let camera = probe.camera();
        let tracer = self.scene.tracer;
        let (origin, direction) = camera.ray(spot.pixel);
        if tracer.is_cut(origin, direction, (spot.point - origin).dot(direction)) {
            return Visibility::Cut;
        }
        let uv = fold.at(parameter).uv;
        let jet = sheet.face.surface.jet2(uv.x, uv.y);
        let flat = |d: DVec3| self.view.velocity(spot, transform.transform_vector3(d));
        let (u, v) = (flat(jet.du), flat(jet.dv));
        let range = if u.length_squared() > v.length_squared() { u } else { v };
        // the step in (u, v) that the picture does not see
        let (a, b) = (v.dot(range), -u.dot(range));
        let bend = flat(jet.duu * (a * a) + jet.duv * (2.0 * a * b) + jet.dvv * (b * b));
        let across = range.perp().normalize_or_zero();
        let outwards = if bend.dot(across) > 0.0 { -across } else { across };
        let least = BEFORE * tracer.bounds().diagonal();
        let before = |hit: &Hit| hit.depth < spot.depth - least && !tracer.is_clear(hit);
        if probe.hits(spot.pixel + outwards * BESIDE).iter().any(before) {
            Visibility::Hidden
        } else {
            Visibility::Visible
        }
    }

    /// One of the faces is seen from outside there and the other is not, or edge-on.
    fn is_contour(&self, spot: &Spot) -> bool {
        let LineSource::Edge { instance, .. } = self.path.source else { return false };
        let transform = self.scene.model.instances[instance].transform;
        let to_part = transform.inverse();
        let (point, eye) = (to_part.transform_point3(spot.point), self.view.to_eye(spot.point));
        let normals = to_part.matrix3.transpose();
        let facing = |side: &Side<'_>| side.normal(point).map(|n| (normals * n).normalize_or_zero().dot(eye));
        let Some(first) = self.sides.first().and_then(facing).filter(|f| f.abs() < CLEARLY) else { return false };
        let others = self.sides[1..].iter().filter_map(facing);
        let (low, high) = others.fold((first, first), |(low, high), f| (low.min(f), high.max(f)));
        first.abs() < EDGE_ON || low.abs() < EDGE_ON || high.abs() < EDGE_ON || low < 0.0 && high > 0.0
    }
}
