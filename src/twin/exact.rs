//! Twin of `glsl/include/exact.glsl`: the exact trim test. [`trim::ExactTrim`](crate::trim::ExactTrim) describes the
//! data structure.

pub use crate::abi::constants::exact::FAR;
use crate::abi::{ARC_LAST, ARC_UP, CELL_SPLIT, ExactArc, ExactCell, ExactFace};
use crate::trim::{AT_HIGH, AT_LOW, MARGIN};

/// The arrays of all faces.
#[derive(Clone, Copy, Debug, Default)]
pub struct Exact<'a> {
    /// One for each face, by its number.
    pub faces: &'a [ExactFace],
    /// Cells of all faces.
    pub cells: &'a [ExactCell],
    /// The lists of all cells.
    pub arcs: &'a [ExactArc],
}

/// A list of arcs, and the points for which it is valid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct List {
    /// Its first arc.
    pub first: u32,
    /// Winding number of the arcs that are not in the list.
    pub winding: i32,
    /// Least corner of the cell's rectangle; unbounded for the outermost cells.
    pub lo: [f32; 2],
    /// Largest corner.
    pub hi: [f32; 2],
    /// Margin around the rectangle where the list is valid, too.
    pub margin: [f32; 2],
}

impl List {
    /// Whether the list gives the winding number of a point.
    pub fn holds_for(&self, uv: [f32; 2]) -> bool {
        (0..2).all(|i| uv[i] >= self.lo[i] - self.margin[i] && uv[i] <= self.hi[i] + self.margin[i])
    }
}

/// A face's cells along one axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    first: f32,
    count: f32,
    scale: f32,
}

impl Axis {
    /// The cell that contains a coordinate.
    pub(super) fn index(self, x: f32) -> f32 {
        (x * self.scale - self.first).floor().max(0.0).min(self.count - 1.0)
    }

    /// The part of a cell, of `parts`, that contains it.
    pub(super) fn part(self, x: f32, index: f32, parts: f32) -> f32 {
        ((x * self.scale - self.first - index) * parts).floor().max(0.0).min(parts - 1.0)
    }

    /// Start and end of a part of a cell, and the margin of its list.
    fn range(self, index: f32, part: f32, parts: f32) -> [f32; 3] {
        let side = 1.0 / (self.scale * parts);
        let at = index * parts + part;
        let lo = (self.first * parts + at) * side;
        let hi = lo + side;
        let (is_first, is_last) = (at <= 0.0, at >= self.count * parts - 1.0);
        [if is_first { -FAR } else { lo }, if is_last { FAR } else { hi }, MARGIN * side]
    }
}

impl ExactFace {
    pub(super) fn axes(&self) -> [Axis; 2] {
        std::array::from_fn(|i| {
            let half = |pair: u32| pair >> (16 * i) & 0xffff;
            Axis {
                first: f32::from(half(self.first) as u16 as i16),
                count: half(self.counts) as f32,
                scale: (1u32 << half(self.bits)) as f32,
            }
        })
    }

    pub(super) fn cell(&self, axes: &[Axis; 2], [column, row]: [f32; 2]) -> usize {
        (self.first_cell + row as u32 * axes[0].count as u32 + column as u32) as usize
    }
}

impl Exact<'_> {
    /// The list of the cell that contains the normalised `uv`.
    pub fn list(&self, face: usize, uv: [f32; 2]) -> List {
        let f = self.faces[face];
        let axes = f.axes();
        let index: [f32; 2] = std::array::from_fn(|i| axes[i].index(uv[i]));
        let cell = f.cell(&axes, index);
        let parts = self.parts(cell);
        let part = std::array::from_fn(|i| axes[i].part(uv[i], index[i], parts));
        self.list_of(&axes, cell, index, part)
    }

    /// Number of parts of a cell along each axis.
    pub(super) fn parts(&self, cell: usize) -> f32 {
        let cell = self.cells[cell];
        if cell.first & CELL_SPLIT != 0 { (1u32 << cell.winding) as f32 } else { 1.0 }
    }

    /// The list of a part of a cell.
    pub(super) fn list_of(&self, axes: &[Axis; 2], cell: usize, index: [f32; 2], part: [f32; 2]) -> List {
        let parts = self.parts(cell);
        let mut own = self.cells[cell];
        if own.first & CELL_SPLIT != 0 {
            own = self.cells[((own.first & !CELL_SPLIT) + part[1] as u32 * parts as u32 + part[0] as u32) as usize];
        }
        let [u, v] = std::array::from_fn(|i| axes[i].range(index[i], part[i], parts));
        let [lo, hi, margin] = std::array::from_fn(|k| [u[k], v[k]]);
        List { first: own.first, winding: own.winding, lo, hi, margin }
    }

    /// Winding number of a point in the box of a list; 0 for NaN.
    pub fn winding_in(&self, list: &List, uv: [f32; 2]) -> i32 {
        if !uv.iter().all(|x| x.abs() < FAR) {
            return 0;
        }
        list.winding + self.arcs(list.first).map(|arc| arc.winding(uv)).sum::<i32>()
    }

    /// Winding number of a face's loops around the normalised `(u, v)`; 0 for NaN.
    pub fn winding(&self, face: usize, uv: [f32; 2]) -> i32 {
        self.winding_in(&self.list(face, uv), uv)
    }

    /// A list's arcs.
    pub(super) fn arcs(&self, first: u32) -> impl Iterator<Item = &ExactArc> {
        let arcs = &self.arcs[first as usize..];
        let last = arcs.iter().position(|arc| arc.shape & ARC_LAST != 0).expect("every list ends");
        arcs[..=last].iter()
    }
}

impl ExactArc {
    /// The winding number that the arc adds to a point.
    fn winding(&self, uv: [f32; 2]) -> i32 {
        let direction = if self.shape & ARC_UP != 0 { 1 } else { -1 };
        let low = if self.shape & AT_LOW != 0 { direction } else { 0 };
        if uv[1] > self.high[1] {
            (if self.shape & AT_HIGH != 0 { direction } else { 0 }) - low
        } else if uv[1] > self.low[1] {
            (if self.lies_right(uv) { direction } else { 0 }) - low
        } else {
            0
        }
    }

    /// Whether the arc passes `v`, which is above its lower end and not above its higher one, at some larger `u`.
    pub(super) fn lies_right(&self, [u, v]: [f32; 2]) -> bool {
        if v == self.high[1] {
            return self.high[0] > u; // the same as the neighbouring arc
        }
        let (chord, corner) = (self.chord(), self.corner);
        let p = [u - self.low[0], v - self.low[1]];
        let area = chord[0] * corner[1] - corner[0] * chord[1];
        let turned = if area < 0.0 { -1.0 } else { 1.0 };
        let q = [u - self.high[0], v - self.high[1]];
        let back: [f32; 2] = std::array::from_fn(|i| turned * corner[i] - turned * chord[i]);
        let middle = turned * chord[0] * p[1] - p[0] * (turned * chord[1]);
        let high = p[0] * (turned * corner[1]) - turned * corner[0] * p[1];
        let low = back[0] * q[1] - q[0] * back[1]; // as a difference it would have the longer sides' rounding
        let beyond = middle > 0.0 && middle * middle > low.max(0.0) * (self.fullness * high.max(0.0));
        beyond == (turned > 0.0)
    }

    /// Weight of the corner, for weights 1 at the ends; 0 for a straight arc.
    fn weight(&self) -> f32 {
        0.5 * self.fullness.sqrt()
    }

    /// The vector from its lower to its higher end.
    pub(super) fn chord(&self) -> [f32; 2] {
        [self.high[0] - self.low[0], self.high[1] - self.low[1]]
    }

    /// A point of the arc, relative to its lower end.
    pub(super) fn point(&self, t: f32) -> [f32; 2] {
        let chord = self.chord();
        if t >= 1.0 {
            return chord;
        }
        if self.fullness == 0.0 {
            return chord.map(|x| x * t);
        }
        let s = 1.0 - t;
        let (corner, end) = (2.0 * self.weight() * (s * t), t * t);
        let sum = s * s + corner + end;
        std::array::from_fn(|i| (corner * self.corner[i] + end * chord[i]) / sum)
    }

    /// Parameter at which a coordinate, relative to the lower end, is `x`; 0 or 1 beyond the ends.
    ///
    /// With `r = t / (1 - t)`, corner `c`, its weight `w` and chord `d`, the coordinate is
    /// `(2 w r c + r² d) / (1 + 2 w r + r²)`: `r` is the only positive root of `(d - x) r² + 2 w (c - x) r - x`.
    pub(super) fn reached(&self, axis: usize, x: f32) -> f32 {
        let chord = self.chord()[axis];
        let way = if chord < 0.0 { -1.0 } else { 1.0 };
        let (to, corner, end) = (way * x, way * self.corner[axis], way * chord);
        if to.is_nan() || to <= 0.0 {
            return 0.0;
        }
        if to >= end {
            return 1.0;
        }
        if self.fullness == 0.0 {
            return to / end;
        }
        let b = self.weight() * (corner - to);
        let root = (b * b + (end - to) * to).sqrt();
        // for t = r / (1 + r), the sum without cancellation
        if b > 0.0 { to / (to + (b + root)) } else { (root - b) / ((root - b) + (end - to)) }
    }
}
