//! Push descriptors: the resources of a pass, in binding order, written into the command buffer.

use super::{Binding, Buffer, Commands, Image, Pipeline, Sampler, TexelBuffer};
use ash::vk;

/// The resource at one binding.
#[derive(Clone, Copy, Debug)]
pub enum Resource<'a> {
    /// All of a buffer.
    Buffer(&'a Buffer),
    /// Bytes `first .. first + bytes` of a buffer: `first` is a multiple of
    /// `minStorageBufferOffsetAlignment` (at most 256).
    Range {
        /// The buffer.
        buffer: &'a Buffer,
        /// First byte.
        first: u64,
        /// Size in bytes.
        bytes: u64,
    },
    /// A buffer read through a format.
    TexelBuffer(&'a TexelBuffer),
    /// A storage image in layout `GENERAL`.
    Image(&'a Image),
    /// An image in layout `GENERAL`, with a sampler.
    Sampled(&'a Image, &'a Sampler),
}

impl<'a> From<&'a Buffer> for Resource<'a> {
    fn from(buffer: &'a Buffer) -> Self {
        Self::Buffer(buffer)
    }
}

impl<'a> From<&'a TexelBuffer> for Resource<'a> {
    fn from(texels: &'a TexelBuffer) -> Self {
        Self::TexelBuffer(texels)
    }
}

impl<'a> From<&'a Image> for Resource<'a> {
    fn from(image: &'a Image) -> Self {
        Self::Image(image)
    }
}

/// Vulkan's description of a resource: one of the two, by kind of binding. Texel buffers need neither.
#[derive(Clone, Copy, Default)]
struct Descriptor {
    buffer: vk::DescriptorBufferInfo,
    image: vk::DescriptorImageInfo,
}

impl Descriptor {
    fn of(resource: &Resource<'_>) -> Self {
        let buffer = |buffer: &Buffer, offset, range| Self {
            buffer: vk::DescriptorBufferInfo { buffer: buffer.handle(), offset, range },
            image: vk::DescriptorImageInfo::default(),
        };
        let image = |image: &Image, sampler| Self {
            buffer: vk::DescriptorBufferInfo::default(),
            image: vk::DescriptorImageInfo {
                sampler,
                image_view: image.view(),
                image_layout: vk::ImageLayout::GENERAL,
            },
        };
        match *resource {
            Resource::Buffer(b) => buffer(b, 0, vk::WHOLE_SIZE),
            Resource::Range { buffer: b, first, bytes } => buffer(b, first, bytes),
            Resource::TexelBuffer(_) => Self::default(),
            Resource::Image(i) => image(i, vk::Sampler::null()),
            Resource::Sampled(i, sampler) => image(i, sampler.handle()),
        }
    }
}

/// Pushes the resources of `pipeline` in binding order.
///
/// # Panics
/// If their number or kinds differ from the pipeline's bindings.
pub(crate) fn resources(cmd: &Commands<'_>, pipeline: &Pipeline, resources: &[Resource<'_>]) {
    let bindings = (0u32..).zip(pipeline.bindings()).filter_map(|(i, b)| Some((i, b, b.descriptor_type()?)));
    let bindings: Vec<_> = bindings.collect();
    assert_eq!(resources.len(), bindings.len(), "`{}` takes one resource per binding", pipeline.name());
    if resources.is_empty() {
        return;
    }
    let descriptors: Vec<Descriptor> = resources.iter().map(Descriptor::of).collect();
    let writes: Vec<_> = bindings
        .iter()
        .zip(resources)
        .zip(&descriptors)
        .map(|((&(i, binding, kind), resource), descriptor)| {
            let write = vk::WriteDescriptorSet::default().dst_binding(i).descriptor_type(kind).descriptor_count(1);
            match (binding, resource) {
                (Binding::Storage | Binding::Uniform, Resource::Buffer(_) | Resource::Range { .. }) => {
                    write.buffer_info(std::slice::from_ref(&descriptor.buffer))
                }
                (Binding::StorageImage, Resource::Image(_)) | (Binding::Sampled, Resource::Sampled(..)) => {
                    write.image_info(std::slice::from_ref(&descriptor.image))
                }
                (Binding::TexelBuffer, Resource::TexelBuffer(texels)) => {
                    write.texel_buffer_view(std::slice::from_ref(texels.view()))
                }
                _ => panic!("`{}` has {binding:?} at binding {i}, not {resource:?}", pipeline.name()),
            }
        })
        .collect();
    // SAFETY: recording, as `Commands` promises; the layout has these bindings in set 0.
    unsafe {
        cmd.device().push_descriptor().cmd_push_descriptor_set(
            cmd.raw(),
            pipeline.point(),
            pipeline.layout(),
            0,
            &writes,
        );
    }
}
