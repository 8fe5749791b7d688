//! A cone that contains every normal of a patch.
//!
//! ```text
//!              axis                    S_u within an angle a of one direction, S_v within b of another, which are
//!          ╲    │    ╱                 an angle g apart:
//!           ╲ θ │ θ ╱
//!            ╲  │  ╱  normals            sin θ = sqrt(sin² a + 2 sin a sin b |cos g| + sin² b) / sin g
//!             ╲ │ ╱
//!       ───────╲│╱──────── patch       axis: across both directions
//! ```
//!
//! *Proof.* A unit normal `n` is perpendicular to some `S_u` and some `S_v`, so its products with their axes are at
//! most `sin a` and `sin b`. The component of `n` in the plane of the two axes has the same products, and the longest
//! vector of that plane with such products has the length above. Where that is below 1 no normal lies in the plane, and
//! all of them, being connected, lie on one side of it.
//!
//! `S_u` and `S_v` need not belong to one point: the cone holds the normals of triangles whose sides run along `u` and `v`
//! between points of the surface, too, since such a side is a mean of tangents.
//!
//! The tangents' directions are those of the numerators in `derivative_bound.rs`, whose coefficients bound them.
//!
//! Source: T. W. Sederberg, R. J. Meyers, *Loop detection in surface patch intersections*, CAGD 5, 1988.

use super::Patch;
use super::net::numerators;
use glam::DVec3;

/// Every `S_u × S_v` of a patch is within an angle of `axis`, of this sine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalCone {
    /// A unit vector.
    pub axis: DVec3,
    /// Sine of half the cone's angle, which is below 90 degrees.
    pub sine: f64,
}

impl Patch {
    /// `None` where the tangents spread too far for a cone of less than 90 degrees. Weights must be positive.
    pub fn normal_cone(&self) -> Option<NormalCone> {
        let (u, v) = numerators(self);
        let ((u, sin_u), (v, sin_v)) = (directions(u.all())?, directions(v.all())?);
        let across = u.cross(v);
        let sin_between = across.length();
        let square = sin_u * sin_u + 2.0 * sin_u * sin_v * u.dot(v).abs() + sin_v * sin_v;
        let sine = square.sqrt() / sin_between;
        (sine < 1.0).then(|| NormalCone { axis: across / sin_between, sine })
    }
}

/// A direction, and the sine of the largest angle between it and any of these vectors; `None` from 90 degrees on.
/// Vectors that are mere rounding of the others count as of no length, and have no direction.
fn directions(all: &[DVec3]) -> Option<(DVec3, f64)> {
    const ROUNDING: f64 = 1e-12;
    let longest = all.iter().map(|d| d.length()).fold(0.0, f64::max);
    let unit = || all.iter().filter(|d| d.length() > ROUNDING * longest).map(|d| d.normalize());
    let axis = unit().sum::<DVec3>().try_normalize()?;
    let sine = |d: DVec3| (d.dot(axis) > 0.0).then(|| d.cross(axis).length());
    let most = unit().try_fold(0.0, |most: f64, d| Some(most.max(sine(d)?)))?;
    Some((axis, most))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spline::Control;
    use glam::DVec4;
    use proptest::prelude::*;

    /// A net over the unit square, its points moved, with weights.
    fn bumpy(n: usize, k: usize, moved: &[(f64, f64, f64, f64)]) -> Patch {
        let point = |(i, &(x, y, z, w)): (usize, &(f64, f64, f64, f64))| {
            let at = DVec3::new((i % (n + 1)) as f64 / n as f64, (i / (n + 1)) as f64 / k as f64, 0.0);
            DVec4::from_point(at + DVec3::new(x, y, z), w)
        };
        let points = moved.iter().take((n + 1) * (k + 1)).enumerate().map(point).collect();
        Patch { degree_u: n, degree_v: k, points }
    }

    fn flat(n: usize, k: usize) -> Patch {
        bumpy(n, k, &vec![(0.0, 0.0, 0.0, 1.0); (n + 1) * (k + 1)])
    }

    #[test]
    fn of_a_plane_there_is_one_normal() {
        let cone = flat(3, 2).normal_cone().unwrap();
        assert!(cone.axis.distance(DVec3::Z) < 1e-15 && cone.sine < 1e-15, "{cone:?}");
    }

    /// On a quarter of a cylinder the normals turn by 90 degrees, the lines along it by none.
    #[test]
    fn of_a_quarter_cylinder_it_is_as_wide_as_the_normals() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let arc = [(1.0, 0.0, 1.0), (1.0, 1.0, half), (0.0, 1.0, 1.0)];
        let row = |z: f64| arc.map(|(x, y, w)| DVec4::from_point(DVec3::new(x, y, z), w));
        let points = [row(0.0), row(2.0)].concat();
        let cone = Patch { degree_u: 2, degree_v: 1, points }.normal_cone().unwrap();
        assert!(cone.axis.distance(DVec3::new(half, half, 0.0)) < 1e-12, "{cone:?}");
        assert!((cone.sine - half).abs() < 1e-12, "{cone:?}");
    }

    #[test]
    fn what_folds_has_none() {
        let mut folded = flat(2, 2);
        folded.points[4] = DVec4::new(5.0, 0.5, 0.0, 1.0);
        assert_eq!(folded.normal_cone(), None);
        let line = vec![(0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0, 1.0), (0.0, -1.0, 0.0, 1.0), (0.0, -1.0, 0.0, 1.0)];
        assert_eq!(bumpy(1, 1, &line).normal_cone(), None, "no area");
    }

    proptest! {
        /// Normals of points, and of triangles with sides along the parameters.
        #[test]
        fn it_holds_every_normal(
            (n, k) in (1..=4usize, 1..=4usize), rational in any::<bool>(),
            moved in prop::collection::vec((-0.1..0.1f64, -0.1..0.1f64, -0.3..0.3f64, 0.5..2.0f64), 25),
        ) {
            let moved: Vec<_> = moved.iter().map(|&(x, y, z, w)| (x, y, z, if rational { w } else { 1.0 })).collect();
            let patch = bumpy(n, k, &moved);
            let Some(cone) = patch.normal_cone() else { return Ok(()) };
            let holds = |normal: DVec3| normal.dot(cone.axis) > 0.0 && normal.cross(cone.axis).length() <= cone.sine + 1e-9;
            let steps = 7;
            let at = |i: usize| i as f64 / steps as f64;
            for (i, j) in (0..steps * steps).map(|c| (c % steps, c / steps)) {
                let jet = patch.jet(at(i), at(j));
                prop_assert!(holds(jet.du.cross(jet.dv).normalize()), "at {i}, {j}: {cone:?}");
                let [p, q, r] = [(i, j), (i + 1, j), (i, j + 1)].map(|(i, j)| patch.jet(at(i), at(j)).point);
                prop_assert!(holds((q - p).cross(r - p).normalize()), "triangle at {i}, {j}: {cone:?}");
            }
        }
    }
}
