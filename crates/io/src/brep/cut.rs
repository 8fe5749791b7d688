//! Cutting a closed surface open, so that no loop runs around it any more.
//!
//! All loops are cut along one line `u = c` (here drawn for a surface that is periodic in `u`); the
//! pieces are moved into `[c, c + period]`; inside the face, ends on the cut are joined along it:
//!
//! ```text
//!   c                c + period
//!   ┌◀──────rim───────┐          rims run around; a hole that lies across the cut is split
//!   │                 │
//!   )   face          (hole
//!   │                 │
//!   └───────rim──────▶┘          a rim without a partner is closed over a pole
//! ```
//!
//! Seen from bottom to top, the crossings of the cut alternately enter and leave the face.

use super::BuildError;
use super::loops::{Limits, Loop};
use super::rims::{choose_cut, close_over_pole};
use super::strand::Strand;
use super::support::Support;
use glam::DVec2;

/// A run of strands within one period, and where it begins and ends on the cut.
struct Chain {
    strands: Vec<Strand>,
    source: usize,
}

/// A point where a loop crosses the cut: one chain ends there on one side, the next begins on the
/// other side.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    height: f64,
    /// The loop runs towards larger values of the cut coordinate.
    forward: bool,
    ends: usize,
    begins: usize,
}

/// Loops without winding that enclose the same region as `loops`.
///
/// `vertices`: poles named by bounds that are a single point.
///
/// # Errors
/// [`BuildError::OpenRim`], [`BuildError::Winding`], [`BuildError::Tangled`].
pub(super) fn cut_open(
    support: &Support,
    mut loops: Vec<Loop>,
    vertices: &[usize],
    limits: Limits,
) -> Result<Vec<Loop>, BuildError> {
    let face = limits.face;
    let Some(rim) = loops.iter().find(|l| l.winding != [0, 0]) else { return Ok(loops) };
    let axis = usize::from(rim.winding[0] == 0);
    for l in &loops {
        let [u, v] = l.winding;
        if l.winding[1 - axis] != 0 || l.winding[axis].abs() > 1 {
            return Err(BuildError::Winding { face, u, v });
        }
    }
    let period = support.periods[axis].ok_or(BuildError::OpenRim { face })?;
    let other = 1 - axis;
    // with the region on the left, a rim along +u has it above, one along +v has it at smaller u
    let above = |forward: bool| forward == (axis == 0);
    let is_rim = |l: &Loop| l.winding[axis] != 0;

    let (cut, _) = choose_cut(support, &loops, axis, period);
    if loops.iter().filter(|l| is_rim(l)).count() % 2 == 1 {
        let rims: Vec<&Loop> = loops.iter().filter(|l| is_rim(l)).collect();
        let closing = close_over_pole(support, &rims, vertices, (axis, cut)).ok_or(BuildError::OpenRim { face })?;
        loops.push(closing);
    }
    // where the other direction repeats too, lift everything above the first rim that bounds from below
    if let Some(height) = support.periods[other] {
        let lower = |l: &Loop| is_rim(l) && above(l.winding[axis] > 0);
        if !loops.iter().any(lower)
            && let Some(l) = loops.iter_mut().find(|l| is_rim(l))
        {
            *l = l.clone().reversed();
        }
        let level = |l: &Loop| l.strands[0].start[other];
        if let Some(base) = loops.iter().position(lower) {
            let floor = level(&loops[base]);
            for (i, l) in loops.iter_mut().enumerate() {
                let rounds = (level(l) - floor) / height;
                // an upper rim at the height of the lower one closes the whole surface
                let upper = is_rim(l) && !lower(l);
                let turns = if upper { (rounds - 1e-9).ceil() - 1.0 } else { (rounds + 1e-9).floor() };
                if i != base && turns != 0.0 {
                    let mut by = DVec2::ZERO;
                    by[other] = -turns * height;
                    *l = l.clone().shifted(by);
                }
            }
        }
    }

    // a loop whose stated direction contradicts its place is turned around, once
    let mut turned = vec![false; loops.len()];
    loop {
        let (chains, whole) = cut_loops(support, &loops, axis, cut, period);
        let crossings = crossings(&chains, axis);
        let wrong: Vec<bool> =
            crossings.iter().enumerate().map(|(i, (c, _))| above(c.forward) != (i % 2 == 0)).collect();
        if !wrong.contains(&true) {
            if crossings.len() % 2 == 1 {
                return Err(BuildError::OpenRim { face });
            }
            let crossings: Vec<Crossing> = crossings.into_iter().map(|c| c.0).collect();
            let mut out = link(chains, &crossings, (axis, cut, period));
            out.extend(whole);
            return Ok(out);
        }
        let mut progress = false;
        // by loop: crossings that are wrong, and all
        let mut counts = vec![[0usize; 2]; loops.len()];
        for ((_, source), wrong) in crossings.iter().zip(&wrong) {
            counts[*source][0] += usize::from(*wrong);
            counts[*source][1] += 1;
        }
        for (i, [faults, all]) in counts.into_iter().enumerate() {
            if 2 * faults > all && !turned[i] {
                loops[i] = loops[i].clone().reversed();
                turned[i] = true;
                progress = true;
            }
        }
        if !progress {
            return Err(BuildError::Tangled { face });
        }
    }
}

/// All loops cut at `cut + k period` and moved into `[cut, cut + period]`: the chains of loops that cross it, and the
/// loops that do not.
fn cut_loops(support: &Support, loops: &[Loop], axis: usize, cut: f64, period: f64) -> (Vec<Chain>, Vec<Loop>) {
    let eps = 1e-9 * period;
    let (mut chains, mut whole) = (Vec::new(), Vec::new());
    for (source, l) in loops.iter().enumerate() {
        let mut pieces: Vec<(f64, Strand)> = Vec::new();
        for s in &l.strands {
            for piece in cut_strand(support, s, axis, cut, period, eps) {
                let polygon = piece.polygon(support);
                let middle = polygon.iter().map(|p| p[axis]).sum::<f64>() / polygon.len() as f64;
                // a strand along the cut itself belongs to the cell of its neighbours
                let cell = (middle - cut) / period;
                let on_cut = (cell - cell.round()).abs() * period <= eps;
                let cell = match pieces.last() {
                    Some((before, _)) if on_cut => *before,
                    _ => (cell + if on_cut { 1e-6 } else { 0.0 }).floor(),
                };
                pieces.push((cell, piece));
            }
        }
        let home = |cell: f64| {
            let mut by = DVec2::ZERO;
            by[axis] = -cell * period;
            by
        };
        // the first piece of the next round lies `winding` cells on
        let onward = f64::from(l.winding[axis]);
        let n = pieces.len();
        let breaks = |k: usize| {
            let after = if k + 1 == n { pieces[0].0 + onward } else { pieces[k + 1].0 };
            after != pieces[k].0
        };
        match (0..n).find(|k| breaks(*k)) {
            None => whole.push(l.clone().shifted(home(pieces[0].0))),
            Some(first) => {
                let mut strands = Vec::new();
                for i in 1..=n {
                    let k = (first + i) % n;
                    strands.push(pieces[k].1.clone().shifted(home(pieces[k].0)));
                    if breaks(k) {
                        chains.push(Chain { strands: std::mem::take(&mut strands), source });
                    }
                }
            }
        }
    }
    (chains, whole)
}

/// A strand cut wherever it passes `cut + k period` away from its own ends.
fn cut_strand(support: &Support, strand: &Strand, axis: usize, cut: f64, period: f64, eps: f64) -> Vec<Strand> {
    let nodes = match strand.part {
        Some(_) => strand.nodes(),
        None => vec![0.0, 1.0],
    };
    let values: Vec<f64> = nodes.iter().map(|s| strand.at(support, *s)[axis]).collect();
    for (s, v) in nodes.windows(2).zip(values.windows(2)) {
        let (lo, hi) = (v[0].min(v[1]), v[0].max(v[1]));
        let line = cut + period * ((lo - cut) / period).floor();
        for line in [line, line + period] {
            let away = |end: DVec2| (end[axis] - line).abs() > eps;
            let at_end = (s[0] == 0.0 && !away(strand.start)) || (s[1] == 1.0 && !away(strand.end));
            if lo < line && hi >= line && !at_end && hi - lo > 0.0 {
                let at = strand.solve(support, axis, line, (s[0], s[1]));
                if at <= 1e-9 || at >= 1.0 - 1e-9 {
                    continue;
                }
                let (left, right) = strand.split(support, at, axis, line);
                let mut out = vec![left];
                out.extend(cut_strand(support, &right, axis, cut, period, eps));
                return out;
            }
        }
    }
    vec![strand.clone()]
}

/// Crossings from bottom to top with the loop that each belongs to; the chains of a loop follow each other.
fn crossings(chains: &[Chain], axis: usize) -> Vec<(Crossing, usize)> {
    let other = 1 - axis;
    let mut out = Vec::new();
    let mut start = 0;
    for mine in chains.chunk_by(|a, b| a.source == b.source) {
        for k in 0..mine.len() {
            let (ends, begins) = (start + k, start + (k + 1) % mine.len());
            let (Some(last), Some(first)) = (chains[ends].strands.last(), chains[begins].strands.first()) else {
                continue;
            };
            // it leaves one side and enters at the opposite one
            let forward = last.end[axis] > first.start[axis];
            out.push((Crossing { height: last.end[other], forward, ends, begins }, mine[k].source));
        }
        start += mine.len();
    }
    out.sort_by(|a, b| a.0.height.total_cmp(&b.0.height));
    out
}

/// Joins the chains along the cut between each lower crossing and the one above it.
fn link(chains: Vec<Chain>, crossings: &[Crossing], (axis, cut, period): (usize, f64, f64)) -> Vec<Loop> {
    let mut after = vec![None; chains.len()];
    for pair in crossings.chunks_exact(2) {
        after[pair[0].ends] = Some(pair[1].begins);
        after[pair[1].ends] = Some(pair[0].begins);
    }
    // ends lie on the two sides of the cut exactly
    let snap = |mut p: DVec2| {
        let side = if p[axis] > cut + 0.5 * period { cut + period } else { cut };
        p[axis] = side;
        p
    };
    let mut used = vec![false; chains.len()];
    let mut out = Vec::new();
    for first in 0..chains.len() {
        let mut strands: Vec<Strand> = Vec::new();
        let mut at = first;
        while !used[at] {
            used[at] = true;
            let mut run = chains[at].strands.clone();
            if let Some(s) = run.first_mut() {
                s.start = snap(s.start);
            }
            if let Some(s) = run.last_mut() {
                s.end = snap(s.end);
            }
            strands.extend(run);
            let Some(next) = after[at] else { break };
            if let (Some(s), Some(t)) = (strands.last(), chains[next].strands.first()) {
                let (from, to) = (s.end, snap(t.start));
                if from != to {
                    strands.push(Strand::inserted(from, to));
                }
            }
            at = next;
        }
        if !strands.is_empty() {
            out.push(Loop { strands, winding: [0; 2] });
        }
    }
    out
}
