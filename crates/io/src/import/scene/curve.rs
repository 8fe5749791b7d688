//! `[curve.NAME]`: curves in the plane or in space.
//!
//! ```text
//!   line arc circle ellipse parabola hyperbola │ polyline bezier bspline │ through polyloop │ joined
//!               exact conics                   │     by control points   │   by points      │ end to end
//! ```

use super::items::Scene;
use super::text::{Fault, Outcome, Table, Value};
use crate::construct::curve::{CurveEnds, Parameters, chain, circle, ellipse, hyperbola, interpolate, line, parabola};
use crate::construct::polyloop::PolyLoop;
use crate::spline::{BSpline, Control, MAX_DEGREE};
use glam::{DAffine3, DVec3, DVec4};

/// Most points of a curve: files are bounded, but the cost of their curves grows with squares.
pub(super) const MOST_POINTS: usize = 1 << 16;
/// Share of a curve's size by which planar curves may leave their plane.
const FLAT: f64 = 1e-12;

pub(super) type Curve = BSpline<DVec4>;

/// The curve that the table describes, before its placement.
pub(super) fn curve<'a>(scene: &mut Scene<'a>, shape: Value<'a>, table: &mut Table<'a>) -> Outcome<Curve> {
    let name = shape.text()?;
    let built = match name {
        "line" => {
            let (a, b) = (table.need("from")?.point()?, table.need("to")?.point()?);
            line(a, b)
        }
        "arc" | "circle" | "ellipse" => return round(name, table),
        "parabola" | "hyperbola" => {
            let origin = table.need(if name == "parabola" { "apex" } else { "centre" })?.point()?;
            let (x, y) = (table.need("x")?.direction()?, table.need("y")?.direction()?);
            let (from, to) = table.need("range")?.pair()?;
            if name == "parabola" { parabola(origin, x, y, from, to) } else { hyperbola(origin, x, y, from, to) }
        }
        "polyline" => {
            let mut points = homogeneous(table)?;
            if table.flag("closed")? {
                points.push(points[0]);
            }
            chain(1, points)
        }
        "bezier" => {
            let points = homogeneous(table)?;
            let degree = table.read("degree", |v| v.count(1, MAX_DEGREE))?;
            if degree.is_none() && points.len() > MAX_DEGREE + 1 {
                let most = MAX_DEGREE;
                return Err(table.need("points")?.fault(format!("degree {} is above {most}", points.len() - 1)));
            }
            chain(degree.unwrap_or(points.len().saturating_sub(1)), points)
        }
        "bspline" => {
            let points = homogeneous(table)?;
            let degree = table.need("degree")?.count(1, MAX_DEGREE)?;
            let knots = knots(table, "knots", degree, points.len())?;
            BSpline::new(degree, knots, points).map_err(Into::into)
        }
        "through" => return through(table),
        "polyloop" => return polyloop(table),
        "joined" => {
            let of = table.need("of")?.names()?;
            let curves = chained(scene, &of)?;
            return joined(&curves, &of);
        }
        _ => return Err(unknown(shape, CURVES)),
    };
    built.map_err(|e| shape.fault(e))
}

const CURVES: &[&str] = &[
    "line",
    "arc",
    "circle",
    "ellipse",
    "parabola",
    "hyperbola",
    "polyline",
    "bezier",
    "bspline",
    "through",
    "polyloop",
    "joined",
];

/// A shape that a section does not have.
pub(super) fn unknown(shape: Value<'_>, known: &[&str]) -> Fault {
    let words: Vec<(&str, ())> = known.iter().map(|w| (*w, ())).collect();
    match shape.word(&words) {
        Err(fault) => fault,
        Ok(()) => shape.fault("not read here"),
    }
}

/// Arcs, circles and ellipses: in the plane by `centre` and `radius`, in space across an `axis`.
fn round(name: &str, table: &mut Table<'_>) -> Outcome<Curve> {
    let at = table.at;
    let centre = table.read("centre", Value::point)?.unwrap_or(DVec3::ZERO);
    let degrees = |table: &mut Table<'_>| -> Outcome<(f64, f64)> {
        let (from, to) = (table.need("from")?.number()?, table.need("to")?.number()?);
        Ok((from.to_radians(), to.to_radians()))
    };
    let built = if name == "ellipse" {
        let (x, y) = (table.need("x")?.direction()?, table.need("y")?.direction()?);
        let part = table.get("from").is_some() || table.get("to").is_some();
        let range = if part { degrees(table)? } else { (0.0, std::f64::consts::TAU) };
        ellipse(centre, x, y, range.0, range.1)
    } else {
        let radius = table.need("radius")?.positive()?;
        let axis = table.read("axis", Value::direction)?.unwrap_or(DVec3::Z);
        // the start of angles: x, or what comes near it in the plane across the axis
        let start = table
            .read("start", Value::direction)?
            .unwrap_or_else(|| if axis.cross(DVec3::X).length() > 1e-6 * axis.length() { DVec3::X } else { DVec3::Y });
        let z = axis.normalize();
        let x = (start - z * start.dot(z)).normalize_or_zero();
        if name == "circle" {
            circle(centre, axis, start, radius, std::f64::consts::TAU)
        } else {
            let (from, to) = degrees(table)?;
            ellipse(centre, x * radius, z.cross(x) * radius, from, to)
        }
    };
    built.map_err(|e| Fault::new(at, e.to_string()))
}

/// `points`, with `weights` where they are given.
fn homogeneous(table: &mut Table<'_>) -> Outcome<Vec<DVec4>> {
    let value = table.need("points")?;
    let points = value.points()?;
    let weights = table.read("weights", |v| {
        let all = v.some()?;
        if all.len() != points.len() {
            return Err(v.fault(format!("{} weights for {} points", all.len(), points.len())));
        }
        all.into_iter().map(Value::positive).collect()
    })?;
    if points.len() < 2 || points.len() > MOST_POINTS {
        return Err(value.fault(format!("{} points are not between 2 and {MOST_POINTS}", points.len())));
    }
    let weight = |i: usize| weights.as_ref().map_or(1.0, |w: &Vec<f64>| w[i]);
    Ok(points.iter().enumerate().map(|(i, p)| DVec4::from_point(*p, weight(i))).collect())
}

/// The knot vector under `key`; evenly spaced and clamped where there is none.
pub(super) fn knots(table: &mut Table<'_>, key: &'static str, degree: usize, count: usize) -> Outcome<Vec<f64>> {
    if let Some(value) = table.get(key) {
        let knots = value.numbers()?;
        let needed = count + degree + 1;
        return if knots.len() == needed {
            Ok(knots)
        } else {
            Err(value.fault(format!("{} knots, but {needed} are needed: points + degree + 1", knots.len())))
        };
    }
    let spans = count.saturating_sub(degree).max(1);
    let inner = (1..spans).map(|k| k as f64 / spans as f64);
    Ok(std::iter::repeat_n(0.0, degree + 1).chain(inner).chain(std::iter::repeat_n(1.0, degree + 1)).collect())
}

/// The C² cubic through points.
fn through(table: &mut Table<'_>) -> Outcome<Curve> {
    let value = table.need("points")?;
    let points = value.points()?;
    let words: &[(&str, _)] = &[
        ("chord", Parameters::ChordLength),
        ("centripetal", Parameters::Centripetal),
        ("uniform", Parameters::Uniform),
    ];
    let parameters = table.read("parameters", |v| {
        if !v.is_text() {
            return Ok(Parameters::Given(v.numbers()?));
        }
        let index: Vec<(&str, usize)> = words.iter().enumerate().map(|(i, w)| (w.0, i)).collect();
        Ok(words[v.word(&index)?].1.clone())
    })?;
    let ends = table.read("ends", |v| {
        v.word(&[("natural", CurveEnds::Natural), ("not-a-knot", CurveEnds::NotAKnot), ("closed", CurveEnds::Closed)])
    })?;
    let slopes = table.read("slopes", |v| {
        let all = v.points()?;
        let [a, b] = all[..] else { return Err(v.fault("2 slopes are wanted, at the first and the last point")) };
        Ok(CurveEnds::Clamped(a, b))
    })?;
    if let (Some(_), Some(_), Some(v)) = (ends, slopes, table.get("slopes")) {
        return Err(v.fault("beside `ends`"));
    }
    if points.len() > MOST_POINTS {
        return Err(value.fault(format!("{} points are more than {MOST_POINTS}", points.len())));
    }
    let parameters = parameters.unwrap_or(Parameters::ChordLength);
    interpolate(&points, &parameters, slopes.or(ends).unwrap_or(CurveEnds::NotAKnot)).map_err(|e| value.fault(e))
}

/// The smooth closed curve of a polygon.
fn polyloop(table: &mut Table<'_>) -> Outcome<Curve> {
    #[derive(Clone, Copy)]
    enum Style {
        Near,
        Through,
        Smooth,
    }
    let value = table.need("points")?;
    let points = value.points()?;
    if points.iter().any(|p| p.z != 0.0) || points.len() > MOST_POINTS {
        return Err(value.fault(format!("at most {MOST_POINTS} points in the plane are wanted")));
    }
    let style = table
        .read("style", |v| v.word(&[("near", Style::Near), ("through", Style::Through), ("smooth", Style::Smooth)]))?;
    let tension = table.read("tension", Value::number)?;
    let style = style.unwrap_or(Style::Near);
    if let (Some(_), false, Some(v)) = (tension, matches!(style, Style::Through), table.get("tension")) {
        return Err(v.fault("only the style `through` has one"));
    }
    let loop_ = PolyLoop::new(points.iter().map(|p| p.truncate()).collect()).map_err(|e| value.fault(e))?;
    let flat = match style {
        Style::Near => loop_.approximating(),
        Style::Through => loop_.interpolating(tension.unwrap_or(0.0)),
        Style::Smooth => loop_.interpolating_smoothly(&Parameters::ChordLength),
    };
    Ok(in_space(&flat.map_err(|e| value.fault(e))?))
}

/// The curve at another place.
pub(super) fn moved(curve: &Curve, by: &DAffine3, at: usize) -> Outcome<Curve> {
    let place = |p: &DVec4| (by.matrix3 * p.truncate() + by.translation * p.w).extend(p.w);
    let points = curve.points().iter().map(place).collect();
    BSpline::new(curve.degree(), curve.knots().to_vec(), points).map_err(|e| Fault::new(at, e.to_string()))
}

pub(super) fn in_space(flat: &BSpline<DVec3>) -> Curve {
    let points = flat.points().iter().map(|p| DVec4::new(p.x, p.y, 0.0, p.z)).collect();
    BSpline::new(flat.degree(), flat.knots().to_vec(), points).expect("the same knots and weights")
}

/// The curve in the plane `z = 0`.
pub(super) fn planar(curve: &Curve, named: Value<'_>) -> Outcome<BSpline<DVec3>> {
    let size = curve.points().iter().map(|p| p.point().abs().max_element()).fold(0.0, f64::max);
    if let Some(p) = curve.points().iter().find(|p| p.point().z.abs() > FLAT * size) {
        let message = format!("`{}` must lie in the plane z = 0, but reaches z = {}", named.text()?, p.point().z);
        return Err(named.fault(message));
    }
    let points = curve.points().iter().map(|p| DVec3::new(p.x, p.y, p.w)).collect();
    Ok(BSpline::new(curve.degree(), curve.knots().to_vec(), points).expect("the same knots and weights"))
}

/// Named curves end to end, each turned round where that brings its start to the end before it.
pub(super) fn chained<'a>(scene: &mut Scene<'a>, names: &[Value<'a>]) -> Outcome<Vec<Curve>> {
    let mut curves = names.iter().map(|n| scene.curve(*n).map(|c| (*c).clone())).collect::<Outcome<Vec<_>>>()?;
    let ends = |c: &Curve| {
        let (a, b) = c.domain();
        (c.point(a), c.point(b))
    };
    for i in 0..curves.len() {
        let (start, end) = ends(&curves[i]);
        let turn = if i == 0 {
            let Some(next) = curves.get(1).map(ends) else { break };
            let near = |p: DVec3| p.distance(next.0).min(p.distance(next.1));
            near(start) < near(end)
        } else {
            let before = ends(&curves[i - 1]).1;
            before.distance(end) < before.distance(start)
        };
        if turn {
            curves[i] = curves[i].reversed();
        }
    }
    Ok(curves)
}

/// One curve of several, of the largest of their degrees.
fn joined(curves: &[Curve], names: &[Value<'_>]) -> Outcome<Curve> {
    let degree = curves.iter().map(BSpline::degree).max().unwrap_or(1);
    let total: usize = curves.iter().map(|c| c.points().len()).sum();
    if total > MOST_POINTS / 8 {
        return Err(names[0].fault(format!("{total} points in all are more than {}", MOST_POINTS / 8)));
    }
    let mut points: Vec<DVec4> = Vec::new();
    for (curve, name) in curves.iter().zip(names) {
        let pieces = curve.elevated_to(degree).map_err(|e| name.fault(e))?.beziers();
        for mut piece in pieces.into_iter().map(|s| s.piece.points) {
            if let Some(last) = points.pop() {
                let gap = last.point().distance(piece[0].point());
                let size = points.iter().map(|p| p.point().abs().max_element()).fold(0.0, f64::max);
                if gap > 1e-9 * size {
                    return Err(name.fault(format!("`{}` begins {gap:e} from the end before it", name.text()?)));
                }
                // one point belongs to both: the earlier one's, with weights to match
                let scale = last.w / piece[0].w;
                piece.iter_mut().for_each(|p| *p *= scale);
                piece[0] = last;
            }
            points.extend(piece);
        }
    }
    chain(degree, points).map_err(|e| names[0].fault(e))
}
