//! Instances and where they stand.

use super::import;
use glam::DVec3;
use std::fmt::Write;

/// One triangle as a surface model `#18` and what it needs; context `#1` is in millimetres, `#2` in
/// centimetres.
pub(super) const TRIANGLE: &str = "#1=(GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNIT_ASSIGNED_CONTEXT((#3)) REPRESENTATION_CONTEXT('',''));\
    #2=(GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNIT_ASSIGNED_CONTEXT((#4)) REPRESENTATION_CONTEXT('',''));\
    #3=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.));#4=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.CENTI.,.METRE.));\
    #11=CARTESIAN_POINT('',(0.,0.,0.));#12=CARTESIAN_POINT('',(1.,0.,0.));#13=CARTESIAN_POINT('',(0.,1.,0.));\
    #14=POLY_LOOP('',(#11,#12,#13));#15=FACE_OUTER_BOUND('',#14,.T.);#16=FACE('',(#15));#17=OPEN_SHELL('',(#16));\
    #18=SHELL_BASED_SURFACE_MODEL('the skin',(#17));\
    #21=DIRECTION('',(0.,0.,1.));#22=DIRECTION('',(0.,1.,0.));#23=CARTESIAN_POINT('',(1.,2.,3.));\
    #24=AXIS2_PLACEMENT_3D('',#11,$,$);#25=AXIS2_PLACEMENT_3D('',#23,#21,#22);#26=AXIS2_PLACEMENT_3D('',#12,$,$);\n";

/// A product `name` with definition `#base` shown by representation `shape`.
pub(super) fn product(base: u32, name: &str, shape: u32) -> String {
    let [f, p, s, d] = [base + 1, base + 2, base + 3, base + 4];
    format!(
        "#{base}=PRODUCT_DEFINITION('design','',#{f},$);#{f}=PRODUCT_DEFINITION_FORMATION('','',#{p});\
         #{p}=PRODUCT('{name}-id','{name}','',());#{s}=PRODUCT_DEFINITION_SHAPE('','',#{base});\
         #{d}=SHAPE_DEFINITION_REPRESENTATION(#{s},#{shape});\n"
    )
}

/// An occurrence of definition `child` in `parent`; `reps` and `items` in the order of the file.
pub(super) fn occurrence(base: u32, name: &str, defs: (u32, u32), reps: (u32, u32), items: (u32, u32)) -> String {
    let [s, r, t, c] = [base + 1, base + 2, base + 3, base + 4];
    format!(
        "#{base}=NEXT_ASSEMBLY_USAGE_OCCURRENCE('{base}','{name}','',#{},#{},$);#{s}=PRODUCT_DEFINITION_SHAPE('','',#{base});\
         #{r}=(REPRESENTATION_RELATIONSHIP('','',#{},#{}) REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#{t}) SHAPE_REPRESENTATION_RELATIONSHIP());\
         #{t}=ITEM_DEFINED_TRANSFORMATION('','',#{},#{});#{c}=CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#{r},#{s});\n",
        defs.0, defs.1, reps.0, reps.1, items.0, items.1
    )
}

pub(super) fn near(a: DVec3, b: DVec3) -> bool {
    (a - b).length() < 1e-12
}

#[test]
fn one_part_alone() {
    let import = import(&format!(
        "{TRIANGLE}{}#40=SHAPE_REPRESENTATION('',(#24),#1);\
        #41=MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#24,#18),#1);#42=SHAPE_REPRESENTATION_RELATIONSHIP('','',#40,#41);",
        product(30, "plate", 40)
    ));
    assert!(import.warnings.is_empty(), "{:?}", import.warnings);
    let model = &import.model;
    assert_eq!((model.parts.len(), model.instances.len(), model.face_count()), (1, 1, 1));
    assert_eq!((model.name.as_str(), model.parts[0].name.as_str(), model.unit.as_str()), ("plate", "plate", "mm"));
    assert_eq!(model.parts[0].faces[0].id, 16);
    assert!(!model.parts[0].closed);
    assert_eq!(
        (import.report.written_by.as_str(), import.report.format.as_str()),
        ("the writer", "STEP AUTOMOTIVE_DESIGN")
    );
}

/// The part in centimetres, the assembly in millimetres; the file lists child and parent in either
/// order. Placement 25 in the parent: at (1, 2, 3) mm, x to y. Placement 26 in the child: at 1 cm.
#[test]
fn placements_with_units_in_either_order() {
    for swapped in [false, true] {
        let shapes =
            "#40=SHAPE_REPRESENTATION('',(#24,#25),#1);#41=MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#24,#18),#2);";
        let (reps, items) = if swapped { ((40, 41), (25, 26)) } else { ((41, 40), (26, 25)) };
        let data = [
            TRIANGLE,
            shapes,
            &product(30, "box", 40),
            &product(50, "lid", 41),
            &occurrence(60, "lid:1", (30, 50), reps, items),
            &occurrence(70, "lid:2", (30, 50), if swapped { (40, 41) } else { (41, 40) }, (24, 24)),
        ];
        let import = import(&data.concat());
        assert!(import.warnings.is_empty(), "{:?}", import.warnings);
        let model = &import.model;
        assert_eq!((model.parts.len(), model.instances.len(), model.face_instance_count()), (1, 2, 2));
        assert_eq!(import.report.occurrences, ["lid:1", "lid:2"]);
        assert_eq!(model.name, "box");
        let at = |p: DVec3| model.instances[0].transform.transform_point3(p);
        assert!(near(at(DVec3::X * 10.0), DVec3::new(1.0, 2.0, 3.0)), "{:?}", at(DVec3::ZERO));
        assert!(near(at(DVec3::X * 11.0), DVec3::new(1.0, 3.0, 3.0)));
        assert!(near(at(DVec3::new(10.0, 1.0, 0.0)), DVec3::new(0.0, 2.0, 3.0)));
        assert!(near(model.instances[1].transform.transform_point3(DVec3::ONE), DVec3::ONE));
    }
}

#[test]
fn mapped_items_and_nested_names() {
    let data = format!(
        "{TRIANGLE}#40=SHAPE_REPRESENTATION('',(#24,#43,#44),#1);#41=MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#18),#1);\
         #42=REPRESENTATION_MAP(#26,#41);#43=MAPPED_ITEM('left',#42,#25);#44=MAPPED_ITEM('right',#42,#45);\
         #45=CARTESIAN_TRANSFORMATION_OPERATOR_3D('',$,'',$,$,#23,2.,$);\
         #46=SHAPE_REPRESENTATION('',(#24),#1);{}{}{}",
        product(50, "whole", 46),
        product(60, "pair", 40),
        occurrence(70, "pair:1", (50, 60), (40, 46), (24, 24))
    );
    let import = import(&data);
    assert!(import.warnings.is_empty(), "{:?}", import.warnings);
    assert_eq!(import.report.occurrences, ["pair:1/left", "pair:1/right"]);
    let at = |i: usize, p: DVec3| import.model.instances[i].transform.transform_point3(p);
    assert!(near(at(0, DVec3::X), DVec3::new(1.0, 2.0, 3.0)));
    assert!(near(at(0, DVec3::X * 2.0), DVec3::new(1.0, 3.0, 3.0)));
    // origin (1, 0, 0) to (1, 2, 3), scaled by 2
    assert!(near(at(1, DVec3::new(2.0, 0.0, 0.0)), DVec3::new(3.0, 2.0, 3.0)));
}

#[test]
fn representations_of_aspects_are_not_shapes() {
    let data = format!(
        "{TRIANGLE}#40=MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#18),#1);#41=SHAPE_REPRESENTATION('',(#16,#18),#1);\
         #42=SHAPE_ASPECT('','',#33,.T.);#43=PROPERTY_DEFINITION('','',#42);#44=SHAPE_DEFINITION_REPRESENTATION(#43,#41);{}",
        product(30, "p", 40)
    );
    assert_eq!(import(&data).model.face_instance_count(), 1);
}

#[test]
fn bodies_that_no_representation_lists_are_drawn() {
    let import = import(TRIANGLE);
    assert_eq!(import.model.face_instance_count(), 1);
    assert_eq!(
        import.warnings[0].to_string(),
        "t.step:8: #18: body without representation: drawn with the file's first units"
    );
}

#[test]
fn an_assembly_that_contains_itself_is_cut() {
    let data = [
        TRIANGLE,
        "#40=MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#18),#1);#41=SHAPE_REPRESENTATION('',(#24),#1);",
        &product(50, "a", 40),
        &product(60, "b", 41),
        &occurrence(70, "b in a", (50, 60), (41, 40), (24, 24)),
        &occurrence(80, "a in b", (60, 50), (40, 41), (24, 24)),
    ];
    let import = import(&data.concat());
    assert!(!import.model.instances.is_empty());
    assert!(
        import.warnings.iter().any(|w| w.to_string().contains("the assembly contains itself")),
        "{:?}",
        import.warnings
    );
}

/// Forty levels of two children each: 2^40 paths, cut off at the bound.
#[test]
fn exponential_assemblies_are_bounded() {
    let mut data = TRIANGLE.to_owned();
    data += "#100=MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#18),#1);";
    for level in 0..40u32 {
        let (rep, map) = (110 + level * 10, 111 + level * 10);
        let below = if level == 0 { 100 } else { rep - 10 };
        write!(
            data,
            "#{map}=REPRESENTATION_MAP(#24,#{below});#{}=MAPPED_ITEM('',#{map},#24);#{}=MAPPED_ITEM('',#{map},#25);\
             #{rep}=SHAPE_REPRESENTATION('',(#{},#{}),#1);",
            map + 1,
            map + 2,
            map + 1,
            map + 2
        )
        .unwrap();
    }
    let import = import(&data);
    assert_eq!(import.model.instances.len(), 1 << 20);
    assert!(
        import.warnings.iter().any(|w| w.message.contains("all but the first 1048576 instances")),
        "{:?}",
        import.warnings
    );
}

/// A hundred thousand levels of one child each: no cycle, and not called one.
#[test]
fn deep_assemblies_are_reported_as_deep() {
    let chain = |levels: u32, more: &str| {
        let mut data = format!("{TRIANGLE}{more}");
        data += "#100=MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#18),#1);";
        for level in 1..=levels {
            let [below, rep, map, item] = [100 + 3 * (level - 1), 100 + 3 * level, 101 + 3 * level, 102 + 3 * level];
            write!(
                data,
                "#{map}=REPRESENTATION_MAP(#24,#{below});#{item}=MAPPED_ITEM('',#{map},#24);\
                 #{rep}=SHAPE_REPRESENTATION('',(#{item}),#1);"
            )
            .unwrap();
        }
        import(&data)
    };
    let whole = chain(255, "");
    assert_eq!((whole.model.instances.len(), whole.warnings.len()), (1, 0), "{:?}", whole.warnings);
    for levels in [256, 100_000] {
        let (deep, why) = (chain(levels, ""), "1 x it is nested deeper than 256 levels");
        let told = deep.summary().to_string();
        assert!(told.starts_with("nothing of it can be drawn; ") && told.contains(why), "{told}");
        assert_eq!(deep.model.instances.len(), 0, "no part of the chain is a root");
        // placed by a chain of one level, too
        let shallow = "#9000000=SHAPE_REPRESENTATION('',(#9000001),#1);#9000001=MAPPED_ITEM('',#104,#24);";
        let both = chain(levels, shallow);
        assert_eq!(both.model.instances.len(), 1, "{}", both.summary());
    }
}
