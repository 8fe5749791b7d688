//! Solids made of faces, and of quadrics, against closed forms.

use super::{contains, import};
use crate::import::brlcad;
use crate::model::{Face, Part, Shape};
use crate::spline::{Bezier, Control};
use glam::DVec3;
use std::f64::consts::PI;

/// What rounding leaves of volumes and areas of a few hundred units.
const ROUNDING: f64 = 1e-9;

fn gauss(f: impl Fn(f64) -> f64) -> f64 {
    // four points, exact to degree 7, in each of 16 parts of [0, 1]
    const AT: [(f64, f64); 2] =
        [(0.339_981_043_584_856_26, 0.652_145_154_862_546_1), (0.861_136_311_594_052_6, 0.347_854_845_137_453_85)];
    let part = |k: usize| {
        let middle = (k as f64 + 0.5) / 16.0;
        AT.iter().map(|(x, w)| w * (f(middle - x / 32.0) + f(middle + x / 32.0)) / 32.0).sum::<f64>()
    };
    (0..16).map(part).sum()
}

/// Volume's share and area of a face.
fn of_face(face: &Face) -> (f64, f64) {
    let sign = if face.same_sense { 1.0 } else { -1.0 };
    let grid = face.surface.patches();
    let over = |f: &dyn Fn(DVec3, DVec3) -> f64| {
        let patch = |p: &crate::spline::SurfacePatch| {
            gauss(|u| {
                gauss(|v| {
                    let jet = p.patch.jet(u, v);
                    f(jet.point, jet.du.cross(jet.dv))
                })
            })
        };
        grid.patches.iter().map(patch).sum::<f64>()
    };
    if face.loops.is_empty() {
        return (sign * over(&|p, n| p.dot(n) / 3.0), over(&|_, n| n.length()));
    }
    // a plane: the loops' areas by Green's theorem, in its parameters
    let along = |c: &Bezier<DVec3>| {
        gauss(|t| {
            let (p, d) = c.jet(t);
            let at = p.point();
            let step = (d.truncate() - at * d.z) / p.z;
            0.5 * at.perp_dot(step)
        })
    };
    let area: f64 = face.loops.iter().flat_map(|l| l.curves()).map(|c| along(&c)).sum();
    let jet = grid.jet(0.0, 0.0);
    let normal = jet.du.cross(jet.dv);
    (sign * jet.point.dot(normal) / 3.0 * area, normal.length() * area)
}

/// Volume and area of the only primitive, whose faces close.
fn size(text: &str) -> (f64, f64) {
    let read = import(text);
    let solid = &read.model.solids[0];
    let Shape::Part(part) = &solid.primitives()[0].shape else { panic!("no faces: {text}") };
    let scale = solid.primitives()[0].transform.matrix3;
    assert!((scale.determinant().abs() - 1.0).abs() < 1e-12, "placed by a rotation");
    assert!(part.closed && solid.primitives().len() == 1);
    meets(part);
    let all: Vec<(f64, f64)> = part.faces.iter().map(of_face).collect();
    (all.iter().map(|f| f.0).sum(), all.iter().map(|f| f.1).sum())
}

/// Of a closed surface the vectors of area add up to nothing.
fn meets(part: &Part) {
    let moved = |face: &Face| {
        let mut far = face.clone();
        let points = face.surface.points().iter().map(|p| *p + (DVec3::new(3.0, 5.0, 7.0) * p.w).extend(0.0));
        let (u, v) = face.surface.knots();
        far.surface =
            crate::spline::Surface::new(face.surface.degrees(), u.to_vec(), v.to_vec(), points.collect()).unwrap();
        of_face(&far).0 - of_face(face).0
    };
    let flow: f64 = part.faces.iter().map(moved).sum();
    assert!(flow.abs() < ROUNDING, "open by {flow:e}");
}

#[track_caller]
fn is(text: &str, volume: f64, area: impl Into<Option<f64>>) {
    let (found, surface) = size(text);
    assert!((found - volume).abs() < ROUNDING * volume.max(1.0), "volume {found}, not {volume}: {text}");
    if let Some(area) = area.into() {
        assert!((surface - area).abs() < ROUNDING * area.max(1.0), "area {surface}, not {area}: {text}");
    }
}

/// Pappus: the ellipse's area, or a circle's circumference, times the way of its centre.
#[test]
fn elliptical_tori() {
    is("put e eto V {1 2 3} N {0 0 2} C {2 0 1} r 5 r_d 1", 2.0 * PI * 5.0 * PI * 5f64.sqrt(), None);
    is("put e eto V {1 2 3} N {1 2 0} C {-1 .5 0} r 5 r_d 1", 2.0 * PI * 5.0 * PI * 1.25f64.sqrt(), None);
    is("put e eto V {0 0 0} N {0 3 0} C {0 2 0} r 5 r_d 2", 2.0 * PI * 5.0 * PI * 4.0, 4.0 * PI * PI * 10.0);
}

#[test]
fn particles() {
    is("put p part V {1 0 0} H {0 3 4} r_v 2 r_h 2", PI * 4.0 * 5.0 + PI * 32.0 / 3.0, PI * 4.0 * 5.0 + PI * 16.0);
    // balls of 3 and 1, 4 apart: the cone touches at the sine of 1/2
    let cap = |r: f64, z: f64| PI * (r * r * z - z * z * z / 3.0 + 2.0 / 3.0 * r * r * r);
    let (low, high) = (3.0 * 0.75f64.sqrt(), 0.75f64.sqrt());
    let cone = PI * 3.0 / 3.0 * (low * low + low * high + high * high);
    is("put p part V {0 0 0} H {4 0 0} r_v 3 r_h 1", cap(3.0, 1.5) + cone + cap(1.0, -0.5), None);
    // one ball within the other is the other
    let ball = import("put p part V {0 0 0} H {1 0 0} r_v 3 r_h 1");
    assert_eq!(ball.model.solids[0].primitives()[0].shape, Shape::Sphere { radius: 3.0 });
}

/// Slices are ellipses whose half axes change evenly.
#[test]
fn cones_of_every_taper() {
    is("put c tgc V {0 0 0} H {1 0 4} A {2 0 0} B {0 1 0} C {1 0 0} D {0 3 0}", 4.0 * PI * 17.0 / 6.0, None);
    // the other hand, and upside down
    is("put c tgc V {0 0 0} H {1 0 -4} A {2 0 0} B {0 1 0} C {1 0 0} D {0 3 0}", 4.0 * PI * 17.0 / 6.0, None);
    // an end that is a line, and one line across the other
    is("put c tgc V {0 0 0} H {0 0 4} A {2 0 0} B {0 1 0} C {2 0 0} D {0 0 0}", 4.0 * PI, None);
    is("put c tgc V {0 0 0} H {0 0 6} A {2 0 0} B {0 0 0} C {0 0 0} D {0 3 0}", PI * 6.0, None);
}

#[test]
fn pipes() {
    let point = |i: u32, at: &str, od: f64, id: f64| format!(" V{i} {{{at}}} O{i} {od} I{i} {id} R{i} 5");
    let pipe = |all: &[(&str, f64, f64)]| {
        let points = (0..).zip(all).map(|(i, (at, od, id))| point(i, at, *od, *id));
        format!("put p pipe{}", points.collect::<String>())
    };
    let ends = 2.0 * PI * 3.0;
    is(&pipe(&[("0 0 0", 4.0, 2.0), ("10 0 0", 4.0, 2.0)]), PI * 3.0 * 10.0, 2.0 * PI * 3.0 * 10.0 + ends);
    // a right angle, and one of 60 degrees: the middle's length times the ring
    let way = 5.0 + 5.0 + 2.5 * PI;
    let bent = [("0 0 0", 4.0, 2.0), ("10 0 0", 4.0, 2.0), ("10 10 0", 4.0, 2.0)];
    is(&pipe(&bent), PI * 3.0 * way, 2.0 * PI * 3.0 * way + ends);
    let (step, takes) = (10.0 * 0.75f64.sqrt(), 5.0 * (PI / 6.0).tan());
    let corner = format!("15 {step} 0");
    let slight = [("0 0 0", 4.0, 0.0), ("10 0 0", 4.0, 0.0), (corner.as_str(), 4.0, 0.0)];
    is(&pipe(&slight), PI * 4.0 * (20.0 - 2.0 * takes + 5.0 * PI / 3.0), None);
    // through a straight corner, wider and with a hole that begins there
    let wider = [("0 0 0", 2.0, 0.0), ("0 0 3", 4.0, 0.0), ("0 0 6", 4.0, 2.0)];
    is(&pipe(&wider), PI * (1.0 + 2.0 + 4.0) + PI * 12.0 - PI, None);
    let fault = |text: &str| brlcad(text.as_bytes(), "t.asc").expect_err("no pipe").to_string();
    for (points, message) in [
        (vec![("0 0 0", 4.0, 2.0)], "fewer than two points"),
        (vec![("0 0 0", 4.0, 2.0), ("0 0 0", 4.0, 2.0)], "two points of it are one"),
        (vec![("0 0 0", 4.0, 4.0), ("9 0 0", 4.0, 2.0)], "point 0: diameters 4 within 4"),
        (vec![("0 0 0", 4.0, 2.0), ("9 0 0", 4.0, 2.0), ("3 0 0", 4.0, 2.0)], "it turns back on itself at point 1"),
        (vec![("0 0 0", 4.0, 2.0), ("4 0 0", 4.0, 2.0), ("4 9 0", 4.0, 2.0)], "the way to point 1 is too short"),
        (vec![("0 0 0", 4.0, 2.0), ("9 0 0", 12.0, 2.0), ("9 9 0", 4.0, 2.0)], "point 1 bends by 5, but is 6 wide"),
    ] {
        assert!(fault(&pipe(&points)).contains(message), "{}", fault(&pipe(&points)));
    }
}

#[test]
fn corners_out_of_plane() {
    let text = "put u arb8 V1 {0 0 0} V2 {1 0 0} V3 {1 1 0} V4 {0 1 0} V5 {.1 .3 1} V6 {1.1 .3 1} V7 {1.3 1.3 1} V8 {.1 1.3 1}";
    // slices are trapezoids of height 1 and widths 1 and 1 + z / 5
    is(text, 1.05, None);
    let said = import(text).warnings[0].to_string();
    assert!(said.starts_with("t.asc:1: faces that are not flat: u arb8: corners lie"), "{said}");
    // inside out
    let turned = "put u arb8 V1 {.1 .3 1} V2 {1.1 .3 1} V3 {1.3 1.3 1} V4 {.1 1.3 1} V5 {0 0 0} V6 {1 0 0} V7 {1 1 0} V8 {0 1 0}";
    is(turned, 1.05, None);
    let concave = "put u arb8 V1 {0 0 0} V2 {4 0 0} V3 {1 1 0} V4 {0 4 0} V5 {0 0 1} V6 {4 0 1} V7 {1 1 1} V8 {0 4 1}";
    let error = brlcad(concave.as_bytes(), "t.asc").expect_err("concave").to_string();
    assert_eq!(error, "t.asc:1: u arb8: it is not convex, or has no volume, and is not read");
}

#[test]
fn extrusions() {
    let sketch = |segments: &str| {
        format!(
            "put s sketch V {{0 0 0}} A {{1 0 0}} B {{0 1 0}} VL {{{{0 0}} {{4 0}} {{4 2}} {{0 2}} {{1 1}} {{1.5 1}}}} SL {{{segments}}}\n\
             put e extrude V {{1 2 3}} H {{0 1 5}} A {{0 0 1}} B {{1 0 0}} S s K 0\n"
        )
    };
    // out of order and against each other; a round hole of radius a half
    let sides = "{line S 0 E 1} {line S 2 E 3} {line S 2 E 1} {line S 3 E 0}";
    let hole = " {carc S 5 E 4 R -1 L 0 O 0}";
    is(&sketch(&format!("{sides}{hole}")), 8.0 - PI / 4.0, None);
    // one end round, outwards or inwards; its centre is left of the way from 1 to 2, and the arc runs either way
    let round = |o: u32| sketch(&sides.replace("{line S 2 E 1}", &format!("{{carc S 1 E 2 R 1 L 1 O {o}}}")));
    is(&round(0), 8.0 + PI / 2.0, None);
    is(&round(1), 8.0 - PI / 2.0, None);
    let bezier = sides.replace("{line S 2 E 1}", "{bezier D 2 P {1 4 2}}");
    // the triangle of a parabola's control points, two thirds of it
    is(&sketch(&bezier), 8.0 - 2.0 / 3.0 * 3.0, None);
    let fault = |text: &str| brlcad(text.as_bytes(), "t.asc").expect_err("no extrusion").to_string();
    for (from, to, message) in [
        ("{line S 3 E 0}", "", "s sketch: the curve ends at vertex 3"),
        ("E 0}", "E 9}", "s sketch: segment 3: there is no vertex 9"),
        ("{line S 3", "{nurb S 3", "s sketch: segment 3: `nurb` is not read"),
        ("put s sketch", "put q sketch", "e extrude: there is no sketch `s`"),
        ("H {0 1 5}", "H {0 0 5}", "e extrude: the extrusion across the plane of its profile has no length"),
    ] {
        let text = sketch(sides).replacen(from, to, 1);
        assert!(fault(&text).contains(message), "{}", fault(&text));
    }
}

#[test]
fn triangles_close_or_are_left_out() {
    let text = |faces: &str, mode: &str| {
        format!(
            "put t bot mode {mode} orient rh flags {{}} V {{ {{0 0 0}} {{1 0 0}} {{0 1 0}} {{0 0 1}} }} F {{ {faces} }}"
        )
    };
    let good = "{0 2 1} {0 1 3} {1 2 3} {2 0 3}";
    let read = import(&text(good, "volume"));
    let Shape::Mesh(mesh) = &read.model.solids[0].primitives()[0].shape else { panic!("no mesh") };
    assert_eq!((mesh.triangles().len(), mesh.bounds().max), (4, DVec3::ONE));
    let fault = |text: &str| brlcad(text.as_bytes(), "t.asc").expect_err("open").to_string();
    // two triangles meet in the middle of another one's side, and a little beside it
    let junction = |middle: &str| {
        let more = text("{0 2 4} {4 2 1} {0 1 3} {1 2 3} {2 0 3}", "volume");
        more.replace("{0 0 1} }", &format!("{{0 0 1}} {{{middle}}} }}"))
    };
    for (middle, off) in [("0.5 0 0", "0.000e0"), ("0.5 0 -1e-5", "1.000e-5")] {
        let read = brlcad(junction(middle).as_bytes(), "t.asc").unwrap();
        let Shape::Mesh(mesh) = &read.model.solids[0].primitives()[0].shape else { panic!("no mesh") };
        assert_eq!(mesh.triangles().len(), 6);
        let told = format!("sides divided: t: 1 sides of triangles, at vertices up to {off} off");
        assert!(read.warnings.len() == 1 && read.warnings[0].to_string().ends_with(&told), "{:?}", read.warnings);
    }
    assert!(fault(&junction("0.5 0 -1e-3")).contains("its triangles do not close"));
    for (faces, mode, message) in [
        ("{0 2 1} {0 1 3} {1 2 3}", "volume", "its triangles do not close"),
        ("{0 2 1} {0 1 3} {1 2 3} {2 0 4}", "volume", "triangle 3 names a vertex that does not exist"),
        ("{0 2 1} {0 1 3} {1 2 3} {2 0}", "volume", "vertices and triangles are not threes of numbers"),
        (good, "plate", "triangles of mode `plate` bound no volume"),
    ] {
        assert!(fault(&text(faces, mode)).contains(message), "{}", fault(&text(faces, mode)));
    }
}

/// Inside or outside at many points, by the equations of their definition.
#[test]
fn quadrics_between_planes() {
    let points = |i: u32| {
        let k = f64::from(i) + 0.5;
        (DVec3::new(0.819_172_5, 0.671_043_6, 0.549_700_5) * k).fract() * 12.0 - 5.0
    };
    let check = |text: &str, expected: &dyn Fn(DVec3) -> bool| {
        let import = import(text);
        let inside = (0..20_000).map(points).filter(|p| {
            assert_eq!(contains(&import, p.to_array()), expected(*p), "{text} at {p}");
            expected(*p)
        });
        assert!(inside.count() > 200, "{text}");
    };
    check("put s epa V {1 0 -1} H {0 0 6} A {0 1 0} r_1 4 r_2 2", &|p| {
        (p.y / 4.0).powi(2) + ((p.x - 1.0) / 2.0).powi(2) <= 1.0 - (p.z + 1.0) / 6.0 && p.z >= -1.0
    });
    // hyperbola: distance w from the tip of its cone, half axes c and the one that meets the ellipse at the end
    let sheet = |depth: f64, c: f64, z: f64, share: f64| {
        let (w, end) = (depth + c - z, depth + c);
        w >= c && share <= (w * w - c * c) / (end * end - c * c) && z >= 0.0
    };
    check("put s ehy V {0 0 0} H {0 0 5} A {1 0 0} r_1 4 r_2 3 c 2", &|p| {
        sheet(5.0, 2.0, p.z, (p.x / 4.0).powi(2) + (p.y / 3.0).powi(2))
    });
    check("put s ehy V {0 0 0} H {0 0 5} A {1 0 0} r_1 4 r_2 3 c .001", &|p| {
        sheet(5.0, 0.001, p.z, (p.x / 4.0).powi(2) + (p.y / 3.0).powi(2))
    });
    check("put s hyp V {0 0 -2} H {0 0 6} A {4 0 0} b 3 bnr .5", &|p| {
        let z = (p.z - 1.0) / 3.0;
        z.abs() <= 1.0 && (p.x / 4.0).powi(2) + (p.y / 3.0).powi(2) <= 0.25 + 0.75 * z * z
    });
    check("put s rpc V {0 0 -2} H {0 0 6} B {5 0 0} r 3", &|p| {
        (-2.0..=4.0).contains(&p.z) && p.x >= 0.0 && (p.y / 3.0).powi(2) <= 1.0 - p.x / 5.0
    });
    check("put s rhc V {0 0 -2} H {0 0 6} B {5 0 0} r 3 c 1", &|p| {
        (-2.0..=4.0).contains(&p.z) && sheet(5.0, 1.0, p.x, (p.y / 3.0).powi(2))
    });
    check("put s half N {0 0 2} d 1", &|p| p.z <= 0.5);
    let fault = |text: &str| brlcad(text.as_bytes(), "t.asc").expect_err("no solid").to_string();
    for (text, message) in [
        ("put s epa V {0 0 0} H {0 0 0} A {1 0 0} r_1 4 r_2 3", "`H` has no length"),
        ("put s epa V {0 0 0} H {0 0 1} A {0 0 2} r_1 4 r_2 3", "`A` has no length across `H`"),
        ("put s epa V {0 0 0} H {0 0 1} A {1 0 0} r_1 0 r_2 3", "`r_1` is 0, but must be positive"),
        ("put s ehy V {0 0 0} H {0 0 1} A {1 0 0} r_1 4 r_2 3 c 0", "`c` is 0, but must be positive"),
        ("put s hyp V {0 0 0} H {0 0 1} A {1 0 0} b 3 bnr 1.5", "`bnr` is 1.5, but must be at most 1"),
        ("put s rhc V {0 0 0} H {0 0 1} B {1 0 0} r -3 c 1", "`r` is -3, but must be positive"),
        ("put s eto V {0 0 0} N {0 0 1} C {1 0 0} r .5 r_d 1", "its ellipse reaches across the axis"),
        ("put s part V {0 0 0} H {0 0 1} r_v -1 r_h 1", "its radii are not those of balls"),
    ] {
        assert!(fault(text).contains(message), "{}", fault(text));
    }
}
