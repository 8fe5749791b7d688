//! Ambient occlusion: the share of the sky that a wall hides; only lit colours change.

use crate::layers::in_glass;
use crate::shapes;
use crate::shapes::solids::{block, folded};
use crate::support::{assert_identical, assert_silent, perspective, watched_for, watched_with};
use crate::watched::renderer;
use glam::{DVec2, DVec3};
use selvedge::csg::Op;
use selvedge::headless::{HeadlessError, HeadlessRenderer};
use selvedge::model::{Camera, Model, Primitive, Projection, srgb};
use selvedge::picture::{FrameSettings, Outputs, Picture, Samples, SceneSettings, Style};
use selvedge::renderer::RenderError;
use std::f64::consts::PI;

/// Share of the light that is lost where no sky is visible: `STRENGTH` of ambient_write.comp.
const STRENGTH: f64 = 0.75;

fn settings(ambient: Option<f64>) -> SceneSettings {
    SceneSettings { ambient, ..SceneSettings::default() }
}

fn draw(model: &Model, scene: SceneSettings, camera: &Camera, style: Style) -> Picture {
    let mut renderer = renderer();
    let picture = draw_next(&mut renderer, (model, scene), camera, style);
    assert_silent(renderer);
    picture
}

/// The picture of a scene that replaces the renderer's.
fn draw_next(
    renderer: &mut HeadlessRenderer,
    (model, scene): (&Model, SceneSettings),
    camera: &Camera,
    style: Style,
) -> Picture {
    renderer.upload_with(model, scene).unwrap();
    let settings = FrameSettings { style, ..FrameSettings::default() };
    renderer.render(camera, &settings, Outputs::ALL).unwrap()
}

/// Share of the sky, weighted by the cosine, that an endless wall hides from a floor. `x` is the distance of the wall
/// divided by the length of the rays. At the azimuth `p` from the wall's normal, rays below the elevation acos(x / cos
/// p) meet the wall. The integral of the squared sine of that elevation has this closed form.
fn hidden_by_wall(x: f64) -> f64 {
    if x >= 1.0 { 0.0 } else { (x.acos() - x * (1.0 - x * x).sqrt()) / PI }
}

/// The floor beside a wall, as solids, from above in both projections. Occlusion fades from three quarters of the
/// radius to the radius, so a pixel's loss lies between the losses for rays of these two lengths. The tolerance is a
/// sixteenth: a pixel takes four steps and uses the lower of two horizons.
#[test]
fn a_wall_hides_what_it_hides_from_rays() {
    let radius = 1.0;
    // white, so that eight bits round what is lost by a hundredth
    let white = |end: [f64; 3]| Primitive { colour: [1.0; 4], ..block([-1.0, -8.0, -1.0], end) };
    let solids = folded(Op::Union, vec![white([0.0, 8.0, 4.0]), white([8.0, 8.0, 0.0])]);
    for projection in [Projection::Orthographic { height: 6.0 }, Projection::Perspective { fov_y: 0.3 }] {
        let camera = Camera {
            eye: DVec3::new(16.0, 0.0, 12.0),
            target: DVec3::ZERO,
            up: DVec3::Z,
            projection,
            depth_range: (5.0, 60.0),
            size: (320, 240),
        };
        let [before, after] = [None, Some(radius)].map(|r| draw(&solids, settings(r), &camera, Style::Shaded));
        let (mut judged, mut seen, mut off) = (0, [0.0, 1.0f64], [0.0f64; 2]);
        for i in (0..before.depth.len()).filter(|i| before.depth[*i].is_finite() && before.normal[*i][2] > 0.9) {
            let (x, y) = (i % 320, i / 320);
            let (from, ray) = camera.ray(DVec2::new(x as f64 + 0.5, y as f64 + 0.5));
            let point = from + f64::from(before.depth[i]) * ray;
            if !(0.1..2.0).contains(&point.x) || point.y.abs() > 2.0 {
                continue;
            }
            // colours are rounded to eight bits
            let light = |p: &Picture, off: f64| srgb::decoded((f64::from(p.colour[i][1]) + off) / 255.0);
            let hidden_at = |off: f64| (1.0 - light(&after, -off) / light(&before, off)) / STRENGTH;
            let [low, hidden, high] = [-0.5, 0.0, 0.5].map(hidden_at);
            let (least, most) = (hidden_by_wall(point.x / (0.75 * radius)), hidden_by_wall(point.x / radius));
            off = [off[0].max(least - high), off[1].max(low - most)];
            seen = [seen[0].max(hidden), seen[1].min(hidden)];
            judged += 1;
        }
        println!("{projection:?}: {judged} pixels, {seen:?}, off by {off:?}");
        assert!(off[0] < 1.0 / 16.0 && off[1] < 1.0 / 16.0, "{projection:?}: {off:?}");
        assert!(judged > 3000 && seen[0] > 0.3 && seen[1] < 0.02, "{judged}, {seen:?}");
    }
}

/// A floor alone is as light as before, to a step of eight bits: nothing hides the sky.
#[test]
fn a_floor_sees_all_of_the_sky() {
    let model = folded(Op::Union, vec![block([-4.0, -4.0, -1.0], [4.0, 4.0, 0.0])]);
    let camera = Camera {
        eye: DVec3::new(3.0, -5.0, 1.0),
        target: DVec3::ZERO,
        up: DVec3::Z,
        projection: Projection::Perspective { fov_y: 0.5 },
        depth_range: (0.5, 60.0),
        size: (160, 120),
    };
    let [before, after] = [None, Some(1.0)].map(|r| draw(&model, settings(r), &camera, Style::Clay));
    let mut floor = 0;
    for i in (0..before.colour.len()).filter(|i| before.normal[*i][2] > 0.9) {
        floor += 1;
        let off = before.colour[i].iter().zip(after.colour[i]).map(|(b, a)| b.abs_diff(a)).max().unwrap();
        assert!(off <= 1, "pixel {i}: {:?} to {:?}", before.colour[i], after.colour[i]);
    }
    assert!(floor > 2000, "{floor}");
}

/// Patches, meshes, solids and glass: all images but the colour are the same with and without ambient occlusion, bit
/// for bit, and so are colours of the style zebra, which shows no light. Some shaded pixels get darker, and none gets
/// lighter.
#[test]
fn nothing_but_light_changes() {
    let (mut renderer, mut darker) = (renderer(), 0);
    for (name, model) in shapes::all().into_iter().map(|s| (s.name, s.model)).chain([("glass", in_glass())]) {
        let camera = perspective(&model, (64, 48));
        let radius = (0.2 * model.control_bounds().diagonal()).max(1e-3);
        let zebra = ["cube", "torus", "glass"].contains(&name).then_some(Style::Zebra);
        for style in [Style::Shaded].into_iter().chain(zebra) {
            let [before, after] =
                [None, Some(radius)].map(|r| draw_next(&mut renderer, (&model, settings(r)), &camera, style));
            let same_colour = Picture { colour: before.colour.clone(), stats: before.stats.clone(), ..after.clone() };
            assert_identical(&before, &same_colour, name);
            for (b, a) in before.colour.iter().zip(&after.colour) {
                // lit colours may round differently by a step of eight bits
                let off = if style == Style::Zebra { 0 } else { 1 };
                assert!(
                    (0..3).all(|k| a[k] <= b[k].saturating_add(off)) && a[3].abs_diff(b[3]) <= off,
                    "{name}: {b:?} {a:?}"
                );
                assert!(style == Style::Shaded || a == b, "{name}: {b:?} {a:?}");
                darker += usize::from(a[1].saturating_add(2) < b[1]);
            }
        }
    }
    assert!(darker > 900, "{darker}");
    assert_silent(renderer);
}

/// A scene that measures lengths within solids and has nothing to see through loses as much light as one that does not
/// measure them. There rays are followed, and no layers are drawn over the image behind them.
#[test]
fn scenes_that_measure_thickness_lose_as_much_light() {
    let parts = [block([-1.0, -8.0, -1.0], [0.0, 8.0, 4.0]), block([-1.0, -8.0, -1.0], [8.0, 8.0, 0.0])];
    let model = folded(Op::Union, parts.into());
    let camera = perspective(&model, (96, 72));
    let drawn = |ambient: Option<f64>, thickness: bool| {
        let mut renderer = watched_with(&model, SceneSettings { thickness, ..settings(ambient) });
        let outputs = Outputs { thickness, ..Outputs::ALL };
        let picture = renderer.render(&camera, &FrameSettings::default(), outputs).unwrap();
        assert_silent(renderer);
        picture
    };
    let [before, after, measured] = [drawn(None, false), drawn(Some(2.0), false), drawn(Some(2.0), true)];
    assert!(measured.thickness.iter().any(|length| *length > 0.0));
    let (mut darker, mut other) = (0, 0);
    for ((b, a), m) in before.colour.iter().zip(&after.colour).zip(&measured.colour) {
        darker += usize::from(a[1].saturating_add(4) < b[1]);
        other += usize::from(a[1].abs_diff(m[1]) > 1);
    }
    assert!(darker > 50 && other * 50 < darker, "{darker} pixels are darker, {other} are not so in the other scene");
}

/// Its passes and images exist only in scenes that have ambient occlusion.
#[test]
fn it_exists_where_it_is_wanted() {
    let of_ambient = |ambient| {
        let model = shapes::cube();
        let mut renderer = watched_for(Outputs::default(), &model, settings(ambient));
        renderer.render(&perspective(&model, (64, 48)), &FrameSettings::default(), Outputs::default()).unwrap();
        let objects = renderer.objects();
        assert_silent(renderer);
        objects.iter().filter(|o| o.starts_with("ambient") || *o == "resolved" || *o == "linear_show").count()
    };
    // two passes, the pass that writes the host's colour, and two images
    assert_eq!((of_ambient(None), of_ambient(Some(0.1))), (0, 5));
}

#[test]
fn bad_settings_are_told() {
    let model = shapes::cube();
    let mut renderer = watched_with(&shapes::cube(), SceneSettings::default());
    let mut refused = |scene: SceneSettings| match renderer.upload_with(&model, scene).unwrap_err() {
        HeadlessError::Render(error) => error,
        error => panic!("{error}"),
    };
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(refused(settings(Some(radius))), RenderError::AmbientRadius(_)), "{radius}");
    }
    let four = SceneSettings { samples: Samples::Four, ..settings(Some(1.0)) };
    assert!(matches!(refused(four), RenderError::AmbientSamples));
    assert_silent(renderer);
}
