//! Solids of facets as unions of convex cells.
//!
//! ```text
//!   ┌───────┐            ┌─────┬─┐      A - B, B convex: the part beyond the first plane of B, then of the rest
//!   │  ┌─┐  │            │  ┌─┐│ │      the part beyond the second, ...: disjoint convex pieces
//!   │  └─┘  │     ▶      ├──┴─┤│ │
//!   └───────┘            └────┴┴─┘      A * B: A cut by every plane of B
//! ```
//!
//! A cell that a cut leaves thinner than [`FLAT`] of its size is dropped. No operation on cells can fail by rounding:
//! no mesh has to stay closed.

use super::Budget;
use super::hull::{self, FLAT};
use crate::import::solid::Plane;
use crate::model::Bounds;
use glam::{DAffine3, DVec3};

/// A convex polytope: its facets, corners counter-clockwise from outside.
#[derive(Clone, Debug)]
pub(in crate::import::scad) struct Cell {
    pub facets: Vec<Facet>,
    pub bounds: Bounds,
}

/// One side of a cell.
#[derive(Clone, Debug)]
pub(in crate::import::scad) struct Facet {
    pub plane: Plane,
    pub corners: Vec<DVec3>,
}

impl Cell {
    /// The hull of points; `None` where they lie in a plane.
    pub fn hull(points: &[DVec3]) -> Option<Self> {
        let (corners, triangles) = hull::solid(points)?;
        let bounds = corners.iter().copied().fold(Bounds::EMPTY, Bounds::with);
        let thin = FLAT * bounds.diagonal();
        let facets = triangles.iter().filter_map(|t| {
            let corners: Vec<DVec3> = t.iter().map(|i| corners[*i as usize]).collect();
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let longest = (0..3).map(|k| corners[k].distance(corners[(k + 1) % 3])).fold(0.0, f64::max);
            let unit = normal.try_normalize().filter(|_| normal.length() > thin * longest)?;
            Some(Facet { plane: (unit, unit.dot(corners[0])), corners })
        });
        Some(Self { facets: facets.collect(), bounds })
    }

    /// A box.
    pub fn block(bounds: Bounds) -> Self {
        let corner = |i: usize| {
            let pick = |bit: usize, low: f64, high: f64| if i >> bit & 1 == 0 { low } else { high };
            let (l, h) = (bounds.min, bounds.max);
            DVec3::new(pick(0, l.x, h.x), pick(1, l.y, h.y), pick(2, l.z, h.z))
        };
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let facets = sides.map(|side| {
            let corners: Vec<DVec3> = side.map(corner).to_vec();
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
            Facet { plane: (normal, normal.dot(corners[0])), corners }
        });
        Self { facets: facets.into(), bounds }
    }

    /// Its corners, some of them more than once.
    pub fn corners(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.facets.iter().flat_map(|f| f.corners.iter().copied())
    }

    /// Its corners, each once.
    pub fn distinct(&self) -> Vec<DVec3> {
        let mut all: Vec<DVec3> = self.corners().collect();
        all.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z)));
        all.dedup();
        all
    }

    /// Its planes, each once.
    pub fn planes(&self) -> Vec<Plane> {
        let near = FLAT * self.bounds.diagonal();
        let mut all: Vec<Plane> = Vec::new();
        for f in &self.facets {
            if !all.iter().any(|p| (p.0 - f.plane.0).length() < FLAT && (p.1 - f.plane.1).abs() <= near) {
                all.push(f.plane);
            }
        }
        all
    }

    #[cfg(test)]
    pub fn volume(&self) -> f64 {
        let origin = self.bounds.min;
        let fan = |f: &Facet| {
            let at = |i: usize| f.corners[i] - origin;
            (2..f.corners.len()).map(|i| at(0).dot(at(i - 1).cross(at(i)))).sum::<f64>()
        };
        self.facets.iter().map(fan).sum::<f64>() / 6.0
    }

    /// The same under a map that has an inverse.
    pub fn moved(&self, by: &DAffine3) -> Option<Self> {
        Self::hull(&self.distinct().into_iter().map(|p| by.transform_point3(p)).collect::<Vec<_>>())
    }

    /// The part where `normal · x <= offset`.
    pub fn below(&self, (normal, offset): Plane) -> Option<Self> {
        let flat = FLAT * self.bounds.diagonal();
        let height = |p: DVec3| {
            let h = normal.dot(p) - offset;
            if h.abs() <= flat { 0.0 } else { h }
        };
        let (low, high) = self.corners().map(height).fold((0.0_f64, 0.0_f64), |(l, h), x| (l.min(x), h.max(x)));
        if low == 0.0 {
            return None;
        }
        if high == 0.0 {
            return Some(self.clone());
        }
        let (mut facets, mut rim) = (Vec::with_capacity(self.facets.len() + 1), Vec::new());
        for facet in &self.facets {
            let (kept, _) = split(&facet.corners, height);
            rim.extend(
                kept.iter().copied().filter(|p| height(*p).abs() <= 0.0 || (normal.dot(*p) - offset).abs() <= flat),
            );
            if kept.len() >= 3 && kept.iter().any(|p| height(*p) < 0.0) {
                facets.push(Facet { plane: facet.plane, corners: kept });
            }
        }
        let cap = around(rim, normal, flat);
        if cap.len() >= 3 {
            facets.push(Facet { plane: (normal, offset), corners: cap });
        }
        let bounds = facets.iter().flat_map(|f| &f.corners).copied().fold(Bounds::EMPTY, Bounds::with);
        (facets.len() >= 4).then_some(Self { facets, bounds })
    }

    /// The convex pieces of the part outside of the other.
    pub fn without(&self, other: &Self, budget: &mut Budget) -> Result<Vec<Self>, String> {
        if apart(&self.bounds, &other.bounds) {
            return Ok(vec![self.clone()]);
        }
        let (mut pieces, mut rest) = (Vec::new(), self.clone());
        for (normal, offset) in other.planes() {
            budget.spend(rest.facets.len())?;
            pieces.extend(rest.below((-normal, -offset)));
            match rest.below((normal, offset)) {
                Some(inner) => rest = inner,
                None => return Ok(vec![self.clone()]), // nothing of it lies in the other
            }
        }
        Ok(pieces)
    }

    /// What both have in common.
    pub fn common(&self, other: &Self, budget: &mut Budget) -> Result<Option<Self>, String> {
        if apart(&self.bounds, &other.bounds) {
            return Ok(None);
        }
        let mut rest = self.clone();
        for plane in other.planes() {
            budget.spend(rest.facets.len())?;
            match rest.below(plane) {
                Some(inner) => rest = inner,
                None => return Ok(None),
            }
        }
        Ok(Some(rest))
    }
}

fn apart(a: &Bounds, b: &Bounds) -> bool {
    (a.min.cmpge(b.max) | b.min.cmpge(a.max)).any()
}

/// A convex polygon's parts with a height of at most zero, and of at least zero.
fn split(corners: &[DVec3], height: impl Fn(DVec3) -> f64) -> (Vec<DVec3>, Vec<DVec3>) {
    let (mut low, mut high) = (Vec::new(), Vec::new());
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let (ha, hb) = (height(a), height(b));
        if ha <= 0.0 {
            low.push(a);
        }
        if ha >= 0.0 {
            high.push(a);
        }
        if ha * hb < 0.0 {
            // from the lower end, so that both facets of an edge find the same point
            let ((p, hp), (q, hq)) = if ha < hb { ((a, ha), (b, hb)) } else { ((b, hb), (a, ha)) };
            let at = p + (q - p) * (hp / (hp - hq));
            low.push(at);
            high.push(at);
        }
    }
    (low, high)
}

/// Points of a plane in order around their middle, counter-clockwise seen against the normal.
fn around(points: Vec<DVec3>, normal: DVec3, near: f64) -> Vec<DVec3> {
    let mut distinct: Vec<DVec3> = Vec::new();
    for p in points {
        if !distinct.iter().any(|q| q.distance(p) <= near) {
            distinct.push(p);
        }
    }
    let middle = distinct.iter().sum::<DVec3>() / distinct.len().max(1) as f64;
    let x = normal.any_orthonormal_vector();
    let y = normal.cross(x);
    let angle = |p: &DVec3| (*p - middle).dot(y).atan2((*p - middle).dot(x));
    distinct.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    distinct
}

/// The union of cells without others.
pub(super) fn difference(from: Vec<Cell>, take: &[Cell], budget: &mut Budget) -> Result<Vec<Cell>, String> {
    let mut rest = from;
    for other in take {
        let mut next = Vec::with_capacity(rest.len());
        for cell in rest {
            next.extend(cell.without(other, budget)?);
        }
        rest = next;
    }
    Ok(rest)
}

/// What two unions of cells have in common.
pub(super) fn intersection(a: &[Cell], b: &[Cell], budget: &mut Budget) -> Result<Vec<Cell>, String> {
    let mut all = Vec::new();
    for x in a {
        for y in b {
            budget.spend(1)?;
            all.extend(x.common(y, budget)?);
        }
    }
    Ok(all)
}

/// A polygon of a boundary while space is divided.
#[derive(Clone)]
struct Side {
    plane: Plane,
    corners: Vec<DVec3>,
}

/// The inside of a closed mesh as convex cells: space is divided by the planes of its triangles until no triangle lies
/// within a part. Source: S. Thibault, B. Naylor, *Set operations on polyhedra using binary space partitioning trees*, 1987.
pub(super) fn of_mesh(points: &[DVec3], triangles: &[[u32; 3]], budget: &mut Budget) -> Result<Vec<Cell>, String> {
    let bounds = points.iter().copied().fold(Bounds::EMPTY, Bounds::with);
    let size = bounds.diagonal();
    let flat = FLAT * size;
    let sides = triangles.iter().filter_map(|t| {
        let corners: Vec<DVec3> = t.iter().map(|i| points[*i as usize]).collect();
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).try_normalize()?;
        Some(Side { plane: (normal, normal.dot(corners[0])), corners })
    });
    let margin = DVec3::splat(0.1 * size);
    let whole = Cell::block(Bounds { min: bounds.min - margin, max: bounds.max + margin });
    let mut waiting = vec![(whole, sides.collect::<Vec<_>>())];
    let mut cells = Vec::new();
    while let Some((cell, sides)) = waiting.pop() {
        let plane = best(&sides, flat);
        let (normal, offset) = plane;
        let height = |p: DVec3| {
            let h = normal.dot(p) - offset;
            if h.abs() <= flat { 0.0 } else { h }
        };
        let (mut back, mut front) = (Vec::new(), Vec::new());
        budget.spend(sides.len())?;
        for side in sides {
            let (low, high) = split(&side.corners, height);
            if low.len() >= 3 && low.iter().any(|p| height(*p) < 0.0) {
                back.push(Side { plane: side.plane, corners: low });
            }
            if high.len() >= 3 && high.iter().any(|p| height(*p) > 0.0) {
                front.push(Side { plane: side.plane, corners: high });
            }
        }
        if let Some(inner) = cell.below(plane) {
            if back.is_empty() { cells.push(inner) } else { waiting.push((inner, back)) }
        }
        if !front.is_empty()
            && let Some(outer) = cell.below((-normal, -offset))
        {
            waiting.push((outer, front));
        }
    }
    Ok(cells)
}

/// Of a few sides the plane that cuts the fewest others and leaves as many on both sides.
fn best(sides: &[Side], flat: f64) -> Plane {
    const TRIED: usize = 8;
    let step = sides.len().div_ceil(TRIED).max(1);
    let seen = sides.len().div_ceil(256).max(1);
    let cost = |side: &&Side| {
        let (normal, offset) = side.plane;
        let (mut cut, mut low, mut high) = (0_i64, 0_i64, 0_i64);
        for other in sides.iter().step_by(seen) {
            let heights = other.corners.iter().map(|p| normal.dot(*p) - offset);
            let (l, h) = heights.fold((0.0_f64, 0.0_f64), |(l, h), x| (l.min(x), h.max(x)));
            low += i64::from(l < -flat);
            high += i64::from(h > flat);
            cut += i64::from(l < -flat && h > flat);
        }
        8 * cut + (low - high).abs()
    };
    sides.iter().step_by(step).min_by_key(cost).expect("a part without sides is not divided").plane
}
