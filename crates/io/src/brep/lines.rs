//! Lines of constant `u` or `v` along which edges of a face run. Lines that nearly coincide get one number.
//!
//! ```text
//!   ──●─────────●──●───────────────●──▶ coordinate      a set sorted by value, in periods by the residue: only lines
//!          └─ reach ─┘                                  within the reach of a value are compared with it
//! ```
//!
//! Of several lines within reach the one met first counts.

use std::collections::BTreeSet;

/// Rounding of residues, as a share of the numbers: more than it is, since each line found is compared exactly.
const ROUNDING: f64 = 1e-12;

/// Constant coordinates met so far on a face.
#[derive(Debug, Default)]
pub(super) struct Lines {
    values: Vec<f64>,
    /// For `u` and for `v`: the order of each residue, and the number of its value.
    sorted: [BTreeSet<(u64, usize)>; 2],
}

impl Lines {
    /// Adds the value of a coordinate (`axis` 0 or 1) that repeats after `period`, always the same one of an axis.
    pub fn push(&mut self, axis: usize, value: f64, period: Option<f64>) {
        self.sorted[axis].insert((order(residue(value, period)), self.values.len()));
        self.values.push(value);
    }

    /// The first value pushed that `holds` is true for. It is true for no value farther than `reach` from a copy of
    /// `value`.
    pub fn first(
        &self,
        (axis, value): (usize, f64),
        period: Option<f64>,
        reach: f64,
        holds: impl Fn(f64) -> bool,
    ) -> Option<f64> {
        let at = residue(value, period);
        let reach = reach + ROUNDING * (reach + value.abs() + period.unwrap_or(0.0));
        let turns = [0.0, -1.0, 1.0].into_iter().take(if period.is_some() { 3 } else { 1 });
        let spans = turns.map(|turn| at + turn * period.unwrap_or(0.0)).map(|at| {
            let (lo, hi) = (order(at - reach), order(at + reach));
            self.sorted[axis].range((lo, 0)..=(hi, usize::MAX))
        });
        let numbers = spans.flatten().map(|(_, number)| *number);
        numbers.filter(|number| holds(self.values[*number])).min().map(|number| self.values[number])
    }
}

fn residue(value: f64, period: Option<f64>) -> f64 {
    period.map_or(value, |period| value.rem_euclid(period))
}

/// Numbers in the order of `f64::total_cmp`.
fn order(x: f64) -> u64 {
    let bits = x.to_bits();
    if x.is_sign_negative() { !bits } else { bits | 1 << 63 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_order() {
        let rising = [f64::NEG_INFINITY, -2.0, -1e-300, -0.0, 0.0, 5e-324, 1.0, 1.5, f64::INFINITY];
        assert!(rising.windows(2).all(|pair| order(pair[0]) < order(pair[1])));
    }

    /// Against a search of all, with and without a period, and with a reach that holds everything.
    #[test]
    fn the_first_line_within_reach_is_found() {
        let mut state = 5_u64;
        let mut random = |scale: f64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) as f64 / f64::from(1_u32 << 30) - 1.0) * scale
        };
        let mut found = 0;
        for period in [None, Some(6.25)] {
            let (mut lines, mut all) = (Lines::default(), Vec::new());
            for k in 0..2000 {
                let (axis, value) = (k % 2, random(20.0));
                let reach = if k % 97 == 0 { f64::INFINITY } else { 0.01 };
                let near = |x: f64| period.map_or(x, |p: f64| x - p * ((x - value) / p).round());
                let holds = |x: f64| (near(x) - value).abs() <= reach;
                let expected = all.iter().find(|(a, x)| *a == axis && holds(*x)).map(|(_, x)| *x);
                assert_eq!(lines.first((axis, value), period, reach, holds), expected, "{value} of {period:?}");
                found += usize::from(expected.is_some());
                lines.push(axis, value, period);
                all.push((axis, value));
            }
        }
        assert!((500..3500).contains(&found), "{found}");
    }
}
