//! Rational B-splines in `f64`: evaluation, knot insertion, Bézier pieces. Pure numbers, no GPU.
//!
//! Everything is *homogeneous*: a control point carries its weight as the last coordinate, with the
//! other coordinates already multiplied by it, `(w x, w y, w z, w)`. A planar curve therefore has
//! [`DVec3`] control points and a space curve or surface [`DVec4`] ones; the same code serves both
//! through [`Control`].
//!
//! ```text
//!   BSpline<P>            one curve, any degree          ──beziers()──▶  [Span<Bezier<P>>]
//!   Surface               tensor product, u fastest      ──patches()──▶  PatchGrid of Patch
//!   triangle_surface      the Surface that a triangular patch is a part of
//!
//!        v                      points[j * count_u + i] = P_ij
//!        ▲   P_02  P_12  P_22   i runs along u, j along v
//!        │   P_01  P_11  P_21
//!        │   P_00  P_10  P_20
//!        └──────────────────▶ u
//! ```
//!
//! Sources: L. Piegl, W. Tiller, *The NURBS Book*, 2nd ed. 1997, chapters 2 to 5; G. Farin, *Curves
//! and Surfaces for CAGD*, 5th ed. 2002, chapters 4, 5 and 13.

pub mod arc;
mod basis;
mod bernstein;
mod bezier;
mod bspline;
pub mod cubic;
mod derivative_bound;
mod differential;
mod net;
mod normal_cone;
mod patch;
mod refine;
mod spare;
mod surface;
mod triangle;

pub use basis::Basis;
pub use bernstein::{MAX_DEGREE, binomial};
pub use bezier::{Bezier, Span};
pub use bspline::{BSpline, SplineError};
pub use derivative_bound::DerivativeBound;
pub use differential::{Curvature, Jet2};
pub(crate) use net::Net;
pub use normal_cone::NormalCone;
pub use patch::{Jet, Patch};
pub use surface::{PatchGrid, Surface, SurfacePatch};
pub use triangle::{triangle_points, triangle_surface};

use glam::{DVec2, DVec3, DVec4};
use std::ops::{Add, Mul, Sub};

/// A homogeneous control point: `(w x, w)` with `w` last.
pub trait Control:
    Copy + std::fmt::Debug + PartialEq + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self>
{
    /// The Euclidean point, without its weight.
    type Point: Copy + std::fmt::Debug;
    /// The additive identity.
    const ZERO: Self;
    /// The weight, the last coordinate.
    fn weight(self) -> f64;
    /// The Euclidean point: coordinates over weight.
    fn point(self) -> Self::Point;
    /// From a Euclidean point and a weight.
    fn from_point(point: Self::Point, weight: f64) -> Self;
    /// Every coordinate finite.
    fn finite(self) -> bool;
    /// The largest absolute coordinate difference, weight included.
    fn max_abs(self) -> f64;
}

impl Control for DVec3 {
    type Point = DVec2;
    const ZERO: Self = DVec3::ZERO;
    fn weight(self) -> f64 {
        self.z
    }
    fn point(self) -> DVec2 {
        DVec2::new(self.x / self.z, self.y / self.z)
    }
    fn from_point(p: DVec2, w: f64) -> Self {
        DVec3::new(p.x * w, p.y * w, w)
    }
    fn finite(self) -> bool {
        self.is_finite()
    }
    fn max_abs(self) -> f64 {
        self.abs().max_element()
    }
}

impl Control for DVec4 {
    type Point = DVec3;
    const ZERO: Self = DVec4::ZERO;
    fn weight(self) -> f64 {
        self.w
    }
    fn point(self) -> DVec3 {
        DVec3::new(self.x / self.w, self.y / self.w, self.z / self.w)
    }
    fn from_point(p: DVec3, w: f64) -> Self {
        DVec4::new(p.x * w, p.y * w, p.z * w, w)
    }
    fn finite(self) -> bool {
        self.is_finite()
    }
    fn max_abs(self) -> f64 {
        self.abs().max_element()
    }
}
