//! What several stages have in common: prefix sums, and counters that begin at 0.

pub(crate) mod reset;
pub mod scan;
