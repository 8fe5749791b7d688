//! How time grows with the swept quantities: exponents, by least squares of the logarithms, over the rows of `bound`.

use super::Row;

/// A quantity of a row.
type Quantity = (&'static str, fn(&Row) -> f64);

/// The quantities that may be swept. Sub-patches are the patches that are drawn.
const QUANTITIES: [Quantity; 3] = [
    ("drawn patches", |r| r.sub_patches as f64),
    ("covered pixels", |r| r.covered as f64),
    ("triangles", |r| r.triangles as f64),
];

/// Sentences: one a quantity that was swept, and one of patches and pixels together where both were.
pub fn sentences(rows: &[Row]) -> String {
    let rows: Vec<_> = rows.iter().filter(|r| r.factors == "bound").collect();
    let line = |(name, of): &Quantity| {
        let points: Vec<_> = rows.iter().map(|r| (of(r).ln(), r.all_ms.ln())).collect();
        exponent(&points).map(|p| format!("time grows with {name} to the power of {p:.2}"))
    };
    let mut lines: Vec<_> = QUANTITIES.iter().filter_map(line).collect();
    let [patches, pixels, _] = QUANTITIES.map(|(_, of)| of);
    let sum: Vec<_> = rows.iter().map(|r| [1.0, patches(r), pixels(r), r.all_ms]).collect();
    if let Some([fixed, patch, pixel]) = shares(&sum) {
        let fitted = |r: &&Row| fixed + patch * patches(r) + pixel * pixels(r);
        let points: Vec<_> = rows.iter().map(|r| (fitted(r).max(1e-9).ln(), r.all_ms.ln())).collect();
        if let Some(p) = exponent(&points) {
            lines.push(format!(
                "time is {fixed:.1} ms, {:.2} us a drawn patch and {:.1} ns a covered pixel, to the power of {p:.2}",
                patch * 1e3,
                pixel * 1e6
            ));
        }
    }
    lines.join("\n")
}

/// The slope of the least-squares line; `None` where the abscissae do not differ by a factor of two.
fn exponent(points: &[(f64, f64)]) -> Option<f64> {
    let n = points.len() as f64;
    let (mx, my) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / n, y + p.1 / n));
    let (lo, hi) = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), p| (lo.min(p.0), hi.max(p.0)));
    let spread: f64 = points.iter().map(|p| (p.0 - mx).powi(2)).sum();
    (hi - lo > 2f64.ln()).then(|| points.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum::<f64>() / spread)
}

/// `x` with `x · row[..3] = row[3]` by least squares of the relative errors of the rows; `None` where the columns do
/// not determine it.
fn shares(rows: &[[f64; 4]]) -> Option<[f64; 3]> {
    let mut m = [[0.0; 4]; 3];
    for row in rows {
        let row = row.map(|x| x / row[3]);
        for (i, line) in m.iter_mut().enumerate() {
            (0..4).for_each(|j| line[j] += row[i] * row[j]);
        }
    }
    for i in 0..3 {
        let own = m[i][i];
        let before = rows.iter().map(|row| (row[i] / row[3]).powi(2)).sum::<f64>();
        if rows.len() < 4 || own <= 1e-6 * before {
            return None;
        }
        let pivot = m[i];
        for (_, line) in m.iter_mut().enumerate().filter(|(j, _)| *j != i) {
            let share = line[i] / own;
            (0..4).for_each(|k| line[k] -= share * pivot[k]);
        }
    }
    Some(std::array::from_fn(|i| m[i][3] / m[i][i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_has_its_exponent() {
        let points: Vec<_> = [1.0f64, 3.0, 20.0].iter().map(|x| (x.ln(), (5.0 * x.powf(0.75)).ln())).collect();
        assert!((exponent(&points).expect("spread") - 0.75).abs() < 1e-12);
        assert_eq!(exponent(&[(1.0, 2.0), (1.1, 3.0)]), None);
    }

    #[test]
    fn a_sum_has_its_shares() {
        let row = |x: f64, y: f64| [1.0, x, y, 4.0 + 0.5 * x + 2.0 * y];
        let found = shares(&[row(1.0, 9.0), row(10.0, 4.0), row(100.0, 1.0), row(7.0, 50.0)]).expect("told apart");
        assert!(found.iter().zip([4.0, 0.5, 2.0]).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?}");
        assert_eq!(shares(&[row(1.0, 1.0), row(2.0, 2.0), row(3.0, 3.0), row(4.0, 4.0)]), None);
    }
}
