//! Rational tensor-product B-spline surfaces and their cut into Bézier patches.

use super::bspline::{Cuts, SplineError, check_knots, check_points, find_span};
use super::spare::{spare, without};
use super::{Jet, Patch};
use glam::{DVec2, DVec3, DVec4};
#[cfg(feature = "serde")]
use serde::Deserialize;
use std::ops::Range;

/// A rational B-spline surface `S(u, v) = Σ N_i(u) N_j(v) P_ij`, over the domain of its knot vectors.
///
/// `points[j * count_u + i]` is `P_ij`, `i` along `u`: homogeneous, `(w x, w y, w z, w)`, in the part's coordinates.
/// The invariants of [`BSpline`](super::BSpline) hold in both directions.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "SurfaceData"))]
pub struct Surface {
    degree_u: usize,
    degree_v: usize,
    knots_u: Vec<f64>,
    knots_v: Vec<f64>,
    points: Vec<DVec4>,
}

/// The stored form of a [`Surface`], before it is checked.
#[cfg(feature = "serde")]
#[derive(Deserialize)]
struct SurfaceData {
    degree_u: usize,
    degree_v: usize,
    knots_u: Vec<f64>,
    knots_v: Vec<f64>,
    points: Vec<DVec4>,
}

#[cfg(feature = "serde")]
impl TryFrom<SurfaceData> for Surface {
    type Error = SplineError;

    fn try_from(data: SurfaceData) -> Result<Self, SplineError> {
        Self::new((data.degree_u, data.degree_v), data.knots_u, data.knots_v, data.points)
    }
}

/// A Bézier patch with the rectangle of the surface's domain that it covers.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfacePatch {
    /// Parameter range along `u`.
    pub u: (f64, f64),
    /// Parameter range along `v`.
    pub v: (f64, f64),
    /// The patch over the unit square.
    pub patch: Patch,
}

/// The Bézier patches of a surface, row by row, `u` fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchGrid {
    /// Patches along `u`.
    pub count_u: usize,
    /// Patches along `v`.
    pub count_v: usize,
    /// `patches[j * count_u + i]`.
    pub patches: Vec<SurfacePatch>,
    /// Where the patches begin along `u`, then along `v`: side by side in memory, for [`PatchGrid::locate`].
    starts: Vec<f64>,
}

impl Surface {
    /// Checks the invariants. A knot inside the domain whose multiplicity exceeds the degree is reduced to the degree,
    /// where the control points show that the surface is one piece.
    ///
    /// # Errors
    /// The first of [`SplineError`] that does not hold, `u` before `v`.
    pub fn new(
        degrees: (usize, usize),
        knots_u: Vec<f64>,
        knots_v: Vec<f64>,
        points: Vec<DVec4>,
    ) -> Result<Self, SplineError> {
        let count_u = knots_u.len().saturating_sub(degrees.0).saturating_sub(1);
        let count_v = knots_v.len().saturating_sub(degrees.1).saturating_sub(1);
        if points.len() == count_u * count_v {
            let same = |i: usize, j: usize| (0..count_v).all(|k| points[k * count_u + i] == points[k * count_u + j]);
            let spare_u = spare(degrees.0, &knots_u, same);
            let row = |k: usize| &points[k * count_u..(k + 1) * count_u];
            let spare_v = spare(degrees.1, &knots_v, |i, j| row(i) == row(j));
            if !spare_u.is_empty() || !spare_v.is_empty() {
                let rows = without(&(0..count_v).collect::<Vec<_>>(), &spare_v);
                let net = rows.into_iter().flat_map(|k| without(row(k), &spare_u)).collect();
                return Self::new(degrees, without(&knots_u, &spare_u), without(&knots_v, &spare_v), net);
            }
        }
        check_knots(degrees.0, &knots_u, count_u)?;
        check_knots(degrees.1, &knots_v, count_v)?;
        if points.len() != count_u * count_v {
            return Err(SplineError::NetSize { points: points.len(), count_u, count_v });
        }
        check_points(&points)?;
        Ok(Self { degree_u: degrees.0, degree_v: degrees.1, knots_u, knots_v, points })
    }

    /// From parts that satisfy the invariants.
    pub(super) fn with_net(
        (degree_u, degree_v): (usize, usize),
        (knots_u, knots_v): (&[f64], &[f64]),
        points: Vec<DVec4>,
    ) -> Self {
        Self { degree_u, degree_v, knots_u: knots_u.to_vec(), knots_v: knots_v.to_vec(), points }
    }

    /// Degrees along `u` and `v`.
    pub fn degrees(&self) -> (usize, usize) {
        (self.degree_u, self.degree_v)
    }

    /// Knot vectors along `u` and `v`.
    pub fn knots(&self) -> (&[f64], &[f64]) {
        (&self.knots_u, &self.knots_v)
    }

    /// Control points along `u` and `v`.
    pub fn counts(&self) -> (usize, usize) {
        (self.knots_u.len() - self.degree_u - 1, self.knots_v.len() - self.degree_v - 1)
    }

    /// Homogeneous control net, `u` fastest.
    pub fn points(&self) -> &[DVec4] {
        &self.points
    }

    /// Parameter ranges `((u0, u1), (v0, v1))`.
    pub fn domain(&self) -> ((f64, f64), (f64, f64)) {
        let (nu, nv) = self.counts();
        ((self.knots_u[self.degree_u], self.knots_u[nu]), (self.knots_v[self.degree_v], self.knots_v[nv]))
    }

    /// All weights equal within rounding: a polynomial surface.
    pub fn is_polynomial(&self) -> bool {
        let w = self.points[0].w;
        self.points.iter().all(|p| (p.w - w).abs() <= 1e-14 * w.abs())
    }

    /// The surface cut at its knots, by blossoming; neighbours share their boundary control points
    /// bit for bit.
    pub fn patches(&self) -> PatchGrid {
        let (nu, nv) = self.counts();
        let cuts = [Cuts::new(self.degree_u, &self.knots_u, nu), Cuts::new(self.degree_v, &self.knots_v, nv)];
        let [count_u, count_v] = [cuts[0].count(), cuts[1].count()];
        let (ku, kv) = (self.degree_u + 1, self.degree_v + 1);
        // rows first: each row of control points becomes a row of Bézier pieces along u
        let width = count_u * ku;
        let mut rows = Vec::with_capacity(nv * width);
        self.points.chunks_exact(nu).for_each(|row| cuts[0].apply(row, &mut rows));
        // columns[c * height..][..height]: pieces along v of column c of those
        let height = count_v * kv;
        let mut columns: Vec<DVec4> = Vec::with_capacity(width * height);
        let mut column = Vec::with_capacity(nv);
        for c in 0..width {
            column.clear();
            column.extend(rows[c..].iter().step_by(width));
            cuts[1].apply(&column, &mut columns);
        }
        let mut patches = Vec::with_capacity(count_u * count_v);
        for (j, v) in cuts[1].ranges().enumerate() {
            for (i, u) in cuts[0].ranges().enumerate() {
                let strip = &columns[i * ku * height..(i + 1) * ku * height];
                let mut points = Vec::with_capacity(ku * kv);
                for r in 0..kv {
                    points.extend((0..ku).map(|c| strip[c * height + j * kv + r]));
                }
                let patch = Patch { degree_u: self.degree_u, degree_v: self.degree_v, points };
                patches.push(SurfacePatch { u, v, patch });
            }
        }
        PatchGrid::new(count_u, patches)
    }

    /// The part over a rectangle inside the domain, as Bézier patches with their own parameters.
    ///
    /// Exact up to the rounding of one subdivision at each side.
    ///
    /// # Errors
    /// [`SplineError`] when the rectangle is empty or outside the domain.
    pub fn within(&self, u: (f64, f64), v: (f64, f64)) -> Result<Self, SplineError> {
        self.patches().within(self.degrees(), u, v)
    }

    /// The control points, along `u` and along `v`, of the knot spans that a rectangle meets, clamped to the domain.
    pub(crate) fn points_over(&self, lo: DVec2, hi: DVec2) -> [Range<usize>; 2] {
        let ((nu, nv), (domain_u, domain_v)) = (self.counts(), self.domain());
        let along = |degree: usize, knots: &[f64], count: usize, (a, b): (f64, f64), domain: (f64, f64)| {
            let span = |t: f64| find_span(degree, knots, count, t.clamp(domain.0, domain.1));
            span(a) - degree..span(b) + 1
        };
        let u = along(self.degree_u, &self.knots_u, nu, (lo.x, hi.x), domain_u);
        let v = along(self.degree_v, &self.knots_v, nv, (lo.y, hi.y), domain_v);
        [u, v]
    }

    /// The surface over the knot spans that these control points make, along `u` and along `v`.
    pub(crate) fn part(&self, [u, v]: [Range<usize>; 2]) -> Self {
        let nu = self.counts().0;
        let knots_u = &self.knots_u[u.start..u.end + self.degree_u + 1];
        let knots_v = &self.knots_v[v.start..v.end + self.degree_v + 1];
        let points = v.flat_map(|j| &self.points[j * nu..][u.clone()]).copied().collect();
        Self::with_net(self.degrees(), (knots_u, knots_v), points)
    }

    /// Point and first derivatives at `(u, v)`, clamped to the domain.
    ///
    /// Cuts the surface anew at every call: for many evaluations keep a [`PatchGrid`].
    pub fn jet(&self, u: f64, v: f64) -> Jet {
        self.patches().jet(u, v)
    }

    /// Smallest box of the Euclidean control points; it contains the surface.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        use super::Control;
        let first = self.points[0].point();
        self.points.iter().map(|p| p.point()).fold((first, first), |(lo, hi), p| (lo.min(p), hi.max(p)))
    }
}

impl SurfacePatch {
    /// Parameters of the patch, clamped to it.
    fn local(&self, u: f64, v: f64) -> (f64, f64) {
        let share = |x: f64, (a, b): (f64, f64)| ((x - a) / (b - a)).clamp(0.0, 1.0);
        (share(u, self.u), share(v, self.v))
    }

    /// Point and first derivatives with respect to the surface's own `(u, v)`, clamped to the patch.
    pub fn jet(&self, u: f64, v: f64) -> Jet {
        let (s, t) = self.local(u, v);
        let jet = self.patch.jet(s, t);
        Jet { point: jet.point, du: jet.du / (self.u.1 - self.u.0), dv: jet.dv / (self.v.1 - self.v.0) }
    }
}

impl PatchGrid {
    /// Patches row by row, `count_u` in a row.
    pub fn new(count_u: usize, patches: Vec<SurfacePatch>) -> Self {
        let starts_v = patches.iter().step_by(count_u).map(|p| p.v.0);
        let starts = patches[..count_u].iter().map(|p| p.u.0).chain(starts_v).collect();
        Self { count_u, count_v: patches.len() / count_u, patches, starts }
    }

    /// [`Surface::within`] of the surface of degrees `n` and `k` that this was cut from: the part over a rectangle
    /// inside the domain, as Bézier patches with their own parameters.
    ///
    /// Exact up to the rounding of one subdivision at each side.
    ///
    /// # Errors
    /// [`SplineError`] when the rectangle is empty or outside the domain.
    pub fn within(&self, (n, k): (usize, usize), u: (f64, f64), v: (f64, f64)) -> Result<Surface, SplineError> {
        let touches = |a: (f64, f64), b: (f64, f64)| a.1 > b.0 && a.0 < b.1;
        let columns = self.patches[..self.count_u].iter().filter(|p| touches(p.u, u)).count();
        let kept: Vec<_> = self.patches.iter().filter(|p| touches(p.u, u) && touches(p.v, v)).collect();
        if kept.is_empty() {
            return Err(SplineError::EmptyDomain);
        }
        let local = |range: (f64, f64), to: (f64, f64)| {
            let at = |t: f64| ((t - range.0) / (range.1 - range.0)).clamp(0.0, 1.0);
            (at(to.0), at(to.1))
        };
        let pieces: Vec<Patch> = kept.iter().map(|p| p.patch.rectangle(local(p.u, u), local(p.v, v))).collect();
        let knots = |degree: usize, inner: Vec<f64>, (a, b): (f64, f64)| -> Vec<f64> {
            let inner = inner.into_iter().flat_map(|t| [t].repeat(degree));
            [a].repeat(degree + 1).into_iter().chain(inner).chain([b].repeat(degree + 1)).collect()
        };
        let inner_u = kept[1..columns].iter().map(|p| p.u.0).collect();
        let inner_v = kept.iter().step_by(columns).skip(1).map(|p| p.v.0).collect();
        let (count_u, count_v) = (columns * n + 1, kept.len() / columns * k + 1);
        let net = (0..count_v).flat_map(|j| (0..count_u).map(move |i| (i, j))).map(|(i, j)| {
            // a point that two pieces share is the later one's, but for the last
            let piece = |at: usize, degree: usize, count: usize| (at / degree).min((count - 1) / degree - 1);
            let (a, b) = (piece(i, n, count_u), piece(j, k, count_v));
            pieces[b * columns + a].points[(j - b * k) * (n + 1) + (i - a * n)]
        });
        let net = net.collect();
        Surface::new((n, k), knots(n, inner_u, u), knots(k, inner_v, v), net)
    }

    /// The patch that holds `(u, v)`, clamped to the domain, and the local parameters.
    pub fn locate(&self, u: f64, v: f64) -> (&SurfacePatch, f64, f64) {
        let p = &self.patches[self.index(u, v)];
        let (s, t) = p.local(u, v);
        (p, s, t)
    }

    /// The number of the patch that holds `(u, v)`, clamped to the domain.
    pub fn index(&self, u: f64, v: f64) -> usize {
        let last = |starts: &[f64], x: f64| starts.partition_point(|start| *start <= x).max(1) - 1;
        let (along_u, along_v) = self.starts.split_at(self.count_u);
        last(along_v, v) * self.count_u + last(along_u, u)
    }

    /// Point and first derivatives with respect to the surface's own `(u, v)`.
    pub fn jet(&self, u: f64, v: f64) -> Jet {
        self.patches[self.index(u, v)].jet(u, v)
    }

    /// Point at `(u, v)`, clamped to the domain.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        let (p, s, t) = self.locate(u, v);
        p.patch.point(s, t)
    }
}
