//! Boxes of Boolean solids.
//!
//! ```text
//!   primitive, placed by M, t:   max e · (M x + t) = h(Mᵀ e) + e · t      h: its support, by formula
//!
//!   A + B   box of both          A * B   what both boxes hold
//!   A - B   box of A, less where a block B goes right through it and takes one of its ends
//! ```
//!
//! *Certainty.* The box contains the solid. It is tight for one primitive, for a block that half-spaces cut and for
//! half-spaces that enclose something (see [`convex`]), and for unions of these, to rounding. It is also tight where
//! blocks along the axes, half-spaces across them and tight boxes meet in a box. Otherwise it may be larger: where
//! boxes meet and solids do not, and where a difference removes the farthest points.

use super::convex;
use crate::model::{Bounds, Boxes, Primitive, Quadric, Shape, Solid};
use glam::{BVec3, DAffine3, DMat3, DVec3};

/// Directions that differ by less are one: rounding of a placement.
const PARALLEL: f64 = 8.0 * f64::EPSILON;
/// Ellipsoids that are longer beside their width count as unbounded.
const LONGEST: f64 = 1e5;

pub(super) fn bounds(solid: &Solid) -> Bounds {
    Extent::new(solid).bounds()
}

/// A solid whose boxes along several directions are wanted.
pub(super) struct Extent<'a> {
    solid: &'a Solid,
    convex: Vec<convex::Part>,
}

impl<'a> Extent<'a> {
    pub fn new(solid: &'a Solid) -> Self {
        Self { solid, convex: convex::parts(solid) }
    }

    /// A box along the axes.
    pub fn bounds(&self) -> Bounds {
        self.solid.bounds_over(boxes, &self.known(|p| p))
    }

    /// A height along `direction`, of any length but 0, that no point of the solid exceeds: that of a box with a side
    /// across it. Infinite where the solid may be unbounded there.
    pub fn reach(&self, direction: DVec3) -> f64 {
        let (u, v) = direction.normalize().any_orthonormal_pair();
        let turn = DAffine3::from_mat3(DMat3::from_cols(direction, u, v).transpose());
        let turned = |p: &Primitive| boxes(&Primitive { transform: turn * p.transform, ..p.clone() });
        self.solid.bounds_over(turned, &self.known(|p| turn.transform_point3(p))).max.x
    }

    /// The nodes of the convex parts, and the boxes of their corners where `turned` moves them to.
    fn known(&self, turned: impl Fn(DVec3) -> DVec3) -> Vec<(usize, Bounds)> {
        let of = |part: &convex::Part| {
            (part.node, part.corners.iter().map(|p| turned(*p)).fold(Bounds::EMPTY, Bounds::with))
        };
        self.convex.iter().map(of).collect()
    }
}

fn boxes(primitive: &Primitive) -> Boxes {
    let flat = match &primitive.shape {
        Shape::Part(_) => false,
        shape => shape.bounds().is_empty(),
    };
    if flat || primitive.to_own().is_none() {
        return Boxes::around(Bounds::EMPTY);
    }
    match &primitive.shape {
        Shape::Part(part) => {
            let of = part.bounds_placed(primitive.transform);
            let is_flat = !of.min.cmplt(of.max).all();
            Boxes::around(if is_flat { Bounds::EMPTY } else { of })
        }
        Shape::HalfSpace { normal, offset } => {
            let of = placed(primitive, |d| half_space(*normal, *offset, d));
            let not = placed(primitive, |d| half_space(-*normal, -*offset, d));
            Boxes { of, not, within: if of == Bounds::ALL { Bounds::EMPTY } else { of } }
        }
        Shape::Block { .. } => {
            let of = placed(primitive, |d| support(&primitive.shape, d));
            let m = primitive.transform.matrix3;
            let is_along_axes = [m.x_axis, m.y_axis, m.z_axis].iter().all(|axis| is_along_axis(*axis));
            Boxes { within: if is_along_axes { of } else { Bounds::EMPTY }, ..Boxes::around(of) }
        }
        shape => Boxes::around(placed(primitive, |d| support(shape, d))),
    }
}

fn is_along_axis(v: DVec3) -> bool {
    let BVec3 { x, y, z } = v.cmpeq(DVec3::ZERO);
    u8::from(x) + u8::from(y) + u8::from(z) == 2
}

/// The box of a placed shape with a known support, own coordinates.
fn placed(primitive: &Primitive, support: impl Fn(DVec3) -> f64) -> Bounds {
    let transposed = primitive.transform.matrix3.transpose();
    let t = primitive.transform.translation;
    let far = |e: DVec3| support(transposed * e) + e.dot(t);
    let max = DVec3::new(far(DVec3::X), far(DVec3::Y), far(DVec3::Z));
    let below = DVec3::new(far(DVec3::NEG_X), far(DVec3::NEG_Y), far(DVec3::NEG_Z));
    let bounds = Bounds { min: 0.0 - below, max };
    if bounds.is_empty() { Bounds::EMPTY } else { bounds }
}

fn half_space(normal: DVec3, offset: f64, d: DVec3) -> f64 {
    let is_across = d.cross(normal).length() <= PARALLEL * d.length() * normal.length();
    if is_across && d.dot(normal) > 0.0 { offset * d.dot(normal) / normal.length_squared() } else { f64::INFINITY }
}

/// The largest `d · x` of a shape, own coordinates; infinite where it is unbounded.
fn support(shape: &Shape, d: DVec3) -> f64 {
    let around = d.truncate().length();
    match shape {
        Shape::Block { min, max } => d.dot(DVec3::select(d.cmpgt(DVec3::ZERO), *max, *min)),
        Shape::Sphere { radius } => radius * d.length(),
        Shape::Cylinder { radius, height } => radius * around + (height * d.z).max(0.0),
        Shape::Cone { bottom, top, height } => (bottom * around).max(top * around + height * d.z),
        Shape::Torus { major, minor } => major * around + minor * d.length(),
        Shape::Quadric(quadric) => ellipsoid(quadric, d),
        Shape::Mesh(mesh) => {
            let corners = mesh.triangles().iter().flatten().map(|v| d.dot(mesh.positions()[*v as usize]));
            corners.fold(f64::NEG_INFINITY, f64::max)
        }
        // `boxes` treats these itself
        Shape::HalfSpace { .. } | Shape::Part(_) => f64::INFINITY,
    }
}

/// With the matrix `A` of the squares and products, centre `c` and value `-r` there: `c · d + √(r d A⁻¹ d)`.
fn ellipsoid(q: &Quadric, d: DVec3) -> f64 {
    let (s, m) = (q.squares, 0.5 * q.products);
    let a = DMat3::from_cols(DVec3::new(s.x, m.x, m.z), DVec3::new(m.x, s.y, m.y), DVec3::new(m.z, m.y, s.z));
    let minors = [s.x, s.x * s.y - m.x * m.x, a.determinant()];
    // the smallest eigenvalue is at least the determinant over the square of the largest one
    let is_closed = minors.iter().all(|x| *x > 0.0) && minors[2] * LONGEST * LONGEST > (s.x + s.y + s.z).powi(3);
    if !is_closed {
        return f64::INFINITY;
    }
    let inverse = a.inverse();
    let centre = inverse * (-0.5 * q.linear);
    let rest = -q.value(centre);
    if rest < 0.0 { f64::NEG_INFINITY } else { centre.dot(d) + (rest * d.dot(inverse * d)).sqrt() }
}
