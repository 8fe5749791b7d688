//! Convex hulls of points.
//!
//! ```text
//!        p                  the facets that p sees go; each edge between a facet that stays and one
//!       ╱ ╲                 that goes makes a new facet with p
//!   ───a   b───  ▶  a──p──b
//! ```
//!
//! Exact predicates decide which facets a point sees, so the removed facets are always one patch with one edge around
//! it. A point within [`FLAT`] of the hull so far does not move it: it counts as lying in a facet.
//!
//! Sources: C. B. Barber, D. P. Dobkin, H. Huhdanpaa, *The Quickhull Algorithm for Convex Hulls*, 1996; predicates of
//! J. R. Shewchuk, 1997.

use glam::{DVec2, DVec3};
use robust::{Coord, Coord3D, orient2d, orient3d};
use std::collections::HashMap;

/// Distance from a facet that is rounding, relative to the size.
pub(super) const FLAT: f64 = 1e-10;

/// Corners of the hull, counter-clockwise, without those within its sides; empty where the points lie in a line.
pub(super) fn flat(points: impl IntoIterator<Item = DVec2>) -> Vec<DVec2> {
    let mut points: Vec<DVec2> = points.into_iter().collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let at = |p: DVec2| Coord { x: p.x, y: p.y };
    let half = |points: &mut dyn Iterator<Item = &DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for p in points {
            while chain.len() > 1 && orient2d(at(chain[chain.len() - 2]), at(chain[chain.len() - 1]), at(*p)) <= 0.0 {
                chain.pop();
            }
            chain.push(*p);
        }
        chain.pop();
        chain
    };
    let mut all = half(&mut points.iter());
    all.extend(half(&mut points.iter().rev()));
    if all.len() < 3 { Vec::new() } else { all }
}

/// A triangle of the hull, counter-clockwise from outside.
struct Facet {
    corners: [u32; 3],
    /// The facet beyond the edge from corner `k` to the next.
    beyond: [u32; 3],
    normal: DVec3,
    offset: f64,
    /// So narrow that the normal is rounding.
    thin: bool,
    /// Points that lie outside of it, each listed by one facet.
    outside: Vec<u32>,
    gone: bool,
}

/// The corners of the hull and its triangles, counter-clockwise from outside; `None` where the points lie in a plane.
pub(super) fn solid(points: &[DVec3]) -> Option<(Vec<DVec3>, Vec<[u32; 3]>)> {
    let mut hull = Hull::new(points)?;
    let mut waiting: Vec<u32> = (0..4).collect();
    while let Some(f) = waiting.pop() {
        if !hull.facets[f as usize].gone
            && let Some(p) = hull.farthest(f)
        {
            waiting.extend(hull.insert(f, p)?);
        }
    }
    let mut numbers: HashMap<u32, u32> = HashMap::new();
    let mut corners = Vec::new();
    let mut number = |p: u32| {
        *numbers.entry(p).or_insert_with(|| {
            corners.push(points[p as usize]);
            corners.len() as u32 - 1
        })
    };
    let triangles = hull.facets.iter().filter(|f| !f.gone).map(|f| f.corners.map(&mut number)).collect();
    Some((corners, triangles))
}

struct Hull<'a> {
    points: &'a [DVec3],
    facets: Vec<Facet>,
    /// Distance that counts as none.
    flat: f64,
}

impl<'a> Hull<'a> {
    /// A tetrahedron of points that lie far apart.
    fn new(points: &'a [DVec3]) -> Option<Self> {
        let farthest = |distance: &dyn Fn(DVec3) -> f64| {
            let far = |i: &u32| distance(points[*i as usize]);
            (0..points.len() as u32).max_by(|i, j| far(i).total_cmp(&far(j)))
        };
        let first = farthest(&|p| -p.x)?;
        let a = points[first as usize];
        let second = farthest(&|p| p.distance_squared(a))?;
        let along = (points[second as usize] - a).try_normalize()?;
        let third = farthest(&|p| (p - a).cross(along).length_squared())?;
        let normal = along.cross(points[third as usize] - a).try_normalize()?;
        let fourth = farthest(&|p| (p - a).dot(normal).abs())?;
        let size = points[second as usize].distance(a);
        let flat = FLAT * size;
        let thin = (points[third as usize] - a).cross(along).length() <= flat;
        if thin || (points[fourth as usize] - a).dot(normal).abs() <= flat {
            return None;
        }
        let mut hull = Self { points, facets: Vec::new(), flat };
        let [i, j, k, l] = if hull.sees(fourth, [first, second, third]) {
            [first, third, second, fourth]
        } else {
            [first, second, third, fourth]
        };
        for (corners, beyond) in
            [([i, j, k], [1, 2, 3]), ([j, i, l], [0, 3, 2]), ([k, j, l], [0, 1, 3]), ([i, k, l], [0, 2, 1])]
        {
            let facet = hull.facet(corners, beyond);
            hull.facets.push(facet);
        }
        let all: Vec<u32> = (0..points.len() as u32).collect();
        hull.share(all, &[0, 1, 2, 3]);
        Some(hull)
    }

    fn facet(&self, corners: [u32; 3], beyond: [u32; 3]) -> Facet {
        let [a, b, c] = corners.map(|i| self.points[i as usize]);
        let across = (b - a).cross(c - a);
        let normal = across.normalize_or_zero();
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        let thin = across.length() <= 1e5 * self.flat * longest;
        Facet { corners, beyond, normal, offset: normal.dot(a), thin, outside: Vec::new(), gone: false }
    }

    /// Whether the point lies strictly on the side from which the corners run counter-clockwise.
    fn sees(&self, p: u32, corners: [u32; 3]) -> bool {
        let at = |i: u32| {
            let [x, y, z] = self.points[i as usize].to_array();
            Coord3D { x, y, z }
        };
        let [a, b, c] = corners.map(at);
        orient3d(a, b, c, at(p)) < 0.0
    }

    /// Gives each point to the first facet outside of which it lies.
    fn share(&mut self, points: Vec<u32>, facets: &[u32]) {
        for p in points {
            let at = self.points[p as usize];
            let outside = |f: &&u32| {
                let facet = &self.facets[**f as usize];
                if facet.thin { self.sees(p, facet.corners) } else { facet.normal.dot(at) - facet.offset > self.flat }
            };
            if let Some(f) = facets.iter().find(outside) {
                self.facets[*f as usize].outside.push(p);
            }
        }
    }

    /// The point farthest outside of a facet, which it sees.
    fn farthest(&self, f: u32) -> Option<u32> {
        let facet = &self.facets[f as usize];
        let height = |p: &u32| facet.normal.dot(self.points[*p as usize]);
        let p = facet.outside.iter().copied().max_by(|p, q| height(p).total_cmp(&height(q)))?;
        self.sees(p, facet.corners).then_some(p)
    }

    /// The hull with one more point, which `seen` sees; the new facets.
    fn insert(&mut self, seen: u32, p: u32) -> Option<Vec<u32>> {
        let mut gone = vec![seen];
        self.facets[seen as usize].gone = true;
        let mut edges: HashMap<u32, (u32, u32)> = HashMap::new(); // from: to, the facet beyond
        let mut next = 0;
        while let Some(&f) = gone.get(next) {
            next += 1;
            for k in 0..3 {
                let (from, to) = (self.facets[f as usize].corners[k], self.facets[f as usize].corners[(k + 1) % 3]);
                let beyond = self.facets[f as usize].beyond[k];
                if self.facets[beyond as usize].gone {
                    continue;
                }
                if self.sees(p, self.facets[beyond as usize].corners) {
                    self.facets[beyond as usize].gone = true;
                    gone.push(beyond);
                } else {
                    edges.insert(from, (to, beyond));
                }
            }
        }
        // a facet that went after its edge was listed
        edges.retain(|_, (_, beyond)| !self.facets[*beyond as usize].gone);
        let first = self.facets.len() as u32;
        let (&start, _) = edges.iter().min()?;
        let (mut from, mut made) = (start, Vec::new());
        loop {
            let (to, beyond) = edges.remove(&from)?;
            let at = first + made.len() as u32;
            let facet = self.facet([from, to, p], [beyond, at + 1, at.wrapping_sub(1)]);
            self.facets.push(facet);
            let other = &mut self.facets[beyond as usize];
            let k = (0..3).find(|k| other.corners[*k] == to && other.corners[(k + 1) % 3] == from)?;
            other.beyond[k] = at;
            made.push(at);
            from = to;
            if from == start {
                break;
            }
        }
        if !edges.is_empty() {
            return None; // one edge runs around what went
        }
        let last = *made.last()?;
        self.facets[first as usize].beyond[2] = last;
        self.facets[last as usize].beyond[1] = first;
        let left: Vec<u32> = gone
            .iter()
            .flat_map(|f| std::mem::take(&mut self.facets[*f as usize].outside))
            .filter(|q| *q != p)
            .collect();
        self.share(left, &made);
        Some(made)
    }
}
