//! Models cut open, by planes with caps and by volumes without, against the exact reference, every pixel.

use crate::shapes::solids::{self, at, ball, below, block, moved, post, ring, turned};
use crate::shapes::{self, SPHERE_RADIUS, operands};
use crate::support::{assert_silent, orthographic, perspective, render, watched};
use glam::{DAffine3, DVec3};
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, Model, Part, Primitive, Solid};
use selvedge::picture::{FrameSettings, Outputs, SceneSettings, TrimWay};
use selvedge_check::{JudgeOptions, Tracer, judge};

/// Small, because the exact reference is slow for splines among Boolean solids.
const SIZE: (u32, u32) = (72, 48);

/// The solid of an expression.
fn volume(text: &str, primitives: Vec<Primitive>) -> Solid {
    solids::solid(text, primitives).solids.remove(0)
}

/// The model within the volume, scaled to the model.
fn trimmed(mut model: Model, volume: &Solid) -> Model {
    model.trim_by(volume).unwrap();
    model
}

/// Scales a volume to a model's box; the expression is for a box from -1 to 1.
fn around(model: &Model, text: &str, primitives: Vec<Primitive>) -> Solid {
    let bounds = model.control_bounds();
    let size = (bounds.max - bounds.min).max_element() * 0.5;
    let to = DAffine3::from_translation(bounds.centre()) * DAffine3::from_scale(DVec3::splat(size));
    volume(text, primitives.into_iter().map(|p| moved(to, p)).collect())
}

/// Every pixel is right from two eyes that see all of `whole`; some pixels are covered and some are not.
fn right(renderer: &mut HeadlessRenderer, name: &str, whole: &Model, model: &Model, way: TrimWay) -> Vec<String> {
    let views = [("perspective", perspective(whole, SIZE)), ("parallel", orthographic(whole, SIZE))];
    renderer.upload(whole).unwrap();
    let uncut: Vec<_> = views.iter().map(|(_, camera)| render(renderer, camera).depth).collect();
    renderer.upload_with(model, SceneSettings { trim: way, ..Default::default() }).unwrap();
    let tracer = Tracer::new(model);
    let mut wrong = Vec::new();
    for ((view, camera), uncut) in views.into_iter().zip(uncut) {
        let picture = render(renderer, &camera);
        let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions::default());
        if (j.wrong, j.given_up, picture.stats.clamps) != (0, 0, 0) {
            wrong.push(format!("{name}, {view}, {way:?}: {} wrong, {:?}", j.wrong, j.mismatches.first()));
        }
        let drawn = picture.face.iter().filter(|f| **f != 0).count();
        let missing = picture.depth.iter().zip(&uncut).filter(|(a, b)| a != b).count();
        if drawn < 50 || missing < 15 {
            wrong.push(format!("{name}, {view}: {drawn} drawn, {missing} unlike the whole"));
        }
    }
    wrong
}

/// Untrimmed faces, trimmed faces, meshes, and several instances within four volumes, each with both ways to trim.
#[test]
fn volumes_trim_faces_and_meshes() {
    let models = [
        ("sphere", shapes::sphere()),
        ("cylinder", shapes::cylinder()),
        ("cube", shapes::cube()),
        ("pair", shapes::pair()),
        ("mirrored", shapes::mirrored()),
        ("ripple", shapes::ripple()),
        ("facets", shapes::ball()),
        ("beside", shapes::beside()),
    ];
    let volumes: [(&str, &str, Vec<Primitive>); 4] = [
        ("half-space", "A", vec![below(DVec3::new(1.0, -0.7, 0.4), 0.13)]),
        ("less a ball", "!A", vec![moved(at(0.7, -0.8, 0.6), ball(0.8, 0.0))]),
        (
            "union less a post",
            "(A+B)-C",
            vec![
                block([-2.0, -2.0, -2.0], [0.1, 2.0, 0.2]),
                ball(0.75, 0.2),
                moved(turned(0.3, 0.4, 0.0), post(0.3, -3.0, 6.0)),
            ],
        ),
        ("less a torus", "!A", vec![moved(turned(0.2, 0.5, 0.0), ring(0.8, 0.25))]),
    ];
    let mut renderer = watched(&Model::default());
    let mut wrong = Vec::new();
    for (k, (name, model)) in models.iter().enumerate() {
        let (by, text, primitives) = &volumes[k % volumes.len()];
        let cut = trimmed(model.clone(), &around(model, text, primitives.clone()));
        let way = if k < volumes.len() { TrimWay::Table } else { TrimWay::Exact };
        wrong.extend(right(&mut renderer, &format!("{name} {by}"), model, &cut, way));
    }
    assert_silent(renderer);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// From above, half a sphere is half a disc, to the pixel: computed without the reference and the renderer.
#[test]
fn half_a_sphere_is_half_a_disc() {
    let whole = shapes::sphere();
    let half = trimmed(whole.clone(), &volume("A", vec![below(DVec3::X, 0.0)]));
    let camera = Camera { eye: DVec3::Z * 20.0, target: DVec3::ZERO, up: DVec3::Y, ..orthographic(&whole, (200, 150)) };
    let mut renderer = watched(&half);
    let picture = render(&mut renderer, &camera);
    for (k, &face) in picture.face.iter().enumerate() {
        let centre = glam::DVec2::new((k % 200) as f64 + 0.5, (k / 200) as f64 + 0.5);
        let (p, _) = camera.ray(centre);
        let pixel = 1.5 * whole.control_bounds().diagonal() / 150.0; // half a pixel from the rim, to a corner
        let r = p.x.hypot(p.y);
        if (r - SPHERE_RADIUS).abs() > pixel && p.x.abs() > 1e-3 {
            assert_eq!(face != 0, p.x < 0.0 && r < SPHERE_RADIUS, "pixel {centre}");
        }
    }
    assert_silent(renderer);
}

/// A face in the volume's boundary stays, although rounding decides each of its points.
#[test]
fn faces_in_the_boundary_stay() {
    let mut renderer = watched(&Model::default());
    let h = shapes::CUBE_HALF;
    let cases = [("A", block([-h; 3], [h; 3])), ("!A", block([-3.0 * h, -3.0 * h, h], [3.0 * h; 3]))];
    for (text, side) in cases {
        let model = trimmed(shapes::cube(), &volume(text, vec![side]));
        renderer.upload(&model).unwrap();
        let camera = perspective(&model, SIZE);
        let picture = render(&mut renderer, &camera);
        let j = judge(&Tracer::new(&shapes::cube()), &camera, &picture.images(), &JudgeOptions::default());
        assert_eq!(j.wrong, 0, "{text}: {:?}", j.mismatches.first());
    }
    assert_silent(renderer);
}

/// Boolean solids stay solid, and are closed where they are cut.
#[test]
fn volumes_trim_solids_by_volume() {
    let whole = solids::solid("A-B", vec![ball(2.0, 0.0), ball(1.2, 0.0)]);
    let cut = trimmed(whole.clone(), &volume("A", vec![below(DVec3::new(1.0, -1.0, 0.3), 0.2)]));
    let mut renderer = watched(&Model::default());
    let wrong = right(&mut renderer, "a shell", &whole, &cut, TrimWay::Table);
    assert_silent(renderer);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Volumes that are not allowed, and volumes that are everywhere or nowhere.
#[test]
fn volumes_need_equations() {
    let cube = shapes::cube();
    let mut renderer = watched(&cube);
    let meshed = trimmed(cube.clone(), &volume("A", vec![operands::mesh(shapes::ball_mesh(1))]));
    let error = renderer.upload(&meshed).unwrap_err().to_string();
    assert!(error.contains("needs equations"), "{error}");
    let camera = perspective(&cube, SIZE);
    for (text, blank) in [("A+!A", false), ("AB", true)] {
        let all = volume(text, vec![ball(1.0, 0.0), ball(1.0, 9.0)]);
        renderer.upload(&trimmed(cube.clone(), &all)).unwrap();
        let picture = renderer.render(&camera, &FrameSettings::default(), Outputs::ALL).unwrap();
        assert_eq!(picture.face.iter().all(|f| *f == 0), blank, "{text}");
    }
    assert_silent(renderer);
}

/// Sections of all kinds of things: closed parts and solids get caps, shells are open.
#[test]
fn sections_have_caps() {
    let tube = solids::solid("A-B", vec![post(2.0, -1.0, 4.0), post(1.2, -2.0, 6.0)]);
    let mut both = shapes::cube();
    both.solids = solids::solid("A", vec![ball(0.8, 0.9)]).solids;
    let mut assembly = shapes::cube();
    assembly.parts.extend(shapes::sphere().parts);
    let aside = DAffine3::from_translation(DVec3::new(3.5, 1.0, 0.5));
    assembly.instances.push(selvedge::model::Instance { part: 1, ..shapes::placed(aside, None) });
    let mesh = Model { parts: vec![Part { closed: true, ..shapes::ball().parts.remove(0) }], ..shapes::ball() };
    let cases = [
        ("cube", shapes::cube()),
        ("sphere", shapes::sphere()),
        ("torus", shapes::torus()),
        ("mesh", mesh),
        ("shell", shapes::mirrored()),
        ("tube", tube),
        ("cube and ball", both),
        ("assembly", assembly),
    ];
    let mut renderer = watched(&Model::default());
    let mut wrong = Vec::new();
    for (name, model) in &cases {
        let normal = DVec3::new(1.0, -0.8, 0.37);
        let middle = normal.dot(model.control_bounds().centre()) + 0.11;
        let cut = model.section(normal, middle).unwrap();
        wrong.extend(right(&mut renderer, name, model, &cut, TrimWay::Table));
        if !["cube", "shell", "tube"].contains(name) {
            continue;
        }
        let twice = cut.section(DVec3::Z, model.control_bounds().centre().z + 0.21).unwrap();
        wrong.extend(right(&mut renderer, &format!("{name} twice"), model, &twice, TrimWay::Exact));
    }
    assert_silent(renderer);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Seen along its normal, a section of a sphere is a disc of known radius, depth and normal.
#[test]
fn the_cap_of_a_sphere_is_a_disc() {
    let whole = shapes::sphere();
    let height = 0.4 * SPHERE_RADIUS;
    let cut = whole.section(DVec3::Z * 2.0, 2.0 * height).unwrap();
    let cap = cut.solids[0].primitives()[1].id;
    assert_eq!((cut.instances.len(), cut.solids.len(), cap), (0, 1, 2));
    let radius = (SPHERE_RADIUS * SPHERE_RADIUS - height * height).sqrt();
    let size = (200, 150);
    let camera = Camera { eye: DVec3::Z * 20.0, target: DVec3::ZERO, up: DVec3::Y, ..orthographic(&whole, size) };
    let mut renderer = watched(&cut);
    let picture = render(&mut renderer, &camera);
    let pixel = whole.control_bounds().diagonal() / 150.0;
    for (k, &face) in picture.face.iter().enumerate() {
        let (p, _) = camera.ray(glam::DVec2::new((k % 200) as f64 + 0.5, (k / 200) as f64 + 0.5));
        let r = p.x.hypot(p.y);
        if (r - radius).abs() < 0.5 * pixel || (r - SPHERE_RADIUS).abs() < 0.5 * pixel {
            continue; // the tolerance
        }
        let expected = if r < radius { cap } else { u32::from(r < SPHERE_RADIUS) };
        assert_eq!(face, expected, "{k}: r = {r}");
        if face == cap {
            // some roundings of the distance from the eye
            assert!((f64::from(picture.depth[k]) - (20.0 - height)).abs() < 1e-5, "{}", picture.depth[k]);
            assert_eq!(picture.normal[k], [0.0, 0.0, 1.0]);
        }
    }
    assert_silent(renderer);
}

/// The rest of a section looks as before: faces with colours keep them.
#[test]
fn sections_keep_the_colours_of_faces() {
    let mut whole = shapes::cube();
    for (k, face) in whole.parts[0].faces.iter_mut().enumerate() {
        let shade = 0.15 * (k + 1) as f32;
        face.colour = Some([shade, 1.0 - shade, 0.5, 1.0]);
    }
    let cut = whole.section(DVec3::new(1.0, -0.6, 0.2), 0.3).unwrap();
    let camera = perspective(&whole, SIZE);
    let mut renderer = watched(&whole);
    let before = render(&mut renderer, &camera);
    renderer.upload(&cut).unwrap();
    let after = render(&mut renderer, &camera);
    let mut same = 0;
    for k in 0..before.face.len() {
        // roundings of a depth near 10
        if before.face[k] != 0 && (before.depth[k] - after.depth[k]).abs() < 1e-5 {
            assert_eq!(before.colour[k], after.colour[k], "pixel {k}");
            same += 1;
        }
    }
    assert!(same > 50, "{same}");
    assert_silent(renderer);
}
