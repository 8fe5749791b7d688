//! Surfaces, and how the standard's parameters map to those of `brep`.
//!
//! ```text
//!   type                       its (u, v)                     brep's (u, v)
//!   108 plane                  none                           lengths
//!   118 ruled                  [0, 1] x [0, 1]                the same: a B-spline
//!   114, 128 splines           knots                          the same
//!   120 revolution             (t, angle): profile first      (angle, t)
//!   122 tabulated cylinder     [0, 1] x [0, 1]                (t, v)
//!   190 to 198 elementary      lengths, degrees               lengths, radians
//!   140 offset                 those of its basis
//! ```
//!
//! Where the map changes the orientation, the normal of the surface in the file is the opposite of the
//! normal that `brep` computes.

use super::curve::Segment;
use super::entity::{Entity, Fault};
use super::geometry::{Geometry, Placed, finite, similarity};
use super::ruled;
use crate::brep::{self, CurveGeometry, SurfaceGeometry, SurfaceMap};
use crate::import::step::{OTHER_SIDE, OTHER_SIDE_HOW, as_cylinder, offset};
use glam::{DAffine2, DAffine3, DMat2, DVec2, DVec3};

/// A surface with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Carrier {
    /// In millimetres.
    pub surface: SurfaceGeometry,
    /// From the file's parameters to the surface's; `None` where they are not affine.
    pub to_native: Option<DAffine2>,
    /// The file's normal is the opposite of the surface's.
    pub flipped: bool,
    /// The whole surface in the file's sense, in the surface's own parameters.
    pub natural: Option<[(f64, f64); 2]>,
}

/// Types that are surfaces without bounds of their own.
pub(super) const SURFACES: [u16; 12] = [108, 114, 118, 120, 122, 128, 140, 190, 192, 194, 196, 198];

impl Carrier {
    fn new(surface: SurfaceGeometry, to_native: DAffine2, natural: Option<[(f64, f64); 2]>) -> Self {
        let flipped = to_native.matrix2.determinant() < 0.0;
        Self { surface, to_native: Some(to_native), flipped, natural }
    }

    /// The same for a face that ends where the surface ends: a profile that goes on beyond its range is cut there, and
    /// gets parameters of its own.
    pub fn bounded(self, id: u32) -> Result<Self, Fault> {
        let Some([u, v]) = self.natural else { return Ok(self) };
        let end = |profile: Box<CurveGeometry>, (start, end): (f64, f64)| match *profile {
            CurveGeometry::Circle { .. } | CurveGeometry::Ellipse { .. } => {
                let part = CurveGeometry::Trimmed { basis: profile, start, end, forward: true };
                (Box::new(CurveGeometry::Composite(vec![part])), true)
            }
            _ => (profile, false),
        };
        let (surface, axis, ended) = match self.surface {
            SurfaceGeometry::Revolution { profile, origin, axis } => {
                let (profile, ended) = end(profile, v);
                (SurfaceGeometry::Revolution { profile, origin, axis }, 1, ended)
            }
            SurfaceGeometry::Extrusion { profile, direction } => {
                let (profile, ended) = end(profile, u);
                (SurfaceGeometry::Extrusion { profile, direction }, 0, ended)
            }
            surface => return Ok(Self { surface, ..self }),
        };
        if !ended {
            return Ok(Self { surface, ..self });
        }
        let range = natural(&surface, id)?[axis].ok_or(Fault::Value { id, what: "the profile has no ends" })?;
        let natural = Some(if axis == 0 { [range, v] } else { [u, range] });
        Ok(Self { surface, to_native: None, natural, ..self })
    }
}

impl<'a> Geometry<'a> {
    /// The surface `#id`.
    pub fn surface(&self, id: u32, outer: &DAffine3) -> Result<Carrier, Fault> {
        self.surface_near(id, outer, &[])
    }

    /// The surface `#id`; of an offset, the side of its basis on which the points are, if they are on one.
    pub fn surface_near(&self, id: u32, outer: &DAffine3, points: &[DVec3]) -> Result<Carrier, Fault> {
        self.nested(id, |entity| {
            let map = self.placed(entity, outer)?;
            match entity.kind() {
                108 => self.plane(entity, &map),
                114 => {
                    let surface = self.parametric_surface(entity, &map)?;
                    let (u, v) = surface.domain();
                    Ok(Carrier::new(SurfaceGeometry::BSpline(surface), DAffine2::IDENTITY, Some([u, v])))
                }
                118 => self.ruled(entity, &map),
                120 => self.revolution(entity, &map),
                122 => self.tabulated(entity, &map),
                128 => {
                    let (surface, range) = self.bspline_surface(entity, &map)?;
                    Ok(Carrier::new(SurfaceGeometry::BSpline(surface), DAffine2::IDENTITY, Some(range)))
                }
                140 => self.offset_surface(entity, &map, points),
                190 | 192 | 194 | 196 | 198 => self.elementary(entity, &map),
                _ => Err(entity.unsupported()),
            }
        })
    }

    /// 108: A x + B y + C z = D.
    fn plane(&self, entity: Entity<'a>, map: &DAffine3) -> Result<Carrier, Fault> {
        let (normal, d) = (entity.triple(1)?, entity.real(4)?);
        let id = entity.id();
        let origin = finite(id, map.transform_point3(normal * (d / normal.length_squared())))?;
        let placed = self.frame(id, map, origin, (normal, None))?;
        let surface = SurfaceGeometry::Plane { frame: placed.frame };
        Ok(Carrier { surface, to_native: None, flipped: placed.sign < 0.0, natural: None })
    }

    /// 120: a curve about a line.
    fn revolution(&self, entity: Entity<'a>, map: &DAffine3) -> Result<Carrier, Fault> {
        let id = entity.id();
        let axis = self.segments(entity.pointer(1)?, map)?;
        let [Segment { curve: CurveGeometry::Line { origin, direction }, .. }] = axis[..] else {
            return Err(Fault::Value { id, what: "the axis of revolution is not a line" });
        };
        // a reflection turns the other way round
        let axis = if map.matrix3.determinant() < 0.0 { -direction } else { direction };
        let (start, end) = (entity.real(3)?, entity.real(4)?);
        let (start, end) = if start < end { (start, end) } else { (end, start) };
        let (profile, range) = self.profile(entity.pointer(2)?, map)?;
        let surface =
            SurfaceGeometry::Revolution { profile: Box::new(profile), origin, axis: axis.normalize_or_zero() };
        let swap = DAffine2::from_mat2(DMat2::from_cols(DVec2::Y, DVec2::X));
        Ok(match range {
            Some(range) => Carrier::new(surface, swap, Some([(start, end), range])),
            None => {
                let range = natural(&surface, id)?[1].ok_or(Fault::Value { id, what: "the profile has no ends" })?;
                Carrier { surface, to_native: None, flipped: true, natural: Some([(start, end), range]) }
            }
        })
    }

    /// 122: a curve moved so that its start comes to a given point.
    fn tabulated(&self, entity: Entity<'a>, map: &DAffine3) -> Result<Carrier, Fault> {
        let id = entity.id();
        let curve = entity.pointer(1)?;
        let segments = self.segments(curve, map)?;
        let start = segments.first().map_or(DVec3::NAN, |s| s.ends().0);
        let direction = finite(id, map.transform_point3(entity.triple(2)?))? - start;
        if !(direction.length() > 0.0 && direction.is_finite()) {
            return Err(Fault::Value { id, what: "the cylinder has no height" });
        }
        let (profile, range) = as_profile(segments);
        let surface = SurfaceGeometry::Extrusion { profile: Box::new(profile), direction };
        Ok(match range {
            Some((a, b)) => {
                let to_native = DAffine2::from_scale_angle_translation(DVec2::new(b - a, 1.0), 0.0, DVec2::new(a, 0.0));
                Carrier::new(surface, to_native, Some([(a, b), (0.0, 1.0)]))
            }
            None => {
                let range = natural(&surface, id)?[0].ok_or(Fault::Value { id, what: "the profile has no ends" })?;
                Carrier { surface, to_native: None, flipped: false, natural: Some([range, (0.0, 1.0)]) }
            }
        })
    }

    /// A curve as the profile of a surface, with its range unless it has several segments.
    fn profile(&self, id: u32, map: &DAffine3) -> Result<(CurveGeometry, Option<(f64, f64)>), Fault> {
        self.segments(id, map).map(as_profile)
    }

    /// 118: straight lines between points of two curves.
    fn ruled(&self, entity: Entity<'a>, map: &DAffine3) -> Result<Carrier, Fault> {
        let id = entity.id();
        let side = |index: usize| {
            let curve = entity.pointer(index)?;
            if Entity::find(self.file, curve)?.kind() == 116 {
                return Ok(ruled::Side::Point(self.point(curve, map)?));
            }
            Ok(ruled::Side::Curve(self.segments(curve, map)?))
        };
        let (first, second) = (side(1)?, side(2)?);
        if entity.entry.form == 0 && !(first.is_even() && second.is_even()) {
            self.note("ruled surface", id, "lines join points of equal parameters, not of equal arc length");
        }
        let surface = ruled::surface(first, second, entity.integer(3)? != 0);
        let surface = surface.map_err(|source| Fault::Spline { id, source })?;
        let unit = Some([(0.0, 1.0); 2]);
        Ok(Carrier::new(SurfaceGeometry::BSpline(surface), DAffine2::IDENTITY, unit))
    }

    /// 190 plane, 192 cylinder, 194 cone, 196 sphere, 198 torus.
    fn elementary(&self, entity: Entity<'a>, map: &DAffine3) -> Result<Carrier, Fault> {
        let id = entity.id();
        // a sphere names its radius before its axis
        let (axis, first) = if entity.kind() == 196 { (3, 2) } else { (2, 3) };
        let reference = axis + [1, 2, 3, 1, 3][usize::from(entity.kind() - 190) / 2];
        let origin = self.point(entity.pointer(1)?, map)?;
        let z = entity.optional(axis)?.map_or(Ok(DVec3::Z), |d| self.direction(d))?;
        let x = entity.optional(reference)?.map(|d| self.direction(d)).transpose()?;
        let Placed { frame, sign, scale } = self.frame(id, map, origin, (z, x))?;
        let length = |index: usize| Ok(entity.length(index)? * scale);
        let degree = 1f64.to_radians();
        let (surface, per_unit) = match entity.kind() {
            190 => (SurfaceGeometry::Plane { frame }, DVec2::splat(scale)),
            192 => (SurfaceGeometry::Cylinder { frame, radius: length(first)? }, DVec2::new(degree, sign * scale)),
            194 => {
                let half_angle = entity.real(first + 1)?.to_radians();
                let radius = entity.real(first)? * scale;
                if !(radius >= 0.0 && half_angle > 0.0 && half_angle < std::f64::consts::FRAC_PI_2) {
                    let what = "a cone needs a radius of 0 or more and an angle between 0 and 90 degrees";
                    return Err(Fault::Value { id, what });
                }
                let half_angle = half_angle * sign;
                (SurfaceGeometry::Cone { frame, radius, half_angle }, DVec2::new(degree, sign * scale))
            }
            196 => (SurfaceGeometry::Sphere { frame, radius: length(first)? }, DVec2::new(degree, sign * degree)),
            _ => {
                let (major, minor) = (length(first)?, length(first + 1)?);
                (SurfaceGeometry::Torus { frame, major, minor }, DVec2::new(degree, sign * degree))
            }
        };
        // a plane keeps both its axes in a reflection
        Ok(Carrier::new(surface, DAffine2::from_scale(per_unit), None))
    }

    /// 140: the surface at a distance on the side of an indicator.
    fn offset_surface(&self, entity: Entity<'a>, map: &DAffine3, points: &[DVec3]) -> Result<Carrier, Fault> {
        let id = entity.id();
        let basis = self.surface(entity.pointer(5)?, map)?;
        let basis = match as_cylinder(&basis.surface) {
            Some((surface, turned)) => {
                Carrier { surface, flipped: basis.flipped != turned, to_native: None, natural: None }
            }
            None => basis,
        };
        let scale = similarity(&map.matrix3).ok_or(Fault::Value { id, what: "the matrix distorts an offset" })?;
        let distance = entity.real(4)? * scale;
        let indicator = map.transform_vector3(entity.triple(1)?);
        let sign = match indicator.try_normalize() {
            Some(indicator) => side(&basis, indicator, id)?,
            None if basis.flipped => -1.0,
            None => 1.0,
        };
        let tolerance = self.file.global.resolution;
        let at = |d: f64| match offset(basis.surface.clone(), d) {
            Some(surface) => Ok((surface, 0.0)),
            None => brep::offset_surface(&basis.surface, d, tolerance).map_err(|what| Fault::Value { id, what }),
        };
        let ((surface, error), other) = brep::on_its_side(at, |s| &s.0, (distance * sign, tolerance), points)?;
        if other {
            self.note(OTHER_SIDE, id, OTHER_SIDE_HOW);
        }
        if error > tolerance {
            self.note("surface approximated", id, format!("to {error:.1e} mm"));
        }
        Ok(Carrier { surface, ..basis })
    }
}

/// 1 when the normal at the start of the surface points along the indicator, else -1.
fn side(basis: &Carrier, indicator: DVec3, id: u32) -> Result<f64, Fault> {
    let map = SurfaceMap::new(&basis.surface, 1e-6).map_err(|what| Fault::Value { id, what })?;
    let at = basis.natural.map_or(DVec2::ZERO, |[u, v]| DVec2::new(u.0, v.0));
    let jet = map.jet(at);
    Ok(if jet.du.cross(jet.dv).dot(indicator) < 0.0 { -1.0 } else { 1.0 })
}

fn as_profile(segments: Vec<Segment>) -> (CurveGeometry, Option<(f64, f64)>) {
    match <[Segment; 1]>::try_from(segments) {
        Ok([only]) => (only.curve, Some((only.start, only.end))),
        Err(several) => (CurveGeometry::Composite(several.iter().map(Segment::trimmed).collect()), None),
    }
}

/// Whole range of the parameters of a surface.
fn natural(surface: &SurfaceGeometry, id: u32) -> Result<[Option<(f64, f64)>; 2], Fault> {
    SurfaceMap::new(surface, 1e-6).map(|m| m.natural()).map_err(|what| Fault::Value { id, what })
}
