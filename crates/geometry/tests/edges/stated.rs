//! Edges that the source states as one.

use super::{check, counts, open, sheet};
use glam::{DVec2, DVec3};
use selvedge_geometry::model::{EdgeRef, EdgeSource, Face, FaceError, Part, TrimLoop};
use selvedge_geometry::spline::Bezier;

/// The border of the unit square as a loop whose sides are pieces of these edges.
fn stated(mut face: Face, edges: [Option<(u32, bool)>; 4]) -> Face {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
    let sides = (0..4).map(|k| Bezier::line(corners[k], corners[(k + 1) % 4])).collect();
    let edges = edges.map(|e| e.map(|(edge, forward)| EdgeRef { edge, forward })).to_vec();
    face.loops = vec![TrimLoop::new(sides, DVec2::ZERO).unwrap().with_edges(edges).unwrap()];
    face
}

/// Two squares `gap` apart that share edge 0, which has number 70 in the source; `forward` of the second's use.
fn pair(gap: f64, own: [bool; 2]) -> Part {
    // the first square's right side runs up; the second's left one down
    let mut part = open(vec![
        stated(
            sheet(1, DVec3::ZERO, DVec3::X, DVec3::Y),
            [Some((1, true)), Some((0, own[0])), Some((2, true)), Some((3, true))],
        ),
        stated(
            sheet(2, DVec3::X * (1.0 + gap), DVec3::X, DVec3::Y),
            [Some((4, true)), Some((5, true)), Some((6, true)), Some((0, own[1]))],
        ),
    ]);
    part.stated_edges = (0..7).map(|k| Some(EdgeSource { entity: 70 + k, item: (k == 6).then_some(3) })).collect();
    part
}

/// Far beyond what geometry alone would join.
#[test]
fn an_edge_of_the_source_is_one_however_sloppy() {
    let part = pair(0.01, [true, false]);
    let edges = part.edges().unwrap();
    assert_eq!(counts(&edges), [0, 1, 0, 6, 6]);
    let shared = edges.edges.iter().find(|e| e.uses.len() == 2).unwrap();
    assert_eq!(shared.source, Some(EdgeSource { entity: 70, item: None }));
    assert_eq!([shared.uses[0].forward, shared.uses[1].forward], [true, false]);
    assert!((edges.deviation - 0.01).abs() < 1e-12, "{}", edges.deviation);
    let mut sources: Vec<u32> = edges.edges.iter().map(|e| e.source.unwrap().entity).collect();
    sources.sort();
    assert_eq!(sources, [70, 71, 72, 73, 74, 75, 76]);
    check(&part, &edges, 0.0101, 0);
    // the same without the source's statement
    let mut bare = part;
    bare.faces.iter_mut().for_each(|f| f.loops = f.loops.drain(..).map(TrimLoop::without_edges).collect());
    assert_eq!(bare.edges().unwrap().single(), 8);
}

/// Its ends are the same in both faces, and between them one face's side is bowed.
#[test]
fn an_edge_of_the_source_is_as_far_off_as_its_faces_have_it() {
    let mut part = pair(0.0, [true, false]);
    let bowed = &part.faces[1].loops[0];
    let mut sides: Vec<Bezier<DVec3>> = bowed.curves().collect();
    sides[3].points = [(0.0, 1.0, 1.0), (0.02, 0.5, 1.0), (0.0, 0.0, 1.0)].map(DVec3::from).to_vec();
    let stated = bowed.edges().to_vec();
    part.faces[1].loops = vec![TrimLoop::new(sides, DVec2::ZERO).unwrap().with_edges(stated).unwrap()];
    let edges = part.edges().unwrap();
    for edge in &edges.edges {
        let wanted = if edge.uses.len() == 2 { 0.01 } else { 0.0 };
        assert!((edge.deviation - wanted).abs() < 1e-12, "{} uses: {}", edge.uses.len(), edge.deviation);
    }
    assert!((edges.deviation - 0.01).abs() < 1e-12, "{}", edges.deviation);
}

/// A claim that geometry contradicts: the two ends of the edge lie apart.
#[test]
fn an_edge_whose_uses_lie_apart_is_not_joined() {
    assert_eq!(pair(0.5, [true, false]).edges().unwrap().single(), 8);
    // both uses forwards, though the sides run against each other
    assert_eq!(pair(0.01, [true, true]).edges().unwrap().single(), 8);
}

/// Edges that the source separates, but geometry does not.
#[test]
fn edges_of_two_numbers_at_one_place_are_joined() {
    let mut part = pair(0.0, [true, false]);
    let edges = part.faces[1].loops[0].edges().to_vec();
    let mut other = edges;
    other[3] = Some(EdgeRef { edge: 6, forward: false });
    other[2] = None;
    part.faces[1].loops[0] = part.faces[1].loops[0].clone().with_edges(other).unwrap();
    let edges = part.edges().unwrap();
    assert_eq!(counts(&edges), [0, 1, 0, 6, 6]);
}

/// A side in two pieces of one edge, smooth at the joint, is one edge; of two edges, two.
#[test]
fn smooth_joints_part_edges_of_different_numbers() {
    let halves = |second: u32| {
        let corners = [(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
        let sides = (0..5).map(|k| Bezier::line(corners[k], corners[(k + 1) % 5])).collect();
        let edges = [0, second, 2, 3, 4].map(|edge| Some(EdgeRef { edge, forward: true })).to_vec();
        let mut face = sheet(1, DVec3::ZERO, DVec3::X, DVec3::Y);
        face.loops = vec![TrimLoop::new(sides, DVec2::ZERO).unwrap().with_edges(edges).unwrap()];
        Part { stated_edges: vec![None; 5], ..open(vec![face]) }.edges().unwrap()
    };
    assert_eq!(halves(0).edges.len(), 4);
    assert_eq!(halves(1).edges.len(), 5);
}

#[test]
fn references_follow_their_curves() {
    let loops = pair(0.0, [true, false]).faces[0].loops[0].clone();
    let back = loops.clone().reversed();
    let edges: Vec<_> = back.edges().iter().map(|e| e.map(|e| (e.edge, e.forward))).collect();
    assert_eq!(edges, [Some((3, false)), Some((2, false)), Some((0, false)), Some((1, false))]);
    assert_eq!(back.reversed(), loops);
    assert_eq!(loops.translated(DVec2::ONE).unwrap().edges(), loops.edges());
    assert_eq!(loops.with_point(0, 0, DVec2::splat(0.1)).unwrap().edges(), loops.edges());
    let short = loops.clone().with_edges(vec![None; 3]);
    assert_eq!(short, Err(FaceError::Edges { edges: 3, curves: 4 }));
    assert!(loops.without_edges().edges().is_empty());
}

#[test]
fn sources_are_called_by_number_and_place() {
    assert_eq!(EdgeSource { entity: 12, item: None }.to_string(), "#12");
    assert_eq!(EdgeSource { entity: 12, item: Some(3) }.to_string(), "#12, item 3");
}
