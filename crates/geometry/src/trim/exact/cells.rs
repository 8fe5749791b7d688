//! Arcs sorted into the cells' lists.
//!
//! ```text
//!   winding number beside a list = crossings right of the centre, on its scan line, of arcs outside the list
//!
//!   cells of a row:   all arcs of the row, sorted by where they pass its middle
//!   parts of a cell:  those outside of the cell's list, and those of its list that are not in the part's
//! ```

use super::arcs::Chains;
use super::grid::Region;
use super::{AT_HIGH, AT_LOW, Arc, Cell, Entry, ExactTrim, Grid, MOST_HALVINGS};
use std::collections::HashMap;

/// Entries that a list may always have: a joint has two arcs beside it in any cell, and smaller cells decide over
/// smaller distances.
const FEW: usize = 3;
/// Parts of a cell, and their entries, at most so many to an entry of its own.
const MOST_PARTS_AN_ENTRY: usize = 4;

/// Where arcs along a scan line are listed, if no chain leaves a list by them.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Flats {
    /// They are in no list.
    Left,
    /// They are in the lists of all boxes that they meet.
    Kept,
}

pub(super) fn sorted_into(chains: Chains, flats: Flats) -> ExactTrim {
    let grid = Grid::around(&chains.arcs);
    let [columns, rows] = grid.counts.map(u32::from);
    let met = vec![0; chains.arcs.len()];
    let mut sorter = Sorter { chains: &chains, flats, met, regions: 0, known: HashMap::new(), entries: Vec::new() };
    sorter.list(Vec::new());
    let mut cells = vec![Cell::Whole { first: 0, winding: 0 }; (columns * rows) as usize];
    let mut row_arcs: Vec<Vec<u32>> = vec![Vec::new(); rows as usize];
    for (i, arc) in chains.arcs.iter().enumerate() {
        let (low, high) = (f64::from(arc.low[1]), f64::from(arc.high[1]));
        grid.meeting(1, (low, high)).for_each(|row| row_arcs[row as usize].push(i as u32));
    }
    let mut lists: Vec<Vec<u32>> = vec![Vec::new(); columns as usize];
    for (row, arcs) in (0..).zip(&row_arcs) {
        let middle = Region::of(&grid, [0, row]);
        let crossings = Crossings::new(&chains.arcs, arcs, middle.centre().y);
        lists.iter_mut().for_each(Vec::clear);
        for &i in arcs {
            let span = chains.arcs[i as usize].span((middle.box_lo.y, middle.box_hi.y));
            let Some(span) = span else { continue };
            grid.meeting(0, span).for_each(|column| lists[column as usize].push(i));
        }
        for (column, list) in (0..).zip(&lists) {
            let region = Region::of(&grid, [column, row]);
            let content = sorter.content(&region, list, crossings.right_of(region.centre().x));
            let cell = sorter.cell(&mut cells, &region, &content);
            cells[(row * columns + column) as usize] = cell;
        }
    }
    let entries = sorter.entries;
    ExactTrim { arcs: chains.arcs, grid, cells, entries }
}

/// The crossings of arcs with a scan line.
struct Crossings {
    /// From the largest `u` to the smallest, with the sum of all up to it.
    sums: Vec<(f64, i32)>,
}

impl Crossings {
    fn new(arcs: &[Arc], some: &[u32], v: f64) -> Self {
        let mut sums: Vec<(f64, i32)> = some.iter().filter_map(|&i| crossing(&arcs[i as usize], v)).collect();
        sums.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut sum = 0;
        sums.iter_mut().for_each(|s| {
            sum += s.1;
            s.1 = sum;
        });
        Self { sums }
    }

    fn right_of(&self, u: f64) -> i32 {
        let right = self.sums.partition_point(|s| s.0 > u);
        if right > 0 { self.sums[right - 1].1 } else { 0 }
    }
}

/// The crossing of an arc with a scan line, and its sign; bottom-open, top-closed.
fn crossing(arc: &Arc, v: f64) -> Option<(f64, i32)> {
    let (low, high) = (f64::from(arc.low[1]), f64::from(arc.high[1]));
    (low < v && v <= high).then(|| (if v == high { f64::from(arc.high[0]) } else { arc.at(v) }, sign(arc)))
}

/// `+1` for an arc that its loop climbs, `-1` for one that it falls along.
fn sign(arc: &Arc) -> i32 {
    if arc.up { 1 } else { -1 }
}

/// The arcs that meet a region's box, and the winding number of the others.
struct Content {
    /// Numbers of arcs and their flags.
    arcs: Vec<(u32, u32)>,
    /// How many of them are in the list.
    length: usize,
    winding: i32,
}

struct Sorter<'a> {
    chains: &'a Chains,
    flats: Flats,
    /// For each arc the last region whose box it meets.
    met: Vec<u32>,
    regions: u32,
    /// First entry of each list.
    known: HashMap<Vec<(u32, u32)>, u32>,
    entries: Vec<Entry>,
}

impl Sorter<'_> {
    /// The arcs that meet a region's box, where all crossings right of its centre add up to `right`.
    fn content(&mut self, region: &Region, meet: &[u32], right: i32) -> Content {
        self.regions += 1;
        meet.iter().for_each(|&i| self.met[i as usize] = self.regions);
        let centre = region.centre();
        let mut content = Content { arcs: Vec::with_capacity(meet.len()), length: 0, winding: right };
        for &i in meet {
            let arc = &self.chains.arcs[i as usize];
            if let Some((u, sign)) = crossing(arc, centre.y) {
                content.winding -= if u > centre.x { sign } else { 0 };
            }
            let mut flags = 0;
            for (high, flag) in [(false, AT_LOW), (true, AT_HIGH)] {
                let [u, v] = (if high { arc.high } else { arc.low }).map(f64::from);
                let in_rows = v >= region.box_lo.y && v < region.box_hi.y;
                if in_rows && u > centre.x && self.met[self.chains.beyond(i as usize, high)] != self.regions {
                    flags |= flag;
                }
            }
            content.winding -= lengthened(arc, flags, centre.y);
            content.length += usize::from(self.is_listed((i, flags)));
            content.arcs.push((i, flags));
        }
        content
    }

    fn is_listed(&self, (arc, flags): (u32, u32)) -> bool {
        let arc = &self.chains.arcs[arc as usize];
        flags != 0 || arc.low[1] < arc.high[1] || self.flats == Flats::Kept
    }

    /// A cell of the first level, split where it pays; its parts go behind the other cells.
    fn cell(&mut self, cells: &mut Vec<Cell>, region: &Region, content: &Content) -> Cell {
        match self.parts(region, content) {
            None => self.whole(content),
            Some((halvings, parts)) => {
                let first = cells.len() as u32;
                cells.extend(parts.iter().map(|part| self.whole(part)));
                Cell::Split { first, halvings }
            }
        }
    }

    /// Splits into as few parts as have few arcs each; else into the parts with the fewest.
    fn parts(&mut self, region: &Region, content: &Content) -> Option<(u32, Vec<Content>)> {
        let most = MOST_PARTS_AN_ENTRY * content.length;
        let mut best = None;
        let mut longest = content.length;
        for halvings in 1..=MOST_HALVINGS {
            if longest <= FEW || 1 << (2 * halvings) > most {
                break;
            }
            let parts = self.split(region, content, halvings);
            if parts.iter().map(|part| part.length).sum::<usize>() > most {
                break;
            }
            let now = parts.iter().map(|part| part.length).max().unwrap_or(0);
            if now < longest {
                (longest, best) = (now, Some((halvings, parts)));
            }
        }
        best
    }

    fn split(&mut self, region: &Region, content: &Content, halvings: u32) -> Vec<Content> {
        let n = 1 << halvings;
        let at = (0..n).flat_map(|row| (0..n).map(move |column| [column, row]));
        let mut meet = Vec::new();
        let parts = at.map(|at| {
            let part = region.part(at, halvings);
            let centre = part.centre();
            let mut right = content.winding;
            meet.clear();
            for &(i, flags) in &content.arcs {
                let arc = &self.chains.arcs[i as usize];
                right += crossing(arc, centre.y).map_or(0, |(u, sign)| if u > centre.x { sign } else { 0 });
                right += lengthened(arc, flags, centre.y);
                if part.meets(arc) {
                    meet.push(i);
                }
            }
            self.content(&part, &meet, right)
        });
        parts.collect()
    }

    fn whole(&mut self, content: &Content) -> Cell {
        let list = content.arcs.iter().copied().filter(|entry| self.is_listed(*entry)).collect();
        Cell::Whole { first: self.list(list), winding: content.winding }
    }

    /// First entry of a list.
    fn list(&mut self, list: Vec<(u32, u32)>) -> u32 {
        if let Some(first) = self.known.get(&list) {
            return *first;
        }
        let first = self.entries.len() as u32;
        let last = list.len().saturating_sub(1);
        let entry = |(k, &(arc, flags))| Entry { arc: Some(arc), flags, last: k == last };
        self.entries.extend(list.iter().enumerate().map(entry));
        if list.is_empty() {
            self.entries.push(Entry { arc: None, flags: 0, last: true });
        }
        self.known.insert(list, first);
        first
    }
}

/// The contribution of an arc's flags to the winding number of a point on a scan line.
fn lengthened(arc: &Arc, flags: u32, v: f64) -> i32 {
    let low = if flags & AT_LOW != 0 && f64::from(arc.low[1]) < v { -sign(arc) } else { 0 };
    let high = if flags & AT_HIGH != 0 && f64::from(arc.high[1]) < v { sign(arc) } else { 0 };
    low + high
}
