//! Twin of the pass `sort`: sorts each row by `u`, and reduces it to the places where inside and outside change.
//!
//! ```text
//!   intercepts   ↑  ↑  ↓  ↑  ↓  ↓        winding   0 1 2 1 2 1 0
//!   flips        |              |        inside    0 1 1 1 1 1 0
//! ```
//!
//! The shader sorts few intercepts in registers and many by heap sort; the sorted list is the same for any method. At
//! equal `u`, where loops touch or coincide, several flips may be adjacent; a look-up passes all of them or none. Words
//! behind a row's flips are unused.

use super::FAILED_INTERCEPTS;
use crate::abi::{Counters, Frame};

/// Sorts the intercepts of each row, and overwrites the first ones with the flips' `u` (float bits). Returns for each
/// row `flips << 1`, plus 1 if it starts inside: with a winding number other than 0.
///
/// `row_total` is the number of intercepts of all rows. A row beyond `intercept_capacity` has no flip: the host
/// enlarges the table and records again.
pub fn sort(
    frame: &Frame,
    row_starts: &[u32],
    row_total: u32,
    row_windings: &[i32],
    intercepts: &mut [u32],
    counters: &mut Counters,
) -> Vec<u32> {
    let rows = counters.rows as usize;
    if rows > 0 {
        counters.intercepts = row_total;
        if row_total > frame.intercept_capacity {
            counters.failed |= FAILED_INTERCEPTS;
        }
    }
    (0..rows)
        .map(|index| {
            let end = if index + 1 < rows { row_starts[index + 1] } else { row_total };
            if end > frame.intercept_capacity {
                return 0;
            }
            let row = &mut intercepts[row_starts[index] as usize..end as usize];
            row.sort_unstable();
            let start = row_windings[index];
            let (mut flips, mut winding) = (0, start);
            for i in 0..row.len() {
                let bits = row[i];
                let next = winding + if bits & 1 != 0 { 1 } else { -1 };
                if (winding == 0) != (next == 0) {
                    row[flips] = from_ordered(bits & !1).to_bits();
                    flips += 1;
                }
                winding = next;
            }
            (flips as u32) << 1 | u32::from(start != 0)
        })
        .collect()
}

/// The number of the given [`ordered_bits`](super::cross::ordered_bits).
pub fn from_ordered(bits: u32) -> f32 {
    f32::from_bits(if bits & 0x8000_0000 != 0 { bits & 0x7fff_ffff } else { !bits })
}

#[cfg(test)]
mod tests {
    use super::super::cross::ordered_bits;
    use super::*;

    #[test]
    fn bits_order_as_numbers_do_and_come_back() {
        let ascending = [f32::NEG_INFINITY, -3.5, -1e-30, -0.0, 0.0, 1e-30, 0.3, 1.0, f32::INFINITY];
        for pair in ascending.windows(2) {
            assert!(ordered_bits(pair[0]) < ordered_bits(pair[1]), "{pair:?}");
        }
        ascending.iter().for_each(|&u| assert_eq!(from_ordered(ordered_bits(u)).to_bits(), u.to_bits()));
    }

    /// The row of the figure: nested and overlapping loops flip only where the winding number leaves or reaches zero.
    #[test]
    fn only_zero_windings_flip() {
        let row: Vec<u32> = [(0.1, 1), (0.2, 1), (0.3, 0), (0.4, 1), (0.5, 0), (0.6, 0)]
            .map(|(u, up)| ordered_bits(u) & !1 | up)
            .to_vec();
        let mut shuffled = [row[3], row[5], row[0], row[4], row[2], row[1]];
        let frame = Frame { intercept_capacity: 6, ..Default::default() };
        let mut counters = Counters { rows: 1, ..Default::default() };
        assert_eq!(sort(&frame, &[0], 6, &[0], &mut shuffled, &mut counters), [2 << 1]);
        let flips = [shuffled[0], shuffled[1]].map(f32::from_bits);
        // the direction's bit replaces the last bit of u
        assert!((flips[0] - 0.1).abs() < 1e-7 && (flips[1] - 0.6).abs() < 2e-7, "{flips:?}");
        assert_eq!(counters.intercepts, 6);
    }
}
