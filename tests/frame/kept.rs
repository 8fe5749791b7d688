//! A still camera keeps the patches as they were divided and the trim table, and nothing shows it: every image is the
//! same bit for bit as that of a renderer that has drawn nothing before, and every count as in a frame of all passes.

use crate::hidden::crowd;
use crate::shapes::{self, operands, solids};
use crate::support::{assert_identical, assert_silent, watched_with};
use glam::{DVec2, DVec3};
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, LoopAt, Model};
use selvedge::picture::{FrameSettings, FrameStats, Levels, Outputs, Picture, Samples, SceneSettings, TrimWay};

const SIZE: (u32, u32) = (160, 120);

/// Few patches, none of which is left out: plates with a hole, waves, a cube.
fn few() -> Model {
    let mut model = crowd();
    model.instances = model.instances.into_iter().step_by(9).collect();
    model
}

fn from(model: &Model, angle: f64) -> Camera {
    let direction = DVec3::new(angle.sin(), -angle.cos(), 0.4);
    Camera::framing(model.bounds(), direction, DVec3::Z, 35f64.to_radians(), SIZE)
}

/// A renderer, and one that begins anew with every picture.
struct Pair {
    scene: SceneSettings,
    viewer: HeadlessRenderer,
    fresh: HeadlessRenderer,
}

impl Pair {
    fn new(model: &Model, scene: SceneSettings) -> Self {
        let fixed = SceneSettings { editable: false, ..scene };
        Self { scene: fixed, viewer: watched_with(model, scene), fresh: watched_with(model, fixed) }
    }

    /// The first picture of a view makes what it draws from; those that follow come to keep it, and are the same.
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
        assert!(!first.stats.kept || first.stats.retries > 0, "{what}: something changed");
        // where patches may lie behind others, a view is told of them, and then makes the table of what is seen
        let kept = [1, 2, 3].map(|nth| drawn(nth, false))[2].clone();
        let whole = drawn(4, true);
        let again = drawn(5, false);
        assert_eq!((kept.stats.kept, whole.stats.kept, again.stats.kept), (true, false, true), "{what}");
        assert!(passes(&whole).contains(&"tessellation"), "{what}: {:?}", passes(&whole));
        for picture in [&kept, &again] {
            assert_eq!(counts(picture), counts(&whole), "{what}");
            assert!(!passes(picture).iter().any(|pass| MADE_BY.contains(pass)), "{what}: {:?}", passes(picture));
        }
    }

    fn ends(self) {
        assert_silent(self.viewer);
        assert_silent(self.fresh);
    }
}

const MADE_BY: [&str; 2] = ["tessellation", "trim table"];

fn passes(picture: &Picture) -> Vec<&str> {
    picture.stats.passes.iter().map(|pass| pass.name.as_str()).collect()
}

/// All that a frame tells but its time.
fn counts(picture: &Picture) -> FrameStats {
    FrameStats { passes: Vec::new(), kept: false, ..picture.stats.clone() }
}

/// Everything that a view is made of, changed and changed back.
#[test]
fn whatever_changes_is_made_anew() {
    for &trim in TrimWay::ALL {
        for (name, model) in [("few", few()), ("many", crowd())] {
            let scene = SceneSettings { trim: Some(trim), ..SceneSettings::default() };
            let mut pair = Pair::new(&model, scene);
            let settings = FrameSettings::default();
            let mut stands = |camera: &Camera, settings, what: &str| {
                pair.stands(&model, camera, settings, &format!("{name}, {trim:?}, {what}"));
            };
            let camera = from(&model, 0.3);
            stands(&camera, settings, "the first view");
            stands(&from(&model, 0.32), settings, "turned a little");
            stands(&camera, settings, "turned back");
            let nearer = Camera { eye: camera.eye.lerp(camera.target, 0.5), ..camera };
            stands(&nearer, settings, "nearer");
            stands(&camera, FrameSettings { tolerance_px: 0.2, ..settings }, "finer");
            stands(&camera, FrameSettings { levels: Levels::Fixed(3), ..settings }, "other levels");
            stands(&camera, FrameSettings { background: Some([0.1, 0.2, 0.3, 1.0]), ..settings }, "on another ground");
            stands(&Camera { size: (120, 100), ..camera }, settings, "smaller");
            stands(&camera, settings, "as large as before");
            pair.ends();
        }
    }
}

#[test]
fn an_edit_is_seen() {
    for &trim in TrimWay::ALL {
        let mut model = few();
        let scene = SceneSettings { trim: Some(trim), editable: true, ..SceneSettings::default() };
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

/// Other models of as many patches, in the same view.
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
    cut.trim_by(solids::solid("A", vec![solids::ball(9.0, 3.0)]).solids.remove(0)).unwrap();
    pair.viewer.upload(&cut).unwrap();
    pair.stands(&cut, &camera, FrameSettings::default(), "cut open");
    pair.ends();
}

/// What drawing itself does more than once, or with counts of its own: samples, bands, a sun, operands of splines.
#[test]
fn whatever_draws_draws_from_what_is_kept() {
    let default = SceneSettings::default();
    let scenes = [
        ("samples", SceneSettings { samples: Samples::Four, ..default }),
        ("a sun", SceneSettings { sun: Some(DVec3::new(-0.5, 0.4, 0.9)), ..default }),
        ("bands", SceneSettings { solid_budget: Some(60_000), ..default }),
        ("smooth trims", SceneSettings { smooth_trims: true, trim: Some(TrimWay::Exact), ..default }),
    ];
    let mut beside = few();
    let (_, torus_less_a_post) = operands::splines().remove(1);
    beside.solids.extend(torus_less_a_post.solids);
    for (name, scene) in scenes {
        let mut pair = Pair::new(&beside, scene);
        for angle in [0.3, 0.5] {
            let camera = from(&beside, angle);
            pair.stands(&beside, &camera, FrameSettings::default(), &format!("{name} from {angle}"));
        }
        pair.ends();
    }
}

/// Meshes and solids alone leave nothing to keep.
#[test]
fn a_scene_without_patches_keeps_nothing() {
    for model in [
        shapes::whole_mesh("ball", shapes::ball_mesh(1)),
        solids::solid("A-B", vec![solids::ball(2.0, 0.0), solids::ball(1.0, 2.0)]),
    ] {
        let mut pair = Pair::new(&model, SceneSettings::default());
        let camera = from(&model, 0.3);
        let pictures = [(); 4].map(|()| pair.viewer.render(&camera, &FrameSettings::default(), Outputs::ALL).unwrap());
        assert!(pictures.iter().all(|p| !p.stats.kept && counts(p) == counts(&pictures[0])));
        assert!(!pair.viewer.objects().contains(&"kept counters".to_owned()));
        pair.ends();
    }
}
