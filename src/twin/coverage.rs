//! Twin of `glsl/include/coverage.glsl`: how much of a pixel a trimmed face covers.
//!
//! ```text
//!     ┌───────b─┐     w: winding number at the pixel's centre c.   A point p of the pixel has another one where the
//!     │  c    ╲▒│     way from c to p crosses an arc, so  ∫ winding = w - Σ (signed area that a chord hides from c).
//!     │        ╲│     A chord a ─▶ b hides what the rays from c between a and b sweep, less the triangle c a b:
//!     └─────────a         swept(b) - swept(a) - (a × b) / 2
//! ```
//!
//! `swept(d)` is the area of the unit square that a ray from its centre sweeps from `(1, 0)` to `d`: 1/8 of the ray's
//! slope in each of the eight octants. So the area is exact for straight borders, corners, slits and holes
//! alike, however many arcs run through the pixel. Where the centre is between a chord and its arc, which the exact test
//! tells, `w` is changed to what the chords make of it.
//!
//! Bent arcs count as [`CHORDS`] chords of equal steps between where they enter a cell (or the pixel's box) and leave it:
//! an arc of radius `r` px bulges by less than `2 / (8 CHORDS² r)` px over each. The pixel's square is mapped to the
//! domain by its first derivatives.
//!
//! Where more than [`MOST_CELLS`] cells meet the pixel's box, what the centre sees counts as the whole pixel.

use super::exact::Exact;
use crate::abi::{ARC_UP, ExactArc};

/// Cells that a pixel is asked in.
pub const MOST_CELLS: u32 = 64;
/// Chords of a bent arc in one cell.
pub const CHORDS: u32 = 8;
const ROOT_STEPS: u32 = 40;
const ROOT_PX: f32 = 1e-3;

/// What a face covers of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cover {
    /// Of the pixel's area, 0 to 1.
    pub share: f32,
    /// The border in the pixel, turned a quarter away from the face and added up; pixels.
    pub outward: [f32; 2],
    /// A border runs through the pixel.
    pub cut: bool,
}

/// The pixel's length and width in the domain's directions: how far the pixel moves with u, and with v.
pub type Along = [[f32; 2]; 2];

impl Exact<'_> {
    /// What of the pixel around the normalised `(u, v)` is inside the loops of a face; loops that overlap count
    /// once. The face's cells hold arcs along scan lines, too:
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
        let f = self.faces[face];
        let bands = &self.bands[f.first_band as usize..][..f.band_count as usize];
        let is_box = (0..2).all(|i| lo[i] <= hi[i]);
        if bands.len() < 2 || !is_box {
            return whole;
        }
        let mut sum = Sum { along, winding, hidden: 0.0, outward: [0.0; 2], cut: false };
        let mut asked = 0;
        let first_band = 1 + bands[1..].partition_point(|band| band.top < lo[1]);
        for pair in bands[first_band - 1..].windows(2) {
            let (below, band) = (pair[0], pair[1]);
            if below.top > hi[1] {
                break;
            }
            let cells = &self.cells[below.end as usize..band.end as usize];
            let first = cells.partition_point(|cell| cell.right < lo[0]);
            let mut left = if first > 0 { cells[first - 1].right } else { lo[0] };
            for cell in &cells[first..] {
                if left > hi[0] {
                    break;
                }
                asked += 1;
                if asked > MOST_CELLS {
                    return whole;
                }
                let from = [lo[0].max(left), lo[1].max(below.top)];
                let to = [hi[0].min(cell.right), hi[1].min(band.top)];
                for &entry in &self.entries[cell.first as usize..][..cell.count as usize] {
                    let arc = &self.arcs[(entry >> 2) as usize];
                    self.add_arc(&mut sum, arc, uv, (from, to), reach.map(|r| ROOT_PX * r));
                }
                left = cell.right;
            }
        }
        let turned = if det < 0.0 { -1.0 } else { 1.0 };
        let mean = sum.winding as f32 - turned * sum.hidden;
        let way = if mean < 0.0 { -turned } else { turned };
        Cover { share: mean.abs().min(1.0), outward: sum.outward.map(|x| x * way), cut: sum.cut }
    }

    /// The part of an arc that is in a box.
    fn add_arc(&self, sum: &mut Sum, arc: &ExactArc, uv: [f32; 2], (from, to): ([f32; 2], [f32; 2]), slack: [f32; 2]) {
        let relative = |p: [f32; 2]| [p[0] - arc.low[0], p[1] - arc.low[1]];
        let (begin, end) = self.within(arc, relative(from), relative(to), slack);
        if begin >= end {
            return;
        }
        let way = if arc.shape & ARC_UP != 0 { 1.0 } else { -1.0 };
        let chords = if degree(arc) <= 1 { 1 } else { CHORDS };
        let base = [arc.low[0] - uv[0], arc.low[1] - uv[1]];
        let pixel = |t: f32| {
            let q = self.at(arc, t);
            let p = [base[0] + q[0], base[1] + q[1]];
            let [pu, pv] = sum.along;
            ([pu[0] * p[0] + pv[0] * p[1], pu[1] * p[0] + pv[1] * p[1]], p[1])
        };
        // in the pixel, and v from its centre
        let mut corners = [([0.0; 2], 0.0); CHORDS as usize + 1];
        corners[0] = pixel(begin);
        for k in 1..=chords {
            let t = begin + (end - begin) * (k as f32 / chords as f32);
            corners[k as usize] = pixel(if k == chords { end } else { t });
        }
        let [pu, pv] = sum.along;
        let det = pu[0] * pv[1] - pu[1] * pv[0];
        let in_row = arc.low[1] < uv[1] && uv[1] <= arc.high[1];
        for pair in corners[..=chords as usize].windows(2) {
            let ((a, a_v), (b, b_v)) = (pair[0], pair[1]);
            let Some((a, b)) = clipped_to_pixel(a, b) else { continue };
            let mut sweep = swept_along(a, b);
            let mut left = (sweep > 0.0) == (det > 0.0);
            if sweep.abs() == 0.5 {
                // the centre is on it: as the exact test has it
                left = self.is_left_of(arc, uv);
                sweep = if left == (det > 0.0) { 0.5 } else { -0.5 };
            } else if in_row && a_v < 0.0 && b_v >= 0.0 && left != self.lies_right(arc, uv) {
                // the centre is between the chord and its arc
                sum.winding += (if left { way } else { -way }) as i32;
            }
            sum.hidden += way * (sweep - 0.5 * (a[0] * b[1] - a[1] * b[0]));
            let d = [b[0] - a[0], b[1] - a[1]];
            sum.outward = [sum.outward[0] + way * d[1], sum.outward[1] + way * -d[0]];
            sum.cut = true;
        }
    }

    /// Whether a point on an arc lies left of it, as it runs from its lower end to its higher one.
    fn is_left_of(&self, arc: &ExactArc, uv: [f32; 2]) -> bool {
        if arc.low[1] < uv[1] && uv[1] <= arc.high[1] {
            self.lies_right(arc, uv)
        } else {
            (uv[1] > arc.high[1]) == (arc.high[0] > arc.low[0])
        }
    }

    /// Parameters between which an arc is in a box, whose corners are relative to its lower end.
    fn within(&self, arc: &ExactArc, lo: [f32; 2], hi: [f32; 2], slack: [f32; 2]) -> (f32, f32) {
        let (mut begin, mut end) = (0.0f32, 1.0f32);
        for i in 0..2 {
            if arc.high[i] == arc.low[i] {
                if lo[i] > 0.0 || hi[i] < 0.0 {
                    return (1.0, 0.0);
                }
                continue;
            }
            let (enter, leave) = if arc.high[i] < arc.low[i] { (hi[i], lo[i]) } else { (lo[i], hi[i]) };
            begin = begin.max(self.reached(arc, i, enter, slack));
            end = end.min(self.reached(arc, i, leave, slack));
        }
        (begin, end)
    }

    /// Parameter at which a coordinate of an arc, relative to its lower end, becomes `x`, where both are within `slack`;
    /// 0 or 1 beyond its ends.
    fn reached(&self, arc: &ExactArc, axis: usize, x: f32, slack: [f32; 2]) -> f32 {
        let chord = [arc.high[0] - arc.low[0], arc.high[1] - arc.low[1]];
        let way = chord.map(|x| if x < 0.0 { -1.0 } else { 1.0 });
        let (to, mut a, mut b) = (way[axis] * x, [0.0f32; 2], [way[0] * chord[0], way[1] * chord[1]]);
        if to.is_nan() || to <= a[axis] {
            return 0.0;
        }
        if to >= b[axis] {
            return 1.0;
        }
        if degree(arc) <= 1 {
            return to / b[axis];
        }
        let (mut ta, mut tb) = (0.0f32, 1.0f32);
        for step in 0..ROOT_STEPS {
            if (0..2).all(|i| b[i] - a[i] <= slack[i]) {
                break;
            }
            let share = if step & 1 == 0 { (to - a[axis]) / (b[axis] - a[axis]) } else { 0.5 };
            let within = |t: f32| t > ta && t < tb;
            let mut t = ta + (tb - ta) * share;
            if !within(t) {
                t = 0.5 * (ta + tb);
                if !within(t) {
                    break;
                }
            }
            let q = self.point(arc.first as usize, degree(arc), t);
            let q: [f32; 2] = std::array::from_fn(|i| (way[i] * q[i]).clamp(a[i], b[i]));
            if q[axis] >= to {
                (tb, b) = (t, q);
            } else {
                (ta, a) = (t, q);
            }
        }
        if b[axis] > a[axis] { ta + (tb - ta) * ((to - a[axis]) / (b[axis] - a[axis])) } else { tb }
    }

    fn at(&self, arc: &ExactArc, t: f32) -> [f32; 2] {
        let chord = [arc.high[0] - arc.low[0], arc.high[1] - arc.low[1]];
        if t >= 1.0 {
            chord
        } else if degree(arc) <= 1 {
            chord.map(|x| x * t)
        } else {
            self.point(arc.first as usize, degree(arc), t)
        }
    }
}

fn degree(arc: &ExactArc) -> u32 {
    arc.shape & (ARC_UP - 1)
}

/// What chords add up to.
struct Sum {
    along: Along,
    /// At the centre, as the chords have it.
    winding: i32,
    hidden: f32,
    outward: [f32; 2],
    cut: bool,
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

/// What a ray from the centre sweeps along a chord; positive when it turns as `(1, 0)` does to `(0, 1)`.
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
