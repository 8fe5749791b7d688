//! Derived curves and surfaces, and surfaces without loops: against numbers worked out by hand.

use super::shapes::{curve, near, with};
use super::{import, wrap};
use crate::brep::{CurveGeometry, SurfaceGeometry};
use crate::import::step;
use crate::import::step::locate;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Mirrors y, then twice as large, then to (1, 2, 3); lengths are tenths, see [`with`].
const COPY: &str = "#110=CARTESIAN_TRANSFORMATION_OPERATOR_3D('',$,'',#111,#112,#1,2.,#113);#111=DIRECTION('',(1.,0.,0.));\
    #112=DIRECTION('',(0.,-1.,0.));#113=DIRECTION('',(0.,0.,1.));";

fn points(c: &CurveGeometry) -> [DVec3; 3] {
    let (a, b) = match c {
        CurveGeometry::Trimmed { start, end, .. } => (*start, *end),
        CurveGeometry::BSpline(s) => s.domain(),
        _ => (0.0, TAU),
    };
    [a, 0.5 * (a + b), b].map(|t| locate::point(c, t).unwrap())
}

#[test]
fn curve_replicas_keep_parameters() {
    for basis in [
        "#100=CURVE_REPLICA('',#101,#110);#101=CIRCLE('',#8,1.5);",
        "#100=CURVE_REPLICA('',#101,#110);#101=ELLIPSE('',#8,1.5,1.);",
        "#100=CURVE_REPLICA('',#101,#110);#101=POLYLINE('',(#4,#5,#10));",
        "#100=CURVE_REPLICA('',#101,#110);#101=TRIMMED_CURVE('',#102,(PARAMETER_VALUE(0.5)),(PARAMETER_VALUE(2.)),.T.,.PARAMETER.);#102=LINE('',#5,#9);",
        "#100=CURVE_REPLICA('',#101,#110);#101=TRIMMED_CURVE('',#102,(PARAMETER_VALUE(0.5)),(PARAMETER_VALUE(2.)),.T.,.PARAMETER.);#102=PARABOLA('',#8,1.);",
        "#100=CURVE_REPLICA('',#101,#110);#101=TRIMMED_CURVE('',#102,(PARAMETER_VALUE(0.5)),(PARAMETER_VALUE(2.)),.T.,.PARAMETER.);#102=HYPERBOLA('',#8,1.,2.);",
    ] {
        let data = format!("{COPY}{basis}");
        let parent = points(&with(&data, |g| g.curve(101)).unwrap());
        let copy = points(&curve(&data));
        for (p, q) in parent.into_iter().zip(copy) {
            let expected = DVec3::new(10.0 + 2.0 * p.x, 20.0 - 2.0 * p.y, 30.0 + 2.0 * p.z);
            assert!((q - expected).length() < 1e-10, "{basis}: {q} {expected}");
        }
    }
}

#[test]
fn surface_replicas_know_that_a_mirror_turns_them() {
    let copy = |surface: &str| {
        let data = format!("{COPY}#100=SURFACE_REPLICA('',#101,#110);#101={surface};#102=AXIS1_PLACEMENT('',#4,#113);");
        with(&data, |g| g.surface(100)).unwrap()
    };
    let tube = copy("CYLINDRICAL_SURFACE('',#8,1.5)");
    let SurfaceGeometry::Cylinder { frame, radius } = tube.surface else { panic!() };
    assert!(tube.flipped && (radius - 30.0).abs() < 1e-12 && near(frame.z, DVec3::Z) && near(frame.y, DVec3::Y));
    let plane = copy("PLANE('',#8)");
    let SurfaceGeometry::Plane { frame } = plane.surface else { panic!() };
    assert!(!plane.flipped && near(frame.z, -DVec3::Z) && near(frame.y, -DVec3::Y));
    let ball = copy("SPHERICAL_SURFACE('',#8,1.)");
    assert!(
        ball.flipped && matches!(ball.surface, SurfaceGeometry::Sphere { radius, .. } if (radius - 20.0).abs() < 1e-12)
    );
    let swept = copy("SURFACE_OF_LINEAR_EXTRUSION('',#11,#9)");
    assert!(
        !swept.flipped
            && matches!(swept.surface, SurfaceGeometry::Extrusion { direction, .. } if near(direction, DVec3::Y * -40.0))
    );
    let turned = copy("SURFACE_OF_REVOLUTION('',#12,#102)");
    assert!(
        turned.flipped && matches!(turned.surface, SurfaceGeometry::Revolution { axis, .. } if near(axis, DVec3::Z))
    );
    let cut = copy("RECTANGULAR_TRIMMED_SURFACE('',#103,10.,20.,1.,2.,.T.,.T.);#103=CYLINDRICAL_SURFACE('',#8,1.5)");
    let SurfaceGeometry::Window { u, v, .. } = cut.surface else { panic!() };
    assert!((u.0 + 20f64.to_radians()).abs() < 1e-14 && v == (20.0, 40.0), "{u:?} {v:?}");
}

#[test]
fn curves_given_on_a_surface_alone() {
    let on = |surface: &str, flat: &str| {
        format!(
            "#101=PCURVE('',#102,#103);#102={surface};#103=DEFINITIONAL_REPRESENTATION('',(#104),$);{flat}#100=SURFACE_CURVE('',$,(#101),.PCURVE_S1.);"
        )
    };
    let line = "#104=TRIMMED_CURVE('',#105,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(2.)),.T.,.PARAMETER.);#105=LINE('',#106,#107);\
        #106=CARTESIAN_POINT('',(30.,1.));#107=VECTOR('',#108,30.);#108=DIRECTION('',(1.,0.));";
    // from 30 to 90 degrees at height 10 mm around y
    let arc = curve(&on("CYLINDRICAL_SURFACE('',#7,2.)", line));
    let centre = DVec3::new(10.0, 30.0, 30.0);
    for (found, angle) in points(&arc).into_iter().zip([30f64, 60.0, 90.0]) {
        let expected = centre + (DVec3::Z * angle.to_radians().cos() + DVec3::X * angle.to_radians().sin()) * 20.0;
        assert!((found - expected).length() < 1e-6, "{found} {expected}");
    }
    let circle = "#104=CIRCLE('',#105,0.5);#105=AXIS2_PLACEMENT_2D('',#106,$);#106=CARTESIAN_POINT('',(1.,2.));";
    let flat = curve(&on("PLANE('',#8)", circle));
    assert!(
        matches!(flat, CurveGeometry::Circle { frame, radius } if near(frame.origin, DVec3::new(10.0, 20.0, 0.0)) && radius == 5.0)
    );
    let endless = on(
        "CYLINDRICAL_SURFACE('',#7,2.)",
        "#104=LINE('',#106,#107);#106=CARTESIAN_POINT('',(30.,1.));#107=VECTOR('',#108,30.);#108=DIRECTION('',(1.,0.));",
    );
    assert_eq!(with(&endless, |g| g.curve(100)).unwrap_err().to_string(), "#101: its curve in (u, v) has no ends");
}

#[test]
fn offsets() {
    let inner = curve("#100=OFFSET_CURVE_3D('',#11,0.5,.F.,#101);#101=DIRECTION('',(0.,0.,1.));");
    assert!(points(&inner).iter().all(|p| (p.length() - 5.0).abs() < 1e-6));
    let spline = "#100=OFFSET_SURFACE('',#101,0.5,.F.);#101=BEZIER_SURFACE('',1,1,((#4,#6),(#5,#10)),.U.,.F.,.F.,.F.);";
    let SurfaceGeometry::BSpline(s) = with(spline, |g| g.surface(100)).unwrap().surface else { panic!() };
    assert!((s.patches().point(0.3, 0.8) - DVec3::new(3.0, 8.0, 5.0)).length() < 1e-9);
}

#[test]
fn windows_in_the_files_units() {
    let cut = |basis: &str, ranges: &str| {
        let data = format!("#100=RECTANGULAR_TRIMMED_SURFACE('',#101,{ranges});#101={basis};");
        match with(&data, |g| g.surface(100)).unwrap().surface {
            SurfaceGeometry::Window { u, v, .. } => (u, v),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(cut("PLANE('',#8)", "1.,2.,3.,4.,.T.,.T."), ((10.0, 20.0), (30.0, 40.0)));
    assert_eq!(cut("PLANE('',#8)", "2.,1.,3.,4.,.F.,.T."), ((10.0, 20.0), (30.0, 40.0)));
    let (u, v) = cut("CYLINDRICAL_SURFACE('',#8,1.)", "270.,90.,0.,1.,.T.,.T.");
    assert!((u.0 - 3.0 * FRAC_PI_2).abs() < 1e-14 && (u.1 - 5.0 * FRAC_PI_2).abs() < 1e-14 && v == (0.0, 10.0));
    assert_eq!(cut("SURFACE_OF_LINEAR_EXTRUSION('',#12,#9)", "1.,2.,3.,4.,.T.,.T."), ((1.0, 2.0), (3.0, 4.0)));
}

/// The inner part of a degenerate torus, in both spellings.
#[test]
fn lemons_and_apples() {
    for (entity, lemon) in [
        ("DEGENERATE_TOROIDAL_SURFACE('',#8,1.,2.,.F.)", true),
        ("DEGENERATE_TOROIDAL_SURFACE('',#8,1.,2.,.T.)", false),
        ("(DEGENERATE_TOROIDAL_SURFACE(.F.) ELEMENTARY_SURFACE(#8) TOROIDAL_SURFACE(1.,2.) SURFACE())", true),
        ("(DEGENERATE_TOROIDAL_SURFACE(.T.) ELEMENTARY_SURFACE(#8) TOROIDAL_SURFACE(1.,2.) SURFACE())", false),
    ] {
        let surface = with(&format!("#100={entity};"), |g| g.surface(100)).unwrap().surface;
        let turned = matches!(surface, SurfaceGeometry::Revolution { .. });
        assert_eq!(turned, lemon, "{entity}");
    }
    // drawn whole: the lemon reaches sqrt(3) up and 1 out, the apple 2 up and 3 out
    for (outer, width, height) in [(".F.", 1.0, 3f64.sqrt()), (".T.", 3.0, 2.0)] {
        let found = import(&format!(
            "#4=CARTESIAN_POINT('',(0,0,0));#8=AXIS2_PLACEMENT_3D('',#4,$,$);#100=DEGENERATE_TOROIDAL_SURFACE('',#8,1.,2.,{outer});\
            #101=GEOMETRIC_SET('',(#100));#102=SHAPE_REPRESENTATION('',(#101),#103);#103=(GEOMETRIC_REPRESENTATION_CONTEXT(3) REPRESENTATION_CONTEXT('',''));"
        ));
        assert!(found.warnings.is_empty(), "{:?}", found.warnings);
        let face = &found.model.parts[0].faces[0];
        let grid = face.surface.patches();
        let ((u0, u1), (v0, v1)) = face.surface.domain();
        let samples = (0..=64).flat_map(|i| (0..=64).map(move |j| (f64::from(i) / 64.0, f64::from(j) / 64.0)));
        let points: Vec<DVec3> = samples.map(|(x, y)| grid.point(u0 + (u1 - u0) * x, v0 + (v1 - v0) * y)).collect();
        let out = points.iter().map(|p| p.x.hypot(p.y)).fold(0.0, f64::max);
        let up = points.iter().map(|p| p.z).fold(0.0, f64::max);
        // 64 steps around half a circle: the top is met to 2 (1 - cos(pi / 64))
        assert!((out - width).abs() < 3e-3 && (up - height).abs() < 3e-3, "{outer}: {out} {up}");
    }
}

/// Radii below 0: the points and the normal of the formula.
#[test]
fn negative_radii_mean_what_the_formula_says() {
    let surface = |entity: &str| {
        let carrier = with(&format!("#100={entity};"), |g| g.surface(100)).unwrap();
        (carrier.surface, carrier.flipped)
    };
    // the frame #8 is that of space; lengths are tenths
    let (SurfaceGeometry::Cylinder { frame, radius }, false) = surface("CYLINDRICAL_SURFACE('',#8,-1.5)") else {
        panic!()
    };
    assert!(radius == 15.0 && near(frame.x, -DVec3::X) && near(frame.y, -DVec3::Y) && near(frame.z, DVec3::Z));
    let (SurfaceGeometry::Sphere { frame, radius }, true) = surface("SPHERICAL_SURFACE('',#8,-1.5)") else { panic!() };
    assert!(radius == 15.0 && near(frame.x.cross(frame.y), frame.z) && near(frame.z, -DVec3::Z));
    let (SurfaceGeometry::Cone { frame, radius, half_angle }, false) = surface("CONICAL_SURFACE('',#8,-1.,30.)") else {
        panic!()
    };
    assert!(radius == 10.0 && near(frame.x, -DVec3::X) && (half_angle + 30f64.to_radians()).abs() < 1e-15);
    let ring = surface("TOROIDAL_SURFACE('',#8,-2.,1.)");
    assert!(matches!(ring, (SurfaceGeometry::Torus { major: 20.0, minor: 10.0, .. }, true)), "{ring:?}");
    let tube = surface("TOROIDAL_SURFACE('',#8,2.,-1.)");
    assert!(matches!(tube, (SurfaceGeometry::Torus { major: 20.0, minor: 10.0, .. }, false)), "{tube:?}");
    let lemon = surface("TOROIDAL_SURFACE('',#8,-1.,2.)");
    assert!(matches!(lemon, (SurfaceGeometry::Revolution { .. }, true)), "{lemon:?}");
    let apple = surface("DEGENERATE_TOROIDAL_SURFACE('',#8,-1.,2.,.T.)");
    assert!(matches!(apple, (SurfaceGeometry::Torus { .. }, true)), "{apple:?}");
    for entity in [
        "CYLINDRICAL_SURFACE('',#8,0.)",
        "SPHERICAL_SURFACE('',#8,0.)",
        "TOROIDAL_SURFACE('',#8,0.,1.)",
        "TOROIDAL_SURFACE('',#8,1.,0.)",
    ] {
        let fault = with(&format!("#100={entity};"), |g| g.surface(100)).unwrap_err().to_string();
        assert!(fault.ends_with("is not a length other than 0"), "{entity}: {fault}");
    }
    // curves: the same points at the same parameters
    for (entity, at) in [
        ("CIRCLE('',#8,-1.5)", |t: f64| DVec3::new(-15.0 * t.cos(), -15.0 * t.sin(), 0.0)),
        ("ELLIPSE('',#8,-1.5,1.)", |t: f64| DVec3::new(-15.0 * t.cos(), 10.0 * t.sin(), 0.0)),
        ("ELLIPSE('',#8,1.5,-1.)", |t: f64| DVec3::new(15.0 * t.cos(), -10.0 * t.sin(), 0.0)),
        ("PARABOLA('',#8,-1.)", |t: f64| DVec3::new(-10.0 * t * t, -20.0 * t, 0.0)),
        ("HYPERBOLA('',#8,-1.,2.)", |t: f64| DVec3::new(-10.0 * t.cosh(), 20.0 * t.sinh(), 0.0)),
    ] as [(&str, fn(f64) -> DVec3); 5]
    {
        let found = curve(&format!("#100={entity};"));
        for t in [0.0, 0.5, 2.0] {
            let point = locate::point(&found, t).unwrap();
            assert!((point - at(t)).length() < 1e-12 * at(t).length().max(1.0), "{entity} at {t}: {point}");
        }
    }
}

/// A lemon of a torus with R = -4, r = 10: sqrt(10² - 4²) up and down, 6 out, its normal outwards.
#[test]
fn a_torus_with_a_negative_major_radius_is_a_lemon() {
    let found = step(include_bytes!("cases/negative_major_radius.stp"), "case.stp").unwrap();
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    let [face] = &found.model.parts[0].faces[..] else { panic!() };
    let grid = face.surface.patches();
    let ((u0, u1), (v0, v1)) = face.surface.domain();
    let (mut out, mut up) = (0f64, 0f64);
    let at = |i: f64, j: f64| grid.point(u0 + (u1 - u0) * i / 64.0, v0 + (v1 - v0) * j / 64.0);
    for (i, j) in (1..64).flat_map(|i| (1..64).map(move |j| (f64::from(i), f64::from(j)))) {
        let p = at(i, j);
        let (rho, h) = (p.x.hypot(p.y), 1e-3);
        assert!(((rho + 4.0).hypot(p.z) - 10.0).abs() < 1e-9, "{p}");
        let normal = (at(i + h, j) - at(i - h, j)).cross(at(i, j + h) - at(i, j - h));
        assert!(normal.dot(p) * if face.same_sense { 1.0 } else { -1.0 } > 0.0, "the normal at {p}");
        (out, up) = (out.max(rho), up.max(p.z));
    }
    // steps of a 64th of the arc: its ends are not among the points
    assert!((out - 6.0).abs() < 5e-3 && up > 8.5 && up < 84f64.sqrt(), "{out} {up}");
}

/// SEAM_EDGE and SUBEDGE stand where an oriented edge and an edge may; without an edge they cost the face.
#[test]
fn seam_edges_and_parts_of_edges() {
    let good = super::damage::GOOD;
    let loops = good.lines().find(|line| line.contains("#51=")).unwrap();
    assert!(loops.contains("#51=ORIENTED_EDGE('',*,*,#"), "{loops}");
    let (edge, _) = loops.split_once("*,*,#").unwrap().1.split_once(',').unwrap();
    let seam = loops.replace("ORIENTED_EDGE", "SEAM_EDGE").replace(");", ",#990);");
    let found = step(good.replace(loops, &seam).as_bytes(), "good.step").unwrap();
    assert_eq!((found.model.face_count(), found.warnings.len()), (3, 0), "{:?}", found.warnings);
    let lost = step(good.replace(loops, &seam.replace(&format!("#{edge}"), "$")).as_bytes(), "good.step").unwrap();
    assert!(
        lost.model.face_count() < 3 && lost.warnings[0].message.contains("#51: attribute 1 is not a reference"),
        "{:?}",
        lost.warnings
    );
    // an edge as the whole of another one
    let whole = good.lines().find(|line| line.starts_with(&format!("#{edge}=EDGE_CURVE"))).unwrap();
    let ends = whole.split_once("('',").unwrap().1.split(',').take(2).collect::<Vec<_>>().join(",");
    let part = whole.replace(&format!("#{edge}="), "#991=") + &format!("\n#{edge}=SUBEDGE('',{ends},#991);");
    let found = step(good.replace(whole, &part).as_bytes(), "good.step").unwrap();
    assert_eq!((found.model.face_count(), found.warnings.len()), (3, 0), "{:?}", found.warnings);
}

const SQUARE: &str = "#1=(GEOMETRIC_REPRESENTATION_CONTEXT(3) REPRESENTATION_CONTEXT('',''));#11=CARTESIAN_POINT('',(0.,0.,0.));\
    #12=CARTESIAN_POINT('',(4.,0.,0.));#13=CARTESIAN_POINT('',(0.,4.,0.));#14=CARTESIAN_POINT('',(4.,4.,0.));\
    #15=CARTESIAN_POINT('',(2.,2.,0.));#16=AXIS2_PLACEMENT_3D('',#15,$,$);#17=CIRCLE('',#16,1.);\
    #20=BEZIER_SURFACE('',1,1,((#11,#13),(#12,#14)),.U.,.F.,.F.,.F.);#30=GEOMETRIC_SET('',(#21));#31=SHAPE_REPRESENTATION('',(#30),#1);";

#[test]
fn an_implicit_outer_border_makes_curves_holes() {
    let boundary = "#22=BOUNDARY_CURVE('',(#23),.F.);#23=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#17);";
    for (implicit, loops) in [(".T.", 2), (".F.", 1)] {
        let found = import(&format!("{SQUARE}{boundary}#21=CURVE_BOUNDED_SURFACE('',#20,(#22),{implicit});"));
        assert!(found.warnings.is_empty(), "{:?}", found.warnings);
        let face = &found.model.parts[0].faces[0];
        assert_eq!(face.loops.len(), loops);
        // in the unit square: the hole has a sixteenth of pi
        let area: f64 = face.loops.iter().map(|l| 0.5 * l.signed_area()).sum();
        let hole = std::f64::consts::PI / 16.0;
        let expected = if implicit == ".T." { 1.0 - hole } else { hole };
        // signed_area steps along chords
        assert!((area - expected).abs() < 1e-3, "{implicit}: {area}");
    }
}

/// Three quarter circles on a sphere of radius 2, either way around: writers do not mean the other seven eighths.
#[test]
fn curves_that_bound_a_sphere_bound_the_smaller_part() {
    let arc = |id: u32, z: u32, x: u32| {
        format!(
            "#{id}=TRIMMED_CURVE('',#{},(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(1.5707963267948966)),.T.,.PARAMETER.);\
             #{}=CIRCLE('',#{},2.);#{}=AXIS2_PLACEMENT_3D('',#11,#{z},#{x});",
            id + 1,
            id + 1,
            id + 2,
            id + 2
        )
    };
    let shape = "#1=(GEOMETRIC_REPRESENTATION_CONTEXT(3) REPRESENTATION_CONTEXT('',''));#11=CARTESIAN_POINT('',(0.,0.,0.));\
        #12=DIRECTION('',(1.,0.,0.));#13=DIRECTION('',(0.,1.,0.));#14=DIRECTION('',(0.,0.,1.));\
        #20=SPHERICAL_SURFACE('',#42,2.);#30=GEOMETRIC_SET('',(#21));#31=SHAPE_REPRESENTATION('',(#30),#1);";
    let arcs = [arc(40, 14, 12), arc(43, 12, 13), arc(46, 13, 14)].concat();
    for (kind, sense, order, told) in [
        ("BOUNDARY_CURVE", ".T.", "#51,#52,#53", 0),
        ("BOUNDARY_CURVE", ".F.", "#53,#52,#51", 1),
        ("OUTER_BOUNDARY_CURVE", ".T.", "#51,#52,#53", 0),
        ("OUTER_BOUNDARY_CURVE", ".F.", "#53,#52,#51", 1),
    ] {
        let segment = |id: u32, arc: u32| format!("#{id}=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,{sense},#{arc});");
        let segments = [segment(51, 40), segment(52, 43), segment(53, 46)].concat();
        let border = format!("#22={kind}('',({order}),.F.);#21=CURVE_BOUNDED_SURFACE('',#20,(#22),.F.);");
        let found = import(&[shape, &arcs, &segments, &border].concat());
        let bounds = found.model.bounds();
        assert!(bounds.min.abs().max_element() < 1e-9, "{kind} {sense}: {bounds:?}");
        let warned = found.warnings.iter().filter(|w| w.message.contains("the smaller one is taken")).count();
        assert_eq!((warned, found.warnings.len()), (told, told), "{kind} {sense}: {:?}", found.warnings);
    }
}

#[test]
fn splines_that_break() {
    let part = "#40=CARTESIAN_POINT('',(6.,0.,0.));#41=CARTESIAN_POINT('',(9.,0.,0.));#42=CARTESIAN_POINT('',(6.,4.,0.));#43=CARTESIAN_POINT('',(9.,4.,0.));";
    let torn = |middle: &str| {
        import(&format!(
            "{SQUARE}{part}#21=B_SPLINE_SURFACE_WITH_KNOTS('',1,1,((#11,#13),(#12,#14),{middle},(#41,#43)),.U.,.F.,.F.,.F.,(2,2,2),(2,2),(0.,1.,2.),(0.,1.),.U.);"
        ))
    };
    let (two, one) = (torn("(#40,#42)"), torn("(#12,#14)"));
    let told = |found: &crate::import::Import| found.warnings.iter().map(ToString::to_string).collect::<Vec<_>>();
    assert_eq!(told(&two), ["t.step:8: #21: torn spline: cut into 2 parts where it breaks"]);
    assert_eq!(told(&one), ["t.step:8: #21: torn spline: joined over a gap of 0.0e0 mm"]);
    assert_eq!((two.model.face_count(), one.model.face_count()), (2, 1));
    let curve = |middle: &str| {
        let data =
            format!("#100=B_SPLINE_CURVE_WITH_KNOTS('',1,(#4,#5,{middle},#6),.U.,.F.,.F.,(2,2,2),(0.,1.,2.),.U.);");
        with(&data, |g| g.curve(100)).unwrap()
    };
    assert!(matches!(curve("#10"), CurveGeometry::Composite(parts) if parts.len() == 2));
    assert!(matches!(curve("#5"), CurveGeometry::BSpline(s) if s.points().len() == 3));
}

/// Half a circle of two quarters whose weights differ at their joint, and a cylinder over it: both are round.
#[test]
fn rational_pieces_of_other_weights_are_joined() {
    let corner = 0.5f64.sqrt();
    let points = "#40=CARTESIAN_POINT('',(1.,0.,0.));#41=CARTESIAN_POINT('',(1.,1.,0.));#42=CARTESIAN_POINT('',(0.,1.,0.));\
        #43=CARTESIAN_POINT('',(-1.,1.,0.));#44=CARTESIAN_POINT('',(-1.,0.,0.));#50=CARTESIAN_POINT('',(1.,0.,4.));\
        #51=CARTESIAN_POINT('',(1.,1.,4.));#52=CARTESIAN_POINT('',(0.,1.,4.));#53=CARTESIAN_POINT('',(-1.,1.,4.));\
        #54=CARTESIAN_POINT('',(-1.,0.,4.));";
    let weights = [1.0, corner, 1.0, 3.0, 3.0 * corner, 3.0].map(|w| format!("{w:?}"));
    let curve = format!(
        "{points}#100=(BOUNDED_CURVE() B_SPLINE_CURVE(2,(#40,#41,#42,#42,#43,#44),.U.,.F.,.F.)\
         B_SPLINE_CURVE_WITH_KNOTS((3,3,3),(0.,1.,2.),.U.) CURVE() GEOMETRIC_REPRESENTATION_ITEM()\
         RATIONAL_B_SPLINE_CURVE(({})) REPRESENTATION_ITEM(''));",
        weights.join(",")
    );
    let CurveGeometry::BSpline(curve) = with(&curve, |g| g.curve(100)).unwrap() else { panic!("one spline") };
    let round = |p: DVec3, radius: f64| (p.truncate().length() - radius).abs() < 1e-14 * radius;
    assert!((0..=40).all(|k| round(curve.point(f64::from(k) / 20.0), 10.0)));

    let pairs: Vec<String> = [40, 41, 42, 42, 43, 44].iter().map(|i| format!("(#{i},#{})", i + 10)).collect();
    let rows: Vec<String> = weights.iter().map(|w| format!("({w},{w})")).collect();
    let found = import(&format!(
        "{SQUARE}{points}#21=(BOUNDED_SURFACE() B_SPLINE_SURFACE(2,1,({}),.U.,.F.,.F.,.F.)\
         B_SPLINE_SURFACE_WITH_KNOTS((3,3,3),(2,2),(0.,1.,2.),(0.,1.),.U.) GEOMETRIC_REPRESENTATION_ITEM()\
         RATIONAL_B_SPLINE_SURFACE(({})) REPRESENTATION_ITEM('') SURFACE());",
        pairs.join(","),
        rows.join(",")
    ));
    assert_eq!(found.model.face_count(), 1, "{:?}", found.warnings);
    let grid = found.model.parts[0].faces[0].surface.patches();
    assert!((0..=40).all(|k| round(grid.point(f64::from(k) / 20.0, 0.5), 1.0)));
}

/// A square whose edges are listed in any order.
#[test]
fn edges_of_a_loop_in_any_order() {
    // start and end vertex, the start's coordinates, the direction
    let side = |i: u32, (a, b): (u32, u32), (x, y): (i32, i32), (dx, dy): (i32, i32)| {
        let [line, point, vector, direction, oriented] = [1, 2, 3, 4, 5].map(|k| i + k);
        format!(
            "#{i}=EDGE_CURVE('',#{a},#{b},#{line},.T.);#{line}=LINE('',#{point},#{vector});\
             #{point}=CARTESIAN_POINT('',({x}.,{y}.,0.));#{vector}=VECTOR('',#{direction},1.);\
             #{direction}=DIRECTION('',({dx}.,{dy}.,0.));#{oriented}=ORIENTED_EDGE('',*,*,#{i},.T.);"
        )
    };
    let lines = [
        side(100, (51, 52), (0, 0), (1, 0)),
        side(110, (52, 54), (4, 0), (0, 1)),
        side(120, (54, 53), (4, 4), (-1, 0)),
        side(130, (53, 51), (0, 4), (0, -1)),
    ];
    let vertices =
        "#51=VERTEX_POINT('',#11);#52=VERTEX_POINT('',#12);#53=VERTEX_POINT('',#13);#54=VERTEX_POINT('',#14);";
    for order in ["#105,#115,#125,#135", "#105,#125,#115,#135", "#125,#105,#135,#115"] {
        let data = format!(
            "{SQUARE}{vertices}{}#60=EDGE_LOOP('',({order}));#61=FACE_OUTER_BOUND('',#60,.T.);#21=ADVANCED_FACE('',(#61),#62,.T.);#62=PLANE('',#16);\
            #63=OPEN_SHELL('',(#21));#64=SHELL_BASED_SURFACE_MODEL('',(#63));#65=SHAPE_REPRESENTATION('',(#64),#1);",
            lines.concat()
        );
        let found = step(wrap(&data).as_bytes(), "t.step").unwrap();
        let face = &found.model.parts.iter().find(|p| !p.faces.is_empty()).unwrap().faces[0];
        let area: f64 = face.loops.iter().map(|l| 0.5 * l.signed_area()).sum();
        assert!((area - 16.0).abs() < 1e-9, "{order}: {area}");
        let sorted = order != "#105,#115,#125,#135";
        assert_eq!(
            found.report.repaired.iter().any(|(what, _)| what == "the edges of a loop were put in order"),
            sorted,
            "{:?}",
            found.report.repaired
        );
        assert_eq!(found.warnings.iter().any(|w| w.message.contains("put in order")), sorted);
    }
}
