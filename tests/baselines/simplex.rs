//! A covering linear program: the cheapest `x >= 0` with `A x >= b`, for costs `c >= 0`.
//!
//! Its dual, the largest `b y` with `Aᵀ y <= c`, `y >= 0`, starts feasible at `y = 0`; the simplex method ends with
//! `x` in the objective row. Bland's rule keeps it from going in circles. Source: V. Chvátal, *Linear Programming*,
//! 1983, chapters 3 and 5.

/// A smaller reduced cost or pivot is rounding; the programs here have entries of about 1.
const ZERO: f64 = 1e-12;

/// `rows`: pairs of a row of `A` and its bound.
pub fn cover(rows: &[(Vec<f64>, f64)], costs: &[f64]) -> Vec<f64> {
    let (n, m) = (rows.len(), costs.len());
    // one tableau row for each x: y's, slacks, right side; the objective last
    let mut t: Vec<Vec<f64>> = (0..m)
        .map(|i| {
            let slack = (0..m).map(|k| f64::from(u8::from(k == i)));
            rows.iter().map(|(row, _)| row[i]).chain(slack).chain([costs[i]]).collect()
        })
        .collect();
    t.push(rows.iter().map(|(_, b)| -b).chain(vec![0.0; m + 1]).collect());
    let mut basis: Vec<usize> = (n..n + m).collect();
    while let Some(enter) = (0..n + m).find(|&k| t[m][k] < -ZERO) {
        let ratio = |i: &usize| t[*i][n + m] / t[*i][enter];
        let leave = (0..m).filter(|&i| t[i][enter] > ZERO);
        let order = |a: &usize, b: &usize| ratio(a).total_cmp(&ratio(b)).then(basis[*a].cmp(&basis[*b]));
        let leave = leave.min_by(order).expect("a cover exists");
        let pivot = t[leave][enter];
        t[leave].iter_mut().for_each(|x| *x /= pivot);
        let row = t[leave].clone();
        for (_, other) in t.iter_mut().enumerate().filter(|(i, _)| *i != leave) {
            let factor = other[enter];
            other.iter_mut().zip(&row).for_each(|(x, r)| *x -= factor * r);
        }
        basis[leave] = enter;
    }
    t[m][n..n + m].to_vec()
}

#[test]
fn small_programs() {
    // the corner of x + 2 y >= 4 and 3 x + y >= 6
    let x = cover(&[(vec![1.0, 2.0], 4.0), (vec![3.0, 1.0], 6.0)], &[1.0, 1.0]);
    assert!((x[0] - 1.6).abs() < 1e-12 && (x[1] - 1.2).abs() < 1e-12, "{x:?}");
    // y is too expensive
    assert_eq!(cover(&[(vec![1.0, 2.0], 4.0)], &[1.0, 3.0]), [4.0, 0.0]);
    // an upper bound: -x >= -3
    let x = cover(&[(vec![1.0, 1.0], 4.0), (vec![-1.0, 0.0], -3.0)], &[1.0, 2.0]);
    assert_eq!(x, [3.0, 1.0]);
}
