//! Vertices that lie on sides of triangles, where a mesh is closed in space but its triangles do not share their sides.
//!
//! ```text
//!       c                c
//!      ╱ ╲              ╱│╲        p is a vertex of the triangles below a b:
//!     ╱   ╲     ──▶    ╱ │ ╲       the side a b becomes a p and p b
//!    a──p──b          a──p──b
//! ```
//!
//! Only sides without an opposite are divided, at ends of such sides, and only where that closes the mesh.

use super::facets;
use crate::model::Mesh;
use glam::DVec3;
use std::collections::{HashMap, HashSet};

/// Rounds in which sides are divided; each finds a vertex for every side that still is open.
const MOST_ROUNDS: usize = 64;
/// Pairs of a side and a vertex that are compared.
const MOST_PAIRS: usize = 20_000_000;

/// A mesh that is closed once its sides are divided.
pub(super) struct Closed {
    pub mesh: Mesh,
    /// Sides that were divided.
    pub divided: usize,
    /// How far a vertex lay from its side at most.
    pub off: f64,
}

/// Divides sides at vertices no farther off than `reach`; `None` where the mesh is not closed then.
pub(super) fn close(mesh: &Mesh, reach: f64) -> Option<Closed> {
    // vertices are the same when their coordinates are
    let (mut numbers, mut places) = (HashMap::new(), Vec::new());
    let mut number = |p: DVec3| {
        *numbers.entry((p + 0.0).to_array().map(f64::to_bits)).or_insert_with(|| {
            places.push(p);
            places.len() - 1
        })
    };
    let corners = (0..mesh.triangles().len()).map(|t| mesh.corners(t).map(&mut number));
    let flat = |t: &[usize; 3]| t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    let mut triangles: Vec<[usize; 3]> = corners.filter(|t| !flat(t)).collect();
    let (mut divided, mut off, mut pairs) = (0, 0.0_f64, 0);
    for _ in 0..MOST_ROUNDS {
        let open = open_sides(&triangles);
        if open.is_empty() {
            let at = |i: usize| u32::try_from(i).ok();
            let all = triangles.iter().map(|t| Some([at(t[0])?, at(t[1])?, at(t[2])?])).collect::<Option<_>>()?;
            let mesh = Mesh::new(1, places, all, Vec::new()).ok()?;
            return facets::closed([&mesh]).then_some(Closed { mesh, divided, off });
        }
        let mut ends: Vec<usize> = open.iter().flat_map(|(a, b)| [*a, *b]).collect();
        ends.sort_by(|a, b| places[*a].x.total_cmp(&places[*b].x).then(a.cmp(b)));
        ends.dedup();
        let before = divided;
        let mut next = Vec::with_capacity(triangles.len());
        for t in triangles {
            let sides = (0..3).map(|k| [t[k], t[(k + 1) % 3], t[(k + 2) % 3]]);
            let mut found = None;
            for [a, b, c] in sides.filter(|s| open.contains(&(s[0], s[1]))) {
                let (from, to) = (places[a].x.min(places[b].x) - reach, places[a].x.max(places[b].x) + reach);
                let first = ends.partition_point(|p| places[*p].x < from);
                let near = ends[first..].iter().copied().take_while(|p| places[*p].x <= to);
                let near: Vec<usize> = near.filter(|p| ![a, b, c].contains(p)).collect();
                pairs += near.len();
                // the first along the side
                let on =
                    near.into_iter().filter_map(|p| on_side(places[p], [places[a], places[b]], reach).map(|s| (s, p)));
                if let Some(((_, gap), p)) = on.min_by(|x, y| x.0.0.total_cmp(&y.0.0)) {
                    found = Some(([a, b, c], p, gap));
                    break;
                }
            }
            match found {
                Some(([a, b, c], p, gap)) => {
                    next.extend([[a, p, c], [p, b, c]]);
                    divided += 1;
                    off = off.max(gap);
                }
                None => next.push(t),
            }
            if pairs > MOST_PAIRS {
                return None;
            }
        }
        if divided == before {
            return None;
        }
        triangles = next;
    }
    None
}

/// Sides, as they run, that have not as many opposites.
fn open_sides(triangles: &[[usize; 3]]) -> HashSet<(usize, usize)> {
    let mut uses: HashMap<(usize, usize), usize> = HashMap::new();
    for t in triangles {
        for k in 0..3 {
            *uses.entry((t[k], t[(k + 1) % 3])).or_default() += 1;
        }
    }
    let opposites = |&(a, b): &(usize, usize)| uses.get(&(b, a)).copied().unwrap_or(0);
    uses.iter().filter(|(side, count)| opposites(side) != **count).map(|(side, _)| *side).collect()
}

/// Where a point lies along a side, strictly between its ends, and how far from it.
fn on_side(p: DVec3, [a, b]: [DVec3; 2], reach: f64) -> Option<(f64, f64)> {
    let along = b - a;
    let share = (p - a).dot(along) / along.length_squared();
    let gap = p.distance(a + along * share);
    (share > 0.0 && share < 1.0 && gap <= reach).then_some((share, gap))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron whose side from 0 to X is met by a vertex in its middle, `off` beside it: two triangles there.
    fn tetrahedron(off: f64, more: &[[u32; 3]]) -> Mesh {
        let middle = DVec3::new(0.5, 0.0, -off);
        let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, middle];
        let all = [&[[0, 2, 4], [4, 2, 1], [0, 1, 3], [1, 2, 3]], more].concat();
        Mesh::new(1, corners, all, Vec::new()).unwrap()
    }

    #[test]
    fn a_vertex_on_a_side_divides_it() {
        for off in [0.0, 1e-7] {
            let open = tetrahedron(off, &[[2, 0, 3]]);
            assert!(!facets::closed([&open]));
            let Closed { mesh, divided, off: told } = close(&open, 1e-6).expect("closed");
            assert_eq!((mesh.triangles().len(), divided), (6, 1));
            assert!((told - off).abs() < 1e-16, "{told}");
            assert!(mesh.triangles().iter().all(|t| t.iter().all(|v| *v < 5)));
        }
    }

    #[test]
    fn what_is_open_stays_open() {
        // a side is missing; the vertex is too far off; a triangle is there twice
        assert!(close(&tetrahedron(0.0, &[]), 1e-6).is_none());
        assert!(close(&tetrahedron(1e-5, &[[2, 0, 3]]), 1e-6).is_none());
        assert!(close(&tetrahedron(0.0, &[[2, 0, 3], [2, 0, 3]]), 1e-6).is_none());
    }
}
