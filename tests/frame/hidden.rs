//! Hidden patches are left out, which changes no picture: after any earlier view, every image is the same, bit for bit,
//! as in a frame that draws everything.

use crate::shapes;
use crate::support::{assert_identical, assert_silent, render, watched_with};
use glam::{DAffine3, DVec2, DVec3};
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, Instance, LoopAt, Model, Projection};
use selvedge::picture::{Picture, SceneSettings, TrimWay};

const SIZE: (u32, u32) = (200, 150);

/// So far apart that no two meet: at exactly equal depths, the first drawn would be visible.
const APART: f64 = 7.0;

/// Plates with a hole, cubes, cylinders beside a plate, waves and ripples, in rows one behind the other.
pub fn crowd() -> Model {
    let shapes = [shapes::plate(), shapes::cube(), shapes::mirrored(), shapes::wave(), shapes::ripple()];
    let mut model = Model::default();
    for (part, shape) in shapes.into_iter().enumerate() {
        let centre = shape.control_bounds().centre();
        model.parts.extend(shape.parts);
        for k in 0..18 {
            let nth = k + 18 * part;
            let place = APART * DVec3::new((nth % 5) as f64, (nth / 5 % 6) as f64, (nth / 30) as f64);
            let turned = DAffine3::from_rotation_y(0.3 * (k % 5) as f64);
            let transform = DAffine3::from_translation(place) * turned * DAffine3::from_translation(-centre);
            model.instances.push(Instance { part, transform, colour: None, name: String::new() });
        }
    }
    model
}

fn from(model: &Model, direction: DVec3) -> Camera {
    Camera::around(model.control_bounds(), direction, DVec3::Z, 35f64.to_radians(), SIZE)
}

/// The picture of a renderer that has drawn nothing else.
fn alone(renderer: &mut HeadlessRenderer, model: &Model, settings: SceneSettings, camera: &Camera) -> Picture {
    renderer.upload_with(model, settings).unwrap();
    let picture = render(renderer, camera);
    assert_eq!(picture.stats.hidden_patches, 0, "a first frame knows nothing");
    picture
}

/// Views one after the other, each twice; the most patches left out at a view's first and second picture.
fn same_as_alone(model: &Model, trim: TrimWay, views: &[Camera]) -> [u64; 2] {
    let settings = SceneSettings { trim, ..SceneSettings::default() };
    let mut renderer = watched_with(model, settings);
    let mut other = watched_with(model, settings);
    let mut most = [0; 2];
    for (k, camera) in views.iter().enumerate() {
        let expected = alone(&mut other, model, settings, camera);
        assert_eq!(expected.stats.clamps, 0, "view {k}");
        for (nth, most) in most.iter_mut().enumerate() {
            let picture = render(&mut renderer, camera);
            assert_identical(&picture, &expected, &format!("view {k}, picture {nth}, {trim:?}"));
            *most = picture.stats.hidden_patches.max(*most);
        }
    }
    assert_silent(renderer);
    assert_silent(other);
    most
}

#[test]
fn nothing_shows_that_patches_are_left_out() {
    let model = crowd();
    // around the rows, in small steps and in jumps; in parallel; and from among them
    let turned = |angle: f64| DVec3::new(angle.sin(), -angle.cos(), 0.25);
    let mut views: Vec<Camera> = [0.0, 0.05, 1.6, 3.0, 3.05].map(|angle| from(&model, turned(angle))).to_vec();
    let parallel = Camera { projection: Projection::Orthographic { height: 30.0 }, ..views[0] };
    views.extend([parallel, Camera { eye: parallel.eye + DVec3::X, target: parallel.target + DVec3::X, ..parallel }]);
    let within = Camera { eye: DVec3::new(3.0, 10.5, 8.0), depth_range: (0.05, 100.0), ..views[0] };
    views.extend([within, Camera { eye: within.eye + DVec3::new(1.0, 4.0, 0.5), ..within }]);
    for &trim in TrimWay::ALL {
        let [moved, same] = same_as_alone(&model, trim, &views);
        assert!(moved > 20 && same > 100, "{trim:?}: {moved} and {same} patches at most were left out");
    }
}

/// A thing behind a new hole is visible in the frame of the edit.
#[test]
fn an_edit_shows_what_lay_behind() {
    let mut model = shapes::plate();
    // a plate before many small others, which lie behind the border of its hole
    let small = DAffine3::from_scale(DVec3::splat(0.04));
    for k in 0..80 {
        let place = DVec3::new(0.3 * f64::from(k % 9) - 1.5, 0.3 * f64::from(k / 9) - 1.5, -1.0);
        model.parts.push(model.parts[0].clone());
        let part = model.parts.len() - 1;
        let transform = DAffine3::from_translation(place) * small;
        model.instances.push(Instance { part, transform, colour: Some([0.9, 0.2, 0.1, 1.0]), name: String::new() });
    }
    let camera = Camera { up: DVec3::Y, ..from(&model, DVec3::new(0.05, -0.1, 1.0)) };
    for &trim in TrimWay::ALL {
        let settings = SceneSettings { trim, editable: true, ..SceneSettings::default() };
        let mut edited = watched_with(&model, settings);
        let mut other = watched_with(&model, settings);
        let before = [(); 3].map(|()| render(&mut edited, &camera).stats.hidden_patches);
        assert!(before[2] > 20, "{trim:?}: {before:?} patches were left out before");
        let mut changed = model.clone();
        let mut shown = Vec::new();
        for by in [DVec2::new(0.4, 0.1), DVec2::new(-0.9, 0.2), DVec2::new(0.3, -0.7)] {
            let at = LoopAt { part: 0, face: 0, trim_loop: 1 };
            let moved = changed.parts[0].faces[0].loops[1].translated(by).unwrap();
            edited.edit_loop(at, &moved).unwrap();
            changed.parts[0].faces[0].loops[1] = moved;
            let (picture, expected) = (render(&mut edited, &camera), alone(&mut other, &changed, settings, &camera));
            assert_identical(&picture, &expected, &format!("hole by {by}, {trim:?}"));
            shown.push(picture.stats.hidden_patches);
        }
        assert!(shown.iter().all(|hidden| *hidden > 0), "{trim:?}: {shown:?} patches were left out");
        assert!(shown.iter().any(|hidden| *hidden < before[2]), "{trim:?}: {shown:?} and nothing appeared");
        assert_silent(edited);
        assert_silent(other);
    }
}
