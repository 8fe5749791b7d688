//! Pipelines from SPIR-V, a list of bindings and specialisation constants.
//!
//! A driver may need seconds for a pipeline, and successive models mostly need the same ones. So pipelines with equal
//! descriptions share one Vulkan object while one of them exists.
//!
//! ```text
//!   set 0, push descriptors          push constants             specialisation constants
//!   binding 0: bindings[0]           push_bytes, all stages     constants: [(id, bits)], all stages
//!   binding 1: bindings[1] …
//! ```

use super::description::Description;
use super::device::Registration;
use super::layout::{Binding, Layout};
use super::{Device, GpuError, Named};
use ash::vk;
use std::ffi::CStr;
use std::sync::Arc;

/// The parameters of a compute pipeline.
#[derive(Clone, Copy, Debug)]
pub struct ComputeInfo<'a> {
    /// Name in errors, validation messages and [`Device::objects`].
    pub name: &'a str,
    /// SPIR-V with entry point `main`.
    pub spirv: &'a [u32],
    /// The bindings of set 0 in order.
    pub bindings: &'a [Binding],
    /// Size of the push constants; a multiple of 4, at most 128.
    pub push_bytes: u32,
    /// Specialisation constants: `constant_id` and value bits (`f32::to_bits`, `bool as u32`).
    pub constants: &'a [(u32, u32)],
}

/// A pipeline with its layout. The last pipeline that shares a Vulkan object frees it on drop; the GPU must have
/// finished with it before.
#[derive(Debug)]
pub struct Pipeline {
    made: Arc<Made>,
    _registration: Registration,
}

/// The shared objects of pipelines with one description.
#[derive(Debug)]
pub(super) struct Made {
    pub(super) device: Device,
    pub(super) handle: vk::Pipeline,
    pub(super) layout: Layout,
    pub(super) point: vk::PipelineBindPoint,
    pub(super) bindings: Vec<Binding>,
    pub(super) push_bytes: u32,
    pub(super) name: String,
}

pub(super) const ENTRY: &CStr = c"main";

impl Pipeline {
    /// Makes a compute pipeline.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`].
    pub fn compute(device: &Device, info: &ComputeInfo<'_>) -> Result<Self, GpuError> {
        let description = Description::of_compute(info);
        if let Some(made) = device.pipeline(&description) {
            return Ok(Self::sharing(made));
        }
        let stages = vk::ShaderStageFlags::COMPUTE;
        let layout = Layout::new(device, info.name, stages, info.bindings, info.push_bytes)?;
        let module = Module::new(device, info.name, info.spirv)?;
        let constants = Constants::new(info.constants);
        let special = constants.info();
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(stages)
            .module(module.handle)
            .name(ENTRY)
            .specialization_info(&special);
        let create = vk::ComputePipelineCreateInfo::default().stage(stage).layout(layout.pipeline);
        // SAFETY: layout and module belong to this device and outlive the call.
        let make = || unsafe { device.raw().create_compute_pipelines(device.pipeline_cache(), &[create], None) };
        let made = device.timing_pipeline(make);
        let handle = made.map_err(|(_, result)| result).named("vkCreateComputePipelines", info.name)?[0];
        Ok(Self::of_made(
            description,
            Made {
                device: device.clone(),
                handle,
                layout,
                point: vk::PipelineBindPoint::COMPUTE,
                bindings: info.bindings.to_vec(),
                push_bytes: info.push_bytes,
                name: info.name.to_owned(),
            },
        ))
    }

    /// The first pipeline of its description.
    pub(super) fn of_made(description: Description, made: Made) -> Self {
        made.device.set_name(made.handle, &made.name);
        let made = Arc::new(made);
        made.device.share_pipeline(description, &made);
        Self::sharing(made)
    }

    /// Another pipeline of an existing description.
    pub(super) fn sharing(made: Arc<Made>) -> Self {
        Self { _registration: made.device.register(&made.name, 0), made }
    }

    /// The Vulkan pipeline.
    pub fn handle(&self) -> vk::Pipeline {
        self.made.handle
    }

    /// Its layout.
    pub fn layout(&self) -> vk::PipelineLayout {
        self.made.layout.pipeline
    }

    /// Compute or graphics.
    pub fn point(&self) -> vk::PipelineBindPoint {
        self.made.point
    }

    /// The bindings of set 0 in order.
    pub fn bindings(&self) -> &[Binding] {
        &self.made.bindings
    }

    /// Size of the push constants.
    pub fn push_bytes(&self) -> u32 {
        self.made.push_bytes
    }

    /// Stages that see bindings and push constants.
    pub fn stages(&self) -> vk::ShaderStageFlags {
        self.made.layout.stages
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.made.name
    }
}

impl Drop for Made {
    fn drop(&mut self) {
        let Some(device) = self.device.living() else { return };
        // SAFETY: owned here; the GPU has finished with it, as the type's contract says.
        unsafe { device.destroy_pipeline(self.handle, None) }
    }
}

/// Specialisation constants in Vulkan's two arrays.
pub(super) struct Constants {
    entries: Vec<vk::SpecializationMapEntry>,
    data: Vec<u8>,
}

impl Constants {
    pub(super) fn new(constants: &[(u32, u32)]) -> Self {
        let entry = |(i, &(id, _))| vk::SpecializationMapEntry { constant_id: id, offset: 4 * i as u32, size: 4 };
        Self {
            entries: constants.iter().enumerate().map(entry).collect(),
            data: constants.iter().flat_map(|(_, bits)| bits.to_ne_bytes()).collect(),
        }
    }

    pub(super) fn info(&self) -> vk::SpecializationInfo<'_> {
        vk::SpecializationInfo::default().map_entries(&self.entries).data(&self.data)
    }
}

/// A shader module that lives while a pipeline is made.
pub(super) struct Module<'a> {
    pub(super) handle: vk::ShaderModule,
    device: &'a Device,
}

impl<'a> Module<'a> {
    pub(super) fn new(device: &'a Device, name: &str, spirv: &[u32]) -> Result<Self, GpuError> {
        #[cfg(test)]
        let rewritten = device.rewriting().map(|rewrite| rewrite(spirv));
        #[cfg(test)]
        let spirv = rewritten.as_deref().unwrap_or(spirv);
        let create = vk::ShaderModuleCreateInfo::default().code(spirv);
        // SAFETY: the device is alive; the words come from the build's compiler.
        let handle = unsafe { device.raw().create_shader_module(&create, None) }.named("vkCreateShaderModule", name)?;
        Ok(Self { handle, device })
    }
}

impl Drop for Module<'_> {
    fn drop(&mut self) {
        // SAFETY: owned here; pipelines do not need their modules once made.
        unsafe { self.device.raw().destroy_shader_module(self.handle, None) }
    }
}
