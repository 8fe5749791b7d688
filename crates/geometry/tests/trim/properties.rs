//! Random loops: the index and the table against brute force on a very fine polyline.
//!
//! The brute-force winding number is the sum of signed angles, which shares nothing with crossings.
//! The polyline stays nearer to the curve than its longest chord, so a point farther from the
//! polyline than that has the curve's winding number; nearer points are skipped.

use crate::shapes::at;
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use selvedge_geometry::model::TrimLoop;
use selvedge_geometry::spline::{Bezier, Control};
use selvedge_geometry::trim::{LoopIndex, RectSide, TrimTable, segment_count};
use std::f64::consts::TAU;

/// Chords per curve of the brute-force polyline.
const FINE: u32 = 600;

/// A closed polyline and its longest chord.
struct Fine {
    points: Vec<DVec2>,
    longest: f64,
}

impl Fine {
    fn new(trim_loop: &TrimLoop) -> Self {
        let points: Vec<DVec2> =
            trim_loop.curves().flat_map(|c| (0..FINE).map(move |i| c.point(f64::from(i) / f64::from(FINE)))).collect();
        let longest = chords(&points).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
        Self { points, longest }
    }

    fn winding(&self, p: DVec2) -> i32 {
        let angle: f64 = chords(&self.points).map(|(a, b)| (a - p).angle_to(b - p)).sum();
        (angle / TAU).round() as i32
    }

    fn distance(&self, p: DVec2) -> f64 {
        let to = |(a, b): (DVec2, DVec2)| {
            let along = b - a;
            let t = if a == b { 0.0 } else { ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0) };
            p.distance(a + along * t)
        };
        chords(&self.points).map(to).fold(f64::INFINITY, f64::min)
    }
}

fn chords(points: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    points.iter().copied().zip(points.iter().copied().cycle().skip(1))
}

fn control() -> impl Strategy<Value = DVec3> {
    let weight = prop_oneof![Just(1.0), 0.1f64..10.0];
    (-1f64..1.0, -1f64..1.0, weight).prop_map(|(u, v, w)| DVec3::from_point(at(u, v), w))
}

/// One to four curves of degree 1 to 9 between random points.
fn random_loop() -> impl Strategy<Value = TrimLoop> {
    let loops = prop::collection::vec(prop::collection::vec(control(), 1..10), 1..5).prop_map(|mut curves| {
        for i in 0..curves.len() {
            let next = curves[(i + 1) % curves.len()][0];
            curves[i].push(next);
        }
        let curves = curves.into_iter().map(|points| Bezier { points }).collect();
        TrimLoop::new(curves, DVec2::splat(1e-14)).expect("closed by construction")
    });
    loops.prop_filter("a single point is no curve", |l| l.bounds().0 != l.bounds().1)
}

fn points() -> impl Strategy<Value = Vec<DVec2>> {
    prop::collection::vec((-1.1f64..1.1, -1.1f64..1.1).prop_map(|(u, v)| at(u, v)), 24)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn winding_agrees_with_angles(loops in prop::collection::vec(random_loop(), 1..4), probes in points()) {
        let index = LoopIndex::new(&loops);
        let fine: Vec<Fine> = loops.iter().map(Fine::new).collect();
        for p in probes {
            if fine.iter().all(|f| f.distance(p) > f.longest) {
                prop_assert_eq!(index.winding(p), fine.iter().map(|f| f.winding(p)).sum::<i32>(), "at {}", p);
            }
        }
    }

    #[test]
    fn distance_agrees_with_chords(shape in random_loop(), probes in points()) {
        let index = LoopIndex::new(std::slice::from_ref(&shape));
        let fine = Fine::new(&shape);
        for p in probes {
            let (d, brute) = (index.distance(p, 100.0), fine.distance(p));
            prop_assert!((d - brute).abs() <= fine.longest + 1e-3 * d, "{} against {} at {}", d, brute, p);
            prop_assert_eq!(index.distance(p, d * 0.5), d * 0.5);
            let doubled = index.distance_scaled(p, DVec2::splat(2.0), 100.0);
            prop_assert!((doubled - 2.0 * d).abs() <= 2e-3 * d + 1e-14);
        }
    }

    #[test]
    fn rectangles_are_what_they_are_called(shape in random_loop(), corners in points(), size in 0.001f64..0.5) {
        let index = LoopIndex::new(std::slice::from_ref(&shape));
        let fine = Fine::new(&shape);
        for lo in corners {
            let hi = lo + at(size, 0.5 * size);
            let meets = fine.points.iter().any(|p| p.cmpge(lo).all() && p.cmple(hi).all());
            let side = index.classify(lo, hi);
            if meets {
                prop_assert_eq!(side, RectSide::Boundary);
            }
            if side == RectSide::Boundary {
                // some curve is near: within the longest chord of the rectangle
                let reach = (hi - lo).length() * 0.5 + fine.longest;
                prop_assert!(fine.distance(0.5 * (lo + hi)) <= reach);
            } else {
                for i in 0..25 {
                    let p = lo + (hi - lo) * at(f64::from(i % 5) / 4.0, f64::from(i / 5) / 4.0);
                    prop_assert_eq!(index.contains(p), side == RectSide::Inside, "at {}", p);
                }
            }
        }
    }

    /// Reversal negates, elevation and cutting change nothing, away from the curve by 1e-12.
    #[test]
    fn other_representations_of_the_same_loop(shape in random_loop(), probes in points(), t in 0.1f64..0.9) {
        let index = LoopIndex::new(std::slice::from_ref(&shape));
        let rebuilt = |curves: Vec<Bezier<DVec3>>| {
            LoopIndex::new(&[TrimLoop::new(curves, DVec2::splat(1e-13)).expect("still closed")])
        };
        let raised = rebuilt(shape.curves().map(|c| c.elevated()).collect());
        let cut = rebuilt(shape.curves().flat_map(|c| <[_; 2]>::from(c.split(t))).collect());
        let reversed = LoopIndex::new(&[shape.reversed()]);
        for p in probes.into_iter().filter(|&p| index.distance(p, 1.0) > 1e-12) {
            let winding = index.winding(p);
            prop_assert_eq!(raised.winding(p), winding);
            prop_assert_eq!(cut.winding(p), winding);
            prop_assert_eq!(reversed.winding(p), -winding);
        }
    }

    /// Where answers flip: 1e-13 beside the curve they are those of 1e-5 beside it.
    #[test]
    fn the_curve_is_met_to_thirteen_digits(shape in random_loop(), t in 0.01f64..0.99) {
        let index = LoopIndex::new(std::slice::from_ref(&shape));
        for curve in shape.curves() {
            let (value, slope) = curve.jet(t);
            let p = value.point();
            let tangent = at(slope.x - p.x * slope.z, slope.y - p.y * slope.z);
            let normal = tangent.perp().normalize_or_zero();
            let near = 1e-13;
            let far = 1e-5;
            // only where nothing else of the loop is near: the nearest point to p ± far n is p itself
            let alone = |q: DVec2| (index.distance(q, 1.0) - far).abs() < 2e-3 * far;
            if normal != DVec2::ZERO && alone(p + normal * far) && alone(p - normal * far) {
                for side in [normal, -normal] {
                    prop_assert_eq!(index.winding(p + side * near), index.winding(p + side * far), "{}, t {}", p, t);
                }
            }
        }
    }

    /// On its own scan lines the table is right for every point farther from the curves than the
    /// chords' deviation.
    #[test]
    fn the_table_agrees_on_its_scan_lines(loops in prop::collection::vec(random_loop(), 1..4), rows in 1u32..40) {
        let eps = 1e-4;
        let table = TrimTable::new(&loops, (-1.0, 1.0), &[rows, 1, 2 * rows], |c| segment_count(c, DVec2::ONE, eps));
        prop_assert_eq!(table.row_count() as u32, 3 * rows + 1);
        let index = LoopIndex::new(&loops);
        for row in 0..table.row_count() {
            let v = table.row_v(row);
            prop_assert_eq!(table.row_of(v), row);
            prop_assert!(table.row(row).is_sorted_by(|a, b| a < b) && table.row(row).len().is_multiple_of(2));
            for i in 0..20 {
                let u = f64::from(i) * 0.105 - 1.0;
                if index.distance(at(u, v), 1.0) > eps {
                    prop_assert_eq!(table.contains(u, v), index.contains(at(u, v)), "({}, {})", u, v);
                }
            }
        }
    }

    /// Parity of a polygon is the exclusive or of the triangles (o, edge), whatever the origin o.
    #[test]
    fn parity_is_the_xor_of_triangles(corners in prop::collection::vec((-1f64..1.0, -1f64..1.0), 3..12), origin in (-2f64..2.0, -2f64..2.0), probes in points()) {
        let index = LoopIndex::new(&[crate::shapes::polygon(&corners)]);
        let corners: Vec<DVec2> = corners.iter().map(|&(u, v)| at(u, v)).collect();
        let o = at(origin.0, origin.1);
        let left = |a: DVec2, b: DVec2, p: DVec2| (b - a).perp_dot(p - a);
        for p in probes {
            let mut inside = false;
            let mut sure = true;
            for (a, b) in chords(&corners) {
                let sides = [left(o, a, p), left(a, b, p), left(b, o, p)];
                sure &= sides.iter().all(|s| s.abs() > 1e-12);
                inside ^= sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0);
            }
            if sure {
                prop_assert_eq!(index.winding(p).rem_euclid(2) == 1, inside);
            }
        }
    }

    /// Straight loops have no deviation at all.
    #[test]
    fn the_table_of_a_polygon(corners in prop::collection::vec((-1f64..1.0, -1f64..1.0), 3..12), rows in 1u32..60) {
        let loops = [crate::shapes::polygon(&corners)];
        let table = TrimTable::new(&loops, (-1.0, 1.0), &[rows], |_| 1);
        let index = LoopIndex::new(&loops);
        for row in 0..table.row_count() {
            let v = table.row_v(row);
            for &u in table.row(row) {
                for p in [u - 1e-14, u + 1e-14] {
                    // a nearly horizontal chord shifts more: skip what lies within rounding of it
                    if index.distance(at(p, v), 1.0) > 1e-15 {
                        prop_assert_eq!(table.contains(p, v), index.contains(at(p, v)), "({:e}, {:e})", p, v);
                    }
                }
            }
        }
    }
}
