//! A picture in a rectangle of larger targets. The frame is drawn into images of the picture's size, which are then
//! copied.
//!
//! ```text
//!    host's target                    own image                        host's target
//!   ┌─────────────┐   where the host's picture is kept               ┌─────────────┐
//!   │   ┌────┐    │ ────────────────▶ ┌────┐ ─▶ frame ─▶ ┌────┐ ───▶ │   ┌────┐    │
//!   │   └────┘    │     rectangle     └────┘             └────┘      │   └────┘    │
//!   └─────────────┘                                                  └─────────────┘
//! ```
//!
//! The passes are those of a whole target, so the pixels are the same bit for bit. Pixels outside the rectangle are not
//! written. Cost: one copy of the rectangle for each target, two if the host's picture is kept.

use crate::gpu::{Access, Commands, Device, GpuError, Image, ImageAccess, ImageInfo, Pool, barrier};
use ash::vk;

/// A host's target and the image that is drawn into in its place.
pub(crate) type Pair<'a> = (&'a Image, &'a Image);

/// The image that is drawn into in place of one target.
///
/// # Errors
/// See [`Image::new`].
pub(crate) fn image(device: &Device, target: &Image, size: (u32, u32)) -> Result<Image, GpuError> {
    use vk::ImageUsageFlags as Usage;
    let drawn = if is_depth(target) { Usage::DEPTH_STENCIL_ATTACHMENT } else { Usage::COLOR_ATTACHMENT };
    let usage = drawn | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
    let name = format!("viewport of {}", target.name());
    Image::new(device, &ImageInfo { name: &name, size, format: target.format(), usage, pool: Pool::Transient })
}

fn is_depth(image: &Image) -> bool {
    !image.range().aspect_mask.contains(vk::ImageAspectFlags::COLOR)
}

/// The access that draws into the image.
pub(crate) fn drawn(image: &Image) -> Access {
    if is_depth(image) { Access::DEPTH_WRITE } else { Access::COLOUR_WRITE }
}

/// Before the frame: prepares the images for drawing. If the host's picture is kept, copies it into them.
pub(crate) fn begin(cmd: &Commands<'_>, pairs: &[Pair<'_>], corner: (u32, u32), keep: bool) {
    for &(target, own) in pairs {
        let before = Access::TRANSFER_READ.discarded(); // the copy of the frame before
        if !keep {
            barrier::images::<ImageAccess, Access>(cmd, &[(own, before, drawn(own))]);
            continue;
        }
        barrier::images::<ImageAccess, Access>(
            cmd,
            &[(own, before, Access::TRANSFER_WRITE), (target, drawn(target).into(), Access::TRANSFER_READ)],
        );
        cmd.copy_rectangle((target, corner), (own, (0, 0)), own.size());
        barrier::images(
            cmd,
            &[(own, Access::TRANSFER_WRITE, drawn(own)), (target, Access::TRANSFER_READ, drawn(target))],
        );
    }
}

/// After the frame: copies each image into the rectangle of its target.
pub(crate) fn end(cmd: &Commands<'_>, pairs: &[Pair<'_>], corner: (u32, u32)) {
    for &(target, own) in pairs {
        barrier::images(
            cmd,
            &[(own, drawn(own), Access::TRANSFER_READ), (target, drawn(target), Access::TRANSFER_WRITE)],
        );
        cmd.copy_rectangle((own, (0, 0)), (target, corner), own.size());
        barrier::images(cmd, &[(target, Access::TRANSFER_WRITE, drawn(target))]);
    }
}
