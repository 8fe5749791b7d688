//! Boolean solids whose operands have no equations: meshes and spline parts.

use super::solids::{Named, at, ball, block, moved, post, primitive, ring, solid, turned};
use super::{CUBE_HALF, ball_mesh, block_mesh, cube, sphere, tetra, torus, torus_mesh};
use glam::{DAffine3, DMat3, DVec3};
use selvedge::model::{Mesh, Model, Primitive, Shape};
use std::sync::Arc;

/// A mesh as an operand.
pub fn mesh(mesh: Mesh) -> Primitive {
    primitive(Shape::Mesh(Arc::new(mesh)), DAffine3::IDENTITY)
}

/// The first part of a model as an operand.
pub fn part(mut model: Model) -> Primitive {
    primitive(Shape::Part(Arc::new(model.parts.remove(0))), DAffine3::IDENTITY)
}

fn box_mesh(low: [f64; 3], high: [f64; 3]) -> Primitive {
    mesh(block_mesh(low.into(), high.into(), 1))
}

/// A mesh with reversed triangles.
fn inverted(m: &Mesh) -> Mesh {
    let triangles = m.triangles().iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    Mesh::new(1, m.positions().to_vec(), triangles, vec![]).unwrap()
}

/// Closed meshes.
pub fn meshes() -> Vec<Named> {
    let wide = || block([-2.0, -2.0, 0.0], [2.0, 2.0, 1.0]);
    let rock = || mesh(torus_mesh(40));
    let squeezed = DMat3::from_rotation_z(0.7) * DMat3::from_diagonal(DVec3::new(-1.0, 0.6, 1.3));
    vec![
        ("a mesh", solid("A", vec![mesh(ball_mesh(2))])),
        ("a ripple less a ball", solid("A-B", vec![rock(), ball(1.4, 3.0)])),
        ("a ball less a ripple", solid("B-A", vec![rock(), ball(3.5, 0.0)])),
        ("a mesh and a mesh", solid("AB", vec![mesh(ball_mesh(2)), moved(at(0.8, 0.3, 0.0), mesh(ball_mesh(3)))])),
        ("a mesh less a mesh", solid("A-B", vec![mesh(ball_mesh(3)), moved(at(0.8, 0.3, 0.4), mesh(ball_mesh(2)))])),
        ("a mesh twice", solid("A^B", vec![mesh(ball_mesh(2)), block([-0.5; 3], [2.0; 3])])),
        ("a mirrored mesh", {
            let tetra = Shape::Part(Arc::new(tetra().parts.remove(0)));
            solid("A-B", vec![primitive(tetra, DAffine3::from_mat3(squeezed)), ball(0.5, 0.5)])
        }),
        // faces that coincide
        ("a mesh through a block", solid("A-B", vec![wide(), box_mesh([-1.0, -1.0, 0.0], [1.0, 1.0, 1.0])])),
        (
            "a block through a mesh",
            solid("B-A", vec![block([-1.0, -1.0, 0.0], [1.0; 3]), box_mesh([-2.0, -2.0, 0.0], [2.0, 2.0, 1.0])]),
        ),
        (
            "a mesh beside a block",
            solid("A+B", vec![block([0.0; 3], [1.0; 3]), box_mesh([1.0, 0.0, 0.0], [2.0, 1.0, 1.0])]),
        ),
        ("a mesh pocket", solid("A-B", vec![wide(), box_mesh([-1.0, -1.0, 0.5], [1.0, 1.0, 1.0])])),
        ("turned together", {
            let m = turned(0.3, 0.7, 1.1) * at(3.0, 2.0, 1.0);
            let hole = moved(m, box_mesh([-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]));
            solid("A-B+C", vec![moved(m, wide()), hole, moved(m, post(0.4, 0.0, 1.0))])
        }),
        // transforms
        (
            "a mesh at 1e6",
            solid(
                "A-B",
                vec![moved(at(1e6, -1e6, 1e6), mesh(ball_mesh(2))), moved(at(1e6, -1e6, 1e6), ball(0.7, 0.6))],
            ),
        ),
    ]
}

/// Closed spline parts.
pub fn splines() -> Vec<Named> {
    let c = CUBE_HALF;
    vec![
        ("a spline sphere", solid("A", vec![part(sphere())])),
        (
            "a spline torus less a post",
            solid("A-B", vec![part(torus()), moved(at(3.0, 0.0, 0.0), post(0.6, -4.0, 8.0))]),
        ),
        ("a block less a spline torus", solid("B-A", vec![part(torus()), block([-4.0, -4.0, -4.0], [4.0, 0.0, 0.0])])),
        ("a trimmed cube", solid("A", vec![part(cube())])),
        ("a trimmed cube less a ball", solid("A-B", vec![part(cube()), ball(1.2 * c, c)])),
        (
            "a ball less a trimmed cube",
            solid("B-A", vec![moved(turned(0.3, 0.5, 0.2), part(cube())), ball(1.5 * c, 0.3)]),
        ),
        ("a trimmed cube in a sphere", solid("AB", vec![part(cube()), moved(at(0.2, 0.1, 0.3), part(sphere()))])),
        ("a spline torus and a ring", solid("A+B", vec![part(torus()), moved(turned(1.5, 0.0, 0.0), ring(3.0, 0.5))])),
    ]
}

/// Meshes that are not clean boundaries, and still bound something.
pub fn unclean() -> Vec<Named> {
    let with = |m: &Mesh, more: Vec<[u32; 3]>| {
        Mesh::new(1, m.positions().to_vec(), [m.triangles().to_vec(), more].concat(), vec![]).unwrap()
    };
    let cut = || ball(0.8, 0.7);
    let round = ball_mesh(2);
    let doubled = with(&round, round.triangles().to_vec());
    let flat = with(&round, vec![[0, 0, 1], [0, 1, 1], [5, 5, 5]]);
    // two balls in one mesh that intersect each other
    let beside = Mesh::new(
        1,
        round.positions().iter().copied().chain(round.positions().iter().map(|p| *p + DVec3::X)).collect(),
        (0..2 * round.positions().len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
        vec![],
    );
    // a box whose top is two triangles and a third vertex on the diagonal, which only one of them has
    let plain = block_mesh(DVec3::splat(-1.0), DVec3::ONE, 1);
    let mut corners = plain.positions().to_vec();
    corners.push(DVec3::Z);
    let (middle, top) = (8, |t: &[u32; 3]| t.iter().all(|v| *v >= 4));
    let mut triangles: Vec<[u32; 3]> = plain.triangles().iter().filter(|t| !top(t)).copied().collect();
    triangles.extend([[4, 5, middle], [5, 7, middle], [4, 7, 6]]);
    let t_junction = Mesh::new(1, corners, triangles, vec![]).unwrap();
    vec![
        ("inverted", solid("A-B", vec![mesh(inverted(&round)), cut()])),
        ("an inverted one taken away", solid("B-A", vec![mesh(inverted(&round)), cut()])),
        ("duplicated", solid("A-B", vec![mesh(doubled), cut()])),
        ("triangles without area", solid("A-B", vec![mesh(flat), cut()])),
        ("one that intersects itself", solid("A-B", vec![mesh(beside.unwrap()), cut()])),
        ("a T-junction", solid("A-B", vec![mesh(t_junction), moved(at(0.0, 0.0, 1.0), ball(0.6, 0.0))])),
    ]
}

/// Closed, outward-oriented meshes with one faulty part: one whose smaller end is drawn through itself, and one with a
/// smaller box beside it.
pub fn partly_inside_out() -> Vec<Named> {
    let whole = block_mesh(DVec3::new(-2.0, -1.0, -1.0), DVec3::new(2.0, 1.0, 1.0), 1);
    let drawn = |p: &DVec3| {
        let y = if p.x > 0.0 { -0.6 * p.y } else { p.y };
        DVec3::new(p.x + 0.2 * y * p.z, y, p.z + 0.1 * p.x * p.y)
    };
    let crossed = Mesh::new(1, whole.positions().iter().map(drawn).collect(), whole.triangles().to_vec(), vec![]);
    let other = block_mesh(DVec3::new(3.0, -0.5, -0.4), DVec3::new(4.0, 0.6, 0.5), 1);
    let corners = whole.positions().iter().chain(other.positions()).copied().collect();
    let turned = other.triangles().iter().map(|&[a, b, c]| [8 + a, 8 + c, 8 + b]);
    let beside = Mesh::new(1, corners, whole.triangles().iter().copied().chain(turned).collect(), vec![]);
    let far = || moved(at(0.0, 5.0, 0.0), ball(0.5, 0.0));
    vec![
        ("crossed", solid("A+B", vec![mesh(crossed.unwrap()), far()])),
        ("beside", solid("A+B", vec![mesh(beside.unwrap()), far()])),
    ]
}

/// A ball of triangles without some of them.
pub fn open_mesh() -> Model {
    let round = ball_mesh(2);
    let triangles = round.triangles()[..round.triangles().len() - 6].to_vec();
    let open = Mesh::new(1, round.positions().to_vec(), triangles, vec![]).unwrap();
    solid("A+B", vec![mesh(open), ball(0.3, 2.0)])
}

/// A comb of `n` walls, one mesh: a ray along them crosses `2 n` triangles.
pub fn comb(n: u32) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..n {
        let x = f64::from(i) / f64::from(n);
        let wall = block_mesh(DVec3::new(x, 0.0, 0.0), DVec3::new(x + 0.5 / f64::from(n), 1.0, 1.0), 1);
        let first = positions.len() as u32;
        positions.extend_from_slice(wall.positions());
        triangles.extend(wall.triangles().iter().map(|t| t.map(|v| first + v)));
    }
    Mesh::new(1, positions, triangles, vec![]).unwrap()
}

/// A mesh less a torus, mirrored and squeezed.
pub fn squeezed_torus() -> Model {
    let squeezed = DMat3::from_rotation_z(0.7) * DMat3::from_diagonal(DVec3::new(-1.0, 0.6, 1.3));
    let round = moved(DAffine3::from_scale(DVec3::splat(3.0)), mesh(ball_mesh(3)));
    solid("B-A", vec![moved(DAffine3::from_mat3(squeezed), part(torus())), round])
}
