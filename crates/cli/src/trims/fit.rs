//! Tests whether the table's build time is linear in its segments and crossings.
//!
//! ```text
//!   ms = a + b (segments + crossings)        least squares over all measured tables of a model
//! ```

use super::measure::Row;
use super::way::Way;
use selvedge::picture::TrimWay;

/// A straight line through points.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Line {
    /// Where it begins.
    a: f64,
    /// How fast it rises.
    b: f64,
    /// Share of the variance that it explains.
    r2: f64,
}

/// Least squares; `None` for fewer than three points or all above one place.
fn line(points: &[(f64, f64)]) -> Option<Line> {
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x0, y0) = (mean(|p| p.0), mean(|p| p.1));
    let sum = |of: &dyn Fn(f64, f64) -> f64| points.iter().map(|(x, y)| of(x - x0, y - y0)).sum::<f64>();
    let (xx, xy, yy) = (sum(&|x, _| x * x), sum(&|x, y| x * y), sum(&|_, y| y * y));
    if points.len() < 3 || xx <= 0.0 || yy <= 0.0 {
        return None;
    }
    let b = xy / xx;
    Some(Line { a: y0 - b * x0, b, r2: xy * xy / (xx * yy) })
}

/// The fit of each model, in words.
pub fn text(rows: &[Row]) -> String {
    let mut models: Vec<&str> = rows.iter().map(|r| r.model.as_str()).collect();
    models.dedup();
    let mut lines = Vec::new();
    for model in models {
        let tables = rows.iter().filter(|r| r.model == model && r.way == Way::Own(TrimWay::Table));
        let costs = tables.filter_map(|r| r.cost.as_ref());
        let points: Vec<(f64, f64)> =
            costs.map(|c| ((c.trim_segments + c.trim_intercepts) as f64, c.own_passes_ms)).collect();
        if let Some(Line { a, b, r2 }) = line(&points) {
            let most = points.iter().map(|p| p.0).fold(0.0, f64::max);
            lines.push(format!(
                "{model}: the table takes {a:.3} ms + {:.1} ns for each of up to {most} segments and crossings (R² = {r2:.3}, {} tables)",
                b * 1e6,
                points.len()
            ));
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_found_and_others_are_seen() {
        let straight: Vec<(f64, f64)> = (0..5).map(|x| (f64::from(x), 2.0 + 3.0 * f64::from(x))).collect();
        assert_eq!(line(&straight), Some(Line { a: 2.0, b: 3.0, r2: 1.0 }));
        let bent: Vec<(f64, f64)> = (0..20).map(|x| (f64::from(x), f64::from(x).powi(4))).collect();
        assert!(line(&bent).is_some_and(|l| l.r2 < 0.8));
        assert_eq!(line(&straight[..2]), None);
        assert_eq!(line(&[(1.0, 1.0), (1.0, 2.0), (1.0, 3.0)]), None);
    }
}
