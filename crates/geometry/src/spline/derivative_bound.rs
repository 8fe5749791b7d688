//! Guaranteed bounds of the first and second derivatives of a rational patch.
//!
//! With `S = P / w`, the derivatives are quotients of Bernstein polynomials:
//!
//! ```text
//!   A    = P_u w - P w_u                    S_u  = A w  / w³
//!   A_uu = A_u w - 2 A w_u                  S_uu = A_uu / w³
//!   A_uv = A_v w - 2 A w_v                  S_uv = A_uv / w³        (v alike)
//! ```
//!
//! Numerators and `w³` are multiplied out *exactly* as Bernstein nets of one degree, so terms that cancel do cancel (on
//! a cylinder `S_uv` comes out as zero). With `B_i` the basis, `|Σ B_i a_i| / Σ B_i w_i` is at most the largest `|a_i|
//! / w_i`. The nets are halved where this bound is more than [`SPARE`] above a value that a derivative reaches: no
//! bound is farther above the truth, unless [`MOST_HALVINGS`] did not suffice.
//!
//! **The twist.** The error of a triangulation depends on the second derivative along a step `(x, y)`, a vector.
//! Separate bounds of its three terms add up vectors that may have different directions, or be large in different
//! places. So the mixed term is bounded last, by the smallest `b` that makes, with `a = sup |S_uu|` and `c = sup
//! |S_vv|`,
//!
//! ```text
//!   |S_uu x² + 2 S_uv x y + S_vv y²| <= a x² + 2 b |x y| + c y²         for all x, y, everywhere
//! ```
//!
//! true term by term. Both sides squared are polynomials of degree 4 in `r = |x / y|`, and the difference has no
//! negative coefficient where, for the coefficients `A`, `B`, `C` of the nets (quotients, as above),
//!
//! ```text
//!   |A|² <= a²      |A·B| <= a b      2 |B|² + A·C <= 2 b² + a c      |B·C| <= b c      |C|² <= c²
//! ```
//!
//! `b = sup |S_uv|` satisfies them; on random nets of degree 2 to 7 the smallest is about half of that.
//!
//! Why not bound the homogeneous triple after projection, as one may for polynomial patches? Its
//! mixed second difference sees the weights, which vary around every arc: a quarter cylinder 500
//! pixels long would be cut into several hundred strips for no gain.
//!
//! Source: the numerators by the quotient rule; Bernstein products from G. Farin, *Curves and
//! Surfaces for CAGD*, 2002, section 6.10; the factor that uses them from D. Filip, R. Magedson,
//! R. Markot, *Surface algorithms using bounds on derivatives*, CAGD 3, 1986.

use super::Patch;
use super::net::{Net, Value, nets, numerators};
use glam::DVec3;
use std::ops::{Add, Mul, Sub};

/// How far a bound may be above the truth, as a share of it.
const SPARE: f64 = 1.0 / 32.0;
/// Halvings of the patch, along both parameters together: pieces of a sixteenth by a sixteenth at the smallest.
const MOST_HALVINGS: u32 = 8;
/// Second derivatives below this share of the first ones count as none: not worth a halving.
const FLAT: f64 = 1e-9;

/// Largest lengths of a patch's derivatives over its unit square.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DerivativeBound {
    /// `sup |S_u|`, model units.
    pub u: f64,
    /// `sup |S_v|`.
    pub v: f64,
    /// `sup |S_uu|`.
    pub uu: f64,
    /// `sup |S_uv|`.
    pub uv: f64,
    /// `sup |S_vv|`.
    pub vv: f64,
    /// At most `uv`: `|S_uu x² + 2 S_uv x y + S_vv y²| <= uu x² + 2 twist |x y| + vv y²`.
    pub twist: f64,
}

impl Patch {
    /// Upper bounds of the derivatives' lengths over the unit square. Weights must be positive.
    ///
    /// Cost: a few halvings of one net, of three times the degree where weights differ.
    pub fn derivative_bound(&self) -> DerivativeBound {
        let pieces = halved(vec![Piece { net: terms(self), halvings: 0 }], Terms::lengths);
        let [u, v, uu, uv, vv] = largest(&pieces, Terms::lengths);
        let twist = |t: &Terms| [t.twist(uu, vv, uv)];
        let [twist] = largest(&halved(pieces, twist), twist);
        DerivativeBound { u, v, uu, uv, vv, twist: twist.min(uv) }
    }

    /// Upper bounds of `|S_u|` and `|S_v|` alone, from one hull.
    pub fn speed_bound(&self) -> (f64, f64) {
        let w_min = self.points.iter().map(|p| p.w).fold(f64::INFINITY, f64::min);
        let along_u = |patch: &Patch| {
            let (position, weight) = nets(patch);
            position.du().times(&weight).minus(&position.times(&weight.du())).largest() / (w_min * w_min)
        };
        (along_u(self), along_u(&self.transposed()))
    }
}

/// Coefficients of the numerators of all derivatives, and of their denominator.
#[derive(Clone, Copy, Default)]
struct Terms {
    u: DVec3,
    v: DVec3,
    uu: DVec3,
    uv: DVec3,
    vv: DVec3,
    weight: f64,
}

impl Terms {
    /// The lengths of `S_u`, `S_v`, `S_uu`, `S_uv`, `S_vv`.
    fn lengths(&self) -> [f64; 5] {
        [self.u, self.v, self.uu, self.uv, self.vv].map(|d| d.length() / self.weight)
    }

    /// The smallest `b` of the module's inequalities, and at most `uv`.
    fn twist(&self, uu: f64, vv: f64, uv: f64) -> f64 {
        let [a, b, c] = [self.uu, self.uv, self.vv].map(|d| d / self.weight);
        // for a bound of 0 the numerators vanish
        let over = |x: f64, bound: f64| if bound > 0.0 { x.abs() / bound } else { 0.0 };
        let square = b.length_squared() + (a.dot(c) - uu * vv) / 2.0;
        over(a.dot(b), uu).max(over(b.dot(c), vv)).max(square.max(0.0).sqrt()).min(uv)
    }

    /// Combines all terms one by one, except for the weight.
    fn map(self, other: Self, of: impl Fn(DVec3, DVec3) -> DVec3, weight: f64) -> Self {
        Self {
            u: of(self.u, other.u),
            v: of(self.v, other.v),
            uu: of(self.uu, other.uu),
            uv: of(self.uv, other.uv),
            vv: of(self.vv, other.vv),
            weight,
        }
    }
}

impl Add for Terms {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.map(other, |a, b| a + b, self.weight + other.weight)
    }
}

impl Sub for Terms {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.map(other, |a, b| a - b, self.weight - other.weight)
    }
}

impl Mul<f64> for Terms {
    type Output = Self;
    fn mul(self, s: f64) -> Self {
        self.map(self, |a, _| a * s, self.weight * s)
    }
}

impl Value for Terms {}

/// The net of a patch's [`Terms`].
fn terms(patch: &Patch) -> Net<Terms> {
    let (_, weight) = nets(patch);
    let (a, b) = numerators(patch);
    let (u, v, uu, uv, vv, cube);
    if patch.is_polynomial() {
        (uu, uv, vv, cube) = (a.du(), a.dv(), b.dv(), weight);
        (u, v) = (a, b);
    } else {
        let second = |a: &Net<DVec3>, slope: Net<DVec3>, weight_slope: &Net<f64>| {
            slope.times(&weight).minus(&a.times(weight_slope).scaled(2.0))
        };
        (uu, uv) = (second(&a, a.du(), &weight.du()), second(&a, a.dv(), &weight.dv()));
        (vv, cube) = (second(&b, b.dv(), &weight.dv()), weight.times(&weight).times(&weight));
        (u, v) = (a.times(&weight), b.times(&weight));
    }
    let (n, k) = (cube.n, cube.k);
    let [u, v, uu, uv, vv] = [u, v, uu, uv, vv].map(|net| net.elevated(n, k));
    Net::build(n, k, |i, j| Terms {
        u: u.at(i, j),
        v: v.at(i, j),
        uu: uu.at(i, j),
        uv: uv.at(i, j),
        vv: vv.at(i, j),
        weight: cube.at(i, j),
    })
}

/// A part of the unit square.
struct Piece {
    net: Net<Terms>,
    halvings: u32,
}

impl Piece {
    /// The largest over all coefficients: a bound.
    fn most<const N: usize>(&self, of: impl Fn(&Terms) -> [f64; N]) -> [f64; N] {
        self.net.all().iter().map(of).fold([0.0; N], both)
    }

    /// The largest over the corners, which lie on the surface: a lower limit of any bound.
    fn reached<const N: usize>(&self, of: impl Fn(&Terms) -> [f64; N]) -> [f64; N] {
        let (n, k) = (self.net.n, self.net.k);
        [(0, 0), (n, 0), (0, k), (n, k)].map(|(i, j)| of(&self.net.at(i, j))).into_iter().fold([0.0; N], both)
    }

    /// Across the parameter along which its second derivatives vary more.
    fn halves(self) -> [Self; 2] {
        let varies = |a: Terms, b: Terms| {
            let d = a - b;
            d.uu.length_squared() + d.uv.length_squared() + d.vv.length_squared()
        };
        let (n, k) = (self.net.n, self.net.k);
        let along_u = (0..=k).flat_map(|j| (0..n).map(move |i| (i, j)));
        let along_v = (0..k).flat_map(|j| (0..=n).map(move |i| (i, j)));
        let in_u = along_u.map(|(i, j)| varies(self.net.at(i + 1, j), self.net.at(i, j)));
        let in_v = along_v.map(|(i, j)| varies(self.net.at(i, j + 1), self.net.at(i, j)));
        let (n, k) = (n.max(1) as f64, k.max(1) as f64);
        let across_u = in_u.sum::<f64>() * n >= in_v.sum::<f64>() * k;
        let halves = if across_u { self.net.halves_u() } else { self.net.halves_v() };
        halves.map(|net| Self { net, halvings: self.halvings + 1 })
    }
}

fn both<const N: usize>(a: [f64; N], b: [f64; N]) -> [f64; N] {
    std::array::from_fn(|i| a[i].max(b[i]))
}

fn largest<const N: usize>(pieces: &[Piece], of: impl Fn(&Terms) -> [f64; N]) -> [f64; N] {
    pieces.iter().map(|p| p.most(&of)).fold([0.0; N], both)
}

/// The pieces, halved until each one's bound is near a value that is reached somewhere.
fn halved<const N: usize>(mut open: Vec<Piece>, of: impl Fn(&Terms) -> [f64; N]) -> Vec<Piece> {
    let [u, v, uu, uv, vv] = largest(&open, Terms::lengths);
    // not worth a halving: derivatives that are rounding, or below a thousandth of the largest
    let least = (FLAT * u.max(v)).max(1e-3 * uu.max(uv).max(vv));
    let mut done = Vec::new();
    while !open.is_empty() {
        let reached = open.iter().chain(&done).map(|p| p.reached(&of)).fold([0.0; N], both);
        let mut halves = Vec::new();
        for piece in open {
            let most = piece.most(&of);
            let far = (0..N).any(|i| most[i] > (reached[i] * (1.0 + SPARE)).max(least));
            match far && piece.halvings < MOST_HALVINGS {
                true => halves.extend(piece.halves()),
                false => done.push(piece),
            }
        }
        open = halves;
    }
    done
}
#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec4;
    use std::f64::consts::SQRT_2;

    fn quarter_cylinder(radius: f64, height: f64) -> Patch {
        let arc = [(1.0, 0.0, 1.0), (1.0, 1.0, SQRT_2 / 2.0), (0.0, 1.0, 1.0)];
        let points = [0.0, height]
            .iter()
            .flat_map(|&z| arc.map(|(x, y, w)| DVec4::new(x * radius * w, y * radius * w, z * w, w)))
            .collect();
        Patch { degree_u: 2, degree_v: 1, points }
    }

    #[test]
    fn the_mixed_derivative_of_a_cylinder_vanishes() {
        let b = quarter_cylinder(3.0, 100.0).derivative_bound();
        assert!(b.uv < 1e-11 * 100.0, "S_uv is 0 on every cylinder, the bound says {}", b.uv);
        assert!(b.vv < 1e-11 * 100.0);
        // the hull divides by the smallest squared weight of each piece: at most (1 / 0.89)^2 too large
        assert!(b.v >= 100.0 && b.v < 130.0, "height per unit v: {}", b.v);
    }

    #[test]
    fn bounds_hold_and_are_tight_on_random_patches() {
        use proptest::prelude::*;
        let net = (1usize..5, 1usize..4).prop_flat_map(|(n, k)| {
            let point = (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64, 0.2..5.0f64);
            (Just(n), Just(k), proptest::collection::vec(point, (n + 1) * (k + 1)))
        });
        proptest!(ProptestConfig::with_cases(200), |((n, k, points) in net)| {
            let points = points.into_iter().map(|(x, y, z, w)| DVec4::new(x * w, y * w, z * w, w)).collect();
            let patch = Patch { degree_u: n, degree_v: k, points };
            let b = patch.derivative_bound();
            let h = 1e-4;
            for i in 0..=10 {
                for j in 0..=10 {
                    let (u, v) = (h + (1.0 - 2.0 * h) * i as f64 / 10.0, h + (1.0 - 2.0 * h) * j as f64 / 10.0);
                    let at = |du: f64, dv: f64| patch.jet(u + du * h, v + dv * h);
                    let uu = (at(1.0, 0.0).du - at(-1.0, 0.0).du).length() / (2.0 * h);
                    let uv = (at(0.0, 1.0).du - at(0.0, -1.0).du).length() / (2.0 * h);
                    let vv = (at(0.0, 1.0).dv - at(0.0, -1.0).dv).length() / (2.0 * h);
                    // central differences are off by about h² times the third derivative
                    let slack = 1e-4;
                    prop_assert!(uu <= b.uu * (1.0 + slack) + slack, "S_uu {uu} > {}", b.uu);
                    prop_assert!(uv <= b.uv * (1.0 + slack) + slack, "S_uv {uv} > {}", b.uv);
                    prop_assert!(vv <= b.vv * (1.0 + slack) + slack, "S_vv {vv} > {}", b.vv);
                    prop_assert!(at(0.0, 0.0).du.length() <= b.u * (1.0 + 1e-12));
                    let (duu, dvv) = ((at(1.0, 0.0).du - at(-1.0, 0.0).du) / (2.0 * h), (at(0.0, 1.0).dv - at(0.0, -1.0).dv) / (2.0 * h));
                    let duv = (at(0.0, 1.0).du - at(0.0, -1.0).du) / (2.0 * h);
                    for step in -40..=40 {
                        let r = (f64::from(step) / 10.0).exp() * (b.vv.max(1e-9) / b.uu.max(1e-9)).sqrt();
                        let most = b.uu * r * r + 2.0 * b.twist * r + b.vv;
                        for sign in [1.0, -1.0] {
                            let form = (duu * r * r + duv * (2.0 * sign * r) + dvv).length();
                            let slack = slack * (1.0 + r) * (1.0 + r);
                            prop_assert!(form <= most + slack * (1.0 + most), "{form} > {most} at {r}");
                        }
                    }
                }
            }
        });
    }

    #[test]
    fn quarter_circle_is_tight() {
        // |S_uu| of the standard quarter circle peaks at its ends: 2 (w0 - ...) evaluated densely
        let patch = quarter_cylinder(1.0, 1.0);
        let h = 1e-4;
        let dense = (1..1000)
            .map(|i| f64::from(i) / 1000.0)
            .map(|u| (patch.jet(u + h, 0.0).du - patch.jet(u - h, 0.0).du).length() / (2.0 * h))
            .fold(0.0, f64::max);
        let bound = patch.derivative_bound().uu;
        assert!(bound >= dense * 0.999 && bound <= dense * 1.25, "bound {bound}, truth {dense}");
    }

    /// Bends that are perpendicular, and a twist between them: `(u², v², 2 t u v)` has the form
    /// `2 (x², y², 2 t x y)`, whose length is `2 sqrt(x⁴ + y⁴ + 4 t² x² y²)`, at most `2 (x² + y²)` up to `t² = 1/2`.
    #[test]
    fn a_twist_between_bends_takes_less_than_its_length() {
        let with = |t: f64| {
            let parabola = [0.0, 0.0, 1.0];
            let at = |i: usize, j: usize| DVec3::new(parabola[i], parabola[j], 2.0 * t * (i * j) as f64 / 4.0);
            let points = (0..3).flat_map(|j| (0..3).map(move |i| at(i, j).extend(1.0))).collect();
            Patch { degree_u: 2, degree_v: 2, points }.derivative_bound()
        };
        for t in [0.0, 0.3, 0.7] {
            let b = with(t);
            assert!((b.uu - 2.0).abs() < 1e-12 && (b.vv - 2.0).abs() < 1e-12 && (b.uv - 2.0 * t).abs() < 1e-12);
            assert!(b.twist < 1e-6, "{b:?}");
        }
        let b = with(1.0);
        assert!((b.twist - 2f64.sqrt()).abs() < 1e-12 && (b.uv - 2.0).abs() < 1e-12, "{b:?}");
    }
}
