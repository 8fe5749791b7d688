//! One-line barriers: a resource, its access before and its access after.
//!
//! ```text
//!   barrier::buffers(cmd, &[(&counts, Access::COMPUTE_WRITE, Access::COMPUTE_READ)]);
//!   barrier::images(cmd, &[(&depth, Access::NONE, Access::DEPTH_WRITE)]);
//! ```

use super::{Access, Buffer, Commands, Image, ImageAccess};
use ash::vk;

/// Orders accesses to whole buffers.
pub fn buffers(cmd: &Commands<'_>, barriers: &[(&Buffer, Access, Access)]) {
    let barriers: Vec<_> = barriers
        .iter()
        .map(|(buffer, before, after)| {
            vk::BufferMemoryBarrier2::default()
                .src_stage_mask(before.stages)
                .src_access_mask(before.mask)
                .dst_stage_mask(after.stages)
                .dst_access_mask(after.mask)
                .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .buffer(buffer.handle())
                .size(vk::WHOLE_SIZE)
        })
        .collect();
    cmd.pipeline_barrier(&vk::DependencyInfo::default().buffer_memory_barriers(&barriers));
}

/// Orders accesses to images and moves them from the first access's layout to the second's.
pub fn images<Before, After>(cmd: &Commands<'_>, barriers: &[(&Image, Before, After)])
where
    Before: Into<ImageAccess> + Copy,
    After: Into<ImageAccess> + Copy,
{
    let barriers: Vec<_> = barriers
        .iter()
        .map(|(image, before, after)| {
            let (before, after): (ImageAccess, ImageAccess) = ((*before).into(), (*after).into());
            vk::ImageMemoryBarrier2::default()
                .src_stage_mask(before.access.stages)
                .src_access_mask(before.access.mask)
                .dst_stage_mask(after.access.stages)
                .dst_access_mask(after.access.mask)
                .old_layout(before.layout)
                .new_layout(after.layout)
                .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .image(image.handle())
                .subresource_range(image.range())
        })
        .collect();
    cmd.pipeline_barrier(&vk::DependencyInfo::default().image_memory_barriers(&barriers));
}

/// Orders accesses to all buffers at once.
pub fn memory(cmd: &Commands<'_>, before: Access, after: Access) {
    let barriers = [vk::MemoryBarrier2::default()
        .src_stage_mask(before.stages)
        .src_access_mask(before.mask)
        .dst_stage_mask(after.stages)
        .dst_access_mask(after.mask)];
    cmd.pipeline_barrier(&vk::DependencyInfo::default().memory_barriers(&barriers));
}
