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
//!
//! *Unbounded primitives.* A plane bounds the direction across it, and an elliptic cylinder all directions across its
//! axis. Where that leaves a box infinite, boxes turned to such planes and axes are tried, and the box is around their
//! corners.

use super::convex;
use crate::model::{Bounds, Boxes, Primitive, Quadric, Shape, Solid, meet};
use glam::{BVec3, DAffine3, DMat3, DVec3};

/// Directions that differ by less are one: rounding of a placement, and of a turn.
const PARALLEL: f64 = 64.0 * f64::EPSILON;
/// Ellipsoids that are longer beside their width count as unbounded.
const LONGEST: f64 = 1e5;
/// Turned boxes that are tried, at most.
const MOST_TURNS: usize = 16;

pub(super) fn bounds(solid: &Solid) -> Bounds {
    Extent::new(solid).bounds()
}

/// A solid whose boxes along several directions are wanted.
pub(super) struct Extent<'a> {
    solid: &'a Solid,
    convex: Vec<convex::Part>,
    /// A box along the axes.
    around: Bounds,
}

impl<'a> Extent<'a> {
    pub fn new(solid: &'a Solid) -> Self {
        let mut this = Self { solid, convex: convex::parts(solid), around: Bounds::ALL };
        let along_axes = solid.bounds_over(boxes, &this.known(|p| p));
        this.around = if is_open(along_axes) { this.turned_back(along_axes) } else { along_axes };
        this
    }

    /// A box along the axes.
    pub fn bounds(&self) -> Bounds {
        self.around
    }

    /// A height along `direction`, of any length but 0, that no point of the solid exceeds: that of a box with a side
    /// across it, or of a corner of the box along the axes. Infinite where the solid may be unbounded there.
    pub fn reach(&self, direction: DVec3) -> f64 {
        let (u, v) = direction.normalize().any_orthonormal_pair();
        let far = self.boxed(DMat3::from_cols(direction, u, v).transpose()).max.x;
        if far < f64::INFINITY || is_open(self.around) {
            return far;
        }
        self.around.corners().into_iter().map(|p| direction.dot(p)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// A box of the turned solid along the axes.
    fn boxed(&self, turn: DMat3) -> Bounds {
        let turn = DAffine3::from_mat3(turn);
        let turned = |p: &Primitive| boxes(&Primitive { transform: turn * p.transform, ..p.clone() });
        self.solid.bounds_over(turned, &self.known(|p| turn.transform_point3(p)))
    }

    /// A box within `all`, of boxes that are turned to planes and axes.
    fn turned_back(&self, mut all: Bounds) -> Bounds {
        let directions = self.solid.primitives().iter().filter_map(|p| {
            let to_own = p.to_own()?;
            match &p.shape {
                Shape::HalfSpace { normal, .. } => Some(to_own.matrix3.transpose() * *normal),
                Shape::Quadric(quadric) => Some(p.transform.matrix3 * tube(quadric)?),
                _ => None,
            }
        });
        for direction in directions.filter_map(DVec3::try_normalize).take(MOST_TURNS) {
            let (u, v) = direction.any_orthonormal_pair();
            let back = DMat3::from_cols(direction, u, v);
            let turned = self.boxed(back.transpose());
            if turned.is_empty() {
                return Bounds::EMPTY;
            }
            if !is_open(turned) {
                all = meet(all, turned.corners().into_iter().map(|p| back * p).fold(Bounds::EMPTY, Bounds::with));
            }
        }
        all
    }

    /// The nodes of the convex parts, and the boxes of their corners where `turned` moves them to.
    fn known(&self, turned: impl Fn(DVec3) -> DVec3) -> Vec<(usize, Bounds)> {
        let of = |part: &convex::Part| {
            (part.node, part.corners.iter().map(|p| turned(*p)).fold(Bounds::EMPTY, Bounds::with))
        };
        self.convex.iter().map(of).collect()
    }
}

/// Whether a box is unbounded; an empty one is not.
fn is_open(of: Bounds) -> bool {
    let is_finite = of.min.is_finite() && of.max.is_finite();
    !is_finite && !of.is_empty()
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

/// Squares and products as a symmetric matrix.
fn matrix(q: &Quadric) -> DMat3 {
    let (s, m) = (q.squares, 0.5 * q.products);
    DMat3::from_cols(DVec3::new(s.x, m.x, m.z), DVec3::new(m.x, s.y, m.y), DVec3::new(m.z, m.y, s.z))
}

/// The axis of an elliptic cylinder, of length 1; `None` of other quadrics.
fn tube(q: &Quadric) -> Option<DVec3> {
    let a = matrix(q);
    let trace = q.squares.element_sum();
    // two eigenvalues are above 0 where the matrix takes one direction to nothing
    let [x, y, z] = [a.y_axis.cross(a.z_axis), a.z_axis.cross(a.x_axis), a.x_axis.cross(a.y_axis)];
    let is_round = trace > 0.0 && (x.x + y.y + z.z) * LONGEST * LONGEST > trace * trace;
    let longest = [x, y, z].into_iter().max_by(|a, b| a.length().total_cmp(&b.length()))?;
    let axis = longest.try_normalize()?;
    let is_straight = (a * axis).length() <= PARALLEL * trace;
    let is_even = q.linear.dot(axis).abs() <= PARALLEL * q.linear.length();
    (is_round && is_straight && is_even).then_some(axis)
}

/// With the matrix `A` of the squares and products, centre `c` and value `-r` there: `c · d + √(r d A⁻¹ d)`. A
/// cylinder's height across its axis is that of an ellipsoid which it touches all around.
fn ellipsoid(q: &Quadric, d: DVec3) -> f64 {
    let (s, m, a) = (q.squares, 0.5 * q.products, matrix(q));
    let minors = [s.x, s.x * s.y - m.x * m.x, a.determinant()];
    // the smallest eigenvalue is at least the determinant over the square of the largest one
    let is_closed = minors.iter().all(|x| *x > 0.0) && minors[2] * LONGEST * LONGEST > s.element_sum().powi(3);
    let a = if is_closed {
        a
    } else {
        match tube(q) {
            Some(n) if d.dot(n).abs() <= PARALLEL * d.length() => {
                a + s.element_sum() * DMat3::from_cols(n * n.x, n * n.y, n * n.z)
            }
            _ => return f64::INFINITY,
        }
    };
    let inverse = a.inverse();
    let centre = inverse * (-0.5 * q.linear);
    let rest = -q.value(centre);
    if rest < 0.0 { f64::NEG_INFINITY } else { centre.dot(d) + (rest * d.dot(inverse * d)).sqrt() }
}
