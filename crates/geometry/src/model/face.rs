//! A face: one surface and the loops that trim it.

use super::{Bounds, Colour, EdgeRef};
use crate::spline::{Bezier, Control, MAX_DEGREE, Surface};
use glam::{DVec2, DVec3};
#[cfg(feature = "serde")]
use serde::Deserialize;

/// The kind of a surface in its source, before it became a rational B-spline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum SurfaceKind {
    /// A plane.
    Plane,
    /// A circular cylinder.
    Cylinder,
    /// A circular cone.
    Cone,
    /// A sphere.
    Sphere,
    /// A torus.
    Torus,
    /// A curve turned about an axis.
    Revolution,
    /// A curve moved along a vector.
    Extrusion,
    /// At a constant distance from another surface.
    Offset,
    /// A B-spline, or what has become one: Bézier patches, constructions, subdivision.
    BSpline,
}

impl SurfaceKind {
    /// Whether it is given by one equation in space, which then holds for all patches of the surface.
    pub fn is_elementary(self) -> bool {
        matches!(self, Self::Plane | Self::Cylinder | Self::Cone | Self::Sphere | Self::Torus)
    }
}

/// A closed chain of rational Bézier curves in the `(u, v)` domain of its face.
///
/// Control points are homogeneous, `(w u, w v, w)`. The end of each curve is the start of the next,
/// bit for bit, the last one's the first one's: [`TrimLoop::new`] sees to it.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "LoopData"))]
pub struct TrimLoop {
    curves: Vec<Vec<DVec3>>,
    /// One a curve, or none at all: see [`TrimLoop::edges`].
    edges: Vec<Option<EdgeRef>>,
}

/// A trim loop of a model, by numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LoopAt {
    /// In [`Model::parts`](super::Model::parts).
    pub part: usize,
    /// In the part's faces.
    pub face: usize,
    /// In the face's loops.
    pub trim_loop: usize,
}

/// One face.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Face {
    /// Number in the source, written to the face-id image; for STEP `#123` is 123. Never 0.
    pub id: u32,
    /// The kind of the surface in the source.
    pub kind: SurfaceKind,
    /// The carrier surface.
    pub surface: Surface,
    /// Trim loops; empty when the face is its whole surface.
    pub loops: Vec<TrimLoop>,
    /// The outward normal is `S_u x S_v` when true, its opposite when false.
    pub same_sense: bool,
    /// The face's own colour, if it has one.
    pub colour: Option<Colour>,
}

/// Why a face is invalid.
#[allow(missing_docs)] // the messages say what each field is
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FaceError {
    /// A loop without a curve.
    #[error("trim loop has no curve")]
    EmptyLoop,
    /// Curve end and next start are farther apart than the loop's tolerance.
    #[error("trim loop is open by {gap:e} in (u, v) after curve {curve}")]
    OpenLoop { curve: usize, gap: f64 },
    /// Not finite, or a weight that is not positive.
    #[error("trim curve {curve} has a control point that is not finite or a weight that is not positive")]
    ControlPoint { curve: usize },
    /// There is no such control point.
    #[error("trim curve {curve} has no control point {point}, or there is no such curve")]
    NoPoint { curve: usize, point: usize },
    /// References to edges that are neither none nor one a curve.
    #[error("{edges} references to edges for {curves} trim curves")]
    Edges { edges: usize, curves: usize },
    /// Degree 0, or above [`MAX_DEGREE`].
    #[error("trim curve {curve} has degree {degree}, which is not between 1 and {MAX_DEGREE}")]
    Degree { curve: usize, degree: usize },
}

/// The stored form of a [`TrimLoop`], before it is checked.
#[cfg(feature = "serde")]
#[derive(Deserialize)]
struct LoopData {
    curves: Vec<Vec<DVec3>>,
    edges: Vec<Option<EdgeRef>>,
}

/// Largest gap between the curves of a stored loop, relative to its coordinates: a loop that was run
/// backwards meets itself within the rounding of a division by the weight.
const STORED_GAP: f64 = 4.0 * f64::EPSILON;

#[cfg(feature = "serde")]
impl TryFrom<LoopData> for TrimLoop {
    type Error = FaceError;

    /// Keeps every bit, where [`TrimLoop::new`] would snap.
    fn try_from(data: LoopData) -> Result<Self, FaceError> {
        check_curves(&data.curves)?;
        for (curve, points) in data.curves.iter().enumerate() {
            let end = points[points.len() - 1].point();
            let start = data.curves[(curve + 1) % data.curves.len()][0].point();
            let gap = (end - start).abs();
            if (gap.cmpgt(STORED_GAP * end.abs().max(start.abs()))).any() {
                return Err(FaceError::OpenLoop { curve, gap: gap.max_element() });
            }
        }
        Self { curves: data.curves, edges: Vec::new() }.with_edges(data.edges)
    }
}

/// At least one curve, degrees within the limit, numbers that are numbers.
fn check_curves(curves: &[Vec<DVec3>]) -> Result<(), FaceError> {
    if curves.is_empty() {
        return Err(FaceError::EmptyLoop);
    }
    for (curve, points) in curves.iter().enumerate() {
        let degree = points.len().saturating_sub(1);
        if degree == 0 || degree > MAX_DEGREE {
            return Err(FaceError::Degree { curve, degree });
        }
        if points.iter().any(|p| !p.finite() || p.z <= 0.0) {
            return Err(FaceError::ControlPoint { curve });
        }
    }
    Ok(())
}

impl TrimLoop {
    /// Chains `curves`, snapping each start to the end before it when they are within `snap` (in
    /// `(u, v)` units, per coordinate).
    ///
    /// # Errors
    /// [`FaceError`] when the chain is empty, open by more than `snap`, or not made of numbers.
    pub fn new(curves: Vec<Bezier<DVec3>>, snap: DVec2) -> Result<Self, FaceError> {
        let mut curves: Vec<Vec<DVec3>> = curves.into_iter().map(|c| c.points).collect();
        check_curves(&curves)?;
        let count = curves.len();
        for curve in 0..count {
            let end = *curves[curve].last().expect("checked above");
            let start = &mut curves[(curve + 1) % count][0];
            let gap = (end.point() - start.point()).abs();
            if gap.x > snap.x || gap.y > snap.y {
                return Err(FaceError::OpenLoop { curve, gap: gap.max_element() });
            }
            *start = DVec3::from_point(end.point(), start.z);
        }
        Ok(Self { curves, edges: Vec::new() })
    }

    /// The loop with one reference to an edge a curve, in the order of the curves.
    ///
    /// # Errors
    /// [`FaceError::Edges`] when their number is another.
    pub fn with_edges(self, edges: Vec<Option<EdgeRef>>) -> Result<Self, FaceError> {
        if !edges.is_empty() && edges.len() != self.curves.len() {
            return Err(FaceError::Edges { edges: edges.len(), curves: self.curves.len() });
        }
        Ok(Self { edges, ..self })
    }

    /// The loop without references to edges.
    pub fn without_edges(self) -> Self {
        Self { edges: Vec::new(), ..self }
    }

    /// The edge of the source of which each curve is a piece: one entry a curve, or none at all where the source has no
    /// shared edges. `None` for curves without an edge: inserted seams and sides at poles.
    pub fn edges(&self) -> &[Option<EdgeRef>] {
        &self.edges
    }

    /// The curves in order.
    pub fn curves(&self) -> impl ExactSizeIterator<Item = Bezier<DVec3>> + '_ {
        self.curves.iter().map(|points| Bezier { points: points.clone() })
    }

    /// The homogeneous control points of each curve.
    pub(crate) fn control_points(&self) -> impl DoubleEndedIterator<Item = &[DVec3]> {
        self.curves.iter().map(Vec::as_slice)
    }

    /// The loop with one control point moved to `to` in `(u, v)`; its weight stays. The last one of a curve is
    /// the first of the next: both move.
    ///
    /// # Errors
    /// [`FaceError::NoPoint`], or [`FaceError::ControlPoint`] for a place that is not finite.
    pub fn with_point(&self, curve: usize, point: usize, to: DVec2) -> Result<Self, FaceError> {
        let mut curves = self.curves.clone();
        let count = curves.len();
        let moved = curves.get_mut(curve).and_then(|c| c.get_mut(point)).ok_or(FaceError::NoPoint { curve, point })?;
        *moved = DVec3::from_point(to, moved.z);
        // the start of a curve is made from the end before, as in `new`
        let end = if point == 0 { (curve + count - 1) % count } else { curve };
        if point == 0 || point + 1 == curves[curve].len() {
            let last = curves[end].last_mut().expect("curves have points");
            *last = DVec3::from_point(to, last.z);
            let joint = last.point();
            let start = &mut curves[(end + 1) % count][0];
            *start = DVec3::from_point(joint, start.z);
        }
        check_curves(&curves)?;
        Ok(Self { curves, edges: self.edges.clone() })
    }

    /// The loop moved by `step` in `(u, v)`.
    ///
    /// # Errors
    /// [`FaceError`] where the step is not finite.
    pub fn translated(&self, step: DVec2) -> Result<Self, FaceError> {
        let point = |p: &DVec3| DVec3::from_point(p.point() + step, p.z);
        let curves = self.curves.iter().map(|c| Bezier { points: c.iter().map(point).collect() }).collect();
        // two homogeneous forms of one point may round apart
        let (lo, hi) = self.bounds();
        Self::new(curves, STORED_GAP * (lo.abs().max(hi.abs()) + step.abs()))?.with_edges(self.edges.clone())
    }

    /// Twice the signed area of the control polygons' enclosed region: positive when the loop runs
    /// counter-clockwise. Exact for straight edges; the sign is right for every loop whose curves
    /// stay near their chords.
    pub fn signed_area(&self) -> f64 {
        const STEPS: usize = 16;
        let mut area = 0.0;
        for c in self.curves() {
            let steps = if c.degree() == 1 { 1 } else { STEPS };
            let mut before = c.point(0.0);
            for i in 1..=steps {
                let p = c.point(i as f64 / steps as f64);
                area += before.perp_dot(p);
                before = p;
            }
        }
        area
    }

    /// The loop run backwards.
    pub fn reversed(mut self) -> Self {
        self.curves.reverse();
        self.curves.iter_mut().for_each(|c| c.reverse());
        self.edges.reverse();
        self.edges.iter_mut().flatten().for_each(|e| e.forward = !e.forward);
        self
    }

    /// Box of the control points in `(u, v)`; it contains the loop.
    pub fn bounds(&self) -> (DVec2, DVec2) {
        let points = self.curves.iter().flatten().map(|p| p.point());
        points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)))
    }
}

impl Face {
    /// Box of the control points of the part of the surface that its loops can reach. It contains the trimmed face, and
    /// may be much larger than it: [`Face::bounds`] is tight.
    pub fn control_bounds(&self) -> Bounds {
        let (lo, hi) = self
            .loops
            .iter()
            .map(TrimLoop::bounds)
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), (a, b)| (lo.min(a), hi.max(b)));
        let grid = self.surface.patches();
        let mut bounds = Bounds::EMPTY;
        for p in &grid.patches {
            let clip = |range: (f64, f64), a: f64, b: f64| {
                let at = |x: f64| ((x - range.0) / (range.1 - range.0)).clamp(0.0, 1.0);
                (at(a), at(b))
            };
            let (u, v) = if self.loops.is_empty() {
                ((0.0, 1.0), (0.0, 1.0))
            } else {
                (clip(p.u, lo.x, hi.x), clip(p.v, lo.y, hi.y))
            };
            if u.1 > u.0 && v.1 > v.0 {
                let (min, max): (DVec3, DVec3) = p.patch.rectangle(u, v).bounds();
                bounds = bounds.with(min).with(max);
            }
        }
        bounds
    }
}
