//! The pure structure of solids, against truth tables and the figures of the literature.

mod blist;
mod bsp;
mod label;
mod parse;
mod random;
mod zone;
