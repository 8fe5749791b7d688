//! Straight lines between two curves.
//!
//! ```text
//!   b ───────────────── v = 1
//!     │ ╲  ╲   │  ╱           equal fractions of both domains are joined
//!   a ───────────────── v = 0
//! ```

use super::ConstructError;
use super::compat::{apart, compatible, size};
use crate::spline::{BSpline, Surface};
use glam::DVec4;

/// The ruled surface from `a` (`v = 0`) to `b` (`v = 1`), over the unit square: exact.
///
/// The curves may differ in degree, knots and domain. Where weights differ, the lines stay straight and run through
/// the same points of both curves, but not at constant speed.
///
/// # Errors
/// The curves coincide.
pub fn ruled(a: &BSpline<DVec4>, b: &BSpline<DVec4>) -> Result<Surface, ConstructError> {
    let rows = compatible(&[a.clone(), b.clone()])?;
    if apart(&rows[0], &rows[1]) <= 1e-14 * size([a, b]) {
        return Err(ConstructError::CoincidentSections { first: 0, second: 1 });
    }
    Ok(Surface::from_rows(&rows, 1, vec![0.0, 0.0, 1.0, 1.0])?)
}
