//! Labels: names for the exits of a list of switches, few enough for a stencil buffer.
//!
//! ```text
//!   all leaves in order:   if next == name { next = if in { t } else { f } }
//!
//!      leaf            0   1   2   3        a label lives from the first exit that carries it
//!      exits to 2      ●──▶╶──▶○            to the leaf that it names; a leaf frees its own label
//!      exits to 3          ●──────▶○        before its exits take theirs, each the lowest free one
//! ```
//!
//! How many labels live at once depends on the order of the children of `+` and `*`. With *t* and *f*
//! saying whether the labels of a subtree's exits live already when it begins,
//!
//! ```text
//!   cost(leaf)         = 2
//!   cost(L+R, t, f)    = min over both orders of max(f + cost(L, t, 0), cost(R, 1, f))
//!   cost(L*R, t, f)    = min over both orders of max(t + cost(L, 0, f), cost(R, t, 1))
//! ```
//!
//! which is exact, and linear in the leaves. Source of labels and of the "taller child first" rule: J. Hable,
//! J. Rossignac, *Blister: GPU-based rendering of Boolean combinations of free-form triangulated shapes*,
//! SIGGRAPH 2005.

use super::blist::Blist;
use super::tree::{Node, Op, Tree};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// When the labels of the final "inside" and "outside" are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Convention {
    /// V1: by the first exit that leads there.
    WhenUsed,
    /// V2: before the first leaf.
    FromStart,
}

/// One leaf of the label walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Switch {
    /// Index of the primitive.
    pub primitive: u32,
    /// The primitive is complemented.
    pub negative: bool,
    /// The leaf is evaluated when `next` equals this; the walk starts with `next = 0`.
    pub name: u32,
    /// The next label when the point is in the literal.
    pub when_in: u32,
    /// The next label when it is not.
    pub when_out: u32,
}

/// A list of switches with labels in place of indices.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Labels {
    /// The leaves in order.
    pub switches: Vec<Switch>,
    /// The label in which walks inside end; `None` when no walk does.
    pub inside: Option<u32>,
    /// The same of walks outside.
    pub outside: Option<u32>,
    /// Labels in use: all are below this.
    pub count: u32,
}

impl Labels {
    /// Whether a point is in the solid: every leaf is passed, as a stencil buffer would.
    pub fn contains(&self, mut inside: impl FnMut(u32) -> bool) -> bool {
        let mut next = 0;
        for s in &self.switches {
            if next == s.name {
                next = if inside(s.primitive) != s.negative { s.when_in } else { s.when_out };
            }
        }
        Some(next) == self.inside
    }
}

/// Labels by the thing they name: a leaf, or an end.
struct Pool {
    of: Vec<Option<u32>>,
    free: BinaryHeap<Reverse<u32>>,
    count: u32,
}

impl Pool {
    fn of(&mut self, target: u32) -> u32 {
        *self.of[target as usize].get_or_insert_with(|| match self.free.pop() {
            Some(Reverse(label)) => label,
            None => {
                self.count += 1;
                self.count - 1
            }
        })
    }

    fn release(&mut self, target: u32) {
        if let Some(label) = self.of[target as usize].take() {
            self.free.push(Reverse(label));
        }
    }
}

impl Blist {
    /// Gives labels to the exits, the lowest free one each.
    ///
    /// A list without entries walks nowhere: its one label is `inside` when it means everything.
    pub fn labels(&self, convention: Convention) -> Labels {
        let outside = self.outside();
        let mut pool = Pool { of: vec![None; outside as usize + 2], free: BinaryHeap::new(), count: 0 };
        if outside == 0 {
            let end = |inside: bool| ((self.start() == 1) == inside).then_some(0);
            return Labels { switches: Vec::new(), inside: end(true), outside: end(false), count: 1 };
        }
        if convention == Convention::FromStart {
            pool.of(outside + 1);
            pool.of(outside);
        }
        let mut switches = Vec::with_capacity(outside as usize);
        for (i, entry) in (0..).zip(self.entries()) {
            // nothing carries a label before the first leaf, so its name is free
            let name = if i == 0 { 0 } else { pool.of(i) };
            pool.release(i);
            let (t, f) = entry.exits(i);
            let (when_in, when_out) = (pool.of(t), pool.of(f));
            switches.push(Switch { primitive: entry.primitive(), negative: entry.negative(), name, when_in, when_out });
        }
        let [outside, inside] = [pool.of[outside as usize], pool.of[outside as usize + 1]];
        Labels { switches, inside, outside, count: pool.count }
    }
}

/// Costs by context: index `t + 2 f`.
type Costs = [u32; 4];

fn context(t: u32, f: u32) -> usize {
    (t + 2 * f) as usize
}

/// Cost of `first` before `second` under `op`.
fn cost(op: Op, first: &Costs, second: &Costs, t: u32, f: u32) -> u32 {
    match op {
        Op::Union => (f + first[context(t, 0)]).max(second[context(1, f)]),
        _ => (t + first[context(0, f)]).max(second[context(t, 1)]),
    }
}

impl Tree {
    /// The same positive form with the children of each node in the order that needs the fewest labels.
    /// Exact, in linear time.
    ///
    /// # Panics
    /// When the tree is not [positive](Tree::is_positive).
    pub fn with_fewest_labels(&self, convention: Convention) -> Self {
        assert!(self.is_positive(), "labels belong to positive forms");
        let nodes = self.nodes();
        let mut costs: Vec<Costs> = Vec::with_capacity(nodes.len());
        for node in nodes {
            costs.push(match *node {
                Node::Pair(op, a, b) => std::array::from_fn(|c| {
                    let (t, f) = (c as u32 & 1, c as u32 >> 1);
                    let (a, b) = (&costs[a as usize], &costs[b as usize]);
                    cost(op, a, b, t, f).min(cost(op, b, a, t, f))
                }),
                Node::Complement(a) => costs[a as usize],
                _ => [2; 4],
            });
        }
        let live = u32::from(convention == Convention::FromStart);
        let mut contexts = vec![(live, live); nodes.len()];
        let mut swap = vec![false; nodes.len()];
        for (i, node) in nodes.iter().enumerate().rev() {
            let Node::Pair(op, a, b) = *node else { continue };
            let (t, f) = contexts[i];
            let (l, r) = (&costs[a as usize], &costs[b as usize]);
            swap[i] = cost(op, r, l, t, f) < cost(op, l, r, t, f);
            let (first, second) = if swap[i] { (b, a) } else { (a, b) };
            let (before, after) = if op == Op::Union { ((t, 0), (1, f)) } else { ((0, f), (t, 1)) };
            (contexts[first as usize], contexts[second as usize]) = (before, after);
        }
        self.swapped(|i| swap[i as usize])
    }

    /// The same tree with the taller child of each union and intersection first: a rule of thumb that often
    /// saves labels.
    pub fn with_taller_first(&self) -> Self {
        let heights = self.heights();
        let taller = |a: u32, b: u32| heights[b as usize] > heights[a as usize];
        self.swapped(|i| matches!(self.nodes()[i as usize], Node::Pair(_, a, b) if taller(a, b)))
    }

    /// The same tree with the children of some unions, intersections and symmetric differences swapped.
    fn swapped(&self, swap: impl Fn(u32) -> bool) -> Self {
        let mut b = super::tree::Builder::new();
        for (i, node) in (0..).zip(self.nodes()) {
            b.push(match *node {
                Node::Pair(op, l, r) if op != Op::Difference && swap(i) => Node::Pair(op, r, l),
                node => node,
            });
        }
        b.finish(self.root()).expect("as large as before")
    }
}
