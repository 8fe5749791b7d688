//! Scenes cut open.

use super::{import, refused};
use crate::model::Shape;
use glam::DVec3;

const BOXES: &str = "unit = \"cm\"\n\
    [solid.shell]\nshape = \"block\"\nsize = [4, 4, 1]\nfaces = true\n\
    [solid.ball]\nshape = \"sphere\"\nradius = 1\nat = [2, 2, 1]\n\
    [solid.window]\nshape = \"block\"\nfrom = [1, 1, 0]\nto = [3, 3, 2]\n";

#[test]
fn a_section_closes_what_it_cuts() {
    let cut = import(&format!("section = {{ normal = [2, 0, 0], offset = 4 }}\n{BOXES}"));
    let model = cut.model;
    // the shell, the ball and the window: all pass x = 20 mm
    assert_eq!((model.instances.len(), model.solids.len(), model.trim.is_some()), (0, 3, false));
    for solid in &model.solids {
        let cap = &solid.primitives()[1];
        assert!(matches!(cap.shape, Shape::Block { max, .. } if max.z == 0.0));
        assert!((cap.transform.translation.x - 20.0).abs() < 1e-12, "{}", cap.transform.translation);
    }
    let kept = import(&format!("section = [{{ normal = [1, 0, 0], offset = 5 }}, {{ normal = [0, 0, -1] }}]\n{BOXES}"));
    assert_eq!((kept.model.instances.len(), kept.model.solids.len()), (1, 2));
}

#[test]
fn a_volume_trims_and_is_not_drawn() {
    let cut = import(&format!("trim = \"window\"\n{BOXES}"));
    let volume = cut.model.trim.expect("a volume");
    assert_eq!(volume.bounds().max, DVec3::new(30.0, 30.0, 20.0));
    // the ball within it; the shell is a part
    assert_eq!((cut.model.instances.len(), cut.model.solids.len()), (1, 1));
    assert_eq!(cut.model.solids[0].primitives().len(), 2);
}

#[test]
fn parts_that_cannot_cut_are_reported() {
    let names = ["trim = \"shell\"", "trim = \"door\"", "section = { normal = [0, 0, 0] }", "section = { offset = 2 }"];
    let told = ["needs equations", "nothing is called `door`", "without length", "`normal` is missing"];
    for (text, message) in names.iter().zip(told) {
        let found = refused(&format!("{text}\n{BOXES}"));
        assert!(found.contains(message), "{text}: {found}");
    }
}
