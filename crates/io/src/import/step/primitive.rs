//! Operands of Boolean expressions by dimensions, and half-spaces.
//!
//! ```text
//!   BLOCK('',axes,x,y,z)                          from the axes' origin
//!   RIGHT_ANGULAR_WEDGE('',axes,x,y,z,ltx)        a block whose side x leans: as far as ltx at y
//!   SPHERE('',radius,centre)                      ELLIPSOID('',axes,a,b,c)
//!   RIGHT_CIRCULAR_CYLINDER('',axis,height,radius)
//!   RIGHT_CIRCULAR_CONE('',axis,height,radius,semi_angle)    grows wider from `radius`, which may be 0
//!   TORUS('',axis,major,minor)
//!   RECTANGULAR_PYRAMID('',axes,x,y,height)       a corner of its base at the origin, its tip above the middle
//!   ECCENTRIC_CONE('',axes,a,b,height,x,y,ratio)  an elliptic base, a top `ratio` times as large, moved by x, y
//!   TETRAHEDRON('',(4 points))                    CONVEX_HEXAHEDRON('',(8 points)): one face, then the one opposite
//!   HALF_SPACE_SOLID('',surface,agreement)        .T.: the surface's normal points out of it
//! ```
//!
//! A half-space of a sphere, cylinder or torus is its inside, or its outside. The box around a BOXED_HALF_SPACE serves
//! searches only. A conical surface has two nappes and bounds no half-space.
//!
//! Source: ISO 10303-42, 6.4.

use super::entity::{Entity, Fault, Fields};
use super::geometry::{Geometry, frame, to_affine};
use crate::brep::SurfaceGeometry;
use crate::import::facets::triangulate;
use crate::model::{Bounds, Mesh, Quadric, Shape};
use glam::{DAffine3, DMat3, DVec3};
use std::collections::HashMap;
use std::f64::consts::FRAC_PI_2;

/// Names of operands given by their own dimensions. Unbounded ones come last.
pub(super) const PRIMITIVES: [&str; 13] = [
    "BLOCK",
    "RIGHT_ANGULAR_WEDGE",
    "SPHERE",
    "ELLIPSOID",
    "RIGHT_CIRCULAR_CYLINDER",
    "RIGHT_CIRCULAR_CONE",
    "TORUS",
    "RECTANGULAR_PYRAMID",
    "ECCENTRIC_CONE",
    "TETRAHEDRON",
    "CONVEX_HEXAHEDRON",
    "HALF_SPACE_SOLID",
    "BOXED_HALF_SPACE",
];

/// How many of them are bounded.
pub(super) const BOUNDED: usize = 11;

/// The intersection of shapes placed alike, or its complement.
#[derive(Debug)]
pub(super) struct Exact {
    pub shapes: Vec<Shape>,
    pub place: DAffine3,
    pub all_but: bool,
}

impl Geometry<'_> {
    /// One of [`PRIMITIVES`].
    pub fn primitive(&self, entity: Entity<'_>) -> Result<Exact, Fault> {
        let id = entity.id();
        let kind = PRIMITIVES.iter().copied().find(|k| entity.is(k)).ok_or_else(|| entity.not("a CSG primitive"))?;
        // a complex instance keeps the attributes common to half-spaces in a part of their own
        let fields = match kind {
            "BOXED_HALF_SPACE" => entity.fields("HALF_SPACE_SOLID", 1).or_else(|_| entity.fields(kind, 1))?,
            _ => entity.fields(kind, 1)?,
        };
        let length = |i: usize| Ok(fields.length(i)? * self.units.length);
        let axes = || Ok(to_affine(self.frame(fields.reference(0)?)?));
        let axis = || {
            let (origin, z) = self.axis(fields.reference(0)?)?;
            Ok(to_affine(frame(origin, z, None)))
        };
        let exact = |shape, place| Ok(Exact { shapes: vec![shape], place, all_but: false });
        match kind {
            "BLOCK" => {
                let max = DVec3::new(length(1)?, length(2)?, length(3)?);
                exact(Shape::Block { min: DVec3::ZERO, max }, axes()?)
            }
            "RIGHT_ANGULAR_WEDGE" => {
                let max = DVec3::new(length(1)?, length(2)?, length(3)?);
                let short = fields.real(4)? * self.units.length;
                if !(0.0..max.x).contains(&short) {
                    return Err(Fault::Value { id, what: "a wedge whose smaller side is not below its larger one" });
                }
                let normal = DVec3::new(max.y, max.x - short, 0.0);
                let lean = Shape::HalfSpace { normal, offset: max.x * max.y };
                let shapes = vec![Shape::Block { min: DVec3::ZERO, max }, lean];
                Ok(Exact { shapes, place: axes()?, all_but: false })
            }
            "SPHERE" => {
                let centre = self.point(fields.reference(1)?)?;
                exact(Shape::Sphere { radius: length(0)? }, DAffine3::from_translation(centre))
            }
            "ELLIPSOID" => {
                let half = DVec3::new(length(1)?, length(2)?, length(3)?);
                exact(Shape::Sphere { radius: 1.0 }, axes()? * DAffine3::from_scale(half))
            }
            "RIGHT_CIRCULAR_CYLINDER" => exact(Shape::Cylinder { height: length(1)?, radius: length(2)? }, axis()?),
            "RIGHT_CIRCULAR_CONE" => {
                let (height, bottom) = (length(1)?, fields.real(2)? * self.units.length);
                let angle = fields.real(3)? * self.units.angle;
                if bottom < 0.0 {
                    return Err(Fault::Value { id, what: "the radius of the cone is negative" });
                }
                if !(angle > 0.0 && angle < FRAC_PI_2) {
                    return Err(Fault::Value { id, what: "the angle of the cone is not between 0 and a right one" });
                }
                exact(Shape::Cone { bottom, top: bottom + height * angle.tan(), height }, axis()?)
            }
            "TORUS" => exact(Shape::Torus { major: length(1)?, minor: length(2)? }, axis()?),
            "RECTANGULAR_PYRAMID" => {
                let max = DVec3::new(length(1)?, length(2)?, length(3)?);
                let (tip, steep) = (DVec3::new(0.5 * max.x, 0.5 * max.y, max.z), max.z);
                let side = |normal: DVec3| Shape::HalfSpace { normal, offset: normal.dot(tip) };
                let mut shapes = vec![Shape::Block { min: DVec3::ZERO, max }];
                shapes.extend([-1.0, 1.0].map(|sign| side(DVec3::new(sign * steep, 0.0, tip.x))));
                shapes.extend([-1.0, 1.0].map(|sign| side(DVec3::new(0.0, sign * steep, tip.y))));
                Ok(Exact { shapes, place: axes()?, all_but: false })
            }
            "ECCENTRIC_CONE" => {
                let (a, b, height) = (length(1)?, length(2)?, length(3)?);
                let [x, y] = [fields.real(4)? * self.units.length, fields.real(5)? * self.units.length];
                let ratio = fields.real(6)?;
                if ratio < 0.0 {
                    return Err(Fault::Value { id, what: "the ratio of the cone's ends is negative" });
                }
                // a right circular one of radius and height 1, stretched and leaning
                let lean = DMat3::from_cols(DVec3::X * a, DVec3::Y * b, DVec3::new(x, y, height));
                let shape = match ratio == 1.0 {
                    true => Shape::Cylinder { height: 1.0, radius: 1.0 },
                    false => Shape::Cone { bottom: 1.0, top: ratio, height: 1.0 },
                };
                exact(shape, axes()? * DAffine3::from_mat3(lean))
            }
            "TETRAHEDRON" => self.polytope(fields, &[&[0, 1, 2], &[0, 1, 3], &[0, 2, 3], &[1, 2, 3]]),
            "CONVEX_HEXAHEDRON" => self.polytope(
                fields,
                &[&[0, 1, 2, 3], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]],
            ),
            _ => self.half_space(fields.reference(0)?, fields.flag(1)),
        }
    }

    /// A convex solid by its corners; `sides` are the corners of each face, in order around it.
    fn polytope(&self, fields: Fields<'_>, sides: &[&[usize]]) -> Result<Exact, Fault> {
        let fault = |what| Fault::Value { id: fields.id, what };
        let corners = fields.references(0)?.map(|p| self.point(p?)).collect::<Result<Vec<_>, _>>()?;
        if corners.len() != sides.iter().flat_map(|s| s.iter()).max().map_or(0, |last| last + 1) {
            return Err(fault("the number of its corners is not that of its kind"));
        }
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let bounds = corners.iter().copied().fold(Bounds::EMPTY, Bounds::with);
        let mut shapes = vec![Shape::Block { min: bounds.min, max: bounds.max }];
        for side in sides {
            let at = |k: usize| corners[side[k % side.len()]];
            // Newell's normal
            let normal: DVec3 = (0..side.len()).map(|k| (at(k) - middle).cross(at(k + 1) - middle)).sum();
            let normal = normal.try_normalize().ok_or(fault("a side has no area"))?;
            let normal = if normal.dot(at(0) - middle) < 0.0 { -normal } else { normal };
            let offset = side.iter().map(|k| normal.dot(corners[*k])).fold(f64::NEG_INFINITY, f64::max);
            let off = |p: &DVec3| normal.dot(*p) - offset;
            if side.iter().any(|k| off(&corners[*k]) < -self.units.tolerance) {
                return Err(fault("a side is not plane"));
            }
            if corners.iter().any(|p| off(p) > self.units.tolerance) {
                return Err(fault("it is not convex"));
            }
            shapes.push(Shape::HalfSpace { normal, offset });
        }
        Ok(Exact { shapes, place: DAffine3::IDENTITY, all_but: false })
    }

    fn half_space(&self, surface: u32, agreement: bool) -> Result<Exact, Fault> {
        let carrier = self.surface(surface)?;
        let behind = agreement != carrier.flipped;
        let (shape, frame) = match carrier.surface {
            SurfaceGeometry::Plane { frame } => {
                let normal = if behind { DVec3::Z } else { DVec3::NEG_Z };
                let shapes = vec![Shape::HalfSpace { normal, offset: 0.0 }];
                return Ok(Exact { shapes, place: to_affine(frame), all_but: false });
            }
            SurfaceGeometry::Cylinder { frame, radius } => {
                let squares = DVec3::new(1.0, 1.0, 0.0);
                (Shape::Quadric(Quadric { squares, constant: -radius * radius, ..Quadric::default() }), frame)
            }
            SurfaceGeometry::Sphere { frame, radius } => (Shape::Sphere { radius }, frame),
            SurfaceGeometry::Torus { frame, major, minor } => (Shape::Torus { major, minor }, frame),
            _ => {
                let kind = format!("a half-space of {}", self.entity(surface)?.name());
                return Err(Fault::Unsupported { id: surface, kind });
            }
        };
        Ok(Exact { shapes: vec![shape], place: to_affine(frame), all_but: !behind })
    }

    /// A FACETED_BREP of polygons without holes as triangles.
    pub fn faceted(&self, id: u32) -> Result<Mesh, Fault> {
        let solid =
            self.entity(id)?.fields("FACETED_BREP", 1).or_else(|_| self.entity(id)?.fields("MANIFOLD_SOLID_BREP", 1));
        let shell = self.entity(solid?.reference(0)?)?.fields("CLOSED_SHELL", 1)?;
        let mut known: HashMap<u32, u32> = HashMap::new();
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for face in shell.references(0)? {
            let face = self.entity(face?)?;
            let fields = face.fields("FACE_SURFACE", 1).or_else(|_| face.fields("FACE", 1))?;
            let mut bounds = fields.references(0)?;
            let (Some(bound), None) = (bounds.next(), bounds.next()) else {
                return Err(Fault::Value { id: face.id(), what: "a face of several loops" });
            };
            let bound = self.entity(bound?)?;
            let bound = bound.fields("FACE_OUTER_BOUND", 1).or_else(|_| bound.fields("FACE_BOUND", 1))?;
            let polygon = self.entity(bound.reference(0)?)?.fields("POLY_LOOP", 1)?;
            let mut corners = Vec::new();
            for point in polygon.references(0)? {
                let point = point?;
                self.ledger.spend(point, 1)?;
                let next = positions.len() as u32;
                let index = *known.entry(point).or_insert(next);
                if index == next {
                    positions.push(self.point(point)?);
                }
                corners.push(index);
            }
            if !bound.flag(1) {
                corners.reverse();
            }
            let places: Vec<DVec3> = corners.iter().map(|&c| positions[c as usize]).collect();
            triangles.extend(triangulate(&places).iter().map(|t| t.map(|k| corners[k as usize])));
        }
        Mesh::new(id, positions, triangles, Vec::new())
            .map_err(|_| Fault::Value { id, what: "a coordinate is not finite" })
    }
}
