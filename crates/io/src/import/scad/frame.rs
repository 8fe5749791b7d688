//! Nodes that are being read: the result of their children so far.
//!
//! ```text
//!   difference() { A B C }     sum: A, then A - B, then A - B - C
//!                              A is empty: void;  A is left out: lost
//! ```

use super::facets::{Gather, Shape};
use super::{Args, Context, Lexer};
use crate::csg::Op;
use crate::import::solid::Assembly;

/// The result of a node.
#[derive(Clone, Debug)]
pub(super) enum Made<T> {
    Is(T),
    /// A node without a solid in it, or one that is empty.
    Empty,
    /// Left out, with a warning.
    Lost,
}

/// A node of the solid, or facets for the node around.
#[derive(Debug)]
pub(super) enum Outcome {
    Node(Made<u32>),
    Shape(Made<Shape>),
}

/// A node whose children are being read.
#[derive(Debug)]
pub(super) struct Frame<'a> {
    pub args: Args<'a>,
    pub op: Op,
    /// What its children inherit.
    pub inside: Context,
    /// The node itself stands inside of one that is made of facets.
    pub within_facets: bool,
    /// Its children so far.
    pub sum: Option<u32>,
    /// Meets the sum in the end.
    pub cut: Option<u32>,
    /// `!`
    pub root: bool,
    /// Its children, where it is made of facets.
    pub gather: Option<Box<Gather>>,
    /// Where its children begin and the number of the node, if they are read again.
    pub start: Option<Box<(Lexer<'a>, u32)>>,
    own: Option<Outcome>,
    /// Children so far, of any kind.
    count: usize,
    /// A child is empty, where that makes the whole empty.
    void: bool,
    /// A child was left out.
    lost: bool,
    /// Is no part of the solid: background, disabled, or inside such a node.
    absent: bool,
}

impl<'a> Frame<'a> {
    pub fn new(args: Args<'a>, inside: Context) -> Self {
        Self {
            args,
            op: Op::Union,
            inside,
            within_facets: inside.facets,
            sum: None,
            cut: None,
            root: false,
            gather: None,
            start: None,
            own: None,
            count: 0,
            void: false,
            lost: false,
            absent: inside.skipped,
        }
    }

    pub fn is_absent(&self) -> bool {
        self.absent
    }

    /// A node that is made without its children: those are only parsed.
    pub fn leaf(&mut self, outcome: Outcome) {
        self.own = Some(outcome);
        self.inside.skipped = true;
    }

    /// A node that cannot be made.
    pub fn lose(&mut self) {
        self.gather = None;
        self.leaf(if self.within_facets { Outcome::Shape(Made::Lost) } else { Outcome::Node(Made::Lost) });
    }

    /// Takes a finished child.
    pub fn add(&mut self, child: Outcome, assembly: &mut Assembly) {
        let child = match (child, &mut self.gather) {
            (Outcome::Shape(shape), Some(gather)) => return gather.add(shape),
            (Outcome::Node(node), _) => node,
            (Outcome::Shape(_), None) => Made::Empty,
        };
        let first = self.count == 0;
        self.count += 1;
        let (minuend, factor) = (self.op == Op::Difference && first, self.op == Op::Intersection);
        match child {
            Made::Is(node) => {
                self.sum = Some(match self.sum {
                    Some(sum) => assembly.nodes.pair(self.op, sum, node),
                    // subtracted from nothing
                    None if self.op == Op::Difference && !first => return,
                    None => node,
                });
            }
            Made::Empty => self.void |= minuend || factor,
            Made::Lost => self.lost = true,
        }
    }

    /// The node's result, after its last child.
    pub fn outcome(&mut self, assembly: &mut Assembly) -> Outcome {
        if let Some(own) = self.own.take() {
            return own;
        }
        Outcome::Node(match (self.sum, self.cut) {
            (_, _) if self.void => Made::Empty,
            (Some(node), Some(cut)) => Made::Is(assembly.nodes.pair(Op::Intersection, node, cut)),
            (Some(node), None) => Made::Is(node),
            (None, _) if self.lost => Made::Lost,
            (None, _) => Made::Empty,
        })
    }
}
