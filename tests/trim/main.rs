//! The trim test against exact answers, brute force and stated bounds.

mod flatten;
mod hard_cases;
mod properties;
mod shapes;
