//! The edges of a bound in an order and in directions that make a loop.
//!
//! ```text
//!   listed  a─▶b  c─▶d  b─▶c  a─▶d          sorted  a─▶b  b─▶c  c─▶d  d─▶a
//! ```
//!
//! An order that joins up within the tolerance is left alone: a loop may pass a vertex twice, and only the list says in
//! which order.

use super::edge::EdgeCurve;
use glam::DVec3;

/// Edges of a loop that are sorted at most: the cost is their square.
const MOST: usize = 4096;

/// Sorts edges, and turns each one around that does not begin where the one before ends, but ends there. Vertices
/// within `50 eps` mm meet. True when half of the edges or more were turned: the loop's direction is then unknown.
pub(super) fn sort(edges: Vec<EdgeCurve>, face: u32, eps: f64, notes: &mut Vec<String>) -> (Vec<EdgeCurve>, bool) {
    let edges = match sorted(&edges, eps) {
        Some(order) => {
            notes.push(format!("face #{face}: the edges of a loop were put in order"));
            order.into_iter().map(|i| edges[i].clone()).collect()
        }
        None => edges,
    };
    directed(edges, face, eps, notes)
}

fn near(p: DVec3, q: DVec3, eps: f64) -> bool {
    p.distance(q) <= 50.0 * eps
}

/// An order that joins up, where the given one does not and such an order is found: from the first edge always on to
/// the nearest edge that begins, or else ends, where the last one ended.
fn sorted(edges: &[EdgeCurve], eps: f64) -> Option<Vec<usize>> {
    let n = edges.len();
    let touch = |a: &EdgeCurve, b: &EdgeCurve| a.vertices.iter().any(|p| b.vertices.iter().any(|q| near(*p, *q, eps)));
    if !(3..=MOST).contains(&n) || (0..n).all(|i| touch(&edges[i], &edges[(i + 1) % n])) {
        return None;
    }
    let mut order = vec![0];
    let mut free: Vec<usize> = (1..n).collect();
    let mut end = edges[0].vertices[1];
    while !free.is_empty() {
        let reach = |side: usize| {
            let distance = |k: &usize| edges[free[*k]].vertices[side].distance(end);
            let best = (0..free.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
            (distance(&best) <= 50.0 * eps).then_some((best, edges[free[best]].vertices[1 - side]))
        };
        let (next, onward) = reach(0).or_else(|| reach(1))?;
        order.push(free.swap_remove(next));
        end = onward;
    }
    near(end, edges[0].vertices[0], eps).then_some(order)
}

fn directed(edges: Vec<EdgeCurve>, face: u32, eps: f64, notes: &mut Vec<String>) -> (Vec<EdgeCurve>, bool) {
    let near = |p: DVec3, q: DVec3| near(p, q, eps);
    let flip = |e: EdgeCurve| {
        let [a, b] = e.vertices;
        let (t0, t1) = (e.curve.reversed_parameter(e.t1), e.curve.reversed_parameter(e.t0));
        let used = (e.used.0, !e.used.1);
        EdgeCurve { curve: e.curve.reversed(), used, t0, t1, vertices: [b, a], ..e }
    };
    let mut out: Vec<EdgeCurve> = Vec::with_capacity(edges.len());
    let count = edges.len();
    let mut turned = 0;
    for e in edges {
        if e.turned {
            notes.push(format!("face #{face}: edge #{} runs against its stated sense", e.id));
        }
        let mut e = e;
        let alone = out.len() == 1 && count > 1;
        if let Some(last) = out.last_mut() {
            let fits = |end: DVec3, e: &EdgeCurve| near(end, e.vertices[0]) || near(end, e.vertices[1]);
            if alone && !fits(last.vertices[1], &e) && fits(last.vertices[0], &e) {
                notes.push(format!("face #{face}: edge #{} was turned around in its loop", last.id));
                *last = flip(last.clone());
                turned += 1;
            }
            if !near(last.vertices[1], e.vertices[0]) && near(last.vertices[1], e.vertices[1]) {
                notes.push(format!("face #{face}: edge #{} was turned around in its loop", e.id));
                e = flip(e);
                turned += 1;
            }
        }
        out.push(e);
    }
    (out, turned > 0 && 2 * turned >= count)
}
