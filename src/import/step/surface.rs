//! Surfaces.
//!
//! ```text
//!   OFFSET_SURFACE('',basis,d,.F.)     plane: origin + d z       cylinder, sphere: r + d
//!                                      torus: minor + d          cone: r + d / cos a
//! ```
//!
//! An offset of an elementary surface is one again, exactly, because `S_u × S_v` points out of them. A
//! straight profile turned about a line parallel to it is a cylinder, and counts as one here. Offsets
//! of other surfaces are not rational and not supported.
//!
//! RECTANGULAR_TRIMMED_SURFACE stands for its basis: the loops of the face bound it.
//!
//! Source: ISO 10303-42, 4.5.

use super::entity::{Entity, Fault};
use super::geometry::Geometry;
use super::spline;
use crate::brep::{CurveGeometry, Frame, SurfaceGeometry};
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// A surface, and how its normal relates to that of the entity in the file.
#[derive(Clone, Debug)]
pub(super) struct Carrier {
    /// The surface.
    pub surface: SurfaceGeometry,
    /// Its normal is the opposite of the entity's.
    pub flipped: bool,
}

impl From<SurfaceGeometry> for Carrier {
    fn from(surface: SurfaceGeometry) -> Self {
        Self { surface, flipped: false }
    }
}

const KINDS: [&str; 10] = [
    "PLANE",
    "CYLINDRICAL_SURFACE",
    "CONICAL_SURFACE",
    "SPHERICAL_SURFACE",
    "TOROIDAL_SURFACE",
    "DEGENERATE_TOROIDAL_SURFACE",
    "SURFACE_OF_LINEAR_EXTRUSION",
    "SURFACE_OF_REVOLUTION",
    "RECTANGULAR_TRIMMED_SURFACE",
    "OFFSET_SURFACE",
];

impl Geometry<'_> {
    /// The surface `#id`.
    pub fn surface(&self, id: u32) -> Result<Carrier, Fault> {
        self.ledger.nested(id, || {
            let entity = self.entity(id)?;
            if entity.kinds().any(spline::is_surface) {
                return Ok(SurfaceGeometry::BSpline(self.bspline_surface(entity)?).into());
            }
            let kind = KINDS.iter().copied().rfind(|k| entity.is(k));
            match kind.unwrap_or_default() {
                "" => Err(Fault::Unsupported { id, kind: entity.name() }),
                "OFFSET_SURFACE" => self.offset(entity),
                "RECTANGULAR_TRIMMED_SURFACE" => {
                    let fields = entity.fields("RECTANGULAR_TRIMMED_SURFACE", 1)?;
                    let basis = self.surface(fields.reference(0)?)?;
                    self.ledger.note("trimmed surface", id, "stands for its basis, bounded by the face's loops");
                    let turned = fields.flag(5) != fields.flag(6);
                    Ok(Carrier { flipped: basis.flipped != turned, ..basis })
                }
                "SURFACE_OF_LINEAR_EXTRUSION" => {
                    let fields = entity.fields("SURFACE_OF_LINEAR_EXTRUSION", 1)?;
                    let profile = Box::new(self.curve(fields.reference(0)?)?);
                    let direction = self.vector(fields.reference(1)?)?;
                    Ok(SurfaceGeometry::Extrusion { profile, direction }.into())
                }
                "SURFACE_OF_REVOLUTION" => {
                    let fields = entity.fields("SURFACE_OF_REVOLUTION", 1)?;
                    let profile = Box::new(self.curve(fields.reference(0)?)?);
                    let (origin, axis) = self.axis(fields.reference(1)?)?;
                    Ok(SurfaceGeometry::Revolution { profile, origin, axis }.into())
                }
                kind => self.elementary(entity, kind).map(Carrier::from),
            }
        })
    }

    fn elementary(&self, entity: Entity<'_>, kind: &'static str) -> Result<SurfaceGeometry, Fault> {
        let id = entity.id();
        let fields = entity.fields(kind, 1)?;
        // a complex instance keeps the position in the part ELEMENTARY_SURFACE
        let (position, first) = match entity.fields("ELEMENTARY_SURFACE", 1) {
            Ok(elementary) => (elementary.reference(0)?, 0),
            Err(_) => (fields.reference(0)?, 1),
        };
        let frame = self.frame(position)?;
        let length = |index: usize| Ok(fields.length(first + index)? * self.units.length);
        Ok(match kind {
            "PLANE" => SurfaceGeometry::Plane { frame },
            "CYLINDRICAL_SURFACE" => SurfaceGeometry::Cylinder { frame, radius: length(0)? },
            "SPHERICAL_SURFACE" => SurfaceGeometry::Sphere { frame, radius: length(0)? },
            "CONICAL_SURFACE" => {
                let radius = fields.real(first)? * self.units.length;
                let half_angle = fields.real(first + 1)? * self.units.angle;
                if half_angle == 0.0 && radius > 0.0 {
                    return Ok(SurfaceGeometry::Cylinder { frame, radius });
                }
                if radius < 0.0 || half_angle == 0.0 || half_angle.abs() >= FRAC_PI_2 {
                    return Err(Fault::Value {
                        id,
                        what: "a cone needs a radius of 0 or more and an angle below 90 degrees",
                    });
                }
                SurfaceGeometry::Cone { frame, radius, half_angle }
            }
            _ => SurfaceGeometry::Torus { frame, major: length(0)?, minor: length(1)? },
        })
    }

    fn offset(&self, entity: Entity<'_>) -> Result<Carrier, Fault> {
        let id = entity.id();
        let fields = entity.fields("OFFSET_SURFACE", 1)?;
        let basis = self.surface(fields.reference(0)?)?;
        let basis = match as_cylinder(&basis.surface) {
            Some((surface, turned)) => Carrier { surface, flipped: basis.flipped != turned },
            None => basis,
        };
        let distance = fields.real(1)? * self.units.length * if basis.flipped { -1.0 } else { 1.0 };
        let surface = offset(basis.surface, distance);
        let surface =
            surface.ok_or_else(|| Fault::Unsupported { id, kind: "OFFSET_SURFACE of this surface".into() })?;
        Ok(Carrier { surface, ..basis })
    }
}

/// The surface at `d` along its normal, if it is elementary and stays one.
pub(in crate::import) fn offset(surface: SurfaceGeometry, d: f64) -> Option<SurfaceGeometry> {
    use SurfaceGeometry as S;
    let positive = |r: f64| Some(r).filter(|r| *r > 0.0);
    Some(match surface {
        S::Plane { frame } => S::Plane { frame: Frame { origin: frame.origin + frame.z * d, ..frame } },
        S::Cylinder { frame, radius } => S::Cylinder { frame, radius: positive(radius + d)? },
        S::Sphere { frame, radius } => S::Sphere { frame, radius: positive(radius + d)? },
        S::Torus { frame, major, minor } => S::Torus { frame, major, minor: positive(minor + d)? },
        S::Cone { frame, radius, half_angle } => {
            S::Cone { frame, radius: positive(radius + d / half_angle.cos())?, half_angle }
        }
        _ => return None,
    })
}

/// A straight profile turned about an axis parallel to it; true when the cylinder's normal is the
/// opposite of the surface's.
pub(in crate::import) fn as_cylinder(surface: &SurfaceGeometry) -> Option<(SurfaceGeometry, bool)> {
    let SurfaceGeometry::Revolution { profile, origin, axis } = surface else { return None };
    let (start, direction) = straight(profile)?;
    let direction = direction.try_normalize()?;
    // parallel as far as f64 can tell after a rotation or two
    if direction.cross(*axis).length() > 1e-12 {
        return None;
    }
    let radial = (start - *origin).reject_from_normalized(*axis);
    let x = radial.try_normalize()?;
    let frame = Frame { origin: *origin, x, y: axis.cross(x), z: *axis };
    Some((SurfaceGeometry::Cylinder { frame, radius: radial.length() }, direction.dot(*axis) < 0.0))
}

/// A point and the direction of a straight curve.
fn straight(curve: &CurveGeometry) -> Option<(DVec3, DVec3)> {
    match curve {
        CurveGeometry::Line { origin, direction } => Some((*origin, *direction)),
        CurveGeometry::Trimmed { basis, forward, .. } => {
            straight(basis).map(|(p, d)| (p, if *forward { d } else { -d }))
        }
        CurveGeometry::BSpline(spline) if spline.degree() == 1 && spline.points().len() == 2 => {
            let (a, b) = spline.domain();
            Some((spline.point(a), spline.point(b) - spline.point(a)))
        }
        _ => None,
    }
}
