//! A renderer that the validation layers watch, for all test crates that draw.

use selvedge::gpu::LowerLimits;
use selvedge::headless::{HeadlessOptions, HeadlessRenderer};

/// A renderer without a model, under validation and synchronisation validation.
pub fn renderer() -> HeadlessRenderer {
    limited(LowerLimits::NONE)
}

/// The same on a device with lower limits.
pub fn limited(lower: LowerLimits) -> HeadlessRenderer {
    let options = HeadlessOptions { device: None, validation: true };
    HeadlessRenderer::limited(&options, lower).unwrap_or_else(|error| panic!("these tests need Vulkan: {error}"))
}

/// Ends the renderer; any message of the layers fails the test.
pub fn assert_silent(renderer: HeadlessRenderer) {
    let messages = renderer.shutdown();
    assert!(messages.is_empty(), "validation messages:\n{}", messages.join("\n"));
}
