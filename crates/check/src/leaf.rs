//! Sub-patches small and flat enough that most rays meet each of them at most once.
//!
//! ```text
//!   Face ──patches()──▶ Bézier patches ──halve while curved──▶ leaves ──▶ boxes of a Bvh
//!                        drop what lies outside all trim loops
//! ```
//!
//! A leaf has its control net relative to its own middle `c` (so that a model far from the origin
//! loses no digits) as `(w (X - c), w)`. A leaf that is a parallelogram with equal weights, as every
//! plane is, is met in closed form; any other goes through the [`Solver`].
//!
//! Halving is only for speed: tight boxes, and first cells that are *regular* for most rays.

use super::net::{self, Degrees};
use super::solver::Solver;
use crate::model::{Bounds, Face};
use crate::spline::{Control, Patch};
use crate::trim::LoopIndex;
use glam::{DVec2, DVec3, DVec4};

/// Curvature at which halving stops: the largest relative deviation of a tangent from the mean one. From 0.1 to 0.8 the
/// time of a picture hardly changes, but the number of leaves changes by a factor of forty.
const FLAT: f64 = 0.4;
/// Halvings of a Bézier patch in each direction at most: poles never become flat.
const LEVELS: u32 = 3;
/// A net this near to a parallelogram, relative to its size, is one: below the rounding of a hit.
const AFFINE: f64 = 1e-14;
/// Rounding of `n·(X - o)` relative to the distances in it: two subtractions and a dot product.
const ROUNDING: f64 = 4e-16;
/// Roots are accepted this far outside the unit square, so that neighbours lose none between them.
const BORDER: f64 = 1e-12;
/// A root known no better than this part of the leaf, in space, is a piece of surface that contains the
/// ray (see the solver's class 4), not a pole or a tangent point.
const POINT: f64 = 1e-3;
/// How far to step from a pole towards the middle of the leaf for a normal, as a part of the way.
const OFF_POLE: f64 = 1e-6;

/// A ray in part coordinates: the points `origin + t direction`, `t` as in model coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    origin: DVec3,
    direction: DVec3,
    /// Unit normals of two planes through the ray.
    planes: (DVec3, DVec3),
}

/// A meeting of a ray and a leaf.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    /// Ray parameter.
    pub t: f64,
    /// Parameters of the surface.
    pub uv: DVec2,
    /// Point in part coordinates.
    pub point: DVec3,
    /// `S_u x S_v` in part coordinates, not a unit vector; zero where the surface has no normal.
    pub normal: DVec3,
    /// How well the point is known: a length, part coordinates.
    pub spread: f64,
}

/// One sub-patch.
#[derive(Debug)]
pub(super) struct Leaf {
    /// Index of its face in the part.
    pub face: u32,
    /// No trim curve comes near and the leaf is inside the loops.
    pub inside: bool,
    middle: DVec3,
    /// Low corner and sides of its rectangle in the surface's domain.
    low: DVec2,
    side: DVec2,
    shape: Shape,
}

#[derive(Debug)]
enum Shape {
    /// `middle + (s - 1/2) u + (t - 1/2) v`; `dual_u` and `dual_v` pick `s - 1/2` and `t - 1/2` out.
    Affine {
        normal: DVec3,
        dual_u: DVec3,
        dual_v: DVec3,
    },
    Net(Net),
}

/// A control net `(w (X - c), w)` about the middle `c` of its box.
#[derive(Debug)]
struct Net {
    degrees: Degrees,
    points: Vec<DVec4>,
    /// Largest distance of a control point from the middle.
    radius: f64,
}

impl Ray {
    pub fn new(origin: DVec3, direction: DVec3) -> Self {
        Self { origin, direction, planes: direction.normalize().any_orthonormal_pair() }
    }

    /// Place of `p` in a plane across the ray, which passes it at the origin.
    pub fn across(&self, p: DVec3) -> DVec2 {
        let from = p - self.origin;
        DVec2::new(self.planes.0.dot(from), self.planes.1.dot(from))
    }

    /// Ray parameter of the point of the ray nearest to `p`.
    pub fn parameter(&self, p: DVec3) -> f64 {
        (p - self.origin).dot(self.direction) / self.direction.length_squared()
    }

    /// Parameter and position relative to `middle` of the point nearest to it.
    fn nearest(&self, middle: DVec3) -> (f64, DVec3) {
        let o = self.origin - middle;
        let t = -o.dot(self.direction) / self.direction.length_squared();
        (t, o + self.direction * t)
    }
}

impl Leaf {
    /// Calls `found` for every point where the ray meets the leaf, in no order.
    pub fn meet(&self, ray: &Ray, solver: &mut Solver, mut found: impl FnMut(Meeting)) {
        let (start, near) = ray.nearest(self.middle);
        let mut report = |t: f64, at: DVec2, p: DVec3, normal: DVec3, spread: f64| {
            let (uv, point) = (self.low + self.side * at, self.middle + p);
            found(Meeting { t: start + t, uv, point, normal, spread });
        };
        match &self.shape {
            Shape::Affine { normal, dual_u, dual_v } => {
                let slope = normal.dot(ray.direction);
                if slope.abs() <= 1e-15 * normal.length() * ray.direction.length() {
                    return; // edge-on
                }
                let t = -normal.dot(near) / slope;
                let p = near + ray.direction * t;
                let at = DVec2::new(dual_u.dot(p), dual_v.dot(p)) + 0.5;
                if at.min_element() >= -BORDER && at.max_element() <= 1.0 + BORDER {
                    report(t, at.clamp(DVec2::ZERO, DVec2::ONE), p, *normal, 0.0);
                }
            }
            Shape::Net(net) => {
                if near.length() > net.radius * (1.0 + 1e-9) {
                    return;
                }
                net.project(ray, near, (ray.origin - self.middle).length(), solver);
                for root in &solver.roots {
                    let at = root.at.clamp(DVec2::ZERO, DVec2::ONE);
                    let (p, du, dv) = net.jet(at);
                    let spread = (du * root.spread.x).length() + (dv * root.spread.y).length();
                    if spread > POINT * net.radius {
                        continue; // edge-on
                    }
                    let normal = net.normal(at, du, dv);
                    let t = (p - near).dot(ray.direction) / ray.direction.length_squared();
                    report(t, at, p, normal, spread);
                }
            }
        }
    }
}

impl Net {
    fn new(patch: &Patch, middle: DVec3) -> Self {
        let relative = |p: &DVec4| DVec4::from_point(p.point() - middle, p.w);
        let points: Vec<DVec4> = patch.points.iter().map(relative).collect();
        let radius = points.iter().map(|p| p.point().length()).fold(0.0, f64::max);
        Self { degrees: (patch.degree_u, patch.degree_v), points, radius }
    }

    /// Solves for the ray that passes `near` the middle and starts `distance` from it.
    fn project(&self, ray: &Ray, near: DVec3, distance: f64, solver: &mut Solver) {
        let plane = |n: DVec3| n.extend(-n.dot(near));
        let (a, b) = (plane(ray.planes.0), plane(ray.planes.1));
        solver.base.clear();
        solver.base.extend(self.points.iter().map(|p| DVec2::new(a.dot(*p), b.dot(*p))));
        let weight = self.points.iter().map(|p| p.w).fold(0.0, f64::max);
        solver.solve(self.degrees, ROUNDING * (distance + self.radius) * weight);
    }

    /// Point relative to the middle and slopes by the quotient rule.
    fn jet(&self, at: DVec2) -> (DVec3, DVec3, DVec3) {
        let (h, hu, hv) = net::jet(&self.points, self.degrees, at.x, at.y);
        let p = h.point();
        let slope = |d: DVec4| (d.truncate() - p * d.w) / h.w;
        (p, slope(hu), slope(hv))
    }

    /// `S_u x S_v`, or its limit at a pole.
    fn normal(&self, at: DVec2, du: DVec3, dv: DVec3) -> DVec3 {
        let normal = du.cross(dv);
        if normal.length() > 1e-9 * self.radius * du.length().max(dv.length()) {
            return normal;
        }
        let (_, du, dv) = self.jet(at + (DVec2::splat(0.5) - at) * OFF_POLE);
        du.cross(dv)
    }

    /// The closed form, when the net is a parallelogram about the middle.
    fn affine(&self) -> Option<Shape> {
        let (n, m) = self.degrees;
        let w = self.points[0].w;
        if self.points.iter().any(|p| (p.w - w).abs() > AFFINE * w) {
            return None;
        }
        let corner = |i: usize| self.points[i].point();
        let (u, v) = (corner(n) - corner(0), corner((n + 1) * m) - corner(0));
        for (k, p) in self.points.iter().enumerate() {
            let (s, t) = ((k % (n + 1)) as f64 / n as f64, (k / (n + 1)) as f64 / m as f64);
            if (u * (s - 0.5) + v * (t - 0.5) - p.point()).length() > AFFINE * self.radius {
                return None;
            }
        }
        let normal = u.cross(v);
        let square = normal.length_squared();
        // a parallelogram without area covers nothing; the solver rejects it
        (square > 0.0).then(|| Shape::Affine {
            normal,
            dual_u: v.cross(normal) / square,
            dual_v: normal.cross(u) / square,
        })
    }

    /// Whether to halve along `u` (true) or `v` (false); `None` when flat enough.
    ///
    /// Tangents `D` are compared with their means `U`, `V`: within the tangent plane in the basis
    /// `U, V`, as the solver's `q` will, and across it as an angle.
    fn bend(&self) -> Option<bool> {
        let xyz = |d: DVec4| d.truncate();
        let (u, v) = net::mean_slopes(&self.points, self.degrees);
        let (u, v) = (xyz(u), xyz(v));
        let (lu, lv) = (u.length(), v.length());
        let normal = u.cross(v);
        let square = normal.length_squared();
        let flat = square > 0.0 && {
            let (dual_u, dual_v, unit) = (v.cross(normal) / square, normal.cross(u) / square, normal / square.sqrt());
            let deviation = |e: DVec3| DVec3::new(dual_u.dot(e).abs(), dual_v.dot(e).abs(), unit.dot(e).abs());
            let worst = |it: &mut dyn Iterator<Item = DVec3>| it.map(deviation).fold(DVec3::ZERO, DVec3::max);
            let eu = worst(&mut net::slopes_u(&self.points, self.degrees).map(|d| xyz(d) - u));
            let ev = worst(&mut net::slopes_v(&self.points, self.degrees).map(|d| xyz(d) - v));
            (eu.x + ev.x).max(eu.y + ev.y).max(eu.z / lu).max(ev.z / lv) <= FLAT
        };
        if flat {
            return None;
        }
        let (n, m) = self.degrees;
        let du: Vec<DVec4> = net::slopes_u(&self.points, self.degrees).collect(); // degrees (n - 1, m)
        let dv: Vec<DVec4> = net::slopes_v(&self.points, self.degrees).collect(); // degrees (n, m - 1)
        let longest = |it: &mut dyn Iterator<Item = DVec4>| it.map(|d| xyz(d).length()).fold(0.0, f64::max);
        let uu = longest(&mut net::slopes_u(&du, (n - 1, m)));
        let uv = longest(&mut net::slopes_v(&du, (n - 1, m)));
        let vv = longest(&mut net::slopes_v(&dv, (n, m - 1)));
        let tiny = 1e-300;
        Some(uu / lu.max(tiny) + uv / lv.max(tiny) >= vv / lv.max(tiny) + uv / lu.max(tiny))
    }
}

/// The leaves of face number `index` with their boxes.
pub(super) fn leaves(index: u32, face: &Face, loops: &LoopIndex) -> Vec<(Leaf, Bounds)> {
    let fence = Fence::new(face, loops);
    let mut out = Vec::new();
    for p in face.surface.patches().patches {
        let low = DVec2::new(p.u.0, p.v.0);
        let side = DVec2::new(p.u.1, p.v.1) - low;
        let mut stack = vec![(p.patch, low, side, (0, 0))];
        while let Some((patch, low, side, levels)) = stack.pop() {
            let Some(inside) = fence.place(low, side) else { continue };
            let (min, max) = patch.bounds();
            let middle = (min + max) * 0.5;
            let net = Net::new(&patch, middle);
            let affine = net.affine();
            let split = if affine.is_some() { None } else { net.bend() };
            let ((a, b), half, levels) = match split {
                Some(true) if levels.0 < LEVELS => (patch.split_u(0.5), DVec2::new(0.5, 1.0), (levels.0 + 1, levels.1)),
                Some(false) if levels.1 < LEVELS => {
                    (patch.split_v(0.5), DVec2::new(1.0, 0.5), (levels.0, levels.1 + 1))
                }
                _ => {
                    let shape = affine.unwrap_or(Shape::Net(net));
                    out.push((Leaf { face: index, inside, middle, low, side, shape }, Bounds { min, max }));
                    continue;
                }
            };
            stack.push((a, low, side * half, levels));
            stack.push((b, low + side * (DVec2::ONE - half), side * half, levels));
        }
    }
    out
}

/// The boxes of a face's trim curves: a rectangle that meets none is on one side of all.
struct Fence<'a> {
    loops: &'a LoopIndex,
    boxes: Vec<(DVec2, DVec2)>,
    margin: DVec2,
}

impl<'a> Fence<'a> {
    fn new(face: &Face, loops: &'a LoopIndex) -> Self {
        let curve_box = |points: &[DVec3]| {
            let p = points.iter().map(|p| p.point());
            p.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)))
        };
        let boxes = face.loops.iter().flat_map(|l| l.curves().map(|c| curve_box(&c.points)).collect::<Vec<_>>());
        let ((u0, u1), (v0, v1)) = face.surface.domain();
        // wide against the rounding of a parameter, narrow against any feature
        let margin = DVec2::new(u1 - u0, v1 - v0) * 1e-9;
        Self { loops, boxes: boxes.collect(), margin }
    }

    /// `Some(true)`: all inside. `Some(false)`: needs the test. `None`: all outside.
    fn place(&self, low: DVec2, side: DVec2) -> Option<bool> {
        let (low, high) = (low - self.margin, low + side + self.margin);
        if self.boxes.iter().any(|(a, b)| a.cmple(high).all() && b.cmpge(low).all()) {
            return Some(false);
        }
        (self.boxes.is_empty() || self.loops.contains((low + high) * 0.5)).then_some(true)
    }
}
