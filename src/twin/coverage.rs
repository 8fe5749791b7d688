//! Twin of `glsl/include/coverage.glsl`: the share of a pixel that a trimmed face covers.
//!
//! ```text
//!     ┌───────b─┐     w: winding number at the pixel's centre c.   A point p of the pixel has another one if the
//!     │  c    ╲▒│     segment c p crosses an arc, so  ∫ winding = w - Σ (signed area that a chord hides from c).
//!     │        ╲│     A chord a ─▶ b hides the area that rays from c between a and b sweep, less the triangle c a b:
//!     └─────────a         swept(b) - swept(a) - (a × b) / 2
//! ```
//!
//! `swept(d)` is the area of the unit square that a ray from its centre sweeps from `(1, 0)` to `d`: 1/8 of the ray's
//! slope in each of the eight octants. So the area is exact for straight borders, corners, slits and holes alike, with
//! any number of arcs in the pixel. If the centre is between a chord and its arc, which the exact test decides, `w` is
//! corrected to that of the chords.
//!
//! A curved arc counts as [`CHORDS`] chords of equal steps within a cell (or the pixel's box): an arc of radius `r` px
//! bulges by less than `2 / (8 CHORDS² r)` px over each. The pixel's square is mapped to the domain by its first
//! derivatives.
//!
//! If the pixel's box lies in the box of the centre's list, that list suffices. Otherwise the lists of all cells that
//! meet the pixel's box are used, each between the cell's borders. If there are more than [`MOST_CELLS`], the pixel
//! counts as covered or not as its centre is.

//! ```text
//!   error on another GPU, whose quotients are off by d = 2.5 * 2^-23 and whose roots by 2 d:
//!     way      of a border's point: 4 d pixels to a domain     quotient of the point, slide along the arc, clipping
//!     share    2 way + 4 d       a pixel has two pixels of border; `swept` is an eighth of a quotient, at 16 ends
//!     outward  32 way + 32 d     16 chords of two ends
//! ```
//!
//! The arithmetic is `precise`: nothing is contracted, and only quotients and roots differ.

use super::exact::Exact;
pub use crate::abi::constants::coverage::{CHORDS, MOST_CELLS};
use crate::abi::{ARC_UP, ExactArc};

/// The part of a pixel that a face covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cover {
    /// Share of the pixel's area, 0 to 1.
    pub share: f32,
    /// Sum of the border's pieces in the pixel, turned by 90 degrees away from the face; pixels.
    pub outward: [f32; 2],
    /// A border crosses the pixel.
    pub cut: bool,
}

/// Error bounds of a [`Cover`] on another GPU.
#[cfg(test)]
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    /// Error of the share.
    pub share: f32,
    /// Error of either component of `outward`. A shorter border may or may not count as crossing the pixel.
    pub outward: f32,
}

#[cfg(test)]
impl Bound {
    /// The bounds for a pixel.
    pub fn of(along: Along) -> Self {
        const D: f32 = 2.5 * f32::EPSILON;
        let pixels = along.as_flattened().iter().fold(0.0f32, |most, x| most.max(x.abs()));
        let way = 4.0 * D * pixels;
        Self { share: 2.0 * way + 4.0 * D, outward: 32.0 * (way + D) }
    }
}

/// The pixel's sides in the domain: change of the pixel with u, and with v.
pub type Along = [[f32; 2]; 2];

impl Exact<'_> {
    /// The part of the pixel around the normalised `(u, v)` that is inside a face's loops; overlapping loops count
    /// once. The face's cells must also have arcs along scan lines:
    /// [`ExactTrim::with_flats`](crate::trim::ExactTrim::with_flats).
    pub fn cover(&self, face: usize, uv: [f32; 2], along: Along) -> Cover {
        let winding = self.winding(face, uv);
        let whole = Cover { share: if winding != 0 { 1.0 } else { 0.0 }, outward: [0.0; 2], cut: false };
        let [pu, pv] = along;
        let det = pu[0] * pv[1] - pu[1] * pv[0];
        let scale = 0.5 / det.abs();
        let reach = [(pv[1].abs() + pv[0].abs()) * scale, (pu[1].abs() + pu[0].abs()) * scale];
        let lo: [f32; 2] = std::array::from_fn(|i| uv[i] - reach[i]);
        let hi: [f32; 2] = std::array::from_fn(|i| uv[i] + reach[i]);
        let is_box = (0..2).all(|i| lo[i] <= hi[i]);
        if !is_box {
            return whole;
        }
        let f = self.faces[face];
        let axes = f.axes();
        let mut sum = Sum { along, winding, hidden: 0.0, outward: [0.0; 2], cut: false };
        let mut asked = 0;
        // one list for the whole pixel, if possible: that of the centre's cell
        let middle = self.list(face, uv);
        if middle.holds_for(lo) && middle.holds_for(hi) {
            self.arcs(middle.first).for_each(|arc| sum.add_arc(arc, uv, (lo, hi)));
            return sum.cover(det);
        }
        for index in through(|i| (axes[i].index(lo[i]), axes[i].index(hi[i]))) {
            let cell = f.cell(&axes, index);
            let parts = self.parts(cell);
            let part = |x: [f32; 2], i: usize| axes[i].part(x[i], index[i], parts);
            for part in through(|i| (part(lo, i), part(hi, i))) {
                asked += 1;
                if asked > MOST_CELLS {
                    return whole;
                }
                let list = self.list_of(&axes, cell, index, part);
                let from = std::array::from_fn(|i| lo[i].max(list.lo[i]));
                let to = std::array::from_fn(|i| hi[i].min(list.hi[i]));
                for arc in self.arcs(list.first) {
                    sum.add_arc(arc, uv, (from, to));
                }
            }
        }
        sum.cover(det)
    }
}

/// Pairs of whole numbers, row by row; each runs through a range, ends included.
fn through(range: impl Fn(usize) -> (f32, f32)) -> impl Iterator<Item = [f32; 2]> {
    let [columns, rows] = [range(0), range(1)].map(|(first, last)| first as u32..=last as u32);
    rows.flat_map(move |row| columns.clone().map(move |column| [column as f32, row as f32]))
}

/// Sums over chords.
struct Sum {
    along: Along,
    /// Winding number at the centre, for the chords.
    winding: i32,
    hidden: f32,
    outward: [f32; 2],
    cut: bool,
}

impl Sum {
    fn cover(&self, det: f32) -> Cover {
        let turned = if det < 0.0 { -1.0 } else { 1.0 };
        let mean = self.winding as f32 - turned * self.hidden;
        let way = if mean < 0.0 { -turned } else { turned };
        Cover { share: mean.abs().min(1.0), outward: self.outward.map(|x| x * way), cut: self.cut }
    }

    /// Adds the part of an arc that is in a box.
    fn add_arc(&mut self, arc: &ExactArc, uv: [f32; 2], (from, to): ([f32; 2], [f32; 2])) {
        let relative = |p: [f32; 2]| [p[0] - arc.low[0], p[1] - arc.low[1]];
        let (begin, end) = arc.within(relative(from), relative(to));
        if begin >= end {
            return;
        }
        let way = if arc.shape & ARC_UP != 0 { 1.0 } else { -1.0 };
        let chords = if arc.fullness == 0.0 { 1 } else { CHORDS };
        let base = [arc.low[0] - uv[0], arc.low[1] - uv[1]];
        let [pu, pv] = self.along;
        let pixel = |t: f32| {
            let q = arc.point(t);
            let p = [base[0] + q[0], base[1] + q[1]];
            ([pu[0] * p[0] + pv[0] * p[1], pu[1] * p[0] + pv[1] * p[1]], p[1])
        };
        // points in the pixel, and their v relative to its centre
        let mut corners = [([0.0; 2], 0.0); CHORDS as usize + 1];
        corners[0] = pixel(begin);
        for k in 1..=chords {
            let t = begin + (end - begin) * (k as f32 / chords as f32);
            corners[k as usize] = pixel(if k == chords { end } else { t });
        }
        let det = pu[0] * pv[1] - pu[1] * pv[0];
        let in_row = arc.low[1] < uv[1] && uv[1] <= arc.high[1];
        for pair in corners[..=chords as usize].windows(2) {
            let ((a, a_v), (b, b_v)) = (pair[0], pair[1]);
            let Some((a, b)) = clipped_to_pixel(a, b) else { continue };
            let mut sweep = swept_along(a, b);
            let mut left = (sweep > 0.0) == (det > 0.0);
            if sweep.abs() == 0.5 {
                // the centre is on it: decide as the exact test does
                left = arc.is_right_of(uv);
                sweep = if left == (det > 0.0) { 0.5 } else { -0.5 };
            } else if in_row && a_v < 0.0 && b_v >= 0.0 && left != arc.lies_right(uv) {
                // the centre is between the chord and its arc
                self.winding += (if left { way } else { -way }) as i32;
            }
            self.hidden += way * (sweep - 0.5 * (a[0] * b[1] - a[1] * b[0]));
            let d = [b[0] - a[0], b[1] - a[1]];
            self.outward = [self.outward[0] + way * d[1], self.outward[1] + way * -d[0]];
            self.cut = true;
        }
    }
}

impl ExactArc {
    /// Whether a point on the arc counts as left of it, for an arc that runs from its lower to its higher end.
    fn is_right_of(&self, uv: [f32; 2]) -> bool {
        if self.low[1] < uv[1] && uv[1] <= self.high[1] {
            self.lies_right(uv)
        } else {
            (uv[1] > self.high[1]) == (self.high[0] > self.low[0])
        }
    }

    /// The parameters between which the arc lies in a box, whose corners are relative to its lower end. The box
    /// excludes its upper and right side, so an arc along a common side of two cells counts once.
    fn within(&self, lo: [f32; 2], hi: [f32; 2]) -> (f32, f32) {
        let (mut begin, mut end) = (0.0f32, 1.0f32);
        for i in 0..2 {
            if self.high[i] == self.low[i] {
                if lo[i] > 0.0 || hi[i] <= 0.0 {
                    return (1.0, 0.0);
                }
                continue;
            }
            let (enter, leave) = if self.high[i] < self.low[i] { (hi[i], lo[i]) } else { (lo[i], hi[i]) };
            begin = begin.max(self.reached(i, enter));
            end = end.min(self.reached(i, leave));
        }
        (begin, end)
    }
}

/// Area of the unit square that a ray from its centre sweeps, from `(1, 0)` to `d`.
pub fn swept(d: [f32; 2]) -> f32 {
    let [x, y] = d;
    if d == [0.0; 2] {
        0.0
    } else if y.abs() <= x.abs() {
        (if x > 0.0 { 0.0 } else { 0.5 }) + 0.125 * (y / x)
    } else {
        (if y > 0.0 { 0.25 } else { 0.75 }) - 0.125 * (x / y)
    }
}

/// The area that a ray from the centre sweeps along a chord; positive if it turns from `(1, 0)` to `(0, 1)`.
fn swept_along(a: [f32; 2], b: [f32; 2]) -> f32 {
    let turn = swept(b) - swept(a);
    turn - (turn + 0.5).floor()
}

/// The part of a chord that is in the unit square around the origin. Source: Y.-D. Liang, B. A. Barsky, *A new concept
/// and method for line clipping*, ACM TOG 3 (1), 1984.
fn clipped_to_pixel(a: [f32; 2], b: [f32; 2]) -> Option<([f32; 2], [f32; 2])> {
    let d = [b[0] - a[0], b[1] - a[1]];
    let (mut enter, mut leave) = (0.0f32, 1.0f32);
    for i in 0..2 {
        if d[i] == 0.0 {
            if a[i].abs() > 0.5 {
                return None;
            }
            continue;
        }
        let (first, last) = ((-0.5 - a[i]) / d[i], (0.5 - a[i]) / d[i]);
        enter = enter.max(first.min(last));
        leave = leave.min(first.max(last));
    }
    let at = |t: f32| [a[0] + d[0] * t, a[1] + d[1] * t];
    let inside = |p: [f32; 2]| p.map(|x| x.clamp(-0.5, 0.5));
    (enter < leave).then(|| (inside(at(enter)), inside(if leave < 1.0 { at(leave) } else { b })))
}
