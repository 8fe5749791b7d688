//! Bernstein polynomials: the evaluation that the shaders repeat step by step.

use super::Control;

/// Largest degree of a surface or trim curve, in each direction.
///
/// The evaluation has no per-degree table, so the limit is a contract with the file formats (real files reach 14), not
/// a buffer size.
pub const MAX_DEGREE: usize = 15;

/// `n` over `k`, exact for every `n` up to 50.
pub fn binomial(n: usize, k: usize) -> f64 {
    let k = k.min(n - k);
    (0..k).fold(1.0, |b, i| b * (n - i) as f64 / (i + 1) as f64)
}

/// `sum B_i^n(t) p_i` by Horner's scheme in `t / (1 - t)`.
///
/// Exact at both ends: `t = 0` returns `points[0]` and `t = 1` the last point, bit for bit, so neighbouring patches
/// meet without a crack. Cost: `3 n` multiply-adds a coordinate. Relative error below `2 n` ulp of the largest control
/// value for `t` in `[0, 1]`.
///
/// Source: Farin 2002, section 4.3 (`hornbez`).
pub(super) fn horner<P: Control>(points: &[P], t: f64) -> P {
    let n = points.len() - 1;
    let s = 1.0 - t;
    if n == 0 {
        return points[0];
    }
    let table = CHOOSE.get(n);
    let mut factor = 1.0;
    let mut choose = 1.0;
    let mut sum = points[0] * s;
    for (i, &p) in points.iter().enumerate().take(n).skip(1) {
        factor *= t;
        choose = table.map_or_else(|| choose * ((n - i + 1) as f64 / i as f64), |row| row[i]);
        sum = (sum + p * (factor * choose)) * s;
    }
    sum + points[n] * (factor * t)
}

/// `n` over `k` as the running product of [`horner`] gives it, so that both agree bit for bit: a
/// table, because a division a step would cost as much as the rest of it.
const CHOOSE: [[f64; MAX_DEGREE + 1]; MAX_DEGREE + 1] = {
    let mut table = [[1.0; MAX_DEGREE + 1]; MAX_DEGREE + 1];
    let mut n = 0;
    while n <= MAX_DEGREE {
        let mut i = 1;
        while i < n {
            table[n][i] = table[n][i - 1] * ((n - i + 1) as f64 / i as f64);
            i += 1;
        }
        n += 1;
    }
    table
};

/// Room in a [`Row`] for every degree.
pub(super) const FULL: usize = MAX_DEGREE + 1;

/// The factors with which [`horner`] multiplies the points, for many rows at one `t`; the values are the same, bit for
/// bit.
pub(super) struct Row<const ROOM: usize> {
    s: f64,
    degree: usize,
    weights: [f64; ROOM],
}

impl<const ROOM: usize> Row<ROOM> {
    /// For rows of `degree + 1` points; `degree` is less than `ROOM`.
    #[inline]
    pub fn new(degree: usize, t: f64) -> Self {
        let mut weights = [1.0; ROOM];
        let mut factor = 1.0;
        let choose = &CHOOSE[degree];
        for i in 1..degree {
            factor *= t;
            weights[i] = factor * choose[i];
        }
        weights[degree] = factor * t;
        Self { s: 1.0 - t, degree, weights }
    }

    /// `horner(points, t)`.
    pub fn value<P: Control>(&self, points: &[P]) -> P {
        if self.degree == 0 {
            return points[0];
        }
        let (points, weights) = (&points[..=self.degree], &self.weights[..=self.degree]);
        let mut sum = points[0] * self.s;
        for i in 1..self.degree {
            sum = (sum + points[i] * weights[i]) * self.s;
        }
        sum + points[self.degree] * weights[self.degree]
    }

    /// [`Row::value`] of a row whose length the compiler knows; `degree` was one less.
    #[inline]
    pub fn value_of<P: Control>(&self, points: &[P; ROOM]) -> P {
        let mut sum = points[0] * self.s;
        for (point, weight) in points[1..ROOM - 1].iter().zip(&self.weights[1..]) {
            sum = (sum + *point * *weight) * self.s;
        }
        sum + points[ROOM - 1] * self.weights[ROOM - 1]
    }

    /// [`Row::jet`] of a row whose length, at least 2, the compiler knows; `degree` was two less.
    #[inline]
    pub fn jet_of<P: Control>(&self, points: &[P; ROOM], t: f64) -> (P, P) {
        let value = |points: &[P]| {
            let mut sum = points[0] * self.s;
            for (point, weight) in points[1..ROOM - 2].iter().zip(&self.weights[1..]) {
                sum = (sum + *point * *weight) * self.s;
            }
            sum + points[ROOM - 2] * self.weights[ROOM - 2]
        };
        let (a, b) = if ROOM == 2 { (points[0], points[1]) } else { (value(&points[..ROOM - 1]), value(&points[1..])) };
        (a * (1.0 - t) + b * t, (b - a) * (ROOM - 1) as f64)
    }

    /// `horner_jet(points, t)` for points of one degree more than the row's, which may both be 0.
    pub fn jet<P: Control>(&self, points: &[P], t: f64) -> (P, P) {
        let n = points.len() - 1;
        if n == 0 {
            return (points[0], P::ZERO);
        }
        let (a, b) = (self.value(&points[..n]), self.value(&points[1..]));
        (a * (1.0 - t) + b * t, (b - a) * n as f64)
    }
}

/// Value and first derivative, from the last step of de Casteljau's algorithm:
/// with `a`, `b` the degree `n - 1` values of the first and last `n` points, `p = a + t (b - a)`
/// and `p' = n (b - a)`.
pub(super) fn horner_jet<P: Control>(points: &[P], t: f64) -> (P, P) {
    let n = points.len() - 1;
    if n == 0 {
        return (points[0], P::ZERO);
    }
    if n <= MAX_DEGREE {
        return Row::<FULL>::new(n - 1, t).jet(points, t);
    }
    let (a, b) = (horner(&points[..n], t), horner(&points[1..], t));
    (a * (1.0 - t) + b * t, (b - a) * n as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec4;

    /// The formula itself, with a division a step.
    fn divided(points: &[DVec4], t: f64) -> DVec4 {
        let n = points.len() - 1;
        let (mut factor, mut choose, mut sum) = (1.0, 1.0, points[0] * (1.0 - t));
        for (i, &point) in points.iter().enumerate().take(n).skip(1) {
            factor *= t;
            choose *= (n - i + 1) as f64 / i as f64;
            sum = (sum + point * (factor * choose)) * (1.0 - t);
        }
        sum + points[n] * (factor * t)
    }

    #[test]
    fn tables_change_no_bit() {
        let point = |i: usize| DVec4::new((i as f64).sin(), 1.0 / (i + 3) as f64, i as f64 * 0.7, 1.0 + 0.1 * i as f64);
        let points: Vec<DVec4> = (0..40).map(point).collect();
        for degree in 1..=39 {
            for t in [0.0, 1.0, 0.5, 1.0 / 3.0, 0.9371, -0.2, 1.7] {
                let row = &points[..=degree];
                assert_eq!(horner(row, t), divided(row, t), "degree {degree}, t {t}");
                let (a, b) = (divided(&points[..degree], t), divided(&points[1..=degree], t));
                let jet = (a * (1.0 - t) + b * t, (b - a) * degree as f64);
                if degree > 1 {
                    assert_eq!(horner_jet(row, t), jet, "degree {degree}, t {t}");
                }
                if degree <= MAX_DEGREE {
                    assert_eq!(Row::<FULL>::new(degree, t).value(row), divided(row, t), "degree {degree}, t {t}");
                }
            }
        }
    }
}
