//! Whether loops cross themselves or each other: then points lie within more loops than they should, or fewer.
//!
//! ```text
//!        ╲   ╱            two chains that run one way along an axis change sides: on one scan line A is left of B, on
//!   v ────●─╳─●────       another right of it, each time by more than a margin
//!     ───● ╱ ╲ ●───
//!        B╱   ╲A          chains that only touch, or run along each other, do not count
//! ```

use super::meet::{Box2, each_pair};
use super::piece::{Piece, append_pieces};
use crate::math::root::bracketed;
use crate::model::TrimLoop;
use crate::spline::{Bezier, Control};
use glam::{DVec2, DVec3};

/// By how much chains must change sides, as a share of the smaller loop's box: joints in files are less exact than
/// their digits, and loops may touch.
const MARGIN: f64 = 1e-3;
/// Share of a piece's parameters to which its place on a scan line is found: far below the margin.
const PLACE: f64 = 1e-12;
/// Places between two ends of pieces at which the sides of chains are compared, also just after the one and before the
/// other.
const SHARES: [f64; 5] = [0.02, 0.25, 0.5, 0.75, 0.98];
/// The same, first the one at which two curves are mostly farthest apart.
const MIDDLE_FIRST: [f64; 5] = [0.5, 0.02, 0.25, 0.75, 0.98];
/// Bisections of a piece to the ends of a part of it: few holes are nearer to a border than a sixty-fourth of it.
const PART: u32 = 6;
/// Bisections to the place where two chains meet: it only serves a message.
const BISECTIONS: u32 = 40;
/// Pairs of overlapping boxes that are compared: more would take longer than reading the face.
const MOST_PAIRS: usize = 1 << 22;

/// The result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Crossing {
    /// None.
    No,
    /// Near this point in `(u, v)`.
    At(DVec2),
    /// Too many curves lie beside each other to decide.
    Unknown,
}

/// A place where `loops` cross themselves or each other by more than a thousandth of the smaller loop. Nearly linear
/// where few boxes of curves overlap.
pub fn crossing(loops: &[TrimLoop]) -> Crossing {
    let curves: Vec<Vec<Bezier<DVec3>>> = loops.iter().map(|l| l.curves().collect()).collect();
    let boxes: Vec<Hull> = curves.iter().flatten().map(Hull::new).collect();
    if boxes.iter().all(|b| !b.turns_back) {
        match pairs(&boxes, |hull| (hull.lo, hull.hi), |a, b| a.meets(b).then_some(DVec2::ZERO)) {
            Crossing::At(_) => {}
            other => return other,
        }
    }
    let chains: Vec<_> = curves.iter().enumerate().flat_map(|(of, curves)| chains(of, curves)).collect();
    let margins: Vec<DVec2> = loops.iter().map(TrimLoop::bounds).map(|(lo, hi)| MARGIN * (hi - lo)).collect();
    pairs(&chains, |chain| (chain.lo, chain.hi), |a, b| change_sides(a, b, margins[a.of].min(margins[b.of])))
}

/// The first answer of `ask` on two whose boxes meet.
fn pairs<T>(all: &[T], bounds: impl Fn(&T) -> Box2, ask: impl Fn(&T, &T) -> Option<DVec2>) -> Crossing {
    let boxes: Vec<Box2> = all.iter().map(bounds).collect();
    let mut asked = 0;
    let answer = each_pair(&boxes, |a, b| {
        asked += 1;
        if asked > MOST_PAIRS {
            return Some(Crossing::Unknown);
        }
        ask(&all[a], &all[b]).map(Crossing::At)
    });
    answer.unwrap_or(Crossing::No)
}

/// The box of a curve's control points, which holds it.
struct Hull {
    ends: [DVec2; 2],
    lo: DVec2,
    hi: DVec2,
    /// Some leg of the control polygon runs against the chord; if not, no line across the chord meets the curve twice.
    turns_back: bool,
}

impl Hull {
    fn new(curve: &Bezier<DVec3>) -> Self {
        let points: Vec<DVec2> = curve.points.iter().map(|p| p.point()).collect();
        let (start, end) = (points[0], points[points.len() - 1]);
        let (lo, hi) = points.iter().fold((start, start), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
        let turns_back = points.len() > 3 && points.windows(2).any(|leg| (leg[1] - leg[0]).dot(end - start) <= 0.0);
        Self { ends: [start, end], lo, hi, turns_back }
    }

    /// The boxes share more than a corner where one curve ends and the other begins.
    fn meets(&self, other: &Self) -> bool {
        let (lo, hi) = (self.lo.max(other.lo), self.hi.min(other.hi));
        !(lo == hi && self.ends.contains(&lo) && other.ends.contains(&lo))
    }
}

/// Pieces of a loop that follow each other and run one way along an axis; those across the axis left out.
struct Chain<'c> {
    of: usize,
    axis: usize,
    lo: DVec2,
    hi: DVec2,
    /// From low to high along the axis, with the curves of the loop, which they number.
    pieces: Vec<Piece>,
    curves: &'c [Bezier<DVec3>],
}

/// The chains along both axes.
fn chains(of: usize, curves: &[Bezier<DVec3>]) -> Vec<Chain<'_>> {
    let mut pieces: Vec<Piece> = Vec::new();
    for (index, curve) in curves.iter().enumerate() {
        append_pieces(&mut pieces, index as u32, curve, curve.points[0].point());
    }
    [0, 1].into_iter().flat_map(|axis| along((of, curves), axis, &pieces)).collect()
}

fn along<'c>((of, curves): (usize, &'c [Bezier<DVec3>]), axis: usize, pieces: &[Piece]) -> Vec<Chain<'c>> {
    let rises = |p: &Piece| p.end[axis] - p.start[axis];
    let mut moving: Vec<Piece> = pieces.iter().filter(|p| rises(p) != 0.0).cloned().collect();
    // begin at the start of a chain
    let turn = |a: &Piece, b: &Piece| rises(a) * rises(b) < 0.0;
    let first = (1..moving.len()).find(|&i| turn(&moving[i - 1], &moving[i])).unwrap_or(0);
    moving.rotate_left(first);
    let mut chains = Vec::new();
    for part in moving.chunk_by(|a, b| !turn(a, b)) {
        let mut pieces = part.to_vec();
        if rises(&pieces[0]) < 0.0 {
            pieces.reverse();
        }
        let bounds = pieces.iter().map(Piece::bounds);
        let (lo, hi) = bounds.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), (a, b)| (lo.min(a), hi.max(b)));
        chains.push(Chain { of, axis, lo, hi, pieces, curves });
    }
    chains
}

impl Chain<'_> {
    /// The number of the first piece that ends at or above a value along the axis, else of the last.
    fn index(&self, value: f64) -> usize {
        let top = |p: &Piece| p.start[self.axis].max(p.end[self.axis]);
        self.pieces.partition_point(|p| top(p) < value).min(self.pieces.len() - 1)
    }

    /// Ends of pieces along the axis, from `lo` to `hi`.
    fn ends(&self, lo: f64, hi: f64) -> impl Iterator<Item = f64> {
        let within = &self.pieces[self.index(lo)..=self.index(hi)];
        let ends = within.iter().flat_map(|p| [p.start[self.axis], p.end[self.axis]]);
        ends.filter(move |x| (lo..=hi).contains(x))
    }

    /// Bounds of the other coordinate at a value along the axis.
    fn range(&self, value: f64) -> (f64, f64) {
        let (lo, hi) = self.pieces[self.index(value)].bounds();
        (lo[1 - self.axis], hi[1 - self.axis])
    }

    /// Bounds of the other coordinate between two values along the axis, both within one piece: those of little more of
    /// the piece than lies between them.
    fn part(&self, from: f64, to: f64) -> (f64, f64) {
        let (axis, across) = (self.axis, 1 - self.axis);
        let piece = &self.pieces[self.index(0.5 * (from + to))];
        let [mut low, mut high] = [(piece.t.0, piece.start), (piece.t.1, piece.end)];
        if low.1[axis] > high.1[axis] {
            std::mem::swap(&mut low, &mut high);
        }
        let curve = &self.curves[piece.curve as usize];
        let reached = |value: f64, is_upper: bool| {
            let (mut below, mut above) = (low, high);
            for _ in 0..PART {
                let t = 0.5 * (below.0 + above.0);
                let p = curve.point(t);
                let is_below = p[axis] < value || (p[axis] == value && !is_upper);
                if is_below { below = (t, p) } else { above = (t, p) }
            }
            if is_upper { above.1[across] } else { below.1[across] }
        };
        let ends = match from <= low.1[axis] && high.1[axis] <= to {
            true => [low.1[across], high.1[across]],
            false => [reached(from, false), reached(to, true)],
        };
        (ends[0].min(ends[1]), ends[0].max(ends[1]))
    }

    /// The other coordinate at a value along the axis between the chain's ends.
    fn place(&self, value: f64) -> f64 {
        let (axis, across) = (self.axis, 1 - self.axis);
        let piece = &self.pieces[self.index(value)];
        let (start, end) = (piece.start, piece.end);
        if piece.straight {
            let share = (value - start[axis]) / (end[axis] - start[axis]);
            return start[across] + (end[across] - start[across]) * share.clamp(0.0, 1.0);
        }
        let curve = &self.curves[piece.curve as usize];
        let (from, to) = piece.t;
        let t = bracketed(|t| curve.point(t)[axis] - value, from, to, PLACE * (to - from));
        curve.point(t)[across]
    }

    /// A chain along an axis through one straight across it.
    fn passes(&self, other: &Self, margin: DVec2) -> Option<DVec2> {
        let (axis, across) = (self.axis, other.axis);
        let value = other.lo[axis];
        let beyond = |lo: f64, hi: f64, x: f64, by: f64| lo + by < x && x < hi - by;
        if other.hi[axis] > value || !beyond(self.lo[axis], self.hi[axis], value, margin[axis]) {
            return None;
        }
        let place = self.place(value);
        let at = if axis == 0 { DVec2::new(value, place) } else { DVec2::new(place, value) };
        beyond(other.lo[across], other.hi[across], place, margin[across]).then_some(at)
    }
}

/// Where two chains change sides. Most do not, which is soon known; the place is then found in every detail.
fn change_sides(a: &Chain<'_>, b: &Chain<'_>, margin: DVec2) -> Option<DVec2> {
    if a.axis != b.axis {
        return a.passes(b, margin).or_else(|| b.passes(a, margin));
    }
    compared(a, b, margin, Compare::Sides)?;
    compared(a, b, margin, Compare::Places)
}

/// What is known of two chains between two ends of pieces.
#[derive(Clone, Copy, PartialEq)]
enum Compare {
    /// Which is on which side. Where the boxes of their pieces, or of parts of these, overlap nowhere, one place
    /// decides.
    Sides,
    /// The sides at all places.
    Places,
}

/// The first change of sides of two chains along one axis.
fn compared(a: &Chain<'_>, b: &Chain<'_>, margin: DVec2, what: Compare) -> Option<DVec2> {
    let axis = a.axis;
    let (lo, hi) = (a.lo.max(b.lo)[axis], a.hi.min(b.hi)[axis]);
    // between the ends of pieces, where either may jump
    let mut ends: Vec<f64> = a.ends(lo, hi).chain(b.ends(lo, hi)).collect();
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let (mut before, mut last) = (0.0, lo);
    for pair in ends.windows(2) {
        let line = |share: f64| pair[0] + share * (pair[1] - pair[0]);
        // one piece of each: mostly their boxes lie apart
        let ((mut a_lo, mut a_hi), (mut b_lo, mut b_hi)) = (a.range(line(0.5)), b.range(line(0.5)));
        if what == Compare::Sides && a_lo < b_hi && b_lo < a_hi {
            // a long piece's box may hold all of a hole beside it
            ((a_lo, a_hi), (b_lo, b_hi)) = (a.part(pair[0], pair[1]), b.part(pair[0], pair[1]));
        }
        let sides = (a_lo - b_hi, b_lo - a_hi);
        let beside = what == Compare::Sides && sides.0.max(sides.1) >= 0.0;
        let as_before = if sides.0 >= 0.0 { before > 0.0 } else { before < 0.0 };
        if beside && as_before {
            continue;
        }
        let shares: &[f64] = match () {
            () if sides.0.max(sides.1) > margin[1 - axis] => &[0.5],
            () if beside => &MIDDLE_FIRST,
            () => &SHARES,
        };
        for &share in shares {
            let line = line(share);
            let apart = match sides {
                (above, _) if above > margin[1 - axis] => above,
                (_, below) if below > margin[1 - axis] => -below,
                _ => a.place(line) - b.place(line),
            };
            if apart.abs() <= margin[1 - axis] {
                continue;
            }
            if apart * before < 0.0 {
                return Some(meeting(a, b, (last, line), apart));
            }
            (before, last) = (apart, line);
            if beside {
                break; // on the same side at all others
            }
        }
    }
    None
}

/// Where two chains meet between scan lines; on the second they are `apart`.
fn meeting(a: &Chain<'_>, b: &Chain<'_>, (mut from, mut to): (f64, f64), apart: f64) -> DVec2 {
    for _ in 0..BISECTIONS {
        let line = 0.5 * (from + to);
        if (a.place(line) - b.place(line)) * apart > 0.0 { to = line } else { from = line }
    }
    // where one chain jumps across the other, along a piece across the axis, the other one gives the place
    let jump = |c: &Chain<'_>| (c.place(to) - c.place(from)).abs();
    let (line, place) = (to, if jump(a) <= jump(b) { a.place(to) } else { b.place(to) });
    if a.axis == 0 { DVec2::new(line, place) } else { DVec2::new(place, line) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[(f64, f64)]) -> TrimLoop {
        let next = points.iter().cycle().skip(1);
        let lines = points.iter().zip(next).map(|(&a, &b)| Bezier::line(a.into(), b.into()));
        TrimLoop::new(lines.collect(), DVec2::ZERO).unwrap()
    }

    fn cubics(curves: &[[(f64, f64); 4]]) -> TrimLoop {
        let curve = |c: &[(f64, f64); 4]| Bezier { points: c.iter().map(|&(u, v)| DVec3::new(u, v, 1.0)).collect() };
        TrimLoop::new(curves.iter().map(curve).collect(), DVec2::ZERO).unwrap()
    }

    fn square(at: f64, side: f64) -> TrimLoop {
        polygon(&[(at, at), (at + side, at), (at + side, at + side), (at, at + side)])
    }

    fn near(loops: &[TrimLoop], p: (f64, f64), off: f64) {
        let found = crossing(loops);
        assert!(matches!(found, Crossing::At(q) if q.distance(p.into()) <= off), "{found:?}");
    }

    #[test]
    fn loops_that_cross_themselves() {
        near(&[polygon(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)])], (0.5, 0.5), 1e-9);
        // in a corner of both
        let bow = [(-1.0, -1.0), (0.0, 0.0), (1.0, 1.0), (1.0, -1.0), (0.0, 0.0), (-1.0, 1.0)];
        near(&[polygon(&bow)], (0.0, 0.0), 1e-9);
        // along the axes alone
        near(&[polygon(&[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 2.0), (1.0, -1.0), (0.0, -1.0)])], (1.0, 0.0), 1e-9);
        // a curve with a loop in it, and its chord
        let knot = [(0.0, 0.0), (3.0, 2.0), (-2.0, 2.0), (1.0, 0.0)];
        let back = [(1.0, 0.0), (1.0, -1.0), (0.0, -1.0), (0.0, 0.0)];
        near(&[cubics(&[knot, back])], (0.5, 0.75), 0.5);
        // one whose box the other curves touch in corners only
        let knot = [(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0), (0.0, 0.0), (3.0, 3.0)];
        let curve = Bezier { points: knot.iter().map(|&(u, v)| DVec3::new(u, v, 1.0)).collect() };
        let around = [(3.0, 3.0), (3.0, 4.0), (-1.0, 4.0), (-1.0, 0.0), (0.0, 0.0)];
        let lines = around.windows(2).map(|w| Bezier::line(w[0].into(), w[1].into()));
        let whole = TrimLoop::new([curve].into_iter().chain(lines).collect(), DVec2::ZERO).unwrap();
        near(&[whole], (1.634, 1.920), 0.5);
        // two bows
        let over = [(0.0, 0.0), (0.0, 2.0), (1.0, -1.0), (1.0, 1.0)];
        let under = [(1.0, 1.0), (0.8, 1.0), (0.2, 0.0), (0.0, 0.0)];
        near(&[cubics(&[over, under])], (0.5, 0.5), 0.5);
    }

    #[test]
    fn loops_that_cross_each_other() {
        near(&[square(0.0, 2.0), square(1.0, 2.0)], (1.5, 1.5), 0.8); // in one of two corners
        near(&[square(0.0, 2.0), polygon(&[(0.9, 1.5), (1.1, 1.5), (1.0, 2.5)])], (1.0, 2.0), 0.1);
        // where two sides of the one meet
        near(&[square(0.0, 2.0), polygon(&[(1.0, 1.5), (1.5, 2.0), (1.0, 2.5), (0.5, 2.0)])], (1.0, 2.0), 0.6);
    }

    /// Holes inside, loops that touch in a point or along a side, thin ones, and curves that follow each other.
    #[test]
    fn loops_that_do_not() {
        let arc = |k: f64| [(0.0, 0.0), (k, 0.2), (k, 0.8), (0.0, 1.0)];
        let back = |k: f64| [(0.0, 1.0), (k, 0.8), (k, 0.2), (0.0, 0.0)];
        let wave = [(0.0, 0.0), (1.0, 3.0), (2.0, -3.0), (3.0, 0.0)];
        for loops in [
            vec![],
            vec![square(0.0, 2.0), square(0.5, 1.0), square(0.75, 0.5)],
            vec![square(0.0, 1.0), square(1.0, 1.0)],
            vec![square(0.0, 2.0), polygon(&[(0.0, 0.5), (0.0, 1.5), (1.0, 1.0)])],
            vec![polygon(&[(0.0, 0.0), (1.0, 1e-5), (2.0, 0.0), (1.0, 1e-5 + 1e-9)])],
            vec![cubics(&[arc(-0.5), back(0.5)])],
            vec![cubics(&[arc(0.4), back(0.6)])],
            vec![cubics(&[wave, [(3.0, 0.0), (3.0, 3.0), (0.0, 3.0), (0.0, 0.0)]])],
        ] {
            assert_eq!(crossing(&loops), Crossing::No, "{loops:?}");
        }
    }

    /// A comb of 3000 teeth whose boxes all meet, so far do they lean; upright, each is beside two others.
    #[test]
    fn too_many_are_reported() {
        let comb = |lean: f64, first: u32| {
            let teeth = (first..3000).flat_map(|k| [(f64::from(2 * k), 0.0), (f64::from(2 * k + 1) + lean, 1.0)]);
            let points: Vec<(f64, f64)> = teeth.chain([(6000.0, -1.0), (0.0, -1.0)]).collect();
            crossing(&[polygon(&points)])
        };
        assert_eq!(comb(12_000.0, 0), Crossing::Unknown);
        assert_eq!(comb(12_000.0, 2500), Crossing::No);
        assert_eq!(comb(0.0, 0), Crossing::No);
    }

    /// The shorter comparison finds a change of sides where the other one does: rings of four bent or straight curves
    /// that touch, overlap and lie in each other.
    #[test]
    fn sides_are_told_by_fewer_places() {
        let mut state = 11_u64;
        let mut below = |n: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % n) as f64
        };
        let mut found = [0; 2];
        for _ in 0..200 {
            let mut ring = || {
                let (x, y, r, bulge) = (below(5), below(5), 1.0 + below(3), below(3) * 0.5);
                let corners = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];
                let at = |k: usize| (x + r * corners[k % 4].0, y + r * corners[k % 4].1);
                let quarter = |k: usize| {
                    let ((ax, ay), (bx, by)) = (at(k), at(k + 1));
                    let corner = (ax + bx - x, ay + by - y);
                    let towards = |(px, py): (f64, f64)| (px + bulge * (corner.0 - px), py + bulge * (corner.1 - py));
                    [(ax, ay), towards((ax, ay)), towards((bx, by)), (bx, by)]
                };
                cubics(&[0, 1, 2, 3].map(quarter))
            };
            let loops = [ring(), ring()];
            let curves: Vec<Vec<Bezier<DVec3>>> = loops.iter().map(|l| l.curves().collect()).collect();
            let [a, b] = [0, 1].map(|of| chains(of, &curves[of]));
            let all: Vec<&Chain<'_>> = a.iter().chain(&b).collect();
            for (k, p) in all.iter().enumerate() {
                let meets = |q: &Chain<'_>| p.lo.cmple(q.hi).all() && q.lo.cmple(p.hi).all();
                for q in all[k + 1..].iter().filter(|q| q.axis == p.axis && meets(q)) {
                    let margin = DVec2::splat(1e-3);
                    let [quick, slow] = [Compare::Sides, Compare::Places].map(|what| compared(p, q, margin, what));
                    assert_eq!(quick.is_some(), slow.is_some(), "{loops:?}");
                    found[usize::from(slow.is_some())] += 1;
                }
            }
        }
        assert!(found.iter().all(|count| *count > 20), "{found:?}");
    }

    /// Holes in rows and columns, as in perforated sheets: none crosses another, and one that does is found.
    #[test]
    fn many_loops_side_by_side() {
        let hole = |k: u32| {
            let (x, y) = (f64::from(k % 100), f64::from(k / 100));
            polygon(&[(x + 0.2, y + 0.5), (x + 0.5, y + 0.8), (x + 0.8, y + 0.5), (x + 0.5, y + 0.2)])
        };
        let mut loops: Vec<TrimLoop> = (0..10_000).map(hole).chain([square(0.0, 100.0)]).collect();
        assert_eq!(crossing(&loops), Crossing::No);
        loops.push(polygon(&[(41.5, 73.0), (41.9, 73.5), (41.5, 74.5), (41.4, 73.5)]));
        near(&loops, (41.5, 73.8), 1.0);
    }

    /// The boxes of a round border's quarters hold nearly all holes.
    #[test]
    fn many_loops_within_a_round_border() {
        let turned = |(x, y): (f64, f64), k: usize| [(x, y), (-y, x), (-x, -y), (y, -x)][k];
        let quarter = |k: usize| [(60.0, 0.0), (60.0, 33.1), (33.1, 60.0), (0.0, 60.0)].map(|p| turned(p, k));
        let hole = |(x, y): (f64, f64)| polygon(&[(x - 0.3, y), (x, y + 0.3), (x + 0.3, y), (x, y - 0.3)]);
        let places = (0..120 * 120).map(|k| (f64::from(k % 120) - 59.5, f64::from(k / 120) - 59.5));
        let inside = places.filter(|(x, y)| x.hypot(*y) < 59.5);
        let mut loops: Vec<TrimLoop> = inside.map(hole).collect();
        assert!(loops.len() > 10_000);
        loops.push(cubics(&[0, 1, 2, 3].map(quarter)));
        assert_eq!(crossing(&loops), Crossing::No);
        loops.push(hole((59.9, 0.0)));
        near(&loops, (60.0, 0.0), 0.5);
    }
}
