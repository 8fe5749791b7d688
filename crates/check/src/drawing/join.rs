//! Lines that continue each other, as one.

use super::fit::{Cubic, cubic_slope};
use super::{Line, LineKind};
use glam::DVec2;
use std::collections::HashMap;

/// Pixels: ends this near to each other meet.
const SAME: f64 = 2e-3;
/// Cosine of the turn up to which lines continue each other: 3 degrees.
const STRAIGHT: f64 = 0.998_6;

/// Curves end to end, of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// What it is.
    pub kind: LineKind,
    /// Whether something is before it.
    pub hidden: bool,
    /// Pixels, `y` down.
    pub curves: Vec<Cubic>,
    /// It ends where it begins.
    pub closed: bool,
}

/// An end of a line: its place, and the direction out of the line.
#[derive(Clone, Copy)]
struct End {
    at: DVec2,
    out: DVec2,
}

fn ends(curves: &[Cubic]) -> Option<[End; 2]> {
    let (first, last) = (curves.first()?, curves.last()?);
    let out = |c: &Cubic, t: f64, sign: f64| (cubic_slope(c, t) * sign).normalize_or_zero();
    Some([End { at: first[0], out: out(first, 0.0, -1.0) }, End { at: last[3], out: out(last, 1.0, 1.0) }])
}

/// The strokes of lines. Two ends are joined where no third of the same kind is, and where they continue each other.
pub(super) fn strokes(lines: &[Line]) -> Vec<Stroke> {
    let ends: Vec<[End; 2]> = lines.iter().filter_map(|l| ends(&l.curves)).collect();
    let lines: Vec<&Line> = lines.iter().filter(|l| !l.curves.is_empty()).collect();
    let next = partners(&lines, &ends);
    let mut used = vec![false; lines.len()];
    let mut out = Vec::new();
    for seed in 0..lines.len() {
        if used[seed] {
            continue;
        }
        // back to where the stroke begins, or once around
        let (mut first, mut reversed) = (seed, false);
        while let Some((line, end)) = next[first][usize::from(reversed)] {
            (first, reversed) = (line, end == 0);
            if first == seed {
                break;
            }
        }
        let (mut line, start) = (first, (first, usize::from(reversed)));
        let mut stroke =
            Stroke { kind: lines[seed].kind, hidden: lines[seed].hidden, curves: Vec::new(), closed: false };
        loop {
            used[line] = true;
            stroke.curves.extend(oriented(&lines[line].curves, reversed));
            let Some((following, end)) = next[line][usize::from(!reversed)] else { break };
            if (following, end) == start {
                stroke.closed = true;
                break;
            }
            if used[following] {
                break;
            }
            (line, reversed) = (following, end == 1);
        }
        // ends that meet are one point
        for k in 1..stroke.curves.len() {
            stroke.curves[k][0] = stroke.curves[k - 1][3];
        }
        if stroke.closed {
            let first = stroke.curves[0][0];
            let last = stroke.curves.len() - 1;
            stroke.curves[last][3] = first;
        }
        out.push(stroke);
    }
    out
}

fn oriented(curves: &[Cubic], reversed: bool) -> Vec<Cubic> {
    if !reversed {
        return curves.to_vec();
    }
    curves.iter().rev().map(|c| [c[3], c[2], c[1], c[0]]).collect()
}

/// Of each end the line and end that continues it.
fn partners(lines: &[&Line], ends: &[[End; 2]]) -> Vec<[Option<(usize, usize)>; 2]> {
    let cell = |p: DVec2| ((p.x / (4.0 * SAME)).floor() as i64, (p.y / (4.0 * SAME)).floor() as i64);
    let mut cells: HashMap<(i64, i64), Vec<(usize, usize)>> = HashMap::new();
    for (line, pair) in ends.iter().enumerate() {
        for (end, e) in pair.iter().enumerate() {
            cells.entry(cell(e.at)).or_default().push((line, end));
        }
    }
    let near = |line: usize, end: usize| {
        let here = ends[line][end];
        let (x, y) = cell(here.at);
        let around = (-1..=1).flat_map(move |dy| (-1..=1).map(move |dx| (x + dx, y + dy)));
        let all = around.filter_map(|c| cells.get(&c)).flatten().copied();
        let group = (lines[line].kind, lines[line].hidden);
        let meets = all.filter(|&(l, e)| (l, e) != (line, end) && ends[l][e].at.distance(here.at) <= SAME);
        meets.filter(|(l, _)| (lines[*l].kind, lines[*l].hidden) == group).collect::<Vec<_>>()
    };
    let continues = |a: End, b: End| a.out.dot(b.out) < -STRAIGHT;
    let single = |line: usize, end: usize| match near(line, end)[..] {
        [only] => Some(only),
        _ => None,
    };
    let partner = |line: usize, end: usize| {
        let (other, at) = single(line, end)?;
        let mutual = single(other, at) == Some((line, end));
        (mutual && continues(ends[line][end], ends[other][at])).then_some((other, at))
    };
    (0..lines.len()).map(|line| [partner(line, 0), partner(line, 1)]).collect()
}
