//! Surfaces and their loops, against their formulas.

use super::{import, told};
use crate::spline::Control;
use glam::{DVec2, DVec3};

/// The example of the format's own specification.
const SPEC: &str = include_str!("spec.obj");

/// Quadratic Bernstein polynomials.
fn quadratic(t: f64) -> [f64; 3] {
    [(1.0 - t) * (1.0 - t), 2.0 * t * (1.0 - t), t * t]
}

#[test]
fn the_example_of_the_specification() {
    let read = import(SPEC);
    assert_eq!(told(&read), ["t.obj:36: statement not used: `scrv`, 1 times"]);
    assert_eq!((read.report.faces, read.report.pcurves), (1, 2));
    let face = &read.model.parts[0].faces[0];
    assert_eq!(face.surface.domain(), ((-1.0, 2.5), (-2.0, 2.0)));
    assert_eq!(face.surface.degrees(), (2, 2));

    // one patch: the rational sum over the printed points and weights
    let points = [
        [-1.35, -1.03, 0.0, 1.0],
        [0.13, -1.03, 0.432, 7.6],
        [1.48, -1.03, 0.0, 2.3],
        [-1.46, 0.06, 0.201, 1.0],
        [0.12, 0.06, 0.915, 0.5],
        [1.38, 0.06, 0.454, 1.5],
        [-1.48, 1.03, 0.0, 2.3],
        [0.12, 1.03, 0.394, 6.1],
        [1.17, 1.03, 0.0, 3.3],
    ];
    let (u, v) = (0.4, -0.25);
    let (a, b) = (quadratic((u + 1.0) / 3.5), quadratic((v + 2.0) / 4.0));
    let (mut sum, mut weight) = (DVec3::ZERO, 0.0);
    for (k, [x, y, z, w]) in points.into_iter().enumerate() {
        let n = a[k % 3] * b[k / 3] * w;
        sum += DVec3::new(x, y, z) * n;
        weight += n;
    }
    assert!((face.surface.jet(u, v).point - sum / weight).length() < 1e-15);

    // the loop: two rational cubics, run so that the face is on their left
    let [trim] = &face.loops[..] else { panic!("one loop") };
    assert!(trim.signed_area() > 0.0);
    let middle = |c: [[f64; 3]; 4]| {
        let n = [0.125, 0.375, 0.375, 0.125];
        let weight: f64 = (0..4).map(|i| n[i] * c[i][2]).sum();
        (0..4).map(|i| DVec2::new(c[i][0], c[i][1]) * (n[i] * c[i][2])).sum::<DVec2>() / weight
    };
    let first = middle([[-0.675, 1.85, 3.0], [0.915, 1.93, 1.0], [2.485, 0.47, 2.0], [2.485, -1.03, 1.0]]);
    let second = middle([[2.485, -1.03, 1.0], [1.605, -1.89, 10.7], [-0.745, -0.654, 0.5], [-0.675, 1.85, 3.0]]);
    let found: Vec<DVec2> = trim.curves().map(|c| c.point(0.5)).collect();
    for expected in [first, second] {
        assert!(found.iter().any(|p| (*p - expected).length() < 1e-15), "{expected} in {found:?}");
    }
}

/// A bilinear square of side 4 with its parameters, and curves 1 (a small square, clockwise) and 2 (its
/// lower half, as far as its height).
fn square(loops: &str) -> String {
    format!(
        "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 4 4 0\nvp 1 1\nvp 1 2\nvp 2 2\nvp 2 1\n\
        cstype bspline\ndeg 1 1\ncurv2 1 2 3 4 1\nparm u 0 0 1 2 3 4 4\nend\n\
        cstype bezier\ncurv2 1 4 3\nparm u 0 1 2\nend\n\
        surf 0 4 0 4 1 2 3 4\nparm u 0 4\nparm v 0 4\n{loops}end\n"
    )
}

#[test]
fn holes_have_the_other_direction() {
    let area = |loops: &str| -> Vec<f64> {
        let read = import(&square(loops));
        assert!(read.warnings.is_empty(), "{:?}", told(&read));
        read.model.parts[0].faces[0].loops.iter().map(|l| l.signed_area() / 2.0).collect()
    };
    assert!(area("").is_empty());
    assert_eq!(area("trim 0 4 1\n"), [1.0]);
    // a hole alone lies in the whole domain
    assert_eq!(area("hole 0 4 1\n"), [16.0, -1.0]);
    // two halves: up the left and over the top, then back along the second curve
    assert_eq!(area("trim 0 2 1 2 0 2\n"), [1.0]);
}

#[test]
fn a_smaller_range_cuts_the_surface() {
    let read = import(&square("").replace("surf 0 4 0 4", "surf 1 3 0 2"));
    let surface = &read.model.parts[0].faces[0].surface;
    assert_eq!(surface.domain(), ((1.0, 3.0), (0.0, 2.0)));
    assert_eq!(surface.jet(1.0, 0.0).point, DVec3::new(1.0, 0.0, 0.0));
    assert_eq!(surface.jet(3.0, 2.0).point, DVec3::new(3.0, 2.0, 0.0));
    let wide = import(&square("").replace("surf 0 4 0 4", "surf -1 4 0 4"));
    assert_eq!(told(&wide), ["t.obj:18: face repaired: range -1 4 beyond the domain 0 4"]);
}

/// Catmull-Rom in u, power basis in v, against the sum of the bases.
#[test]
fn mixed_bases() {
    let mut text = String::new();
    let height = |i: usize, j: usize| [3.0, 1.0, -2.0, 0.5, 4.0][i] * [1.0, 0.5, -0.25][j];
    for j in 0..3 {
        for i in 0..5 {
            text += &format!("v {} {} {}\n", if j == 0 { i as f64 } else { 0.0 }, [0.0, 1.0, 0.0][j], height(i, j));
        }
    }
    let points: String = (1..=15).map(|i| format!(" {i}")).collect();
    let bmat = "bmat u 0 -0.5 1 -0.5 1 0 -2.5 1.5 0 0.5 2 -1.5 0 0 -0.5 0.5\nbmat v 1 0 0 0 1 0 0 0 1\n";
    text += &format!("cstype bmatrix\ndeg 3 2\nstep 1 3\n{bmat}surf 0 2 0 1{points}\nparm u 0 1 2\nparm v 0 1\nend\n");
    let read = import(&text);
    assert!(read.warnings.is_empty(), "{:?}", told(&read));
    let surface = &read.model.parts[0].faces[0].surface;
    for (u, v) in [(0.0, 0.0), (0.3, 0.7), (1.0, 0.5), (1.6, 0.2), (2.0, 1.0)] {
        let (k, t) = if u < 1.0 { (0, u) } else { (1, u - 1.0) };
        let a = [
            t * (-0.5 + t * (1.0 - 0.5 * t)),
            1.0 + t * t * (-2.5 + 1.5 * t),
            t * (0.5 + t * (2.0 - 1.5 * t)),
            t * t * (-0.5 + 0.5 * t),
        ];
        let z: f64 = (0..4).map(|i| (0..3).map(|j| a[i] * [1.0, v, v * v][j] * height(k + i, j)).sum::<f64>()).sum();
        let p = surface.jet(u, v).point;
        // the bases sum to one, so x is u past the first inner point, y is v
        assert!((p - DVec3::new(u + 1.0, v, z)).length() < 4e-15, "{p} at {u} {v}, height {z}");
    }
}

#[test]
fn loops_with_small_gaps_are_closed() {
    let gap = square("trim 0 4 1\n").replace("curv2 1 2 3 4 1\n", "vp 1.0001 1\ncurv2 1 2 3 4 5\n");
    let read = import(&gap);
    assert!(told(&read)[0].contains("face repaired: loop closed over a gap of 9.999"), "{:?}", told(&read));
    let trim = &read.model.parts[0].faces[0].loops[0];
    let ends: Vec<_> = trim.curves().map(|c| (c.points[0].point(), c.points[c.degree()].point())).collect();
    assert!((0..ends.len()).all(|i| ends[i].1 == ends[(i + 1) % ends.len()].0));
    let wide = import(&square("trim 0 3 1\n"));
    assert!(told(&wide)[0].starts_with("t.obj:18: face left out: trim loop is open by 1e0"), "{:?}", told(&wide));
}
