//! Polygons, and which points they hold: by the edges of one row, where there are many.
//!
//! ```text
//!       ╭──╮      row 3: edges c, d          a ray towards +u crosses an odd number of edges from inside;
//!     b╭╯  ╰╮c    row 2: b, c                only edges of the point's own row can be among them
//! ```
//!
//! In a face with a hundred thousand holes, millions of points are compared with the border. Cost of a point: that of
//! the edges at its height, a few for a border that does not turn to and fro.
//!
//! Source: M. Shimrat, *Algorithm 112: position of point relative to polygon*, 1962.

use glam::DVec2;
use std::cell::OnceCell;

/// Edges up to which all of them are tested.
const FEW: usize = 64;
/// Entries of all rows together, for each edge; beyond it a polygon has no rows.
const MOST_ENTRIES: usize = 16;

/// A closed polygon: its last point is its first.
pub(super) struct Outline<'p> {
    points: &'p [DVec2],
    /// Its box; upside down where it has no point.
    pub bounds: (DVec2, DVec2),
    /// Made when they are needed for the first time.
    rows: OnceCell<Option<Rows>>,
}

/// The edges that reach into each of many rows of equal height.
struct Rows {
    low: f64,
    /// Rows in a unit of height.
    density: f64,
    /// The first entry of each row, and the end of the last.
    starts: Vec<u32>,
    edges: Vec<u32>,
}

/// The box of points.
fn bounds(polygon: &[DVec2]) -> (DVec2, DVec2) {
    polygon.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)))
}

impl<'p> Outline<'p> {
    pub fn new(points: &'p [DVec2]) -> Self {
        Self { points, bounds: bounds(points), rows: OnceCell::new() }
    }

    /// `inner` lies within, by the vote of its edge midpoints: loops may touch.
    pub fn contains(&self, inner: &[DVec2]) -> bool {
        // at most some thirty votes of the longest loops
        let stride = inner.len().div_ceil(32).max(1);
        let mut votes = (0, 0);
        for w in inner.windows(2).step_by(stride) {
            let p = 0.5 * (w[0] + w[1]);
            votes.1 += 1;
            if (p.cmpge(self.bounds.0) & p.cmple(self.bounds.1)).all() && self.encloses(p) {
                votes.0 += 1;
            }
        }
        2 * votes.0 > votes.1
    }

    /// Parity of the crossings of a ray towards `+u`; edges are bottom-open, top-closed.
    pub fn encloses(&self, p: DVec2) -> bool {
        let crosses = |k: usize| {
            let (a, b) = (self.points[k], self.points[k + 1]);
            (a.y < p.y) != (b.y < p.y) && a.x + (b.x - a.x) * ((p.y - a.y) / (b.y - a.y)) > p.x
        };
        let rows = self.rows.get_or_init(|| Rows::new(self.points, self.bounds));
        let count = match rows {
            Some(rows) => rows.at(p.y).iter().filter(|k| crosses(**k as usize)).count(),
            None => (0..self.points.len().saturating_sub(1)).filter(|k| crosses(*k)).count(),
        };
        count % 2 == 1
    }
}

impl Rows {
    fn new(points: &[DVec2], (lo, hi): (DVec2, DVec2)) -> Option<Self> {
        let count = points.len().saturating_sub(1);
        let height = hi.y - lo.y;
        let density = count as f64 / height;
        if count <= FEW || !density.is_finite() || u32::try_from(MOST_ENTRIES * count).is_err() {
            return None;
        }
        let mut rows = Self { low: lo.y, density, starts: vec![0; count + 1], edges: Vec::new() };
        let reach = |rows: &Self, k: usize| {
            let (a, b) = (points[k].y, points[k + 1].y);
            rows.row(a.min(b))..rows.row(a.max(b)) + 1
        };
        let mut entries = 0;
        for k in 0..count {
            let reach = reach(&rows, k);
            entries += reach.len();
            if entries > MOST_ENTRIES * count {
                return None;
            }
            for row in reach {
                rows.starts[row + 1] += 1;
            }
        }
        for row in 0..count {
            rows.starts[row + 1] += rows.starts[row];
        }
        let mut next = rows.starts.clone();
        rows.edges = vec![0; entries];
        for k in 0..count {
            for row in reach(&rows, k) {
                rows.edges[next[row] as usize] = k as u32;
                next[row] += 1;
            }
        }
        Some(rows)
    }

    /// The row of a height, the first or last one for those beyond. It never falls where the height rises.
    fn row(&self, y: f64) -> usize {
        // the conversion saturates
        (((y - self.low) * self.density) as usize).min(self.starts.len() - 2)
    }

    fn at(&self, y: f64) -> &[u32] {
        let row = self.row(y);
        &self.edges[self.starts[row] as usize..self.starts[row + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;
    use std::f64::consts::TAU;

    /// A flower of `count` edges, whose radius turns to and fro `petals` times.
    fn flower(count: usize, petals: f64) -> Vec<DVec2> {
        let at = |k: usize| {
            let angle = TAU * (k % count) as f64 / count as f64;
            DVec2::from_angle(angle) * (2.0 + (petals * angle).cos())
        };
        (0..=count).map(at).collect()
    }

    /// With and without rows, at random points and at the heights of corners.
    #[test]
    fn rows_change_no_answer() {
        let mut random = Random::new(3);
        for (count, petals) in [(3, 1.0), (65, 2.0), (1000, 7.0), (5000, 20.0)] {
            let points = flower(count, petals);
            let outline = Outline::new(&points);
            let slow = Outline { rows: OnceCell::from(None), ..Outline::new(&points) };
            let mut inside = 0;
            for i in 0..4000 {
                let y = if i % 2 == 0 { random.range(-3.5, 3.5) } else { points[i % points.len()].y };
                let p = DVec2::new(random.range(-3.5, 3.5), y);
                assert_eq!(outline.encloses(p), slow.encloses(p), "{count} edges, {p}");
                inside += usize::from(outline.encloses(p));
            }
            assert!((200..3500).contains(&inside), "{inside}");
            assert_eq!(outline.rows.get().unwrap().is_some(), count > FEW, "{count} edges");
        }
    }

    /// Edges that all run from bottom to top would fill every row.
    #[test]
    fn rows_take_memory_in_proportion() {
        let zigzag: Vec<DVec2> = (0..=2000).map(|k| DVec2::new(f64::from(k % 2000), f64::from(k % 2))).collect();
        let outline = Outline::new(&zigzag);
        assert!(!outline.encloses(DVec2::new(-1.0, 0.5)) && outline.encloses(DVec2::new(0.75, 0.5)));
        assert!(outline.rows.get().unwrap().is_none());
        let round = flower(5000, 3.0);
        let outline = Outline::new(&round);
        assert!(outline.encloses(DVec2::ZERO));
        let rows = outline.rows.get().unwrap().as_ref().unwrap();
        assert!(rows.edges.len() < 6 * 5000, "{}", rows.edges.len());
        // a point is compared with a few edges of thousands
        let most = (0..5000).map(|row| rows.starts[row + 1] - rows.starts[row]).max().unwrap();
        assert!(most < 400, "{most}");
    }
}
