//! The rivals' ways: slefe tables derived again.

mod program;
mod simplex;
mod slefe;
