//! Corners of the convex parts of Boolean solids: blocks that half-spaces cut.
//!
//! ```text
//!        ╱╲ half-spaces      Each plane holds a polygon of the part's surface: a square as large as the block, clipped
//!    ┌──╱──╲──┐ block        by every other plane. The corners of all polygons are those of the part.
//!    │ ╱    ╲ │
//!    └╱──────╲┘              Intersections, and differences of a half-space, make parts. Readers make such blocks
//!                            larger than the part, so that no side of the block is one of the part.
//! ```
//!
//! *Certainty.* A point counts as beyond a plane where it is higher than some roundings of the largest coordinate, so
//! that rounding takes no polygon away. Corners are right to as much over the sine of the smallest angle of a corner.
//!
//! *Cost.* The square of the number of planes.

use crate::csg::{Node, Op};
use crate::model::{Bounds, Primitive, Shape, Solid};
use glam::DVec3;

/// Planes of a part beyond which it has the box of its block.
const MOST_PLANES: usize = 1024;
/// Height above a plane that counts as none, in roundings of the largest coordinate.
const ROUNDINGS: f64 = 16.0;

/// A convex part of a solid.
pub(super) struct Part {
    /// Its node in the tree.
    pub node: usize,
    /// Its corners, each at least three times; none where it is empty.
    pub corners: Vec<DVec3>,
}

/// The parts of a solid that are blocks cut by half-spaces, each as large as possible, in the order of their nodes.
pub(super) fn parts(solid: &Solid) -> Vec<Part> {
    let nodes = solid.tree().nodes();
    let shape = |node: u32| match nodes[node as usize] {
        Node::Leaf(p) => Some(&solid.primitives()[p as usize].shape),
        _ => None,
    };
    let is_half_space = |node: u32| matches!(shape(node), Some(Shape::HalfSpace { .. }));
    // where the leaves of a convex node begin, whether it is within a larger one, and whether a leaf is taken away
    let mut first: Vec<Option<usize>> = Vec::with_capacity(nodes.len());
    let (mut is_within, mut is_taken) = (vec![false; nodes.len()], vec![false; nodes.len()]);
    for (i, node) in nodes.iter().enumerate() {
        let begin = match *node {
            Node::Leaf(_) => {
                matches!(shape(i as u32), Some(Shape::HalfSpace { .. } | Shape::Block { .. })).then_some(i)
            }
            Node::Pair(Op::Intersection, a, b) => first[a as usize].filter(|_| first[b as usize].is_some()),
            Node::Pair(Op::Difference, a, b) => first[a as usize].filter(|_| is_half_space(b)),
            _ => None,
        };
        if let (Node::Pair(op, a, b), true) = (node, begin.is_some()) {
            is_within[*a as usize] = true;
            is_within[*b as usize] = true;
            is_taken[*b as usize] = *op == Op::Difference;
        }
        first.push(begin);
    }
    let whole = first.iter().enumerate().filter(|(node, _)| !is_within[*node]);
    let several = whole.filter_map(|(node, first)| Some((*first)?..=node).filter(|range| range.start() < range.end()));
    let of = |range: std::ops::RangeInclusive<usize>| {
        let node = *range.end();
        let leaves = range.filter_map(|i| match nodes[i] {
            Node::Leaf(p) => Some((&solid.primitives()[p as usize], is_taken[i])),
            _ => None,
        });
        corners(leaves).map(|corners| Part { node, corners })
    };
    several.filter_map(of).collect()
}

/// The corners of the intersection of blocks and half-spaces, or of their complements; `None` without a block, and with
/// too many planes.
fn corners<'p>(leaves: impl Iterator<Item = (&'p Primitive, bool)>) -> Option<Vec<DVec3>> {
    let (mut all, mut within) = (Vec::new(), None);
    for (primitive, is_taken) in leaves {
        let to_own = primitive.to_own()?;
        let mut push = |normal: DVec3, offset: f64| {
            let (normal, offset) = (to_own.matrix3.transpose() * normal, offset - normal.dot(to_own.translation));
            let sign = if is_taken { -1.0 } else { 1.0 };
            all.push((normal * sign / normal.length(), offset * sign / normal.length()));
        };
        match &primitive.shape {
            Shape::HalfSpace { normal, offset } => push(*normal, *offset),
            Shape::Block { min, max } => {
                within = Some(primitive.bounds());
                for axis in DVec3::AXES {
                    push(axis, axis.dot(*max));
                    push(-axis, -axis.dot(*min));
                }
            }
            _ => return None,
        }
        if all.len() > MOST_PLANES {
            return None;
        }
    }
    let within = within.filter(|b| !b.is_empty())?;
    let are_planes = all.iter().all(|(normal, offset)| normal.is_finite() && offset.is_finite());
    are_planes.then(|| between(&all, within))
}

/// The corners of the polygons between planes `normal · x <= offset` of unit normals, whose common part is in a box.
fn between(planes: &[(DVec3, f64)], within: Bounds) -> Vec<DVec3> {
    let (centre, radius) = (within.centre(), 0.5 * within.diagonal());
    let slack = ROUNDINGS * f64::EPSILON * within.min.abs().max(within.max.abs()).max_element();
    let (mut polygon, mut clipped, mut all) = (Vec::new(), Vec::new(), Vec::new());
    for (i, (normal, offset)) in planes.iter().enumerate() {
        let height = offset - normal.dot(centre);
        if height.abs() > radius + slack {
            continue;
        }
        let (u, v) = normal.any_orthonormal_pair();
        // twice as large as the plane's part of the ball around the box
        let (foot, u, v) = (centre + height * *normal, 2.0 * radius * u, 2.0 * radius * v);
        polygon.clear();
        polygon.extend([foot + u + v, foot - u + v, foot - u - v, foot + u - v]);
        for (j, (normal, offset)) in planes.iter().enumerate() {
            if j != i && !polygon.is_empty() {
                clip(&mut polygon, &mut clipped, (*normal, *offset), slack);
            }
        }
        all.extend_from_slice(&polygon);
    }
    all
}

/// Takes away what is beyond a plane by more than `slack`. Source: I. E. Sutherland, G. W. Hodgman, *Reentrant Polygon
/// Clipping*, 1974.
fn clip(polygon: &mut Vec<DVec3>, clipped: &mut Vec<DVec3>, (normal, offset): (DVec3, f64), slack: f64) {
    let height = |p: DVec3| normal.dot(p) - offset;
    if polygon.iter().all(|p| height(*p) <= slack) {
        return;
    }
    clipped.clear();
    for (k, a) in polygon.iter().enumerate() {
        let b = polygon[(k + 1) % polygon.len()];
        let (from, to) = (height(*a), height(b));
        if from <= slack {
            clipped.push(*a);
        }
        if (from <= slack) != (to <= slack) {
            clipped.push(*a + (b - *a) * (from / (from - to)).clamp(0.0, 1.0));
        }
    }
    std::mem::swap(polygon, clipped);
}
