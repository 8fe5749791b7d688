//! The reference against closed forms and brute force.

mod edges;
mod facets;
mod judge;
mod patches;
mod quadrics;
mod shapes;
