//! Boolean solids whose lists are made band by band: the same picture, bit for bit.

use crate::layers::{in_glass, model, one, painted};
use crate::shapes::operands::{mesh, meshes, part, splines};
use crate::shapes::solids::{self, ball};
use crate::shapes::{ball_mesh, cube};
use crate::support::{assert_identical, assert_silent, perspective, watched, watched_with};
use glam::DVec3;
use selvedge::headless::{HeadlessError, HeadlessRenderer};
use selvedge::model::{Camera, Model, Projection};
use selvedge::picture::{FrameSettings, Highlight, Outputs, Picture, Samples, SceneSettings, SolidWay};
use selvedge::renderer::RenderError;
use std::collections::BTreeSet;

/// Ten rows of tiles, the last of them only partly in the picture.
const SIZE: (u32, u32) = (160, 156);

fn draw(renderer: &mut HeadlessRenderer, camera: &Camera, outputs: Outputs) -> Result<Picture, RenderError> {
    match renderer.render(camera, &FrameSettings::default(), outputs) {
        Ok(picture) => Ok(picture),
        Err(HeadlessError::Render(error)) => Err(error),
        Err(error) => panic!("another error: {error}"),
    }
}

fn assert_same(a: &Picture, b: &Picture, what: &str) {
    assert_identical(a, b, what);
    let bits = |p: &Picture| p.thickness.iter().map(|t| t.to_bits()).collect::<Vec<_>>();
    assert!(bits(a) == bits(b), "thickness {what}");
    let told = |p: &Picture| {
        let s = &p.stats;
        (s.fragments, s.mended, s.unpaired, s.clamps, s.contact_pixels, s.overlap_pixels)
    };
    assert_eq!(told(a), told(b), "{what}");
}

/// Bytes that the budget limits.
fn list_bytes(picture: &Picture) -> u64 {
    let lists = picture.stats.solid_bytes.iter().filter(|l| ["tiles", "crossings"].contains(&l.name.as_str()));
    lists.map(|l| l.bytes).sum()
}

/// A model that is drawn with smaller and smaller budgets.
struct Case {
    name: &'static str,
    model: Model,
    camera: Camera,
    settings: SceneSettings,
    /// Bytes with which it is drawn in one band.
    most: f64,
}

impl Case {
    fn new(name: &'static str, model: Model, settings: SceneSettings, most: f64) -> Self {
        Self { name, camera: perspective(&model, SIZE), model, settings, most }
    }
}

/// The steps from one budget to the next.
#[derive(Clone, Copy, PartialEq)]
enum Steps {
    /// From the budget for one band to the budget for ten, in steps that just change the number of bands.
    Wide,
    /// From `Case::most`, by 6 % a step while there are fewer than three bands.
    Narrow,
}

/// Draws with smaller and smaller budgets, until a row of tiles does not fit.
fn with_less_and_less(case: &Case, steps: Steps) {
    let Case { name, model, camera, settings, most } = case;
    let settings = *settings;
    let outputs = Outputs { thickness: settings.thickness, ..Outputs::ALL };
    let mut renderer = watched(&Model::default());
    renderer.upload_with(model, settings).unwrap();
    let whole = draw(&mut renderer, camera, outputs).unwrap();
    assert_eq!(whole.stats.bands, 1, "{name}");
    assert!(whole.face.iter().filter(|id| **id != 0).count() * 8 > whole.face.len(), "{name} shows little");
    let mut seen = BTreeSet::new();
    // lists of a view without a budget have a quarter of spare room
    let mut budget = if steps == Steps::Wide { most.min(list_bytes(&whole) as f64) } else { *most };
    let refused = loop {
        assert!(budget > 100.0, "{name}: any budget will do");
        let what = format!("{name}, {budget:.0} bytes");
        let settings = SceneSettings { solid_budget: Some(budget as u64), ..settings };
        renderer.upload_with(model, settings).unwrap();
        let picture = match draw(&mut renderer, camera, outputs) {
            Ok(picture) => picture,
            Err(error) => break error,
        };
        assert_same(&whole, &picture, &what);
        assert!(picture.stats.retries <= 3, "{what}: {} retries", picture.stats.retries);
        assert!(list_bytes(&picture) <= budget as u64, "{what}: {:?}", picture.stats.solid_bytes);
        assert_same(&whole, &draw(&mut renderer, camera, outputs).unwrap(), &format!("{what}, again"));
        seen.insert(picture.stats.bands);
        let narrow = picture.stats.bands < if steps == Steps::Wide { 2 } else { 3 };
        budget *= if narrow { 0.94 } else { 0.7 };
    };
    let few = [1, 2].iter().all(|bands| seen.contains(bands)) && [3, 4, 5].iter().any(|bands| seen.contains(bands));
    assert!(few && seen.contains(&10), "{name}: {seen:?}");
    let RenderError::TooMany(error) = refused else { panic!("{name}: {refused}") };
    assert_eq!((error.what, error.most), ("bytes for the lists of one row of tiles", budget as u32), "{name}");
    // the renderer still works
    renderer.upload_with(model, settings).unwrap();
    assert_same(&whole, &draw(&mut renderer, camera, outputs).unwrap(), name);
    assert_silent(renderer);
}

fn of_a_mesh() -> Vec<Case> {
    let (name, model) = meshes().swap_remove(1);
    vec![Case::new(name, model, SceneSettings::default(), 900_000.0)]
}

/// Trimmed faces, with gaps that skirts close, in operands and in placed parts.
fn of_spline_parts() -> Vec<Case> {
    let (name, mut model) = splines().swap_remove(6);
    model.parts = cube().parts;
    model.instances = cube().instances;
    vec![Case::new(name, model, SceneSettings::default(), 1_600_000.0)]
}

fn of_thousands_of_primitives() -> Vec<Case> {
    let model = solids::holes(45);
    let above = Camera::around(model.control_bounds(), DVec3::new(0.02, -0.01, 1.0), DVec3::Y, 0.6, SIZE);
    vec![Case { camera: above, ..Case::new("holes", model, SceneSettings::default(), 120_000.0) }]
}

fn of_what_is_seen_through() -> Vec<Case> {
    let clear = |c| [0.2, 0.5, 0.4, c];
    let of_operands = model(vec![
        one(painted(clear(0.4), mesh(ball_mesh(3)))),
        one(painted(clear(0.3), part(cube()))),
        one(painted(clear(1.0), ball(0.4, 0.1))),
    ]);
    let settings = SceneSettings::default();
    vec![
        Case::new("glass", in_glass(), settings, 20_000.0),
        Case::new("operands of glass", of_operands, settings, 900_000.0),
    ]
}

fn of_lengths_and_marks() -> Vec<Case> {
    let settings = SceneSettings { thickness: true, highlight: Some(Highlight::default()), ..SceneSettings::default() };
    let m = model(vec![one(painted([0.5; 4], mesh(ball_mesh(3)))), one(painted([0.7; 4], ball(0.8, 0.5)))]);
    vec![Case::new("lengths", m, settings, 900_000.0)]
}

fn of_samples() -> [Case; 2] {
    let (name, model) = splines().swap_remove(1);
    let settings = SceneSettings { samples: Samples::Four, ..SceneSettings::default() };
    [Case::new(name, model, settings, 900_000.0), Case::new("glass, samples", in_glass(), settings, 20_000.0)]
}

#[test]
fn a_mesh() {
    of_a_mesh().iter().for_each(|case| with_less_and_less(case, Steps::Wide));
}

#[test]
fn spline_parts() {
    of_spline_parts().iter().for_each(|case| with_less_and_less(case, Steps::Wide));
}

#[test]
fn thousands_of_primitives() {
    of_thousands_of_primitives().iter().for_each(|case| with_less_and_less(case, Steps::Wide));
}

#[test]
fn seen_through() {
    of_what_is_seen_through().iter().for_each(|case| with_less_and_less(case, Steps::Wide));
}

#[test]
fn lengths_and_marks() {
    of_lengths_and_marks().iter().for_each(|case| with_less_and_less(case, Steps::Wide));
}

#[test]
#[ignore = "half a minute: tools/soak"]
fn samples_of_spline_parts() {
    with_less_and_less(&of_samples()[0], Steps::Wide);
}

#[test]
fn samples_of_what_is_seen_through() {
    with_less_and_less(&of_samples()[1], Steps::Wide);
}

/// By many more budgets, most of which give the same number of bands as the one before.
#[test]
#[ignore = "minutes: tools/soak"]
fn by_small_steps() {
    let all = [
        of_a_mesh(),
        of_spline_parts(),
        of_thousands_of_primitives(),
        of_what_is_seen_through(),
        of_lengths_and_marks(),
        of_samples().into(),
    ];
    all.iter().flatten().for_each(|case| with_less_and_less(case, Steps::Narrow));
}

/// Statistics of crossings are those of one drawing, whatever the number of samples.
#[test]
fn samples_are_counted_apart() {
    let (_, model) = meshes().swap_remove(2);
    let fragments = |samples: Samples| {
        let mut renderer = watched_with(&model, SceneSettings { samples, ..SceneSettings::default() });
        let picture = draw(&mut renderer, &perspective(&model, SIZE), Outputs::ALL).unwrap();
        assert_silent(renderer);
        picture.stats.fragments as f64
    };
    let [one, four] = [Samples::One, Samples::Four].map(fragments);
    // rays of samples lie within half a pixel of the pixel's
    assert!(one > 1000.0 && (0.9..1.1).contains(&(four / one)), "{one}, {four}");
}

/// From a view that needs bands to one that needs none, and to one of another size.
#[test]
fn views_change() {
    let (_, model) = meshes().swap_remove(2);
    let far = perspective(&model, SIZE);
    let near = Camera { projection: Projection::Perspective { fov_y: 0.2 }, ..far };
    let views = [near, far, Camera { size: (200, 90), ..near }, Camera { size: (33, 300), ..near }, far, near];
    let mut renderer = watched(&model);
    let whole = views.map(|view| draw(&mut renderer, &view, Outputs::ALL).unwrap());
    let need = |p: &Picture| 16 * p.stats.fragments + 8 * u64::from(p.size.0 * p.size.1);
    let budget = (need(&whole[0]) + need(&whole[1])) / 2;
    renderer.upload_with(&model, SceneSettings { solid_budget: Some(budget), ..SceneSettings::default() }).unwrap();
    let mut bands = Vec::new();
    for (view, whole) in views.iter().zip(&whole) {
        // the second time uses the counters of the first
        for what in ["at first", "again"] {
            let picture = draw(&mut renderer, view, Outputs::ALL).unwrap();
            assert_same(whole, &picture, &format!("{what} {view:?}"));
            bands.push(picture.stats.bands);
        }
    }
    assert!(bands[0] > 1 && bands[3] == 1 && bands[11] == bands[0], "{bands:?}");
    assert_silent(renderer);
}

/// Lists exist according to the way to draw, and are reported separately.
#[test]
fn each_way_tells_what_it_takes() {
    let (_, of_mesh) = meshes().swap_remove(1);
    let cases = [
        (SolidWay::Events, solids::holes(4), vec!["blocks", "tiles"], 1),
        (SolidWay::Events, of_mesh.clone(), vec!["blocks", "tiles", "crossings"], 1),
        (SolidWay::Cst, solids::holes(4), vec!["blocks", "tiles"], 0),
        (SolidWay::Blister, solids::holes(4), vec!["blocks", "tiles", "layers"], 0),
        (SolidWay::Blister, of_mesh, vec!["layers"], 0),
    ];
    let mut renderer = watched(&Model::default());
    for (solids, model, names, bands) in cases {
        renderer.upload_with(&model, SceneSettings { solids, ..SceneSettings::default() }).unwrap();
        let stats = draw(&mut renderer, &perspective(&model, SIZE), Outputs::ALL).unwrap().stats;
        let found: Vec<&str> = stats.solid_bytes.iter().map(|l| l.name.as_str()).collect();
        assert_eq!((found, stats.bands), (names, bands), "{}", solids.name());
        let objects = renderer.object_bytes();
        let of = |names: &[&str]| -> u64 {
            objects.iter().filter(|o| names.iter().any(|n| o.0.starts_with(n))).map(|o| o.1).sum()
        };
        for list in &stats.solid_bytes {
            let taken = match list.name.as_str() {
                "blocks" => of(&["solid block counts", "solid block starts", "solid block leaves"]),
                "tiles" => of(&[
                    "solid tile counts",
                    "solid tile starts",
                    "solid tile leaves",
                    "solid tile entries",
                    "solid tile squares",
                ]),
                "crossings" => of(&["operand fragment"]),
                _ => of(&["blister layer", "blister faces", "blister depth", "blister stencil"]),
            };
            // memory is allocated in steps of some bytes
            assert!(list.bytes <= taken && taken < list.bytes + 1024, "{}: {list:?}, {taken}", solids.name());
        }
    }
    assert_silent(renderer);
}
