//! Files that contradict themselves: loops that nearly close, edges that miss their vertices, offsets on the other side.

use super::import;
use super::shapes::curve;
use crate::brep::CurveGeometry;
use crate::import::Import;
use crate::import::step;
use crate::model::TrimLoop;

/// A square of 10 mm with a round hole, both of one curve each; the hole's ends are 1e-10 mm apart.
const HOLE: &str = include_str!("hole_end_gap.stp");

/// A box of 10 mm; the line of one edge lies (3, 3, 3) off its vertices.
const BOX: &str = include_str!("line_off_its_vertices.stp");

fn told(import: &Import) -> Vec<String> {
    import.warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn a_hole_whose_ends_nearly_meet_is_there() {
    for gap in ["5.0", "5.000000000000001", "5.0000000001", "4.9999999999", "5.00000001", "5.0000003", "5.00001"] {
        let text = HOLE.replace("(7.0,5.0000000001,0.0)", &format!("(7.0,{gap},0.0)"));
        let i = step(text.as_bytes(), "t.stp").unwrap();
        let face = &i.model.parts[0].faces[0];
        assert_eq!(
            (face.loops.len(), i.report.warnings.contains_key("loop left out")),
            (2, false),
            "{gap}: {:?}",
            told(&i)
        );
        // the hole is the outer loop at half its size
        let areas: Vec<f64> = face.loops.iter().map(TrimLoop::signed_area).collect();
        assert!((areas[0] + 4.0 * areas[1]).abs() < 1e-4 * areas[0].abs(), "{gap}: {areas:?}");
    }
}

#[test]
fn a_closed_curve_trimmed_by_one_point_is_all_of_it() {
    let trimmed = |by: &str, sense: &str| {
        let points =
            "#101=B_SPLINE_CURVE_WITH_KNOTS('',1,(#4,#5,#6,#4),.UNSPECIFIED.,.T.,.F.,(2,1,1,2),(0.,1.,2.,3.),$);";
        curve(&format!("{points}#100=TRIMMED_CURVE('',#101,({by}),({by}),{sense},.CARTESIAN.);"))
    };
    for sense in [".T.", ".F."] {
        assert!(matches!(trimmed("#4", sense), CurveGeometry::Trimmed { start, end, .. } if end - start == 3.0));
        let CurveGeometry::Composite(parts) = trimmed("#5", sense) else { panic!("two parts") };
        let lengths = parts.iter().map(|p| match p {
            CurveGeometry::Trimmed { start, end, .. } => end - start,
            other => panic!("{other:?}"),
        });
        assert!((lengths.sum::<f64>() - 3.0).abs() < 1e-12);
    }
}

#[test]
fn a_line_off_its_vertices_gives_way() {
    let i = step(BOX.as_bytes(), "t.stp").unwrap();
    let told = told(&i);
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].ends_with(
        "#26: edge repaired: its curve misses its vertices by 4.243e0 mm: they and its faces say where it runs"
    ));
    let faces = &i.model.parts[0].faces;
    assert!(faces.len() == 6 && i.report.gap < 1e-12, "{}", i.report.gap);
    for face in faces {
        let grid = face.surface.patches();
        let corners = face.loops[0].curves().map(|c| c.point(0.0)).map(|p| grid.point(p.x, p.y));
        assert_eq!(corners.filter(|p| p.to_array().iter().all(|x| *x == 0.0 || *x == 10.0)).count(), 4);
    }
}

#[test]
fn an_offset_is_drawn_where_its_edges_are() {
    // a plane of 10 mm, 1 mm above its basis; its four edges at z
    let at = |z: &str| {
        let data = "#1=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\
            #2=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#1))REPRESENTATION_CONTEXT('',''));\
            #3=CARTESIAN_POINT('',(0.,0.,0.));#4=AXIS2_PLACEMENT_3D('',#3,$,$);#5=PLANE('',#4);\
            #6=OFFSET_SURFACE('',#5,1.,.F.);#11=CARTESIAN_POINT('',(0.,0.,Z));#12=CARTESIAN_POINT('',(9.,0.,Z));\
            #13=CARTESIAN_POINT('',(9.,9.,Z));#14=CARTESIAN_POINT('',(0.,9.,Z));\
            #20=POLY_LOOP('',(#11,#12,#13,#14));#21=FACE_OUTER_BOUND('',#20,.T.);#22=FACE_SURFACE('',(#21),#6,.T.);\
            #23=OPEN_SHELL('',(#22));#24=SHELL_BASED_SURFACE_MODEL('',(#23));\
            #25=MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#24),#2);";
        import(&data.replace('Z', z))
    };
    for (z, height, warnings) in [("1.", 1.0, 0), ("-1.", -1.0, 1), ("-0.4", 1.0, 4)] {
        let i = at(z);
        let (u, v) = i.model.parts[0].faces[0].surface.domain();
        let found = i.model.parts[0].faces[0].surface.patches().point(u.0, v.0).z;
        assert!((found - height).abs() < 1e-12, "{z}: {found}");
        assert_eq!(told(&i).len(), warnings, "{z}: {:?}", told(&i));
    }
    assert!(told(&at("-1."))[0].ends_with("#6: offset on the other side: its edges lie there, and so it is drawn"));
}
