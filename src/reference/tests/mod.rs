//! The reference against closed forms and brute force.

mod judge;
mod patches;
mod quadrics;
mod shapes;
