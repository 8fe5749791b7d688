//! Placements whose relationship and transformation name child and parent in either order.

use super::assemblies::{TRIANGLE, near, occurrence, product};
use super::import;
use crate::import::{Import, step};
use glam::DVec3;

/// Reads the file with the relationship's representations and the transformation's items in this order.
fn read(representations: &str, items: &str) -> Import {
    let text = include_str!("cases/representations_swapped.stp");
    let (old, stated) = ("RELATIONSHIP('','',#182,#168)", "TRANSFORMATION('','',#159,#181)");
    assert!(text.contains(old) && text.contains(stated));
    let text = text.replace(old, &format!("RELATIONSHIP('','',{representations})"));
    step(text.replace(stated, &format!("TRANSFORMATION('','',{items})")).as_bytes(), "case.stp").unwrap()
}

/// The origin of the child, and the warnings.
fn found(import: &Import) -> (DVec3, Vec<String>) {
    assert_eq!(import.model.instances.len(), 1);
    let told = import.warnings.iter().map(ToString::to_string).collect();
    (import.model.instances[0].transform.transform_point3(DVec3::ZERO), told)
}

/// The child #168 lists its axes #159, the parent #182 lists #181 at x = 30.
#[test]
fn each_item_belongs_to_the_representation_that_lists_it() {
    for representations in ["#182,#168", "#168,#182"] {
        for items in ["#159,#181", "#181,#159"] {
            let (at, told) = found(&read(representations, items));
            assert!(near(at, DVec3::X * 30.0) && told.is_empty(), "{representations} {items}: {at} {told:?}");
        }
    }
}

/// If both list an item, the other item still decides.
#[test]
fn one_item_is_enough() {
    for (list, with) in [("(#177,#181)", "(#177,#181,#159)"), ("(#177,#181)", "(#177)")] {
        for representations in ["#182,#168", "#168,#182"] {
            let text = include_str!("cases/representations_swapped.stp").replace(list, with);
            let text = text.replace("'',#182,#168)", &format!("'',{representations})"));
            let (at, told) = found(&step(text.as_bytes(), "case.stp").unwrap());
            assert!(near(at, DVec3::X * 30.0) && told.is_empty(), "{with} {representations}: {at} {told:?}");
        }
    }
}

/// Items that no representation lists follow the order of the relationship, with a warning.
#[test]
fn unlisted_items_are_reported() {
    let text = include_str!("cases/representations_swapped.stp").replace("(#177,#181)", "(#177)");
    let text = text.replace("(#159,#155)", "(#155)");
    for (representations, x) in [("#168,#182", 30.0), ("#182,#168", -30.0)] {
        let text = text.replace("'',#182,#168)", &format!("'',{representations})"));
        let (at, told) = found(&step(text.as_bytes(), "case.stp").unwrap());
        assert!(near(at, DVec3::X * x), "{representations}: {at}");
        let message = "case.stp:193: #186: placement guessed: neither representation lists its items: taken in the order \
                       of the relationship";
        assert_eq!(told, [message]);
    }
}

/// A relationship that no CONTEXT_DEPENDENT_SHAPE_REPRESENTATION owns: the products determine the child.
#[test]
fn relationships_by_themselves_know_their_child() {
    for representations in ["#41,#40", "#40,#41"] {
        let whole = occurrence(60, "lid", (30, 50), (41, 40), (24, 25));
        let (usage, relation) = (whole.split(";#61").next().unwrap(), whole.split_once("#62=").unwrap().1);
        let relation = relation.split(";#64").next().unwrap().replace("#41,#40", representations);
        let data = [
            TRIANGLE,
            "#40=SHAPE_REPRESENTATION('',(#24,#25),#1);#41=MANIFOLD_SURFACE_SHAPE_REPRESENTATION('',(#24,#18),#1);",
            &product(30, "box", 40),
            &product(50, "lid", 41),
            &format!("{usage};#62={relation};"),
        ];
        let (at, told) = found(&import(&data.concat()));
        assert!(near(at, DVec3::new(1.0, 2.0, 3.0)) && told.is_empty(), "{representations}: {at} {told:?}");
    }
}
