//! The look of pictures: styles and backgrounds.

use crate::layers::in_glass;
use crate::shapes;
use crate::support::{assert_silent, perspective, watched_for, watched_with};
use glam::{DVec2, DVec3};
use selvedge::glam::DAffine3;
use selvedge::headless::HeadlessError;
use selvedge::model::{Camera, GREY, Model, Primitive, Shape, Solid, srgb};
use selvedge::picture::{FrameSettings, Outputs, Picture, Samples, SceneSettings, Smooth, Style};
use selvedge::renderer::RenderError;
use selvedge_check::light::{KEY, clay, curvature_scale};
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
        Style::Clay => Some(clay(n, camera)),
        Style::Zebra => {
            let height = (ray - 2.0 * ray.dot(v) * v).y.clamp(-1.0, 1.0);
            let stripe = (12.0 * height.acos() / PI).fract();
            let is_edge = stripe.min((stripe - 0.5).abs()).min(1.0 - stripe) < 1e-3;
            let light = if stripe < 0.5 { 0.9 * (0.35 + 0.65 * v.z.max(0.0)) } else { 0.02 };
            (!is_edge).then(|| DVec3::splat(light))
        }
        Style::Isophotes => {
            let angle = v.dot(KEY.normalize()).clamp(-1.0, 1.0).acos();
            let band = (18.0 * angle / PI).fract();
            let is_edge = band.min((band - 0.5).abs()).min(1.0 - band) < 1e-3;
            let light = if band < 0.5 { 0.9 } else { 0.02 };
            (!is_edge).then(|| DVec3::splat(light * lean(v)))
        }
        Style::Technical => Some(DVec3::splat(lean(v))),
        _ => None,
    }
}

/// The share of light on a surface that is turned from the viewer.
fn lean(v: DVec3) -> f64 {
    0.7 + 0.3 * v.z.max(0.0)
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
    for &style in Style::ALL[1..].iter().filter(|style| !style.is_curvature()) {
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

/// The torus's principal curvatures at a point, both positive where it bulges, from its own equations.
fn of_torus((major, minor): (f64, f64), point: DVec3) -> (f64, f64) {
    let rho = point.truncate().length();
    let out = (rho - major) / minor; // cosine of the angle about the tube
    (1.0 / minor, out / rho)
}

/// Compares the colours of a picture of curvature with closed forms; `of` returns the principal curvatures of a visible
/// point, positive where the surface bulges towards the eye.
fn check_curvature(name: &str, model: &Model, range: f64, of: impl Fn(DVec3) -> (f64, f64)) {
    let camera = perspective(model, SIZE);
    let mut renderer = watched_with(model, SceneSettings { curvature: true, ..SceneSettings::default() });
    for style in [Style::MeanCurvature, Style::GaussianCurvature] {
        let settings = FrameSettings { style, curvature_range: range, ..FrameSettings::default() };
        let picture = renderer.render(&camera, &settings, Outputs::ALL).unwrap();
        let mut compared = 0;
        let mut shares = (f64::INFINITY, f64::NEG_INFINITY);
        for pixel in (0..picture.face.len()).filter(|i| picture.face[*i] != 0) {
            let (v, _) = facing(&picture, &camera, pixel);
            let (x, y) = (pixel as u32 % SIZE.0, pixel as u32 / SIZE.0);
            let (from, ray) = camera.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
            let (_, _, forward) = camera.axes();
            let point = from + ray * (f64::from(picture.depth[pixel]) / ray.dot(forward));
            let (k1, k2) = of(point);
            let share = match style {
                Style::MeanCurvature => 0.5 * (k1 + k2) / range,
                _ => k1 * k2 / (range * range),
            };
            shares = (shares.0.min(share), shares.1.max(share));
            // a closed part shows its outside, also in a fold's pixel whose ray passes it
            let outside = DVec3::from(picture.normal[pixel].map(f64::from)).dot(ray) <= 0.0;
            let leant = lean(if outside { v } else { -v });
            let light = curvature_scale(share).to_array().map(|c| srgb::decoded(c) * leant);
            for (light, drawn) in light.into_iter().zip(picture.colour[pixel]) {
                // rounding to eight bits; half a step for single precision, whose curvatures are good to a thousandth
                let off = (255.0 * srgb::encoded(light) - f64::from(drawn)).abs();
                assert!(off <= 1.0, "{name}, {style:?}, pixel {pixel}: {drawn} is off by {off}");
            }
            compared += 1;
        }
        assert!(compared > 1500, "{name}, {style:?}: {compared}");
        if name.contains("torus") {
            assert!(shares.1 > shares.0 + 0.2, "{name}, {style:?}: the scale is used: {shares:?}");
        }
    }
    assert_silent(renderer);
}

/// Patches and the sides of Boolean solids show the curvature of closed forms.
#[test]
fn curvature_is_that_of_closed_forms() {
    let (radius, torus) = (shapes::SPHERE_RADIUS, shapes::TORUS_RADII);
    check_curvature("sphere", &shapes::sphere(), 2.0 / radius, |_| (1.0 / radius, 1.0 / radius));
    check_curvature("torus", &shapes::torus(), 1.5 / torus.1, |p| of_torus(torus, p));
    let solid = |shape| {
        let primitive = Primitive { shape, transform: DAffine3::IDENTITY, colour: GREY, id: 7 };
        Model { solids: vec![Solid::of(primitive).unwrap()], ..Model::default() }
    };
    check_curvature("ball", &solid(Shape::Sphere { radius: 3.0 }), 0.5, |_| (1.0 / 3.0, 1.0 / 3.0));
    let (major, minor) = (5.0, 2.0);
    check_curvature("solid torus", &solid(Shape::Torus { major, minor }), 0.6, |p| of_torus((major, minor), p));
    // flat ends, round mantle
    let rod = solid(Shape::Cylinder { radius: 2.0, height: 4.0 });
    check_curvature("rod", &rod, 0.4, |p| if p.truncate().length() > 2.0 - 1e-4 { (0.5, 0.0) } else { (0.0, 0.0) });
}

/// A part stretched along one axis shows the curvature of the stretched surface.
#[test]
fn curvature_is_that_of_the_placed_part() {
    let radius = shapes::SPHERE_RADIUS;
    let mut model = shapes::sphere();
    let stretch = DVec3::new(1.0, 1.0, 1.5);
    model.instances[0].transform = DAffine3::from_scale(stretch);
    let axes = radius * stretch;
    check_curvature("ellipsoid", &model, 3.0 / radius, |p| {
        // of the ellipsoid x²/a² + y²/b² + z²/c² = 1, h the distance of the tangent plane from the middle
        let h = 1.0 / (p / (axes * axes)).length();
        let gaussian = h.powi(4) / (axes.x * axes.y * axes.z).powi(2);
        let mean = h.powi(3) * (axes.dot(axes) - p.dot(p)) / (2.0 * (axes.x * axes.y * axes.z).powi(2));
        let half = (mean * mean - gaussian).max(0.0).sqrt();
        (mean + half, mean - half)
    });
}

/// Curvature needs a scene made for it, and a positive range; otherwise the frame is an error.
#[test]
fn curvature_needs_its_scene_and_a_scale() {
    let model = shapes::torus();
    let camera = perspective(&model, SIZE);
    let mut renderer = watched_with(&model, SceneSettings::default());
    let mean = FrameSettings { style: Style::MeanCurvature, ..FrameSettings::default() };
    let refused = renderer.render(&camera, &mean, Outputs::default()).unwrap_err();
    assert!(matches!(refused, HeadlessError::Render(RenderError::NoCurvature)), "{refused}");
    for curvature_range in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = renderer.render(&camera, &FrameSettings { curvature_range, ..mean }, Outputs::default());
        assert!(matches!(refused, Err(HeadlessError::Render(RenderError::CurvatureRange(_)))), "{curvature_range}");
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
        let mut renderer = watched_for(Outputs::default(), &model, scene);
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
