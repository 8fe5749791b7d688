//! Twin of the pass `carry`: the winding number at the start of each row of a strip with several bins.
//!
//! ```text
//!   bin               0     1     2     3
//!   crossings add up  +1    0     -1    0      as pass `cross` counted them
//!   at the start      0    1     1     0
//! ```

use crate::abi::{Frame, StripRows};

/// For the strips that begin at the bin instances `wide_strips`; rows of all others start with 0, which is already
/// stored.
pub fn carry(frame: &Frame, strips: &[StripRows], wide_strips: &[u32], row_windings: &mut [i32]) {
    for &strip in wide_strips {
        let rows = strips[strip as usize];
        for line in 0..rows.lines {
            let mut winding = 0;
            for bin in rows.first_bin..=rows.last_bin() {
                let row = rows.row_of(line, bin);
                if row >= frame.row_capacity {
                    break; // the line's other rows have none, either
                }
                let crossed = std::mem::replace(&mut row_windings[row as usize], winding);
                winding += crossed;
            }
        }
    }
}
