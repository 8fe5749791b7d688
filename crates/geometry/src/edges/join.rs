//! Finds the stretches of loops that are the same edge.
//!
//! ```text
//!      face A ──●────────────●──         one edge of the source: its uses, whatever the distance
//!      face B ──●──────●─────●──  cut    else same ends, and A's inner points within `reach` of B's
//! ```
//!
//! Stretches of one face may meet too: a seam.

use super::sheet::Sheet;
use super::stretch::{Cut, Stretch, cut};
use super::{LOOSE, nearest};
use crate::model::Bounds;
use glam::DVec3;
use std::collections::HashMap;

/// Chords in a stretch, for the search of near stretches.
const STRETCH_CHORDS: usize = 64;

/// The boundary of a part.
#[derive(Debug)]
pub(super) struct Boundaries {
    pub cut: Cut,
    /// Of each edge its stretches, and whether each runs as the first does.
    pub edges: Vec<Vec<(usize, bool)>>,
    /// Of each stretch that was compared.
    samples: Vec<Samples>,
    size: f64,
}

/// Points along a stretch, at equal steps.
#[derive(Clone, Debug)]
struct Samples {
    points: Vec<DVec3>,
    bounds: Bounds,
    longest_chord: f64,
}

/// A stretch in space.
struct Trail<'b> {
    stretch: &'b Stretch,
    sheet: &'b Sheet<'b>,
}

impl Trail<'_> {
    /// The point at the fraction `s`, each piece taking the same.
    fn at(&self, s: f64) -> DVec3 {
        let pieces = &self.stretch.pieces;
        let s = s * pieces.len() as f64;
        let k = (s.floor() as usize).min(pieces.len() - 1);
        self.sheet.at(&pieces[k], s - k as f64)
    }

    fn samples(&self) -> Samples {
        let count = STRETCH_CHORDS.max(16 * self.stretch.pieces.len());
        let points: Vec<DVec3> = (0..=count).map(|k| self.at(k as f64 / count as f64)).collect();
        let bounds = points.iter().copied().fold(Bounds::EMPTY, Bounds::with);
        let longest_chord = points.windows(2).map(|w| w[0].distance(w[1])).fold(0.0, f64::max);
        Samples { points, bounds, longest_chord }
    }
}

/// Cuts and joins the loops of `sheets`. Points within `reach` are the same; `size` is the part's.
pub(super) fn join(sheets: &[Sheet], reach: f64, size: f64) -> Boundaries {
    let cut = cut(sheets, reach, size);
    let mut stated: HashMap<u32, Vec<(usize, bool)>> = HashMap::new();
    let mut order = Vec::new();
    for (i, s) in cut.stretches.iter().enumerate().filter(|(_, s)| s.whole) {
        let Some(edge) = s.edge else { continue };
        let uses = stated.entry(edge.edge).or_insert_with(|| {
            order.push(edge.edge);
            Vec::new()
        });
        let along = uses.first().is_none_or(|first| cut.stretches[first.0].edge == s.edge);
        uses.push((i, along));
    }
    let edges = order.into_iter().filter_map(|edge| stated.remove(&edge)).collect();
    let rest: Vec<usize> = (0..cut.stretches.len()).filter(|i| !cut.stretches[*i].whole).collect();
    let count = cut.stretches.len();
    let none = Samples { points: Vec::new(), bounds: Bounds::EMPTY, longest_chord: 0.0 };
    let mut out = Boundaries { samples: vec![none; count], cut, edges, size };
    out.pair(&rest, sheets, reach);
    out
}

impl Boundaries {
    fn trail<'b>(&'b self, sheets: &'b [Sheet], i: usize) -> Trail<'b> {
        let stretch = &self.cut.stretches[i];
        Trail { stretch, sheet: &sheets[stretch.face] }
    }

    /// Finds the edges of `some`: stretches in order, each with the nearest free one between the same vertices. A
    /// stretch that stays alone joins an existing edge.
    fn pair(&mut self, some: &[usize], sheets: &[Sheet], reach: f64) {
        for &i in some {
            if self.samples[i].points.is_empty() {
                self.samples[i] = self.trail(sheets, i).samples();
            }
        }
        let mut between: HashMap<[usize; 2], Vec<usize>> = HashMap::new();
        for &i in some {
            let [a, b] = self.cut.stretches[i].ends;
            between.entry([a.min(b), a.max(b)]).or_default().push(i);
        }
        let mut taken: HashMap<usize, usize> = HashMap::new();
        for &first in some {
            if taken.contains_key(&first) {
                continue;
            }
            let [a, b] = self.cut.stretches[first].ends;
            let partners = &between[&[a.min(b), a.max(b)]];
            let free = partners.iter().copied().filter(|j| *j != first && !taken.contains_key(j));
            let best = self.best(first, free, sheets, reach);
            let uses = match best {
                Some((second, distance)) => {
                    self.cut.deviation = self.cut.deviation.max(distance);
                    vec![(first, true), (second, !self.opposite(sheets, first, second))]
                }
                None => vec![(first, true)],
            };
            uses.iter().for_each(|u| {
                taken.insert(u.0, self.edges.len());
            });
            self.edges.push(uses);
        }
        // where three faces meet, no free stretch is left for the third
        for &single in some {
            let own = taken[&single];
            if self.edges[own].len() != 1 {
                continue;
            }
            let [a, b] = self.cut.stretches[single].ends;
            let partners = &between[&[a.min(b), a.max(b)]];
            let joined = partners.iter().copied().filter(|j| self.edges[taken[j]].len() > 1);
            if let Some((other, distance)) = self.best(single, joined, sheets, reach) {
                self.cut.deviation = self.cut.deviation.max(distance);
                let first = self.edges[taken[&other]][0].0;
                let along = !self.opposite(sheets, first, single);
                self.edges[own].clear();
                self.edges[taken[&other]].push((single, along));
            }
        }
        self.edges.retain(|uses| !uses.is_empty());
    }

    /// The stretch of `others` next to `first`, and its distance, where that is within `reach`; pieces of one edge of
    /// the source come first, and may be as far apart as loose edges.
    fn best(
        &self,
        first: usize,
        others: impl Iterator<Item = usize>,
        sheets: &[Sheet],
        reach: f64,
    ) -> Option<(usize, f64)> {
        let edge = |i: usize| self.cut.stretches[i].edge.map(|e| e.edge);
        let measured = others.filter_map(|j| {
            let same = edge(first).is_some() && edge(first) == edge(j);
            let limit = if same { reach.max(LOOSE * self.size) } else { reach };
            let distance = self.apart(first, j, sheets, limit);
            (distance <= limit).then_some((!same, distance, j))
        });
        let best = measured.min_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        best.map(|(_, distance, j)| (j, distance))
    }

    /// Largest distance of three inner points of `a` from `b`; if beyond `limit`, any distance beyond it.
    fn apart(&self, a: usize, b: usize, sheets: &[Sheet], limit: f64) -> f64 {
        let (trail, other) = (self.trail(sheets, a), self.trail(sheets, b));
        let (own, samples) = (&self.samples[a].points, &self.samples[b]);
        let (middle, slack) = (own[own.len() / 2], limit + samples.longest_chord);
        let (low, high) = (samples.bounds.min - slack, samples.bounds.max + slack);
        if middle.cmplt(low).any() || middle.cmpgt(high).any() {
            return f64::INFINITY;
        }
        let mut most: f64 = 0.0;
        for s in [0.21, 0.5, 0.83] {
            most = most.max(nearest(&|t| other.at(t), &samples.points, trail.at(s), slack).1);
            if most > limit {
                break;
            }
        }
        most
    }

    /// Whether stretch `b` runs against `a`, which is the same edge.
    fn opposite(&self, sheets: &[Sheet], a: usize, b: usize) -> bool {
        let (first, second) = (&self.cut.stretches[a], &self.cut.stretches[b]);
        if first.ends[0] != first.ends[1] {
            return first.ends[0] == second.ends[1];
        }
        let (first, second) = (self.trail(sheets, a), self.trail(sheets, b));
        let t = |s: f64| nearest(&|t| second.at(t), &self.samples[b].points, first.at(s), f64::INFINITY).0;
        t(0.3) > t(0.6)
    }

    /// Joins edges that have one stretch only, where a file's edges lie off its surfaces. Ends within `loose` of each
    /// other become one vertex, stretches within `loose` of a point are dropped, and the others are paired again.
    pub fn mend(&mut self, sheets: &[Sheet], loose: f64) {
        let single: Vec<usize> = self.edges.iter().filter(|e| e.len() == 1).map(|e| e[0].0).collect();
        let points = &self.cut.vertices.points;
        let mut ends: Vec<usize> = single.iter().flat_map(|s| self.cut.stretches[*s].ends).collect();
        ends.sort_by(|a, b| points[*a].x.total_cmp(&points[*b].x));
        ends.dedup();
        let mut to: HashMap<usize, usize> = HashMap::new();
        for (k, &a) in ends.iter().enumerate() {
            let p = points[a];
            let own = *to.entry(a).or_insert(a);
            for &b in ends[k + 1..].iter().take_while(|b| points[**b].x <= p.x + loose) {
                let distance = points[b].distance(p);
                // only to the first of a cluster, so that none grows along a chain
                if distance <= loose && !to.contains_key(&b) && own == a {
                    to.insert(b, a);
                    self.cut.deviation = self.cut.deviation.max(distance);
                }
            }
        }
        for s in &mut self.cut.stretches {
            s.ends = s.ends.map(|v| to.get(&v).copied().unwrap_or(v));
        }
        let is_point = |s: &usize| {
            let (stretch, samples) = (&self.cut.stretches[*s], &self.samples[*s].points);
            let vertex = self.cut.vertices.points[stretch.ends[0]];
            stretch.ends[0] == stretch.ends[1] && samples.iter().all(|p| p.distance(vertex) <= loose)
        };
        let rest: Vec<usize> = single.iter().copied().filter(|s| !is_point(s)).collect();
        self.edges.retain(|e| e.len() > 1);
        self.pair(&rest, sheets, loose);
    }

    /// Edges of one stretch.
    pub fn single(&self) -> usize {
        self.edges.iter().filter(|e| e.len() == 1).count()
    }

    /// Loops of each face that keep a stretch, to be compared.
    pub fn kept_loops(&self) -> Vec<(usize, Option<usize>)> {
        let stretches = self.edges.iter().flatten().map(|(s, _)| &self.cut.stretches[*s]);
        let mut all: Vec<_> = stretches.map(|s| (s.face, s.trim_loop)).collect();
        all.sort();
        all.dedup();
        all
    }
}
