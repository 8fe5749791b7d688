//! Closed solids from walls that close around `u`: plane caps, trimmed by the walls' own ends.
//!
//! ```text
//!        ___                 cap at the end of v: a plane in lengths of its own, its outer loop the end of the
//!      ╱ ___ ╲               first wall, its holes the ends of the others
//!     ( (   ) )
//!     │╲ ‾‾‾ ╱│              walls: one face each; a wall that closes along v too, or ends in poles, has no caps
//!     │  ‾‾‾  │
//!      ╲ ___ ╱
//! ```

use super::ConstructError;
use super::compat::apart;
use super::solid::{crossings, outline};
use crate::model::{Face, Part, SurfaceKind, TrimLoop};
use crate::spline::{BSpline, Control, Surface};
use glam::{DVec2, DVec3, DVec4};

/// Share of the size by which ends may miss each other or their plane.
const SNAP: f64 = 1e-9;

/// The solid between the first wall and the others, which are its holes from end to end. Exact: the caps' loops
/// have the control points of the walls' ends.
///
/// A wall's ends may be points (poles), or meet each other. Crossings of ends with themselves and each other are
/// searched between chords, 16 in each of their Bézier pieces. Crossings of walls between their ends are not searched.
///
/// # Errors
/// No wall; a wall whose `u` does not close; an end that is not in one plane, or not in that of the first wall, that
/// crosses itself or another.
pub fn capped_solid(walls: &[Surface]) -> Result<Part, ConstructError> {
    let Some(outer) = walls.first() else {
        return Err(ConstructError::TooFew { what: "walls of a solid", got: 0, needed: 1 });
    };
    let (low, high) = outer.bounds();
    let reach = SNAP * low.distance(high);
    let mut part = Part { closed: true, ..Part::default() };
    let mut ends: [Vec<End>; 2] = [Vec::new(), Vec::new()];
    for (k, wall) in walls.iter().enumerate() {
        let turned = wall.transposed();
        let open = apart(&side(&turned, false)?, &side(&turned, true)?);
        if open > reach {
            return Err(ConstructError::Open { what: "a wall, around u,", gap: open });
        }
        let (first, last) = (side(wall, false)?, side(wall, true)?);
        let closed = apart(&first, &last) <= reach;
        // towards the inside of the wall's stretch, at the start; away from it, at the end
        let columns = turned.rows().into_iter().map(|c| c.clamped());
        let along = columns.map(|c| {
            let p = c.points();
            (p[1].point() - p[0].point(), p[p.len() - 1].point() - p[p.len() - 2].point())
        });
        let (inward, onward) = along.fold((DVec3::ZERO, DVec3::ZERO), |(a, b), (p, q)| (a + p, b + q));
        let (start, end) = (End::new(first, inward, reach)?, End::new(last, onward, reach)?);
        // rows that run counter-clockwise about the direction of `v` have S_u x S_v outwards
        let out = match (&start, &end) {
            (Some(e), _) | (None, Some(e)) => e.ahead,
            (None, None) => wall_points_out(wall),
        };
        part.add(SurfaceKind::BSpline, wall.clone(), Vec::new(), out == (k == 0));
        if !closed {
            ends[0].extend(start);
            ends[1].extend(end);
        }
    }
    for (of, at_end) in ends.iter().zip([false, true]) {
        let Some(first) = of.first() else { continue };
        let (surface, loops) = first.cap(&of[1..], reach)?;
        part.add(SurfaceKind::Plane, surface, loops, first.ahead == at_end);
    }
    Ok(part)
}

impl Part {
    /// Adds a face to a made part, and numbers it.
    pub(super) fn add(&mut self, kind: SurfaceKind, surface: Surface, loops: Vec<TrimLoop>, same_sense: bool) {
        let id = self.faces.len() as u32 + 1;
        self.faces.push(Face { id, kind, surface, loops, same_sense, colour: None });
    }
}

/// The curve at the first or last `v`.
fn side(surface: &Surface, last: bool) -> Result<BSpline<DVec4>, ConstructError> {
    let columns = surface.transposed().rows();
    let at = if last { surface.domain().1.1 } else { surface.domain().1.0 };
    let points = columns.iter().map(|c| c.homogeneous(at)).collect();
    Ok(BSpline::new(surface.degrees().0, surface.knots().0.to_vec(), points)?)
}

/// Of a wall without ends: the sign of the volume inside, by the midpoints of its patches.
fn wall_points_out(wall: &Surface) -> bool {
    let (low, high) = wall.bounds();
    let centre = 0.5 * (low + high);
    let flux = |p: &crate::spline::SurfacePatch| {
        let jets = (0..16).map(|k| p.patch.jet(f64::from(k % 4) / 4.0 + 0.125, f64::from(k / 4) / 4.0 + 0.125));
        jets.map(|j| (j.point - centre).dot(j.du.cross(j.dv))).sum::<f64>()
    };
    wall.patches().patches.iter().map(flux).sum::<f64>() > 0.0
}

/// A planar end of a wall.
struct End {
    curve: BSpline<DVec4>,
    /// Unit normal: the curve runs counter-clockwise about it.
    normal: DVec3,
    /// The normal points the way `v` runs.
    ahead: bool,
}

impl End {
    /// `None` when the curve is a point.
    fn new(curve: BSpline<DVec4>, along: DVec3, reach: f64) -> Result<Option<Self>, ConstructError> {
        let points: Vec<DVec3> = curve.points().iter().map(|p| p.point()).collect();
        let first = points[0];
        if points.iter().all(|p| p.distance(first) <= reach) {
            return Ok(None);
        }
        let arms: Vec<DVec3> = points.iter().map(|p| *p - first).collect();
        let area: DVec3 = arms.windows(2).map(|w| w[0].cross(w[1])).sum();
        let long = |a: DVec3, b: DVec3| if b.length_squared() > a.length_squared() { b } else { a };
        let longest = arms.iter().copied().fold(DVec3::ZERO, long);
        // the halves of an eight cancel: its plane is that of its points
        let widest = arms.iter().map(|p| longest.cross(*p)).fold(DVec3::ZERO, long);
        let flat = area.length() <= SNAP * widest.length();
        let Some(normal) =
            if flat { widest } else { area }.try_normalize().filter(|_| widest.length() > reach * longest.length())
        else {
            return Err(ConstructError::ZeroLength { what: "the end of a wall, seen along its axis," });
        };
        Ok(Some(Self { curve, normal, ahead: normal.dot(along) > 0.0 }))
    }

    /// The plane and its loops: this end's, and the `holes`.
    fn cap(&self, holes: &[Self], reach: f64) -> Result<(Surface, Vec<TrimLoop>), ConstructError> {
        let origin = self.curve.points()[0].point();
        let x = self.normal.any_orthonormal_vector();
        let y = self.normal.cross(x);
        let (mut loops, mut outlines) = (Vec::new(), Vec::new());
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for (k, end) in [self].into_iter().chain(holes).enumerate() {
            let arm = |p: &DVec4| p.truncate() - origin * p.w;
            let off = end.curve.points().iter().map(|p| (arm(p).dot(self.normal) / p.w).abs()).fold(0.0, f64::max);
            if off > reach {
                return Err(ConstructError::NotPlanar { what: "the end of a wall", gap: off });
            }
            let flat = |p: &DVec4| DVec3::new(arm(p).dot(x), arm(p).dot(y), p.w);
            let points: Vec<DVec3> = end.curve.points().iter().map(flat).collect();
            for p in points.iter().map(|p| p.point()) {
                (low, high) = (low.min(p), high.max(p));
            }
            let flat = BSpline::new(end.curve.degree(), end.curve.knots().to_vec(), points)?;
            outlines.push(outline(std::slice::from_ref(&flat)));
            let pieces = flat.beziers().into_iter().map(|s| s.piece).collect();
            let trim = TrimLoop::new(pieces, DVec2::splat(reach))?;
            let outwards = trim.signed_area() > 0.0;
            loops.push(if outwards == (k == 0) { trim } else { trim.reversed() });
        }
        crossings("the end of a wall (by its chords)", &outlines)?;
        let corner = |u: f64, v: f64| (origin + x * u + y * v).extend(1.0);
        let net = vec![corner(low.x, low.y), corner(high.x, low.y), corner(low.x, high.y), corner(high.x, high.y)];
        let knots = |a: f64, b: f64| vec![a, a, b, b];
        Ok((Surface::new((1, 1), knots(low.x, high.x), knots(low.y, high.y), net)?, loops))
    }
}
