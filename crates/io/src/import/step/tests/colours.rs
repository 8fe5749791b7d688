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
    assert!(import.warnings.is_empty(), "{:?}", import.warnings);
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

/// Styles of curves on a surface, with another colour before and after that of the area.
#[test]
fn curves_on_a_surface_do_not_paint_it() {
    let line = "#59=CURVE_STYLE('',$,$,#82);#58=SURFACE_STYLE_PARAMETER_LINE(#59,(1));#57=SURFACE_STYLE_SILHOUETTE(#59);\
        #56=SURFACE_STYLE_CONTROL_GRID(#59);#49=SURFACE_STYLE_SEGMENTATION_CURVE(#59);#48=SURFACE_STYLE_BOUNDARY(#59);";
    let whole = |styles: &str| {
        format!(
            "{line}#60=PRESENTATION_STYLE_ASSIGNMENT((#61));#61=SURFACE_STYLE_USAGE(.BOTH.,#62);\
             #62=SURFACE_SIDE_STYLE('',({styles}));#90=STYLED_ITEM('',(#60),#18);"
        )
    };
    for curves in ["#48", "#49", "#56", "#57", "#58"] {
        for styles in [format!("{curves},#43"), format!("#43,{curves}")] {
            let found = faces(&whole(&styles));
            assert!(same(found[0], GREEN) && same(found[1], GREEN), "{styles}: {found:?}");
        }
        assert_eq!(faces(&whole(curves)), [None, None], "{curves}");
        let found = import(&[SHAPE, PALETTE, &whole(curves)].concat());
        assert_eq!(found.report.ignored["colours of the curves on a surface"], 1);
    }
}

/// A name that the standard does not have, and a kind of colour that is not read.
#[test]
fn unknown_colours_are_reported() {
    for (colour, name) in [
        ("DRAUGHTING_PRE_DEFINED_COLOUR('orange')", "DRAUGHTING_PRE_DEFINED_COLOUR"),
        ("COLOUR_SPECIFICATION('orange')", "COLOUR_SPECIFICATION"),
    ] {
        let one = format!("{SHAPE}{}#89={colour};#90=STYLED_ITEM('',(#30),#18);", style(30, 89));
        let found = import(&one);
        let told: Vec<_> = found.warnings.iter().map(|w| w.message.clone()).collect();
        assert_eq!(told, [format!("colour ignored: {name} #89 is no colour that is known")]);
        assert!(found.model.parts[0].faces.iter().all(|f| f.colour.is_none()));
    }
}

#[test]
fn glass_is_kept_as_glass_without_a_word() {
    let found = crate::import::step(include_bytes!("cases/transparent.stp"), "case.stp").unwrap();
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    let colours: Vec<_> = found.model.parts[0].faces.iter().map(|f| f.colour.unwrap()[3]).collect();
    assert!(colours.len() == 6 && colours.iter().all(|a| (a - 0.3).abs() < 1e-6), "{colours:?}");
}

#[test]
fn occurrences_have_their_own_colour() {
    let mapped = "#70=REPRESENTATION_MAP(#71,#19);#71=AXIS2_PLACEMENT_3D('',#11,$,$);#72=MAPPED_ITEM('a',#70,#71);#73=MAPPED_ITEM('b',#70,#71);\
        #74=SHAPE_REPRESENTATION('',(#72,#73),#1);#90=STYLED_ITEM('',(#50),#73);";
    let found = import(&[SHAPE, PALETTE, &style(50, 82), mapped].concat());
    let colours: Vec<_> = found.model.instances.iter().map(|i| i.colour).collect();
    assert_eq!(colours, [None, Some(RED)]);
}

/// A part that is used twice, with a style for the representation of each occurrence.
#[test]
fn an_occurrence_has_the_colour_of_its_own_representation() {
    let found = |item: u32, context: u32, more: &str| {
        let part = |id: u32, name: &str| {
            format!(
                "#{id}=PRODUCT_DEFINITION('','',#{f},$);#{f}=PRODUCT_DEFINITION_FORMATION('','',#{p});#{p}=PRODUCT('{name}','{name}','',());",
                f = id + 1,
                p = id + 2
            )
        };
        let usage = |id: u32, frame: u32| {
            let [c, r, t, s, d, own] = [1, 2, 3, 4, 5, 6].map(|i| id + i);
            format!(
                "#{id}=NEXT_ASSEMBLY_USAGE_OCCURRENCE('{id}','','',#110,#100,$);#{c}=CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#{r},#{s});\
                 #{r}=(REPRESENTATION_RELATIONSHIP('','',#19,#132)REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#{t})SHAPE_REPRESENTATION_RELATIONSHIP());\
                 #{t}=ITEM_DEFINED_TRANSFORMATION('','',#120,#{frame});#{s}=PRODUCT_DEFINITION_SHAPE('','',#{id});\
                 #{d}=SHAPE_DEFINITION_REPRESENTATION(#{s},#{own});#{own}=SHAPE_REPRESENTATION('',(#{frame}),#1);"
            )
        };
        let frames = "#120=AXIS2_PLACEMENT_3D('',#11,$,$);#121=AXIS2_PLACEMENT_3D('',#12,$,$);\
            #130=PRODUCT_DEFINITION_SHAPE('','',#100);#131=SHAPE_DEFINITION_REPRESENTATION(#130,#19);\
            #133=PRODUCT_DEFINITION_SHAPE('','',#110);#132=SHAPE_REPRESENTATION('',(#120,#121),#1);#134=SHAPE_DEFINITION_REPRESENTATION(#133,#132);";
        let shape = SHAPE.replace("(#18),#1)", "(#18,#120),#1)");
        let styles = format!(
            "#90=STYLED_ITEM('',(#91),#{item});#91=PRESENTATION_STYLE_BY_CONTEXT((#51),#{context});\
             #92=STYLED_ITEM('',(#93),#18);#93=PRESENTATION_STYLE_BY_CONTEXT((#41),#146);"
        );
        let all = [part(100, "a"), part(110, "b"), usage(140, 120), usage(150, 121)].concat();
        let found = import(&[&shape, PALETTE, &style(40, 81), &style(50, 82), &all, frames, &styles, more].concat());
        let colours: Vec<_> = found.model.instances.iter().map(|i| i.colour).collect();
        let own = found.model.parts.first().and_then(|p| p.faces[0].colour);
        (colours, own, found.warnings.iter().map(ToString::to_string).collect::<Vec<_>>())
    };
    // each its own; by the representation that lists the body
    for item in [18, 19] {
        assert_eq!(found(item, 156, ""), (vec![Some(GREEN), Some(RED)], None, Vec::new()), "#{item}");
    }
    // hidden there, or everywhere
    assert_eq!(found(18, 156, "#95=INVISIBILITY((#90));"), (vec![Some(GREEN)], None, Vec::new()));
    assert_eq!(found(18, 156, "#95=INVISIBILITY((#18));").0, []);
    // the context is that of the part itself: no occurrence's
    assert_eq!(found(18, 19, ""), (vec![Some(GREEN), None], Some(RED), Vec::new()));
    let (colours, own, told) = found(16, 156, "");
    assert_eq!((colours, own), (vec![Some(GREEN), None], None));
    assert!(
        told.len() == 1 && told[0].ends_with("colour ignored: #16 is a part of a body, and it is for one occurrence"),
        "{told:?}"
    );
}

#[test]
fn a_style_that_refers_to_itself_costs_its_colour() {
    let cyclic =
        "#60=PRESENTATION_STYLE_ASSIGNMENT((#61));#61=SURFACE_STYLE_USAGE(.BOTH.,#60);#90=STYLED_ITEM('',(#60),#18);";
    let found = import(&format!("{SHAPE}{cyclic}"));
    assert_eq!(found.model.face_count(), 2);
    assert_eq!(found.warnings[0].to_string(), "t.step:8: #90: colour ignored: #60 refers to itself");
}
