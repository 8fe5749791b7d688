//! One occurrence, one instance: views, copies and mapped items that mention it add none.

use super::assemblies::{TRIANGLE, near, occurrence, product};
use super::colours::SHAPE;
use super::import;
use crate::import::{Import, step};
use glam::DVec3;

/// Reads a whole file of `cases/`.
fn case(text: &str) -> Import {
    step(text.as_bytes(), "case.stp").unwrap()
}

/// Instances, faces of all of them, and messages.
fn counts(import: &Import) -> (usize, usize, Vec<String>) {
    let told = import.warnings.iter().map(ToString::to_string).collect();
    (import.model.instances.len(), import.model.face_instance_count(), told)
}

/// Least and greatest x of a corner of the unit cube of 10 mm, over all instances.
fn span_x(import: &Import) -> (f64, f64) {
    let ends =
        import.model.instances.iter().flat_map(|i| [0.0, 10.0].map(|x| i.transform.transform_point3(DVec3::X * x).x));
    ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| (lo.min(x), hi.max(x)))
}

#[test]
fn saved_views_draw_nothing() {
    let text = include_str!("cases/saved_views.stp");
    assert_eq!(counts(&case(text)), (1, 6, vec![]));
    // not even where no product has the part
    let bare = text.replace("#169=SHAPE_DEFINITION_REPRESENTATION(#167,#168);", "");
    assert_eq!(counts(&case(&bare)), (1, 6, vec![]));
    // a view that is no view of presentation but a plain representation mentions the product's part, too
    let plain = text.replace("CHARACTERIZED_REPRESENTATION()DRAUGHTING_MODEL()", "");
    let found = case(&plain);
    assert_eq!(counts(&found), (1, 6, vec![]));
    assert_eq!(found.report.ignored["further mentions of drawn bodies"], 2);
}

#[test]
fn a_view_is_damaged_alone() {
    let text =
        include_str!("cases/saved_views.stp").replace("REPRESENTATION('view 1',(#171)", "REPRESENTATION('view 1',#171");
    assert_eq!(counts(&case(&text)).0, 1);
}

#[test]
fn tessellated_copies_are_one_mesh() {
    let text = include_str!("cases/tessellated_twice.stp");
    let found = case(text);
    assert_eq!((counts(&found), found.report.meshes), ((1, 0, vec![]), 1));
    assert_eq!(found.report.ignored["tessellated copies beside the products"], 1);
    // a shell in the representation that nothing refers to: a copy all the same
    let own = text
        .replace("REPRESENTATION('',(#8)", "REPRESENTATION('',(#80)")
        .replace("ENDSEC;\nEND", "#80=TESSELLATED_SHELL('',(#7),$);\nENDSEC;\nEND");
    let found = case(&own);
    assert_eq!((found.model.instances.len(), found.report.meshes), (1, 1));
    // it is the shape where the product has none
    let alone = own.replace("(#12,#8)", "(#12)");
    let found = case(&alone);
    assert_eq!((found.model.instances.len(), found.report.meshes), (1, 1));
    // without products a shell that two representations list is one
    let bare = text.replace("#22=SHAPE_DEFINITION_REPRESENTATION(#20,#21);", "");
    assert_eq!(case(&bare).model.instances.len(), 1);
}

#[test]
fn mapped_items_are_the_occurrences_that_they_place() {
    let text = include_str!("cases/mapped_items_with_occurrences.stp");
    let found = case(text);
    assert_eq!(counts(&found), (2, 12, vec![]));
    assert_eq!(span_x(&found), (20.0, 60.0));
    assert_eq!(found.report.occurrences, ["o0", "o1"]);
    // the occurrences' own representations missing: by name, in whatever order
    let kept = text.lines().filter(|line| !["#183=", "#193="].iter().any(|id| line.starts_with(id)));
    let unnamed = kept.collect::<Vec<_>>().join("\n").replace("(#179,#189,#197)", "(#189,#179,#197)");
    let found = case(&unnamed);
    assert_eq!((counts(&found), span_x(&found)), ((2, 12, vec![]), (20.0, 60.0)));
    assert_eq!(found.report.occurrences, ["o0", "o1"]);
    // the parent's representation missing them: from the occurrences' own
    let unlisted = text.replace("(#179,#189,#197)", "(#197)");
    let found = case(&unlisted);
    assert_eq!((counts(&found), span_x(&found)), ((2, 12, vec![]), (20.0, 60.0)));
    // one mapped item short: the second occurrence has no place, with a warning
    let short =
        text.replace("(#179,#189,#197)", "(#179,#197)").replace("REPRESENTATION('o1',(#189)", "REPRESENTATION('o1',()");
    let told = ["case.stp:197: #190: occurrence without placement: placed at the origin of its parent"];
    assert_eq!(counts(&case(&short)), (2, 12, told.map(str::to_owned).to_vec()));
}

/// The product `lid` in `box` once, by a relationship; `mention` adds another one.
fn stated_and(items: &str, mention: &str) -> Import {
    let data = [
        TRIANGLE,
        &format!(
            "#40=SHAPE_REPRESENTATION('',(#24,#25{items}),#1);#41=MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#24,#18),#1);"
        ),
        &product(30, "box", 40),
        &product(50, "lid", 41),
        &occurrence(60, "lid:1", (30, 50), (41, 40), (24, 25)),
        mention,
    ];
    import(&data.concat())
}

#[test]
fn an_occurrence_of_a_relationship_is_not_drawn_by_its_mapped_item_too() {
    let map = "#90=REPRESENTATION_MAP(#24,#41);#91=MAPPED_ITEM('',#90,#25);#92=MAPPED_ITEM('',#90,#26);";
    let at = |import: &Import, i: usize| import.model.instances[i].transform.transform_point3(DVec3::ZERO);
    let place = DVec3::new(1.0, 2.0, 3.0);
    let found = stated_and(",#91", map);
    assert_eq!(counts(&found), (1, 1, vec![]));
    assert!(near(at(&found, 0), place));
    // a second relationship of the same occurrence, as of its tessellated shape
    let twice = "#93=CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#62,#61);";
    assert_eq!(counts(&stated_and("", twice)), (1, 1, vec![]));
    // another relationship with another place: the first one counts
    let elsewhere = "#93=CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#94,#61);#95=ITEM_DEFINED_TRANSFORMATION('','',#24,#24);\
        #94=(REPRESENTATION_RELATIONSHIP('','',#41,#40) REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#95) SHAPE_REPRESENTATION_RELATIONSHIP());";
    let found = stated_and("", elsewhere);
    let told = "t.step:12: #93: occurrence at a second place: #60 is drawn at its first";
    assert_eq!(counts(&found), (1, 1, vec![told.into()]));
    assert!(near(at(&found, 0), place));
    // a mapped item elsewhere is a placement of its own
    assert_eq!(counts(&stated_and(",#92", map)), (2, 2, vec![]));
    let found = stated_and(",#91,#92", map);
    assert_eq!(counts(&found), (2, 2, vec![]));
    assert!(near(at(&found, 1), place) && near(at(&found, 0), DVec3::X));
}

/// A group of a product that only a ring of others holds is drawn, with a warning.
#[test]
fn a_ring_beside_a_tree_is_not_lost() {
    let ring = "#100=MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#104),#1);#101=SHAPE_REPRESENTATION('',(#24),#1);\
        #104=SHELL_BASED_SURFACE_MODEL('',(#105));#105=OPEN_SHELL('',(#106));#106=FACE('',(#15));";
    let data = [
        ring,
        &product(110, "a", 100),
        &product(120, "b", 101),
        &occurrence(130, "b in a", (110, 120), (101, 100), (24, 24)),
        &occurrence(140, "a in b", (120, 110), (100, 101), (24, 24)),
    ];
    let found = stated_and("", &data.concat());
    assert_eq!(found.model.instances.len(), 2);
    assert!(found.warnings.iter().any(|w| w.message.contains("contains itself")), "{:?}", found.warnings);
}

/// A second model of one triangle, which an aspect of the product has for its shape.
#[test]
fn the_body_of_a_feature_is_none_of_the_part() {
    let product = "#100=PRODUCT_DEFINITION('','',#101,$);#101=PRODUCT_DEFINITION_FORMATION('','',#102);#102=PRODUCT('a','a','',());\
        #130=PRODUCT_DEFINITION_SHAPE('','',#100);#131=SHAPE_DEFINITION_REPRESENTATION(#130,#19);\
        #160=SHAPE_ASPECT('','',#130,.T.);#161=PROPERTY_DEFINITION('','',#160);#162=SHAPE_DEFINITION_REPRESENTATION(#161,#163);\
        #163=SHAPE_REPRESENTATION('explicit geometry branch',(#165),#1);#165=SHELL_BASED_SURFACE_MODEL('',(#166));#166=OPEN_SHELL('',(#26));";
    let found = import(&[SHAPE, product].concat());
    assert_eq!(counts(&found), (1, 2, vec![]));
    assert_eq!(found.report.ignored["bodies of features"], 1);
    // a file that has lost the part's own shape draws the feature's
    let lost = SHAPE.replace("(#18),#1)", "(),#1)").replace("#18=SHELL_BASED_SURFACE_MODEL('',(#17));", "");
    let found = import(&[&lost, product].concat());
    assert!(found.warnings.iter().any(|w| w.to_string().contains("#165: body without")), "{:?}", found.warnings);
    assert!(!found.report.ignored.contains_key("bodies of features"));
}
