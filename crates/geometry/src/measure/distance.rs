//! The smallest distance between points, edges and faces.
//!
//! ```text
//!   face = its surface inside the loops  ∪  its trim curves on the surface  (edges and corners among them)
//!   of each pair of pieces: samples ─▶ the nearest few ─▶ Newton on |A(x) - B(y)|² in a box ─▶ the least of all
//! ```
//!
//! A minimum inside a face counts when its (u, v) is inside the loops; every other minimum lies on a trim curve.
//! Newton's method ends where the gradient is rounding. The distance of the pair of points that it finds is then right
//! within [`Distance::error`]. Samples decide that no other pair is nearer: pieces are skipped only where their
//! samples, less the gaps between them, are farther apart than a distance already found.

use crate::model::Face;
use crate::spline::{Bezier, Surface};
use crate::trim::LoopIndex;
use glam::{DAffine3, DVec2, DVec3, DVec4};

/// The nearest pair of points of two items.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Model units.
    pub distance: f64,
    /// On the first and on the second item, model coordinates.
    pub points: [DVec3; 2],
    /// How much the last step changed it, and the rounding of the coordinates; model units.
    pub error: f64,
}

/// Samples of a curve.
const ALONG: usize = 24;
/// Samples of a surface along each side, most; four in each span.
const ACROSS: usize = 24;
/// Starts of Newton's method for a pair of pieces.
const STARTS: usize = 4;
/// Its steps.
const STEPS: usize = 60;

/// One piece: a point, a curve over `[0, 1]`, or a surface over a box.
enum Piece<'a> {
    Point(DVec3),
    Curve(DAffine3, &'a Bezier<DVec4>),
    /// A trim curve on its surface.
    Trim(DAffine3, &'a Surface, Bezier<DVec3>),
    Surface(DAffine3, &'a Surface, LoopIndex, (DVec2, DVec2)),
}

/// A point of a piece, and its parameters.
#[derive(Clone, Copy)]
struct Look {
    at: DVec2,
    point: DVec3,
}

/// A piece with its samples and the largest gap between neighbours.
pub struct Sampled<'a> {
    piece: Piece<'a>,
    looks: Vec<Look>,
    gap: f64,
}

impl Piece<'_> {
    fn dimension(&self) -> usize {
        match self {
            Self::Point(_) => 0,
            Self::Curve(..) | Self::Trim(..) => 1,
            Self::Surface(..) => 2,
        }
    }

    fn domain(&self) -> (DVec2, DVec2) {
        match self {
            Self::Surface(.., domain) => *domain,
            _ => (DVec2::ZERO, DVec2::ONE),
        }
    }

    /// Point and derivatives.
    fn jet(&self, at: DVec2) -> (DVec3, [DVec3; 2]) {
        match self {
            Self::Point(p) => (*p, [DVec3::ZERO; 2]),
            Self::Curve(transform, curve) => {
                let (p, d) = curve.jet(at.x);
                let point = p.truncate() / p.w;
                let along = (d.truncate() - point * d.w) / p.w;
                (transform.transform_point3(point), [transform.transform_vector3(along), DVec3::ZERO])
            }
            Self::Trim(transform, surface, curve) => {
                let (p, d) = curve.jet(at.x);
                let uv = p.truncate() / p.z;
                let speed = (d.truncate() - uv * d.z) / p.z;
                let jet = surface.jet2(uv.x, uv.y);
                let along = jet.du * speed.x + jet.dv * speed.y;
                (transform.transform_point3(jet.point), [transform.transform_vector3(along), DVec3::ZERO])
            }
            Self::Surface(transform, surface, ..) => {
                let jet = surface.jet2(at.x, at.y);
                let [du, dv] = [jet.du, jet.dv].map(|d| transform.transform_vector3(d));
                (transform.transform_point3(jet.point), [du, dv])
            }
        }
    }

    fn contains(&self, at: DVec2) -> bool {
        match self {
            Self::Surface(_, _, loops, _) => loops.contains(at),
            _ => true,
        }
    }
}

impl<'a> Sampled<'a> {
    fn new(piece: Piece<'a>) -> Self {
        let (low, high) = piece.domain();
        let counts = match &piece {
            Piece::Point(_) => (1, 1),
            Piece::Curve(..) | Piece::Trim(..) => (ALONG + 1, 1),
            Piece::Surface(_, surface, ..) => {
                let ((pu, pv), (nu, nv)) = (surface.degrees(), surface.counts());
                let count = |points: usize, degree: usize| (4 * (points - degree)).clamp(9, ACROSS) + 1;
                (count(nu, pu), count(nv, pv))
            }
        };
        let share = |i: usize, n: usize| if n > 1 { i as f64 / (n - 1) as f64 } else { 0.0 };
        let at = |i, j| low + (high - low) * DVec2::new(share(i, counts.0), share(j, counts.1));
        let grid: Vec<Look> = (0..counts.1)
            .flat_map(|j| (0..counts.0).map(move |i| (i, j)))
            .map(|(i, j)| Look { at: at(i, j), point: piece.jet(at(i, j)).0 })
            .collect();
        let mut gap = 0.0_f64;
        for (k, look) in grid.iter().enumerate() {
            let (i, j) = (k % counts.0, k / counts.0);
            if i + 1 < counts.0 {
                gap = gap.max(look.point.distance(grid[k + 1].point));
            }
            if j + 1 < counts.1 {
                gap = gap.max(look.point.distance(grid[k + counts.0].point));
            }
        }
        Self { piece, looks: grid, gap }
    }

    /// A point, model coordinates.
    pub fn point(point: DVec3) -> Vec<Self> {
        vec![Self::new(Piece::Point(point))]
    }

    /// A placed edge.
    pub fn edge(edge: &'a crate::model::Edge, transform: DAffine3) -> Vec<Self> {
        edge.curve.iter().map(|span| Self::new(Piece::Curve(transform, &span.piece))).collect()
    }

    /// A placed face.
    pub fn face(face: &'a Face, transform: DAffine3) -> Vec<Self> {
        let ((u0, u1), (v0, v1)) = face.surface.domain();
        let whole = (DVec2::new(u0, v0), DVec2::new(u1, v1));
        let mut domain = whole;
        if !face.loops.is_empty() {
            let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
            let all = face.loops.iter().map(|l| l.bounds()).fold(none, |(l, h), (a, b)| (l.min(a), h.max(b)));
            domain = (all.0.clamp(whole.0, whole.1), all.1.clamp(whole.0, whole.1));
        }
        let trims = face.loops.iter().flat_map(|l| l.curves().collect::<Vec<_>>());
        let mut all: Vec<Self> = trims.map(|curve| Self::new(Piece::Trim(transform, &face.surface, curve))).collect();
        all.push(Self::new(Piece::Surface(transform, &face.surface, LoopIndex::new(&face.loops), domain)));
        all
    }
}

/// The smallest distance between two items; `None` where one of them has no points.
pub fn smallest(a: &[Sampled<'_>], b: &[Sampled<'_>]) -> Option<Distance> {
    let all = a.iter().flat_map(|x| b.iter().map(move |y| (x, y)));
    let mut pairs: Vec<_> = all
        .filter_map(|(x, y)| {
            let near = nearest(x, y);
            Some((near.first()?.0 - x.gap - y.gap, x, y, near))
        })
        .collect();
    pairs.sort_by(|p, q| p.0.total_cmp(&q.0));
    let mut best: Option<Distance> = None;
    for (least, x, y, starts) in pairs {
        if best.is_some_and(|best| least > best.distance) {
            break;
        }
        for (_, from, to) in starts {
            let Some(found) = newton(&x.piece, &y.piece, from.at, to.at) else { continue };
            if best.is_none_or(|best| found.distance < best.distance) {
                best = Some(found);
            }
        }
    }
    best
}

/// The nearest pairs of samples, far apart from each other in the first piece.
fn nearest(a: &Sampled<'_>, b: &Sampled<'_>) -> Vec<(f64, Look, Look)> {
    let of = |look: &Look| {
        let distance = |other: &&Look| look.point.distance_squared(other.point);
        let other = b.looks.iter().min_by(|p, q| distance(p).total_cmp(&distance(q)))?;
        Some((look.point.distance(other.point), *look, *other))
    };
    let mut all: Vec<_> = a.looks.iter().filter_map(of).collect();
    all.sort_by(|p, q| p.0.total_cmp(&q.0));
    let mut kept: Vec<(f64, Look, Look)> = Vec::new();
    for pair in all {
        let fresh = kept.iter().all(|k| k.1.point.distance(pair.1.point) > 1.5 * a.gap);
        if kept.len() < STARTS && (fresh || kept.is_empty()) {
            kept.push(pair);
        }
    }
    kept
}

/// Newton's method from a pair of samples; `None` where it ends outside of a face.
fn newton(a: &Piece<'_>, b: &Piece<'_>, at_a: DVec2, at_b: DVec2) -> Option<Distance> {
    let (da, db) = (a.dimension(), b.dimension());
    let n = da + db;
    let ((la, ha), (lb, hb)) = (a.domain(), b.domain());
    let pick = |x: DVec2, y: DVec2| {
        let mut all = [0.0; 4];
        all[..da].copy_from_slice(&x.to_array()[..da]);
        all[da..n].copy_from_slice(&y.to_array()[..db]);
        all
    };
    let (low, high) = (pick(la, lb), pick(ha, hb));
    let spread = |x: &[f64; 4]| {
        let mut parts = [DVec2::ZERO; 2];
        (0..da).for_each(|i| parts[0][i] = x[i]);
        (0..db).for_each(|i| parts[1][i] = x[da + i]);
        parts
    };
    // half the square of the distance, and its gradient
    let value = |x: &[f64; 4]| {
        let [p, q] = spread(x);
        let ((pa, ja), (pb, jb)) = (a.jet(p), b.jet(q));
        let apart = pa - pb;
        let mut gradient = [0.0; 4];
        (0..da).for_each(|i| gradient[i] = apart.dot(ja[i]));
        (0..db).for_each(|i| gradient[da + i] = -apart.dot(jb[i]));
        (0.5 * apart.length_squared(), gradient, [pa, pb])
    };
    let mut x = pick(at_a, at_b);
    let (mut f, mut gradient, mut points) = value(&x);
    let (mut damping, mut change) = (1e-6, f64::INFINITY);
    for _ in 0..STEPS {
        // parameters that are held by the box
        let held: [bool; 4] = std::array::from_fn(|i| {
            i >= n || x[i] <= low[i] && gradient[i] > 0.0 || x[i] >= high[i] && gradient[i] < 0.0
        });
        let mut hessian = [[0.0; 4]; 4];
        for i in (0..n).filter(|i| !held[*i]) {
            let step = 1e-6 * (high[i] - low[i]);
            let (mut up, mut down) = (x, x);
            (up[i], down[i]) = ((x[i] + step).min(high[i]), (x[i] - step).max(low[i]));
            let (above, below) = (value(&up).1, value(&down).1);
            (0..n).for_each(|j| hessian[i][j] = (above[j] - below[j]) / (up[i] - down[i]));
        }
        let Some(step) = solve(&hessian, &gradient, &held, damping) else {
            damping = (damping * 10.0).max(1e-6);
            if damping > 1e12 {
                break;
            }
            continue;
        };
        let next: [f64; 4] = std::array::from_fn(|i| (x[i] - step[i]).clamp(low[i], high[i]));
        let (g, next_gradient, next_points) = value(&next);
        if g.is_finite() && g <= f {
            change = (2.0 * f).sqrt() - (2.0 * g).sqrt();
            let done = change <= 1e-15 * (2.0 * f).sqrt() || next == x;
            (x, f, gradient, points) = (next, g, next_gradient, next_points);
            damping *= 0.1;
            if done {
                break;
            }
        } else {
            damping = (damping * 10.0).max(1e-6);
            if damping > 1e12 {
                break;
            }
        }
    }
    let [p, q] = spread(&x);
    let size = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    (a.contains(p) && b.contains(q)).then(|| Distance {
        distance: (2.0 * f).sqrt(),
        points,
        error: if change.is_finite() { change } else { 0.0 } + 8.0 * f64::EPSILON * size,
    })
}

/// `(H + damping diag |H|) s = g` over the parameters that are not held, by Cholesky's method; `None` where the matrix
/// is not positive definite.
fn solve(hessian: &[[f64; 4]; 4], gradient: &[f64; 4], held: &[bool; 4], damping: f64) -> Option<[f64; 4]> {
    let free: Vec<usize> = (0..4).filter(|i| !held[*i]).collect();
    let n = free.len();
    let largest = free.iter().map(|i| hessian[*i][*i].abs()).fold(f64::MIN_POSITIVE, f64::max);
    let mut lower = [[0.0_f64; 4]; 4];
    for r in 0..n {
        for c in 0..=r {
            let (i, j) = (free[r], free[c]);
            let mut sum = 0.5 * (hessian[i][j] + hessian[j][i]);
            if r == c {
                sum += damping * sum.abs().max(1e-12 * largest);
            }
            sum -= (0..c).map(|k| lower[r][k] * lower[c][k]).sum::<f64>();
            if r == c {
                if sum <= 1e-14 * largest {
                    return None;
                }
                lower[r][r] = sum.sqrt();
            } else {
                lower[r][c] = sum / lower[c][c];
            }
        }
    }
    let mut y = [0.0; 4];
    for r in 0..n {
        let sum: f64 = (0..r).map(|k| lower[r][k] * y[k]).sum();
        y[r] = (gradient[free[r]] - sum) / lower[r][r];
    }
    let mut step = [0.0; 4];
    for r in (0..n).rev() {
        let sum: f64 = (r + 1..n).map(|k| lower[k][r] * step[free[k]]).sum();
        step[free[r]] = (y[r] - sum) / lower[r][r];
    }
    Some(step)
}
