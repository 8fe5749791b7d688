//! Views that need larger buffers than a scene begins with: drawn again until the picture is complete.

use crate::shapes;
use crate::support::{assert_identical, assert_silent, plain, watched_with};
use crate::watched::limited;
use glam::{DAffine3, DQuat, DVec2, DVec3};
use selvedge::gpu::LowerLimits;
use selvedge::headless::{HeadlessError, HeadlessRenderer};
use selvedge::model::{Camera, LoopAt, Model, Projection};
use selvedge::picture::{FrameSettings, Outputs, Picture, SceneSettings, Smooth, TrimWay};

/// Its buffers grow with the view.
const BY_TABLE: SceneSettings = plain(TrimWay::Table);

fn draw(renderer: &mut HeadlessRenderer, camera: &Camera, tolerance_px: f64) -> Picture {
    let settings = FrameSettings { tolerance_px, ..FrameSettings::default() };
    renderer.render(camera, &settings, Outputs::ALL).unwrap()
}

/// Draws a view for which the first buffers are too small. The picture equals that of buffers that are large enough
/// from the start, which the first, small view does not have.
fn check(model: &Model, camera: &Camera, tolerance_px: f64) -> Picture {
    check_with(model, BY_TABLE, camera, tolerance_px)
}

fn check_with(model: &Model, settings: SceneSettings, camera: &Camera, tolerance_px: f64) -> Picture {
    let mut renderer = watched_with(model, settings);
    let grown = draw(&mut renderer, camera, tolerance_px);
    assert!(grown.stats.retries > 0, "the first buffers were large enough: {:?}", grown.stats);
    let again = draw(&mut renderer, camera, tolerance_px);
    assert_eq!(again.stats.retries, 0, "what had grown was too small: {:?}", again.stats);
    assert_identical(&grown, &again, "with room from the start");
    assert_silent(renderer);

    let mut fresh = watched_with(model, settings);
    let small = Camera { size: (8, 6), ..*camera };
    assert_eq!(draw(&mut fresh, &small, 2.0).stats.retries, 0);
    assert_identical(&grown, &draw(&mut fresh, camera, tolerance_px), "after a small view");
    assert_silent(fresh);
    grown
}

/// 64 plates side by side, and a view of all of them: it has more scan lines than a first table at 0.125 px.
pub fn plates() -> (Model, Camera) {
    let mut model = shapes::plate();
    let place = |i: u32| DVec3::new(f64::from(i % 8), f64::from(i / 8), 0.0) * 7.0;
    model.instances = (0..64).map(|i| shapes::placed(DAffine3::from_translation(place(i)), None)).collect();
    let camera = Camera::around(model.control_bounds(), DVec3::new(0.1, -0.2, 1.0), DVec3::Y, 0.6, (640, 480));
    (model, camera)
}

/// 64 plates with 32 scan lines a pixel: some 10^5 rows and twice as many intercepts.
#[test]
fn more_rows_than_the_first_table_holds() {
    let (model, camera) = plates();
    let picture = check(&model, &camera, 0.125);
    assert!(picture.stats.trim_rows > 65_536, "{:?}", picture.stats);
}

/// Six waves, stretched to 20 times their height: each is cut into 8 x 8 sub-patches, where a scene of
/// six patches begins with room for 262.
#[test]
fn more_sub_patches_than_the_first_list_holds() {
    let mut model = shapes::wave();
    let tall = |i: u32| {
        let place = DVec3::new(0.1 * f64::from(i), 0.0, 0.0);
        shapes::placed(
            DAffine3::from_scale_rotation_translation(DVec3::new(1.0, 1.0, 20.0), DQuat::IDENTITY, place),
            None,
        )
    };
    model.instances = (0..6).map(tall).collect();
    let above = Camera::around(model.control_bounds(), DVec3::Z, DVec3::Y, 0.6, (320, 240));
    let camera = Camera { projection: Projection::Orthographic { height: 3.2 }, ..above };
    let picture = check(&model, &camera, 0.125);
    assert!(picture.stats.sub_patches > 262, "{:?}", picture.stats);
    assert_eq!(picture.stats.clamps, 0, "{:?}", picture.stats);
}

/// Small balls, of two pixels and a half: some ten points of each follow its surface, where a first list has room for 4096
/// points. Nothing else has too little room.
#[test]
fn more_points_that_follow_surfaces_than_the_first_list_holds() {
    let mut model = shapes::sphere();
    let place = |i: u32| 8.0 * DVec3::new(f64::from(i % 50), f64::from(i / 50), 0.0);
    model.instances = (0..50 * 37).map(|i| shapes::placed(DAffine3::from_translation(place(i)), None)).collect();
    let above = Camera::around(model.control_bounds(), DVec3::Z, DVec3::Y, 0.6, (320, 240));
    let camera = Camera { projection: Projection::Orthographic { height: 300.0 }, ..above };
    let mut rough = watched_with(&model, BY_TABLE);
    assert_eq!(draw(&mut rough, &camera, 0.5).stats.retries, 0);
    assert_silent(rough);
    check_with(&model, SceneSettings { smooth: Smooth::Borders, ..BY_TABLE }, &camera, 0.5);
}

/// A device that binds 16 MiB: its table has room for two million scan lines.
const LITTLE: LowerLimits = LowerLimits { storage_range: Some(1 << 24), ..LowerLimits::NONE };

fn with_little(model: &Model, settings: SceneSettings) -> HeadlessRenderer {
    let mut renderer = limited(LITTLE);
    renderer.upload_with(model, settings).unwrap();
    renderer
}

/// A stack of plates. A close view has more scan lines than fit into the table; a view of the whole stack has few.
fn stack() -> Model {
    let mut model = shapes::plate();
    let place = |i: u32| DVec3::new(0.0, 0.0, -1e-3 * f64::from(i));
    model.instances = (0..120).map(|i| shapes::placed(DAffine3::from_translation(place(i)), None)).collect();
    model
}

/// The whole stack from above, and a part of it `closer` times closer.
fn onto(model: &Model, closer: f64) -> Camera {
    let above = Camera::around(model.control_bounds(), DVec3::Z, DVec3::Y, 0.6, (64, 64));
    let height = model.control_bounds().diagonal() / closer;
    Camera { projection: Projection::Orthographic { height }, ..above }
}

fn finely(renderer: &mut HeadlessRenderer, camera: &Camera) -> Result<Picture, HeadlessError> {
    renderer.render(camera, &FrameSettings { tolerance_px: 0.1, ..FrameSettings::default() }, Outputs::ALL)
}

/// A request for the table fails with advice; a request without a way switches to the exact way and stays with it.
#[test]
fn a_view_beyond_the_table_is_trimmed_exactly() {
    let model = stack();
    let (whole, close) = (onto(&model, 1.0), onto(&model, 300.0));
    let mut by_table = with_little(&model, BY_TABLE);
    let refused = finely(&mut by_table, &close).unwrap_err().to_string();
    let told = ["scan lines are too many: at most 2097152", "this device binds 16777216", "`exact`"];
    assert!(told.iter().all(|text| refused.contains(text)), "{refused}");
    let kept = finely(&mut by_table, &whole).unwrap();

    let mut auto = with_little(&model, SceneSettings { trim: TrimWay::Auto, ..BY_TABLE });
    let first = finely(&mut auto, &whole).unwrap();
    assert_eq!(first.stats.trim, Some(TrimWay::Table));
    assert_identical(&first, &kept, "few scan lines");
    let mut exact = with_little(&model, SceneSettings { trim: TrimWay::Exact, ..BY_TABLE });
    for (camera, what) in [(&close, "many"), (&whole, "few again")] {
        let picture = finely(&mut auto, camera).unwrap();
        assert_eq!(picture.stats.trim, Some(TrimWay::Exact), "{what}");
        assert_identical(&picture, &finely(&mut exact, camera).unwrap(), what);
    }
    [by_table, auto, exact].into_iter().for_each(assert_silent);
}

/// Loops keep their edits, and may be edited further.
#[test]
fn edits_outlive_the_table() {
    let mut model = stack();
    let (whole, close) = (onto(&model, 1.0), onto(&model, 300.0));
    let settings = SceneSettings { trim: TrimWay::Auto, editable: true, ..BY_TABLE };
    let mut edited = with_little(&model, settings);
    let at = LoopAt { part: 0, face: 0, trim_loop: 1 };
    let mut edit = |edited: &mut HeadlessRenderer, by: DVec2| {
        let moved = model.parts[0].faces[0].loops[1].translated(by).unwrap();
        edited.edit_loop(at, &moved).unwrap();
        model.parts[0].faces[0].loops[1] = moved;
        model.clone()
    };
    assert_eq!(finely(&mut edited, &whole).unwrap().stats.trim, Some(TrimWay::Table));
    let once = edit(&mut edited, DVec2::new(0.4, 0.1));
    let mut exact = with_little(&once, SceneSettings { trim: TrimWay::Exact, ..settings });
    let picture = finely(&mut edited, &close).unwrap();
    assert_eq!(picture.stats.trim, Some(TrimWay::Exact));
    assert_identical(&picture, &finely(&mut exact, &close).unwrap(), "edited before");
    let twice = edit(&mut edited, DVec2::new(-0.3, 0.2));
    exact.upload_with(&twice, SceneSettings { trim: TrimWay::Exact, ..settings }).unwrap();
    let picture = finely(&mut edited, &whole).unwrap();
    assert_identical(&picture, &finely(&mut exact, &whole).unwrap(), "edited after");
    [edited, exact].into_iter().for_each(assert_silent);
}
