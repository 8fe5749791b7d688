//! Shadows against the exact reference and against closed forms, every pixel: of Boolean solids here; of spline faces
//! and meshes in `parts`.

mod parts;

use crate::layers::{BLUE, centre, glass, model, one};
use crate::shapes::solids::{self, at, ball, below, block, cone, moved, post, ring, turned};
use crate::shapes::{self, operands};
use crate::support::{assert_identical, assert_silent, orthographic, perspective, render, watched, watched_with};
use glam::{DAffine3, DQuat, DVec2, DVec3};
use selvedge::headless::{HeadlessError, HeadlessRenderer};
use selvedge::model::{Camera, Model, Primitive, Projection, Solid, srgb};
use selvedge::picture::{FrameSettings, Outputs, Picture, Samples, SceneSettings, SolidWay};
use selvedge::renderer::RenderError;
use selvedge_check::light::{Key, studio};
use selvedge_check::{JudgeOptions, SunJudgement, SunTracer, Tracer, judge, judge_sun};

const SIZE: (u32, u32) = (120, 90);
/// Direction from the model to the sun: shadows fall towards the eye.
const SUN: DVec3 = DVec3::new(-0.5, 0.4, 0.9);

fn sunny(towards: DVec3) -> SceneSettings {
    SceneSettings { sun: Some(towards), ..SceneSettings::default() }
}

/// A plate with a hole above a block.
fn holed() -> Model {
    let (ground, plate) = (block([-4.0, -4.0, -1.0], [4.0, 4.0, 0.0]), block([-2.0, -2.0, 2.0], [2.0, 2.0, 2.5]));
    solids::solid("A+(B-C)", vec![ground, plate, post(1.0, 1.0, 3.0)])
}

/// Solids with visible shadows: through holes, on themselves, of tori, stretched, unbounded, on and in each other.
fn cases() -> Vec<solids::Named> {
    let stretched = DAffine3::from_scale(DVec3::new(2.5, 0.6, 1.2)) * turned(0.4, 0.9, 0.2);
    let floor = || below(DVec3::Z, 0.0);
    let slab = || block([-3.0, -3.0, -0.4], [3.0, 3.0, 0.0]);
    let up = |z: f64, p: Primitive| moved(at(0.0, 0.0, z), p);
    vec![
        ("a hole over a block", holed()),
        (
            "a bracket in its own shade",
            solids::solid(
                "A-B-C",
                vec![block([-2.0; 3], [2.0; 3]), block([-1.0, -1.5, -1.0], [3.0, 3.0, 3.0]), post(0.5, -3.0, 6.0)],
            ),
        ),
        ("a bowl", solids::solid("A-B*C", vec![post(2.0, 0.0, 2.0), up(2.2, ball(1.8, 0.0)), post(1.5, 0.0, 3.0)])),
        ("a ring over a slab", solids::solid("A+B+C", vec![up(1.2, ring(1.5, 0.4)), slab(), post(0.3, 0.0, 2.0)])),
        (
            "a leaning ring with a groove",
            solids::solid(
                "A-B+C",
                vec![
                    moved(turned(0.7, 0.2, 0.0), up(0.5, ring(1.5, 0.6))),
                    moved(turned(0.7, 0.2, 0.0), up(1.0, ring(1.5, 0.4))),
                    up(-2.0, slab()),
                ],
            ),
        ),
        (
            "stretched",
            solids::solid(
                "A-B+C",
                vec![
                    moved(stretched, ring(1.0, 0.4)),
                    moved(stretched, ball(0.5, 1.0)),
                    up(-2.2, block([-4.0, -4.0, -0.5], [4.0, 4.0, 0.0])),
                ],
            ),
        ),
        (
            "on a floor without an end",
            solids::solid("A+B+C", vec![floor(), cone(0.8, 0.2, 2.0), moved(at(1.6, 0.0, 0.7), ball(0.7, 0.0))]),
        ),
        (
            "sunk into a floor",
            solids::solid("A-B+C", vec![floor(), ball(1.5, 0.0), moved(at(0.3, 0.0, -1.0), post(0.2, -1.0, 2.5))]),
        ),
        (
            "an apex on a face",
            solids::solid(
                "A+B",
                vec![slab(), moved(turned(std::f64::consts::PI, 0.0, 0.0) * at(0.0, 0.0, -1.5), cone(1.0, 0.0, 1.5))],
            ),
        ),
        ("holes", solids::holes(5)),
    ]
}

/// Verdicts about the light, and about the faces, which must be right.
fn judged(
    renderer: &mut HeadlessRenderer,
    (tracer, sun): (&Tracer, &SunTracer),
    camera: &Camera,
) -> Result<(SunJudgement, Picture), String> {
    let picture = render(renderer, camera);
    let j = judge(tracer, camera, &picture.images(), &JudgeOptions::default());
    let light = judge_sun(tracer, sun, camera, &picture.images(), &JudgeOptions::default());
    if (j.wrong, light.wrong, picture.stats.clamps) != (0, 0, 0) {
        return Err(format!("{} faces wrong, {} clamps, {light:?}", j.wrong, picture.stats.clamps));
    }
    Ok((light, picture))
}

/// Number of pixels that face the sun, and of lit ones.
fn facing(picture: &Picture, camera: &Camera, towards: DVec3) -> (usize, usize) {
    let looks = |i: &usize| {
        let n = DVec3::from(picture.normal[*i].map(f64::from));
        let n = if n.dot(camera.ray(centre(*i, camera.size)).1) > 0.0 { -n } else { n };
        n.dot(towards.normalize()) > 0.05
    };
    let all: Vec<usize> = (0..picture.face.len()).filter(looks).collect();
    (all.len(), all.iter().filter(|i| picture.sunlit[**i]).count())
}

#[test]
fn every_pixel_is_lit_or_shaded_as_in_truth() {
    let mut renderer = watched(&Model::default());
    let mut wrong = Vec::new();
    // unbounded solids are viewed near the origin
    let near = solids::folded(selvedge::csg::Op::Union, vec![ball(2.5, 0.0)]);
    for (name, m) in cases() {
        let tracer = Tracer::new(&m);
        let framed = if m.solids[0].bounds().diagonal().is_finite() { &m } else { &near };
        let (mut in_shade, mut in_light) = (0, 0);
        for towards in [SUN, DVec3::new(-0.2, -1.0, 0.3), DVec3::Z] {
            let sun = SunTracer::new(&m, towards).unwrap();
            for (view, camera) in [("perspective", perspective(framed, SIZE)), ("parallel", orthographic(framed, SIZE))]
            {
                renderer.upload_with(&m, sunny(towards)).unwrap();
                let (_, events) = match judged(&mut renderer, (&tracer, &sun), &camera) {
                    Ok(found) => found,
                    Err(fault) => {
                        wrong.push(format!("{name}, {view}, {towards}: {fault}"));
                        continue;
                    }
                };
                let (all, lit) = facing(&events, &camera, towards);
                (in_shade, in_light) = (in_shade + all - lit, in_light + lit);
                let others: &[SolidWay] = if towards == SUN { &[SolidWay::Cst, SolidWay::Blister] } else { &[] };
                for &way in others {
                    renderer.upload_with(&m, SceneSettings { solids: way, ..sunny(towards) }).unwrap();
                    let other = render(&mut renderer, &camera);
                    assert_identical(&other, &events, &format!("{name}, {view}, by {}", way.name()));
                    assert!(other.sunlit == events.sunlit, "{name}, {view}, by {}", way.name());
                }
            }
        }
        if in_light < 1000 || in_shade < 300 {
            wrong.push(format!("{name}: of what faces the sun {in_light} lit, {in_shade} in shade"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_silent(renderer);
}

/// The light of a floor of colour `grey` and normal `n`, eight bits.
fn light(grey: f64, n: DVec3, camera: &Camera, key: Key) -> f64 {
    255.0 * srgb::encoded(studio(DVec3::splat(grey), n, camera, key).x)
}

/// A plate's shadow on a leaning floor: a ray to the sun passes the plate's lower face and its upper face within the
/// hole's circle, so the light in the shadow lies within two ellipses. The colours are those of the lamps.
#[test]
fn light_falls_through_a_hole() {
    let lean = turned(0.3, -0.2, 0.0);
    let ground = moved(lean, block([-6.0, -6.0, -1.0], [6.0, 6.0, 0.0]));
    let plate = block([-2.5, -2.5, 3.0], [2.5, 2.5, 3.4]);
    let m = solids::solid("A+(B-C)", vec![ground, plate, post(1.1, 2.0, 3.0)]);
    let (s, n) = (SUN.normalize(), lean.matrix3 * DVec3::Z);
    let camera = Camera {
        eye: n * 20.0 + DVec3::new(0.0, -6.0, 0.0),
        target: s * -2.0,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: 9.0 },
        depth_range: (1.0, 60.0),
        size: (240, 180),
    };
    let mut renderer = watched_with(&m, sunny(SUN));
    let picture = render(&mut renderer, &camera);
    assert_silent(renderer);
    // `None`: the plate hides the floor there
    let truth = |at: DVec2| {
        let (o, d) = camera.ray(at);
        let on_floor = |t: f64| o + d * t;
        let q = on_floor(-o.dot(n) / d.dot(n));
        let square = |p: DVec3| p.x.abs().max(p.y.abs()) < 2.5;
        let between = [3.0, 3.4].map(|z| on_floor((z - o.z) / d.z));
        if between.into_iter().any(square) {
            return None;
        }
        let [low, high] = [3.0, 3.4].map(|z| q + s * ((z - q.z) / s.z));
        let within = |p: DVec3| p.truncate().length() < 1.1;
        // or the ray is above the plate between the two, over a range of its length
        let (from, along) = (low.truncate(), (high - low).truncate());
        let (a, b) = ((DVec2::splat(-2.5) - from) / along, (DVec2::splat(2.5) - from) / along);
        let (first, last) = (a.min(b).max_element().max(0.0), a.max(b).min_element().min(1.0));
        Some(within(low) && within(high) || first >= last)
    };
    let colour = |key| light(f64::from(179) / 255.0, n, &camera, key);
    let (bright, dark) = (colour(Key::Sun(s)), colour(Key::Shadow));
    assert!(bright - dark > 60.0);
    let mut seen = [0; 3];
    for i in 0..picture.colour.len() {
        let at = centre(i, camera.size);
        let on_top = picture.face[i] == 1 && DVec3::from(picture.normal[i].map(f64::from)).dot(n) > 0.999;
        let Some(lit) = truth(at).filter(|_| on_top) else { continue };
        let near = (0..16).map(|k| at + 0.5 * DVec2::from_angle(f64::from(k) * std::f64::consts::TAU / 16.0));
        if near.into_iter().any(|beside| truth(beside) != Some(lit)) {
            continue;
        }
        assert_eq!(picture.sunlit[i], lit, "at {at}");
        // one step of eight bits, and its rounding
        let expected = if lit { bright } else { dark };
        let [r, g, b, _] = picture.colour[i].map(f64::from);
        assert!((r - expected).abs() <= 1.0 && r == g && g == b, "at {at}: {r} for {expected}");
        let spot = lit && camera.project(at3(&camera, at, n)).is_some() && in_plate(&camera, at, n, s);
        seen[if spot { 2 } else { usize::from(lit) }] += 1;
    }
    assert!(seen.iter().all(|count| *count > 500), "shaded, lit, lit through the hole: {seen:?}");
}

/// Where the floor of normal `n` through the origin is at a pixel.
fn at3(camera: &Camera, at: DVec2, n: DVec3) -> DVec3 {
    let (o, d) = camera.ray(at);
    o - d * (o.dot(n) / d.dot(n))
}

/// The ray to the sun passes within the outline of the plate.
fn in_plate(camera: &Camera, at: DVec2, n: DVec3, s: DVec3) -> bool {
    let q = at3(camera, at, n);
    let p = q + s * ((3.0 - q.z) / s.z);
    p.x.abs().max(p.y.abs()) < 2.5
}

/// Spline faces, trimmed ones, open ones and meshes receive shadows, from others and from themselves.
#[test]
fn every_kind_of_face_is_shaded() {
    let cases = [
        ("a sphere", shapes::sphere()),
        ("a trimmed cylinder", shapes::cylinder()),
        ("an open sheet", shapes::wave()),
        ("a trimmed plate", shapes::plate()),
        ("a mesh", shapes::tetra()),
        ("a mesh and a trimmed face", shapes::beside()),
    ];
    let mut renderer = watched(&Model::default());
    for (name, mut m) in cases {
        let (c, r) = (m.control_bounds().centre(), m.control_bounds().diagonal());
        let towards = DVec3::new(-0.3, -0.6, 0.9).normalize();
        let to =
            DAffine3::from_scale_rotation_translation(DVec3::splat(r), DQuat::from_rotation_arc(DVec3::Z, towards), c);
        // a lattice between the model and the sun
        let bars =
            (-4..=4).map(|k| moved(at(0.0, f64::from(k) * 0.12, 0.0), block([-0.6, -0.03, 1.2], [0.6, 0.03, 1.3])));
        let lattice = solids::folded(selvedge::csg::Op::Union, bars.map(|bar| moved(to, bar)).collect());
        let solid = &lattice.solids[0];
        let ids = solid.primitives().iter().map(|p| Primitive { id: p.id + 1000, ..p.clone() }).collect();
        let camera = Camera { depth_range: (0.01 * r, 20.0 * r), ..perspective(&m, SIZE) };
        m.solids = vec![Solid::new(ids, solid.tree().clone()).unwrap()];
        let (tracer, sun) = (Tracer::new(&m), SunTracer::new(&m, towards).unwrap());
        renderer.upload_with(&m, sunny(towards)).unwrap();
        let (light, picture) =
            judged(&mut renderer, (&tracer, &sun), &camera).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(picture.stats.shadowless, 0, "{name}");
        let (all, lit) = facing(&picture, &camera, towards);
        assert!(lit > 100 && all - lit > 100, "{name}: {lit} of {all} lit, {light:?}");
    }
    assert_silent(renderer);
}

/// Mesh operands cast shadows, on themselves and on a slab below: whole, mirrored, coinciding, inverted and doubled
/// ones.
#[test]
fn meshes_cast_shadows() {
    let mut renderer = watched(&Model::default());
    let mut wrong = Vec::new();
    for (name, mut m) in operands::meshes().into_iter().chain(operands::unclean()) {
        let bounds = m.control_bounds();
        let (c, r) = (bounds.centre(), bounds.diagonal());
        let below = DVec3::new(0.0, 0.0, bounds.min.z - c.z - 0.05 * r);
        let slab = block(
            (c + below - r * DVec3::new(0.8, 0.8, 0.1)).into(),
            (c + below + r * DVec3::new(0.8, 0.8, 0.0)).into(),
        );
        m.solids.push(one(Primitive { id: 1000, ..slab }));
        let camera = perspective(&m, (96, 72));
        let (tracer, sun) = (Tracer::new(&m), SunTracer::new(&m, SUN).unwrap());
        renderer.upload_with(&m, sunny(SUN)).unwrap();
        match judged(&mut renderer, (&tracer, &sun), &camera) {
            Err(fault) => wrong.push(format!("{name}: {fault}")),
            Ok((light, picture)) => {
                let (all, lit) = facing(&picture, &camera, SUN);
                if lit < 200 || all - lit < 50 || picture.stats.shadowless > 0 {
                    wrong
                        .push(format!("{name}: {lit} of {all} lit, {} cast none, {light:?}", picture.stats.shadowless));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_silent(renderer);
}

/// The eye within a solid or within its hole; the near plane through the middle: neither cuts the light.
#[test]
fn the_eye_may_be_anywhere() {
    let m = solids::solid(
        "A-B-D+C",
        vec![ball(3.0, 0.0), ball(2.0, 0.0), ring(1.2, 0.2), moved(at(0.5, -0.4, 0.0), post(0.8, 0.0, 4.0))],
    );
    let look = |eye: DVec3, near: f64| Camera {
        eye,
        target: eye + DVec3::new(1.0, 0.3, -0.5),
        up: DVec3::Z,
        projection: Projection::Perspective { fov_y: 1.2 },
        depth_range: (near, 20.0),
        size: SIZE,
    };
    let cases = [
        ("in the hole", look(DVec3::new(-1.5, 0.0, 0.6), 0.01)),
        ("in the shell", look(DVec3::new(-2.5, 0.0, 0.6), 0.01)),
        ("near plane through the middle", look(DVec3::new(-7.0, -2.0, 3.5), 7.6)),
    ];
    let (tracer, sun) = (Tracer::new(&m), SunTracer::new(&m, SUN).unwrap());
    let mut renderer = watched_with(&m, sunny(SUN));
    for (name, camera) in &cases {
        let (light, _) = judged(&mut renderer, (&tracer, &sun), camera).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(light.lit > 20 && light.compared - light.lit > 500, "{name}: {light:?}");
    }
    assert_silent(renderer);
}

/// Empty solids leave everything that faces the sun lit, and so does a ball for itself. Without a sun there are no
/// resources for it.
#[test]
fn only_who_casts_shadows_has_what_that_takes() {
    let nothing = solids::solid("A*B", vec![ball(0.5, 0.0), ball(0.5, 3.0)]);
    let with = |m: &Model| Model { solids: nothing.solids.clone(), ..m.clone() };
    let objects = |m: &Model, settings: SceneSettings| {
        let mut renderer = watched_with(m, settings);
        let picture = render(&mut renderer, &perspective(&shapes::sphere(), SIZE));
        let mut names = renderer.objects();
        names.retain(|name| name.contains("sun"));
        assert_silent(renderer);
        (names, picture)
    };
    for m in [shapes::sphere(), with(&shapes::sphere())] {
        let (names, picture) = objects(&m, sunny(SUN));
        assert!(names.iter().any(|n| n.starts_with("resolve")) && names.iter().any(|n| n == "sun"), "{names:?}");
        assert!(names.iter().any(|n| n == "sun tiles"), "{names:?}");
        let mut lit = 0;
        for (i, n) in picture.normal.iter().enumerate() {
            let rise = DVec3::from(n.map(f64::from)).dot(SUN.normalize());
            if rise.abs() > 1e-5 {
                assert_eq!(picture.sunlit[i], rise > 0.0, "{rise}");
            }
            lit += usize::from(picture.sunlit[i]);
        }
        assert!(lit > 500, "{lit}");
        let (names, picture) = objects(&m, SceneSettings::default());
        assert!(names.is_empty() && picture.sunlit.is_empty(), "{names:?}");
    }
    // transparent solids have none
    let mut clear = shapes::sphere();
    clear.instances[0].colour = Some([0.5; 4]);
    let (names, picture) = objects(&clear, sunny(SUN));
    assert!(names.iter().any(|n| n == "sun") && !names.iter().any(|n| n == "sun tiles"), "{names:?}");
    assert_eq!(picture.stats.shadowless, 1);
}

/// Transparent solids receive shadows, face by face, and cast none; each sample is lit by itself.
#[test]
fn among_layers_and_samples() {
    let steel = holed();
    let pane = glass(BLUE, [-3.0, -3.5, 0.3], [3.0, 3.5, 0.8]);
    let m = model(steel.solids.iter().cloned().chain([pane]).collect());
    let (tracer, sun) = (Tracer::new(&m), SunTracer::new(&m, SUN).unwrap());
    let mut renderer = watched_with(&m, sunny(SUN));
    for camera in [perspective(&m, SIZE), orthographic(&m, SIZE)] {
        let (light, picture) = judged(&mut renderer, (&tracer, &sun), &camera).unwrap();
        assert!(light.lit > 1000 && light.compared - light.lit > 500, "{light:?}");
        assert_eq!(picture.stats.shadowless, 1);
    }
    // the same without glass, with samples: intermediate colours at the edges of shadows only
    let camera = orthographic(&steel, SIZE);
    let pictures = [Samples::One, Samples::Four].map(|samples| {
        renderer.upload_with(&steel, SceneSettings { samples, ..sunny(SUN) }).unwrap();
        render(&mut renderer, &camera)
    });
    let (one, four) = (&pictures[0], &pictures[1]);
    assert!(one.sunlit == four.sunlit);
    let ground = |i: usize| one.face[i] == 1 && one.normal[i][2] > 0.9;
    let shades: std::collections::BTreeSet<_> =
        (0..one.colour.len()).filter(|i| ground(*i)).map(|i| one.colour[i]).collect();
    assert_eq!(shades.len(), 2, "the ground is lit or not: {shades:?}");
    let w = SIZE.0 as usize;
    let inner = |i: usize| (1..w - 1).contains(&(i % w)) && i > w && i + w < one.colour.len();
    let mut between = 0;
    for i in (0..one.colour.len()).filter(|i| inner(*i)) {
        let block = [0, 1, 2].into_iter().flat_map(|y| (0..3).map(move |x| i + x + y * w - 1 - w));
        if !block.clone().all(ground) {
            continue;
        }
        let edge = block.clone().any(|k| one.sunlit[k] != one.sunlit[i]);
        assert!(edge || four.colour[i] == one.colour[i], "at {}", centre(i, SIZE));
        between += usize::from(!shades.contains(&four.colour[i]));
    }
    assert!(between > 50, "{between} pixels in between");
    assert_silent(renderer);
}

/// Cut by a plane or a volume, the rest receives shadows. Solids cast them; parts that a volume cuts do not, and are
/// counted.
#[test]
fn cut_open() {
    let cut = holed().section(DVec3::new(0.3, 1.0, 0.1), 0.4).unwrap();
    let mut trimmed = shapes::sphere();
    let bounds = trimmed.control_bounds();
    trimmed.trim_by(&one(moved(at(0.0, 0.0, bounds.centre().z), below(DVec3::new(1.0, -1.0, 1.0), 0.2)))).unwrap();
    let (c, r) = (bounds.centre(), bounds.diagonal());
    let bar = Primitive { id: 77, ..block([-0.1, -0.1, 0.5], [0.1, 0.1, 0.6]) };
    trimmed.solids.push(one(moved(DAffine3::from_translation(c) * DAffine3::from_scale(DVec3::splat(r)), bar)));
    let part = operands::part(shapes::sphere());
    let operand = model(vec![Solid::union(&[one(part), one(block([-3.0, -3.0, -3.0], [3.0, 3.0, -2.0]))]).unwrap()]);
    let mut renderer = watched(&Model::default());
    for (name, m, shadowless) in [("by a plane", cut, 0), ("by a volume", trimmed, 1), ("an operand", operand, 0)] {
        let (tracer, sun) = (Tracer::new(&m), SunTracer::new(&m, SUN).unwrap());
        renderer.upload_with(&m, sunny(SUN)).unwrap();
        let (light, picture) = judged(&mut renderer, (&tracer, &sun), &perspective(&m, (96, 64)))
            .unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(light.lit > 50 && light.compared - light.lit > 50, "{name}: {light:?}");
        assert_eq!(picture.stats.shadowless, shadowless, "{name}");
    }
    assert_silent(renderer);
}

/// Pictures repeat bit for bit, for any order of equal operands.
#[test]
fn shadows_repeat_and_operands_commute() {
    let one = |text: &str| {
        let all = vec![
            block([-3.0, -3.0, -1.0], [3.0, 3.0, 0.0]),
            block([-1.5, -1.5, 1.5], [1.5, 1.5, 2.0]),
            post(0.8, 1.0, 2.0),
        ];
        let mut m = solids::solid(text, all);
        let solid = &m.solids[0];
        let same = solid.primitives().iter().map(|p| Primitive { id: 1, ..p.clone() }).collect();
        m.solids = vec![Solid::new(same, solid.tree().clone()).unwrap()];
        m
    };
    let first = one("A+(B-C)");
    let camera = perspective(&first, SIZE);
    let mut renderer = watched_with(&first, sunny(SUN));
    let picture = render(&mut renderer, &camera);
    assert_identical(&picture, &render(&mut renderer, &camera), "again");
    for text in ["(B-C)+A", "!C*B+A", "!(!A*(C+!B))", "A+B-(C-A)"] {
        renderer.upload_with(&one(text), sunny(SUN)).unwrap();
        let drawn = render(&mut renderer, &camera);
        assert!(drawn.sunlit == picture.sunlit && drawn.colour == picture.colour, "light of {text}");
    }
    assert_silent(renderer);
}

/// A sun without a direction is an error, and the scene before stays.
#[test]
fn a_sun_has_a_direction() {
    let m = holed();
    let camera = perspective(&m, SIZE);
    let mut renderer = watched_with(&m, sunny(SUN));
    let settings = FrameSettings::default();
    let before = renderer.render(&camera, &settings, Outputs::ALL).unwrap();
    for bad in [DVec3::ZERO, DVec3::NAN, DVec3::new(f64::INFINITY, 0.0, 0.0)] {
        let refused = renderer.upload_with(&m, sunny(bad));
        assert!(matches!(refused, Err(HeadlessError::Render(RenderError::Sun(_)))), "{bad}: {refused:?}");
    }
    // so small or large that its square is not finite
    for scale in [1e-200, 1e200] {
        renderer.upload_with(&m, sunny(SUN * scale)).unwrap();
        let after = renderer.render(&camera, &settings, Outputs::ALL).unwrap();
        assert!(after.colour == before.colour, "a direction of length {scale}");
    }
    assert_silent(renderer);
}
