//! Ways to choose tessellation factors, behind one interface.
//!
//! | way | bounds | guaranteed | source |
//! |---|---|---|---|
//! | [`Way::Bound`] | second derivatives in space: pass `bound` | yes | `twin::factor` |
//! | [`Way::Homogeneous`] | second differences of the net's homogeneous pixels | yes | below |
//! | [`Way::Ipass`] | width of projected slefe boxes | no | Yeo, Bin, Peters 2012 |
//! | [`Way::Corrected`] | slefes of the homogeneous second derivatives | yes | below |
//! | [`Way::Fixed`] | nothing | no | industrial practice |
//!
//! **Homogeneous.** With the control points as homogeneous pixels `(X, Y, W)`, weights multiplied in, and `L = X - x W`
//! for a pixel of abscissa `x`, the linear interpolant over cells of `1 / tau_u` by `1 / tau_v` is off by
//!
//! ```text
//!   |x_exact - x| <= (M_uu / tau_u² + 2 M_uv / (tau_u tau_v) + M_vv / tau_v²) / (8 W_min)
//!   M_uu = sup |L_uu| <= n (n-1) max |Δ²_u L|     M_uv <= n k max |Δ_u Δ_v L|     M_vv <= k (k-1) max |Δ²_v L|
//! ```
//!
//! if the homogeneous position is interpolated between vertices without dividing by the weight. `M` is convex in `x`,
//! so the ends of the patch's range within the picture suffice. Through the near plane, with
//! `K` the larger `M(L)` of the ends, `(K / ε + M(W)) / (8 near)` takes the place of `M / (8 ε W_min)`.
//!
//! **Corrected.** Slefes guarantee the budget if they enclose *second derivatives*: the factor then bounds triangles,
//! and shrinks with the square of the interval. `L_uu`, `L_uv`, `L_vv` and `W` are Bernstein polynomials, too. Their
//! slefes are tighter than their hulls, and `L` contains the weights.

mod measure;

pub use measure::{Seen, Spread, Ways, of_model, of_random};

use super::slefe::{Enclosure, MOST_DEGREE, Slefe};
use crate::fixtures::{Emit, Trial};
use crate::spline::{Control, Patch};
use crate::twin::factor::factors;
use glam::{DVec2, DVec4};

/// A way to choose the factors of a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// The engine's way.
    Bound,
    /// Second differences of the net, after splitting it into equal pieces along each side.
    Homogeneous {
        /// Pieces along a side.
        cuts: usize,
    },
    /// Projected slefe boxes. On the GPU: pass `baseline_slefe`.
    Ipass {
        /// Segments of the slefe.
        segments: usize,
    },
    /// Slefes of second derivatives.
    Corrected {
        /// Segments of the slefe.
        segments: usize,
    },
    /// The same number for every patch.
    Fixed(usize),
}

/// Factors beyond this are a clamp.
const MOST: f64 = 4096.0;

impl Way {
    /// The quantity that must be linear between vertices for the way's bound; points for ways without a bound.
    pub(crate) fn emits(self) -> Emit {
        match self {
            Self::Homogeneous { .. } | Self::Corrected { .. } => Emit::Homogeneous,
            Self::Bound | Self::Ipass { .. } | Self::Fixed(_) => Emit::Point,
        }
    }

    /// Segments along `u` and `v`; `None` if the way gives no factor, or one above 4096.
    pub(crate) fn factors(self, trial: &Trial) -> Option<[usize; 2]> {
        let asked = match self {
            Self::Bound => return (!trial.clamped()).then_some(trial.tau),
            Self::Fixed(n) => return Some([n; 2]),
            Self::Homogeneous { cuts } => pieces(&trial.patch, cuts)
                .map(|piece| homogeneous(&piece, trial, &Hull).map(|t| t * cuts as f64))
                .fold([1.0, 1.0], |most: [f64; 2], t| [most[0].max(t[0]), most[1].max(t[1])]),
            Self::Ipass { segments } => [ipass(trial, segments); 2],
            Self::Corrected { segments } => homogeneous(&trial.patch, trial, &Slefes(segments)),
        };
        let finite = asked.iter().all(|t| (1.0..=MOST).contains(t));
        finite.then(|| asked.map(|t| t.ceil() as usize))
    }
}

fn pieces(patch: &Patch, cuts: usize) -> impl Iterator<Item = Patch> + '_ {
    let range = move |i: usize| (i as f64 / cuts as f64, (i + 1) as f64 / cuts as f64);
    (0..cuts * cuts).map(move |c| patch.rectangle(range(c % cuts), range(c / cuts)))
}

/// An enclosure of a Bernstein polynomial over the unit square: from coefficients, `u` fastest, and degrees.
trait Enclose {
    fn largest(&self, b: &[f64], n: usize, k: usize) -> f64;
    fn smallest(&self, b: &[f64], n: usize, k: usize) -> f64;
}

/// Enclosure by the coefficients.
struct Hull;

impl Enclose for Hull {
    fn largest(&self, b: &[f64], _: usize, _: usize) -> f64 {
        b.iter().fold(0.0, |m, x| m.max(x.abs()))
    }
    fn smallest(&self, b: &[f64], _: usize, _: usize) -> f64 {
        b.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

/// Enclosure by a slefe with this number of segments, or by the coefficients if they are tighter.
struct Slefes(usize);

impl Slefes {
    fn enclose(&self, b: &[f64], n: usize, k: usize) -> Option<Enclosure> {
        (n.max(k) <= MOST_DEGREE).then(|| Slefe::new(n, self.0).enclose_net(&Slefe::new(k, self.0), b))
    }
}

impl Enclose for Slefes {
    fn largest(&self, b: &[f64], n: usize, k: usize) -> f64 {
        self.enclose(b, n, k).map_or(f64::INFINITY, |e| e.largest()).min(Hull.largest(b, n, k))
    }
    fn smallest(&self, b: &[f64], n: usize, k: usize) -> f64 {
        let lowest = self.enclose(b, n, k).map(|e| e.lower.iter().copied().fold(f64::INFINITY, f64::min));
        lowest.unwrap_or(f64::NEG_INFINITY).max(Hull.smallest(b, n, k))
    }
}

/// `M_uu`, `M_uv`, `M_vv` of the net `b`.
fn second_derivatives(b: &[f64], n: usize, k: usize, by: &impl Enclose) -> [f64; 3] {
    let at = |i: usize, j: usize| b[j * (n + 1) + i];
    let net = |n: usize, k: usize, value: &dyn Fn(usize, usize) -> f64| -> f64 {
        let values: Vec<f64> = (0..=k).flat_map(|j| (0..=n).map(move |i| (i, j))).map(|(i, j)| value(i, j)).collect();
        by.largest(&values, n, k)
    };
    let (nf, kf) = (n as f64, k as f64);
    let uu = |i: usize, j: usize| (at(i, j) - 2.0 * at(i + 1, j) + at(i + 2, j)) * nf * (nf - 1.0);
    let uv = |i: usize, j: usize| (at(i, j) - at(i + 1, j) - at(i, j + 1) + at(i + 1, j + 1)) * nf * kf;
    let vv = |i: usize, j: usize| (at(i, j) - 2.0 * at(i, j + 1) + at(i, j + 2)) * kf * (kf - 1.0);
    [if n > 1 { net(n - 2, k, &uu) } else { 0.0 }, net(n - 1, k - 1, &uv), if k > 1 { net(n, k - 2, &vv) } else { 0.0 }]
}

/// The factor from homogeneous pixels, with one of the enclosures.
fn homogeneous(patch: &Patch, trial: &Trial, by: &impl Enclose) -> [f64; 2] {
    let (n, k) = (patch.degree_u, patch.degree_v);
    let frame = &trial.frame;
    let (size, near) = (DVec2::from(frame.size.map(f64::from)), f64::from(frame.near));
    let deviation = f64::from(frame.deviation_px);
    let q: Vec<DVec4> = patch.points.iter().map(|p| trial.to_pixels * *p).collect();
    let net = |of: &dyn Fn(&DVec4) -> f64| q.iter().map(of).collect::<Vec<f64>>();
    let weight = patch.points.iter().map(|p| p.w).fold(f64::INFINITY, f64::min);
    let depths = patch.points.iter().zip(&q).map(|(p, q)| q.z / p.w);
    let crosses = frame.perspective != 0 && depths.fold(f64::INFINITY, f64::min) < near;
    let pixels = q.iter().map(|q| DVec2::new(q.x, q.y) / q.w);
    let range = |(lo, hi): (DVec2, DVec2), p: DVec2| (lo.min(p), hi.max(p));
    let whole = (DVec2::ZERO, size);
    let (lo, hi) = if crosses { whole } else { pixels.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), range) };
    let (lo, hi) = (lo.clamp(DVec2::ZERO, size), hi.clamp(DVec2::ZERO, size));
    let mut most = [[0.0f64; 2]; 3];
    for (axis, end) in [(0, lo.x), (0, hi.x), (1, lo.y), (1, hi.y)] {
        let m = second_derivatives(&net(&|q| q[axis] - end * q.w), n, k, by);
        (0..3).for_each(|d| most[d][axis] = most[d][axis].max(m[d]));
    }
    let both = most.map(|[x, y]| x.hypot(y));
    let (bend, w) = if crosses {
        let w = second_derivatives(&net(&|q| q.w), n, k, by);
        (std::array::from_fn(|d| both[d] / deviation + w[d]), near * weight)
    } else {
        (both.map(|m| m / deviation), by.smallest(&net(&|q| q.w), n, k))
    };
    factors(bend.map(|b: f64| b as f32), (8.0 * w) as f32).map(f64::from)
}

/// `m sqrt(e / tolerance)`, where `e` is the largest extent of a slefe box in pixels; weights are ignored. Infinite
/// above the table's degrees, and for a box that reaches the near plane.
pub(crate) fn ipass(trial: &Trial, segments: usize) -> f64 {
    let (patch, frame) = (&trial.patch, &trial.frame);
    if patch.degree_u.max(patch.degree_v) > MOST_DEGREE {
        return f64::INFINITY;
    }
    let (rows, columns) = (Slefe::new(patch.degree_u, segments), Slefe::new(patch.degree_v, segments));
    let boxes: [Enclosure; 3] = std::array::from_fn(|axis| {
        rows.enclose_net(&columns, &patch.points.iter().map(|p| p.point()[axis]).collect::<Vec<_>>())
    });
    let mut widest = 0.0f64;
    for i in 0..boxes[0].lower.len() {
        let corner = |c: usize| {
            let at = |axis: usize| if c >> axis & 1 == 0 { boxes[axis].lower[i] } else { boxes[axis].upper[i] };
            trial.to_pixels * DVec4::new(at(0), at(1), at(2), 1.0)
        };
        let corners: [DVec4; 8] = std::array::from_fn(corner);
        if frame.perspective != 0 && corners.iter().any(|q| q.w <= f64::from(frame.near)) {
            return f64::INFINITY;
        }
        let corners = corners.map(|q| DVec2::new(q.x, q.y) / q.w);
        let span = |of: fn(DVec2) -> f64| {
            let all = corners.map(of);
            all.iter().fold(f64::NEG_INFINITY, |m, x| m.max(*x)) - all.iter().fold(f64::INFINITY, |m, x| m.min(*x))
        };
        widest = widest.max(span(|p| p.x)).max(span(|p| p.y));
    }
    (segments as f64 * (widest / f64::from(frame.deviation_px)).sqrt()).max(1.0)
}
