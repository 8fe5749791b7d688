//! The limit point of a vertex of a control mesh, and the normal there, in closed form.
//!
//! ```text
//!             Catmull-Clark                                     Loop
//!   inside    (n² c + 4 Σ e_j + Σ f_j) / n (n + 5)              (1 - n w) c + w Σ e_j,  w = 1 / (n + 3 / 8 b)
//!   border    (4 c + e_0 + e_m) / 6                             the same
//!   tangents  Σ A cos θ_j e_j + (cos θ_j + cos θ_j+1) f_j       Σ cos θ_j e_j          and with sines
//! ```
//!
//! `e_j` are the neighbours of `c` along its edges, `f_j` those across its quadrilaterals, `θ_j = 2 π j / n`,
//! `A = 1 + cos θ_1 + cos (θ_1 / 2) sqrt(2 (9 + cos θ_1))`, `b` as in [`weight`].
//!
//! Sources: M. Halstead, M. Kass, T. DeRose, 1993, appendix A; C. Loop, *Smooth subdivision surfaces based on
//! triangles*, 1987.

use super::Scheme;
use super::mesh::{Fan, Topology};
use glam::DVec3;
use std::f64::consts::TAU;

/// A vertex in the limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// On the surface.
    pub point: DVec3,
    /// Unit normal; `None` on borders, corners and creases, and where the tangents span no plane.
    pub normal: Option<DVec3>,
}

/// Loop's weight of each neighbour, for `n` of them.
pub(super) fn weight(n: usize) -> f64 {
    let n = n as f64;
    let c = 0.375 + 0.25 * (TAU / n).cos();
    (0.625 - c * c) / n
}

impl Limit {
    /// The vertex of a fan; for Catmull-Clark its faces are quadrilaterals.
    pub(super) fn of(scheme: Scheme, mesh: &Topology, fan: &Fan) -> Self {
        let c = mesh.at(fan.out[0]);
        let rays = mesh.rays(fan);
        if let Some(point) = mesh.border_point(mesh.origin(fan.out[0])) {
            return Self { point, normal: None };
        }
        let count = rays.len() as f64;
        let angle = |j: usize| TAU * j as f64 / count;
        let sum: DVec3 = rays.iter().sum();
        let (point, tangents) = match scheme {
            Scheme::CatmullClark => {
                let across: Vec<DVec3> = fan.out.iter().map(|h| mesh.at(mesh.next(mesh.next(*h)))).collect();
                let point = (c * (count * count) + sum * 4.0 + across.iter().sum::<DVec3>()) / (count * (count + 5.0));
                let first = angle(1).cos();
                let a = 1.0 + first + (0.5 * angle(1)).cos() * (2.0 * (9.0 + first)).sqrt();
                let tangent = |f: fn(f64) -> f64| -> DVec3 {
                    let term = |j: usize| rays[j] * (a * f(angle(j))) + across[j] * (f(angle(j)) + f(angle(j + 1)));
                    (0..rays.len()).map(term).sum()
                };
                (point, [tangent(f64::cos), tangent(f64::sin)])
            }
            Scheme::Loop => {
                let w = 1.0 / (count + 0.375 / weight(rays.len()));
                let tangent = |f: fn(f64) -> f64| -> DVec3 { (0..rays.len()).map(|j| rays[j] * f(angle(j))).sum() };
                (c * (1.0 - count * w) + sum * w, [tangent(f64::cos), tangent(f64::sin)])
            }
        };
        let cross = tangents[0].cross(tangents[1]);
        let slight = cross.length() <= 1e-12 * tangents[0].length() * tangents[1].length();
        Self { point, normal: cross.try_normalize().filter(|_| !slight) }
    }

    /// The nearest point of the tangent plane, if there is one.
    pub(super) fn tangent_plane(&self, p: DVec3) -> DVec3 {
        self.normal.map_or(p, |n| p - n * (p - self.point).dot(n))
    }
}
