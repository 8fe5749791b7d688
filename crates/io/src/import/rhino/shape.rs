//! Curves and surfaces of an archive as splines, in millimetres.
//!
//! ```text
//!   spline, line, arc, polyline, chain of curves    ──▶  BSpline          arcs and turned surfaces are exact, but in
//!   spline, plane, turned, sum of two curves        ──▶  Surface, Map     another parameter than the angle: a Map
//! ```

use super::archive::{Class, Lost, Reader};
use super::joined;
use crate::model::SurfaceKind;
use crate::spline::arc::{arc, assemble, pieces, revolve};
use crate::spline::{BSpline, Bezier, Control, Span, Surface};
use glam::{DVec2, DVec3, DVec4};
use std::f64::consts::{FRAC_PI_2, TAU};

/// First bytes of the classes' ids.
const NURBS_CURVE: u32 = 0x4ED7_D4DD;
const LINE: u32 = 0x4ED7_D4DB;
const ARC: u32 = 0xCF33_BE2A;
const POLYLINE: u32 = 0x4ED7_D4E6;
const POLYCURVE: u32 = 0x4ED7_D4E0;
const NURBS_SURFACE: u32 = 0x4ED7_D4DE;
const PLANE: u32 = 0x4ED7_D4DF;
const REVOLUTION: u32 = 0xA162_20D3;
const SUM: u32 = 0xC4CD_5359;

/// The id that openNURBS gives to a class; older archives and Rhino's modeller use other ids for some classes.
fn known(id: u32) -> u32 {
    match id {
        0x5EAF_1119 | 0x76A7_09D5 => NURBS_CURVE,
        0xEF63_8317 => POLYCURVE,
        0x4760_C817 | 0xFA4F_D4B5 => NURBS_SURFACE,
        0x0A84_01B6 => REVOLUTION,
        0x665F_6331 => SUM,
        same => same,
    }
}

/// Share of a length that is rounding.
const ROUNDING: f64 = 1e-9;

/// A curve over `[start, end]` of its parameter, `(x, y, z)` as stated; all of it without a range.
pub(super) fn curve(class: Class<'_>, range: Option<[f64; 2]>) -> Lost<BSpline<DVec4>> {
    let mut r = class.data;
    if r.version()?.0 != 1 {
        return Err("a curve of a later version".to_owned());
    }
    match known(class.id) {
        NURBS_CURVE => part(&nurbs_curve(&mut r)?, range),
        LINE => {
            let ends = [r.point()?, r.point()?];
            part(&polyline(&ends, &r.pair()?)?, range)
        }
        POLYLINE => {
            let points = (0..r.count(24)?).map(|_| r.point()).collect::<Lost<Vec<_>>>()?;
            part(&polyline(&points, &r.numbers()?)?, range)
        }
        ARC => circular(&mut r, range),
        POLYCURVE => polycurve(&mut r, range),
        other => Err(format!("a curve of class {other:08X}")),
    }
}

fn failed(error: crate::spline::SplineError) -> String {
    error.to_string()
}

/// `Vec` of knots as splines have them: the archive leaves out the first and last.
fn knots(mut stated: Vec<f64>) -> Lost<Vec<f64>> {
    let (Some(first), Some(last)) = (stated.first().copied(), stated.last().copied()) else {
        return Err("a spline without knots".to_owned());
    };
    stated.insert(0, first);
    stated.push(last);
    Ok(stated)
}

/// Dimension and weights of a spline, checked.
fn layout(r: &mut Reader<'_>) -> Lost<(usize, bool)> {
    let (dimension, rational) = (r.int()?, r.int()? != 0);
    match dimension {
        2 | 3 => Ok((dimension as usize, rational)),
        _ => Err(format!("a spline in {dimension} dimensions")),
    }
}

fn control(r: &mut Reader<'_>, (dimension, rational): (usize, bool)) -> Lost<DVec4> {
    let (x, y) = (r.number()?, r.number()?);
    let z = if dimension == 3 { r.number()? } else { 0.0 };
    let w = if rational { r.number()? } else { 1.0 };
    Ok(DVec4::new(x, y, z, w))
}

fn degree(order: i32) -> Lost<usize> {
    usize::try_from(order - 1).ok().filter(|d| *d > 0).ok_or_else(|| format!("a spline of order {order}"))
}

fn nurbs_curve(r: &mut Reader<'_>) -> Lost<BSpline<DVec4>> {
    let layout = layout(r)?;
    let degree = degree(r.int()?)?;
    r.skip(4 + 8 + 48)?;
    let knots = knots(r.numbers()?)?;
    let points = (0..r.count(16)?).map(|_| control(r, layout)).collect::<Lost<Vec<_>>>()?;
    // where it is torn by rounding, the earlier end counts
    let pieces = BSpline::pieces(degree, knots, points).map_err(failed)?;
    match &pieces[..] {
        [whole] => Ok(whole.clone()),
        torn => {
            let (degree, knots, points) = assemble(&torn.iter().flat_map(BSpline::beziers).collect::<Vec<_>>());
            BSpline::new(degree, knots, points).map_err(failed)
        }
    }
}

fn polyline(points: &[DVec3], at: &[f64]) -> Lost<BSpline<DVec4>> {
    BSpline::new(1, knots(at.to_vec())?, points.iter().map(|p| p.extend(1.0)).collect()).map_err(failed)
}

/// The part of a curve over a range.
fn part(curve: &BSpline<DVec4>, range: Option<[f64; 2]>) -> Lost<BSpline<DVec4>> {
    let Some([a, b]) = range.filter(|r| (r[0], r[1]) != curve.domain()) else { return Ok(curve.clone()) };
    let (low, high) = curve.domain();
    let reach = ROUNDING * (high - low);
    if !(a < b && a >= low - reach && b <= high + reach) {
        return Err(format!("a part from {a} to {b} of a curve from {low} to {high}"));
    }
    let spans = curve.beziers_between(a.max(low), b.min(high));
    if spans.is_empty() {
        return Err("a part without length of a curve".to_owned());
    }
    let (degree, knots, points) = assemble(&spans);
    BSpline::new(degree, knots, points).map_err(failed)
}

/// Quarter by quarter. Knots are at the parameters where the quarters end; the parameter is linear in the angle.
fn circular(r: &mut Reader<'_>, range: Option<[f64; 2]>) -> Lost<BSpline<DVec4>> {
    let (centre, x, y) = (r.point()?, r.point()?, r.point()?);
    r.skip(24 + 32)?;
    let radius = r.number()?;
    r.skip(72)?;
    let ([from, to], [start, end]) = (r.pair()?, r.pair()?);
    let turn = (to - from) / (end - start);
    let [a, b] = range.unwrap_or([start, end]);
    if !(turn > 0.0 && turn.is_finite() && a < b && to - from <= TAU * (1.0 + ROUNDING)) {
        return Err("an arc without length".to_owned());
    }
    let at = |angle: f64| start + (angle - from) / turn;
    let [low, high] = [a, b].map(|t| from + (t - start) * turn);
    let angles = pieces(low, high, FRAC_PI_2);
    let quarter =
        |k: &[f64]| Span { start: at(k[0]), end: at(k[1]), piece: arc(centre, x * radius, y * radius, k[0], k[1]) };
    let (degree, knots, points) = assemble(&angles.windows(2).map(quarter).collect::<Vec<_>>());
    BSpline::new(degree, knots, points).map_err(failed)
}

/// Segments end to end, each stretched to its part of the whole's parameter.
fn polycurve(r: &mut Reader<'_>, range: Option<[f64; 2]>) -> Lost<BSpline<DVec4>> {
    let count = r.count(1)?;
    r.skip(8 + 48)?;
    let at = r.numbers()?;
    if at.len() != count + 1 || count == 0 {
        return Err(format!("{count} curves in a row over {} parameters", at.len()));
    }
    let [a, b] = range.unwrap_or([at[0], at[count]]);
    let mut spans: Vec<Span<Bezier<DVec4>>> = Vec::new();
    for k in at.windows(2) {
        let class = r.class()?;
        let whole = curve(class, None)?;
        let (low, high) = whole.domain();
        let (from, to) = (a.max(k[0]), b.min(k[1]));
        let reach = ROUNDING * (at[count] - at[0]);
        if from > to - reach {
            continue;
        }
        let own = |t: f64| if t == k[1] { high } else { low + (t - k[0]) / (k[1] - k[0]) * (high - low) };
        let stretched = |t: f64| k[0] + (t - low) / (high - low) * (k[1] - k[0]);
        let parts = whole.beziers_between(own(from), own(to)).into_iter();
        spans.extend(parts.map(|s| Span { start: stretched(s.start), end: stretched(s.end), piece: s.piece }));
    }
    if spans.is_empty() {
        return Err("a row of curves without length".to_owned());
    }
    let (degree, knots, points) = assemble(&spans);
    BSpline::new(degree, knots, points).map_err(failed)
}

/// How a surface's own parameters become those of its spline.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Map {
    Same,
    /// Along `u` or `v` the surface's parameter is an angle; the spline's knots are the ends of its pieces.
    Angle {
        along_v: bool,
        from: [f64; 2],
        angles: Vec<f64>,
    },
}

/// A surface as a spline.
pub(super) struct Carrier {
    pub surface: Surface,
    pub kind: SurfaceKind,
    pub map: Map,
}

/// A surface, lengths times `scale`.
pub(super) fn surface(class: Class<'_>, scale: f64) -> Lost<Carrier> {
    let mut r = class.data;
    let (major, minor) = r.version()?;
    let large = |p: DVec4| (p.truncate() * scale).extend(p.w);
    match (known(class.id), major) {
        (NURBS_SURFACE, 1) => {
            let layout = layout(&mut r)?;
            let degrees = (degree(r.int()?)?, degree(r.int()?)?);
            let counts = (r.count(8)?, r.count(8)?);
            r.skip(8 + 48)?;
            let (u, v) = (knots(r.numbers()?)?, knots(r.numbers()?)?);
            let total = r.count(16)?;
            if counts.0.checked_mul(counts.1) != Some(total) {
                return Err(format!("{total} control points of {} by {}", counts.0, counts.1));
            }
            // stored column by column
            let stored = (0..total).map(|_| control(&mut r, layout).map(large)).collect::<Lost<Vec<_>>>()?;
            let net = (0..counts.1).flat_map(|j| (0..counts.0).map(move |i| i * counts.1 + j)).map(|k| stored[k]);
            let surface = joined::surface(degrees, (u, v), net.collect()).map_err(failed)?;
            Ok(Carrier { surface, kind: SurfaceKind::BSpline, map: Map::Same })
        }
        (PLANE, 1) => {
            let (o, x, y) = (r.point()?, r.point()?, r.point()?);
            r.skip(24 + 32)?;
            let (u, v) = (r.pair()?, r.pair()?);
            let (p, q) = if minor >= 1 { (r.pair()?, r.pair()?) } else { (u, v) };
            let at = |a: f64, b: f64| large((o + x * a + y * b).extend(1.0));
            let net = vec![at(p[0], q[0]), at(p[1], q[0]), at(p[0], q[1]), at(p[1], q[1])];
            let knots = |d: [f64; 2]| vec![d[0], d[0], d[1], d[1]];
            let surface = Surface::new((1, 1), knots(u), knots(v), net).map_err(failed)?;
            Ok(Carrier { surface, kind: SurfaceKind::Plane, map: Map::Same })
        }
        (SUM, 1) => {
            let base = r.point()?;
            r.skip(48)?;
            let (first, second) = (curve(r.class()?, None)?, curve(r.class()?, None)?);
            let sum = |b: &DVec4, a: &DVec4| {
                let p = a.truncate() * b.w + b.truncate() * a.w + base * (a.w * b.w);
                large(p.extend(a.w * b.w))
            };
            let net = second.points().iter().flat_map(|b| first.points().iter().map(move |a| sum(b, a)));
            let (u, v) = (first.knots().to_vec(), second.knots().to_vec());
            let surface = Surface::new((first.degree(), second.degree()), u, v, net.collect()).map_err(failed)?;
            Ok(Carrier { surface, kind: SurfaceKind::BSpline, map: Map::Same })
        }
        (REVOLUTION, 1 | 2) => turned(r, major, scale),
        (other, _) => Err(format!("a surface of class {other:08X}, version {major}")),
    }
}

fn turned(mut r: Reader<'_>, major: u8, scale: f64) -> Lost<Carrier> {
    let (from, to, angle) = (r.point()?, r.point()?, r.pair()?);
    let stated = if major == 2 { r.pair()? } else { angle };
    r.skip(48)?;
    let transposed = r.int()? != 0;
    if r.byte()? == 0 {
        return Err("a turned surface without its curve".to_owned());
    }
    let profile = curve(r.class()?, None)?;
    let axis = (to - from).try_normalize().ok_or("a turned surface without axis")?;
    if !(angle[0] < angle[1] && angle[1] - angle[0] <= TAU * (1.0 + ROUNDING) && stated[0] < stated[1]) {
        return Err("a turned surface without angle".to_owned());
    }
    let angles = pieces(angle[0], angle[1], FRAC_PI_2);
    let points: Vec<DVec4> = profile.points().iter().map(|p| (p.truncate() * scale).extend(p.w)).collect();
    let profile = (profile.degree(), profile.knots().to_vec(), &points[..]);
    let surface = revolve(profile, (from * scale, axis), &angles).map_err(failed)?;
    let surface = if transposed { surface.transposed() } else { surface };
    Ok(Carrier {
        surface,
        kind: SurfaceKind::Revolution,
        map: Map::Angle { along_v: transposed, from: stated, angles },
    })
}

impl Map {
    /// Where a point in the surface's own parameters is in those of its spline.
    fn point(&self, p: DVec2) -> DVec2 {
        let Self::Angle { along_v, from, angles } = self else { return p };
        let own = if *along_v { p.y } else { p.x };
        let (first, last) = (angles[0], angles[angles.len() - 1]);
        let angle = first + (own - from[0]) / (from[1] - from[0]) * (last - first);
        let k = angles.windows(2).position(|k| angle <= k[1]).unwrap_or(angles.len() - 2);
        let (middle, half) = (0.5 * (angles[k] + angles[k + 1]), 0.5 * (angles[k + 1] - angles[k]));
        // on an arc with weights 1, cos h, 1 the tangent of half the angle is linear in the parameter
        let share = (0.5 * (angle - middle)).tan() / (0.5 * half).tan();
        let t = middle + half * share.clamp(-1.0, 1.0);
        if *along_v { DVec2::new(p.x, t) } else { DVec2::new(t, p.y) }
    }

    /// A curve in the surface's own parameters in those of its spline.
    ///
    /// Lines at one angle, and along the angle, stay lines, exactly. Other curves become chords, `EACH` a piece.
    pub fn curve(&self, curve: &BSpline<DVec4>) -> Lost<BSpline<DVec3>> {
        const EACH: u32 = 64;
        let flat = |p: &DVec4| DVec3::new(p.x, p.y, p.w);
        if *self == Self::Same {
            let points = curve.points().iter().map(flat).collect();
            return BSpline::new(curve.degree(), curve.knots().to_vec(), points).map_err(failed);
        }
        let ends: Vec<DVec2> = curve.points().iter().map(|p| flat(p).point()).collect();
        let (low, high) = ends.iter().fold((ends[0], ends[0]), |(l, h), p| (l.min(*p), h.max(*p)));
        let straight = (high - low).min_element() <= ROUNDING * (high - low).max_element();
        let spans = curve.beziers();
        let steps = if straight && curve.degree() == 1 { 1 } else { EACH };
        let mut at: Vec<(f64, DVec2)> = Vec::new();
        for s in &spans {
            let first = u32::from(!at.is_empty());
            at.extend((first..=steps).map(|k| {
                let x = f64::from(k) / f64::from(steps);
                let p = s.piece.point(x);
                (s.start + (s.end - s.start) * x, self.point(DVec2::new(p.x, p.y)))
            }));
        }
        let knots = knots(at.iter().map(|(t, _)| *t).collect())?;
        let points = at.iter().map(|(_, p)| DVec3::from_point(*p, 1.0)).collect();
        BSpline::new(1, knots, points).map_err(failed)
    }
}
