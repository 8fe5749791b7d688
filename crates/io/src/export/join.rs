//! Finds the stretches of loops that are the same edge.
//!
//! ```text
//!   corners of every loop ─▶ vertices ─▶ every loop cut at each vertex that it passes ─▶ stretches
//!
//!      face A ──●────────────●──         same ends, and A's inner points within `reach` of B's
//!      face B ──●──────●─────●──  cut    stretch, run the other way: one edge
//! ```
//!
//! A loop without a corner is cut at the vertices of its neighbours, else at its start. Stretches of one face may
//! meet too: a seam.

use super::boundary::{Both, Sheet};
use crate::spline::{BSpline, Bezier, SplineError};
use glam::{DVec3, DVec4};
use std::collections::HashMap;

/// Turn of a loop, in radians, that makes a vertex.
const CORNER: f64 = 0.02;
/// Chords in a piece, to look for what is near.
const CHORDS: usize = 16;
/// Steps of a golden section.
const SECTIONS: usize = 48;
/// Chords in a stretch, to look for what is near.
const STRETCH_CHORDS: usize = 64;

/// One stretch of a loop.
pub(super) struct Stretch {
    pub face: usize,
    pub both: Both,
    /// Vertices at its ends.
    pub ends: [usize; 2],
}

/// One edge: the stretch that gives its curve, and the one that follows it, if any.
pub(super) struct Edge {
    pub first: usize,
    pub second: Option<usize>,
}

/// The boundary of a part.
#[derive(Default)]
pub(super) struct Boundaries {
    pub vertices: Vec<DVec3>,
    pub stretches: Vec<Stretch>,
    pub edges: Vec<Edge>,
    /// Edge of each stretch.
    pub edge_of: Vec<usize>,
    /// Loops of each face: stretches in order.
    pub loops: Vec<Vec<Vec<usize>>>,
    /// Largest distance found between curves that are one edge, or between an edge and its surface, mm.
    pub deviation: f64,
}

/// Points that are the same within a reach.
struct Vertices {
    points: Vec<DVec3>,
    cells: HashMap<[i64; 3], Vec<usize>>,
    reach: f64,
}

impl Vertices {
    fn cell(&self, p: DVec3) -> [i64; 3] {
        // twice the reach: a point within it lies in this cell or next to it
        (p / (2.0 * self.reach)).floor().to_array().map(|x| x as i64)
    }

    fn find(&self, p: DVec3) -> Option<usize> {
        let [x, y, z] = self.cell(p);
        let near = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let all = near.filter_map(|c| self.cells.get(&c)).flatten().copied();
        let best = all.map(|i| (self.points[i].distance(p), i)).min_by(|a, b| a.0.total_cmp(&b.0));
        best.filter(|b| b.0 <= self.reach).map(|b| b.1)
    }

    fn add(&mut self, p: DVec3) -> usize {
        self.find(p).unwrap_or_else(|| {
            self.points.push(p);
            self.cells.entry(self.cell(p)).or_default().push(self.points.len() - 1);
            self.points.len() - 1
        })
    }
}

/// Cuts and joins the loops of `sheets`. Points within `reach` are the same; fitted curves aim at `fit`.
///
/// # Errors
/// The face whose curves cannot be assembled, by its place in `sheets`.
pub(super) fn join(sheets: &[Sheet], reach: f64, fit: f64) -> Result<Boundaries, (usize, SplineError)> {
    let loops: Vec<Vec<Vec<Bezier<DVec3>>>> = sheets.iter().map(|s| s.loops(reach)).collect();
    let mut vertices = Vertices { points: Vec::new(), cells: HashMap::new(), reach };
    for (sheet, pieces) in each(sheets, &loops) {
        for (k, c) in pieces.iter().enumerate() {
            let next = &pieces[(k + 1) % pieces.len()];
            let (end, start) = (sheet.at(c, 1.0), sheet.at(next, 0.0));
            let back = (end - sheet.at(c, 1.0 - 1e-3)).normalize_or_zero();
            let on = (sheet.at(next, 1e-3) - start).normalize_or_zero();
            if end.distance(start) > reach || back.angle_between(on) > CORNER || back.dot(on) <= 0.0 {
                vertices.add(end);
                vertices.add(start);
            }
        }
    }
    // loops that meet no vertex start where they start
    let order = by_x(&vertices.points);
    let mut seeds = Vec::new();
    for (sheet, pieces) in each(sheets, &loops) {
        if pieces.iter().all(|c| cuts(sheet, c, &order, reach).is_empty()) {
            seeds.push(sheet.at(&pieces[0], 0.0));
        }
    }
    seeds.into_iter().for_each(|s| {
        vertices.add(s);
    });
    let order = by_x(&vertices.points);
    let mut out = Boundaries::default();
    for (face, (sheet, loops)) in sheets.iter().zip(&loops).enumerate() {
        let mut of_face = Vec::new();
        for pieces in loops {
            let mut of_loop = Vec::new();
            for (pieces, ends) in stretches(sheet, pieces, &order, reach) {
                let both = sheet.curve(&pieces, fit).map_err(|e| (face, e))?;
                out.deviation = out.deviation.max(both.deviation);
                of_loop.push(out.stretches.len());
                out.stretches.push(Stretch { face, both, ends });
            }
            of_face.push(of_loop);
        }
        out.loops.push(of_face);
    }
    out.vertices = vertices.points;
    pair(&mut out, reach);
    Ok(out)
}

fn each<'s, 'a>(
    sheets: &'s [Sheet<'a>],
    loops: &'s [Vec<Vec<Bezier<DVec3>>>],
) -> impl Iterator<Item = (&'s Sheet<'a>, &'s Vec<Bezier<DVec3>>)> {
    sheets.iter().zip(loops).flat_map(|(s, l)| l.iter().map(move |pieces| (s, pieces)))
}

/// Points with their numbers, in order of `x`.
fn by_x(points: &[DVec3]) -> Vec<(DVec3, usize)> {
    let mut order: Vec<_> = points.iter().copied().enumerate().map(|(i, p)| (p, i)).collect();
    order.sort_by(|a, b| a.0.x.total_cmp(&b.0.x));
    order
}

/// Parameters at which a piece passes a vertex, ends included, in order, and the vertices.
fn cuts(sheet: &Sheet, c: &Bezier<DVec3>, order: &[(DVec3, usize)], reach: f64) -> Vec<(f64, usize)> {
    let chords: Vec<DVec3> = (0..=CHORDS).map(|k| sheet.at(c, k as f64 / CHORDS as f64)).collect();
    // a curve stays within a chord's length of its chords, unless it is wilder than any trim
    let slack = reach + chords.windows(2).map(|w| w[0].distance(w[1])).fold(0.0, f64::max);
    let (lo, hi) = chords.iter().fold((chords[0], chords[0]), |(a, b), p| (a.min(*p), b.max(*p)));
    let (lo, hi) = (lo - slack, hi + slack);
    let from = order.partition_point(|(p, _)| p.x < lo.x);
    let near = order[from..].iter().take_while(|(p, _)| p.x <= hi.x);
    let mut found: Vec<(f64, usize)> = near
        .filter(|(p, _)| p.cmpge(lo).all() && p.cmple(hi).all())
        .filter_map(|&(p, vertex)| {
            for (t, end) in [(0.0, chords[0]), (1.0, chords[CHORDS])] {
                if end.distance(p) <= reach {
                    return Some(vec![(t, vertex)]);
                }
            }
            let (t, distance) = nearest(&|t| sheet.at(c, t), CHORDS, p);
            (distance <= reach).then(|| vec![(t, vertex)])
        })
        .flatten()
        .collect();
    // a piece that begins and ends at one vertex has it at both ends
    for (t, end) in [(0.0, chords[0]), (1.0, chords[CHORDS])] {
        let closest = order[from..].iter().take_while(|(p, _)| p.x <= hi.x);
        let closest = closest.map(|&(p, v)| (p.distance(end), v)).min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((distance, vertex)) = closest
            && distance <= reach
        {
            found.retain(|f| f.0 != t);
            found.push((t, vertex));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.dedup_by(|a, b| a.0 == b.0);
    found
}

/// Parameter in `[0, 1]` and distance of the point of `curve` next to `p`: the best of `chords` + 1 points, refined.
fn nearest(curve: &dyn Fn(f64) -> DVec3, chords: usize, p: DVec3) -> (f64, f64) {
    let step = 1.0 / chords as f64;
    let at = |t: f64| curve(t).distance_squared(p);
    let best = (0..=chords).map(|k| k as f64 * step).min_by(|a, b| at(*a).total_cmp(&at(*b))).unwrap_or(0.0);
    let (mut a, mut b) = ((best - step).max(0.0), (best + step).min(1.0));
    for _ in 0..SECTIONS {
        let (c, d) = (a + 0.381_966 * (b - a), a + 0.618_034 * (b - a));
        if at(c) < at(d) { b = d } else { a = c }
    }
    let t = [0.5 * (a + b), best].into_iter().min_by(|a, b| at(*a).total_cmp(&at(*b))).unwrap_or(best);
    (t, at(t).sqrt())
}

/// A loop cut at its vertices: pieces and end vertices of each stretch.
type Pieces = (Vec<Bezier<DVec3>>, [usize; 2]);

fn stretches(sheet: &Sheet, pieces: &[Bezier<DVec3>], order: &[(DVec3, usize)], reach: f64) -> Vec<Pieces> {
    let mut out: Vec<Pieces> = Vec::new();
    // what comes before the first vertex belongs to the last stretch
    let mut head = Vec::new();
    let mut open: Option<(Vec<Bezier<DVec3>>, usize)> = None;
    for c in pieces {
        let cuts = cuts(sheet, c, order, reach);
        let mut at = 0.0;
        let mut take = |from: f64, to: f64, open: &mut Option<(Vec<Bezier<DVec3>>, usize)>| {
            if to > from {
                let piece = if from == 0.0 && to == 1.0 { c.clone() } else { c.segment(from, to) };
                open.as_mut().map_or(&mut head, |o| &mut o.0).push(piece);
            }
        };
        for (t, vertex) in cuts {
            take(at, t, &mut open);
            at = t;
            if let Some((pieces, start)) = open.take()
                && !pieces.is_empty()
            {
                out.push((pieces, [start, vertex]));
            }
            open = Some((Vec::new(), vertex));
        }
        take(at, 1.0, &mut open);
    }
    if let Some((mut pieces, start)) = open {
        pieces.append(&mut head);
        if !pieces.is_empty() {
            let end = out.first().map_or(start, |o| o.1[0]);
            out.push((pieces, [start, end]));
        }
    }
    out
}

/// Finds the edges: stretches in order, each with the nearest free one between the same vertices.
fn pair(out: &mut Boundaries, reach: f64) {
    out.edge_of = vec![usize::MAX; out.stretches.len()];
    let all: Vec<usize> = (0..out.stretches.len()).collect();
    pair_of(out, &all, reach);
}

fn pair_of(out: &mut Boundaries, some: &[usize], reach: f64) {
    let mut between: HashMap<[usize; 2], Vec<usize>> = HashMap::new();
    for &i in some {
        between.entry(out.stretches[i].ends).or_default().push(i);
    }
    for &first in some {
        if out.edge_of[first] != usize::MAX {
            continue;
        }
        let [a, b] = out.stretches[first].ends;
        let partners = [[b, a], [a, b]].into_iter().filter_map(|ends| between.get(&ends)).flatten();
        let free = partners.filter(|&&j| j != first && out.edge_of[j] == usize::MAX);
        let measured = free.map(|&j| (apart(&out.stretches[first].both.space, &out.stretches[j].both.space), j));
        let best = measured.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|b| b.0 <= reach);
        let second = best.map(|b| b.1);
        for s in [Some(first), second].into_iter().flatten() {
            out.edge_of[s] = out.edges.len();
        }
        out.deviation = out.deviation.max(best.map_or(0.0, |b| b.0));
        out.edges.push(Edge { first, second });
    }
}

/// Largest distance of three inner points of `a` from `b`.
fn apart(a: &BSpline<DVec4>, b: &BSpline<DVec4>) -> f64 {
    let on = |c: &BSpline<DVec4>, s: f64| c.point(c.domain().0 + (c.domain().1 - c.domain().0) * s);
    let chords = STRETCH_CHORDS.max(4 * b.points().len());
    [0.21, 0.5, 0.83].into_iter().map(|s| nearest(&|t| on(b, t), chords, on(a, s)).1).fold(0.0, f64::max)
}

impl Boundaries {
    /// Joins edges that have one stretch only, where a file's edges lie off its surfaces: their ends within `loose` of
    /// each other become one vertex, those that are within `loose` of a point go, and the others are paired again.
    pub fn mend(&mut self, loose: f64) {
        let single: Vec<usize> = self.edges.iter().filter(|e| e.second.is_none()).map(|e| e.first).collect();
        let mut ends: Vec<usize> = single.iter().flat_map(|s| self.stretches[*s].ends).collect();
        ends.sort_by(|a, b| self.vertices[*a].x.total_cmp(&self.vertices[*b].x));
        ends.dedup();
        let mut to: HashMap<usize, usize> = HashMap::new();
        for (k, &a) in ends.iter().enumerate() {
            let p = self.vertices[a];
            let own = *to.entry(a).or_insert(a);
            for &b in ends[k + 1..].iter().take_while(|b| self.vertices[**b].x <= p.x + loose) {
                let distance = self.vertices[b].distance(p);
                // only to the first of a cluster, so that none grows along a chain
                if distance <= loose && !to.contains_key(&b) && own == a {
                    to.insert(b, a);
                    self.deviation = self.deviation.max(distance);
                }
            }
        }
        let moved = |v: usize| to.get(&v).copied().unwrap_or(v);
        for s in &mut self.stretches {
            s.ends = s.ends.map(moved);
        }
        let is_point = |s: &Stretch| {
            let (a, b) = s.both.space.domain();
            let at = |k: usize| s.both.space.point(a + (b - a) * k as f64 / CHORDS as f64);
            s.ends[0] == s.ends[1] && (0..=CHORDS).all(|k| at(k).distance(self.vertices[s.ends[0]]) <= loose)
        };
        let gone: Vec<usize> = single.iter().copied().filter(|s| is_point(&self.stretches[*s])).collect();
        for l in self.loops.iter_mut().flatten() {
            l.retain(|s| !gone.contains(s));
        }
        self.edges.retain(|e| e.second.is_some());
        self.edge_of.fill(usize::MAX);
        for (k, e) in self.edges.iter().enumerate() {
            for s in [Some(e.first), e.second].into_iter().flatten() {
                self.edge_of[s] = k;
            }
        }
        let rest: Vec<usize> = single.into_iter().filter(|s| !gone.contains(s)).collect();
        pair_of(self, &rest, loose);
    }

    /// Edges of one stretch.
    pub fn single(&self) -> usize {
        self.edges.iter().filter(|e| e.second.is_none()).count()
    }

    /// Every edge has two stretches.
    pub fn closed(&self) -> bool {
        self.single() == 0
    }

    /// Whether the edge's second stretch runs against its first.
    pub fn opposite(&self, edge: &Edge) -> bool {
        let Some(second) = edge.second else { return false };
        let (a, b) = (&self.stretches[edge.first], &self.stretches[second]);
        if a.ends[0] != a.ends[1] {
            return a.ends[0] == b.ends[1];
        }
        let on = |c: &BSpline<DVec4>, s: f64| c.point(c.domain().0 + (c.domain().1 - c.domain().0) * s);
        let t = |s: f64| {
            let c = &b.both.space;
            nearest(&|t| on(c, t), STRETCH_CHORDS.max(4 * c.points().len()), on(&a.both.space, s)).0
        };
        t(0.3) > t(0.6)
    }
}
