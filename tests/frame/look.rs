//! The look of pictures: styles and backgrounds.

use crate::layers::in_glass;
use crate::shapes;
use crate::support::{assert_silent, perspective, watched_with};
use glam::{DVec2, DVec3};
use selvedge::model::{Camera, srgb};
use selvedge::picture::{FrameSettings, Outputs, Picture, Samples, SceneSettings, Smooth, Style};
use selvedge_check::light::{Key, studio};
use std::f64::consts::PI;

const SIZE: (u32, u32) = (160, 120);

fn linear(c: u8) -> f64 {
    srgb::decoded(f64::from(c) / 255.0)
}

/// Unit normal in view space, towards the viewer, and the pixel's ray there.
fn facing(picture: &Picture, camera: &Camera, pixel: usize) -> (DVec3, DVec3) {
    let (x, y) = (pixel as u32 % SIZE.0, pixel as u32 / SIZE.0);
    let (_, ray) = camera.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
    let n = DVec3::from(picture.normal[pixel].map(f64::from));
    let n = if n.dot(ray) > 0.0 { -n } else { n };
    let (right, up, forward) = camera.axes();
    let view = |v: DVec3| DVec3::new(right.dot(v), up.dot(v), -forward.dot(v));
    (view(n), view(ray))
}

/// The colour of a style in linear light; `None` if a stripe ends within the rounding of normals.
fn expected(style: Style, v: DVec3, ray: DVec3, n: DVec3, camera: &Camera) -> Option<DVec3> {
    match style {
        Style::Normals => Some((0.5 + 0.5 * v).map(srgb::decoded)),
        Style::Clay => {
            // below the tone curve's shoulder: the highlight is a summand
            let half_way = (DVec3::new(-0.42, 0.57, 0.71) + DVec3::Z).normalize();
            let highlight = 0.10 * v.dot(half_way).max(0.0).powi(48);
            Some(studio(DVec3::new(0.58, 0.52, 0.46), n, camera, Key::Lamp) - highlight)
        }
        Style::Zebra => {
            let height = (ray - 2.0 * ray.dot(v) * v).y.clamp(-1.0, 1.0);
            let stripe = (12.0 * height.acos() / PI).fract();
            let is_edge = stripe.min((stripe - 0.5).abs()).min(1.0 - stripe) < 1e-3;
            let light = if stripe < 0.5 { 0.9 * (0.35 + 0.65 * v.z.max(0.0)) } else { 0.02 };
            (!is_edge).then(|| DVec3::splat(light))
        }
        _ => None,
    }
}

/// Each colour is the style's formula at the normal of the picture's own image; no other image changes.
#[test]
fn a_style_changes_colours_alone() {
    let model = shapes::torus();
    let camera = perspective(&model, SIZE);
    let mut renderer = watched_with(&model, SceneSettings::default());
    let mut draw = |style| {
        let settings = FrameSettings { style, ..FrameSettings::default() };
        renderer.render(&camera, &settings, Outputs::ALL).unwrap()
    };
    let shaded = draw(Style::Shaded);
    for &style in &Style::ALL[1..] {
        let picture = draw(style);
        assert!(picture.depth == shaded.depth && picture.face == shaded.face, "{style:?}");
        assert!(picture.normal == shaded.normal, "{style:?}");
        let mut compared = 0;
        for pixel in (0..picture.face.len()).filter(|i| picture.face[*i] != 0) {
            let (v, ray) = facing(&picture, &camera, pixel);
            let (right, up, forward) = camera.axes();
            let n = right * v.x + up * v.y - forward * v.z;
            let Some(light) = expected(style, v, ray, n, &camera) else { continue };
            let drawn = picture.colour[pixel];
            for (light, drawn) in light.to_array().into_iter().zip(drawn) {
                // rounding to eight bits, and one step for single precision
                let off = (255.0 * srgb::encoded(light) - f64::from(drawn)).abs();
                assert!(off <= 1.5, "{style:?}, pixel {pixel}: {drawn} is off by {off}");
            }
            compared += 1;
        }
        assert!(compared > 2000, "{style:?}: {compared}");
    }
    assert_silent(renderer);
}

/// A picture with an empty background, blended over white in linear light, equals the picture on white.
#[test]
fn what_is_drawn_on_nothing_can_be_laid_over_anything() {
    let samples = |samples| SceneSettings { samples, ..SceneSettings::default() };
    let smooth = SceneSettings { smooth: Smooth::Trims, ..SceneSettings::default() };
    let cases = [
        ("patches", shapes::plate(), SceneSettings::default()),
        ("four samples", shapes::plate(), samples(Samples::Four)),
        ("smooth trims", shapes::plate(), smooth),
        ("glass", in_glass(), SceneSettings::default()),
        ("glass, four samples", in_glass(), samples(Samples::Four)),
    ];
    for (name, model, scene) in cases {
        let camera = perspective(&model, SIZE);
        let mut renderer = watched_with(&model, scene);
        let mut draw = |background| {
            let settings = FrameSettings { background: Some(background), ..FrameSettings::default() };
            renderer.render(&camera, &settings, Outputs::default()).unwrap()
        };
        let (on_white, on_nothing) = (draw([1.0; 4]), draw([0.0; 4]));
        assert!(on_nothing.colour.iter().any(|c| c[3] == 0), "{name}: something is background");
        if scene != SceneSettings::default() || name == "glass" {
            assert!(on_nothing.colour.iter().any(|c| c[3] > 0 && c[3] < 255), "{name}: something is mixed");
        }
        for (pixel, (white, nothing)) in on_white.colour.iter().zip(&on_nothing.colour).enumerate() {
            let opacity = f64::from(nothing[3]) / 255.0;
            for k in 0..3 {
                let laid = opacity * linear(nothing[k]) + 1.0 - opacity;
                // half a step of both colours, of at most 2.28 times as much linear light, and of the opacity
                let off = (laid - linear(white[k])).abs();
                assert!(
                    off <= (2.28 + 0.5) / 255.0,
                    "{name}, pixel {pixel}: {white:?} and {nothing:?} are {off} apart"
                );
            }
        }
        assert_silent(renderer);
    }
}
