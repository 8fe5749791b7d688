//! Pieces of an item, and what is known of all points of one.
//!
//! ```text
//!    hull        control points; their convex hull contains the piece, and lies within O(h²) of it
//!    slopes      S_u and S_v up to a positive factor, as a vector and how far it may be off
//!    profiles    about a datum line: distance from it and height along it; from a datum point: distance
//! ```
//!
//! **No minimum inside.** Where `A(u, v)` is nearest to `q` inside of a face, `(A - q)·A_u = 0` and `(A - q)·A_v = 0`.
//! A pair of pieces in which one of these products has one sign holds no minimum inside of the face; borders are pieces
//! of their own. A fold of the surface along `u` is no reason to expect a zero of the product with `A_u` there, so
//! pieces at a fold have no slope across it.
//!
//! With `x` the positions relative to a point `c` of the piece, `w S_u = (w x)_u - x w_u`: the first term is a
//! Bernstein polynomial whose coefficients are differences of control points; the second is at most `|x| |w_u|`, which
//! is small of second order.
//!
//! **Profiles.** The map from space to distance and height about a line lengthens nothing, so two pieces are no nearer
//! than their images. The square of the distance is a quotient of Bernstein polynomials: of a circle about the line it
//! comes out as one number, of a piece of any size, and in general the quotient's range is found by halving it alone.
//! Round things about one axis or centre, whose nearest points are many, are decided at once.

use super::Source;
use crate::spline::{Control, Net, Patch, binomial};
use glam::{DVec2, DVec3, DVec4};

/// Halvings in search of the range of a profile's quotient.
const HALVINGS: usize = 40;
/// Its bound and a value that it has agree within this share.
const CLOSE: f64 = 1e-13;
/// Coefficients of the largest quotient that is halved.
const MOST_COEFFICIENTS: usize = 81;

/// Control points of the largest piece that is squared for a profile.
const MOST_SQUARED: usize = 128;

/// A line or a point that pieces are seen from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Datum {
    /// A point of it, and its unit direction.
    Line(DVec3, DVec3),
    Point(DVec3),
}

/// The part of a source that a piece covers.
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// Number of the source.
    pub source: usize,
    /// Control points in model coordinates; of a curve along `u`.
    pub net: Patch,
    /// Parameters of the source.
    pub low: DVec2,
    pub high: DVec2,
    /// Folds of the surface along its sides: low and high `u`, low and high `v`.
    pub folds: [bool; 4],
    /// All its points belong to the item.
    pub is_whole: bool,
    /// How far the net may be off, model units.
    pub noise: f64,
    /// What a halving adds to that.
    pub step: f64,
}

/// A vector up to a positive factor, and how far it may be off.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slope {
    along: DVec3,
    off: f64,
}

/// A piece, or a group of pieces.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// `None` for a group.
    pub part: Option<Part>,
    pub hull: Vec<DVec3>,
    /// A ball around the hull.
    pub centre: DVec3,
    pub radius: f64,
    pub noise: f64,
    /// A point of the item, from the middle of the piece; `None` where that is trimmed away.
    pub middle: Option<DVec3>,
    /// Boxes of the images about each datum.
    profiles: Vec<(DVec2, DVec2)>,
    /// Deviation from a flat piece along `u` and `v`, and size.
    bend: DVec2,
    extent: DVec2,
    slopes: [Option<Slope>; 2],
    /// Once it was halved; `None` for a half that is trimmed away.
    pub halves: Option<[Option<usize>; 2]>,
}

impl Part {
    /// Both halves across an axis; `None` where the parameters are too fine for it.
    pub fn halved(&self, axis: usize) -> Option<[Self; 2]> {
        let middle = 0.5 * (self.low[axis] + self.high[axis]);
        if !(self.low[axis] < middle && middle < self.high[axis]) {
            return None;
        }
        let (first, second) = if axis == 0 { self.net.split_u(0.5) } else { self.net.split_v(0.5) };
        let [mut a, mut b] = [first, second].map(|net| Self { net, noise: self.noise + self.step, ..self.clone() });
        (a.high[axis], b.low[axis]) = (middle, middle);
        (a.folds[2 * axis + 1], b.folds[2 * axis]) = (false, false);
        Some([a, b])
    }

    /// Where it lies in the source.
    pub fn contains(&self, at: DVec2) -> bool {
        at.cmpge(self.low).all() && at.cmple(self.high).all()
    }
}

impl Piece {
    /// A part of its source.
    pub fn new(part: Part, source: &Source<'_>, datums: &[Datum]) -> Self {
        let hull: Vec<DVec3> = part.net.points.iter().map(|p| p.point()).collect();
        let (low, high) = bounds(&hull);
        let centre = 0.5 * (low + high);
        let radius = hull.iter().map(|p| p.distance(centre)).fold(0.0, f64::max);
        let at = 0.5 * (part.low + part.high);
        let middle = (part.is_whole || source.contains(at)).then(|| source.jet(at).point);
        let (bend, extent) = shape(&part.net, &hull);
        let mut slopes = [None; 2];
        if part.net.degree_u > 0 && part.net.degree_v > 0 {
            slopes = [0, 1].map(|axis| {
                let is_smooth = !part.folds[2 * axis] && !part.folds[2 * axis + 1];
                is_smooth.then(|| slope(&part.net, axis, centre, radius, part.noise))
            });
        }
        let profiles = datums.iter().map(|datum| profile(&part.net, &hull, datum)).collect();
        let noise = part.noise;
        Self { part: Some(part), hull, centre, radius, noise, middle, profiles, bend, extent, slopes, halves: None }
    }

    /// Two pieces as one.
    pub fn group(a: (usize, &Self), b: (usize, &Self)) -> Self {
        let (low, high) = bounds(&[&a.1.hull[..], &b.1.hull[..]].concat());
        let pick = |i: usize, k: usize| if i >> k & 1 == 0 { low[k] } else { high[k] };
        let both = a.1.profiles.iter().zip(&b.1.profiles);
        Self {
            part: None,
            hull: (0..8).map(|i| DVec3::new(pick(i, 0), pick(i, 1), pick(i, 2))).collect(),
            centre: 0.5 * (low + high),
            radius: 0.5 * low.distance(high),
            noise: a.1.noise.max(b.1.noise),
            middle: None,
            profiles: both.map(|(p, q)| (p.0.min(q.0), p.1.max(q.1))).collect(),
            bend: DVec2::INFINITY,
            extent: DVec2::INFINITY,
            slopes: [None; 2],
            halves: Some([Some(a.0), Some(b.0)]),
        }
    }

    /// The axis across which it is to be halved.
    pub fn axis(&self) -> usize {
        let need = self.needs();
        let need = if need.max_element() > self.noise { need } else { self.extent };
        usize::from(need.y > need.x)
    }

    /// How uncertain it leaves a distance, and its size, model units: 0 for a piece that is its hull but for rounding.
    pub fn need(&self) -> (f64, f64) {
        let (need, size) = (self.needs().max_element(), self.extent.max_element());
        (if need > self.noise { need } else { 0.0 }, size)
    }

    /// A piece that is not whole may have its points anywhere in the hull.
    fn needs(&self) -> DVec2 {
        match &self.part {
            Some(part) if !part.is_whole => self.bend.max(self.extent),
            _ => self.bend,
        }
    }

    /// Whether no point of this piece can be one inside of a face at which the distance from a point of `other` has a
    /// minimum.
    pub fn has_none_nearest(&self, other: &Self) -> bool {
        let reach = self.centre.distance(other.centre) + self.radius + other.radius;
        self.slopes.iter().flatten().any(|slope| {
            let ((low, high), (other_low, other_high)) =
                (range(&self.hull, slope.along), range(&other.hull, slope.along));
            let off = reach * slope.off + (self.noise + other.noise) * (slope.along.length() + slope.off);
            low - other_high > off || high - other_low < -off
        })
    }

    /// A lower bound of the distance, by the images about each datum.
    pub fn apart_in_profile(&self, other: &Self) -> f64 {
        // the datum's directions are unit vectors but for rounding
        const LENGTHENS: f64 = 1.0 - 1e-14;
        let apart = self.profiles.iter().zip(&other.profiles).map(|(a, b)| {
            let gap = (b.0 - a.1).max(a.0 - b.1).max(DVec2::ZERO);
            gap.length() * LENGTHENS
        });
        apart.fold(0.0, f64::max)
    }
}

fn bounds(points: &[DVec3]) -> (DVec3, DVec3) {
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    points.iter().fold(none, |(low, high), p| (low.min(*p), high.max(*p)))
}

/// Least and largest coordinate along a vector.
fn range(points: &[DVec3], along: DVec3) -> (f64, f64) {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    points.iter().map(|p| p.dot(along)).fold(none, |(low, high), x| (low.min(x), high.max(x)))
}

/// How far the hull deviates from a flat one along `u` and `v`, by second differences and the twist; and how long the
/// rows of the net are.
fn shape(net: &Patch, hull: &[DVec3]) -> (DVec2, DVec2) {
    let (n, k) = (net.degree_u, net.degree_v);
    let at = |i: usize, j: usize| hull[j * (n + 1) + i];
    let twist = if n > 0 && k > 0 { 0.25 * (at(0, 0) - at(n, 0) - at(0, k) + at(n, k)).length() } else { 0.0 };
    let along = |degree: usize, rows: usize, at: &dyn Fn(usize, usize) -> DVec3| {
        let (mut bend, mut extent) = (0.0_f64, 0.0_f64);
        for j in 0..=rows {
            extent = extent.max((0..degree).map(|i| at(i, j).distance(at(i + 1, j))).sum());
            let second = |i: usize| (at(i, j) - 2.0 * at(i + 1, j) + at(i + 2, j)).length();
            bend = (0..degree.saturating_sub(1)).map(second).fold(bend, f64::max);
        }
        (0.125 * (degree * degree.saturating_sub(1)) as f64 * bend + twist, extent)
    };
    let (u, v) = (along(n, k, &at), along(k, n, &|j, i| at(i, j)));
    (DVec2::new(u.0, v.0), DVec2::new(u.1, v.1))
}

/// The direction of the derivative along an axis over the whole net, whose points lie within `radius` of `centre`.
fn slope(net: &Patch, axis: usize, centre: DVec3, radius: f64, noise: f64) -> Slope {
    let (n, k) = (net.degree_u, net.degree_v);
    let at = |i: usize, j: usize| {
        let p = net.points[j * (n + 1) + i];
        (p.truncate() - centre * p.w, p.w)
    };
    let (last, next) = if axis == 0 { ((n - 1, k), (1, 0)) } else { ((n, k - 1), (0, 1)) };
    let places = (0..=last.1).flat_map(|j| (0..=last.0).map(move |i| (i, j)));
    let steps: Vec<(DVec3, f64)> = places
        .map(|(i, j)| {
            let ((p, v), (q, w)) = (at(i, j), at(i + next.0, j + next.1));
            (q - p, (w - v).abs())
        })
        .collect();
    let along = steps.iter().map(|s| s.0).sum::<DVec3>() / steps.len() as f64;
    let most = |of: &dyn Fn(&(DVec3, f64)) -> f64| steps.iter().map(of).fold(0.0, f64::max);
    let weight = net.points.iter().map(|p| p.w).fold(0.0, f64::max);
    let off = most(&|s| s.0.distance(along)) + (radius + noise) * most(&|s| s.1) + 8.0 * noise * weight;
    Slope { along, off }
}

/// The least and the largest square of the distance from `from` along some axes, but for rounding.
fn squares(net: &Patch, from: DVec3, across: &[DVec3]) -> (f64, f64) {
    // coefficients times binomials: products are convolutions, and their binomials cancel in the quotient
    let (n, k) = (net.degree_u, net.degree_v);
    let scaled = |value: &dyn Fn(&DVec4) -> f64| -> Vec<f64> {
        let share = |i: usize| binomial(n, i % (n + 1)) * binomial(k, i / (n + 1));
        net.points.iter().enumerate().map(|(i, p)| value(p) * share(i)).collect()
    };
    let square = |of: &[f64], into: &mut [f64]| {
        for (a, x) in of.iter().enumerate() {
            for (b, y) in of.iter().enumerate() {
                let (i, j) = (a % (n + 1) + b % (n + 1), a / (n + 1) + b / (n + 1));
                into[j * (2 * n + 1) + i] += x * y;
            }
        }
    };
    let none = vec![0.0; (2 * n + 1) * (2 * k + 1)];
    let (mut squares, mut weights) = (none.clone(), none);
    for axis in across {
        square(&scaled(&|p| (p.truncate() - from * p.w).dot(*axis)), &mut squares);
    }
    square(&scaled(&|p| p.w), &mut weights);
    let quotient = |sign: f64| {
        Net::build(2 * n, 2 * k, |i, j| {
            let at = j * (2 * n + 1) + i;
            DVec2::new(sign * squares[at], weights[at]) * (1.0 / (binomial(2 * n, i) * binomial(2 * k, j)))
        })
    };
    (least(quotient(1.0)), -least(quotient(-1.0)))
}

/// The box of distance and height about a datum.
fn profile(net: &Patch, hull: &[DVec3], datum: &Datum) -> (DVec2, DVec2) {
    let (from, across) = match *datum {
        Datum::Line(point, direction) => {
            let x = direction.any_orthonormal_vector();
            (point, vec![x, direction.cross(x)])
        }
        Datum::Point(point) => (point, DVec3::AXES.to_vec()),
    };
    let (n, k) = (net.degree_u, net.degree_v);
    // the cost grows with the square of the control points
    let (low, high) = if net.points.len() > MOST_SQUARED { (0.0, f64::INFINITY) } else { squares(net, from, &across) };
    // rounding: of the sums and their halves, and of coordinates
    let reach = hull.iter().map(|p| p.distance(from)).fold(0.0, f64::max);
    let ends = net.points.iter().map(|p| p.w).fold((f64::INFINITY, 0.0_f64), |(a, b), w| (a.min(w), b.max(w)));
    let roundings = ((n + 1) * (k + 1) + 16 + 2 * HALVINGS * (n + k)) as f64 * (ends.1 / ends.0).powi(2);
    let of_squares = f64::EPSILON * roundings * reach * reach;
    let of_places = 8.0 * f64::EPSILON * (reach + from.length());
    let near = ((low - of_squares).max(0.0).sqrt() - of_places).max(0.0);
    // the distance is convex: no point of the hull is farther than all of its corners. Near the datum this is better
    let aside = |p: &DVec3| across.iter().map(|axis| (*p - from).dot(*axis).powi(2)).sum::<f64>().sqrt();
    let corners = hull.iter().map(aside).fold(0.0, f64::max);
    let far = (high + of_squares).max(0.0).sqrt().min(corners) + of_places;
    let (down, up) = match *datum {
        Datum::Line(_, direction) => {
            let (low, high) = range(hull, direction);
            let height = from.dot(direction);
            (low - height - of_places, high - height + of_places)
        }
        Datum::Point(_) => (0.0, 0.0),
    };
    (DVec2::new(near, down), DVec2::new(far, up))
}

/// A lower bound of a quotient of Bernstein polynomials over the unit square, `x / y` of each coefficient with `y > 0`:
/// the least coefficient of a net halved until that is a value of the quotient, or [`HALVINGS`] times.
fn least(net: Net<DVec2>) -> f64 {
    let quotient = |c: DVec2| c.x / c.y;
    let lowest = |net: &Net<DVec2>| net.all().iter().map(|c| quotient(*c)).fold(f64::INFINITY, f64::min);
    let reached = |net: &Net<DVec2>| {
        let corners = [(0, 0), (net.n, 0), (0, net.k), (net.n, net.k)];
        corners.iter().map(|(i, j)| quotient(net.at(*i, *j))).fold(f64::INFINITY, f64::min)
    };
    let halvings = if net.all().len() > MOST_COEFFICIENTS { 0 } else { HALVINGS };
    let mut value = reached(&net);
    let mut open = vec![(lowest(&net), net)];
    for _ in 0..halvings {
        let numbers = 0..open.len();
        let Some(number) = numbers.min_by(|a, b| open[*a].0.total_cmp(&open[*b].0)) else { break };
        if open[number].0 >= value - CLOSE * value.abs() {
            break;
        }
        let (_, net) = open.swap_remove(number);
        let halves = if varies_more_along_u(&net) { net.halves_u() } else { net.halves_v() };
        for half in halves {
            value = value.min(reached(&half));
            open.push((lowest(&half), half));
        }
    }
    open.iter().map(|(bound, _)| *bound).fold(f64::INFINITY, f64::min)
}

fn varies_more_along_u(net: &Net<DVec2>) -> bool {
    let quotient = |i: usize, j: usize| net.at(i, j).x / net.at(i, j).y;
    let places = || (0..=net.k).flat_map(|j| (0..=net.n).map(move |i| (i, j)));
    let along_u = places().filter(|p| p.0 < net.n).map(|(i, j)| (quotient(i + 1, j) - quotient(i, j)).abs());
    let along_v = places().filter(|p| p.1 < net.k).map(|(i, j)| (quotient(i, j + 1) - quotient(i, j)).abs());
    along_u.fold(0.0, f64::max) >= along_v.fold(0.0, f64::max)
}
