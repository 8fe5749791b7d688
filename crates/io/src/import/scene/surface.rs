//! `[surface.NAME]`: surfaces from curves, and the keys of all surfaces: loops, colour, side, placement.
//!
//! ```text
//!   plane bilinear bezier bspline equations grid │ extrude sweep lathe ruled loft coons gordon tube │ offset
//!             by numbers: see `data`             │               from curves                        │
//! ```

use super::curve::{self, Curve, planar, unknown};
use super::data;
use super::items::Scene;
use super::text::{Fault, Outcome, Table, Value};
use super::{place, trim};
use crate::construct::{
    Boundary, Built, ConstructError, Network, Sweep, coons, extrude, gordon, lathe, loft, offset, ruled, tube,
};
use crate::model::{Colour, Face, SurfaceKind, TrimLoop};
use crate::spline::Surface;
use glam::DAffine3;
use std::rc::Rc;

/// Most control points of a surface.
pub(super) const MOST_NET: usize = 1 << 20;
/// Most knots of all curves that a surface is laid through: their knots are merged.
const MOST_KNOTS: usize = 1 << 13;
/// Most control points of the profile of a sweep: there is one row for each.
const MOST_PROFILE: usize = 512;
/// Most knot spans of a surface that is offset: each is cut at least fourfold each way.
const MOST_SPANS: usize = 1 << 13;

/// A surface that is ready to be drawn.
#[derive(Clone, Debug)]
pub(super) struct Made {
    pub surface: Surface,
    pub kind: SurfaceKind,
    /// Largest distance from the description, in the file's units.
    pub deviation: f64,
    /// Notes for the report.
    pub notes: Vec<String>,
    pub loops: Vec<TrimLoop>,
    pub same_sense: bool,
    pub colour: Option<Colour>,
}

impl Made {
    pub fn exact(surface: Surface, kind: SurfaceKind) -> Self {
        let (notes, loops) = (Vec::new(), Vec::new());
        Self { surface, kind, deviation: 0.0, notes, loops, same_sense: true, colour: None }
    }

    fn built(built: Built, kind: SurfaceKind) -> Self {
        Self { deviation: built.deviation, ..Self::exact(built.surface, kind) }
    }

    /// The face, in millimetres.
    pub fn face(&self, id: u32, unit: f64) -> Face {
        let surface = self.surface.transformed(&DAffine3::from_scale(glam::DVec3::splat(unit)));
        let (kind, loops) = (self.kind, self.loops.clone());
        Face { id, kind, surface, loops, same_sense: self.same_sense, colour: self.colour }
    }
}

/// Everything of a surface's table.
pub(super) fn surface<'a>(scene: &mut Scene<'a>, table: &mut Table<'a>) -> Outcome<Made> {
    let shape = table.need("shape")?;
    scene.count(shape)?;
    let mut made = shaped(scene, shape, table)?;
    let net = made.surface.points().len();
    if net > MOST_NET {
        return Err(shape.fault(format!("{net} control points are more than {MOST_NET}")));
    }
    scene.spend(net, shape)?;
    if let Some(by) = place::placement(table)? {
        made.surface = made.surface.transformed(&by);
        // the normal of the mirrored surface points the other way round
        made.same_sense ^= by.matrix3.determinant() < 0.0;
        made.deviation *= largest_stretch(&by);
        if made.surface.points().iter().any(|p| !p.is_finite()) {
            return Err(shape.fault("its placement leaves the range of numbers"));
        }
    }
    made.same_sense ^= table.flag("flip")?;
    made.colour = table.read("colour", Value::colour)?;
    trim::trim(scene, table, &mut made)?;
    Ok(made)
}

/// How much longer a vector may become.
fn largest_stretch(by: &DAffine3) -> f64 {
    let m = by.matrix3;
    [m.x_axis, m.y_axis, m.z_axis].iter().map(|c| c.length_squared()).sum::<f64>().sqrt()
}

fn shaped<'a>(scene: &mut Scene<'a>, shape: Value<'a>, table: &mut Table<'a>) -> Outcome<Made> {
    let tolerance = table.read("tolerance", Value::positive)?.unwrap_or(scene.tolerance);
    let fault = |e: ConstructError| shape.fault(e);
    let exact = |surface: Result<Surface, ConstructError>, kind| surface.map(|s| Made::exact(s, kind)).map_err(fault);
    let built = |built: Result<Built, ConstructError>, kind| built.map(|b| Made::built(b, kind)).map_err(fault);
    use SurfaceKind::{BSpline, Extrusion, Offset, Revolution};
    match shape.text()? {
        "extrude" => {
            let profile = scene.named_curve(table, "profile")?;
            exact(extrude(&profile, table.need("along")?.direction()?), Extrusion)
        }
        "lathe" => {
            let name = table.need("profile")?;
            let profile = planar(&*scene.curve(name)?, name)?;
            let angle = table.number_or("angle", 360.0)?;
            exact(lathe(&profile, angle.to_radians()), Revolution)
        }
        "sweep" => {
            let name = table.need("profile")?;
            let profile = planar(&*scene.curve(name)?, name)?;
            if profile.points().len() > MOST_PROFILE {
                return Err(name.fault(format!("{} points are more than {MOST_PROFILE}", profile.points().len())));
            }
            let path = scene.named_curve(table, "path")?;
            let sweep = Sweep {
                up: table.read("up", Value::direction)?,
                twist: table.number_or("twist", 0.0)?.to_radians(),
                scale: table.read("taper", Value::pair)?.unwrap_or((1.0, 1.0)),
                ..Sweep::new(&profile, &path, tolerance)
            };
            built(sweep.build(), BSpline)
        }
        "tube" => {
            let path = scene.named_curve(table, "path")?;
            built(tube(&path, table.need("radius")?.positive()?, tolerance), BSpline)
        }
        "ruled" => {
            let (a, b) = (scene.named_curve(table, "from")?, scene.named_curve(table, "to")?);
            bounded(&[&a, &b], &[], shape)?;
            exact(ruled(&a, &b), BSpline)
        }
        "loft" => {
            let sections = scene.named_curves(table, "sections")?;
            bounded(&sections.iter().collect::<Vec<_>>(), &[], shape)?;
            let closed = table.flag("closed")?;
            exact(loft(&sections, closed), BSpline)
        }
        "coons" => {
            let mut side = |key: &'static str| scene.named_curve(table, key);
            let (bottom, top, left, right) = (side("bottom")?, side("top")?, side("left")?, side("right")?);
            bounded(&[&bottom, &top], &[&left, &right], shape)?;
            let boundary = Boundary { bottom: &bottom, top: &top, left: &left, right: &right };
            exact(coons(boundary, tolerance), BSpline)
        }
        "gordon" => {
            let (along_u, along_v) = (scene.named_curves(table, "u_curves")?, scene.named_curves(table, "v_curves")?);
            bounded(&along_u.iter().collect::<Vec<_>>(), &along_v.iter().collect::<Vec<_>>(), shape)?;
            let (u, v) = (table.need("u")?.numbers()?, table.need("v")?.numbers()?);
            let network = Network { u_curves: &along_u, v_curves: &along_v, u: &u, v: &v };
            exact(gordon(network, tolerance), BSpline)
        }
        "offset" => {
            let of = scene.surface(table.need("of")?)?;
            let grid = of.surface.patches();
            let spans = grid.patches.len();
            if spans > MOST_SPANS {
                return Err(shape.fault(format!("{spans} knot spans are more than {MOST_SPANS}")));
            }
            let distance = table.need("distance")?.number()?;
            let mut made = built(offset(&of.surface, distance, tolerance), Offset)?;
            made.deviation += of.deviation;
            made.same_sense = of.same_sense;
            Ok(made)
        }
        _ => data::shaped(scene, shape, table, tolerance)?.ok_or_else(|| unknown(shape, SURFACES)),
    }
}

const SURFACES: &[&str] = &[
    "plane",
    "bilinear",
    "bezier",
    "bspline",
    "equations",
    "grid",
    "extrude",
    "lathe",
    "sweep",
    "tube",
    "ruled",
    "loft",
    "coons",
    "gordon",
    "offset",
];

/// The curves are few and simple enough to be brought to common knots.
fn bounded(along: &[&Curve], across: &[&Curve], shape: Value<'_>) -> Outcome<()> {
    let knots = |curves: &[&Curve]| {
        let degree = curves.iter().map(|c| c.degree()).max().unwrap_or(1);
        // raised to the common degree, every knot is repeated as often as the degree grew
        curves.iter().map(|c| c.knots().len() * (1 + degree - c.degree())).sum::<usize>()
    };
    let (u, v) = (knots(along), knots(across));
    // a net through sections has a row for each; a network's has its knots both ways
    let net = (u + 4) * if across.is_empty() { along.len() + 4 } else { v + 4 };
    if u + v > MOST_KNOTS || net > MOST_NET {
        let message = format!("its curves have {} knots in all, which is too many for one surface", u + v);
        return Err(shape.fault(message));
    }
    Ok(())
}

impl<'a> Scene<'a> {
    /// The curve that a key names.
    pub fn named_curve(&mut self, table: &mut Table<'a>, key: &'static str) -> Outcome<Rc<Curve>> {
        let name = table.need(key)?;
        self.curve(name)
    }

    /// The curves that a key names.
    pub fn named_curves(&mut self, table: &mut Table<'a>, key: &'static str) -> Outcome<Vec<Curve>> {
        let names = table.need(key)?.some()?;
        names.into_iter().map(|n| self.curve(n).map(|c| (*c).clone())).collect()
    }
}

/// An error of a construction, at the column of the string that it is about.
pub(super) fn in_expression(
    scene: &Scene<'_>,
    texts: [(&'static str, Value<'_>); 3],
    shape: Value<'_>,
    error: ConstructError,
) -> Fault {
    match error {
        ConstructError::Expression { expression, column, message } => {
            let Some((_, value)) = texts.iter().find(|t| t.0 == expression) else { return shape.fault(message) };
            Fault::new(value.column(scene.text, column), format!("`{}`: {message}", value.key))
        }
        other => shape.fault(other),
    }
}

/// Curves of a table as they are placed.
pub(super) fn placed_curve<'a>(scene: &mut Scene<'a>, table: &mut Table<'a>) -> Outcome<Curve> {
    let shape = table.need("shape")?;
    scene.count(shape)?;
    let made = curve::curve(scene, shape, table)?;
    let made = match place::placement(table)? {
        Some(by) => curve::moved(&made, &by, table.at)?,
        None => made,
    };
    scene.spend(made.points().len(), shape)?;
    Ok(made)
}
