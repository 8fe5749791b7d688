//! Dynamic rendering: attachments, and their contents before and after.

use super::{Access, Image, ImageAccess};
use ash::vk;

/// The contents of an attachment when rendering begins.
#[derive(Clone, Copy)]
pub enum Load {
    /// The previous contents.
    Keep,
    /// Undefined: every pixel that matters will be written.
    Discard,
    /// This colour, per channel.
    ColourF32([f32; 4]),
    /// This colour of an unsigned integer format, per channel.
    ColourU32([u32; 4]),
    /// This depth, and stencil 0.
    Depth(f32),
}

/// An image that is drawn into. Its contents are stored afterwards.
#[derive(Clone, Copy)]
pub struct Attachment<'a> {
    /// In the layout of [`Access::COLOUR_WRITE`] or [`Access::DEPTH_WRITE`].
    pub image: &'a Image,
    /// Its contents before.
    pub load: Load,
}

impl Attachment<'_> {
    /// The same attachment with its contents loaded.
    pub fn again(&self) -> Self {
        Self { load: Load::Keep, ..*self }
    }

    pub(crate) fn info(&self, access: Access) -> vk::RenderingAttachmentInfo<'static> {
        let (load_op, clear) = match self.load {
            Load::Keep => (vk::AttachmentLoadOp::LOAD, vk::ClearValue::default()),
            Load::Discard => (vk::AttachmentLoadOp::DONT_CARE, vk::ClearValue::default()),
            Load::ColourF32(float32) => {
                (vk::AttachmentLoadOp::CLEAR, vk::ClearValue { color: vk::ClearColorValue { float32 } })
            }
            Load::ColourU32(uint32) => {
                (vk::AttachmentLoadOp::CLEAR, vk::ClearValue { color: vk::ClearColorValue { uint32 } })
            }
            Load::Depth(depth) => {
                let depth_stencil = vk::ClearDepthStencilValue { depth, stencil: 0 };
                (vk::AttachmentLoadOp::CLEAR, vk::ClearValue { depth_stencil })
            }
        };
        vk::RenderingAttachmentInfo::default()
            .image_view(self.image.view())
            .image_layout(ImageAccess::from(access).layout)
            .load_op(load_op)
            .store_op(vk::AttachmentStoreOp::STORE)
            .clear_value(clear)
    }
}
