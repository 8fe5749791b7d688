//! Layers, hidden items, annotation and curves: reported, not drawn.

use super::colours::SHAPE;
use super::import;
use crate::import::Import;

/// The two triangles `#16`, `#26` of [`SHAPE`], with styled items and a mapped copy `#72`.
fn read(data: &str) -> Import {
    let items = "#31=STYLED_ITEM('',(),#26);#32=STYLED_ITEM('',(),#18);\
        #70=REPRESENTATION_MAP(#71,#19);#71=AXIS2_PLACEMENT_3D('',#11,$,$);#72=MAPPED_ITEM('a',#70,#71);#73=MAPPED_ITEM('b',#70,#71);\
        #74=SHAPE_REPRESENTATION('',(#71,#72,#73),#1);";
    import(&[SHAPE, items, data].concat())
}

fn ignored(import: &Import) -> Vec<(&str, usize)> {
    import.report.ignored.iter().map(|(kind, count)| (kind.as_str(), *count)).collect()
}

#[test]
fn hidden_items_are_counted_and_not_drawn() {
    for (hidden, instances, faces, kind) in [
        ("#26", 2, 1, "hidden faces"),
        ("#31", 2, 1, "hidden faces"),
        ("#80", 2, 1, "hidden faces"),
        ("#17", 2, 0, "hidden shells"),
        ("#18", 0, 0, "hidden bodies"),
        ("#32", 0, 0, "hidden bodies"),
        ("#19", 0, 0, "hidden bodies"),
        ("#72", 1, 2, "hidden occurrences"),
    ] {
        let layer = "#80=PRESENTATION_LAYER_ASSIGNMENT('construction','',(#31));";
        let found = read(&format!("{layer}#81=INVISIBILITY(({hidden}));"));
        assert!(found.warnings.is_empty(), "{hidden}: {:?}", found.warnings);
        assert_eq!((found.model.instances.len(), found.model.face_count()), (instances, faces), "{hidden}");
        assert_eq!(ignored(&found), [(kind, 1)], "{hidden}");
    }
}

#[test]
fn layers_are_reported_with_the_number_of_their_items() {
    let layers = "#80=PRESENTATION_LAYER_ASSIGNMENT('a','',(#16,#26));#81=PRESENTATION_LAYER_ASSIGNMENT('b','',(#18));\
        #82=PRESENTATION_LAYER_ASSIGNMENT('a','',(#17));#83=PRESENTATION_LAYER_ASSIGNMENT('c','',#17);";
    let found = read(layers);
    let layers: Vec<_> = found.report.layers.iter().map(|(name, n)| (name.as_str(), *n)).collect();
    assert_eq!(layers, [("a", 3), ("b", 1)]);
    assert_eq!(found.warnings[0].to_string(), "t.step:8: #83: layer ignored: #83: attribute 3 is not a list");
    assert_eq!(found.model.face_instance_count(), 4);
}

#[test]
fn hidden_in_one_occurrence_only_is_reported() {
    let found = read(
        "#80=CONTEXT_DEPENDENT_OVER_RIDING_STYLED_ITEM('',(),#18,#31,(#72));#81=INVISIBILITY((#80));#82=INVISIBILITY((#999));",
    );
    let told: Vec<_> = found.warnings.iter().map(|w| w.to_string()).collect();
    let expected = [
        "t.step:8: #80: hidden in one occurrence: drawn all the same",
        "t.step:8: #82: invisibility ignored: #999 does not exist",
    ];
    assert_eq!(told, expected);
    assert_eq!(found.model.face_instance_count(), 4);
}

/// A kind that no program of today knows is no shape that is drawn, but it is counted; placements are not.
#[test]
fn items_of_unknown_kinds_are_counted() {
    let found = read("#80=FANCY_BODY('',#18);#82=SHAPE_REPRESENTATION('',(#71,#80),#1);");
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    assert_eq!(ignored(&found), [("FANCY_BODY", 1)]);
    assert_eq!(found.model.face_instance_count(), 4);
}

#[test]
fn curves_and_annotation_are_counted() {
    let found = read(
        "#80=GEOMETRIC_CURVE_SET('',(#81));#81=POLYLINE('',(#11,#12));#82=SHAPE_REPRESENTATION('',(#80),#1);\
        #83=GEOMETRIC_SET('',(#84,#81));#84=B_SPLINE_SURFACE_WITH_KNOTS('',1,1,((#11,#12),(#13,#10)),.U.,.F.,.F.,.F.,(2,2),(2,2),(0.,1.),(0.,1.),.U.);\
        #85=GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION('',(#83),#1);\
        #86=DRAUGHTING_CALLOUT('',());#87=ANNOTATION_CURVE_OCCURRENCE('',(),#81);#88=ANNOTATION_CURVE_OCCURRENCE('',(),#81);",
    );
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    let expected =
        [("ANNOTATION_CURVE_OCCURRENCE", 2), ("DRAUGHTING_CALLOUT", 1), ("GEOMETRIC_CURVE_SET", 1), ("POLYLINE", 1)];
    assert_eq!(ignored(&found), expected);
    assert_eq!(found.model.face_count(), 3);
}
