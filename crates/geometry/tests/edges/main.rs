//! Edges of parts whose edges are known.

mod cut;
mod flatten;
mod joined;
mod meshes;
mod shapes;
mod stated;

use glam::{DVec2, DVec3, DVec4};
use selvedge_geometry::model::{Edge, EdgeKind, Edges, Face, Part, SurfaceKind};
use selvedge_geometry::spline::{Control, Surface};

/// Kinds of the edges, in order: sharp, smooth, seams, borders, and the vertices.
fn counts(edges: &Edges) -> [usize; 5] {
    let c = edges.counts();
    [c.sharp, c.smooth, c.seams, c.borders, c.vertices]
}

/// The parallelogram `origin + u x + v y` over the unit square, without loops.
fn sheet(id: u32, origin: DVec3, x: DVec3, y: DVec3) -> Face {
    let points = [origin, origin + x, origin + y, origin + x + y].map(|p| p.extend(1.0)).to_vec();
    let knots = vec![0.0, 0.0, 1.0, 1.0];
    let surface = Surface::new((1, 1), knots.clone(), knots, points).unwrap();
    Face { id, kind: SurfaceKind::Plane, surface, loops: Vec::new(), same_sense: true, colour: None }
}

fn open(faces: Vec<Face>) -> Part {
    Part { faces, ..Part::default() }
}

/// The point of an edge at the fraction `s`, every piece taking the same.
fn at(edge: &Edge, s: f64) -> DVec3 {
    let s = s * edge.curve.len() as f64;
    let k = (s as usize).min(edge.curve.len() - 1);
    edge.curve[k].piece.point(s - k as f64)
}

/// Where a face has the point at `position` of a loop, as uses count: curve and parameter.
fn on_face(face: &Face, trim_loop: Option<usize>, position: f64) -> DVec3 {
    let curves: Vec<Vec<DVec3>> = match trim_loop {
        Some(l) => face.loops[l].curves().map(|c| c.points).collect(),
        None => {
            let ((a, b), (c, d)) = face.surface.domain();
            let corners = [(a, c), (b, c), (b, d), (a, d), (a, c)].map(|p| DVec2::from(p).extend(1.0));
            corners.windows(2).map(<[DVec3]>::to_vec).collect()
        }
    };
    let k = position.floor();
    let curve = selvedge_geometry::spline::Bezier { points: curves[k as usize % curves.len()].clone() };
    let uv = curve.point(position - k);
    face.surface.jet(uv.x, uv.y).point
}

/// Rules for the edges of every part: curves run between their vertices, uses lie along the curves in their stated
/// direction, `tolerance` apart at most, and no piece of a loop has two edges. Whole loops belong to edges except for
/// `poles` curves.
#[track_caller]
fn check(part: &Part, edges: &Edges, tolerance: f64, poles: usize) {
    let mut covered = 0.0;
    for edge in &edges.edges {
        let ends = edge.ends.map(|v| edges.vertices[v]);
        assert!(at(edge, 0.0).distance(ends[0]) <= tolerance && at(edge, 1.0).distance(ends[1]) <= tolerance);
        for pair in edge.curve.windows(2) {
            assert_eq!(pair[0].end, pair[1].start);
            assert!(pair[0].piece.point(1.0).distance(pair[1].piece.point(0.0)) <= tolerance);
        }
        for used in &edge.uses {
            let face = &part.faces[used.face];
            let (a, b) = used.range;
            assert!(b > a);
            covered += b - a;
            let [start, end] = [a, b].map(|x| on_face(face, used.trim_loop, x));
            let [first, last] = if used.forward { ends } else { [ends[1], ends[0]] };
            assert!(start.distance(first) <= tolerance && end.distance(last) <= tolerance, "{used:?}");
            for k in 0..=20 {
                let p = on_face(face, used.trim_loop, a + (b - a) * f64::from(k) / 20.0);
                let nearest = (0..=4000).map(|i| at(edge, f64::from(i) / 4000.0).distance(p)).fold(f64::MAX, f64::min);
                assert!(nearest <= tolerance + 1e-3 * part.control_bounds().diagonal(), "{nearest}");
            }
        }
    }
    let curves =
        |f: &Face| f.loops.iter().map(|l| l.curves().len()).sum::<usize>().max(if f.loops.is_empty() { 4 } else { 0 });
    let all: usize = part.faces.iter().map(curves).sum();
    assert!((covered - (all - poles) as f64).abs() < 1e-9, "{covered} of {all} curves");
}

/// Number of edges of a kind.
fn of(edges: &Edges, kind: EdgeKind) -> impl Iterator<Item = &Edge> {
    edges.edges.iter().filter(move |e| e.kind == kind)
}

/// A weight does not move a point.
fn homogeneous(p: DVec3, w: f64) -> DVec4 {
    DVec4::from_point(p, w)
}
