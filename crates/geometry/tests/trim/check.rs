//! The form of a hard case.
//!
//! A row `(u, v, w)` states the winding number `w` at `(u, v)`. Every row is checked with the exact index and with a
//! table that has a scan line exactly at `v`. Coordinates are dyadic or one ulp from it, so chords of straight loops
//! are exact in both.

use crate::shapes::at;
use selvedge_geometry::model::TrimLoop;
use selvedge_geometry::trim::{LoopIndex, TrimTable};

/// One ulp more.
pub const fn up(x: f64) -> f64 {
    x.next_up()
}
/// One ulp less.
pub const fn down(x: f64) -> f64 {
    x.next_down()
}

/// Chords per curve of the tables below: a deviation of about 1e-4 for unit arcs, so rows for tables lie no nearer than
/// that to a bent curve.
pub const CHORDS: u32 = 64;

/// Checks the rows with the index.
pub fn expect_winding(loops: &[TrimLoop], rows: &[(f64, f64, i32)]) {
    let index = LoopIndex::new(loops);
    for &(u, v, winding) in rows {
        assert_eq!(index.winding(at(u, v)), winding, "winding at ({u:e}, {v:e})");
    }
}

/// The table with one scan line, exactly at `v`: `0 + 2v/2`, `2v - 2v/2` and `-1 + 2/2` do not round.
pub fn table_at(loops: &[TrimLoop], v: f64) -> TrimTable {
    let range = if v > 0.0 {
        (0.0, 2.0 * v)
    } else if v < 0.0 {
        (2.0 * v, 0.0)
    } else {
        (-1.0, 1.0)
    };
    let table = TrimTable::new(loops, range, &[1], |c| if c.degree() == 1 { 1 } else { CHORDS });
    assert_eq!(table.row_v(0), v);
    table
}

/// Checks the rows with the index and with a table.
pub fn expect(loops: &[TrimLoop], rows: &[(f64, f64, i32)]) {
    expect_winding(loops, rows);
    for &(u, v, winding) in rows {
        assert_eq!(table_at(loops, v).contains(u, v), winding != 0, "table at ({u:e}, {v:e})");
    }
}
