//! One rational tensor-product Bézier patch.

use super::bernstein::{FULL, Row};
use super::{Control, MAX_DEGREE, bernstein};
use crate::math::bernstein::split;
use glam::{DVec3, DVec4};

/// A rational Bézier patch over `[0, 1]²`.
///
/// `points[j * (degree_u + 1) + i]` is the homogeneous control point `P_ij`, `i` along `u`.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// Degree along `u`.
    pub degree_u: usize,
    /// Degree along `v`.
    pub degree_v: usize,
    /// Control net, `u` fastest.
    pub points: Vec<DVec4>,
}

/// Point and first derivatives of a surface in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    /// `S(u, v)`.
    pub point: DVec3,
    /// `∂S/∂u`.
    pub du: DVec3,
    /// `∂S/∂v`.
    pub dv: DVec3,
}

impl Patch {
    /// Row `j` of the control net.
    pub fn row(&self, j: usize) -> &[DVec4] {
        let n = self.degree_u + 1;
        &self.points[j * n..(j + 1) * n]
    }

    /// Homogeneous value and both first derivatives `(P, P_u, P_v)`.
    pub fn homogeneous_jet(&self, u: f64, v: f64) -> (DVec4, DVec4, DVec4) {
        match self.degree_u {
            1 => self.jet_of::<2>(u, v),
            2 => self.jet_of::<3>(u, v),
            3 => self.jet_of::<4>(u, v),
            4 => self.jet_of::<5>(u, v),
            5 => self.jet_of::<6>(u, v),
            6 => self.jet_of::<7>(u, v),
            _ => self.jet_any(u, v),
        }
    }

    /// Rows of `N` points: loops of known length, for the degrees that most surfaces have.
    fn jet_of<const N: usize>(&self, u: f64, v: f64) -> (DVec4, DVec4, DVec4) {
        match self.degree_v {
            1 => self.jet_at::<N, 2>(u, v),
            2 => self.jet_at::<N, 3>(u, v),
            3 => self.jet_at::<N, 4>(u, v),
            4 => self.jet_at::<N, 5>(u, v),
            5 => self.jet_at::<N, 6>(u, v),
            6 => self.jet_at::<N, 7>(u, v),
            _ => self.jet_any(u, v),
        }
    }

    /// As [`Patch::jet_any`], bit for bit.
    fn jet_at<const N: usize, const K: usize>(&self, u: f64, v: f64) -> (DVec4, DVec4, DVec4) {
        let (mut values, mut slopes) = ([DVec4::ZERO; K], [DVec4::ZERO; K]);
        let row = Row::<N>::new(N - 2, u);
        for ((points, value), slope) in self.points.as_chunks::<N>().0.iter().zip(&mut values).zip(&mut slopes) {
            (*value, *slope) = row.jet_of(points, u);
        }
        let (p, dv) = Row::<K>::new(K - 2, v).jet_of(&values, v);
        (p, Row::<K>::new(K - 1, v).value_of(&slopes), dv)
    }

    fn jet_any(&self, u: f64, v: f64) -> (DVec4, DVec4, DVec4) {
        match self.degree_v {
            0..4 => self.jet_in::<4>(u, v),
            4..8 => self.jet_in::<8>(u, v),
            _ => self.jet_in::<FULL>(u, v),
        }
    }

    /// With room for `ROWS` rows. As [`bernstein::horner_jet`] of each row and of their values, bit for
    /// bit, but the weights are made once.
    fn jet_in<const ROWS: usize>(&self, u: f64, v: f64) -> (DVec4, DVec4, DVec4) {
        let (n, k) = (self.degree_u, self.degree_v);
        let (mut values, mut slopes) = ([DVec4::ZERO; ROWS], [DVec4::ZERO; ROWS]);
        let row = Row::<FULL>::new(n.saturating_sub(1), u);
        for ((points, value), slope) in self.points.chunks_exact(n + 1).zip(&mut values).zip(&mut slopes) {
            (*value, *slope) = row.jet(points, u);
        }
        let (p, dv) = Row::<FULL>::new(k.saturating_sub(1), v).jet(&values[..=k], v);
        (p, Row::<FULL>::new(k, v).value(&slopes[..=k]), dv)
    }

    /// Homogeneous value.
    pub fn homogeneous(&self, u: f64, v: f64) -> DVec4 {
        let mut values = [DVec4::ZERO; MAX_DEGREE + 1];
        let row = Row::<FULL>::new(self.degree_u, u);
        for (points, value) in self.points.chunks_exact(self.degree_u + 1).zip(&mut values) {
            *value = row.value(points);
        }
        bernstein::horner(&values[..=self.degree_v], v)
    }

    /// Point at `(u, v)`; parameters outside `[0, 1]` extrapolate.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        self.homogeneous(u, v).point()
    }

    /// Point and first derivatives, by the quotient rule.
    pub fn jet(&self, u: f64, v: f64) -> Jet {
        let (p, pu, pv) = self.homogeneous_jet(u, v);
        let point = p.point();
        let slope = |d: DVec4| (d.truncate() - point * d.w) / p.w;
        Jet { point, du: slope(pu), dv: slope(pv) }
    }

    /// The patch with `u` and `v` exchanged.
    pub fn transposed(&self) -> Self {
        let (n, k) = (self.degree_u + 1, self.degree_v + 1);
        let points = (0..n).flat_map(|i| (0..k).map(move |j| (i, j))).map(|(i, j)| self.points[j * n + i]).collect();
        Self { degree_u: self.degree_v, degree_v: self.degree_u, points }
    }

    /// The halves over `u` in `[0, t]` and `[t, 1]`.
    pub fn split_u(&self, t: f64) -> (Self, Self) {
        let n = self.degree_u + 1;
        let mut left = self.clone();
        let mut right = self.clone();
        for j in 0..=self.degree_v {
            let range = j * n..(j + 1) * n;
            right.points[range.clone()].copy_from_slice(&split(&mut left.points[range], t));
        }
        (left, right)
    }

    /// The halves over `v` in `[0, t]` and `[t, 1]`.
    pub fn split_v(&self, t: f64) -> (Self, Self) {
        let (a, b) = self.transposed().split_u(t);
        (a.transposed(), b.transposed())
    }

    /// The patch over `[u0, u1] x [v0, v1]`, re-parametrised to the unit square.
    pub fn rectangle(&self, u: (f64, f64), v: (f64, f64)) -> Self {
        let along_u = |p: &Self, (a, b): (f64, f64)| {
            if a <= 0.0 && b >= 1.0 {
                p.clone()
            } else if a < 1.0 {
                p.split_u(a).1.split_u((b - a) / (1.0 - a)).0
            } else {
                p.split_u(b).0.split_u(a / b).1
            }
        };
        let half = along_u(self, u).transposed();
        along_u(&half, v).transposed()
    }

    /// All weights equal within rounding: a polynomial patch.
    pub fn is_polynomial(&self) -> bool {
        let w = self.points[0].w;
        self.points.iter().all(|p| (p.w - w).abs() <= 1e-14 * w.abs())
    }

    /// Smallest axis-aligned box of the (Euclidean) control points; it contains the patch.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let first = self.points[0].point();
        self.points.iter().map(|p| p.point()).fold((first, first), |(lo, hi), p| (lo.min(p), hi.max(p)))
    }
}
