//! Slefes: subdividable linear efficient function enclosures of Bézier polynomials.
//!
//! ```text
//!    p+ ╲_          p of degree n with coefficients b_i, D_j = b_(j-1) - 2 b_j + b_(j+1):
//!    p  ⌣  ╲__
//!    p- ╲___  ╲     p(t) = (1-t) b_0 + t b_n + sum_(j=1..n-1) D_j a_j(t)
//!       │  │  │
//!       0 1/m 2/m   a_j: coefficients -i (n-j) / n for i <= j, -j (n-i) / n for i >= j
//! ```
//!
//! Each `a_j` is convex and nowhere positive. Between break points `i / m` its best piecewise-linear upper bound `U_j`
//! is its own interpolant. The lower bound `L_j` solves a small linear program (the smallest largest gap, then the
//! smallest sum of gaps); `table.txt` has the solutions for degrees 2 to 9 and 1 to 9 segments. Then
//!
//! ```text
//!   p+ = linear + sum max(D_j, 0) U_j + min(D_j, 0) L_j
//!   p- = linear + sum max(D_j, 0) L_j + min(D_j, 0) U_j
//! ```
//!
//! enclose `p`. A tensor product is enclosed along its rows; then the upper values are bounded from above and the lower
//! values from below along the columns. This gives *bilinear* tiles between break points, as each step is convex in the
//! coefficients.
//!
//! `tools/slefe_table` writes the table; `tests/baselines` derives it again and compares it with values from the
//! literature. Sources: D. Lutterkort, J. Peters, *Optimized refinable enclosures of multivariate polynomial pieces*,
//! CAGD 18, 2001; Y. I. Yeo, L. Bin, J. Peters, *Efficient pixel-accurate rendering of curved surfaces*, 2012.

use std::cmp::Ordering;
use std::collections::HashMap;
use std::sync::LazyLock;

/// Largest degree in the table; degrees below 2 are linear and need no slefe.
pub const MOST_DEGREE: usize = 9;
/// Most segments in the table.
pub const MOST_SEGMENTS: usize = 9;

/// Default number of segments.
pub const USUAL_SEGMENTS: usize = 3;

/// The table: a line `n m j` and the `m + 1` values of `L_j`, for `j <= n / 2`; the other `j` are mirrored.
pub const TABLE: &str = include_str!("table.txt");

static LOWER: LazyLock<HashMap<[usize; 3], Vec<f64>>> = LazyLock::new(|| {
    let line = |line: &str| {
        let mut words = line.split_whitespace();
        let key = std::array::from_fn(|_| words.next().and_then(|w| w.parse().ok()).expect("n m j"));
        (key, words.map(|w| w.parse().expect("a number")).collect())
    };
    TABLE.lines().filter(|l| !l.starts_with('#')).map(line).collect()
});

/// Enclosures of the basis functions `a_j` of one degree on one number of segments.
#[derive(Clone, Debug, PartialEq)]
pub struct Slefe {
    degree: usize,
    segments: usize,
    /// `U_j` and `L_j` at the break points, `j - 1` first.
    bounds: Vec<(Vec<f64>, Vec<f64>)>,
}

/// Piecewise linear bounds at uniform break points.
#[derive(Clone, Debug, PartialEq)]
pub struct Enclosure {
    /// Below the polynomial.
    pub lower: Vec<f64>,
    /// Above it.
    pub upper: Vec<f64>,
}

/// Bézier coefficients of `a_j` of degree `n`.
pub fn basis(n: usize, j: usize) -> Vec<f64> {
    (0..=n).map(|i| -(i.min(j) as f64) * (n - i.max(j)) as f64 / n as f64).collect()
}

/// A Bézier polynomial at `t`, by de Casteljau's algorithm.
pub fn value(coefficients: &[f64], t: f64) -> f64 {
    let mut c = coefficients.to_vec();
    for last in (1..c.len()).rev() {
        (0..last).for_each(|i| c[i] += (c[i + 1] - c[i]) * t);
    }
    c[0]
}

/// The table as shaders read it, in single precision: `segments`, then `U_j` and `L_j` in turn at the break points, for
/// each `j`, for each degree from 2 to [`MOST_DEGREE`].
///
/// # Panics
/// If `segments` is not 1 to [`MOST_SEGMENTS`].
pub(crate) fn words(segments: usize) -> Vec<u32> {
    let bounds = (2..=MOST_DEGREE).flat_map(|degree| Slefe::new(degree, segments).bounds);
    let pairs = bounds.flat_map(|(upper, lower)| upper.into_iter().zip(lower)).flat_map(|(u, l)| [u, l]);
    std::iter::once(segments as u32).chain(pairs.map(|x| (x as f32).to_bits())).collect()
}

impl Slefe {
    /// # Panics
    /// If the degree is above [`MOST_DEGREE`], or `segments` is not 1 to [`MOST_SEGMENTS`].
    pub fn new(degree: usize, segments: usize) -> Self {
        assert!(degree <= MOST_DEGREE && (1..=MOST_SEGMENTS).contains(&segments), "degree {degree} on {segments}");
        let breaks = || (0..=segments).map(|i| i as f64 / segments as f64);
        let lower = |j: usize| {
            let stored = &LOWER[&[degree, segments, j.min(degree - j)]];
            let mirrored = || stored.iter().rev().copied();
            match (2 * j).cmp(&degree) {
                Ordering::Less => stored.clone(),
                // it is its own mirror image, except for the last digit of the solution
                Ordering::Equal => stored.iter().zip(mirrored()).map(|(a, b)| a.min(b)).collect(),
                Ordering::Greater => mirrored().collect(),
            }
        };
        let bounds = (1..degree).map(|j| (breaks().map(|t| value(&basis(degree, j), t)).collect(), lower(j))).collect();
        Self { degree, segments, bounds }
    }

    /// `U_j` and `L_j` at the break points.
    pub fn bounds(&self, j: usize) -> (&[f64], &[f64]) {
        let (upper, lower) = &self.bounds[j - 1];
        (upper, lower)
    }

    /// Bounds of the polynomial with these coefficients.
    ///
    /// # Panics
    /// If there are not `degree + 1` of them.
    pub fn enclose(&self, b: &[f64]) -> Enclosure {
        assert_eq!(b.len(), self.degree + 1, "one coefficient more than the degree");
        let linear = |i: usize| b[0] + (b[self.degree] - b[0]) * (i as f64 / self.segments as f64);
        let line: Vec<f64> = (0..=self.segments).map(linear).collect();
        let mut e = Enclosure { lower: line.clone(), upper: line };
        for (j, (upper, lower)) in self.bounds.iter().enumerate() {
            let d = b[j] - 2.0 * b[j + 1] + b[j + 2];
            let (above, below) = if d > 0.0 { (upper, lower) } else { (lower, upper) };
            for i in 0..=self.segments {
                e.upper[i] += d * above[i];
                e.lower[i] += d * below[i];
            }
        }
        e
    }

    /// Bounds of a tensor product with coefficients `b`, `u` fastest, at `(m + 1)` by `(m + 1)` break points. Their
    /// bilinear interpolants enclose it. `self` is for its rows, `columns` for its columns.
    pub fn enclose_net(&self, columns: &Self, b: &[f64]) -> Enclosure {
        let rows: Vec<Enclosure> = b.chunks_exact(self.degree + 1).map(|row| self.enclose(row)).collect();
        let (across, up) = (self.segments + 1, columns.segments + 1);
        let mut e = Enclosure { lower: vec![0.0; across * up], upper: vec![0.0; across * up] };
        for i in 0..across {
            let column = |of: fn(&Enclosure) -> &Vec<f64>| {
                columns.enclose(&rows.iter().map(|row| of(row)[i]).collect::<Vec<_>>())
            };
            let (lowest, highest) = (column(|r| &r.lower).lower, column(|r| &r.upper).upper);
            for j in 0..up {
                e.lower[j * across + i] = lowest[j];
                e.upper[j * across + i] = highest[j];
            }
        }
        e
    }
}

impl Enclosure {
    /// The largest distance between the two bounds.
    pub fn width(&self) -> f64 {
        self.upper.iter().zip(&self.lower).map(|(u, l)| u - l).fold(0.0, f64::max)
    }

    /// The largest absolute value of the bounds.
    pub fn largest(&self) -> f64 {
        self.upper.iter().chain(&self.lower).fold(0.0, |m, x| m.max(x.abs()))
    }
}
