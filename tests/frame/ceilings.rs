//! Dispatches with more workgroups than fit into one row use several rows.

use crate::hidden::crowd;
use crate::hidden_parts::{before_the_block, behind_the_hall, hall};
use crate::shapes::operands::splines;
use crate::shapes::{self, solids};
use crate::support::{assert_identical, assert_silent, perspective, watched_with};
use crate::watched::{limited, renderer};
use glam::{DAffine3, DVec3, DVec4};
use selvedge::gpu::LowerLimits;
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, Face, Instance, Model, Part, Projection, SurfaceKind};
use selvedge::picture::{
    EdgeSettings, FrameSettings, Outputs, Picture, Samples, SceneSettings, Smooth, SolidWay, TrimWay,
};
use selvedge::spline::Surface;

/// Three workgroups in a row. Devices have 65,535 or more.
const FEW_GROUPS: LowerLimits = LowerLimits { work_groups: Some(3), ..LowerLimits::NONE };

fn draw(renderer: &mut HeadlessRenderer, camera: &Camera) -> Picture {
    renderer.render(camera, &FrameSettings::default(), Outputs::ALL).unwrap()
}

/// Scenes whose passes have a thread for each patch, scan line, pixel, edge or primitive.
#[test]
fn several_rows_of_workgroups_draw_the_same() {
    let plain = SceneSettings::default();
    let by = |trim| SceneSettings { trim, ..plain };
    let lines = SceneSettings { edges: Some(EdgeSettings::default()), ..plain };
    let cases = [
        ("patches by table", crowd(), by(TrimWay::Table)),
        ("patches exactly", crowd(), by(TrimWay::Exact)),
        ("parts", hall(), plain),
        ("samples", shapes::pair(), SceneSettings { samples: Samples::Four, ..plain }),
        ("smooth borders", crowd(), SceneSettings { smooth: Smooth::Borders, ..plain }),
        ("lines", crowd(), lines),
        ("solids by events", solids::holes(90), SceneSettings { solids: SolidWay::Events, ..plain }),
        ("solids by blister", solids::holes(9), SceneSettings { solids: SolidWay::Blister, ..plain }),
        ("operands", splines().swap_remove(1).1, plain),
    ];
    let (mut whole, mut in_rows) = (renderer(), limited(FEW_GROUPS));
    for (name, model, settings) in cases {
        // the second picture tests for occlusion, the third uses the result
        let mut cameras = vec![perspective(&model, (160, 120)); 3];
        if name == "parts" {
            // then what was hidden appears in one frame, in each of the lists of parts
            cameras = [before_the_block(DVec3::ZERO); 3].into_iter().chain([behind_the_hall(); 2]).collect();
        }
        whole.upload_with(&model, settings).unwrap();
        in_rows.upload_with(&model, settings).unwrap();
        let mut hidden_parts = Vec::new();
        for (nth, camera) in cameras.iter().enumerate() {
            let (a, b) = (draw(&mut whole, camera), draw(&mut in_rows, camera));
            assert!(a.face.iter().any(|face| *face != 0), "{name} shows nothing");
            assert_identical(&a, &b, &format!("{name}, {nth}"));
            let told = |p: &Picture| {
                let hidden = [p.stats.hidden_parts, p.stats.hidden_patches, p.stats.listed_patches];
                (p.stats.sub_patches, p.stats.trim_rows, hidden, p.stats.clamps)
            };
            assert_eq!(told(&a), told(&b), "{name}, {nth}");
            hidden_parts.push(a.stats.hidden_parts);
        }
        let appear = name != "parts" || hidden_parts[2] > 150 && hidden_parts[3] < 100;
        assert!(appear, "{name}: {hidden_parts:?} parts are hidden");
    }
    [whole, in_rows].into_iter().for_each(assert_silent);
}

/// Copies stacked upwards, so that the last one is seen from above.
fn stacked(part: Model, count: u32) -> Model {
    let place = |i: u32| DAffine3::from_translation(DVec3::new(0.0, 0.0, 1e-3 * f64::from(i)));
    Model { instances: (0..count).map(|i| shapes::placed(place(i), None)).collect(), ..part }
}

fn from_above(model: &Model, height: f64, size: (u32, u32)) -> Camera {
    let above = Camera::around(model.control_bounds(), DVec3::Z, DVec3::Y, 0.6, size);
    Camera { projection: Projection::Orthographic { height }, ..above }
}

/// A flat face of `across` by `down` patches.
fn sheet(across: usize, down: usize) -> Part {
    let knots = |patches: usize| {
        let inner = (0..=patches).map(|k| k as f64);
        std::iter::once(0.0).chain(inner).chain([patches as f64]).collect::<Vec<_>>()
    };
    let points = (0..=down).flat_map(|y| (0..=across).map(move |x| DVec4::new(x as f64, y as f64, 0.0, 1.0)));
    let surface = Surface::new((1, 1), knots(across), knots(down), points.collect()).unwrap();
    let face = Face { id: 2, kind: SurfaceKind::BSpline, surface, loops: vec![], same_sense: true, colour: None };
    Part { faces: vec![face], ..Part::default() }
}

/// More patches than 65,535 workgroups of 64 threads hold. All but the last one are far outside the picture.
#[test]
#[ignore = "minutes, and a gigabyte"]
fn five_million_patches() {
    let one = shapes::wave();
    let mut model = one.clone();
    model.parts.push(sheet(100, 50));
    let beside = |i: u32| DAffine3::from_translation(DVec3::new(1e4, 60.0 * f64::from(i), 0.0));
    model.instances = (0..1020).map(|i| Instance { part: 1, ..shapes::placed(beside(i), None) }).collect();
    model.instances.push(shapes::placed(DAffine3::IDENTITY, None));
    let camera = perspective(&one, (320, 240));
    let mut renderer = watched_with(&model, SceneSettings::default());
    let picture = draw(&mut renderer, &camera);
    assert_eq!(picture.stats.patches, 5_100_001);
    let mut alone = watched_with(&one, SceneSettings::default());
    assert_identical(&picture, &draw(&mut alone, &camera), "alone");
    // the whole model from afar
    let whole = perspective(&model, (320, 240));
    assert!(draw(&mut renderer, &whole).face.contains(&2), "nothing is seen of the sheets");
    [renderer, alone].into_iter().for_each(assert_silent);
}

/// The picture has more scan lines than 65,535 workgroups have threads. The plates are stacked, and only the last is
/// visible.
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
    // the first plate stays, so that the model's bounds are the same
    let mut last = model.clone();
    last.instances.drain(1..119);
    let mut alone = watched_with(&last, settings);
    let expected = alone.render(&camera, &fine, Outputs::ALL).unwrap();
    assert!(expected.stats.trim_rows < 65_535 * 128, "{:?}", expected.stats);
    assert_identical(&picture, &expected, "alone");
    [renderer, alone].into_iter().for_each(assert_silent);
}
