//! The trim test against exact answers, brute force and stated bounds.

mod bounds;
mod check;
mod flatten;
mod hard_crossings;
mod hard_curves;
mod hard_domains;
mod properties;
mod shapes;
