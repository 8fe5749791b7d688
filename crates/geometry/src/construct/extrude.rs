//! A curve moved along a straight line.
//!
//! ```text
//!   curve + d  ─────────╮ v = 1
//!       ▲   ▲   ▲       │            S(u, v) = c(u) + v d
//!       │   │   │ d     │
//!   curve c ────────────╯ v = 0
//! ```

use super::ConstructError;
use super::compat::size;
use crate::spline::{BSpline, Control, Surface};
use glam::{DVec3, DVec4};

/// `c(u) + v d` over the curve's domain and `v` in `[0, 1]`: exact.
///
/// # Errors
/// The direction is not finite or zero; the curve is a point, or runs along the direction alone.
pub fn extrude(curve: &BSpline<DVec4>, direction: DVec3) -> Result<Surface, ConstructError> {
    if !direction.is_finite() {
        return Err(ConstructError::NotFinite { what: "the direction of an extrusion" });
    }
    let Some(along) = direction.try_normalize() else {
        return Err(ConstructError::ZeroLength { what: "the direction of an extrusion" });
    };
    let extent = size([curve]);
    let first = curve.points()[0].point();
    let wide = curve.points().iter().any(|p| (p.point() - first).cross(along).length() > 1e-14 * extent);
    if !wide {
        return Err(ConstructError::ZeroLength { what: "the profile across the direction of its extrusion" });
    }
    let moved = curve.points().iter().map(|p| *p + (direction * p.w).extend(0.0));
    let net = curve.points().iter().copied().chain(moved).collect();
    Ok(Surface::new((curve.degree(), 1), curve.knots().to_vec(), vec![0.0, 0.0, 1.0, 1.0], net)?)
}
