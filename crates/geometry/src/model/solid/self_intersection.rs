//! Whether a closed mesh bounds each part of space once: it does not cross itself, and nested shells are oriented
//! alternately inwards and outwards.
//!
//! ```text
//!    ┌──────────┐       ┌─────╲ ╱─────┐      ┌───┐  ┌───┐
//!    │ ┌──────┐ │       │  1   ╳   -1 │      │ 1 │  │-1 │       winding numbers: 0 and 1 alone
//!    │1│  0   │ │       └─────╱ ╲─────┘      └───┘  └───┘
//!    │ └──────┘ │
//!    └──────────┘
//!    yes                no: crosses itself   no: inside out
//! ```
//!
//! *Then the first triangle that a ray from outside meets faces it, and no ray leaves the mesh before it has entered
//! it.*
//!
//! An edge passes through a triangle with which it shares no corner if the triangle's plane separates its ends, and its
//! line passes the triangle's sides on the same side. The signs of volumes of tetrahedra decide this, each with a bound
//! of its rounding; a sign within the bound counts as crossing. Edges in the triangle's plane need no test: if they
//! cross it, other edges pass through. Triangles with an edge in common meet there only, unless they lie back to back,
//! which `super::orientation` tests.

use super::nearby::Nearby;
use crate::math::orientation::orientation;
use crate::model::{Bounds, Mesh};
use glam::DVec3;
use rayon::prelude::*;

/// Triangles tested for nested shells, for each triangle of the mesh; beyond, the mesh counts as badly nested.
const WORK_EACH: usize = 64;
/// The rounding of a volume, of the sum of its absolute products. Source: J. R. Shewchuk, *Adaptive Precision
/// Floating-Point Arithmetic*, 1997, bound A of ORIENT3D: (7 + 56 ε) ε with ε = 2^-53.
const VOLUME_ROUNDING: f64 = (7.0 + 28.0 * f64::EPSILON) * (0.5 * f64::EPSILON);

/// Each edge of `mesh` is there once in each direction.
pub(super) fn bounds_space_once(mesh: &Mesh) -> bool {
    !crosses_itself(mesh) && turns_by_turns(mesh)
}

fn crosses_itself(mesh: &Mesh) -> bool {
    let boxes: Vec<Bounds> = (0..mesh.triangles().len()).map(|t| around(&mesh.corners(t))).collect();
    let nearby = Nearby::new(boxes, 0.0);
    (0..mesh.triangles().len() as u32).into_par_iter().any(|t| {
        let mut crosses = false;
        nearby.before(t, |other| crosses = crosses || meet(mesh, t as usize, other as usize));
        crosses
    })
}

fn around(corners: &[DVec3; 3]) -> Bounds {
    let [a, b, c] = *corners;
    Bounds { min: a.min(b).min(c), max: a.max(b).max(c) }
}

/// Two triangles meet elsewhere than in the corners that they share.
fn meet(mesh: &Mesh, s: usize, t: usize) -> bool {
    let (first, second) = (mesh.triangles()[s], mesh.triangles()[t]);
    let shared = first.iter().filter(|v| second.contains(v)).count();
    if shared >= 2 {
        return false;
    }
    let passes = |edges: usize, other: usize| {
        let (of, to) = (mesh.triangles()[edges], mesh.triangles()[other]);
        let (ends, triangle) = (mesh.corners(edges), mesh.corners(other));
        [(0, 1), (1, 2), (2, 0)]
            .into_iter()
            .filter(|(p, q)| !to.contains(&of[*p]) && !to.contains(&of[*q]))
            .any(|(p, q)| passes_through(ends[p], ends[q], &triangle))
    };
    passes(s, t) || passes(t, s)
}

/// The edge from p to q passes through the triangle, or may touch it.
fn passes_through(p: DVec3, q: DVec3, &[a, b, c]: &[DVec3; 3]) -> bool {
    let (of_p, of_q) = (side(a, b, c, p), side(a, b, c, q));
    if of_p == of_q {
        return false; // beside the plane, or in it
    }
    let sides = [side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)];
    !(sides.contains(&1) && sides.contains(&-1))
}

/// The sign of the volume of a, b, c, p; 0 where rounding may have turned it.
fn side(a: DVec3, b: DVec3, c: DVec3, p: DVec3) -> i8 {
    let (a, b, c) = (a - p, b - p, c - p);
    let size = |x: DVec3, y: DVec3| (x.y * y.z).abs() + (x.z * y.y).abs();
    let volume = a.dot(b.cross(c));
    let bound = a.x.abs() * size(b, c) + b.x.abs() * size(c, a) + c.x.abs() * size(a, b);
    if volume.abs() <= VOLUME_ROUNDING * bound { 0 } else { volume.signum() as i8 }
}

/// Every outermost shell is oriented outwards, each shell directly inside it inwards, and so on; shells do not cross.
fn turns_by_turns(mesh: &Mesh) -> bool {
    let shells = shells(mesh);
    let mut work = WORK_EACH * mesh.triangles().len();
    shells.iter().enumerate().all(|(k, shell)| {
        let p = mesh.corners(shell.triangles[0]).iter().sum::<DVec3>() / 3.0;
        let mut around = 0;
        for (other, of) in shells.iter().enumerate() {
            let beside = p.cmplt(of.bounds.min).any() || p.cmpgt(of.bounds.max).any();
            if other == k || beside {
                continue;
            }
            let (Some(rest), Some(turns)) = (work.checked_sub(of.triangles.len()), of.winding(mesh, p)) else {
                return false;
            };
            work = rest;
            around += turns;
        }
        if shell.volume > 0.0 { around == 0 } else { shell.volume < 0.0 && around == 1 }
    })
}

/// Triangles connected by edges.
struct Shell {
    triangles: Vec<usize>,
    bounds: Bounds,
    /// Six times the volume.
    volume: f64,
}

fn shells(mesh: &Mesh) -> Vec<Shell> {
    let mut edges: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * mesh.triangles().len());
    for (t, &[a, b, c]) in (0..).zip(mesh.triangles()) {
        edges.extend([(a, b), (b, c), (c, a)].map(|(from, to)| (from.min(to), from.max(to), t)));
    }
    edges.sort_unstable();
    let mut parents: Vec<u32> = (0..mesh.triangles().len() as u32).collect();
    for two in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let (s, t) = (root(&mut parents, two[0].2), root(&mut parents, two[two.len() - 1].2));
        parents[s.max(t) as usize] = s.min(t);
    }
    let middle = mesh.bounds().centre();
    let mut number = vec![usize::MAX; parents.len()];
    let mut shells: Vec<Shell> = Vec::new();
    for t in 0..parents.len() {
        let first = root(&mut parents, t as u32) as usize;
        if number[first] == usize::MAX {
            number[first] = shells.len();
            shells.push(Shell { triangles: Vec::new(), bounds: Bounds::EMPTY, volume: 0.0 });
        }
        let (shell, corners) = (&mut shells[number[first]], mesh.corners(t));
        let [a, b, c] = corners.map(|p| p - middle);
        shell.triangles.push(t);
        shell.bounds = shell.bounds.union(around(&corners));
        shell.volume += a.dot(b.cross(c));
    }
    shells
}

/// The first triangle of those connected with `t`; shortens the way there.
fn root(parents: &mut [u32], mut t: u32) -> u32 {
    while parents[t as usize] != t {
        parents[t as usize] = parents[parents[t as usize] as usize];
        t = parents[t as usize];
    }
    t
}

impl Shell {
    /// How often the shell goes around p: the line upwards leaves it so many times more than it enters it. `None` where
    /// p may lie on it.
    fn winding(&self, mesh: &Mesh, p: DVec3) -> Option<i32> {
        let mut sum = 0;
        for corners in self.triangles.iter().map(|t| mesh.corners(*t)) {
            let turns = turns(&corners, p);
            if turns == 0 {
                continue;
            }
            // a, b, c turn left seen from above where turns is 1: p is below where the volume is positive
            let [a, b, c] = corners;
            match side(a, b, c, p) {
                0 => return None,
                below if i32::from(below) == turns => sum += turns,
                _ => {}
            }
        }
        Some(sum)
    }
}

/// How often the triangle, seen from above, goes around p. An edge counts when it passes p's height, bottom included and
/// top excluded, on the right: the same for both triangles at an edge.
fn turns(corners: &[DVec3; 3], p: DVec3) -> i32 {
    let q = p.truncate();
    let flat = corners.map(DVec3::truncate);
    let mut sum = 0;
    for (from, to) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (flat[i], flat[j])) {
        let up = to.y > from.y;
        let (low, high) = if up { (from, to) } else { (to, from) };
        if low.y <= q.y && q.y < high.y && orientation(low, high, q) > 0.0 {
            sum += if up { 1 } else { -1 };
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box; inside out where `inwards`.
    fn block(low: [f64; 3], high: [f64; 3], inwards: bool) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let corners = (0..8).map(|i| DVec3::from([0, 1, 2].map(|k| if i >> k & 1 == 0 { low[k] } else { high[k] })));
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let turn = |[a, b, c]: [u32; 3]| if inwards { [a, c, b] } else { [a, b, c] };
        let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(turn);
        (corners.collect(), triangles.collect())
    }

    fn is_one(parts: &[(Vec<DVec3>, Vec<[u32; 3]>)]) -> bool {
        let (mut corners, mut triangles) = (Vec::new(), Vec::new());
        for (of, sides) in parts {
            let first = corners.len() as u32;
            corners.extend(of);
            triangles.extend(sides.iter().map(|t| t.map(|v| v + first)));
        }
        bounds_space_once(&Mesh::new(1, corners, triangles, Vec::new()).unwrap())
    }

    #[test]
    fn shells_in_shells_turn_by_turns() {
        let cube = |r: f64, inwards| block([-r; 3], [r; 3], inwards);
        let beside = |inwards| block([5.0, 0.0, 0.0], [6.0, 1.0, 1.0], inwards);
        assert!(is_one(&[cube(3.0, false)]));
        assert!(!is_one(&[cube(3.0, true)]));
        assert!(is_one(&[cube(3.0, false), cube(2.0, true)]));
        assert!(is_one(&[cube(2.0, true), cube(1.0, false), cube(3.0, false)]));
        assert!(!is_one(&[cube(3.0, false), cube(2.0, false)]));
        assert!(!is_one(&[cube(3.0, false), cube(2.0, true), cube(1.0, true)]));
        assert!(is_one(&[cube(3.0, false), beside(false)]));
        assert!(!is_one(&[cube(3.0, false), beside(true)]));
        // many pores
        let pores = (0..100).map(|k| block([f64::from(k), 1.0, 1.0], [f64::from(k) + 0.5, 2.0, 2.0], true));
        let many: Vec<_> = [block([-1.0; 3], [101.0, 3.0, 3.0], false)].into_iter().chain(pores).collect();
        assert!(is_one(&many));
    }

    #[test]
    fn what_crosses_or_touches_is_found() {
        let cube = block([0.0; 3], [2.0; 3], false);
        let with = |low, high| is_one(&[cube.clone(), block(low, high, false)]);
        assert!(with([2.1, 0.0, 0.0], [3.0; 3]));
        assert!(!with([1.0; 3], [3.0; 3]));
        assert!(!with([0.5, 0.5, -1.0], [1.5, 1.5, 3.0]));
        // corners and edges that touch
        assert!(!with([2.0; 3], [3.0; 3]));
        assert!(!with([2.0, 2.0, -1.0], [3.0, 3.0, 3.0]));
        assert!(!with([2.0, 0.5, 0.5], [3.0, 1.0, 1.0]));
    }

    /// A prism over a polygon; its flat ends are fans around their middles.
    fn prism(polygon: &[[f64; 2]]) -> bool {
        let n = polygon.len() as u32;
        let ends = [0.0, 1.0].map(|z| polygon.iter().map(move |p| DVec3::new(p[0], p[1], z)));
        let corners: Vec<DVec3> = ends.into_iter().flatten().chain([DVec3::ZERO, DVec3::Z]).collect();
        let sides = (0..n).flat_map(|i| {
            let j = (i + 1) % n;
            [[i, j, n + j], [i, n + j, n + i], [j, i, 2 * n], [n + i, n + j, 2 * n + 1]]
        });
        is_one(&[(corners, sides.collect())])
    }

    #[test]
    fn bow_ties_cross() {
        assert!(prism(&[[1.0, 0.0], [0.2, 0.3], [-1.0, 0.0], [-0.2, -0.3]]));
        assert!(!prism(&[[3.0, 1.0], [-1.0, -1.0], [-1.0, 1.0], [3.0, -1.0]]));
        // twice around
        assert!(!prism(&[[1.0, 0.0], [-0.8, 0.6], [0.3, -1.0], [0.3, 1.0], [-0.8, -0.6]]));
    }
}
