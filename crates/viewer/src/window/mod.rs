//! The window: events in, frames out. The viewer's `unsafe` Vulkan calls are in this module.
//!
//! ```text
//!   winit ─events─▶ App ─▶ View (camera), Session (what is shown), panels (egui)
//!                    │
//!                    ├─▶ Engine: changes in place, uploads in a thread
//!                    └─▶ Screen: a frame when something has changed; none otherwise
//! ```

mod app;
mod composite;
mod context;
mod engine;
mod events;
mod living;
mod look;
mod made;
mod opening;
mod photograph;
mod screen;
mod selecting;
mod shown;
mod swapchain;
mod targets;
mod tasks;
mod waiter;

use crate::session::Finder;
use selvedge::ash::vk;
use selvedge::gpu::GpuError;
use selvedge::renderer::RenderError;
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::event_loop::EventLoop;

/// How to open the window.
#[derive(Clone, Debug, Default)]
pub struct ViewOptions {
    /// Files to open.
    pub files: Vec<PathBuf>,
    /// A part of the name of the Vulkan device to use.
    pub device: Option<String>,
    /// Turns on the validation layer; [`Closed::messages`] has its messages.
    pub validation: bool,
    /// The file of settings; `None` stores none.
    pub settings: Option<PathBuf>,
    /// The folder of the desktop's settings: less motion, dark or light. `None` reads none of them.
    pub desktop: Option<PathBuf>,
    /// Width and height of the window, points; `None` leaves them to the system.
    pub size: Option<(u32, u32)>,
    /// Finds parts of assemblies in other files; `None`: beside the file that names them.
    pub finder: Option<Finder>,
    /// Failures to imitate; `None` imitates none.
    pub faults: Option<Faults>,
}

/// Imitates failures, for tests.
#[derive(Clone)]
pub struct Faults(
    /// Called before each frame.
    pub Arc<dyn Fn() -> Option<Fault> + Send + Sync>,
);

/// A failure to imitate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The result of the frame's first call. Lack of device memory is that of the picture's images.
    Vulkan(vk::Result),
    /// The system suspends the program while the frame is in flight, and resumes it after this time.
    Suspended(Duration),
}

impl fmt::Debug for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Faults")
    }
}

/// The state after the window is closed.
#[derive(Clone, Debug, Default)]
pub struct Closed {
    /// Messages of the validation layer.
    pub messages: Vec<String>,
}

/// Why there is no window, or no longer one.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewError {
    /// The system's windows.
    #[error("window: {0}")]
    Window(String),
    /// No event loop: no display.
    #[error("no window can be opened: {0}")]
    Loop(#[from] winit::error::EventLoopError),
    /// The Vulkan loader is missing.
    #[error("Vulkan is not installed: {0}")]
    NoLoader(String),
    /// The validation layer is asked for and missing.
    #[error("the validation layer VK_LAYER_KHRONOS_validation is not installed")]
    NoValidation,
    /// No device draws and presents.
    #[error("no Vulkan device can draw to this window: {0}")]
    NoDevice(String),
    /// A call of Vulkan.
    #[error("Vulkan: {0}")]
    Vulkan(#[from] vk::Result),
    /// No memory on the device.
    #[error("device memory: {0}")]
    Memory(String),
    /// The engine.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The engine's Vulkan layer.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The panels.
    #[error("panels: {0}")]
    Panels(#[from] egui_ash_renderer::RendererError),
}

/// Why a frame is incomplete.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The window is shown without a new picture.
    Picture(ViewError),
    /// Nothing is shown.
    Screen(ViewError),
}

impl<E: Into<ViewError>> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Screen(error.into())
    }
}

impl ViewError {
    /// The device is missing, or failed; otherwise the window is.
    pub fn is_of_device(&self) -> bool {
        !matches!(self, Self::Window(_) | Self::Loop(_) | Self::NoValidation)
    }

    /// The device is lost; the host's data suffice to make everything again.
    pub(crate) fn is_device_lost(&self) -> bool {
        match self {
            Self::Vulkan(result) => *result == vk::Result::ERROR_DEVICE_LOST,
            Self::Gpu(error) | Self::Render(RenderError::Gpu(error)) => error.is_device_lost(),
            _ => false,
        }
    }
}

/// Opens a window and returns when it is closed. On Linux any thread may call it, elsewhere the main one.
///
/// # Errors
/// [`ViewError`] where no window or device can be opened, or the device fails for good.
pub fn run(options: ViewOptions) -> Result<Closed, ViewError> {
    let begun = Instant::now();
    let mut builder = EventLoop::with_user_event();
    #[cfg(target_os = "linux")]
    {
        use winit::platform::{wayland::EventLoopBuilderExtWayland, x11::EventLoopBuilderExtX11};
        EventLoopBuilderExtX11::with_any_thread(&mut builder, true);
        EventLoopBuilderExtWayland::with_any_thread(&mut builder, true);
    }
    let events = builder.build()?;
    let mut app = app::App::new(options, events.create_proxy(), begun);
    events.run_app(&mut app)?;
    app.close()
}
