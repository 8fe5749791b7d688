//! Triangles: creases, and silhouettes where none is.

use super::*;
use crate::model::Mesh;

fn mesh(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Model {
    let mesh = Mesh::new(1, positions, triangles, vec![]).unwrap();
    alone(Part { meshes: vec![mesh], closed: true, ..Part::default() })
}

/// The diagonals of its sides are no lines.
#[test]
fn a_cube_of_triangles_is_a_cube() {
    let corner = |k: u32| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)) - 0.5;
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let model = mesh((0..8).map(corner).collect(), triangles);
    for camera in [parallel(DVec3::new(2.0, -2.0, 2.0), 2.0), perspective(DVec3::new(1.0, -3.0, 0.9))] {
        let [visible, hidden] = super::bodies::cube_edges(&camera);
        let drawing = drawn(&model, &camera);
        same_segments(&strokes(&drawing, LineKind::Sharp, false), &visible);
        same_segments(&strokes(&drawing, LineKind::Sharp, true), &hidden);
        assert_eq!(drawing.lines.len(), 12);
    }
}

/// A ball of triangles that turn by less than a crease: its outline all around, and nothing else.
#[test]
fn a_ball_of_triangles_has_an_outline() {
    let (rings, around) = (24u32, 48u32);
    let at = |i: u32, j: u32| {
        let (theta, phi) = (f64::from(i) / f64::from(rings), f64::from(j % around) / f64::from(around));
        let (s, c) = (theta * std::f64::consts::PI).sin_cos();
        let (sin, cos) = (phi * std::f64::consts::TAU).sin_cos();
        // the poles are points, bit for bit
        if i == 0 || i == rings { DVec3::Z * c } else { DVec3::new(s * cos, s * sin, c) }
    };
    let positions: Vec<DVec3> = (0..=rings).flat_map(|i| (0..around).map(move |j| at(i, j))).collect();
    let index = |i: u32, j: u32| i * around + j % around;
    let quads = (0..rings).flat_map(|i| (0..around).map(move |j| (i, j)));
    let triangles = quads.flat_map(|(i, j)| {
        let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
        [(i + 1 < rings).then_some([a, b, c]), (i > 0).then_some([a, c, d])].into_iter().flatten()
    });
    let model = mesh(positions, triangles.collect());
    let camera = parallel(DVec3::new(1.0, -2.0, 0.8), 3.0);
    let drawing = drawn(&model, &camera);
    let (middle, radius) = (DVec2::new(400.0, 300.0), 200.0);
    let mut bins = [false; 90];
    for line in drawing.lines.iter().filter(|l| !l.hidden) {
        assert_eq!(line.kind, LineKind::Silhouette);
        for p in points(&line.curves) {
            let off = p - middle;
            // triangles lie within the ball by a part of the square of half their angle
            assert!(off.length() <= radius + CURVE && off.length() > 0.97 * radius, "{p}");
            bins[((off.to_angle() + std::f64::consts::PI) / std::f64::consts::TAU * 90.0) as usize % 90] = true;
        }
    }
    assert!(bins.iter().all(|b| *b), "{bins:?}");
}
