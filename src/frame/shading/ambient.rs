//! Passes `ambient_find` and `ambient_write`: less of the sky's light reaches points near other surfaces.
//!
//! ```text
//!   resolved ──find──▶ ambient: hidden share of every second pixel ──write──▶ mean within 4 x 4 pixels ──▶ resolved
//! ```
//!
//! `find` reads `frame` and `resolved`, and writes `ambient`. `write` reads `frame`, `ambient` and `resolved`, and
//! writes the colours of `resolved`.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError, Image};
use crate::shaders;
use ash::vk;

/// Hidden share of the sky, and depth.
pub(crate) const AMBIENT_FORMAT: vk::Format = vk::Format::R32G32_SFLOAT;

/// Threads of a workgroup, both ways.
const GROUP: u32 = 8;

/// Both passes.
pub(crate) struct Ambient {
    find: Kernel,
    write: Kernel,
}

/// Its buffer and images.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    /// Linear colour and depth.
    pub resolved: &'a Image,
    pub ambient: &'a Image,
}

impl Ambient {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        Ok(Self {
            find: Kernel::new(device, "ambient find", &shaders::AMBIENT_FIND_COMP, &[])?,
            write: Kernel::new(device, "ambient write", &shaders::AMBIENT_WRITE_COMP, &[])?,
        })
    }

    /// One thread for two pixels of a row. Points farther than `radius`, in model units, hide nothing.
    pub(crate) fn find(&self, cmd: &Commands<'_>, b: &Bindings<'_>, radius: f32) {
        self.find.bind(cmd, &[b.frame.into(), b.resolved.into(), b.ambient.into()], bytemuck::bytes_of(&radius));
        cmd.dispatch_grid(groups(b.resolved, 2));
    }

    /// One thread a pixel.
    pub(crate) fn write(&self, cmd: &Commands<'_>, b: &Bindings<'_>, radius: f32) {
        self.write.bind(cmd, &[b.frame.into(), b.ambient.into(), b.resolved.into()], bytemuck::bytes_of(&radius));
        cmd.dispatch_grid(groups(b.resolved, 1));
    }
}

/// `columns`: of a thread.
fn groups(image: &Image, columns: u32) -> [u32; 3] {
    let (width, height) = image.size();
    [width.div_ceil(columns * GROUP), height.div_ceil(GROUP), 1]
}
