//! Trimmed and bounded surfaces: 144 with 142, 143 with 141.
//!
//! ```text
//!   C(t) in space ───────────────┐                    both given: they should be the same curve
//!   B(t) in (u, v) ──S──▶ S(B(t))┴──▶ edges ──▶ brep
//! ```
//!
//! The two faces that meet along a curve in space share it, a curve in `(u, v)` they do not. So where both are there, C
//! is used. B is used instead
//!
//! * where there is no C;
//! * where the file prefers B, and the surface lies farther than the file's resolution from C;
//! * where C is farther off than a thousandth of the face, or makes no face, whatever the file prefers.
//!
//! S(B(t)) is fitted to `1e-10` of its box; the rest is the same for both.

use super::curve::Segment;
use super::entity::{Entity, Fault};
use super::fit::fit;
use super::geometry::Geometry;
use super::surface::Carrier;
use crate::brep::{Boundary, BuildError, BuiltFace, CurveGeometry, Edge, FaceGeometry, SurfaceGeometry, SurfaceMap};
use crate::brep::{build_face, face_in_parameters};
use crate::model::{Bounds, TrimLoop};
use glam::{DAffine2, DAffine3, DVec2, DVec3};

/// A surface and its bounds.
#[derive(Clone, Debug)]
pub(super) struct Sheet {
    /// The entity.
    pub id: u32,
    pub carrier: Carrier,
    pub loops: Vec<Trim>,
    /// The border of the surface itself bounds it, too.
    pub natural: bool,
}

/// One loop, in space or in the file's parameters or both.
#[derive(Clone, Debug, Default)]
pub(super) struct Trim {
    pub model: Vec<Segment>,
    pub parameter: Vec<Segment>,
    /// The file prefers the curves in the parameters.
    pub prefers_parameter: bool,
}

/// Share of the face's size: a curve in space farther than this from the surface is replaced by its curve in the
/// parameters.
const FAR: f64 = 1e-3;

impl<'a> Geometry<'a> {
    /// 143, 144, or a surface as a face.
    pub fn sheet(&self, id: u32, outer: &DAffine3) -> Result<Sheet, Fault> {
        let entity = Entity::find(self.file, id)?;
        if entity.kind() == 108 {
            // a plane by itself has a curve around it
            let model = closed(self.segments(entity.pointer(5)?, &self.placed(entity, outer)?)?);
            let loops = vec![Trim { model, ..Trim::default() }];
            return Ok(Sheet { id, carrier: self.surface(id, outer)?, loops, natural: false });
        }
        if !matches!(entity.kind(), 143 | 144) {
            return Ok(Sheet { id, carrier: self.surface(id, outer)?.bounded(id)?, loops: Vec::new(), natural: true });
        }
        self.nested(id, |entity| {
            let map = self.placed(entity, outer)?;
            if entity.kind() == 143 {
                let bounds = 4..4 + entity.count(3, 1)?;
                let loops = bounds.map(|i| self.boundary(entity.pointer(i)?, &map)).collect::<Result<Vec<_>, _>>()?;
                let carrier = self.surface_near(entity.pointer(2)?, &map, &ends(&loops))?;
                return Ok(Sheet { id, carrier, natural: loops.is_empty(), loops });
            }
            let outer_loop = entity.integer(2)? != 0;
            let mut loops = Vec::new();
            if outer_loop {
                loops.push(self.curve_on_surface(entity.pointer(4)?, &map)?);
            }
            for index in 5..5 + entity.count(3, 1)? {
                loops.push(self.curve_on_surface(entity.pointer(index)?, &map)?);
            }
            let carrier = self.surface_near(entity.pointer(1)?, &map, &ends(&loops))?;
            let carrier = if outer_loop { carrier } else { carrier.bounded(id)? };
            Ok(Sheet { id, carrier, loops, natural: !outer_loop })
        })
    }

    /// 142.
    fn curve_on_surface(&self, id: u32, outer: &DAffine3) -> Result<Trim, Fault> {
        self.nested(id, |entity| {
            let entity = entity.of_kind(142, "142, a curve on a surface")?;
            let map = self.placed(entity, outer)?;
            let parameter = entity.optional(3)?.map(|b| self.segments(b, &DAffine3::IDENTITY).map(closed));
            let model = entity.optional(4)?.map(|c| self.segments(c, &map).map(closed));
            let prefers_parameter = entity.integer(5)? == 1;
            self.either(id, model, parameter, prefers_parameter)
        })
    }

    /// 141: curves in space, each with its curves in the parameters.
    fn boundary(&self, id: u32, outer: &DAffine3) -> Result<Trim, Fault> {
        self.nested(id, |entity| {
            let entity = entity.of_kind(141, "141, a boundary")?;
            let map = self.placed(entity, outer)?;
            let prefers_parameter = entity.integer(2)? == 2;
            let mut trim = Trim { prefers_parameter, ..Trim::default() };
            let mut in_parameters = true;
            let mut at = 5;
            for _ in 0..entity.count(4, 3)? {
                let model = self.segments(entity.pointer(at)?, &map)?;
                if entity.integer(at + 1)? == 2 {
                    trim.model.extend(model.into_iter().rev().map(Segment::reversed));
                } else {
                    trim.model.extend(model);
                }
                let count = entity.count(at + 2, 1)?;
                in_parameters &= count > 0;
                for index in at + 3..at + 3 + count {
                    trim.parameter.extend(self.segments(entity.pointer(index)?, &DAffine3::IDENTITY)?);
                }
                at += 3 + count;
            }
            if !in_parameters {
                trim.parameter.clear();
            }
            Ok(Trim { model: closed(trim.model), parameter: closed(trim.parameter), ..trim })
        })
    }

    /// Tries one description of a loop, then the other: one may be damaged.
    fn either(
        &self,
        id: u32,
        model: Option<Result<Vec<Segment>, Fault>>,
        parameter: Option<Result<Vec<Segment>, Fault>>,
        prefers_parameter: bool,
    ) -> Result<Trim, Fault> {
        let trim = |model, parameter| Ok(Trim { model, parameter, prefers_parameter });
        match (model, parameter) {
            (None, None) => Err(Fault::Value { id, what: "neither of its two curves is there" }),
            (Some(model), None) => trim(model?, Vec::new()),
            (None, Some(parameter)) => trim(Vec::new(), parameter?),
            (Some(Ok(model)), Some(Ok(parameter))) => trim(model, parameter),
            (Some(Err(fault)), Some(Ok(parameter))) => {
                self.note("one of two trim curves ignored", id, fault.to_string());
                trim(Vec::new(), parameter)
            }
            (Some(model), Some(Err(fault))) => {
                let model = model?;
                self.note("one of two trim curves ignored", id, fault.to_string());
                trim(model, Vec::new())
            }
        }
    }
}

impl Trim {
    /// Largest distance in mm between ends of pieces of the two curves, `|S(B) - C|`, and of C from the surface in
    /// between; 0 where the pieces do not correspond.
    fn apart(&self, map: &SurfaceMap, to_native: &DAffine2) -> f64 {
        if self.model.len() != self.parameter.len() {
            return 0.0;
        }
        let lifted = |p: DVec3| map.jet(to_native.transform_point2(p.truncate())).point;
        let apart = |(c, b): (&Segment, &Segment)| {
            let (p, q) = (c.ends(), b.ends());
            let ends = lifted(q.0).distance(p.0).max(lifted(q.1).distance(p.1));
            let at = |s: &Segment, f: f64| s.point(s.start + (s.end - s.start) * f);
            let off = |f: f64| map.distance(at(c, f), to_native.transform_point2(at(b, f).truncate()));
            [0.25, 0.5, 0.75].map(off).into_iter().fold(ends, f64::max)
        };
        self.model.iter().zip(&self.parameter).map(apart).fold(0.0, f64::max)
    }
}

impl Sheet {
    /// The face, drawn along the better curves; `tolerance` in mm.
    ///
    /// # Errors
    /// [`BuildError`] of the last attempt.
    pub fn build(&self, tolerance: f64) -> Result<BuiltFace, BuildError> {
        let map = SurfaceMap::new(&self.carrier.surface, 1e-3 * tolerance.max(1e-9));
        let map = map.map_err(|reason| BuildError::Surface { face: self.id, reason })?;
        let both = self.loops.iter().any(|l| !l.model.is_empty() && !l.parameter.is_empty());
        let Some(to_native) = self.carrier.to_native.filter(|_| both) else {
            return self.attempt(&map, tolerance, false);
        };
        let points = self.loops.iter().flat_map(|l| &l.model).flat_map(|s| s.samples(4));
        let size = points.fold(Bounds::EMPTY, Bounds::with).diagonal();
        let prefers = self.loops.iter().any(|l| l.prefers_parameter);
        let limit = if prefers { tolerance.max(1e-7 * size) } else { FAR * size };
        let id = self.id;
        let replaced = |mut face: BuiltFace, by: f64| {
            face.notes.push(format!("face #{id}: curves in space lie {by:.3e} mm off, those in (u, v) are used"));
            face
        };
        if prefers {
            // no attempt is needed to see this
            let by = self.loops.iter().map(|l| l.apart(&map, &to_native)).fold(0.0, f64::max);
            if by > limit {
                let first = self.attempt(&map, tolerance, true).map(|face| replaced(face, by));
                return first.or_else(|_| self.attempt(&map, tolerance, false));
            }
        }
        let first = self.attempt(&map, tolerance, false);
        // a file that prefers B means the surface's points, so C may be as far from them as a fitted curve
        let off = |f: &BuiltFace| if prefers { f.deviation.max(f.gap) } else { f.deviation };
        if first.as_ref().is_ok_and(|f| off(f) <= limit) {
            return first;
        }
        match (first, self.attempt(&map, tolerance, true)) {
            (Ok(first), Ok(second)) if off(&second) < off(&first) => Ok(replaced(second, off(&first))),
            (Err(error), Ok(mut second)) => {
                second.notes.push(format!("face #{id}: curves in (u, v) are used, for with those in space: {error}"));
                Ok(second)
            }
            (first, _) => first,
        }
    }

    /// The face along the curves in space, or along the curves in the parameters where there are any.
    fn attempt(&self, map: &SurfaceMap, tolerance: f64, in_parameters: bool) -> Result<BuiltFace, BuildError> {
        if let Some(face) = self.given(map, tolerance, in_parameters) {
            return Ok(face);
        }
        let mut edges = Vec::new();
        let mut bounds = Vec::new();
        for trim in &self.loops {
            let segments: Vec<Segment> = if trim.model.is_empty() || (in_parameters && !trim.parameter.is_empty()) {
                let reason = "its parameters in the file are not those of a curve on it";
                let to_native = self.carrier.to_native.ok_or(BuildError::Surface { face: self.id, reason })?;
                trim.parameter.iter().filter_map(|s| lift(map, &to_native, s)).collect()
            } else {
                trim.model.clone()
            };
            // the border of a closed surface is its seams, there and back: it bounds nothing
            if map.is_closed() && retraces(&segments) {
                continue;
            }
            let from = edges.len();
            edges.extend(segments.iter().map(Segment::edge));
            let mut uses: Vec<(usize, bool)> = (from..edges.len()).map(|i| (i, true)).collect();
            if self.carrier.flipped {
                uses.reverse();
                uses.iter_mut().for_each(|u| u.1 = false);
            }
            bounds.push(Boundary::Edges(uses));
        }
        if self.natural {
            bounds.extend(self.border(map, &mut edges)?);
        }
        let face = FaceGeometry {
            id: self.id,
            surface: self.carrier.surface.clone(),
            bounds,
            same_sense: !self.carrier.flipped,
            ambiguous: false,
        };
        let mut built = build_face(&face, &edges, tolerance)?;
        // its edges are its own: no other face can share them
        built.face.loops = built.face.loops.into_iter().map(TrimLoop::without_edges).collect();
        Ok(built)
    }

    /// The face along the curves in the parameters, where these are the parameters of its spline and the curves bound
    /// it unchanged.
    fn given(&self, map: &SurfaceMap, tolerance: f64, in_parameters: bool) -> Option<BuiltFace> {
        let SurfaceGeometry::BSpline(surface) = &self.carrier.surface else { return None };
        let own = self.carrier.to_native == Some(DAffine2::IDENTITY) && !self.natural && !map.is_closed();
        let taken = |l: &Trim| !l.parameter.is_empty() && (in_parameters || l.model.is_empty());
        if !own || self.loops.is_empty() || !self.loops.iter().all(taken) {
            return None;
        }
        let loops = self.loops.iter().map(|l| l.parameter.iter().map(Segment::trimmed).collect()).collect::<Vec<_>>();
        face_in_parameters(self.id, (surface, map), &loops, tolerance).ok()
    }

    /// The border of the surface; `None` where it is a whole spline or closed anyway.
    fn border(&self, map: &SurfaceMap, edges: &mut Vec<Edge>) -> Result<Option<Boundary>, BuildError> {
        let [(u0, u1), (v0, v1)] = match self.carrier.natural {
            Some(natural) => natural,
            None if map.is_closed() => return Ok(None),
            None => return Err(BuildError::Unbounded { face: self.id }),
        };
        let covers = |(a, b): (f64, f64), whole: Option<(f64, f64)>| {
            whole.is_some_and(|(lo, hi)| (b - a) >= (hi - lo) * (1.0 - 1e-9))
        };
        let [u, v] = map.natural();
        let spline = matches!(self.carrier.surface, SurfaceGeometry::BSpline(_));
        if covers((u0, u1), u) && covers((v0, v1), v) && (map.is_closed() || (spline && self.loops.is_empty())) {
            return Ok(None);
        }
        let corners = [DVec2::new(u0, v0), DVec2::new(u1, v0), DVec2::new(u1, v1), DVec2::new(u0, v1)];
        let from = edges.len();
        for i in 0..4 {
            let (a, b) = (corners[i], corners[(i + 1) % 4]);
            let curve = CurveGeometry::Line { origin: a.extend(0.0), direction: (b - a).extend(0.0) };
            let side = Segment { id: self.id, curve, start: 0.0, end: 1.0 };
            edges.extend(lift(map, &DAffine2::IDENTITY, &side).map(|s| s.edge()));
        }
        Ok(Some(Boundary::Edges((from..edges.len()).map(|i| (i, true)).collect())))
    }
}

/// The ends of the curves in space: points on the surface.
fn ends(loops: &[Trim]) -> Vec<DVec3> {
    loops.iter().flat_map(|l| &l.model).flat_map(|s| <[DVec3; 2]>::from(s.ends())).collect()
}

/// Angle up to which an arc that is a loop by itself is a whole turn: its ends are as far apart as those of a loop may be.
const TURN: f64 = 0.1;

/// The segments of a loop; a single arc whose ends nearly meet is a whole turn.
fn closed(mut segments: Vec<Segment>) -> Vec<Segment> {
    if let [only] = &mut segments[..]
        && matches!(only.curve, CurveGeometry::Circle { .. } | CurveGeometry::Ellipse { .. })
        && only.end - only.start <= TURN
    {
        only.end = only.start + std::f64::consts::TAU;
    }
    segments
}

/// Parameters at which a curve crosses the creases of a surface, to rounding.
fn creases(map: &SurfaceMap, at: impl Fn(f64) -> DVec2, breaks: &[f64]) -> Vec<f64> {
    const STEPS: usize = 8;
    let mut out = Vec::new();
    for w in breaks.windows(2) {
        for k in 0..STEPS {
            let step = |k: usize| w[0] + (w[1] - w[0]) * k as f64 / STEPS as f64;
            let (a, b) = (step(k), step(k + 1));
            let (p, q) = (at(a), at(b));
            for axis in 0..2 {
                // a hair wider, for a crease that a step meets
                let hair = 1e-9 * (q[axis] - p[axis]).abs();
                let (least, most) = (p[axis].min(q[axis]) - hair, p[axis].max(q[axis]) + hair);
                if most <= least {
                    continue;
                }
                for value in map.creases(axis, least, most) {
                    let (mut low, mut high) = (a, b);
                    for _ in 0..60 {
                        let middle = 0.5 * (low + high);
                        if (at(middle)[axis] < value) == (p[axis] < q[axis]) { low = middle } else { high = middle }
                    }
                    out.push(0.5 * (low + high));
                }
            }
        }
    }
    out
}

/// Each segment comes again in the opposite direction.
fn retraces(segments: &[Segment]) -> bool {
    let marks: Vec<[DVec3; 3]> =
        segments.iter().map(|s| [s.start, 0.5 * (s.start + s.end), s.end].map(|t| s.point(t))).collect();
    let size = marks.iter().flatten().copied().fold(Bounds::EMPTY, Bounds::with).diagonal();
    let same = |p: DVec3, q: DVec3| p.distance(q) <= 1e-6 * size;
    let pairs = |a: &[DVec3; 3], b: &[DVec3; 3]| same(a[0], b[2]) && same(a[1], b[1]) && same(a[2], b[0]);
    // seams are few; a long loop is none
    segments.len().is_multiple_of(2)
        && segments.len() <= 64
        && (0..marks.len()).all(|i| (0..marks.len()).any(|j| j != i && pairs(&marks[i], &marks[j])))
}

/// A curve in the parameters as one in space; `None` where it is a point.
fn lift(map: &SurfaceMap, to_native: &DAffine2, segment: &Segment) -> Option<Segment> {
    let at = |t: f64| map.jet(to_native.transform_point2(segment.point(t).truncate())).point;
    let (a, b) = (segment.start, segment.end);
    let inside: Vec<f64> = match &segment.curve {
        CurveGeometry::BSpline(c) => c.knots().to_vec(),
        CurveGeometry::Line { .. } => Vec::new(),
        _ => (1..8).map(|i| a + (b - a) * f64::from(i) / 8.0).collect(),
    };
    let mut breaks: Vec<f64> = inside.into_iter().filter(|t| *t > a && *t < b).chain([a, b]).collect();
    breaks.sort_by(f64::total_cmp);
    let native = |t: f64| to_native.transform_point2(segment.point(t).truncate());
    breaks.extend(creases(map, native, &breaks));
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|y, x| *y - *x <= 1e-12 * (b - a));
    let spline = fit(at, &breaks)?;
    let first = spline.points()[0].truncate();
    let apart = |p: &DVec3| p.distance(first);
    let size = spline.points().iter().map(|p| apart(&p.truncate())).fold(0.0, f64::max);
    let rounding = 1e-12 * first.length();
    (size > rounding).then(|| Segment { curve: CurveGeometry::BSpline(spline), ..segment.clone() })
}
