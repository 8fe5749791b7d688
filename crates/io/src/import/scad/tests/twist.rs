//! Extrusions that turn, against the meshes that OpenSCAD 2021.01 writes of the same texts.

use super::import;
use crate::model::{Mesh, Shape};
use std::sync::Arc;

/// `openscad -o x.stl`: vertices, and the volume within the six digits of the file's numbers.
const SIX_DIGITS: f64 = 2e-5;

fn meshes(text: &str) -> Vec<Arc<Mesh>> {
    let of = |shape: &Shape| if let Shape::Mesh(mesh) = shape { mesh.clone() } else { panic!("{shape:?}") };
    import(text).model.solids[0].primitives().iter().map(|p| of(&p.shape)).collect()
}

fn volume(mesh: &Mesh) -> f64 {
    let six_times = |k: usize| {
        let [a, b, c] = mesh.corners(k);
        a.dot(b.cross(c))
    };
    (0..mesh.triangles().len()).map(six_times).sum::<f64>() / 6.0
}

/// Of `linear_extrude(arguments) { shape }`: the first mesh less the others.
fn same(arguments: &str, shape: &str, vertices: usize, expected: f64) {
    let text = format!("linear_extrude({arguments}) {{ {shape} }}");
    let all = meshes(&text);
    assert_eq!(all.iter().map(|m| m.positions().len()).sum::<usize>(), vertices, "{text}");
    let sum: f64 = all.iter().enumerate().map(|(i, m)| if i == 0 { volume(m) } else { -volume(m) }).sum();
    assert!((sum - expected).abs() < SIX_DIGITS * expected, "{text}: {sum}, not {expected}");
    for mesh in all {
        let mut balance = std::collections::HashMap::new();
        for t in mesh.triangles() {
            for k in 0..3 {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                *balance.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
            }
        }
        assert!(balance.values().all(|n| *n == 0) && volume(&mesh) > 0.0, "{text}: open, or inside out");
    }
}

#[test]
fn slices_and_facets_are_openscads() {
    let plate = "square(size = [20, 10], center = true);";
    let fine = "height = 20, $fn = 0, $fa = 1, $fs = 5";
    same("height = 20, twist = 90, $fn = 0, $fa = 12, $fs = 2", plate, 36, 4299.52419);
    same(&format!("{fine}, twist = 300"), plate, 56, 4546.58804);
    same(&format!("{fine}, twist = 300, scale = [0.5, 0.5]"), plate, 44, 2714.69344);
    same(&format!("{fine}, twist = 300, scale = [2, 2]"), plate, 44, 10858.79264);
    same(&format!("{fine}, twist = -300, scale = [0, 0]"), plate, 33, 1575.84110);
    same("height = 20, scale = [0.5, 1.5], $fn = 0, $fa = 1, $fs = 0.7", plate, 124, 3666.66664);
    same("height = 20, twist = 60, scale = [0.5, 1.5], $fn = 30", plate, 24, 4030.80112);
    let circle = "multmatrix([[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { circle(r = 4); }";
    same("height = 20, center = true, twist = -100", circle, 130, 975.88930);
}

/// An outline that is not convex is its hull less a pocket, and the pocket's lid is an edge of the hull: the three
/// corners of the pocket stand twice. One with a hole has eight corners a ring, as there.
#[test]
fn pockets_and_holes_are_cut_from_the_same_slices() {
    let bent = "polygon(points = [[0, 0], [4, 0], [4, 4], [2, 1]], paths = undef);";
    same("height = 9, twist = 200, slices = 12", bent, 13 * (3 + 3), 58.40630);
    let frame = "polygon(points = [[-4, -4], [4, -4], [4, 4], [-4, 4], [-1, -1], [1, -1], [1, 1], [-1, 1]], \
                 paths = [[0, 1, 2, 3], [4, 5, 6, 7]]);";
    same("height = 9, twist = 50, $fn = 0, $fa = 12, $fs = 2", frame, 48, 568.52194);
}
