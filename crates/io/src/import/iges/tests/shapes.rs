//! One tiny model per kind of curve and surface, against closed forms.

use super::{Entity, e, face, import, lies_on, points, reaches};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// A tabulated cylinder of height 2 over the curve, which begins at `start`.
fn above(curve: &str, form: i32, start: DVec3) -> [Entity; 2] {
    let tip = start + 2.0 * DVec3::Z;
    [Entity { form, ..e(curve) }, e(&format!("122,1,{},{},{};", tip.x, tip.y, tip.z))]
}

#[test]
fn an_arc() {
    // three quarters of a circle about (1, 2), from angle 90 to 360 degrees
    let f = face(&above("100,0.5,1.,2.,1.,5.,4.,2.;", 0, v(1.0, 5.0, 0.5)));
    lies_on(&f, |p| (p.x - 1.0).hypot(p.y - 2.0) - 3.0);
    for p in [v(1.0, 5.0, 0.5), v(4.0, 2.0, 0.5), v(4.0, 2.0, 2.5)] {
        reaches(&f, p);
    }
    assert!(points(&f).iter().all(|p| !(p.x > 1.1 && p.y > 2.1)));
}

#[test]
fn an_ellipse_turned_and_moved() {
    // x'²/9 + y'² = 1 in axes turned by 30 degrees about (2, 1)
    let (s, c) = (PI / 6.0).sin_cos();
    let (a, b, d) = (c * c / 9.0 + s * s, 2.0 * s * c * (1.0 / 9.0 - 1.0), s * s / 9.0 + c * c);
    let implicit =
        |x: f64, y: f64| a * (x - 2.0) * (x - 2.0) + b * (x - 2.0) * (y - 1.0) + d * (y - 1.0) * (y - 1.0) - 1.0;
    let (k, m) = (-4.0 * a - b, -2.0 * b - 2.0 * d);
    let rest = implicit(0.0, 0.0);
    let (start, end) = (v(2.0 + 3.0 * c, 1.0 + 3.0 * s, 0.0), v(2.0 - s, 1.0 + c, 0.0));
    let text = format!("104,{a},{b},{d},{k},{m},{rest},0.,{},{},{},{};", start.x, start.y, end.x, end.y);
    let f = face(&above(&text, 1, start));
    lies_on(&f, |p| implicit(p.x, p.y));
    reaches(&f, start);
    reaches(&f, end);
    // a quarter of it: never on the far side of the centre
    assert!(points(&f).iter().all(|p| (p.x - 2.0) * c + (p.y - 1.0) * s > -1e-9));
}

#[test]
fn a_hyperbola_and_a_parabola() {
    // y² / 4 - x² = 1, lower branch
    let (a, b) = (v(-1.0, -(8f64.sqrt()), 0.0), v(2.0, -(20f64.sqrt()), 0.0));
    let f = face(&above(&format!("104,-1.,0.,0.25,0.,0.,-1.,0.,-1.,{},2.,{};", a.y, b.y), 2, a));
    lies_on(&f, |p| p.y * p.y / 4.0 - p.x * p.x - 1.0);
    [a, b].into_iter().for_each(|p| reaches(&f, p));
    // x² + 2 x + 8 y = 0
    let (a, b) = (v(3.0, -15.0 / 8.0, 0.0), v(-2.0, 0.0, 0.0));
    let f = face(&above(&format!("104,1.,0.,0.,2.,8.,0.,0.,3.,{},-2.,0.;", a.y), 3, a));
    lies_on(&f, |p| p.x * p.x + 2.0 * p.x + 8.0 * p.y);
    [a, b].into_iter().for_each(|p| reaches(&f, p));
}

#[test]
fn polylines_and_composites() {
    let f = face(&above("106,1,3,1.,0.,0.,4.,0.,4.,3.;", 11, v(0.0, 0.0, 1.0)));
    [v(4.0, 0.0, 1.0), v(4.0, 3.0, 3.0)].into_iter().for_each(|p| reaches(&f, p));
    // form 63 goes back to where it began
    let f = face(&above("106,1,3,1.,0.,0.,4.,0.,4.,3.;", 63, v(0.0, 0.0, 1.0)));
    assert!(points(&f).iter().any(|p| p.x > 1.0 && p.x < 3.0 && (p.y - 0.75 * p.x).abs() < 1e-9));
    let members = [e("110,0.,0.,0.,1.,0.,0.;"), e("100,0.,1.,1.,1.,0.,2.,1.;"), e("102,2,1,3;"), e("122,5,0.,0.,3.;")];
    let f = face(&members);
    [v(2.0, 1.0, 3.0), v(1.0, 0.0, 0.0)].into_iter().for_each(|p| reaches(&f, p));
}

#[test]
fn a_power_curve() {
    // (s, s³, 0) over [0, 2], then on straight
    let piece = "0.,1.,0.,0.,0.,0.,0.,1.,0.,0.,0.,0.,2.,1.,0.,0.,8.,12.,0.,0.,0.,0.,0.,0.";
    let f = face(&above(&format!("112,3,1,3,2,0.,2.,3.,{piece};"), 0, DVec3::ZERO));
    lies_on(&f, |p| if p.x <= 2.0 { p.y - p.x.powi(3) } else { p.y - 8.0 - 12.0 * (p.x - 2.0) });
    reaches(&f, v(3.0, 20.0, 2.0));
}

#[test]
fn offset_curves() {
    // z × tangent of a circle run counter-clockwise points inwards
    let f =
        face(&[e("100,0.,0.,0.,3.,0.,3.,0.;"), e("130,1,1,0,3,0,1.,0.,1.,0.,0.,0.,1.,0.,7.;"), e("122,3,2.,0.,5.;")]);
    lies_on(&f, |p| p.x.hypot(p.y) - 2.0);
    // of a parabola y = x²: at (1, 1) the normal is (-2, 1) / √5
    let parabola = "126,2,2,0,0,1,0,0.,0.,0.,1.,1.,1.,1.,1.,1.,-1.,1.,0.,0.,-1.,0.,1.,1.,0.,0.,1.,0.,0.,1.;";
    let (a, b) = (2.0 / 5f64.sqrt(), 1.0 / 5f64.sqrt());
    let tip = format!("122,3,{},{},4.;", -1.0 + a, 1.0 + b);
    let f = face(&[e(parabola), e("130,1,1,0,3,0,1.,0.,1.,0.,0.,0.,1.,0.,1.;"), e(&tip)]);
    [v(1.0 - a, 1.0 + b, 0.0), v(0.0, 1.0, 4.0)].into_iter().for_each(|p| reaches(&f, p));
}

#[test]
fn surfaces_of_revolution() {
    // a slanted line about the z axis: a cone from radius 1 to 3, a quarter turn
    let cone = ["110,0.,0.,0.,0.,0.,1.;", "110,1.,0.,0.,3.,0.,4.;", "120,1,3,0.,1.5707963267948966;"];
    let f = face(&cone.map(e));
    lies_on(&f, |p| p.x.hypot(p.y) - 1.0 - p.z / 2.0);
    [v(1.0, 0.0, 0.0), v(0.0, 3.0, 4.0)].into_iter().for_each(|p| reaches(&f, p));
    // mirrored, it turns the other way: from -x to y
    let mut all = Vec::from(cone.map(e));
    all[2].matrix = 7;
    all.push(e("124,-1.,0.,0.,0.,0.,1.,0.,0.,0.,0.,1.,0.;"));
    let f = face(&all);
    [v(-1.0, 0.0, 0.0), v(0.0, 3.0, 4.0)].into_iter().for_each(|p| reaches(&f, p));
    assert!(points(&f).iter().all(|p| p.x < 1e-9 && p.y > -1e-9));
    // half a circle about its diameter: a whole sphere, no loop
    let arc = "100,0.,0.,0.,2.,0.,-2.,0.;";
    let f = face(&[e("110,0.,0.,0.,1.,0.,0.;"), e(arc), e(&format!("120,1,3,0.,{TAU};"))]);
    lies_on(&f, |p| p.length() - 2.0);
    assert_eq!(f.loops.len(), 0);
}

#[test]
fn ruled_and_power_surfaces() {
    // between two lines that cross at right angles: z = x y
    let f = face(&[e("110,0.,0.,0.,1.,0.,0.;"), e("110,0.,1.,0.,1.,1.,1.;"), e("118,1,3,0,0;")]);
    lies_on(&f, |p| p.z - p.x * p.y);
    reaches(&f, v(1.0, 1.0, 1.0));
    // the second one run backwards
    let f = face(&[e("110,0.,0.,0.,1.,0.,0.;"), e("110,1.,1.,1.,0.,1.,0.;"), e("118,1,3,1,0;")]);
    lies_on(&f, |p| p.z - p.x * p.y);
    // x = s, y = t, z = s² t over [0, 2] x [0, 3]; then the numbers that mean nothing
    let mut c = [0.0; 192];
    (c[1], c[16 + 4], c[32 + 6]) = (1.0, 1.0, 1.0);
    let text: Vec<String> = c.iter().map(f64::to_string).collect();
    let f = face(&[e(&format!("114,3,1,1,1,0.,2.,0.,3.,{};", text.join(",")))]);
    lies_on(&f, |p| p.z - p.x * p.x * p.y);
    reaches(&f, v(2.0, 3.0, 12.0));
}

/// A plane of 10 x 10 mm with parameters 0 to 5 and 0 to 10.
const PLANE: &str =
    "128,1,1,1,1,0,0,1,0,0,0.,0.,5.,5.,0.,0.,10.,10.,1.,1.,1.,1.,0.,0.,7.,10.,0.,7.,0.,10.,7.,10.,10.,7.,0.,5.,0.,10.;";

/// Kept area in mm² of a face whose carrier has twice as many mm as parameters along u: the loops' doubled
/// areas are that already.
fn area(f: &crate::model::Face) -> f64 {
    f.loops.iter().map(crate::model::TrimLoop::signed_area).sum()
}

#[test]
fn a_hole_in_space_in_parameters_or_in_both() {
    let circle = "100,7.,5.,5.,8.,5.,8.,5.;"; // #3: radius 3 about the middle
    // the same in parameters: an ellipse of half width 1.5 and half height 3 about (2.5, 5)
    let ellipse = "104,4.,0.,1.,-20.,-10.,41.,0.,4.,5.,4.,5.;"; // #5
    let wanted = 100.0 - 9.0 * PI;
    for both in ["142,0,1,0,3,2;", "142,0,1,5,0,1;", "142,0,1,5,3,1;", "142,0,1,5,3,2;", "142,0,1,5,3,0;"] {
        let f = face(&[
            e(PLANE),
            Entity { status: "00010000", ..e(circle) },
            Entity { form: 1, status: "00010000", ..e(ellipse) },
            e(both),
            e("144,1,0,1,0,7;"),
        ]);
        assert_eq!(f.loops.len(), 2, "{both}");
        // the area is that of sixteen chords a curve, four curves or more to the circle
        assert!((area(&f) - wanted).abs() < 2e-2, "{both}: {}", area(&f));
    }
    // a curve in space that lies 0.5 mm above, or on the plane but elsewhere: the preferred one counts
    let (off, aside) = ("100,7.5,5.,5.,7.,5.,7.,5.;", "100,7.,5.5,5.,7.5,5.,7.5,5.;");
    let other = 100.0 - 4.0 * PI;
    let cases = [
        (off, "142,0,1,5,3,1;", wanted),
        (off, "142,0,1,0,3,1;", other),
        (aside, "142,0,1,5,3,1;", wanted),
        (aside, "142,0,1,5,3,2;", other),
    ];
    for (off, both, wanted) in cases {
        let i = import(&[
            e(PLANE),
            e(off),
            Entity { form: 1, status: "00010000", ..e(ellipse) },
            e(both),
            e("144,1,0,1,0,7;"),
        ]);
        let f = &i.model.parts[0].faces[0];
        assert!((area(f) - wanted).abs() < 2e-2, "{both}: {}", area(f));
    }
}

#[test]
fn a_preferred_curve_counts_where_the_other_leaves_the_surface() {
    // a micrometre above the plane: projected on it, it would be the same circle
    let circle = "100,7.001,5.,5.,8.,5.,8.,5.;";
    let ellipse = "104,4.,0.,1.,-20.,-10.,41.,0.,4.,5.,4.,5.;";
    for (both, parameters) in [("142,0,1,5,3,1;", true), ("142,0,1,5,3,2;", false)] {
        let i = import(&[
            e(PLANE),
            Entity { status: "00010000", ..e(circle) },
            Entity { form: 1, status: "00010000", ..e(ellipse) },
            e(both),
            e("144,1,0,1,0,7;"),
        ]);
        let record = &i.report.face_records[0];
        assert_eq!(record.gap < 1e-9, parameters, "{both}: {record:?}");
        assert_eq!(record.notes.iter().any(|n| n.contains("those in (u, v) are used")), parameters, "{record:?}");
    }
}

/// The spline's own parameters: nothing is fitted. A conic in them is four rational arcs.
#[test]
fn loops_in_parameters_are_exact() {
    let ellipse = "104,4.,0.,1.,-20.,-10.,41.,0.,4.,5.,4.,5.;";
    let i = import(&[
        e(PLANE),
        Entity { form: 1, status: "00010000", ..e(ellipse) },
        e("142,0,1,3,0,1;"),
        e("144,1,1,0,5;"),
    ]);
    let (f, record) = (&i.model.parts[0].faces[0], &i.report.face_records[0]);
    assert_eq!((record.deviation, f.loops.len(), f.loops[0].curves().len()), (0.0, 1, 4), "{record:?}");
    assert!(record.gap < 1e-14 && f.loops[0].curves().all(|c| c.degree() == 2), "{record:?}");
}

#[test]
fn a_bounded_surface() {
    // 141 in space, a triangle whose last side is stated backwards
    let sides = ["110,1.,1.,7.,9.,1.,7.;", "110,9.,1.,7.,9.,9.,7.;", "110,1.,1.,7.,9.,9.,7.;"];
    let all = [PLANE, sides[0], sides[1], sides[2], "141,0,1,1,3,3,1,0,5,1,0,7,2,0;", "143,0,1,1,9;"];
    assert!((area(&face(&all.map(e))) - 32.0).abs() < 1e-9);
}

/// Parameters of a cylinder are degrees and lengths; half of one, stated in parameters only.
#[test]
fn parameters_of_an_elementary_surface() {
    let mut all = Vec::from(["116,0.,0.,0.;", "123,0.,0.,1.;", "123,1.,0.,0.;", "192,1,3,2.,5;"].map(e));
    all[3].form = 1;
    let corners = [(0, 1), (180, 1), (180, 4), (0, 4), (0, 1)];
    for w in corners.windows(2) {
        all.push(e(&format!("110,{}.,{}.,0.,{}.,{}.,0.;", w[0].0, w[0].1, w[1].0, w[1].1)));
    }
    all.extend(["102,4,9,11,13,15;", "142,0,7,17,0,1;", "144,7,1,0,19;"].map(e));
    let f = face(&all);
    lies_on(&f, |p| p.x.hypot(p.y) - 2.0);
    assert!(points(&f).iter().all(|p| p.y > -1e-9 && p.z > 1.0 - 1e-9 && p.z < 4.0 + 1e-9));
    [v(2.0, 0.0, 1.0), v(-2.0, 0.0, 4.0), v(0.0, 2.0, 1.0)].into_iter().for_each(|p| reaches(&f, p));
}

#[test]
fn offset_surfaces() {
    let sphere = ["116,1.,0.,0.;", "196,1,2.;", "140,0.,0.,1.,0.5,3;"];
    let f = face(&sphere.map(e));
    lies_on(&f, |p| p.distance(DVec3::X) - 2.5);
    lies_on(&face(&[e(PLANE), e("140,0.,0.,1.,0.5,1;")]), |p| p.z - 7.5);
    lies_on(&face(&[e(PLANE), e("140,0.,0.,-1.,0.5,1;")]), |p| p.z - 6.5);
    // a quarter of a circle about the y-axis, half a millimetre outside: part of a torus
    let ring = ["110,0.,0.,0.,0.,1.,0.;", "100,0.,5.,0.,6.,0.,5.,1.;", "120,1,3,0.,2.;", "140,1.,0.,0.,0.5,5;"];
    let worst = |points: Vec<DVec3>| {
        points.iter().map(|p| (p.x.hypot(p.z) - 5.0).hypot(p.y) - 1.5).fold(0.0, |a: f64, d| a.max(d.abs()))
    };
    // the file's resolution
    let error = worst(points(&face(&ring.map(e))));
    assert!(error < 1e-6, "{error:e}");
    // two parts of a spline that meet at an angle have no offset
    let roof = "128,2,1,1,1,0,0,1,0,0,0.,0.,1.,2.,2.,0.,0.,1.,1.,1.,1.,1.,1.,1.,1.,0.,0.,0.,1.,0.,1.,2.,0.,0.,0.,1.,0.,1.,1.,1.,2.,1.,0.,0.,2.,0.,1.;";
    let i = import(&[e(roof), e("140,0.,0.,1.,0.5,1;")]);
    assert_eq!(i.report.dropped.total(), 1, "{:?}", i.warnings);
    assert!(i.warnings[0].to_string().ends_with("#3: face left out: #3: its offset is not smooth"), "{:?}", i.warnings);
    let [record] = &i.report.face_records[..] else { panic!("one record") };
    assert_eq!((record.id, record.kind, record.part), (3, None, 0));
    assert_eq!(record.notes, ["#3: its offset is not smooth"]);
}
