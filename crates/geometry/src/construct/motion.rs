//! The moving frame of a sweep, and its approximation by cubic pieces.
//!
//! ```text
//!   A(t) = [ s x | s y | c ]      S(u, t) = A(t) (p_x(u), p_y(u), 1)
//!
//!   x, y: the frame of least turning, turned further by the twist      c: the path       s: the scale
//! ```
//!
//! `S` is affine in the profile, so a spline for `A` alone makes the surface: its error at `t` is a convex function of
//! the profile's point, largest at one of the profile's control points. Only `t` is sampled.

use super::ConstructError;
use super::frame::{Path, PathJet, across, carried};
use glam::{DVec2, DVec3};

/// The affine frame, columns `s x`, `s y` and `c`.
pub(super) type Affine = [DVec3; 3];

/// Most nodes of a table of frames.
const MOST_NODES: usize = 1 << 17;
/// Most pieces of a fit.
const MOST_PIECES: usize = 1 << 13;
/// Samples of the error inside a piece. A cubic Hermite error has one hump (of `x² (1 - x)²`); the nearest of twelve
/// samples reaches 99 % of it.
const SAMPLES: usize = 12;
/// Factor for the error between the samples.
const MARGIN: f64 = 1.1;

/// The motion beside the path itself.
#[derive(Clone, Copy, Debug)]
pub(super) struct Laws {
    /// Direction of the profile's `x` at the start.
    pub up: Option<DVec3>,
    /// Turn from start to end, radians, even by arc length.
    pub twist: f64,
    /// Scales at start and end, even by arc length.
    pub scale: (f64, f64),
}

/// Frames at nodes along a path.
pub(super) struct Motion<'a> {
    path: &'a Path,
    laws: Laws,
    /// Parameter, frame, and length so far.
    nodes: Vec<(f64, DVec3, f64)>,
    length: f64,
    /// Twist, and the turn that closes the frame of a closed path.
    turn: f64,
    /// Bound of the frame's error, radians.
    pub frame_error: f64,
}

impl<'a> Motion<'a> {
    /// Frames to within `angle` radians, estimated by halving the steps.
    ///
    /// # Errors
    /// The frames need more than the allowed number of nodes.
    pub fn new(path: &'a Path, laws: Laws, angle: f64) -> Result<Self, ConstructError> {
        let mut steps = 16;
        let mut nodes = table(path, laws.up, steps);
        loop {
            let finer = table(path, laws.up, 2 * steps);
            let end = |n: &[(f64, DVec3, f64)]| n[n.len() - 1].1;
            let error = end(&nodes).angle_between(end(&finer));
            nodes = finer;
            steps *= 2;
            if error <= angle {
                let length = nodes[nodes.len() - 1].2;
                let holonomy = if path.closed() {
                    let (first, t) = (nodes[0].1, path.jet(0.0).tangent());
                    let last = end(&nodes);
                    last.dot(t.cross(first)).atan2(last.dot(first))
                } else {
                    0.0
                };
                return Ok(Self { path, laws, nodes, length, turn: laws.twist - holonomy, frame_error: error });
            }
            if nodes.len() > MOST_NODES {
                return Err(ConstructError::Bound { asked: angle, reached: error, pieces: nodes.len() });
            }
        }
    }

    /// Affine frame and its derivative on piece `i` of the path at `x` in `[0, 1]`.
    pub fn jet(&self, i: usize, x: f64) -> (Affine, Affine) {
        let s = &self.path.spans()[i];
        let t = s.start + (s.end - s.start) * x;
        let at = self.path.local(i, x);
        let k = self.nodes.partition_point(|n| n.0 <= t).max(1) - 1;
        let (from, r, length) = self.nodes[k];
        let (r, length) = if t > from {
            (carried(r, &self.path.jet(from), &at), length + self.path.length(from, t))
        } else {
            (r, length)
        };
        let share = length / self.length;
        let (sin, cos) = (self.turn * share).sin_cos();
        let tangent = at.tangent();
        let x = r * cos + tangent.cross(r) * sin;
        let y = tangent.cross(x);
        let (speed, turning) = (at.first.length() / self.length, at.turning());
        let rate = self.turn * speed;
        let (a, b) = self.laws.scale;
        let (scale, growth) = (a + (b - a) * share, (b - a) * speed);
        let dx = y * rate - tangent * x.dot(turning);
        let dy = -x * rate - tangent * y.dot(turning);
        ([x * scale, y * scale, at.point], [x * growth + dx * scale, y * growth + dy * scale, at.first])
    }

    /// Where the profile reaches beyond a centre of curvature of the path, by the table's nodes.
    pub fn fold(&self, profile: &[DVec2]) -> Option<ConstructError> {
        for (i, s) in self.path.spans().iter().enumerate() {
            for (t, ..) in self.nodes.iter().filter(|n| n.0 >= s.start && n.0 <= s.end) {
                let x = (t - s.start) / (s.end - s.start);
                let jet: PathJet = self.path.local(i, x);
                let bend = jet.turning() / jet.first.length();
                let ([a, b, _], _) = self.jet(i, x);
                let most = profile.iter().map(|p| (a * p.x + b * p.y).dot(bend)).fold(0.0, f64::max);
                if most >= 1.0 {
                    let radius = 1.0 / bend.length();
                    return Some(ConstructError::Folds { parameter: *t, reach: most * radius, radius });
                }
            }
        }
        None
    }

    /// Cubic pieces within `tolerance` for every point of `hull`; returns the knots, the control frames and the
    /// largest error.
    ///
    /// # Errors
    /// [`ConstructError::Bound`]
    pub fn fit(&self, hull: &[DVec2], tolerance: f64) -> Result<(Vec<f64>, Vec<Affine>, f64), ConstructError> {
        let (mut knots, mut net, mut worst) = (vec![0.0; 4], Vec::<Affine>::new(), 0.0f64);
        let mut before: Option<Affine> = None;
        let mut count = 0;
        for (i, span) in self.path.spans().iter().enumerate() {
            let width = span.end - span.start;
            // pieces still to fit, the next one last
            let mut todo = vec![(0.0, 1.0)];
            while let Some((a, b)) = todo.pop() {
                let (start, end) = (self.jet(i, a), self.jet(i, b));
                let third = (b - a) * width / 3.0;
                let cubic: [Affine; 4] = [
                    start.0,
                    std::array::from_fn(|c| start.0[c] + start.1[c] * third),
                    std::array::from_fn(|c| end.0[c] - end.1[c] * third),
                    end.0,
                ];
                let error = MARGIN * self.error(i, (a, b), &cubic, hull);
                if error > tolerance || error.is_nan() {
                    let middle = 0.5 * (a + b);
                    count += 1;
                    if count > MOST_PIECES || middle <= a || middle >= b {
                        return Err(ConstructError::Bound { asked: tolerance, reached: error, pieces: count });
                    }
                    todo.extend([(middle, b), (a, middle)]);
                    continue;
                }
                worst = worst.max(error);
                let at = span.start + width * a;
                match before {
                    None => net.push(cubic[0]),
                    // derivatives that agree need no control point at the joint
                    Some(d) if (0..3).all(|c| d[c].distance(start.1[c]) <= 1e-9 * d[c].length()) => {
                        net.pop();
                        knots.extend([at; 2]);
                    }
                    Some(_) => knots.extend([at; 3]),
                }
                net.extend(&cubic[1..]);
                before = Some(end.1);
            }
        }
        knots.extend([1.0; 4]);
        Ok((knots, net, worst))
    }

    /// Largest sampled error of one cubic piece over part `(a, b)` of piece `i` of the path.
    fn error(&self, i: usize, (a, b): (f64, f64), cubic: &[Affine; 4], hull: &[DVec2]) -> f64 {
        let one = |k: usize| {
            let x = (k as f64 + 0.5) / SAMPLES as f64;
            let y = 1.0 - x;
            let weights = [y * y * y, 3.0 * y * y * x, 3.0 * y * x * x, x * x * x];
            let (exact, _) = self.jet(i, a + (b - a) * x);
            let off: Affine =
                std::array::from_fn(|c| weights.iter().zip(cubic).map(|(w, p)| p[c] * *w).sum::<DVec3>() - exact[c]);
            hull.iter().map(|p| (off[0] * p.x + off[1] * p.y + off[2]).length()).fold(0.0, f64::max)
        };
        (0..SAMPLES).map(one).fold(0.0, f64::max)
    }
}

/// Frames and lengths at `steps` nodes in each piece of the path.
fn table(path: &Path, up: Option<DVec3>, steps: usize) -> Vec<(f64, DVec3, f64)> {
    let mut at = path.jet(0.0);
    let (mut r, mut length) = (across(at.tangent(), up), 0.0);
    let mut nodes = vec![(0.0, r, 0.0)];
    for (i, s) in path.spans().iter().enumerate() {
        let mut t = s.start;
        for k in 1..=steps {
            let x = k as f64 / steps as f64;
            let next = path.local(i, x);
            let to = if k == steps { s.end } else { s.start + (s.end - s.start) * x };
            r = carried(r, &at, &next);
            length += path.length(t, to);
            (at, t) = (next, to);
            nodes.push((t, r, length));
        }
    }
    nodes
}
