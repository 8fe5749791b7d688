//! Twin of `glsl/include/factor.glsl`: the guaranteed tessellation factor.
//!
//! ```text
//!   1 / tau_v ┌───────────┐          a triangle with vertices on the surface S, within a rectangle
//!             │ T      ╱  │          of 1 / tau_u by 1 / tau_v in (u, v); T is its point at (u, v),
//!             │    ╱  T'  │          e = T(u, v) - S(u, v) its deviation
//!             └───────────┘
//!                  1 / tau_u
//! ```
//!
//! **In space.** Let `(u, v) = Σ λ_i (u_i, v_i)` with barycentric `λ_i`, and `d_i = (u_i, v_i) - (u, v)`,
//! so `Σ λ_i d_i = 0`. Taylor's theorem along the unit vector of `e`, at `(u, v)`, leaves
//!
//! ```text
//!   |e| ≤ ½ Σ λ_i |S_uu du_i² + 2 S_uv du_i dv_i + S_vv dv_i²| ≤ ½ Σ λ_i (a du_i² + 2 b |du_i dv_i| + c dv_i²)
//! ```
//!
//! with the derivatives of each `i` at a different place, and `a`, `b`, `c` from
//! [`derivative_bound`](crate::spline::DerivativeBound), valid at all places. `Σ λ_i du_i²` is the variance of a
//! quantity that spans at most `1 / tau_u`, hence at most `1 / (4 tau_u²)` (Popoviciu), and `Σ λ_i |du_i dv_i|` at most
//! `1 / (4 tau_u tau_v)` (Cauchy and Schwarz). So
//!
//! ```text
//!   |e| ≤ E = (a / tau_u² + 2 b / (tau_u tau_v) + c / tau_v²) / 8
//! ```
//!
//! for every triangle in such a rectangle, of either diagonal. Pass [`split`](super::split) ensures that triangles
//! along sides with another factor are in such a rectangle, too.
//!
//! **On the screen.** View coordinates, depth `z`, `focal` pixels per unit slope. The pixels of `T` and `S` differ by
//! `focal |T_xy / T_z - S_xy / S_z|`; with `T = S + e` this is either of
//!
//! ```text
//!   focal |e_xy - (S_xy / S_z) e_z| / T_z        focal |e_xy - (T_xy / T_z) e_z| / S_z
//! ```
//!
//! By Cauchy and Schwarz `|e_xy - s e_z| ≤ |e| sqrt(1 + |s|²)`. `S` and `T` are means of the control points. So both
//! depths are at least the smallest depth of the control points, `W_min`, and `|s|` is at most their steepest slope; if
//! `S` or `T` is in the picture, also at most the picture's: `slant = sqrt(1 + tan²)` with the smaller one. (The box of
//! the control points has nearer and steeper corners.) A placement stretches `e` by `scale` at most:
//!
//! ```text
//!   deviation_px ≤ E · scale · focal · slant / W_min
//! ```
//!
//! In a parallel view `focal` is pixels per unit and `slant = W = 1`. If a control point lies before the near plane,
//! the box replaces the control points. If the box crosses the plane, too, `W_min` is set to `near`. The drawn `T` has
//! `T_z ≥ near`, and `S_z ≥ near - |e|` costs a factor of at most `1 / (1 - deviation_px / focal)`: one part in 5000
//! for half a pixel and usual lenses. A trimmed face's skirt extends beyond `[0, 1]²`. There `visibility_surface.glsl`
//! pushes vertices only as far as the surface stays within a quarter of the budget of its tangent, so across the border
//! it deviates by at most 25/16 of the budget.
//!
//! **Towards the eye.** A deviation along the ray moves no pixel. For a polynomial patch, pass [`bound`](super::bound)
//! projects the second differences of the net, which bound its second derivatives, into the picture:
//!
//! ```text
//!   a, b, c = sup |(d_X - x d_W, d_Y - y d_W)|      d = n (n-1) Δ²_u, n k Δ_u Δ_v, k (k-1) Δ²_v of the control points
//!   deviation_px ≤ E / W_min                        as homogeneous pixels; (x, y) where the patch is seen in the picture
//! ```
//!
//! since the pixels of `T` and `S` differ by `|e_X - x e_W| / T_W` with `(x, y)` the pixel of `S`, and by the same with
//! `T` and `S` exchanged. Each coordinate is linear in `x`, so its largest values are at the ends of its range. In
//! space `T` may then deviate by [`DEPTH_SHARE`](super::bound::DEPTH_SHARE) times the budget, by the bound above.
//! Factors that satisfy both bounds are used if they give fewer quads. Rational patches use the bound in space alone:
//! weights that vary around an arc make second differences of their nets large.
//!
//! **The choice.** With `a`, `b`, `c` over the budget and `r = tau_u / tau_v`, the quads are
//!
//! ```text
//!   tau_u tau_v = a / r + 2 b + c r          fewest, 2 (sqrt(a c) + b), at r = sqrt(a / c)
//! ```
//!
//! If the surface mostly twists, `b` is large and `r` hardly matters. But where one of `a`, `c` is small, the fewest
//! quads would be slender: thousands of segments along one side, one along the other. So `r` is the ratio nearest to 1
//! that costs at most [`SPARE`] more quads than the fewest. If a factor is below one segment, it is set to one, and the
//! other factor follows from a quadratic equation.
//!
//! Accuracy: 0 violations; the tests beside this file also measure how much finer than necessary it divides. Sources:
//! D. Filip, R. Magedson, R. Markot, *Surface algorithms using bounds on derivatives*,
//! CAGD 3, 1986 (right triangles, in space); T. Popoviciu, *Sur les équations algébriques*, 1935.

pub use crate::abi::constants::factor::SPARE;
use crate::abi::constants::factor::UP;

/// Whether one segment along each parameter satisfies the bound of [`factors`].
pub fn is_undivided(bend: [f32; 3], budget: f32) -> bool {
    let [a, b, c] = bend.map(|x| x / budget);
    (a + 2.0 * b + c) * UP <= 1.0
}

/// Segments `(tau_u, tau_v)`, whole numbers of small product, with
/// `bend[0] / tau_u² + 2 bend[1] / (tau_u tau_v) + bend[2] / tau_v² ≤ budget`.
///
/// `bend`: `|S_uu x² + 2 S_uv x y + S_vv y²| ≤ bend[0] x² + 2 bend[1] |x y| + bend[2] y²`, part units. `budget` is
/// `8 deviation_px` over the pixels that one part unit can cover. Valid for factors up to 10⁹.
pub fn factors(bend: [f32; 3], budget: f32) -> [f32; 2] {
    let [a, b, c] = bend.map(|x| x / budget);
    if is_undivided(bend, budget) {
        return [1.0, 1.0];
    }
    let (al, cl) = (a.max(1e-20), c.max(1e-20));
    // a / r + c r <= q between the roots of a quadratic, written without cancellation
    let q = 2.0 * ((1.0 + SPARE) * (al * cl).sqrt() + SPARE * b);
    let most = q + (q * q - 4.0 * al * cl).max(0.0).sqrt();
    let r = 1.0f32.max(2.0 * al / most).min(most / (2.0 * cl));
    let tv = (a / (r * r) + 2.0 * b / r + c).sqrt();
    let tu = r * tv;
    // tv < 1 only if r > 1, so r is the smaller root: c <= a / r², tv² >= 2 c, and 1 - c has no cancellation; the same
    // for tu
    if tv < 1.0 {
        return [((b + (b * b + a * (1.0 - c)).sqrt()) / (1.0 - c) * UP).ceil(), 1.0];
    }
    if tu < 1.0 {
        return [1.0, ((b + (b * b + c * (1.0 - a)).sqrt()) / (1.0 - a) * UP).ceil()];
    }
    [tu, tv].map(|t| (t * UP).ceil())
}

#[cfg(test)]
mod guarantee;
#[cfg(test)]
mod screen_bound;

#[cfg(test)]
mod tests {
    use super::*;

    /// Tight up to rounding; at most the spare share above the fewest quads, except for rounding to whole numbers.
    #[test]
    fn the_pair_meets_the_budget_with_few_quads() {
        let sizes = [0.0, 1e-9, 0.3, 0.7, 3.0, 50.0, 2000.0, 1e6];
        for a in sizes {
            for b in sizes {
                for c in sizes {
                    let [u, v] = factors([a, b, c], 1.0).map(f64::from);
                    let [a, b, c] = [a, b, c].map(f64::from);
                    let spent = |u: f64, v: f64| a / (u * u) + 2.0 * b / (u * v) + c / (v * v);
                    assert!(spent(u, v) <= 1.0, "{u} x {v} for {a}, {b}, {c}");
                    let fewer = |t: f64| (t - 1.0).max(1.0);
                    assert!(u * v == 1.0 || spent(fewer(u), fewer(v)) > 0.999, "{u} x {v} for {a}, {b}, {c}");
                    let fewest = (2.0 * ((a * c).sqrt() + b)).max(1.0).max(a.sqrt()).max(c.sqrt());
                    let spare = 1.0 + f64::from(SPARE);
                    assert!((u - 1.0) * (v - 1.0) <= spare * fewest, "{u} x {v} for {a}, {b}, {c}");
                }
            }
        }
    }

    #[test]
    fn a_straight_side_stays_one_segment() {
        assert_eq!(factors([400.0, 0.0, 0.0], 1.0), [21.0, 1.0]);
        assert_eq!(factors([400.0, 1e-9, 1e-9], 1.0), [21.0, 1.0]);
        assert_eq!(factors([0.0, 0.0, 400.0], 1.0), [1.0, 21.0]);
        assert_eq!(factors([0.0; 3], 1.0), [1.0, 1.0]);
    }

    /// A twisted strip that is also slightly bent along one parameter is divided along both.
    #[test]
    fn a_twist_is_not_cut_into_slivers() {
        let [u, v] = factors([0.0, 2500.0, 30.0], 1.0);
        assert!(u.max(v) < 80.0 && u.min(v) > 60.0, "{u} x {v}");
    }
}
