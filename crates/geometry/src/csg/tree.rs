//! Boolean expressions as flat arrays: no recursion anywhere, so no depth is too deep.
//!
//! ```text
//!   (A+B)-CD      postfix:   0 A   1 B   2 0+1   3 C   4 D   5 3*4   6 2-5
//!       -                    └── subtree of 2 ─┘ └── subtree of 5 ─┘
//!     ╱   ╲                  children stand before parents, each subtree is one range,
//!    +     *                 leaves from left to right are leaves in ascending order, the root is last
//!   ╱ ╲   ╱ ╲
//!  A   B C   D
//! ```
//!
//! [`Builder`] takes nodes in any order and may share them; [`Builder::finish`] makes the [`Tree`].

#[cfg(feature = "serde")]
use serde::Deserialize;

/// A Boolean operation on two solids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Op {
    /// `L+R`: in either.
    Union,
    /// `L*R`: in both.
    Intersection,
    /// `L-R`: in the first and not in the second.
    Difference,
    /// `L^R`: in exactly one.
    SymmetricDifference,
}

impl Op {
    /// The operation on truth values.
    pub fn apply(self, left: bool, right: bool) -> bool {
        match self {
            Self::Union => left || right,
            Self::Intersection => left && right,
            Self::Difference => left && !right,
            Self::SymmetricDifference => left != right,
        }
    }
}

/// One node; children are indices of nodes that stand before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Node {
    /// No point (`false`) or every point (`true`).
    Constant(bool),
    /// A primitive, by its index in the solid's list.
    Leaf(u32),
    /// The complement of its child.
    Complement(u32),
    /// Left and right child under an operation.
    Pair(Op, u32, u32),
}

/// Why nodes are not a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[allow(missing_docs)]
#[non_exhaustive]
pub enum TreeError {
    #[error("the solid needs more than {} nodes once its symmetric differences are written out", Tree::MOST_NODES)]
    TooLarge,
    #[error("a node names node {0}, which does not stand before it")]
    Child(u32),
}

/// Nodes of expressions under construction. Nodes may be shared, and left unused.
#[derive(Clone, Debug, Default)]
pub struct Builder {
    nodes: Vec<Node>,
}

impl Builder {
    /// An empty one.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a node and returns its index.
    pub fn push(&mut self, node: Node) -> u32 {
        let index = u32::try_from(self.nodes.len()).expect("fewer than 2^32 nodes");
        self.nodes.push(node);
        index
    }

    /// The node of an index.
    pub fn node(&self, index: u32) -> Node {
        self.nodes[index as usize]
    }

    /// A primitive.
    pub fn leaf(&mut self, primitive: u32) -> u32 {
        self.push(Node::Leaf(primitive))
    }

    /// `!a`, with `!0 = 1`, `!1 = 0` and `!!a = a` applied.
    pub fn complement(&mut self, a: u32) -> u32 {
        match self.node(a) {
            Node::Constant(value) => self.push(Node::Constant(!value)),
            Node::Complement(inner) => inner,
            _ => self.push(Node::Complement(a)),
        }
    }

    /// `a op b`, with constants applied: `a+0 = a`, `a*0 = 0` and so on.
    pub fn pair(&mut self, op: Op, a: u32, b: u32) -> u32 {
        let constant = |node| if let Node::Constant(value) = node { Some(value) } else { None };
        let (left, right) = (constant(self.node(a)), constant(self.node(b)));
        match (op, left, right) {
            (_, Some(x), Some(y)) => self.push(Node::Constant(op.apply(x, y))),
            (Op::Union, Some(true), _) | (Op::Intersection, Some(false), _) | (Op::Difference, Some(false), _) => a,
            (Op::Union, _, Some(true)) | (Op::Intersection, _, Some(false)) => b,
            (Op::Union | Op::SymmetricDifference, Some(false), _) | (Op::Intersection, Some(true), _) => b,
            (Op::Union | Op::SymmetricDifference | Op::Difference, _, Some(false))
            | (Op::Intersection, _, Some(true)) => a,
            (Op::Difference, _, Some(true)) => self.push(Node::Constant(false)),
            (Op::Difference | Op::SymmetricDifference, Some(true), _) => self.complement(b),
            (Op::SymmetricDifference, _, Some(true)) => self.complement(a),
            (_, None, None) => self.push(Node::Pair(op, a, b)),
        }
    }

    /// `a op b op c …` from the left; for an empty list the constant `0`, or `1` for an intersection.
    pub fn fold(&mut self, op: Op, all: impl IntoIterator<Item = u32>) -> u32 {
        let mut all = all.into_iter();
        let Some(first) = all.next() else { return self.push(Node::Constant(op == Op::Intersection)) };
        all.fold(first, |a, b| self.pair(op, a, b))
    }

    /// Copies `tree`, each leaf converted by `leaf`, and returns the new place of each of its nodes.
    pub(super) fn copy(&mut self, tree: &Tree, mut leaf: impl FnMut(&mut Self, u32) -> u32) -> Vec<u32> {
        let mut map: Vec<u32> = Vec::with_capacity(tree.nodes.len());
        for node in &tree.nodes {
            let new = match *node {
                Node::Constant(_) => self.push(*node),
                Node::Leaf(p) => leaf(self, p),
                Node::Complement(a) => self.complement(map[a as usize]),
                Node::Pair(op, a, b) => self.pair(op, map[a as usize], map[b as usize]),
            };
            map.push(new);
        }
        map
    }

    /// The tree below `root`; shared nodes are written out once for each use.
    ///
    /// # Errors
    /// [`TreeError`] when that makes more than [`Tree::MOST_NODES`] nodes, or a child does not stand
    /// before its parent.
    pub fn finish(&self, root: u32) -> Result<Tree, TreeError> {
        let sizes = self.sizes(root)?;
        if sizes[root as usize] > u64::from(Tree::MOST_NODES) {
            return Err(TreeError::TooLarge);
        }
        let mut nodes = Vec::with_capacity(sizes[root as usize] as usize);
        let mut open = vec![(root, false)];
        let mut done: Vec<u32> = Vec::new(); // roots of finished subtrees that wait for their parents
        while let Some((index, visited)) = open.pop() {
            let node = match (self.node(index), visited) {
                (Node::Complement(a), false) => {
                    open.extend([(index, true), (a, false)]);
                    continue;
                }
                (Node::Pair(_, a, b), false) => {
                    open.extend([(index, true), (b, false), (a, false)]);
                    continue;
                }
                (Node::Complement(_), true) => Node::Complement(done.pop().expect("its child is done")),
                (Node::Pair(op, ..), true) => {
                    let b = done.pop().expect("its right child is done");
                    Node::Pair(op, done.pop().expect("its left child is done"), b)
                }
                (leaf, _) => leaf,
            };
            done.push(nodes.len() as u32);
            nodes.push(node);
        }
        Ok(Tree { nodes })
    }

    /// Nodes below each node, itself included, shared ones counted for each use; saturating.
    fn sizes(&self, root: u32) -> Result<Vec<u64>, TreeError> {
        let mut sizes: Vec<u64> = Vec::with_capacity(root as usize + 1);
        for node in &self.nodes[..=root as usize] {
            let of = |child: u32| sizes.get(child as usize).copied().ok_or(TreeError::Child(child));
            let size = match *node {
                Node::Constant(_) | Node::Leaf(_) => 1,
                Node::Complement(a) => of(a)?.saturating_add(1),
                Node::Pair(_, a, b) => of(a)?.saturating_add(of(b)?).saturating_add(1),
            };
            sizes.push(size);
        }
        Ok(sizes)
    }
}

/// A Boolean expression in postfix order; see the module's figure. Every node has one parent but the
/// last, which has none.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "TreeData"))]
pub struct Tree {
    nodes: Vec<Node>,
}

/// A tree before its nodes are checked.
#[cfg(feature = "serde")]
#[derive(Deserialize)]
struct TreeData {
    nodes: Vec<Node>,
}

#[cfg(feature = "serde")]
impl TryFrom<TreeData> for Tree {
    type Error = TreeError;

    /// A tree whose children stand before their parents is the input of a [`Builder`], which sorts it.
    fn try_from(data: TreeData) -> Result<Self, TreeError> {
        match data.nodes.len() as u64 {
            0 => Ok(Self::constant(false)),
            n if n > u64::from(Self::MOST_NODES) => Err(TreeError::TooLarge),
            n => Builder { nodes: data.nodes }.finish(n as u32 - 1),
        }
    }
}

impl Tree {
    /// Nodes that a tree may have: as many take 1 GiB.
    pub const MOST_NODES: u32 = 1 << 26;

    /// No point, or every point.
    pub fn constant(value: bool) -> Self {
        Self { nodes: vec![Node::Constant(value)] }
    }

    /// One primitive.
    pub fn leaf(primitive: u32) -> Self {
        Self { nodes: vec![Node::Leaf(primitive)] }
    }

    /// The nodes in postfix order, at least one.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Index of the root: the last node.
    pub fn root(&self) -> u32 {
        self.nodes.len() as u32 - 1
    }

    /// Primitives of the leaves from left to right; repeated ones repeatedly.
    pub fn leaves(&self) -> impl Iterator<Item = u32> + '_ {
        self.nodes.iter().filter_map(|n| if let Node::Leaf(p) = n { Some(*p) } else { None })
    }

    /// The value when the whole is a constant.
    pub fn as_constant(&self) -> Option<bool> {
        if let [Node::Constant(value)] = self.nodes[..] { Some(value) } else { None }
    }

    /// Whether a point is in the solid, for `inside(primitive)`; linear in the nodes.
    pub fn contains(&self, mut inside: impl FnMut(u32) -> bool) -> bool {
        let mut values: Vec<bool> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let value = match *node {
                Node::Constant(value) => value,
                Node::Leaf(p) => inside(p),
                Node::Complement(a) => !values[a as usize],
                Node::Pair(op, a, b) => op.apply(values[a as usize], values[b as usize]),
            };
            values.push(value);
        }
        values[values.len() - 1]
    }

    /// Parent of each node; the root is its own.
    pub fn parents(&self) -> Vec<u32> {
        let mut parents = vec![self.root(); self.nodes.len()];
        for (i, node) in self.nodes.iter().enumerate() {
            match *node {
                Node::Complement(a) => parents[a as usize] = i as u32,
                Node::Pair(_, a, b) => (parents[a as usize], parents[b as usize]) = (i as u32, i as u32),
                _ => {}
            }
        }
        parents
    }

    /// Height of each node: 0 for a leaf.
    pub fn heights(&self) -> Vec<u32> {
        let mut heights: Vec<u32> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            heights.push(match *node {
                Node::Complement(a) => 1 + heights[a as usize],
                Node::Pair(_, a, b) => 1 + heights[a as usize].max(heights[b as usize]),
                _ => 0,
            });
        }
        heights
    }

    /// The tree with known primitives replaced by their value and constants evaluated. `known(primitive)` says that a
    /// primitive is absent (`Some(false)`), everywhere (`Some(true)`), or neither.
    pub fn fold(&self, mut known: impl FnMut(u32) -> Option<bool>) -> Self {
        let mut b = Builder::new();
        let map = b.copy(self, |b, p| match known(p) {
            Some(value) => b.push(Node::Constant(value)),
            None => b.leaf(p),
        });
        b.finish(map[self.nodes.len() - 1]).expect("no larger than before")
    }
}
