//! Loops cut into stretches: each a part of a loop between two vertices, and of one edge.
//!
//! ```text
//!   loop   e1 e1 e1 │ e2 │ -  - │ e3 e3      curves, by the edge of the source that each is a piece of
//!          ──────────────────────────────
//!   whole  e1                     e3         every face that uses the edge has all of it: a stretch as it is
//!   other            e2    -  -              no edge, or one that a seam cuts in one of its faces: cut at each vertex
//!                                            that it passes
//! ```
//!
//! Vertices are the ends of whole edges, the corners of loops and the places where a loop goes from one edge of the
//! source to the next. A loop that meets no vertex is cut at its start.

use super::sheet::{Piece, Sheet};
use super::vertices::{Ordered, Vertices};
use super::{LOOSE, nearest};
use crate::model::EdgeRef;
use crate::spline::Bezier;
use glam::DVec3;
use std::collections::{BTreeMap, HashSet};

/// Turn of a loop, in radians, that makes a vertex.
const CORNER: f64 = 0.02;
/// Chords in a piece, for the search of near vertices.
const CHORDS: usize = 16;
/// Share of the distance between the ends of an edge by which two faces may disagree on an end: sloppy files.
const APART: f64 = 0.25;

/// One stretch of a loop.
#[derive(Debug)]
pub(super) struct Stretch {
    pub face: usize,
    pub trim_loop: Option<usize>,
    /// As [`EdgeUse::range`](crate::model::EdgeUse::range).
    pub range: (f64, f64),
    pub pieces: Vec<Bezier<DVec3>>,
    /// Vertices at its ends.
    pub ends: [usize; 2],
    /// The edge of the source that it is a piece of.
    pub edge: Option<EdgeRef>,
    /// It is all of that edge, in every face that uses it.
    pub whole: bool,
}

/// A loop: `count` curves in the face, of which those that are points in space are no `pieces`.
struct Loop<'s, 'a> {
    face: usize,
    sheet: &'s Sheet<'a>,
    trim_loop: Option<usize>,
    count: usize,
    pieces: Vec<Piece>,
    /// Pieces of one edge: where each run begins, and how many they are. None where the whole loop is of one.
    runs: Vec<(usize, usize)>,
}

/// One run of a loop that is a piece of an edge of the source.
struct Use {
    /// The loop, and the run among its runs.
    at: (usize, usize),
    face: usize,
    edge: EdgeRef,
    /// First and last point, as the edge runs.
    ends: [DVec3; 2],
}

/// Stretches of the loops of all faces, and the vertices between them.
#[derive(Debug, Default)]
pub(super) struct Cut {
    pub vertices: Vertices,
    pub stretches: Vec<Stretch>,
    /// Faces with loops that are points, and how many.
    pub lost: Vec<(usize, usize)>,
    /// Largest distance between ends that were made one.
    pub deviation: f64,
}

impl<'s, 'a> Loop<'s, 'a> {
    fn new(face: usize, sheet: &'s Sheet<'a>, trim_loop: Option<usize>, reach: f64) -> Self {
        let (count, pieces) = sheet.pieces(trim_loop, reach);
        let n = pieces.len();
        let starts: Vec<usize> = (0..n).filter(|&k| pieces[k].edge != pieces[(k + n - 1) % n].edge).collect();
        let length = |i: usize| match starts.get(i + 1) {
            Some(next) => next - starts[i],
            None => starts[0] + n - starts[i],
        };
        let runs = match starts[..] {
            [] => vec![(0, n)],
            _ => (0..starts.len()).map(|i| (starts[i], length(i))).collect(),
        };
        Self { face, sheet, trim_loop, count, pieces, runs }
    }

    fn piece(&self, k: usize) -> &Piece {
        &self.pieces[k % self.pieces.len()]
    }

    /// The ends of a run, as the loop runs.
    fn ends(&self, (from, length): (usize, usize)) -> [DVec3; 2] {
        let (first, last) = (self.piece(from), self.piece(from + length - 1));
        [self.sheet.at(&first.curve, 0.0), self.sheet.at(&last.curve, 1.0)]
    }

    /// Whether the loop turns between piece `k` and the next, or leaves a gap.
    fn corner(&self, k: usize, reach: f64) -> bool {
        let (c, next) = (&self.piece(k).curve, &self.piece(k + 1).curve);
        let at = |c: &Bezier<DVec3>, t: f64| self.sheet.at(c, t);
        let (end, start) = (at(c, 1.0), at(next, 0.0));
        let back = (end - at(c, 1.0 - 1e-3)).normalize_or_zero();
        let on = (at(next, 1e-3) - start).normalize_or_zero();
        end.distance(start) > reach || back.angle_between(on) > CORNER || back.dot(on) <= 0.0
    }

    /// The stretch of `parts`: numbers of pieces and their ranges, in order.
    fn stretch(&self, parts: Vec<(usize, f64, f64)>, ends: [usize; 2], whole: bool) -> Stretch {
        let (first, last) = (parts[0], parts[parts.len() - 1]);
        let from = self.piece(first.0).index as f64 + first.1;
        let to = self.piece(last.0).index as f64 + last.2;
        let to = if to > from { to } else { to + self.count as f64 };
        let edge = self.piece(first.0).edge;
        let edge = edge.filter(|_| parts.iter().all(|p| self.piece(p.0).edge == edge));
        let pieces = parts.iter().map(|&(k, a, b)| self.piece(k).curve.segment(a, b)).collect();
        Stretch { face: self.face, trim_loop: self.trim_loop, range: (from, to), pieces, ends, edge, whole }
    }
}

/// Cuts the loops of `sheets`. Points within `reach` are the same; `size` is the part's.
pub(super) fn cut(sheets: &[Sheet], reach: f64, size: f64) -> Cut {
    let mut out = Cut { vertices: Vertices::new(reach), ..Cut::default() };
    let mut loops: Vec<Loop> = Vec::new();
    for (face, sheet) in sheets.iter().enumerate() {
        let all = sheet.loops().into_iter().map(|l| Loop::new(face, sheet, l, reach));
        let before = loops.len();
        loops.extend(all.filter(|l| !l.pieces.is_empty()));
        let lost = sheet.loops().len() - (loops.len() - before);
        out.lost.extend((lost > 0).then_some((face, lost)));
    }
    let shared = shared(&loops, size);
    let whole: HashSet<(usize, usize)> = shared.iter().flatten().map(|u| u.at).collect();
    for uses in &shared {
        for k in 0..2 {
            let first = out.vertices.add(uses[0].ends[k]);
            for u in &uses[1..] {
                let other = out.vertices.add(u.ends[k]);
                out.deviation = out.deviation.max(out.vertices.unite(first, other));
            }
        }
    }
    for (at, l) in loops.iter().enumerate() {
        for (run, &(from, length)) in l.runs.iter().enumerate() {
            let kept = whole.contains(&(at, run));
            if kept || l.runs.len() > 1 {
                l.ends((from, length)).into_iter().for_each(|p| {
                    out.vertices.add(p);
                });
            }
            let inside = if l.runs.len() > 1 { length - 1 } else { length };
            for k in (from..from + inside).filter(|k| !kept && l.corner(*k, reach)) {
                out.vertices.add(l.sheet.at(&l.piece(k).curve, 1.0));
                out.vertices.add(l.sheet.at(&l.piece(k + 1).curve, 0.0));
            }
        }
    }
    // loops that meet no vertex start where they start
    let order = out.vertices.ordered();
    let bare = |l: &&Loop| l.pieces.iter().all(|p| cuts(l.sheet, &p.curve, &order, reach).is_empty());
    let free = loops.iter().enumerate().filter(|(at, l)| l.runs.len() == 1 && !whole.contains(&(*at, 0)));
    let seeds: Vec<DVec3> = free.map(|(_, l)| l).filter(bare).map(|l| l.sheet.at(&l.pieces[0].curve, 0.0)).collect();
    seeds.into_iter().for_each(|s| {
        out.vertices.add(s);
    });
    let order = out.vertices.ordered();
    for (at, l) in loops.iter().enumerate() {
        // runs that are not whole and follow each other are one section
        let n = l.runs.len();
        let is_whole = |run: usize| whole.contains(&(at, run % n));
        let first = (0..n).find(|run| is_whole(*run));
        let mut section: Vec<usize> = Vec::new();
        for run in (0..n).map(|k| (first.unwrap_or(0) + k) % n) {
            let (from, length) = l.runs[run];
            if !is_whole(run) {
                section.extend(from..from + length);
                continue;
            }
            stretches(l, &std::mem::take(&mut section), &order, reach, &mut out);
            let ends = l.ends((from, length)).map(|p| out.vertices.add(p));
            out.stretches.push(l.stretch((from..from + length).map(|k| (k, 0.0, 1.0)).collect(), ends, true));
        }
        stretches(l, &section, &order, reach, &mut out);
    }
    for s in &mut out.stretches {
        s.ends = s.ends.map(|v| out.vertices.root(v));
    }
    out
}

/// The uses of each edge of the source that two uses or more have all of: once in each loop and direction, with the same
/// ends.
fn shared(loops: &[Loop], size: f64) -> Vec<Vec<Use>> {
    let mut uses: BTreeMap<u32, Vec<Use>> = BTreeMap::new();
    for (at, l) in loops.iter().enumerate() {
        for (run, &range) in l.runs.iter().enumerate() {
            let Some(edge) = l.piece(range.0).edge else { continue };
            let [a, b] = l.ends(range);
            let ends = if edge.forward { [a, b] } else { [b, a] };
            uses.entry(edge.edge).or_default().push(Use { at: (at, run), face: l.face, edge, ends });
        }
    }
    let all_of_it = |uses: &Vec<Use>| {
        let [a, b] = uses[0].ends;
        let reach = (APART * a.distance(b)).max(LOOSE * size);
        let distinct: HashSet<(usize, EdgeRef)> = uses.iter().map(|u| (u.face, u.edge)).collect();
        let same = |u: &Use| u.ends[0].distance(a) <= reach && u.ends[1].distance(b) <= reach;
        uses.len() > 1 && distinct.len() == uses.len() && uses.iter().all(same)
    };
    uses.into_values().filter(all_of_it).collect()
}

/// Parameters at which a piece passes a vertex, ends included, in order, and the vertices.
fn cuts(sheet: &Sheet, c: &Bezier<DVec3>, order: &Ordered, reach: f64) -> Vec<(f64, usize)> {
    let chords: Vec<DVec3> = (0..=CHORDS).map(|k| sheet.at(c, k as f64 / CHORDS as f64)).collect();
    // a curve is assumed to stay within a chord's length of its chords
    let slack = reach + chords.windows(2).map(|w| w[0].distance(w[1])).fold(0.0, f64::max);
    let (lo, hi) = chords.iter().fold((chords[0], chords[0]), |(a, b), p| (a.min(*p), b.max(*p)));
    let (lo, hi) = (lo - slack, hi + slack);
    let near: Vec<(DVec3, usize)> = order.within(lo, hi).collect();
    let mut found: Vec<(f64, usize)> = Vec::new();
    for &(p, vertex) in &near {
        if [chords[0], chords[CHORDS]].iter().all(|end| end.distance(p) > reach) {
            let (t, distance) = nearest(&|t| sheet.at(c, t), &chords, p, slack);
            found.extend((distance <= reach).then_some((t, vertex)));
        }
    }
    // a piece that begins and ends at one vertex has it at both ends
    for (t, end) in [(0.0, chords[0]), (1.0, chords[CHORDS])] {
        let closest = near.iter().map(|&(p, v)| (p.distance(end), v)).min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, vertex)) = closest.filter(|c| c.0 <= reach) {
            found.retain(|f| f.0 != t);
            found.push((t, vertex));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.dedup_by(|a, b| a.0 == b.0);
    found
}

/// Parts of pieces, by number and from where to where, since a vertex.
type Opened = (Vec<(usize, f64, f64)>, usize);

/// Cuts a section of a loop, given by the numbers of its pieces, at the vertices that it passes. In a section that is
/// the whole loop, the part before the first vertex belongs to the last stretch.
fn stretches(l: &Loop, section: &[usize], order: &Ordered, reach: f64, out: &mut Cut) {
    let mut head = Vec::new();
    let mut open: Option<Opened> = None;
    let mut first = None;
    for &k in section {
        let mut at = 0.0;
        let mut take = |from: f64, to: f64, open: &mut Option<Opened>| {
            if to > from {
                open.as_mut().map_or(&mut head, |o| &mut o.0).push((k, from, to));
            }
        };
        for (t, vertex) in cuts(l.sheet, &l.piece(k).curve, order, reach) {
            take(at, t, &mut open);
            at = t;
            if let Some((parts, start)) = open.take()
                && !parts.is_empty()
            {
                out.stretches.push(l.stretch(parts, [start, vertex], false));
            }
            first = first.or(Some(vertex));
            open = Some((Vec::new(), vertex));
        }
        take(at, 1.0, &mut open);
    }
    if let Some((mut parts, start)) = open {
        parts.append(&mut head);
        if !parts.is_empty() {
            out.stretches.push(l.stretch(parts, [start, first.unwrap_or(start)], false));
        }
    }
}
