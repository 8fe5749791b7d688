//! The pure structure of solids, against truth tables and the figures of the literature.

mod blist;
mod random;
