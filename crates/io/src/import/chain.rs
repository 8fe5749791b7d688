//! Trim curves of a file, end to end, as a loop.

use crate::model::TrimLoop;
use crate::spline::{Bezier, Control};
use glam::{DVec2, DVec3};

/// Gap that counts as rounding, relative to the size of the loop.
pub(super) const ROUNDING: f64 = 1e-9;

/// The loop of `curves`, counter-clockwise or (`hole`) clockwise.
///
/// Ends that differ by rounding become one point; a wider gap is closed by a line, with a note in `notes`, when
/// `may_close(end, start, size)` allows it for the size of the loop.
///
/// # Errors
/// A reason in words: a gap, a loop without area, control points that are none.
pub(super) fn chain(
    curves: &[Bezier<DVec3>],
    hole: bool,
    notes: &mut Vec<String>,
    may_close: impl Fn(DVec2, DVec2, f64) -> bool,
) -> Result<TrimLoop, String> {
    let points = curves.iter().flat_map(|b| &b.points).map(|p| p.point());
    let (lo, hi) = points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)));
    let size = (hi - lo).max_element();
    let mut chain: Vec<Bezier<DVec3>> = Vec::with_capacity(curves.len());
    for (i, curve) in curves.iter().enumerate() {
        chain.push(curve.clone());
        let end = curve.points[curve.degree()].point();
        let start = curves[(i + 1) % curves.len()].points[0].point();
        let gap = (end - start).abs().max_element();
        if gap > ROUNDING * size && may_close(end, start, size) {
            notes.push(format!("loop closed over a gap of {gap:e} in (u, v)"));
            chain.push(Bezier::line(end, start));
        }
    }
    let trim = TrimLoop::new(chain, DVec2::splat(ROUNDING * size)).map_err(|e| e.to_string())?;
    let area = trim.signed_area();
    if !area.is_finite() || area.abs() <= ROUNDING * size * size {
        return Err("a trim loop without area".into());
    }
    Ok(if (area > 0.0) == hole { trim.reversed() } else { trim })
}
