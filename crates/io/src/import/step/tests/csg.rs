//! Boolean expressions: every operand by its exact dimensions, graphs of any form, and the message of each fault.

use super::import;
use crate::csg::{Node, Op, Tree};
use crate::import::Import;
use crate::model::{Primitive, Shape, Solid, SurfaceTable};
use glam::DVec3;
use selvedge_check::solids::SolidTracer;

/// Axes at (1, 2, 3) with z along x and x along y, points, and the context of centimetres and degrees.
const COMMON: &str = "#1=CARTESIAN_POINT('',(1.,2.,3.));#2=DIRECTION('',(1.,0.,0.));#3=DIRECTION('',(0.,1.,0.));\
    #4=AXIS2_PLACEMENT_3D('',#1,#2,#3);#5=AXIS1_PLACEMENT('',#1,#2);#6=CARTESIAN_POINT('',(0.,0.,0.));\
    #20=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.CENTI.,.METRE.));\
    #21=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));\
    #22=PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(1.7453292519943295E-2),#21);\
    #23=(CONVERSION_BASED_UNIT('DEGREE',#22)NAMED_UNIT(*)PLANE_ANGLE_UNIT());\
    #24=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#20,#23))REPRESENTATION_CONTEXT('',''));";

/// Balls about the origin and about the axes' origin, where `data` refers to them: a ball without a reference is drawn
/// by itself.
fn balls(data: &str) -> String {
    let named = |id: u32| data.contains(&format!("#{id},")) || data.contains(&format!("#{id})"));
    let ball = |(id, centre): (u32, u32)| format!("#{id}=SPHERE('',2.,#{centre});");
    [(8, 6), (9, 1)].into_iter().filter(|b| named(b.0)).map(ball).collect()
}

/// A file whose representation, in centimetres and degrees, lists `#50`.
pub(super) fn read(data: &str) -> Import {
    import(&format!("{COMMON}{}{data}#30=CSG_SHAPE_REPRESENTATION('',(#50,#4),#24);", balls(data)))
}

pub(super) fn told(import: &Import) -> Vec<String> {
    import.warnings.iter().map(|w| w.message.clone()).collect()
}

pub(super) fn one(import: &Import) -> &Solid {
    assert!(import.warnings.is_empty(), "{:?}", import.warnings);
    let [solid] = &import.model.solids[..] else { panic!("{} solids", import.model.solids.len()) };
    solid
}

/// Whether points are inside: a line through each.
pub(super) fn holds(solid: &Solid, points: &[(DVec3, bool)]) {
    let tracer = SolidTracer::new(solid, SurfaceTable::ROUNDED).unwrap();
    for (p, inside) in points {
        let trace = tracer.trace(*p, DVec3::new(0.3, 0.5, 0.8));
        assert_eq!(trace.inside(0.0), *inside, "at {p}");
    }
}

/// Dimensions in centimetres at axes x' = y, y' = z, z' = x through (1, 2, 3), in millimetres.
#[test]
fn primitives_stand_where_they_should() {
    let at = |x: f64, y: f64, z: f64| DVec3::new(10.0 + 10.0 * z, 20.0 + 10.0 * x, 30.0 + 10.0 * y);
    let e = 1e-6;
    type Points = Vec<([f64; 3], bool)>;
    let cases: Vec<(&str, Points)> = vec![
        (
            "BLOCK('',#4,2.,3.,4.)",
            vec![
                ([e, e, e], true),
                ([2.0 - e, 3.0 - e, 4.0 - e], true),
                ([2.0 + e, 1.0, 1.0], false),
                ([1.0, -e, 1.0], false),
            ],
        ),
        (
            "RIGHT_ANGULAR_WEDGE('',#4,4.,2.,3.,1.)",
            vec![
                ([4.0 - 2.0 * e, e, e], true),
                ([1.0 - e, 2.0 - e, 1.0], true),
                ([1.0 + e, 2.0 - e / 2.0, 1.0], false),
                ([2.5 + e, 1.0, 1.0], false),
                ([2.5 - e, 1.0, 3.0 - e], true),
            ],
        ),
        ("RIGHT_ANGULAR_WEDGE('',#4,4.,2.,3.,0.)", vec![([2.0 - e, 1.0, 1.0], true), ([2.0 + e, 1.0, 1.0], false)]),
        (
            "ELLIPSOID('',#4,2.,3.,4.)",
            vec![
                ([2.0 - e, 0.0, 0.0], true),
                ([0.0, 3.0 - e, 0.0], true),
                ([0.0, 0.0, 4.0 - e], true),
                ([2.0 + e, 0.0, 0.0], false),
                ([0.0, 0.0, -4.0 - e], false),
            ],
        ),
        ("SPHERE('',2.,#1)", vec![([0.0, 0.0, 2.0 - e], true), ([0.0, 0.0, 2.0 + e], false)]),
        (
            "RIGHT_CIRCULAR_CYLINDER('',#5,4.,2.)",
            vec![
                ([0.0, 2.0 - e, e], true),
                ([0.0, 1.0, -e], false),
                ([0.0, 1.0, 4.0 - e], true),
                ([0.0, 2.0 + e, 1.0], false),
            ],
        ),
        (
            // wider along the axis: 1 at its origin, 1 + 4 tan 45° at its end
            "RIGHT_CIRCULAR_CONE('',#5,4.,1.,45.)",
            vec![
                ([0.0, 1.0 - e, e], true),
                ([0.0, 5.0 - e, 4.0 - e / 2.0], true),
                ([0.0, 3.0 + e, 2.0], false),
                ([0.0, 0.0, -e], false),
                ([0.0, 0.0, 4.0 + e], false),
            ],
        ),
        ("RIGHT_CIRCULAR_CONE('',#5,4.,0.,45.)", vec![([0.0, 0.0, e], true), ([0.0, 2.0 + e, 2.0], false)]),
        (
            // 4 by 2 at the bottom, the tip 3 above (2, 1)
            "RECTANGULAR_PYRAMID('',#4,4.,2.,3.)",
            vec![
                ([2.0 * e, 2.0 * e, e], true),
                ([2.0, 1.0, 3.0 - e], true),
                ([2.0, 1.0, -e], false),
                ([1.0 - e, 1.0, 1.5], false),
                ([1.0 + e, 1.0, 1.5 - e], true),
                ([3.0 + e, 1.0, 1.5], false),
                ([2.0, 0.5 - e, 1.5], false),
                ([2.0, 1.5 - 2.0 * e, 1.5], true),
                ([2.0, 1.5 + e, 1.5], false),
            ],
        ),
        (
            // semi-axes 2 and 1; half as large at 4, where the middle is (1, -1)
            "ECCENTRIC_CONE('',#4,2.,1.,4.,1.,-1.,0.5)",
            vec![
                ([2.0 - e, 0.0, e / 8.0], true),
                ([0.0, 1.0 - e, e / 8.0], true),
                ([2.0 - e, -1.0, 4.0 - e / 8.0], true),
                ([e, -1.0, 4.0 - e / 8.0], true),
                ([-e, -1.0, 4.0 - e / 8.0], false),
                ([1.0, -0.5 - e, 4.0 - e / 8.0], true),
                ([1.0, -1.0, 4.0 + e], false),
            ],
        ),
        (
            "ECCENTRIC_CONE('',#4,2.,1.,4.,1.,0.,1.)",
            vec![([3.0 - e, 0.0, 4.0 - e / 8.0], true), ([3.0, 0.0, 3.0], false)],
        ),
        ("ECCENTRIC_CONE('',#4,2.,1.,4.,1.,0.,0.)", vec![([1.0, 0.0, 4.0 - e], true), ([1.0, 0.0, 4.0 + e], false)]),
        (
            "TORUS('',#5,3.,1.)",
            vec![
                ([3.0, 0.0, 1.0 - e], true),
                ([0.0, 4.0 - e, 0.0], true),
                ([0.0, 2.0 - e, 0.0], false),
                ([0.0, 0.0, 0.0], false),
            ],
        ),
        ("HALF_SPACE_SOLID('',#51,.T.);#51=PLANE('',#4)", vec![([5.0, 6.0, -e], true), ([5.0, 6.0, e], false)]),
        ("HALF_SPACE_SOLID('',#51,.F.);#51=PLANE('',#4)", vec![([5.0, 6.0, -e], false), ([5.0, 6.0, e], true)]),
        (
            "BOXED_HALF_SPACE('',#51,.T.,#52);#51=CYLINDRICAL_SURFACE('',#4,2.);#52=BOX_DOMAIN(#6,1.,1.,1.)",
            vec![([0.0, 2.0 - e, 50.0], true), ([0.0, 2.0 + e, 0.0], false)],
        ),
        (
            "HALF_SPACE_SOLID('',#51,.F.);#51=SPHERICAL_SURFACE('',#4,2.)",
            vec![([0.0, 2.0 - e, 0.0], false), ([0.0, 2.0 + e, 0.0], true), ([90.0, 0.0, 0.0], true)],
        ),
        (
            "HALF_SPACE_SOLID('',#51,.T.);#51=DEGENERATE_TOROIDAL_SURFACE('',#4,1.,2.,.T.)",
            vec![([0.0, 0.0, 0.0], true), ([0.0, 3.0 - e, 0.0], true), ([0.0, 0.0, 3.0_f64.sqrt() + e], false)],
        ),
    ];
    for (text, points) in cases {
        let import = read(&format!("#50={text};"));
        let points: Vec<_> = points.iter().map(|([x, y, z], inside)| (at(*x, *y, *z), *inside)).collect();
        holds(one(&import), &points);
    }
}

/// Operations, replicas that move, turn and mirror, and solids within solids.
#[test]
fn operations_and_replicas() {
    let data = "#50=CSG_SOLID('all',#51);#51=BOOLEAN_RESULT('',.UNION.,#52,#55);\
        #52=BOOLEAN_RESULT('',.DIFFERENCE.,#8,#53);#53=BOOLEAN_RESULT('',.INTERSECTION.,#8,#9);\
        #55=SOLID_REPLICA('',#56,#57);#56=CSG_SOLID('',#58);#58=BLOCK('',#4,1.,2.,3.);\
        #57=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',#3,#2,#59,2.,#60);#59=CARTESIAN_POINT('',(10.,0.,0.));\
        #60=DIRECTION('',(0.,0.,1.));";
    let import = read(data);
    let solid = one(&import);
    assert_eq!((solid.primitives().len(), import.report.bodies, import.report.nodes["SPHERE"]), (3, 1, 2));
    // the block, 1 2 3 in x' y' z' = y z x: from (1, 2, 3) to (4, 3, 5); x and y change places, twice as large
    let (lo, hi) = (DVec3::new(10.0 + 4.0, 2.0, 6.0), DVec3::new(10.0 + 6.0, 8.0, 10.0));
    let e = DVec3::splat(1e-6);
    let far = DVec3::new(-1.9, 0.0, 0.0);
    let (near, both) = (DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.5, 1.0, 1.5));
    let points =
        [(lo + e, true), (hi - e, true), (lo - e, false), (hi + e, false), (far, true), (both, false), (-near, true)];
    holds(solid, &points.map(|(p, inside)| (p * 10.0, inside)));
}

/// `(a - b) + (b - a)` over the same entities is one operation; a primitive used twice is one.
#[test]
fn symmetric_differences_are_known() {
    let import = read(
        "#50=CSG_SOLID('',#51);#51=BOOLEAN_RESULT('',.UNION.,#52,#53);#52=BOOLEAN_RESULT('',.DIFFERENCE.,#8,#9);\
         #53=BOOLEAN_RESULT('',.DIFFERENCE.,#9,#8);",
    );
    let solid = one(&import);
    assert_eq!(solid.tree().nodes(), [Node::Leaf(0), Node::Leaf(1), Node::Pair(Op::SymmetricDifference, 0, 1)]);
    let ids: Vec<u32> = solid.primitives().iter().map(|p| p.id).collect();
    assert_eq!(ids, [8, 9]);
}

/// A tetrahedron of polygons: triangles as an operand; with a hole, or on anything else, faces.
const TETRAHEDRON: &str = "#61=CARTESIAN_POINT('',(1.,0.,0.));#62=CARTESIAN_POINT('',(0.,1.,0.));\
    #63=CARTESIAN_POINT('',(0.,0.,1.));#70=FACETED_BREP('',#71);#71=CLOSED_SHELL('',(#72,#73,#74,#75));\
    #72=FACE_SURFACE('',(#76),#95,.T.);#73=FACE('',(#77));#74=FACE('',(#78));#75=FACE('',(#79));\
    #76=FACE_OUTER_BOUND('',#80,.T.);#77=FACE_OUTER_BOUND('',#81,.T.);#78=FACE_BOUND('',#82,.F.);\
    #79=FACE_OUTER_BOUND('',#83,.T.);#80=POLY_LOOP('',(#6,#62,#61));#81=POLY_LOOP('',(#6,#61,#63));\
    #82=POLY_LOOP('',(#6,#62,#63));#83=POLY_LOOP('',(#61,#62,#63));\
    #95=PLANE('',#96);#96=AXIS2_PLACEMENT_3D('',#6,#97,$);#97=DIRECTION('',(0.,0.,-1.));";

#[test]
fn solids_of_faces_are_operands() {
    let data = format!("{TETRAHEDRON}#50=CSG_SOLID('',#51);#51=BOOLEAN_RESULT('',.INTERSECTION.,#70,#8);");
    let import = read(&data);
    let solid = one(&import);
    let Shape::Mesh(mesh) = &solid.primitives()[0].shape else { panic!("{:?}", solid.primitives()[0]) };
    assert_eq!((mesh.positions().len(), mesh.triangles().len()), (4, 4));
    let e = 1e-6;
    let points = [(DVec3::splat(e), true), (DVec3::splat(10.0 / 3.0 - e), true), (DVec3::splat(10.0 / 3.0 + e), false)];
    holds(solid, &points);
    assert_eq!((import.model.parts.len(), import.report.faces), (0, 0), "an operand is not drawn by itself");
    // a face without a polygon of its own: all are faces
    let data = data.replace("#75=FACE('',(#79))", "#75=FACE_SURFACE('',(#79,#79),#98,.T.)")
        + "#98=PLANE('',#99);#99=AXIS2_PLACEMENT_3D('',#61,#100,$);#100=DIRECTION('',(1.,1.,1.));";
    let import = read(&data);
    let Shape::Part(part) = &import.model.solids[0].primitives()[0].shape else { panic!("no part") };
    assert!(part.closed);
    assert_eq!((part.faces.len(), import.report.faces, import.model.parts.len()), (4, 4, 0));
    assert!(import.report.face_records.iter().all(|r| r.part == 0));
    // without one of them it has no inside
    let import = read(&data.replace("#98=PLANE('',#99)", "#98=SPHERICAL_SURFACE('',#99,0.)"));
    let lost = told(&import).iter().any(|t| t.contains("its operand #70 is not closed, so it has no inside"));
    assert!(lost && import.model.solids.is_empty() && import.model.parts.is_empty(), "{:?}", told(&import));
}

/// Its own colour, else that of the operation around it, else the representation's; the occurrence's beats all.
#[test]
fn colours_come_from_the_nearest() {
    let style = |id: u32, rgb: &str, item: u32| {
        format!(
            "#{id}=COLOUR_RGB('',{rgb});#{a}=FILL_AREA_STYLE_COLOUR('',#{id});#{b}=FILL_AREA_STYLE('',(#{a}));\
             #{c}=SURFACE_STYLE_FILL_AREA(#{b});#{d}=SURFACE_SIDE_STYLE('',(#{c}));\
             #{e}=SURFACE_STYLE_USAGE(.BOTH.,#{d});#{f}=PRESENTATION_STYLE_ASSIGNMENT((#{e}));\
             #{g}=STYLED_ITEM('',(#{f}),#{item});",
            a = id + 1,
            b = id + 2,
            c = id + 3,
            d = id + 4,
            e = id + 5,
            f = id + 6,
            g = id + 7
        )
    };
    let data = "#50=CSG_SOLID('',#51);#51=BOOLEAN_RESULT('',.UNION.,#52,#9);#52=BOOLEAN_RESULT('',.DIFFERENCE.,#8,#58);\
                #58=BLOCK('',#4,1.,2.,3.);";
    let seen = |data: &str| -> Vec<[f32; 4]> { one(&read(data)).primitives().iter().map(|p| p.colour).collect() };
    let (red, green, blue) = ([1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]);
    let grey = crate::model::GREY;
    assert_eq!(seen(data), [grey; 3]);
    let styled = data.to_owned() + &style(200, "1.,0.,0.", 8) + &style(220, "0.,1.,0.", 52);
    assert_eq!(seen(&styled), [red, green, grey]);
    assert_eq!(seen(&(styled.clone() + &style(240, "0.,0.,1.", 50))), [red, green, blue]);
    assert_eq!(seen(&(styled + &style(240, "0.,0.,1.", 30))), [red, green, blue]);
}

/// A chain as deep as one likes; shared operations are one entity each, but not without end.
#[test]
fn graphs_of_any_form() {
    let chain: String = (0..150_000)
        .map(|k| format!("#{}=BOOLEAN_RESULT('',.{}.,#{},#9);", 1000 + k, ["UNION", "DIFFERENCE"][k % 2], 1001 + k))
        .collect();
    let import = read(&format!("#50=CSG_SOLID('',#1000);{chain}#151000=SPHERE('',1.,#6);"));
    assert_eq!((one(&import).primitives().len(), one(&import).tree().nodes().len()), (2, 300_001));
    let doubled = |end: usize| -> String {
        (0..end).map(|k| format!("#{}=BOOLEAN_RESULT('',.UNION.,#{},#{});", 1000 + k, 1001 + k, 1001 + k)).collect()
    };
    let import = read(&format!("#50=CSG_SOLID('',#1000);{}#1010=SPHERE('',1.,#6);", doubled(10)));
    assert_eq!((one(&import).primitives().len(), one(&import).tree().nodes().len()), (1, 2047));
    let import = read(&format!("#50=CSG_SOLID('',#1000);{}#1060=SPHERE('',1.,#6);", doubled(60)));
    let shared = "Boolean solid left out: #50: entities are shared so often that the file would not end";
    assert_eq!(told(&import), [shared]);
    // replicas of replicas
    let moved: String = (0..60)
        .map(|k| {
            let (a, b, c, d) = (1000 + 3 * k, 1001 + 3 * k, 1002 + 3 * k, 1003 + 3 * k);
            format!("#{a}=BOOLEAN_RESULT('',.UNION.,#{b},#{c});#{b}=SOLID_REPLICA('',#{d},#40);#{c}=SOLID_REPLICA('',#{d},#41);")
        })
        .collect();
    let operators = "#40=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',$,$,#1,$,$);\
                     #41=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',$,$,#6,$,$);";
    let import = read(&format!("#50=CSG_SOLID('',#1000);{operators}{moved}#1180=SPHERE('',1.,#6);"));
    assert!(told(&import)[0].contains("shared so often"), "{:?}", told(&import));
}

#[test]
fn each_fault_names_its_entity() {
    let pair = |op: &str, a: u32, b: u32| format!("#50=CSG_SOLID('',#51);#51=BOOLEAN_RESULT('',.{op}.,#{a},#{b});");
    let with = |leaf: &str| pair("UNION", 8, 60) + "#60=" + leaf + ";";
    for (data, expected) in [
        (pair("UNION", 8, 51), "#51 refers to itself"),
        (pair("UNION", 8, 50), "#50 refers to itself"),
        (
            with("SOLID_REPLICA('',#60,#40);#40=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',$,$,#1,$,$)"),
            "#60 refers to itself",
        ),
        (pair("UNION", 8, 99), "#99 does not exist"),
        (pair("XOR", 8, 9), "#51: the operator is no union, intersection or difference"),
        (pair("UNION", 8, 4), "#4 is AXIS2_PLACEMENT_3D, not an operand of a Boolean expression"),
        (
            with("CYCLIDE_SEGMENT_SOLID('',#4,1.,1.,0.,0.)"),
            "#60 is CYCLIDE_SEGMENT_SOLID, not an operand of a Boolean expression",
        ),
        (with("SPHERE('',-2.,#6)"), "#60: attribute 1 is not a length above 0"),
        (with("SPHERE('',0.,#6)"), "#60: attribute 1 is not a length above 0"),
        (with("SPHERE('',NaN,#6)"), "#60: attribute 1 is not a length above 0"),
        (with("SPHERE('',2.,$)"), "#60: attribute 2 is not a reference"),
        (with("BLOCK('',#4,1.,2.,0.)"), "#60: attribute 4 is not a length above 0"),
        (with("BLOCK('',#5,1.,2.,1.)"), "#5 is AXIS1_PLACEMENT, not AXIS2_PLACEMENT_3D"),
        (with("RIGHT_CIRCULAR_CONE('',#5,1.,-1.,45.)"), "#60: the radius of the cone is negative"),
        (with("RIGHT_CIRCULAR_CONE('',#5,1.,1.,90.)"), "#60: the angle of the cone is not between 0 and a right one"),
        (with("RIGHT_CIRCULAR_CONE('',#5,1.,1.,NaN)"), "#60: attribute 4 is not a finite number"),
        (with("RIGHT_ANGULAR_WEDGE('',#4,1.,1.,1.,1.)"), "#60: a wedge whose smaller side is not below its larger one"),
        (with("RECTANGULAR_PYRAMID('',#4,1.,2.,-3.)"), "#60: attribute 4 is not a length above 0"),
        (with("ECCENTRIC_CONE('',#4,1.,1.,1.,0.,0.,-0.5)"), "#60: the ratio of the cone's ends is negative"),
        (with("TETRAHEDRON('',(#1,#6,#1))"), "#60: the number of its corners is not that of its kind"),
        (with("TETRAHEDRON('',(#1,#6,#1,#6))"), "#60: a side has no area"),
        (with("TORUS('',#5,1.,-1.)"), "#60: attribute 3 is not a length above 0"),
        (
            with("HALF_SPACE_SOLID('',#61,.T.);#61=CONICAL_SURFACE('',#4,1.,45.)"),
            "a half-space of CONICAL_SURFACE is not supported (#61)",
        ),
        (with("HALF_SPACE_SOLID('',#8,.T.)"), "SPHERE is not supported (#8)"),
        (with("SPHERE('',1.E308,#6)"), "primitive 1: a dimension is not a finite number"),
        (with("MANIFOLD_SOLID_BREP('',#61);#61=CLOSED_SHELL('',())"), "its operand #60 has no face left"),
    ] {
        let import = read(&data);
        let all = told(&import);
        assert!(import.model.solids.is_empty() && import.model.parts.is_empty(), "{data}");
        assert!(all.contains(&format!("Boolean solid left out: {expected}")), "{data}: {all:#?}");
    }
}

/// Placed by an assembly, as often as it says; and once where no representation lists it. Operands are drawn by themselves
/// only where the operation that names them is lost.
#[test]
fn where_solids_stand() {
    let solid = "#50=CSG_SOLID('',#51);#51=BOOLEAN_RESULT('',.DIFFERENCE.,#70,#9);";
    let mapped = "#30=CSG_SHAPE_REPRESENTATION('',(#50,#4),#24);#31=REPRESENTATION_MAP(#4,#30);\
        #32=MAPPED_ITEM('',#31,#4);#33=MAPPED_ITEM('',#31,#34);#34=AXIS2_PLACEMENT_3D('',#35,#2,#3);\
        #35=CARTESIAN_POINT('',(5.,2.,3.));#36=SHAPE_REPRESENTATION('',(#32,#33),#24);";
    let found = import(&format!("{COMMON}{TETRAHEDRON}{}{solid}{mapped}", balls(solid)));
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    let places = |s: &Solid| s.primitives().iter().map(|p: &Primitive| p.transform.translation.x).collect::<Vec<_>>();
    let all: Vec<_> = found.model.solids.iter().map(places).collect();
    assert_eq!(all, [[0.0, 10.0], [40.0, 50.0]]);
    // unlisted
    let found = import(&format!("{COMMON}{TETRAHEDRON}{}{solid}", balls(solid)));
    let expected = "body without representation: drawn with the file's first units";
    assert_eq!((told(&found), found.model.solids.len(), found.model.parts.len()), (vec![expected.to_owned()], 1, 0));
    // without its operations
    let found = import(&format!("{COMMON}{TETRAHEDRON}{}", balls(solid)));
    assert_eq!((told(&found), found.model.solids.len(), found.model.parts.len()), (vec![expected.to_owned(); 2], 1, 1));
    assert!(found.model.solids.iter().all(|s| *s.tree() == Tree::leaf(0)));
}

/// Corners in centimetres, in model coordinates.
fn corners(points: &[[f64; 3]]) -> String {
    let point =
        |(i, p): (usize, &[f64; 3])| format!("#{}=CARTESIAN_POINT('',({:?},{:?},{:?}));", 70 + i, p[0], p[1], p[2]);
    points.iter().enumerate().map(point).collect()
}

#[test]
fn polytopes_by_their_corners() {
    let e = 1e-6;
    let tetrahedron = corners(&[[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]]);
    // in whatever order
    for list in ["#70,#71,#72,#73", "#73,#71,#70,#72"] {
        let found = read(&format!("#50=CSG_SOLID('',#51);#51=TETRAHEDRON('',({list}));{tetrahedron}"));
        holds(
            one(&found),
            &[
                (DVec3::splat(10.0 - e), true),
                (DVec3::splat(10.0 + e), false),
                (DVec3::splat(-e), false),
                (DVec3::splat(e), true),
            ],
        );
    }
    // a frustum: 4 wide at the bottom, 2 at 1
    let ring = |w: f64, z: f64| [[-w, -w, z], [w, -w, z], [w, w, z], [-w, w, z]];
    let frustum = corners(&[ring(2.0, 0.0), ring(1.0, 1.0)].concat());
    let list = "#70,#71,#72,#73,#74,#75,#76,#77";
    let found = read(&format!("#50=CSG_SOLID('',#51);#51=CONVEX_HEXAHEDRON('',({list}));{frustum}"));
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * 10.0;
    holds(
        one(&found),
        &[
            (at(1.5 - e, 0.0, 0.5), true),
            (at(1.5 + e, 0.0, 0.5), false),
            (at(0.0, -1.5 + e, 0.5), true),
            (at(0.0, -1.5 - e, 0.5), false),
            (at(0.9, 0.9, 1.0 - e), true),
            (at(0.9, 0.9, 1.0 + e), false),
        ],
    );
    for (list, message) in [
        ("#70,#72,#71,#73,#74,#75,#76,#77", "#51: a side has no area"),
        ("#70,#71,#72,#77,#74,#75,#76,#73", "#51: a side is not plane"),
    ] {
        let found = read(&format!("#50=CSG_SOLID('',#51);#51=CONVEX_HEXAHEDRON('',({list}));{frustum}"));
        assert_eq!((told(&found), found.model.solids.len()), (vec![format!("Boolean solid left out: {message}")], 0));
    }
}
