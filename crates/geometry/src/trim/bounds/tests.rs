//! How much a search prepares: what is extreme, and little else.

use super::compose::{compose, rectangle as part};
use super::curves::Curves;
use super::search::{Body, Work};
use super::{OTHER, of};
use crate::csg::{Builder, Op};
use crate::model::{Bounds, Face, Primitive, Shape, Solid, SurfaceKind, TrimLoop};
use crate::spline::{Bezier, Control, Patch, Surface};
use crate::trim::RectSide;
use glam::{DAffine3, DVec2, DVec3, DVec4};
use std::f64::consts::{PI, TAU};

fn face(kind: SurfaceKind, surface: Surface, loops: Vec<TrimLoop>) -> Face {
    Face { id: 1, kind, surface, loops, same_sense: true, colour: None }
}

/// The square from -half to half at a height, with its coordinates as parameters.
fn square(half: f64, z: f64) -> Surface {
    let at = |k: i32| half * f64::from(2 * k - 1);
    let points = (0..4).map(|k| DVec4::new(at(k % 2), at(k / 2), z, 1.0)).collect();
    let knots = vec![-half, -half, half, half];
    Surface::new((1, 1), knots.clone(), knots, points).unwrap()
}

fn polygon(corners: &[DVec2]) -> TrimLoop {
    let line = |i: usize| vec![corners[i].extend(1.0), corners[(i + 1) % corners.len()].extend(1.0)];
    TrimLoop::new((0..corners.len()).map(|i| Bezier { points: line(i) }).collect(), DVec2::ZERO).unwrap()
}

fn rectangle(lo: DVec2, hi: DVec2) -> TrimLoop {
    polygon(&[lo, DVec2::new(hi.x, lo.y), hi, DVec2::new(lo.x, hi.y)])
}

/// The box is as expected; what the search has prepared for it.
#[track_caller]
fn work(faces: &[Face], expected: Bounds) -> Work {
    let bodies = [Body::new(faces, &[])];
    let found = of(&bodies, &[(0, DAffine3::IDENTITY)]);
    let off = (found.min - expected.min).abs().max((found.max - expected.max).abs()).max_element();
    assert!(off <= OTHER * expected.diagonal(), "off by {off:e}: {found:?} instead of {expected:?}");
    bodies[0].work()
}

/// Squares one above the other, each smaller than the one below: the lowest and the highest are extreme.
#[test]
fn faces_within_the_box_of_others_are_not_cut() {
    let square = |k: i32| {
        let half = f64::from(20 - k);
        let all = rectangle(DVec2::splat(-half), DVec2::splat(half));
        face(SurfaceKind::Plane, square(half, f64::from(k)), vec![all])
    };
    let faces: Vec<Face> = (0..20).map(square).collect();
    let expected = Bounds { min: DVec3::new(-20.0, -20.0, 0.0), max: DVec3::new(20.0, 20.0, 19.0) };
    assert_eq!(work(&faces, expected).faces, 2);
}

/// The surface `(u, v, u v)` has 1600 patches. Its loop reaches four of them.
#[test]
fn patches_that_loops_do_not_reach_are_not_cut() {
    const ACROSS: i32 = 40;
    let points = (0..(ACROSS + 1) * (ACROSS + 1)).map(|k| {
        let (u, v) = (f64::from(k % (ACROSS + 1)), f64::from(k / (ACROSS + 1)));
        DVec4::new(u, v, u * v, 1.0)
    });
    let inner = (0..=ACROSS).map(f64::from);
    let knots: Vec<f64> = std::iter::once(0.0).chain(inner).chain([f64::from(ACROSS)]).collect();
    let surface = Surface::new((1, 1), knots.clone(), knots, points.collect()).unwrap();
    let (lo, hi) = (DVec2::new(30.5, 7.5), DVec2::new(31.5, 8.5));
    let expected = Bounds { min: lo.extend(30.5 * 7.5), max: hi.extend(31.5 * 8.5) };
    let work = work(&[face(SurfaceKind::BSpline, surface, vec![rectangle(lo, hi)])], expected);
    assert_eq!(work.patches, 4, "{work:?}");
}

/// A disc of 200 edges: two meet at each of four extreme points. It is level, so that one edge is enough across.
#[test]
fn only_the_highest_pieces_are_tested_for_the_face_beside_them() {
    const EDGES: usize = 200;
    let corner = |k: usize| DVec2::from_angle(TAU * k as f64 / EDGES as f64);
    let disc = polygon(&(0..EDGES).map(corner).collect::<Vec<_>>());
    let expected = Bounds { min: DVec3::new(-1.0, -1.0, 3.0), max: DVec3::new(1.0, 1.0, 3.0) };
    let work = work(&[face(SurfaceKind::Plane, square(2.0, 3.0), vec![disc])], expected);
    assert!(work.pieces_tested <= 4 * 2 + 2, "{work:?}");
    assert!(work.pieces_in_space <= 4 * 2 + 2, "{work:?}");
}

fn circle(radius: f64) -> TrimLoop {
    let quarter = |k: usize| {
        let turned = |x: f64, y: f64, w: f64| {
            let turn = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y][k];
            DVec3::from_point(radius * turn.rotate(DVec2::new(x, y)), w)
        };
        let points = vec![turned(1.0, 0.0, 1.0), turned(1.0, 1.0, 0.5f64.sqrt()), turned(0.0, 1.0, 1.0)];
        Bezier { points }
    };
    TrimLoop::new((0..4).map(quarter).collect(), DVec2::ZERO).unwrap()
}

/// Between two circles about the origin.
#[test]
fn curves_are_cut_where_tests_reach_them() {
    let ring = face(SurfaceKind::Plane, square(3.0, 0.0), vec![circle(2.0), circle(1.0).reversed()]);
    let curves = Curves::new(&ring);
    let at = DVec2::new;
    // whole loops, curves beside the scan line, and the sides of boxes need no cut
    assert!(!curves.contains(at(-2.5, 0.3)) && !curves.contains(at(2.5, 0.3)) && !curves.contains(at(0.3, 2.5)));
    assert_eq!(curves.classify(at(-2.5, -2.5), at(2.5, 2.5)), RectSide::Boundary);
    assert_eq!(curves.classify(at(2.1, -1.0), at(2.5, 1.0)), RectSide::Outside);
    assert_eq!(curves.curves_cut(), 0);
    assert_eq!(curves.classify(at(1.9, 1.9), at(2.0, 2.0)), RectSide::Outside);
    assert_eq!(curves.curves_cut(), 1);
    assert_eq!(curves.classify(at(1.2, -0.1), at(1.8, 0.1)), RectSide::Inside);
    assert_eq!(curves.classify(at(1.9, -0.1), at(2.1, 0.1)), RectSide::Boundary);
    for k in 0..1000 {
        let (angle, radius) = (f64::from(k) * 2.4, 0.0025 * f64::from(k) + 1e-9);
        let p = radius * DVec2::from_angle(angle);
        assert_eq!(curves.contains(p), radius > 1.0 && radius < 2.0, "{p}");
    }
}

/// Of a rational patch: over rectangles, one of them a line and one a side; along rational curves, one that bends, and
/// lines along either parameter.
#[test]
fn parts_and_composed_curves_are_the_patch_at_their_points() {
    let point = |i: usize, j: usize| {
        let (u, v) = (i as f64, j as f64);
        DVec4::from_point(DVec3::new(u + 0.2 * v, v * v - 0.3 * u, u * v), 1.0 + 0.4 * ((i + 2 * j) % 3) as f64)
    };
    let points = (0..12).map(|k| point(k % 3, k / 3)).collect();
    let patch = Patch { degree_u: 2, degree_v: 3, points };
    for (u, v) in [((0.2, 0.7), (0.0, 1.0)), ((0.0, 0.4), (0.3, 0.3)), ((0.5, 1.0), (1.0, 1.0))] {
        let part = Patch { points: part(&patch, u, v), ..patch.clone() };
        for (s, t) in [(0.0, 1.0), (0.3, 0.6), (1.0, 0.0)] {
            let expected = patch.point(u.0 + s * (u.1 - u.0), v.0 + t * (v.1 - v.0));
            assert!(part.point(s, t).distance(expected) < 1e-13, "{expected}");
        }
    }
    let at = |u: f64, v: f64, w: f64| DVec3::from_point(DVec2::new(u, v), w);
    let curves = [
        vec![at(0.1, 0.2, 1.0), at(0.9, 0.3, 2.0), at(0.4, 0.8, 0.7)],
        vec![at(0.2, 0.3, 1.0), at(0.7, 0.3, 1.5)],
        vec![at(0.6, 0.9, 1.0), at(0.6, 0.1, 1.0)],
    ];
    for points in curves {
        let composed = Bezier { points: compose(&patch, &points) };
        let curve = Bezier { points };
        for t in [0.0, 0.17, 0.5, 0.83, 1.0] {
            let on = curve.point(t);
            let (found, expected) = (composed.point(t), patch.point(on.x, on.y));
            assert!(found.distance(expected) < 1e-13, "{found} instead of {expected}");
        }
    }
}

/// 4,900 half-spaces: rings of 100 corners at heights `r cos((i + ½) π / 50)`, the widest of radius `r cos(π / 100)`, in a
/// block that is wider.
#[test]
fn thousands_of_half_spaces_have_the_box_of_their_corners() {
    let (radius, rings, n) = (10.0, 50, 100);
    let corner = |ring: i32| (PI * (f64::from(ring) + 0.5) / f64::from(rings)).sin_cos();
    let (middle, high) = ((0.5 * TAU / f64::from(n)).cos(), radius * corner(0).1);
    let reach = DVec3::new(2.0 * radius, 2.0 * radius, high);
    let mut shapes = vec![Shape::Block { min: -reach, max: reach }];
    for ring in 1..rings {
        let [(r0, z0), (r1, z1)] = [ring - 1, ring].map(corner).map(|(s, c)| (radius * s, radius * c));
        let (out, up) = (z0 - z1, (r1 - r0) * middle);
        shapes.extend((0..n).map(|i| {
            let (s, c) = (TAU * (f64::from(i) + 0.5) / f64::from(n)).sin_cos();
            Shape::HalfSpace { normal: DVec3::new(out * c, out * s, up), offset: out * r0 * middle + up * z0 }
        }));
    }
    let mut b = Builder::new();
    let leaves: Vec<u32> = (0..shapes.len() as u32).map(|p| b.leaf(p)).collect();
    let root = b.fold(Op::Intersection, leaves);
    let place = |shape| Primitive { shape, transform: DAffine3::IDENTITY, colour: [1.0; 4], id: 1 };
    let solid = Solid::new(shapes.into_iter().map(place).collect(), b.finish(root).unwrap()).unwrap();
    let (found, far) = (super::solid::bounds(&solid), radius * (PI / f64::from(n)).cos());
    let off = (found.max - far).abs().max((found.min + far).abs()).max_element();
    assert!(off < 1e-9, "{found:?}");
}
