//! The function that is zero where a patch folds, or where a plane cuts it, as one Bernstein polynomial.

use crate::math::bernstein::value;
use crate::math::root::bracketed;
use crate::spline::{Control, Net, SurfacePatch};
use glam::{DMat4, DVec2, DVec3, DVec4};

/// Coefficients below this share of the product of their factors are rounding.
const NOISE: f64 = 1e-13;
/// A side of a patch on which no coefficient exceeds this share of the largest is a factor: a pole, or a fold that runs
/// along it to nine digits.
const ON_SIDE: f64 = 1e-9;
/// A side whose control points lie within this share of the patch's size is a point.
const POLE: f64 = 1e-9;
/// Share of a cell to which a root is found.
const PLACE: f64 = 1e-15;

/// `f` of a patch over its unit square, sides that are factors divided out.
#[derive(Clone, Debug)]
pub(super) struct FoldNet {
    pub n: usize,
    pub k: usize,
    /// `u` fastest.
    pub values: Vec<f64>,
    /// Coefficients below this are rounding.
    pub noise: f64,
    /// The patch's rectangle in the surface's domain.
    pub low: DVec2,
    pub side: DVec2,
    /// Size of the control net in pixels; infinite where some of it is behind the eye.
    pub pixels: f64,
}

/// A side of the unit square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Left,
    Right,
    Bottom,
    Top,
}

impl Side {
    pub const ALL: [Self; 4] = [Self::Left, Self::Right, Self::Bottom, Self::Top];

    /// `v` changes along it.
    pub fn over_v(self) -> bool {
        matches!(self, Self::Left | Self::Right)
    }

    /// The other parameter.
    pub fn at(self) -> f64 {
        if matches!(self, Self::Left | Self::Bottom) { 0.0 } else { 1.0 }
    }
}

impl FoldNet {
    /// The net of a patch in a view, and the sides that are folds. `None` for a patch that is seen edge-on.
    pub fn new(of: &SurfacePatch, matrix: &DMat4) -> Option<(Self, Vec<Side>)> {
        let patch = &of.patch;
        let projected: Vec<DVec4> = patch.points.iter().map(|p| *matrix * *p).collect();
        let middle = projected[projected.len() / 2];
        let centre = if middle.w > 0.0 { DVec2::new(middle.x, middle.y) / middle.w } else { DVec2::ZERO };
        let moved = projected.iter().map(|q| DVec3::new(q.x - centre.x * q.w, q.y - centre.y * q.w, q.w));
        let moved: Vec<DVec3> = moved.collect();
        // rows of one size: the determinant is a number without a unit
        let across = moved.iter().map(|q| q.truncate().abs().max_element()).fold(0.0, f64::max);
        let deep = moved.iter().map(|q| q.z.abs()).fold(0.0, f64::max);
        if !(across > 0.0 && across.is_finite() && deep > 0.0) {
            return None;
        }
        let (n, k) = (patch.degree_u, patch.degree_v);
        let q = Net::build(n, k, |i, j| {
            let q = moved[j * (n + 1) + i];
            DVec3::new(q.x / across, q.y / across, q.z / deep)
        });
        let (qu, qv) = (q.du(), q.dv());
        let flat = q.all().iter().all(|p| (p.z - 1.0).abs() <= 1e-14);
        let normals = qu.cross(&qv);
        let part = |c: usize| Net::build(normals.n, normals.k, |i, j| normals.at(i, j)[c]);
        let function = if flat {
            part(2)
        } else {
            let of = |c: usize| Net::build(n, k, |i, j| q.at(i, j)[c]);
            let [x, y, z] = [0, 1, 2].map(|c| part(c).times(&of(c)));
            Net::build(x.n, x.k, |i, j| x.at(i, j) + y.at(i, j) + z.at(i, j))
        };
        // precision lost where a small patch is far from the picture's origin
        let lost = 1.0 + centre.abs().max_element() * deep / across;
        let noise = NOISE * lost.min(1e6) * qu.largest() * qv.largest();
        let all = function.all();
        if all.iter().all(|c| c.abs() <= noise) {
            return None;
        }
        let visible = projected.iter().all(|p| p.w > 0.0);
        let far = moved.iter().map(|q| (q.truncate() / q.z).length()).fold(0.0, f64::max);
        let low = DVec2::new(of.u.0, of.v.0);
        let mut net = Self {
            n: function.n,
            k: function.k,
            values: all.to_vec(),
            noise,
            low,
            side: DVec2::new(of.u.1, of.v.1) - low,
            pixels: if visible { 2.0 * far } else { f64::INFINITY },
        };
        let folds = Side::ALL.into_iter().filter(|side| net.divide(*side) % 2 == 1 && !is_point(of, *side)).collect();
        Some((net, folds))
    }

    /// Of a patch that a plane cuts, `normal · p + w = 0`, and the sides that lie in it. `None` of one that lies in it.
    pub fn of_plane(of: &SurfacePatch, plane: DVec4) -> Option<(Self, Vec<Side>)> {
        let patch = &of.patch;
        let values: Vec<f64> = patch.points.iter().map(|p| plane.dot(*p)).collect();
        let size = |p: &DVec4| (plane * *p).abs().max_element();
        let noise = NOISE * patch.points.iter().map(size).fold(0.0, f64::max);
        if values.iter().all(|c| c.abs() <= noise) {
            return None;
        }
        let low = DVec2::new(of.u.0, of.v.0);
        let side = DVec2::new(of.u.1, of.v.1) - low;
        let mut net = Self { n: patch.degree_u, k: patch.degree_v, values, noise, low, side, pixels: f64::INFINITY };
        let cuts = Side::ALL.into_iter().filter(|side| net.divide(*side) % 2 == 1 && !is_point(of, *side)).collect();
        Some((net, cuts))
    }

    fn at(&self, i: usize, j: usize) -> f64 {
        self.values[j * (self.n + 1) + i]
    }

    /// Coefficients on a side.
    pub fn on(&self, side: Side) -> Vec<f64> {
        match side {
            Side::Left => (0..=self.k).map(|j| self.at(0, j)).collect(),
            Side::Right => (0..=self.k).map(|j| self.at(self.n, j)).collect(),
            Side::Bottom => (0..=self.n).map(|i| self.at(i, 0)).collect(),
            Side::Top => (0..=self.n).map(|i| self.at(i, self.k)).collect(),
        }
    }

    /// Divides the side out as often as it is a factor; returns how often.
    fn divide(&mut self, side: Side) -> usize {
        let mut times = 0;
        loop {
            let largest = self.values.iter().fold(0.0f64, |m, c| m.max(c.abs()));
            let degree = if side.over_v() { self.n } else { self.k };
            let is_factor = self.on(side).iter().all(|c| c.abs() <= (ON_SIDE * largest).max(self.noise));
            if degree == 0 || !is_factor || largest <= self.noise {
                return times;
            }
            let (n, k) = if side.over_v() { (self.n - 1, self.k) } else { (self.n, self.k - 1) };
            // u B_(i-1) of degree n - 1 is i / n B_i of degree n; (1 - u) B_i is (n - i) / n B_i
            let share = |i: usize| match side.at() {
                0.0 => (i + 1, degree as f64 / (i + 1) as f64),
                _ => (i, degree as f64 / (degree - i) as f64),
            };
            let quotient = (0..=k).flat_map(|j| (0..=n).map(move |i| (i, j))).map(|(i, j)| {
                let (from, factor) = share(if side.over_v() { i } else { j });
                factor * if side.over_v() { self.at(from, j) } else { self.at(i, from) }
            });
            self.values = quotient.collect();
            (self.n, self.k) = (n, k);
            times += 1;
        }
    }

    /// The coefficients along the line on which one parameter is `x`.
    fn line(&self, over_v: bool, x: f64) -> Vec<f64> {
        if over_v {
            let column = |i: usize| -> Vec<f64> { (0..=self.k).map(|j| self.at(i, j)).collect() };
            (0..=self.n).map(|i| value(&column(i), x)).collect()
        } else {
            self.values.chunks_exact(self.n + 1).map(|row| value(row, x)).collect()
        }
    }

    /// Where `f` is zero on that line, in a bracket.
    pub fn root(&self, over_v: bool, x: f64, (a, b): (f64, f64)) -> f64 {
        if a == b {
            return a;
        }
        let line = self.line(over_v, x);
        bracketed(|y| value(&line, y), a, b, PLACE * (b - a))
    }

    /// Derivative of the root by `x`, at a point of the fold in the unit square.
    pub fn slope(&self, over_v: bool, at: DVec2) -> f64 {
        let (x, y) = if over_v { (at.y, at.x) } else { (at.x, at.y) };
        let derivative = |c: &[f64]| -> Vec<f64> {
            let n = c.len() - 1;
            if n == 0 { vec![0.0] } else { c.windows(2).map(|w| (w[1] - w[0]) * n as f64).collect() }
        };
        let across = value(&derivative(&self.line(over_v, x)), y);
        let along = value(&derivative(&self.line(!over_v, y)), x);
        let slope = -along / across;
        if slope.is_finite() { slope } else { 0.0 }
    }
}

fn is_point(of: &SurfacePatch, side: Side) -> bool {
    let patch = &of.patch;
    let (n, k) = (patch.degree_u, patch.degree_v);
    let at = |i: usize, j: usize| patch.points[j * (n + 1) + i].point();
    let points: Vec<DVec3> = match side {
        Side::Left => (0..=k).map(|j| at(0, j)).collect(),
        Side::Right => (0..=k).map(|j| at(n, j)).collect(),
        Side::Bottom => (0..=n).map(|i| at(i, 0)).collect(),
        Side::Top => (0..=n).map(|i| at(i, k)).collect(),
    };
    let (low, high) = patch.bounds();
    points.iter().all(|p| p.distance(points[0]) <= POLE * low.distance(high))
}
