//! Creases and borders of triangles.

use glam::DVec3;
use selvedge_geometry::model::{EdgeKind, EdgeLimits, Edges, Mesh, Part};

/// Quads as pairs of triangles, each with corners of its own.
fn quads(corners: &[[DVec3; 4]]) -> Mesh {
    let positions: Vec<DVec3> = corners.iter().flatten().copied().collect();
    let triangles =
        (0..corners.len() as u32).flat_map(|k| [[4 * k, 4 * k + 1, 4 * k + 2], [4 * k, 4 * k + 2, 4 * k + 3]]);
    Mesh::new(1, positions, triangles.collect(), Vec::new()).unwrap()
}

fn edges(meshes: Vec<Mesh>, crease: f64) -> Edges {
    let limits = EdgeLimits { crease: crease.to_radians(), ..EdgeLimits::default() };
    Part { meshes, ..Part::default() }.edges_within(&limits).unwrap()
}

fn cube() -> Vec<[DVec3; 4]> {
    let at = |i: usize| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2 & 1) as f64);
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]].map(|q| q.map(at)).to_vec()
}

#[test]
fn a_cube_of_facets_has_twelve_creases() {
    let found = edges(vec![quads(&cube())], 20.0);
    assert_eq!((found.counts().mesh_creases, found.counts().mesh_borders), (12, 0));
    assert!(
        found.of_meshes.iter().all(|e| e.triangles.len() == 2 && (e.ends[0].distance(e.ends[1]) - 1.0).abs() < 1e-15)
    );
    // the same with a mesh a face
    let apart = cube().iter().map(|q| quads(&[*q])).collect();
    let found = edges(apart, 20.0);
    assert_eq!((found.counts().mesh_creases, found.counts().mesh_borders), (12, 0));
    assert!(found.of_meshes.iter().all(|e| e.triangles[0].0 != e.triangles[1].0));
    // a side less
    let found = edges(vec![quads(&cube()[1..])], 20.0);
    assert_eq!((found.counts().mesh_creases, found.counts().mesh_borders), (8, 4));
}

/// A prism of 24 sides turns by 15 degrees at each, of 12 by 30.
#[test]
fn a_crease_is_an_angle() {
    let prism = |sides: usize| {
        let at = |k: usize, z: f64| {
            let (s, c) = (std::f64::consts::TAU * (k % sides) as f64 / sides as f64).sin_cos();
            DVec3::new(c, s, z)
        };
        let wall = |k: usize| [at(k, 0.0), at(k + 1, 0.0), at(k + 1, 1.0), at(k, 1.0)];
        vec![quads(&(0..sides).map(wall).collect::<Vec<_>>())]
    };
    let counts = |sides: usize, crease: f64| {
        let c = edges(prism(sides), crease).counts();
        (c.mesh_creases, c.mesh_borders)
    };
    assert_eq!(counts(24, 20.0), (0, 48));
    assert_eq!(counts(12, 20.0), (12, 24));
    assert_eq!(counts(12, 31.0), (0, 24));
}

/// Winding does not matter, a third triangle does, and one without area is ignored.
#[test]
fn odd_triangles() {
    let flat = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    let mesh = |triangles: Vec<[u32; 3]>, more: Option<DVec3>| {
        let positions = flat.iter().copied().chain(more).collect();
        vec![Mesh::new(1, positions, triangles, Vec::new()).unwrap()]
    };
    let kinds = |meshes| edges(meshes, 20.0).of_meshes.iter().map(|e| e.kind).collect::<Vec<_>>();
    assert_eq!(kinds(mesh(vec![[0, 1, 2], [0, 3, 2]], None)), [EdgeKind::Border; 4]);
    let three = kinds(mesh(vec![[0, 1, 2], [0, 2, 3], [0, 2, 4]], Some(DVec3::Z)));
    assert_eq!(three.iter().filter(|k| **k == EdgeKind::Sharp).count(), 1);
    assert_eq!(three.len(), 7);
    // the needle along the diagonal lies between the two: neither is a border there
    let needle = kinds(mesh(vec![[0, 1, 2], [0, 2, 3], [0, 4, 2]], Some(DVec3::new(0.5, 0.5, 0.0))));
    assert_eq!(needle, [EdgeKind::Border; 4]);
    // minus zero is zero
    let zero =
        vec![quads(&[flat]), quads(&[[-DVec3::X, DVec3::new(-0.0, -0.0, -0.0), DVec3::Y, DVec3::new(-1.0, 1.0, 0.0)]])];
    assert_eq!(kinds(zero).len(), 6);
}

/// The diagonals of a cube's sides, with the corners across them; with a wider limit its edges, too.
#[test]
fn smooth_sides_are_those_between_creases() {
    let part = Part { meshes: vec![quads(&cube())], ..Part::default() };
    let found = part.smooth_sides(&EdgeLimits::default());
    assert_eq!(found.len(), 6);
    for side in &found {
        let [a, b] = side.ends;
        assert!((a.distance(b) - 2f64.sqrt()).abs() < 1e-15, "{side:?}");
        // the other corners of the square
        assert_eq!(side.beside[0] + side.beside[1], a + b, "{side:?}");
    }
    assert_eq!(part.smooth_sides(&EdgeLimits { crease: 2.0, ..EdgeLimits::default() }).len(), 18);
}
