//! The surface at a constant distance from a curve.
//!
//! ```text
//!    ╭──────────╮
//!   ( ) ─ path ─ )   radius     swept circle: u around, v along
//!    ╰──────────╯
//! ```

use super::frame::Path;
use super::sweep::Sweep;
use super::{Built, ConstructError};
use crate::spline::arc::{arc, assemble, pieces};
use crate::spline::{BSpline, Span};
use glam::{DVec3, DVec4};
use std::f64::consts::{FRAC_PI_2, TAU};

/// The tube of `radius` around `path`, open at the ends of an open path: see [`Sweep`] for when it is exact. The
/// normal `S_u × S_v` points outwards.
///
/// Folds are searched at 128 points of each piece of the path. Parts of the path that come near each other without
/// bending sharply make a tube that crosses itself: such crossings are not searched.
///
/// # Errors
/// The radius is not positive, or not smaller than the path's radius of curvature; as [`Sweep::build`].
pub fn tube(path: &BSpline<DVec4>, radius: f64, tolerance: f64) -> Result<Built, ConstructError> {
    const EACH: u32 = 128;
    if !(radius > 0.0 && radius.is_finite()) {
        return Err(ConstructError::Range { what: "the radius of a tube", value: radius, must: "positive" });
    }
    let smooth = Path::new(path, "the path")?;
    for (i, s) in smooth.spans().iter().enumerate() {
        for k in 0..=EACH {
            let x = f64::from(k) / f64::from(EACH);
            let jet = smooth.local(i, x);
            let bend = jet.turning().length() / jet.first.length();
            if radius * bend >= 1.0 {
                let parameter = s.start + (s.end - s.start) * x;
                return Err(ConstructError::Folds { parameter, reach: radius, radius: 1.0 / bend });
            }
        }
    }
    Sweep::new(&circle(radius)?, path, tolerance).build()
}

/// A planar circle about the origin over `[0, 2π]`, counter-clockwise from `x`.
fn circle(radius: f64) -> Result<BSpline<DVec3>, ConstructError> {
    let quarter = |k: &[f64]| {
        let piece = arc(DVec3::ZERO, DVec3::X * radius, DVec3::Y * radius, k[0], k[1]);
        Span { start: k[0], end: k[1], piece }
    };
    let (degree, knots, points) = assemble(&pieces(0.0, TAU, FRAC_PI_2).windows(2).map(quarter).collect::<Vec<_>>());
    Ok(BSpline::new(degree, knots, points.iter().map(|p| DVec3::new(p.x, p.y, p.w)).collect())?)
}
