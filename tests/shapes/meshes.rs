//! Named meshes. The vertices of a mesh that approximates a closed form lie on it.

use super::{cube, cylinder, one, placed, plate, sphere};
use glam::{DAffine3, DMat3, DVec3};
use selvedge::model::{Mesh, Model, Part};
use std::f64::consts::TAU;

/// One tetrahedron around the origin.
pub fn tetra() -> Model {
    whole_mesh("tetra", tetra_mesh(1))
}

/// The tetrahedron twice: unchanged, and mirrored, turned and squeezed, in another colour.
pub fn facets() -> Model {
    let mut model = tetra();
    let squeezed = DMat3::from_rotation_z(0.7) * DMat3::from_diagonal(DVec3::new(-1.0, 0.6, 1.3));
    let beside = DAffine3::from_mat3_translation(squeezed, DVec3::new(2.2, 0.9, 0.1));
    model.instances = vec![placed(DAffine3::IDENTITY, None), placed(beside, Some([0.1, 0.4, 0.8, 1.0]))];
    model
}

/// The trimmed cylinder, and a mesh cube that cuts into it.
pub fn beside() -> Model {
    with_meshes(cylinder(), vec![block_mesh(DVec3::new(0.4, -1.6, 1.5), DVec3::new(2.0, 1.7, 1.1), 7)])
}

/// The whole sphere, and a mesh cube that cuts into it: no trims.
pub fn globe() -> Model {
    with_meshes(sphere(), vec![block_mesh(DVec3::new(0.4, -4.0, 0.5), DVec3::new(2.0, 1.7, 2.1), 7)])
}

/// The spline cube and, beside it, the plate with its hole, over a coarse and before a fine mesh.
pub fn floor() -> Model {
    let mut model = cube();
    let (mut shell, turned) = (plate(), DAffine3::from_rotation_x(0.4));
    shell.parts[0].faces[0].id = 20;
    model.parts.append(&mut shell.parts);
    let beside = DAffine3::from_translation(DVec3::new(-4.5, 1.0, 0.5)) * turned;
    model.instances.push(selvedge::model::Instance { part: 1, ..placed(beside, None) });
    let wall =
        Mesh::new(31, grid(90, |u, v| DVec3::new(14.0 * u - 10.0, 5.0 + u * v, 8.0 * v - 2.5)), cells(90), vec![]);
    with_meshes(model, vec![block_mesh(DVec3::new(-9.0, -4.0, -1.5), DVec3::new(4.0, 5.0, -1.0), 30), wall.unwrap()])
}

/// A coarse ball of radius 1 whose normals are the sphere's.
pub fn ball() -> Model {
    whole_mesh("ball", ball_mesh(2))
}

/// Everything of a model, and meshes in a part of their own. Only a lone mesh's part is closed.
fn with_meshes(mut model: Model, meshes: Vec<Mesh>) -> Model {
    model.parts.push(Part { name: "meshes".to_owned(), meshes, ..Part::default() });
    let part = model.parts.len() - 1;
    model.instances.push(selvedge::model::Instance { part, ..placed(DAffine3::IDENTITY, None) });
    model
}

/// A model of one closed mesh.
pub fn whole_mesh(name: &str, mesh: Mesh) -> Model {
    let mut model = one(name, true, Vec::new());
    model.parts[0].meshes.push(mesh);
    model
}

fn tetra_mesh(id: u32) -> Mesh {
    let corners = [(1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0)];
    let triangles = vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
    Mesh::new(id, corners.map(DVec3::from).to_vec(), triangles, vec![]).expect("a tetrahedron")
}

/// A box between two corners: eight vertices, twelve triangles.
pub fn block_mesh(low: DVec3, high: DVec3, id: u32) -> Mesh {
    let pick = |i: usize, axis: usize| if i >> axis & 1 == 0 { low[axis] } else { high[axis] };
    let corners = (0..8).map(|i| DVec3::new(pick(i, 0), pick(i, 1), pick(i, 2)));
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh::new(id, corners.collect(), triangles, vec![]).expect("a box")
}

/// The octahedron with each triangle cut into four, `levels` times, and the vertices moved to the unit
/// sphere; its normals are the sphere's.
pub fn ball_mesh(levels: u32) -> Mesh {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let mut corners: Vec<[DVec3; 3]> = (0..8)
        .map(|octant: usize| {
            let [x, y, z] = [0, 1, 2].map(|i| if octant >> i & 1 == 0 { axes[i] } else { -axes[i] });
            if octant.count_ones().is_multiple_of(2) { [x, y, z] } else { [x, z, y] }
        })
        .collect();
    for _ in 0..levels {
        let quarters = |&[a, b, c]: &[DVec3; 3]| {
            // the sum does not depend on the order, so neighbours agree bit for bit
            let [ab, bc, ca] = [(a + b).normalize(), (b + c).normalize(), (c + a).normalize()];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        corners = corners.iter().flat_map(quarters).collect();
    }
    let triangles = (0..corners.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    Mesh::new(1, corners.concat(), triangles, corners.clone()).expect("a ball")
}

/// A closed torus of `2 n^2` triangles with ripples; radii 3 and 1.
pub fn torus_mesh(n: u32) -> Mesh {
    let vertex = |i: u32, j: u32| {
        let ((su, cu), (sv, cv)) =
            ((TAU * f64::from(i) / f64::from(n)).sin_cos(), (TAU * f64::from(j) / f64::from(n)).sin_cos());
        let tube = 1.0 + 0.02 * (40.0 * TAU * f64::from(i) / f64::from(n)).sin();
        DVec3::new((3.0 + tube * cv) * cu, (3.0 + tube * cv) * su, tube * sv)
    };
    let positions = (0..n).flat_map(|j| (0..n).map(move |i| vertex(i, j)));
    let at = |i: u32, j: u32| j % n * n + i % n;
    let cell = |i: u32, j: u32| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    let triangles = (0..n).flat_map(|j| (0..n).flat_map(move |i| cell(i, j)));
    Mesh::new(1, positions.collect(), triangles.collect(), vec![]).expect("a torus")
}

/// `(n + 1)^2` points over the unit square.
fn grid(n: u32, at: impl Fn(f64, f64) -> DVec3) -> Vec<DVec3> {
    let t = |k: u32| f64::from(k) / f64::from(n);
    (0..=n).flat_map(|j| (0..=n).map(move |i| (i, j))).map(|(i, j)| at(t(i), t(j))).collect()
}

/// The triangles between them.
fn cells(n: u32) -> Vec<[u32; 3]> {
    let at = |i: u32, j: u32| j * (n + 1) + i;
    let cell = |i: u32, j: u32| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    (0..n).flat_map(|j| (0..n).flat_map(move |i| cell(i, j))).collect()
}
