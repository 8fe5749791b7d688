//! A frame leaves out effects of its scene: the picture is that of a scene without them. The next one has them again.

use crate::hidden::crowd;
use crate::layers::in_glass;
use crate::shapes::solids::{block, folded};
use crate::support::{assert_identical, assert_silent, perspective, watched_for, watched_with};
use glam::DVec3;
use selvedge::csg::Op;
use selvedge::picture::{
    EdgeSettings, Effects, FrameSettings, Outputs, Picture, Samples, SceneSettings, Smooth, TrimWay,
};

const SIZE: (u32, u32) = (160, 120);
const OUTPUTS: Outputs = Outputs { edge: true, ..Outputs::ALL };

fn passes(picture: &Picture) -> Vec<&str> {
    picture.stats.passes.iter().map(|pass| pass.name.as_str()).collect()
}

#[test]
fn what_is_left_out_is_as_if_the_scene_had_it_not() {
    let corner = folded(Op::Union, vec![block([-1.0, -4.0, -1.0], [0.0, 4.0, 4.0]), block([0.0; 3], [4.0, 4.0, 1.0])]);
    for (model, what) in [(crowd(), "parts"), (corner, "solids")] {
        let camera = perspective(&model, SIZE);
        let scene = SceneSettings {
            // `Auto` depends on the borders
            trim: TrimWay::Exact,
            smooth: Smooth::Borders,
            ambient: Some(0.1 * model.control_bounds().diagonal()),
            // of a height of 1080: a pixel here
            edges: Some(EdgeSettings { width: 9.0, thin_width: 9.0, ..EdgeSettings::default() }),
            ..SceneSettings::default()
        };
        let (mut renderer, mut fresh) = (watched_with(&model, scene), crate::watched::renderer());
        let mut draw = |without: Effects| {
            let settings = FrameSettings { without, ..FrameSettings::default() };
            renderer.render(&camera, &settings, OUTPUTS).unwrap()
        };
        let full = draw(Effects::NONE);
        assert!(full.edge.iter().any(|number| *number != 0), "{what}: no line");
        let (borders, ambient, lines) = (
            Effects { borders: true, ..Effects::NONE },
            Effects { ambient: true, ..Effects::NONE },
            Effects { lines: true, ..Effects::NONE },
        );
        let cases = [
            (borders, SceneSettings { smooth: Smooth::None, ..scene }, "borders"),
            (ambient, SceneSettings { ambient: None, ..scene }, "ambient"),
            (lines, SceneSettings { edges: None, ..scene }, "lines"),
        ];
        for (without, plain, pass) in cases {
            fresh.upload_with(&model, plain).unwrap();
            let expected = fresh.render(&camera, &FrameSettings::default(), OUTPUTS).unwrap();
            assert!(passes(&full).contains(&pass), "{what}: {:?}", passes(&full));
            // twice: the second one may reuse what the first one saw
            for _ in 0..2 {
                let picture = draw(without);
                assert_identical(&picture, &expected, &format!("{what} without {pass}"));
                assert!(picture.colour != full.colour, "{what}: {pass} is not seen in the whole picture");
                assert!(!passes(&picture).contains(&pass), "{what}: {:?}", passes(&picture));
                assert_eq!(picture.edge.iter().all(|number| *number == 0), without.lines, "{what} without {pass}");
            }
            for _ in 0..2 {
                let again = draw(Effects::NONE);
                assert_identical(&again, &full, &format!("{what} with {pass} again"));
                assert!(again.edge == full.edge, "{what} with {pass} again");
            }
        }
        let all = draw(Effects { borders: true, ambient: true, lines: true, shadows: true });
        let kept = ["borders", "ambient", "lines", "edges"].into_iter().find(|pass| passes(&all).contains(pass));
        assert_eq!(kept, None, "{what}");
        assert!(all.depth == full.depth && all.face == full.face, "{what}");
        assert_silent(renderer);
        assert_silent(fresh);
    }
}

/// Without shadows the sun reaches all that is turned towards it. What it reaches with them looks the same.
#[test]
fn shadows_that_are_left_out_change_what_is_in_shadow_alone() {
    let corner = folded(Op::Union, vec![block([-1.0, -4.0, -1.0], [0.0, 4.0, 4.0]), block([0.0; 3], [4.0, 4.0, 1.0])]);
    for (model, what) in [(crowd(), "parts"), (corner, "solids")] {
        let camera = perspective(&model, SIZE);
        let sun = Some(DVec3::new(-1.0, 0.3, 0.7));
        let mut renderer =
            watched_with(&model, SceneSettings { sun, smooth: Smooth::None, ..SceneSettings::default() });
        let mut draw = |without: Effects| {
            let settings = FrameSettings { without, ..FrameSettings::default() };
            renderer.render(&camera, &settings, OUTPUTS).unwrap()
        };
        let full = draw(Effects::NONE);
        let lit = |picture: &Picture| picture.sunlit.iter().filter(|lit| **lit).count();
        // twice: the second one may reuse what the first one saw
        for _ in 0..2 {
            let picture = draw(Effects { shadows: true, ..Effects::NONE });
            assert!(lit(&full) > 0 && lit(&picture) > lit(&full), "{what}: {} and {}", lit(&full), lit(&picture));
            assert!(picture.depth == full.depth && picture.face == full.face, "{what}");
            let same = |i: usize| picture.sunlit[i] && picture.colour[i] == full.colour[i];
            assert!(
                (0..full.sunlit.len()).all(|i| !full.sunlit[i] || same(i)),
                "{what}: what is lit with shadows, too"
            );
        }
        assert_identical(&draw(Effects::NONE), &full, &format!("{what} with shadows again"));
        assert_silent(renderer);
    }
}

/// What is behind glass is drawn into another image than a picture without glass.
#[test]
fn what_is_left_out_behind_glass_is_as_if_the_scene_had_it_not() {
    let model = in_glass();
    let camera = perspective(&model, SIZE);
    let ambient = Some(0.1 * model.control_bounds().diagonal());
    let scene = SceneSettings { smooth: Smooth::Borders, ambient, ..SceneSettings::default() };
    let cases = [
        (Effects { borders: true, ..Effects::NONE }, SceneSettings { smooth: Smooth::None, ..scene }, "borders"),
        (Effects { ambient: true, ..Effects::NONE }, SceneSettings { ambient: None, ..scene }, "ambient"),
    ];
    let mut renderer = watched_with(&model, scene);
    for (without, plain, pass) in cases {
        let mut fresh = watched_with(&model, plain);
        let expected = fresh.render(&camera, &FrameSettings::default(), OUTPUTS).unwrap();
        assert_silent(fresh);
        let settings = FrameSettings { without, ..FrameSettings::default() };
        let picture = renderer.render(&camera, &settings, OUTPUTS).unwrap();
        assert_identical(&picture, &expected, &format!("without {pass}"));
    }
    assert_silent(renderer);
}

/// With several samples the pixels' centres are drawn for lines, and for images; for a colour without lines they are
/// not.
#[test]
fn without_lines_several_samples_draw_no_centres() {
    let model = crowd();
    let camera = perspective(&model, SIZE);
    let plain = SceneSettings { trim: TrimWay::Exact, samples: Samples::Four, ..SceneSettings::default() };
    let edges = EdgeSettings { width: 9.0, thin_width: 9.0, ..EdgeSettings::default() };
    let lines = SceneSettings { edges: Some(edges), ..plain };
    let [mut renderer, mut fresh] = [lines, plain].map(|scene| watched_for(Outputs::default(), &model, scene));
    let without = Effects { lines: true, ..Effects::NONE };
    // twice, so that a view is reused both ways
    for (without, outputs, draws) in [
        (Effects::NONE, Outputs::default(), true),
        (without, Outputs::default(), false),
        (without, OUTPUTS, true),
        (without, Outputs::default(), false),
        (Effects::NONE, Outputs::default(), true),
    ] {
        let settings = FrameSettings { without, ..FrameSettings::default() };
        let picture = renderer.render(&camera, &settings, outputs).unwrap();
        assert_eq!(passes(&picture).contains(&"centre sample"), draws, "{without:?}, {outputs:?}");
        let expected = fresh.render(&camera, &FrameSettings::default(), outputs).unwrap();
        if without.lines {
            assert_identical(&picture, &expected, "several samples without lines");
        } else {
            assert!(picture.colour != expected.colour, "no line");
        }
    }
    assert_silent(renderer);
    assert_silent(fresh);
}
