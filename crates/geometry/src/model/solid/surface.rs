//! Coincident surfaces: one index for all faces that lie on one carrier.
//!
//! ```text
//!   plate  z = 0 ... 2      top of the plate ────────┐
//!   hole   z = 0 ... 2      top of the hole  ────────┴─▶ surface 5, evaluated once per ray by one formula:
//!   boss   z = 2 ... 4      bottom of the boss (flipped) ┘   equal parameters are equal bit for bit
//! ```
//!
//! At one ray parameter the toggles of the whole coincident group apply together, and a face exists only where the
//! state before differs from the state after. This is the regularised Boolean operation. It needs exact equality: a
//! tolerance on ray parameters would close gaps.
//!
//! Two carriers are one when each passes within the tolerance of sample points on the other, spread as far as its face.
//! The first carrier represents the rest. A key, a fixed combination of the coefficients that nearly coincident
//! carriers nearly share, finds the candidates of a large face. A small face may lean, and change its key: its
//! candidates are the surfaces of faces that it may touch, and those with the same key. (Faces apart are never met at
//! one depth; they may share a surface, but need not.)

use super::carrier::Carrier;
use super::nearby::Nearby;
use super::shape::{Quadric, Shape};
use super::{Primitive, Solid};
use crate::model::Bounds;
use glam::{DAffine3, DMat3, DVec3};
use std::collections::BTreeMap;

/// A surface that carries one or more faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The formula, in the coordinates of [`Surface::primitive`].
    pub carrier: Carrier,
    /// The solid's coordinates to those of the formula.
    pub to_own: DAffine3,
    /// The primitive whose face represents the others.
    pub primitive: u32,
}

/// A face of a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CarriedFace {
    /// Index of its surface.
    pub surface: u32,
    /// The inside of the face is where the surface's value is positive.
    pub flipped: bool,
}

/// The distinct surfaces of a solid, and the surface of each face.
#[derive(Clone, Debug)]
pub struct SurfaceTable {
    surfaces: Vec<Surface>,
    faces: Vec<CarriedFace>,
    /// Of each primitive, the first of its faces; one more at the end.
    starts: Vec<u32>,
    /// The tolerance, in the solid's units.
    distance: f64,
}

/// A face before it has a surface.
struct Candidate {
    surface: Surface,
    samples: Vec<DVec3>,
    /// Diameter of the samples.
    size: f64,
    /// The samples do not cover the face.
    anywhere: bool,
}

impl SurfaceTable {
    /// Tolerance for files that round to six digits: coplanar faces come back from a rotation up to 2.5e-6
    /// of their coordinates apart, while gaps of 1e-5 of the model stay open.
    pub const ROUNDED: f64 = 4e-6;
    /// Least tolerance for drawing. Single precision may confuse two faces that are nearer than some ten of these, at
    /// single pixels where rays graze them.
    pub const FINEST: f64 = 1e-7;
    /// Largest tolerance for drawing.
    pub const COARSEST: f64 = 1e-3;
    /// Tolerance for coordinates in full precision.
    pub const EXACT: f64 = 1e-11;

    /// Finds the coincident carriers of `solid`. `tolerance` is a distance relative to the diagonal of all
    /// bounded primitives' boxes. Empty primitives (see [`Primitive::to_own`](super::Primitive::to_own))
    /// have no faces here.
    ///
    /// Cost: `O(n log n)` for `n` carriers, unless many nearly coincide, or touch.
    pub fn new(solid: &Solid, tolerance: f64) -> Self {
        let boxes = solid.primitives().iter().map(super::Primitive::bounds);
        let whole = boxes.filter(|b| !b.is_empty() && b.diagonal().is_finite()).fold(Bounds::EMPTY, Bounds::union);
        let (centre, size) = if whole.is_empty() { (DVec3::ZERO, 1.0) } else { (whole.centre(), whole.diagonal()) };
        let distance = tolerance * size;
        let each = || (0..).zip(solid.primitives());
        let candidates = |(index, p)| Candidate::of(index, p, (centre, size));
        let boxes = each().flat_map(candidates).map(|c| c.near(distance)).collect();
        let nearby = Nearby::new(boxes, distance);
        let mut finder = Finder { centre, size, distance, nearby, ..Finder::default() };
        let mut table = Self { surfaces: Vec::new(), faces: Vec::new(), starts: vec![0], distance };
        for primitive in each() {
            for candidate in candidates(primitive) {
                let face = finder.find(candidate, &table.faces);
                table.faces.push(face);
            }
            table.starts.push(table.faces.len() as u32);
        }
        table.surfaces = finder.kept.into_iter().map(|c| c.surface).collect();
        table
    }

    /// How far a face may be from the surface that it shares, in the solid's units. A primitive reaches so far beyond
    /// its [`bounds`](super::Primitive::bounds).
    pub fn distance(&self) -> f64 {
        self.distance
    }

    /// The distinct surfaces.
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// The faces of a primitive, in the order of [`Shape::carriers`]; none of a part, nor of an empty
    /// primitive.
    pub fn faces(&self, primitive: u32) -> &[CarriedFace] {
        let p = primitive as usize;
        &self.faces[self.starts[p] as usize..self.starts[p + 1] as usize]
    }
}

impl Candidate {
    /// The faces of a primitive, none of an empty one; `whole` is the middle and the size of the model.
    fn of(index: u32, primitive: &Primitive, whole: (DVec3, f64)) -> impl Iterator<Item = Self> + '_ {
        let to_own = primitive.to_own().filter(|_| !primitive.shape.bounds().is_empty());
        to_own.into_iter().flat_map(move |to_own| {
            let (centre, size) = whole;
            // unbounded shapes are compared all over the model
            let reach = 0.5 * size * to_own.matrix3.to_cols_array().iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let samples = primitive.shape.samples(to_own.transform_point3(centre), reach);
            primitive.shape.carriers().into_iter().zip(samples).map(move |(carrier, own)| {
                let samples: Vec<DVec3> = own.iter().map(|p| primitive.transform.transform_point3(*p)).collect();
                let size = bounds_of(&samples).diagonal();
                let anywhere = matches!(primitive.shape, Shape::Quadric(_));
                Self { surface: Surface { carrier, to_own, primitive: index }, samples, size, anywhere }
            })
        })
    }

    /// A box around all of the face: circles are sampled at seven points and more, so they reach less than half their
    /// size beyond these.
    fn near(&self, distance: f64) -> Bounds {
        if self.anywhere {
            return Bounds { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
        }
        let (b, beyond) = (bounds_of(&self.samples), DVec3::splat(0.5 * self.size + distance));
        Bounds { min: b.min - beyond, max: b.max + beyond }
    }
}

fn bounds_of(points: &[DVec3]) -> Bounds {
    points.iter().copied().fold(Bounds::EMPTY, Bounds::with)
}

impl Surface {
    /// First-order distance of a point from the surface, in the solid's units, and the gradient there;
    /// `None` where there is no gradient.
    fn distance(&self, p: DVec3) -> Option<(f64, DVec3)> {
        let own = self.to_own.transform_point3(p);
        let gradient = self.to_own.matrix3.transpose() * self.carrier.gradient(own);
        let length = gradient.length();
        // an apex: value and gradient vanish together
        (length > 0.0).then(|| (self.carrier.value(own).abs() / length, gradient))
    }

    /// Ten coefficients of the polynomial about `centre` in units of `size`, of unit length in those of
    /// second order (first, for a plane); three for a torus, its centre. Up to sign the same for the same
    /// surface.
    fn coefficients(&self, centre: DVec3, size: f64) -> [f64; 10] {
        let m = self.to_own.matrix3 * size;
        let o = self.to_own.transform_point3(centre);
        let (second, first, zeroth) = match &self.carrier {
            Carrier::Plane { normal, offset } => (DMat3::ZERO, m.transpose() * *normal, normal.dot(o) - offset),
            Carrier::Quadric(q) => {
                let columns = [m.x_axis, m.y_axis, m.z_axis].map(|c| m.transpose() * (0.5 * q.slope(c)));
                let [x, y, z] = columns;
                (DMat3::from_cols(x, y, z), m.transpose() * q.gradient(o), q.value(o))
            }
            // the sphere about its centre represents it
            Carrier::Torus { .. } => {
                let at = -(self.to_own.inverse().transform_point3(DVec3::ZERO) - centre) / size;
                return [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 2.0 * at.x, 2.0 * at.y, 2.0 * at.z, at.length_squared()];
            }
        };
        let squares = DVec3::new(second.x_axis.x, second.y_axis.y, second.z_axis.z);
        let products = 2.0 * DVec3::new(second.x_axis.y, second.y_axis.z, second.z_axis.x);
        let order2 = (squares.length_squared() + products.length_squared()).sqrt();
        let scale = if order2 > 1e-12 * first.length() { order2 } else { first.length() };
        let all = [squares.to_array(), products.to_array(), first.to_array()].concat();
        std::array::from_fn(|i| all.get(i).copied().unwrap_or(zeroth) / scale)
    }
}

/// Weights of the key: of no special direction.
const WEIGHTS: [f64; 10] = [0.291, 0.613, 0.847, 0.379, 0.523, 0.701, 0.947, 0.659, 0.431, 0.773];
/// The key moves at most this much per unit of displacement over size: the coefficients' sensitivity (4 by
/// translation, 8 by rotation) times the weights' sum.
const SENSITIVITY: f64 = 80.0;
/// Rounding of a key.
const ROUNDING: f64 = 1e-10;

/// Faces whose keys move by more are small.
const NARROW: f64 = 4e-3;

/// The surfaces found so far.
#[derive(Default)]
struct Finder {
    centre: DVec3,
    size: f64,
    /// The tolerance.
    distance: f64,
    /// The faces.
    nearby: Nearby,
    /// Surfaces by the bits of their keys, which are not negative and sort as numbers do.
    by_key: BTreeMap<u64, Vec<u32>>,
    kept: Vec<Candidate>,
}

impl Finder {
    /// The surface of the next face; `faces` are the earlier ones.
    fn find(&mut self, new: Candidate, faces: &[CarriedFace]) -> CarriedFace {
        let coefficients = new.surface.coefficients(self.centre, self.size);
        let key = coefficients.iter().zip(WEIGHTS).map(|(c, w)| c * w).sum::<f64>().abs();
        // a small face may lean more than a large one within the same distance
        let width = ROUNDING * (1.0 + key) + SENSITIVITY * self.distance / new.size.max(self.distance);
        let wide = width > NARROW;
        let within = if wide { ROUNDING * (1.0 + key) } else { width };
        let range = (key - within).max(0.0).to_bits()..=(key + within).to_bits();
        let mut near: Vec<u32> = self.by_key.range(range).flat_map(|(_, list)| list).copied().collect();
        if wide {
            self.nearby.before(faces.len() as u32, |face| near.push(faces[face as usize].surface));
        }
        near.sort_unstable();
        near.dedup();
        let found = near.into_iter().find_map(|k| Some((k, self.same(&self.kept[k as usize], &new)?)));
        if let Some((surface, flipped)) = found {
            return CarriedFace { surface, flipped };
        }
        let surface = self.kept.len() as u32;
        self.by_key.entry(key.to_bits()).or_default().push(surface);
        self.kept.push(new);
        CarriedFace { surface, flipped: false }
    }

    /// Whether both are one surface, and then whether their insides are opposite.
    fn same(&self, a: &Candidate, b: &Candidate) -> Option<bool> {
        let torus = |c: &Candidate| matches!(c.surface.carrier, Carrier::Torus { .. });
        if torus(a) != torus(b) {
            return None;
        }
        let (mut along, mut against) = (0, 0);
        for (p, other) in b.samples.iter().map(|p| (p, a)).chain(a.samples.iter().map(|p| (p, b))) {
            let Some((distance, gradient)) = other.surface.distance(*p) else { continue };
            if distance > self.distance || distance.is_nan() {
                return None;
            }
            let own = if std::ptr::eq(other, a) { b } else { a };
            let Some((_, mine)) = own.surface.distance(*p) else { continue };
            if gradient.dot(mine) >= 0.0 { along += 1 } else { against += 1 }
        }
        // neither: apexes only. Both: surfaces that fold onto each other
        (along.min(against) == 0 && along.max(against) >= 3).then_some(against > 0)
    }
}

impl Shape {
    /// Whether the shape is the intersection of the insides of its carriers.
    pub fn is_analytic(&self) -> bool {
        !matches!(self, Self::Mesh(_) | Self::Part(_))
    }
}

/// Quadrics without terms of second order are planes, and are met as such.
impl From<Quadric> for Carrier {
    fn from(q: Quadric) -> Self {
        if q.squares == DVec3::ZERO && q.products == DVec3::ZERO && q.linear != DVec3::ZERO {
            return Self::Plane { normal: q.linear, offset: -q.constant };
        }
        Self::Quadric(q)
    }
}
