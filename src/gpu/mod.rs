//! The thin Vulkan layer: typed owners of the engine's Vulkan handles, and nothing else.
//!
//! ```text
//!   the host's VkInstance, VkPhysicalDevice, VkDevice, queue family, allocator
//!        │  Requirements::missing / add_to        what the device must offer
//!        ▼
//!   Device ──▶ Buffer, Image, Sampler, Pipeline, Timestamps        free themselves on drop
//!        │         each in one Pool: persistent │ ring │ transient
//!        ▼
//!   Commands = Device + a command buffer of the host's, recording
//!        bind · dispatch · draw · rendering · barrier::buffers · Uploads · ReadBack
//! ```
//!
//! The device belongs to the host: this layer records into the host's command buffers, and never submits, waits, or
//! destroys a device. It contains no geometry. `unsafe` is confined to this layer (and `headless`, the host for tools
//! and tests), so the passes need none.

#[doc(hidden)]
pub mod barrier;

mod access;
mod budget;
mod buffer;
mod commands;
mod description;
mod device;
mod error;
mod graphics;
mod image;
mod layout;
mod memory;
mod pipeline;
mod push;
mod quirks;
mod read_back;
mod rendering;
mod requirements;
mod texels;
mod timestamps;
mod upload;

// for hosts
pub use access::{Access, ImageAccess};
pub use device::{Device, HostDevice};
pub use error::{BudgetOwner, GpuError, MemoryOwner};
pub use image::Image;
pub use memory::Pool;
pub use quirks::Quirks;
pub use requirements::Requirements;

// for the passes, and tests of this layer
#[doc(hidden)]
pub use {
    buffer::{Buffer, BufferInfo},
    commands::Commands,
    device::LowerLimits,
    graphics::{Blend, ColourTarget, DepthTest, GraphicsInfo, StencilTest},
    image::{ImageInfo, Sampler},
    layout::Binding,
    memory::MemoryLocation,
    pipeline::{ComputeInfo, Pipeline},
    push::Resource,
    read_back::ReadBack,
    rendering::{Attachment, Load},
    texels::{Texel, TexelBuffer},
    timestamps::{ScopeTime, Statistics, Timestamps},
    upload::Uploads,
};

#[cfg(feature = "headless")]
pub(crate) use device::text;
pub(crate) use error::Named;
