//! A still camera reuses the visibility of each pixel, and one that turns around the model its trim table. This changes
//! no picture: every image is the same, bit for bit, as that of a renderer that has drawn nothing before, and every
//! count as in a frame of all passes.

use crate::hidden::crowd;
use crate::layers::in_glass;
use crate::shapes::{self, operands, solids};
use crate::support::{assert_identical, assert_silent, watched_with};
use glam::{DVec2, DVec3};
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, LoopAt, Model, Projection};
use selvedge::picture::{
    FrameSettings, FrameStats, Highlight, Levels, Outputs, Picture, Samples, SceneSettings, Smooth, SolidWay, TrimWay,
};

const SIZE: (u32, u32) = (96, 80);

/// Few patches, all of them drawn: plates with a hole, waves, a cube.
fn few() -> Model {
    let mut model = crowd();
    model.instances = model.instances.into_iter().step_by(9).collect();
    model
}

fn from(model: &Model, angle: f64) -> Camera {
    let direction = DVec3::new(angle.sin(), -angle.cos(), 0.4);
    Camera::around(model.control_bounds(), direction, DVec3::Z, 35f64.to_radians(), SIZE)
}

/// A renderer, and one that starts again for every picture.
struct Pair {
    scene: SceneSettings,
    viewer: HeadlessRenderer,
    fresh: HeadlessRenderer,
}

impl Pair {
    fn new(model: &Model, scene: SceneSettings) -> Self {
        Self { scene, viewer: watched_with(model, scene), fresh: watched_with(model, scene) }
    }

    /// The first picture of a view computes the visibility; later ones reuse it and are the same.
    fn stands(&mut self, model: &Model, camera: &Camera, settings: FrameSettings, what: &str) {
        self.fresh.upload_with(model, self.scene).unwrap();
        let expected = self.fresh.render(camera, &settings, Outputs::ALL).unwrap();
        let mut drawn = |nth: usize, all_passes: bool| {
            let settings = FrameSettings { all_passes, ..settings };
            let picture = self.viewer.render(camera, &settings, Outputs::ALL).unwrap();
            assert_identical(&picture, &expected, &format!("{what}, picture {nth}"));
            picture
        };
        let first = drawn(0, false);
        assert!(!first.stats.reused || first.stats.retries > 0, "{what}: something changed");
        // with occlusion culling, a view's test changes its next frame, and the frame after that reuses
        let kept = [1, 2, 3].map(|nth| drawn(nth, false))[2].clone();
        let whole = drawn(4, true);
        let again = drawn(5, false);
        assert_eq!((kept.stats.reused, whole.stats.reused, again.stats.reused), (true, false, true), "{what}");
        let kept_passes: &[&str] = if self.scene.samples == Samples::One { &SEEN_BY } else { &SEEN_BY[..2] };
        // with samples, only tessellation and trim table, which a scene without patches does not have
        let has = passes(&whole).iter().any(|pass| kept_passes.contains(pass));
        assert!(has || whole.stats.patches == 0, "{what}: {:?}", passes(&whole));
        for picture in [&kept, &again] {
            assert_eq!(counts(picture), counts(&whole), "{what}");
            assert!(!passes(picture).iter().any(|pass| kept_passes.contains(pass)), "{what}: {:?}", passes(picture));
        }
    }

    fn ends(self) {
        assert_silent(self.viewer);
        assert_silent(self.fresh);
    }
}

/// Passes that compute the visibility; the first two serve all samples.
const SEEN_BY: [&str; 7] = ["tessellation", "trim table", "mesh", "solids", "visibility", "occlusion", "gaps"];

fn passes(picture: &Picture) -> Vec<&str> {
    picture.stats.passes.iter().map(|pass| pass.name.as_str()).collect()
}

/// All statistics of a frame except times and the reuse itself.
fn counts(picture: &Picture) -> FrameStats {
    let mut stats = picture.stats.clone();
    (stats.passes, stats.reused, stats.triangles) = (Vec::new(), false, 0);
    stats
}

/// Whether a viewer's next picture makes a trim table. It equals a new renderer's picture, with the same number of
/// rows.
fn makes_a_table(pair: &mut Pair, model: &Model, camera: &Camera, settings: FrameSettings, what: &str) -> bool {
    pair.fresh.upload_with(model, pair.scene).unwrap();
    let expected = pair.fresh.render(camera, &settings, Outputs::ALL).unwrap();
    let picture = pair.viewer.render(camera, &settings, Outputs::ALL).unwrap();
    assert_identical(&picture, &expected, what);
    let of_table = |p: &Picture| (p.stats.trim_rows, p.stats.trim_segments, p.stats.trim_intercepts, p.stats.clamps);
    assert_eq!(of_table(&picture), of_table(&expected), "{what}");
    assert!(!picture.stats.reused && picture.stats.trim_rows > 0, "{what}");
    assert!(passes(&expected).contains(&"trim table"), "{what}: a first picture has no table");
    passes(&picture).contains(&"trim table")
}

#[test]
fn views_from_about_as_far_and_from_near_by_share_a_trim_table() {
    let mut model = few();
    let scene = SceneSettings { trim: TrimWay::Table, editable: true, ..SceneSettings::default() };
    let mut pair = Pair::new(&model, scene);
    let settings = FrameSettings::default();
    let coarse = FrameSettings { tolerance_px: 2.0, ..settings };
    let anew = FrameSettings { all_passes: true, ..settings };
    let camera = from(&model, 0.3);
    let farther = Camera { eye: camera.eye.lerp(camera.target, -0.5), ..camera };
    let farther = Camera { depth_range: (1.0, 2.0 * camera.depth_range.1), ..farther };
    let close = Camera { eye: camera.eye.lerp(camera.target, 0.9), depth_range: (0.05, 100.0), ..camera };
    let by = DVec3::new(1e-3, -2e-3, 1e-3);
    let hardly = |view: Camera| Camera { eye: view.eye + by, target: view.target + by, ..view };
    let beside = Camera { eye: close.eye + DVec3::X, target: close.target + DVec3::X, ..close };
    let narrow = Camera { projection: Projection::Perspective { fov_y: 0.4 }, ..close };
    let part = Camera { projection: Projection::Orthographic { height: 8.0 }, ..camera };
    let parallel = Camera { projection: Projection::Orthographic { height: 30.0 }, ..camera };
    let aside = Camera { eye: parallel.eye + DVec3::X, target: parallel.target + DVec3::X, ..parallel };
    let views = [
        ("first", camera, settings, true),
        ("turned", from(&model, 0.5), settings, false),
        ("turned around", from(&model, 3.0), settings, false),
        ("coarser", from(&model, 0.4), coarse, true),
        ("coarser, turned", from(&model, 0.6), coarse, false),
        ("as fine as before", camera, settings, true),
        ("anew", from(&model, 0.7), anew, true),
        ("turned since", from(&model, 0.8), settings, false),
        ("farther", farther, settings, true),
        ("close", close, settings, true),
        ("close, hardly moved", hardly(close), settings, false),
        ("beside it", beside, settings, true),
        ("close, narrow", narrow, settings, true),
        ("close, narrow, hardly moved", hardly(narrow), settings, false),
        ("close, narrow, coarser", hardly(narrow), coarse, true),
        ("a part, parallel", part, settings, true),
        ("a part, parallel, hardly moved", hardly(part), settings, false),
        ("back", from(&model, 0.9), settings, true),
        ("parallel", parallel, settings, true),
        ("parallel, aside", aside, settings, false),
    ];
    for (what, camera, settings, made) in views {
        assert_eq!(makes_a_table(&mut pair, &model, &camera, settings, what), made, "{what}");
    }
    let moved = model.parts[0].faces[0].loops[1].translated(DVec2::new(0.3, 0.1)).unwrap();
    pair.viewer.edit_loop(LoopAt { part: 0, face: 0, trim_loop: 1 }, &moved).unwrap();
    model.parts[0].faces[0].loops[1] = moved;
    assert!(makes_a_table(&mut pair, &model, &parallel, settings, "edited"));
    assert!(!makes_a_table(&mut pair, &model, &aside, settings, "since the edit"));
    pair.ends();
}

/// Everything that a view depends on, changed and changed back.
fn made_anew(model: &Model, trim: TrimWay) {
    let mut pair = Pair::new(model, SceneSettings { trim, ..SceneSettings::default() });
    let settings = FrameSettings::default();
    let mut stands = |camera: &Camera, settings, what: &str| pair.stands(model, camera, settings, what);
    let camera = from(model, 0.3);
    stands(&camera, settings, "the first view");
    stands(&from(model, 0.32), settings, "turned a little");
    stands(&Camera { eye: camera.eye.lerp(camera.target, 0.5), ..camera }, settings, "nearer");
    stands(&camera, settings, "back where it was");
    stands(&camera, FrameSettings { tolerance_px: 8.0, ..settings }, "coarser");
    stands(&camera, FrameSettings { levels: Levels::Fixed(3), ..settings }, "other levels");
    stands(&camera, FrameSettings { background: Some([0.1, 0.2, 0.3, 1.0]), ..settings }, "on another ground");
    stands(&Camera { size: (80, 70), ..camera }, settings, "smaller");
    stands(&camera, settings, "as large as before");
    pair.ends();
}

#[test]
fn few_patches_are_made_anew() {
    made_anew(&few(), TrimWay::Exact);
}

/// So many patches that occlusion culling delays reuse by two frames.
#[test]
fn many_patches_are_made_anew() {
    made_anew(&crowd(), TrimWay::Table);
}

#[test]
fn an_edit_is_seen() {
    for &trim in TrimWay::ALL {
        let mut model = few();
        let scene = SceneSettings { trim, editable: true, ..SceneSettings::default() };
        let mut pair = Pair::new(&model, scene);
        let camera = from(&model, 0.3);
        pair.stands(&model, &camera, FrameSettings::default(), "before");
        for by in [DVec2::new(0.3, 0.1), DVec2::new(-0.5, 0.2)] {
            let moved = model.parts[0].faces[0].loops[1].translated(by).unwrap();
            pair.viewer.edit_loop(LoopAt { part: 0, face: 0, trim_loop: 1 }, &moved).unwrap();
            model.parts[0].faces[0].loops[1] = moved;
            pair.stands(&model, &camera, FrameSettings::default(), &format!("edited, {trim:?}"));
        }
        pair.ends();
    }
}

/// Other models with the same number of patches, in the same view.
#[test]
fn another_scene_is_seen() {
    let model = few();
    let mut pair = Pair::new(&model, SceneSettings::default());
    let camera = from(&model, 0.3);
    pair.stands(&model, &camera, FrameSettings::default(), "before");
    let mut other = model.clone();
    other.parts.reverse();
    pair.viewer.upload(&other).unwrap();
    pair.stands(&other, &camera, FrameSettings::default(), "other parts");
    let mut cut = model.clone();
    cut.trim_by(&solids::solid("A", vec![solids::ball(9.0, 3.0)]).solids[0]).unwrap();
    pair.viewer.upload(&cut).unwrap();
    pair.stands(&cut, &camera, FrameSettings::default(), "cut open");
    pair.ends();
}

/// With so little room for lists that a view needs several bands.
fn in_bands(model: &Model) -> SceneSettings {
    let mut renderer = watched_with(model, SceneSettings::default());
    let camera = from(model, 0.3);
    let draw = |renderer: &mut HeadlessRenderer| {
        renderer.render(&camera, &FrameSettings::default(), Outputs::ALL).unwrap().stats
    };
    let lists = draw(&mut renderer).solid_bytes;
    let all: u64 = lists.iter().filter(|l| ["tiles", "crossings"].contains(&l.name.as_str())).map(|l| l.bytes).sum();
    let has_bands = |part: &u64| {
        let settings = SceneSettings { solid_budget: Some(all * (8 - part) / 8), ..SceneSettings::default() };
        renderer.upload_with(model, settings).unwrap();
        draw(&mut renderer).bands > 1
    };
    let part = (1..8).find(has_bands).unwrap();
    assert_silent(renderer);
    SceneSettings { solid_budget: Some(all * (8 - part) / 8), ..SceneSettings::default() }
}

/// Later passes with lists and counts of their own: samples, bands, a sun, smooth trims, transparent layers,
/// highlights; spline operands; every way to draw solids.
#[test]
fn whatever_follows_draws_what_is_kept() {
    let default = SceneSettings::default();
    let highlight = Some(Highlight::default());
    let mut beside = few();
    beside.instances.truncate(6);
    let (_, torus_less_a_post) = operands::splines().remove(1);
    beside.solids.extend(torus_less_a_post.solids);
    let clear = in_glass();
    let plain = solids::solid("A-B", vec![solids::ball(2.0, 0.0), solids::ball(1.0, 2.0)]);
    let scenes = [
        ("samples", &beside, SceneSettings { samples: Samples::Four, ..default }),
        ("a sun", &beside, SceneSettings { sun: Some(DVec3::new(-0.5, 0.4, 0.9)), ..default }),
        ("bands", &beside, in_bands(&beside)),
        ("smooth trims", &beside, SceneSettings { smooth: Smooth::Trims, trim: TrimWay::Exact, ..default }),
        ("marks", &beside, SceneSettings { highlight, ..default }),
        ("glass", &clear, default),
        ("glass, samples", &clear, SceneSettings { samples: Samples::Four, ..default }),
        ("glass, bands", &clear, in_bands(&clear)),
        ("layers peeled", &plain, SceneSettings { solids: SolidWay::Blister, ..default }),
        ("primitives trimmed", &plain, SceneSettings { solids: SolidWay::Cst, ..default }),
    ];
    for (name, model, scene) in scenes {
        let mut pair = Pair::new(model, scene);
        pair.stands(model, &from(model, 0.3), FrameSettings::default(), name);
        pair.ends();
    }
    let meshes = shapes::whole_mesh("ball", shapes::ball_mesh(1));
    let mut pair = Pair::new(&meshes, default);
    pair.stands(&meshes, &from(&meshes, 0.3), FrameSettings::default(), "a mesh");
    pair.ends();
}
