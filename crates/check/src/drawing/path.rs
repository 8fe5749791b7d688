//! Curves in the picture that may become lines: exact places, and polylines to find what meets what.

use super::LineKind;
use crate::model::Camera;
use glam::{DAffine3, DMat4, DVec2, DVec3, DVec4};
use selvedge_geometry::edges::Sheet;
use selvedge_geometry::silhouette::Fold;
use selvedge_geometry::spline::{Bezier, Control};
use std::sync::Arc;

/// Pixels: chords of a polyline are this near to the curve.
const CHORD_OFF: f64 = 0.004;
/// Pixels: longest chord; coincident lines are compared chord by chord.
const LONGEST: f64 = 48.0;
/// Halvings of a step.
const HALVINGS: u32 = 14;
/// Steps of each piece of a curve before any is halved: what bends back between them is seen.
const STEPS: u32 = 6;
/// Pixels around the picture within which curves are followed.
const MARGIN: f64 = 4.0;
/// Measure of a chord outside of the picture.
const UNSEEN: f64 = 1.0;
/// The direction of a curve at an end is that of a chord to a point so far inside, as a share of a piece.
const INSIDE: f64 = 1e-4;

/// A camera's numbers, made once.
#[derive(Clone, Debug)]
pub(crate) struct View {
    pub matrix: DMat4,
    pub size: DVec2,
    pub depth: (f64, f64),
    pub perspective: bool,
    /// Pixels around the picture that count as in it.
    beyond: f64,
    eye: DVec3,
    forward: DVec3,
}

/// A point in space and in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spot {
    pub pixel: DVec2,
    pub depth: f64,
    pub point: DVec3,
}

impl View {
    pub fn new(camera: &Camera) -> Self {
        Self {
            matrix: camera.pixel_matrix(),
            size: DVec2::new(f64::from(camera.size.0), f64::from(camera.size.1)),
            depth: camera.depth_range,
            perspective: camera.is_perspective(),
            beyond: 0.0,
            eye: camera.eye,
            forward: camera.axes().2,
        }
    }

    /// The same view with so many pixels around the picture that count as in it.
    pub fn with_beyond(self, beyond: f64) -> Self {
        Self { beyond, ..self }
    }

    /// `None` behind the eye.
    pub fn spot(&self, point: DVec3) -> Option<Spot> {
        let q = self.matrix * point.extend(1.0);
        (q.w > 0.0).then(|| Spot { pixel: DVec2::new(q.x, q.y) / q.w, depth: q.z, point })
    }

    /// How the picture of a spot moves when its point moves by `step`.
    pub fn velocity(&self, at: &Spot, step: DVec3) -> DVec2 {
        let (q, d) = (self.matrix * at.point.extend(1.0), self.matrix * step.extend(0.0));
        (DVec2::new(d.x, d.y) - at.pixel * d.w) / q.w
    }

    /// Unit vector towards the eye.
    pub fn to_eye(&self, point: DVec3) -> DVec3 {
        if self.perspective { (self.eye - point).normalize_or_zero() } else { -self.forward }
    }

    /// In the picture, or `beyond` beside it, and in the depth range.
    pub fn shows(&self, at: &Spot) -> bool {
        let (near, far) = self.depth;
        self.holds(at.pixel, self.beyond) && at.depth >= near && at.depth <= far
    }

    /// In the picture, or at most so many pixels beside it.
    pub fn holds(&self, pixel: DVec2, beside: f64) -> bool {
        pixel.cmpge(DVec2::splat(-beside)).all() && pixel.cmple(self.size + beside).all()
    }
}

/// What a line is a picture of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LineSource {
    /// An edge: index into [`Edges::edges`](crate::model::Edges::edges) of the instance's part.
    Edge {
        /// Index into [`Model::instances`](crate::model::Model::instances).
        instance: usize,
        /// Its number.
        edge: usize,
    },
    /// The fold of a face.
    Fold {
        /// Index into [`Model::instances`](crate::model::Model::instances).
        instance: usize,
        /// Index into the part's faces.
        face: usize,
    },
    /// A side of triangles.
    Side {
        /// Index into [`Model::instances`](crate::model::Model::instances).
        instance: usize,
        /// Index into the part's meshes.
        mesh: usize,
    },
}

/// The curve of a path.
#[derive(Clone, Debug)]
pub(crate) enum Curve<'s> {
    /// Pieces in model coordinates.
    Chain(Vec<Bezier<DVec4>>),
    Fold {
        fold: Arc<Fold>,
        sheet: &'s Sheet<'s>,
        transform: DAffine3,
    },
}

/// A curve, or the part of one without a cusp or a trim curve inside.
#[derive(Clone, Debug)]
pub(crate) struct Path<'s> {
    pub source: LineSource,
    pub kind: LineKind,
    pub curve: Curve<'s>,
    pub range: (f64, f64),
    /// Filled by [`Path::follow`].
    pub nodes: Vec<Node>,
}

/// A point of a polyline.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub parameter: f64,
    /// Behind the eye there is none.
    pub spot: Option<Spot>,
    /// Length of the polyline up to here: pixels, where it is in the picture.
    pub measure: f64,
}

impl Curve<'_> {
    fn piece(&self, parameter: f64) -> (usize, f64) {
        let count = match self {
            Self::Chain(pieces) => pieces.len(),
            Self::Fold { fold, .. } => fold.length(),
        };
        let k = (parameter.max(0.0) as usize).min(count - 1);
        (k, (parameter - k as f64).clamp(0.0, 1.0))
    }

    /// The point, and its derivative by the parameter.
    pub fn jet(&self, parameter: f64) -> (DVec3, DVec3) {
        match self {
            Self::Chain(pieces) => {
                let (k, t) = self.piece(parameter);
                let (h, dh) = pieces[k].jet(t);
                let point = h.point();
                (point, (dh.truncate() - point * dh.w) / h.w)
            }
            Self::Fold { fold, sheet, transform } => {
                let at = fold.at(parameter);
                let jet = sheet.grid.jet(at.uv.x, at.uv.y);
                let step = jet.du * at.along.x + jet.dv * at.along.y;
                (transform.transform_point3(jet.point), transform.transform_vector3(step))
            }
        }
    }

    pub fn point(&self, parameter: f64) -> DVec3 {
        match self {
            Self::Chain(pieces) => {
                let (k, t) = self.piece(parameter);
                pieces[k].point(t)
            }
            Self::Fold { .. } => self.jet(parameter).0,
        }
    }

    fn is_straight(&self) -> bool {
        matches!(self, Self::Chain(pieces) if pieces.iter().all(|p| p.degree() == 1))
    }
}

impl<'s> Path<'s> {
    pub fn new(source: LineSource, kind: LineKind, curve: Curve<'s>, range: (f64, f64)) -> Self {
        Self { source, kind, curve, range, nodes: Vec::new() }
    }

    pub fn spot(&self, view: &View, parameter: f64) -> Option<Spot> {
        view.spot(self.curve.point(parameter))
    }

    /// The place in the picture and its derivative by the parameter.
    pub fn motion(&self, view: &View, parameter: f64) -> Option<(Spot, DVec2)> {
        let (point, step) = self.curve.jet(parameter);
        let spot = view.spot(point)?;
        Some((spot, view.velocity(&spot, step)))
    }

    /// Unit direction in the picture as the parameter grows; at an end of the range as seen from inside. At cusps a fold's
    /// is that of the face's picture, which is a line there.
    pub fn direction(&self, view: &View, parameter: f64) -> Option<DVec2> {
        let (spot, velocity) = self.motion(view, parameter)?;
        let (a, b) = self.range;
        let step = INSIDE.min(0.25 * (b - a));
        let inside = if parameter + step <= b { step } else { -step };
        let other = self.spot(view, parameter + inside)?;
        let chord = (other.pixel - spot.pixel) / inside;
        if let Curve::Fold { fold, sheet, transform } = &self.curve {
            let at = fold.at(parameter);
            let jet = sheet.grid.jet(at.uv.x, at.uv.y);
            let [u, v] = [jet.du, jet.dv].map(|d| view.velocity(&spot, transform.transform_vector3(d)));
            let longer = if u.length_squared() > v.length_squared() { u } else { v };
            let along = longer.try_normalize()?;
            return Some(if along.dot(chord) < 0.0 { -along } else { along });
        }
        let moves = velocity.length() > 1e-3 * chord.length();
        if moves { velocity.try_normalize() } else { chord.try_normalize() }
    }

    /// Makes the polyline.
    pub fn follow(&mut self, view: &View) {
        let (a, b) = self.range;
        let node = |parameter: f64| Node { parameter, spot: self.spot(view, parameter), measure: 0.0 };
        let steps = if self.curve.is_straight() { 1 } else { STEPS };
        let mut places: Vec<f64> = vec![a];
        let mut whole = a.floor();
        while whole < b {
            let inner = (1..=steps).map(|k| whole + f64::from(k) / f64::from(steps));
            places.extend(inner.filter(|s| *s > a && *s < b));
            whole += 1.0;
        }
        places.push(b);
        let mut nodes = vec![node(a)];
        for pair in places.windows(2) {
            let (first, last) = (*nodes.last().expect("one at least"), node(pair[1]));
            divide(&node, view, first, last, HALVINGS, &mut nodes);
        }
        for k in 1..nodes.len() {
            nodes[k].measure = nodes[k - 1].measure + chord(view, &nodes[k - 1], &nodes[k]);
        }
        self.nodes = nodes;
    }

    /// The whole measure.
    pub fn length(&self) -> f64 {
        self.nodes.last().map_or(0.0, |n| n.measure)
    }

    /// The parameter at a measure.
    pub fn parameter(&self, measure: f64) -> f64 {
        let k = self.nodes.partition_point(|n| n.measure < measure).clamp(1, self.nodes.len() - 1);
        let (a, b) = (&self.nodes[k - 1], &self.nodes[k]);
        let share = if b.measure > a.measure { (measure - a.measure) / (b.measure - a.measure) } else { 0.0 };
        a.parameter + (b.parameter - a.parameter) * share.clamp(0.0, 1.0)
    }

    /// The measure at a parameter.
    pub fn measure(&self, parameter: f64) -> f64 {
        let k = self.nodes.partition_point(|n| n.parameter < parameter).clamp(1, self.nodes.len() - 1);
        let (a, b) = (&self.nodes[k - 1], &self.nodes[k]);
        let share =
            if b.parameter > a.parameter { (parameter - a.parameter) / (b.parameter - a.parameter) } else { 0.0 };
        a.measure + (b.measure - a.measure) * share.clamp(0.0, 1.0)
    }
}

/// Nothing between the two is in the picture, as far as they tell.
fn beside(view: &View, spots: [&Spot; 3]) -> bool {
    let all = |test: &dyn Fn(&Spot) -> bool| spots.iter().all(|s| test(s));
    let margin = MARGIN + view.beyond;
    all(&|s| s.pixel.x < -margin)
        || all(&|s| s.pixel.y < -margin)
        || all(&|s| s.pixel.x > view.size.x + margin)
        || all(&|s| s.pixel.y > view.size.y + margin)
        || all(&|s| s.depth < view.depth.0)
        || all(&|s| s.depth > view.depth.1)
}

fn chord(view: &View, a: &Node, b: &Node) -> f64 {
    match (&a.spot, &b.spot) {
        (Some(p), Some(q)) => {
            let length = p.pixel.distance(q.pixel);
            if beside(view, [p, q, q]) { length.min(UNSEEN) } else { length.min(4.0 * LONGEST) }
        }
        _ => UNSEEN,
    }
}

fn divide(at: &dyn Fn(f64) -> Node, view: &View, a: Node, b: Node, halvings: u32, out: &mut Vec<Node>) {
    let middle = at(0.5 * (a.parameter + b.parameter));
    let fine = match (&a.spot, &middle.spot, &b.spot) {
        (Some(p), Some(m), Some(q)) => {
            let along = q.pixel - p.pixel;
            let length = along.length();
            let from = m.pixel - p.pixel;
            let off = if length > 0.0 { (along.perp_dot(from) / length).abs() } else { from.length() };
            let between = from.dot(along) >= 0.0 && from.dot(along) <= along.length_squared();
            beside(view, [p, m, q]) || length <= LONGEST && off <= CHORD_OFF && (between || from.length() <= CHORD_OFF)
        }
        (None, None, None) => true,
        _ => false,
    };
    if fine || halvings == 0 {
        out.push(b);
        return;
    }
    divide(at, view, a, middle, halvings - 1, out);
    divide(at, view, middle, b, halvings - 1, out);
}
