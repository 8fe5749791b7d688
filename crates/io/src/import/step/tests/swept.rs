//! Swept solids: points inside and outside, by dimensions worked out by hand.

use super::csg::{holds, one, read, told};
use super::import;
use crate::import::Import;
use glam::DVec3;
use std::f64::consts::FRAC_1_SQRT_2;

/// In the plane z = 0, in centimetres: a square from (2, 0) to (4, 2) with a hole of radius 0.5 about (3, 1), edges by composite
/// curves; its centre's axes #60. The axis #65 is y.
const AREA: &str = "#60=AXIS2_PLACEMENT_3D('',#61,#62,$);#61=CARTESIAN_POINT('',(3.,1.,0.));#62=DIRECTION('',(0.,0.,1.));\
    #63=PLANE('',#60);#64=CIRCLE('',#60,0.5);#65=AXIS1_PLACEMENT('',#6,#3);#66=DIRECTION('',(0.,0.,-1.));\
    #71=CARTESIAN_POINT('',(2.,0.,0.));#72=CARTESIAN_POINT('',(4.,0.,0.));#73=CARTESIAN_POINT('',(4.,2.,0.));#74=CARTESIAN_POINT('',(2.,2.,0.));\
    #75=POLYLINE('',(#71,#72,#73,#74,#71));#76=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#75);#77=BOUNDARY_CURVE('',(#76),.F.);\
    #78=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#64);#79=BOUNDARY_CURVE('',(#78),.F.);\
    #80=CURVE_BOUNDED_SURFACE('',#63,(#77,#79),.F.);#81=CURVE_BOUNDED_SURFACE('',#63,(#82),.F.);\
    #83=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#64);#82=BOUNDARY_CURVE('',(#83),.F.);";

/// The solid as the only operand of an expression.
fn solid(data: &str) -> Import {
    read(&format!("{AREA}#50=CSG_SOLID('',#51);#51={data};"))
}

/// Points in centimetres.
fn check(data: &str, points: &[([f64; 3], bool)]) {
    let found = solid(data);
    assert!(found.warnings.is_empty(), "{data}: {:?}", found.warnings);
    let points: Vec<_> = points.iter().map(|(p, inside)| (DVec3::from_array(*p) * 10.0, *inside)).collect();
    holds(one(&found), &points);
}

const E: f64 = 1e-5;

#[test]
fn extruded_areas() {
    let points = [
        ([2.0 + E, 1.0, 1.5], true),
        ([2.0 - E, 1.0, 1.5], false),
        ([4.0 - E, 2.0 - E, 3.0 - E], true),
        ([2.2, 0.3, E], true),
        ([2.2, 0.3, -E], false),
        ([2.2, 0.3, 3.0 + E], false),
        // the hole
        ([3.0, 1.0, 1.5], false),
        ([3.5 - E, 1.0, 1.5], false),
        ([3.5 + E, 1.0, 1.5], true),
    ];
    check("EXTRUDED_AREA_SOLID('',#80,#62,3.)", &points);
    let down = points.map(|([x, y, z], inside)| ([x, y, -z], inside));
    check("EXTRUDED_AREA_SOLID('',#80,#66,3.)", &down);
    check("EXTRUDED_AREA_SOLID('',#80,#62,-3.)", &down);
    // leaning by 45 degrees
    let lean = format!("EXTRUDED_AREA_SOLID('',#81,#90,{});#90=DIRECTION('',(1.,0.,1.))", 2.0 / FRAC_1_SQRT_2);
    check(
        &lean,
        &[
            ([5.0 + 0.5 - E, 1.0, 2.0 - E / 2.0], true),
            ([5.5 + E, 1.0, 2.0 - E / 2.0], false),
            ([3.5, 1.0, 0.5], true),
            ([3.0, 1.0, 1.0], false),
        ],
    );
}

#[test]
fn revolved_areas() {
    // a whole turn about y: a square ring with a round channel
    for angle in ["360.", "-360."] {
        check(
            &format!("REVOLVED_AREA_SOLID('',#80,#65,{angle})"),
            &[
                ([0.0, 1.0, 2.0 + E], true),
                ([0.0, 1.0, 2.0 - E], false),
                ([-4.0 + E, 1.0, 0.0], true),
                ([-4.0 - E, 1.0, 0.0], false),
                ([-3.0, 1.0, 0.0], false),
                ([-3.5 - E, 1.0, 0.0], true),
                ([-3.0, E, 0.0], true),
                ([-3.0, -E, 0.0], false),
            ],
        );
    }
    // a quarter about y takes x to -z; the other way to +z
    for (angle, z) in [("90.", -1.0), ("-90.", 1.0)] {
        check(
            &format!("REVOLVED_AREA_SOLID('',#80,#65,{angle})"),
            &[
                ([2.2, 0.3, z * E], true),
                ([2.2, 0.3, -z * E], false),
                ([E, 0.3, z * 2.2], true),
                ([-E, 0.3, z * 2.2], false),
                ([3.0 * FRAC_1_SQRT_2, 1.0, z * 3.0 * FRAC_1_SQRT_2], false),
                ([3.6 * FRAC_1_SQRT_2, 1.0, z * 3.6 * FRAC_1_SQRT_2], true),
            ],
        );
    }
    // a circle alone: a torus
    check(
        "REVOLVED_AREA_SOLID('',#81,#65,360.)",
        &[
            ([0.0, 1.0, 3.5 - E], true),
            ([0.0, 1.0, 3.5 + E], false),
            ([-3.0, 1.5 - E, 0.0], true),
            ([0.0, 1.0, 0.0], false),
        ],
    );
    // half a disk about its diameter: a ball, and a quarter of one
    let half = "#90=CURVE_BOUNDED_SURFACE('',#63,(#91),.F.);#91=BOUNDARY_CURVE('',(#92,#93),.F.);\
        #92=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#94);#94=TRIMMED_CURVE('',#64,(PARAMETER_VALUE(270.)),(PARAMETER_VALUE(90.)),.T.,.PARAMETER.);\
        #93=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#95);#95=POLYLINE('',(#96,#97));\
        #96=CARTESIAN_POINT('',(3.,1.5,0.));#97=CARTESIAN_POINT('',(3.,0.5,0.));#98=AXIS1_PLACEMENT('',#61,#3)";
    for (angle, behind) in [("360.", true), ("90.", false)] {
        check(
            &format!("REVOLVED_AREA_SOLID('',#90,#98,{angle});{half}"),
            &[
                ([3.1, 1.0, -0.5 + 0.02], true),
                ([3.1, 1.0, -0.5], false),
                ([3.0 + E, 1.5 - 2.0 * E, -E], true),
                ([2.8, 1.0, 0.1], behind),
            ],
        );
    }
    // an area with a side on the axis: a cylinder, and a quarter of one
    let touching = "#91=AXIS1_PLACEMENT('',#71,#3)";
    for (angle, behind) in [("360.", true), ("90.", false)] {
        check(
            &format!("REVOLVED_AREA_SOLID('',#92,#91,{angle});{touching};#92=CURVE_BOUNDED_SURFACE('',#63,(#77),.F.)"),
            &[
                ([2.0 + 2.0 * FRAC_1_SQRT_2 - E, 1.0, -2.0 * FRAC_1_SQRT_2 + E], true),
                ([2.1, 1.0, -0.1], true),
                ([1.9, 1.0, 0.1], behind),
                ([4.0 + E, 1.0, -E], false),
            ],
        );
    }
}

/// The same by faces, whose sides are edges of topology.
#[test]
fn swept_faces() {
    let face = "#100=VERTEX_POINT('',#71);#101=VERTEX_POINT('',#72);#102=VERTEX_POINT('',#73);\
        #103=EDGE_CURVE('',#100,#101,#104,.T.);#104=LINE('',#71,#105);#105=VECTOR('',#106,1.);#106=DIRECTION('',(1.,0.,0.));\
        #107=EDGE_CURVE('',#102,#101,#108,.F.);#108=LINE('',#72,#109);#109=VECTOR('',#3,1.);\
        #110=EDGE_CURVE('',#100,#102,#111,.T.);#111=LINE('',#71,#112);#112=VECTOR('',#113,1.);#113=DIRECTION('',(1.,1.,0.));\
        #114=ORIENTED_EDGE('',*,*,#103,.T.);#115=ORIENTED_EDGE('',*,*,#107,.F.);#116=ORIENTED_EDGE('',*,*,#110,.F.);\
        #117=EDGE_LOOP('',(#114,#115,#116));#118=FACE_OUTER_BOUND('',#117,.T.)";
    for sense in [".T.", ".F."] {
        let bound = if sense == ".T." { face.to_owned() } else { face.replace("#117,.T.", "#117,.F.") };
        let of = |kind: &str| format!("{kind};{bound};#99=FACE_SURFACE('',(#118),#63,{sense})");
        // the triangle (2, 0), (4, 0), (4, 2)
        check(
            &of("EXTRUDED_FACE_SOLID('',#99,#62,1.)"),
            &[
                ([3.0, 1.0 - E, 0.5], true),
                ([3.0, 1.0 + E, 0.5], false),
                ([4.0 - E, 0.1, 1.0 - E], true),
                ([3.5, 0.5, -E], false),
            ],
        );
        check(
            &of("REVOLVED_FACE_SOLID('',#99,#65,180.)"),
            &[
                ([-3.0, 1.0 - E, -E], true),
                ([-3.0, 1.0 - E, E], false),
                ([0.0, 0.1, -2.1 - E], true),
                ([0.0, 0.1, -2.1 + 2.0 * E], false),
            ],
        );
    }
}

/// A pipe: straight from x = -2, a quarter of radius 3 to the left, straight again.
const PIPE: &str = "#120=POLYLINE('',(#121,#6));#121=CARTESIAN_POINT('',(-2.,0.,0.));#122=CARTESIAN_POINT('',(0.,3.,0.));\
    #123=AXIS2_PLACEMENT_3D('',#122,#62,$);#124=CIRCLE('',#123,3.);\
    #125=TRIMMED_CURVE('',#124,(PARAMETER_VALUE(270.)),(PARAMETER_VALUE(0.)),.T.,.PARAMETER.);\
    #126=CARTESIAN_POINT('',(3.,3.,0.));#127=CARTESIAN_POINT('',(3.,5.,0.));#128=POLYLINE('',(#127,#126));\
    #131=COMPOSITE_CURVE_SEGMENT(.CONTSAMEGRADIENT.,.T.,#120);#132=COMPOSITE_CURVE_SEGMENT(.CONTSAMEGRADIENT.,.T.,#125);\
    #133=COMPOSITE_CURVE_SEGMENT(.DISCONTINUOUS.,.F.,#128);#130=COMPOSITE_CURVE('',(#131,#132,#133),.F.)";

#[test]
fn disks_and_rings_along_lines_and_arcs() {
    let (c, s) = (3.0 * FRAC_1_SQRT_2, 3.0 - 3.0 * FRAC_1_SQRT_2);
    let points = |hollow: bool| {
        [
            ([-2.0 + E, 0.9, 0.0], true),
            ([-2.0 - E, 0.9, 0.0], false),
            ([-1.0, 0.0, 1.0 - E], true),
            ([-1.0, 0.0, 1.0 + E], false),
            ([-1.0, 0.1, 0.0], !hollow),
            ([c, s, 1.0 - E], true),
            ([c, s, 1.0 + E], false),
            ([c, s, 0.1], !hollow),
            ([3.9, 5.0 - E, 0.0], true),
            ([3.9, 5.0 + E, 0.0], false),
        ]
    };
    check(&format!("SWEPT_DISK_SOLID('',#130,1.,$,$,$);{PIPE}"), &points(false));
    check(&format!("SWEPT_DISK_SOLID('',#130,1.,0.5,0.,3.);{PIPE}"), &points(true));
    // between parameters of a line in steps of 2, and around a whole circle
    check(
        "SWEPT_DISK_SOLID('',#140,1.,$,0.5,2.);#140=LINE('',#6,#141);#141=VECTOR('',#3,2.)",
        &[
            ([0.0, 1.0 + E, 0.9], true),
            ([0.0, 1.0 - E, 0.0], false),
            ([0.0, 4.0 - E, 0.0], true),
            ([0.0, 4.0 + E, 0.0], false),
        ],
    );
    check(
        "SWEPT_DISK_SOLID('',#64,0.25,0.125,$,$)",
        &[
            ([3.5, 1.0, 0.25 - E], true),
            ([3.5, 1.0, 0.25 + E], false),
            ([2.5, 1.0, 0.1], false),
            ([3.0, 1.0, 0.0], false),
        ],
    );
}

/// A disk along a spline is within its tolerance of the tube: a parabola of curvature 1 at most.
#[test]
fn disks_along_splines() {
    let spline = "#150=BEZIER_CURVE('',2,(#6,#151,#152),.UNSPECIFIED.,.F.,.F.);#151=CARTESIAN_POINT('',(2.,0.,0.));#152=CARTESIAN_POINT('',(4.,4.,0.))";
    check(
        &format!("SWEPT_DISK_SOLID('',#150,0.5,$,$,$);{spline}"),
        &[
            ([E, 0.4, 0.0], true),
            ([-E, 0.4, 0.0], false),
            ([2.0, 1.0, 0.5 - 1e-3], true),
            ([2.0, 1.0, 0.5 + 1e-3], false),
            ([3.96, 3.9204, 0.0], true),
        ],
    );
}

#[test]
fn swept_solids_are_bodies_too() {
    let found = import(&format!(
        "#6=CARTESIAN_POINT('',(0.,0.,0.));#3=DIRECTION('',(0.,1.,0.));#1=(GEOMETRIC_REPRESENTATION_CONTEXT(3) REPRESENTATION_CONTEXT('',''));\
         {AREA}#50=EXTRUDED_AREA_SOLID('',#80,#62,3.);#51=SHAPE_REPRESENTATION('',(#50),#1);"
    ));
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    let part = &found.model.parts[0];
    // two squares, four sides, the hole
    assert_eq!((part.closed, part.faces.len(), found.model.instances.len()), (true, 7, 1));
}

/// The profile of a solid of an unsupported kind is no face of its own.
#[test]
fn a_profile_is_not_drawn_by_itself() {
    let face = "#99=FACE_SURFACE('',(#98),#63,.T.);#98=FACE_OUTER_BOUND('',#97,.T.);#97=POLY_LOOP('',(#71,#72,#73))";
    let found = solid(&format!("PARAMETRIC_EXTRUDED_FACE_SOLID('',#99,#62,1.);{face}"));
    assert_eq!(found.model.face_count(), 0, "{:?}", found.warnings);
    assert!(told(&found)[0].contains("#51 is PARAMETRIC_EXTRUDED_FACE_SOLID"), "{:?}", found.warnings);
    // one that nothing refers to is
    let found = solid(&format!("PARAMETRIC_EXTRUDED_FACE_SOLID('',#80,#62,1.);{face}"));
    assert_eq!(found.model.face_count(), 1, "{:?}", found.warnings);
}

#[test]
fn impossible_sweeps_are_reported() {
    let pipe = |from: &str, to: &str| {
        assert!(PIPE.contains(from), "{from}");
        format!("SWEPT_DISK_SOLID('',#130,1.,$,$,$);{}", PIPE.replace(from, to))
    };
    for (data, message) in [
        ("EXTRUDED_AREA_SOLID('',#80,#62,0.)".into(), "#51: the depth is 0"),
        ("EXTRUDED_AREA_SOLID('',#80,#3,1.)".into(), "#51: what is swept moves within its own plane"),
        ("EXTRUDED_AREA_SOLID('',#77,#62,1.)".into(), "#77 is BOUNDARY_CURVE, not FACE_SURFACE"),
        ("EXTRUDED_AREA_SOLID('',#99,#62,1.);#99=CURVE_BOUNDED_SURFACE('',#98,(#82),.F.);#98=SPHERICAL_SURFACE('',#60,0.5)".into(), "#51: what is swept is not plane"),
        ("REVOLVED_AREA_SOLID('',#80,#65,0.)".into(), "#51: the angle is 0"),
        ("REVOLVED_AREA_SOLID('',#80,#99,90.);#99=AXIS1_PLACEMENT('',#61,#3)".into(), "#51: the axis crosses what turns"),
        // a circle, whose vertex lies on one side
        ("REVOLVED_AREA_SOLID('',#81,#99,90.);#99=AXIS1_PLACEMENT('',#61,#3)".into(), "#51: the axis crosses what turns"),
        ("REVOLVED_AREA_SOLID('',#80,#99,90.);#99=AXIS1_PLACEMENT('',#6,#98);#98=DIRECTION('',(0.,1.,1.))".into(), "#51: the axis does not lie in the plane of what turns"),
        ("SWEPT_DISK_SOLID('',#64,-1.,$,$,$)".into(), "#51: attribute 2 is not a length above 0"),
        ("SWEPT_DISK_SOLID('',#64,0.5,$,$,$)".into(), "#51: the tube folds: it is as wide as its arc"),
        ("SWEPT_DISK_SOLID('',#64,0.25,0.25,$,$)".into(), "#51: the inner radius is not below the outer one"),
        ("SWEPT_DISK_SOLID('',#75,0.25,$,$,$)".into(), "#51: the directrix has a corner"),
        ("SWEPT_DISK_SOLID('',#99,0.25,$,$,$);#99=LINE('',#6,#98);#98=VECTOR('',#3,1.)".into(), "#51: the directrix has no ends"),
        (pipe("#133),.F.)", "#133),.F.);#134=DIRECTION('',(1.,0.,0.))").replace("(3.,3.,0.)", "(3.,3.1,0.)"), "#51: the pieces of the directrix do not meet"),
        (format!("SWEPT_DISK_SOLID('',#130,1.,$,0.,2.5);{PIPE}"), "a part of a composite directrix is not supported (#51)"),
    ] {
        let told = told(&solid(&data));
        assert!(told.iter().any(|t| t.ends_with(&format!(" left out: {message}"))), "{data}: {told:?}");
    }
}
