//! Faces that are lost without a gap: thinner than the tolerance, between straight and between curved edges, or within
//! one edge that runs there and back.

use super::*;
use crate::spline::BSpline;

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

/// A closed cubic spline of twelve corners, the first again at its end.
fn twelve(corner: impl Fn(f64) -> DVec3) -> CurveGeometry {
    let knots = [0.0; 3].into_iter().chain((0..=10).map(f64::from)).chain([10.0; 3]).collect();
    let points = (0..=12).map(|i| corner(TAU * f64::from(i % 12) / 12.0).extend(1.0)).collect();
    CurveGeometry::BSpline(BSpline::new(3, knots, points).unwrap())
}

/// A loop of one closed edge.
fn alone(curve: CurveGeometry, at: DVec3, forward: bool) -> (Vec<Boundary>, Vec<Edge>) {
    let mut edges = Vec::new();
    let only = edge(&mut edges, curve, at, at);
    (vec![Boundary::Edges(vec![(only, forward)])], edges)
}

/// One edge there and back, 20 mm long: as wide as stated, collapsed, and with one wide place.
#[test]
fn an_edge_that_runs_there_and_back() {
    let f = odd_frame();
    let surface = SurfaceGeometry::Plane { frame: f };
    let at = |x: f64, y: f64| f.world(DVec3::new(x, y, 0.0));
    let narrow = |width: f64, bulge: f64, forward: bool| {
        let y = |a: f64| 0.5 * width * a.sin() + if (a - FRAC_PI_2).abs() < 0.1 { bulge } else { 0.0 };
        alone(twelve(|a| at(10.0 * a.cos(), y(a))), at(10.0, 0.0), forward)
    };
    let thin = |width: f64, bulge: f64, forward: bool, tolerance: f64| {
        let (bounds, edges) = narrow(width, bulge, forward);
        is_sliver(&surface, bounds, &edges, tolerance)
    };
    for forward in [true, false] {
        assert!(thin(5e-4, 0.0, forward, 1e-3) && thin(0.0, 0.0, forward, 1e-3));
        assert!(!thin(5e-4, 0.0, forward, 1e-4) && !thin(5e-4, 0.5, forward, 1e-3) && !thin(5.0, 0.0, forward, 1e-3));
    }
    let flat = |semi_y: f64| {
        let ellipse = CurveGeometry::Ellipse { frame: f, semi_x: 10.0, semi_y };
        let (bounds, edges) = alone(ellipse, at(10.0, 0.0), true);
        is_sliver(&surface, bounds, &edges, 1e-3)
    };
    assert!(flat(2e-4) && !flat(2e-3));
    // vertices that nearly meet, at the ends of the curve
    let (bounds, mut edges) = narrow(5e-4, 0.0, true);
    edges[0].end += f.x * 1e-7;
    assert!(is_sliver(&surface, bounds, &edges, 1e-3));
}

/// On a closed surface the directions say whether the face is what the edge encloses.
#[test]
fn an_edge_there_and_back_on_a_sphere() {
    let f = odd_frame();
    let surface = SurfaceGeometry::Sphere { frame: f, radius: 5.0 };
    let at = |latitude: f64, longitude: f64| {
        let out = 5.0 * latitude.cos();
        f.world(DVec3::new(out * longitude.cos(), out * longitude.sin(), 5.0 * latitude.sin()))
    };
    // counter-clockwise as seen from outside
    let lune = |forward: bool| alone(twelve(|a| at(0.5 * a.cos(), -2e-5 * a.sin())), at(0.5, 0.0), forward);
    let is_sliver = |(bounds, edges): (Vec<Boundary>, Vec<Edge>)| is_sliver(&surface, bounds, &edges, 1e-3);
    assert!(is_sliver(lune(true)) && !is_sliver(lune(false)));
}

/// A border that is a point leaves nothing of a plane, but it may leave all of a sphere.
#[test]
fn an_edge_that_is_a_point() {
    let f = odd_frame();
    let (plane, sphere) = (SurfaceGeometry::Plane { frame: f }, SurfaceGeometry::Sphere { frame: f, radius: 5.0 });
    let (bounds, edges) = alone(twelve(|_| f.origin), f.origin, true);
    assert!(build_face(&face(plane.clone(), bounds.clone()), &edges, TOLERANCE).is_err());
    assert!(is_sliver(&plane, bounds.clone(), &edges, 1e-3) && !is_sliver(&sphere, bounds, &edges, 1e-3));
    // an open curve with one vertex for both its ends
    let knots = vec![0.0, 0.0, 1.0, 1.0];
    let ends = [f.origin, f.origin + f.x * 10.0].map(|p| p.extend(1.0));
    let open = CurveGeometry::BSpline(BSpline::new(1, knots, ends.to_vec()).unwrap());
    let (bounds, edges) = alone(open, f.origin, true);
    assert!(!is_sliver(&plane, bounds, &edges, 1e-3));
    // edges that are points apart from each other
    let mut edges = Vec::new();
    let two = [f.origin, f.origin + f.x].map(|p| (edge(&mut edges, twelve(|_| p), p, p), true));
    assert!(!is_sliver(&plane, vec![Boundary::Edges(two.to_vec())], &edges, 1e-3));
}
