//! The thin Vulkan layer: typed owners for the handles that the engine makes, and nothing else.
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
//! The host keeps its device: this layer records into command buffers that it is given, and never
//! submits, waits, or destroys a device. It knows nothing of geometry. `unsafe` lives here (and in
//! `headless`, which plays the host for tools and tests), so that the passes
//! need none.

pub mod barrier;

mod access;
mod buffer;
mod commands;
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

pub use access::{Access, ImageAccess};
pub use buffer::{Buffer, BufferInfo};
pub use commands::Commands;
pub use device::{Device, HostDevice};
pub use error::GpuError;
pub use graphics::{Blend, ColourTarget, DepthTest, GraphicsInfo, StencilTest};
pub use image::{Image, ImageInfo, Sampler};
pub use layout::Binding;
pub use memory::{Home, Pool};
pub use pipeline::{ComputeInfo, Pipeline};
pub use push::Resource;
pub use quirks::Quirks;
pub use read_back::ReadBack;
pub use rendering::{Attachment, Load};
pub use requirements::Requirements;
pub use texels::{Texel, Texels};
pub use timestamps::{ScopeTime, Statistics, Timestamps};
pub use upload::Uploads;

pub(crate) use error::Named;
