//! Volumes in closed form, by lines on a jittered grid: the error of `n²` lines falls as `n^-3/2` for a
//! rim, so the tolerances are relative and a few times the rim's share at that rate.

use super::shapes::*;
use crate::model::{Primitive, Quadric, Shape};
use crate::solids::SolidTracer;
use glam::{DAffine3, DVec3};
use std::f64::consts::PI;

fn close(tracer: &SolidTracer, side: f64, expected: f64, tolerance: f64) {
    let found = volume(tracer, side, 200);
    assert!((found / expected - 1.0).abs() < tolerance, "{found} for {expected}");
}

#[test]
fn single_shapes() {
    let own = |shape: Shape| tracer("A", vec![placed(shape, DAffine3::IDENTITY)]);
    close(&own(Shape::Sphere { radius: 1.0 }), 2.5, 4.0 / 3.0 * PI, 2e-3);
    close(&own(Shape::Cylinder { radius: 1.0, height: 2.0 }), 2.5, 2.0 * PI, 2e-3);
    close(&own(Shape::Cone { bottom: 1.0, top: 0.0, height: 3.0 }), 2.5, PI, 2e-3);
    close(&own(Shape::Cone { bottom: 0.5, top: 1.0, height: 3.0 }), 2.5, PI * 1.75, 2e-3);
    close(&own(Shape::Torus { major: 2.0, minor: 0.5 }), 6.0, PI * PI, 4e-3);
    let q = Quadric { squares: DVec3::new(1.0, 1.0, 0.25), constant: -1.0, ..Quadric::default() };
    close(&own(Shape::Quadric(q)), 2.5, 8.0 / 3.0 * PI, 2e-3);
}

/// A spindle torus with its lemon: `2 π ∫ ...` of the disc's part at positive radius, R = 1, r = 2.
#[test]
fn a_spindle_is_filled() {
    let (big, r) = (1.0, 2.0f64);
    // Pappus over the part of the disc at x >= 0 of its profile: ∫ 2πx · 2√(r² - (x-R)²) dx from 0 to R + r
    let steps = 200_000;
    let step = (big + r) / f64::from(steps);
    let slice = |i: i32| {
        let x = (f64::from(i) + 0.5) * step;
        4.0 * PI * x * (r * r - (x - big) * (x - big)).max(0.0).sqrt() * step
    };
    let expected: f64 = (0..steps).map(slice).sum();
    close(&tracer("A", vec![placed(Shape::Torus { major: big, minor: r }, DAffine3::IDENTITY)]), 6.5, expected, 4e-3);
}

/// A lens: two unit spheres 1 apart share `5 π / 12`; and a sphere less that.
#[test]
fn sphere_minus_sphere() {
    let lens = 5.0 / 12.0 * PI;
    let two = || vec![sphere(1.0, -0.5), sphere(1.0, 0.5)];
    close(&tracer("AB", two()), 2.5, lens, 4e-3);
    close(&tracer("A-B", two()), 3.5, 4.0 / 3.0 * PI - lens, 4e-3);
    close(&tracer("A+B", two()), 3.5, 8.0 / 3.0 * PI - lens, 4e-3);
    close(&tracer("A^B", two()), 3.5, 8.0 / 3.0 * PI - 2.0 * lens, 4e-3);
}

/// Two unit cylinders at right angles share `16 / 3`, three `8 (2 - √2)` (Steinmetz).
#[test]
fn steinmetz_solids() {
    let long = || cylinder(1.0, -2.0, 4.0);
    let turned = |m: DAffine3| Primitive { transform: m * long().transform, ..long() };
    let all = || {
        let quarter = std::f64::consts::FRAC_PI_2;
        vec![turned(DAffine3::from_rotation_x(quarter)), turned(DAffine3::from_rotation_y(quarter)), long()]
    };
    close(&tracer("AB", all()), 2.5, 16.0 / 3.0, 2e-3);
    close(&tracer("ABC", all()), 2.5, 8.0 * (2.0 - 2f64.sqrt()), 2e-3);
}

/// A plate less holes of the shape D: cylinder and block, flush with the plate on both sides.
#[test]
fn d_holes() {
    let hole = |x: f64| {
        let disc = placed(Shape::Cylinder { radius: 1.0, height: 1.0 }, at(x, 0.0, 0.0));
        let half = Primitive { transform: at(x, 0.0, 0.0), ..block([0.0, -1.0, 0.0], [1.0, 1.0, 1.0]) };
        [disc, half]
    };
    let mut all = vec![block([-5.0, -2.0, 0.0], [5.0, 2.0, 1.0])];
    all.extend([-3.0, 0.0, 3.0].into_iter().flat_map(hole));
    close(&tracer("A-(BC+DE+FG)", all), 12.0, 40.0 - 1.5 * PI, 2e-3);
}
