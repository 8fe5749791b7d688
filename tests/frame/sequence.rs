//! Several frames in flight: the pictures of one frame after another, bit for bit.

use crate::hidden::crowd;
use crate::hidden_parts::{before_the_block, behind_the_hall, hall};
use crate::room::plates;
use crate::shapes;
use crate::support::{assert_identical, assert_silent, perspective, watched, watched_for, watched_with};
use crate::watched::limited;
use glam::{DAffine3, DVec3};
use selvedge::gpu::LowerLimits;
use selvedge::headless::{HeadlessError, HeadlessRenderer};
use selvedge::model::{Camera, Model, Projection};
use selvedge::picture::{EdgeSettings, FrameSettings, Outputs, Picture, SceneSettings, Smooth, TrimWay};
use std::panic::{AssertUnwindSafe, catch_unwind};

const SIZE: (u32, u32) = (160, 120);

/// A sequence of copies, in the order in which they are handed over.
fn sequence(
    renderer: &mut HeadlessRenderer,
    cameras: &[Camera],
    frame: FrameSettings,
    outputs: Outputs,
) -> Vec<Picture> {
    let mut pictures = Vec::new();
    let taken = renderer.render_sequence(cameras, &frame, outputs, |nth, picture| {
        assert_eq!(nth, pictures.len(), "the order of the cameras");
        pictures.push(picture.to_picture());
        Ok::<_, HeadlessError>(())
    });
    taken.unwrap();
    pictures
}

/// Compares everything except costs.
fn assert_same(in_flight: &Picture, alone: &Picture, what: &str) {
    assert_identical(in_flight, alone, what);
    let beside = |p: &Picture| {
        let thickness: Vec<_> = p.thickness.iter().map(|length| length.to_bits()).collect();
        (p.sunlit.clone(), thickness, p.edge.clone(), p.part.clone(), p.instance.clone())
    };
    assert!(beside(in_flight) == beside(alone), "images beside {what}");
    let of_scene =
        |p: &Picture| (p.stats.trim, p.stats.patches, p.stats.clamps, p.stats.open_clear, p.stats.shadowless);
    assert_eq!(of_scene(in_flight), of_scene(alone), "{what}");
}

/// Draws a sequence, and the same pictures one by one with another renderer; then one more picture with both.
fn check(model: &Model, settings: SceneSettings, cameras: &[Camera], outputs: Outputs) -> Vec<Picture> {
    let frame = FrameSettings::default();
    let [mut in_flight, mut one_by_one] = [(); 2].map(|()| watched_for(outputs, model, settings));
    let pictures = sequence(&mut in_flight, cameras, frame, outputs);
    assert_eq!(pictures.len(), cameras.len());
    for (nth, (camera, picture)) in cameras.iter().zip(&pictures).enumerate() {
        let alone = one_by_one.render(camera, &frame, outputs).unwrap();
        let shows = alone.face.iter().any(|face| *face != 0) || alone.colour.iter().any(|c| *c != alone.colour[0]);
        assert!(shows, "picture {nth} shows nothing");
        assert_same(picture, &alone, &format!("in picture {nth}"));
    }
    let after = |renderer: &mut HeadlessRenderer| renderer.render(&cameras[0], &frame, outputs).unwrap();
    assert_same(&after(&mut in_flight), &after(&mut one_by_one), "after the sequence");
    [in_flight, one_by_one].into_iter().for_each(assert_silent);
    pictures
}

/// Around the model, nearer and nearer.
fn turn(model: &Model, count: u32) -> Vec<Camera> {
    let of = |nth: u32| {
        let (sin, cos) = (0.4 * f64::from(nth)).sin_cos();
        let camera = Camera::around(model.control_bounds(), DVec3::new(cos, sin, 0.7), DVec3::Z, 0.6, SIZE);
        let nearer = 1.0 - 0.1 * f64::from(nth % 8);
        Camera { eye: camera.target + nearer * (camera.eye - camera.target), depth_range: (0.1, 1e3), ..camera }
    };
    (0..count).map(of).collect()
}

#[test]
fn patches_that_lie_behind_others() {
    let model = crowd();
    let settings = SceneSettings { trim: TrimWay::Exact, ..SceneSettings::default() };
    check(&model, settings, &turn(&model, 9), Outputs::ALL);
}

/// Hidden as wholes; they appear while other frames are in flight.
#[test]
fn placed_parts_that_lie_behind_others() {
    let settings = SceneSettings { trim: TrimWay::Exact, ..SceneSettings::default() };
    let steps = [0.0, 0.0, 1.0, 90.0, 93.0].map(|x| before_the_block(DVec3::X * x));
    let cameras: Vec<Camera> = steps.into_iter().chain([behind_the_hall()]).chain(steps[1..].to_vec()).collect();
    let pictures = check(&hall(), settings, &cameras, Outputs::ALL);
    let hidden: Vec<u64> = pictures.iter().map(|picture| picture.stats.hidden_parts).collect();
    assert!(hidden.iter().any(|parts| *parts > 150) && hidden[5] < 100, "{hidden:?} parts are hidden");
}

#[test]
fn smooth_borders_colour_alone() {
    let model = shapes::pair();
    let settings = SceneSettings { smooth: Smooth::Borders, ..SceneSettings::default() };
    check(&model, settings, &turn(&model, 5), Outputs::default());
}

/// All images at once: with lines, a sun and lengths within solids.
#[test]
fn every_image() {
    let model = shapes::cube();
    let settings = SceneSettings {
        edges: Some(EdgeSettings::default()),
        sun: Some(DVec3::new(0.3, -0.5, 1.0)),
        ..SceneSettings::default()
    };
    let outputs = Outputs { thickness: true, edge: true, part: true, instance: true, ..Outputs::ALL };
    let pictures = check(&model, settings, &turn(&model, 4), outputs);
    assert!(pictures.iter().all(|p| p.sunlit.contains(&true) && p.edge.iter().any(|edge| *edge != 0)));
    assert!(pictures.iter().all(|p| p.thickness.iter().any(|length| *length > 0.0)));
}

/// A view that stays reuses the previous frame's visibility; other sizes have images of their own.
#[test]
fn views_that_stay_and_sizes_that_change() {
    let model = crowd();
    let small = perspective(&model, (64, 48));
    let large = perspective(&model, SIZE);
    let cameras = [small, small, small, small, large, small, large, large];
    let pictures = check(&model, SceneSettings::default(), &cameras, Outputs::ALL);
    assert!(pictures.iter().any(|p| p.stats.reused), "no view is reused");
}

#[test]
fn fewer_pictures_than_flights() {
    let model = shapes::pair();
    check(&model, SceneSettings::default(), &turn(&model, 2), Outputs::ALL);
    check(&model, SceneSettings::default(), &turn(&model, 1), Outputs::ALL);
}

#[test]
fn no_picture_at_all() {
    let mut renderer = watched(&shapes::cube());
    assert!(sequence(&mut renderer, &[], FrameSettings::default(), Outputs::ALL).is_empty());
    assert_silent(renderer);
}

/// The fourth view has more scan lines than the first table, and so have the views in flight with it. Two of them are
/// the same view, so one reuses a table that lacks rows.
#[test]
fn a_frame_that_lacks_room_is_drawn_again_in_its_turn() {
    let (model, all) = plates();
    let from = |times: f64| Camera {
        eye: all.target + times * (all.eye - all.target),
        depth_range: (all.depth_range.0, times * all.depth_range.1),
        ..all
    };
    let settings = SceneSettings { trim: TrimWay::Table, ..SceneSettings::default() };
    let frame = FrameSettings { tolerance_px: 0.125, ..FrameSettings::default() };
    let cameras = [12.0, 11.0, 10.0, 1.0, 1.0, 1.01, 10.0, 11.0].map(from);
    let (mut in_flight, mut one_by_one) = (watched_with(&model, settings), watched_with(&model, settings));
    let pictures = sequence(&mut in_flight, &cameras, frame, Outputs::ALL);
    let retries: Vec<_> = pictures.iter().map(|picture| picture.stats.retries).collect();
    assert!(retries[..3] == [0; 3] && retries[3..6].iter().all(|count| *count > 0), "{retries:?}");
    for (nth, (camera, picture)) in cameras.iter().zip(&pictures).enumerate() {
        let alone = one_by_one.render(camera, &frame, Outputs::ALL).unwrap();
        assert_same(picture, &alone, &format!("in picture {nth}"));
    }
    [in_flight, one_by_one].into_iter().for_each(assert_silent);
}

/// The scene changes while frames are in flight, because near views show what was cut out of the model for them. The
/// statistics of each picture are those of its own scene.
#[test]
fn near_and_far_views_in_turn() {
    let model = shapes::wave();
    let above = Camera::around(model.control_bounds(), DVec3::Z, DVec3::Y, 0.6, SIZE);
    let diagonal = model.control_bounds().diagonal();
    let of = |closer: f64| Camera { projection: Projection::Orthographic { height: diagonal / closer }, ..above };
    let cameras = [1.0, 1e6, 1.0, 1.0, 1e6, 2e6, 1.0].map(of);
    let pictures = check(&model, SceneSettings::default(), &cameras, Outputs::ALL);
    assert_ne!(pictures[0].stats.patches, pictures[1].stats.patches, "nothing was cut out");
}

/// The sixth of eight views has more scan lines than a device with a limit of 16 MiB allows.
#[test]
fn an_error_in_the_middle_ends_the_sequence() {
    let mut model = shapes::plate();
    let place = |i: u32| DVec3::new(0.0, 0.0, -1e-3 * f64::from(i));
    model.instances = (0..120).map(|i| shapes::placed(DAffine3::from_translation(place(i)), None)).collect();
    let above = Camera::around(model.control_bounds(), DVec3::Z, DVec3::Y, 0.6, (64, 64));
    let diagonal = model.control_bounds().diagonal();
    let of = |closer: f64| Camera { projection: Projection::Orthographic { height: diagonal / closer }, ..above };
    let cameras = [1.0, 1.1, 1.2, 1.3, 1.4, 300.0, 1.5, 1.6].map(of);
    let settings = SceneSettings { trim: TrimWay::Table, ..SceneSettings::default() };
    let frame = FrameSettings { tolerance_px: 0.1, ..FrameSettings::default() };
    let mut renderer = limited(LowerLimits { storage_range: Some(1 << 24), ..LowerLimits::NONE });
    renderer.upload_with(&model, settings).unwrap();
    let mut pictures = Vec::new();
    let ended = renderer.render_sequence(&cameras, &frame, Outputs::ALL, |_, picture| {
        pictures.push(picture.to_picture());
        Ok::<_, HeadlessError>(())
    });
    let told = ended.unwrap_err().to_string();
    assert!(told.contains("scan lines are too many: at most 2097152"), "{told}");
    assert_eq!(pictures.len(), 5);
    // the renderer goes on
    for (camera, picture) in cameras.iter().zip(&pictures) {
        assert_same(picture, &renderer.render(camera, &frame, Outputs::ALL).unwrap(), "before the error");
    }
    assert_silent(renderer);
}

/// Ways in which a caller of `render_sequence` may end.
#[derive(Debug)]
enum Ended {
    Enough,
    Failed(#[allow(dead_code)] HeadlessError), // for its Debug
}

impl From<HeadlessError> for Ended {
    fn from(error: HeadlessError) -> Self {
        Self::Failed(error)
    }
}

/// After an error or a panic of the caller, frames in flight finish, and the next picture is right.
#[test]
fn a_caller_ends_the_sequence() {
    let model = shapes::pair();
    let (cameras, frame) = (turn(&model, 6), FrameSettings::default());
    let mut renderer = watched(&model);
    renderer.render(&cameras[1], &frame, Outputs::ALL).unwrap();
    // the second frame frees what the first one was uploaded from
    let right = renderer.render(&cameras[1], &frame, Outputs::ALL).unwrap();
    let objects = |renderer: &HeadlessRenderer| {
        let mut names = renderer.objects();
        names.sort();
        names
    };
    let before = objects(&renderer);
    let mut count = 0;
    let ended = renderer.render_sequence(&cameras, &frame, Outputs::ALL, |_, _| {
        count += 1;
        if count == 2 { Err(Ended::Enough) } else { Ok(()) }
    });
    assert!(matches!(ended, Err(Ended::Enough)), "{ended:?}");
    assert_eq!(count, 2);
    assert_same(&renderer.render(&cameras[1], &frame, Outputs::ALL).unwrap(), &right, "after an error");
    assert_eq!(objects(&renderer), before, "what further flights had is freed");

    let panicked = catch_unwind(AssertUnwindSafe(|| {
        renderer.render_sequence(&cameras, &frame, Outputs::ALL, |_, _| -> Result<(), HeadlessError> {
            panic!("on purpose")
        })
    }));
    assert!(panicked.is_err());
    assert_same(&renderer.render(&cameras[1], &frame, Outputs::ALL).unwrap(), &right, "after a panic");
    assert_eq!(objects(&renderer), before, "what further flights had is freed");
    assert_silent(renderer);
}

/// Cameras that come while pictures are drawn: at times there is none yet, at times there are more than flights. The
/// pictures are those of one frame after another.
#[test]
fn cameras_that_come_while_pictures_are_drawn() {
    let model = shapes::pair();
    let (cameras, frame) = (turn(&model, 7), FrameSettings::default());
    let (mut in_flight, mut one_by_one) = (watched(&model), watched(&model));
    // the answers of `next`; none after these
    let come = [Some(0), None, Some(1), Some(2), None, Some(3), Some(4), Some(5), None, Some(6), None];
    let mut come = come.into_iter();
    let mut pictures = Vec::new();
    let drawn = in_flight.render_stream(
        &frame,
        Outputs::ALL,
        || come.next().flatten().map(|nth: usize| cameras[nth]),
        |nth, picture| {
            assert_eq!(nth, pictures.len(), "the order of the cameras");
            pictures.push(picture.to_picture());
            Ok::<_, HeadlessError>(())
        },
    );
    drawn.unwrap();
    assert!(pictures.len() == cameras.len() && come.next().is_none());
    for (nth, (camera, picture)) in cameras.iter().zip(&pictures).enumerate() {
        let alone = one_by_one.render(camera, &frame, Outputs::ALL).unwrap();
        assert_same(picture, &alone, &format!("in picture {nth}"));
    }

    // a camera that shows nothing, while two pictures are in flight
    let bad = Camera { target: cameras[2].eye, ..cameras[2] };
    let mut come = [cameras[0], cameras[1], bad].into_iter();
    let mut taken = 0;
    let ended = in_flight.render_stream(
        &frame,
        Outputs::ALL,
        || come.next(),
        |_, _| {
            taken += 1;
            Ok::<_, HeadlessError>(())
        },
    );
    assert!(ended.unwrap_err().to_string().contains("camera") && taken == 0);
    assert_same(&in_flight.render(&cameras[3], &frame, Outputs::ALL).unwrap(), &pictures[3], "after an error");
    [in_flight, one_by_one].into_iter().for_each(assert_silent);
}

/// A pixel to be picked applies to the next single picture.
#[test]
fn a_pick_waits_for_the_next_picture() {
    let model = shapes::pair();
    let (cameras, frame) = (turn(&model, 4), FrameSettings::default());
    let mut renderer = watched(&model);
    let picture = renderer.render(&cameras[0], &frame, Outputs::ALL).unwrap();
    let at = picture.face.iter().position(|face| *face != 0).unwrap() as u32;
    renderer.pick(at % SIZE.0, at / SIZE.0);
    sequence(&mut renderer, &cameras, frame, Outputs::ALL);
    assert!(renderer.picked().is_none());
    renderer.render(&cameras[0], &frame, Outputs::ALL).unwrap();
    assert!(renderer.picked().is_some());
    assert_silent(renderer);
}
