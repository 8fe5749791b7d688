//! Blist: a Boolean expression as a list of switches, walked without a stack.
//!
//! ```text
//!   A (B + !C)                entry  primitive  sign  in, out of the literal     as packed
//!                               0       A        +    in ─▶ 1     out ─▶ 3       next when in,  other 3
//!      0      1      2          1       B        +    in ─▶ 4     out ─▶ 2       next when out, other 4
//!      A ─▶   B ─▶  !C ─▶ 3     2       C        -    in ─▶ 4     out ─▶ 3       next when out, other 4
//!      └──────│──────────▶ 3    3 = n: outside the solid      4 = n + 1: inside
//!             └───────────▶ 4
//! ```
//!
//! The leaves of a positive form (see [`Tree::positive`]), left to right, each with two exits: where to
//! go when the point is in the literal and when it is out. One of the two is always the next entry, so
//! an entry takes 8 bytes:
//!
//! ```text
//!   word 0:  bit 31 sign (1: complemented)   bit 30 the next entry is for in (1) or out (0)   bits 0-29 primitive
//!   word 1:  the other exit: an entry further on, or n (outside), or n + 1 (inside)
//! ```
//!
//! Source: J. Rossignac, *Blist: a Boolean list formulation of CSG trees*, Georgia Tech GVU 99-04, 1999.

use super::tree::{Node, Op, Tree, TreeError};
use bytemuck::{Pod, Zeroable};

/// One switch; see the module for its bits.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct Entry {
    /// Sign, sense of the next entry, primitive.
    pub what: u32,
    /// The exit that is not the next entry.
    pub other: u32,
}

impl Entry {
    /// Bit of [`Entry::what`]: the primitive is complemented.
    pub const NEGATIVE: u32 = 1 << 31;
    /// Bit of [`Entry::what`]: the next entry is the exit for points in the literal.
    pub const NEXT_WHEN_IN: u32 = 1 << 30;
    /// Bits of the primitive.
    pub const PRIMITIVE: u32 = Self::NEXT_WHEN_IN - 1;

    /// Index of the primitive.
    pub fn primitive(self) -> u32 {
        self.what & Self::PRIMITIVE
    }

    /// The primitive is complemented.
    pub fn negative(self) -> bool {
        self.what & Self::NEGATIVE != 0
    }

    /// Exits of the entry at `index` for points in and out of the *literal* (the primitive, complemented
    /// when negative).
    pub fn exits(self, index: u32) -> (u32, u32) {
        if self.what & Self::NEXT_WHEN_IN != 0 { (index + 1, self.other) } else { (self.other, index + 1) }
    }
}

/// A list of switches.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Blist {
    entries: Vec<Entry>,
    start: u32,
}

impl Blist {
    /// Wires the leaves of `tree`'s positive form in their order. Linear time, no recursion.
    ///
    /// # Errors
    /// [`TreeError::TooLarge`] when the positive form is.
    pub fn new(tree: &Tree) -> Result<Self, TreeError> {
        if tree.is_positive() { Ok(Self::wire(tree)) } else { Ok(Self::wire(&tree.positive()?)) }
    }

    /// Targets flow from the root down; parents stand behind their children.
    fn wire(tree: &Tree) -> Self {
        let nodes = tree.nodes();
        if let Some(value) = tree.as_constant() {
            return Self { entries: Vec::new(), start: u32::from(value) };
        }
        // entries before the subtree of each node
        let mut firsts: Vec<u32> = Vec::with_capacity(nodes.len());
        let mut count = 0;
        for node in nodes {
            firsts.push(match *node {
                Node::Pair(_, a, _) | Node::Complement(a) => firsts[a as usize],
                Node::Leaf(_) | Node::Constant(_) => count,
            });
            count += u32::from(matches!(node, Node::Leaf(_)));
        }
        let (outside, inside) = (count, count + 1);
        let mut exits = vec![(0, 0); nodes.len()]; // for in and out
        exits[nodes.len() - 1] = (inside, outside);
        let mut entries = vec![Entry { what: 0, other: 0 }; count as usize];
        let mut negative = vec![false; nodes.len()];
        for (i, node) in nodes.iter().enumerate().rev() {
            let (t, f) = exits[i];
            match *node {
                Node::Pair(op, a, b) => {
                    let (a, b) = (a as usize, b as usize);
                    exits[a] = if op == Op::Union { (t, firsts[b]) } else { (firsts[b], f) };
                    exits[b] = (t, f);
                }
                Node::Complement(a) => {
                    (exits[a as usize], negative[a as usize]) = ((t, f), true);
                }
                Node::Leaf(primitive) => {
                    let next = firsts[i] + 1;
                    let (sense, other) = if t == next { (Entry::NEXT_WHEN_IN, f) } else { (0, t) };
                    debug_assert!(t == next || f == next, "one exit is the next entry");
                    let sign = if negative[i] { Entry::NEGATIVE } else { 0 };
                    entries[firsts[i] as usize] = Entry { what: primitive | sense | sign, other };
                }
                Node::Constant(_) => unreachable!("a positive form with leaves has no constants"),
            }
        }
        Self { entries, start: 0 }
    }

    /// The switches, ready for upload.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Where walks begin: 0, except for the list without entries that means everything, where it is 1.
    pub fn start(&self) -> u32 {
        self.start
    }

    /// The index at which a walk ends outside; one more is inside.
    pub fn outside(&self) -> u32 {
        self.entries.len() as u32
    }

    /// Whether a point is in the solid; calls `inside(primitive)` only for primitives that decide it.
    pub fn contains(&self, mut inside: impl FnMut(u32) -> bool) -> bool {
        let mut i = self.start;
        while let Some(entry) = self.entries.get(i as usize) {
            let literal = inside(entry.primitive()) != entry.negative();
            let (t, f) = entry.exits(i);
            i = if literal { t } else { f };
        }
        i > self.outside()
    }
}
