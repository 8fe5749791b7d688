//! A placed primitive in a form that files have: with exact dimensions where its placement lets it keep them.
//!
//! ```text
//!   columns of its transform   at right angles               block
//!                              and x as long as y            cylinder, cone: heights scale apart from radii
//!                              all of one length             sphere, torus
//!                              any other                     exact faces, the transform carried out
//! ```

use super::baked;
use crate::construct::shapes::{block, cone, cylinder, sphere, torus};
use crate::model::{Mesh, Part, Primitive, Shape};
use glam::{DAffine3, DVec3};

/// How far axes may be from a right angle, or from one length, in shares of their lengths.
pub(super) const RIGID: f64 = 1e-12;

/// A primitive in the solid's coordinates.
#[derive(Debug)]
pub(super) enum Operand {
    /// From a corner along x, y = z × x and z.
    Block {
        corner: DVec3,
        x: DVec3,
        z: DVec3,
        size: DVec3,
    },
    Sphere {
        centre: DVec3,
        radius: f64,
    },
    /// From `base` along the axis.
    Cylinder {
        base: DVec3,
        axis: DVec3,
        radius: f64,
        height: f64,
    },
    /// From its narrow end, of radius 0 for a whole cone, along the axis; `slope` is how much wider it gets.
    Cone {
        narrow: DVec3,
        axis: DVec3,
        radius: f64,
        height: f64,
        slope: f64,
    },
    /// The minor radius may be the larger one: the apple then.
    Torus {
        centre: DVec3,
        axis: DVec3,
        major: f64,
        minor: f64,
    },
    /// The half-space behind a plane; the unit normal points out.
    HalfSpace {
        point: DVec3,
        normal: DVec3,
    },
    /// The volume within the faces of a part.
    Faces(Part),
    /// The volume within meshes, placed by a transform.
    Meshes(Vec<Mesh>, DAffine3),
}

/// The operand of a primitive that is not empty.
///
/// # Errors
/// Why no file could hold it.
pub(super) fn operand(p: &Primitive) -> Result<Operand, String> {
    let placed = Frame::new(p.transform);
    let upright = placed.square && placed.round;
    let even = upright && (placed.lengths.z - placed.lengths.x).abs() <= RIGID * placed.lengths.x;
    let at = |p| placed.transform.transform_point3(p);
    let (wide, tall) = (placed.lengths.x, placed.lengths.z);
    let axis = placed.axes[2];
    Ok(match &p.shape {
        Shape::Block { min, max } if placed.square => {
            let [x, y, z] = placed.axes;
            // a mirrored block starts at its other side
            let corner = if z.cross(x).dot(y) > 0.0 { *min } else { DVec3::new(min.x, max.y, min.z) };
            Operand::Block { corner: at(corner), x, z, size: (*max - *min) * placed.lengths }
        }
        Shape::Sphere { radius } if even => Operand::Sphere { centre: at(DVec3::ZERO), radius: radius * wide },
        Shape::Cylinder { radius, height } if upright => {
            Operand::Cylinder { base: at(DVec3::ZERO), axis, radius: radius * wide, height: height * tall }
        }
        Shape::Cone { bottom, top, height } if upright && bottom == top => {
            Operand::Cylinder { base: at(DVec3::ZERO), axis, radius: bottom * wide, height: height * tall }
        }
        Shape::Cone { bottom, top, height } if upright => {
            let down = top < bottom;
            let narrow = at(if down { DVec3::Z * *height } else { DVec3::ZERO });
            let (radius, height) = (bottom.min(*top) * wide, height * tall);
            let slope = (bottom - top).abs() * wide / height;
            Operand::Cone { narrow, axis: if down { -axis } else { axis }, radius, height, slope }
        }
        Shape::Torus { major: 0.0, minor } if even => Operand::Sphere { centre: at(DVec3::ZERO), radius: minor * wide },
        Shape::Torus { major, minor } if even => {
            Operand::Torus { centre: at(DVec3::ZERO), axis, major: major * wide, minor: minor * wide }
        }
        Shape::HalfSpace { normal, offset } => {
            let out = placed.transform.matrix3.inverse().transpose() * *normal;
            let (point, normal) = (at(*normal * (offset / normal.length_squared())), out.normalize());
            if !(point.is_finite() && normal.is_finite()) {
                return Err("its plane is beyond all numbers".into());
            }
            Operand::HalfSpace { point, normal }
        }
        Shape::Quadric(_) => return Err("is a quadric, which files of this form do not have".into()),
        Shape::Mesh(mesh) => Operand::Meshes(vec![Mesh::clone(mesh)], p.transform),
        Shape::Part(part) if part.faces.is_empty() => Operand::Meshes(part.meshes.clone(), p.transform),
        Shape::Part(part) if !part.meshes.is_empty() => {
            return Err("is bounded by faces and meshes together, which files of this form do not have".into());
        }
        stretched => Operand::Faces(baked(&faces(stretched)?, &p.transform)),
    })
}

/// Exact faces of a bounded shape in its own coordinates.
///
/// # Errors
/// Why there are none.
pub(super) fn faces(shape: &Shape) -> Result<Part, String> {
    let body = match shape {
        Shape::Block { min, max } => block(*min, *max),
        Shape::Sphere { radius } => sphere(*radius),
        Shape::Cylinder { radius, height } => cylinder(*radius, *height),
        Shape::Cone { bottom, top, height } => cone(*bottom, *top, *height),
        Shape::Torus { major, minor } => torus(*major, *minor),
        Shape::Part(part) if part.meshes.is_empty() => return Ok(Part::clone(part)),
        Shape::Part(_) | Shape::HalfSpace { .. } | Shape::Quadric(_) | Shape::Mesh(_) => {
            return Err("has no faces of its own".into());
        }
    };
    body.map(|body| body.part).map_err(|e| e.to_string())
}

/// A transform, and the lengths and angles that it keeps.
struct Frame {
    transform: DAffine3,
    /// Unit columns.
    axes: [DVec3; 3],
    lengths: DVec3,
    /// The columns stand at right angles.
    square: bool,
    /// The first two are of one length.
    round: bool,
}

impl Frame {
    fn new(transform: DAffine3) -> Self {
        let m = transform.matrix3;
        let columns = [m.x_axis, m.y_axis, m.z_axis];
        let lengths = DVec3::from(columns.map(DVec3::length));
        let axes = columns.map(DVec3::normalize);
        let across = |i: usize, j: usize| axes[i].dot(axes[j]).abs() <= RIGID;
        Self {
            transform,
            axes,
            lengths,
            square: across(0, 1) && across(1, 2) && across(2, 0),
            round: (lengths.x - lengths.y).abs() <= RIGID * lengths.x,
        }
    }
}
