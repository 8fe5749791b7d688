//! Shadows of spline faces and placed meshes: closed forms, and the exact reference, which does not use triangles of
//! spline faces.

use super::{SIZE, SUN, facing, judged, sunny};
use crate::layers::{centre, one};
use crate::shapes::solids::{at, block, moved, post, turned};
use crate::shapes::{self, PLATE_HALF, PLATE_HOLE, SPHERE_RADIUS, operands, placed};
use crate::support::{assert_silent, orthographic, perspective, render, watched, watched_with};
use glam::{DAffine3, DVec2, DVec3};
use selvedge::construct::{Chain, extruded_solid, lathed_solid};
use selvedge::csg::Op;
use selvedge::model::{Camera, Mesh, Model, Part, Primitive, Projection, Solid};
use selvedge::picture::Picture;
use selvedge::spline::BSpline;
use selvedge_check::{JudgeOptions, SunTracer, Tracer, judge_sun};
use std::f64::consts::TAU;

/// Number of the ground.
const GROUND: u32 = 1000;
/// A sun 7 degrees above the horizon.
const LOW: DVec3 = DVec3::new(-0.9, 0.35, 0.12);

/// The ground; its top is z = 0.
fn ground() -> Primitive {
    Primitive { id: GROUND, ..block([-14.0, -14.0, -1.0], [14.0, 14.0, 0.0]) }
}

/// A view from above and aside of everything on the ground and its shadow: 15 pixels a unit.
fn above(middle: DVec3) -> Camera {
    Camera {
        eye: middle + DVec3::new(6.0, -18.0, 30.0),
        target: middle,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: 14.0 },
        depth_range: (1.0, 90.0),
        size: (280, 210),
    }
}

/// Compares the ground's pixels with their known shade, except within half a pixel of a border, the tolerance; the
/// deviation in these scenes is less than a twelfth of that. Returns the numbers of lit and of shaded pixels.
fn assert_ground(picture: &Picture, camera: &Camera, name: &str, shade: impl Fn(DVec3) -> bool) -> [usize; 2] {
    let in_shade = |at: DVec2| {
        let (o, d) = camera.ray(at);
        shade(o - d * (o.z / d.z))
    };
    let mut seen = [0; 2];
    for i in (0..picture.face.len()).filter(|i| picture.face[*i] == GROUND && picture.normal[*i][2] > 0.999) {
        let at = centre(i, camera.size);
        let truth = in_shade(at);
        let near = (0..16).map(|k| at + 0.5 * DVec2::from_angle(f64::from(k) * TAU / 16.0));
        if near.into_iter().all(|beside| in_shade(beside) == truth) {
            assert_eq!(picture.sunlit[i], !truth, "{name}: at {at}");
            seen[usize::from(truth)] += 1;
        }
    }
    let bound = 1.0 / 8192.0 * 42.0;
    assert!((0.0..bound).contains(&picture.stats.shadow_deviation), "{name}: {}", picture.stats.shadow_deviation);
    assert_eq!((picture.stats.shadowless, picture.stats.clamps), (0, 0), "{name}");
    seen
}

/// Whether a line, from its start on, meets the transformed ball of radius [`SPHERE_RADIUS`].
fn meets_ball(to: DAffine3, start: DVec3, towards: DVec3) -> bool {
    let back = to.inverse();
    let (o, d) = (back.transform_point3(start), back.transform_vector3(towards));
    let t = -o.dot(d) / d.length_squared();
    t > 0.0 && (o + d * t).length() < SPHERE_RADIUS
}

/// The shadow of an ellipsoid on a plane is an ellipse; the side of the ellipsoid that faces the sun has none.
#[test]
fn a_spline_ball_casts_an_ellipse() {
    let up = at(0.0, 0.0, 3.2) * DAffine3::from_scale(DVec3::splat(0.6));
    let leaning = at(0.5, 0.3, 2.6) * turned(0.4, 0.8, 0.2) * DAffine3::from_scale(DVec3::new(-0.3, 0.7, 0.5));
    let mut renderer = watched(&Model::default());
    for towards in [SUN, DVec3::Z, LOW] {
        for (name, to) in [("a ball", up), ("an ellipsoid, mirrored", leaning)] {
            let as_part = {
                let mut m = shapes::sphere();
                m.instances = vec![placed(to, None)];
                m.solids = vec![one(ground())];
                m
            };
            let ball = Primitive { id: 1, ..moved(to, operands::part(shapes::sphere())) };
            let apart = of(vec![one(ground()), one(ball.clone())]);
            let cut = {
                // less something absent: the ball's leaf is part of an expression
                let nothing = Primitive { id: 2, ..block([20.0; 3], [21.0; 3]) };
                of(vec![numbered("A+(B-C)", [ground(), ball, nothing], [GROUND, 1, 2])])
            };
            for (kind, m) in [("placed", as_part), ("an operand", apart), ("in an expression", cut)] {
                let name = format!("{name}, {kind}, {towards}");
                let s = towards.normalize();
                let camera = above(DVec3::new(0.0, 0.0, 1.0) - DVec3::new(s.x, s.y, 0.0).normalize_or_zero() * 3.0);
                renderer.upload_with(&m, sunny(towards)).unwrap();
                let picture = render(&mut renderer, &camera);
                let [lit, dark] = assert_ground(&picture, &camera, &name, |q| meets_ball(to, q, s));
                assert!(lit > 3000 && dark > 300, "{name}: {lit} lit, {dark} not");
                // no acne: a ball does not shade itself where it faces the sun
                let (mut own, mut outline) = ([0; 2], 0);
                let tracer = Tracer::new(&m);
                for i in (0..picture.face.len()).filter(|i| picture.face[*i] == 1) {
                    let rise = DVec3::from(picture.normal[i].map(f64::from)).dot(s);
                    if rise.abs() > 1e-5 {
                        let at = centre(i, camera.size);
                        // at its outline the far side is visible, whose normal is turned to the viewer
                        let lit = picture.sunlit[i] == (rise > 0.0) || {
                            let near = tracer.probe(&camera).first(at).expect("it is there").normal;
                            outline += 1;
                            near.dot(DVec3::from(picture.normal[i].map(f64::from))) < 0.0
                        };
                        assert!(lit, "{name}: at {at}, {rise}");
                        own[usize::from(rise > 0.0)] += 1;
                    }
                }
                assert!(own[1] > 700 && outline <= 2, "{name}: {own:?}, {outline} on the outline");
            }
        }
    }
    assert_silent(renderer);
}

/// A sheet blocks the light from both sides, and its trimmed hole passes it: both edges by closed forms.
#[test]
fn sheets_cast_shadows() {
    let (hole, radius) = PLATE_HOLE;
    let height = 2.0;
    let square = |hole: bool| {
        move |q: DVec3, s: DVec3| {
            let p = (q + s * ((height - q.z) / s.z)).truncate() / 0.8;
            p.abs().max_element() < PLATE_HALF && !(hole && p.distance(PLATE_HOLE.0) < radius)
        }
    };
    assert!(hole.length() < radius);
    let to = at(0.0, 0.0, height) * DAffine3::from_scale(DVec3::splat(0.8));
    let over = |mut m: Model, to: DAffine3| {
        m.instances = vec![placed(to, None)];
        m.solids = vec![one(ground())];
        m
    };
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0) * PLATE_HALF);
    let mesh = Mesh::new(7, corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]], vec![]).unwrap();
    let quad = Model {
        parts: vec![Part { meshes: vec![mesh], ..Part::default() }],
        instances: vec![placed(to, None)],
        ..Model::default()
    };
    let mirrored = to * DAffine3::from_scale(DVec3::new(1.0, 1.0, -1.0));
    let mut renderer = watched(&Model::default());
    for towards in [SUN, DVec3::new(0.3, -0.2, 0.4)] {
        let s = towards.normalize();
        for (name, m, has_hole) in [
            ("a trimmed plate", over(shapes::plate(), to), true),
            ("the same from behind", over(shapes::plate(), mirrored), true),
            ("a mesh", over(quad.clone(), to), false),
        ] {
            let camera = above(DVec3::new(-s.x, -s.y, 0.0) * 4.0);
            renderer.upload_with(&m, sunny(towards)).unwrap();
            let picture = render(&mut renderer, &camera);
            let [lit, dark] = assert_ground(&picture, &camera, name, |q| square(has_hole)(q, s));
            assert!(lit > 1500 && dark > 1000, "{name}: {lit} lit, {dark} not");
        }
    }
    assert_silent(renderer);
}

/// Everything on a slab, with the slab as a part or as a solid: against the reference, every pixel.
#[test]
fn whatever_there_is_casts_shadows_as_in_truth() {
    let mut renderer = watched(&Model::default());
    let mut wrong = Vec::new();
    let mut deviated = 0;
    let all = shapes::all().into_iter().map(|s| (s.name, s.model)).filter(|(name, _)| *name != "empty");
    for (name, mut m) in all.chain(operands::splines()) {
        let bounds = m.control_bounds();
        let (c, r) = (bounds.centre(), bounds.diagonal());
        let below = DVec3::new(0.0, 0.0, bounds.min.z - c.z - 0.05 * r);
        let corner = |z: f64, side: f64| c + below + r * DVec3::new(0.8 * side, 0.8 * side, z);
        let slab = block(corner(-0.1, -1.0).into(), corner(0.0, 1.0).into());
        m.solids.push(one(Primitive { id: GROUND, ..slab }));
        let tracer = Tracer::new(&m);
        for (towards, camera) in [(SUN, perspective(&m, (96, 72))), (LOW, orthographic(&m, (96, 72)))] {
            let sun = SunTracer::new(&m, towards).unwrap();
            renderer.upload_with(&m, sunny(towards)).unwrap();
            match judged(&mut renderer, (&tracer, &sun), &camera) {
                Err(fault) => wrong.push(format!("{name}, {towards}: {fault}")),
                Ok((light, picture)) => {
                    let (all, lit) = facing(&picture, &camera, towards);
                    deviated += light.deviated;
                    // for a low sun, the shadow of a flat thing falls beside the slab
                    let least = if towards == SUN { 30 } else { 0 };
                    if lit < 200 || all - lit < least || picture.stats.shadowless > 0 {
                        let stats = picture.stats.shadowless;
                        wrong.push(format!("{name}, {towards}: {lit} of {all} lit, {stats} cast none, {light:?}"));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(deviated <= 20, "{deviated} pixels are right only within the deviation");
    assert_silent(renderer);
}

/// A spline part as a tool: light passes the hole that it makes, within the ellipse that both rims leave.
#[test]
fn a_spline_tool_lets_light_through() {
    let (low, high) = (2.0, 2.5);
    let plate = Primitive { id: 1, ..block([-3.0, -3.0, low], [3.0, 3.0, high]) };
    // at least as long as the plate is thick: the sphere's middle is the plate's
    let to = at(0.3, -0.2, 0.5 * (low + high)) * DAffine3::from_scale(DVec3::splat(0.5));
    let tool = Primitive { id: 2, ..moved(to, operands::part(shapes::sphere())) };
    let m = of(vec![numbered("A+(B-C)", [ground(), plate, tool], [GROUND, 1, 2])]);
    let mut renderer = watched(&Model::default());
    for towards in [SUN, DVec3::new(0.1, -0.2, 1.0)] {
        let s = towards.normalize();
        renderer.upload_with(&m, sunny(towards)).unwrap();
        let camera = above(DVec3::new(-s.x, -s.y, 0.0) * 2.5);
        let picture = render(&mut renderer, &camera);
        let shade = |q: DVec3| {
            // part of the way within the plate is outside the ball
            let back = to.inverse();
            let within = |t: f64| back.transform_point3(q + s * t).length() < SPHERE_RADIUS;
            let through = |p: DVec3| p.truncate().abs().max_element() < 3.0;
            let ends = [low, high].map(|z| (z - q.z) / s.z);
            (0..=400)
                .map(|k| ends[0] + (ends[1] - ends[0]) * f64::from(k) / 400.0)
                .any(|t| through(q + s * t) && !within(t))
        };
        let [lit, dark] = assert_ground(&picture, &camera, "a tool", shade);
        assert!(lit > 1500 && dark > 1000, "{lit} lit, {dark} not");
    }
    assert_silent(renderer);
}

/// Curves of a profile, one after another, back to the first.
fn chain(curves: &[(usize, &[[f64; 3]])]) -> Chain {
    let curve = |(degree, points): &(usize, &[[f64; 3]])| {
        let inner = (1..points.len() - degree).map(|k| k as f64);
        let last = (points.len() - degree) as f64;
        let knots = [vec![0.0; degree + 1], inner.collect(), vec![last; degree + 1]].concat();
        BSpline::new(*degree, knots, points.iter().map(|p| DVec3::from(*p)).collect()).unwrap()
    };
    curves.iter().map(curve).collect()
}

/// An expression over A, B, C ..., each with a number.
fn numbered<const N: usize>(text: &str, primitives: [Primitive; N], ids: [u32; N]) -> Solid {
    let parts = shapes::solids::solid(text, primitives.into());
    let solid = &parts.solids[0];
    let own = |p: &Primitive| Primitive { id: ids[p.id as usize - 1], ..p.clone() };
    Solid::new(solid.primitives().iter().map(own).collect(), solid.tree().clone()).unwrap()
}

/// Of solids, whose primitives keep their numbers.
fn of(solids: Vec<Solid>) -> Model {
    Model { solids, ..Model::default() }
}

fn part_of(part: Part, id: u32, to: DAffine3) -> Primitive {
    let shape = selvedge::model::Shape::Part(std::sync::Arc::new(part));
    Primitive { shape, id, transform: to, colour: [1.0; 4] }
}

/// A bore whose wall and lids have different chords: a ray that passes the crack between them must not count as outside
/// the bore. Tests the light on the ground below, where rays pass the rim of the lower lid.
#[test]
fn no_light_slips_through_cracks() {
    use std::f64::consts::FRAC_1_SQRT_2;
    let (low, high) = (2.0, 3.0);
    let corners = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
    let point = |k: usize| {
        let weight = if k.is_multiple_of(2) { 1.0 } else { FRAC_1_SQRT_2 };
        [f64::from(corners[k].0) * weight, f64::from(corners[k].1) * weight, weight]
    };
    let arcs = [0, 2, 4, 6].map(|k| [point(k), point(k + 1), point(k + 2)]);
    let circle = chain(&arcs.each_ref().map(|arc| (2, arc.as_slice())));
    let bore = part_of(extruded_solid(&[circle], DVec3::Z * 2.0).unwrap(), 2, at(0.0, 0.0, 1.5));
    let plate = Primitive { id: 1, ..block([-3.0, -3.0, low], [3.0, 3.0, high]) };
    let m = of(vec![numbered("A+(B-C)", [ground(), plate, bore], [GROUND, 1, 2])]);
    let s = SUN.normalize();
    let below = |z: f64| (DVec3::Z - s / s.z) * z;
    // over half of the rim's shadow, seen from below the plate
    let middle = below(1.5) + DVec3::new(-0.6, 0.0, 0.0);
    let camera = Camera {
        eye: middle + DVec3::new(0.4, -2.0, 1.2),
        projection: Projection::Orthographic { height: 1.6 },
        depth_range: (0.1, 10.0),
        size: (480, 360),
        ..above(middle)
    };
    let mut renderer = watched_with(&m, sunny(SUN));
    let picture = render(&mut renderer, &camera);
    assert_silent(renderer);
    let shade = |q: DVec3| {
        let ends = [low, high].map(|z| (q + s * ((z - q.z) / s.z)).truncate());
        ends.iter().any(|p| p.length() > 1.0)
    };
    let [lit, dark] = assert_ground(&picture, &camera, "a bore", shade);
    assert!(lit > 10_000 && dark > 10_000, "{lit} lit, {dark} not");
}

/// A pot with a neck, carved into a block: its wall turns away from the sun and back, so some rays leave it where it is
/// parallel to the sun's rays. Everything inside, against the reference.
#[test]
fn a_carved_pot_is_dark_where_the_sun_does_not_reach() {
    let outline = [[0.0, -1.6], [1.6, -1.6], [2.2, -1.2], [2.0, -0.4], [3.0, 0.6]].map(|[r, z]| [r, z, 1.0]);
    let brim = [[3.0, 0.6, 1.0], [0.0, 0.6, 1.0]];
    let axis = [[0.0, 0.6, 1.0], [0.0, -1.6, 1.0]];
    let part = lathed_solid(&[chain(&[(3, &outline), (1, &brim), (1, &axis)])], TAU).unwrap();
    let pot = part_of(part, 1, DAffine3::IDENTITY);
    let thick = Primitive { id: GROUND, ..block([-14.0, -14.0, -3.0], [14.0, 14.0, 0.0]) };
    let m = of(vec![numbered("A-B", [thick, pot], [GROUND, 1])]);
    let towards = DVec3::new(-0.45, 0.6, 1.1);
    let camera = Camera {
        eye: DVec3::new(3.0, -10.0, 9.0),
        projection: Projection::Orthographic { height: 4.0 },
        size: (240, 180),
        ..above(DVec3::new(0.0, 0.0, -0.6))
    };
    let (tracer, sun) = (Tracer::new(&m), SunTracer::new(&m, towards).unwrap());
    let mut renderer = watched_with(&m, sunny(towards));
    let picture = render(&mut renderer, &camera);
    let light = judge_sun(&tracer, &sun, &camera, &picture.images(), &JudgeOptions::default());
    assert_silent(renderer);
    assert!(light.lit > 5000 && light.compared - light.lit > 5000, "{light:?}");
    assert!(light.deviated == 0 && picture.stats.clamps == 0, "{light:?}");
    // at the border of its own shade, a ray leaves the hollow wall by less than a cell bends, and meets it again at
    // once. The test cannot decide this, but the sun adds less than a thousandth of its light there, less than a step
    // of eight bits
    let grazed = |i: usize| DVec3::from(picture.normal[i].map(f64::from)).dot(towards.normalize()) < 1e-3;
    let told = (0..).zip(&picture.sunlit).map(|(i, lit)| *lit && !grazed(i)).collect();
    let seen = Picture { sunlit: told, ..picture.clone() };
    let rest = judge_sun(&tracer, &sun, &camera, &seen.images(), &JudgeOptions::default());
    assert!(light.wrong <= 2 && rest.wrong == 0, "{light:?}, {rest:?}");
}

/// Meshes cast exact shadows, without a deviation; a scene makes only the buffers for its casters.
#[test]
fn a_scene_makes_what_casts() {
    let ball = || shapes::sphere();
    let named = |m: &Model| {
        let mut renderer = watched_with(m, sunny(SUN));
        let picture = render(&mut renderer, &perspective(&shapes::sphere(), SIZE));
        let names = renderer.objects();
        assert_silent(renderer);
        (["sun facets", "sun parts", "sun triangles", "sun lists"].map(|n| names.iter().any(|o| o == n)), picture.stats)
    };
    let (has, stats) = named(&ball());
    assert_eq!(has, [true, true, false, true]);
    // a 1024th of the ball's box
    assert!((1e-4..6.0 * 3f64.sqrt() / 1024.0).contains(&stats.shadow_deviation), "{}", stats.shadow_deviation);
    let (has, stats) = named(&shapes::tetra());
    assert_eq!((has, stats.shadow_deviation), ([true, true, false, true], 0.0));
    let (has, stats) = named(&of(vec![one(operands::part(ball()))]));
    assert_eq!((has, stats.shadow_deviation > 0.0), ([false, false, true, true], true));
    let (has, _) = named(&of(vec![one(post(1.0, 0.0, 1.0))]));
    assert_eq!(has, [false; 4]);
    let folded = shapes::solids::folded(Op::Union, vec![post(1.0, 0.0, 1.0), operands::mesh(shapes::ball_mesh(1))]);
    assert_eq!(named(&folded).0, [false, false, true, true]);
}

/// A view of a few hundredths of a unit, cut out of the scene: the caster of the shadow is not in the cut.
#[test]
fn shadows_reach_into_views_from_very_near() {
    let mut m = shapes::plate();
    let mut ball = shapes::sphere();
    ball.parts[0].faces[0].id = 2;
    m.parts.append(&mut ball.parts);
    let to = at(-1.0, -1.0, 4.0) * DAffine3::from_scale(DVec3::splat(0.25));
    m.instances.push(selvedge::model::Instance { part: 1, ..placed(to, None) });
    let s = SUN.normalize();
    // the ray past the ball's side meets the plate here
    let side = s.cross(DVec3::Z).normalize();
    let edge = to.transform_point3(DVec3::ZERO) + side * 0.25 * SPHERE_RADIUS;
    let border = edge - s * (edge.z / s.z);
    let height = 0.012;
    let camera = Camera {
        eye: border + DVec3::new(0.2, -0.3, 1.0),
        target: border,
        up: DVec3::Y,
        projection: Projection::Orthographic { height },
        depth_range: (0.1, 3.0),
        size: (160, 120),
    };
    let mut renderer = watched_with(&m, sunny(SUN));
    let picture = render(&mut renderer, &camera);
    assert_silent(renderer);
    // along the plate, from twice the deviation, the error of a ray at both of its ends
    let far = 2.0 * picture.stats.shadow_deviation / s.z;
    assert!(far < 0.4 * height, "{far}");
    let mut seen = [0; 2];
    for i in (0..picture.face.len()).filter(|i| picture.face[*i] == 1) {
        let (o, d) = camera.ray(centre(i, camera.size));
        let q = o - d * (o.z / d.z);
        let truth = meets_ball(to, q, s);
        let near = (0..16).map(|k| q + far * DVec2::from_angle(f64::from(k) * TAU / 16.0).extend(0.0));
        if near.into_iter().all(|beside| meets_ball(to, beside, s) == truth) {
            assert_eq!(picture.sunlit[i], !truth, "at {q}");
            seen[usize::from(truth)] += 1;
        }
    }
    assert!(seen.iter().all(|n| *n > 500), "{seen:?}");
}
