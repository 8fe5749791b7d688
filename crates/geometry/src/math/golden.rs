//! The least value of a function between two parameters, by golden section: one value a step.
//!
//! ```text
//!   low ├──────────┼─────┼──────────┤ high     the lesser of c and d stays inside, and is c or d of the next step
//!                  c     d
//! ```

/// Share of the span after one step.
const SECTION: f64 = 0.618_033_988_749_894_9;

/// The two inner parameters after `steps` steps, in order: the least value of a function with one valley lies within
/// 0.618^`steps` of the span about them. A parabola's least value is known to rounding where its place is to 1e-8.
///
/// ```
/// let [c, d] = selvedge_geometry::math::golden::section((0.0, 1.0), 60, |x| (x - 0.3).powi(2));
/// assert!((0.5 * (c + d) - 0.3).abs() < 1e-7);
/// ```
pub fn section((low, high): (f64, f64), steps: usize, mut value: impl FnMut(f64) -> f64) -> [f64; 2] {
    let (mut a, mut b) = (low, high);
    let inner = |a: f64, b: f64| (b - (b - a) * SECTION, a + (b - a) * SECTION);
    let (mut c, mut d) = inner(a, b);
    let (mut of_c, mut of_d) = (value(c), value(d));
    for _ in 0..steps {
        if of_c <= of_d {
            (b, d, of_d) = (d, c, of_c);
            c = inner(a, b).0;
            of_c = value(c);
        } else {
            (a, c, of_c) = (c, d, of_d);
            d = inner(a, b).1;
            of_d = value(d);
        }
    }
    [c, d]
}

#[cfg(test)]
mod tests {
    use super::section;

    #[test]
    fn the_least_value_is_found_at_an_end_too() {
        for place in [-2.0, -1.0, 0.125, 1.0 / 3.0, 3.0, 7.0] {
            let [c, d] = section((-1.0, 3.0), 80, |x| (x - place).abs());
            assert!(c <= d && (c - f64::clamp(place, -1.0, 3.0)).abs() < 1e-13, "{place}: {c}");
        }
    }
}
