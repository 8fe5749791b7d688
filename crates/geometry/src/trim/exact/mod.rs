//! Trim loops prepared once for answers at any zoom: two levels of cells, each with the few arcs near it.
//!
//! ```text
//!   v ▲ ┌───────┬───────┬───────┐     as many cells as there are arcs, about; their sides are powers of two
//!     │ │   0   │       │ 0     │
//!     │ │      ╭┼───┬─●╮│       │     a cell with many arcs is split, once, into 4, 16, 64 or 256 alike
//!     │ ├──────│┼─┼─┼─┼│┼───────┤
//!     │ │      ╲│ │1│ │╱│       │     ┄┄┄┄┄  each has the arcs of a box a quarter wider to every side:
//!     │ │       ╲─┼─┼─╱ │       │     ┆ ┌─┐  so a point near the centre of a pixel has its arcs in
//!     │ └───────┴─●───┴─┴───────┘     ┆ └─┘  the list that the centre finds
//!     └───────────────────────────▶ u
//! ```
//!
//! An *arc* is a piece of a trim curve that turns back neither in `u` nor in `v`: straight, or of a conic ([`conic`]),
//! from its lower end to its higher one. Whether a point lies left of it is decided without a search, all in `f32`, the
//! shader's arithmetic. The side of its chord decides, and on the corner's side the sign of the conic's equation.
//!
//! **Winding.** The winding number of `p` counts crossings right of `p`. Arcs of the list are tested. The others add up
//! to one number for all points of the box, provided that they form whole chains. A chain that leaves the list at a
//! joint right of the box is lengthened straight upwards from that joint, at `u = ∞`. The arc of the list subtracts the
//! lengthening again: that is the meaning of [`AT_LOW`] and [`AT_HIGH`]. Joints are the same bits for both neighbours
//! and are only compared, so the loops stay closed whatever an arc's own rounding is.
//!
//! **Accuracy.** An arc is within 2⁻²⁵ of the domain of its trim curve, proved as it is made. Corners are stored
//! relative to the arc's lower end, so the equation is off by a few roundings times the arc's size. Joints are rounded
//! to 2⁻²⁴ of the domain, as the fragment's own (u, v) is.
//!
//! **Memory.** See [`ExactTrim::bytes`]. A list stores its arcs themselves, and cells with equal lists share one. Cells
//! are fewer where arcs cross each other, so memory stays linear in the number of arcs.
//!
//! Sources: D. Nehab, H. Hoppe, *Random-access rendering of general vector graphics*, 2008 (a lattice of cells that
//! store their winding number, and shortcuts for chains that leave them); A. Schollmeyer, B. Fröhlich, *Direct trimming
//! of NURBS surfaces on the GPU*, 2009 (monotone pieces).

mod arcs;
mod cells;
mod conic;
mod grid;

use crate::model::TrimLoop;
use glam::DVec2;

/// Flag of an entry: the chain goes on from the arc's lower end, right of the list's box; above that end it counts against
/// the arc's direction.
pub const AT_LOW: u32 = 1;
/// As [`AT_LOW`] from the higher end; above that end it counts with the arc's direction.
pub const AT_HIGH: u32 = 2;

/// A monotone piece of a trim curve in the normalised domain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// End of the smaller `v`.
    pub low: [f32; 2],
    /// End of the larger `v`.
    pub high: [f32; 2],
    /// The meeting point of the end tangents, relative to `low`; zero when the arc is straight.
    pub corner: [f32; 2],
    /// `4 w²` of the corner's weight `w`, where the ends have weight 1; 0 when the arc is straight.
    pub fullness: f32,
    /// The loop runs from `low` to `high`.
    pub up: bool,
}

/// A rectangle of the domain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell {
    /// With a list.
    Whole {
        /// First entry of the list.
        first: u32,
        /// Winding number of the arcs outside the list.
        winding: i32,
    },
    /// Split into `4^halvings` others.
    Split {
        /// First of them.
        first: u32,
        /// Halvings of each side; at most 4.
        halvings: u32,
    },
}

/// Most halvings of a side of a [`Cell::Split`].
const MOST_HALVINGS: u32 = 4;

/// An arc of a list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Number of the arc; `None` in the list of the cells that no arc comes near.
    pub arc: Option<u32>,
    /// [`AT_LOW`] and [`AT_HIGH`].
    pub flags: u32,
    /// The list ends here.
    pub last: bool,
}

/// One face's trims, as passes `visibility` and `gap_fill` read them in the way [`crate::trim`] calls *exact*.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExactTrim {
    /// The arcs of all loops.
    pub arcs: Vec<Arc>,
    /// The place of the cells.
    pub grid: Grid,
    /// The cells of the grid, row by row, then the parts of each split one.
    pub cells: Vec<Cell>,
    /// The lists; the first is that of cells without arcs.
    pub entries: Vec<Entry>,
}

/// Cells of the first level. The outermost reach out to infinity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Grid {
    /// Place of the first column and row, in widths and heights of a cell.
    pub first: [i16; 2],
    /// Columns and rows.
    pub counts: [u16; 2],
    /// Columns and rows to the domain, as powers of two.
    pub bits: [u32; 2],
}

/// How far the box of a cell's list reaches beyond it to every side, in widths and heights of the cell.
pub const MARGIN: f32 = 0.25;

impl ExactTrim {
    /// Prepares `loops`, whose coordinates `p` become `(p - origin) / size`; `O(n log n)`.
    pub fn new(loops: &[TrimLoop], origin: DVec2, size: DVec2) -> Self {
        cells::sorted_into(arcs::chains(loops, origin, size), cells::Flats::Left)
    }

    /// As [`new`](Self::new), with arcs along scan lines in the lists: they cross no scan line, so winding numbers do
    /// not depend on them, but they are part of the border that pass `coverage` measures.
    pub fn with_flats(loops: &[TrimLoop], origin: DVec2, size: DVec2) -> Self {
        cells::sorted_into(arcs::chains(loops, origin, size), cells::Flats::Kept)
    }

    /// Bytes in GPU memory: 32 an entry, 8 a cell, 16 for the grid.
    pub fn bytes(&self) -> usize {
        32 * self.entries.len() + 8 * self.cells.len() + 16
    }
}
