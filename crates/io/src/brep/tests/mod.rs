//! Faces small enough to know by heart: areas and distances against closed forms.

mod borders;
mod carriers;
mod closing;
mod curved;
mod damage;
mod derived;
mod details;
mod flat;
mod given;
mod poles;
mod settle;
mod slivers;
mod splines;

use super::*;
use crate::model::{Face, TrimLoop};
use crate::spline::{Control, PatchGrid};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The tolerance that all these faces state, mm.
const TOLERANCE: f64 = 1e-6;

/// A frame that is aligned with nothing.
fn odd_frame() -> Frame {
    Frame::new(DVec3::new(12.0, -7.0, 3.0), DVec3::new(0.3, -0.5, 0.8), DVec3::new(1.0, 0.4, -0.2)).unwrap()
}

fn circle(frame: Frame, radius: f64) -> CurveGeometry {
    CurveGeometry::Circle { frame, radius }
}

/// `frame` with its origin moved by `d`, in its own coordinates.
fn moved(frame: Frame, d: [f64; 3]) -> Frame {
    Frame { origin: frame.world(DVec3::from(d)), ..frame }
}

/// `frame` turned so that its z axis is the old `-y`: circles in it are meridians of the old one,
/// by latitude.
fn meridian_frame(frame: Frame, angle: f64) -> Frame {
    let x = frame.x * angle.cos() + frame.y * angle.sin();
    Frame { origin: frame.origin, x, y: frame.z, z: x.cross(frame.z) }
}

/// An edge between two points; ids count from 101.
fn edge(list: &mut Vec<Edge>, curve: CurveGeometry, start: DVec3, end: DVec3) -> usize {
    let id = 101 + list.len() as u32;
    list.push(Edge { id, curve, start, end, same_sense: true });
    list.len() - 1
}

fn segment(list: &mut Vec<Edge>, start: DVec3, end: DVec3) -> usize {
    edge(list, CurveGeometry::Line { origin: start, direction: end - start }, start, end)
}

fn full_circle(list: &mut Vec<Edge>, frame: Frame, radius: f64) -> usize {
    let at = frame.origin + frame.x * radius;
    edge(list, circle(frame, radius), at, at)
}

fn face(surface: SurfaceGeometry, bounds: Vec<Boundary>) -> FaceGeometry {
    FaceGeometry { id: 7, surface, bounds, same_sense: true, ambiguous: false }
}

fn build(surface: SurfaceGeometry, bounds: Vec<Boundary>, edges: &[Edge]) -> BuiltFace {
    let built = build_face(&face(surface, bounds), edges, TOLERANCE).unwrap();
    check(&built, edges);
    built
}

/// What every built face must satisfy: loops closed bit for bit and inside the carrier, sane
/// turning numbers, and curves as near to their edges as promised, measured from the carrier itself.
fn check(built: &BuiltFace, edges: &[Edge]) {
    let face = &built.face;
    let ((u0, u1), (v0, v1)) = face.surface.domain();
    let slack = DVec2::new(u1 - u0, v1 - v0) * 1e-7;
    let grid = face.surface.patches();
    for l in &face.loops {
        let curves: Vec<_> = l.curves().collect();
        for (i, c) in curves.iter().enumerate() {
            let next = &curves[(i + 1) % curves.len()];
            assert_eq!(c.point(1.0), next.point(0.0), "joint {i}");
            for k in 0..=20 {
                let p = c.point(f64::from(k) / 20.0);
                let inside = p.cmpge(DVec2::new(u0, v0) - slack) & p.cmple(DVec2::new(u1, v1) + slack);
                assert!(inside.all(), "{p} leaves {:?}", face.surface.domain());
            }
        }
    }
    // every point of every edge lies on the image of some trim curve, within the stated deviation
    let image: Vec<DVec3> = image_of_loops(face, &grid, 1200);
    // sagitta of the polygon: 1200 chords of a whole turn of radius 7
    let sagitta = 1e-4;
    for e in edges.iter().filter(|_| !face.loops.is_empty()) {
        let used = super::edge::EdgeCurve::new(e, true, TOLERANCE).unwrap().unwrap();
        for k in 0..=10 {
            let p = used.point(f64::from(k) / 10.0);
            let nearest = image.windows(2).map(|w| to_segment(p, w[0], w[1])).fold(f64::INFINITY, f64::min);
            assert!(nearest < built.deviation + built.gap + sagitta, "edge {} lies {nearest} from the trims", e.id);
        }
    }
}

fn image_of_loops(face: &Face, grid: &PatchGrid, per_curve: usize) -> Vec<DVec3> {
    let curves = face.loops.iter().flat_map(|l| l.curves().collect::<Vec<_>>());
    curves
        .flat_map(|c| {
            (0..=per_curve)
                .map(|k| c.point(k as f64 / per_curve as f64))
                .map(|p| grid.point(p.x, p.y))
                .collect::<Vec<_>>()
        })
        .collect()
}

fn to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let d = b - a;
    let t = if d == DVec3::ZERO { 0.0 } else { ((p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0) };
    p.distance(a + d * t)
}

/// Largest distance of the trim curves' images from a set given by its distance function.
fn farthest(built: &BuiltFace, distance: impl Fn(DVec3) -> f64) -> f64 {
    let grid = built.face.surface.patches();
    image_of_loops(&built.face, &grid, 100).into_iter().map(distance).fold(0.0, f64::max)
}

/// Distance from a circle in space.
fn from_circle(p: DVec3, frame: Frame, radius: f64) -> f64 {
    let l = frame.local(p);
    (l.x.hypot(l.y) - radius).hypot(l.z)
}

/// Area in mm² enclosed by the loops (positive when outer loops run counter-clockwise), or of the
/// whole carrier: Green's theorem with 12-point Gauss rules, `∮ F dv` where `F = ∫ |S_u × S_v| du`.
fn surface_area(face: &Face) -> f64 {
    let grid = face.surface.patches();
    let ((u0, u1), (v0, v1)) = face.surface.domain();
    let mut knots_u: Vec<f64> = face.surface.knots().0.to_vec();
    let mut knots_v: Vec<f64> = face.surface.knots().1.to_vec();
    knots_u.dedup();
    knots_v.dedup();
    let density = |u: f64, v: f64| {
        let jet = grid.jet(u, v);
        jet.du.cross(jet.dv).length()
    };
    let strip = |u: f64, v: f64| -> f64 {
        let ends = knots_u.iter().copied().filter(|k| *k > u0 && *k < u.min(u1));
        let marks: Vec<f64> = [u0].into_iter().chain(ends).chain([u.min(u1)]).collect();
        marks.windows(2).map(|w| gauss(w[0], w[1], |x| density(x, v))).sum()
    };
    if face.loops.is_empty() {
        let rows = knots_v.windows(2).filter(|w| w[0] >= v0 && w[1] <= v1);
        return rows.map(|w| gauss(w[0], w[1], |v| strip(u1, v))).sum();
    }
    let one = |l: &TrimLoop| -> f64 {
        l.curves()
            .map(|c| {
                // split where the integrand kinks: where the curve passes a knot
                let mut cuts = vec![0.0, 1.0];
                for k in 0..256 {
                    let (a, b) = (f64::from(k) / 256.0, f64::from(k + 1) / 256.0);
                    let (p, q) = (c.point(a), c.point(b));
                    for (axis, knots) in [(0, &knots_u), (1, &knots_v)] {
                        for knot in knots.iter().filter(|x| (p[axis] < **x) != (q[axis] < **x)) {
                            let (mut lo, mut hi) = (a, b);
                            for _ in 0..50 {
                                let m = 0.5 * (lo + hi);
                                if (c.point(m)[axis] < *knot) == (p[axis] < *knot) { lo = m } else { hi = m }
                            }
                            cuts.push(lo);
                        }
                    }
                }
                cuts.sort_by(f64::total_cmp);
                let along = |t: f64| {
                    let (p, d) = c.jet(t);
                    let point = p.point();
                    strip(point.x, point.y) * (d.y - point.y * d.z) / p.z
                };
                cuts.windows(2).map(|w| gauss(w[0], w[1], along)).sum::<f64>()
            })
            .sum()
    };
    face.loops.iter().map(one).sum()
}

/// 12-point Gauss-Legendre, nodes by Newton on the Legendre recurrence.
fn gauss(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    const N: usize = 12;
    let legendre = |x: f64| {
        let (mut p0, mut p1) = (1.0, x);
        for k in 2..=N {
            let k = k as f64;
            (p0, p1) = (p1, ((2.0 * k - 1.0) * x * p1 - (k - 1.0) * p0) / k);
        }
        (p1, N as f64 * (x * p1 - p0) / (x * x - 1.0))
    };
    let mut sum = 0.0;
    for i in 0..N {
        let mut x = (PI * (i as f64 + 0.75) / (N as f64 + 0.5)).cos();
        for _ in 0..8 {
            let (p, d) = legendre(x);
            x -= p / d;
        }
        let d = legendre(x).1;
        sum += 2.0 / ((1.0 - x * x) * d * d) * f(0.5 * (a + b) + 0.5 * (b - a) * x);
    }
    sum * 0.5 * (b - a)
}

#[track_caller]
fn assert_area(built: &BuiltFace, expected: f64, relative: f64) {
    let area = surface_area(&built.face);
    assert!((area - expected).abs() <= relative * expected, "area {area}, expected {expected}");
}
