//! Boolean solids: expressions over primitives, and the lists that decide membership.
//!
//! ```text
//!   Solid ── primitives: [Primitive]     shape, transform, colour, id
//!         └─ tree: Tree                  + * - ^ ! over primitive indices, postfix, any depth
//!
//!   Tree ──positive──▶ + * and complemented leaves ──Blist──▶ 8-byte switches, walked without a stack
//!     └─zone──▶ where a primitive matters      └─with_fewest_labels──▶ orders for a stencil buffer
//!
//!   Solid ──SurfaceTable──▶ one index for all faces on one carrier: coincidence is equality
//! ```

mod blist;
mod bsp;
mod carrier;
mod cover;
mod label;
mod parse;
mod positive;
mod shape;
mod solid;
mod surface;
#[cfg(test)]
mod tests;
mod tree;
mod zone;

pub use blist::{Blist, Entry};
pub use bsp::{Bsp, BspNode, Visit, most_cells};
pub use carrier::Carrier;
pub use cover::covering_set;
pub use label::{Convention, Labels, Switch};
pub use parse::{Expression, ParseError, parse};
pub use shape::{Primitive, Quadric, Shape, ShapeError};
pub use solid::{Solid, SolidError};
pub use surface::{CarriedFace, Surface, SurfaceTable};
pub use tree::{Builder, Node, Op, Tree, TreeError};
pub use zone::Path;
