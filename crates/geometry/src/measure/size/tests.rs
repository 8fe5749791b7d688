use crate::construct::shapes::{block, cylinder, sphere, torus};
use crate::model::{Face, Part, SurfaceKind, TrimLoop};
use crate::spline::{Bezier, Surface};
use glam::{DVec2, DVec3, DVec4};
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Closed forms and what the rules promise.
fn near(value: f64, expected: f64) {
    assert!((value / expected - 1.0).abs() < 1e-9, "{value} in place of {expected}");
}

fn of_kind(part: &Part, kind: SurfaceKind) -> &Face {
    part.faces.iter().find(|face| face.kind == kind).expect("a face of the kind")
}

#[test]
fn areas_and_radii_of_round_faces_have_closed_forms() {
    let (can, ball, ring) = (cylinder(5.0, 7.0).unwrap(), sphere(3.0).unwrap(), torus(10.0, 2.0).unwrap());
    let side = of_kind(&can.part, SurfaceKind::Cylinder);
    near(side.area(), 2.0 * PI * 5.0 * 7.0);
    near(side.radius().unwrap(), 5.0);
    let disc = of_kind(&can.part, SurfaceKind::Plane);
    near(disc.area(), PI * 25.0);
    assert_eq!(disc.radius(), None);
    near(of_kind(&ball.part, SurfaceKind::Sphere).area(), 4.0 * PI * 9.0);
    near(of_kind(&ball.part, SurfaceKind::Sphere).radius().unwrap(), 3.0);
    let tube = of_kind(&ring.part, SurfaceKind::Torus);
    near(tube.area(), 4.0 * PI * PI * 10.0 * 2.0);
    near(tube.radius().unwrap(), 2.0);
}

/// What calls itself a cylinder and is not round has no radius.
#[test]
fn a_flat_cylinder_has_no_radius() {
    let mut face = block(DVec3::ZERO, DVec3::ONE).unwrap().part.faces[0].clone();
    face.kind = SurfaceKind::Cylinder;
    assert_eq!(face.radius(), None);
}

/// A circle of four conics.
fn circle(centre: DVec2, radius: f64) -> TrimLoop {
    let corner = |x: f64, y: f64, w: f64| ((centre + radius * DVec2::new(x, y)) * w).extend(w);
    let points = [(1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (-1.0, 1.0), (-1.0, 0.0), (-1.0, -1.0), (0.0, -1.0), (1.0, -1.0)];
    let at = |k: usize| {
        let (x, y) = points[k % 8];
        corner(x, y, if k.is_multiple_of(2) { 1.0 } else { FRAC_1_SQRT_2 })
    };
    let quarter = |k: usize| Bezier { points: vec![at(2 * k), at(2 * k + 1), at(2 * k + 2)] };
    TrimLoop::new((0..4).map(quarter).collect(), DVec2::splat(1e-12)).expect("closed")
}

/// A plane of 20 x 10 with a knot line through the hole, twice as long in space as in (u, v).
#[test]
fn holes_are_no_area() {
    let point = |i: usize, j: usize| DVec4::new([0.0, 20.0, 40.0][i], 20.0 * j as f64, 0.0, 1.0);
    let net = (0..2).flat_map(|j| (0..3).map(move |i| point(i, j))).collect();
    let knots = vec![0.0, 0.0, 10.0, 20.0, 20.0];
    let surface = Surface::new((1, 1), knots, vec![0.0, 0.0, 10.0, 10.0], net).expect("a plane");
    let corner = |x: f64, y: f64| DVec2::new(x, y);
    let square = [corner(1.0, 1.0), corner(19.0, 1.0), corner(19.0, 9.0), corner(1.0, 9.0)];
    let sides = (0..4).map(|k| Bezier::<DVec3>::line(square[k], square[(k + 1) % 4])).collect();
    let border = TrimLoop::new(sides, DVec2::ZERO).expect("closed");
    let face = |loops| Face {
        id: 1,
        kind: SurfaceKind::Plane,
        surface: surface.clone(),
        loops,
        same_sense: true,
        colour: None,
    };
    near(face(Vec::new()).area(), 800.0);
    near(face(vec![border.clone()]).area(), 4.0 * 18.0 * 8.0);
    let hole = circle(corner(10.0, 5.0), 3.0).reversed();
    near(face(vec![border, hole]).area(), 4.0 * (18.0 * 8.0 - PI * 9.0));
}

/// Twice as long along v below the knot line v = 5 as above it; a triangle crosses that line off the middle of its
/// sides. A rule that is halved 14 times only is off by 3e-7 of the area.
#[test]
fn a_step_of_the_derivative_is_found() {
    let net = [0.0, 20.0, 30.0].into_iter().flat_map(|y| [0.0, 40.0].map(|x| DVec4::new(x, y, 0.0, 1.0))).collect();
    let surface =
        Surface::new((1, 1), vec![0.0, 0.0, 20.0, 20.0], vec![0.0, 0.0, 5.0, 10.0, 10.0], net).expect("a plane");
    let corners = [DVec2::new(1.0, 1.0), DVec2::new(19.0, 1.0), DVec2::new(10.0, 8.0)];
    let sides = (0..3).map(|k| Bezier::<DVec3>::line(corners[k], corners[(k + 1) % 3])).collect();
    let face = |loops| Face {
        id: 1,
        kind: SurfaceKind::BSpline,
        surface: surface.clone(),
        loops,
        same_sense: true,
        colour: None,
    };
    // 8 for each unit of (u, v) below, 4 above
    near(face(Vec::new()).area(), 8.0 * 100.0 + 4.0 * 100.0);
    let found = face(vec![TrimLoop::new(sides, DVec2::ZERO).expect("closed")]).area();
    let expected = (8.0 * 360.0 + 4.0 * 81.0) / 7.0;
    assert!((found / expected - 1.0).abs() < 1e-7, "{found} in place of {expected}");
}

#[test]
fn edges_have_the_length_of_their_circles() {
    let can = cylinder(5.0, 7.0).unwrap().part;
    let edges = can.edges().expect("edges");
    let rim: f64 = edges
        .edges
        .iter()
        .filter(|e| e.uses.iter().any(|u| can.faces[u.face].kind == SurfaceKind::Plane))
        .map(|e| e.length())
        .sum();
    near(rim, 2.0 * 2.0 * PI * 5.0);
}
