//! The reference against closed forms and brute force.

mod drawing;
mod edges;
mod facets;
mod judge;
mod patches;
mod quadrics;
pub(crate) mod shapes;
mod snap;
mod touching;
