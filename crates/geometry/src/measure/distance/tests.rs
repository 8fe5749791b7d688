//! Against closed forms, and against dense sets of points of random faces.

use super::*;
use crate::construct::{curve, shapes};
use crate::math::random::Random;
use crate::measure::surface::SurfaceShape;
use crate::model::{EdgeKind, Part as Body, SurfaceKind};
use crate::spline::{BSpline, Control};
use glam::DQuat;

/// Stated errors of complete searches: a share of the distance, and of sizes of some units.
const STATED: f64 = 1e-9;

fn face(surface: Surface, loops: Vec<TrimLoop>) -> Face {
    Face { id: 1, kind: SurfaceKind::BSpline, surface, loops, same_sense: true, colour: None }
}

/// The plane through two corners of a rectangle at a height; its parameters are x and y.
fn plane(low: DVec2, high: DVec2, z: f64) -> Surface {
    let net = [low, DVec2::new(high.x, low.y), DVec2::new(low.x, high.y), high].map(|p| p.extend(z).extend(1.0));
    Surface::new((1, 1), vec![low.x, low.x, high.x, high.x], vec![low.y, low.y, high.y, high.y], net.to_vec())
        .expect("a plane")
}

fn polygon(corners: &[DVec2]) -> TrimLoop {
    let next = corners.iter().cycle().skip(1);
    TrimLoop::new(corners.iter().zip(next).map(|(a, b)| Bezier::line(*a, *b)).collect(), DVec2::ZERO).expect("a loop")
}

fn rectangle(low: DVec2, high: DVec2) -> TrimLoop {
    polygon(&[low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)])
}

fn edge(curve: &BSpline<DVec4>) -> Edge {
    let curve = curve.beziers();
    Edge { curve, ends: [0, 1], uses: Vec::new(), source: None, kind: EdgeKind::Sharp, turn: 1.0, deviation: 0.0 }
}

fn at(x: f64, y: f64, z: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(x, y, z))
}

/// The first face of a kind of surface.
fn side(body: &Body, is_it: impl Fn(&SurfaceShape) -> bool) -> &Face {
    body.faces.iter().find(|f| is_it(&shape(f, DAffine3::IDENTITY))).expect("such a face")
}

fn round(body: &Body) -> &Face {
    side(body, |s| matches!(s, SurfaceShape::Cylinder { .. }))
}

/// The distance is the expected one within its error, which is small, both ways round.
#[track_caller]
fn holds(a: &Pieces<'_>, b: &Pieces<'_>, expected: f64) {
    for (a, b) in [(a, b), (b, a)] {
        let found = smallest(a, b).expect("both have points");
        let off = (found.distance - expected).abs();
        assert!(off <= found.error + 1e-14 * (1.0 + expected), "{found:?} instead of {expected}");
        assert!(found.error > 0.0 && found.error <= STATED * expected.max(1.0), "{found:?}");
        let apart = found.points[0].distance(found.points[1]);
        assert!((apart - found.distance).abs() <= found.error, "{found:?}");
    }
}

#[test]
fn round_faces_have_the_distances_of_their_axes_and_centres() {
    let still = DAffine3::IDENTITY;
    let askew = DAffine3::from_rotation_translation(DQuat::from_rotation_x(1.0), DVec3::new(0.0, 0.0, 2.5));
    let body = |r: f64, h: f64| shapes::cylinder(r, h).expect("a cylinder").part;
    let ball = |r: f64| shapes::sphere(r).expect("a sphere").part;
    let torus = shapes::torus(4.0, 1.25).expect("a torus").part;
    let (thin, wide, small, large) = (body(2.5, 5.0), body(10.0, 5.0), ball(1.5), ball(4.0));
    let ring = Pieces::face(&torus.faces[0], still);
    // many nearest points: a whole circle, a cylinder, a sphere
    holds(&Pieces::face(round(&wide), at(0.0, 0.0, -2.0)), &ring, 4.75);
    holds(&Pieces::face(round(&thin), still), &ring, 0.25);
    holds(&Pieces::face(round(&thin), still), &Pieces::face(round(&wide), at(0.0, 0.0, 2.0)), 7.5);
    holds(&Pieces::face(&small.faces[0], askew), &Pieces::face(round(&thin), still), 1.0);
    holds(&Pieces::face(&small.faces[0], askew), &Pieces::face(&large.faces[0], at(0.0, 0.0, 2.5)), 2.5);
    // one along the other: the circles at the ends
    holds(&Pieces::face(round(&thin), at(0.0, 0.0, 9.0)), &Pieces::face(round(&wide), still), 7.5_f64.hypot(4.0));
    // axes at right angles and parallel
    let lying =
        DAffine3::from_rotation_translation(DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2), DVec3::Z * 6.0);
    let long = body(2.0, 40.0);
    holds(&Pieces::face(round(&long), lying * at(0.0, 0.0, -20.0)), &ring, 2.75);
    holds(&Pieces::face(round(&thin), still), &Pieces::face(round(&long), at(7.0, 1.0, -9.0)), 50.0_f64.sqrt() - 4.5);
}

/// The foot of the sphere's centre on the plane is outside of the loop, or in its hole.
#[test]
fn the_nearest_point_of_a_plane_is_where_its_loops_leave_it() {
    let carrier = || plane(DVec2::splat(-20.0), DVec2::splat(20.0), 0.0);
    let square = face(carrier(), vec![rectangle(DVec2::new(0.0, -3.0), DVec2::new(4.0, 5.0))]);
    let ball = shapes::sphere(2.0).expect("a sphere").part;
    let sphere = |x, y, z| Pieces::face(&ball.faces[0], at(x, y, z));
    let square = Pieces::face(&square, DAffine3::IDENTITY);
    holds(&sphere(10.0, 0.3, 3.0), &square, 6.0_f64.hypot(3.0) - 2.0);
    holds(&sphere(7.0, 9.0, 5.0), &square, 50.0_f64.sqrt() - 2.0);
    holds(&sphere(3.9, 4.9, 5.0), &square, 3.0);
    // inside by little, outside by less
    holds(&sphere(4.0 - 1e-6, 1.0, 5.0), &square, 3.0);
    holds(&sphere(4.001, 1.0, 5.0), &square, 0.001_f64.hypot(5.0) - 2.0);
    let hole = polygon(&[DVec2::new(1.0, 0.0), DVec2::new(1.0, 2.0), DVec2::new(3.0, 2.0), DVec2::new(3.0, 0.0)]);
    let holed = face(carrier(), vec![rectangle(DVec2::ZERO - 6.0, DVec2::splat(6.0)), hole]);
    holds(&sphere(1.75, 1.0, 3.0), &Pieces::face(&holed, DAffine3::IDENTITY), 0.75_f64.hypot(3.0) - 2.0);
    // a loop around the domain: the domain's own border
    let beyond = face(plane(DVec2::ZERO, DVec2::ONE, 0.0), vec![rectangle(DVec2::splat(-1.0), DVec2::new(2.0, 0.75))]);
    let beyond = Pieces::face(&beyond, DAffine3::IDENTITY);
    holds(&Pieces::point(DVec3::new(3.0, 0.5, 0.0)), &beyond, 2.0);
    holds(&Pieces::point(DVec3::new(0.5, 2.0, 0.0)), &beyond, 1.25);
}

#[test]
fn lines_and_circles_have_their_distances() {
    let line = |a: [f64; 3], b: [f64; 3]| edge(&curve::line(a.into(), b.into()).expect("a line"));
    let whole = std::f64::consts::TAU;
    let circle = |centre: DVec3, axis: DVec3, start: DVec3, radius: f64| {
        edge(&curve::circle(centre, axis, start, radius, whole).expect("a circle"))
    };
    let still = DAffine3::from_rotation_translation(DQuat::from_rotation_x(0.3), DVec3::new(1.0, 2.0, 3.0));
    let apart =
        |a: &Edge, b: &Edge, expected: f64| holds(&Pieces::edges(&[a], still), &Pieces::edges(&[b], still), expected);
    let along = line([0.0, 0.0, 0.0], [10.0, 0.0, 0.0]);
    apart(&along, &line([4.0, -5.0, 3.0], [4.0, 5.0, 3.0]), 3.0);
    apart(&along, &line([12.0, -5.0, 3.0], [12.0, 5.0, 3.0]), 2.0_f64.hypot(3.0));
    apart(&along, &line([2.0, 1.0, 0.0], [30.0, 1.0, 0.0]), 1.0);
    apart(&along, &line([12.0, 3.0, 4.0], [15.0, 3.0, 4.0]), 29.0_f64.sqrt());
    let flat = circle(DVec3::ZERO, DVec3::Z, DVec3::X, 3.0);
    apart(&flat, &circle(DVec3::Z * 2.0, DVec3::Z, DVec3::new(1.0, 2.0, 0.0), 5.0), 8.0_f64.sqrt());
    apart(&flat, &circle(DVec3::X * 7.0, DVec3::Y, DVec3::X, 1.0), 3.0);
    apart(&flat, &line([0.0, 0.0, -9.0], [0.0, 0.0, 9.0]), 3.0);
    apart(&flat, &line([-9.0, 5.0, 1.0], [9.0, 5.0, 1.0]), 2.0_f64.hypot(1.0));
}

/// A roof's ridge is a fold of its surface, no border, and no place where the distance has a derivative.
#[test]
fn the_nearest_point_may_lie_on_a_fold() {
    let net = [(-1.0, 0.0), (0.0, 1.0), (2.0, 0.0)];
    let points = [0.0, 3.0].iter().flat_map(|y| net.map(|(x, z)| DVec4::new(x, *y, z, 1.0))).collect();
    let knots = (vec![0.0, 0.0, 0.4, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0]);
    let roof = face(Surface::new((1, 1), knots.0, knots.1, points).expect("a roof"), Vec::new());
    let roof = Pieces::face(&roof, DAffine3::IDENTITY);
    holds(&Pieces::point(DVec3::new(0.3, 1.1, 4.0)), &roof, 0.3_f64.hypot(3.0));
    let ball = shapes::sphere(1.0).expect("a sphere").part;
    holds(&Pieces::face(&ball.faces[0], at(0.0, 1.7, 5.0)), &roof, 3.0);
}

/// A ridge of 2/3, as wide as 4 of 200 spans, on a flat strip: samples at 24ths of the strip see none of it, and from
/// the one nearest to the point Newton's method leads to the flat, 3 away.
#[test]
fn a_narrow_place_is_found() {
    let (spans, degree, raised) = (200_usize, 3_usize, 105_usize);
    let inner = (1..spans).map(|i| i as f64 / spans as f64);
    let knots: Vec<f64> = [0.0; 4].into_iter().chain(inner).chain([1.0; 4]).collect();
    let place = |i: usize| knots[i + 1..=i + degree].iter().sum::<f64>() / degree as f64;
    let row = |y: f64| {
        let at = |i: usize| DVec4::new(place(i), y, if i == raised { 1.0 } else { 0.0 }, 1.0);
        (0..spans + degree).map(at).collect::<Vec<_>>()
    };
    let net = [row(0.0), row(1.0)].concat();
    let strip = Surface::new((3, 1), knots.clone(), vec![0.0, 0.0, 1.0, 1.0], net).expect("a strip");
    assert!((0..=24).all(|i| strip.point(f64::from(i) / 24.0, 0.5).z == 0.0), "samples miss the ridge");
    let point = DVec3::new(0.2, 0.5, 3.0);
    // along the ridge's section, at the point's own y; near the minimum the curvature is some 1e5
    let count = 400_000;
    let (from, to) = (knots[raised], knots[raised + 4]);
    let sample = |i: i32| strip.point(from + (to - from) * f64::from(i) / f64::from(count), 0.5).distance(point);
    let expected = (0..=count).map(sample).fold(f64::INFINITY, f64::min);
    assert!(expected < 2.4, "the flat is 3 away, the ridge {expected}");
    let strip = face(strip, Vec::new());
    let strip = Pieces::face(&strip, DAffine3::IDENTITY);
    for (a, b) in [(&strip, &Pieces::point(point)), (&Pieces::point(point), &strip)] {
        let found = smallest(a, b).expect("both have points");
        assert!((found.distance - expected).abs() <= 1e-9 && found.error <= STATED, "{found:?} beside {expected}");
    }
}

#[test]
fn items_that_touch_are_0_apart_within_an_error() {
    let ball = shapes::sphere(2.0).expect("a sphere").part;
    let floor = face(plane(DVec2::splat(-5.0), DVec2::new(6.0, 7.0), 0.0), Vec::new());
    let floor = Pieces::face(&floor, DAffine3::IDENTITY);
    let block = shapes::block(DVec3::ZERO, DVec3::ONE).expect("a block").part;
    for (x, y, z) in [(0.0, 0.0, 2.0), (0.3, 1.7, 2.0), (1.0, 2.0, 0.7), (6.0, 7.0, 1.5)] {
        let sphere = Pieces::face(&ball.faces[0], at(x, y, z));
        let found = smallest(&sphere, &floor).expect("both have points");
        assert!(found.distance == 0.0 && found.error > 0.0 && found.error < 1e-9, "{found:?}");
    }
    // neighbours meet in an edge; opposite sides do not
    let apart = |i: usize, j: usize| {
        let [a, b] = [i, j].map(|k| Pieces::face(&block.faces[k], DAffine3::IDENTITY));
        smallest(&a, &b).expect("both have points")
    };
    let touching =
        (1..6).map(|k| apart(0, k)).filter(|d| d.distance == 0.0 && d.error > 0.0 && d.error < 1e-12).count();
    assert_eq!(touching, 4);
}

/// A rational bicubic patch of random control points within 1 of a point.
fn random_surface(random: &mut Random, middle: DVec3) -> Surface {
    let mut point = |_| {
        let off = DVec3::from_array([0; 3].map(|_| random.range(-1.0, 1.0)));
        DVec4::from_point(middle + off, random.range(0.4, 2.5))
    };
    let net = (0..16).map(&mut point).collect();
    let knots = vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    Surface::new((3, 3), knots.clone(), knots, net).expect("a surface")
}

/// A bent loop around the middle of the unit square.
fn random_loop(random: &mut Random) -> TrimLoop {
    let mut ring = |k: usize| {
        let turn = std::f64::consts::TAU * k as f64 / 10.0;
        0.5 + DVec2::from_angle(turn) * random.range(0.15, 0.48)
    };
    let points: Vec<DVec2> = (0..10).map(&mut ring).collect();
    let arc = |k: usize| {
        let corners = [0, 1, 2].map(|i| points[(2 * k + i) % 10]);
        Bezier { points: corners.iter().map(|p| DVec3::from_point(*p, 1.0)).collect() }
    };
    TrimLoop::new((0..5).map(arc).collect(), DVec2::ZERO).expect("a loop")
}

/// Points of a face: a grid's that the loops keep, and of the loops. Also how far any point is from the nearest of
/// them, about.
fn points_of(face: &Face) -> (Vec<DVec3>, f64) {
    const ACROSS: usize = 36;
    const ALONG: usize = 60;
    let patch = &face.surface.patches().patches[0].patch;
    let loops = LoopIndex::new(&face.loops);
    let share = |i: usize| i as f64 / ACROSS as f64;
    let grid: Vec<DVec2> =
        (0..=ACROSS).flat_map(|j| (0..=ACROSS).map(move |i| DVec2::new(share(i), share(j)))).collect();
    let (along_u, along_v) = patch.speed_bound();
    let kept = grid.into_iter().filter(|uv| loops.contains(*uv));
    let of_loops = face.loops.iter().flat_map(TrimLoop::curves);
    let of_loops = of_loops.flat_map(|c| (0..=ALONG).map(move |i| c.point(i as f64 / ALONG as f64)));
    let points = kept.chain(of_loops).map(|uv| patch.point(uv.x, uv.y)).collect();
    (points, (along_u + along_v) / ACROSS as f64)
}

/// Random pairs, every other one trimmed: no sampled pair of points is nearer than the distance less its error, and the
/// distance is one of points that are as near to samples as samples are dense.
#[test]
fn no_sampled_pair_is_nearer() {
    let mut random = Random::new(17);
    let mut largest = 0.0_f64;
    for case in 0..24 {
        let middle = DVec3::new(random.range(1.0, 3.5), random.range(-1.0, 1.0), random.range(-1.0, 1.0));
        let [a, b] = [DVec3::ZERO, middle].map(|middle| {
            let surface = random_surface(&mut random, middle);
            let loops = if case % 2 == 0 { Vec::new() } else { vec![random_loop(&mut random)] };
            face(surface, loops)
        });
        let [p, q] = [&a, &b].map(|f| Pieces::face(f, DAffine3::IDENTITY));
        let found = smallest(&p, &q).expect("both have points");
        let turned = smallest(&q, &p).expect("both have points");
        let ((of_a, gap_a), (of_b, gap_b)) = (points_of(&a), points_of(&b));
        let distances = of_a.iter().flat_map(|x| of_b.iter().map(move |y| x.distance_squared(*y)));
        let sampled = distances.fold(f64::INFINITY, f64::min).sqrt();
        assert!(found.distance <= sampled + found.error, "case {case}: {found:?}, sampled {sampled}");
        assert!(found.distance >= sampled - gap_a - gap_b, "case {case}: {found:?}, sampled {sampled}");
        let off = (found.distance - turned.distance).abs();
        assert!(off <= found.error + turned.error, "case {case}: {found:?} and {turned:?}");
        for (point, (samples, gap)) in found.points.iter().zip([(&of_a, gap_a), (&of_b, gap_b)]) {
            let near = samples.iter().map(|s| s.distance(*point)).fold(f64::INFINITY, f64::min);
            assert!(near <= gap, "case {case}: {point} is {near} from the face");
        }
        largest = largest.max(found.error);
    }
    assert!(largest > 0.0 && largest <= STATED, "{largest:e}");
}

/// A search that is cut short states a larger error, within which the distance is.
#[test]
fn a_search_cut_short_states_how_far_it_came() {
    let mut random = Random::new(5);
    let mut cut = 0;
    for _ in 0..6 {
        let [a, b] = [DVec3::ZERO, DVec3::X * 4.0].map(|middle| face(random_surface(&mut random, middle), Vec::new()));
        let [p, q] = [&a, &b].map(|f| Pieces::face(f, DAffine3::IDENTITY));
        let whole = smallest(&p, &q).expect("both have points");
        for most in [1, 4, 16, 64] {
            let found = search::smallest(&p, &q, most).expect("both have points");
            let off = (found.distance - whole.distance).abs();
            assert!(off <= found.error + whole.error, "{most} pairs: {found:?} beside {whole:?}");
            cut += i32::from(found.error > 1e3 * whole.error);
        }
    }
    assert!(cut >= 12, "only {cut} searches were cut short");
}

/// Two tori about one axis are nearest along whole circles, which no datum's profile decides: the search is cut short,
/// and says so.
#[test]
fn an_undecided_distance_has_a_large_error() {
    let [small, large] = [(4.0, 1.25), (9.0, 1.0)].map(|(r, s)| shapes::torus(r, s).expect("a torus").part);
    let [a, b] = [(&small, 0.0), (&large, 2.0)].map(|(part, z)| Pieces::face(&part.faces[0], at(0.0, 0.0, z)));
    let expected = 5.0_f64.hypot(2.0) - 2.25;
    for (most, worst) in [(500, 1.0), (3000, 0.1)] {
        let found = search::smallest(&a, &b, most).expect("both have points");
        assert!((found.distance - expected).abs() <= found.error, "{found:?} instead of {expected}");
        assert!((found.distance - expected).abs() <= 1e-12, "the pair of points is one of the nearest: {found:?}");
        assert!(found.error > STATED && found.error < worst, "{found:?}");
    }
}

#[test]
fn nothing_is_not_near() {
    let none = Pieces::edges(&[], DAffine3::IDENTITY);
    assert_eq!(smallest(&none, &Pieces::point(DVec3::ZERO)), None);
    let found = smallest(&Pieces::point(DVec3::X), &Pieces::point(DVec3::Y)).expect("points");
    assert!((found.distance - 2.0_f64.sqrt()).abs() <= found.error && found.error < 1e-13, "{found:?}");
}
