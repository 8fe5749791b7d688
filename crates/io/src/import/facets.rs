//! Polygons to triangles, and whether triangles enclose a volume: for every format that has facets.
//!
//! ```text
//!   3 ─── 2        3 ─── 2        fan from the first corner, where the polygon is convex;
//!   │     │   ▶    │  ╱  │        else ears (mapbox's earcut), and corners on a straight side,
//!   0 ─── 1        0 ─── 1        which earcut drops, are put back: neighbours share them
//! ```

use crate::model::Mesh;
use glam::{DVec2, DVec3};
use std::collections::HashMap;

/// Corners of a polygon beyond which it is not taken apart: ears can cost the square of them.
pub(super) const MAX_CORNERS: usize = 10_000;

/// Triangles of a polygon, as places in `corners`; they run the way the polygon does.
///
/// Every side of the polygon is a side of one triangle. A polygon without area, or one that crosses itself so that its
/// inside is undefined, becomes a fan. Cost: linear for convex polygons.
pub(super) fn triangulate(corners: &[DVec3]) -> Vec<[u32; 3]> {
    let count = corners.len();
    let fan = || (1..count as u32 - 1).map(|i| [0, i, i + 1]).collect::<Vec<_>>();
    if count <= 3 {
        return if count == 3 { fan() } else { Vec::new() };
    }
    let sides = (1..count - 1).map(|i| (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]));
    let normal: DVec3 = sides.clone().sum();
    let turns = |i: usize| {
        let (a, b, c) = (corners[i], corners[(i + 1) % count], corners[(i + 2) % count]);
        (b - a).cross(c - b).dot(normal)
    };
    // convex: every triangle of the fan and every turn goes the way of the whole
    if normal == DVec3::ZERO || (sides.clone().all(|s| s.dot(normal) > 0.0) && (0..count).all(|i| turns(i) >= 0.0)) {
        return fan();
    }
    let mut ears = Vec::new();
    earcut::Earcut::new().earcut(corners.iter().map(|&p| flat(p, normal)), &[], &mut ears);
    let ears: Vec<[u32; 3]> = ears.chunks_exact(3).map(|t: &[u32]| [t[0], t[1], t[2]]).collect();
    let next: Vec<u32> = (0..count as u32).map(|i| (i + 1) % count as u32).collect();
    let ears = with_dropped(ears, &next);
    if ears.len() == count - 2 { ears } else { fan() }
}

/// Triangles of an outline in the plane, counter-clockwise, with its holes, clockwise: places in the corners of all of
/// them, one after the other. Every side is a side of one triangle where no outline touches another.
#[cfg(feature = "scad-facets")]
pub(super) fn triangulate_flat(outlines: &[Vec<DVec2>]) -> Vec<[u32; 3]> {
    let (mut next, mut holes) = (Vec::new(), Vec::new());
    for outline in outlines {
        let (first, count) = (next.len() as u32, outline.len() as u32);
        holes.push(first);
        next.extend((0..count).map(|i| first + (i + 1) % count));
    }
    let mut ears: Vec<u32> = Vec::new();
    earcut::Earcut::new().earcut(outlines.iter().flatten().map(DVec2::to_array), &holes[1..], &mut ears);
    with_dropped(ears.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(), &next)
}

/// The plane that shows most of the polygon, seen from the side on which it runs counter-clockwise.
fn flat(p: DVec3, normal: DVec3) -> [f64; 2] {
    let size = normal.abs();
    let (q, facing) = if size.z >= size.x && size.z >= size.y {
        (DVec2::new(p.x, p.y), normal.z)
    } else if size.x >= size.y {
        (DVec2::new(p.y, p.z), normal.x)
    } else {
        (DVec2::new(p.z, p.x), normal.y)
    };
    if facing < 0.0 { [-q.x, q.y] } else { [q.x, q.y] }
}

/// Splits the triangles whose side passes over corners that no triangle has; `following`: the next corner of each.
fn with_dropped(triangles: Vec<[u32; 3]>, following: &[u32]) -> Vec<[u32; 3]> {
    let count = following.len();
    let mut used = vec![false; count];
    triangles.iter().flatten().for_each(|&c| used[c as usize] = true);
    let next = |i: u32| following[i as usize];
    let mut all = Vec::with_capacity(count);
    let mut waiting: Vec<_> = triangles;
    waiting.reverse();
    while let Some(triangle) = waiting.pop() {
        let side = (0..3).find_map(|k| {
            let [a, b, c] = [0, 1, 2].map(|i| triangle[(k + i) % 3]);
            let between = next(a);
            // only dropped corners lie between the ends of the side
            let mut at = between;
            while at != b && !used[at as usize] {
                at = next(at);
            }
            (at == b && between != b).then_some((a, between, b, c))
        });
        match side {
            Some((a, between, b, c)) => {
                used[between as usize] = true;
                waiting.extend([[between, b, c], [a, between, c]]);
            }
            None => all.push(triangle),
        }
    }
    all
}

/// The meshes together bound a volume: every side of a triangle has exactly one opposite.
///
/// Vertices are the same when their coordinates are; self-intersection is not tested. A mesh without triangles bounds
/// nothing.
pub(super) fn closed<'m>(meshes: impl IntoIterator<Item = &'m Mesh> + Clone) -> bool {
    let mut numbers = HashMap::new();
    let mut number = |p: DVec3| {
        let next = numbers.len();
        // zero of either sign is one place
        *numbers.entry((p + 0.0).to_array().map(f64::to_bits)).or_insert(next)
    };
    let mut sides: HashMap<(usize, usize), [u32; 2]> = HashMap::new();
    for mesh in meshes {
        for triangle in 0..mesh.triangles().len() {
            let corners = mesh.corners(triangle).map(&mut number);
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                sides.entry((a.min(b), a.max(b))).or_default()[usize::from(a > b)] += 1;
            }
        }
    }
    !sides.is_empty() && sides.values().all(|uses| *uses == [1, 1])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(flat: &[(f64, f64)]) -> Vec<DVec3> {
        // a slanted plane, so that no axis is special
        flat.iter().map(|&(x, y)| DVec3::new(x, y + 0.25 * x, 2.0 * x - y)).collect()
    }

    /// Areas add up with sign, and every side of the polygon is a side of one triangle.
    #[track_caller]
    fn covers(flat: &[(f64, f64)]) {
        let corners = points(flat);
        let triangles = triangulate(&corners);
        assert_eq!(triangles.len(), flat.len() - 2);
        let double = |[a, b, c]: [usize; 3]| {
            let ((ax, ay), (bx, by), (cx, cy)) = (flat[a], flat[b], flat[c]);
            (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        };
        let areas: Vec<f64> = triangles.iter().map(|t| double(t.map(|i| i as usize))).collect();
        let whole: f64 = (1..flat.len() - 1).map(|i| double([0, i, i + 1])).sum();
        assert!((areas.iter().sum::<f64>() - whole).abs() < 1e-12 * whole.abs(), "{areas:?}");
        assert!(areas.iter().all(|a| a * whole >= 0.0), "{areas:?}");
        for i in 0..flat.len() as u32 {
            let side = (i, (i + 1) % flat.len() as u32);
            let uses = triangles.iter().flat_map(|t| (0..3).map(|k| (t[k], t[(k + 1) % 3])));
            assert_eq!(uses.filter(|s| *s == side).count(), 1, "{side:?} in {triangles:?}");
        }
    }

    #[test]
    fn polygons_are_covered_once() {
        covers(&[(0., 0.), (1., 0.), (1., 1.), (0., 1.)]);
        // clockwise
        covers(&[(0., 1.), (1., 1.), (1., 0.), (0., 0.)]);
        // an arrow: the fan from its first corner would leave it
        covers(&[(0., 0.), (4., -2.), (1., 0.), (4., 2.)]);
        // an L, then with corners on its straight sides
        covers(&[(0., 0.), (2., 0.), (2., 1.), (1., 1.), (1., 2.), (0., 2.)]);
        covers(&[
            (0., 0.),
            (1., 0.),
            (2., 0.),
            (2., 1.),
            (1.5, 1.),
            (1.25, 1.),
            (1., 1.),
            (1., 2.),
            (0., 2.),
            (0., 1.),
        ]);
        // a square whose fan has a triangle without area
        covers(&[(0., 0.), (1., 0.), (2., 0.), (2., 2.), (0., 2.)]);
    }

    #[test]
    fn a_comb_is_covered() {
        let teeth = 40;
        let tooth = |i: usize| [(i as f64, 1.0), (i as f64 - 0.25, 0.1), (i as f64 - 0.5, 1.0)];
        let mut comb: Vec<_> = (1..=teeth).rev().flat_map(tooth).collect();
        comb.extend([(0.0, 0.0), (teeth as f64, 0.0)]);
        covers(&comb);
    }

    #[test]
    fn polygons_without_area_keep_their_sides() {
        let line = points(&[(0., 0.), (1., 1.), (2., 2.), (1., 1.)]);
        assert_eq!(triangulate(&line), [[0, 1, 2], [0, 2, 3]]);
        assert!(triangulate(&line[..2]).is_empty());
    }

    #[test]
    fn a_tetrahedron_is_closed_until_a_side_is_missing_turned_or_doubled() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].to_vec();
        let all = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let mesh = |triangles: Vec<[u32; 3]>| Mesh::new(1, corners.clone(), triangles, Vec::new()).unwrap();
        assert!(closed([&mesh(all.clone())]));
        // in two meshes that share no vertex number
        let apart = Mesh::new(2, vec![DVec3::Y, -DVec3::ZERO, DVec3::Z], vec![[0, 1, 2]], Vec::new()).unwrap();
        assert!(closed([&mesh(all[..3].to_vec()), &apart]));
        assert!(!closed([&mesh(all[..3].to_vec())]));
        let turned = [all[..3].to_vec(), vec![[0, 2, 3]]].concat();
        assert!(!closed([&mesh(turned)]));
        let doubled = [all.clone(), vec![[2, 0, 3]]].concat();
        assert!(!closed([&mesh(doubled)]));
        assert!(!closed([&mesh(Vec::new())]));
    }
}
