//! Frames trimmed by each baseline against the exact reference, watched by the validation layers.

use crate::watched::{self, assert_silent, sample};
use glam::{DAffine3, DVec3};
use selvedge::baselines::pretessellated::pretessellated;
use selvedge::baselines::{SceneOptions, Sorted, TrimMethod, many_holes, texture};
use selvedge::gpu::GpuError;
use selvedge::headless::{HeadlessError, HeadlessRenderer};
use selvedge::model::{Camera, Instance, Model, Projection};
use selvedge::picture::{FrameSettings, Levels, Outputs, Picture, SceneSettings, TrimWay};
use selvedge::renderer::RenderError;
use selvedge_check::{JudgeOptions, Judgement, Tracer, judge};

const SIZE: (u32, u32) = (320, 240);

fn camera(model: &Model) -> Camera {
    Camera::around(model.control_bounds(), DVec3::new(1.0, -1.6, 1.1), DVec3::Z, 35f64.to_radians(), SIZE)
}

fn panel() -> Model {
    sample("panel.step")
}

/// A way to trim: the engine's own or a baseline.
#[derive(Clone, Copy, Debug)]
enum Way {
    Own(TrimWay),
    Baseline(TrimMethod),
}

impl Way {
    fn settings(self) -> SceneSettings {
        let Self::Own(trim) = self else { return SceneSettings::default() };
        SceneSettings { trim, ..SceneSettings::default() }
    }

    fn options(self) -> SceneOptions {
        let trim = if let Self::Baseline(method) = self { Some(method) } else { None };
        SceneOptions { trim, ..SceneOptions::default() }
    }
}

fn watched(model: &Model, way: Way) -> HeadlessRenderer {
    watched_with(model, way.settings(), way.options())
}

fn watched_with(model: &Model, settings: SceneSettings, baseline: SceneOptions) -> HeadlessRenderer {
    let mut renderer = watched::renderer();
    renderer.upload_baseline(model, settings, baseline).unwrap();
    renderer
}

/// Draws `drawn` and judges it against `model`: every pixel.
fn judged(drawn: &Model, way: Way, model: &Model) -> Judgement {
    judged_by(&JudgeOptions::default(), drawn, way, model)
}

fn judged_by(options: &JudgeOptions<'_>, drawn: &Model, way: Way, model: &Model) -> Judgement {
    let mut renderer = watched(drawn, way);
    let camera = camera(model);
    let picture = renderer.render(&camera, &FrameSettings::default(), Outputs::ALL).unwrap();
    assert_silent(renderer);
    judge(&Tracer::new(model), &camera, &picture.images(), options)
}

fn baseline(model: &Model, method: TrimMethod) -> Judgement {
    judged(model, Way::Baseline(method), model)
}

#[test]
fn bisection_keeps_half_a_pixel_and_one_step_does_not() {
    for model in [many_holes(6), panel()] {
        for sorted in [Sorted::Source, Sorted::Tuned] {
            let j = baseline(&model, TrimMethod::Bisect { steps: 16, sorted });
            assert_eq!(j.wrong, 0, "{}, {sorted:?}: {:?}", model.name, j.mismatches);
        }
    }
    // holes of 20 pixels, whose quarters become chords that bulge by a third of the radius
    let j = baseline(&many_holes(6), TrimMethod::Bisect { steps: 0, sorted: Sorted::Tuned });
    assert!(j.wrong > 100 && j.worst_shift_px > 1.0, "{} wrong, {} px", j.wrong, j.worst_shift_px);
}

/// Occlusion culling works with every way to trim; otherwise a comparison would not be one of trims.
#[test]
fn baselines_leave_out_what_lies_behind() {
    let one = sample("bracket.step");
    let mut model = Model { instances: Vec::new(), ..one.clone() };
    // away from the eye
    let behind = -0.5 * one.control_bounds().diagonal() * DVec3::new(1.0, -1.6, 1.1).normalize();
    for k in 0..12 {
        let place = |i: &Instance| Instance {
            transform: DAffine3::from_translation(f64::from(k) * behind) * i.transform,
            ..i.clone()
        };
        model.instances.extend(one.instances.iter().map(place));
    }
    // the first one fills the picture
    let camera = Camera { depth_range: (camera(&one).depth_range.0, 1e4), ..camera(&one) };
    let mut renderer = watched::renderer();
    let mut left_out = |way: Way| {
        renderer.upload_baseline(&model, way.settings(), way.options()).unwrap();
        let settings = FrameSettings { all_passes: true, ..FrameSettings::default() };
        let mut draw = || renderer.render(&camera, &settings, Outputs::ALL).unwrap().stats;
        [draw(), draw(), draw()].map(|stats| stats.hidden_patches)
    };
    let sorted = Sorted::Tuned;
    let methods =
        [TrimMethod::Untrimmed, TrimMethod::Bisect { steps: 16, sorted }, TrimMethod::Texture { eighths: 16 }];
    let ways = methods.map(Way::Baseline).into_iter().chain(TrimWay::ALL.iter().map(|way| Way::Own(*way)));
    for way in ways {
        // the second frame tests occlusion, and the third uses the result
        let [first, _, third] = left_out(way);
        assert!(first == 0 && third > 100, "{way:?}: {first}, then {third} patches");
    }
    assert_silent(renderer);
}

#[test]
fn textures_are_off_by_half_a_texel_each_way() {
    for model in [many_holes(6), panel()] {
        let j = baseline(&model, TrimMethod::Texture { eighths: 16 });
        assert_eq!(j.wrong, 0, "{}: {:?}", model.name, j.mismatches);
    }
    // four pixels a texel: up to two pixels in each direction, but the density is a bound, and mostly finer
    let j = baseline(&many_holes(6), TrimMethod::Texture { eighths: 2 });
    assert!(j.wrong > 100 && j.worst_shift_px > 0.7, "{} wrong, {} px", j.wrong, j.worst_shift_px);
}

#[test]
fn meshes_are_off_by_their_deflection() {
    for model in [many_holes(6), panel()] {
        let camera = camera(&model);
        let Projection::Perspective { fov_y } = camera.projection else { panic!("framing makes perspective views") };
        let pixel = 2.0 * (fov_y * 0.5).tan() * camera.depth_range.0 / f64::from(SIZE.1);
        let (mesh, made) = pretessellated(&model, 0.4 * pixel);
        // triangles that bulge after the last round are counted; one in a thousand is not visible
        assert_eq!((made.missing, 1000 * made.beyond / made.triangles), (0, 0));
        let j = judged(&mesh, Way::Own(TrimWay::Auto), &model);
        assert_eq!(j.wrong, 0, "{}: {:?}", model.name, j.mismatches);
        let j = judged(&pretessellated(&model, 4.0 * pixel).0, Way::Own(TrimWay::Auto), &model);
        assert!(j.wrong > 10 && j.worst_shift_px > 0.7, "{} wrong, {} px", j.wrong, j.worst_shift_px);
    }
}

/// The same frame measures the cost of tests: its patches are also drawn without tests, which changes no image.
#[test]
fn patches_drawn_without_a_test_are_not_seen() {
    let model = panel();
    let settings = FrameSettings::default();
    let bisect = TrimMethod::Bisect { steps: 16, sorted: Sorted::Tuned };
    for way in [Way::Own(TrimWay::Table), Way::Own(TrimWay::Exact), Way::Baseline(bisect)] {
        let mut renderer = watched(&model, way);
        let mut draw = |untested| {
            renderer.upload_baseline(&model, way.settings(), SceneOptions { untested, ..way.options() }).unwrap();
            renderer.render(&camera(&model), &settings, Outputs::ALL).unwrap()
        };
        let (alone, beside) = (draw(false), draw(true));
        let untested =
            |picture: &Picture| picture.stats.passes.iter().filter(|p| p.name == "visibility untested").count();
        assert_eq!((untested(&alone), untested(&beside)), (0, 1), "{way:?}");
        assert_eq!((&alone.colour, &alone.depth), (&beside.colour, &beside.depth), "{way:?}");
        assert_eq!(alone.stats.triangles, beside.stats.triangles, "{way:?}");
        assert_silent(renderer);
    }
}

/// A frame without trim tests is judged wrong. The judge checks some of the pixels in its holes, because it searches
/// far around each.
#[test]
fn a_frame_that_is_not_trimmed_is_wrong() {
    let model = many_holes(6);
    let options = JudgeOptions { searches: 2000, ..JudgeOptions::default() };
    let j = judged_by(&options, &model, Way::Baseline(TrimMethod::Untrimmed), &model);
    assert!(j.wrong > 1000, "{}", j.wrong);
}

#[test]
fn a_texture_beyond_the_device_is_told_and_the_next_view_drawn() {
    let model = many_holes(3);
    let mut renderer = watched(&model, Way::Baseline(TrimMethod::Texture { eighths: 16 }));
    let whole = camera(&model);
    // at the border of a hole; from nearer, the view would be cut out of the model
    let face = model.parts[0].faces.iter().max_by_key(|face| face.loops.len()).unwrap();
    let border = face.loops[1].curves().next().unwrap().points[0];
    let target = face.surface.jet(border.x / border.z, border.y / border.z).point;
    let close = Camera { target, projection: Projection::Perspective { fov_y: 35f64.to_radians() / 100.0 }, ..whole };
    let settings = FrameSettings::default();
    match renderer.render(&close, &settings, Outputs::default()) {
        Err(HeadlessError::Gpu(GpuError::TooLarge { .. }))
        | Err(HeadlessError::Render(RenderError::Gpu(GpuError::TooLarge { .. }))) => {}
        other => panic!("{:?}", other.map(|picture| picture.stats)),
    }
    let wanted = |camera: &Camera| texture::wanted_bytes(&model, camera, 16).unwrap();
    // ten thousand times the texels, and a little for the tighter bound of the slant
    assert!(wanted(&close) > 1e3 * wanted(&whole));
    let picture = renderer.render(&whole, &settings, Outputs::default()).unwrap();
    let words = wanted(&whole) / 4.0;
    let counted = picture.stats.trim_intercepts as f64;
    // single precision rounds sizes up or down by a texel
    assert!((counted / words - 1.0).abs() < 0.01, "{counted} words instead of {words}");
    assert_silent(renderer);
}

/// Slefes replace the bound in such a scene, and divide patches differently.
#[test]
fn slefes_make_a_picture() {
    let model = panel();
    let camera = camera(&model);
    let tracer = Tracer::new(&model);
    let drawn = [None, Some(3), Some(9)].map(|slefe_segments| {
        let mut renderer =
            watched_with(&model, SceneSettings::default(), SceneOptions { slefe_segments, ..SceneOptions::default() });
        let picture = renderer.render(&camera, &FrameSettings::default(), Outputs::ALL).unwrap();
        let has = |name: &str| renderer.objects().iter().any(|object| object == name);
        let expected = [slefe_segments.is_none(), slefe_segments.is_some(), slefe_segments.is_some()];
        assert_eq!(["bound", "baseline slefe", "slefes"].map(has), expected, "{:?}", renderer.objects());
        assert_silent(renderer);
        let covered = picture.face.iter().filter(|face| **face != 0).count();
        let j = judge(&tracer, &camera, &picture.images(), &JudgeOptions::default());
        // no promise, but a picture of the model
        assert!(covered > 10_000 && 100 * j.wrong < j.sampled, "{covered} covered, {} of {} wrong", j.wrong, j.sampled);
        picture.stats.triangles
    });
    assert!(drawn[0] != drawn[1] && drawn[1] != drawn[2], "{drawn:?}");
}

/// Whether a pixel or one beside it shows the face.
fn has_beside(picture: &Picture, k: usize, face: u32) -> bool {
    let (width, height) = (picture.size.0 as usize, picture.size.1 as usize);
    let (x, y) = (k % width, k / width);
    let rows = y.saturating_sub(1)..=(y + 1).min(height - 1);
    rows.flat_map(|y| (x.saturating_sub(1)..=(x + 1).min(width - 1)).map(move |x| y * width + x))
        .any(|k| picture.face[k] == face)
}

/// Whether two depths are the same to 1e-4 of themselves; nothing's is infinite.
fn near(a: f32, b: f32) -> bool {
    a == b || (a - b).abs() <= 1e-4 * a.abs().min(b.abs())
}

/// Patches of one segment a side have the same triangles by their corners as by the tessellator: the same faces are seen,
/// from turn to turn, so that patches also appear that were hidden. (u, v) between the corners may be rounded otherwise;
/// Newton's method then ends elsewhere within 5e-4 px of the pixel's centre, so depths are the same to 1e-4 of
/// themselves (1e-5 measured). Trims are tested at (u, v): where a trim curve passes a centre by a rounding, the pixel may
/// show the face on its other side (5 pixels measured). Vulkan leaves the triangles to the driver; elsewhere than on
/// llvmpipe the faces of a few pixels in a thousand may differ.
#[test]
fn patches_by_their_corners_make_the_same_pictures() {
    // trimmed faces, some of them in pieces; a linked surface beside a mesh
    for (name, fewest, most_at_borders) in [("assembly.step", 20, 10), ("gallery/subdivided.toml", 20, 0)] {
        let model = sample(name);
        let mut ways = [true, false].map(|corners| {
            watched_with(
                &model,
                SceneSettings::default(),
                SceneOptions { corners: Some(corners), ..Default::default() },
            )
        });
        let named = |renderer: &HeadlessRenderer| renderer.objects().iter().any(|name| name.contains("by corners"));
        assert!(named(&ways[0]) && !named(&ways[1]), "{name}");
        for (nth, levels) in [Levels::Bound, Levels::Bound, Levels::Fixed(1)].into_iter().enumerate() {
            let direction = DVec3::new(1.0, -1.6 + 0.4 * nth as f64, 1.1);
            let camera = Camera::around(model.control_bounds(), direction, DVec3::Z, 35f64.to_radians(), SIZE);
            let settings = FrameSettings { tolerance_px: 2.0, levels, ..FrameSettings::default() };
            let [with, without] = ways.each_mut().map(|way| way.render(&camera, &settings, Outputs::ALL).unwrap());
            let counts = |p: &Picture| (p.stats.sub_patches, p.stats.hidden_patches);
            assert_eq!(counts(&with), counts(&without), "{name}, view {nth}");
            let corners = [with.stats.corner_patches, without.stats.corner_patches];
            assert!(
                corners[1] == 0 && (levels == Levels::Bound || corners[0] >= fewest),
                "{name}, view {nth}: {corners:?}"
            );
            let others: Vec<usize> = (0..with.face.len()).filter(|k| with.face[*k] != without.face[*k]).collect();
            let most = if with.stats.driver.contains("llvmpipe") { 0 } else { with.face.len() / 500 };
            let at_border =
                |k: &usize| has_beside(&without, *k, with.face[*k]) && has_beside(&with, *k, without.face[*k]);
            let far = others.iter().filter(|k| !at_border(k)).count();
            println!("{name}, view {nth}: {} pixels, {far} of them at no border", others.len());
            assert!(far <= most && others.len() <= most + most_at_borders, "{name}, view {nth}: {others:?}");
            let is_off = |k: &usize| with.face[*k] == without.face[*k] && !near(with.depth[*k], without.depth[*k]);
            let off = (0..with.face.len()).filter(is_off).count();
            assert!(off <= most, "{name}, view {nth}: {off} depths");
        }
        ways.into_iter().for_each(assert_silent);
    }
}
