//! Boolean expressions over primitives, which are numbers here, and lists that decide membership.
//!
//! ```text
//!   Tree: + * - ^ ! over primitive indices, postfix, any depth
//!     │
//!     ├─positive──▶ + * and complemented leaves ──Blist──▶ 8-byte switches, walked without a stack
//!     ├─zone──▶ where a primitive matters
//!     └─with_fewest_labels──▶ orders for a stencil buffer
//! ```

mod blist;
mod bsp;
mod cover;
mod label;
mod parse;
mod positive;
#[cfg(test)]
mod tests;
mod tree;
mod zone;

pub use blist::{Blist, Entry};
pub use bsp::{Bsp, BspNode, Visit, most_cells};
pub use cover::covering_set;
pub use label::{Convention, Labels, Switch};
pub use parse::{Expression, ParseError, parse};
pub use tree::{Builder, Node, Op, Tree, TreeError};
pub use zone::Path;
