//! Placed parts that other surfaces hide as wholes are left out before their patches, which changes no picture: after
//! any earlier view, every image is the same, bit for bit, as in a first frame, which draws everything.

use crate::shapes;
use crate::support::{assert_identical, assert_silent, render, watched_with};
use glam::{DAffine3, DVec3};
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, Instance, Model, Projection};
use selvedge::picture::{EdgeSettings, Picture, SceneSettings, Smooth, TrimWay};

const SIZE: (u32, u32) = (200, 150);
/// Parts along each side of the hall.
const SIDE: i32 = 6;
/// Distance of neighbours, so large that no two meet: at exactly equal depths, the first drawn would be visible.
const APART: f64 = 9.0;
/// Half of a side of the block before the hall.
const BLOCK_HALF: f64 = 36.0;

/// The middle of the hall.
fn middle() -> DVec3 {
    DVec3::splat(0.5 * APART * f64::from(SIDE - 1))
}

/// A block before a hall of cubes and plates. The block is instance 0.
pub fn hall() -> Model {
    let mut model = Model::default();
    model.parts.extend(shapes::cube().parts.into_iter().chain(shapes::plate().parts));
    let placed = |part: usize, transform: DAffine3| Instance { part, ..shapes::placed(transform, None) };
    let scale = BLOCK_HALF / shapes::CUBE_HALF;
    let before = middle() - DVec3::Y * (middle().y + BLOCK_HALF + 8.0);
    model.instances.push(placed(0, DAffine3::from_translation(before) * DAffine3::from_scale(DVec3::splat(scale))));
    for nth in 0..SIDE * SIDE * SIDE {
        let place = APART * DVec3::new((nth % SIDE).into(), (nth / SIDE % SIDE).into(), (nth / SIDE / SIDE).into());
        let turned = DAffine3::from_rotation_y(0.7 * f64::from(nth)) * DAffine3::from_rotation_x(0.4);
        model.instances.push(placed(usize::from(nth % 4 == 3), DAffine3::from_translation(place) * turned));
    }
    model
}

/// A view from `eye` towards the middle of the hall.
fn from(eye: DVec3) -> Camera {
    Camera {
        eye,
        target: middle(),
        up: DVec3::Z,
        projection: Projection::Perspective { fov_y: 0.6 },
        depth_range: (1.0, 1000.0),
        size: SIZE,
    }
}

/// From before the block, `aside` of its middle.
fn before_the_block(aside: DVec3) -> Camera {
    from(middle() - DVec3::Y * 220.0 + aside)
}

/// The picture of a renderer that has drawn nothing else.
fn alone(renderer: &mut HeadlessRenderer, model: &Model, settings: SceneSettings, camera: &Camera) -> Picture {
    renderer.upload_with(model, settings).unwrap();
    let picture = render(renderer, camera);
    assert_eq!((picture.stats.hidden_parts, picture.stats.hidden_patches), (0, 0), "a first frame tests nothing");
    picture
}

/// Two pictures of each view: the first after another view, the second after the same view.
fn same_as_alone(model: &Model, settings: SceneSettings, views: &[Camera]) -> Vec<[Picture; 2]> {
    let mut renderer = watched_with(model, settings);
    let mut other = watched_with(model, settings);
    let of_views = views.iter().enumerate().map(|(k, camera)| {
        let expected = alone(&mut other, model, settings, camera);
        assert_eq!(expected.stats.clamps, 0, "view {k}");
        [0, 1].map(|nth| {
            let picture = render(&mut renderer, camera);
            assert_identical(&picture, &expected, &format!("view {k}, picture {nth}, {:?}", settings.trim));
            picture
        })
    });
    let pictures = of_views.collect();
    assert_silent(renderer);
    assert_silent(other);
    pictures
}

#[test]
fn nothing_shows_that_parts_are_left_out() {
    let model = hall();
    // before the block; aside in small steps, so that parts appear at its border; from the side and from behind, where
    // everything appears in one frame; before it again; in a parallel view; among the parts
    let steps = [0.0, 1.0, 90.0, 93.0, 97.0, 130.0].map(|x| before_the_block(DVec3::X * x));
    let around = [DVec3::new(-200.0, 0.0, 30.0), DVec3::new(10.0, 220.0, 0.0)].map(|eye| from(middle() + eye));
    let again = before_the_block(DVec3::Z);
    let parallel = Camera { projection: Projection::Orthographic { height: 90.0 }, ..again };
    let within = from(DVec3::new(4.5, 4.5, 4.5));
    let views: Vec<Camera> = steps.into_iter().chain(around).chain([again, parallel, within, again]).collect();
    for &trim in TrimWay::ALL {
        let pictures = same_as_alone(&model, SceneSettings { trim, ..SceneSettings::default() }, &views);
        let stats = |view: usize, nth: usize| &pictures[view][nth].stats;
        let most = |s: &selvedge::picture::FrameStats| (s.hidden_parts, s.listed_patches, s.patches);
        // a small step: what was hidden has no patch that any pass looks at
        for (view, nth) in [(1, 0), (1, 1)] {
            let (hidden, listed, patches) = most(stats(view, nth));
            assert!(hidden > 150 && listed < patches / 4, "{trim:?}, view {view}: {:?}", (hidden, listed, patches));
        }
        // a jump: what appears is listed in the same frame
        for view in [6, 7] {
            let (hidden, listed, patches) = most(stats(view, 0));
            assert!(hidden < 100 && listed > patches / 2, "{trim:?}, view {view}: {:?}", (hidden, listed, patches));
        }
    }
}

/// Smooth borders look between the pixels' centres, and lines are drawn over the picture.
#[test]
fn smooth_borders_and_lines_show_nothing_of_it_either() {
    let model = hall();
    let views = [90.0, 93.0, 97.0].map(|x| before_the_block(DVec3::X * x));
    let smooth = SceneSettings { smooth: Smooth::Borders, ..SceneSettings::default() };
    let lines = SceneSettings { edges: Some(EdgeSettings::default()), ..SceneSettings::default() };
    for settings in [smooth, lines] {
        let pictures = same_as_alone(&model, settings, &views);
        assert!(pictures[2][1].stats.hidden_parts > 20, "{} parts", pictures[2][1].stats.hidden_parts);
    }
}

/// In an editable scene the split of a patch does not depend on other patches.
fn editable() -> SceneSettings {
    SceneSettings { trim: TrimWay::Exact, editable: true, ..SceneSettings::default() }
}

/// The block moves aside: what lay behind it is seen in the same frame. It comes back, and hides it again.
#[test]
fn what_lay_behind_a_part_that_moves_is_seen_at_once() {
    let model = hall();
    let camera = before_the_block(DVec3::ZERO);
    let mut renderer = watched_with(&model, editable());
    let mut other = watched_with(&model, editable());
    let pictures = [(); 3].map(|()| render(&mut renderer, &camera));
    let before = &pictures[2].stats;
    assert!(before.hidden_parts > 150, "{} parts are hidden", before.hidden_parts);
    let (home, away) = (model.instances[0].transform, DAffine3::from_translation(DVec3::X * 1e4));
    for (transform, hides) in [(away, false), (home, true)] {
        let mut changed = model.clone();
        changed.instances[0].transform = transform;
        renderer.set_transform(0, transform).unwrap();
        let expected = alone(&mut other, &changed, editable(), &camera);
        for nth in 0..3 {
            let picture = render(&mut renderer, &camera);
            assert_identical(&picture, &expected, &format!("picture {nth}, the block hides: {hides}"));
            // the frame of the change tests what its first drawing does not show; the next ones leave it out
            let hidden = picture.stats.hidden_parts;
            assert!(if hides { nth == 0 || hidden > 150 } else { hidden < 100 }, "picture {nth}: {hidden}, {hides}");
        }
    }
    assert_silent(renderer);
    assert_silent(other);
}

/// Parts that leave the picture and return, hidden and shown by the host.
#[test]
fn parts_that_return_are_seen() {
    let model = hall();
    let camera = before_the_block(DVec3::X * 95.0);
    let beside = Camera { target: camera.eye - DVec3::Y, ..camera };
    let mut renderer = watched_with(&model, editable());
    let first = render(&mut renderer, &camera);
    for _ in 0..2 {
        for _ in 0..2 {
            assert_identical(&render(&mut renderer, &camera), &first, "again");
        }
        render(&mut renderer, &beside);
        renderer.set_visible(0, false).unwrap();
        render(&mut renderer, &beside);
        assert!(render(&mut renderer, &camera).face != first.face, "without the block, more is seen");
        renderer.set_visible(0, true).unwrap();
    }
    assert_silent(renderer);
}
