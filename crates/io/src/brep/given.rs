//! Spline faces whose trim curves the source states in the spline's own parameters: they are used unchanged.
//!
//! ```text
//!   stated   ─────▶ ┆ ───▶        drawn   ─────▶──▶───▶        a straight piece where two do not meet
//! ```
//!
//! A curve deviates only where it misses the one before it by less than the tolerance: it is moved to begin where that
//! one ends.

use super::build::crossing_note;
use super::curve::segment;
use super::map::SurfaceMap;
use super::nest::depths;
use super::{BuildError, BuiltFace, CurveGeometry};
use crate::model::{Bounds, Face, SurfaceKind, TrimLoop};
use crate::spline::{Bezier, Control, Surface};
use glam::{DVec2, DVec3};

/// Share of the face's diagonal by which control points may lie outside the surface; they are moved to its border.
const OUTSIDE: f64 = 1e-5;

/// Share of a domain that a curve may be moved by to meet the one before it.
const NEAR: f64 = 1e-7;

/// Share of a domain within which points are the same: the rounding of weights multiplied in and divided out.
const ROUNDING: f64 = 1e-13;

/// Share of a period that a joint may span; a wider one is a way around the surface.
const AROUND: f64 = 0.25;

/// Share of the face's diagonal by which a loop may be open, as for loops of edges.
const OPEN: f64 = 0.05;

/// A loop.
struct Joined {
    curves: Vec<Bezier<DVec3>>,
    /// By how much, mm, a control point left the surface.
    outside: f64,
    /// By how much, mm, a curve was moved to meet the one before it.
    moved: f64,
}

/// The face of a spline whose loops are curves in its own `(u, v)`, in any order and direction; `map` is the
/// spline's, `tolerance` in mm.
///
/// Curves keep their image and their parametrisation. [`BuiltFace::deviation`] is how far a curve was moved to meet the
/// one before it: by no more than the tolerance. Wider gaps, up to a twentieth of the face, are closed by straight
/// pieces, with a note. [`BuiltFace::gap`] is how far control points lay outside the surface: `1e-5` of the face's
/// diagonal at most. They are moved to its border, so no curve moves farther.
///
/// # Errors
/// [`BuildError`] where curves leave the domain, run around a closed surface, or bound nothing. Their images in space
/// may still bound a face.
pub fn face_in_parameters(
    id: u32,
    (surface, map): (&Surface, &SurfaceMap),
    loops: &[Vec<CurveGeometry>],
    tolerance: f64,
) -> Result<BuiltFace, BuildError> {
    let tolerance = if tolerance > 0.0 && tolerance.is_finite() { tolerance } else { 1e-6 };
    let (mut notes, mut trims, mut deviation, mut gap) = (Vec::new(), Vec::new(), 0.0_f64, 0.0_f64);
    let range = range(surface);
    let all: Vec<Joined> = loops.iter().map(|l| inside(id, (surface, map), l)).collect::<Result<_, _>>()?;
    let corners = all.iter().flat_map(|l| &l.curves).map(|c| map.jet(c.points[0].point()).point);
    let size = corners.fold(Bounds::EMPTY, Bounds::with).diagonal();
    for mut joined in all {
        if joined.outside > OUTSIDE * size {
            return Err(BuildError::Surface { face: id, reason: "a curve in (u, v) leaves the surface" });
        }
        let open = joined.close((id, size), map, (range, tolerance))?;
        if open > 50.0 * tolerance.clamp(1e-9 * size, 1e-5 * size) {
            notes.push(format!("face #{id}: a gap of {open:.3e} mm between edges was closed"));
        }
        (deviation, gap) = (deviation.max(joined.moved), gap.max(joined.outside));
        let trim =
            TrimLoop::new(joined.curves, ROUNDING * range).map_err(|source| BuildError::Loop { face: id, source })?;
        if trim.signed_area().abs() <= 1e-12 * range.x * range.y {
            return Err(BuildError::NoArea { face: id });
        }
        trims.push(trim);
    }
    let polygons: Vec<Vec<DVec2>> = if trims.len() > 1 { trims.iter().map(polygon).collect() } else { Vec::new() };
    let depths = if polygons.is_empty() { vec![0; trims.len()] } else { depths(&polygons) };
    let oriented = |(trim, depth): (TrimLoop, usize)| {
        if (trim.signed_area() > 0.0) == depth.is_multiple_of(2) { trim } else { trim.reversed() }
    };
    let loops: Vec<TrimLoop> = trims.into_iter().zip(depths).map(oriented).collect();
    notes.extend(crossing_note(&loops).map(|note| format!("face #{id}: {note}")));
    let (kind, surface) = (SurfaceKind::BSpline, surface.clone());
    let face = Face { id, kind, surface, loops, same_sense: true, colour: None };
    Ok(BuiltFace { face, notes, deviation, gap, lost: Vec::new() })
}

fn range(surface: &Surface) -> DVec2 {
    let (u, v) = surface.domain();
    DVec2::new(u.1 - u.0, v.1 - v.0)
}

/// The curves of a loop as rational Bézier pieces within the domain; curves that are a point are left out.
fn inside(id: u32, (surface, map): (&Surface, &SurfaceMap), curves: &[CurveGeometry]) -> Result<Joined, BuildError> {
    let (u, v) = surface.domain();
    let (lo, hi) = (DVec2::new(u.0, v.0), DVec2::new(u.1, v.1));
    let mut out = Joined { curves: Vec::new(), outside: 0.0, moved: 0.0 };
    for curve in curves {
        for piece in segment(curve, 0.0).map_err(|reason| BuildError::Surface { face: id, reason })? {
            let mut points: Vec<DVec3> = piece.points.iter().map(|p| DVec3::new(p.x, p.y, p.w)).collect();
            for p in &mut points {
                let (at, kept) = (p.point(), p.point().clamp(lo, hi));
                if at != kept {
                    let off = length(map, kept, at - kept);
                    out.outside = if off.is_nan() { f64::INFINITY } else { out.outside.max(off) };
                    *p = DVec3::from_point(kept, p.z);
                }
            }
            if points.iter().any(|p| p.point() != points[0].point()) {
                out.curves.push(Bezier { points });
            }
        }
    }
    Ok(out)
}

/// Length in mm of a short step in `(u, v)`, at most.
fn length(map: &SurfaceMap, at: DVec2, step: DVec2) -> f64 {
    let jet = map.jet(at);
    jet.du.length() * step.x.abs() + jet.dv.length() * step.y.abs()
}

impl Joined {
    /// Makes each curve begin where the one before it ends. Returns the widest gap in mm that needed a straight piece.
    fn close(
        &mut self,
        (face, size): (u32, f64),
        map: &SurfaceMap,
        (range, tolerance): (DVec2, f64),
    ) -> Result<f64, BuildError> {
        let (mut widest, mut out) = (0.0_f64, Vec::<Bezier<DVec3>>::new());
        let count = self.curves.len();
        if count == 0 {
            return Err(BuildError::EmptyLoop { face });
        }
        let end = |c: &Bezier<DVec3>| c.points[c.degree()].point();
        for k in 0..count {
            let (from, to) = (end(&self.curves[k]), self.curves[(k + 1) % count].points[0].point());
            out.push(self.curves[k].clone());
            if from == to {
                continue;
            }
            let step = to - from;
            if (0..2).any(|i| map.natural_period(i).is_some_and(|period| step[i].abs() > AROUND * period)) {
                return Err(BuildError::OpenRim { face });
            }
            let (short, apart) = (length(map, from, step), map.jet(from).point.distance(map.jet(to).point));
            if short <= tolerance && step.abs().cmple(NEAR * range).all() {
                self.moved = self.moved.max(short);
                let next = &mut self.curves[(k + 1) % count].points[0];
                *next = DVec3::from_point(from, next.z);
                if k + 1 == count {
                    out[0].points[0] = *next;
                }
                continue;
            }
            if apart > OPEN * size {
                return Err(BuildError::OpenLoop { face, edge: face, gap: apart });
            }
            widest = widest.max(apart);
            out.push(Bezier::line(from, to));
        }
        self.curves = out;
        Ok(widest)
    }
}

/// A closed polygon close to the loop.
fn polygon(trim: &TrimLoop) -> Vec<DVec2> {
    const STEPS: usize = 12;
    let inside = |c: Bezier<DVec3>| {
        let steps = if c.degree() == 1 { 1 } else { STEPS };
        (0..steps).map(move |i| c.point(i as f64 / steps as f64))
    };
    let mut points: Vec<DVec2> = trim.curves().flat_map(inside).collect();
    points.extend(points.first().copied());
    points
}
