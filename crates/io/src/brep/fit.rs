//! From a strand in native parameters to rational Bézier curves in the carrier's domain.
//!
//! Straight and planar strands are exact. The others are cut where the carrier or the edge creases
//! and fitted by polynomials through Chebyshev points, halved until the bound holds:
//!
//! ```text
//!   error at s = | S(fit(s)) - S(trace(s)) |    measured in space, in mm, between the points of
//!                                               interpolation
//! ```
//!
//! Both curves are compared at equal `s`, so the largest distance bounds the Hausdorff distance in
//! both directions. An interpolant of degree n errs as `h^(n + 1)`: a cubic is tried, then a quintic,
//! then halves.

use super::carrier::Carrier;
use super::law::Axis;
use super::strand::{Path, Strand};
use super::support::Support;
use crate::spline::{Bezier, Control};
use glam::{DVec2, DVec3};
use std::sync::LazyLock;

/// Halvings before a piece is kept as it is and its error reported: `2^-16` of an edge.
const MAX_DEPTH: u32 = 16;

/// Curves of one strand, beside eight for each cut, after which no piece is halved any more. Real faces have some
/// hundreds in all their loops. Damaged ones, whose pre-image is noise, would need `2^16`.
const MAX_CURVES: usize = 2048;

/// Between two points of interpolation the error runs like the product of the distances from them all. Its
/// peak is at most this many times what is found at 0.3 and 0.7 of the way.
pub(super) const PEAK: f64 = 1.25;

/// Share of a parameter, or of a line's length, by which rounding alone moves a point off the line.
const ROUNDING: f64 = 1e-15;

/// Trim curves of one strand.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    /// In order, from the strand's start to its end.
    pub curves: Vec<Bezier<DVec3>>,
    /// Largest measured distance in mm, on the surface, of a curve from the pre-image of its edge.
    pub deviation: f64,
}

/// A surface on which strands are fitted.
pub(super) struct Fitter<'a> {
    /// The surface.
    pub support: &'a Support,
    /// Its spline.
    pub carrier: &'a Carrier,
}

impl Fitter<'_> {
    /// Native parameters to the carrier's domain.
    fn to_carrier(&self, p: DVec2) -> DVec2 {
        DVec2::new(self.carrier.axes[0].to_carrier(p.x), self.carrier.axes[1].to_carrier(p.y))
    }

    /// Point in space of a point of the carrier's domain.
    pub fn point(&self, p: DVec2) -> DVec3 {
        let native = DVec2::new(self.carrier.axes[0].to_native(p.x), self.carrier.axes[1].to_native(p.y));
        self.support.point(native)
    }

    /// The curves of a strand.
    pub fn curves(&self, strand: &Strand) -> Fitted {
        match &strand.path {
            Path::Line => self.line(strand),
            Path::Exact(_) => {
                let curves = strand.exact_curves().unwrap_or_default();
                Fitted { deviation: self.compare_exact(strand, &curves), curves }
            }
            Path::Traced => self.traced(strand),
        }
    }

    fn line(&self, strand: &Strand) -> Fitted {
        let (start, end) = (strand.start, strand.end);
        let along = end - start;
        let axis =
            usize::from((along * self.support.speed(start)).abs().x < (along * self.support.speed(start)).abs().y);
        let mut deviation: f64 = 0.0;
        for s in strand.nodes() {
            let Some(raw) = strand.raw(self.support, s) else { break };
            let p = strand.at(self.support, s);
            let f = if along[axis] == 0.0 { 0.0 } else { ((p[axis] - start[axis]) / along[axis]).clamp(0.0, 1.0) };
            let off = start.lerp(end, f);
            // most points are on the line but for rounding
            if (off - raw).abs().cmpgt(ROUNDING * raw.abs().max(along.abs())).any() {
                deviation = deviation.max(self.support.point(off).distance(self.support.point(raw)));
            }
        }
        let curve = Bezier::line(self.to_carrier(start), self.to_carrier(end));
        Fitted { curves: vec![curve], deviation }
    }

    /// Planar curves keep the parameter of their edge, so equal parameters are equal points.
    fn compare_exact(&self, strand: &Strand, curves: &[Bezier<DVec3>]) -> f64 {
        const SAMPLES: usize = 8;
        let Some(part) = &strand.part else { return 0.0 };
        let plane = &self.support.frame;
        let edge = &part.trace.edge;
        let mut spans = edge.curve.beziers(edge.t0, edge.t1);
        if part.from > part.to {
            spans.reverse();
            spans.iter_mut().for_each(|s| s.piece.points.reverse());
        }
        let pairs = curves.iter().zip(&spans);
        let gaps = pairs.flat_map(|(c, s)| {
            (0..=SAMPLES).map(move |i| {
                let t = i as f64 / SAMPLES as f64;
                let p = c.point(t);
                plane.local(s.piece.point(t)).truncate().distance(p)
            })
        });
        gaps.fold(0.0, f64::max)
    }

    fn traced(&self, strand: &Strand) -> Fitted {
        let cuts = self.cuts(strand);
        let most = MAX_CURVES + 8 * cuts.len();
        let mut out = Fitted { curves: Vec::new(), deviation: 0.0 };
        for w in cuts.windows(2) {
            self.fit(strand, w[0], w[1], MAX_DEPTH, most, &mut out);
        }
        out
    }

    /// Fractions and carrier parameters at which the strand must be cut: creases of the edge, of the
    /// surface, and the ends of the carrier's angular pieces.
    fn cuts(&self, strand: &Strand) -> Vec<(f64, DVec2)> {
        let mut cuts = vec![(0.0, strand.start), (1.0, strand.end)];
        let nodes: Vec<(f64, DVec2)> = strand.nodes().into_iter().map(|s| (s, strand.at(self.support, s))).collect();
        for axis in 0..2 {
            let values = nodes.iter().map(|n| n.1[axis]);
            let (lo, hi) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
            let knots = &self.carrier.axes[axis].knots;
            let lines = self.support.creases(axis, lo, hi).into_iter();
            for line in lines.chain(knots.iter().copied().filter(|k| *k > lo && *k < hi)) {
                for w in nodes.windows(2) {
                    if (w[0].1[axis] < line) != (w[1].1[axis] < line) {
                        let (s, mut p) = if self.support.exhausted() {
                            let ((s0, p0), (s1, p1)) = (w[0], w[1]);
                            let f = (line - p0[axis]) / (p1[axis] - p0[axis]);
                            (s0 + (s1 - s0) * f, p0.lerp(p1, f))
                        } else {
                            let s = strand.solve(self.support, axis, line, (w[0].0, w[1].0));
                            (s, strand.at(self.support, s))
                        };
                        p[axis] = line;
                        cuts.push((s, p));
                    }
                }
            }
        }
        if let Some(part) = &strand.part {
            for t in part.trace.edge.creases() {
                let s = (t - part.from) / (part.to - part.from);
                if s > 0.0 && s < 1.0 {
                    cuts.push((s, strand.at(self.support, s)));
                }
            }
        }
        cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
        // creases of edge and surface often coincide; ends stay
        let mut kept: Vec<(f64, DVec2)> = vec![cuts[0]];
        for c in &cuts[1..cuts.len() - 1] {
            if c.0 - kept[kept.len() - 1].0 > 1e-6 && 1.0 - c.0 > 1e-6 {
                kept.push(*c);
            }
        }
        kept.push(cuts[cuts.len() - 1]);
        kept.iter().map(|(s, p)| (*s, self.to_carrier(*p))).collect()
    }

    fn fit(&self, strand: &Strand, a: (f64, DVec2), b: (f64, DVec2), depth: u32, most: usize, out: &mut Fitted) {
        let at = |x: f64| self.to_carrier(strand.at(self.support, a.0 + (b.0 - a.0) * x));
        let middle = 0.5 * (a.0 + b.0);
        let stop = out.curves.len() >= most || self.support.exhausted();
        let last = depth == 0 || stop || middle <= a.0 || middle >= b.0;
        let target = self.support.target_of(strand.part.as_ref().map_or(0.0, |p| p.trace.gap));
        let mut best: Option<(f64, f64, Bezier<DVec3>)> = None;
        for degree in [3, 5] {
            let values: Vec<DVec2> = (0..=degree)
                .map(|i| match i {
                    0 => a.1,
                    _ if i == degree => b.1,
                    _ => at(chebyshev(i, degree)),
                })
                .collect();
            let curve = interpolate(&values);
            let (mut error, mut deviation): (f64, f64) = (0.0, 0.0);
            for i in 0..2 * degree {
                // two points between each pair of interpolation points
                let (x0, x1) = (chebyshev(i / 2, degree), chebyshev(i / 2 + 1, degree));
                let x = x0 + (x1 - x0) * if i % 2 == 0 { 0.3 } else { 0.7 };
                let fitted = self.point(curve.point(x));
                let (path, raw) = strand.at_and_raw(self.support, a.0 + (b.0 - a.0) * x);
                let wanted = self.point(self.to_carrier(path));
                error = error.max(fitted.distance(wanted));
                if let Some(raw) = raw {
                    // most strands lie on their trace: one point serves both, unless a law converts parameters there
                    // and back
                    let same = raw == path && self.carrier.axes.iter().all(Axis::is_linear);
                    let traced = if same { wanted } else { self.support.point(raw) };
                    deviation = deviation.max(PEAK * fitted.distance(traced));
                }
                if error > target && !last {
                    break; // only a fit that is taken needs its exact error
                }
            }
            if best.as_ref().is_none_or(|b| error < b.0) {
                best = Some((error, deviation, curve));
            }
            if error <= target {
                break;
            }
        }
        let Some((error, deviation, curve)) = best else { return };
        if error <= target || last {
            out.deviation = out.deviation.max(deviation);
            out.curves.push(curve);
            return;
        }
        let m = (middle, self.to_carrier(strand.at(self.support, middle)));
        self.fit(strand, a, m, depth - 1, most, out);
        self.fit(strand, m, b, depth - 1, most, out);
    }
}

/// Chebyshev-Lobatto point `i` of `degree` on `[0, 1]`; both ends are among them.
pub(super) fn chebyshev(i: usize, degree: usize) -> f64 {
    0.5 - 0.5 * (std::f64::consts::PI * i as f64 / degree as f64).cos()
}

/// The polynomial Bézier curve through `values` at the Chebyshev points; ends bit for bit.
fn interpolate(values: &[DVec2]) -> Bezier<DVec3> {
    let degree = values.len() - 1;
    let inverse = if degree == 3 { &*CUBIC } else { &*QUINTIC };
    let n = values.len();
    let row = |i: usize| (0..n).map(|j| values[j] * inverse[i * n + j]).sum::<DVec2>();
    let points = (0..n).map(|i| match i {
        0 => values[0],
        _ if i == degree => values[degree],
        _ => row(i),
    });
    Bezier { points: points.map(|p| DVec3::from_point(p, 1.0)).collect() }
}

static CUBIC: LazyLock<Vec<f64>> = LazyLock::new(|| collocation_inverse(3));
pub(super) static QUINTIC: LazyLock<Vec<f64>> = LazyLock::new(|| collocation_inverse(5));

/// Inverse of the Bernstein polynomials' values at the Chebyshev points, row by row.
fn collocation_inverse(degree: usize) -> Vec<f64> {
    let n = degree + 1;
    let bernstein =
        |i: usize, t: f64| crate::spline::binomial(degree, i) * t.powi(i as i32) * (1.0 - t).powi((degree - i) as i32);
    // Gauss-Jordan on [A | I]; A is diagonally heavy enough to need no pivots
    let width = 2 * n;
    let mut m = vec![0.0; n * width];
    for r in 0..n {
        for c in 0..n {
            m[r * width + c] = bernstein(c, chebyshev(r, degree));
        }
        m[r * width + n + r] = 1.0;
    }
    for p in 0..n {
        let pivot = m[p * width + p];
        (0..width).for_each(|c| m[p * width + c] /= pivot);
        for r in (0..n).filter(|r| *r != p) {
            let factor = m[r * width + p];
            (0..width).for_each(|c| m[r * width + c] -= factor * m[p * width + c]);
        }
    }
    (0..n).flat_map(|r| m[r * width + n..(r + 1) * width].to_vec()).collect()
}
