//! Surfaces.
//!
//! ```text
//!   OFFSET_SURFACE('',basis,d,.F.)     plane: origin + d z       cylinder, sphere: r + d
//!                                      torus: minor + d          cone: r + d / cos a
//! ```
//!
//! An offset of an elementary surface is one again, exactly, because `S_u × S_v` points out of them. A straight profile
//! turned about a line parallel to it is a cylinder, and counts as one here. Offsets of other surfaces are not
//! rational: they are fitted, and a warning states the error of a fit that misses the tolerance.
//!
//! A radius below 0 is put into the formula, which gives the points, the parameters and the normal:
//!
//! ```text
//!   cylinder, cone   the same points, turned by half about z: the normal points outwards
//!   sphere           the same points, mirrored in the centre: the normal points inwards
//!   torus R < 0      the torus of -R whose tube runs the other way: the normal points into the tube, and of a
//!                    TOROIDAL_SURFACE with -R < r out of its inner part, the lemon, as writers mean it
//!   torus r < 0      the same points, by half a turn around the tube
//! ```
//!
//! RECTANGULAR_TRIMMED_SURFACE is a window of its basis, which a face without loops shows. The inner part
//! of a DEGENERATE_TOROIDAL_SURFACE (`select_outer` false, the lemon) is a surface of revolution.
//!
//! Source: ISO 10303-42, 4.5.

use super::entity::{Entity, Fault};
use super::geometry::Geometry;
use super::spline;
use crate::brep::{self, CurveGeometry, Frame, Similarity, SurfaceGeometry};
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

    /// The surface `#id`; of a spline that breaks, the part that lies nearest to the points, of an offset the side of its
    /// basis on which they are.
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
                "OFFSET_SURFACE" => self.offset(entity, points),
                "RECTANGULAR_TRIMMED_SURFACE" => {
                    let fields = entity.fields("RECTANGULAR_TRIMMED_SURFACE", 1)?;
                    let basis = self.surface_near(fields.reference(0)?, points)?;
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
                kind => self.elementary(entity, kind),
            }
        })
    }

    fn elementary(&self, entity: Entity<'_>, kind: &'static str) -> Result<Carrier, Fault> {
        let id = entity.id();
        let fields = entity.fields(kind, 1)?;
        // a complex instance keeps the position in the part ELEMENTARY_SURFACE
        let (position, first) = match entity.fields("ELEMENTARY_SURFACE", 1) {
            Ok(elementary) => (elementary.reference(0)?, 0),
            Err(_) => (fields.reference(0)?, 1),
        };
        let frame = self.frame(position)?;
        let length = |index: usize| Ok(fields.radius(first + index)? * self.units.length);
        let about_z = |radius: f64| if radius < 0.0 { Frame { x: -frame.x, y: -frame.y, ..frame } } else { frame };
        let surface = match kind {
            "PLANE" => SurfaceGeometry::Plane { frame },
            "CYLINDRICAL_SURFACE" => {
                let radius = length(0)?;
                SurfaceGeometry::Cylinder { frame: about_z(radius), radius: radius.abs() }
            }
            "SPHERICAL_SURFACE" => {
                let radius = length(0)?;
                let flipped = radius < 0.0;
                let frame = if flipped { Frame { x: -frame.x, z: -frame.z, ..frame } } else { frame };
                return Ok(Carrier { surface: SurfaceGeometry::Sphere { frame, radius: radius.abs() }, flipped });
            }
            "CONICAL_SURFACE" => {
                let radius = fields.real(first)? * self.units.length;
                let half_angle = fields.real(first + 1)? * self.units.angle;
                let (frame, half_angle) = (about_z(radius), if radius < 0.0 { -half_angle } else { half_angle });
                let radius = radius.abs();
                if half_angle == 0.0 && radius > 0.0 {
                    return Ok(SurfaceGeometry::Cylinder { frame, radius }.into());
                }
                if half_angle == 0.0 || half_angle.abs() >= FRAC_PI_2 {
                    return Err(Fault::Value { id, what: "a cone needs an angle other than 0 and below a right one" });
                }
                SurfaceGeometry::Cone { frame, radius, half_angle }
            }
            _ => {
                // a complex instance keeps the radii in the part TOROIDAL_SURFACE
                let complex = entity.kinds().count() > 1;
                let radii = if complex { entity.fields("TOROIDAL_SURFACE", 1)? } else { fields };
                let length = |index: usize| Ok(radii.radius(first + index)? * self.units.length);
                let (major, minor) = (length(0)?, length(1)?);
                let (frame, flipped) = (about_z(major), major < 0.0);
                let (major, minor) = (major.abs(), minor.abs());
                let outer = match kind {
                    "DEGENERATE_TOROIDAL_SURFACE" => fields.flag(if complex { 0 } else { first + 2 }),
                    _ => !flipped,
                };
                let surface = match major < minor && !outer {
                    true => lemon(frame, major, minor),
                    false => SurfaceGeometry::Torus { frame, major, minor },
                };
                return Ok(Carrier { surface, flipped });
            }
        };
        Ok(surface.into())
    }

    fn offset(&self, entity: Entity<'_>, points: &[DVec3]) -> Result<Carrier, Fault> {
        let id = entity.id();
        let fields = entity.fields("OFFSET_SURFACE", 1)?;
        let basis = self.surface(fields.reference(0)?)?;
        let basis = match as_cylinder(&basis.surface) {
            Some((surface, turned)) => Carrier { surface, flipped: basis.flipped != turned },
            None => basis,
        };
        let distance = fields.real(1)? * self.units.length * if basis.flipped { -1.0 } else { 1.0 };
        let tolerance = self.units.tolerance;
        let at = |d: f64| match offset(basis.surface.clone(), d) {
            Some(surface) => Ok((surface, 0.0)),
            None => brep::offset_surface(&basis.surface, d, tolerance).map_err(|what| Fault::Value { id, what }),
        };
        let ((surface, error), other) = brep::on_its_side(at, |s| &s.0, (distance, tolerance), points)?;
        if other {
            self.ledger.note(OTHER_SIDE, id, OTHER_SIDE_HOW);
        }
        if error > tolerance {
            self.ledger.note("surface approximated", id, format!("to {error:.1e} mm"));
        }
        Ok(Carrier { surface, ..basis })
    }
}

/// The warning of an offset whose edges lie on the other side of its basis.
pub(in crate::import) const OTHER_SIDE: &str = "offset on the other side";
pub(in crate::import) const OTHER_SIDE_HOW: &str = "its edges lie there, and so it is drawn";

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
