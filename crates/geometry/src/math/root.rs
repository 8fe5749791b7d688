//! One root of a continuous function in a bracket.

/// A zero of `f` between `a` and `b`, where `f(a)` and `f(b)` have opposite signs.
///
/// False position with the Illinois rule, and a bisection whenever three steps have not halved the bracket: superlinear
/// on simple roots, at most four times the steps of bisection on any. Stops on an exact zero or when the bracket is two
/// neighbouring numbers or shorter than `tolerance`; the result is the end of the bracket with the smaller `|f|`. If
/// the signs are not opposite, the end with the smaller `|f|` is returned.
///
/// Source: M. Dowell, P. Jarratt, *A modified regula falsi method*, BIT 11, 1971.
pub fn bracketed(mut f: impl FnMut(f64) -> f64, mut a: f64, mut b: f64, tolerance: f64) -> f64 {
    let (mut fa, mut fb) = (f(a), f(b));
    let (mut wa, mut wb) = (fa, fb); // the ordinates that aim the next step
    let nearer = |a: f64, fa: f64, b: f64, fb: f64| if fa.abs() <= fb.abs() { a } else { b };
    if fa == 0.0 || fb == 0.0 || (fa > 0.0) == (fb > 0.0) {
        return nearer(a, fa, b, fb);
    }
    let mut goal = (b - a).abs() * 0.5; // the length to be reached within three steps
    let mut steps = 0;
    let mut kept = 0; // +1 after a step that kept `b`, -1 after one that kept `a`
    while (b - a).abs() > tolerance {
        let middle = a + (b - a) * 0.5;
        let aimed = a + (b - a) * (wa / (wa - wb));
        let inside = (aimed > a) != (aimed > b) && aimed != a && aimed != b;
        let x = if inside && steps < 3 { aimed } else { middle };
        if x == a || x == b {
            break;
        }
        let fx = f(x);
        if fx == 0.0 {
            return x;
        }
        if (fx > 0.0) == (fa > 0.0) {
            (a, fa, wa) = (x, fx, fx);
            wb = if kept > 0 { wb * 0.5 } else { fb };
            kept = 1;
        } else {
            (b, fb, wb) = (x, fx, fx);
            wa = if kept < 0 { wa * 0.5 } else { fa };
            kept = -1;
        }
        steps += 1;
        if (b - a).abs() <= goal || steps > 3 {
            goal = (b - a).abs() * 0.5;
            steps = 0;
        }
    }
    nearer(a, fa, b, fb)
}

#[cfg(test)]
mod tests {
    use super::bracketed;

    #[test]
    fn a_line_is_solved_exactly() {
        assert_eq!(bracketed(|x| 0.25 - x, 0.0, 1.0, 0.0), 0.25);
        assert_eq!(bracketed(|x| x - 3.0, 8.0, 0.0, 0.0), 3.0);
    }

    #[test]
    fn square_root_to_the_last_bit() {
        let x = bracketed(|x| x * x - 2.0, 1.0, 2.0, 0.0);
        assert!((x - std::f64::consts::SQRT_2).abs() <= f64::EPSILON);
    }

    /// Roots of odd multiplicity defeat Newton and plain false position; the step count must stay
    /// below four bisections.
    #[test]
    fn flat_roots_cost_no_more_than_bisection() {
        for power in [3, 5, 9] {
            let mut calls = 0;
            let x = bracketed(
                |x| {
                    calls += 1;
                    (x - 0.3f64).powi(power)
                },
                0.0,
                1.0,
                1e-15,
            );
            assert!((x - 0.3).abs() <= 1e-15, "power {power}: {x}");
            assert!(calls <= 4 * 50 + 2, "power {power}: {calls} calls");
        }
    }

    #[test]
    fn without_a_bracket_the_nearer_end() {
        assert_eq!(bracketed(|x| x + 1.0, 0.0, 1.0, 0.0), 0.0);
        assert_eq!(bracketed(|x| x, 0.0, 1.0, 0.0), 0.0);
    }
}
