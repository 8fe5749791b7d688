//! Where lines meet in the picture: places at which visibility may change, and lines that lie on each other.
//!
//! ```text
//!   chords of all paths ─▶ cells of CELL px ─▶ chords that cross ─▶ Newton on both curves ─▶ a place on each path
//!                                           ─▶ ends of paths within ON px of a chord      ─▶ a place on that path
//! ```

use super::LineKind;
use super::path::{Node, Path, View};
use glam::DVec2;
use rayon::prelude::*;
use std::collections::HashMap;

/// Pixels: side of a cell.
const CELL: f64 = 16.0;
/// Pixels: what is this near lies on a line; chords are within 0.004 of their curves.
const ON: f64 = 0.015;
/// Sine of the angle between lines that run along each other.
const ALONG: f64 = 0.02;
/// Shares of a chord's parameters by which the true crossing may lie outside of it.
const SLACK: f64 = 0.5;
/// Steps of Newton's method.
const STEPS: usize = 4;
/// Depths differ by more than this share of the depth range, or are the same.
const DEPTH: f64 = 1e-6;

/// A chord: a path and the number of its first node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Chord {
    path: u32,
    node: u32,
}

/// The chords of paths by place.
pub(super) struct Meetings<'p> {
    paths: &'p [Path<'p>],
    view: &'p View,
    cells: HashMap<(i32, i32), Vec<Chord>>,
    /// Which paths are drawn as lines wherever they are seen.
    drawn: Vec<bool>,
}

fn cell(p: DVec2) -> (i32, i32) {
    ((p.x / CELL).floor() as i32, (p.y / CELL).floor() as i32)
}

impl<'p> Meetings<'p> {
    pub fn new(paths: &'p [Path<'p>], view: &'p View, drawn: impl Fn(LineKind) -> bool) -> Self {
        let mut cells: HashMap<(i32, i32), Vec<Chord>> = HashMap::new();
        let (low, high) = (cell(DVec2::splat(-CELL)), cell(view.size + CELL));
        for (path, p) in paths.iter().enumerate() {
            for (node, pair) in p.nodes.windows(2).enumerate() {
                let [Some(a), Some(b)] = [pair[0].spot, pair[1].spot] else { continue };
                let chord = Chord { path: path as u32, node: node as u32 };
                let (first, last) = (cell(a.pixel.min(b.pixel) - ON), cell(a.pixel.max(b.pixel) + ON));
                for y in first.1.max(low.1)..=last.1.min(high.1) {
                    for x in first.0.max(low.0)..=last.0.min(high.0) {
                        cells.entry((x, y)).or_default().push(chord);
                    }
                }
            }
        }
        let drawn = paths.iter().map(|p| p.kind != LineKind::Seam && drawn(p.kind)).collect();
        Self { paths, view, cells, drawn }
    }

    fn nodes(&self, chord: Chord) -> (&'p Node, &'p Node) {
        let nodes = &self.paths[chord.path as usize].nodes;
        (&nodes[chord.node as usize], &nodes[chord.node as usize + 1])
    }

    fn ends(&self, chord: Chord) -> Option<(DVec2, DVec2)> {
        let (a, b) = self.nodes(chord);
        Some((a.spot?.pixel, b.spot?.pixel))
    }

    /// Of each path the parameters at which its visibility may change, in no order.
    pub fn places(&self) -> Vec<Vec<f64>> {
        let mut cells: Vec<&Vec<Chord>> = self.cells.values().filter(|c| c.len() > 1).collect();
        cells.sort_by_key(|c| (c[0].path, c[0].node));
        let crossings = cells.par_iter().flat_map_iter(|chords| {
            let mut found: Vec<(u32, f64)> = Vec::new();
            for (i, a) in chords.iter().enumerate() {
                for b in &chords[i + 1..] {
                    let next = a.path == b.path && a.node.abs_diff(b.node) <= 1;
                    if let Some((s, t)) = (!next).then(|| self.crossing(*a, *b)).flatten() {
                        found.extend([(a.path, s), (b.path, t)]);
                    }
                }
            }
            found
        });
        let touches = self.paths.par_iter().enumerate().flat_map_iter(|(path, p)| {
            let ends = [p.nodes.first(), p.nodes.last()].into_iter().flatten().filter_map(|n| n.spot);
            ends.flat_map(move |spot| self.touching(path as u32, spot.pixel)).collect::<Vec<_>>()
        });
        let all: Vec<(u32, f64)> = crossings.chain(touches).collect();
        let mut places = vec![Vec::new(); self.paths.len()];
        all.into_iter().for_each(|(path, s)| places[path as usize].push(s));
        places
    }

    fn crossing(&self, a: Chord, b: Chord) -> Option<(f64, f64)> {
        let ((a0, a1), (b0, b1)) = (self.ends(a)?, self.ends(b)?);
        if a0.max(a1).cmplt(b0.min(b1) - ON).any() || a0.min(a1).cmpgt(b0.max(b1) + ON).any() {
            return None;
        }
        let (u, v) = (a1 - a0, b1 - b0);
        let cross = u.perp_dot(v);
        let lengths = u.length() * v.length();
        // lines along each other have no crossing that says anything; their ends do
        if cross.abs() <= 1e-4 * lengths {
            return None;
        }
        let from = b0 - a0;
        let (s, t) = (from.perp_dot(v) / cross, from.perp_dot(u) / cross);
        let slack = |length: f64| ON / length.max(ON);
        let within = |x: f64, slack: f64| x >= -slack && x <= 1.0 + slack;
        if !(within(s, slack(u.length())) && within(t, slack(v.length()))) {
            return None;
        }
        Some(self.refined((a, s), (b, t)))
    }

    /// Newton's method on both curves; the crossing of the chords where it leaves them.
    fn refined(&self, (a, s): (Chord, f64), (b, t): (Chord, f64)) -> (f64, f64) {
        let range = |chord: Chord| {
            let (first, last) = self.nodes(chord);
            (first.parameter, last.parameter)
        };
        let (ra, rb) = (range(a), range(b));
        let at = |(from, to): (f64, f64), share: f64| from + (to - from) * share.clamp(0.0, 1.0);
        let start = (at(ra, s), at(rb, t));
        let (p, q) = (&self.paths[a.path as usize], &self.paths[b.path as usize]);
        let (mut x, mut y) = start;
        for _ in 0..STEPS {
            let Some(((at_p, dp), (at_q, dq))) = p.motion(self.view, x).zip(q.motion(self.view, y)) else {
                return start;
            };
            let off = at_q.pixel - at_p.pixel;
            let cross = dp.perp_dot(dq);
            let step = (off.perp_dot(dq) / cross, off.perp_dot(dp) / cross);
            if !(step.0.is_finite() && step.1.is_finite()) {
                return start;
            }
            (x, y) = (x + step.0, y + step.1);
            let near = |x: f64, (from, to): (f64, f64)| {
                let slack = SLACK * (to - from);
                x >= from - slack && x <= to + slack
            };
            if !(near(x, ra) && near(y, rb)) {
                return start;
            }
            (x, y) = (x.clamp(p.range.0, p.range.1), y.clamp(q.range.0, q.range.1));
        }
        (x, y)
    }

    /// Places on other paths that a point of the picture touches.
    fn touching(&self, path: u32, p: DVec2) -> Vec<(u32, f64)> {
        let chords = self.cells.get(&cell(p)).map_or(&[][..], |c| &c[..]);
        let place = |chord: &Chord| {
            let (share, off) = foot(self.ends(*chord)?, p);
            let (a, b) = self.nodes(*chord);
            (off <= ON && chord.path != path).then_some((chord.path, a.parameter + (b.parameter - a.parameter) * share))
        };
        chords.iter().filter_map(place).collect()
    }

    /// A line that is drawn lies on this place of a path, along it, and is nearer to the eye; or as near, and comes first.
    pub fn is_covered(&self, path: usize, parameter: f64) -> bool {
        let own = &self.paths[path];
        let Some((spot, direction)) = own.spot(self.view, parameter).zip(own.direction(self.view, parameter)) else {
            return false;
        };
        let same = DEPTH * (self.view.depth.1 - self.view.depth.0);
        let chords = self.cells.get(&cell(spot.pixel)).map_or(&[][..], |c| &c[..]);
        chords.iter().any(|chord| {
            let other = chord.path as usize;
            let (a, b) = self.nodes(*chord);
            let Some((p, q)) = a.spot.zip(b.spot).filter(|_| other != path && self.drawn[other]) else { return false };
            let (share, off) = foot((p.pixel, q.pixel), spot.pixel);
            let along = (q.pixel - p.pixel).normalize_or_zero();
            if off > ON || along.perp_dot(direction).abs() > ALONG || along == DVec2::ZERO {
                return false;
            }
            // along a straight chord of a perspective view the reciprocal of the depth is linear
            let depth = if self.view.perspective {
                1.0 / (p.depth.recip() + (q.depth.recip() - p.depth.recip()) * share)
            } else {
                p.depth + (q.depth - p.depth) * share
            };
            let rank = |k: usize| (self.paths[k].kind, k);
            depth < spot.depth - same || depth <= spot.depth + same && rank(other) < rank(path)
        })
    }
}

/// Share of a segment next to a point, and the distance.
fn foot((a, b): (DVec2, DVec2), p: DVec2) -> (f64, f64) {
    let along = b - a;
    let share = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    let share = if share.is_nan() { 0.0 } else { share };
    (share, p.distance(a + along * share))
}
