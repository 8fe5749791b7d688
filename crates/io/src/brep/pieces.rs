//! A curve made of rational Bézier pieces, with the parameter range that each covers.

use crate::model::Bounds;
use crate::spline::{BSpline, Bezier, Control, Span};
use glam::{DVec3, DVec4};

/// Bézier pieces end to end.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pieces {
    /// In order; each begins at the parameter where the one before it ends. Never empty.
    pub spans: Vec<Span<Bezier<DVec4>>>,
    /// Interior parameters where the second derivative may jump.
    pub creases: Vec<f64>,
    /// The last point is the first: parameters repeat.
    pub closed: bool,
}

/// A piece that reaches into a range of parameters.
struct Reach<'a> {
    /// Where the piece starts and ends.
    start: f64,
    end: f64,
    /// The part of the piece within the range.
    from: f64,
    to: f64,
    piece: &'a Bezier<DVec4>,
}

impl Pieces {
    /// The pieces of a B-spline. `closed` is set when its ends are within `eps`, mm, or
    /// `1e-7` of its size.
    pub fn of_spline(c: &BSpline<DVec4>, eps: f64) -> Self {
        Self::new(c.beziers(), creases(c.degree(), c.knots()), eps)
    }

    /// Curves of different kinds, piece `i` over `[i, i + 1]`; every joint is a crease.
    pub fn chain(pieces: Vec<Bezier<DVec4>>, eps: f64) -> Self {
        let joints = (1..pieces.len()).map(|i| i as f64).collect();
        let span = |(i, piece)| Span { start: i as f64, end: i as f64 + 1.0, piece };
        Self::new(pieces.into_iter().enumerate().map(span).collect(), joints, eps)
    }

    fn new(spans: Vec<Span<Bezier<DVec4>>>, creases: Vec<f64>, eps: f64) -> Self {
        let ends = (spans[0].piece.point(0.0), spans[spans.len() - 1].piece.point(1.0));
        let points = spans.iter().flat_map(|s| s.piece.points.iter().map(|p| p.point()));
        // writers close their splines less exactly than they place their vertices
        let eps = eps.max(1e-7 * points.fold(Bounds::EMPTY, Bounds::with).diagonal());
        Self { closed: ends.0.distance(ends.1) <= eps, spans, creases }
    }

    /// First and last parameter.
    pub fn domain(&self) -> (f64, f64) {
        (self.spans[0].start, self.spans[self.spans.len() - 1].end)
    }

    /// `t` in the domain: wrapped when closed, clamped when not.
    pub fn wrap(&self, t: f64) -> f64 {
        let (a, b) = self.domain();
        if self.closed && !(a..=b).contains(&t) { a + (t - a).rem_euclid(b - a) } else { t.clamp(a, b) }
    }

    /// Point and derivative at `t`.
    pub fn jet(&self, t: f64) -> (DVec3, DVec3) {
        let t = self.wrap(t);
        let i = self.spans.partition_point(|s| s.start <= t).clamp(1, self.spans.len()) - 1;
        let s = &self.spans[i];
        let length = s.end - s.start;
        let (p, d) = s.piece.jet((t - s.start) / length);
        let point = p.point();
        (point, (d.truncate() - point * d.w) / (p.w * length))
    }

    /// The same points in the opposite order over the same domain.
    pub fn reversed(&self) -> Self {
        let sum = self.domain().0 + self.domain().1;
        let flip = |s: &Span<Bezier<DVec4>>| Span {
            start: sum - s.end,
            end: sum - s.start,
            piece: s.piece.clone().reversed(),
        };
        let spans = self.spans.iter().rev().map(flip).collect();
        let creases = self.creases.iter().rev().map(|c| sum - c).collect();
        Self { spans, creases, closed: self.closed }
    }

    /// The pieces over `[a, b]`; on a closed curve the range may leave the domain by whole periods.
    pub fn between(&self, a: f64, b: f64) -> Vec<Span<Bezier<DVec4>>> {
        let cut = |r: Reach<'_>| {
            let length = r.end - r.start;
            let piece = r.piece.segment((r.from - r.start) / length, (r.to - r.start) / length);
            Span { start: r.from, end: r.to, piece }
        };
        let mut out: Vec<_> = self.ranges(a, b).into_iter().map(cut).collect();
        if out.is_empty() {
            let ends = [a, b].map(|t| DVec4::from_point(self.jet(t).0, 1.0));
            out.push(Span { start: a, end: b, piece: Bezier { points: ends.to_vec() } });
        }
        out
    }

    /// The pieces that reach into `[a, b]`, as in [`Pieces::between`].
    fn ranges(&self, a: f64, b: f64) -> Vec<Reach<'_>> {
        let (lo, hi) = self.domain();
        let period = hi - lo;
        let turns = if self.closed { ((a - lo) / period).floor()..=((b - lo) / period).floor() } else { 0.0..=0.0 };
        let mut out = Vec::new();
        let mut turn = *turns.start();
        while turn <= *turns.end() {
            for s in &self.spans {
                let (start, end) = (s.start + turn * period, s.end + turn * period);
                let (from, to) = (a.max(start), b.min(end));
                // slivers of rounding at the ends are not pieces
                if to - from > 1e-13 * period {
                    out.push(Reach { start, end, from, to, piece: &s.piece });
                }
            }
            turn += 1.0;
        }
        out
    }

    /// Increasing parameters from `a` to `b`: long splines have short spans, and fewer samples in each.
    pub fn nodes(&self, a: f64, b: f64) -> Vec<f64> {
        let mut spans: Vec<_> = self.ranges(a, b).iter().map(|r| (r.from, r.to, r.piece.degree())).collect();
        if spans.is_empty() {
            spans.push((a, b, 1));
        }
        let each = |degree: usize| match spans.len() {
            0..=4 => 2 * degree + 4,
            5..=32 => degree + 2,
            _ => 3,
        };
        let inside = |&(from, to, degree): &(f64, f64, usize)| {
            let n = each(degree);
            (0..n).map(move |i| from + (to - from) * (i as f64 / n as f64))
        };
        spans.iter().flat_map(inside).chain([b]).collect()
    }

    /// Parameters at which to look first: enough that no piece of the curve hides between two.
    pub fn seeds(&self) -> Vec<f64> {
        let per_span = |s: &Span<Bezier<DVec4>>| (s.piece.degree() + 1).max(3);
        let inside = |s: &Span<Bezier<DVec4>>| {
            let (n, a, d) = (per_span(s), s.start, s.end - s.start);
            (0..n).map(move |i| a + d * i as f64 / n as f64)
        };
        self.spans.iter().flat_map(inside).chain([self.domain().1]).collect()
    }
}

/// Interior knots where the curve is less than twice differentiable.
pub(super) fn creases(degree: usize, knots: &[f64]) -> Vec<f64> {
    let inside = &knots[degree + 1..knots.len() - degree - 1];
    let (a, b) = (knots[degree], knots[knots.len() - degree - 1]);
    inside
        .chunk_by(|x, y| x == y)
        .filter(|run| run.len() + 1 >= degree && run[0] > a && run[0] < b)
        .map(|run| run[0])
        .collect()
}
