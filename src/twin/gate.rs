//! Twin of the pass `gate`: if a list of this frame overflowed, no patch is drawn.

use crate::abi::Counters;

/// The counters after the pass.
pub fn gate(counters: Counters) -> Counters {
    let drawn = if counters.failed == 0 { 1 } else { 0 };
    let Counters { plain_draws, trimmed_draws, corner_draws, trimmed_corner_draws, .. } = counters;
    let [plain_draws, trimmed_draws, corner_draws, trimmed_corner_draws] =
        [plain_draws, trimmed_draws, corner_draws, trimmed_corner_draws].map(|draws| drawn * draws);
    Counters { plain_draws, trimmed_draws, corner_draws, trimmed_corner_draws, ..counters }
}
