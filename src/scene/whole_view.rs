//! One trim table for all views of the whole model from about the same distance.
//!
//! ```text
//!               ╭────╮             the ball contains everything trimmed. A unit at P, at depth w, covers at most
//!    eye ·──────│─P  │────▶ axis   focal |P| / w² pixels where it is visible, whatever the surface's orientation
//!               ╰────╯
//!
//!    along a ray that leaves the ball's middle by φ and the axis by at most α + φ:
//!
//!          |P| >= ρ(φ)  and  w = |P| cos θ, θ <= α + φ      =>      |P| / w² <= 1 / (ρ(φ) cos² (α + φ))
//! ```
//!
//! A table of higher density than a view's serves the view, and its scan lines follow from the density alone. Densities
//! are rounded up to the next of a few steps, so views from about the same distance share one table. A model that is
//! turned needs no new table while the whole model is visible. The picture does not depend on earlier views.
//!
//! Such a table also has rows beside the picture. Views of a part of the model use `view_cell.rs`.

use super::focal_and_slant;
use crate::model::{Bounds, Camera};
use glam::DVec3;

/// Densities are rounded up to a power of the fourth root of two, a twelfth too many rows on average.
const STEPS: f64 = 4.0;
/// Largest width of the ball, in longer sides of the picture; a wider ball would be mostly beside the picture.
const MOST_WIDE: f64 = 2.0;
/// Parts into which the ball's apparent angle is divided.
const PARTS: u32 = 32;
/// Relative rounding of the ball and of the sums below.
const ROUNDING: f64 = 1e-6;

/// A ball around everything trimmed, in model coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ball {
    pub(super) centre: DVec3,
    pub(super) radius: f64,
}

impl Ball {
    /// The ball around a box; `None` if the box is empty or unbounded.
    pub(super) fn around(bounds: Bounds) -> Option<Self> {
        let radius = 0.5 * bounds.diagonal() * (1.0 + ROUNDING);
        (!bounds.is_empty() && radius.is_finite() && radius > 0.0).then(|| Self { centre: bounds.centre(), radius })
    }

    /// Most pixels that a model unit covers in a picture of the ball; `None` if the eye is inside the ball or very near
    /// it.
    fn density(&self, camera: &Camera) -> Option<f64> {
        let (focal, slant) = focal_and_slant(camera);
        if !camera.is_perspective() {
            return Some(focal);
        }
        let to_centre = self.centre - camera.eye;
        let distance = to_centre.length();
        let share = self.radius / distance;
        if share >= 1.0 - ROUNDING {
            return None;
        }
        let (_, _, forward) = camera.axes();
        let beside = forward.angle_between(to_centre);
        let corner = (1.0 / slant).acos();
        let part = |k: u32| share.asin() * f64::from(k) / f64::from(PARTS);
        let densest = (0..PARTS).map(|k| {
            let (from, to) = (part(k), part(k + 1));
            let nearest =
                distance * from.cos() - (self.radius.powi(2) - (distance * from.sin()).powi(2)).max(0.0).sqrt();
            let depth = (beside + to).min(corner).cos();
            1.0 / (nearest * depth * depth)
        });
        Some(focal * densest.fold(0.0, f64::max) * (1.0 + ROUNDING))
    }

    /// The density of the trim table for all views from about this distance, in pixels a model unit; `None` if the view
    /// shows only a part of the ball.
    pub(super) fn table_density(&self, camera: &Camera) -> Option<f32> {
        let steps = (self.density(camera)?.log2() * STEPS).ceil();
        let density = (steps / STEPS).exp2();
        let (width, height) = camera.size;
        let is_whole = 2.0 * self.radius * density <= MOST_WIDE * f64::from(width.max(height));
        is_whole.then(|| (density as f32).next_up())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::Random;
    use crate::model::Projection;
    use glam::DVec2;

    fn ball() -> Ball {
        Ball { centre: DVec3::new(3.0, -1.0, 2.0), radius: 5.0 }
    }

    fn camera(eye: DVec3, target: DVec3, projection: Projection) -> Camera {
        Camera { eye, target, up: DVec3::Z, projection, depth_range: (0.1, 1e3), size: (640, 360) }
    }

    fn direction(random: &mut Random) -> DVec3 {
        loop {
            let p = DVec3::from_array(std::array::from_fn(|_| random.range(-1.0, 1.0)));
            if (1e-3..1.0).contains(&p.length()) {
                return p.normalize();
            }
        }
    }

    /// Largest stretch of a small step at a point, by finite differences of projections.
    fn stretch(camera: &Camera, p: DVec3) -> Option<f64> {
        const STEP: f64 = 1e-6;
        let (at, _) = camera.project(p)?;
        let (w, h) = camera.size;
        let is_seen = at.x >= 0.0 && at.y >= 0.0 && at.x <= f64::from(w) && at.y <= f64::from(h);
        let columns =
            [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| (camera.project(p + STEP * axis).unwrap().0 - at) / STEP);
        // the larger singular value of a 2 x 3 matrix
        let (a, b, c) =
            columns.iter().fold((0.0, 0.0, 0.0), |(a, b, c), d| (a + d.x * d.x, b + d.x * d.y, c + d.y * d.y));
        is_seen.then(|| (0.5 * (a + c) + (0.25 * (a - c).powi(2) + b * b).sqrt()).sqrt())
    }

    #[test]
    fn no_point_of_the_ball_is_denser_and_some_is_nearly_as_dense() {
        let mut random = Random::new(11);
        for n in 0..80 {
            let distance = random.range(5.2, 30.0);
            let eye = ball().centre + direction(&mut random) * distance;
            let target = ball().centre + direction(&mut random) * random.range(0.0, 4.0);
            let projection = match n {
                60.. => Projection::Pinhole {
                    focal: DVec2::splat(random.range(250.0, 900.0)),
                    principal: DVec2::new(random.range(-300.0, 940.0), random.range(-200.0, 560.0)),
                },
                _ if n % 3 == 0 => Projection::Orthographic { height: 12.0 },
                _ => Projection::Perspective { fov_y: random.range(0.3, 1.5) },
            };
            let camera = camera(eye, target, projection);
            let bound = ball().density(&camera).unwrap();
            let mut densest = 0.0f64;
            let mut see = |p: DVec3| densest = densest.max(stretch(&camera, p).unwrap_or(0.0));
            for _ in 0..4000 {
                see(ball().centre + ball().radius * direction(&mut random) * random.range(0.7, 1.0));
            }
            see(ball().centre - (ball().centre - eye).normalize() * ball().radius);
            assert!(densest <= bound * (1.0 + 1e-6), "{densest} of {bound}: {camera:?}");
            // from nearer, few points are where the ball is densest; off the middle, few are visible
            assert!(distance < 7.0 || n >= 60 || densest >= 0.6 * bound, "{densest} of {bound}: {camera:?}");
        }
    }

    #[test]
    fn a_turn_has_one_density_and_other_views_have_their_own() {
        let perspective = Projection::Perspective { fov_y: 0.8 };
        let turned = |k: u32| {
            let angle = f64::from(k) * 0.1 + 0.01;
            let from = DVec3::new(angle.cos(), angle.sin(), 0.6).normalize();
            ball().table_density(&camera(ball().centre + 14.0 * from, ball().centre, perspective))
        };
        let first = turned(0).unwrap();
        assert!((1..60).all(|k| turned(k) == Some(first)));
        let from = |distance: f64, projection| camera(ball().centre + distance * DVec3::X, ball().centre, projection);
        let whole = from(14.0, perspective);
        let asked = ball().density(&whole).unwrap();
        assert!(f64::from(first) >= asked && f64::from(first) < 1.2 * asked, "{first} for {asked}");
        assert!(ball().table_density(&from(28.0, perspective)).unwrap() < first);
        let narrow = from(14.0, Projection::Perspective { fov_y: 0.1 });
        for own in [from(5.5, perspective), from(4.9, perspective), narrow] {
            assert_eq!(ball().table_density(&own), None, "{own:?}");
        }
        let near = from(4.0, Projection::Orthographic { height: 12.0 });
        assert!(ball().table_density(&near).is_some(), "parallel rays do not spread");
    }

    #[test]
    fn nothing_and_everything_have_no_ball() {
        assert_eq!(Ball::around(Bounds::EMPTY), None);
        assert_eq!(Ball::around(Bounds { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY }), None);
        let flat = Bounds { min: DVec3::ZERO, max: DVec3::new(6.0, 8.0, 0.0) };
        let ball = Ball::around(flat).unwrap();
        assert!(ball.radius >= 5.0 && ball.radius < 5.001 && ball.centre == DVec3::new(3.0, 4.0, 0.0));
    }
}
