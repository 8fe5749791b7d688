//! A torus seen aslant: two folds, the inner one with four cusps; hidden by itself.
//!
//! The brute force knows the torus by its equation alone. Points of the fold: at the angle φ the normal
//! `(cos θ e_r + sin θ z)` is across the view where `tan θ = -(v · e_r) / v_z`. Visible: the smallest value of the
//! torus' function along the ray before the point is not negative.

use super::*;
use selvedge_geometry::construct::shapes;
use std::f64::consts::TAU;

const MAJOR: f64 = 1.0;
const MINOR: f64 = 0.4;

/// Negative inside.
fn function(p: DVec3) -> f64 {
    (p.truncate().length() - MAJOR).hypot(p.z) - MINOR
}

fn fold(v: DVec3, phi: f64, other: bool) -> DVec3 {
    let (sin, cos) = phi.sin_cos();
    let along = DVec3::new(cos, sin, 0.0);
    let theta = (-v.dot(along)).atan2(v.z) + if other { std::f64::consts::PI } else { 0.0 };
    along * (MAJOR + MINOR * theta.cos()) + DVec3::Z * (MINOR * theta.sin())
}

/// The smallest value of the function on the ray from the point to the eye, away from the point itself.
fn least(p: DVec3, v: DVec3) -> f64 {
    const STEP: f64 = 2e-3;
    let at = |t: f64| function(p + v * t);
    let mut least = f64::INFINITY;
    let mut t = 2e-2;
    while t < 4.0 {
        let here = at(t);
        if here < least {
            // refined by a golden section about the step
            let (mut a, mut b) = (t - STEP, t + STEP);
            for _ in 0..40 {
                let (c, d) = (a + 0.382 * (b - a), a + 0.618 * (b - a));
                if at(c) < at(d) { b = d } else { a = c }
            }
            least = least.min(at(0.5 * (a + b))).min(here);
        }
        t += STEP;
    }
    least
}

#[test]
fn a_torus_aslant_is_as_brute_force_has_it() {
    let model = alone(shapes::torus(MAJOR, MINOR).unwrap().part);
    let eye = DVec3::new(1.0, -3.0, 0.9);
    let v = eye.normalize();
    let camera = parallel(eye, 3.2);
    let drawing = drawn(&model, &camera);
    assert!(drawing.lines.iter().all(|l| l.kind == LineKind::Silhouette));
    let (hidden, visible): (Vec<&Line>, Vec<&Line>) = drawing.lines.iter().partition(|l| l.hidden);
    let ends: Vec<DVec2> =
        drawing.lines.iter().flat_map(|l| [l.curves[0][0], l.curves[l.curves.len() - 1][3]]).collect();
    let at = |phi: f64, other: bool| pixel(&camera, fold(v, phi, other));
    let (mut seen, mut unseen) = (0, 0);
    for other in [false, true] {
        for k in 0..500 {
            let p = fold(v, TAU * f64::from(k) / 500.0, other);
            let at = pixel(&camera, p);
            let off = distance(drawing.lines.iter(), at);
            assert!(off <= CURVE, "{at} is {off} px from any line");
            // at a change of visibility both are near
            if ends.iter().any(|e| e.distance(at) < 3.0) {
                continue;
            }
            let is_visible = least(p, v) > -1e-9;
            let right = if is_visible { &visible } else { &hidden };
            assert!(distance(right.iter().copied(), at) <= CURVE, "{at}: visible {is_visible}");
            if is_visible { seen += 1 } else { unseen += 1 }
        }
    }
    assert!(seen > 400 && unseen > 40, "{seen} {unseen}");
    // nothing else is drawn: every point of a line is on the fold, by chords that are a tenth of a pixel long
    let folds = [false, true].map(|o| (0..=20_000).map(|k| at(TAU * f64::from(k) / 20_000.0, o)).collect::<Vec<_>>());
    for p in drawing.lines.iter().flat_map(|l| points(&l.curves)) {
        let off =
            folds.iter().flat_map(|f| f.windows(2)).map(|w| off_chord(w[0], w[1], p)).fold(f64::INFINITY, f64::min);
        assert!(off <= CURVE, "{p} is {off} px from the fold");
    }
}

fn off_chord(a: DVec2, b: DVec2, p: DVec2) -> f64 {
    if (p - a).abs().max_element() > 2.0 {
        return f64::INFINITY;
    }
    let share = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    p.distance(a.lerp(b, share))
}

/// Four cusps, and two T-junctions on either side: ends of lines at places known by brute force.
#[test]
fn a_torus_ends_its_lines_at_cusps_and_junctions() {
    let model = alone(shapes::torus(MAJOR, MINOR).unwrap().part);
    let eye = DVec3::new(1.0, -3.0, 0.9);
    let v = eye.normalize();
    let camera = parallel(eye, 3.2);
    let drawing = drawn(&model, &camera);
    let ends: Vec<DVec2> =
        drawing.lines.iter().flat_map(|l| [l.curves[0][0], l.curves[l.curves.len() - 1][3]]).collect();
    let nearest = |p: DVec2| ends.iter().map(|e| e.distance(p)).fold(f64::INFINITY, f64::min);
    // cusps: the picture of the fold stands still
    let at = |phi: f64, other: bool| pixel(&camera, fold(v, phi, other));
    let mut cusps = 0;
    let step = TAU / 20_000.0;
    for other in [false, true] {
        let speed = |phi: f64| at(phi + 0.5 * step, other).distance(at(phi - 0.5 * step, other)) / step;
        for k in 0..20_000 {
            let phi = step * f64::from(k);
            let (a, b, c) = (speed(phi - step), speed(phi), speed(phi + step));
            if b < a && b <= c && b < 1.0 {
                cusps += 1;
                // the fold moves as the square of the angle there: half a step is far below a hundredth of a pixel
                let off = nearest(at(phi, other));
                assert!(off <= END, "cusp {}: {off} px", at(phi, other));
            }
        }
    }
    assert_eq!(cusps, 4);
    // junctions: the fold behind passes under the fold before it
    let mut junctions = 0;
    for other in [false, true] {
        let visible = |phi: f64| least(fold(v, phi, other), v) > -1e-9;
        let count = 400;
        for k in 0..count {
            let (mut a, mut b) = (TAU * f64::from(k) / f64::from(count), TAU * f64::from(k + 1) / f64::from(count));
            let before = visible(a);
            if visible(b) == before {
                continue;
            }
            for _ in 0..30 {
                let middle = 0.5 * (a + b);
                if visible(middle) == before { a = middle } else { b = middle }
            }
            let p = at(a, other);
            let off = nearest(p);
            // near a cusp the brute force does not tell the fold from what hides it
            if off > END && ends.iter().any(|e| e.distance(p) < 3.0) {
                continue;
            }
            assert!(off <= END, "junction {p}: {off} px");
            junctions += 1;
        }
    }
    assert!(junctions >= 2, "{junctions}");
}
