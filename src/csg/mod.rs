//! Boolean solids: expressions over primitives, and the lists that decide membership.
//!
//! ```text
//!   Solid ── primitives: [Primitive]     shape, transform, colour, id
//!         └─ tree: Tree                  + * - ^ ! over primitive indices, postfix, any depth
//!
//!   Tree ──positive──▶ + * and complemented leaves ──Blist──▶ 8-byte switches, walked without a stack
//! ```

mod blist;
mod positive;
mod shape;
mod solid;
#[cfg(test)]
mod tests;
mod tree;

pub use blist::{Blist, Entry};
pub use shape::{Primitive, Quadric, Shape, ShapeError};
pub use solid::{Solid, SolidError};
pub use tree::{Builder, Node, Op, Tree, TreeError};
