//! Solids of facets: unions of convex cells and closed meshes.
//!
//! ```text
//!   at ring j + 1   p2 ── q2      a region that is swept: its outline stands in every ring; between two rings a side
//!                   │  ╲   │      becomes two triangles; the first and the last ring are covered
//!   at ring j       p1 ── q1
//! ```

use super::cells::{self, Cell};
use super::region::Region;
use super::{Budget, hull};
use crate::import::facets::triangulate_flat;
use crate::model::Bounds;
use glam::{DAffine3, DVec2, DVec3};
use std::collections::HashMap;

/// The message for a mesh that bounds nothing.
pub(super) const OPEN: &str = "the faces do not close, so there is no inside";

/// A part of a solid.
#[derive(Clone, Debug)]
pub(in crate::import::scad) enum Part {
    Cell(Cell),
    Mesh(Triangles),
}

/// A closed mesh: triangles run counter-clockwise from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::import::scad) struct Triangles {
    pub points: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
}

/// The union of its parts.
#[derive(Clone, Debug, Default)]
pub(in crate::import::scad) struct Body {
    pub parts: Vec<Part>,
}

impl Body {
    /// The hull of points; nothing where they lie in a plane.
    pub fn hull(points: &[DVec3]) -> Self {
        Self { parts: Cell::hull(points).map(Part::Cell).into_iter().collect() }
    }

    pub fn mesh(mesh: Triangles) -> Self {
        Self { parts: if mesh.triangles.is_empty() { Vec::new() } else { vec![Part::Mesh(mesh)] } }
    }

    fn of(cells: Vec<Cell>) -> Self {
        Self { parts: cells.into_iter().map(Part::Cell).collect() }
    }

    pub fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    pub fn union(all: Vec<Self>) -> Self {
        Self { parts: all.into_iter().flat_map(|b| b.parts).collect() }
    }

    /// Corners of its parts, some more than once.
    pub fn corners(&self) -> Vec<DVec3> {
        let of = |part: &Part| match part {
            Part::Cell(cell) => cell.distinct(),
            Part::Mesh(mesh) => mesh.points.clone(),
        };
        self.parts.iter().flat_map(of).collect()
    }

    pub fn bounds(&self) -> Bounds {
        self.corners().into_iter().fold(Bounds::EMPTY, Bounds::with)
    }

    /// The same under a map; nothing under one without an inverse.
    pub fn moved(&self, by: &DAffine3) -> Self {
        let turned = by.matrix3.determinant();
        if turned == 0.0 || !by.is_finite() {
            return Self::default();
        }
        let part = |part: &Part| match part {
            Part::Cell(cell) => cell.moved(by).map(Part::Cell),
            Part::Mesh(mesh) => Some(Part::Mesh(mesh.moved(by, turned < 0.0))),
        };
        Self { parts: self.parts.iter().filter_map(part).collect() }
    }

    fn cells(self, budget: &mut Budget) -> Result<Vec<Cell>, String> {
        let mut all = Vec::with_capacity(self.parts.len());
        for part in self.parts {
            match part {
                Part::Cell(cell) => all.push(cell),
                Part::Mesh(mesh) if !mesh.is_closed() => return Err(OPEN.to_owned()),
                Part::Mesh(mesh) => all.extend(cells::of_mesh(&mesh.points, &mesh.triangles, budget)?),
            }
        }
        Ok(all)
    }

    pub fn without(self, other: Self, budget: &mut Budget) -> Result<Self, String> {
        let other = other.cells(budget)?;
        Ok(Self::of(cells::difference(self.cells(budget)?, &other, budget)?))
    }

    pub fn common(self, other: Self, budget: &mut Budget) -> Result<Self, String> {
        let other = other.cells(budget)?;
        Ok(Self::of(cells::intersection(&self.cells(budget)?, &other, budget)?))
    }

    /// All sums of a point of this and one of the other: the hulls of the sums of the corners of two cells.
    pub fn minkowski(self, other: Self, budget: &mut Budget) -> Result<Self, String> {
        let corners = |cells: Vec<Cell>| cells.iter().map(Cell::distinct).collect::<Vec<_>>();
        let (mine, theirs) = (corners(self.cells(budget)?), corners(other.cells(budget)?));
        let mut all = Vec::new();
        for a in &mine {
            for b in &theirs {
                budget.spend(a.len() * b.len())?;
                let sums: Vec<DVec3> = a.iter().flat_map(|p| b.iter().map(move |q| *p + *q)).collect();
                all.extend(Cell::hull(&sums));
            }
        }
        Ok(Self::of(all))
    }

    /// Its shadow on the plane z = 0.
    pub fn shadow(&self) -> Region {
        let mut all = Vec::new();
        for part in &self.parts {
            match part {
                Part::Cell(cell) => all.push(hull::flat(cell.corners().map(DVec3::truncate))),
                Part::Mesh(mesh) => all.extend(mesh.triangles.iter().map(|t| {
                    let mut corners: Vec<DVec2> = t.map(|i| mesh.points[i as usize].truncate()).to_vec();
                    if (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]) < 0.0 {
                        corners.reverse();
                    }
                    corners
                })),
            }
        }
        Region::new(&all, false)
    }

    /// What it has in common with the plane z = 0.
    pub fn cut(self, budget: &mut Budget) -> Result<Region, String> {
        let mut all = Vec::new();
        for cell in self.cells(budget)? {
            let flat = hull::FLAT * cell.bounds.diagonal();
            let mut points = Vec::new();
            for facet in &cell.facets {
                for (i, a) in facet.corners.iter().enumerate() {
                    let b = facet.corners[(i + 1) % facet.corners.len()];
                    if a.z.abs() <= flat {
                        points.push(a.truncate());
                    } else if b.z.abs() > flat && a.z * b.z < 0.0 {
                        points.push(a.lerp(b, a.z / (a.z - b.z)).truncate());
                    }
                }
            }
            all.push(hull::flat(points));
        }
        Ok(Region::new(&all, false))
    }

    /// Six times the volume of each part, summed; parts that overlap count twice.
    #[cfg(test)]
    pub fn volume(&self) -> f64 {
        let of = |part: &Part| match part {
            Part::Cell(cell) => cell.volume(),
            Part::Mesh(mesh) => mesh.volume(),
        };
        self.parts.iter().map(of).sum()
    }
}

impl Triangles {
    fn moved(&self, by: &DAffine3, mirrored: bool) -> Self {
        let points = self.points.iter().map(|p| by.transform_point3(*p)).collect();
        let turn = |t: &[u32; 3]| if mirrored { [t[0], t[2], t[1]] } else { *t };
        Self { points, triangles: self.triangles.iter().map(turn).collect() }
    }

    /// Positive where the triangles look outwards.
    pub fn volume(&self) -> f64 {
        let origin = self.points.first().copied().unwrap_or_default();
        let at = |i: u32| self.points[i as usize] - origin;
        self.triangles.iter().map(|t| at(t[0]).dot(at(t[1]).cross(at(t[2])))).sum::<f64>() / 6.0
    }

    /// The same with triangles that look outwards.
    pub fn outwards(mut self) -> Self {
        if self.volume() < 0.0 {
            self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        self
    }

    /// Points at one place are one; triangles without three corners go.
    pub fn welded(points: &[DVec3], triangles: impl IntoIterator<Item = [u32; 3]>) -> Self {
        let mut places = HashMap::new();
        let mut kept: Vec<DVec3> = Vec::new();
        let numbers: Vec<u32> = points
            .iter()
            .map(|p| {
                *places.entry((*p + 0.0).to_array().map(f64::to_bits)).or_insert_with(|| {
                    kept.push(*p + 0.0);
                    kept.len() as u32 - 1
                })
            })
            .collect();
        let triangles = triangles.into_iter().map(|t| t.map(|i| numbers[i as usize]));
        let triangles = triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect();
        Self { points: kept, triangles }
    }

    /// Whether every side of a triangle has exactly one opposite.
    pub fn is_closed(&self) -> bool {
        let mut sides: HashMap<(u32, u32), i64> = HashMap::new();
        for t in &self.triangles {
            for k in 0..3 {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                *sides.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
            }
        }
        sides.values().all(|n| *n == 0)
    }
}

/// How a region is swept.
pub(in crate::import::scad) struct Sweep<'a> {
    /// Copies of the outline, two or more.
    pub rings: u32,
    /// The last ring meets the first.
    pub around: bool,
    /// Place of a corner in a ring.
    pub at: &'a dyn Fn(u32, DVec2) -> DVec3,
    /// Whether a side is parted from its first corner to the second one in the next ring: by `[p1, q1, p2, q2]`.
    pub along: &'a dyn Fn([DVec3; 4]) -> bool,
}

impl Sweep<'_> {
    /// The solid; its triangles look outwards.
    pub fn mesh(&self, region: &Region) -> Triangles {
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        for outlines in region.shapes() {
            let (first, corners) = (points.len() as u32, outlines.iter().map(Vec::len).sum::<usize>() as u32);
            for ring in 0..self.rings {
                points.extend(outlines.iter().flatten().map(|p| (self.at)(ring, *p)));
            }
            let number = |ring: u32, corner: u32| first + (ring % self.rings) * corners + corner;
            if !self.around {
                let cover = triangulate_flat(&outlines);
                triangles.extend(cover.iter().map(|t| [t[0], t[2], t[1]].map(|k| number(0, k))));
                triangles.extend(cover.iter().map(|t| t.map(|k| number(self.rings - 1, k))));
            }
            let mut start = 0;
            for outline in &outlines {
                let n = outline.len() as u32;
                for ring in 0..self.rings - u32::from(!self.around) {
                    for k in 0..n {
                        let (p, q) = (start + k, start + (k + 1) % n);
                        let [p1, q1] = [number(ring, p), number(ring, q)];
                        let [p2, q2] = [number(ring + 1, p), number(ring + 1, q)];
                        let along = (self.along)([p1, q1, p2, q2].map(|i| points[i as usize]));
                        triangles.extend(if along {
                            [[p1, q1, q2], [p1, q2, p2]]
                        } else {
                            [[p1, q1, p2], [q1, q2, p2]]
                        });
                    }
                }
                start += n;
            }
        }
        Triangles::welded(&points, triangles).outwards()
    }
}
