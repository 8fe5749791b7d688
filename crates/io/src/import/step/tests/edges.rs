//! Which edges of a file the trim curves are pieces of.

use crate::import::step;
use crate::model::{Edge, EdgeKind, Part};

const GOOD: &str = include_str!("good.step");

fn part(text: &str) -> Part {
    step(text.as_bytes(), "t.step").unwrap().model.parts.remove(0)
}

fn counts(part: &Part) -> [usize; 5] {
    let c = part.edges().unwrap().counts();
    [c.sharp, c.smooth, c.seams, c.borders, c.vertices]
}

fn number(edge: &Edge) -> u32 {
    edge.source.expect("the file has its number").entity
}

/// A cylinder: two circles and the seam between them, by their numbers.
#[test]
fn edges_have_the_numbers_of_the_file() {
    let part = part(GOOD);
    assert_eq!(counts(&part), [2, 0, 1, 0, 2]);
    let edges = part.edges().unwrap();
    let mut found: Vec<_> = edges.edges.iter().map(|e| (number(e), e.kind, e.uses.len())).collect();
    found.sort();
    assert_eq!(found, [(46, EdgeKind::Sharp, 2), (47, EdgeKind::Sharp, 2), (48, EdgeKind::Seam, 2)]);
    // the seam is run once each way, on one face
    let seam = edges.edges.iter().find(|e| number(e) == 48).unwrap();
    assert_eq!(seam.uses[0].face, seam.uses[1].face);
    assert_ne!(seam.uses[0].forward, seam.uses[1].forward);
    let references: Vec<_> = part.faces[0].loops[0].edges().iter().map(|e| e.map(|e| (e.edge, e.forward))).collect();
    assert!(references.iter().all(Option::is_some), "{references:?}");
    let mut seams: Vec<bool> = references
        .iter()
        .flatten()
        .filter(|e| part.stated_edges[e.0 as usize].unwrap().entity == 48)
        .map(|e| e.1)
        .collect();
    seams.dedup();
    assert_eq!(seams.len(), 2, "{references:?}");
}

/// A face less: its rim is a free border that keeps its number.
#[test]
fn a_lost_face_leaves_a_border() {
    let text = GOOD.replace("CLOSED_SHELL('',(#61,#62,#63))", "CLOSED_SHELL('',(#61,#62))");
    let model = step(text.as_bytes(), "t.step").unwrap().model;
    let part = model.parts.into_iter().find(|p| p.faces.len() == 2).unwrap();
    assert_eq!(counts(&part), [1, 0, 1, 1, 2]);
    let edges = part.edges().unwrap();
    assert_eq!(number(edges.edges.iter().find(|e| e.kind == EdgeKind::Border).unwrap()), 47);
}

/// Without a seam in the file the importer makes one: it has no number, and the circles that it cuts keep theirs.
#[test]
fn an_inserted_seam_has_no_number() {
    let text = GOOD.replace("EDGE_LOOP('',(#51,#52,#53,#49))", "EDGE_LOOP('',(#51))");
    let text = text.replace("#50=EDGE_LOOP", "#70=EDGE_LOOP('',(#53));\n#50=EDGE_LOOP");
    let text =
        text.replace("#61=ADVANCED_FACE('',(#59),", "#71=FACE_BOUND('',#70,.T.);\n#61=ADVANCED_FACE('',(#59,#71),");
    let part = part(&text);
    assert_eq!(counts(&part), [2, 0, 1, 0, 2]);
    let edges = part.edges().unwrap();
    let mut numbers: Vec<_> = edges.edges.iter().map(|e| (e.kind, e.source.map(|s| s.entity))).collect();
    numbers.sort();
    assert_eq!(numbers, [(EdgeKind::Sharp, Some(46)), (EdgeKind::Sharp, Some(47)), (EdgeKind::Seam, None)]);
}
