//! Expressions against Rust's own arithmetic, and the errors of bad ones.

use super::*;
use proptest::prelude::*;

fn value(text: &str) -> f64 {
    Equation::parse([text, "0", "0"], &[("r", 2.5), ("shift", -3.0)]).unwrap().at(0.3, -1.7).x
}

#[test]
fn precedence_is_that_of_paper() {
    let (u, v): (f64, f64) = (0.3, -1.7);
    let cases: &[(&str, f64)] = &[
        ("-u^2", -(u * u)),
        ("-2^2", -4.0),
        ("2-2^2*3", -10.0),
        ("u*-v^2", -(u * v * v)),
        ("u/-v^2", -(u / (v * v))),
        ("u/-v*u", u / -v * u),
        ("2^-u", 2f64.powf(-u)),
        ("2^-(u+1)", 2f64.powf(-(u + 1.0))),
        ("(2^3)^2", 64.0),
        ("2^(3^2)", 512.0),
        ("--2", 2.0),
        ("1-+2", -1.0),
        ("1--2", 3.0),
        ("-sin(u)^2", -(u.sin() * u.sin())),
        ("2*-cos(u)", -2.0 * u.cos()),
        ("1e-3*2E2+.5", 0.7),
        ("2*pi", std::f64::consts::TAU),
        ("shift^2", 9.0),
        ("-shift", 3.0),
        ("r*cos(u)*sin(v)", 2.5 * u.cos() * v.sin()),
        ("atan2(v, u)", v.atan2(u)),
        ("2*max(u, v)^2*3", 2.0 * u * u * 3.0),
        ("min(u+1, v)-max(-u, -v)", v - 1.7),
        ("v", v),
        ("u-v", u - v),
        ("8-4-2", 2.0),
        ("8/4/2", 1.0),
        ("ln(e)", 1.0),
        (" sqrt ( abs ( v ) ) ", v.abs().sqrt()),
        ("7", 7.0),
    ];
    for (text, expected) in cases {
        let got = value(text);
        assert!((got - expected).abs() <= 1e-14 * expected.abs().max(1.0), "{text}: {got}, not {expected}");
    }
}

#[test]
fn mistakes_name_their_column() {
    let cases: &[(&str, usize, &str)] = &[
        ("u+foo*2", 3, "unknown name `foo`"),
        ("2*radius", 3, "unknown name `radius`"),
        ("cos(w)", 5, "unknown name `w`"),
        ("2u", 2, "operator"),
        ("u v", 3, "operator"),
        ("u**2", 3, "`*`"),
        ("u+", 3, "ends"),
        ("", 1, "ends"),
        ("(u", 1, "not closed"),
        ("u)", 2, "without `(`"),
        ("sin u", 1, "parentheses"),
        ("sin()", 5, "`)`"),
        ("atan2(u)", 6, "two arguments"),
        ("sin(u,v)", 6, "no further argument"),
        ("u,v", 2, "no further argument"),
        ("2^3^4", 4, "parentheses"),
        ("1..2", 1, "not a finite number"),
        ("1e999", 1, "not a finite number"),
        ("u{v}", 2, "operator"),
        ("u & v", 3, "operator"),
    ];
    for (text, column, message) in cases {
        match Equation::parse(["u", text, "v"], &[]) {
            Err(ConstructError::Expression { expression: "y", column: c, message: m }) => {
                assert!(c == *column && m.contains(message), "{text}: column {c}, {m}");
            }
            other => panic!("{text}: {other:?}"),
        }
    }
    assert!(Equation::parse(["u", "v", "0"], &[("u", 1.0)]).is_err());
    assert!(Equation::parse(["u", "v", "k"], &[("k", f64::NAN)]).is_err());
    let long = "u+".repeat(4000);
    assert!(Equation::parse([&long, "v", "0"], &[]).unwrap_err().to_string().contains("2048"));
    // the deepest nesting that fits, and one more
    let deep = |n: usize| Equation::parse([&format!("{}u{}", "(".repeat(n), ")".repeat(n)), "v", "0"], &[]);
    assert_eq!(deep(32).unwrap().at(4.0, 0.0).x, 4.0);
    assert!(matches!(deep(33), Err(ConstructError::Expression { column: 33, .. })));
    let functions = format!("{}u{}", "cos(".repeat(32), ")".repeat(32));
    assert!(Equation::parse([&functions, "v", "0"], &[]).is_ok());
    let signs = format!("{}u", "-".repeat(2047));
    assert_eq!(Equation::parse([&signs, "v", "0"], &[]).unwrap().at(4.0, 0.0).x, -4.0);
    let terms = format!("{}u", "u+".repeat(1000));
    assert_eq!(Equation::parse([&terms, "v", "0"], &[]).unwrap().at(2.0, 0.0).x, 2002.0);
}

/// An expression and its value, built together.
fn tree() -> impl Strategy<Value = (String, f64)> {
    let leaf = prop_oneof![
        Just(("u".to_owned(), 0.3)),
        Just(("v".to_owned(), -1.7)),
        (1u32..50).prop_map(|n| (format!("{n}"), f64::from(n))),
    ];
    leaf.prop_recursive(5, 60, 2, |inner| {
        let p = |(s, x): (String, f64)| (format!("({s})"), x);
        prop_oneof![
            (inner.clone(), inner.clone()).prop_map(|(a, b)| (format!("{}+{}", a.0, b.0), a.1 + b.1)),
            (inner.clone(), inner.clone()).prop_map(move |(a, b)| {
                let b = p(b);
                (format!("{}-{}", a.0, b.0), a.1 - b.1)
            }),
            (inner.clone(), inner.clone()).prop_map(move |(a, b)| {
                let (a, b) = (p(a), p(b));
                (format!("{}*-{}", a.0, b.0), a.1 * -b.1)
            }),
            inner.clone().prop_map(move |a| {
                let a = p(a);
                (format!("-{}^2", a.0), -(a.1 * a.1))
            }),
            inner.clone().prop_map(|a| (format!("sin({})", a.0), a.1.sin())),
        ]
    })
}

proptest! {
    #[test]
    fn agrees_with_arithmetic((text, expected) in tree()) {
        prop_assume!(expected.abs() < 1e6 && text.len() < 4000);
        let got = Equation::parse([&text, "0", "0"], &[]).unwrap().at(0.3, -1.7).x;
        // sums are taken in another order, and sines of large arguments keep the difference
        prop_assert!((got - expected).abs() <= 1e-6 * expected.abs().max(1.0), "{}: {} {}", text, got, expected);
    }

    #[test]
    fn nothing_panics(text in "[uvrsincoqtxpe0-9 .,+*/^()-]{0,60}") {
        let _ = Equation::parse([&text, "u", "v"], &[]);
    }

    #[test]
    fn no_characters_panic(text in "\\PC{0,40}") {
        let _ = Equation::parse([&text, "u", "v"], &[]);
    }

    /// The parser takes and evaluates every output of the scan.
    #[test]
    fn the_scan_misses_nothing(text in "([-+]?(u|v|2|sin\\(u\\)|\\(u[-+*/]v\\))[-+*/]){0,6}u") {
        let e = Equation::parse([&text, "u", "v"], &[]);
        prop_assert!(e.is_ok(), "{}: {:?}", text, e);
        let _ = e.unwrap().at(0.5, 0.25);
    }
}
