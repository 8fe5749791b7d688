//! A solid under construction, and why it cannot be read, for the readers of Boolean solids.
//!
//! ```text
//!   add(shape, placed) ──▶ leaf ─┐
//!   half_spaces(box, planes) ────┼─▶ builder ──finish──▶ Solid of the primitives that its tree names
//!                                │
//!      box * {n·x <= d} * ...  ──┘   the box bounds the rest, so that the whole has a size
//! ```

use super::ImportError;
use crate::csg::{Builder, Node, Op};
use crate::model::{Bounds, Colour, GREY, Primitive, Shape, Solid};
use glam::{DAffine3, DVec3};

/// Why a text of Boolean solids is not read, and where.
#[derive(Clone, Debug)]
pub(super) struct Fault {
    pub line: usize,
    pub message: String,
}

impl Fault {
    pub fn new(line: usize, message: impl Into<String>) -> Self {
        Self { line, message: message.into() }
    }

    /// As an error of the file of this name.
    pub fn of_file(self, name: &str) -> ImportError {
        ImportError::Solid { file: name.to_owned(), line: self.line, message: self.message }
    }
}

/// Where a primitive stands and how it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placed {
    /// Own coordinates to the model's.
    pub transform: DAffine3,
    /// Linear light; `None` for the default.
    pub colour: Option<Colour>,
    /// Number of the node in the source, from 1.
    pub id: u32,
}

/// `normal · x <= offset`.
pub(super) type Plane = (DVec3, f64);

/// Primitives and nodes so far.
#[derive(Debug, Default)]
pub(super) struct Assembly {
    primitives: Vec<Primitive>,
    /// Expressions over them.
    pub nodes: Builder,
}

impl Assembly {
    /// A primitive, as a node.
    pub fn add(&mut self, shape: Shape, placed: &Placed) -> u32 {
        let colour = placed.colour.unwrap_or(GREY);
        self.primitives.push(Primitive { shape, transform: placed.transform, colour, id: placed.id });
        self.nodes.leaf(self.primitives.len() as u32 - 1)
    }

    /// The part of the box that satisfies all planes.
    pub fn half_spaces(&mut self, within: Bounds, planes: &[Plane], placed: &Placed) -> u32 {
        let first = self.add(Shape::Block { min: within.min, max: within.max }, placed);
        self.cut(first, planes, placed)
    }

    /// The part of a node that satisfies all planes; planes without a normal cut nothing.
    pub fn cut(&mut self, node: u32, planes: &[Plane], placed: &Placed) -> u32 {
        let planes = planes.iter().filter(|(n, _)| *n != DVec3::ZERO);
        planes.fold(node, |all, &(normal, offset)| {
            let leaf = self.add(Shape::HalfSpace { normal, offset }, placed);
            self.nodes.pair(Op::Intersection, all, leaf)
        })
    }

    /// Nothing.
    pub fn nothing(&mut self) -> u32 {
        self.nodes.push(Node::Constant(false))
    }

    /// The solid of a node, with the primitives that it uses and no others.
    pub fn finish(self, root: u32) -> Result<Solid, String> {
        let tree = self.nodes.finish(root).map_err(|e| e.to_string())?;
        let mut place = vec![u32::MAX; self.primitives.len()];
        let mut used = Vec::new();
        let mut nodes = Builder::new();
        // postfix: children are where they were
        for node in tree.nodes() {
            let new = match *node {
                Node::Leaf(p) => {
                    let to = &mut place[p as usize];
                    if *to == u32::MAX {
                        *to = used.len() as u32;
                        used.push(self.primitives[p as usize].clone());
                    }
                    Node::Leaf(*to)
                }
                other => other,
            };
            nodes.push(new);
        }
        let tree = nodes.finish(tree.root()).map_err(|e| e.to_string())?;
        Solid::new(used, tree).map_err(|e| e.to_string())
    }
}

/// A box around points, wider by a tenth on every side, so that no face of it is one of theirs.
pub(super) fn around(points: impl IntoIterator<Item = DVec3>) -> Bounds {
    let tight = points.into_iter().fold(Bounds::EMPTY, Bounds::with);
    let margin = DVec3::splat(0.1 * tight.diagonal());
    Bounds { min: tight.min - margin, max: tight.max + margin }
}
