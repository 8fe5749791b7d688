//! Surfaces.
//!
//! ```text
//!   OFFSET_SURFACE('',basis,d,.F.)     plane: origin + d z       cylinder, sphere: r + d
//!                                      torus: minor + d          cone: r + d / cos a
//! ```
//!
//! An offset of an elementary surface is one again, exactly, because `S_u × S_v` points out of them. A
//! straight profile turned about a line parallel to it is a cylinder, and counts as one here. Offsets
//! of other surfaces are not rational: they are fitted, and a fit that misses the tolerance is told with
//! its error.
//!
//! RECTANGULAR_TRIMMED_SURFACE is a window of its basis, which a face without loops shows. The inner part
//! of a DEGENERATE_TOROIDAL_SURFACE (`select_outer` false, the lemon) is a surface of revolution.
//!
//! Source: ISO 10303-42, 4.5.

use super::entity::{Entity, Fault};
use super::geometry::Geometry;
use super::replica::Similarity;
use super::spline;
use crate::brep::{self, CurveGeometry, Frame, SurfaceGeometry};
use crate::spline::Surface;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, TAU};

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

const KINDS: [&str; 11] = [
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
    "SURFACE_REPLICA",
];

impl Geometry<'_> {
    /// The surface `#id`.
    pub fn surface(&self, id: u32) -> Result<Carrier, Fault> {
        self.surface_near(id, &[])
    }

    /// The surface `#id`; of a spline that breaks, the part that lies nearest to the points.
    pub fn surface_near(&self, id: u32, points: &[DVec3]) -> Result<Carrier, Fault> {
        self.ledger.nested(id, || {
            let entity = self.entity(id)?;
            if entity.kinds().any(spline::is_surface) {
                let mut parts = self.bspline_surface(entity)?;
                if parts.len() > 1 && points.is_empty() {
                    return Err(Fault::Value { id, what: "the surface breaks, and nothing says which part is meant" });
                }
                let away = |s: &Surface| {
                    let (lo, hi) = s.bounds();
                    points.iter().map(|p| p.distance_squared(p.clamp(lo, hi))).sum::<f64>()
                };
                let near = (0..parts.len()).min_by(|a, b| away(&parts[*a]).total_cmp(&away(&parts[*b])));
                return Ok(SurfaceGeometry::BSpline(parts.swap_remove(near.unwrap_or(0))).into());
            }
            let kind = KINDS.iter().copied().rfind(|k| entity.is(k));
            match kind.unwrap_or_default() {
                "" => Err(Fault::Unsupported { id, kind: entity.name() }),
                "OFFSET_SURFACE" => self.offset(entity),
                "RECTANGULAR_TRIMMED_SURFACE" => {
                    let fields = entity.fields("RECTANGULAR_TRIMMED_SURFACE", 1)?;
                    let basis = self.surface(fields.reference(0)?)?;
                    let units = self.parameter_units(&basis.surface);
                    let turn = |axis: usize| (units[axis] == self.units.angle).then_some(TAU);
                    let range = |axis: usize| {
                        let (first, last) = (fields.real(1 + 2 * axis)?, fields.real(2 + 2 * axis)?);
                        let (a, b) = if fields.flag(5 + axis) { (first, last) } else { (last, first) };
                        let (a, b) = (a * units[axis], b * units[axis]);
                        // over the seam
                        Ok((a, if b <= a { b + turn(axis).unwrap_or(0.0) } else { b }))
                    };
                    let (u, v) = (range(0)?, range(1)?);
                    let turned = fields.flag(5) != fields.flag(6);
                    let surface = SurfaceGeometry::Window { basis: Box::new(basis.surface), u, v };
                    Ok(Carrier { surface, flipped: basis.flipped != turned })
                }
                "SURFACE_REPLICA" => {
                    let fields = entity.fields("SURFACE_REPLICA", 1)?;
                    let parent = self.surface(fields.reference(0)?)?;
                    let copy = Similarity::new(self.transform(fields.reference(1)?)?).surface(parent.surface);
                    let what = "the copy has a coordinate that is not finite";
                    let (surface, turned) = copy.ok_or(Fault::Value { id, what })?;
                    Ok(Carrier { surface, flipped: parent.flipped != turned })
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
            _ => {
                // a complex instance keeps the radii in the part TOROIDAL_SURFACE
                let complex = entity.kinds().count() > 1;
                let radii = if complex { entity.fields("TOROIDAL_SURFACE", 1)? } else { fields };
                let length = |index: usize| Ok(radii.length(first + index)? * self.units.length);
                let (major, minor) = (length(0)?, length(1)?);
                let degenerate = kind == "DEGENERATE_TOROIDAL_SURFACE" && major < minor;
                let outer = fields.flag(if complex { 0 } else { first + 2 });
                if degenerate && !outer {
                    lemon(frame, major, minor)
                } else {
                    SurfaceGeometry::Torus { frame, major, minor }
                }
            }
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
        if let Some(surface) = offset(basis.surface.clone(), distance) {
            return Ok(Carrier { surface, ..basis });
        }
        let fitted = brep::offset_surface(&basis.surface, distance, self.units.tolerance);
        let (surface, error) = fitted.map_err(|what| Fault::Value { id, what })?;
        if error > self.units.tolerance {
            self.ledger.note("surface approximated", id, format!("to {error:.1e} mm"));
        }
        Ok(Carrier { surface, ..basis })
    }
}

/// The inner part of a torus that meets its axis, in the parameters of the torus: the part of its circle
/// beyond the axis, turned.
fn lemon(frame: Frame, major: f64, minor: f64) -> SurfaceGeometry {
    let circle = Frame { origin: frame.origin + frame.x * major, x: frame.x, y: frame.z, z: -frame.y };
    let profile = Box::new(CurveGeometry::Circle { frame: circle, radius: minor });
    SurfaceGeometry::Revolution { profile, origin: frame.origin, axis: frame.z }
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
        S::Window { basis, u, v } => S::Window { basis: Box::new(offset(*basis, d)?), u, v },
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
