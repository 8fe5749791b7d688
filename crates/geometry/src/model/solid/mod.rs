//! A solid: primitives and the expression over them.

mod carrier;
mod isolated;
mod nearby;
mod operands;
mod orientation;
mod reach;
mod self_intersection;
mod shape;
mod surface;
#[cfg(test)]
mod tests;

pub use carrier::Carrier;
pub use isolated::Isolated;
pub(super) use operands::Operands;
pub use orientation::oriented_outwards;
pub(crate) use reach::{Boxes, meet};
pub use shape::{Primitive, Quadric, Shape, ShapeError};
pub use surface::{CarriedFace, Surface, SurfaceTable};

use super::Bounds;
use crate::csg::{Builder, Entry, Node, Op, Tree, TreeError};
#[cfg(feature = "serde")]
use serde::Deserialize;

/// Primitives and a Boolean expression over them, in one system of coordinates. Valid by construction: see
/// [`Solid::new`]. No boundary is computed: a renderer and the reference evaluate the expression along rays.
///
/// # Example
/// A block with a bore:
/// ```
/// use selvedge_geometry::csg::parse;
/// use selvedge_geometry::glam::{DAffine3, DVec3};
/// use selvedge_geometry::model::{GREY, Primitive, Shape, Solid};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let primitive = |id, shape| Primitive { shape, transform: DAffine3::IDENTITY, colour: GREY, id };
/// let block = Shape::Block { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) };
/// let bore = Shape::Cylinder { radius: 0.5, height: 2.0 };
/// let solid = Solid::new(vec![primitive(1, block), primitive(2, bore)], parse("A-B")?.tree)?;
/// assert_eq!(solid.bounds().max, DVec3::splat(1.0));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "SolidData"))]
pub struct Solid {
    pub(super) primitives: Vec<Primitive>,
    tree: Tree,
}

/// A solid before its indices are checked.
#[cfg(feature = "serde")]
#[derive(Deserialize)]
struct SolidData {
    primitives: Vec<Primitive>,
    tree: Tree,
}

#[cfg(feature = "serde")]
impl TryFrom<SolidData> for Solid {
    type Error = SolidError;

    fn try_from(data: SolidData) -> Result<Self, SolidError> {
        Self::new(data.primitives, data.tree)
    }
}

/// Why primitives and a tree do not make a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[allow(missing_docs)] // the messages say what each field is
#[non_exhaustive]
pub enum SolidError {
    /// A leaf names a primitive that does not exist.
    #[error("a leaf names primitive {primitive} of {count}")]
    Leaf { primitive: u32, count: usize },
    /// An invalid primitive.
    #[error("primitive {primitive}: {error}")]
    Shape { primitive: usize, error: ShapeError },
    /// More primitives than a list of switches can hold.
    #[error("more than {} primitives", Solid::MOST_PRIMITIVES)]
    TooMany,
    /// The expression is too large.
    #[error(transparent)]
    Tree(#[from] TreeError),
}

impl Solid {
    /// Primitives that a solid may have: the limit of an entry of a [`Blist`](crate::csg::Blist).
    pub const MOST_PRIMITIVES: u32 = Entry::PRIMITIVE;

    /// Checks the primitives' dimensions and the leaves' indices.
    ///
    /// # Errors
    /// [`SolidError`] names the first primitive or leaf that is wrong.
    pub fn new(primitives: Vec<Primitive>, tree: Tree) -> Result<Self, SolidError> {
        let count = primitives.len();
        if count > Self::MOST_PRIMITIVES as usize {
            return Err(SolidError::TooMany);
        }
        for (primitive, p) in primitives.iter().enumerate() {
            p.shape.check().map_err(|error| SolidError::Shape { primitive, error })?;
        }
        let missing = tree.leaves().find(|p| *p as usize >= count);
        match missing {
            Some(primitive) => Err(SolidError::Leaf { primitive, count }),
            None => Ok(Self { primitives, tree }),
        }
    }

    /// One primitive.
    ///
    /// # Errors
    /// [`SolidError::Shape`].
    pub fn of(primitive: Primitive) -> Result<Self, SolidError> {
        Self::new(vec![primitive], Tree::leaf(0))
    }

    /// The union of `solids`, which the picture shows.
    ///
    /// # Errors
    /// [`SolidError::TooMany`] primitives, or [`SolidError::Tree`].
    pub fn union(solids: &[Self]) -> Result<Self, SolidError> {
        Self::joined(Op::Union, solids)
    }

    /// The intersection with `other`.
    ///
    /// # Errors
    /// As [`Solid::union`].
    pub fn intersection(&self, other: &Self) -> Result<Self, SolidError> {
        Self::joined(Op::Intersection, &[self.clone(), other.clone()])
    }

    /// `solids` under one operation: primitives one solid after another, and one tree over them.
    fn joined(op: Op, solids: &[Self]) -> Result<Self, SolidError> {
        let mut builder = Builder::new();
        let mut primitives = Vec::new();
        let mut roots = Vec::with_capacity(solids.len());
        for solid in solids {
            let first = primitives.len() as u32;
            if primitives.len() + solid.primitives.len() > Self::MOST_PRIMITIVES as usize {
                return Err(SolidError::TooMany);
            }
            primitives.extend_from_slice(&solid.primitives);
            let mut map = Vec::with_capacity(solid.tree.nodes().len());
            for node in solid.tree.nodes() {
                map.push(match *node {
                    Node::Constant(_) => builder.push(*node),
                    Node::Leaf(p) => builder.leaf(first + p),
                    Node::Complement(a) => builder.complement(map[a as usize]),
                    Node::Pair(op, a, b) => builder.pair(op, map[a as usize], map[b as usize]),
                });
            }
            roots.extend(map.last());
        }
        let root = builder.fold(op, roots);
        Ok(Self { primitives, tree: builder.finish(root)? })
    }

    /// The primitives that leaves name by index.
    pub fn primitives(&self) -> &[Primitive] {
        &self.primitives
    }

    /// The expression.
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// A box around the solid: boxes of the primitives under the same operations. Infinite where the
    /// solid may be unbounded.
    pub fn bounds(&self) -> Bounds {
        self.bounds_over(Boxes::of, &[])
    }

    /// A box around the solid, over boxes of its primitives, and of some nodes of its tree in their order.
    pub(crate) fn bounds_over(&self, primitive: impl Fn(&Primitive) -> Boxes, nodes: &[(usize, Bounds)]) -> Bounds {
        reach::boxes(self, primitive, nodes).last().expect("a tree has a root").of
    }

    /// For each primitive, the box outside which it may be taken as absent, alone or with other primitives beyond
    /// theirs, without a change of the solid: within [`Primitive::bounds`], and within the boxes of everything that it
    /// is cut with. Empty where it never matters, infinite where it may matter everywhere.
    pub fn reaches(&self) -> Vec<Bounds> {
        reach::reaches(self)
    }
}
