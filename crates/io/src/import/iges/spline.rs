//! Spline curves and surfaces: 126 and 128 unchanged, 112 and 114 from power to Bézier form.
//!
//! ```text
//!   112, 114: a piece over [0, h] of  A + B s + C s² + D s³
//!     control points   A,  A + B h/3,  A + 2 B h/3 + C h²/3,  A + B h + C h² + D h³
//! ```
//!
//! Knots between pieces are as multiple as the degree; the last point of a piece is not stored, since the first point
//! of the next is the same.

use super::curve::Segment;
use super::entity::{Entity, Fault};
use super::geometry::Geometry;
use crate::brep::CurveGeometry;
use crate::spline::{BSpline, Surface};
use glam::{DAffine3, DVec3, DVec4};

impl<'a> Geometry<'a> {
    /// 126.
    pub(super) fn bspline_curve(&self, entity: Entity<'a>, map: &DAffine3) -> Result<Segment, Fault> {
        let id = entity.id();
        let (last, degree) = (entity.count(1, 4)?, entity.count(2, 1)?);
        let (points, knots) = (last + 1, last + degree + 2);
        let knots = (entity.reals(7, knots)?, 7 + knots);
        let net = control_points(entity, knots.1, points, map)?;
        let end = knots.1 + 4 * points;
        let spline = BSpline::new(degree, knots.0, net).map_err(|source| Fault::Spline { id, source })?;
        let (a, b) = spline.domain();
        let (start, end) = range(entity, end, (a, b))?;
        Ok(Segment { id, curve: CurveGeometry::BSpline(spline), start, end })
    }

    /// 128, and its range where that is not the whole.
    pub(super) fn bspline_surface(
        &self,
        entity: Entity<'a>,
        map: &DAffine3,
    ) -> Result<(Surface, [(f64, f64); 2]), Fault> {
        let id = entity.id();
        let (nu, nv) = (entity.count(1, 1)? + 1, entity.count(2, 1)? + 1);
        let (du, dv) = (entity.count(3, 1)?, entity.count(4, 1)?);
        let knots_u = entity.reals(10, nu + du + 1)?;
        let at = 10 + nu + du + 1;
        let knots_v = entity.reals(at, nv + dv + 1)?;
        let at = at + nv + dv + 1;
        // `u` runs fastest in the file as well
        let points = control_points(entity, at, nu.saturating_mul(nv), map)?;
        let surface =
            Surface::new((du, dv), knots_u, knots_v, points).map_err(|source| Fault::Spline { id, source })?;
        let (u, v) = surface.domain();
        let end = at + 4 * nu * nv;
        Ok((surface, [range(entity, end, u)?, range(entity, end + 2, v)?]))
    }

    /// 112.
    pub(super) fn parametric_curve(&self, entity: Entity<'a>, map: &DAffine3) -> Result<Segment, Fault> {
        let id = entity.id();
        let pieces = entity.count(4, 13)?;
        let breaks = entity.reals(5, pieces + 1)?;
        let coefficients = entity.reals(6 + pieces, 12 * pieces)?;
        let mut points: Vec<DVec4> = Vec::with_capacity(3 * pieces + 1);
        for (c, t) in coefficients.chunks_exact(12).zip(breaks.windows(2)) {
            let power = [0, 1, 2, 3].map(|k| DVec3::new(c[k], c[4 + k], c[8 + k]));
            points.truncate(points.len().saturating_sub(1));
            points.extend(bezier(power, t[1] - t[0]).map(|p| map.transform_point3(p).extend(1.0)));
        }
        let spline = BSpline::new(3, joined(&breaks), points).map_err(|source| Fault::Spline { id, source })?;
        let (start, end) = spline.domain();
        Ok(Segment { id, curve: CurveGeometry::BSpline(spline), start, end })
    }

    /// 114.
    pub(super) fn parametric_surface(&self, entity: Entity<'a>, map: &DAffine3) -> Result<Surface, Fault> {
        let id = entity.id();
        let (nu, nv) = (entity.count(3, 1)?, entity.count(4, 1)?);
        let (tu, tv) = (entity.reals(5, nu + 1)?, entity.reals(6 + nu, nv + 1)?);
        let first = 7 + nu + nv;
        let given = (entity.len() + 1).saturating_sub(first) / 48;
        if nu == 0 || nv == 0 || nu.saturating_mul(nv) > given {
            return Err(Fault::Parameter { id, index: entity.len() + 1, wanted: "there, the record is too short" });
        }
        // each row of patches along v ends with 48 unused numbers; some writers leave them out
        let stride = if nu * (nv + 1) <= given { nv + 1 } else { nv };
        let (width, height) = (3 * nu + 1, 3 * nv + 1);
        let mut points = vec![DVec4::ZERO; width * height];
        for i in 0..nu {
            for j in 0..nv {
                let c = entity.reals(first + 48 * (i * stride + j), 48)?;
                // along u first: four cubics in s, one a power of t
                let along_u = [0, 1, 2, 3].map(|t| {
                    let power = [0, 1, 2, 3].map(|s| DVec3::new(c[4 * t + s], c[16 + 4 * t + s], c[32 + 4 * t + s]));
                    bezier(power, tu[i + 1] - tu[i])
                });
                for s in 0..4 {
                    let along_v = bezier([0, 1, 2, 3].map(|t| along_u[t][s]), tv[j + 1] - tv[j]);
                    for (t, p) in along_v.into_iter().enumerate() {
                        points[(3 * j + t) * width + 3 * i + s] = map.transform_point3(p).extend(1.0);
                    }
                }
            }
        }
        Surface::new((3, 3), joined(&tu), joined(&tv), points).map_err(|source| Fault::Spline { id, source })
    }
}

/// Control points of a cubic over `[0, h]` given by its powers.
fn bezier([a, b, c, d]: [DVec3; 4], h: f64) -> [DVec3; 4] {
    let (b, c, d) = (b * h, c * (h * h), d * (h * h * h));
    [a, a + b / 3.0, a + (b * 2.0 + c) / 3.0, a + b + c + d]
}

/// Knots of cubic pieces that only meet.
fn joined(breaks: &[f64]) -> Vec<f64> {
    let ends = breaks.first().into_iter().chain(breaks.last());
    let mut knots: Vec<f64> = breaks.iter().flat_map(|t| [*t; 3]).chain(ends.copied()).collect();
    knots.sort_by(f64::total_cmp);
    knots
}

/// Weights, then points; homogeneous and placed.
fn control_points(entity: Entity<'_>, at: usize, count: usize, map: &DAffine3) -> Result<Vec<DVec4>, Fault> {
    let numbers = entity.reals(at, count.saturating_mul(4))?;
    let (weights, points) = numbers.split_at(count);
    let placed = points.chunks_exact(3).map(|p| map.transform_point3(DVec3::new(p[0], p[1], p[2])));
    Ok(placed.zip(weights).map(|(p, w)| (p * *w).extend(*w)).collect())
}

/// The stated range, inside the domain; the whole domain when it is missing.
fn range(entity: Entity<'_>, at: usize, (a, b): (f64, f64)) -> Result<(f64, f64), Fault> {
    if entity.len() < at + 1 {
        return Ok((a, b));
    }
    let (from, to) = (entity.real(at)?, entity.real(at + 1)?);
    let near = |x: f64, end: f64| if (x - end).abs() <= 1e-9 * (b - a) { end } else { x.clamp(a, b) };
    let (from, to) = (near(from, a), near(to, b));
    Ok(if from < to { (from, to) } else { (a, b) })
}
