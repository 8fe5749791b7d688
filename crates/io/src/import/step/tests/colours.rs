//! Colours: whose, and how much of them.

use super::import;
use crate::model::Colour;

/// Two triangles `#16`, `#26` in one shell `#17` of a surface model `#18`.
pub(super) const SHAPE: &str = "#1=(GEOMETRIC_REPRESENTATION_CONTEXT(3) REPRESENTATION_CONTEXT('',''));\
    #11=CARTESIAN_POINT('',(0.,0.,0.));#12=CARTESIAN_POINT('',(1.,0.,0.));#13=CARTESIAN_POINT('',(0.,1.,0.));#10=CARTESIAN_POINT('',(1.,1.,0.));\
    #14=POLY_LOOP('',(#11,#12,#13));#15=FACE_OUTER_BOUND('',#14,.T.);#16=FACE('',(#15));\
    #24=POLY_LOOP('',(#12,#10,#13));#25=FACE_OUTER_BOUND('',#24,.T.);#26=FACE('',(#25));\
    #17=OPEN_SHELL('',(#16,#26));#18=SHELL_BASED_SURFACE_MODEL('',(#17));\
    #19=MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#18),#1);";

/// A fill style `#base` that ends in colour `#colour`.
fn style(base: u32, colour: u32) -> String {
    let [u, s, f, a, c] = [base + 1, base + 2, base + 3, base + 4, base + 5];
    format!(
        "#{base}=PRESENTATION_STYLE_ASSIGNMENT((#{u}));#{u}=SURFACE_STYLE_USAGE(.BOTH.,#{s});#{s}=SURFACE_SIDE_STYLE('',(#{f}));\
         #{f}=SURFACE_STYLE_FILL_AREA(#{a});#{a}=FILL_AREA_STYLE('',(#{c}));#{c}=FILL_AREA_STYLE_COLOUR('',#{colour});"
    )
}

const PALETTE: &str =
    "#80=COLOUR_RGB('',0.5,0.04,1);#81=DRAUGHTING_PRE_DEFINED_COLOUR('green');#82=COLOUR_RGB('',1.,0.,0.);";

/// sRGB 0.5 is 0.21404114 and 0.04 is 0.04 / 12.92 in linear light (IEC 61966-2-1).
const HALF: Colour = [0.214_041_14, 0.003_095_975_2, 1.0, 1.0];
const GREEN: Colour = [0.0, 1.0, 0.0, 1.0];
const RED: Colour = [1.0, 0.0, 0.0, 1.0];

fn faces(styles: &str) -> [Option<Colour>; 2] {
    let import = import(&[SHAPE, PALETTE, &style(30, 80), &style(40, 81), &style(50, 82), styles].concat());
    let told: Vec<_> = import.warnings.iter().map(|w| w.message.as_str()).collect();
    let glass = styles.contains("TRANSPARENT").then_some("transparent colour: kept in the model, drawn opaque");
    assert_eq!(told, glass.as_slice());
    [0, 1].map(|i| import.model.parts[0].faces[i].colour)
}

fn same(a: Option<Colour>, b: Colour) -> bool {
    a.is_some_and(|a| a.iter().zip(b).all(|(x, y)| (x - y).abs() < 1e-6))
}

#[test]
fn no_style_no_colour() {
    assert_eq!(faces(""), [None, None]);
}

#[test]
fn every_level_and_its_rank() {
    for item in [19, 18, 17] {
        let all = faces(&format!("#90=STYLED_ITEM('',(#30),#{item});"));
        assert!(same(all[0], HALF) && same(all[1], HALF), "#{item}: {all:?}");
    }
    let mixed = faces("#90=STYLED_ITEM('',(#30),#18);#91=STYLED_ITEM('',(#40),#26);");
    assert!(same(mixed[0], HALF) && same(mixed[1], GREEN), "{mixed:?}");
    // an overriding style wins on its own item, whatever the order in the file
    let over = faces(
        "#89=OVER_RIDING_STYLED_ITEM('',(#50),#26,#91);#90=STYLED_ITEM('',(#30),#17);#91=STYLED_ITEM('',(#40),#26);",
    );
    assert!(same(over[0], HALF) && same(over[1], RED), "{over:?}");
}

#[test]
fn transparency_is_opacity_turned_round() {
    let glass = "#60=PRESENTATION_STYLE_ASSIGNMENT((#61));#61=SURFACE_STYLE_USAGE(.BOTH.,#62);#62=SURFACE_SIDE_STYLE('',(#63));\
        #63=SURFACE_STYLE_RENDERING_WITH_PROPERTIES(.NORMAL_SHADING.,#81,(#64));#64=SURFACE_STYLE_TRANSPARENT(0.25);#90=STYLED_ITEM('',(#60),#18);";
    assert!(same(faces(glass)[0], [0.0, 1.0, 0.0, 0.75]));
}

#[test]
fn curve_styles_do_not_paint_faces() {
    let curve = "#60=PRESENTATION_STYLE_ASSIGNMENT((#61));#61=CURVE_STYLE('',$,$,#82);#90=STYLED_ITEM('',(#60),#16);";
    assert_eq!(faces(curve), [None, None]);
}

#[test]
fn occurrences_have_their_own_colour() {
    let mapped = "#70=REPRESENTATION_MAP(#71,#19);#71=AXIS2_PLACEMENT_3D('',#11,$,$);#72=MAPPED_ITEM('a',#70,#71);#73=MAPPED_ITEM('b',#70,#71);\
        #74=SHAPE_REPRESENTATION('',(#72,#73),#1);#90=STYLED_ITEM('',(#50),#73);";
    let found = import(&[SHAPE, PALETTE, &style(50, 82), mapped].concat());
    let colours: Vec<_> = found.model.instances.iter().map(|i| i.colour).collect();
    assert_eq!(colours, [None, Some(RED)]);
}

#[test]
fn a_style_that_refers_to_itself_costs_its_colour() {
    let cyclic =
        "#60=PRESENTATION_STYLE_ASSIGNMENT((#61));#61=SURFACE_STYLE_USAGE(.BOTH.,#60);#90=STYLED_ITEM('',(#60),#18);";
    let found = import(&format!("{SHAPE}{cyclic}"));
    assert_eq!(found.model.face_count(), 2);
    assert_eq!(found.warnings[0].to_string(), "t.step:8: #90: colour ignored: #60 refers to itself");
}
