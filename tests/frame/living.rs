//! A scene lives: placed parts move, hide and change their colour without an upload. Every image is the same bit for bit as
//! that of the changed model, uploaded anew.

use crate::hidden::crowd;
use crate::shapes::{self, solids};
use crate::support::{assert_identical, assert_silent, watched_for};
use glam::{DAffine3, DVec3};
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, Colour, Model, ModelError};
use selvedge::picture::{
    EdgeSettings, FrameSettings, Highlight, Outputs, Picture, Samples, SceneSettings, Smooth, TrimWay,
};
use selvedge::renderer::InstanceError;

pub const SIZE: (u32, u32) = (160, 120);
pub const ALL: Outputs = Outputs { edge: true, part: true, instance: true, ..Outputs::ALL };
const RED: Colour = [0.8, 0.05, 0.05, 1.0];

/// Rows of plates, cubes, cylinders, waves and ripples, with a mesh among them.
pub fn scene() -> Model {
    let mut model = crowd();
    let globe = shapes::globe();
    model.parts.extend(globe.parts);
    for place in [DVec3::new(10.0, -3.0, 5.0), DVec3::new(17.0, -3.0, 9.0)] {
        let placed = shapes::placed(DAffine3::from_translation(place) * DAffine3::from_scale(DVec3::splat(2.0)), None);
        model.instances.push(selvedge::model::Instance { part: model.parts.len() - 1, ..placed });
    }
    model
}

pub fn camera(model: &Model) -> Camera {
    Camera::around(model.control_bounds(), DVec3::new(0.3, -1.0, 0.4), DVec3::Z, 35f64.to_radians(), SIZE)
}

/// A watched renderer for pictures with all images.
pub fn renderer() -> HeadlessRenderer {
    let mut renderer = crate::watched::renderer();
    renderer.expect(ALL);
    renderer
}

pub fn draw(renderer: &mut HeadlessRenderer, camera: &Camera) -> Picture {
    renderer.render(camera, &FrameSettings::default(), ALL).unwrap()
}

/// As `assert_identical`, numbers included.
pub fn assert_all_identical(a: &Picture, b: &Picture, what: &str) {
    assert_identical(a, b, what);
    assert!(a.edge == b.edge && a.part == b.part && a.instance == b.instance, "numbers {what}");
}

/// Settings that draw placed parts each in another way.
pub fn ways() -> Vec<(&'static str, SceneSettings)> {
    let usual = SceneSettings::default();
    vec![
        ("table", SceneSettings { trim: TrimWay::Table, ..usual }),
        ("exact", SceneSettings { trim: TrimWay::Exact, ..usual }),
        ("edges", SceneSettings { edges: Some(EdgeSettings { silhouettes: true, ..Default::default() }), ..usual }),
        ("samples", SceneSettings { trim: TrimWay::Table, samples: Samples::Four, ..usual }),
        ("smooth", SceneSettings { smooth: Smooth::Trims, ..usual }),
        ("smooth borders", SceneSettings { smooth: Smooth::Borders, ..usual }),
        ("edits", SceneSettings { trim: TrimWay::Table, editable: true, ..usual }),
    ]
}

/// Where an instance goes at a step: along a row, turned and mirrored, all within the scene.
pub fn step(n: usize) -> DAffine3 {
    let place = DVec3::new(3.0 + 5.0 * n as f64, 9.0 - 2.0 * n as f64, 3.0 + n as f64);
    let mirror = if n.is_multiple_of(2) { DVec3::ONE } else { DVec3::new(-1.0, 1.0, 1.0) };
    DAffine3::from_translation(place) * DAffine3::from_rotation_z(0.4 * n as f64) * DAffine3::from_scale(mirror)
}

#[test]
fn a_moved_part_is_where_an_upload_has_it() {
    let mut views = 0;
    let [mut renderer, mut fresh] = [(); 2].map(|()| renderer());
    for (way, settings) in ways() {
        let mut model = scene();
        renderer.upload_with(&model, settings).unwrap();
        let camera = camera(&model);
        let near = Camera { eye: camera.eye.lerp(DVec3::new(15.0, 10.0, 5.0), 0.7), ..camera };
        let near = Camera { depth_range: (1.0, 100.0), ..near };
        let mut before = draw(&mut renderer, &camera);
        // of a plate, a mirrored part and the mesh; another view between
        for (n, instance) in [0, 40, model.instances.len() - 1].into_iter().enumerate() {
            model.instances[instance].transform = step(n);
            renderer.set_transform(instance, step(n)).unwrap();
            fresh.upload_with(&model, settings).unwrap();
            // near by, lists grow: after the first step alone
            for (nth, view) in [camera, near].iter().take(if n == 0 { 2 } else { 1 }).enumerate() {
                let picture = draw(&mut renderer, view);
                let expected = draw(&mut fresh, view);
                assert_all_identical(&picture, &expected, &format!("{way}, step {n}, picture {nth}"));
                assert!(nth > 0 || !picture.stats.reused, "{way}: the part moved");
                assert!(nth > 0 || picture.stats.edit_bytes == 64, "{way}: {} bytes", picture.stats.edit_bytes);
                views += 1;
            }
            let picture = draw(&mut renderer, &camera);
            assert!(picture.face != before.face, "{way}, step {n}: nothing moved");
            before = picture;
        }
    }
    assert_silent(renderer);
    assert_silent(fresh);
    assert_eq!(views, ways().len() * (2 + 1 + 1));
}

#[test]
fn a_hidden_part_is_as_one_that_was_not_uploaded() {
    let [mut renderer, mut fresh] = [(); 2].map(|()| renderer());
    for (way, settings) in ways() {
        let model = scene();
        let gone = [1usize, 22, 41, 80, model.instances.len() - 2];
        let mut without = model.clone();
        let mut nth = 0..;
        without.instances.retain(|_| !gone.contains(&nth.next().unwrap()));
        renderer.upload_with(&model, settings).unwrap();
        fresh.upload_with(&without, settings).unwrap();
        let camera = camera(&model);
        let whole = draw(&mut renderer, &camera);
        gone.iter().for_each(|&instance| renderer.set_visible(instance, false).unwrap());
        let picture = draw(&mut renderer, &camera);
        assert_identical(&picture, &draw(&mut fresh, &camera), way);
        assert!(picture.edge == draw(&mut fresh, &camera).edge, "{way}: lines");
        assert!(picture.face != whole.face, "{way}: nothing was hidden");
        assert!(!picture.instance.iter().any(|n| gone.contains(&(*n as usize).wrapping_sub(1))), "{way}");
        // moved while nobody sees it, and shown again
        renderer.set_transform(gone[0], step(1)).unwrap();
        let still = draw(&mut renderer, &camera);
        assert_all_identical(&still, &picture, way);
        gone.iter().for_each(|&instance| renderer.set_visible(instance, true).unwrap());
        let mut moved = model.clone();
        moved.instances[gone[0]].transform = step(1);
        fresh.upload_with(&moved, settings).unwrap();
        assert_all_identical(&draw(&mut renderer, &camera), &draw(&mut fresh, &camera), way);
    }
    assert_silent(renderer);
    assert_silent(fresh);
}

#[test]
fn a_colour_changes_no_other_image_and_draws_nothing_else_anew() {
    let mut model = scene();
    let settings = SceneSettings::default();
    let mut renderer = watched_for(ALL, &model, settings);
    let camera = camera(&model);
    let plain = [0, 1, 2].map(|_| draw(&mut renderer, &camera))[2].clone();
    let plate = 3;
    renderer.set_colour(plate, Some(RED)).unwrap();
    let red = draw(&mut renderer, &camera);
    assert!(red.stats.reused, "what is seen stays");
    model.instances[plate].colour = Some(RED);
    let mut fresh = watched_for(ALL, &model, settings);
    assert_all_identical(&red, &draw(&mut fresh, &camera), "red");
    let changed = |a: &Picture, b: &Picture| -> Vec<u32> {
        let mut all: Vec<u32> =
            (0..a.colour.len()).filter(|i| a.colour[*i] != b.colour[*i]).map(|i| a.instance[i]).collect();
        all.sort_unstable();
        all.dedup();
        all
    };
    assert_eq!(changed(&plain, &red), [plate as u32 + 1]);
    // a mark goes over the colour, as strong as its opacity
    renderer.set_selected(plate, Some([0.0, 0.2, 1.0, 1.0])).unwrap();
    let marked = draw(&mut renderer, &camera);
    model.instances[plate].colour = Some([0.0, 0.2, 1.0, 1.0]);
    fresh.upload_with(&model, settings).unwrap();
    assert!(marked.colour == draw(&mut fresh, &camera).colour && marked.face == plain.face);
    renderer.set_selected(plate, Some([0.0, 0.2, 1.0, 0.5])).unwrap();
    let half = draw(&mut renderer, &camera);
    assert_eq!((changed(&half, &marked), changed(&half, &red)), (vec![plate as u32 + 1], vec![plate as u32 + 1]));
    renderer.set_selected(plate, None).unwrap();
    assert!(draw(&mut renderer, &camera).colour == red.colour);
    renderer.set_colour(plate, None).unwrap();
    assert!(draw(&mut renderer, &camera).colour == plain.colour);
    assert_silent(renderer);
    assert_silent(fresh);
}

/// Before the first picture, close up where a part of the model is cut out, and after an upload for other images.
#[test]
fn changes_stay_whatever_is_loaded() {
    let mut model = scene();
    let settings = SceneSettings::default();
    let mut renderer = watched_for(Outputs::default(), &model, settings);
    let (moved, gone) = (0, 7);
    renderer.set_transform(moved, step(0)).unwrap();
    renderer.set_visible(gone, false).unwrap();
    model.instances[moved].transform = step(0);
    let place = model.instances[gone].transform.translation;
    let mut without = model.clone();
    without.instances[gone].transform.translation = DVec3::new(0.0, 30.0, 5.0); // behind the eye below
    let afar = camera(&model);
    let first = renderer.render(&afar, &FrameSettings::default(), Outputs::default()).unwrap();
    let all = draw(&mut renderer, &afar);
    assert!(first.colour == all.colour, "images of numbers came to it");
    // a ten-thousandth of the scene, at a plate that moved; beside it what is hidden
    let target = model.instances[moved].transform.transform_point3(model.parts[0].control_bounds().min);
    let close = Camera { eye: target + DVec3::new(0.001, -0.003, 0.002), target, depth_range: (1e-4, 25.0), ..afar };
    let mut fresh = watched_for(ALL, &without, settings);
    let seen = draw(&mut renderer, &close);
    assert!(seen.instance.contains(&(moved as u32 + 1)), "it looks at the plate");
    assert_all_identical(&seen, &draw(&mut fresh, &close), "close up");
    // it moves while it is seen close up
    let shift = DAffine3::from_translation(DVec3::new(5e-4, 0.0, 0.0));
    renderer.set_transform(moved, shift * step(0)).unwrap();
    without.instances[moved].transform = shift * step(0);
    fresh.upload_with(&without, settings).unwrap();
    let next = draw(&mut renderer, &close);
    assert!(next.depth != seen.depth, "it moved");
    assert_all_identical(&next, &draw(&mut fresh, &close), "moved close up");
    // what is hidden stays so
    let hidden = Camera { eye: place + DVec3::new(0.0, -0.004, 0.0), target: place, depth_range: (1e-4, 9.0), ..afar };
    let n = gone as u32 + 1;
    assert!(!draw(&mut renderer, &hidden).instance.contains(&n), "it is hidden");
    assert!(!draw(&mut renderer, &afar).instance.contains(&n), "it is hidden");
    assert_silent(renderer);
    assert_silent(fresh);
}

#[test]
fn what_cannot_change_says_so_and_stays() {
    let model = scene();
    let mut renderer = watched_for(ALL, &model, SceneSettings::default());
    let camera = camera(&model);
    let before = draw(&mut renderer, &camera);
    let none = model.instances.len();
    assert_eq!(renderer.set_visible(none, false), Err(InstanceError::NoSuchInstance(none)));
    let nan = DAffine3::from_translation(DVec3::NAN);
    let bad = InstanceError::Model(ModelError::Transform { instance: 2 });
    assert_eq!(renderer.set_transform(2, nan), Err(bad));
    let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
    assert_eq!(renderer.set_transform(2, flat), Err(InstanceError::Model(ModelError::Flat { instance: 2 })));
    let huge = DAffine3::from_scale(DVec3::splat(1e103));
    assert_eq!(renderer.set_transform(2, huge), Err(InstanceError::Model(ModelError::Scale { instance: 2 })));
    for colour in [[f32::NAN, 0.0, 0.0, 1.0], [2.0, 0.0, 0.0, 1.0]] {
        assert!(matches!(renderer.set_colour(2, Some(colour)), Err(InstanceError::Model(ModelError::Colour { .. }))));
        assert!(matches!(renderer.set_selected(2, Some(colour)), Err(InstanceError::Model(ModelError::Colour { .. }))));
    }
    assert_eq!(renderer.set_colour(2, Some([1.0, 0.0, 0.0, 0.5])), Err(InstanceError::SeenThrough(2)));
    assert_all_identical(&draw(&mut renderer, &camera), &before, "nothing changed");

    let up = DAffine3::from_translation(DVec3::Z);
    let sun = SceneSettings { sun: Some(DVec3::Z), ..SceneSettings::default() };
    renderer.upload_with(&model, sun).unwrap();
    assert_eq!(renderer.set_transform(0, up), Err(InstanceError::Shadows(0)));
    assert_eq!(renderer.set_visible(0, false), Err(InstanceError::Shadows(0)));
    renderer.set_colour(0, Some(RED)).unwrap();
    // a part of glass; and of a scene whose rays are followed, every closed part
    let cube = shapes::cube();
    let mut glass = cube.clone();
    glass.instances[0].colour = Some([0.1, 0.2, 0.9, 0.5]);
    renderer.upload(&glass).unwrap();
    assert_eq!(renderer.set_transform(0, up), Err(InstanceError::Followed(0)));
    assert_eq!(renderer.set_colour(0, Some(RED)), Err(InstanceError::Followed(0)));
    for settings in [
        SceneSettings { thickness: true, ..SceneSettings::default() },
        SceneSettings { highlight: Some(Highlight::default()), ..SceneSettings::default() },
    ] {
        renderer.upload_with(&cube, settings).unwrap();
        assert_eq!(renderer.set_transform(0, up), Err(InstanceError::Followed(0)));
    }
    assert_silent(renderer);
}

/// Boolean solids are no instances: they stay, and parts move beside and into them.
#[test]
fn parts_move_among_boolean_solids() {
    let mut model = shapes::cube();
    model.solids = solids::holes(3).solids;
    let settings = SceneSettings::default();
    let mut renderer = watched_for(ALL, &model, settings);
    let mut fresh = watched_for(ALL, &model, settings);
    let camera = camera(&model);
    draw(&mut renderer, &camera);
    for n in 0..3 {
        let transform = DAffine3::from_translation(DVec3::new(0.3 * f64::from(n), -0.2, 0.1));
        renderer.set_transform(0, transform).unwrap();
        model.instances[0].transform = transform;
        fresh.upload_with(&model, settings).unwrap();
        assert_all_identical(&draw(&mut renderer, &camera), &draw(&mut fresh, &camera), &format!("step {n}"));
    }
    assert_silent(renderer);
    assert_silent(fresh);
}
/// Where patches come to be seen that lay behind others, they are drawn after the others: the lines of that frame are all
/// there.
#[test]
fn lines_are_whole_while_the_eye_moves() {
    let model = scene();
    let (_, settings) = ways()[2];
    let mut renderer = watched_for(ALL, &model, settings);
    let mut fresh = watched_for(ALL, &model, settings);
    let first = camera(&model);
    for n in 0..6 {
        let view = Camera { eye: first.eye + DVec3::new(0.3 * f64::from(n), 0.0, 0.0), ..first };
        fresh.upload_with(&model, settings).unwrap();
        assert_all_identical(&draw(&mut renderer, &view), &draw(&mut fresh, &view), &format!("view {n}"));
        draw(&mut renderer, &view);
    }
    assert_silent(renderer);
    assert_silent(fresh);
}
