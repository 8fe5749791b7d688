//! Instance, device and targets without a window.

use crate::model::{Camera, Model};
use crate::picture::{FrameSettings, Outputs, Picture};

/// Which device and layers.
#[derive(Clone, Debug, Default)]
pub struct HeadlessOptions {
    /// Part of the device's name; the first suitable one when absent.
    pub device: Option<String>,
    /// Load the validation layer.
    pub validation: bool,
}

/// A renderer with its own device.
#[derive(Debug)]
pub struct HeadlessRenderer;

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)]
pub enum HeadlessError {
    #[error("no suitable Vulkan device")]
    NoDevice,
}

impl HeadlessRenderer {
    /// Opens a device.
    ///
    /// # Errors
    /// [`HeadlessError`].
    pub fn new(_options: &HeadlessOptions) -> Result<Self, HeadlessError> {
        Err(HeadlessError::NoDevice)
    }

    /// Replaces the scene.
    ///
    /// # Errors
    /// [`HeadlessError`].
    pub fn upload(&mut self, _model: &Model) -> Result<(), HeadlessError> {
        Err(HeadlessError::NoDevice)
    }

    /// Draws one picture.
    ///
    /// # Errors
    /// [`HeadlessError`].
    pub fn render(&mut self, _: &Camera, _: &FrameSettings, _: Outputs) -> Result<Picture, HeadlessError> {
        Err(HeadlessError::NoDevice)
    }

    /// Messages of the validation layer.
    pub fn messages(&self) -> Vec<String> {
        Vec::new()
    }
}
