//! Fine nets: a second, more precise set of control points for patches whose single-precision points would turn a short
//! side.
//!
//! ```text
//!   points of a patch    first              first + count
//!                        ▼                  ▼
//!                        p₀ p₁ ⋯            C  p₀ − C  p₁ − C  ⋯        C: an end of the side that turns most
//! ```
//!
//! Single precision rounds a coordinate at distance `x` from the part's centre by up to `x` 2⁻²⁴. A side of length `l`
//! between two control points may thus turn by √3 `x` 2⁻²³ / `l`. A loft over a nose has sides of a thousandth of the
//! patch or less; they would turn by more than the promised accuracy of normals. Relative to `C`, rounding is that of
//! numbers near zero. A patch gets a fine net if its own roundings, or those of sums over its whole size, turn a side
//! too far. The drawn surface follows the ordinary control points, which adjacent patches share bit for bit. The passes
//! `resolve` and `solid_layers` read the fine net of a patch that has one.

use super::face::POINT;
use crate::spline::{Control, Patch};
use glam::{DVec3, DVec4};

/// Most that the direction between two control points may turn, in radians: half of 0.01 degrees, since a normal
/// depends on two such directions.
const MOST_TURN: f64 = 8.7e-5;

/// `C` and the points relative to it; `None` if the control points are precise enough. `unit` is the weight stored as
/// 1.
pub(super) fn fine_net(patch: &Patch, origin: DVec3, unit: f64) -> Option<Vec<[f32; 4]>> {
    let local: Vec<DVec3> = patch.points.iter().map(|q| q.point() - origin).collect();
    let (lo, hi) = patch.bounds();
    let (point, across) = (POINT * (hi - lo).length(), patch.degree_u + 1);
    let along_u = (0..local.len()).filter(|i| (i + 1) % across != 0).map(|i| (i, i + 1));
    let along_v = (across..local.len()).map(|i| (i - across, i));
    let rest = |i: usize| local[i] - local[i].as_vec3().as_dvec3();
    let sums = (hi - lo).length() * f64::from(f32::EPSILON);
    // the angle by which a side may turn
    let turn = |(a, b): (usize, usize)| {
        let length = local[a].distance(local[b]);
        (length > point).then(|| ((rest(a).distance(rest(b)) + sums) / length, a))
    };
    let (most, at) = along_u.chain(along_v).filter_map(turn).max_by(|a, b| a.0.total_cmp(&b.0))?;
    if most < MOST_TURN {
        return None;
    }
    let base = local[at].as_vec3();
    let from = origin + base.as_dvec3();
    let near = |q: &DVec4| ((q.truncate() - from * q.w) / unit).extend(q.w / unit).as_vec4().to_array();
    Some(std::iter::once(base.extend(1.0).to_array()).chain(patch.points.iter().map(near)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bilinear patch 100 long and `narrow` wide at its end, with its first corner at `x`.
    fn wedge(x: f64, narrow: f64, weight: f64) -> Patch {
        let points = [(0.0, 0.0), (100.0, 0.0), (0.0, 50.0), (100.0, narrow)];
        let points = points.map(|(a, b)| DVec4::from_point(DVec3::new(x + a, b, 1.0 / 3.0), weight)).to_vec();
        Patch { degree_u: 1, degree_v: 1, points }
    }

    #[test]
    fn a_short_side_far_away_has_one() {
        let origin = DVec3::new(-7.0, 3.0, 0.1);
        let patch = wedge(20_000.1, 0.1, 1.0);
        let net = fine_net(&patch, origin, 1.0).expect("2e-3 of 0.1");
        let base = DVec3::new(f64::from(net[0][0]), f64::from(net[0][1]), f64::from(net[0][2]));
        assert_eq!((net.len(), net[0][3]), (5, 1.0));
        assert!((base + origin).distance(patch.points[1].truncate()) < 2e-3, "{base}");
        for (fine, q) in net[1..].iter().zip(&patch.points) {
            let exact = q.truncate() - origin - base;
            assert!(exact.distance(DVec3::new(fine[0].into(), fine[1].into(), fine[2].into())) < 5e-6, "{exact}");
            assert_eq!(fine[3], 1.0);
        }
        // the two points at the short side, with their own roundings
        let side = |a: [f32; 4], b: [f32; 4]| f64::from(b[1] - a[1]);
        assert!((side(net[2], net[4]) - 0.1).abs() < 1e-8);
    }

    #[test]
    fn weights_stay() {
        let net = fine_net(&wedge(20_000.1, 0.1, 3.0), DVec3::ZERO, 1.5).expect("as without them");
        assert!(net[1..].iter().all(|q| q[3] == 2.0));
        assert!((f64::from(net[4][1] - net[2][1]) - 0.2).abs() < 1e-8, "twice the width");
    }

    #[test]
    fn others_have_none() {
        assert!(fine_net(&wedge(20_000.1, 50.0, 1.0), DVec3::ZERO, 1.0).is_none(), "wide");
        assert!(fine_net(&wedge(20_000.1, 50.0, 1.0), DVec3::splat(1.0), 1.0).is_none(), "wide, and elsewhere");
        assert!(fine_net(&wedge(20_000.1, 0.0, 1.0), DVec3::ZERO, 1.0).is_none(), "a point");
        assert!(fine_net(&wedge(10.0, 1.0, 1.0), DVec3::ZERO, 1.0).is_none(), "near");
    }
}
