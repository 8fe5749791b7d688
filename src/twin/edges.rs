//! Twin of the passes `edge_count` and `edge_emit`: divides pieces of edges into chords.
//!
//! The method and its bound are those of [`edges::flatten`](crate::edges::flatten), in single precision and for the
//! lines of a frame: a piece that needs more than [`MOST_CHORDS`] is halved, one outside the picture left out.

use super::view::to_pixel;
use crate::abi::constants::edge_divide::{EDGE_HALVINGS, EDGE_MOST_CHORDS, EDGE_TOLERANCE_PX};
use crate::abi::{Chord, EDGE_TURNS, EdgeLine, EdgePiece, Frame, PieceInstance, View};

/// Most chords of a piece; a piece that needs more is halved.
pub const MOST_CHORDS: u32 = EDGE_MOST_CHORDS;

/// The input of the passes.
#[derive(Clone, Copy, Debug)]
pub struct Given<'a> {
    /// Part to pixel, for each placement.
    pub views: &'a [View],
    /// Placed pieces.
    pub piece_instances: &'a [PieceInstance],
    /// Pieces of all edges.
    pub pieces: &'a [EdgePiece],
    /// Their control points.
    pub points: &'a [[f32; 4]],
    /// Edges.
    pub lines: &'a [EdgeLine],
    /// Pixels beyond the picture to which lines are drawn.
    pub margin_px: f32,
}

/// Chords of each piece instance, and the number of pieces that bend too much after the last halving.
pub fn divide(frame: &Frame, given: &Given<'_>) -> (Vec<Vec<Chord>>, u32) {
    let mut clamps = 0;
    let chords = (0..)
        .zip(given.piece_instances)
        .map(|(number, piece_instance)| {
            let piece = given.pieces[piece_instance.piece as usize];
            let points = &given.points[piece.first as usize..=(piece.first + piece.degree) as usize];
            let style = given.lines[piece.edge as usize].style;
            let walk = Walk { frame, view: &given.views[piece_instance.placement as usize], margin: given.margin_px };
            if style & EDGE_TURNS != 0 && !walk.is_outline(&given.points[piece.first as usize..][..4]) {
                return Vec::new();
            }
            let (chords, clamped) = walk.divide(points, (number, style));
            clamps += u32::from(clamped);
            chords
        })
        .collect();
    (chords, clamps)
}

enum Fate {
    Outside,
    Halves { near: bool },
    Chords(u32),
}

struct Walk<'a> {
    frame: &'a Frame,
    view: &'a View,
    margin: f32,
}

type Point = [f32; 4];

fn between(a: Point, b: Point, t: f32) -> Point {
    std::array::from_fn(|k| a[k] * (1.0 - t) + b[k] * t)
}

/// Control points of the part of a piece from a to b.
fn restricted(points: &[Point], a: f32, b: f32) -> Vec<Point> {
    let (n, mut net) = (points.len() - 1, points.to_vec());
    if a > 0.0 {
        for k in (1..=n).rev() {
            (0..k).for_each(|i| net[i] = between(net[i], net[i + 1], a));
        }
    }
    if b < 1.0 {
        let t = (b - a) / (1.0 - a);
        for k in 1..=n {
            (k..=n).rev().for_each(|i| net[i] = between(net[i - 1], net[i], t));
        }
    }
    net
}

fn at(net: &[Point], t: f32) -> Point {
    let n = net.len() - 1;
    if t <= 0.0 {
        return net[0];
    }
    if t >= 1.0 {
        return net[n];
    }
    let mut p = net.to_vec();
    for k in (1..=n).rev() {
        (0..k).for_each(|i| p[i] = between(p[i], p[i + 1], t));
    }
    p[0]
}

impl Walk<'_> {
    /// Of a side of triangles, its ends and the third corners of both.
    fn is_outline(&self, corners: &[Point]) -> bool {
        let q = to_pixel(self.view, corners[0]);
        let pixel = [q[0] / q[3], q[1] / q[3]];
        let [along, a, b] = [1, 2, 3].map(|k| {
            let moved = to_pixel(self.view, std::array::from_fn(|i| corners[k][i] - corners[0][i]));
            [moved[0] - pixel[0] * moved[3], moved[1] - pixel[1] * moved[3]]
        });
        let side = |to: [f32; 2]| along[0] * to[1] - along[1] * to[0] < 0.0;
        side(a) == side(b)
    }

    fn fate(&self, net: &[Point]) -> Fate {
        let n = net.len() - 1;
        let last = self.frame.size.map(|size| size + self.margin);
        let (mut outside, mut near, mut least, mut bend) = (63u32, false, 3.0e38f32, [0.0f32; 2]);
        let pixels: Vec<Point> = net.iter().map(|p| to_pixel(self.view, *p)).collect();
        for (p, q) in net.iter().zip(&pixels) {
            let nearer = q[2] - self.frame.near * p[3];
            let farther = q[2] - self.frame.far * p[3];
            let sides = [
                q[0] + self.margin * q[3] < 0.0,
                q[0] - last[0] * q[3] > 0.0,
                q[1] + self.margin * q[3] < 0.0,
                q[1] - last[1] * q[3] > 0.0,
                nearer < 0.0,
                farther > 0.0,
            ];
            outside &= sides.iter().enumerate().fold(0, |bits, (i, &beyond)| bits | u32::from(beyond) << i);
            near |= nearer < 0.0;
            least = least.min(q[3]);
        }
        for three in pixels.windows(3) {
            for axis in 0..2 {
                for x in [-self.margin, last[axis]] {
                    let [a, b, c] = [0, 1, 2].map(|i| three[i][axis] - x * three[i][3]);
                    bend[axis] = bend[axis].max((a - 2.0 * b + c).abs());
                }
            }
        }
        if outside != 0 {
            return Fate::Outside;
        }
        if near {
            return Fate::Halves { near };
        }
        let bent = (bend[0] * bend[0] + bend[1] * bend[1]).sqrt() * (n * n.saturating_sub(1)) as f32;
        let squared = bent / (8.0 * EDGE_TOLERANCE_PX * least);
        if squared <= (MOST_CHORDS * MOST_CHORDS) as f32 {
            Fate::Chords((squared.sqrt().ceil() as u32).max(1))
        } else {
            Fate::Halves { near }
        }
    }

    fn divide(&self, points: &[Point], (piece_instance, style): (u32, u32)) -> (Vec<Chord>, bool) {
        let (mut level, mut place, mut clamped, mut chords) = (0u32, 0u32, false, Vec::new());
        loop {
            let width = 1.0 / (1u32 << level) as f32;
            let (a, b) = (place as f32 * width, (place + 1) as f32 * width);
            let net = restricted(points, a, b);
            let count = match self.fate(&net) {
                Fate::Halves { .. } if level < EDGE_HALVINGS => {
                    (level, place) = (level + 1, place * 2);
                    continue;
                }
                Fate::Halves { near: false } => {
                    clamped = true;
                    MOST_CHORDS
                }
                Fate::Chords(chords) => chords,
                Fate::Outside | Fate::Halves { near: true } => 0,
            };
            self.put(&net, (a, b), count, (piece_instance, style), &mut chords);
            place += 1;
            while level > 0 && place & 1 == 0 {
                (level, place) = (level - 1, place >> 1);
            }
            if level == 0 {
                return (chords, clamped);
            }
        }
    }

    fn put(
        &self,
        net: &[Point],
        (a, b): (f32, f32),
        count: u32,
        (piece_instance, style): (u32, u32),
        chords: &mut Vec<Chord>,
    ) {
        let pixel = |t: f32| to_pixel(self.view, at(net, t));
        let place = |q: &Point| [q[0] / q[3], q[1] / q[3]];
        let (mut from, mut t0) = (pixel(0.0), a);
        for k in 1..=count {
            let share = k as f32 / count as f32;
            let t1 = if k == count { b } else { a + (b - a) * share };
            let to = pixel(share);
            let ends = (place(&from), place(&to));
            chords.push(Chord { a: ends.0, b: ends.1, w: [from[3], to[3]], t: [t0, t1], piece_instance, style });
            (from, t0) = (to, t1);
        }
    }
}
