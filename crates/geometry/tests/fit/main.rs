//! Surfaces from equations and from data, against the equations themselves, closed forms and counting.

mod curves;
mod equations;
mod grids;
mod polyloop;
