//! The slefe table: derived again, valid, tight, as in the literature; and the cases where slefes fail as a guarantee.

use crate::program::Program;
use selvedge::baselines::slefe::{MOST_DEGREE, MOST_SEGMENTS, Slefe, TABLE, basis, value};
use std::fmt::Write as _;

/// Digits after the point; the last is rounded down, so that a lower bound stays one.
const DIGITS: i32 = 12;

fn all() -> impl Iterator<Item = (usize, usize)> {
    (2..=MOST_DEGREE).flat_map(|n| (1..=MOST_SEGMENTS).map(move |m| (n, m)))
}

/// `SELVEDGE_WRITE_SLEFES=1` writes the table (`tools/slefe_table`); without it the stored one must be the same, up to
/// rounding of the last digits.
#[test]
fn the_table_is_what_the_program_yields() {
    let mut text =
        String::from("# n m j, then L_j at 0, 1/m, ..., 1 of degree n on m segments; tools/slefe_table wrote it\n");
    for (n, m) in all() {
        for j in 1..=n / 2 {
            let lower = Program::new(n, j, m).lower();
            write!(text, "{n} {m} {j}").unwrap();
            for x in lower {
                let unit = 10f64.powi(DIGITS);
                write!(text, " {:.1$}", (x * unit).floor() / unit, DIGITS as usize).unwrap();
            }
            text.push('\n');
        }
    }
    if std::env::var_os("SELVEDGE_WRITE_SLEFES").is_some() {
        std::fs::write(concat!(env!("CARGO_MANIFEST_DIR"), "/src/baselines/slefe/table.txt"), text).unwrap();
        return;
    }
    assert_eq!(text.lines().count(), TABLE.lines().count());
    for (derived, stored) in text.lines().zip(TABLE.lines()).skip(1) {
        let numbers = |line: &str| line.split(' ').map(|w| w.parse().unwrap()).collect::<Vec<f64>>();
        let (derived, stored) = (numbers(derived), numbers(stored));
        assert_eq!(derived.len(), stored.len());
        assert!(derived.iter().zip(&stored).all(|(d, s)| (d - s).abs() < 1e-10), "{derived:?}, {stored:?}");
    }
}

/// `L_j <= a_j <= U_j` everywhere; the widest gap is as small as possible for a lower bound; mirrored for `n - j`.
#[test]
fn each_is_a_valid_tight_symmetric_enclosure() {
    for (n, m) in all() {
        let slefe = Slefe::new(n, m);
        for j in 1..n {
            let (upper, lower) = slefe.bounds(j);
            let program = Program::new(n, j, m);
            let mut least = 0.0f64;
            for i in 0..m {
                // the chord of U lies above a convex function; L must be at its deepest point below
                least = least.max(program.bulge(i, program.farthest(i, 0.0)));
                let rise = (upper[i + 1] - lower[i + 1]) - (upper[i] - lower[i]);
                for s in (0..=50).map(|k| f64::from(k) / 50.0).chain([program.farthest(i, rise)]) {
                    let a = value(&basis(n, j), (i as f64 + s) / m as f64);
                    let between = |b: &[f64]| b[i] * (1.0 - s) + b[i + 1] * s;
                    // de Casteljau's algorithm rounds in the 16th digit
                    assert!(between(lower) <= a + 1e-15 && a <= between(upper) + 1e-15, "{n} {m} {j}: {i} {s}");
                }
            }
            let width = upper.iter().zip(lower).map(|(u, l)| u - l).fold(0.0, f64::max);
            assert!(width < least + 1e-10, "{n} {m} {j}: {width} where {least} will do");
            let (other_upper, other_lower) = slefe.bounds(n - j);
            let mirrored = |a: &[f64], b: &[f64]| a.iter().zip(b.iter().rev()).all(|(x, y)| (x - y).abs() < 1e-14);
            assert!(mirrored(upper, other_upper) && mirrored(lower, other_lower));
        }
    }
}

/// Published values, to the digits published.
#[test]
fn anchors() {
    let near = |a: f64, b: f64, digits: f64| (a - b).abs() < 0.6 * 10f64.powf(-digits);
    for m in 1..=MOST_SEGMENTS {
        let slefe = Slefe::new(2, m);
        let (upper, lower) = slefe.bounds(1);
        for i in 0..=m {
            let (t, mf) = (i as f64 / m as f64, m as f64);
            assert!((upper[i] + t * (1.0 - t)).abs() < 1e-12 && (upper[i] - lower[i] - 0.25 / mf / mf).abs() < 1e-10);
        }
    }
    let cubic = Slefe::new(3, 3);
    let (upper, lower) = cubic.bounds(1);
    for (have, want) in upper.iter().zip([0.0, -0.370_370_4, -0.296_296_3, 0.0]) {
        assert!(near(*have, want, 7.0), "{upper:?}");
    }
    for (have, want) in lower.iter().zip([-0.069_521_4, -0.439_891_8, -0.315_351_6, -0.008_732_7]) {
        assert!(near(*have, want, 7.0), "{lower:?}");
    }
    let widths = [
        (3, [0.38490, 0.14106, 0.06952, 0.04104, 0.01910, 0.01099]),
        (4, [0.62500, 0.21739, 0.11702, 0.07218, 0.03509, 0.02062]),
        (5, [0.79358, 0.28542, 0.16556, 0.10627, 0.05382, 0.03229]),
    ];
    for (n, widths) in widths {
        for (m, want) in [1, 2, 3, 4, 6, 8].into_iter().zip(widths) {
            let slefe = Slefe::new(n, m);
            let gap = |j| slefe.bounds(j).0.iter().zip(slefe.bounds(j).1).map(|(u, l)| u - l).fold(0.0, f64::max);
            let width = (1..n).map(gap).fold(0.0, f64::max);
            assert!(near(width, want, 5.0), "degree {n} on {m}: {width}, not {want}");
        }
    }
}

/// Reparametrising to half the interval divides second differences by at least four, but not the width of the slefe: a
/// factor from `sqrt(width / tolerance)` may be too small. Numbers: supplement to ETER, 2023.
#[test]
fn the_width_does_not_shrink_with_the_square_of_the_interval() {
    let b = [0.1967, 0.1983, 0.1704, 0.3678];
    let slefe = Slefe::new(3, 3);
    let whole = slefe.enclose(&b).width();
    assert!((whole - 0.0162).abs() < 5e-5, "{whole}");
    let half = |i: usize| (0..4 - i).map(|k| value(&b[k..=k + i], 0.5)).next_back().unwrap();
    let right = slefe.enclose(&[half(3), half(2), half(1), half(0)]).width();
    assert!((right - 0.0044).abs() < 5e-5, "{right}");
    assert!(right > whole / 4.0, "{right} is no quarter of {whole}");
}

/// A twisted bilinear patch is its own slefe: its width is 0 for any number of segments, but two triangles miss it by a
/// quarter of the twist.
#[test]
fn a_bilinear_patch_has_no_width_and_triangles_miss_it() {
    let twist = [0.0, 0.0, 0.0, 1.0]; // u v
    for m in 1..=MOST_SEGMENTS {
        let line = Slefe::new(1, m);
        assert!(line.enclose_net(&line, &twist).width() < 1e-15);
    }
    let (surface, triangles) = (0.5 * 0.5, 0.5); // on the diagonal from (0, 0) to (1, 1)
    assert_eq!(triangles - surface, 0.25);
}

/// Tensor slefes enclose: random nets of unequal degrees.
#[test]
fn nets_are_enclosed() {
    let mut seed = 7u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as f64 / (1u64 << 30) as f64 - 1.0
    };
    for (n, k, m) in [(2, 3, 3), (5, 1, 2), (7, 4, 9), (9, 9, 4)] {
        let b: Vec<f64> = (0..(n + 1) * (k + 1)).map(|_| random()).collect();
        let (rows, columns) = (Slefe::new(n, m), Slefe::new(k, m));
        let e = rows.enclose_net(&columns, &b);
        for (i, j) in (0..=40).flat_map(|i| (0..=40).map(move |j| (i, j))) {
            let (u, v) = (f64::from(i) / 40.0, f64::from(j) / 40.0);
            let row: Vec<f64> = b.chunks_exact(n + 1).map(|row| value(row, u)).collect();
            let p = value(&row, v);
            let place = |t: f64| ((t * m as f64).floor() as usize).min(m - 1);
            let (a, c) = (place(u), place(v));
            let (s, t) = (u * m as f64 - a as f64, v * m as f64 - c as f64);
            let tile = |g: &[f64]| {
                let at = |i: usize, j: usize| g[(c + j) * (m + 1) + a + i];
                (at(0, 0) * (1.0 - s) + at(1, 0) * s) * (1.0 - t) + (at(0, 1) * (1.0 - s) + at(1, 1) * s) * t
            };
            assert!(tile(&e.lower) <= p + 1e-12 && p <= tile(&e.upper) + 1e-12, "degrees {n}, {k} on {m}");
        }
    }
}
