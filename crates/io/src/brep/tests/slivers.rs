//! Faces that are lost without a gap: thinner than the tolerance, between straight and between curved edges.

use super::*;

fn is_sliver(surface: &SurfaceGeometry, bounds: Vec<Boundary>, edges: &[Edge], tolerance: f64) -> bool {
    FaceGeometry { id: 1, surface: surface.clone(), bounds, same_sense: true, ambiguous: false }
        .is_sliver(edges, tolerance)
}

/// Only what is thinner than the tolerance along one line counts, and only where straight edges close it.
#[test]
fn straight_slivers_are_no_wider_than_the_tolerance() {
    let mut edges = Vec::new();
    let mut quad = |width: f64, shift: f64| {
        let corners = [[0.0, 0.0], [10.0, 0.0], [10.0, width], [0.0, width], [0.0, shift]];
        let points = corners.map(|[x, y]| DVec3::new(x, y, 3.0));
        let list = Edge::chain(1, &points, &mut edges).into_iter().map(|i| (i, true)).collect();
        Boundary::Edges(list)
    };
    let (thin, wide, open) = (quad(1e-6, 0.0), quad(0.05, 0.0), quad(0.05, 0.03));
    let triangle = Boundary::Edges(
        Edge::chain(1, &[DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::ZERO], &mut edges)
            .into_iter()
            .map(|i| (i, true))
            .collect(),
    );
    let frame = Frame { origin: DVec3::Z * 3.0, ..Frame::WORLD };
    let surface = SurfaceGeometry::Plane { frame };
    let is_sliver = |bounds, tolerance| is_sliver(&surface, bounds, &edges, tolerance);
    assert!(is_sliver(vec![thin.clone()], 1e-5) && !is_sliver(vec![thin.clone()], 1e-7));
    assert!(!is_sliver(vec![wide.clone()], 1e-2) && is_sliver(vec![wide.clone()], 0.2));
    // a tolerance of the face's own size says nothing
    assert!(!is_sliver(vec![triangle.clone()], 10.0));
    assert!(!is_sliver(vec![thin, wide], 1e-2) && !is_sliver(Vec::new(), 1.0) && !is_sliver(vec![triangle], 1e-2));
    assert!(!is_sliver(vec![open], 0.02) && !is_sliver(vec![Boundary::Natural], 1.0));
}

/// A ring between two circles, as two bounds; a lens between an arc and its chord; and what is as large as its border.
#[test]
fn flat_slivers_between_arcs() {
    let f = odd_frame();
    let surface = SurfaceGeometry::Plane { frame: f };
    let mut edges = Vec::new();
    let rims = [5.0 + 1e-4, 5.0].map(|radius| full_circle(&mut edges, f, radius));
    let ring = |hole: bool| vec![Boundary::Edges(vec![(rims[0], true)]), Boundary::Edges(vec![(rims[1], !hole)])];
    assert!(is_sliver(&surface, ring(true), &edges, 1e-3) && !is_sliver(&surface, ring(true), &edges, 5e-5));
    // a loop twice around is not what lies between the two, and a disc is no ring
    assert!(!is_sliver(&surface, ring(false), &edges, 1e-3));
    assert!(!is_sliver(&surface, ring(true)[..1].to_vec(), &edges, 1e-3));

    // 100 mm of radius over a chord of 2 mm: 0.005 mm high
    let angle = 0.01_f64.asin();
    let ends = [-angle, angle].map(|a| f.world(DVec3::new(100.0 * a.cos(), 100.0 * a.sin(), 0.0)));
    let arc = edge(&mut edges, circle(f, 100.0), ends[0], ends[1]);
    let chord = segment(&mut edges, ends[0], ends[1]);
    let lens = || vec![Boundary::Edges(vec![(arc, true), (chord, false)])];
    assert!(is_sliver(&surface, lens(), &edges, 6e-3) && !is_sliver(&surface, lens(), &edges, 4e-3));
    // the chord leads elsewhere
    let open = segment(&mut edges, ends[0], ends[1] + f.z * 0.01);
    assert!(!is_sliver(&surface, vec![Boundary::Edges(vec![(arc, true), (open, false)])], &edges, 6e-3));
}

/// Between two rims that a seam joins; a seam that is longer than the tolerance has the face on both sides.
#[test]
fn bands_of_a_cylinder() {
    let f = odd_frame();
    let surface = SurfaceGeometry::Cylinder { frame: f, radius: 5.0 };
    let is_thin = |height: f64| {
        let mut edges = Vec::new();
        let rims = [0.0, height].map(|z| full_circle(&mut edges, moved(f, [0.0, 0.0, z]), 5.0));
        let seam = segment(&mut edges, f.world(DVec3::X * 5.0), f.world(DVec3::new(5.0, 0.0, height)));
        let bound = vec![(rims[0], true), (seam, true), (rims[1], false), (seam, false)];
        is_sliver(&surface, vec![Boundary::Edges(bound)], &edges, 1e-3)
    };
    assert!(is_thin(1e-4) && !is_thin(1e-2) && !is_thin(5.0));
}

/// The directions say whether the face is the lune or the rest of the sphere.
#[test]
fn lunes_of_a_sphere() {
    let f = odd_frame();
    let surface = SurfaceGeometry::Sphere { frame: f, radius: 5.0 };
    let (south, north) = (f.origin - f.z * 5.0, f.origin + f.z * 5.0);
    let mut edges = Vec::new();
    let [west, east] = [0.0, 1e-5].map(|turn| edge(&mut edges, circle(meridian_frame(f, turn), 5.0), south, north));
    let lune = |up: usize, down: usize| vec![Boundary::Edges(vec![(up, true), (down, false)])];
    assert!(is_sliver(&surface, lune(east, west), &edges, 1e-3));
    assert!(!is_sliver(&surface, lune(west, east), &edges, 1e-3));
    assert!(!is_sliver(&surface, lune(east, west), &edges, 1e-5));
    // a seam alone is the whole sphere
    assert!(!is_sliver(&surface, lune(west, west), &edges, 1e-3));
    let ambiguous = FaceGeometry { id: 1, surface, bounds: lune(east, west), same_sense: true, ambiguous: true };
    assert!(!ambiguous.is_sliver(&edges, 1e-3));
}
