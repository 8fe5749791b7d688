//! The scale on which a picture shows curvature.

use super::{Model, Shape};
use crate::spline::Surface;

/// Share of the sampled curvatures that the scale holds: the tightest fillets may lie beyond its end.
const HELD: f64 = 0.9;
/// Samples along each parameter of a face.
const SAMPLES: usize = 3;
/// Curvatures below this over the model's diagonal are those of flat faces.
const FLAT: f64 = 1e-3;

impl Model {
    /// An end of the scale, in 1 / units of the model, at which most of the model's mean curvatures are told apart: one, two or
    /// five times a power of ten. Samples of every face, each counted once, and round primitives of Boolean solids; a model
    /// without any has a tenth of its diagonal as radius.
    pub fn curvature_range(&self) -> f64 {
        let diagonal = self.control_bounds().diagonal();
        let faces = self.instances.iter().flat_map(|instance| {
            let stretch = instance.transform.matrix3.determinant().abs().cbrt();
            self.parts[instance.part]
                .faces
                .iter()
                .flat_map(move |face| means(&face.surface).map(move |mean| mean / stretch).collect::<Vec<_>>())
        });
        let primitives = self.solids.iter().flat_map(|solid| solid.primitives()).filter_map(|primitive| {
            let stretch = primitive.transform.matrix3.determinant().abs().cbrt();
            let mean = match primitive.shape {
                Shape::Sphere { radius } => 1.0 / radius,
                Shape::Cylinder { radius, .. } => 0.5 / radius,
                Shape::Cone { bottom, top, .. } => 1.0 / (bottom + top),
                Shape::Torus { minor, .. } => 0.5 / minor,
                _ => return None,
            };
            Some(mean / stretch)
        });
        let is_bent = |mean: &f64| mean.is_finite() && *mean * diagonal > FLAT;
        let mut found: Vec<f64> = faces.chain(primitives).filter(is_bent).collect();
        let most = if found.is_empty() {
            10.0 / diagonal
        } else {
            let nth = (HELD * (found.len() - 1) as f64) as usize;
            *found.select_nth_unstable_by(nth, f64::total_cmp).1
        };
        if most.is_finite() && most > 0.0 { rounded_up(most) } else { 1.0 }
    }
}

/// Sizes of the mean curvature at a few points of a surface.
fn means(surface: &Surface) -> impl Iterator<Item = f64> {
    let ((u0, u1), (v0, v1)) = surface.domain();
    let at = |(from, to): (f64, f64), k: usize| from + (to - from) * (k as f64 + 0.5) / SAMPLES as f64;
    let places = (0..SAMPLES * SAMPLES).map(move |k| (at((u0, u1), k % SAMPLES), at((v0, v1), k / SAMPLES)));
    places.filter_map(|(u, v)| surface.curvature(u, v)).map(|c| c.mean().abs())
}

/// The next of 1, 2, 5, 10, … times a power of ten.
fn rounded_up(x: f64) -> f64 {
    let power = 10f64.powf(x.log10().floor());
    let digit = [1.0, 2.0, 5.0, 10.0].into_iter().find(|digit| x <= digit * power * (1.0 + 1e-12));
    digit.unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{GREY, Primitive, Solid};
    use glam::{DAffine3, DVec3};

    #[test]
    fn ends_are_round_numbers() {
        for (x, end) in [(0.1, 0.1), (0.11, 0.2), (0.3, 0.5), (0.51, 1.0), (99.0, 100.0), (1.0, 1.0)] {
            assert!((rounded_up(x) / end - 1.0).abs() < 1e-12, "{x}: {}", rounded_up(x));
        }
    }

    #[test]
    fn a_ball_has_the_curvature_of_its_radius() {
        let ball = |radius, scale| {
            let transform = DAffine3::from_scale(DVec3::splat(scale));
            let primitive = Primitive { shape: Shape::Sphere { radius }, transform, colour: GREY, id: 1 };
            Model { solids: vec![Solid::of(primitive).expect("a solid")], ..Model::default() }
        };
        // 1 / 25 and 1 / 250, rounded up
        assert!((ball(25.0, 1.0).curvature_range() - 0.05).abs() < 1e-12);
        assert!((ball(25.0, 10.0).curvature_range() - 0.005).abs() < 1e-12);
        assert!(Model::default().curvature_range() > 0.0);
    }
}
