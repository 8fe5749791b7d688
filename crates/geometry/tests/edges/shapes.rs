//! Shapes with equations.

use super::{at, check, counts, homogeneous, of, open, sheet};
use glam::{DVec2, DVec3};
use selvedge_geometry::construct::{Chain, curve, extruded_solid, shapes};
use selvedge_geometry::model::{EdgeKind, EdgeLimits, Face, Part, SurfaceKind, TrimLoop};
use selvedge_geometry::spline::{BSpline, Bezier, Control, Surface};
use std::f64::consts::{FRAC_PI_2, PI};

/// Rounding of coordinates up to 10, through a few operations.
const ROUNDING: f64 = 1e-13;

#[test]
fn a_block_has_twelve_edges_and_eight_vertices() {
    let part = shapes::block(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0)).unwrap().part;
    let edges = part.edges().unwrap();
    assert_eq!(counts(&edges), [12, 0, 0, 0, 8]);
    check(&part, &edges, ROUNDING, 0);
    assert!(edges.closed());
    let mut lengths: Vec<f64> = edges.edges.iter().map(|e| at(e, 0.0).distance(at(e, 1.0))).collect();
    lengths.sort_by(f64::total_cmp);
    for (k, length) in lengths.into_iter().enumerate() {
        assert!((length - [1.0, 2.0, 3.0][k / 4]).abs() < ROUNDING);
    }
    for e in &edges.edges {
        assert_eq!((e.uses.len(), e.source), (2, None));
        assert!((e.turn - FRAC_PI_2).abs() < 1e-12, "{}", e.turn);
    }
}

/// A face less: its sides are borders, the rest stays.
#[test]
fn a_block_without_lid_has_borders() {
    let mut part = shapes::block(DVec3::ZERO, DVec3::ONE).unwrap().part;
    part.faces.pop();
    part.closed = false;
    let edges = part.edges().unwrap();
    assert_eq!(counts(&edges), [8, 0, 0, 4, 8]);
    assert_eq!(edges.single(), 4);
    assert!(of(&edges, EdgeKind::Border).all(|e| e.turn.is_nan()));
    check(&part, &edges, ROUNDING, 0);
}

/// Planes trimmed by circles, and the wall between them.
fn cylinder(radius: f64, height: f64) -> Part {
    let circle = curve::circle(DVec3::ZERO, DVec3::Z, DVec3::X, radius, 2.0 * PI).unwrap();
    let flat: Vec<Bezier<DVec3>> = circle
        .beziers()
        .into_iter()
        .map(|s| Bezier { points: s.piece.points.iter().map(|p| DVec3::new(p.x, p.y, p.w)).collect() })
        .collect();
    let side = selvedge_geometry::construct::extrude(&circle, DVec3::Z * height).unwrap();
    let reach = 2.0 * radius;
    let disc = |id: u32, z: f64, up: bool| {
        let origin = DVec3::new(-reach, -reach, z);
        let mut face = sheet(id, origin, DVec3::X * 2.0 * reach, DVec3::Y * 2.0 * reach);
        let knots = vec![-reach, -reach, reach, reach];
        face.surface = Surface::new((1, 1), knots.clone(), knots, face.surface.points().to_vec()).unwrap();
        face.loops = vec![TrimLoop::new(flat.clone(), DVec2::splat(1e-12)).unwrap()];
        Face { same_sense: up, ..face }
    };
    let wall =
        Face { id: 1, kind: SurfaceKind::Cylinder, surface: side, loops: Vec::new(), same_sense: true, colour: None };
    Part { faces: vec![wall, disc(2, 0.0, false), disc(3, height, true)], closed: true, ..Part::default() }
}

#[test]
fn a_cylinder_has_two_circles_and_a_seam() {
    let part = cylinder(2.0, 3.0);
    let edges = part.edges().unwrap();
    assert_eq!(counts(&edges), [2, 0, 1, 0, 2]);
    check(&part, &edges, 1e-12, 0);
    for e in of(&edges, EdgeKind::Sharp) {
        assert_eq!(e.ends[0], e.ends[1]);
        for k in 0..=100 {
            let p = at(e, f64::from(k) / 100.0);
            assert!((p.truncate().length() - 2.0).abs() < ROUNDING);
        }
        assert!((e.turn - FRAC_PI_2).abs() < 1e-9);
    }
    let seam = of(&edges, EdgeKind::Seam).next().unwrap();
    assert_eq!([seam.uses[0].face, seam.uses[1].face], [0, 0]);
    assert!((at(seam, 0.0).distance(at(seam, 1.0)) - 3.0).abs() < ROUNDING);
    assert!(seam.turn < 1e-9);
}

/// The lid of a cylinder farther beside its rim than any tolerance allows.
#[test]
fn a_lid_beside_its_rim_is_reported() {
    let mut part = cylinder(2.0, 3.0);
    let by = glam::DAffine3::from_translation(DVec3::Z * 0.1);
    part.faces[2].surface = part.faces[2].surface.transformed(&by);
    let edges = part.edges().unwrap();
    assert_eq!(counts(&edges), [1, 0, 1, 2, 3]);
    assert!(!edges.closed());
}

#[test]
fn a_ball_has_a_seam_between_its_poles() {
    let part = shapes::sphere(2.0).unwrap().part;
    let edges = part.edges().unwrap();
    assert_eq!(counts(&edges), [0, 0, 1, 0, 2]);
    check(&part, &edges, ROUNDING, 2);
    for k in 0..=50 {
        assert!((at(&edges.edges[0], f64::from(k) / 50.0).length() - 2.0).abs() < ROUNDING);
    }
}

#[test]
fn a_ring_has_two_seams_and_one_vertex() {
    let part = shapes::torus(3.0, 1.0).unwrap().part;
    let edges = part.edges().unwrap();
    assert_eq!(counts(&edges), [0, 0, 2, 0, 1]);
    check(&part, &edges, 1e-12, 0);
}

/// A square with one rounded corner, extruded: the arc continues the two sides beside it.
#[test]
fn a_fillet_is_smooth() {
    let corner = |x: f64, y: f64| DVec3::new(x, y, 1.0);
    let line = |a, b| BSpline::new(1, vec![0.0, 0.0, 1.0, 1.0], vec![a, b]).unwrap();
    let arc = {
        let w = 0.5_f64.sqrt();
        let points = vec![corner(2.0, 1.0), DVec3::from_point(DVec2::new(2.0, 2.0), w), corner(1.0, 2.0)];
        BSpline::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], points).unwrap()
    };
    let profile: Chain = vec![
        line(corner(0.0, 0.0), corner(2.0, 0.0)),
        line(corner(2.0, 0.0), corner(2.0, 1.0)),
        arc,
        line(corner(1.0, 2.0), corner(0.0, 2.0)),
        line(corner(0.0, 2.0), corner(0.0, 0.0)),
    ];
    let part = extruded_solid(&[profile], DVec3::Z).unwrap();
    let edges = part.edges().unwrap();
    // five corners of the profile, two of them smooth; the ends of the walls cut the rims of the lids
    let smooth: Vec<_> = of(&edges, EdgeKind::Smooth).collect();
    assert_eq!(smooth.len(), 2);
    assert!(smooth.iter().all(|e| e.turn < 1e-9 && (at(e, 0.0).z - at(e, 1.0).z).abs() > 0.9));
    assert_eq!(counts(&edges), [13, 2, 0, 0, 10]);
    check(&part, &edges, 1e-12, 0);
}

#[test]
fn a_sheet_has_free_borders() {
    let part = open(vec![sheet(1, DVec3::ZERO, DVec3::X, DVec3::Y)]);
    let edges = part.edges().unwrap();
    assert_eq!(counts(&edges), [0, 0, 0, 4, 4]);
    check(&part, &edges, ROUNDING, 0);
}

/// Two sheets that meet at an angle: smooth up to the limit, whichever way their surfaces are turned.
#[test]
fn the_limit_of_smooth_is_an_angle() {
    let pair = |degrees: f64, turned: bool| {
        let (s, c) = degrees.to_radians().sin_cos();
        let (away, up) = (DVec3::new(-c, 0.0, s), DVec3::Y);
        let other = if turned { sheet(2, DVec3::ZERO, up, away) } else { sheet(2, DVec3::ZERO, away, up) };
        open(vec![sheet(1, DVec3::ZERO, DVec3::X, DVec3::Y), other])
    };
    let kind = |degrees: f64, turned: bool, limit: f64| {
        let limits = EdgeLimits { smooth: limit.to_radians(), ..EdgeLimits::default() };
        let edges = pair(degrees, turned).edges_within(&limits).unwrap();
        assert_eq!((edges.vertices.len(), edges.edges.len()), (6, 7));
        let shared = edges.edges.iter().find(|e| e.uses.len() == 2).unwrap();
        assert!((shared.turn.to_degrees() - degrees).abs() < 1e-6);
        shared.kind
    };
    for turned in [false, true] {
        assert_eq!(kind(0.0, turned, 1.0), EdgeKind::Smooth);
        assert_eq!(kind(0.99, turned, 1.0), EdgeKind::Smooth);
        assert_eq!(kind(1.01, turned, 1.0), EdgeKind::Sharp);
        assert_eq!(kind(1.01, turned, 2.0), EdgeKind::Smooth);
        assert_eq!(kind(175.0, turned, 1.0), EdgeKind::Sharp);
    }
}

/// Sharp at one end only: a twisted sheet beside a plane.
#[test]
fn an_edge_is_smooth_only_if_it_is_all_along() {
    let twisted = |rise: f64| {
        let points = [DVec3::ZERO, -DVec3::X, DVec3::Y, DVec3::new(-1.0, 1.0, rise)];
        let knots = vec![0.0, 0.0, 1.0, 1.0];
        let surface = Surface::new((1, 1), knots.clone(), knots, points.map(|p| homogeneous(p, 1.0)).to_vec()).unwrap();
        let face = Face { surface, ..sheet(2, DVec3::ZERO, DVec3::X, DVec3::Y) };
        open(vec![sheet(1, DVec3::ZERO, DVec3::X, DVec3::Y), face]).edges().unwrap()
    };
    let shared = |edges: &selvedge_geometry::model::Edges| edges.edges.iter().find(|e| e.uses.len() == 2).unwrap().kind;
    assert_eq!(shared(&twisted(0.015)), EdgeKind::Smooth);
    assert_eq!(shared(&twisted(0.3)), EdgeKind::Sharp);
}

/// A wall drawn around a closed profile with one corner, which lies at the seam.
#[test]
fn a_seam_with_a_corner_is_sharp() {
    let points = [(0.0, 0.0), (2.0, -1.0), (2.0, 1.0), (0.0, 0.0)];
    let points = points.map(|(x, y)| DVec3::new(x, y, 0.0).extend(1.0)).to_vec();
    let drop = BSpline::new(3, vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0], points).unwrap();
    let surface = selvedge_geometry::construct::extrude(&drop, DVec3::Z).unwrap();
    let wall = Face { surface, kind: SurfaceKind::Extrusion, ..sheet(1, DVec3::ZERO, DVec3::X, DVec3::Y) };
    let edges = open(vec![wall]).edges().unwrap();
    assert_eq!(counts(&edges), [1, 0, 0, 2, 2]);
}
