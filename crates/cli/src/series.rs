//! Numbers gathered frame by frame, and their median, 95th percentile and maximum.
//!
//! A measurement is a name, a unit and a value. Commands only push them: a new pass, pool or counter in a frame's
//! statistics becomes a new row without a change here.

use serde::Serialize;

/// Values of one quantity over the frames.
#[derive(Clone, Debug)]
struct Series {
    name: String,
    unit: &'static str,
    values: Vec<f64>,
}

/// Quantities in the order in which they were first seen.
#[derive(Clone, Debug, Default)]
pub struct Gathered {
    series: Vec<Series>,
}

/// One quantity, summed up.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    pub name: String,
    pub unit: &'static str,
    pub median: f64,
    pub p95: f64,
    pub largest: f64,
    /// Frames in which it was measured.
    pub frames: usize,
}

impl Gathered {
    /// Adds the value of one frame.
    pub fn push(&mut self, name: &str, unit: &'static str, value: f64) {
        match self.series.iter_mut().find(|s| s.name == name) {
            Some(series) => series.values.push(value),
            None => self.series.push(Series { name: name.into(), unit, values: vec![value] }),
        }
    }

    /// Median, 95th percentile and maximum of each quantity.
    pub fn rows(&self) -> Vec<Row> {
        let row = |s: &Series| {
            let mut sorted = s.values.clone();
            sorted.sort_by(f64::total_cmp);
            let (median, p95) = (quantile(&sorted, 0.5), quantile(&sorted, 0.95));
            let largest = quantile(&sorted, 1.0);
            Row { name: s.name.clone(), unit: s.unit, median, p95, largest, frames: sorted.len() }
        };
        self.series.iter().map(row).collect()
    }
}

/// Linear interpolation between order statistics (type 7 of Hyndman and Fan, *Sample quantiles in
/// statistical packages*, The American Statistician 50, 1996); `sorted` is not empty.
fn quantile(sorted: &[f64], q: f64) -> f64 {
    let position = q * (sorted.len() - 1) as f64;
    let (below, above) = (sorted[position.floor() as usize], sorted[position.ceil() as usize]);
    below + (above - below) * position.fract()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_of_a_ramp() {
        let ramp: Vec<f64> = (0..=100).map(f64::from).collect();
        assert_eq!((quantile(&ramp, 0.5), quantile(&ramp, 0.95)), (50.0, 95.0));
        assert_eq!(quantile(&[1.0, 2.0], 0.5), 1.5);
        assert_eq!(quantile(&[3.0], 0.95), 3.0);
    }

    #[test]
    fn rows_keep_the_order_of_appearance() {
        let mut gathered = Gathered::default();
        for (name, value) in [("b", 2.0), ("a", 9.0), ("b", 1.0), ("b", 3.0)] {
            gathered.push(name, "ms", value);
        }
        let row = |name: &str, [median, p95, largest]: [f64; 3], frames| Row {
            name: name.into(),
            unit: "ms",
            median,
            p95,
            largest,
            frames,
        };
        assert_eq!(gathered.rows(), [row("b", [2.0, 2.9, 3.0], 3), row("a", [9.0; 3], 1)]);
    }
}
