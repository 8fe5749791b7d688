//! Trim loops prepared once for answers at any zoom: bands and cells that hold a few arcs each.
//!
//! ```text
//!   v ▲ ─────────────────────────────── band borders stand at joints of the loops; a band is
//!     │    │   ╭┼────┼╮   │             bottom-open, top-closed like the arcs
//!     │    │  ╱ │    │ ╲  │
//!     │ ───┼─●──┼────┼──●─┼──────────── cell borders stand where an arc's part of the band begins
//!     │  0 │ ╲  │ 1  │  ╱ │ 0           and ends in u, so most cells hold one arc or none: a cell
//!     │    │  ╰─┼────┼─╯  │             without arcs knows its winding number and answers at once
//!     │ ───┴────┴────┴────┴─────────
//!     └────────────────────────────▶ u
//! ```
//!
//! An *arc* is a piece of a trim curve that turns back neither in `u` nor in `v`, as a rational Bézier
//! curve of its own, from its lower end to its higher one. Whether a point lies left of it is decided
//! by the first of these that can tell, all in `f32`, the shader's arithmetic:
//!
//! 1. the box of its ends: left or right of all of it;
//! 2. its *hull*: the cross product `d × (p - low)` with its chord `d` is bounded over its control
//!    points, so beyond the bounds the chord decides. Straight arcs end here;
//! 3. the parameter in a bracket `[a, b]`, `v_a < v <= v_b`, halved or cut by the secant in turn, until
//!    the box of the bracket is left or right of the point. Monotony makes each step certain, so
//!    inflections, flat ends and cusps need no care.
//!
//! **Far from a loop** a cell without arcs answers for a whole box around a point: what a pixel asks on behalf of its
//! neighbourhood.
//!
//! **Winding.** The winding number of `p` counts crossings right of `p`. Arcs left of a cell add
//! nothing; those in it are asked. Those right of it add up to one number for all its points, provided
//! that they form whole chains; a chain that leaves an arc of the cell at a joint inside the band is
//! lengthened straight upwards from that joint, at `u = ∞`, and the arc takes the lengthening back:
//! that is the meaning of [`AT_LOW`] and [`AT_HIGH`]. Joints are the same bits for both neighbours and
//! are only compared, so the loops stay closed whatever an arc's own rounding is.
//!
//! **Accuracy.** Control points are stored relative to the arc's lower end, so evaluating an arc is off
//! by [`ExactTrim::error`] times its size, and joints are rounded to 2⁻²⁴ of the domain, as the
//! fragment's own (u, v) is. Memory: see [`ExactTrim::bytes`]; lists are coarsened so that it stays
//! linear in the number of arcs, however they cross each other.
//!
//! Sources: D. Nehab, H. Hoppe, *Random-access rendering of general vector graphics*, 2008 (a lattice
//! of cells that know their winding number, and shortcuts for what leaves them); A. Schollmeyer,
//! B. Fröhlich, *Direct trimming of NURBS surfaces on the GPU*, 2009 (bisection of monotone pieces).

mod arcs;
mod bands;

use crate::model::TrimLoop;
use glam::DVec2;

/// Flag of an entry: left of the cell's points the chain goes on from the arc's lower end, and right
/// of the cell; above that end it counts against the arc's direction.
pub const AT_LOW: u32 = 1;
/// As [`AT_LOW`] from the higher end; above that end it counts with the arc's direction.
pub const AT_HIGH: u32 = 2;

/// A monotone piece of a trim curve in the normalised domain.
#[derive(Clone, Debug, PartialEq)]
pub struct Arc {
    /// End of the smaller `v`.
    pub low: [f32; 2],
    /// End of the larger `v`.
    pub high: [f32; 2],
    /// Smallest and largest `d × (q - low)` over the control points `q`, `d = high - low`; both 0 when
    /// the arc is straight.
    pub hull: [f32; 2],
    /// The loop runs from `low` to `high`.
    pub up: bool,
    /// Homogeneous control points `(w u, w v, w)` relative to `low`, from `low` to `high`; none when
    /// the arc is straight.
    pub points: Vec<[f32; 3]>,
}

/// Arcs between two scan lines; the one below is the `top` of the band before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Highest `v`.
    pub top: f32,
    /// One past its last cell.
    pub end: u32,
}

/// Part of a band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Largest `u`; the cell before ends where this one begins.
    pub right: f32,
    /// Winding number by what lies right of the cell.
    pub winding: i32,
    /// First entry.
    pub first: u32,
    /// Entries.
    pub count: u32,
}

/// One face's trims: what passes `visibility` and `heal` read in the way [`crate::trim`] calls *exact*.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExactTrim {
    /// The arcs of all loops.
    pub arcs: Vec<Arc>,
    /// Ascending in `v`; the first has no cells, its top is the lowest `v` of the loops.
    pub bands: Vec<Band>,
    /// Ascending in `u` within a band. Beyond the last one all is outside.
    pub cells: Vec<Cell>,
    /// Number of an arc, times 4, and flags.
    pub entries: Vec<u32>,
}

impl ExactTrim {
    /// Prepares `loops`, whose coordinates `p` become `(p - origin) / size`; `O(n log n)`.
    pub fn new(loops: &[TrimLoop], origin: DVec2, size: DVec2) -> Self {
        bands::sorted_into(arcs::chains(loops, origin, size), bands::Flats::Left)
    }

    /// As [`new`](Self::new), with arcs along scan lines in the cells beside them: they cross no scan line, so no winding
    /// number asks for them, but they are part of the border that pass `coverage` measures.
    pub fn with_flats(loops: &[TrimLoop], origin: DVec2, size: DVec2) -> Self {
        bands::sorted_into(arcs::chains(loops, origin, size), bands::Flats::Kept)
    }

    /// Bound of the distance between an arc of this degree as the shader evaluates it and the true one,
    /// relative to the arc's size (the larger side of its box), when all weights are equal.
    ///
    /// Horner's scheme in the Bernstein basis rounds `degree` sums and as many products twice; quotient
    /// and stored coordinates round once more each; the terms are positive up to the ends' signs, which
    /// monotony fixes. Unequal weights make control points reach farther than the arc, by no more than
    /// their ratio.
    pub fn error(degree: usize) -> f64 {
        (4.0 * degree as f64 + 8.0) * f64::from(f32::EPSILON) / 2.0
    }

    /// Bytes in GPU memory: 32 an arc and 12 a control point of a bent one, 8 a band, 16 a cell, 4 an
    /// entry.
    pub fn bytes(&self) -> usize {
        let points: usize = self.arcs.iter().map(|arc| arc.points.len()).sum();
        let entries = self.entries.len();
        32 * self.arcs.len() + 12 * points + 8 * self.bands.len() + 16 * self.cells.len() + 4 * entries
    }
}
