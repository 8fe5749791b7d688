//! The chord count satisfies its bound, and is not much larger than necessary.

use crate::shapes::{at, circle, curve};
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use selvedge_geometry::spline::{Bezier, Control};
use selvedge_geometry::trim::{polyline, segment_count};

/// Distance of `p` from the segment `a b`.
fn to_chord(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let t = if a == b { 0.0 } else { ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0) };
    p.distance(a + along * t)
}

/// Largest distance of sampled curve points from their chord, in scaled units.
fn deviation(curve: &Bezier<DVec3>, segments: u32, scale: DVec2, samples: u32) -> f64 {
    let points: Vec<DVec2> = polyline(curve, segments).map(|p| p * scale).collect();
    let mut worst = 0.0f64;
    for (i, ends) in points.windows(2).enumerate() {
        for j in 1..samples {
            let t = (i as f64 + f64::from(j) / f64::from(samples)) / f64::from(segments);
            worst = worst.max(to_chord(curve.point(t) * scale, ends[0], ends[1]));
        }
    }
    worst
}

/// Degree 1 to 9, weights from 1 to 100, coordinates of any offset.
fn random_curve() -> impl Strategy<Value = Bezier<DVec3>> {
    let control = (-1f64..1.0, -1f64..1.0, prop_oneof![Just(0.0), 0f64..2.0]);
    let offset = prop_oneof![Just(0.0), -100f64..100.0];
    (prop::collection::vec(control, 2..11), offset).prop_map(|(points, offset)| Bezier {
        points: points.into_iter().map(|(u, v, w)| DVec3::from_point(at(u + offset, v), 10f64.powf(w))).collect(),
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]
    #[test]
    fn the_deviation_is_never_above_eps(
        curve in random_curve(),
        scale in (0.1f64..10.0, 0.1f64..10.0),
        eps in prop_oneof![0.01f64..0.1, 0.1f64..2.0],
    ) {
        let scale = at(scale.0, scale.1);
        let segments = segment_count(&curve, scale, eps);
        let found = deviation(&curve, segments, scale, 8);
        prop_assert!(found <= eps * (1.0 + 1e-12), "{} above {} with {} chords", found, eps, segments);
    }
}

#[test]
fn a_parabola_gets_exactly_what_it_needs() {
    // v = 4 t (1 - t): the middle of each of s chords lies 1 / s² below the curve
    let parabola = curve(&[(0.0, 0.0), (0.5, 2.0), (1.0, 0.0)]);
    for s in [1, 2, 5, 16, 100] {
        let eps = 1.0 / f64::from(s * s);
        let points: Vec<DVec2> = polyline(&parabola, s).collect();
        for (i, ends) in points.windows(2).enumerate() {
            let sag = parabola.point((i as f64 + 0.5) / f64::from(s)).y - 0.5 * (ends[0].y + ends[1].y);
            assert!((sag - eps).abs() < 1e-15);
        }
        assert_eq!(segment_count(&parabola, DVec2::ONE, eps * (1.0 + 1e-12)), s);
        assert_eq!(segment_count(&parabola, DVec2::ONE, eps * (1.0 - 1e-12)), s + 1);
    }
}

#[test]
fn a_quarter_circle_gets_less_than_twice_what_it_needs() {
    let quarter = circle(DVec2::ZERO, 1.0).curves().next().unwrap();
    for eps in [1e-1, 1e-2, 1e-4, 1e-6] {
        let count = segment_count(&quarter, DVec2::ONE, eps);
        let least = (1..=count).find(|&s| deviation(&quarter, s, DVec2::ONE, 8) <= eps).unwrap();
        assert!(count < 2 * least, "{count} chords, {least} are enough for {eps}");
    }
}

#[test]
fn lines_need_one_chord_and_nonsense_does_not_panic() {
    let line = curve(&[(0.0, 0.0), (3.0, 1.0)]);
    let cubic = curve(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0)]);
    let bent = curve(&[(0.0, 0.0), (1.0, 1.0), (2.0, 0.0)]);
    assert_eq!(segment_count(&line, at(1e6, 1e6), 1e-9), 1);
    assert_eq!(segment_count(&cubic, at(1e6, 1e6), 1e-9), 1);
    assert_eq!(segment_count(&bent, DVec2::ONE, 0.0), u32::MAX);
    assert_eq!(segment_count(&line, DVec2::ONE, 0.0), 1);
}

#[test]
fn a_polyline_keeps_the_ends() {
    let bent = curve(&[(0.1, 0.2), (1.0, 1.0), (0.3, 0.7)]);
    let points: Vec<DVec2> = polyline(&bent, 7).collect();
    assert_eq!((points.len(), points[0], points[7]), (8, at(0.1, 0.2), at(0.3, 0.7)));
    assert_eq!(polyline(&bent, 0).count(), 2);
}
