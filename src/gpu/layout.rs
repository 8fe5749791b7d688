//! Kinds of bindings of set 0, and the layouts made of them.

use super::{Device, GpuError, Named};
use ash::vk;

/// The kind of resource at a binding of set 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binding {
    /// `buffer` block.
    Storage,
    /// `uniform` block.
    Uniform,
    /// `samplerBuffer`.
    TexelBuffer,
    /// `image2D` and similar.
    StorageImage,
    /// `sampler2D` and similar: image and sampler in one.
    Sampled,
    /// No stage reads it: it takes no resource.
    Unused,
}

impl Binding {
    /// `None` for an unused binding.
    pub(crate) fn descriptor_type(self) -> Option<vk::DescriptorType> {
        Some(match self {
            Self::Unused => return None,
            Self::Storage => vk::DescriptorType::STORAGE_BUFFER,
            Self::Uniform => vk::DescriptorType::UNIFORM_BUFFER,
            Self::TexelBuffer => vk::DescriptorType::UNIFORM_TEXEL_BUFFER,
            Self::StorageImage => vk::DescriptorType::STORAGE_IMAGE,
            Self::Sampled => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
        })
    }
}

/// The layouts of a pipeline.
#[derive(Debug)]
pub(super) struct Layout {
    device: Device,
    set: vk::DescriptorSetLayout,
    pub(super) pipeline: vk::PipelineLayout,
    pub(super) stages: vk::ShaderStageFlags,
}

impl Layout {
    pub(super) fn new(
        device: &Device,
        name: &str,
        stages: vk::ShaderStageFlags,
        bindings: &[Binding],
        push_bytes: u32,
    ) -> Result<Self, GpuError> {
        let bindings: Vec<_> = bindings
            .iter()
            .enumerate()
            .filter_map(|(i, binding)| {
                let layout = vk::DescriptorSetLayoutBinding::default().binding(i as u32);
                Some(layout.descriptor_type(binding.descriptor_type()?).descriptor_count(1).stage_flags(stages))
            })
            .collect();
        let create = vk::DescriptorSetLayoutCreateInfo::default()
            .flags(vk::DescriptorSetLayoutCreateFlags::PUSH_DESCRIPTOR_KHR)
            .bindings(&bindings);
        // SAFETY: the device is alive while `Device` is.
        let set = unsafe { device.raw().create_descriptor_set_layout(&create, None) }
            .named("vkCreateDescriptorSetLayout", name)?;
        // Owned from here on, so that a failure below frees the set layout; destroying null is allowed.
        let mut layout = Self { device: device.clone(), set, pipeline: vk::PipelineLayout::null(), stages };
        let sets = [set];
        let ranges = [vk::PushConstantRange::default().stage_flags(stages).size(push_bytes)];
        let create = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(&sets)
            .push_constant_ranges(if push_bytes > 0 { &ranges } else { &[] });
        // SAFETY: as above.
        layout.pipeline =
            unsafe { device.raw().create_pipeline_layout(&create, None) }.named("vkCreatePipelineLayout", name)?;
        Ok(layout)
    }
}

impl Drop for Layout {
    fn drop(&mut self) {
        let Some(device) = self.device.living() else { return };
        // SAFETY: owned here; what was recorded with it has finished, as `Pipeline` demands.
        unsafe {
            device.destroy_pipeline_layout(self.pipeline, None);
            device.destroy_descriptor_set_layout(self.set, None);
        }
    }
}
