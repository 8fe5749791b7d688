//! Copies of curves and surfaces under a similarity: replicas, plane curves placed in space, parts of sweeps.
//!
//! The copy keeps the parameters, except where a surface is mirrored and its formula needs a right-handed frame: there
//! `u` runs the other way, and the normal of the formula is the opposite of the copy's.

use super::{CurveGeometry, Frame, SurfaceGeometry};
use crate::spline::{BSpline, Control, Surface};
use glam::{DAffine3, DVec3, DVec4};

/// How a similarity maps frames and lengths.
#[derive(Clone, Copy, Debug)]
pub struct Similarity {
    map: DAffine3,
    scale: f64,
    mirrored: bool,
}

impl Similarity {
    /// `map` has axes of one length at right angles.
    pub fn new(map: DAffine3) -> Self {
        let volume = map.matrix3.determinant();
        Self { map, scale: volume.abs().cbrt(), mirrored: volume < 0.0 }
    }

    /// The image of a point.
    pub fn point(&self, p: DVec3) -> DVec3 {
        self.map.transform_point3(p)
    }

    fn unit(&self, d: DVec3) -> DVec3 {
        self.map.transform_vector3(d) / self.scale
    }

    /// The frame that keeps x and y.
    fn flat(&self, f: Frame) -> Frame {
        let (x, y) = (self.unit(f.x), self.unit(f.y));
        Frame { origin: self.point(f.origin), x, y, z: x.cross(y) }
    }

    /// The right-handed frame that keeps x and z.
    fn turned(&self, f: Frame) -> Frame {
        let (x, z) = (self.unit(f.x), self.unit(f.z));
        Frame { origin: self.point(f.origin), x, y: z.cross(x), z }
    }

    fn control(&self, p: DVec4) -> DVec4 {
        DVec4::from_point(self.point(p.point()), p.w)
    }

    /// The image of a curve; `None` if its numbers overflow.
    pub fn curve(&self, curve: CurveGeometry) -> Option<CurveGeometry> {
        use CurveGeometry as C;
        let s = self.scale;
        Some(match curve {
            C::Line { origin, direction } => {
                C::Line { origin: self.point(origin), direction: self.map.transform_vector3(direction) }
            }
            C::Circle { frame, radius } => C::Circle { frame: self.flat(frame), radius: radius * s },
            C::Ellipse { frame, semi_x, semi_y } => {
                C::Ellipse { frame: self.flat(frame), semi_x: semi_x * s, semi_y: semi_y * s }
            }
            C::Hyperbola { frame, semi_x, semi_y } => {
                C::Hyperbola { frame: self.flat(frame), semi_x: semi_x * s, semi_y: semi_y * s }
            }
            C::Parabola { frame, focal } => C::Parabola { frame: self.flat(frame), focal: focal * s },
            C::BSpline(b) => {
                let points = b.points().iter().map(|p| self.control(*p)).collect();
                C::BSpline(BSpline::new(b.degree(), b.knots().to_vec(), points).ok()?)
            }
            C::Trimmed { basis, start, end, forward } => {
                C::Trimmed { basis: Box::new(self.curve(*basis)?), start, end, forward }
            }
            C::Composite(parts) => C::Composite(parts.into_iter().map(|p| self.curve(p)).collect::<Option<_>>()?),
        })
    }

    /// The image of a surface, and whether the normal of its formula is the opposite of the image's.
    pub fn surface(&self, surface: SurfaceGeometry) -> Option<(SurfaceGeometry, bool)> {
        use SurfaceGeometry as S;
        let s = self.scale;
        let mirrored = self.mirrored;
        Some(match surface {
            S::Plane { frame } => (S::Plane { frame: self.flat(frame) }, false),
            S::Cylinder { frame, radius } => (S::Cylinder { frame: self.turned(frame), radius: radius * s }, mirrored),
            S::Cone { frame, radius, half_angle } => {
                (S::Cone { frame: self.turned(frame), radius: radius * s, half_angle }, mirrored)
            }
            S::Sphere { frame, radius } => (S::Sphere { frame: self.turned(frame), radius: radius * s }, mirrored),
            S::Torus { frame, major, minor } => {
                (S::Torus { frame: self.turned(frame), major: major * s, minor: minor * s }, mirrored)
            }
            S::Revolution { profile, origin, axis } => {
                let profile = Box::new(self.curve(*profile)?);
                (S::Revolution { profile, origin: self.point(origin), axis: self.unit(axis) }, mirrored)
            }
            S::Extrusion { profile, direction } => {
                let profile = Box::new(self.curve(*profile)?);
                (S::Extrusion { profile, direction: self.map.transform_vector3(direction) }, false)
            }
            S::BSpline(b) => {
                let points = b.points().iter().map(|p| self.control(*p)).collect();
                let (ku, kv) = b.knots();
                (S::BSpline(Surface::new(b.degrees(), ku.to_vec(), kv.to_vec(), points).ok()?), false)
            }
            S::Window { basis, u, v } => {
                let [su, sv] = length_axes(&basis).map(|is| if is { s } else { 1.0 });
                let (basis, flipped) = self.surface(*basis)?;
                let (a, b) = if flipped { (-u.1, -u.0) } else { u };
                (S::Window { basis: Box::new(basis), u: (a * su, b * su), v: (v.0 * sv, v.1 * sv) }, flipped)
            }
        })
    }
}

/// Parameters that are lengths, for which a larger copy needs larger numbers.
fn length_axes(surface: &SurfaceGeometry) -> [bool; 2] {
    match surface {
        SurfaceGeometry::Plane { .. } => [true; 2],
        SurfaceGeometry::Cylinder { .. } | SurfaceGeometry::Cone { .. } => [false, true],
        _ => [false; 2],
    }
}
