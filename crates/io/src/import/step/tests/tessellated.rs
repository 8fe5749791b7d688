//! Tessellated items: triangles by number, shared coordinates, normals, links to exact faces.

use super::colours::SHAPE;
use super::import;
use crate::import::Import;
use glam::DVec3;

/// A square `#31` in the plane z = 0 and its top, over [`SHAPE`]'s points and context.
const COORDINATES: &str =
    "#31=COORDINATES_LIST('',6,((0.,0.,0.),(1.,0,0.),(1.,1.,0.),(0.,1.,0.),(5.,5.,5.),(2.,0.,0.)));";

fn read(items: &str, list: &str) -> Import {
    import(&format!("{SHAPE}{COORDINATES}{items}#90=TESSELLATED_SHAPE_REPRESENTATION('',({list}),#1);"))
}

/// Triangles as points; no warning is expected.
fn triangles(import: &Import) -> Vec<[[f64; 2]; 3]> {
    assert!(import.warnings.is_empty(), "{:?}", import.warnings);
    let meshes = import.model.parts.iter().flat_map(|p| &p.meshes);
    let corners = meshes.flat_map(|m| (0..m.triangles().len()).map(|t| m.corners(t)));
    corners.map(|c| c.map(|p| [p.x, p.y])).collect()
}

const A: [f64; 2] = [0.0, 0.0];
const B: [f64; 2] = [1.0, 0.0];
const C: [f64; 2] = [1.0, 1.0];
const D: [f64; 2] = [0.0, 1.0];

#[test]
fn every_way_to_state_a_square() {
    for item in [
        "#40=TRIANGULATED_FACE('',#31,6,(),$,(),((1,2,3),(1,3,4)));",
        "#40=TRIANGULATED_FACE('',#31,4,((0.,0.,1.)),$,(1,2,3,4),((1,2,3),(1,3,4)));",
        "#40=TRIANGULATED_SURFACE_SET('',#31,6,(),(),((1,2,3),(1,3,4)));",
        "#40=COMPLEX_TRIANGULATED_FACE('',#31,6,(),$,(),(),((1,2,3,4)));",
        "#40=COMPLEX_TRIANGULATED_SURFACE_SET('',#31,6,(),(),(),((1,2,3,4)));",
        "#40=(COMPLEX_TRIANGULATED_FACE((),(),((1,2,3,4))) GEOMETRIC_REPRESENTATION_ITEM() REPRESENTATION_ITEM('') \
         TESSELLATED_FACE(#31,6,(),$) TESSELLATED_ITEM() TESSELLATED_STRUCTURED_ITEM());",
        // numbers name entries of pnindex: 1 is the first point, 2 the fourth
        "#40=TRIANGULATED_FACE('',#31,4,(),$,(1,4,3,2),((1,4,3),(1,3,2)));",
    ] {
        let found = read(item, "#40");
        assert_eq!(triangles(&found), [[A, B, C], [A, C, D]], "{item}");
        let mesh = &found.model.parts.iter().find(|p| !p.meshes.is_empty()).unwrap().meshes[0];
        assert_eq!((mesh.id, mesh.positions().len(), found.report.meshes), (40, 4, 1));
    }
    // every second triangle of a strip is turned
    let strip = read("#40=COMPLEX_TRIANGULATED_FACE('',#31,6,(),$,(),((1,2,4,3)),());", "#40");
    assert_eq!(triangles(&strip), [[A, B, D], [D, B, C]]);
}

#[test]
fn solids_shells_and_sets_hold_faces_with_their_colours() {
    let style = "#60=PRESENTATION_STYLE_ASSIGNMENT((#61));#61=SURFACE_STYLE_USAGE(.BOTH.,#62);#62=SURFACE_SIDE_STYLE('',(#63));\
        #63=SURFACE_STYLE_FILL_AREA(#64);#64=FILL_AREA_STYLE('',(#65));#65=FILL_AREA_STYLE_COLOUR('',#66);#66=COLOUR_RGB('',1.,0.,0.);\
        #67=STYLED_ITEM('',(#60),#41);";
    let found = read(
        &format!(
            "{style}#40=TRIANGULATED_FACE('',#31,6,(),$,(),((1,2,3)));#41=TRIANGULATED_FACE('',#31,6,(),$,(),((1,3,4)));\
            #42=TESSELLATED_SOLID('s',(#40,#41),$);#43=TESSELLATED_SHELL('',(#44),$);#44=TRIANGULATED_FACE('',#31,6,(),$,(),((2,6,3)));\
            #45=(GEOMETRIC_REPRESENTATION_ITEM() REPOSITIONED_TESSELLATED_ITEM(#46) REPRESENTATION_ITEM('') TESSELLATED_GEOMETRIC_SET((#44,#48)) TESSELLATED_ITEM());\
            #46=AXIS2_PLACEMENT_3D('',#47,$,$);#47=CARTESIAN_POINT('',(0.,0.,9.));#48=TESSELLATED_CURVE_SET('',#31,((1,2)));"
        ),
        "#42,#43,#45",
    );
    assert_eq!(triangles(&found).len(), 4);
    let parts: Vec<_> = found.model.parts.iter().filter(|p| !p.meshes.is_empty()).collect();
    assert_eq!(parts.iter().map(|p| p.closed).collect::<Vec<_>>(), [true, false, false]);
    let colours: Vec<_> = parts[0].meshes.iter().map(|m| m.colour).collect();
    assert_eq!(colours, [None, Some([1.0, 0.0, 0.0, 1.0])]);
    assert_eq!(parts[2].meshes[0].positions()[0], DVec3::new(1.0, 0.0, 9.0));
    assert_eq!(found.report.ignored["TESSELLATED_CURVE_SET"], 1);
}

#[test]
fn normals_belong_to_the_numbers_of_the_corners() {
    let found = read(
        "#40=TRIANGULATED_FACE('',#31,3,((0.,0.,1.),(0.,0.6,0.8),(0.,1.,0.)),$,(1,2,3),((1,2,3)));\
        #41=TRIANGULATED_FACE('',#31,6,((0.,0.,1.)),$,(),((1,2,3)));",
        "#40,#41",
    );
    assert_eq!(triangles(&found).len(), 2);
    let meshes: Vec<_> = found.model.parts.iter().flat_map(|p| &p.meshes).collect();
    assert_eq!(meshes[0].normals(), [[DVec3::Z, DVec3::new(0.0, 0.6, 0.8), DVec3::Y]]);
    assert_eq!(meshes[1].normals(), [[DVec3::Z; 3]]);
    let short = read("#40=TRIANGULATED_FACE('',#31,3,((0.,0.,1.),(0.,1.,0.)),$,(1,2,3),((1,2,3)));", "#40");
    assert_eq!(short.warnings[0].to_string(), "t.step:8: #40: normals ignored: they differ in number from the points");
    assert!(short.model.parts.iter().flat_map(|p| &p.meshes).all(|m| m.normals().is_empty()));
}

#[test]
fn what_doubles_an_exact_face_is_counted() {
    let found = read(
        "#40=TRIANGULATED_FACE('',#31,6,(),#16,(),((1,2,3)));#41=TRIANGULATED_FACE('',#31,6,(),#50,(),((1,3,4)));\
        #42=TESSELLATED_SHELL('',(#40,#41),$);#43=TESSELLATED_SHELL('',(#44),#17);#44=TRIANGULATED_FACE('',#31,6,(),$,(),((2,6,3)));\
        #50=PLANE('',#51);#51=AXIS2_PLACEMENT_3D('',#11,$,$);",
        "#42,#43",
    );
    // the face linked to a surface only is no double
    assert_eq!(triangles(&found), [[A, C, D]]);
    assert_eq!(found.report.ignored["tessellated items that double exact ones"], 2);
    assert_eq!(found.model.face_count(), 2);
}

#[test]
fn faults_name_the_item() {
    for (item, message) in [
        ("#40=TRIANGULATED_FACE('',#31,6,(),$,(),((1,2,7)));", "#40: a triangle names a point that is not there"),
        ("#40=TRIANGULATED_FACE('',#31,6,(),$,(1,99),((1,2,1)));", "#40: a triangle names a point that is not there"),
        ("#40=TRIANGULATED_FACE('',#31,6,(),$,(),((0,1,2)));", "#40: an index is not a number from 1"),
        ("#40=TRIANGULATED_FACE('',#31,6,(),$,(),((1,2)));", "#40: its triangles are not lists of three numbers"),
        ("#40=TRIANGULATED_FACE('',#31,6,(),$,(),(1,2));", "#40: its triangles are not lists of three numbers"),
        ("#40=TRIANGULATED_FACE('',#31,6,((0.,NaN,1.)),$,(),());", "#40: a coordinate or normal is not three finite"),
        ("#40=TRIANGULATED_FACE('',#39,6,(),$,(),());#39=COORDINATES_LIST('',1,((0.,0.)));", "#39: a coordinate or"),
        ("#40=TRIANGULATED_FACE('',#99,6,(),$,(),());", "#99 does not exist"),
        ("#40=TESSELLATED_SOLID('',(#40),$);", "#40 refers to itself"),
        ("#40=TESSELLATED_SHELL('',(#99),$);", "#99 does not exist"),
    ] {
        let found = read(item, "#40");
        let told: Vec<_> = found.warnings.iter().map(|w| w.to_string()).collect();
        assert!(told.len() == 1 && told[0].contains(message), "{item}: {told:?}");
        assert_eq!(found.report.meshes, 0);
    }
}

/// A hundred thousand triangles of one list named by every face: the work is cut off.
#[test]
fn sharing_is_bounded() {
    let strip = "1,2,3,4,".repeat(10_000);
    let mut data = format!("#40=COMPLEX_TRIANGULATED_SURFACE_SET('',#31,6,(),(),(({strip}1,2)),());");
    let mut below = 40;
    for level in 0..20 {
        let id = 100 + level;
        data += &format!("#{id}=TESSELLATED_GEOMETRIC_SET('',(#{below},#{below},#{below},#{below}));");
        below = id;
    }
    let found = read(&data, "#119");
    assert!(found.warnings.iter().any(|w| w.message.contains("shared so often")), "{:?}", found.warnings);
}
