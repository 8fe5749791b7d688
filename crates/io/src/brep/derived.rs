//! Curves and surfaces derived from other ones: offsets, and curves on surfaces.
//!
//! ```text
//!   offset surface   S + d n         of an extrusion or revolution: its profile moved, then swept again,
//!                                    because n turns and shifts with it; of a spline: fitted
//!   offset curve     C + d (V × T)   fitted
//!   curve on surface S(c(t))         fitted
//! ```
//!
//! Fits keep the parametrisation and come with their largest error in mm. They aim at a hundredth of the tolerance,
//! clamped to between `1e-9` and `1e-7` of the size. V is the fixed direction of the offset curve, T and n are unit
//! tangent and normal.
//!
//! Source: ISO 10303-42, 4.4.44 (offset_curve_3d) and 4.5.23 (offset_surface).

use super::curve::Curve;
use super::support::{Form, Support};
use super::{CurveGeometry, SurfaceGeometry, approximate};
use glam::{DVec2, DVec3};

/// Largest error of a fit, as a part of the size, that is still a shape.
const USELESS: f64 = 1e-3;

/// The surface at `distance` mm along the normal `S_u × S_v` of an extrusion, a revolution or a spline, and
/// the largest error in mm.
///
/// # Errors
/// Why there is none.
pub fn offset_surface(
    basis: &SurfaceGeometry,
    distance: f64,
    tolerance: f64,
) -> Result<(SurfaceGeometry, f64), &'static str> {
    if let SurfaceGeometry::Window { basis, u, v } = basis {
        let (inner, error) = offset_surface(basis, distance, tolerance)?;
        return Ok((SurfaceGeometry::Window { basis: Box::new(inner), u: *u, v: *v }, error));
    }
    let support = Support::new(basis, tolerance)?;
    let at = |p: DVec2| {
        let jet = support.jet(p);
        jet.point + normal(&support, p) * distance
    };
    match (basis, &support.form) {
        (SurfaceGeometry::Extrusion { direction, .. }, Form::Extrusion { profile, .. }) => {
            let (profile, error) = moved_profile(profile, tolerance, &|t| at(DVec2::new(t, 0.0)))?;
            Ok((SurfaceGeometry::Extrusion { profile, direction: *direction }, error))
        }
        (SurfaceGeometry::Revolution { origin, axis, .. }, Form::Revolution { profile }) => {
            let (profile, error) = moved_profile(profile, tolerance, &|t| at(DVec2::new(0.0, t)))?;
            Ok((SurfaceGeometry::Revolution { profile, origin: *origin, axis: *axis }, error))
        }
        (_, Form::Spline(s)) => {
            let (lo, hi) = s.surface.bounds();
            let size = lo.distance(hi) + distance.abs();
            let (ku, kv) = s.surface.knots();
            let (us, vs) = (breaks(ku, s.domain[0]), breaks(kv, s.domain[1]));
            let fit = approximate::surface(&|u, v| at(DVec2::new(u, v)), us, vs, target(tolerance, size));
            let (surface, error) = fit.filter(|f| f.1 <= USELESS * size).ok_or("its offset is not smooth")?;
            Ok((SurfaceGeometry::BSpline(surface), error))
        }
        _ => Err("an offset of this surface is not supported"),
    }
}

/// The stated side is wrong if edges are farther off than this share of the distance, and this share of that on the
/// other side.
const WRONG: f64 = 0.1;

/// The surface made by `offset` at `distance`, mm. Where `edges`, points of its borders, lie at the same distance on
/// the other side of its basis and not here, the surface on that side: files state wrong normals and indicators more
/// often than wrong edges. The last value is true for the other side.
///
/// # Errors
/// Those of `offset` at `distance`.
pub fn on_its_side<T, E>(
    offset: impl Fn(f64) -> Result<T, E>,
    surface: impl Fn(&T) -> &SurfaceGeometry,
    (distance, tolerance): (f64, f64),
    edges: &[DVec3],
) -> Result<(T, bool), E> {
    let stated = offset(distance)?;
    let away = |t: &T| {
        Support::new(surface(t), tolerance)
            .ok()
            .map(|s| edges.iter().map(|p| s.nearest(*p, None, 0.0).1).fold(0.0, f64::max))
    };
    let off = away(&stated).unwrap_or(0.0);
    if off > tolerance.max(WRONG * distance.abs())
        && let Ok(other) = offset(-distance)
        && away(&other).is_some_and(|a| a <= WRONG * off)
    {
        return Ok((other, true));
    }
    Ok((stated, false))
}

/// The curve at `distance` mm along `reference × T`, and the largest error in mm.
///
/// # Errors
/// Why there is none.
pub fn offset_curve(
    basis: &CurveGeometry,
    distance: f64,
    reference: DVec3,
    tolerance: f64,
) -> Result<(CurveGeometry, f64), &'static str> {
    if let CurveGeometry::Trimmed { basis, start, end, forward } = basis {
        let (inner, error) = offset_curve(basis, distance, reference, tolerance)?;
        let (start, end, forward) = (*start, *end, *forward);
        return Ok((CurveGeometry::Trimmed { basis: Box::new(inner), start, end, forward }, error));
    }
    let curve = Curve::new(basis, tolerance)?;
    let at = |t: f64| {
        let (p, d) = curve.jet(t);
        p + reference.cross(d).normalize() * distance
    };
    let (profile, error) = moved_profile(&curve, tolerance, &at)?;
    Ok((*profile, error))
}

/// The curve `surface(uv(t))` over `range`, and the largest error in mm; `knots` are where `uv` is less
/// smooth. Parameters are native: radians and mm.
///
/// # Errors
/// Why there is none.
pub fn curve_on_surface(
    surface: &SurfaceGeometry,
    uv: &dyn Fn(f64) -> DVec2,
    knots: &[f64],
    range: (f64, f64),
    tolerance: f64,
) -> Result<(CurveGeometry, f64), &'static str> {
    let support = Support::new(surface, tolerance)?;
    fitted(&|t| support.point(uv(t)), &breaks(knots, range), tolerance)
}

/// A profile moved by the offset: exact for a line that moves sideways, else fitted.
fn moved_profile(
    profile: &Curve,
    tolerance: f64,
    at: &dyn Fn(f64) -> DVec3,
) -> Result<(Box<CurveGeometry>, f64), &'static str> {
    if let Curve::Line { direction, .. } = profile {
        let (a, b) = (at(0.0), at(1.0));
        let straight = (b - a).distance(*direction) <= 1e-9 * direction.length();
        let line = CurveGeometry::Line { origin: a, direction: *direction };
        return if straight { Ok((Box::new(line), 0.0)) } else { Err("its offset is not straight") };
    }
    let range = profile.domain().ok_or("its profile has no ends")?;
    let knots = match profile {
        Curve::Pieces(p) => p.spans.iter().map(|s| s.start).collect(),
        // quarter turns: a quintic is good to 1e-5 over one of them
        _ => (1..4).map(|i| range.0 + (range.1 - range.0) * f64::from(i) / 4.0).collect::<Vec<f64>>(),
    };
    fitted(at, &breaks(&knots, range), tolerance).map(|(curve, error)| (Box::new(curve), error))
}

fn fitted(f: &dyn Fn(f64) -> DVec3, breaks: &[f64], tolerance: f64) -> Result<(CurveGeometry, f64), &'static str> {
    let size = breaks.iter().map(|t| f(*t)).chain([f(0.5 * (breaks[0] + breaks[1]))]);
    let size = size.fold(crate::model::Bounds::EMPTY, crate::model::Bounds::with).diagonal();
    let fit = approximate::curve(f, breaks, target(tolerance, size));
    let (curve, error) = fit.filter(|f| f.1 <= USELESS * size).ok_or("it is not smooth")?;
    Ok((CurveGeometry::BSpline(curve), error))
}

fn target(tolerance: f64, size: f64) -> f64 {
    (1e-2 * tolerance).clamp(1e-9 * size, 1e-7 * size)
}

/// Ends of the range and the distinct knots between them.
fn breaks(knots: &[f64], (a, b): (f64, f64)) -> Vec<f64> {
    let margin = 1e-9 * (b - a);
    let inside = knots.iter().copied().filter(|k| *k > a + margin && *k < b - margin);
    let mut all: Vec<f64> = std::iter::once(a).chain(inside).chain([b]).collect();
    all.sort_by(f64::total_cmp);
    all.dedup_by(|y, x| *y - *x <= margin);
    all
}

/// Unit normal; at a pole the one a little inside.
fn normal(support: &Support, p: DVec2) -> DVec3 {
    let of = |p: DVec2| {
        let jet = support.jet(p);
        let n = jet.du.cross(jet.dv);
        let tiny = 1e-9 * (jet.du.length() * jet.dv.length()).max(f64::MIN_POSITIVE);
        (n.length() > tiny).then(|| n.normalize())
    };
    let inside = || {
        let middle = |i: usize| support.natural[i].map_or(p[i], |(a, b)| 0.5 * (a + b));
        of(p.lerp(DVec2::new(middle(0), middle(1)), 1e-6))
    };
    of(p).or_else(inside).unwrap_or(DVec3::NAN)
}
