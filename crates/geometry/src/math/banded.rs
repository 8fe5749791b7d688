//! Linear systems whose matrix is zero away from its diagonal.
//!
//! ```text
//!   ┌ a a a . . . ┐     lower = 1: entries below the diagonal
//!   │ a a a a . . │     upper = 2: above
//!   │ . a a a a . │
//!   │ . . a a a a │     factoring: O(n lower (lower + upper))
//!   │ . . . a a a │     each right side: O(n (lower + upper))
//!   └ . . . . a a ┘
//! ```
//!
//! Source: G. H. Golub, C. F. Van Loan, *Matrix Computations*, 4th ed. 2013, section 4.3.

use std::ops::{Mul, Sub};

/// A square banded matrix, row by row.
#[derive(Clone, Debug)]
pub struct Banded {
    n: usize,
    lower: usize,
    upper: usize,
    /// Row `i` holds columns `i - lower ..= i + upper + lower`: exchanges of rows fill the last ones.
    rows: Vec<f64>,
}

/// A factored [`Banded`] matrix.
#[derive(Clone, Debug)]
pub struct Factored {
    matrix: Banded,
    /// Factors of elimination, `lower` a column.
    factors: Vec<f64>,
    /// The row that column `i`'s pivot came from.
    pivots: Vec<usize>,
}

/// No unique solution: the pivot of this column is zero against the size of its entries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the linear system has no unique solution: unknown {0} is not determined")]
pub struct Singular(pub usize);

impl Banded {
    /// The zero matrix.
    pub fn new(n: usize, lower: usize, upper: usize) -> Self {
        Self { n, lower, upper, rows: vec![0.0; n * (2 * lower + upper + 1)] }
    }

    fn index(&self, i: usize, j: usize) -> usize {
        i * (2 * self.lower + self.upper + 1) + (j + self.lower - i)
    }

    /// Adds `x` to the entry in row `i` and column `j`.
    ///
    /// # Panics
    /// When the entry lies outside of the band.
    pub fn add(&mut self, i: usize, j: usize, x: f64) {
        assert!(i < self.n && j < self.n && j + self.lower >= i && j <= i + self.upper, "({i}, {j}) is in the band");
        let at = self.index(i, j);
        self.rows[at] += x;
    }

    /// LU factors, with the largest pivot of each column.
    ///
    /// # Errors
    /// [`Singular`] where every pivot of a column is below `1e-14` of the largest entry of the matrix, or
    /// not a number.
    pub fn factor(mut self) -> Result<Factored, Singular> {
        /// Rounding leaves about this much of a zero pivot.
        const NOTHING: f64 = 1e-14;
        let (n, lower) = (self.n, self.lower);
        let largest = self.rows.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let mut factors = vec![0.0; n * lower];
        let mut pivots = Vec::with_capacity(n);
        for c in 0..n {
            let last = (c + lower).min(n - 1);
            let size = |i: usize| self.rows[self.index(i, c)].abs();
            let pivot = (c..=last).fold(c, |best, i| if size(i) > size(best) { i } else { best });
            if size(pivot) <= NOTHING * largest || !size(pivot).is_finite() {
                return Err(Singular(c));
            }
            let end = (c + self.upper + lower).min(n - 1);
            if pivot != c {
                for j in c..=end {
                    let (a, b) = (self.index(c, j), self.index(pivot, j));
                    self.rows.swap(a, b);
                }
            }
            pivots.push(pivot);
            let top = self.index(c, c);
            for i in c + 1..=last {
                let at = self.index(i, c);
                let factor = self.rows[at] / self.rows[top];
                factors[c * lower + i - c - 1] = factor;
                if factor != 0.0 {
                    for k in 0..=end - c {
                        self.rows[at + k] -= factor * self.rows[top + k];
                    }
                }
            }
        }
        Ok(Factored { matrix: self, factors, pivots })
    }
}

impl Factored {
    /// Replaces the right side `b` by the solution; numbers or vectors alike.
    ///
    /// # Panics
    /// When `b` has not one entry a row.
    pub fn solve<T: Copy + Sub<Output = T> + Mul<f64, Output = T>>(&self, b: &mut [T]) {
        let (m, n, lower) = (&self.matrix, self.matrix.n, self.matrix.lower);
        assert_eq!(b.len(), n, "one entry a row");
        for c in 0..n {
            b.swap(c, self.pivots[c]);
            for i in c + 1..=(c + lower).min(n - 1) {
                b[i] = b[i] - b[c] * self.factors[c * lower + i - c - 1];
            }
        }
        for c in (0..n).rev() {
            let at = m.index(c, c);
            let end = (c + m.upper + lower).min(n - 1);
            let mut x = b[c];
            for (known, entry) in b[c + 1..=end].iter().zip(&m.rows[at + 1..]) {
                x = x - *known * *entry;
            }
            b[c] = x * (1.0 / m.rows[at]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn second_differences() {
        // -x'' = 2 on (0, 1), five points inside: x (1 - x) exactly
        let (n, h) = (5, 1.0 / 6.0);
        let mut a = Banded::new(n, 1, 1);
        for i in 0..n {
            a.add(i, i, 2.0);
            if i > 0 {
                a.add(i, i - 1, -1.0);
                a.add(i - 1, i, -1.0);
            }
        }
        let mut b = vec![2.0 * h * h; n];
        a.factor().unwrap().solve(&mut b);
        for (i, x) in b.iter().enumerate() {
            let t = (i + 1) as f64 * h;
            assert!((x - t * (1.0 - t)).abs() < 1e-15);
        }
    }

    #[test]
    fn a_zero_on_the_diagonal_is_no_obstacle_and_a_zero_column_is() {
        let mut a = Banded::new(2, 1, 1);
        a.add(0, 1, 2.0);
        a.add(1, 0, 4.0);
        let mut b = [6.0, 8.0];
        a.clone().factor().unwrap().solve(&mut b);
        assert_eq!(b, [2.0, 3.0]);
        let mut c = Banded::new(3, 1, 1);
        c.add(0, 0, 1.0);
        c.add(2, 2, 1.0);
        assert_eq!(c.factor().unwrap_err(), Singular(1));
        let mut d = Banded::new(1, 0, 0);
        d.add(0, 0, f64::NAN);
        assert!(d.factor().is_err());
    }

    proptest! {
        #[test]
        fn solves_what_was_multiplied(
            lower in 0usize..4, upper in 0usize..4,
            x in prop::collection::vec(-1.0f64..1.0, 1..12),
            entries in prop::collection::vec(-1.0f64..1.0, 200),
        ) {
            let n = x.len();
            let mut a = Banded::new(n, lower, upper);
            let mut b = vec![0.0; n];
            let mut next = entries.iter();
            for (i, sum) in b.iter_mut().enumerate() {
                for (j, x) in x.iter().enumerate().take(i + upper + 1).skip(i.saturating_sub(lower)) {
                    // heavier beside the diagonal than on it, so that rows are exchanged
                    let e = next.next().unwrap() + if j + 1 == i { 3.0 } else if j == i { 2.0 } else { 0.0 };
                    a.add(i, j, e);
                    *sum += e * x;
                }
            }
            if let Ok(f) = a.factor() {
                f.solve(&mut b);
                let size = b.iter().fold(0.0f64, |m, v| m.max(v.abs()));
                prop_assume!(size < 1e3); // badly conditioned draws are skipped
                for (p, q) in b.iter().zip(&x) {
                    prop_assert!((p - q).abs() < 1e-6, "{} {}", p, q);
                }
            }
        }
    }
}
