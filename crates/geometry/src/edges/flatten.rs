//! A curve in space as a line in the picture: at most a given part of a pixel off, at any zoom.
//!
//! ```text
//!   piece ─▶ outside a side of the picture, behind the eye, beyond the depth range?   left out
//!         ─▶ few chords are enough?   ──no──▶ halved
//!              │ yes
//!              ▼
//!           equal steps of the parameter ─▶ points (X, Y, D, W) in homogeneous pixels
//! ```
//!
//! **Theorem.** Let `C = (X, Y, W)` be a Bézier curve of degree n in homogeneous pixels with `W ≥ w > 0`, and `H` its
//! piecewise linear interpolant at τ + 1 equal parameters. If `x` is the abscissa of the curve's point at `t`, then
//! `L = X - x W` has `L(t) = 0`, and its own interpolant `X̂ - x Ŵ` differs from it by at most `max|L''| / (8 τ²)`, so that
//!
//! ```text
//!   |X̂/Ŵ - x| ≤ M(L) / (8 τ² w),    M(L) = n (n - 1) max |Δ² L_i|
//! ```
//!
//! (linear interpolation: P. J. Davis, *Interpolation and Approximation*, 1975, theorem 3.1.1; second derivatives of a
//! Bernstein polynomial are convex combinations of its second differences). The same with the roles exchanged bounds the
//! curve's distance from each point of the chord. `M` is convex in `x`, so the two ends of the picture's width bound it for
//! all `x` between. Likewise `y`; the distance is the hypotenuse. The chord in the picture is straight, as `H` is linear and
//! `Ŵ ≥ w`. So within the picture every point of the line is within the tolerance of the curve, and every point of the
//! curve within it of the line.
//!
//! Halving divides `M` by 4 and drops what lies outside, so the number of chords follows what the picture shows, not the
//! zoom. Coordinates are as exact as the control points: `f64` keeps 1e-16 of the model's distance from the origin.

use crate::model::{Camera, Edge};
use crate::spline::Bezier;
use glam::{DMat4, DVec2, DVec4};

/// Chords of a piece; one that needs more is halved.
pub const MOST_CHORDS: u32 = 16;
/// Halvings of a piece. A piece that still crosses the near plane then is shorter than rounding, and is left out; a
/// piece that is still bent is used, and counted.
pub const HALVINGS: u32 = 48;

/// A view that lines are made for.
#[derive(Clone, Copy, Debug)]
pub struct Flattening {
    matrix: DMat4,
    /// Nearest and farthest depth.
    depth: (f64, f64),
    size: DVec2,
    tolerance: f64,
    margin: f64,
}

/// A point of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinePoint {
    /// Homogeneous pixels, as [`Camera::pixel_matrix`] has them: the pixel is `(x, y) / w`.
    pub position: DVec4,
    /// The edge's parameter: number of the piece, and fraction.
    pub parameter: f64,
}

impl LinePoint {
    /// Its place in the picture.
    pub fn pixel(&self) -> DVec2 {
        self.position.truncate().truncate() / self.position.w
    }
}

/// An edge in a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lines {
    /// Each a polyline that stays in the picture, or all but its ends; in the order of the edge.
    pub lines: Vec<Vec<LinePoint>>,
    /// Pieces that miss the bound after the last halving.
    pub unresolved: usize,
}

/// The next step for a piece.
enum Fate {
    Outside,
    Chords(u32),
    Halves,
}

impl Flattening {
    /// For `camera`, `tolerance` pixels off at most, in the picture and `margin` pixels around it.
    pub fn new(camera: &Camera, tolerance: f64, margin: f64) -> Self {
        let size = DVec2::new(f64::from(camera.size.0), f64::from(camera.size.1));
        Self { matrix: camera.pixel_matrix(), depth: camera.depth_range, size, tolerance, margin }
    }

    /// The lines of an edge, model coordinates.
    pub fn edge(&self, edge: &Edge) -> Lines {
        let mut out = Lines::default();
        for (k, span) in edge.curve.iter().enumerate() {
            self.piece(&span.piece, (k as f64, k as f64 + 1.0), HALVINGS, &mut out);
        }
        out
    }

    fn piece(&self, piece: &Bezier<DVec4>, (a, b): (f64, f64), halvings: u32, out: &mut Lines) {
        let points: Vec<DVec4> = piece.points.iter().map(|p| self.matrix * *p).collect();
        let chords = match self.fate(piece, &points) {
            Fate::Outside => return,
            Fate::Chords(chords) => chords,
            Fate::Halves if halvings > 0 => {
                let (left, right) = piece.split(0.5);
                let middle = 0.5 * (a + b);
                self.piece(&left, (a, middle), halvings - 1, out);
                self.piece(&right, (middle, b), halvings - 1, out);
                return;
            }
            Fate::Halves if self.crosses_near(piece, &points) => return,
            Fate::Halves => {
                out.unresolved += 1;
                MOST_CHORDS
            }
        };
        let projected = Bezier { points };
        let at = |k: u32| match k {
            0 => projected.points[0],
            _ if k == chords => projected.points[projected.degree()],
            _ => projected.homogeneous(f64::from(k) / f64::from(chords)),
        };
        let point = |k: u32| LinePoint { position: at(k), parameter: a + (b - a) * f64::from(k) / f64::from(chords) };
        let joins = out.lines.last().and_then(|l| l.last()).is_some_and(|last| last.parameter == a);
        if !joins {
            out.lines.push(vec![point(0)]);
        }
        let line = out.lines.last_mut().expect("pushed above");
        line.extend((1..=chords).map(point));
    }

    /// Heights above the near plane, with the points' weights.
    fn near<'p>(&self, piece: &'p Bezier<DVec4>, points: &'p [DVec4]) -> impl Iterator<Item = f64> + 'p {
        let near = self.depth.0;
        piece.points.iter().zip(points).map(move |(p, q)| q.z - near * p.w)
    }

    fn crosses_near(&self, piece: &Bezier<DVec4>, points: &[DVec4]) -> bool {
        self.near(piece, points).any(|h| h < 0.0)
    }

    fn fate(&self, piece: &Bezier<DVec4>, points: &[DVec4]) -> Fate {
        let (m, far) = (self.margin, self.depth.1);
        let beyond = |side: &dyn Fn(&DVec4) -> f64| points.iter().all(|p| side(p) < 0.0);
        let outside = self.near(piece, points).all(|h| h < 0.0)
            || piece.points.iter().zip(points).all(|(p, q)| q.z > far * p.w)
            || beyond(&|p| p.x + m * p.w)
            || beyond(&|p| (self.size.x + m) * p.w - p.x)
            || beyond(&|p| p.y + m * p.w)
            || beyond(&|p| (self.size.y + m) * p.w - p.y);
        if outside {
            return Fate::Outside;
        }
        if self.crosses_near(piece, points) {
            return Fate::Halves;
        }
        let least = points.iter().map(|p| p.w).fold(f64::INFINITY, f64::min);
        let bend = self.bend(points);
        let squared = bend.length() / (8.0 * self.tolerance * least);
        // NaN and large values are halved
        if squared <= f64::from(MOST_CHORDS * MOST_CHORDS) {
            Fate::Chords((squared.sqrt().ceil() as u32).max(1))
        } else {
            Fate::Halves
        }
    }

    /// `M(L)` of the theorem, for x and for y.
    fn bend(&self, points: &[DVec4]) -> DVec2 {
        let n = (points.len() - 1) as f64;
        let largest = |value: &dyn Fn(&DVec4) -> f64| {
            points.windows(3).map(|w| (value(&w[0]) - 2.0 * value(&w[1]) + value(&w[2])).abs()).fold(0.0, f64::max)
        };
        let axis = |axis: usize| {
            let ends = [-self.margin, self.size[axis] + self.margin];
            ends.map(|x| largest(&|p| p[axis] - x * p.w)).into_iter().fold(0.0, f64::max)
        };
        DVec2::new(axis(0), axis(1)) * (n * (n - 1.0))
    }
}
