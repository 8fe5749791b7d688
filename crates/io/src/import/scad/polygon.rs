//! A polygon as differences of convex ones.
//!
//! ```text
//!   ┌─────┐      hull      pocket, whose hull is
//!   │  ┌──┘      ┌────┐    │  ┌──           P = H0 - (H1 - (H2 - ...))
//!   │  └──┐   =  │    │ -  │  └──           each pocket lies between an edge of the hull (its lid) and
//!   └─────┘      └────┘    lid              the part of the outline that leaves the edge
//! ```
//!
//! Source: B. G. Batchelor, *Hierarchical shape description based upon convex hulls of concavities*,
//! Journal of Cybernetics, 1980.

use glam::DVec2;

/// A convex polygon without the pieces in its pockets.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piece {
    /// Counter-clockwise, at least three.
    pub hull: Vec<DVec2>,
    /// The edge from this corner is the hull's edge around it: no test beyond it is needed.
    pub lid: Option<usize>,
    pub pockets: Vec<Piece>,
}

/// Points of one outline: crossings are found by testing each pair of edges.
pub(super) const MOST_POINTS: usize = 2048;
/// Pockets in pockets.
const MOST_DEEP: usize = 48;

/// Cuts an outline; `None` when it encloses nothing.
pub(super) fn cut(points: &[DVec2]) -> Result<Option<Piece>, String> {
    if points.len() > MOST_POINTS {
        return Err(format!("an outline of more than {MOST_POINTS} points"));
    }
    let mut outline: Vec<DVec2> = Vec::with_capacity(points.len());
    for p in points {
        if outline.last() != Some(p) {
            outline.push(*p);
        }
    }
    while outline.len() > 1 && outline.first() == outline.last() {
        outline.pop();
    }
    let area: f64 = (0..outline.len()).map(|i| outline[i].perp_dot(outline[(i + 1) % outline.len()])).sum();
    if outline.len() < 3 {
        return Ok(None);
    }
    // also where its lobes are of one size, so that it has no area
    if crosses(&outline) {
        return Err("an outline that crosses itself".to_owned());
    }
    if area == 0.0 {
        return Ok(None);
    }
    if area < 0.0 {
        outline.reverse();
    }
    piece(&outline, false, 0)
}

/// Twice the area of a triangle: positive when `c` is left of the line from `a` to `b`.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

fn crosses(p: &[DVec2]) -> bool {
    let n = p.len();
    let edge = |i: usize| (p[i], p[(i + 1) % n]);
    (0..n).any(|i| {
        let (a, b) = edge(i);
        (i + 1..n).any(|j| {
            let (c, d) = edge(j);
            turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0
        })
    })
}

/// Corners of the hull by index, counter-clockwise, without those on its edges (A. M. Andrew, 1979).
fn hull(p: &[DVec2]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|a, b| p[*a].x.total_cmp(&p[*b].x).then(p[*a].y.total_cmp(&p[*b].y)));
    let half = |order: &mut dyn Iterator<Item = usize>| {
        let mut chain: Vec<usize> = Vec::new();
        for i in order {
            while chain.len() >= 2 && turn(p[chain[chain.len() - 2]], p[chain[chain.len() - 1]], p[i]) <= 0.0 {
                chain.pop();
            }
            chain.push(i);
        }
        chain.pop();
        chain
    };
    let mut all = half(&mut order.iter().copied());
    all.extend(half(&mut order.iter().rev().copied()));
    all
}

/// A counter-clockwise outline; of a pocket, the edge from its last point to its first is the lid.
fn piece(p: &[DVec2], pocket: bool, depth: usize) -> Result<Option<Piece>, String> {
    if depth > MOST_DEEP {
        return Err(format!("an outline with pockets nested more than {MOST_DEEP} deep"));
    }
    let mut corners = hull(p);
    if corners.len() < 3 {
        return Ok(None);
    }
    // start with the smallest index: along a simple outline the others ascend
    let first = (0..corners.len()).min_by_key(|i| corners[*i]).expect("three or more");
    corners.rotate_left(first);
    if !corners.is_sorted() {
        return Err("an outline that touches or crosses itself".to_owned());
    }
    let n = corners.len();
    let lid = (pocket && corners[0] == 0 && corners[n - 1] == p.len() - 1).then_some(n - 1);
    let mut pockets = Vec::new();
    for k in 0..n {
        let (from, to) = (corners[k], corners[(k + 1) % n]);
        let to = if to > from { to } else { to + p.len() };
        if to - from >= 2 && lid != Some(k) {
            let chain: Vec<DVec2> = (from..=to).rev().map(|i| p[i % p.len()]).collect();
            pockets.extend(piece(&chain, true, depth + 1)?);
        }
    }
    Ok(Some(Piece { hull: corners.iter().map(|i| p[*i]).collect(), lid, pockets }))
}

/// Whether the outline holds the point, by parity.
pub(super) fn holds(p: &[DVec2], at: DVec2) -> bool {
    let edges = (0..p.len()).map(|i| (p[i], p[(i + 1) % p.len()]));
    let crossings = edges.filter(|(a, b)| (a.y <= at.y) != (b.y <= at.y) && (turn(*a, *b, at) > 0.0) == (b.y > a.y));
    crossings.count() % 2 == 1
}
