//! Why the factor is bounded in space and not on the screen: a comparison of both bounds.
//!
//! The screen-space bound takes the control points as homogeneous pixels `(X, Y, W)`, weights multiplied
//! in. For a pixel at abscissa `x` let `L = X - x W`; then the linear interpolant over cells of
//! `1 / tau_u` by `1 / tau_v` deviates by at most
//!
//! ```text
//!   (M_uu / tau_u² + 2 M_uv / (tau_u tau_v) + M_vv / tau_v²) / (8 W_min)
//!   M_uu = n (n-1) max |Δ²_u L|     M_uv = n k max |Δ_u Δ_v L|     M_vv = k (k-1) max |Δ²_v L|
//! ```
//!
//! pixels, the largest over both ends of the range of `x`, and likewise of `y`. It bounds the error of the interpolated
//! *homogeneous* position, parameters included. Weights that vary along one parameter enter the mixed difference, times
//! the extent along the other parameter.

use super::factors;
use crate::abi::Counters;
use crate::model::{Camera, Projection};
use crate::parity::{Case, placed, untrimmed};
use crate::spline::{Control, Patch, Surface};
use crate::twin::bound::bound;
use glam::{DAffine3, DMat4, DVec2, DVec3, DVec4};
use std::f64::consts::FRAC_1_SQRT_2;

/// `M_uu`, `M_uv`, `M_vv` for one linear functional of the net.
fn second_differences(patch: &Patch, value: impl Fn(DVec4) -> f64) -> [f64; 3] {
    let (n, k) = (patch.degree_u, patch.degree_v);
    let at = |i: usize, j: usize| value(patch.row(j)[i]);
    let mut most = [0.0f64; 3];
    for (i, j) in (0..=n).flat_map(|i| (0..=k).map(move |j| (i, j))) {
        if i + 2 <= n {
            most[0] = most[0].max((at(i, j) - 2.0 * at(i + 1, j) + at(i + 2, j)).abs());
        }
        if i < n && j < k {
            most[1] = most[1].max((at(i, j) - at(i + 1, j) - at(i, j + 1) + at(i + 1, j + 1)).abs());
        }
        if j + 2 <= k {
            most[2] = most[2].max((at(i, j) - 2.0 * at(i, j + 1) + at(i, j + 2)).abs());
        }
    }
    let (n, k) = (n as f64, k as f64);
    [most[0] * n * (n - 1.0), most[1] * n * k, most[2] * k * (k - 1.0)]
}

/// The largest over both coordinates and both ends of the patch's range within the picture, and `W_min`.
fn screen_bound(patch: &Patch, to_pixels: DMat4, size: DVec2) -> ([f64; 3], f64) {
    let points = patch.points.iter().map(|p| {
        let q = to_pixels * *p;
        DVec3::new(q.x, q.y, q.w)
    });
    let on_screen: Vec<DVec3> = points.collect();
    let pixels = on_screen.iter().map(|q| q.point());
    let (lo, hi) =
        pixels.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi): (DVec2, DVec2), p| (lo.min(p), hi.max(p)));
    let (lo, hi) = (lo.max(DVec2::ZERO), hi.min(size));
    let w_min = on_screen.iter().map(|q| q.z).fold(f64::INFINITY, f64::min);
    let mut most = [0.0f64; 3];
    for (axis, end) in [(0, lo.x), (0, hi.x), (1, lo.y), (1, hi.y)] {
        let m = second_differences(patch, |p| {
            let q = to_pixels * p;
            q[axis] - end * q.w
        });
        most = std::array::from_fn(|a| most[a].max(m[a]));
    }
    (most, w_min)
}

/// A quarter cylinder 500 pixels long with a radius of 100 pixels: the number of quads for each bound.
#[test]
fn a_quarter_cylinder_needs_few_strips() {
    let arc = [(1.0, 0.0, 1.0), (1.0, 1.0, FRAC_1_SQRT_2), (0.0, 1.0, 1.0)];
    let point = |x: f64, (y, z, w): (f64, f64, f64)| DVec4::from_point(DVec3::new(x, y * 100.0, z * 100.0), w);
    let points: Vec<DVec4> = [-250.0, 250.0].iter().flat_map(|&x| arc.map(|p| point(x, p))).collect();
    let (parabola, line) = (vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0]);
    let surface = Surface::new((2, 1), parabola, line, points).unwrap();
    // one unit is one pixel at the cylinder's nearest point
    let (distance, size) = (5000.0, (800, 600));
    let fov_y = 2.0 * (300.0f64 / distance).atan();
    let camera = Camera {
        eye: DVec3::new(0.0, 50.0, 100.0 + distance),
        target: DVec3::new(0.0, 50.0, 0.0),
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y },
        depth_range: (100.0, 10_000.0),
        size,
    };
    let model = placed(vec![untrimmed(surface.clone())], DAffine3::IDENTITY);
    let case = Case::new(&model, &camera, 0.5);
    let tau = bound(&case.frame, &case.scene(), &mut Counters::default())[0];
    let ours = (tau & 0xffff) * (tau >> 16);

    let grid = surface.patches();
    let size = DVec2::new(f64::from(size.0), f64::from(size.1));
    let (m, w_min) = screen_bound(&grid.patches[0].patch, camera.pixel_matrix(), size);
    let budget = 8.0 * f64::from(case.frame.deviation_px) * w_min;
    let isotropic = ((m[0] + 2.0 * m[1] + m[2]) / budget).sqrt().ceil().powi(2);
    let best = factors(m.map(|x| x as f32), budget as f32);
    println!(
        "quads of a quarter cylinder, {} px: {} x {} = {ours} in space; on the screen {isotropic} with equal \
         factors, {} x {} = {} with the best ones",
        case.frame.deviation_px,
        tau & 0xffff,
        tau >> 16,
        best[0],
        best[1],
        best[0] * best[1]
    );
    assert_eq!(tau >> 16, 1, "straight along the axis");
    assert!(f64::from(best[0] * best[1]).min(isotropic) > 10.0 * f64::from(ours));
}
