//! Arcs sorted into bands, and each band's arcs into cells.

use super::arcs::Chains;
use super::{AT_HIGH, AT_LOW, Arc, Band, Cell, ExactTrim};
use crate::spline::Bezier;
use glam::{DVec2, DVec3};

/// Arcs of all bands together are at most this many times the arcs of the face: else every second border
/// goes, until they are. Eight bands an arc cost about as much memory as the arc.
const MOST_BANDS_AN_ARC: usize = 8;
/// As [`MOST_BANDS_AN_ARC`], for the entries of a band and its arcs.
const MOST_CELLS_AN_ARC: usize = 8;
/// Halvings that find where an arc crosses a band's border: its range of `u` in the band is then wider
/// than it need be by a millionth of the arc at most.
const HALVINGS: u32 = 20;

/// An arc's part of a band.
#[derive(Clone, Copy, Debug)]
struct Part {
    arc: usize,
    /// Range of `u`, rounded outwards.
    left: f32,
    right: f32,
}

/// What becomes of arcs along a scan line where no chain leaves a cell by them.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Flats {
    /// They are in no cell.
    Left,
    /// They are in the cells that touch them, of one band: the one whose top they are, or that they are within; of the
    /// lowest scan line, the first.
    Kept,
}

pub(super) fn sorted_into(chains: Chains, flats: Flats) -> ExactTrim {
    let borders = band_borders(&chains.arcs);
    let mut out = ExactTrim::default();
    let mut by_low: Vec<usize> = (0..chains.arcs.len()).collect();
    by_low.sort_by(|&a, &b| chains.arcs[a].low[1].total_cmp(&chains.arcs[b].low[1]));
    let mut coming = by_low.into_iter().peekable();
    let mut active: Vec<usize> = Vec::new();
    let mut parts = Vec::new();
    let lowest = borders.first().copied();
    let touches = |i: usize, lo: f32, hi: f32| {
        let v = chains.arcs[i].low[1];
        let flat = chains.arcs[i].high[1] == v;
        flats == Flats::Kept && flat && (v > lo || lowest == Some(v)) && v <= hi
    };
    let mut finder = CellFinder { chains: &chains, part_of: vec![usize::MAX; chains.arcs.len()], flats };
    if let Some(lowest) = lowest {
        out.bands.push(Band { top: lowest, end: 0 });
    }
    for pair in borders.windows(2) {
        let (lo, hi) = (pair[0], pair[1]);
        active.retain(|&i| chains.arcs[i].high[1] > lo);
        while let Some(i) = coming.next_if(|&i| chains.arcs[i].low[1] <= hi) {
            active.push(i);
        }
        parts.clear();
        parts.extend(
            active
                .iter()
                .filter(|&&i| reaches(&chains.arcs[i], lo, hi) || touches(i, lo, hi))
                .map(|&i| part(&chains.arcs, i, lo, hi)),
        );
        finder.add_cells(&mut out, &parts, lo, hi);
        out.bands.push(Band { top: hi, end: out.cells.len() as u32 });
    }
    out.arcs = chains.arcs;
    out
}

/// Some scan line of the band crosses the arc; or the arc lies on one inside the band.
fn reaches(arc: &Arc, lo: f32, hi: f32) -> bool {
    arc.high[1] > lo && arc.low[1] < hi
}

/// Scan lines through joints: all of them, or as many as [`MOST_BANDS_AN_ARC`] allows.
fn band_borders(arcs: &[Arc]) -> Vec<f32> {
    let mut all: Vec<f32> = arcs.iter().flat_map(|a| [a.low[1], a.high[1]]).collect();
    all.sort_by(f32::total_cmp);
    all.dedup();
    let spanned = |borders: &[f32]| -> usize {
        let below = |v: f32| borders.partition_point(|&border| border < v);
        arcs.iter().map(|a| below(a.high[1]).saturating_sub(below(a.low[1]))).sum()
    };
    while all.len() > 2 && spanned(&all) > MOST_BANDS_AN_ARC * arcs.len() {
        all = every_second(&all);
    }
    all
}

/// Every second border; the first and the last stay.
fn every_second(borders: &[f32]) -> Vec<f32> {
    let last = borders.len() - 1;
    borders.iter().enumerate().filter(|(i, _)| i % 2 == 0 || *i == last).map(|(_, &border)| border).collect()
}

/// Where an arc is within a band.
fn part(arcs: &[Arc], i: usize, lo: f32, hi: f32) -> Part {
    let arc = &arcs[i];
    let bottom = if lo > arc.low[1] { crossing(arc, lo) } else { (arc.low[0], arc.low[0]) };
    let top = if hi < arc.high[1] { crossing(arc, hi) } else { (arc.high[0], arc.high[0]) };
    Part { arc: i, left: bottom.0.min(top.0), right: bottom.1.max(top.1) }
}

/// Between which `u` the arc passes the scan line `v`, which is above its lower end and below its higher.
fn crossing(arc: &Arc, v: f32) -> (f32, f32) {
    let low = DVec2::from(arc.low.map(f64::from));
    let chord = DVec2::from(arc.high.map(f64::from)) - low;
    let y = f64::from(v) - low.y;
    let (mut a, mut b) = ((0.0, DVec2::ZERO), (1.0, chord));
    if arc.points.is_empty() {
        let x = chord.x * (y / chord.y);
        (a.1.x, b.1.x) = (x, x);
    } else {
        let curve = Bezier { points: arc.points.iter().map(|p| DVec3::from(p.map(f64::from))).collect() };
        for _ in 0..HALVINGS {
            let t = 0.5 * (a.0 + b.0);
            let middle = (t, curve.point(t).clamp(a.1.min(b.1), a.1.max(b.1)));
            if middle.1.y >= y { b = middle } else { a = middle }
        }
    }
    let (left, right) = (low.x + a.1.x.min(b.1.x), low.x + a.1.x.max(b.1.x));
    let ends = (arc.low[0].min(arc.high[0]), arc.low[0].max(arc.high[0]));
    // rounding to single precision, outwards, and never beyond the arc
    ((left as f32).next_down().max(ends.0), (right as f32).next_up().min(ends.1))
}

/// Finds what each cell of a band holds.
struct CellFinder<'a> {
    chains: &'a Chains,
    /// Of each arc its part of the band, or `usize::MAX`.
    part_of: Vec<usize>,
    flats: Flats,
}

impl CellFinder<'_> {
    fn add_cells(&mut self, out: &mut ExactTrim, parts: &[Part], lo: f32, hi: f32) {
        let mut borders: Vec<f32> = parts.iter().flat_map(|p| [p.left.next_down(), p.right]).collect();
        borders.sort_by(f32::total_cmp);
        borders.dedup();
        let held = |borders: &[f32]| -> usize {
            let below = |u: f32| borders.partition_point(|&border| border < u);
            parts.iter().map(|p| below(p.right) + 1 - below(p.left)).sum()
        };
        while borders.len() > 2 && held(&borders) > MOST_CELLS_AN_ARC * parts.len() {
            borders = every_second(&borders);
        }
        for (i, p) in parts.iter().enumerate() {
            self.part_of[p.arc] = i;
        }
        let mut by_left: Vec<usize> = (0..parts.len()).collect();
        by_left.sort_by(|&a, &b| parts[a].left.total_cmp(&parts[b].left));
        // what lies right of the cell: all, less what has come
        let climbs = |p: &Part| {
            let arc = &self.chains.arcs[p.arc];
            if arc.low[1] < hi && arc.high[1] >= hi { sign(arc) } else { 0 }
        };
        let mut right: i32 = parts.iter().map(climbs).sum();
        let mut coming = by_left.into_iter().peekable();
        let mut active: Vec<usize> = Vec::new();
        let mut left_border = f32::NEG_INFINITY;
        for &border in &borders {
            active.retain(|&i| parts[i].right > left_border);
            while let Some(i) = coming.next_if(|&i| parts[i].left <= border) {
                right -= climbs(&parts[i]);
                active.push(i);
            }
            let mut cell = Cell { right: border, winding: right, first: out.entries.len() as u32, count: 0 };
            for p in active.iter().map(|&i| &parts[i]) {
                self.add_entry(out, &mut cell, parts, p, (lo, hi));
            }
            out.cells.push(cell);
            left_border = border;
        }
        parts.iter().for_each(|p| self.part_of[p.arc] = usize::MAX);
    }

    /// One arc of a cell; an arc along a scan line counts only where a chain leaves it.
    fn add_entry(&self, out: &mut ExactTrim, cell: &mut Cell, parts: &[Part], p: &Part, (lo, hi): (f32, f32)) {
        let arc = &self.chains.arcs[p.arc];
        let mut flags = 0;
        for (high, flag) in [(false, AT_LOW), (true, AT_HIGH)] {
            let v = if high { arc.high[1] } else { arc.low[1] };
            let beyond = parts.get(self.part_of[self.chains.beyond(p.arc, high)]);
            if lo < v && v < hi && beyond.is_some_and(|b| b.left > cell.right) {
                flags |= flag;
                // so that the top of the band is as it was
                cell.winding -= if high { sign(arc) } else { -sign(arc) };
            }
        }
        if flags != 0 || arc.low[1] < arc.high[1] || self.flats == Flats::Kept {
            out.entries.push((p.arc as u32) << 2 | flags);
            cell.count += 1;
        }
    }
}

/// `+1` for an arc that its loop climbs, `-1` for one that it falls along.
fn sign(arc: &Arc) -> i32 {
    if arc.up { 1 } else { -1 }
}
