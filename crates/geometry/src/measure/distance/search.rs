//! Branch and bound over pairs of pieces.

use super::local::{self, Found, Place};
use super::piece::{Datum, Part, Piece};
use super::{Distance, Pieces, Source, hull};
use crate::trim::RectSide;
use glam::{DVec2, DVec3};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Pairs whose bound is below the best distance by no more than this share of it are closed: a tenth of what measures
/// are compared by.
const TOLERANCE: f64 = 1e-10;

/// An item's pieces: groups, patches and curves, and their halves as far as they are known.
struct Tree<'a> {
    sources: &'a [Source<'a>],
    datums: &'a [Datum],
    pieces: Vec<Piece>,
    root: usize,
}

/// A pair of pieces that is open.
struct Pair {
    /// Lower bound of the distance, but for rounding.
    bound: f64,
    /// Pairs of equal bounds: the nearer middles first.
    middles: f64,
    pieces: [usize; 2],
    /// Where Newton's method ended, if that lies in both pieces.
    tried: Option<[DVec2; 2]>,
}

/// The nearest pair of points that is known.
#[derive(Clone, Copy)]
struct Best {
    distance: f64,
    points: [DVec3; 2],
    noise: f64,
}

struct Search<'a> {
    trees: [Tree<'a>; 2],
    open: BinaryHeap<Pair>,
    best: Option<Best>,
    /// The least bound of closed pairs, less their rounding.
    least: f64,
}

impl PartialEq for Pair {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Pair {}

impl PartialOrd for Pair {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Pair {
    /// A heap gives its largest first.
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound).then(other.middles.total_cmp(&self.middles))
    }
}

/// The smallest distance, after at most `most` pairs, or as many as the first pair of points needs.
pub(super) fn smallest(a: &Pieces<'_>, b: &Pieces<'_>, most: usize) -> Option<Distance> {
    let datums: Vec<Datum> = a.datum.into_iter().chain(b.datum).collect();
    let trees = [Tree::new(a, &datums)?, Tree::new(b, &datums)?];
    let roots = [trees[0].root, trees[1].root];
    let mut search = Search { trees, open: BinaryHeap::new(), best: None, least: f64::INFINITY };
    search.consider(roots, 0.0, None);
    let mut count = 0;
    while let Some(pair) = search.open.pop() {
        let is_over = count >= most && search.best.is_some();
        if is_over || search.is_settled(pair.bound, search.noise(pair.pieces)) {
            search.close(pair.bound, pair.pieces);
        } else {
            count += 1;
            search.divide(pair);
        }
    }
    let best = search.best?;
    let (mut distance, mut error) = (best.distance, best.noise);
    if distance <= best.noise {
        (distance, error) = (0.0, distance + error);
    }
    error += (distance - search.least.max(0.0)).max(0.0);
    Some(Distance { distance, points: best.points, error })
}

impl<'a> Tree<'a> {
    fn new(item: &'a Pieces<'_>, datums: &'a [Datum]) -> Option<Self> {
        let mut tree = Self { sources: &item.sources, datums, pieces: Vec::new(), root: 0 };
        let mut all: Vec<usize> = item.parts.iter().map(|part| tree.push(part.clone())).collect();
        if all.is_empty() {
            return None;
        }
        tree.root = tree.grouped(&mut all);
        Some(tree)
    }

    fn push(&mut self, part: Part) -> usize {
        let source = self.source(part.source);
        let piece = Piece::new(part, source, self.datums);
        self.pieces.push(piece);
        self.pieces.len() - 1
    }

    fn source(&self, number: usize) -> &'a Source<'a> {
        &self.sources[number]
    }

    /// Pieces as one, halved at the median of their centres along the longest side.
    fn grouped(&mut self, all: &mut [usize]) -> usize {
        if let [only] = all {
            return *only;
        }
        let centre = |i: usize| self.pieces[i].centre;
        let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let reach = all.iter().map(|i| centre(*i)).fold(none, |(low, high), p| (low.min(p), high.max(p)));
        let axis = (reach.1 - reach.0).max_position();
        let middle = all.len() / 2;
        all.select_nth_unstable_by(middle, |a, b| centre(*a)[axis].total_cmp(&centre(*b)[axis]).then(a.cmp(b)));
        let (left, right) = all.split_at_mut(middle);
        let [a, b] = [self.grouped(left), self.grouped(right)];
        let group = Piece::group((a, &self.pieces[a]), (b, &self.pieces[b]));
        self.pieces.push(group);
        self.pieces.len() - 1
    }

    /// The halves of a piece; `None` where there can be none.
    fn halves(&mut self, piece: usize) -> Option<[Option<usize>; 2]> {
        let of = &self.pieces[piece];
        if of.halves.is_some() {
            return of.halves;
        }
        if of.need().1 <= of.noise {
            return None;
        }
        let halves = of.part.as_ref()?.halved(of.axis())?.map(|mut part| {
            if !part.is_whole {
                match self.source(part.source).side(part.low, part.high) {
                    RectSide::Inside => part.is_whole = true,
                    RectSide::Boundary => {}
                    RectSide::Outside => return None,
                }
            }
            Some(self.push(part))
        });
        self.pieces[piece].halves = Some(halves);
        Some(halves)
    }
}

impl Search<'_> {
    fn pieces(&self, pair: [usize; 2]) -> [&Piece; 2] {
        [&self.trees[0].pieces[pair[0]], &self.trees[1].pieces[pair[1]]]
    }

    fn noise(&self, pair: [usize; 2]) -> f64 {
        let [a, b] = self.pieces(pair);
        a.noise + b.noise
    }

    fn is_settled(&self, bound: f64, noise: f64) -> bool {
        self.best.is_some_and(|best| bound >= best.distance * (1.0 - TOLERANCE) - noise)
    }

    fn close(&mut self, bound: f64, pieces: [usize; 2]) {
        self.least = self.least.min(bound - self.noise(pieces));
    }

    /// A pair of points of both items.
    fn offer(&mut self, distance: f64, points: [DVec3; 2], noise: f64) {
        if distance.is_finite() && self.best.is_none_or(|best| distance < best.distance) {
            self.best = Some(Best { distance, points, noise });
        }
    }

    /// Opens a pair, unless it needs no look. `bound` is that of a pair that holds it.
    fn consider(&mut self, pieces: [usize; 2], bound: f64, tried: Option<[DVec2; 2]>) {
        let [a, b] = self.pieces(pieces);
        if a.has_none_nearest(b) || b.has_none_nearest(a) {
            return;
        }
        let noise = a.noise + b.noise;
        if let (Some(p), Some(q)) = (a.middle, b.middle) {
            self.offer(p.distance(q), [p, q], noise);
        }
        let [a, b] = self.pieces(pieces);
        let enough = self.best.map_or(f64::INFINITY, |best| best.distance);
        let mut bound = bound.max(a.apart_in_profile(b));
        if bound < enough {
            bound = bound.max(hull::apart(&a.hull, &b.hull, enough));
        }
        let middles = a.centre.distance(b.centre);
        let holds = |piece: &Piece, at: DVec2| piece.part.as_ref().is_some_and(|part| part.contains(at));
        let tried = tried.filter(|at| holds(a, at[0]) && holds(b, at[1]));
        if self.is_settled(bound, noise) {
            self.close(bound, pieces);
        } else {
            self.open.push(Pair { bound, middles, pieces, tried });
        }
    }

    /// Looks for nearer points in a pair, and opens its halves.
    fn divide(&mut self, pair: Pair) {
        let tried = pair.tried.or_else(|| self.descend(pair.pieces));
        if self.is_settled(pair.bound, self.noise(pair.pieces)) {
            self.close(pair.bound, pair.pieces);
            return;
        }
        let [a, b] = self.pieces(pair.pieces);
        let both_groups = a.part.is_none() && b.part.is_none();
        let size = |piece: &Piece| if both_groups { (piece.radius, 0.0) } else { piece.need() };
        let is_second = size(b) > size(a);
        for side in if is_second { [1, 0] } else { [0, 1] } {
            let Some(halves) = self.trees[side].halves(pair.pieces[side]) else { continue };
            for half in halves.into_iter().flatten() {
                let mut pieces = pair.pieces;
                pieces[side] = half;
                self.consider(pieces, pair.bound, tried);
            }
            return;
        }
        self.close(pair.bound, pair.pieces);
    }

    /// Newton's method in a pair of pieces that are no groups, and where it ended.
    fn descend(&mut self, pieces: [usize; 2]) -> Option<[DVec2; 2]> {
        let [a, b] = self.pieces(pieces);
        let (p, q) = (a.part.as_ref()?, b.part.as_ref()?);
        let [from, to] = [self.trees[0].source(p.source), self.trees[1].source(q.source)];
        let place = |source, part: &Part| Place { source, low: part.low, high: part.high };
        let Found { at, points, distance } = local::nearest(&place(from, p), &place(to, q));
        let belongs = (p.is_whole || from.contains(at[0])) && (q.is_whole || to.contains(at[1]));
        let noise = a.noise + b.noise;
        if belongs {
            self.offer(distance, points, noise);
        }
        Some(at)
    }
}
