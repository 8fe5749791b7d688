//! Points that are the same: by nearness, or by the source's statement.

use crate::model::Bounds;
use glam::DVec3;
use std::collections::HashMap;

/// Points, those within a reach of each other taken as one; several may be declared one whatever their distance.
#[derive(Debug, Default)]
pub(super) struct Vertices {
    pub points: Vec<DVec3>,
    /// The representative of each point, or a point nearer to it.
    up: Vec<usize>,
    cells: HashMap<[i64; 3], Vec<usize>>,
    reach: f64,
}

impl Vertices {
    pub fn new(reach: f64) -> Self {
        Self { reach, ..Self::default() }
    }

    fn cell(&self, p: DVec3) -> [i64; 3] {
        // twice the reach: a point within it lies in this cell or next to it
        (p / (2.0 * self.reach)).floor().to_array().map(|x| x as i64)
    }

    fn find(&self, p: DVec3) -> Option<usize> {
        let cell = self.cell(p);
        let near = (0..27).map(|k| [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1]);
        let near = near.map(|step: [i64; 3]| std::array::from_fn(|i| cell[i].saturating_add(step[i])));
        let all = near.filter_map(|c: [i64; 3]| self.cells.get(&c)).flatten().copied();
        let best = all.map(|i| (self.points[i].distance(p), i)).min_by(|a, b| a.0.total_cmp(&b.0));
        best.filter(|b| b.0 <= self.reach).map(|b| b.1)
    }

    /// The point's number: that of the nearest within reach, else a new one.
    pub fn add(&mut self, p: DVec3) -> usize {
        self.find(p).unwrap_or_else(|| {
            let number = self.points.len();
            self.points.push(p);
            self.up.push(number);
            self.cells.entry(self.cell(p)).or_default().push(number);
            number
        })
    }

    /// The representative of `number`.
    pub fn root(&self, mut number: usize) -> usize {
        while self.up[number] != number {
            number = self.up[number];
        }
        number
    }

    /// Makes two points one; returns the distance between their representatives.
    pub fn unite(&mut self, a: usize, b: usize) -> f64 {
        let (a, b) = (self.root(a), self.root(b));
        let (first, second) = (a.min(b), a.max(b));
        self.up[second] = first;
        self.points[a].distance(self.points[b])
    }

    /// All points with their numbers, sorted for queries by place.
    pub fn ordered(&self) -> Ordered {
        let bounds = self.points.iter().copied().fold(Bounds::EMPTY, Bounds::with);
        let axis = (bounds.max - bounds.min).max_position();
        let mut points: Vec<_> = self.points.iter().copied().enumerate().map(|(i, p)| (p, i)).collect();
        points.sort_by(|a, b| a.0[axis].total_cmp(&b.0[axis]));
        Ordered { axis, points }
    }
}

/// Points in order along the axis on which they spread farthest.
#[derive(Debug)]
pub(super) struct Ordered {
    axis: usize,
    points: Vec<(DVec3, usize)>,
}

impl Ordered {
    /// Points within a box, and their numbers.
    pub fn within(&self, low: DVec3, high: DVec3) -> impl Iterator<Item = (DVec3, usize)> + '_ {
        let from = self.points.partition_point(|(p, _)| p[self.axis] < low[self.axis]);
        let near = self.points[from..].iter().take_while(move |(p, _)| p[self.axis] <= high[self.axis]);
        near.copied().filter(move |(p, _)| p.cmpge(low).all() && p.cmple(high).all())
    }
}
