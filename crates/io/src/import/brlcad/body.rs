//! Solids of BRL-CAD: each is the affine image of a shape with an exact equation.
//!
//! ```text
//!   ell  ball of (A B C V)        tgc  cylinder or cone of (A B H V), where C = k A and D = k B; else a wall of lines
//!   tor  about H                  arb8 half-spaces of its faces, corners may coincide       half  n·x <= d
//!   eto, part  turned profiles    rpc rhc epa ehy hyp  a quadric and the box of its ends    pipe bot extrude  faces
//! ```

use super::Fault;
use super::object::{Database, Record};
use super::{arb, quadric, sketch, tube};
use crate::construct::curve::{ellipse, line};
use crate::construct::lathed_solid;
use crate::import::junctions::{self, Closed};
use crate::import::solid::{Assembly, Placed};
use crate::import::{Place, Warnings, facets};
use crate::model::{Mesh, Part, Shape};
use crate::spline::BSpline;
use glam::{DAffine3, DMat3, DVec3, DVec4};
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

/// Vectors that are parallel to the rounding of single precision, relative to their length: older databases have it.
const SINGLE: f64 = 1e-6;
/// Cosine that still counts as that of parallel vectors. BRL-CAD draws no cone beyond.
const PARALLEL: f64 = 1e-3;
/// Share of a mesh's diagonal within which a vertex beside a triangle's side divides that side, so that the mesh
/// closes. Converted meshes miss by 1e-6 to 4e-5; in a picture that the mesh fills this is a sixth of a pixel of 1500.
const JUNCTION: f64 = 1e-4;

/// Makes solids of records.
pub(super) struct Bodies<'d, 'a> {
    pub to: Assembly,
    database: &'d Database<'a>,
    /// Shapes of many faces, or why there is none: made once, for all places where a solid is used.
    made: HashMap<u32, Result<(Shape, DAffine3), Fault>>,
}

impl<'d, 'a> Bodies<'d, 'a> {
    pub fn new(database: &'d Database<'a>) -> Self {
        Self { to: Assembly::default(), database, made: HashMap::new() }
    }

    /// A solid as a node.
    pub fn node(&mut self, object: &Record<'_>, placed: &Placed, warnings: &mut Warnings) -> Result<u32, Fault> {
        let v = |key: &str| object.vector(key);
        match object.kind {
            "ell" | "sph" => {
                let radius = 1.0;
                let own = frame(v("A")?, v("B")?, v("C")?, v("V")?);
                Ok(self.place(Shape::Sphere { radius }, own, placed))
            }
            "tor" => {
                let ([major], [minor]) = (object.numbers::<1>("r_a")?, object.numbers::<1>("r_h")?);
                if major < 0.0 || minor < 0.0 {
                    return Err(object.fault("a radius is negative"));
                }
                let own = about(object, "H", v("V")?)?;
                Ok(self.place(Shape::Torus { major, minor }, own, placed))
            }
            "half" => {
                let (normal, offset) = match object.list("N")?[..] {
                    [x, y, z, offset] => (DVec3::new(x, y, z), offset),
                    _ => (v("N")?, object.numbers::<1>("d")?[0]),
                };
                if normal == DVec3::ZERO {
                    return Err(object.fault("`N` has no length"));
                }
                Ok(self.to.add(Shape::HalfSpace { normal, offset }, placed))
            }
            "arb8" | "arb7" | "arb6" | "arb5" | "arb4" => arb::node(&mut self.to, object, placed, warnings),
            "rpc" | "rhc" | "epa" | "ehy" | "hyp" => quadric::node(&mut self.to, object, placed),
            _ => {
                if !self.made.contains_key(&placed.id) {
                    let made = self.shape(object, warnings);
                    self.made.insert(placed.id, made);
                }
                let (shape, own) = self.made[&placed.id].clone()?;
                Ok(self.place(shape, own, placed))
            }
        }
    }

    fn place(&mut self, shape: Shape, own: DAffine3, placed: &Placed) -> u32 {
        self.to.add(shape, &Placed { transform: placed.transform * own, ..*placed })
    }

    /// A single shape and where it stands.
    fn shape(&self, object: &Record<'_>, warnings: &mut Warnings) -> Result<(Shape, DAffine3), Fault> {
        let part = |part: Part| Shape::Part(Arc::new(part));
        match object.kind {
            "tgc" | "rcc" | "rec" | "trc" => cone(object),
            "eto" => {
                let own = about(object, "N", object.vector("V")?)?;
                Ok((part(elliptical_torus(object, own.matrix3.z_axis)?), own))
            }
            "part" => particle(object),
            "pipe" => Ok((part(tube::pipe(object)?), DAffine3::IDENTITY)),
            "bot" => Ok((Shape::Mesh(Arc::new(triangles(object, warnings)?)), DAffine3::IDENTITY)),
            "extrude" => sketch::extruded(object, self.database).map(|(solid, own)| (part(solid), own)),
            _ => Err(object.fault("such a solid has no exact counterpart and is not read")),
        }
    }
}

pub(super) fn frame(x: DVec3, y: DVec3, z: DVec3, at: DVec3) -> DAffine3 {
    DAffine3 { matrix3: DMat3::from_cols(x, y, z), translation: at }
}

/// An orthonormal frame whose z axis is along a field.
fn about(object: &Record<'_>, key: &str, at: DVec3) -> Result<DAffine3, Fault> {
    let axis = object.vector(key)?.try_normalize();
    let axis = axis.ok_or_else(|| object.fault(format!("`{key}` has no length")))?;
    let (x, y) = axis.any_orthonormal_pair();
    Ok(frame(x, y, axis, at))
}

/// Between two ellipses.
fn cone(object: &Record<'_>) -> Result<(Shape, DAffine3), Fault> {
    let (mut v, mut h) = (object.vector("V")?, object.vector("H")?);
    let [mut a, mut b, mut c, mut d] =
        [object.vector("A")?, object.vector("B")?, object.vector("C")?, object.vector("D")?];
    if a.length() + b.length() < c.length() + d.length() {
        (v, h) = (v + h, -h);
        (a, b, c, d) = (c, d, a, b);
    }
    let size = a.length() + b.length();
    let top = if a.length() > 0.0 { c.dot(a) / a.length_squared() } else { 0.0 };
    let off = (c - a * top).length() + (d - b * top).length();
    if top >= 0.0 && off <= SINGLE * size {
        let height = 1.0;
        let same = (top - 1.0).abs() <= SINGLE;
        let shape =
            if same { Shape::Cylinder { radius: 1.0, height } } else { Shape::Cone { bottom: 1.0, top, height } };
        return Ok((shape, frame(a, b, h, v)));
    }
    let apart = |p: DVec3, q: DVec3| p.dot(q) < (1.0 - PARALLEL) * p.length() * q.length();
    if apart(a, c) || apart(b, d) {
        return Err(object.fault("ends that are turned against each other are not read"));
    }
    let solid = tube::between_ellipses(v, h, [a, b, c, d]);
    Ok((Shape::Part(Arc::new(solid.map_err(|what| object.fault(what))?)), DAffine3::IDENTITY))
}

/// An ellipse turned about z: its half axis `C` leans against the axis, outwards and up.
fn elliptical_torus(object: &Record<'_>, axis: DVec3) -> Result<Part, Fault> {
    let (c, r, rd) = (object.vector("C")?, object.positive("r")?, object.positive("r_d")?);
    let up = c.dot(axis).abs();
    let out = (c.length_squared() - up * up).max(0.0).sqrt();
    let first = DVec3::new(out, up, 0.0);
    let across = first.try_normalize().ok_or_else(|| object.fault("`C` has no length"))?;
    let second = DVec3::new(-across.y, across.x, 0.0) * rd;
    if (first.x * first.x + second.x * second.x).sqrt() > r {
        return Err(object.fault("its ellipse reaches across the axis"));
    }
    let profile = ellipse(DVec3::X * r, first, second, 0.0, TAU).and_then(|e| Ok(vec![flat(&e)?]));
    profile.and_then(|p| lathed_solid(&[p], TAU)).map_err(|e| object.fault(e))
}

/// A curve in the plane `z = 0`.
pub(super) fn flat(curve: &BSpline<DVec4>) -> Result<BSpline<DVec3>, crate::construct::ConstructError> {
    let points = curve.points().iter().map(|p| DVec3::new(p.x, p.y, p.w)).collect();
    Ok(BSpline::new(curve.degree(), curve.knots().to_vec(), points)?)
}

/// What lies within two balls and the cone that touches both.
fn particle(object: &Record<'_>) -> Result<(Shape, DAffine3), Fault> {
    let (v, h) = (object.vector("V")?, object.vector("H")?);
    let ([low], [high]) = (object.numbers::<1>("r_v")?, object.numbers::<1>("r_h")?);
    if low < 0.0 || high < 0.0 || low + high == 0.0 {
        return Err(object.fault("its radii are not those of balls"));
    }
    let length = h.length();
    if length <= (low - high).abs() {
        let (radius, at) = if low >= high { (low, v) } else { (high, v + h) };
        return Ok((Shape::Sphere { radius }, DAffine3::from_translation(at)));
    }
    // the cone touches at this latitude
    let sine = (low - high) / length;
    let cosine = (1.0 - sine * sine).sqrt();
    let ball = |at: f64, radius: f64, from: f64, to: f64| {
        ellipse(DVec3::Y * at, DVec3::X * radius, DVec3::Y * radius, from, to).and_then(|e| flat(&e))
    };
    let touch = |at: f64, radius: f64| DVec3::new(radius * cosine, at + radius * sine, 0.0);
    let latitude = sine.asin();
    let mut profile = Vec::new();
    if low > 0.0 {
        profile.push(ball(0.0, low, -FRAC_PI_2, latitude));
    }
    profile.push(line(touch(0.0, low), touch(length, high)).and_then(|e| flat(&e)));
    if high > 0.0 {
        profile.push(ball(length, high, latitude, FRAC_PI_2));
    }
    profile.push(line(DVec3::Y * (length + high), DVec3::Y * -low).and_then(|e| flat(&e)));
    let profile = profile.into_iter().collect::<Result<Vec<_>, _>>();
    let solid = profile.and_then(|p| lathed_solid(&[p], TAU)).map_err(|e| object.fault(e))?;
    Ok((Shape::Part(Arc::new(solid)), about(object, "H", v)?))
}

/// Triangles that bound a volume.
fn triangles(object: &Record<'_>, warnings: &mut Warnings) -> Result<Mesh, Fault> {
    let mode = object.value("mode").unwrap_or("volume");
    if !matches!(mode, "volume" | "solid") {
        return Err(object.fault(format!("triangles of mode `{mode}` bound no volume and are not read")));
    }
    let places = object.list("V")?;
    let numbers = object.list("F")?;
    if places.len() % 3 != 0 || numbers.len() % 3 != 0 {
        return Err(object.fault("vertices and triangles are not threes of numbers"));
    }
    let vertices: Vec<DVec3> = places.chunks_exact(3).map(DVec3::from_slice).collect();
    let corner = |x: f64| (x >= 0.0 && x.fract() == 0.0 && x < vertices.len() as f64).then_some(x as u32);
    let left = object.value("orient") == Some("lh");
    let mut all = Vec::with_capacity(numbers.len() / 3);
    for t in numbers.chunks_exact(3) {
        let [Some(a), Some(b), Some(c)] = [t[0], t[1], t[2]].map(corner) else {
            return Err(object.fault(format!("triangle {} names a vertex that does not exist", all.len())));
        };
        all.push(if left { [a, c, b] } else { [a, b, c] });
    }
    let mesh = Mesh::new(1, vertices, all, Vec::new()).map_err(|e| object.fault(e))?;
    if facets::closed([&mesh]) {
        return Ok(mesh);
    }
    let closed = junctions::close(&mesh, JUNCTION * mesh.bounds().diagonal());
    let Closed { mesh, divided, off } =
        closed.ok_or_else(|| object.fault("its triangles do not close, so it has no inside"))?;
    let told = || format!("{}: {divided} sides of triangles, at vertices up to {off:.3e} off", object.name);
    warnings.push("sides divided", || Place::Line(object.line), told);
    Ok(mesh)
}
