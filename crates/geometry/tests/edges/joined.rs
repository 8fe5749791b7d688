//! Faces joined by geometry.

use super::{at, check, counts, open, sheet};
use glam::{DAffine3, DVec3};
use selvedge_geometry::construct::shapes;
use selvedge_geometry::edges::REACH;
use selvedge_geometry::model::{EdgeKind, Part};

/// A long side beside two short ones: the vertex of the neighbours cuts it.
#[test]
fn a_vertex_of_neighbours_cuts_a_side() {
    let long = sheet(1, DVec3::ZERO, DVec3::X * 3.0, -DVec3::Y);
    let part =
        open(vec![long, sheet(2, DVec3::ZERO, DVec3::X, DVec3::Y), sheet(3, DVec3::X, DVec3::X * 2.0, DVec3::Z)]);
    let edges = part.edges().unwrap();
    // three borders each; the long side continues one neighbour and meets the other at a right angle
    assert_eq!(counts(&edges), [1, 1, 0, 9, 9]);
    let mut ranges: Vec<_> =
        edges.edges.iter().flat_map(|e| &e.uses).filter(|u| u.face == 0).map(|u| u.range).collect();
    ranges.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!((ranges[0].1 - 1.0 / 3.0).abs() < 1e-9 && ranges[0].1 == ranges[1].0, "{ranges:?}");
    check(&part, &edges, 1e-8, 0);
}

/// Within a hundred-thousandth of the diagonal, and not beyond it.
#[test]
fn faces_within_reach_are_joined() {
    let pair = |gap: f64| {
        open(vec![
            sheet(1, DVec3::ZERO, DVec3::X, DVec3::Y),
            sheet(2, DVec3::X * (1.0 + gap), DVec3::X, DVec3::Y),
            sheet(3, DVec3::Y * (1.0 + gap), DVec3::X, DVec3::Y),
        ])
    };
    let reach = REACH * pair(0.0).control_bounds().diagonal();
    let joined = pair(0.9 * reach).edges().unwrap();
    assert_eq!(joined.edges.iter().filter(|e| e.uses.len() == 2).count(), 2);
    assert!((joined.reach - reach).abs() < 1e-3 * reach);
    assert!(joined.deviation > 0.5 * reach && joined.deviation <= reach);
    assert_eq!(pair(1.2 * reach).edges().unwrap().single(), 12);
}

/// Three sheets at one line: one edge, of three uses.
#[test]
fn three_faces_share_an_edge() {
    let part = open(vec![
        sheet(1, DVec3::ZERO, DVec3::X, DVec3::Z),
        sheet(2, DVec3::ZERO, -DVec3::X, DVec3::Z),
        sheet(3, DVec3::ZERO, DVec3::Y, DVec3::Z),
    ]);
    let edges = part.edges().unwrap();
    assert_eq!(counts(&edges), [1, 0, 0, 9, 8]);
    let shared = edges.edges.iter().find(|e| e.kind == EdgeKind::Sharp).unwrap();
    assert_eq!(shared.uses.len(), 3);
    assert_eq!(edges.single(), 9);
    assert!(!edges.closed());
    check(&part, &edges, 1e-12, 0);
}

/// Two blocks that touch along a line: each keeps its own edge there.
#[test]
fn solids_that_touch_along_an_edge_stay_closed() {
    let mut part = shapes::block(DVec3::ZERO, DVec3::ONE).unwrap().part;
    let moved = DAffine3::from_translation(DVec3::new(1.0, 1.0, 0.0));
    let more: Vec<_> = part
        .faces
        .iter()
        .map(|f| {
            let mut face = f.clone();
            face.surface = f.surface.transformed(&moved);
            face
        })
        .collect();
    part.faces.extend(more);
    let edges = part.edges().unwrap();
    assert_eq!(counts(&edges), [24, 0, 0, 0, 14]);
    assert!(edges.closed());
}

/// A pipe between two others meets them in curves without an equation: fitted, on the first face, within the stated
/// deviation.
#[test]
fn a_fitted_curve_reports_its_error() {
    use glam::DVec2;
    use selvedge_geometry::model::TrimLoop;
    use selvedge_geometry::spline::Bezier;
    let mut part = shapes::sphere(2.0).unwrap().part;
    let ((u0, u1), (v0, v1)) = part.faces[0].surface.domain();
    let at_share = |s: f64, t: f64| DVec2::new(u0 + (u1 - u0) * s, v0 + (v1 - v0) * t);
    let corners = [(0.1, 0.3), (0.4, 0.35), (0.3, 0.7)].map(|(s, t)| at_share(s, t));
    let sides = (0..3).map(|k| Bezier::line(corners[k], corners[(k + 1) % 3])).collect();
    part.faces[0].loops = vec![TrimLoop::new(sides, DVec2::ZERO).unwrap()];
    part.closed = false;
    let edges = part.edges().unwrap();
    assert_eq!(counts(&edges), [0, 0, 0, 3, 3]);
    let size = part.faces[0].control_bounds().diagonal();
    assert!(edges.deviation > 0.0 && edges.deviation <= 1e-8 * size, "{:e}", edges.deviation);
    for e in &edges.edges {
        for k in 0..=1000 {
            // twice: the largest is taken at inner points
            assert!((at(e, f64::from(k) / 1000.0).length() - 2.0).abs() <= 2.0 * edges.deviation);
        }
    }
}

#[test]
fn nothing_has_no_edges() {
    let edges = Part::default().edges().unwrap();
    assert!(edges.edges.is_empty() && edges.vertices.is_empty() && edges.closed());
}

/// A hole smaller than the reach has no edge, and is reported.
#[test]
fn a_loop_that_is_a_point_is_reported() {
    use glam::DVec2;
    use selvedge_geometry::model::TrimLoop;
    use selvedge_geometry::spline::Bezier;
    let square = |low: DVec2, side: f64, hole: bool| {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|c| low + side * DVec2::from(c));
        let l = TrimLoop::new((0..4).map(|k| Bezier::line(corners[k], corners[(k + 1) % 4])).collect(), DVec2::ZERO);
        if hole { l.unwrap().reversed() } else { l.unwrap() }
    };
    let mut face = sheet(1, DVec3::ZERO, DVec3::X, DVec3::Y);
    face.loops = vec![square(DVec2::ZERO, 1.0, false), square(DVec2::splat(0.5), 1e-6, true)];
    let edges = open(vec![face]).edges().unwrap();
    assert_eq!((edges.edges.len(), &edges.lost[..]), (4, &[(0, 1)][..]));
}
