//! The trim test against exact answers, brute force and stated bounds.

mod hard_cases;
mod shapes;
