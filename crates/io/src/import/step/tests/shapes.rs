//! Single curves, surfaces and faces, against numbers worked out by hand.

use super::wrap;
use crate::brep::{Boundary, CurveGeometry, SurfaceGeometry};
use crate::import::Warnings;
use crate::import::step::face::EdgeTable;
use crate::import::step::geometry::{Geometry, Ledger};
use crate::import::step::locate;
use crate::import::step::part21::File;
use crate::import::step::units::Units;
use glam::DVec3;
use std::f64::consts::TAU;

/// Frames and points that the snippets share: `#7` stands at (1, 2, 3), axis y, reference z.
const BASE: &str = "#1=CARTESIAN_POINT('',(1.,2.,3));#2=DIRECTION('',(0.,5.,0.));#3=DIRECTION('',(0.,1.,1.));\
    #4=CARTESIAN_POINT('',(0,0,0));#5=CARTESIAN_POINT('',(1.,0.,0.));#6=CARTESIAN_POINT('',(0.,1.,0.));\
    #7=AXIS2_PLACEMENT_3D('',#1,#2,#3);#8=AXIS2_PLACEMENT_3D('',#4,$,$);#9=VECTOR('',#2,2.);\
    #10=CARTESIAN_POINT('',(1.,1.,0.));#11=CIRCLE('',#8,1.);#12=LINE('',#4,#9);#13=AXIS1_PLACEMENT('',#4,#2);";

/// Runs `f` on a file of [`BASE`] and `data`, in units of 10 mm and degrees.
pub(super) fn with<T>(data: &str, f: impl FnOnce(Geometry<'_>) -> T) -> T {
    let text = wrap(&format!("{BASE}{data}"));
    let mut warnings = Warnings::new("t");
    let file = File::parse(text.as_bytes(), "t", &mut warnings).unwrap();
    let units = Units { length: 10.0, angle: 1f64.to_radians(), ..Units::default() };
    let ledger = Ledger::new(&file, warnings);
    f(Geometry { file: &file, units: &units, ledger: &ledger })
}

pub(super) fn curve(data: &str) -> CurveGeometry {
    with(data, |g| g.curve(100)).unwrap()
}

fn fault(data: &str) -> String {
    with(data, |g| g.curve(100)).unwrap_err().to_string()
}

pub(super) fn near(a: DVec3, b: DVec3) -> bool {
    (a - b).length() < 1e-12
}

#[test]
fn frames_are_orthonormal() {
    let frame = with("", |g| g.frame(7)).unwrap();
    assert_eq!((frame.origin, frame.z), (DVec3::new(10.0, 20.0, 30.0), DVec3::Y));
    // the reference (0, 1, 1) loses its part along y
    assert!(near(frame.x, DVec3::Z) && near(frame.y, DVec3::X), "{frame:?}");
    let default = with("", |g| g.frame(8)).unwrap();
    assert_eq!((default.x, default.y, default.z), (DVec3::X, DVec3::Y, DVec3::Z));
    let along_x = with("#100=DIRECTION('',(2.,0.,0.));#101=AXIS2_PLACEMENT_3D('',#4,#100,#100);", |g| g.frame(101));
    assert!(near(along_x.unwrap().x, DVec3::Y));
}

#[test]
fn lines_and_conics() {
    let line = curve("#100=LINE('',#1,#9);");
    assert_eq!(
        line,
        CurveGeometry::Line { origin: DVec3::new(10.0, 20.0, 30.0), direction: DVec3::new(0.0, 20.0, 0.0) }
    );
    assert!(matches!(curve("#100=ELLIPSE('',#7,2.,1.);"), CurveGeometry::Ellipse { semi_x: 20.0, semi_y: 10.0, .. }));
    assert!(matches!(curve("#100=PARABOLA('',#7,2.);"), CurveGeometry::Parabola { focal: 20.0, .. }));
    assert!(matches!(curve("#100=HYPERBOLA('',#7,2.,3.);"), CurveGeometry::Hyperbola { semi_y: 30.0, .. }));
    let complex = curve("#100=(BOUNDED_CURVE() CIRCLE(2.) CONIC(#7) CURVE() REPRESENTATION_ITEM(''));");
    assert!(matches!(complex, CurveGeometry::Circle { radius: 20.0, .. }));
}

#[test]
fn trims_of_a_circle_in_degrees() {
    let trim = |first: &str, last: &str, sense: &str, master: &str| {
        curve(&format!("#100=TRIMMED_CURVE('',#11,({first}),({last}),{sense},{master});"))
    };
    // start, middle and end, by their angles in degrees
    let check = |c: &CurveGeometry, a: f64, b: f64| match c {
        CurveGeometry::Trimmed { start, end, forward: true, .. } if start < end => {
            for (t, degrees) in [(*start, a), ((start + end) * 0.5, (a + b) * 0.5), (*end, b)] {
                let (y, x) = degrees.to_radians().sin_cos();
                let found = locate::point(c, t).unwrap();
                assert!((found - DVec3::new(x, y, 0.0) * 10.0).length() < 1e-12, "{c:?} at {degrees}: {found}");
            }
        }
        _ => panic!("{c:?}"),
    };
    let p = |degrees: i32| format!("PARAMETER_VALUE({degrees}.)");
    check(&trim(&p(0), &p(90), ".T.", ".PARAMETER."), 0.0, 90.0);
    check(&trim(&p(90), &p(0), ".T.", ".PARAMETER."), 90.0, 360.0);
    check(&trim(&p(90), &p(0), ".F.", ".PARAMETER."), 90.0, 0.0);
    check(&trim(&p(0), &p(90), ".F.", ".PARAMETER."), 360.0, 90.0);
    check(&trim(&p(10), &p(370), ".T.", ".PARAMETER."), 10.0, 370.0);
    // points win when the master is cartesian, and serve when there is no parameter
    check(&trim(&format!("#5,{}", p(45)), &format!("#6,{}", p(45)), ".T.", ".CARTESIAN."), 0.0, 90.0);
    check(&trim("#5", "#6", ".T.", ".PARAMETER."), 0.0, 90.0);
    let (a, b) = locate::ends(&trim(&p(90), &p(0), ".F.", ".PARAMETER.")).unwrap();
    assert!(near(a, DVec3::Y * 10.0) && near(b, DVec3::X * 10.0));
}

#[test]
fn trims_of_open_curves_run_from_first_to_last() {
    for sense in [".T.", ".F."] {
        let c = curve(&format!(
            "#100=TRIMMED_CURVE('',#12,(PARAMETER_VALUE(3.)),(PARAMETER_VALUE(1.)),{sense},.PARAMETER.);"
        ));
        assert!(matches!(c, CurveGeometry::Trimmed { start: -3.0, end: -1.0, forward: true, .. }), "{c:?}");
        // (0, 20, 0) mm a unit of parameter, downwards from 3 to 1
        assert_eq!(locate::ends(&c), Some((DVec3::Y * 60.0, DVec3::Y * 20.0)));
    }
    assert!(
        fault("#100=TRIMMED_CURVE('',#12,(#4),(#4),.T.,.CARTESIAN.);")
            .contains("#100: the trimmed curve has no length")
    );
}

/// A closed spline (a diamond) trimmed over its seam, upwards and downwards, and composites run backwards.
#[test]
fn closed_splines_and_composites() {
    let diamond = "#110=CARTESIAN_POINT('',(-1.,0.,0.));#111=CARTESIAN_POINT('',(0.,-1.,0.));#112=POLYLINE('',(#5,#6,#110,#111,#5));";
    let trim = |first: f64, last: f64, sense: &str| {
        curve(&format!(
            "{diamond}#100=TRIMMED_CURVE('',#112,(PARAMETER_VALUE({first:?})),(PARAMETER_VALUE({last:?})),{sense},.PARAMETER.);"
        ))
    };
    let parts = |c: &CurveGeometry| if let CurveGeometry::Composite(parts) = c { parts.len() } else { 1 };
    let (x, y) = (DVec3::X * 10.0, DVec3::Y * 10.0);
    for (first, last, sense, count, ends) in [
        (0.0, 1.0, ".T.", 1, (x, y)),
        (1.0, 0.0, ".F.", 1, (y, x)),
        (3.0, 1.0, ".T.", 2, (-y, y)),
        (1.0, 3.0, ".F.", 2, (y, -y)),
        (3.0, 0.0, ".T.", 1, (-y, x)),
    ] {
        let c = trim(first, last, sense);
        let (a, b) = locate::ends(&c).unwrap();
        assert!(parts(&c) == count && near(a, ends.0) && near(b, ends.1), "{first} {last} {sense}: {c:?}");
    }
    let composite = "#101=TRIMMED_CURVE('',#11,(#5),(#6),.T.,.CARTESIAN.);#102=POLYLINE('',(#4,#6));\
        #103=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#101);#104=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#102);\
        #105=COMPOSITE_CURVE('',(#103,#104),.F.);";
    let whole = curve(&format!("{composite}#100=TRIMMED_CURVE('',#105,(#4),(#5),.F.,.CARTESIAN.);"));
    let CurveGeometry::Composite(segments) = &whole else { panic!("{whole:?}") };
    let ends: Vec<_> = segments.iter().map(|s| locate::ends(s).unwrap()).collect();
    for (found, expected) in ends.iter().zip([(DVec3::ZERO, y), (y, x)]) {
        assert!(near(found.0, expected.0) && near(found.1, expected.1), "{ends:?}");
    }
}

#[test]
fn parameters_of_points_invert_points() {
    let curves = [
        "#100=LINE('',#1,#9);",
        "#100=CIRCLE('',#7,2.);",
        "#100=ELLIPSE('',#7,2.,1.);",
        "#100=HYPERBOLA('',#7,2.,3.);",
        "#100=PARABOLA('',#7,2.);",
        "#100=B_SPLINE_CURVE_WITH_KNOTS('',2,(#4,#5,#10,#6),.UNSPECIFIED.,.F.,.F.,(3,1,3),(-1.,0.5,2.),.UNSPECIFIED.);",
    ];
    for data in curves {
        let c = curve(data);
        for t in [-0.9, 0.0, 0.3, 1.7] {
            let found = locate::parameter(&c, locate::point(&c, t).unwrap()).unwrap();
            // golden section sees squares of distances: half the digits
            assert!((found - t).abs() < 1e-7, "{data} at {t}: {found}");
        }
    }
}

#[test]
fn splines_in_every_spelling() {
    let knots = |data: &str| match curve(data) {
        CurveGeometry::BSpline(s) => (s.degree(), s.knots().to_vec(), s.points().to_vec()),
        other => panic!("{other:?}"),
    };
    let (degree, k, points) =
        knots("#100=B_SPLINE_CURVE_WITH_KNOTS('',2,(#4,#5,#10),.UNSPECIFIED.,.F.,.F.,(3,3),(0.,2.),.UNSPECIFIED.);");
    assert_eq!((degree, k), (2, vec![0.0, 0.0, 0.0, 2.0, 2.0, 2.0]));
    assert_eq!(points[2], glam::DVec4::new(10.0, 10.0, 0.0, 1.0));
    assert_eq!(knots("#100=BEZIER_CURVE('',2,(#4,#5,#10),.UNSPECIFIED.,.F.,.F.);").1, [0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
    assert_eq!(knots("#100=QUASI_UNIFORM_CURVE('',1,(#4,#5,#10),.U.,.F.,.F.);").1, [0.0, 0.0, 1.0, 2.0, 2.0]);
    assert_eq!(knots("#100=UNIFORM_CURVE('',1,(#4,#5,#10),.U.,.F.,.F.);").1, [-1.0, 0.0, 1.0, 2.0, 3.0]);
    assert_eq!(knots("#100=POLYLINE('',(#4,#5,#10));").1, [0.0, 0.0, 1.0, 2.0, 2.0]);
    let rational = "#100=(BOUNDED_CURVE() B_SPLINE_CURVE(2,(#5,#10,#6),.CIRCULAR_ARC.,.F.,.F.) \
        B_SPLINE_CURVE_WITH_KNOTS((3,3),(0.,1.),.UNSPECIFIED.) CURVE() GEOMETRIC_REPRESENTATION_ITEM() \
        RATIONAL_B_SPLINE_CURVE((1.,0.7071067811865476,1)) REPRESENTATION_ITEM(''));";
    let CurveGeometry::BSpline(arc) = curve(rational) else { panic!() };
    for i in 0..=8 {
        assert!((arc.point(f64::from(i) / 8.0).length() - 10.0).abs() < 1e-14);
    }
    let bezier = "#100=(B_SPLINE_CURVE(2,(#5,#10,#6),.U.,.F.,.F.) BEZIER_CURVE() RATIONAL_B_SPLINE_CURVE((1.,2.,1.)));";
    assert_eq!(knots(bezier).2[1], glam::DVec4::new(20.0, 20.0, 0.0, 2.0));
}

#[test]
fn surface_net_runs_along_v_in_the_file() {
    let data = "#20=CARTESIAN_POINT('',(0.,0.,7.));#21=CARTESIAN_POINT('',(0.,1.,7.));\
        #100=B_SPLINE_SURFACE_WITH_KNOTS('',1,1,((#4,#20),(#5,#10),(#6,#21)),.U.,.F.,.F.,.F.,(2,1,2),(2,2),(0.,1.,2.),(5.,6.),.U.);";
    let surface = with(data, |g| g.surface(100)).unwrap().surface;
    let SurfaceGeometry::BSpline(s) = surface else { panic!("{surface:?}") };
    assert_eq!((s.counts(), s.domain()), ((3, 2), ((0.0, 2.0), (5.0, 6.0))));
    assert!(near(s.jet(1.0, 5.0).point, DVec3::X * 10.0));
    assert!(near(s.jet(0.0, 6.0).point, DVec3::Z * 70.0));
    let quarter = "#100=(B_SPLINE_SURFACE(1,1,((#4,#5),(#6,#10)),.U.,.F.,.F.,.F.) QUASI_UNIFORM_SURFACE() \
        RATIONAL_B_SPLINE_SURFACE(((1.,2.),(3.,4.))) SURFACE());";
    let SurfaceGeometry::BSpline(s) = with(quarter, |g| g.surface(100)).unwrap().surface else { panic!() };
    assert_eq!(s.points().iter().map(|p| p.w).collect::<Vec<_>>(), [1.0, 3.0, 2.0, 4.0]);
}

#[test]
fn analytic_surfaces() {
    let surface = |data: &str| with(data, |g| g.surface(100)).unwrap();
    let cone = surface("#100=CONICAL_SURFACE('',#7,2.,30.);").surface;
    assert!(
        matches!(cone, SurfaceGeometry::Cone { radius: 20.0, half_angle, .. } if (half_angle - TAU / 12.0).abs() < 1e-15)
    );
    let torus = surface("#100=DEGENERATE_TOROIDAL_SURFACE('',#7,1.,2.,.T.);").surface;
    assert!(matches!(torus, SurfaceGeometry::Torus { major: 10.0, minor: 20.0, .. }));
    let swept = surface("#100=SURFACE_OF_LINEAR_EXTRUSION('',#11,#9);").surface;
    assert!(matches!(swept, SurfaceGeometry::Extrusion { direction, .. } if near(direction, DVec3::Y * 20.0)));
    let turned = surface("#100=SURFACE_OF_REVOLUTION('',#11,#13);").surface;
    assert!(matches!(turned, SurfaceGeometry::Revolution { axis, .. } if near(axis, DVec3::Y)));
    let cut = surface("#100=RECTANGULAR_TRIMMED_SURFACE('',#101,0.,1.,0.,1.,.T.,.F.);#101=PLANE('',#7);");
    assert!(cut.flipped && matches!(cut.surface, SurfaceGeometry::Window { u: (0.0, 10.0), .. }));
}

#[test]
fn offsets_of_elementary_surfaces() {
    let radius = |basis: &str| {
        let data = format!(
            "#100=OFFSET_SURFACE('',#101,0.5,.F.);#101={basis};#110=LINE('',#5,#9);#102=DIRECTION('',(0.,-1.,0.));#103=VECTOR('',#102,1.);#111=LINE('',#5,#103);"
        );
        let carrier = with(&data, |g| g.surface(100)).unwrap();
        match carrier.surface {
            SurfaceGeometry::Cylinder { radius, .. } | SurfaceGeometry::Sphere { radius, .. } => {
                (radius, carrier.flipped)
            }
            SurfaceGeometry::Cone { radius, .. } => (radius, carrier.flipped),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(radius("CYLINDRICAL_SURFACE('',#7,2.)"), (25.0, false));
    assert_eq!(radius("SPHERICAL_SURFACE('',#7,2.)"), (25.0, false));
    // 60 degrees: cos is one half
    assert!((radius("CONICAL_SURFACE('',#7,2.,60.)").0 - 30.0).abs() < 1e-12);
    // a line at distance 1 from the axis y: upwards its normal points out, downwards in
    assert_eq!(radius("SURFACE_OF_REVOLUTION('',#110,#13)"), (15.0, false));
    assert_eq!(radius("SURFACE_OF_REVOLUTION('',#111,#13)"), (5.0, true));
}

/// One square face in the plane z = 0: its loop must run counter-clockwise seen along the *surface's*
/// normal, whatever combination of flags says so.
#[test]
fn orientation_flags() {
    let points = "#30=VERTEX_POINT('',#4);#31=VERTEX_POINT('',#5);#32=VERTEX_POINT('',#10);#33=VERTEX_POINT('',#6);\
        #40=PLANE('',#8);#41=EDGE_CURVE('',#30,#31,#12,.T.);#42=EDGE_CURVE('',#32,#31,#12,.F.);\
        #43=EDGE_CURVE('',#32,#33,#12,.T.);#44=EDGE_CURVE('',#33,#30,#12,.T.);\
        #51=ORIENTED_EDGE('',*,*,#41,.T.);#52=ORIENTED_EDGE('',*,*,#42,.F.);#53=ORIENTED_EDGE('',*,*,#43,.T.);#54=ORIENTED_EDGE('',*,*,#44,.T.);";
    let run = |bound: &str, sense: &str, kind: &str| {
        let data = format!(
            "{points}#60=EDGE_LOOP('',(#51,#52,#53,#54));#61={kind}('',#60,{bound});#100=ADVANCED_FACE('',(#61),#40,{sense});"
        );
        let mut table = EdgeTable::default();
        let face = with(&data, |g| g.face(100, &mut table)).unwrap();
        assert_eq!(table.edges.len(), 4);
        assert!(!table.edges[1].same_sense);
        let Boundary::Edges(uses) = &face.bounds[0] else { panic!() };
        let start = |&(e, forward): &(usize, bool)| if forward { table.edges[e].start } else { table.edges[e].end };
        let corners: Vec<DVec3> = uses.iter().map(start).collect();
        let area: f64 = (0..4).map(|i| corners[i].cross(corners[(i + 1) % 4]).z).sum::<f64>() * 0.5;
        (area, face.same_sense)
    };
    assert_eq!(run(".T.", ".T.", "FACE_OUTER_BOUND"), (100.0, true));
    assert_eq!(run(".F.", ".T.", "FACE_BOUND"), (-100.0, true));
    assert_eq!(run(".F.", ".F.", "FACE_BOUND"), (100.0, false));
    assert_eq!(run(".T.", ".F.", "FACE_BOUND"), (-100.0, false));
}

#[test]
fn polygons_share_their_sides_and_span_their_plane() {
    let data = "#60=POLY_LOOP('',(#4,#5,#10));#61=FACE_OUTER_BOUND('',#60,.T.);#100=FACE('',(#61));\
        #70=POLY_LOOP('',(#4,#10,#6));#71=FACE_OUTER_BOUND('',#70,.F.);#101=FACE('',(#71));";
    let mut table = EdgeTable::default();
    let (a, b) = with(data, |g| (g.face(100, &mut table).unwrap(), g.face(101, &mut table).unwrap()));
    assert_eq!(table.edges.len(), 5);
    let normal = |s: &SurfaceGeometry| match s {
        SurfaceGeometry::Plane { frame } => frame.z,
        other => panic!("{other:?}"),
    };
    assert!(near(normal(&a.surface), DVec3::Z) && near(normal(&b.surface), -DVec3::Z));
}

#[test]
fn faults_name_the_entity() {
    for (data, message) in [
        ("#100=CIRCLE('',#7,0.);", "#100: attribute 2 is not a length above 0"),
        ("#100=CIRCLE('',#99,1.);", "#99 does not exist"),
        ("#100=CIRCLE('',#11,1.);", "#11 is CIRCLE, not AXIS2_PLACEMENT_3D"),
        ("#100=SPHERICAL_SURFACE('',#7,NaN);", "#100: attribute 2 is not a length above 0"),
        ("#100=TRIMMED_CURVE('',#100,(#4),(#5),.T.,.CARTESIAN.);", "#100 refers to itself"),
        ("#100=COMPOSITE_CURVE('',(#101),.F.);#101=COMPOSITE_CURVE_SEGMENT(.C.,.T.,#100);", "#100 refers to itself"),
        ("#100=OFFSET_SURFACE('',#101,1.,.F.);#101=OFFSET_SURFACE('',#100,1.,.F.);", "#100 refers to itself"),
        (
            "#100=B_SPLINE_CURVE_WITH_KNOTS('',2,(#4,#5,#6),.U.,.F.,.F.,(3,1000000000),(0.,1.),.U.);",
            "#100: the knots do not fit",
        ),
        (
            "#100=B_SPLINE_CURVE_WITH_KNOTS('',1000000000,(#4,#5),.U.,.F.,.F.,(2,2),(0.,1.),.U.);",
            "#100: attribute 1 is not a degree",
        ),
        ("#100=B_SPLINE_CURVE_WITH_KNOTS('',1,(#4,#5),.U.,.F.,.F.,(2,2),(1.,0.),.U.);", "#100: knot 2"),
        (
            "#100=(B_SPLINE_CURVE(1,(#4,#5),.U.,.F.,.F.) BEZIER_CURVE() RATIONAL_B_SPLINE_CURVE((1.,0.)));",
            "#100: control point 1",
        ),
        ("#100=POLYLINE('',());", "#100: "),
        ("#100=CLOTHOID('',#7,1.);", "CLOTHOID is not supported (#100)"),
        ("#100=LINE('',#101,#9);#101=CARTESIAN_POINT('',(0.,1E999,0.));", "#101: a coordinate is not a finite number"),
    ] {
        let curve = with(data, |g| g.curve(100)).map(drop);
        let surface = with(data, |g| g.surface(100)).map(drop);
        let found = [curve, surface].map(|r| r.map_or_else(|e| e.to_string(), |()| String::new()));
        assert!(found.iter().any(|f| f.starts_with(message)), "{data}\n{found:?}");
    }
}
