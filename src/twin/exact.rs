//! Twin of `glsl/include/exact.glsl`: the exact trim test. What the structures mean stands in
//! [`trim::ExactTrim`](crate::trim::ExactTrim).

use crate::abi::{ARC_UP, ExactArc, ExactBand, ExactCell, ExactFace};
use crate::trim::{AT_HIGH, AT_LOW};

const MAX_STEPS: u32 = 40;

/// What a box of the domain holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Area {
    /// Nothing of the face.
    Out,
    /// The face alone.
    In,
    /// Perhaps both.
    Mixed,
}

/// The arrays of all faces.
#[derive(Clone, Copy, Debug, Default)]
pub struct Exact<'a> {
    /// By number of the face.
    pub faces: &'a [ExactFace],
    /// Of all faces.
    pub bands: &'a [ExactBand],
    /// Of all bands.
    pub cells: &'a [ExactCell],
    /// Of all cells.
    pub entries: &'a [u32],
    /// Of all loops.
    pub arcs: &'a [ExactArc],
    /// Homogeneous control points of bent arcs, three numbers each.
    pub points: &'a [f32],
}

impl Exact<'_> {
    /// Winding number of the loops of a face around the normalised `(u, v)`; 0 for one that is no number.
    pub fn winding(&self, face: usize, [u, v]: [f32; 2]) -> i32 {
        let f = self.faces[face];
        let bands = &self.bands[f.first_band as usize..][..f.band_count as usize];
        if bands.len() < 2 || v.is_nan() || v <= bands[0].top {
            return 0;
        }
        let band = 1 + bands[1..].partition_point(|band| band.top < v);
        if band >= bands.len() {
            return 0;
        }
        let cells = &self.cells[bands[band - 1].end as usize..bands[band].end as usize];
        let Some(cell) = cells.get(cells.partition_point(|cell| cell.right < u)) else { return 0 };
        let mut winding = cell.winding;
        for &entry in &self.entries[cell.first as usize..][..cell.count as usize] {
            let arc = &self.arcs[(entry >> 2) as usize];
            let direction = if arc.shape & ARC_UP != 0 { 1 } else { -1 };
            if entry & AT_LOW != 0 && arc.low[1] < v {
                winding -= direction;
            }
            if entry & AT_HIGH != 0 && arc.high[1] < v {
                winding += direction;
            }
            if arc.low[1] < v && v <= arc.high[1] && self.lies_right(arc, [u, v]) {
                winding += direction;
            }
        }
        winding
    }

    /// Whether all of a box is inside the face, all of it outside, or neither is told by the one cell that holds it.
    pub fn area(&self, face: usize, lo: [f32; 2], hi: [f32; 2]) -> Area {
        let f = self.faces[face];
        let bands = &self.bands[f.first_band as usize..][..f.band_count as usize];
        if bands.len() < 2 || hi[1].is_nan() || hi[1] <= bands[0].top {
            return Area::Out;
        }
        let band = 1 + bands[1..].partition_point(|band| band.top < hi[1]);
        if bands[band - 1].top >= lo[1] || lo[1].is_nan() {
            return Area::Mixed;
        }
        if band >= bands.len() {
            return Area::Out;
        }
        let cells = &self.cells[bands[band - 1].end as usize..bands[band].end as usize];
        let cell = cells.partition_point(|cell| cell.right < hi[0]);
        if cell > 0 && (cells[cell - 1].right >= lo[0] || lo[0].is_nan()) {
            return Area::Mixed;
        }
        match cells.get(cell) {
            None => Area::Out,
            Some(cell) if cell.count > 0 => Area::Mixed,
            Some(cell) if cell.winding != 0 => Area::In,
            Some(_) => Area::Out,
        }
    }

    /// The arc passes `v`, which is above its lower end and not above its higher one, at some larger `u`.
    pub(super) fn lies_right(&self, arc: &ExactArc, [u, v]: [f32; 2]) -> bool {
        if u < arc.low[0].min(arc.high[0]) {
            return true;
        }
        if u >= arc.low[0].max(arc.high[0]) {
            return false;
        }
        if v == arc.high[1] {
            return arc.high[0] > u;
        }
        let p = [u - arc.low[0], v - arc.low[1]];
        let chord = [arc.high[0] - arc.low[0], arc.high[1] - arc.low[1]];
        let side = chord[0] * p[1] - p[0] * chord[1];
        if side > arc.hull[1] {
            return true;
        }
        let degree = arc.shape & (ARC_UP - 1);
        if side < arc.hull[0] || degree <= 1 {
            return false;
        }
        let (mut ta, mut tb, mut a, mut b) = (0.0f32, 1.0f32, [0.0f32; 2], chord);
        for step in 0..MAX_STEPS {
            let share = if step & 1 == 0 { (p[1] - a[1]) / (b[1] - a[1]) } else { 0.5 };
            let within = |t: f32| t > ta && t < tb;
            let mut t = ta + (tb - ta) * share;
            if !within(t) {
                t = 0.5 * (ta + tb);
                if !within(t) {
                    break;
                }
            }
            let q = self.point(arc.first as usize, degree, t);
            let q: [f32; 2] = std::array::from_fn(|i| q[i].clamp(a[i].min(b[i]), a[i].max(b[i])));
            if q[1] >= p[1] {
                (tb, b) = (t, q);
            } else {
                (ta, a) = (t, q);
            }
            if p[0] < a[0].min(b[0]) {
                return true;
            }
            if p[0] >= a[0].max(b[0]) {
                return false;
            }
        }
        (b[0] - a[0]) * (p[1] - a[1]) - (p[0] - a[0]) * (b[1] - a[1]) > 0.0
    }

    /// Point of a bent arc, relative to its lower end, by Horner's scheme in the Bernstein basis.
    pub(super) fn point(&self, first: usize, degree: u32, t: f32) -> [f32; 2] {
        let control = |k: u32| -> [f32; 3] { std::array::from_fn(|i| self.points[first + 3 * k as usize + i]) };
        let s = 1.0 - t;
        let (mut f, mut c) = (1.0f32, 1.0f32);
        let mut sum = control(0).map(|x| x * s);
        for k in 1..degree {
            f *= t;
            c *= (degree - k + 1) as f32 / k as f32;
            let p = control(k);
            sum = std::array::from_fn(|i| (sum[i] + p[i] * (f * c)) * s);
        }
        let p = control(degree);
        let sum: [f32; 3] = std::array::from_fn(|i| sum[i] + p[i] * (f * t));
        [sum[0] / sum[2], sum[1] / sum[2]]
    }
}
