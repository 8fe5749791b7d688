//! No number of threads is too large for one dispatch: what does not fit into one row of workgroups has several.

use crate::hidden::crowd;
use crate::shapes::operands::splines;
use crate::shapes::{self, solids};
use crate::support::{assert_identical, assert_silent, perspective, watched_with};
use crate::watched::limited;
use glam::{DAffine3, DVec3};
use selvedge::gpu::LowerLimits;
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, Model, Projection};
use selvedge::picture::{
    EdgeSettings, FrameSettings, Outputs, Picture, Samples, SceneSettings, Smooth, SolidWay, TrimWay,
};

/// Three workgroups a row: what a device has 65,535 of or more.
const FEW_GROUPS: LowerLimits = LowerLimits { work_groups: 3, ..LowerLimits::NONE };

fn draw(renderer: &mut HeadlessRenderer, camera: &Camera) -> Picture {
    renderer.render(camera, &FrameSettings::default(), Outputs::ALL).unwrap()
}

/// Every pass that has a thread for each of what the scene or the picture has many of.
#[test]
fn several_rows_of_workgroups_draw_the_same() {
    let plain = SceneSettings::default();
    let by = |trim| SceneSettings { trim, ..plain };
    let lines = SceneSettings { edges: Some(EdgeSettings::default()), ..plain };
    let cases = [
        ("patches by table", crowd(), by(TrimWay::Table)),
        ("patches exactly", crowd(), by(TrimWay::Exact)),
        ("samples", shapes::pair(), SceneSettings { samples: Samples::Four, ..plain }),
        ("smooth borders", crowd(), SceneSettings { smooth: Smooth::Borders, ..plain }),
        ("lines", crowd(), lines),
        ("solids by events", solids::holes(90), SceneSettings { solids: SolidWay::Events, ..plain }),
        ("solids by blister", solids::holes(9), SceneSettings { solids: SolidWay::Blister, ..plain }),
        ("operands", splines().swap_remove(1).1, plain),
    ];
    for (name, model, settings) in cases {
        let camera = perspective(&model, (320, 240));
        let mut whole = watched_with(&model, settings);
        let mut in_rows = limited(FEW_GROUPS);
        in_rows.upload_with(&model, settings).unwrap();
        // the second picture knows what lay behind others in the first
        for nth in 0..2 {
            let (a, b) = (draw(&mut whole, &camera), draw(&mut in_rows, &camera));
            assert!(a.face.iter().any(|face| *face != 0), "{name} shows nothing");
            assert_identical(&a, &b, &format!("{name}, {nth}"));
            let told = |p: &Picture| (p.stats.sub_patches, p.stats.trim_rows, p.stats.hidden_patches, p.stats.clamps);
            assert_eq!(told(&a), told(&b), "{name}, {nth}");
        }
        [whole, in_rows].into_iter().for_each(assert_silent);
    }
}

/// One under another, the last of which is seen from above.
fn stacked(part: Model, count: u32) -> Model {
    let place = |i: u32| DAffine3::from_translation(DVec3::new(0.0, 0.0, 1e-3 * f64::from(i)));
    Model { instances: (0..count).map(|i| shapes::placed(place(i), None)).collect(), ..part }
}

fn from_above(model: &Model, height: f64, size: (u32, u32)) -> Camera {
    let above = Camera::around(model.control_bounds(), DVec3::Z, DVec3::Y, 0.6, size);
    Camera { projection: Projection::Orthographic { height }, ..above }
}

/// More patches than 65,535 workgroups of 64 threads have: all but the last of them are far beside the picture.
#[test]
#[ignore = "minutes, and a gigabyte"]
fn five_million_patches() {
    const COUNT: u32 = 5_100_000;
    let one = shapes::wave();
    let patches = shapes::wave().parts[0].faces.len() as u32;
    assert_eq!(patches, 1, "a wave is one patch");
    let mut model = one.clone();
    let beside = |i: u32| DAffine3::from_translation(DVec3::new(1e4 + f64::from(i % 1000), f64::from(i / 1000), 0.0));
    model.instances = (1..COUNT).map(|i| shapes::placed(beside(i), None)).collect();
    model.instances.push(shapes::placed(DAffine3::IDENTITY, None));
    let camera = perspective(&one, (320, 240));
    let mut renderer = watched_with(&model, SceneSettings::default());
    let picture = draw(&mut renderer, &camera);
    assert_eq!(picture.stats.patches, u64::from(COUNT));
    assert_identical(&picture, &draw(&mut watched_with(&one, SceneSettings::default()), &camera), "alone");
    assert_silent(renderer);
}

/// More scan lines than 65,535 workgroups of 128 threads have: of plates one under another, the last of which is seen.
#[test]
#[ignore = "minutes, and a gigabyte"]
fn nine_million_scan_lines() {
    let model = stacked(shapes::plate(), 120);
    let height = model.control_bounds().diagonal() / 300.0;
    let camera = from_above(&model, height, (64, 64));
    let settings = SceneSettings { trim: TrimWay::Table, ..SceneSettings::default() };
    let fine = FrameSettings { tolerance_px: 0.1, ..FrameSettings::default() };
    let mut renderer = watched_with(&model, settings);
    let picture = renderer.render(&camera, &fine, Outputs::ALL).unwrap();
    assert!(picture.stats.trim_rows > 65_535 * 128, "{:?}", picture.stats);
    let mut last = model.clone();
    last.instances.drain(..119);
    let mut alone = watched_with(&last, settings);
    let expected = alone.render(&camera, &fine, Outputs::ALL).unwrap();
    assert!(expected.stats.trim_rows < 65_535 * 128, "{:?}", expected.stats);
    assert_identical(&picture, &expected, "alone");
    [renderer, alone].into_iter().for_each(assert_silent);
}
