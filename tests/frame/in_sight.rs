//! Assemblies most of whose parts are out of sight, and parts most of whose faces are: the picture equals that of the
//! visible parts or faces alone, bit for bit.

use crate::shapes;
use crate::support::{assert_identical, assert_silent, watched_with};
use glam::{DAffine3, DVec2, DVec3};
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, Face, Model, Projection};
use selvedge::picture::{FrameSettings, Outputs, Picture, Samples, SceneSettings, Smooth, TrimWay};
use std::time::{Duration, Instant};

const SIZE: (u32, u32) = (200, 150);

fn draw(renderer: &mut HeadlessRenderer, camera: &Camera) -> Picture {
    let outputs = Outputs { face: true, depth: true, uv: true, normal: true, ..Outputs::default() };
    renderer.render(camera, &FrameSettings::default(), outputs).unwrap()
}

/// Cubes, plates, waves and ripples in a block, far enough apart that none meets another; of so many parts.
fn block(side: i32, parts: usize) -> Model {
    let shapes = [shapes::cube(), shapes::plate(), shapes::wave(), shapes::ripple()];
    let four: Vec<_> = shapes.into_iter().flat_map(|shape| shape.parts).collect();
    let mut model = Model { parts: four.iter().cycle().take(parts).cloned().collect(), ..Model::default() };
    for nth in 0..side * side * side {
        let place = DVec3::new((nth % side).into(), (nth / side % side).into(), (nth / side / side).into()) * 9.0;
        let part = nth as usize % model.parts.len();
        let transform = DAffine3::from_translation(place) * DAffine3::from_rotation_y(0.7 * f64::from(nth));
        model.instances.push(selvedge::model::Instance { part, ..shapes::placed(transform, None) });
    }
    model
}

/// Views of the whole block, from inside it, of a corner, and from so far away that most parts are smaller than a
/// pixel.
fn cameras(model: &Model) -> Vec<Camera> {
    let whole = Camera::around(model.control_bounds(), DVec3::new(1.0, -1.6, 1.1), DVec3::Z, 0.6, SIZE);
    let middle = model.control_bounds().centre();
    let at = |eye: DVec3, target: DVec3| Camera { eye, target, depth_range: (0.1, 400.0), ..whole };
    let far = whole.target + 20.0 * (whole.eye - whole.target);
    vec![
        whole,
        at(middle + DVec3::new(2.0, -3.0, 4.5), middle + DVec3::X * 40.0),
        at(DVec3::new(-12.0, -9.0, 6.0), DVec3::ZERO),
        Camera { depth_range: (whole.depth_range.0 * 10.0, whole.depth_range.1 * 100.0), ..at(far, middle) },
    ]
}

/// Draws the views one after another with one renderer, and each view again with only the instances near its picture.
fn check(settings: SceneSettings) {
    let model = block(6, 4);
    let mut renderer = watched_with(&model, settings);
    let mut alone = watched_with(&Model::default(), settings);
    let mut least = usize::MAX;
    // the first views come again at the end, so parts that were out of sight return
    let cameras = cameras(&model);
    for (nth, camera) in cameras.iter().chain(&cameras[..2]).enumerate() {
        let first = draw(&mut renderer, camera);
        assert!(first.face.iter().any(|face| *face != 0), "view {nth} shows nothing");
        assert_identical(&first, &draw(&mut renderer, camera), &format!("view {nth}, again"));
        // only the instances that a wider picture shows
        let wider = (SIZE.0 + 64, SIZE.1 + 64);
        let shown = in_front(&model, camera, wider);
        least = least.min(shown.instances.len());
        alone.upload_with(&shown, settings).unwrap();
        assert_identical(&first, &draw(&mut alone, camera), &format!("view {nth}, alone"));
    }
    assert!(least < model.instances.len() / 4, "a view shows {least} at least");
    [renderer, alone].into_iter().for_each(assert_silent);
}

/// The instances whose bounding cubes reach into a picture of `size`, which extends the camera's picture on all sides.
fn in_front(model: &Model, camera: &Camera, size: (u32, u32)) -> Model {
    let pixels = camera.pixel_matrix();
    let border = [size.0 - camera.size.0, size.1 - camera.size.1].map(|more| f64::from(more) / 2.0);
    let is_seen = |i: &selvedge::model::Instance| {
        let bounds = model.parts[i.part].control_bounds();
        let (centre, radius) = (i.transform.transform_point3(bounds.centre()), 0.5 * bounds.diagonal());
        let corners =
            (0..8).map(|k| centre + radius * DVec3::from([0, 1, 2].map(|a| if k >> a & 1 == 0 { -1.0 } else { 1.0 })));
        let seen: Vec<_> = corners.map(|c| pixels * c.extend(1.0)).collect();
        let all = |beyond: &dyn Fn(&glam::DVec4) -> bool| seen.iter().all(beyond);
        let (w, h) = (f64::from(camera.size.0), f64::from(camera.size.1));
        !(all(&|q| q.x < -border[0] * q.w)
            || all(&|q| q.x > (w + border[0]) * q.w)
            || all(&|q| q.y < -border[1] * q.w)
            || all(&|q| q.y > (h + border[1]) * q.w)
            || all(&|q| q.z < camera.depth_range.0)
            || all(&|q| q.z > camera.depth_range.1))
    };
    Model { instances: model.instances.iter().filter(|i| is_seen(i)).cloned().collect(), ..model.clone() }
}

/// In an editable scene the split of a patch does not depend on other patches.
fn exact() -> SceneSettings {
    SceneSettings { trim: TrimWay::Exact, editable: true, ..SceneSettings::default() }
}

#[test]
fn trimmed_exactly() {
    check(exact());
}

#[test]
fn of_four_samples() {
    check(SceneSettings { samples: Samples::Four, ..exact() });
}

#[test]
fn with_smooth_borders() {
    check(SceneSettings { smooth: Smooth::Borders, ..exact() });
}

/// One part of those of 64 sheets, eight in a row, whose numbers `has` names. Every other one has a loop.
fn sheets(has: impl Fn(i32) -> bool) -> Model {
    let face = |n: i32| {
        let corner = 12.0 * DVec3::new((n % 8).into(), (n / 8).into(), 0.0);
        let sheet = shapes::sheet(n as u32 + 1, corner, 10.0, 8);
        let middle = shapes::rectangle(DVec2::splat(1.0), DVec2::splat(7.0));
        let loops = if (n % 8 + n / 8) % 2 == 0 { vec![] } else { vec![middle] };
        Face { loops, ..sheet }
    };
    shapes::one("sheets", false, (0..64).filter(|n| has(*n)).map(face).collect())
}

/// All sheets once more, behind the eye: every scene with them has so many patches that some are drawn by their corners.
fn with_sheets_behind(mut model: Model) -> Model {
    let part = model.parts.len();
    model.parts.extend(sheets(|_| true).parts);
    let behind = DAffine3::from_translation(DVec3::Z * 1e3);
    model.instances.push(selvedge::model::Instance { part, ..shapes::placed(behind, None) });
    model
}

/// A view of two neighbours among the sheets of one part, in pictures one after another.
#[test]
fn faces_out_of_sight_are_left_out() {
    // the two, and two at corners of the part, which has the same centre so
    let near = sheets(|n| [0, 9, 10, 63].contains(&n));
    let [model, near] = [sheets(|_| true), near].map(with_sheets_behind);
    let target = DVec3::new(23.0, 17.0, 0.0);
    let camera = Camera {
        eye: target + DVec3::new(0.0, -7.0, 26.0),
        target,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 0.3 },
        depth_range: (1.0, 100.0),
        size: SIZE,
    };
    let aside = Camera { eye: camera.eye + 0.5 * DVec3::X, target: target + 0.5 * DVec3::X, ..camera };
    let smooth = SceneSettings { smooth: Smooth::Borders, ..exact() };
    for (way, settings) in [("one sample", exact()), ("smooth borders", smooth)] {
        let (mut renderer, mut alone) = (watched_with(&model, settings), watched_with(&near, settings));
        for (nth, camera) in [camera, camera, aside].iter().enumerate() {
            let (all, expected) = (draw(&mut renderer, camera), draw(&mut alone, camera));
            assert!([10, 11].iter().all(|face| all.face.contains(face)), "{way}, {nth}: a sheet is not seen");
            assert_identical(&all, &expected, &format!("{way}, {nth}"));
            let listed = |picture: &Picture| (picture.stats.listed_patches, picture.stats.patches);
            let (of_all, of_near) = (listed(&all), listed(&expected));
            assert!(0 < of_all.0 && 8 * of_all.0 <= of_all.1, "{way}, {nth}: {of_all:?} patches");
            assert_eq!(of_all.0, of_near.0, "{way}, {nth}: the same two faces are listed");
        }
        [renderer, alone].into_iter().for_each(assert_silent);
    }
}

/// An instance is moved out of sight and back, then hidden and shown.
#[test]
fn what_moves_is_where_it_is() {
    let model = block(4, 4);
    let camera = cameras(&model)[2];
    let mut renderer = watched_with(&model, exact());
    let first = draw(&mut renderer, &camera);
    let away = DAffine3::from_translation(DVec3::new(0.0, 1e4, 0.0));
    renderer.set_transform(0, away).unwrap();
    let gone = draw(&mut renderer, &camera);
    assert!(gone.face != first.face, "the nearest part is seen");
    renderer.set_transform(0, model.instances[0].transform).unwrap();
    assert_identical(&first, &draw(&mut renderer, &camera), "back again");
    renderer.set_visible(0, false).unwrap();
    assert_identical(&gone, &draw(&mut renderer, &camera), "hidden");
    renderer.set_visible(0, true).unwrap();
    assert_identical(&first, &draw(&mut renderer, &camera), "shown again");
    assert_silent(renderer);
}

/// The time of a picture of the colour alone.
pub fn time_of(renderer: &mut HeadlessRenderer, camera: &Camera) -> Duration {
    let start = Instant::now();
    renderer.render(camera, &FrameSettings::default(), Outputs::default()).unwrap();
    start.elapsed()
}

/// A hundred thousand placed parts, of two hundred: whole, from within, and in a corner. In the corner a hundredth is
/// seen. A frame of it takes at most twice as long as one of that hundredth alone.
#[test]
#[ignore = "minutes, and times"]
fn a_hundred_thousand_parts() {
    let model = block(47, 200);
    assert!(model.instances.len() > 100_000);
    let near = |camera: Camera| Camera { depth_range: (0.1, 160.0), ..camera };
    let [whole, within, corner, _]: [Camera; 4] = cameras(&model).try_into().expect("four views");
    let (within, corner) = (near(within), near(corner));
    let (mut renderer, mut alone) = (watched_with(&model, exact()), watched_with(&Model::default(), exact()));
    assert!(draw(&mut renderer, &whole).face.iter().any(|face| *face != 0));
    for camera in [within, corner] {
        let wider = (SIZE.0 + 64, SIZE.1 + 64);
        alone.upload_with(&in_front(&model, &camera, wider), exact()).unwrap();
        // the second pictures have the results of an occlusion test
        for nth in 0..3 {
            assert_identical(&draw(&mut renderer, &camera), &draw(&mut alone, &camera), &format!("picture {nth}"));
        }
    }
    // the frustum alone leaves out so many: `hidden_parts.rs` tests what occlusion leaves out
    let stats = draw(&mut renderer, &corner).stats;
    assert!(stats.listed_patches < stats.patches / 50, "{} of {} patches", stats.listed_patches, stats.patches);
    // the view moves, so every pass runs; the least time of each is that without other programs
    let moved = |k: u32| Camera { eye: corner.eye + 0.01 * f64::from(k) * DVec3::X, ..corner };
    let mut least = [Duration::MAX; 2];
    for k in 1..8 {
        for (least, renderer) in least.iter_mut().zip([&mut renderer, &mut alone]) {
            *least = (*least).min(time_of(renderer, &moved(k)));
        }
    }
    println!("of {} parts {:?}, alone {:?}", model.instances.len(), least[0], least[1]);
    assert!(least[0] <= 2 * least[1], "{least:?}");
    [renderer, alone].into_iter().for_each(assert_silent);
}
