//! The kind of an edge, by the angle at which its faces meet.
//!
//! ```text
//!        A's inward direction a = n × t      n = S_u × S_v, t along A's loop, which has the face on its left
//!      ◀──────●──────▶ b                     the surface continues where b = -a: turn = angle(a, -b)
//! ```
//!
//! The directions into the faces decide, not their normals: neighbours of an open part may be oriented differently. The
//! angle is measured at three points of each curve of the first use; between them it is not bounded. A point at which a
//! face has no normal (a pole, a cusp) is skipped. How far the uses are apart is measured at the same points.

use super::sheet::Sheet;
use super::stretch::Stretch;
use crate::model::EdgeKind;
use crate::spline::Bezier;
use glam::DVec3;
use std::f64::consts::PI;

/// Points of each curve at which the angle is taken.
const POINTS: [f64; 3] = [0.12, 0.5, 0.88];
/// Chords in each curve of another use, for the search of the point next to one of the first use.
const CHORDS: u32 = 8;
/// A normal shorter than this share of its derivatives' product is none.
const FLAT: f64 = 1e-9;

/// The unit direction into the face at `t` of a trim curve, across the curve.
fn inward(sheet: &Sheet, curve: &Bezier<DVec3>, t: f64) -> Option<DVec3> {
    let (jet, along) = sheet.frame(curve, t);
    let normal = jet.du.cross(jet.dv);
    let has_one = normal.length() > FLAT * jet.du.length() * jet.dv.length();
    normal.cross(along).try_normalize().filter(|_| has_one)
}

/// Distance of `p` from a trim curve at its foot on it, `t`: across the curve, for the foot may be off along it.
fn off(sheet: &Sheet, curve: &Bezier<DVec3>, t: f64, p: DVec3) -> f64 {
    let (jet, along) = sheet.frame(curve, t);
    let way = p - jet.point;
    let across = way - along * (way.dot(along) / along.length_squared());
    if across.is_finite() { across.length() } else { way.length() }
}

/// Kind and largest turn of the edge of these stretches, and how far apart they are found.
pub(super) fn kind(
    sheets: &[Sheet],
    stretches: &[Stretch],
    uses: &[(usize, bool)],
    smooth: f64,
) -> (EdgeKind, f64, f64) {
    let [(first, _), others @ ..] = uses else { return (EdgeKind::Border, f64::NAN, 0.0) };
    if others.is_empty() {
        return (EdgeKind::Border, f64::NAN, 0.0);
    }
    let first = &stretches[*first];
    let sheet = &sheets[first.face];
    let mut turn: Option<f64> = None;
    let mut apart: f64 = 0.0;
    for (other, _) in others {
        let other = &stretches[*other];
        let across = Across::new(&sheets[other.face], other);
        for curve in &first.pieces {
            for t in POINTS {
                let p = sheet.at(curve, t);
                let Some((other, s)) = across.foot(p) else { continue };
                apart = apart.max(off(across.sheet, other, s, p));
                let Some(a) = inward(sheet, curve, t) else { continue };
                let Some(b) = inward(across.sheet, other, s) else { continue };
                turn = Some(turn.unwrap_or(0.0).max(a.angle_between(-b)));
            }
        }
    }
    // faces without a normal anywhere along it: their angle is unknown, so it is sharp
    let turn = turn.unwrap_or(PI);
    let own = others.iter().all(|(other, _)| stretches[*other].face == first.face);
    let kind = match (turn <= smooth, own) {
        (true, true) => EdgeKind::Seam,
        (true, false) => EdgeKind::Smooth,
        (false, _) => EdgeKind::Sharp,
    };
    (kind, turn, apart)
}

/// Another use of the edge, evaluated next to points of the first.
struct Across<'s, 'a> {
    sheet: &'s Sheet<'a>,
    stretch: &'s Stretch,
    /// Points at equal steps along its curves: number of the curve, parameter, point.
    points: Vec<(usize, f64, DVec3)>,
}

impl<'s, 'a> Across<'s, 'a> {
    fn new(sheet: &'s Sheet<'a>, stretch: &'s Stretch) -> Self {
        let of_curve = |(k, curve): (usize, &Bezier<DVec3>)| {
            let at = |i: u32| f64::from(i) / f64::from(CHORDS);
            (0..=CHORDS).map(|i| (k, at(i), sheet.at(curve, at(i)))).collect::<Vec<_>>()
        };
        let points = stretch.pieces.iter().enumerate().flat_map(of_curve).collect();
        Self { sheet, stretch, points }
    }

    /// The curve next to `p`, and its parameter there, from the nearest chord. An error of the parameter turns the
    /// direction into the face by as much as the surface bends over a share of that chord.
    fn foot(&self, p: DVec3) -> Option<(&'s Bezier<DVec3>, f64)> {
        let foot = |w: &[(usize, f64, DVec3)]| {
            let chord = w[1].2 - w[0].2;
            let s = ((p - w[0].2).dot(chord) / chord.length_squared()).clamp(0.0, 1.0);
            let s = if s.is_nan() { 0.0 } else { s };
            (p.distance_squared(w[0].2 + chord * s), w[0].0, w[0].1 + (w[1].1 - w[0].1) * s)
        };
        let chords = self.points.windows(2).filter(|w| w[0].0 == w[1].0).map(foot);
        let (_, k, mut t) = chords.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let curve = &self.stretch.pieces[k];
        // to the foot of the perpendicular on the curve itself
        for _ in 0..3 {
            let (jet, along) = self.sheet.frame(curve, t);
            let step = (p - jet.point).dot(along) / along.length_squared();
            t = if step.is_finite() { (t + step).clamp(0.0, 1.0) } else { t };
        }
        Some((curve, t))
    }
}
