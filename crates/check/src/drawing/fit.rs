//! Cubic Bézier curves for a stretch of a path, to a measured distance.
//!
//! ```text
//!      ends and end directions exact           P_1 = P_0 + α d_0,  P_2 = P_3 - β d_3
//!      α, β by least squares over SAMPLES points of the exact curve, whose parameters are then moved to the feet of
//!      their perpendiculars; a distance above the tolerance halves the stretch
//! ```
//!
//! Source: P. J. Schneider, *An algorithm for automatically fitting digitized curves*, Graphics Gems, 1990.

use super::path::{Path, View};
use glam::DVec2;

/// Points between the ends at which the distance is measured.
const SAMPLES: usize = 15;
/// Rounds of better parameters.
const ROUNDS: usize = 6;
/// Halvings of a stretch.
const HALVINGS: u32 = 16;

/// A cubic by its control points, pixels.
pub type Cubic = [DVec2; 4];

/// The point of a cubic at `t`.
pub fn cubic_at(c: &Cubic, t: f64) -> DVec2 {
    let s = 1.0 - t;
    c[0] * (s * s * s) + c[1] * (3.0 * s * s * t) + c[2] * (3.0 * s * t * t) + c[3] * (t * t * t)
}

/// Its derivative.
pub(super) fn cubic_slope(c: &Cubic, t: f64) -> DVec2 {
    let s = 1.0 - t;
    ((c[1] - c[0]) * (s * s) + (c[2] - c[1]) * (2.0 * s * t) + (c[3] - c[2]) * (t * t)) * 3.0
}

/// A straight line as a cubic.
pub(super) fn straight(a: DVec2, b: DVec2) -> Cubic {
    [a, a.lerp(b, 1.0 / 3.0), a.lerp(b, 2.0 / 3.0), b]
}

/// Cubics from one measure of a path to another, and the largest distance measured; they aim at `tolerance`.
pub(super) fn fit(path: &Path<'_>, view: &View, (from, to): (f64, f64), tolerance: f64) -> (Vec<Cubic>, f64) {
    let mut out = Vec::new();
    let mut worst = 0.0;
    piece(path, view, (from, to), tolerance, HALVINGS, &mut out, &mut worst);
    (out, worst)
}

fn piece(
    path: &Path<'_>,
    view: &View,
    (from, to): (f64, f64),
    tolerance: f64,
    halvings: u32,
    out: &mut Vec<Cubic>,
    worst: &mut f64,
) {
    let at = |share: f64| {
        let parameter = path.parameter(from + (to - from) * share);
        path.spot(view, parameter).map(|s| (s.pixel, parameter))
    };
    let samples: Option<Vec<(DVec2, f64)>> = (0..=SAMPLES + 1).map(|k| at(k as f64 / (SAMPLES + 1) as f64)).collect();
    // what is behind the eye is not drawn
    let Some(samples) = samples else { return };
    let points: Vec<DVec2> = samples.iter().map(|s| s.0).collect();
    let (start, end) = (points[0], points[SAMPLES + 1]);
    let line = straight(start, end);
    let off_line = points.iter().map(|p| off_segment(start, end, *p)).fold(0.0, f64::max);
    if off_line <= 0.1 * tolerance {
        *worst = worst.max(off_line);
        out.push(line);
        return;
    }
    let directions = path.direction(view, samples[0].1).zip(path.direction(view, samples[SAMPLES + 1].1));
    let fitted = directions.map(|(d0, d3)| schneider(&points, d0, d3));
    match fitted {
        Some((cubic, off)) if off <= tolerance || halvings == 0 => {
            *worst = worst.max(off);
            out.push(cubic);
        }
        None if halvings == 0 => {
            *worst = worst.max(off_line);
            out.push(line);
        }
        _ => {
            let middle = 0.5 * (from + to);
            piece(path, view, (from, middle), tolerance, halvings - 1, out, worst);
            piece(path, view, (middle, to), tolerance, halvings - 1, out, worst);
        }
    }
}

fn off_segment(a: DVec2, b: DVec2, p: DVec2) -> f64 {
    let along = b - a;
    let share = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    p.distance(if share.is_nan() { a } else { a + along * share })
}

fn schneider(points: &[DVec2], d0: DVec2, d3: DVec2) -> (Cubic, f64) {
    let last = points.len() - 1;
    let mut lengths = vec![0.0];
    for w in points.windows(2) {
        lengths.push(lengths[lengths.len() - 1] + w[0].distance(w[1]));
    }
    let whole = lengths[last].max(f64::MIN_POSITIVE);
    let mut parameters: Vec<f64> = lengths.iter().map(|l| l / whole).collect();
    let mut best = (straight(points[0], points[last]), f64::INFINITY);
    for _ in 0..ROUNDS {
        let cubic = least_squares(points, &parameters, (d0, d3), whole);
        let mut off: f64 = 0.0;
        for (t, p) in parameters.iter_mut().zip(points).take(last).skip(1) {
            *t = foot(&cubic, *t, *p);
            off = off.max(cubic_at(&cubic, *t).distance(*p));
        }
        if off < best.1 {
            best = (cubic, off);
        }
    }
    best
}

/// The foot of the perpendicular from `p`, by Newton's method from `t`.
fn foot(c: &Cubic, mut t: f64, p: DVec2) -> f64 {
    for _ in 0..3 {
        let (d, slope) = (cubic_at(c, t) - p, cubic_slope(c, t));
        let bend = ((c[2] - c[1] * 2.0 + c[0]) * (1.0 - t) + (c[3] - c[2] * 2.0 + c[1]) * t) * 6.0;
        let divisor = slope.length_squared() + d.dot(bend);
        let step = d.dot(slope) / divisor;
        if step.is_finite() && divisor > 0.0 {
            t = (t - step).clamp(0.0, 1.0);
        }
    }
    t
}

fn least_squares(points: &[DVec2], parameters: &[f64], (d0, d3): (DVec2, DVec2), whole: f64) -> Cubic {
    let (start, end) = (points[0], points[points.len() - 1]);
    let (mut a00, mut a01, mut a11, mut b0, mut b1) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (t, p) in parameters.iter().zip(points) {
        let s = 1.0 - t;
        let (f1, f2) = (3.0 * s * s * t, 3.0 * s * t * t);
        let (x, y) = (d0 * f1, -d3 * f2);
        let rest = *p - start * (s * s * s + f1) - end * (f2 + t * t * t);
        (a00, a01, a11) = (a00 + x.dot(x), a01 + x.dot(y), a11 + y.dot(y));
        (b0, b1) = (b0 + x.dot(rest), b1 + y.dot(rest));
    }
    let det = a00 * a11 - a01 * a01;
    let (mut alpha, mut beta) = ((b0 * a11 - b1 * a01) / det, (a00 * b1 - a01 * b0) / det);
    // the classic guard: handles that point back, or reach beyond the curve, are a third of it
    let good = |x: f64| x.is_finite() && x > 1e-3 * whole && x < 2.0 * whole;
    if !(good(alpha) && good(beta)) {
        (alpha, beta) = (whole / 3.0, whole / 3.0);
    }
    [start, start + d0 * alpha, end - d3 * beta, end]
}
