//! A wavy sheet of any degree, for sweeps over degrees and numbers of patches.

use glam::{DAffine3, DVec3, DVec4};
use selvedge::model::{Face, Instance, Model, Part, SurfaceKind};
use selvedge::spline::Surface;

/// Patches along each side.
const SPANS: usize = 32;

/// One face without trims, of 32 x 32 patches: two waves along each side, a tenth of a side high.
pub fn of_degree(degree: usize) -> Model {
    let inner = (1..SPANS).map(|i| i as f64);
    let end = SPANS as f64;
    let knots: Vec<f64> =
        std::iter::repeat_n(0.0, degree + 1).chain(inner).chain(std::iter::repeat_n(end, degree + 1)).collect();
    // Greville's abscissae, along which a spline's control points run evenly
    let at: Vec<f64> =
        (0..SPANS + degree).map(|i| knots[i + 1..=i + degree].iter().sum::<f64>() / degree as f64 / end).collect();
    let wave = |t: f64| (t * 2.0 * std::f64::consts::TAU).sin();
    let point = |u: f64, v: f64| DVec4::new(u, v, 0.05 * (wave(u) + wave(v)), 1.0);
    let points = at.iter().flat_map(|&v| at.iter().map(move |&u| point(u, v))).collect();
    let surface = Surface::new((degree, degree), knots.clone(), knots, points).expect("knots fit the points");
    let face = Face { id: 1, kind: SurfaceKind::BSpline, surface, loops: Vec::new(), same_sense: true, colour: None };
    let instance = Instance { part: 0, transform: DAffine3::from_scale(DVec3::ONE), colour: None, name: String::new() };
    Model { parts: vec![Part { faces: vec![face], ..Part::default() }], instances: vec![instance], ..Model::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sheet_has_its_degree_and_its_patches() {
        for degree in [1, 2, 9] {
            let model = of_degree(degree);
            let grid = model.parts[0].faces[0].surface.patches();
            assert_eq!(grid.patches.len(), SPANS * SPANS);
            assert!(grid.patches.iter().all(|p| (p.patch.degree_u, p.patch.degree_v) == (degree, degree)));
        }
    }
}
