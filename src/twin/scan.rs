//! Twin of the pass [`scan`](crate::frame::common::scan).

/// Exclusive prefix sums of `values`, and their total, both modulo 2³².
///
/// ```
/// assert_eq!(selvedge::internals::twin::scan::scan(&[3, 1, 4, 1]), (vec![0, 3, 4, 8], 9));
/// ```
pub fn scan(values: &[u32]) -> (Vec<u32>, u32) {
    let mut total = 0u32;
    let offsets = values
        .iter()
        .map(|&value| {
            let before = total;
            total = total.wrapping_add(value);
            before
        })
        .collect();
    (offsets, total)
}
