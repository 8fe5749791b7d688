//! Views that need larger buffers than a scene begins with: drawn again until all of it is there.

use crate::shapes;
use crate::support::{assert_identical, assert_silent, watched_with};
use glam::{DAffine3, DQuat, DVec3};
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, Model, Projection};
use selvedge::picture::{FrameSettings, Outputs, Picture, Samples, SceneSettings, SolidWay, TrimWay};

/// Its buffers grow with the view.
const BY_TABLE: SceneSettings = SceneSettings {
    trim: Some(TrimWay::Table),
    #[cfg(feature = "rivals")]
    slefe_segments: None,
    #[cfg(feature = "rivals")]
    untested: false,
    solids: SolidWay::Events,
    editable: false,
    samples: Samples::One,
    smooth_trims: false,
    thickness: false,
    highlight: None,
    sun: None,
    solid_budget: None,
};

fn draw(renderer: &mut HeadlessRenderer, camera: &Camera, tolerance_px: f64) -> Picture {
    let settings = FrameSettings { tolerance_px, ..FrameSettings::default() };
    renderer.render(camera, &settings, Outputs::ALL).unwrap()
}

/// Draws a view for which the first buffers are too small. The picture must be the one that buffers
/// large enough from the start give, which a small view at first does not have.
fn check(model: &Model, camera: &Camera, tolerance_px: f64) -> Picture {
    let mut renderer = watched_with(model, BY_TABLE);
    let grown = draw(&mut renderer, camera, tolerance_px);
    assert!(grown.stats.retries > 0, "the first buffers were large enough: {:?}", grown.stats);
    let again = draw(&mut renderer, camera, tolerance_px);
    assert_eq!(again.stats.retries, 0, "what had grown was too small: {:?}", again.stats);
    assert_identical(&grown, &again, "with room from the start");
    assert_silent(renderer);

    let mut fresh = watched_with(model, BY_TABLE);
    let small = Camera { size: (8, 6), ..*camera };
    assert_eq!(draw(&mut fresh, &small, 2.0).stats.retries, 0);
    assert_identical(&grown, &draw(&mut fresh, camera, tolerance_px), "after a small view");
    assert_silent(fresh);
    grown
}

/// 64 plates with 32 scan lines a pixel: some 10^5 rows and twice as many intercepts.
#[test]
fn more_rows_than_the_first_table_holds() {
    let mut model = shapes::plate();
    let place = |i: u32| DVec3::new(f64::from(i % 8), f64::from(i / 8), 0.0) * 7.0;
    let placed = |i| shapes::placed(DAffine3::from_translation(place(i)), None);
    model.instances = (0..64).map(placed).collect();
    let camera = Camera::framing(model.bounds(), DVec3::new(0.1, -0.2, 1.0), DVec3::Y, 0.6, (640, 480));
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
    let above = Camera::framing(model.bounds(), DVec3::Z, DVec3::Y, 0.6, (320, 240));
    let camera = Camera { projection: Projection::Orthographic { height: 3.2 }, ..above };
    let picture = check(&model, &camera, 0.125);
    assert!(picture.stats.sub_patches > 262, "{:?}", picture.stats);
    assert_eq!(picture.stats.clamps, 0, "{:?}", picture.stats);
}
