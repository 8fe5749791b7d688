//! A renderer that the validation layers watch, for all test crates that draw.

use selvedge::gpu::LowerLimits;
use selvedge::headless::{HeadlessOptions, HeadlessRenderer};
use selvedge::model::Model;
use selvedge::picture::Outputs;
use std::path::Path;

/// A sample of the repository. The test fails if the file is missing.
#[allow(dead_code)] // some test binaries use no samples
pub fn sample(name: &str) -> Model {
    // a packed test binary runs where the source tree does not exist: the environment names the folder
    let root = std::env::var("CARGO_MANIFEST_DIR").unwrap_or_else(|_| env!("CARGO_MANIFEST_DIR").to_owned());
    selvedge_io::import::open(&Path::new(&root).join("samples").join(name)).unwrap().model
}

/// A renderer without a model, under validation and synchronisation validation, for pictures with all images of points.
pub fn renderer() -> HeadlessRenderer {
    limited(LowerLimits::NONE)
}

/// The same on a device with lower limits.
pub fn limited(lower: LowerLimits) -> HeadlessRenderer {
    let options = HeadlessOptions { validation: true, ..Default::default() };
    let renderer = HeadlessRenderer::limited(&options, lower);
    let mut renderer = renderer.unwrap_or_else(|error| panic!("these tests need Vulkan: {error}"));
    renderer.expect(Outputs::ALL);
    renderer
}

/// Ends the renderer; any message of the layers fails the test.
pub fn assert_silent(renderer: HeadlessRenderer) {
    let messages = renderer.shutdown();
    assert!(messages.is_empty(), "validation messages:\n{}", messages.join("\n"));
}
