//! The CPU twin of each compute pass: the same results in plain Rust, for the parity tests to compare
//! with.

pub mod scan;
