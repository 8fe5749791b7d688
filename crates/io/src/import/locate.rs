//! Points at parameters and parameters of points on curves, for trimming.

use crate::brep::{CurveGeometry, Frame};
use crate::math::golden::section;
use crate::spline::BSpline;
use glam::{DVec3, DVec4};

/// Point at parameter `t`; `None` for composites, whose parameters no trimming here uses.
pub(super) fn point(curve: &CurveGeometry, t: f64) -> Option<DVec3> {
    use CurveGeometry as C;
    Some(match curve {
        C::Line { origin, direction } => *origin + *direction * t,
        C::Circle { frame, radius } => frame.origin + (frame.x * t.cos() + frame.y * t.sin()) * *radius,
        C::Ellipse { frame, semi_x, semi_y } => {
            frame.origin + frame.x * (semi_x * t.cos()) + frame.y * (semi_y * t.sin())
        }
        C::Hyperbola { frame, semi_x, semi_y } => {
            frame.origin + frame.x * (semi_x * t.cosh()) + frame.y * (semi_y * t.sinh())
        }
        C::Parabola { frame, focal } => frame.origin + frame.x * (focal * t * t) + frame.y * (2.0 * focal * t),
        C::BSpline(spline) => spline.point(t),
        C::Trimmed { basis, .. } => point(basis, t)?,
        C::Composite(_) => return None,
    })
}

/// First and last point in the direction of the curve; a whole circle or ellipse starts at 0.
pub(super) fn ends(curve: &CurveGeometry) -> Option<(DVec3, DVec3)> {
    match curve {
        CurveGeometry::Trimmed { basis, start, end, forward } => {
            let (a, b) = (point(basis, *start)?, point(basis, *end)?);
            Some(if *forward { (a, b) } else { (b, a) })
        }
        CurveGeometry::BSpline(spline) => {
            let (a, b) = spline.domain();
            Some((spline.point(a), spline.point(b)))
        }
        CurveGeometry::Circle { .. } | CurveGeometry::Ellipse { .. } => {
            let start = point(curve, 0.0)?;
            Some((start, start))
        }
        CurveGeometry::Composite(parts) => Some((ends(parts.first()?)?.0, ends(parts.last()?)?.1)),
        _ => None,
    }
}

/// The part of `basis` from parameter `first` to `last`, run in that direction; `None` when it is empty.
pub(super) fn piece(basis: CurveGeometry, first: f64, last: f64) -> Option<CurveGeometry> {
    if first < last {
        return Some(CurveGeometry::Trimmed { basis: Box::new(basis), start: first, end: last, forward: true });
    }
    let (turned, sum) = turned(basis)?;
    (last < first).then(|| piece(turned, sum - first, sum - last)).flatten()
}

/// The curve with its parameter turned round, `t` becoming `sum - t`.
pub(super) fn turned(curve: CurveGeometry) -> Option<(CurveGeometry, f64)> {
    use CurveGeometry as C;
    // half a turn about x takes every conic to itself, y to -y, t to -t
    let flip = |f: Frame| Frame { y: -f.y, z: -f.z, ..f };
    Some(match curve {
        C::Line { origin, direction } => (C::Line { origin, direction: -direction }, 0.0),
        C::Circle { frame, radius } => (C::Circle { frame: flip(frame), radius }, 0.0),
        C::Ellipse { frame, semi_x, semi_y } => (C::Ellipse { frame: flip(frame), semi_x, semi_y }, 0.0),
        C::Hyperbola { frame, semi_x, semi_y } => (C::Hyperbola { frame: flip(frame), semi_x, semi_y }, 0.0),
        C::Parabola { frame, focal } => (C::Parabola { frame: flip(frame), focal }, 0.0),
        C::BSpline(spline) => {
            let (a, b) = spline.domain();
            (C::BSpline(spline.reversed()), a + b)
        }
        C::Trimmed { basis, start, end, forward } => {
            let (basis, sum) = turned(*basis)?;
            (C::Trimmed { basis: Box::new(basis), start: sum - end, end: sum - start, forward }, sum)
        }
        C::Composite(_) => return None,
    })
}

/// The same curve run backwards; `None` for a composite with an unbounded segment.
pub(super) fn reversed(curve: CurveGeometry) -> Option<CurveGeometry> {
    match curve {
        CurveGeometry::Composite(parts) => {
            parts.into_iter().rev().map(reversed).collect::<Option<_>>().map(CurveGeometry::Composite)
        }
        curve => turned(curve).map(|(curve, _)| curve),
    }
}

/// Parameter of the point of the curve next to `p`. Exact inversion for points on the curve, except for
/// B-splines, where it is found to about 1e-12 of the domain.
pub(super) fn parameter(curve: &CurveGeometry, p: DVec3) -> Option<f64> {
    use CurveGeometry as C;
    let t = match curve {
        C::Line { origin, direction } => (p - *origin).dot(*direction) / direction.length_squared(),
        C::Circle { frame, .. } => {
            let d = p - frame.origin;
            d.dot(frame.y).atan2(d.dot(frame.x))
        }
        C::Ellipse { frame, semi_x, semi_y } => {
            let d = p - frame.origin;
            (d.dot(frame.y) / semi_y).atan2(d.dot(frame.x) / semi_x)
        }
        C::Hyperbola { frame, semi_y, .. } => ((p - frame.origin).dot(frame.y) / semi_y).asinh(),
        C::Parabola { frame, focal } => (p - frame.origin).dot(frame.y) / (2.0 * focal),
        C::BSpline(spline) => nearest(spline, p),
        C::Trimmed { basis, .. } => parameter(basis, p)?,
        C::Composite(_) => return None,
    };
    t.is_finite().then_some(t)
}

/// Parameter of the point nearest to `p`: of a few samples a span, then by golden section between its neighbours.
pub(super) fn nearest(spline: &BSpline<DVec4>, p: DVec3) -> f64 {
    const SAMPLES: usize = 16;
    const STEPS: usize = 60; // 0.618^60 < 1e-12
    let distance = |t: f64| (spline.point(t) - p).length_squared();
    let (a, b) = spline.domain();
    let spans = (spline.points().len() - spline.degree()).min(256);
    let count = spans * SAMPLES;
    let at = |i: usize| a + (b - a) * i as f64 / count as f64;
    let best = (0..=count).min_by(|&i, &j| distance(at(i)).total_cmp(&distance(at(j)))).unwrap_or(0);
    let [c, d] = section((at(best.saturating_sub(1)), at((best + 1).min(count))), STEPS, distance);
    let t = 0.5 * (c + d);
    // ends are what trimming names most often: keep them exact
    let candidates = [a, b, t];
    candidates.into_iter().min_by(|s, t| distance(*s).total_cmp(&distance(*t))).unwrap_or(t)
}
