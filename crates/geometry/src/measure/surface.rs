//! The plane, cylinder, cone, sphere or torus of a face, found from its surface in `f64`.
//!
//! ```text
//!   plane      all normals agree          cylinder   normals ⟂ axis, normal lines meet it at one distance
//!   sphere     normal lines meet          cone       normals at one angle to the axis, tangent planes meet
//!   torus      points at one distance along the normals lie on a circle
//! ```
//!
//! A shape counts when every sampled point is on it within [`SAME`] of its size, so a B-spline in the form of a
//! cylinder counts as one. Radii are as exact as the surface's control points.

use crate::edges::curve::{SAME, circle_through};
use crate::model::Face;
use glam::{DAffine3, DMat3, DVec3};

/// Points along each side of the face's part of the domain.
const LOOKS: usize = 5;

/// The shape of a face's surface: points and radii in model units, unit directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SurfaceShape {
    /// A plane.
    Plane {
        /// Across the plane.
        normal: DVec3,
        /// A point of the plane.
        point: DVec3,
    },
    /// A circular cylinder.
    Cylinder {
        /// Along the cylinder.
        axis: DVec3,
        /// A point of the axis.
        point: DVec3,
        /// Of the circle.
        radius: f64,
    },
    /// A circular cone.
    Cone {
        /// From the apex towards the face.
        axis: DVec3,
        /// The tip.
        apex: DVec3,
        /// Between axis and side, radians.
        half_angle: f64,
    },
    /// A sphere.
    Sphere {
        /// Of the sphere.
        centre: DVec3,
        /// Of the sphere.
        radius: f64,
    },
    /// A torus.
    Torus {
        /// Across the circle through the middle of the tube.
        axis: DVec3,
        /// Of that circle.
        centre: DVec3,
        /// Of that circle.
        major: f64,
        /// Of the tube.
        minor: f64,
    },
    /// None of these.
    Other,
}

impl SurfaceShape {
    /// The direction that angles are measured to: a plane's normal, an axis.
    pub fn direction(&self) -> Option<DVec3> {
        match *self {
            Self::Plane { normal, .. } => Some(normal),
            Self::Cylinder { axis, .. } | Self::Cone { axis, .. } | Self::Torus { axis, .. } => Some(axis),
            Self::Sphere { .. } | Self::Other => None,
        }
    }

    /// The point or line that distances between middles are measured to.
    pub fn middle(&self) -> Option<(DVec3, Option<DVec3>)> {
        match *self {
            Self::Cylinder { axis, point, .. } => Some((point, Some(axis))),
            Self::Cone { axis, apex, .. } => Some((apex, Some(axis))),
            Self::Torus { axis, centre, .. } => Some((centre, Some(axis))),
            Self::Sphere { centre, .. } => Some((centre, None)),
            Self::Plane { .. } | Self::Other => None,
        }
    }
}

/// Points and unit normals of the face's part of its surface.
fn looks(face: &Face, transform: DAffine3) -> Vec<(DVec3, DVec3)> {
    let ((u0, u1), (v0, v1)) = face.surface.domain();
    let whole = (glam::DVec2::new(u0, v0), glam::DVec2::new(u1, v1));
    let none = (glam::DVec2::INFINITY, glam::DVec2::NEG_INFINITY);
    let of_loops = face.loops.iter().map(|l| l.bounds()).fold(none, |(l, h), (a, b)| (l.min(a), h.max(b)));
    let (low, high) = if face.loops.is_empty() { whole } else { (of_loops.0.max(whole.0), of_loops.1.min(whole.1)) };
    let share = |i: usize| (i as f64 + 0.37) / LOOKS as f64; // off knots and seams
    let mut all = Vec::with_capacity(LOOKS * LOOKS);
    for (i, j) in (0..LOOKS).flat_map(|i| (0..LOOKS).map(move |j| (i, j))) {
        let uv = low + (high - low) * glam::DVec2::new(share(i), share(j));
        let jet = face.surface.jet2(uv.x, uv.y);
        let cross = transform.transform_vector3(jet.du).cross(transform.transform_vector3(jet.dv));
        if let Some(normal) = cross.try_normalize() {
            all.push((transform.transform_point3(jet.point), normal));
        }
    }
    all
}

/// The shape of a placed face's surface.
pub fn shape(face: &Face, transform: DAffine3) -> SurfaceShape {
    let looks = looks(face, transform);
    let Some(&(p0, n0)) = looks.first().filter(|_| looks.len() >= LOOKS) else { return SurfaceShape::Other };
    let size = looks.iter().map(|(p, _)| p.distance(p0)).fold(0.0, f64::max);
    if looks.iter().all(|(p, _)| (*p - p0).dot(n0).abs() <= SAME * size) {
        return SurfaceShape::Plane { normal: n0, point: p0 };
    }
    let found = sphere(&looks).or_else(|| cylinder(&looks)).or_else(|| cone(&looks)).or_else(|| torus(&looks));
    found.unwrap_or(SurfaceShape::Other)
}

type Look = (DVec3, DVec3);

/// The sample whose normal differs most from another's.
fn most_turned(looks: &[Look], from: DVec3) -> Look {
    let turned = |look: &&Look| look.1.cross(from).length_squared();
    *looks.iter().max_by(|a, b| turned(a).total_cmp(&turned(b))).unwrap_or(&looks[0])
}

fn sphere(looks: &[Look]) -> Option<SurfaceShape> {
    let (p, n) = looks[0];
    let (q, m) = most_turned(looks, n);
    let along = (p - q).dot(m - n) / (m - n).length_squared();
    let (centre, radius) = (p + n * along, along.abs());
    let on = |(p, _): &Look| (p.distance(centre) - radius).abs() <= SAME * radius;
    looks.iter().all(on).then_some(SurfaceShape::Sphere { centre, radius })
}

fn cylinder(looks: &[Look]) -> Option<SurfaceShape> {
    let (p, n) = looks[0];
    let (q, m) = most_turned(looks, n);
    let axis = n.cross(m).try_normalize()?;
    let apart = (p - q).reject_from_normalized(axis);
    let along = apart.dot(m - n) / (m - n).length_squared();
    let (point, radius) = (p + n * along, along.abs());
    let on = |(p, _): &Look| ((*p - point).reject_from_normalized(axis).length() - radius).abs() <= SAME * radius;
    looks.iter().all(on).then_some(SurfaceShape::Cylinder { axis, point, radius })
}

fn cone(looks: &[Look]) -> Option<SurfaceShape> {
    let (p, n) = looks[0];
    let (q, m) = most_turned(looks, n);
    // the third one farthest from the plane of differences of the first two
    let apart = |look: &&Look| (look.1 - n).cross(m - n).length_squared();
    let (r, k) = *looks.iter().max_by(|a, b| apart(a).total_cmp(&apart(b)))?;
    let axis = (m - n).cross(k - n).try_normalize()?;
    let planes = DMat3::from_cols(n, m, k).transpose();
    if planes.determinant().abs() < 1e-12 {
        return None;
    }
    let apex = planes.inverse() * DVec3::new(n.dot(p), m.dot(q), k.dot(r));
    // towards the side on which the face is
    let axis = if (p - apex).dot(axis) < 0.0 { -axis } else { axis };
    let half_angle = n.dot(axis).abs().asin();
    let (sin, cos) = half_angle.sin_cos();
    let on = |(p, _): &Look| {
        let from = *p - apex;
        let (height, away) = (from.dot(axis), from.reject_from_normalized(axis).length());
        (away * cos - height * sin).abs() <= SAME * from.length()
    };
    looks.iter().all(on).then_some(SurfaceShape::Cone { axis, apex, half_angle })
}

/// By the radius of curvature that all points share.
fn torus(looks: &[Look]) -> Option<SurfaceShape> {
    // the tube's circle through points along the normals: its radius solves one equation, which follows from three
    // samples and the condition that all middles lie in one plane
    let (p, n) = looks[0];
    let axis = torus_axis(looks)?;
    let height = |x: DVec3| x.dot(axis);
    let (q, m) =
        *looks.iter().max_by(|a, b| (height(a.1) - height(n)).abs().total_cmp(&(height(b.1) - height(n)).abs()))?;
    let along = (height(p) - height(q)) / (height(m) - height(n));
    let middles: Vec<DVec3> = looks.iter().map(|(p, n)| *p + *n * along).collect();
    let circle = circle_through(&middles)?;
    let minor = along.abs();
    let (centre, axis, major) = (circle.centre, circle.axis, circle.radius);
    let on = |(p, _): &Look| {
        let from = *p - centre;
        let (up, away) = (from.dot(axis), from.reject_from_normalized(axis).length());
        ((away - major).hypot(up) - minor).abs() <= SAME * major.max(minor)
    };
    looks.iter().all(on).then_some(SurfaceShape::Torus { axis, centre, major, minor })
}

/// The line that all normal lines meet, by least squares in its Plücker coordinates: `d · (p × n) + c · n = 0`.
fn torus_axis(looks: &[Look]) -> Option<DVec3> {
    // scaled and centred, so that both halves of the six unknowns are of one size
    let middle = looks.iter().map(|(p, _)| *p).sum::<DVec3>() / looks.len() as f64;
    let size = looks.iter().map(|(p, _)| p.distance(middle)).fold(0.0, f64::max);
    let mut normal = [[0.0; 6]; 6];
    for (p, n) in looks {
        let moment = ((*p - middle) / size).cross(*n);
        let row = [moment.x, moment.y, moment.z, n.x, n.y, n.z];
        for i in 0..6 {
            for j in 0..6 {
                normal[i][j] += row[i] * row[j];
            }
        }
    }
    let line = smallest(normal)?;
    DVec3::new(line[0], line[1], line[2]).try_normalize()
}

/// The eigenvector of the smallest eigenvalue of a symmetric matrix, by Jacobi's rotations.
///
/// Source: G. Golub, C. Van Loan, *Matrix Computations*, 2013, section 8.5.
fn smallest(mut a: [[f64; 6]; 6]) -> Option<[f64; 6]> {
    let mut vectors = [[0.0; 6]; 6];
    (0..6).for_each(|i| vectors[i][i] = 1.0);
    for _ in 0..60 {
        for p in 0..5 {
            for q in p + 1..6 {
                if a[p][q] == 0.0 {
                    continue;
                }
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t * c;
                for row in a.iter_mut().chain(&mut vectors) {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
                let (above, below) = (a[p], a[q]);
                for (k, (x, y)) in above.into_iter().zip(below).enumerate() {
                    (a[p][k], a[q][k]) = (c * x - s * y, s * x + c * y);
                }
            }
        }
    }
    let least = (0..6).min_by(|i, j| a[*i][*i].total_cmp(&a[*j][*j]))?;
    let vector = vectors.map(|row| row[least]);
    vector.iter().all(|x| x.is_finite()).then_some(vector)
}
