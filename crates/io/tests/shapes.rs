//! Solids from dimensions: exact, closed edge by edge, of the right volume; and dimensions that make no solid.

use glam::{DVec2, DVec3, DVec4};
use proptest::prelude::*;
use selvedge_geometry::construct::shapes::{
    Body, GearBlank, Keyway, SpurGear, block, cone, cylinder, sphere, teapot, torus, tube,
};
use selvedge_geometry::construct::{ConstructError, Sweep, capped_solid, curve};
use selvedge_geometry::model::{Carrier, Face, Instance, Model, Part, Shape, SurfaceKind};
use selvedge_geometry::spline::{BSpline, Bezier, Control, PatchGrid};
use selvedge_io::export;
use std::f64::consts::{PI, TAU};

/// Rounding of an exact construction, of the size.
const EXACT: f64 = 1e-12;

/// Neighbours' edges, of the size.
const SHARED: f64 = 1e-9;

/// As many random cases as the variable `PROPTEST_CASES` says, or `few`.
fn cases(few: u32) -> ProptestConfig {
    let cases = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(few);
    ProptestConfig { cases, max_global_rejects: 100 * cases, ..ProptestConfig::default() }
}

/// Knots of a polyline of `n` points.
fn knots(n: usize) -> Vec<f64> {
    [0].into_iter().chain(0..n).chain([n - 1]).map(|k| k as f64).collect()
}

/// A polyline.
fn line(points: &[DVec3]) -> BSpline<DVec4> {
    let points4 = points.iter().map(|p| DVec4::from_point(*p, 1.0)).collect();
    BSpline::new(1, knots(points.len()), points4).unwrap()
}

/// A planar polyline.
fn planar(points: &[(f64, f64)]) -> BSpline<DVec3> {
    let homogeneous = |&(x, y): &(f64, f64)| DVec3::from_point(DVec2::new(x, y), 1.0);
    BSpline::new(1, knots(points.len()), points.iter().map(homogeneous).collect()).unwrap()
}

/// Nodes and weights of Gauss and Legendre on [0, 1].
fn gauss(n: usize) -> Vec<(f64, f64)> {
    let node = |k: usize| {
        let mut x = (PI * (k as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..20 {
            let (mut p, mut q) = (1.0, 0.0);
            for j in 1..=n {
                (p, q) = (((2 * j - 1) as f64 * x * p - (j - 1) as f64 * q) / j as f64, p);
            }
            slope = n as f64 * (x * p - q) / (x * x - 1.0);
            x -= p / slope;
        }
        (0.5 * (x + 1.0), 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}

/// A third of the flux of position through a face: over its patches, or, for a plane with loops, by the area within.
fn flux(face: &Face) -> f64 {
    let nodes = gauss(16);
    let sum: f64 = if face.loops.is_empty() {
        let patches = face.surface.patches().patches;
        let over = |p: &selvedge_geometry::spline::SurfacePatch| {
            let points = nodes.iter().flat_map(|a| nodes.iter().map(move |b| (a, b)));
            let term = |((u, wu), (v, wv)): (&(f64, f64), &(f64, f64))| {
                let jet = p.patch.jet(*u, *v);
                jet.point.dot(jet.du.cross(jet.dv)) * wu * wv
            };
            points.map(term).sum::<f64>()
        };
        patches.iter().map(over).sum()
    } else {
        assert_eq!(face.surface.degrees(), (1, 1));
        let ((u, _), (v, _)) = face.surface.domain();
        let jet = face.surface.jet(u, v);
        let area = |c: Bezier<DVec3>| {
            let term = |&(t, w): &(f64, f64)| {
                let (h, d) = c.jet(t);
                let p = h.point();
                p.perp_dot((d.truncate() - p * d.z) / h.z) * w
            };
            nodes.iter().map(term).sum::<f64>()
        };
        let area = 0.5 * face.loops.iter().flat_map(|l| l.curves()).map(area).sum::<f64>();
        jet.point.dot(jet.du.cross(jet.dv)) * area
    };
    if face.same_sense { sum / 3.0 } else { -sum / 3.0 }
}

fn volume(part: &Part) -> f64 {
    assert!(part.closed && part.faces.iter().enumerate().all(|(i, f)| f.id == i as u32 + 1));
    part.faces.iter().map(flux).sum()
}

/// One curve of a face's boundary in space.
struct Rim {
    face: usize,
    grid: usize,
    curve: Bezier<DVec3>,
    low: DVec3,
    high: DVec3,
}

impl Rim {
    fn at(&self, grids: &[PatchGrid], t: f64) -> DVec3 {
        let p = self.curve.point(t);
        grids[self.grid].point(p.x, p.y)
    }
}

/// Boundary curves that are not poles: of the loops, or the sides of the patches at the borders of the domain.
fn rims(part: &Part, grids: &[PatchGrid], reach: f64) -> Vec<Rim> {
    let mut all = Vec::new();
    for (face, f) in part.faces.iter().enumerate() {
        let mut curves: Vec<Bezier<DVec3>> = f.loops.iter().flat_map(|l| l.curves()).collect();
        if f.loops.is_empty() {
            let ((u0, u1), (v0, v1)) = f.surface.domain();
            for p in &grids[face].patches {
                let mut side = |on: bool, a: (f64, f64), b: (f64, f64)| {
                    if on {
                        curves.push(Bezier::line(DVec2::from(a), DVec2::from(b)));
                    }
                };
                side(p.v.0 == v0, (p.u.0, v0), (p.u.1, v0));
                side(p.v.1 == v1, (p.u.0, v1), (p.u.1, v1));
                side(p.u.0 == u0, (u0, p.v.0), (u0, p.v.1));
                side(p.u.1 == u1, (u1, p.v.0), (u1, p.v.1));
            }
        }
        for curve in curves {
            let mut rim = Rim { face, grid: face, curve, low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };
            for k in 0..=16 {
                let p = rim.at(grids, f64::from(k) / 16.0);
                (rim.low, rim.high) = (rim.low.min(p), rim.high.max(p));
            }
            if rim.low.distance(rim.high) > reach {
                all.push(rim);
            }
        }
    }
    all
}

/// Distance of `p` from a curve: the nearest of 33 points, then thirds.
fn distance(rim: &Rim, grids: &[PatchGrid], p: DVec3) -> f64 {
    let off = |t: f64| rim.at(grids, t).distance_squared(p);
    let best = (0..=32).map(|k| f64::from(k) / 32.0).min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap();
    let (mut a, mut b) = ((best - 1.0 / 32.0f64).max(0.0), (best + 1.0 / 32.0f64).min(1.0));
    for _ in 0..60 {
        let (s, t) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
        if off(s) < off(t) { b = t } else { a = s }
    }
    [a, 0.5 * (a + b), b, best].map(off).into_iter().fold(f64::INFINITY, f64::min).sqrt()
}

/// Every boundary curve of every face lies on others, point by point.
fn edges_are_shared(part: &Part) {
    let size = part.bounds().diagonal();
    let grids: Vec<PatchGrid> = part.faces.iter().map(|f| f.surface.patches()).collect();
    let rims = rims(part, &grids, SHARED * size);
    let slack = 1e-2 * size;
    for (i, rim) in rims.iter().enumerate() {
        for t in [0.013, 0.27, 0.5, 0.81, 0.987] {
            let p = rim.at(&grids, t);
            let near = rims
                .iter()
                .enumerate()
                .filter(|(j, r)| *j != i && p.cmpge(r.low - slack).all() && p.cmple(r.high + slack).all());
            let best = near.map(|(_, r)| distance(r, &grids, p)).fold(f64::INFINITY, f64::min);
            assert!(best <= SHARED * size, "face {} is alone at {p} by {best:e}", rim.face + 1);
        }
    }
    // and edge by edge, as a writer of STEP pairs them
    let instance = Instance { part: 0, transform: glam::DAffine3::IDENTITY, colour: None, name: String::new() };
    let model = Model { parts: vec![part.clone()], instances: vec![instance], ..Model::default() };
    let mut text = Vec::new();
    assert_eq!(export::step(&model, &mut text).unwrap(), []);
    assert!(String::from_utf8(text).unwrap().contains("MANIFOLD_SOLID_BREP"));
}

/// Points of the faces lie on the primitive's surface: on one carrier, on or inside all.
fn faces_are_the_primitive(body: &Body) {
    let shape = body.shape.as_ref().expect("a primitive");
    shape.check().unwrap();
    let size = body.part.bounds().diagonal();
    let carriers = shape.carriers();
    let off = |c: &Carrier, p: DVec3| c.value(p) / c.gradient(p).length().max(1e-3 * size);
    for face in &body.part.faces {
        let ((u0, u1), (v0, v1)) = face.surface.domain();
        let inside = selvedge_geometry::trim::LoopIndex::new(&face.loops);
        for k in 0..17 * 17 {
            let (u, v) = (u0 + (u1 - u0) * f64::from(k % 17) / 16.0, v0 + (v1 - v0) * f64::from(k / 17) / 16.0);
            if !face.loops.is_empty() && !inside.contains(DVec2::new(u, v)) {
                continue;
            }
            let jet = face.surface.jet(u, v);
            let values: Vec<f64> = carriers.iter().map(|c| off(c, jet.point)).collect();
            let (most, least) =
                values.iter().fold((f64::NEG_INFINITY, f64::INFINITY), |(m, l), x| (m.max(*x), l.min(x.abs())));
            assert!(most <= EXACT * size && least <= EXACT * size, "{values:?} at {u} {v} of face {}", face.id);
            // the normal points where the carrier grows, but on an edge, where there are two
            let mut on = carriers.iter().zip(&values).filter(|(_, x)| x.abs() <= EXACT * size);
            if let (Some((on, _)), None) = (on.next(), on.next()) {
                let normal = jet.du.cross(jet.dv);
                let side = normal.dot(on.gradient(jet.point)) * if face.same_sense { 1.0 } else { -1.0 };
                assert!(side >= 0.0 || normal.length() <= 1e-9 * size * size, "inwards at {u} {v} of face {}", face.id);
            }
        }
    }
}

fn close(found: f64, expected: f64, share: f64) {
    assert!((found - expected).abs() <= share * expected.abs(), "{found} for {expected}");
}

proptest! {
    #![proptest_config(cases(12))]

    /// Primitives have the closed forms' volume, lie on their carriers, and close.
    #[test]
    fn primitives_are_exact(a in 0.01..10.0f64, b in 0.01..10.0f64, c in 0.01..10.0f64) {
        let cases = [
            (block(DVec3::new(-a, b, -c), DVec3::new(b, a + b, a)).unwrap(), (a + b) * a * (a + c)),
            (sphere(a).unwrap(), 4.0 / 3.0 * PI * a.powi(3)),
            (cylinder(a, b).unwrap(), PI * a * a * b),
            (cone(a, 0.0, b).unwrap(), PI * a * a * b / 3.0),
            (cone(0.0, a, b).unwrap(), PI * a * a * b / 3.0),
            (cone(a, b, c).unwrap(), PI * c / 3.0 * (a * a + a * b + b * b)),
            (torus(a + b, b).unwrap(), 2.0 * PI * PI * (a + b) * b * b),
        ];
        for (body, expected) in &cases {
            prop_assert_eq!(body.deviation, 0.0);
            close(volume(&body.part), *expected, EXACT);
            faces_are_the_primitive(body);
            edges_are_shared(&body.part);
        }
        let pipe = tube(a + b, a, c).unwrap();
        close(volume(&pipe.part), PI * c * b * (2.0 * a + b), 1e-11 * (1.0 + a / b));
        edges_are_shared(&pipe.part);
    }

    /// The bore's circle and its slot overlap: their union's area is in closed form.
    #[test]
    fn gear_blanks_are_exact(
        bore in 0.5..2.0f64, hub in 1.6..2.5f64, radius in 1.2..3.0f64, thick in 0.2..2.0f64, key in 0.1..0.9f64,
    ) {
        let (hub, half) = (bore * hub, key * bore);
        let depth = 0.9 * ((hub * hub - half * half).sqrt() - bore);
        let blank = GearBlank {
            radius: hub * radius,
            width: thick,
            hub_radius: hub,
            hub_width: 1.7 * thick,
            bore,
            keyway: (depth > 0.05).then_some(Keyway { width: 2.0 * half, depth }),
        };
        let body = blank.build().unwrap();
        let segment = half * (bore * bore - half * half).sqrt() + bore * bore * (half / bore).asin();
        let slot = blank.keyway.map_or(0.0, |k| k.width * (bore + k.depth) - segment);
        let hole = PI * bore * bore + slot;
        let solid = PI * (blank.radius.powi(2) * thick + hub * hub * 0.7 * thick) - hole * 1.7 * thick;
        close(volume(&body.part), solid, 1e-11);
        edges_are_shared(&body.part);
        prop_assert_eq!(body.part.faces.len(), if blank.keyway.is_some() { 9 } else { 6 });
    }
}

/// Every point of a flank is as far along its tangent to the base circle as the arc that was unrolled, within the
/// gear's stated error; returns half the angles of a tooth's tip and of the gap at the root.
fn flanks_are_involutes(gear: &SpurGear, body: &Body) -> [f64; 2] {
    assert!(body.deviation <= gear.tolerance);
    let n = f64::from(gear.teeth);
    let pitch = 0.5 * gear.module * n;
    let (base, tip, root) = (pitch * gear.pressure_angle.cos(), pitch + gear.module, pitch - 1.25 * gear.module);
    let at = |r: f64| ((r / base).powi(2) - 1.0).max(0.0).sqrt();
    let turn = |t: f64| t - t.atan();
    let middle = 0.5 * PI / n + turn(gear.pressure_angle.tan());
    for face in body.part.faces.iter().filter(|f| f.kind == SurfaceKind::Extrusion).take(2) {
        let grid = face.surface.patches();
        let ((u0, u1), _) = face.surface.domain();
        for k in 0..=600 {
            let p = grid.point(u0 + (u1 - u0) * f64::from(k) / 600.0, 0.3).truncate();
            if p.length() > base {
                // an angle about the centre unrolls as far on the base circle, along the involute's normal
                let off = (p.y.atan2(p.x).abs() - (middle - turn(at(p.length())))).abs() * base;
                assert!(off <= body.deviation + EXACT * tip, "{off:e} of {:e} at {}", body.deviation, p.length());
                assert!(p.length() <= tip * (1.0 + EXACT) + body.deviation);
            }
        }
    }
    [middle - turn(at(tip)), PI / n - middle + turn(at(root))]
}

/// The area under an involute is `base² t³ / 6`; flanks are off by no more than their stated error.
#[test]
fn spur_gears_have_involute_teeth() {
    for (teeth, module, bore) in [(8, 1.0, 0.0), (17, 2.5, 6.0), (60, 0.5, 3.0)] {
        for tolerance in [1e-3, 1e-9] {
            let gear = SpurGear { tolerance: tolerance * module, ..SpurGear::new(module, teeth, 1.5, bore) };
            let body = gear.build().unwrap();
            let [top, gap] = flanks_are_involutes(&gear, &body);
            let n = f64::from(teeth);
            let pitch = 0.5 * module * n;
            let (base, tip, root) = (pitch * gear.pressure_angle.cos(), pitch + module, pitch - 1.25 * module);
            let at = |r: f64| ((r / base).powi(2) - 1.0).max(0.0).sqrt();
            let flanks = base * base * (at(tip).powi(3) - at(root).powi(3)) / 3.0;
            let area = n * (flanks + tip * tip * top + root * root * gap) - PI * bore * bore;
            let length = 2.0 * n * 2.5 * module; // of all flanks, at most
            let slack = 1.5 * length * body.deviation + EXACT * area;
            let found = volume(&body.part);
            assert!((found - 1.5 * area).abs() <= 1.5 * slack, "{found} for {} within {slack:e}", 1.5 * area);
            if tolerance > 1e-6 && teeth < 20 {
                edges_are_shared(&body.part);
            }
        }
    }
}

proptest! {
    #![proptest_config(cases(24))]

    #[test]
    fn flanks_keep_their_tolerance(
        teeth in 4u32..60, module in 0.1..5.0f64, degrees in 14.0..30.0f64, digits in 2.0..10.0f64,
    ) {
        let (pressure_angle, tolerance) = (degrees.to_radians(), module * 10f64.powf(-digits));
        let gear = SpurGear { pressure_angle, tolerance, ..SpurGear::new(module, teeth, 1.0, 0.0) };
        match gear.build() {
            Ok(body) => {
                let [top, gap] = flanks_are_involutes(&gear, &body);
                prop_assert!(top > 0.0 && gap > 0.0);
            }
            Err(ConstructError::Range { what, value, .. }) => {
                // teeth of steep flanks end in a point below the tip circle
                prop_assert!(what == "half the angle of a tooth's tip" && value <= 0.0 && degrees > 20.0, "{what}");
            }
            Err(e) => prop_assert!(false, "{e}"),
        }
    }
}

#[test]
fn the_teapot_is_four_closed_solids() {
    let pot = teapot().unwrap();
    for (name, body) in [("pot", &pot.pot), ("lid", &pot.lid), ("handle", &pot.handle), ("spout", &pot.spout)] {
        assert!(body.part.faces.iter().all(|f| f.id > 0), "{name}");
        assert!(volume(&body.part) > 1.0, "{name}: {}", volume(&body.part));
        edges_are_shared(&body.part);
    }
    // turned solids by the theorem of Pappus, in lengths of the profile that a fine polygon measures
    let profile = |part: &Part| -> f64 {
        let mut sum = 0.0;
        for face in part.faces.iter().filter(|f| f.loops.is_empty()) {
            let grid = face.surface.patches();
            let ((u, _), (a, b)) = face.surface.domain();
            let at = |k: u32| grid.point(u, a + (b - a) * f64::from(k) / 20_000.0);
            sum += (0..20_000)
                .map(|k| (at(k), at(k + 1)))
                .map(|(p, q)| 0.25 * (p.x + q.x).powi(2) * (q.z - p.z))
                .sum::<f64>();
        }
        PI * sum
    };
    for body in [&pot.pot, &pot.lid] {
        close(volume(&body.part), profile(&body.part), 1e-6);
    }
    // handle and spout end inside the wall of the pot: nothing of them shows within
    let outside = |z: f64, inner: bool| -> f64 {
        let grid = pot.pot.part.faces[if inner { 3 } else { 1 }].surface.patches();
        let ((u, _), (a, b)) = pot.pot.part.faces[if inner { 3 } else { 1 }].surface.domain();
        let points = (0..=4000).map(|k| grid.point(u, a + (b - a) * f64::from(k) / 4000.0));
        points.filter(|p| p.x > 2.9 && p.z < 9.0).min_by(|p, q| (p.z - z).abs().total_cmp(&(q.z - z).abs())).unwrap().x
    };
    for part in [&pot.handle.part, &pot.spout.part] {
        for cap in part.faces.iter().filter(|f| f.kind == SurfaceKind::Plane) {
            let on: Vec<DVec3> = cap
                .loops
                .iter()
                .flat_map(|l| l.curves())
                .flat_map(|c| {
                    [0.0, 0.5].map(|t| {
                        let p = c.point(t);
                        cap.surface.jet(p.x, p.y).point
                    })
                })
                .collect();
            if on.iter().any(|p| p.x > 10.0) {
                continue; // the lip
            }
            for p in on {
                let r = p.x.hypot(p.y);
                assert!(
                    r < outside(p.z, false) && r > outside(p.z, true),
                    "{p}: {r} in {} to {}",
                    outside(p.z, true),
                    outside(p.z, false)
                );
            }
        }
    }
}

#[test]
fn walls_with_caps() {
    let ellipse = |at: f64| curve::ellipse(DVec3::Z * at, DVec3::X * 2.0, DVec3::Y, 0.0, TAU).unwrap();
    let wall = selvedge_geometry::construct::ruled(&ellipse(0.0), &ellipse(3.0)).unwrap();
    let part = capped_solid(std::slice::from_ref(&wall)).unwrap();
    close(volume(&part), 6.0 * PI, EXACT);
    edges_are_shared(&part);
    // run backwards, along and around
    let downwards = selvedge_geometry::construct::ruled(&ellipse(3.0), &ellipse(0.0)).unwrap();
    close(volume(&capped_solid(&[downwards]).unwrap()), 6.0 * PI, EXACT);
    let clockwise = selvedge_geometry::construct::ruled(&ellipse(0.0).reversed(), &ellipse(3.0).reversed()).unwrap();
    close(volume(&capped_solid(&[clockwise]).unwrap()), 6.0 * PI, EXACT);
    // a swept square with two holes would be two walls more; a closed path has no caps
    let profile = planar(&[(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5)]);
    let path = curve::circle(DVec3::ZERO, DVec3::Z, DVec3::X, 4.0, TAU).unwrap();
    let swept = Sweep::new(&profile, &path, 1e-9).build().unwrap();
    let ring = capped_solid(&[swept.surface]).unwrap();
    assert_eq!(ring.faces.len(), 1);
    close(volume(&ring), 8.0 * PI, EXACT);
    let half = curve::circle(DVec3::ZERO, DVec3::Z, DVec3::X, 4.0, PI).unwrap();
    let half = capped_solid(&[Sweep::new(&profile, &half, 1e-9).build().unwrap().surface]).unwrap();
    assert_eq!(half.faces.len(), 3);
    close(volume(&half), 4.0 * PI, EXACT);
    edges_are_shared(&half);

    assert!(matches!(capped_solid(&[]), Err(ConstructError::TooFew { .. })));
    let open = curve::line(DVec3::ZERO, DVec3::X).unwrap();
    let open = selvedge_geometry::construct::extrude(&open, DVec3::Z).unwrap();
    assert!(matches!(capped_solid(&[open]), Err(ConstructError::Open { .. })));
    let points = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.3), (1.0, 1.0, 0.0), (0.0, 1.0, 0.3), (0.0, 0.0, 0.0)].map(DVec3::from);
    let bent: BSpline<_> = line(&points);
    let bent = selvedge_geometry::construct::extrude(&bent, DVec3::Z).unwrap();
    assert!(matches!(capped_solid(&[bent]), Err(ConstructError::NotPlanar { .. })));
}

#[test]
fn operands_are_analytic_where_they_can_be() {
    assert_eq!(sphere(2.0).unwrap().operand(), Shape::Sphere { radius: 2.0 });
    let Shape::Part(part) = tube(2.0, 1.0, 3.0).unwrap().operand() else { panic!("a part") };
    assert_eq!(Shape::Part(part).check(), Ok(()));
}

#[test]
fn what_is_no_shape_is_named() {
    let refused = |built: Result<Body, ConstructError>, words: &str| {
        let message = built.expect_err(words).to_string();
        assert!(message.contains(words), "{message} should say {words}");
    };
    refused(sphere(0.0), "the radius of a sphere is 0");
    refused(sphere(f64::NAN), "the radius of a sphere is not a finite number");
    refused(sphere(f64::INFINITY), "the radius of a sphere is inf");
    refused(block(DVec3::ZERO, DVec3::new(1.0, 0.0, 1.0)), "side of a block along y");
    refused(block(DVec3::ONE, DVec3::ZERO), "side of a block along x");
    refused(block(DVec3::NAN, DVec3::ONE), "a corner of a block is not a finite");
    refused(cylinder(1.0, -1.0), "the height of a cylinder is -1");
    refused(cone(0.0, 0.0, 1.0), "the larger radius of a cone");
    refused(cone(-1.0, 1.0, 1.0), "the bottom radius of a cone");
    refused(cone(1.0, 1.0, 0.0), "the height of a cone");
    refused(torus(1.0, 1.0), "the minor radius of a torus is 1, but must be below the major");
    refused(torus(0.0, 1.0), "the major radius of a torus");
    refused(tube(1.0, 1.0, 1.0), "the inner radius of a tube is 1, but must be below the outer");
    refused(tube(1.0, 0.0, 1.0), "the inner radius of a tube is 0");
    let blank = GearBlank { radius: 5.0, width: 1.0, hub_radius: 2.0, hub_width: 2.0, bore: 1.0, keyway: None };
    refused(GearBlank { hub_radius: 5.0, ..blank }.build(), "the hub radius of a gear blank");
    refused(GearBlank { bore: 2.5, ..blank }.build(), "the bore of a gear blank");
    refused(GearBlank { hub_width: 1.0, ..blank }.build(), "the hub width of a gear blank");
    refused(GearBlank { keyway: Some(Keyway { width: 2.0, depth: 0.1 }), ..blank }.build(), "the width of a keyway");
    refused(GearBlank { keyway: Some(Keyway { width: 0.5, depth: 1.0 }), ..blank }.build(), "the reach of a keyway");
    let gear = SpurGear::new(1.0, 20, 2.0, 1.0);
    refused(SpurGear { teeth: 3, ..gear }.build(), "3 teeth of a gear");
    refused(SpurGear { teeth: 1 << 20, ..gear }.build(), "teeth of a gear, but at most");
    refused(SpurGear { bore: 9.0, ..gear }.build(), "the bore of a gear");
    refused(SpurGear { pressure_angle: 0.7, ..gear }.build(), "pointed");
    refused(SpurGear { tolerance: f64::NAN, ..gear }.build(), "tolerance of a gear's flanks is not");
}

/// The judge of edges sees a face that is a hundred-millionth of the size off.
#[test]
#[should_panic(expected = "is alone")]
fn a_face_that_is_off_is_seen() {
    let mut part = tube(2.0, 1.0, 3.0).unwrap().part;
    let moved = glam::DAffine3::from_translation(DVec3::Z * 1e-8 * part.bounds().diagonal());
    part.faces[2].surface = part.faces[2].surface.transformed(&moved);
    edges_are_shared(&part);
}
