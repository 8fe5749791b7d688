//! Second derivatives, curvature, and normals also where the first derivatives do not give one.
//!
//! ```text
//!    n · • ──── pole: S_u = 0, so S_u × S_v = 0        N(s, t) = S_u × S_v as one Bernstein net:
//!       ╱│╲
//!      ╱ │ ╲    the limit from inside is found,         N = Σ N_ij B_i(s) B_j(t)
//!     ╱  │  ╲   not guessed from a point nearby
//!    ▔▔▔▔▔▔▔▔▔                                          the lowest i + j with a sum that is not 0 gives it
//! ```
//!
//! With `A = P_u w - P w_u` and `B = P_v w - P w_v` the cross product is `A × B / w⁴`: a polynomial vector divided by a
//! positive number. The patch is cut so that the point is a corner. Then the first differences of the net `A × B` are
//! the Taylor terms at the corner; the first term that does not vanish is the limit along the diagonal into the patch.
//! On a collapsed side a whole row vanishes, and the limit is that across the side.
//!
//! Source: X. Ye, *Normal direction at degenerate points of NURBS surfaces*, 1996 (the idea); curvature from
//! M. P. do Carmo, *Differential Geometry of Curves and Surfaces*, 1976, section 3.3.

use super::net::numerators;
use super::{Basis, Control, Patch, PatchGrid, Surface, binomial};
use glam::{DVec3, DVec4};

/// Point and all first and second derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet2 {
    /// `S(u, v)`.
    pub point: DVec3,
    /// `∂S/∂u`.
    pub du: DVec3,
    /// `∂S/∂v`.
    pub dv: DVec3,
    /// `∂²S/∂u²`.
    pub duu: DVec3,
    /// `∂²S/∂u∂v`.
    pub duv: DVec3,
    /// `∂²S/∂v²`.
    pub dvv: DVec3,
}

/// Curvatures against the normal `S_u × S_v`, in 1 / model units: negative where the surface bends away from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curvature {
    /// The larger principal curvature.
    pub most: f64,
    /// The smaller one.
    pub least: f64,
}

impl Curvature {
    /// `k1 k2`.
    pub fn gaussian(&self) -> f64 {
        self.most * self.least
    }

    /// `(k1 + k2) / 2`.
    pub fn mean(&self) -> f64 {
        0.5 * (self.most + self.least)
    }
}

/// `|S_u × S_v|` below this share of `|S_u| |S_v|` does not give a direction by itself.
const FLAT: f64 = 1e-6;
/// A derivative below this share of its largest value over the patch is mostly rounding.
const STILL: f64 = 1e-8;
/// A Taylor term of the normals below this share of the product of its factors is skipped. Rounding turns a term of the
/// share `x` by `1e-16 / x`, skipping it turns the normal by about `x`: the square root of the rounding balances both.
const FAINT: f64 = 1e-8;
/// Below this share all is rounding; a patch that nowhere rises above [`FAINT`] is tried again down to this.
const NOISE: f64 = 1e-13;

impl Jet2 {
    /// Principal, Gaussian and mean curvature. `None` where `S_u` and `S_v` do not span a plane; see
    /// [`Surface::curvature`] for poles.
    pub fn curvature(&self) -> Option<Curvature> {
        let cross = self.du.cross(self.dv);
        let scale = self.du.length() * self.dv.length();
        if cross.length() <= 1e-12 * scale || !scale.is_finite() {
            return None;
        }
        let normal = cross.normalize();
        let (e, f, g) = (self.du.length_squared(), self.du.dot(self.dv), self.dv.length_squared());
        let (l, m, n) = (self.duu.dot(normal), self.duv.dot(normal), self.dvv.dot(normal));
        // in an orthonormal frame of the tangent plane the shape is a symmetric matrix: no cancellation in its
        // discriminant
        let (root, det) = (e.sqrt(), (e * g - f * f).max(0.0).sqrt());
        let (c, d) = (-f / (root * det), root / det); // second frame vector = c S_u + d S_v
        let a = l / e;
        let b = (l * c + m * d) / root;
        let k = l * c * c + 2.0 * m * c * d + n * d * d;
        let (mean, half) = (0.5 * (a + k), 0.5 * (a - k));
        let spread = half.hypot(b);
        let found = Curvature { most: mean + spread, least: mean - spread };
        (found.most.is_finite() && found.least.is_finite()).then_some(found)
    }

    /// From homogeneous derivatives, by the quotient rule.
    fn from_homogeneous([p, pu, pv, puu, puv, pvv]: [DVec4; 6]) -> Self {
        let point = p.point();
        let first = |d: DVec4| (d.truncate() - point * d.w) / p.w;
        let (du, dv) = (first(pu), first(pv));
        let second =
            |d: DVec4, a: DVec3, wb: f64, b: DVec3, wa: f64| (d.truncate() - a * wb - b * wa - point * d.w) / p.w;
        Self {
            point,
            du,
            dv,
            duu: second(puu, du, pu.w, du, pu.w),
            duv: second(puv, du, pv.w, dv, pu.w),
            dvv: second(pvv, dv, pv.w, dv, pv.w),
        }
    }
}

impl Surface {
    /// Point and derivatives up to the second at `(u, v)`, clamped to the domain.
    ///
    /// Computed from the B-splines that act there, without cutting the surface: single evaluations are cheap (`O(p² +
    /// q² + p q)`). At a knot the derivatives are those of the span after it.
    pub fn jet2(&self, u: f64, v: f64) -> Jet2 {
        let ((ku, kv), (nu, nv), (pu, pv)) = (self.knots(), self.counts(), self.degrees());
        let (a, b) = (Basis::new(pu, ku, nu, u), Basis::new(pv, kv, nv, v));
        let at = |du: usize, dv: usize| {
            let row = |j: usize| {
                let points = &self.points()[(b.first + j) * nu + a.first..];
                a.derivatives(du).iter().zip(points).fold(DVec4::ZERO, |s, (x, p)| s + *p * *x)
            };
            b.derivatives(dv).iter().enumerate().fold(DVec4::ZERO, |s, (j, y)| s + row(j) * *y)
        };
        Jet2::from_homogeneous([at(0, 0), at(1, 0), at(0, 1), at(2, 0), at(1, 1), at(0, 2)])
    }

    /// Principal, Gaussian and mean curvature at `(u, v)`. `None` where the tangents span no plane, or one of them is
    /// below `1e-8` of the control net's own speed there: at poles, and so near them that the tangents are mostly
    /// rounding.
    pub fn curvature(&self, u: f64, v: f64) -> Option<Curvature> {
        let jet = self.jet2(u, v);
        let ((ku, kv), (nu, nv), (pu, pv)) = (self.knots(), self.counts(), self.degrees());
        let (a, b) = (Basis::new(pu, ku, nu, u), Basis::new(pv, kv, nv, v));
        let net = (b.first..=b.first + pv).flat_map(|j| &self.points()[j * nu + a.first..][..=pu]);
        let extent = net.map(|p| p.point().distance(jet.point)).fold(0.0, f64::max);
        let speed = |knots: &[f64], at: usize| extent / (knots[at + 1] - knots[at]);
        let moves =
            jet.du.length() > STILL * speed(ku, a.first + pu) && jet.dv.length() > STILL * speed(kv, b.first + pv);
        if moves { jet.curvature() } else { None }
    }

    /// Point at `(u, v)`, clamped to the domain, without cutting the surface.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        let ((ku, kv), (nu, nv), (pu, pv)) = (self.knots(), self.counts(), self.degrees());
        let (a, b) = (Basis::new(pu, ku, nu, u), Basis::new(pv, kv, nv, v));
        let row = |j: usize| {
            let points = &self.points()[(b.first + j) * nu + a.first..];
            a.values().iter().zip(points).fold(DVec4::ZERO, |s, (x, p)| s + *p * *x)
        };
        let p: DVec4 = b.values().iter().enumerate().fold(DVec4::ZERO, |s, (j, y)| s + row(j) * *y);
        p.point()
    }

    /// Unit normal at `(u, v)`, as [`PatchGrid::normal`]. Cuts the surface anew at every call.
    pub fn normal(&self, u: f64, v: f64) -> Option<DVec3> {
        self.patches().normal(u, v)
    }
}

impl PatchGrid {
    /// Unit normal at `(u, v)`, on the side of `S_u × S_v`; a limit where that vanishes. See [`Patch::normal`].
    pub fn normal(&self, u: f64, v: f64) -> Option<DVec3> {
        let (p, s, t) = self.locate(u, v);
        p.patch.normal(s, t)
    }
}

impl Patch {
    /// Unit normal at `(u, v)` in the unit square, on the side of `S_u × S_v`.
    ///
    /// Where the cross product vanishes (a pole, a collapsed side, parallel tangents at a corner) it is the limit
    /// from inside the patch: across the side on a collapsed side, along the diagonal at a corner. `None` only when
    /// the patch has no area at all near the point.
    ///
    /// Accuracy: rounding where the derivatives are sound, `1e-12` at a limit, `1e-7` in between (closer to a pole than
    /// `1e-6` of the patch).
    pub fn normal(&self, u: f64, v: f64) -> Option<DVec3> {
        let jet = self.jet(u, v);
        let cross = jet.du.cross(jet.dv);
        let (lu, lv) = (jet.du.length(), jet.dv.length());
        let (most_u, most_v) = self.speed_bound();
        if cross.length() > FLAT * lu * lv && lu > STILL * most_u && lv > STILL * most_v {
            return cross.try_normalize();
        }
        self.normal_limit(u.clamp(0.0, 1.0), v.clamp(0.0, 1.0))
    }

    /// The leading Taylor term of `S_u × S_v` at a point, found at the corner of the larger piece on either side.
    fn normal_limit(&self, u: f64, v: f64) -> Option<DVec3> {
        let range = |x: f64| if x < 0.5 { ((x, 1.0), false) } else { ((0.0, x), true) };
        let ((ru, flip_u), (rv, flip_v)) = (range(u), range(v));
        let piece = self.rectangle(ru, rv);
        let (a, b) = numerators(&piece);
        let scale = a.largest() * b.largest();
        let net = a.cross(&b);
        let at = |i: usize, j: usize| {
            let (i, j) = (if flip_u { net.n - i } else { i }, if flip_v { net.k - j } else { j });
            net.at(i, j)
        };
        // along the diagonal s = t the terms of one order add up, each with its binomials
        let term = |order: usize| {
            (order.saturating_sub(net.k)..=order.min(net.n)).fold((DVec3::ZERO, 0.0), |(sum, share), i| {
                let weight = binomial(net.n, i) * binomial(net.k, order - i);
                (sum + at(i, order - i) * weight, share + weight)
            })
        };
        let terms: Vec<(DVec3, f64)> = (0..=net.n + net.k).map(term).collect();
        let above = |least: f64| terms.iter().find(|(sum, share)| sum.length() > least * scale * share);
        above(FAINT).or_else(|| above(NOISE)).and_then(|(sum, _)| sum.try_normalize())
    }
}
