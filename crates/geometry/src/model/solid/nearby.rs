//! The pairs of near boxes in a list.
//!
//! ```text
//!   extent of a box ──▶ level: cells of 4 to 8 times that        ┌───────┬───────┐
//!                                                                │ ┌─┐   │       │   so a box lies in one or two cells
//!   on each level a box looks up the cells that it touches           │ └─┘ ┌─┼┐      │   along an axis, mostly in one
//!                                                                └─────┴─┴┴──────┘
//! ```

use crate::model::Bounds;
use glam::{DVec3, I64Vec3};
use std::collections::BTreeMap;

/// Boxes in cells.
#[derive(Default)]
pub(super) struct Nearby {
    boxes: Vec<Bounds>,
    /// Cell and box, sorted; cells that share a number only cost time.
    cells: Vec<(u64, u32)>,
    /// The boxes of each level, in order.
    levels: BTreeMap<i32, Vec<u32>>,
}

impl Nearby {
    /// Boxes thinner than `least` count as that wide.
    pub(super) fn new(boxes: Vec<Bounds>, least: f64) -> Self {
        let mut levels: BTreeMap<i32, Vec<u32>> = BTreeMap::new();
        let mut cells: Vec<(u64, u32)> = Vec::with_capacity(2 * boxes.len());
        for (i, bounds) in (0..).zip(&boxes) {
            let extent = (bounds.max - bounds.min).max_element().max(least);
            let level = (extent.log2().ceil() as i32).saturating_add(2);
            levels.entry(level).or_default().push(i);
            Cells::of(bounds, level).each(|cell| cells.push((cell, i)));
        }
        cells.sort_unstable();
        Self { boxes, cells, levels }
    }

    /// The boxes before box `i` in the list that it touches, some of them twice.
    pub(super) fn before(&self, i: u32, mut found: impl FnMut(u32)) {
        let bounds = &self.boxes[i as usize];
        let mut ask = |other: u32| {
            let b = &self.boxes[other as usize];
            if b.min.cmple(bounds.max).all() && bounds.min.cmple(b.max).all() {
                found(other);
            }
        };
        for (level, list) in &self.levels {
            let cells = Cells::of(bounds, *level);
            if cells.count() > list.len() as f64 {
                list.iter().take_while(|other| **other < i).for_each(|other| ask(*other));
                continue;
            }
            cells.each(|cell| {
                let from = self.cells.partition_point(|c| c.0 < cell);
                let those = self.cells[from..].iter().take_while(|c| c.0 == cell && c.1 < i);
                those.for_each(|(_, other)| ask(*other));
            });
        }
    }
}

/// The cells of a level that a box touches.
struct Cells {
    level: i32,
    low: I64Vec3,
    high: I64Vec3,
}

impl Cells {
    fn of(bounds: &Bounds, level: i32) -> Self {
        let place = |p: DVec3| (p * f64::from(level.saturating_neg()).exp2()).floor().as_i64vec3();
        Self { level, low: place(bounds.min), high: place(bounds.max) }
    }

    fn count(&self) -> f64 {
        (self.high.as_dvec3() - self.low.as_dvec3() + 1.0).element_product()
    }

    /// Their numbers.
    fn each(&self, mut each: impl FnMut(u64)) {
        let mix = |sum: u64, c: i64| (sum.rotate_left(23) ^ c as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        for x in self.low.x..=self.high.x {
            for y in self.low.y..=self.high.y {
                for z in self.low.z..=self.high.z {
                    each([x, y, z].into_iter().fold(self.level as u64, mix));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Boxes of sizes a million apart, some of them far away, one without end: those that touch are found, and no others.
    #[test]
    fn boxes_that_touch_are_found() {
        let share =
            |i: u32, k: u32| f64::from((i * 7919 + k * 104_729).wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24);
        let random = |i: u32| {
            let size = 10f64.powf(-6.0 * share(i, 0));
            let min = DVec3::new(share(i, 1), share(i, 2), share(i, 3)) * if i.is_multiple_of(7) { 1e9 } else { 1.0 };
            Bounds { min, max: min + size * DVec3::new(share(i, 4), 1.0, share(i, 5)) }
        };
        let mut boxes: Vec<Bounds> = (0..600).map(random).collect();
        boxes[300] = Bounds { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
        let nearby = Nearby::new(boxes.clone(), 1e-9);
        let mut touching = 0;
        for i in (0..600).filter(|i| *i != 300) {
            let mut found = Vec::new();
            nearby.before(i, |other| found.push(other));
            found.sort_unstable();
            found.dedup();
            let b = boxes[i as usize];
            let meets = |o: &u32| {
                let a = boxes[*o as usize];
                (0..3).all(|k| a.min[k] <= b.max[k] && b.min[k] <= a.max[k])
            };
            assert_eq!(found, (0..i).filter(meets).collect::<Vec<_>>(), "box {i}");
            touching += found.len();
        }
        assert!(touching > 1000, "{touching}");
    }
}
