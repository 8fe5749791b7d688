//! Surfaces by numbers: control nets, equations, grids of points and pictures of heights.
//!
//! ```text
//!   points = [[[x, y, z], …], …]     rows along u, one after another along v
//!   x = "u*cos(v)"                   expressions in u and v, with constants
//!   file = "heights.png"             beside the scene file, or below it
//! ```

use super::grid::{heights_from_png, points_from_csv};
use super::items::Scene;
use super::surface::{MOST_NET, Made, in_expression};
use super::text::{Outcome, Table, Value};
use super::{curve, files};
use crate::construct::fit::{Equation, FitOptions, Side, fit};
use crate::construct::grid::{GridFit, HeightField, PointGrid, approximate, height_field, interpolate};
use crate::construct::{Built, ConstructError};
use crate::model::SurfaceKind;
use crate::spline::{Control, MAX_DEGREE, Surface};
use glam::{DVec3, DVec4};

/// Most control points of a fit to equations.
const MOST_FITTED: usize = 1 << 16;

/// The surface of a shape that is given by numbers; `None` for other shapes.
pub(super) fn shaped<'a>(
    scene: &mut Scene<'a>,
    shape: Value<'a>,
    table: &mut Table<'a>,
    tolerance: f64,
) -> Outcome<Option<Made>> {
    let surface = match shape.text()? {
        "plane" => Made::exact(plane(table, shape)?, SurfaceKind::Plane),
        "bilinear" => Made::exact(bilinear(table, shape)?, SurfaceKind::BSpline),
        "bezier" => Made::exact(bezier(table, shape)?, SurfaceKind::BSpline),
        "bspline" => Made::exact(bspline(table, shape)?, SurfaceKind::BSpline),
        "equations" => equations(scene, shape, table, tolerance)?,
        "grid" => grid(scene, shape, table)?,
        _ => return Ok(None),
    };
    Ok(Some(surface))
}

/// `origin + u x + v y`.
fn plane(table: &mut Table<'_>, shape: Value<'_>) -> Outcome<Surface> {
    let origin = table.read("origin", Value::point)?.unwrap_or(DVec3::ZERO);
    let x = table.read("x", Value::direction)?.unwrap_or(DVec3::X);
    let y = table.read("y", Value::direction)?.unwrap_or(DVec3::Y);
    let (u, v) = (table.need("u")?.pair()?, table.need("v")?.pair()?);
    if x.cross(y).length() <= 1e-12 * x.length() * y.length() {
        return Err(shape.fault("`x` and `y` are on one line"));
    }
    let corner = |u: f64, v: f64| (origin + x * u + y * v).extend(1.0);
    let net = vec![corner(u.0, v.0), corner(u.1, v.0), corner(u.0, v.1), corner(u.1, v.1)];
    Surface::new((1, 1), vec![u.0, u.0, u.1, u.1], vec![v.0, v.0, v.1, v.1], net).map_err(|e| shape.fault(e))
}

/// Between four corners, at (0, 0), (1, 0), (0, 1) and (1, 1).
fn bilinear(table: &mut Table<'_>, shape: Value<'_>) -> Outcome<Surface> {
    let value = table.need("points")?;
    let points = value.points()?;
    if points.len() != 4 {
        return Err(value.fault(format!("4 corners are wanted, not {}", points.len())));
    }
    let net = points.iter().map(|p| p.extend(1.0)).collect();
    let knots = || vec![0.0, 0.0, 1.0, 1.0];
    Surface::new((1, 1), knots(), knots(), net).map_err(|e| shape.fault(e))
}

/// Rows of points, with rows of weights where they are given: the number in a row, and all.
fn net(table: &mut Table<'_>) -> Outcome<(usize, Vec<DVec4>)> {
    let value = table.need("points")?;
    let rows = value.some()?.into_iter().map(Value::points).collect::<Outcome<Vec<_>>>()?;
    let width = rows[0].len();
    if rows.iter().any(|r| r.len() != width) || width == 0 {
        return Err(value.fault("all rows must have the same number of points"));
    }
    let mut weights = vec![1.0; width * rows.len()];
    if let Some(value) = table.get("weights") {
        let given = value.list()?.into_iter().map(Value::list).collect::<Outcome<Vec<_>>>()?;
        if given.len() != rows.len() || given.iter().any(|r| r.len() != width) {
            return Err(value.fault(format!("{} rows of {width} weights are wanted", rows.len())));
        }
        for (w, given) in weights.iter_mut().zip(given.into_iter().flatten()) {
            *w = given.positive()?;
        }
    }
    let points = rows.iter().flatten().zip(weights).map(|(p, w)| DVec4::from_point(*p, w));
    Ok((width, points.collect()))
}

fn bezier(table: &mut Table<'_>, shape: Value<'_>) -> Outcome<Surface> {
    let (width, net) = net(table)?;
    let height = net.len() / width;
    let knots = |n: usize| [0.0].repeat(n).into_iter().chain([1.0].repeat(n)).collect();
    let degree = |n: usize| n.saturating_sub(1);
    Surface::new((degree(width), degree(height)), knots(width), knots(height), net).map_err(|e| shape.fault(e))
}

fn bspline(table: &mut Table<'_>, shape: Value<'_>) -> Outcome<Surface> {
    let (width, net) = net(table)?;
    let degrees = table.read("degrees", |v| {
        let all = v.list()?.into_iter().map(|d| d.count(1, MAX_DEGREE)).collect::<Outcome<Vec<_>>>()?;
        let [u, v_] = all[..] else { return Err(v.fault("2 degrees are wanted, along u and v")) };
        Ok((u, v_))
    })?;
    let degrees = degrees.unwrap_or((3, 3));
    let u = curve::knots(table, "u_knots", degrees.0, width)?;
    let v = curve::knots(table, "v_knots", degrees.1, net.len() / width)?;
    Surface::new(degrees, u, v, net).map_err(|e| shape.fault(e))
}

/// Three expressions, fitted.
fn equations<'a>(scene: &Scene<'a>, shape: Value<'a>, table: &mut Table<'a>, tolerance: f64) -> Outcome<Made> {
    let mut constants: Vec<(&str, f64)> = Vec::new();
    if let Some(value) = table.get("constants") {
        for (name, _, value) in value.table()?.all() {
            let word = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
            if !word || name.starts_with(|c: char| !c.is_ascii_alphabetic()) || matches!(*name, "u" | "v") {
                return Err(value.fault("a constant is called by letters, digits and `_`, and neither `u` nor `v`"));
            }
            constants.push((name, value.number()?));
        }
    }
    let texts = [("x", table.need("x")?), ("y", table.need("y")?), ("z", table.need("z")?)];
    let mut expression = [""; 3];
    for (text, value) in expression.iter_mut().zip(texts) {
        *text = value.1.text()?;
    }
    let equation = Equation::parse(expression, &constants).map_err(|e| in_expression(scene, texts, shape, e))?;
    let mut range = |key: &'static str| -> Outcome<(f64, f64)> {
        let value = table.need(key)?;
        let ends = value.list()?;
        let [a, b] = ends[..] else { return Err(value.fault("2 ends are wanted")) };
        Ok((constant(scene, a, &constants)?, constant(scene, b, &constants)?))
    };
    let (u, v) = (range("u")?, range("v")?);
    let options = FitOptions { tolerance, most_points: MOST_FITTED };
    let fitted = fit(|u, v| equation.at(u, v), u, v, &options).map_err(|e| shape.fault(e))?;
    let notes = vec![format!("fitted within {:.1e}", fitted.bound)];
    let seams = [fitted.sides.u, fitted.sides.v].iter().filter(|s| **s != Side::Open).count();
    let poles = fitted.sides.poles.iter().flatten().count();
    let found = (seams + poles > 0).then(|| format!("{seams} seams and {poles} poles"));
    let built = Built::from(fitted);
    let made = Made { deviation: built.deviation, ..Made::exact(built.surface, SurfaceKind::BSpline) };
    Ok(Made { notes: notes.into_iter().chain(found).collect(), ..made })
}

/// A number, or an expression without `u` and `v`, as `"2*pi"`.
fn constant(scene: &Scene<'_>, value: Value<'_>, constants: &[(&str, f64)]) -> Outcome<f64> {
    if !value.is_text() {
        return value.number();
    }
    let equation = Equation::parse([value.text()?, "0", "0"], constants)
        .map_err(|e| in_expression(scene, [("x", value), ("y", value), ("z", value)], value, e))?;
    let (x, other) = (equation.at(0.25, 0.75).x, equation.at(0.75, 0.25).x);
    let good = x.is_finite() && x == other;
    if good { Ok(x) } else { Err(value.fault("neither `u` nor `v` has a value here, and the result must be finite")) }
}

/// Through the points of a table or a picture, or near them.
fn grid(scene: &mut Scene<'_>, shape: Value<'_>, table: &mut Table<'_>) -> Outcome<Made> {
    let fault = |e: ConstructError| shape.fault(e);
    let controls = table.read("controls", |v| {
        let all = v.list()?.into_iter().map(|n| n.count(4, MOST_NET)).collect::<Outcome<Vec<_>>>()?;
        let [u, v_] = all[..] else { return Err(v.fault("2 numbers of control points are wanted, along u and v")) };
        Ok((u, v_))
    })?;
    let points = match (table.get("file"), table.get("points")) {
        (Some(file), None) => {
            let (bytes, name) = files::data(scene, file)?;
            if bytes.starts_with(b"\x89PNG") {
                let (width, samples) = heights_from_png(&bytes, &name).map_err(|e| file.fault(e))?;
                few(samples.len(), file)?;
                let mut pair = |key: &'static str| table.need(key)?.pair();
                let field = HeightField { width, x: pair("x")?, y: pair("y")?, z: pair("z")? };
                if controls.is_some() {
                    return Err(table.need("controls")?.fault("a picture of heights is interpolated"));
                }
                return Ok(fitted(height_field(&samples, &field).map_err(fault)?));
            }
            points_from_csv(&bytes, &name).map_err(|e| file.fault(e))?
        }
        (None, Some(_)) => {
            let (width, net) = net(table)?;
            PointGrid::new(width, net.iter().map(|p| p.truncate()).collect()).map_err(fault)?
        }
        _ => return Err(shape.fault("either `file` or `points` is wanted")),
    };
    few(points.points().len(), shape)?;
    let made = match controls {
        Some(controls) => approximate(&points, controls),
        None => interpolate(&points),
    };
    Ok(fitted(made.map_err(fault)?))
}

fn few(count: usize, value: Value<'_>) -> Outcome<()> {
    if count > MOST_NET { Err(value.fault(format!("{count} points are more than {MOST_NET}"))) } else { Ok(()) }
}

fn fitted(fit: GridFit) -> Made {
    let note = format!("data met within {:.1e}, in the mean {:.1e}", fit.error.most, fit.error.rms);
    Made { notes: vec![note], ..Made::exact(fit.surface, SurfaceKind::BSpline) }
}
