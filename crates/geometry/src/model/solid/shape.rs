//! Primitives: the bounded solids and half-spaces at the leaves.
//!
//! ```text
//!   own coordinates                                              z│   ___ top radius
//!     half-space  n·x <= d             block     min..max         │  ╱   ╲
//!     sphere      about the origin     cylinder  z in 0..height   │ ╱     ╲   cone: radii at z = 0 and height
//!     torus       about the z axis     quadric   q(x) <= 0        └───────── bottom radius
//!     mesh, part  the volume inside their closed surfaces
//! ```

use crate::model::{Bounds, Colour, Mesh, Part};
use glam::{DAffine3, DVec3};
use std::sync::Arc;

/// The set of points of a primitive, in its own coordinates. All sets are closed.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Shape {
    /// Points with `normal · x <= offset`; the normal, of any length but 0, points out.
    HalfSpace {
        /// Outward normal.
        normal: DVec3,
        /// Distance of the plane from the origin times the normal's length.
        offset: f64,
    },
    /// A box with its sides along the axes.
    Block {
        /// Smallest coordinates.
        min: DVec3,
        /// Largest coordinates.
        max: DVec3,
    },
    /// A ball about the origin.
    Sphere {
        /// Its radius.
        radius: f64,
    },
    /// A round cylinder about the z axis from `z = 0`.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Its length.
        height: f64,
    },
    /// A round cone about the z axis from `z = 0`, whole (one radius 0) or truncated.
    Cone {
        /// Radius at `z = 0`.
        bottom: f64,
        /// Radius at `z = height`.
        top: f64,
        /// Its length.
        height: f64,
    },
    /// All points within `minor` of a circle about the z axis; where `minor > major`, the lemon around
    /// the centre belongs to it.
    Torus {
        /// Radius of the circle.
        major: f64,
        /// Radius of the tube.
        minor: f64,
    },
    /// Points where `q <= 0`.
    Quadric(Quadric),
    /// The volume inside a closed triangle mesh.
    Mesh(Arc<Mesh>),
    /// The volume inside a part that is [closed](Part::closed), with trimmed spline faces and meshes.
    Part(Arc<Part>),
}

/// `a·(x², y², z²) + b·(xy, yz, zx) + c·(x, y, z) + d`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Quadric {
    /// Coefficients of the squares.
    pub squares: DVec3,
    /// Coefficients of `xy`, `yz`, `zx`.
    pub products: DVec3,
    /// Coefficients of `x`, `y`, `z`.
    pub linear: DVec3,
    /// The constant term.
    pub constant: f64,
}

impl Quadric {
    /// The polynomial's value.
    pub fn value(&self, p: DVec3) -> f64 {
        let mixed = DVec3::new(p.x * p.y, p.y * p.z, p.z * p.x);
        self.squares.dot(p * p) + self.products.dot(mixed) + self.linear.dot(p) + self.constant
    }

    /// Its gradient: outward where `q <= 0` is inside.
    pub fn gradient(&self, p: DVec3) -> DVec3 {
        self.slope(p) + self.linear
    }

    /// `2 A v` for the symmetric matrix `A` of the terms of second order.
    pub fn slope(&self, v: DVec3) -> DVec3 {
        let m = self.products;
        2.0 * self.squares * v + DVec3::new(m.x * v.y + m.z * v.z, m.x * v.x + m.y * v.z, m.y * v.y + m.z * v.x)
    }

    fn is_finite(&self) -> bool {
        self.squares.is_finite() && self.products.is_finite() && self.linear.is_finite() && self.constant.is_finite()
    }
}

/// A placed shape.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Primitive {
    /// In its own coordinates.
    pub shape: Shape,
    /// Own coordinates to the solid's. A transform that flattens space makes the primitive empty; one that mirrors
    /// leaves it a solid.
    pub transform: DAffine3,
    /// Colour of its faces.
    pub colour: Colour,
    /// Number in the source, written to the face-id image. Never 0.
    pub id: u32,
}

/// Why a primitive is invalid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[allow(missing_docs)]
#[non_exhaustive]
pub enum ShapeError {
    #[error("a dimension is not a finite number")]
    NotFinite,
    #[error("a radius, height or side is negative")]
    Negative,
    #[error("the half-space has no normal")]
    NoNormal,
    #[error("the part is not closed, so it has no inside")]
    Open,
}

impl Shape {
    /// Checks the dimensions. Zero sizes are allowed: such a solid is empty.
    ///
    /// # Errors
    /// The first of [`ShapeError`] that applies.
    pub fn check(&self) -> Result<(), ShapeError> {
        let sizes = |all: &[f64]| {
            if all.iter().any(|x| !x.is_finite()) {
                Err(ShapeError::NotFinite)
            } else if all.iter().any(|x| *x < 0.0) {
                Err(ShapeError::Negative)
            } else {
                Ok(())
            }
        };
        match self {
            Self::HalfSpace { normal, offset } => match () {
                () if !(normal.is_finite() && offset.is_finite()) => Err(ShapeError::NotFinite),
                () if *normal == DVec3::ZERO => Err(ShapeError::NoNormal),
                () => Ok(()),
            },
            Self::Block { min, max } => sizes(&(*max - *min).to_array()),
            Self::Sphere { radius } => sizes(&[*radius]),
            Self::Cylinder { radius, height } => sizes(&[*radius, *height]),
            Self::Cone { bottom, top, height } => sizes(&[*bottom, *top, *height]),
            Self::Torus { major, minor } => sizes(&[*major, *minor]),
            Self::Quadric(q) => q.is_finite().then_some(()).ok_or(ShapeError::NotFinite),
            Self::Mesh(_) => Ok(()),
            Self::Part(part) => part.closed.then_some(()).ok_or(ShapeError::Open),
        }
    }

    /// A box around the shape in its own coordinates; infinite for half-spaces and quadrics, empty for
    /// a shape without volume.
    pub fn bounds(&self) -> Bounds {
        let round = |r: f64, lo: f64, hi: f64| Bounds { min: DVec3::new(-r, -r, lo), max: DVec3::new(r, r, hi) };
        let bounds = match self {
            Self::HalfSpace { .. } | Self::Quadric(_) => {
                return Bounds { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
            }
            Self::Block { min, max } => Bounds { min: *min, max: *max },
            Self::Sphere { radius: r } => round(*r, -r, *r),
            Self::Cylinder { radius, height } => round(*radius, 0.0, *height),
            Self::Cone { bottom, top, height } => round(bottom.max(*top), 0.0, *height),
            Self::Torus { major, minor } if *minor > 0.0 => round(major + minor, -minor, *minor),
            Self::Torus { .. } => Bounds::EMPTY,
            Self::Mesh(mesh) => mesh.bounds(),
            Self::Part(part) => part.control_bounds(),
        };
        let flat = !(bounds.min.cmplt(bounds.max)).all();
        if flat { Bounds::EMPTY } else { bounds }
    }
}

impl Primitive {
    /// The solid's coordinates to the primitive's own; `None` when the transform flattens space or is
    /// not finite: the primitive is empty then.
    pub fn to_own(&self) -> Option<DAffine3> {
        let m = self.transform.matrix3;
        let lengths = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
        // columns not in one plane, to rounding: the determinant carries an error of a few ulp of the lengths
        let solid = m.determinant().abs() > 8.0 * f64::EPSILON * lengths;
        let inverse = self.transform.inverse();
        (solid && self.transform.is_finite() && inverse.is_finite()).then_some(inverse)
    }

    /// A box around the primitive in the solid's coordinates: of the placed corners of its own box;
    /// infinite for half-spaces and quadrics.
    pub fn bounds(&self) -> Bounds {
        let own = self.shape.bounds();
        if own.is_empty() || self.to_own().is_none() {
            return Bounds::EMPTY;
        }
        if !(own.min.is_finite() && own.max.is_finite()) {
            return own;
        }
        own.corners().into_iter().map(|c| self.transform.transform_point3(c)).fold(Bounds::EMPTY, Bounds::with)
    }
}
