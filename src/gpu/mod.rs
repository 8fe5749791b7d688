//! The thin Vulkan layer: typed owners of the engine's Vulkan handles, and nothing else.
//!
//! ```text
//!   the host's VkInstance, VkPhysicalDevice, VkDevice, queue family, allocator
//!        │  Requirements::missing / add_to        what the device must offer
//!        ▼
//!   Device ──▶ Buffer, Image, Sampler, Pipeline, Timestamps        free themselves on drop
//!        │         each in one Pool: persistent │ ring │ transient │ staging, from a MemoryAllocator
//!        ▼
//!   Commands = Device + a command buffer of the host's, recording
//!        bind · dispatch · draw · rendering · barrier::buffers · Uploads · ReadBack
//! ```
//!
//! The device belongs to the host: this layer records into the host's command buffers, and never submits, waits, or
//! destroys a device. It contains no geometry. `unsafe` is confined to this layer, to `renderer`, which a host calls, and
//! to `headless` and the viewer's window, which are hosts: the passes need none.

#[doc(hidden)]
pub mod barrier;

mod access;
mod allocator;
mod budget;
mod buffer;
mod commands;
mod description;
mod device;
mod error;
mod graphics;
mod host;
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
#[cfg(feature = "gpu-allocator")]
pub use allocator::GpuAllocator;
pub use allocator::{Allocation, AllocationError, BlockAllocator, MemoryAllocator, MemoryReport, MemoryRequest};
pub use device::Device;
pub use error::{BudgetOwner, GpuError, MemoryOwner};
pub use host::{HostDevice, RawDevice, load_instance};
pub use image::Image;
pub use memory::{MemoryLocation, Pool};
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
    pipeline::{ComputeInfo, Pipeline},
    push::Resource,
    read_back::ReadBack,
    rendering::{Attachment, Load},
    texels::{Texel, TexelBuffer},
    timestamps::{ScopeTime, Statistics, Timestamps},
    upload::{Staging, Uploads},
};

#[cfg(feature = "headless")]
pub(crate) use device::{SharedPipeline, text};
pub(crate) use error::Named;
#[cfg(feature = "headless")]
pub(crate) use memory::lock;
