//! A watched renderer and the cameras of these tests.

pub use crate::watched::assert_silent;
use crate::watched::renderer;
use glam::DVec3;
use selvedge::headless::HeadlessRenderer;
use selvedge::model::{Camera, Model, Projection};
use selvedge::picture::{FrameSettings, Outputs, Picture, Samples, SceneSettings, Smooth, SolidWay, TrimWay};

/// A renderer under validation and synchronisation validation, with a model.
pub fn watched(model: &Model) -> HeadlessRenderer {
    watched_with(model, SceneSettings::default())
}

/// As [`watched`], with settings of the scene.
pub fn watched_with(model: &Model, settings: SceneSettings) -> HeadlessRenderer {
    let mut renderer = renderer();
    renderer.upload_with(model, settings).unwrap();
    renderer
}

/// As [`watched_with`], for pictures with other images.
pub fn watched_for(outputs: Outputs, model: &Model, settings: SceneSettings) -> HeadlessRenderer {
    let mut renderer = renderer();
    renderer.expect(outputs);
    renderer.upload_with(model, settings).unwrap();
    renderer
}

/// Settings of a scene without effects, with this way to trim.
pub const fn plain(trim: TrimWay) -> SceneSettings {
    SceneSettings {
        trim,
        solids: SolidWay::Events,
        editable: false,
        samples: Samples::One,
        smooth: Smooth::None,
        ambient: None,
        curvature: false,
        thickness: false,
        highlight: None,
        sun: None,
        edges: None,
        solid_budget: None,
    }
}

/// One picture with every image, at the default tolerance.
pub fn render(renderer: &mut HeadlessRenderer, camera: &Camera) -> Picture {
    renderer.render(camera, &FrameSettings::default(), Outputs::ALL).unwrap()
}

/// The same of a model that replaces the renderer's.
pub fn render_next(
    renderer: &mut HeadlessRenderer,
    model: &Model,
    settings: SceneSettings,
    camera: &Camera,
) -> Picture {
    renderer.upload_with(model, settings).unwrap();
    render(renderer, camera)
}

/// The same by a renderer of its own, which has no messages.
pub fn render_with(model: &Model, settings: SceneSettings, camera: &Camera) -> Picture {
    let mut renderer = renderer();
    let picture = render_next(&mut renderer, model, settings, camera);
    assert_silent(renderer);
    picture
}

/// All of the model, from the front, the right and above.
pub fn perspective(model: &Model, size: (u32, u32)) -> Camera {
    Camera::around(model.control_bounds(), DVec3::new(1.0, -1.6, 1.1), DVec3::Z, 35f64.to_radians(), size)
}

/// The same in a parallel view.
pub fn orthographic(model: &Model, size: (u32, u32)) -> Camera {
    let height = model.control_bounds().diagonal().max(1e-9);
    Camera { projection: Projection::Orthographic { height }, ..perspective(model, size) }
}

/// Everything in two pictures agrees bit for bit, except costs.
pub fn assert_identical(a: &Picture, b: &Picture, what: &str) {
    fn bits<const N: usize>(values: &[[f32; N]]) -> Vec<[u32; N]> {
        values.iter().map(|v| v.map(f32::to_bits)).collect()
    }
    assert_eq!(a.size, b.size, "size {what}");
    assert!(a.colour == b.colour, "colour {what}");
    assert!(a.face == b.face, "face {what}");
    let depth = |p: &Picture| p.depth.iter().map(|d| d.to_bits()).collect::<Vec<_>>();
    assert!(depth(a) == depth(b), "depth {what}");
    assert!(bits(&a.uv) == bits(&b.uv), "(u, v) {what}");
    assert!(bits(&a.normal) == bits(&b.normal), "normal {what}");
}
