//! Carriers: the unbounded surfaces behind a primitive's faces, and points on them.
//!
//! ```text
//!   cylinder = { side <= 0 } * { bottom <= 0 } * { top <= 0 }       every analytic shape is the intersection
//!   block    = six planes                                          of the insides of its carriers
//! ```

use super::shape::{Quadric, Shape};
use glam::DVec3;
use std::f64::consts::TAU;

/// A surface `value(x) = 0` in the coordinates of a primitive; `value < 0` inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Carrier {
    /// `normal · x = offset`.
    Plane {
        /// Outward normal, of any length but 0.
        normal: DVec3,
        /// See the formula.
        offset: f64,
    },
    /// `q(x) = 0`.
    Quadric(Quadric),
    /// The points `minor` away from the circle of radius `major` about z; see [`Shape::Torus`].
    Torus {
        /// Radius of the circle.
        major: f64,
        /// Radius of the tube.
        minor: f64,
    },
}

impl Carrier {
    /// The plane through three corners, outward where they turn left; any plane through them where they are in line.
    pub fn of_triangle([a, b, c]: [DVec3; 3]) -> Self {
        let normal = (b - a).cross(c - a).normalize_or(DVec3::Z);
        Self::Plane { normal, offset: normal.dot((a + b + c) / 3.0) }
    }

    /// Negative inside, positive outside.
    pub fn value(&self, p: DVec3) -> f64 {
        match self {
            Self::Plane { normal, offset } => normal.dot(p) - offset,
            Self::Quadric(q) => q.value(p),
            Self::Torus { major, minor } => {
                let out = p.x.hypot(p.y) - major;
                out * out + p.z * p.z - minor * minor
            }
        }
    }

    /// Gradient of [`Carrier::value`]: points out; zero at an apex.
    pub fn gradient(&self, p: DVec3) -> DVec3 {
        match self {
            Self::Plane { normal, .. } => *normal,
            Self::Quadric(q) => q.gradient(p),
            Self::Torus { major, .. } => {
                let axial = DVec3::new(p.x, p.y, 0.0);
                2.0 * (p - axial.normalize_or_zero() * *major)
            }
        }
    }
}

/// Points around a circle of the samples.
const AROUND: u32 = 9;

fn circle(radius: f64, z: f64) -> impl Iterator<Item = DVec3> {
    (0..AROUND).map(move |k| {
        let (s, c) = (TAU * f64::from(k) / f64::from(AROUND)).sin_cos();
        DVec3::new(radius * c, radius * s, z)
    })
}

/// A disc's rim and centre.
fn disc(radius: f64, z: f64) -> Vec<DVec3> {
    circle(radius, z).chain([DVec3::new(0.0, 0.0, z)]).collect()
}

impl Shape {
    /// The carriers of the shape in order: of a block -x +x -y +y -z +z, of a cylinder or cone side, bottom,
    /// top, of a mesh the plane of each triangle; none of a part.
    pub fn carriers(&self) -> Vec<Carrier> {
        let plane = |normal: DVec3, offset: f64| Carrier::Plane { normal, offset };
        let round = |quadric: Quadric, height: f64| {
            vec![Carrier::Quadric(quadric), plane(DVec3::NEG_Z, 0.0), plane(DVec3::Z, height)]
        };
        match self {
            Self::HalfSpace { normal, offset } => vec![plane(*normal, *offset)],
            Self::Block { min, max } => {
                let axes = [DVec3::X, DVec3::Y, DVec3::Z];
                axes.iter().flat_map(|a| [plane(-*a, -min.dot(*a)), plane(*a, max.dot(*a))]).collect()
            }
            Self::Sphere { radius } => {
                vec![Carrier::Quadric(Quadric {
                    squares: DVec3::ONE,
                    constant: -radius * radius,
                    ..Quadric::default()
                })]
            }
            Self::Cylinder { radius, height } => {
                let squares = DVec3::new(1.0, 1.0, 0.0);
                round(Quadric { squares, constant: -radius * radius, ..Quadric::default() }, *height)
            }
            // x² + y² <= (bottom + slope z)²
            Self::Cone { bottom, top, height } => {
                let slope = if *height > 0.0 { (top - bottom) / height } else { 0.0 };
                let quadric = Quadric {
                    squares: DVec3::new(1.0, 1.0, -slope * slope),
                    linear: DVec3::new(0.0, 0.0, -2.0 * bottom * slope),
                    constant: -bottom * bottom,
                    ..Quadric::default()
                };
                round(quadric, *height)
            }
            Self::Torus { major, minor } => vec![Carrier::Torus { major: *major, minor: *minor }],
            Self::Quadric(q) => vec![Carrier::from(*q)],
            Self::Mesh(mesh) => (0..mesh.triangles().len()).map(|t| Carrier::of_triangle(mesh.corners(t))).collect(),
            Self::Part(_) => Vec::new(),
        }
    }

    /// Points on each carrier, in order, that reach as far as its face does and determine it; for unbounded shapes
    /// within `reach` of `about`.
    pub(super) fn samples(&self, about: DVec3, reach: f64) -> Vec<Vec<DVec3>> {
        match self {
            Self::HalfSpace { normal, offset } => {
                let n = normal.normalize();
                let foot = about - n * (n.dot(about) - offset / normal.length());
                let (u, v) = n.any_orthonormal_pair();
                vec![[u, -u, v, -v, DVec3::ZERO].iter().map(|d| foot + *d * reach).collect()]
            }
            Self::Block { min, max } => {
                let corners = crate::model::Bounds { min: *min, max: *max }.corners();
                let side =
                    |axis: usize, high: usize| (0..8).filter(move |i| i >> axis & 1 == high).map(move |i| corners[i]);
                (0..6).map(|face| side(face / 2, face % 2).collect()).collect()
            }
            Self::Sphere { radius: r } => {
                let rings = [-0.8, 0.0, 0.6].into_iter().flat_map(|z: f64| circle(r * (1.0 - z * z).sqrt(), r * z));
                vec![rings.chain([DVec3::Z * *r]).collect()]
            }
            Self::Cylinder { radius: r, height } => {
                vec![circle(*r, 0.0).chain(circle(*r, *height)).collect(), disc(*r, 0.0), disc(*r, *height)]
            }
            Self::Cone { bottom, top, height } => {
                let wide = bottom.max(*top); // a cap at an apex is still a plane
                let side = [0.0, 0.5, 1.0].map(|h| circle(bottom + (top - bottom) * h, height * h));
                vec![side.into_iter().flatten().collect(), disc(wide, 0.0), disc(wide, *height)]
            }
            Self::Torus { major, minor } => {
                let ring = |k: u32| {
                    let (s, c) = (TAU * f64::from(k) / 7.0).sin_cos();
                    circle(major + minor * c, minor * s)
                };
                vec![(0..7).flat_map(ring).collect()]
            }
            Self::Quadric(q) => vec![quadric_samples(q, about, reach)],
            Self::Mesh(mesh) => (0..mesh.triangles().len()).map(|t| mesh.corners(t).to_vec()).collect(),
            Self::Part(_) => Vec::new(),
        }
    }
}

/// Points of a quadric on lines through the ball of radius `reach` about `about`.
fn quadric_samples(q: &Quadric, about: DVec3, reach: f64) -> Vec<DVec3> {
    let mut found = Vec::new();
    for i in 0..48 {
        // directions and offsets of two golden spirals
        let turn = |k: f64, step: f64| {
            let z = 1.0 - 2.0 * (k * step).fract();
            let (s, c) = (k * 2.399_963_229_728_653).sin_cos();
            DVec3::new(c, s, 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
        };
        let k = f64::from(i) + 0.5;
        let d = turn(k, 0.618_033_988_749_895) * reach;
        let o = about + turn(k, 0.754_877_666_246_693) * (reach * (k * 0.569_840_290_998_053).fract());
        let (a, b, c) = (0.5 * q.slope(d).dot(d), q.gradient(o).dot(d), q.value(o));
        let root = b * b - 4.0 * a * c;
        let far = -0.5 * (b + b.signum() * root.max(0.0).sqrt()); // no cancellation
        let roots = if root < 0.0 { [f64::NAN; 2] } else { [c / far, far / a] };
        found.extend(roots.iter().filter(|t| t.abs() <= 1.0).map(|t| o + d * *t));
    }
    found
}
