//! A bounding volume hierarchy: visits the boxes that a ray may meet, nearest first.
//!
//! Binary, built from the top by the surface area heuristic over [`BINS`] bins an axis; the boxes of
//! a leaf are a range of one permutation. Source: I. Wald, *On fast construction of SAH-based bounding
//! volume hierarchies*, IEEE Symposium on Interactive Ray Tracing 2007.

use crate::model::Bounds;
use glam::DVec3;

/// Candidate splits an axis; more gains under 1 % of traversal time.
const BINS: usize = 16;
/// Items a leaf may hold: a box test costs about a fifth of an item's own first test.
const LEAF: usize = 2;
/// Levels of a traversal's stack: `log(2^24) / log(8 / 7)` is 125.
const DEPTH: usize = 128;

/// Intersects a ray with boxes, for a direction given by its reciprocal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slabs {
    origin: DVec3,
    inverse: DVec3,
}

impl Slabs {
    pub fn new(origin: DVec3, direction: DVec3) -> Self {
        Self { origin, inverse: direction.recip() }
    }

    /// Entry and exit parameters; the box is missed when entry exceeds exit. A ray that runs exactly in
    /// a side of the box (`0 ∞`, not a number) may miss it: sides are padding, away from the contents.
    fn range(&self, b: &Bounds) -> (f64, f64) {
        let (s, e) = ((b.min - self.origin) * self.inverse, (b.max - self.origin) * self.inverse);
        let enter = s.x.min(e.x).max(s.y.min(e.y)).max(s.z.min(e.z));
        let exit = s.x.max(e.x).min(s.y.max(e.y)).min(s.z.max(e.z));
        (enter, exit)
    }
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Bounds,
    /// First item of a leaf; the second child of an inner node, whose first child follows it.
    start: u32,
    /// Items of a leaf; 0 for an inner node.
    count: u32,
}

/// The tree.
#[derive(Debug, Default)]
pub(super) struct Bvh {
    nodes: Vec<Node>,
    items: Vec<(u32, Bounds)>,
}

impl Bvh {
    /// Over `boxes`, each padded by `pad`; empty boxes are left out.
    pub fn new(boxes: &[Bounds], pad: f64) -> Self {
        let padded = |b: &Bounds| Bounds { min: b.min - pad, max: b.max + pad };
        let mut items: Vec<(u32, Bounds)> =
            boxes.iter().enumerate().filter(|(_, b)| !b.is_empty()).map(|(i, b)| (i as u32, padded(b))).collect();
        let mut nodes = Vec::with_capacity(items.len());
        if !items.is_empty() {
            build(&mut nodes, &mut items, 0);
        }
        Self { nodes, items }
    }

    /// Box of everything.
    pub fn bounds(&self) -> Bounds {
        self.nodes.first().map_or(Bounds::EMPTY, |n| n.bounds)
    }

    /// Calls `visit(item)` for items whose box the ray meets between `range.0` and `range.1`. `visit` returns the new
    /// end of the range, so that a hit hides everything behind it.
    pub fn visit(&self, ray: &Slabs, range: (f64, f64), mut visit: impl FnMut(u32) -> f64) {
        let (start, mut end) = range;
        let mut stack = [(0u32, f64::NEG_INFINITY); DEPTH];
        let mut top = 0;
        let meets = |b: &Bounds, end: f64| {
            let (enter, exit) = ray.range(b);
            (enter <= exit && exit >= start && enter <= end).then_some(enter)
        };
        if let Some(root) = self.nodes.first()
            && let Some(enter) = meets(&root.bounds, end)
        {
            stack[0] = (0, enter);
            top = 1;
        }
        while top > 0 {
            top -= 1;
            let (index, enter) = stack[top];
            if enter > end {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count > 0 {
                for (item, bounds) in &self.items[node.start as usize..(node.start + node.count) as usize] {
                    if node.count == 1 || meets(bounds, end).is_some() {
                        end = visit(*item);
                    }
                }
                continue;
            }
            let children = [index + 1, node.start];
            let enters = children.map(|c| meets(&self.nodes[c as usize].bounds, end));
            let far_first = match enters {
                [Some(a), Some(b)] if a <= b => [1, 0],
                _ => [0, 1],
            };
            for k in far_first {
                if let Some(enter) = enters[k] {
                    stack[top] = (children[k], enter);
                    top += 1;
                }
            }
        }
    }
}

fn area(b: &Bounds) -> f64 {
    let d = (b.max - b.min).max(DVec3::ZERO);
    d.x * d.y + d.y * d.z + d.z * d.x
}

/// Appends the nodes over `items`, whose first has index `start` among all.
fn build(nodes: &mut Vec<Node>, items: &mut [(u32, Bounds)], start: usize) {
    let bounds = items.iter().fold(Bounds::EMPTY, |b, i| b.union(i.1));
    let index = nodes.len();
    nodes.push(Node { bounds, start: start as u32, count: items.len() as u32 });
    if items.len() <= LEAF {
        return;
    }
    let middle = split(items);
    let (low, high) = items.split_at_mut(middle);
    build(nodes, low, start);
    nodes[index].start = nodes.len() as u32;
    nodes[index].count = 0;
    build(nodes, high, start + middle);
}

/// Reorders `items` about the cheapest split and returns its place, never at an end. Halves them when
/// the heuristic would take off less than an 8th, which keeps the depth of 2^24 items below [`DEPTH`].
fn split(items: &mut [(u32, Bounds)]) -> usize {
    let centres = items.iter().fold(Bounds::EMPTY, |b, i| b.with(i.1.centre()));
    let extent = centres.max - centres.min;
    let mut best = (f64::INFINITY, 0, 0); // cost, axis, first bin of the upper part
    for axis in 0..3 {
        if extent[axis] <= 0.0 {
            continue;
        }
        let mut bins = [(0usize, Bounds::EMPTY); BINS];
        for (_, b) in items.iter() {
            let bin = &mut bins[bin_of(b, axis, &centres)];
            *bin = (bin.0 + 1, bin.1.union(*b));
        }
        let cost = |part: &[(usize, Bounds)]| {
            let (n, b) = part.iter().fold((0, Bounds::EMPTY), |(n, b), p| (n + p.0, b.union(p.1)));
            if n == 0 { f64::INFINITY } else { n as f64 * area(&b) }
        };
        for k in 1..BINS {
            let c = cost(&bins[..k]) + cost(&bins[k..]);
            if c < best.0 {
                best = (c, axis, k);
            }
        }
    }
    let least = (items.len() / 8).max(1);
    if best.0.is_finite() {
        items.sort_by_key(|i| bin_of(&i.1, best.1, &centres) >= best.2);
        let middle = items.partition_point(|i| bin_of(&i.1, best.1, &centres) < best.2);
        if middle >= least && items.len() - middle >= least {
            return middle;
        }
    }
    let axis = if extent.x >= extent.y.max(extent.z) { 0 } else { 1 + usize::from(extent.z > extent.y) };
    items.sort_by(|a, b| a.1.centre()[axis].total_cmp(&b.1.centre()[axis]));
    items.len() / 2
}

fn bin_of(b: &Bounds, axis: usize, centres: &Bounds) -> usize {
    let x = (b.centre()[axis] - centres.min[axis]) / (centres.max[axis] - centres.min[axis]);
    ((x * BINS as f64) as usize).min(BINS - 1)
}
