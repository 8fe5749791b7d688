//! Rims that the source does not state, and where to cut a closed surface.

use super::loops::{Loop, periods};
use super::strand::Strand;
use super::support::Support;
use glam::DVec2;

/// Where to cut: through a vertex of a rim that no hole covers, else through a gap between holes,
/// else through the middle of the widest stretch without a vertex. The flag says that it meets no hole.
pub(super) fn choose_cut(support: &Support, loops: &[Loop], axis: usize, period: f64) -> (f64, bool) {
    let holes: Vec<(f64, f64)> = loops
        .iter()
        .filter(|l| l.winding[axis] == 0)
        .map(|l| {
            let (lo, hi) = l.bounds(support);
            (lo[axis], hi[axis])
        })
        .collect();
    let margin = 1e-6 * period;
    let covered = Covered::new(&holes, period, SURELY * margin);
    let clear = |c: f64| {
        !covered.holds(c)
            && holes.iter().all(|(lo, hi)| {
                let ahead = (c - lo).rem_euclid(period);
                ahead > hi - lo + margin && ahead < period - margin
            })
    };
    let rims = loops.iter().filter(|l| l.winding[axis] != 0);
    let vertices: Vec<f64> = rims.flat_map(|l| l.strands.iter().map(|s| s.start[axis])).collect();
    if let Some(c) = vertices.iter().find(|c| clear(**c)) {
        return (*c, true);
    }
    // of equally wide gaps the last one
    let middle_of_widest = |marks: &mut Vec<f64>, good: &dyn Fn(f64) -> bool| {
        marks.iter_mut().for_each(|m| *m = m.rem_euclid(period));
        marks.sort_by(f64::total_cmp);
        marks.push(marks.first().copied().unwrap_or(0.0) + period);
        let mut gaps: Vec<(f64, f64)> = marks.windows(2).map(|w| (w[1] - w[0], 0.5 * (w[0] + w[1]))).collect();
        gaps.reverse();
        gaps.sort_by(|a, b| b.0.total_cmp(&a.0));
        gaps.into_iter().map(|gap| gap.1).find(|middle| good(*middle))
    };
    let mut borders: Vec<f64> = holes.iter().flat_map(|h| [h.0, h.1]).collect();
    if let Some(c) = middle_of_widest(&mut borders, &clear) {
        return (c, true);
    }
    let strands = loops.iter().flat_map(|l| &l.strands);
    let mut all: Vec<f64> = strands.map(|s| s.start[axis]).chain(holes.iter().flat_map(|h| [h.0, h.1])).collect();
    (middle_of_widest(&mut all, &|_| true).unwrap_or(0.0), false)
}

/// Share of the margin around holes within which a coordinate is surely too near: the rest is for rounding.
const SURELY: f64 = 0.99;

/// The coordinates of a period that intervals cover.
struct Covered {
    period: f64,
    /// Apart from each other, in order, each from within the period.
    spans: Vec<(f64, f64)>,
}

impl Covered {
    /// By intervals that are widened by `margin` at both ends.
    fn new(intervals: &[(f64, f64)], period: f64, margin: f64) -> Self {
        let wide = |(lo, hi): &(f64, f64)| {
            let start = (lo - margin).rem_euclid(period);
            (start, start + (hi - lo) + 2.0 * margin)
        };
        let mut all: Vec<(f64, f64)> = intervals.iter().map(wide).filter(|(start, end)| start <= end).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut spans: Vec<(f64, f64)> = Vec::new();
        for (start, end) in all {
            match spans.last_mut() {
                Some(last) if start <= last.1 => last.1 = last.1.max(end),
                _ => spans.push((start, end)),
            }
        }
        Self { period, spans }
    }

    fn holds(&self, c: f64) -> bool {
        let c = c.rem_euclid(self.period);
        let before = self.spans.partition_point(|(start, _)| *start <= c);
        // the last one may reach beyond the period's end, and so around
        self.spans[..before].last().is_some_and(|(_, end)| c <= *end)
            || self.spans.last().is_some_and(|(_, end)| c + self.period <= *end)
    }
}

/// The rim along a pole that closes an odd number of rims: the pole that a bound names, else the
/// only one, else the one on the side of the outermost rim where its face lies.
pub(super) fn close_over_pole(
    support: &Support,
    rims: &[&Loop],
    vertices: &[usize],
    (axis, cut): (usize, f64),
) -> Option<Loop> {
    let other = 1 - axis;
    let period = support.periods[axis]?;
    let level = |l: &Loop| {
        let all = l.strands.iter().map(|s| s.start[other]);
        all.clone().sum::<f64>() / all.count() as f64
    };
    let rim = rims.iter().min_by(|a, b| level(a).total_cmp(&level(b)))?;
    let here = level(rim);
    let up = (rim.winding[axis] > 0) == (axis == 0);
    let repeat = |x: f64, up: bool| match support.periods[other] {
        // the next copy in the direction of the face
        Some(q) if up => x + q * ((here - x) / q).ceil(),
        Some(q) => x + q * ((here - x) / q).floor(),
        None => x,
    };
    let poles = || support.poles.iter().enumerate().filter(|(_, p)| p.axis == other);
    let named = poles().find(|(i, _)| vertices.contains(i)).map(|(_, p)| p.value);
    let value = match named {
        Some(x) => repeat(x, up),
        None if poles().count() == 1 && support.periods[other].is_none() => poles().next().map(|(_, p)| p.value)?,
        None => {
            let ahead = poles().map(|(_, p)| repeat(p.value, up)).filter(|x| (*x > here) == up);
            ahead.min_by(|a, b| (a - here).abs().total_cmp(&(b - here).abs()))?
        }
    };
    // it runs against the rim
    let mut from = DVec2::ZERO;
    from[axis] = cut;
    from[other] = value;
    let mut to = from;
    to[axis] += period;
    let mut winding = [0; 2];
    winding[axis] = 1;
    let closing = Loop { strands: vec![Strand::inserted(from, to)], winding };
    Some(if rim.winding[axis] > 0 { closing.reversed() } else { closing })
}

/// The border of the window, or else of the surface's own domain: a rectangle, or two rims where a
/// direction closes; `None` when there is neither.
pub(super) fn natural_border(support: &Support, loops: &[Loop]) -> Option<Vec<Loop>> {
    let natural = || support.natural[0].zip(support.natural[1]).map(|(u, v)| [u, v]);
    let [u, v] = support.window.or_else(natural)?;
    let full = |i: usize, (a, b): (f64, f64)| support.periods[i].is_some_and(|p| b - a >= p * (1.0 - 1e-9));
    if support.window.is_none() && (full(0, u) || full(1, v)) {
        return natural_rims(support, loops).map(Vec::from);
    }
    if let Some(axis) = [full(0, u), full(1, v)].iter().position(|f| *f) {
        let other = [u, v][1 - axis];
        let start = [u, v][axis].0;
        let rim = |height: f64| rim(support, axis, start, height);
        let (low, high) = (rim(other.0), rim(other.1));
        return Some(if axis == 0 { vec![low, high.reversed()] } else { vec![low.reversed(), high] });
    }
    let corners = [(u.0, v.0), (u.1, v.0), (u.1, v.1), (u.0, v.1)].map(|(u, v)| DVec2::new(u, v));
    let strands = (0..4).map(|i| Strand::inserted(corners[i], corners[(i + 1) % 4])).collect();
    Some(vec![Loop { strands, winding: [0; 2] }])
}

/// The line that runs once around in `axis` from `start`, at `height` of the other parameter.
fn rim(support: &Support, axis: usize, start: f64, height: f64) -> Loop {
    let mut turn = [0; 2];
    turn[axis] = 1;
    let mut from = DVec2::ZERO;
    from[axis] = start;
    from[1 - axis] = height;
    Loop { strands: vec![Strand::inserted(from, from + periods(support, turn))], winding: turn }
}

/// The border of a closed surface as loops: two opposite rims that [`cut_open`](super::cut::cut_open) joins. Where neither
/// direction ends, the rims lie on a line that no loop meets; `None` when there is none.
pub(super) fn natural_rims(support: &Support, loops: &[Loop]) -> Option<[Loop; 2]> {
    let axis = (0..2).find(|i| support.periods[*i].is_some())?;
    let other = 1 - axis;
    let (lo, hi) = match (support.periods[other], support.natural[other]) {
        (Some(q), Some((a, b))) if b - a >= q * (1.0 - 1e-9) => {
            let (c, clear) = choose_cut(support, loops, other, q);
            clear.then_some((c, c + q))?
        }
        (_, natural) => natural?,
    };
    let rim = |height: f64| rim(support, axis, support.natural[axis].map_or(0.0, |n| n.0), height);
    let (low, high) = (rim(lo), rim(hi));
    Some(if axis == 0 { [low, high.reversed()] } else { [low.reversed(), high] })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against a test of each interval, for few and many, some across the period's end and some as long as the period.
    #[test]
    fn what_intervals_cover_is_looked_up() {
        let mut state = 3_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(1_u32 << 31)
        };
        let (period, margin) = (7.0, 0.01);
        let mut counts = [0; 2];
        for (number, longest) in [(0, 1.0), (1, 3.0), (1, 8.0), (5, 2.0), (40, 0.2), (300, 0.02)] {
            for _ in 0..20 {
                let interval = |lo: f64, length: f64| (20.0 * lo - 10.0, 20.0 * lo - 10.0 + longest * length);
                let all: Vec<(f64, f64)> = (0..number).map(|_| interval(random(), random())).collect();
                let covered = Covered::new(&all, period, margin);
                for _ in 0..50 {
                    let c = 30.0 * random() - 15.0;
                    let within =
                        |(lo, hi): &(f64, f64)| (c - (lo - margin)).rem_euclid(period) <= hi - lo + 2.0 * margin;
                    let expected = all.iter().any(within);
                    assert_eq!(covered.holds(c), expected, "{c} in {all:?}");
                    counts[usize::from(expected)] += 1;
                }
            }
        }
        assert!(counts.iter().all(|count| *count > 500), "{counts:?}");
    }
}
