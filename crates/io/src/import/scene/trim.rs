//! Loops: closed chains of curves that bound a face in its `(u, v)`, or the profile of a solid.
//!
//! ```text
//!   loops = ["rim"]                                  one closed curve
//!   loops = [["arc", "chord"]]                       several curves end to end
//!   loops = [{ curves = ["star"], at = [2, 1] }]     placed in the plane
//!   loops = [{ curves = ["star"], along = [0, 0, -1] }]     in space, cast on the surface
//!   border = true                                    the edge of the surface's domain, too
//! ```
//!
//! The face is the part inside an odd number of loops.

use super::curve::{self, Curve, planar};
use super::items::Scene;
use super::place;
use super::surface::Made;
use super::text::{Fault, Outcome, Table, Value};
use crate::brep::crossing_note;
use crate::construct::{Chain, project, trim_loops};
use crate::spline::arc::assemble;
use crate::spline::{BSpline, Bezier, Span, Surface};
use glam::{DVec2, DVec3};

/// Most Bézier pieces in all loops of a face or a profile: every chord is compared with its neighbours.
const MOST_PIECES: usize = 1 << 12;
/// Angle between tangents, radians, above which a joint is a corner.
const CORNER: f64 = 1e-6;
/// Share of a domain by which loops may leave it: rounding.
const OUTSIDE: f64 = 1e-9;

/// One loop as stated.
struct Written<'a> {
    value: Value<'a>,
    names: Vec<Value<'a>>,
    curves: Vec<Curve>,
    along: Option<Value<'a>>,
}

/// The loops under `loops`.
fn written<'a>(scene: &mut Scene<'a>, value: Value<'a>) -> Outcome<Vec<Written<'a>>> {
    let mut all = Vec::new();
    let mut pieces = 0;
    for value in value.some()? {
        let (names, by, along) = if value.is_table() {
            let mut table = value.table()?;
            let names = table.need("curves")?.names()?;
            let (by, along) = (place::placement(&mut table)?, table.get("along"));
            table.finish()?;
            (names, by, along)
        } else {
            (value.names()?, None, None)
        };
        let mut curves = curve::chained(scene, &names)?;
        if let Some(by) = by {
            curves = curves.iter().map(|c| curve::moved(c, &by, value.at())).collect::<Outcome<_>>()?;
        }
        pieces += curves.iter().map(|c| c.points().len() / c.degree()).sum::<usize>();
        if pieces > MOST_PIECES {
            return Err(value.fault(format!("the loops have more than {MOST_PIECES} pieces")));
        }
        all.push(Written { value, names, curves, along });
    }
    Ok(all)
}

fn flat(loop_: &Written<'_>) -> Outcome<Chain> {
    let name = |i: usize| loop_.names[i];
    loop_.curves.iter().enumerate().map(|(i, c)| planar(c, name(i))).collect()
}

/// Loops of a profile, in its plane, cut at their corners: every smooth piece becomes a face of its own, as edges of
/// solids are edges of faces.
pub(super) fn profile<'a>(scene: &mut Scene<'a>, value: Value<'a>) -> Outcome<Vec<Chain>> {
    let all = written(scene, value)?;
    if let Some(along) = all.iter().find_map(|l| l.along) {
        return Err(along.fault("a profile is not cast on anything"));
    }
    all.iter().map(|l| flat(l).map(|chain| chain.iter().flat_map(smooth_pieces).collect())).collect()
}

/// The curve's pieces between corners.
fn smooth_pieces(curve: &BSpline<DVec3>) -> Vec<BSpline<DVec3>> {
    let spans = curve.beziers();
    let tangent = |b: &Bezier<DVec3>, t: f64| {
        let (p, d) = b.jet(t);
        (d.truncate() * p.z - p.truncate() * d.z).normalize_or_zero()
    };
    let smooth = |a: &Span<Bezier<DVec3>>, b: &Span<Bezier<DVec3>>| {
        tangent(&a.piece, 1.0).distance(tangent(&b.piece, 0.0)) <= CORNER
    };
    let one = |spans: &[Span<Bezier<DVec3>>]| {
        let (degree, knots, points) = assemble(spans);
        BSpline::new(degree, knots, points).expect("pieces of a curve are curves")
    };
    spans.chunk_by(smooth).map(one).collect()
}

/// Trims a surface by the loops of its table.
pub(super) fn trim<'a>(scene: &mut Scene<'a>, table: &mut Table<'a>, made: &mut Made) -> Outcome<()> {
    let border = table.flag("border")?;
    let Some(value) = table.get("loops") else {
        return match table.get("border") {
            Some(v) if border => Err(v.fault("without `loops` every surface ends at its border")),
            _ => Ok(()),
        };
    };
    let tolerance = table.read("trim_tolerance", Value::positive)?.unwrap_or(scene.tolerance);
    let mut chains = Vec::new();
    let mut projected: f64 = 0.0;
    for loop_ in written(scene, value)? {
        chains.push(match loop_.along {
            None => {
                let chain = flat(&loop_)?;
                within(&made.surface, &chain, loop_.value)?;
                chain
            }
            Some(along) => {
                let cast = project(&made.surface, &loop_.curves, along.direction()?, tolerance);
                let cast = cast.map_err(|e| loop_.value.fault(e))?;
                projected = projected.max(cast.deviation);
                cast.curves
            }
        });
    }
    if border {
        chains.push(vec![rectangle(&made.surface).map_err(|e| value.fault(e))?]);
    }
    made.loops = trim_loops(&chains).map_err(|e| value.fault(e))?;
    made.notes.extend(crossing_note(&made.loops));
    if projected > 0.0 {
        made.notes.push(format!("outlines cast within {projected:.1e}"));
        made.deviation = made.deviation.max(projected);
    }
    Ok(())
}

/// No part of a chain lies outside of the surface's domain.
fn within(surface: &Surface, chain: &Chain, value: Value<'_>) -> Outcome<()> {
    /// Cuts of each piece: a control polygon of a sixteenth lies near its curve.
    const CUTS: usize = 16;
    let ((u0, u1), (v0, v1)) = surface.domain();
    let (low, high) = (DVec2::new(u0, v0), DVec2::new(u1, v1));
    let slack = (high - low) * OUTSIDE;
    let outside = |b: &Bezier<DVec3>| {
        // the ends of small pieces are on the curve
        let ends = (0..=CUTS).map(|k| b.point(k as f64 / CUTS as f64));
        ends.into_iter().find(|p| p.cmplt(low - slack).any() || p.cmpgt(high + slack).any())
    };
    match chain.iter().flat_map(BSpline::beziers).find_map(|s| outside(&s.piece)) {
        None => Ok(()),
        Some(p) => Err(Fault::new(
            value.at(),
            format!("the loop reaches ({}, {}), outside of the surface's u {u0} to {u1}, v {v0} to {v1}", p.x, p.y),
        )),
    }
}

/// The edge of the domain.
fn rectangle(surface: &Surface) -> Result<BSpline<DVec3>, crate::construct::ConstructError> {
    let ((u0, u1), (v0, v1)) = surface.domain();
    let corners = [(u0, v0), (u1, v0), (u1, v1), (u0, v1), (u0, v0)];
    crate::construct::curve::chain(1, corners.iter().map(|(u, v)| DVec3::new(*u, *v, 1.0)).collect())
}
