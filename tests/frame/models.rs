//! Models come to a living scene and go. Every image is the same bit for bit as that of the whole, uploaded anew.

use crate::cages;
use crate::hidden_parts::{before_the_block, behind_the_hall, hall};
use crate::living::{ALL, SIZE, assert_all_identical, camera, draw, renderer, scene, step, ways};
use crate::shapes::{self, solids};
use crate::support::{assert_identical, assert_silent, watched_for};
use glam::{DAffine3, DVec3};
use selvedge::headless::{HeadlessError, HeadlessRenderer};
use selvedge::model::{Camera, Instance, Model};
use selvedge::picture::{FrameSettings, Outputs, Picture, SceneSettings, TrimWay};
use selvedge::renderer::{InstanceError, RemoveError, RenderError};

/// Rows of everything, with closed parts of several faces among them.
fn base() -> Model {
    let mut cage = cages::a_box().model;
    cage.instances[0].transform = DAffine3::from_translation(DVec3::new(3.0, 3.0, 12.0));
    both(&scene(), &cage)
}

/// Plates, waves, globes, cubes and closed cages, in rows within [`base`].
fn extra() -> Model {
    let mut model = Model::default();
    let shapes = [shapes::plate(), shapes::wave(), shapes::globe(), shapes::cube(), cages::a_box().model];
    for (part, shape) in shapes.into_iter().enumerate() {
        let centre = shape.control_bounds().centre();
        model.parts.extend(shape.parts);
        for k in 0..3 {
            let place = DVec3::new(3.5 + 7.0 * k as f64, 3.5 + 6.0 * part as f64, 9.0);
            let transform = DAffine3::from_translation(place - centre);
            model.instances.push(Instance { part, transform, colour: None, name: String::new() });
        }
    }
    model
}

/// One cube, at the place of its number.
fn one(n: usize) -> Model {
    let mut model = shapes::cube();
    model.instances[0].transform = step(n);
    model
}

/// What an upload of both has.
fn both(a: &Model, b: &Model) -> Model {
    let mut model = a.clone();
    let first = model.parts.len();
    model.parts.extend(b.parts.iter().cloned());
    model.instances.extend(b.instances.iter().map(|i| Instance { part: first + i.part, ..i.clone() }));
    model.solids.extend(b.solids.iter().cloned());
    model
}

/// In the middle of where cubes go.
fn within(mut model: Model) -> Model {
    model.instances[0].transform = step(1);
    model
}

/// At the first and the last of those places.
fn wide(model: Model) -> Model {
    let placed = [0, 3].map(|n| Instance { transform: step(n), ..model.instances[0].clone() });
    Model { instances: placed.to_vec(), ..model }
}

fn near(camera: &Camera) -> Camera {
    let near = Camera { eye: camera.eye.lerp(DVec3::new(15.0, 10.0, 5.0), 0.7), ..*camera };
    Camera { depth_range: (1.0, 100.0), ..near }
}

/// Pipelines are what takes no memory.
fn pipelines(renderer: &HeadlessRenderer) -> Vec<String> {
    renderer.object_bytes().into_iter().filter(|(_, bytes)| *bytes == 0).map(|(name, _)| name).collect()
}

#[test]
fn an_added_model_is_as_one_that_was_uploaded() {
    let [mut renderer, mut fresh] = [(); 2].map(|()| renderer());
    for (way, settings) in ways() {
        let joins = settings.edges.is_none() && !settings.editable;
        let (base, extra) = (base(), extra());
        renderer.upload_with(&base, settings).unwrap();
        let camera = camera(&base);
        let before = draw(&mut renderer, &camera);
        let mut whole = base.clone();
        for (nth, added) in [&extra, &one(2)].into_iter().enumerate() {
            whole = both(&whole, added);
            let id = renderer.add(added).unwrap();
            let range = whole.instances.len() - added.instances.len()..whole.instances.len();
            assert_eq!(renderer.instances_of(id), Ok(range));
            assert_eq!(**renderer.model().unwrap(), whole);
            fresh.upload_with(&whole, settings).unwrap();
            // near by, lists grow: after the first model alone
            for (view, camera) in [camera, near(&camera)].iter().take(if nth == 0 { 2 } else { 1 }).enumerate() {
                let what = format!("{way}, {nth} before, view {view}");
                let picture = draw(&mut renderer, camera);
                assert_all_identical(&picture, &draw(&mut fresh, camera), &what);
                assert_all_identical(&draw(&mut renderer, camera), &picture, &what);
                assert_eq!(picture.stats.edit_bytes > 0, joins && view == 0, "{what}");
            }
        }
        assert!(draw(&mut renderer, &camera).face != before.face, "{way}: nothing came");
        // what came lives as the rest does
        let moved = base.instances.len() + 1;
        renderer.set_transform(moved, step(1)).unwrap();
        whole.instances[moved].transform = step(1);
        fresh.upload_with(&whole, settings).unwrap();
        assert_all_identical(&draw(&mut renderer, &camera), &draw(&mut fresh, &camera), &format!("{way}, moved"));
    }
    assert_silent(renderer);
    assert_silent(fresh);
}

#[test]
fn a_removed_model_is_as_one_that_was_never_there() {
    let [mut renderer, mut fresh] = [(); 2].map(|()| renderer());
    for (way, settings) in ways() {
        let (base, extra) = (base(), extra());
        renderer.upload_with(&base, settings).unwrap();
        fresh.upload_with(&both(&base, &one(1)), settings).unwrap();
        let camera = camera(&base);
        let first = renderer.add(&extra).unwrap();
        let second = renderer.add(&one(1)).unwrap();
        let all = draw(&mut renderer, &camera);
        renderer.remove(first).unwrap();
        let picture = draw(&mut renderer, &camera);
        let expected = draw(&mut fresh, &camera);
        assert_identical(&picture, &expected, way);
        assert!(picture.edge == expected.edge && all.face != picture.face, "{way}");
        // its numbers are empty
        let gone = base.instances.len()..base.instances.len() + extra.instances.len();
        assert!(!picture.instance.iter().any(|n| gone.contains(&(*n as usize).wrapping_sub(1))), "{way}");
        assert_eq!(renderer.set_visible(gone.start, true), Err(InstanceError::NoSuchInstance(gone.start)));
        fresh.upload_with(renderer.model().unwrap(), settings).unwrap();
        assert_all_identical(&picture, &draw(&mut fresh, &camera), &format!("{way}, numbers"));
        // and given to the next model with as many
        let third = renderer.add(&extra).unwrap();
        assert_eq!(renderer.instances_of(third), Ok(gone));
        fresh.upload_with(renderer.model().unwrap(), settings).unwrap();
        assert_all_identical(&draw(&mut renderer, &camera), &draw(&mut fresh, &camera), &format!("{way}, again"));
        for id in [third, second] {
            renderer.remove(id).unwrap();
        }
        assert_eq!(**renderer.model().unwrap(), base, "{way}");
        fresh.upload_with(&base, settings).unwrap();
        assert_all_identical(&draw(&mut renderer, &camera), &draw(&mut fresh, &camera), &format!("{way}, all gone"));
    }
    assert_silent(renderer);
    assert_silent(fresh);
}

/// Among the cubes and plates of [`hall`], which lie on a grid of 9.
fn among_hidden_parts() -> Model {
    let mut model = shapes::cube();
    let place = |n: u32| DVec3::new(4.5 + 9.0 * f64::from(n), 22.5, 22.5);
    model.instances = (0..4).map(|n| shapes::placed(DAffine3::from_translation(place(n)), None)).collect();
    model
}

/// Parts that come are hidden as wholes like the others, appear like the others, and go.
#[test]
fn what_comes_behind_a_block_is_hidden_with_the_parts_there() {
    let (base, added) = (hall(), among_hidden_parts());
    let settings = SceneSettings { trim: TrimWay::Exact, ..SceneSettings::default() };
    let mut renderer = watched_for(ALL, &base, settings);
    let mut fresh = watched_for(ALL, &base, settings);
    let [before, behind] = [before_the_block(DVec3::ZERO), behind_the_hall()];
    // every image of the renderer, and the number of parts that are hidden in the third
    let mut hidden_of = |renderer: &mut HeadlessRenderer, whole: &Model, what: &str| {
        fresh.upload_with(whole, settings).unwrap();
        let [of_before, of_behind] = [before, behind].map(|camera| draw(&mut fresh, &camera));
        let pictures = [(); 3].map(|()| draw(renderer, &before));
        pictures.iter().for_each(|picture| assert_all_identical(picture, &of_before, what));
        assert_all_identical(&draw(renderer, &behind), &of_behind, &format!("{what}, from behind"));
        assert_all_identical(&draw(renderer, &before), &of_before, &format!("{what}, again"));
        pictures[2].stats.hidden_parts
    };
    let hidden = hidden_of(&mut renderer, &base, "before");
    assert!(hidden > 150, "{hidden} parts are hidden");
    let id = renderer.add(&added).unwrap();
    let joined = draw(&mut renderer, &before).stats.edit_bytes;
    assert!(joined > 0, "the scene was made anew");
    let with_added = hidden_of(&mut renderer, &both(&base, &added), "added");
    assert_eq!(with_added, hidden + added.instances.len() as u64, "all of them are hidden");
    renderer.remove(id).unwrap();
    assert_eq!(hidden_of(&mut renderer, &base, "removed"), hidden);
    assert_silent(renderer);
    assert_silent(fresh);
}

/// What is copied for a model, and what is made, does not depend on the scene that it comes to.
#[test]
fn a_model_costs_what_it_costs_alone() {
    let settings = SceneSettings::default();
    let mut bytes = Vec::new();
    for times in [1, 4] {
        let mut base = base();
        let placed = base.instances.clone();
        (1..times).for_each(|_| base.instances.extend(placed.iter().cloned()));
        let mut renderer = watched_for(ALL, &base, settings);
        let camera = camera(&base);
        draw(&mut renderer, &camera);
        let made = pipelines(&renderer);
        assert!(!made.is_empty());
        let mut of = |added: &Model| {
            renderer.add(added).unwrap();
            let bytes = draw(&mut renderer, &camera).stats.edit_bytes;
            assert_eq!(draw(&mut renderer, &camera).stats.edit_bytes, 0);
            bytes
        };
        bytes.push([of(&one(0)), of(&extra()), of(&one(1))]);
        assert_eq!(pipelines(&renderer), made);
        assert_silent(renderer);
    }
    let [cube, several, again] = bytes[0];
    assert_eq!(bytes[0], bytes[1], "whatever is there already");
    assert_eq!(cube, again);
    assert!(cube < 1 << 15 && several > 2 * cube, "{bytes:?}");
}

/// From nothing on, before the first picture, and for long: memory follows what is there.
#[test]
fn a_scene_grows_from_nothing_and_does_not_fill_up() {
    let settings = SceneSettings::default();
    // the first picture has the scene uploaded anew, for more images
    let mut renderer = watched_for(Outputs::default(), &Model::default(), settings);
    let mut whole = Model::default();
    for n in 0..4 {
        renderer.add(&one(n)).unwrap();
        whole = both(&whole, &one(n));
    }
    let camera = camera(&whole);
    let mut fresh = watched_for(ALL, &whole, settings);
    assert_all_identical(&draw(&mut renderer, &camera), &draw(&mut fresh, &camera), "from nothing");
    let bytes = |renderer: &HeadlessRenderer| renderer.object_bytes().iter().map(|(_, bytes)| bytes).sum::<u64>();
    let (mut most, mut loaded) = (0, 0);
    for n in 0..150 {
        let id = renderer.add(&one(n % 5)).unwrap();
        let picture = draw(&mut renderer, &camera);
        loaded += u32::from(picture.stats.edit_bytes == 0);
        renderer.remove(id).unwrap();
        most = most.max(bytes(&renderer));
    }
    assert_eq!(**renderer.model().unwrap(), whole);
    assert_all_identical(&draw(&mut renderer, &camera), &draw(&mut fresh, &camera), "as before");
    // seven entries a cube: every 37th removal or so has made more be gone than the 256 that do not matter
    assert!((2..6).contains(&loaded), "loaded anew {loaded} times");
    assert!(most < 2 * bytes(&fresh), "{most} bytes, {} of a fresh one", bytes(&fresh));
    assert_silent(renderer);
    assert_silent(fresh);
}

#[test]
fn misuse_is_told_and_changes_nothing() {
    let settings = SceneSettings::default();
    let mut renderer = watched_for(ALL, &scene(), settings);
    let mut other = watched_for(ALL, &scene(), settings);
    let camera = camera(&scene());
    let id = renderer.add(&one(0)).unwrap();
    let before = draw(&mut renderer, &camera);
    assert_eq!(other.remove(id), Err(RemoveError::OtherScene));
    assert_eq!(other.instances_of(id), Err(RemoveError::OtherScene));
    let mut bad = one(1);
    bad.instances[0].part = 7;
    assert!(matches!(renderer.add(&bad), Err(HeadlessError::Render(RenderError::Model(_)))));
    let mut volume = one(1);
    volume.trim = solids::holes(3).solids.into_iter().next();
    assert!(matches!(renderer.add(&volume), Err(HeadlessError::Render(RenderError::AddedVolume))));
    assert_all_identical(&draw(&mut renderer, &camera), &before, "nothing changed");
    renderer.remove(id).unwrap();
    assert_eq!(renderer.remove(id), Err(RemoveError::Removed));
    assert_eq!(renderer.instances_of(id), Err(RemoveError::Removed));
    let id = renderer.add(&one(0)).unwrap();
    renderer.upload_with(&scene(), settings).unwrap();
    assert_eq!(renderer.remove(id), Err(RemoveError::OtherScene), "it went with the upload");
    assert_silent(renderer);
    assert_silent(other);
}

/// Of what more follows than arrays of parts, everything is loaded anew: solids, glass, a sun, a scene without meshes.
#[test]
fn what_is_no_more_than_parts_comes_and_goes_too() {
    let mut glass = one(1);
    glass.instances[0].colour = Some([0.1, 0.2, 0.9, 0.5]);
    let sun = SceneSettings { sun: Some(DVec3::new(0.3, -0.5, 1.0)), ..SceneSettings::default() };
    let usual = SceneSettings::default();
    let cases = [
        ("solids", usual, one(0), solids::holes(3)),
        ("among solids", usual, both(&one(0), &solids::holes(3)), one(2)),
        ("glass", usual, one(0), glass.clone()),
        ("beside glass", usual, glass, one(2)),
        ("sun", sun, one(0), one(2)),
        ("first mesh", usual, both(&one(0), &one(3)), within(shapes::globe())),
        ("first trims", usual, wide(shapes::wave()), within(shapes::plate())),
    ];
    let [mut renderer, mut fresh] = [(); 2].map(|()| renderer());
    for (what, settings, base, added) in cases {
        let whole = both(&base, &added);
        renderer.upload_with(&base, settings).unwrap();
        fresh.upload_with(&whole, settings).unwrap();
        let camera = camera(&whole);
        let before = draw(&mut renderer, &camera);
        let id = renderer.add(&added).unwrap();
        assert_all_identical(&draw(&mut renderer, &camera), &draw(&mut fresh, &camera), what);
        renderer.remove(id).unwrap();
        assert_eq!(**renderer.model().unwrap(), base, "{what}");
        assert_all_identical(&draw(&mut renderer, &camera), &before, what);
    }
    assert_silent(renderer);
    assert_silent(fresh);
}

/// Close up, where a part of the model is cut out; after an upload for other images; and what a pick says of it.
#[test]
fn models_come_and_go_whatever_is_loaded() {
    let base = base();
    let settings = SceneSettings::default();
    let mut renderer = watched_for(ALL, &base, settings);
    let mut fresh = watched_for(ALL, &both(&base, &one(1)), settings);
    let afar = camera(&base);
    let target = step(1).transform_point3(shapes::cube().control_bounds().min);
    let close = Camera { eye: target + DVec3::new(0.001, -0.003, 0.002), target, depth_range: (1e-4, 25.0), ..afar };
    let id = renderer.add(&one(1)).unwrap();
    let number = base.instances.len();
    // another renderer takes the scene over where other images are wanted
    renderer.render(&afar, &FrameSettings::default(), Outputs::default()).unwrap();
    renderer.pick(SIZE.0 / 2, SIZE.1 / 2);
    let seen = draw(&mut renderer, &close);
    assert!(seen.instance.contains(&(number as u32 + 1)), "it looks at the cube");
    assert_all_identical(&seen, &draw(&mut fresh, &close), "close up");
    let pixel = (SIZE.0 * (SIZE.1 / 2) + SIZE.0 / 2) as usize;
    let hit = renderer.picked().expect("it sees the cube");
    assert_eq!(hit.instance.map(|n| n as u32 + 1), Some(seen.instance[pixel]));
    let far = draw(&mut renderer, &afar);
    assert_all_identical(&far, &draw(&mut fresh, &afar), "from afar");
    // every pixel's hit is what its images say, of what came last too
    renderer.add(&extra()).unwrap();
    let picture = draw(&mut renderer, &afar);
    let mut hits = 0;
    for pixel in (0..picture.instance.len()).step_by(97).filter(|&pixel| picture.instance[pixel] > 0) {
        renderer.pick(pixel as u32 % SIZE.0, pixel as u32 / SIZE.0);
        draw(&mut renderer, &afar);
        let hit = renderer.picked().expect("it is seen");
        let found = (hit.instance.map(|n| n as u32 + 1), hit.part.map(|n| n as u32 + 1), hit.id);
        assert_eq!(found, (Some(picture.instance[pixel]), Some(picture.part[pixel]), picture.face[pixel]));
        hits += u32::from(hit.instance > Some(number));
    }
    assert!(hits > 2, "{hits} hits of what came last");
    // it goes and comes while it is seen close up
    draw(&mut renderer, &close);
    renderer.remove(id).unwrap();
    assert!(!draw(&mut renderer, &close).instance.contains(&(number as u32 + 1)), "it is gone");
    renderer.add(&one(1)).unwrap();
    fresh.upload_with(renderer.model().unwrap(), settings).unwrap();
    let again: [Picture; 2] = [&mut renderer, &mut fresh].map(|renderer| draw(renderer, &close));
    assert_all_identical(&again[0], &again[1], "again");
    assert_silent(renderer);
    assert_silent(fresh);
}
