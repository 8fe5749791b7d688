//! Triangles and borders of fixed-deflection meshes against the surface and its loops.

use selvedge::baselines::many_holes;
use selvedge::baselines::pretessellated::pretessellated;
use selvedge::model::Model;
use selvedge::trim::LoopIndex;
use std::collections::BTreeMap;

/// Largest distance of a model's triangles from the sheet of [`many_holes`], whose parameters are x and y, and of their
/// border from its loops.
fn errors(model: &Model, mesh: &Model) -> (f64, f64) {
    let face = &model.parts[0].faces[0];
    let grid = face.surface.patches();
    let index = LoopIndex::new(&face.loops);
    let mesh = &mesh.parts[0].meshes[0];
    let mut off = 0.0f64;
    let mut sides: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    for (k, t) in mesh.triangles().iter().enumerate() {
        let [a, b, c] = mesh.corners(k);
        for w in [[0.2, 0.3, 0.5], [0.6, 0.1, 0.3], [0.05, 0.9, 0.05], [0.45, 0.45, 0.1]] {
            let p = a * w[0] + b * w[1] + c * w[2];
            off = off.max((grid.point(p.x, p.y).z - p.z).abs());
        }
        for i in 0..3 {
            let (a, b) = (t[i], t[(i + 1) % 3]);
            *sides.entry((a.min(b), a.max(b))).or_default() += 1;
        }
    }
    let border = sides.into_iter().filter(|(_, uses)| *uses == 1).flat_map(|((a, b), _)| {
        let [a, b] = [a, b].map(|v| mesh.positions()[v as usize].truncate());
        (1..8).map(move |i| a.lerp(b, f64::from(i) / 8.0))
    });
    let border = border.map(|p| index.distance(p, 1.0)).fold(0.0, f64::max);
    (off, border)
}

#[test]
fn triangles_and_borders_keep_the_deflection() {
    let model = many_holes(4);
    for deflection in [0.1, 0.01] {
        let (mesh, all) = pretessellated(&model, deflection);
        assert_eq!((all.missing, all.beyond), (0, 0));
        let (off, border) = errors(&model, &mesh);
        assert!(off <= 1.05 * deflection, "{off} at {deflection}"); // the probes are a sample
        assert!(border <= 1.05 * deflection, "{border} at {deflection}");
        // not much finer than requested either, which would be unfair
        assert!(off > 0.2 * deflection && border > 0.2 * deflection, "{off} {border} at {deflection}");
    }
}

#[test]
fn the_area_is_that_of_the_face() {
    let model = many_holes(3);
    let (mesh, _) = pretessellated(&model, 1e-2);
    let mesh = &mesh.parts[0].meshes[0];
    let area = (0..mesh.triangles().len()).map(|k| {
        let [a, b, c] = mesh.corners(k);
        0.5 * (b - a).cross(c - a).z
    });
    let area: f64 = area.sum();
    let loops = &model.parts[0].faces[0].loops;
    let (lo, hi) = loops[0].bounds();
    let holes: f64 = loops[1..]
        .iter()
        .map(|l| {
            let (lo, hi) = l.bounds();
            0.25 * std::f64::consts::PI * (hi.x - lo.x).powi(2)
        })
        .sum();
    let exact = (hi - lo).x * (hi - lo).y - holes;
    // chords 1e-2 mm inside nine circles of about 50 mm around
    assert!((area - exact).abs() < 9.0 * 55.0 * 1e-2, "{area} instead of {exact}");
}
