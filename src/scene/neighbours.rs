//! Which triangles of meshes share sides.
//!
//! ```text
//!       c ───── d     of the side opposite to a: the corner opposite to it beyond, d, as 3 times the triangle + its place
//!      ╱ ╲  2  ╱      there. NO_TRIANGLE where there is none, or more than one
//!     ╱ 1 ╲   ╱
//!    a ─── b          corners are the same where their positions are, bit for bit, within one mesh
//! ```

use crate::abi;
use crate::abi::constants::mesh_walk::NO_TRIANGLE;
use rayon::prelude::*;

/// Of each triangle's corners: what lies beyond the side opposite to it. Meshes have their triangles one after another.
pub(super) fn neighbours(positions: &[[f32; 3]], triangles: &[[u32; 3]], meshes: &[abi::Mesh]) -> Vec<u32> {
    let points = same_points(positions, triangles, meshes);
    let point = |corner: usize| points[triangles[corner / 3][corner % 3] as usize];
    let mut sides: Vec<([u32; 2], u32)> = (0..3 * triangles.len() as u32)
        .into_par_iter()
        .map(|corner| {
            let [a, b] = [1, 2].map(|k| point(corner as usize / 3 * 3 + (corner as usize + k) % 3));
            ([a.min(b), a.max(b)], corner)
        })
        .collect();
    sides.par_sort_unstable();
    let mut beyond = vec![NO_TRIANGLE; 3 * triangles.len()];
    for shared in sides.chunk_by(|(a, _), (b, _)| a == b) {
        if let [([a, b], first), (_, second)] = *shared
            && a != b
        {
            beyond[first as usize] = second;
            beyond[second as usize] = first;
        }
    }
    beyond
}

/// A number for each position: that of the first of its mesh that is the same.
fn same_points(positions: &[[f32; 3]], triangles: &[[u32; 3]], meshes: &[abi::Mesh]) -> Vec<u32> {
    // positions of a mesh follow those of the mesh before
    let starts = meshes.iter().map(|mesh| mesh.first_triangle as usize).chain([triangles.len()]).collect::<Vec<_>>();
    let ends = starts.windows(2).map(|of| triangles[of[0]..of[1]].iter().flatten().max().map_or(0, |last| last + 1));
    let mut mesh_of = vec![0; positions.len()];
    let mut first = 0;
    for (mesh, end) in (0_u32..).zip(ends) {
        let end = (end as usize).max(first);
        mesh_of[first..end].fill(mesh);
        first = end;
    }
    // -0 is 0
    let key = |i: u32| (mesh_of[i as usize], positions[i as usize].map(|x| (x + 0.0).to_bits()));
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.par_sort_unstable_by_key(|&i| (key(i), i));
    let mut points = vec![0; positions.len()];
    for same in order.chunk_by(|&a, &b| key(a) == key(b)) {
        same.iter().for_each(|&i| points[i as usize] = same[0]);
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(first_triangle: u32) -> abi::Mesh {
        abi::Mesh { first_triangle, ..abi::Mesh::default() }
    }

    /// Two triangles that share a side by its positions alone; a third on the same side makes it nobody's.
    #[test]
    fn sides_are_shared_by_two() {
        let [a, b, c, d, e] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]];
        let two = [a, b, c, d, [0.0, 1.0, -0.0], b];
        let of = neighbours(&two, &[[0, 1, 2], [3, 4, 5]], &[mesh(0)]);
        let none = NO_TRIANGLE;
        assert_eq!(of, [3, none, none, 0, none, none]);
        let three = [a, b, c, d, c, b, e];
        let of = neighbours(&three, &[[0, 1, 2], [3, 4, 5], [6, 4, 5]], &[mesh(0)]);
        assert_eq!(of, [none; 9]);
    }

    /// Two meshes in the same place have nothing to do with each other.
    #[test]
    fn a_mesh_ends_where_another_begins() {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let positions = [corners, corners].concat();
        let triangles = [[0, 1, 2], [3, 4, 5]];
        assert_eq!(neighbours(&positions, &triangles, &[mesh(0), mesh(1)]), [NO_TRIANGLE; 6]);
        let same = neighbours(&positions, &triangles, &[mesh(0)]);
        assert_eq!(same, [3, 4, 5, 0, 1, 2]);
    }
}
