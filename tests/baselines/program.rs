//! The linear program behind the slefe table: the best piecewise-linear lower bound of a basis function.
//!
//! ```text
//!    U_i ●───────● U_(i+1)      gaps g_i >= 0 at the break points: L_i = U_i - g_i. The chord of L stays below
//!     g_i│ ⌣ a_j │ g_(i+1)      a_j where   (1 - s) g_i + s g_(i+1) >= chord of U - a_j =: h_i(s),  s in [0, 1]
//!    L_i ●───────●
//! ```
//!
//! First the smallest largest gap, then with it the smallest sum of gaps. There are infinitely many constraints; those
//! that the last solution violates most are added (*cutting planes*). `h_i` is concave, so bisection finds them.

use crate::simplex::cover;
use selvedge::baselines::slefe::{basis, value};

/// Largest remaining violation, far above the rounding of the programs; it is added to every gap at the end.
const DONE: f64 = 1e-11;

/// One basis function on a number of segments.
pub struct Program {
    a: Vec<f64>,
    slope: Vec<f64>,
    m: usize,
}

impl Program {
    pub fn new(degree: usize, j: usize, m: usize) -> Self {
        let a = basis(degree, j);
        let slope = a.windows(2).map(|w| (w[1] - w[0]) * degree as f64).collect();
        Self { a, slope, m }
    }

    fn at(&self, i: usize, s: f64) -> f64 {
        value(&self.a, (i as f64 + s) / self.m as f64)
    }

    /// `h_i(s)`.
    pub fn bulge(&self, i: usize, s: f64) -> f64 {
        self.at(i, 0.0) * (1.0 - s) + self.at(i, 1.0) * s - self.at(i, s)
    }

    /// The `s` at which `h_i` exceeds a line of slope `rise` by most.
    pub fn farthest(&self, i: usize, rise: f64) -> f64 {
        let chord = self.at(i, 1.0) - self.at(i, 0.0);
        let (mut lo, mut hi) = (0.0, 1.0);
        for _ in 0..60 {
            let s = (lo + hi) / 2.0;
            let slope = chord - value(&self.slope, (i as f64 + s) / self.m as f64) / self.m as f64;
            if slope > rise { lo = s } else { hi = s }
        }
        lo
    }

    /// The cheapest gaps with `more` constraints; `costs` has one entry more than the gaps.
    fn solve(&self, more: &[(Vec<f64>, f64)], costs: &[f64]) -> Vec<f64> {
        let mut rows = more.to_vec();
        let cut = |i: usize, s: f64, rows: &mut Vec<(Vec<f64>, f64)>| {
            let mut row = vec![0.0; self.m + 2];
            (row[i], row[i + 1]) = (1.0 - s, s);
            rows.push((row, self.bulge(i, s)));
        };
        (0..self.m).for_each(|i| cut(i, 0.5, &mut rows));
        loop {
            let g = cover(&rows, costs);
            let before = rows.len();
            for i in 0..self.m {
                let s = self.farthest(i, g[i + 1] - g[i]);
                if self.bulge(i, s) > g[i] * (1.0 - s) + g[i + 1] * s + DONE {
                    cut(i, s, &mut rows);
                }
            }
            if rows.len() == before {
                return g;
            }
        }
    }

    /// `L` at the break points.
    pub fn lower(&self) -> Vec<f64> {
        let (m, width) = (self.m, self.m + 2);
        let unit = |k: usize, x: f64| (0..width).map(move |i| if i == k { x } else { 0.0 });
        let below: Vec<_> = (0..=m)
            .map(|i| (unit(i, -1.0).zip(unit(m + 1, 1.0)).map(|(a, b)| a + b).collect::<Vec<_>>(), 0.0))
            .collect();
        let most = self.solve(&below, &unit(m + 1, 1.0).collect::<Vec<_>>())[m + 1] + DONE;
        let limits: Vec<_> = (0..=m).map(|i| (unit(i, -1.0).collect(), -most)).collect();
        let mut g = self.solve(&limits, &(0..width).map(|i| f64::from(u8::from(i <= m))).collect::<Vec<_>>());
        g.truncate(m + 1);
        if self.a.iter().eq(self.a.iter().rev()) {
            // as good as its mirror image, and so is every mean of both: the constraints are convex
            let mirrored: Vec<f64> = g.iter().rev().copied().collect();
            g.iter_mut().zip(mirrored).for_each(|(x, y)| *x = (*x + y) / 2.0);
        }
        g.iter().enumerate().map(|(i, g)| value(&self.a, i as f64 / m as f64) - g - DONE).collect()
    }
}
