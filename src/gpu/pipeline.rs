//! Compute and graphics pipelines from SPIR-V, a list of bindings and named constants.
//!
//! ```text
//!   set 0, push descriptors          push constants             specialisation constants
//!   binding 0: bindings[0]           push_bytes, all stages     constants: [(id, bits)], all stages
//!   binding 1: bindings[1] …
//! ```
//!
//! Graphics pipelines draw without vertex buffers: shaders fetch what they need by index. Viewport
//! and scissor are dynamic; attachments are named by format (dynamic rendering).

use super::device::Registration;
use super::{Device, GpuError, Named};
use ash::vk;
use std::ffi::CStr;

/// What a shader finds at a binding of set 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binding {
    /// `buffer` block.
    Storage,
    /// `uniform` block.
    Uniform,
    /// `image2D` and its kin.
    StorageImage,
    /// `sampler2D` and its kin: image and sampler in one.
    Sampled,
}

impl Binding {
    pub(crate) fn descriptor_type(self) -> vk::DescriptorType {
        match self {
            Self::Storage => vk::DescriptorType::STORAGE_BUFFER,
            Self::Uniform => vk::DescriptorType::UNIFORM_BUFFER,
            Self::StorageImage => vk::DescriptorType::STORAGE_IMAGE,
            Self::Sampled => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
        }
    }
}

/// What a compute pipeline is made from.
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

/// What a graphics pipeline is made from.
#[derive(Clone, Copy, Debug)]
pub struct GraphicsInfo<'a> {
    /// Name in errors, validation messages and [`Device::objects`].
    pub name: &'a str,
    /// SPIR-V of each stage, entry point `main`.
    pub stages: &'a [(vk::ShaderStageFlags, &'a [u32])],
    /// The bindings of set 0 in order, seen by every stage.
    pub bindings: &'a [Binding],
    /// Size of the push constants; a multiple of 4, at most 128.
    pub push_bytes: u32,
    /// Specialisation constants, given to every stage: `constant_id` and value bits.
    pub constants: &'a [(u32, u32)],
    /// What vertices form: `PATCH_LIST` with tessellation stages.
    pub topology: vk::PrimitiveTopology,
    /// Vertices of a patch; 0 without tessellation.
    pub patch_points: u32,
    /// Faces not drawn.
    pub cull: vk::CullModeFlags,
    /// Winding of front faces, in framebuffer coordinates (y down).
    pub front: vk::FrontFace,
    /// Colour attachments in `location` order.
    pub colour: &'a [ColourTarget],
    /// Depth attachment.
    pub depth: Option<DepthTest>,
}

/// A colour attachment of a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColourTarget {
    /// Its format.
    pub format: vk::Format,
    /// How what is drawn meets what is there.
    pub blend: Blend,
}

/// How a fragment's colour meets the attachment's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blend {
    /// It replaces it.
    Replace,
    /// `source + (1 - source alpha) target`, for colours already multiplied by their opacity.
    Over,
    /// `source + target`.
    Add,
}

/// Depth test of a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthTest {
    /// Format of the attachment.
    pub format: vk::Format,
    /// A fragment passes when `its depth (compare) stored depth`.
    pub compare: vk::CompareOp,
    /// Passing fragments store their depth.
    pub write: bool,
}

/// A pipeline with its layout; frees them on drop. The GPU must have finished with it by then.
#[derive(Debug)]
pub struct Pipeline {
    handle: vk::Pipeline,
    layout: Layout,
    point: vk::PipelineBindPoint,
    bindings: Vec<Binding>,
    push_bytes: u32,
    name: String,
    registration: Registration,
}

const ENTRY: &CStr = c"main";

impl Pipeline {
    /// Makes a compute pipeline.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`].
    pub fn compute(device: &Device, info: &ComputeInfo<'_>) -> Result<Self, GpuError> {
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
        let made = unsafe { device.raw().create_compute_pipelines(vk::PipelineCache::null(), &[create], None) };
        let handle = made.map_err(|(_, result)| result).named("vkCreateComputePipelines", info.name)?[0];
        Ok(Self::own(device, handle, layout, vk::PipelineBindPoint::COMPUTE, info.bindings, info.push_bytes, info.name))
    }

    /// Makes a graphics pipeline.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`].
    pub fn graphics(device: &Device, info: &GraphicsInfo<'_>) -> Result<Self, GpuError> {
        let all_stages = info.stages.iter().fold(vk::ShaderStageFlags::empty(), |all, (stage, _)| all | *stage);
        let layout = Layout::new(device, info.name, all_stages, info.bindings, info.push_bytes)?;
        let modules = info
            .stages
            .iter()
            .map(|(stage, spirv)| Ok((*stage, Module::new(device, info.name, spirv)?)))
            .collect::<Result<Vec<_>, GpuError>>()?;
        let constants = Constants::new(info.constants);
        let special = constants.info();
        let stages: Vec<_> = modules
            .iter()
            .map(|(stage, module)| {
                vk::PipelineShaderStageCreateInfo::default()
                    .stage(*stage)
                    .module(module.handle)
                    .name(ENTRY)
                    .specialization_info(&special)
            })
            .collect();

        let vertex_input = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(info.topology);
        let tessellation = vk::PipelineTessellationStateCreateInfo::default().patch_control_points(info.patch_points);
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let raster = vk::PipelineRasterizationStateCreateInfo::default()
            .polygon_mode(vk::PolygonMode::FILL)
            .cull_mode(info.cull)
            .front_face(info.front)
            .line_width(1.0);
        let samples =
            vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let depth = info.depth.map_or_else(vk::PipelineDepthStencilStateCreateInfo::default, |depth| {
            vk::PipelineDepthStencilStateCreateInfo::default()
                .depth_test_enable(true)
                .depth_write_enable(depth.write)
                .depth_compare_op(depth.compare)
        });
        let blends: Vec<_> = info.colour.iter().map(|target| target.blend.state()).collect();
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let dynamic = vk::PipelineDynamicStateCreateInfo::default()
            .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
        let formats: Vec<_> = info.colour.iter().map(|target| target.format).collect();
        let mut rendering = vk::PipelineRenderingCreateInfo::default()
            .color_attachment_formats(&formats)
            .depth_attachment_format(info.depth.map_or(vk::Format::UNDEFINED, |depth| depth.format));
        let mut create = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&vertex_input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(layout.pipeline)
            .push_next(&mut rendering);
        if info.patch_points > 0 {
            create = create.tessellation_state(&tessellation);
        }
        // SAFETY: layout and modules belong to this device and outlive the call.
        let made = unsafe { device.raw().create_graphics_pipelines(vk::PipelineCache::null(), &[create], None) };
        let handle = made.map_err(|(_, result)| result).named("vkCreateGraphicsPipelines", info.name)?[0];
        Ok(Self::own(
            device,
            handle,
            layout,
            vk::PipelineBindPoint::GRAPHICS,
            info.bindings,
            info.push_bytes,
            info.name,
        ))
    }

    fn own(
        device: &Device,
        handle: vk::Pipeline,
        layout: Layout,
        point: vk::PipelineBindPoint,
        bindings: &[Binding],
        push_bytes: u32,
        name: &str,
    ) -> Self {
        device.set_name(handle, name);
        let registration = device.register(name);
        Self { handle, layout, point, bindings: bindings.to_vec(), push_bytes, name: name.to_owned(), registration }
    }

    /// The Vulkan pipeline.
    pub fn handle(&self) -> vk::Pipeline {
        self.handle
    }

    /// Its layout.
    pub fn layout(&self) -> vk::PipelineLayout {
        self.layout.pipeline
    }

    /// Compute or graphics.
    pub fn point(&self) -> vk::PipelineBindPoint {
        self.point
    }

    /// The bindings of set 0 in order.
    pub fn bindings(&self) -> &[Binding] {
        &self.bindings
    }

    /// Size of the push constants.
    pub fn push_bytes(&self) -> u32 {
        self.push_bytes
    }

    /// Stages that see bindings and push constants.
    pub fn stages(&self) -> vk::ShaderStageFlags {
        self.layout.stages
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }
}

impl Drop for Pipeline {
    fn drop(&mut self) {
        // SAFETY: owned here; the GPU has finished with it, as the type's contract says.
        unsafe { self.registration.device().raw().destroy_pipeline(self.handle, None) }
    }
}

impl Blend {
    fn state(self) -> vk::PipelineColorBlendAttachmentState {
        let state = vk::PipelineColorBlendAttachmentState::default().color_write_mask(vk::ColorComponentFlags::RGBA);
        let target = match self {
            Self::Replace => return state,
            Self::Over => vk::BlendFactor::ONE_MINUS_SRC_ALPHA,
            Self::Add => vk::BlendFactor::ONE,
        };
        state
            .blend_enable(true)
            .src_color_blend_factor(vk::BlendFactor::ONE)
            .dst_color_blend_factor(target)
            .src_alpha_blend_factor(vk::BlendFactor::ONE)
            .dst_alpha_blend_factor(target)
    }
}

/// Specialisation constants in Vulkan's two arrays.
struct Constants {
    entries: Vec<vk::SpecializationMapEntry>,
    data: Vec<u8>,
}

impl Constants {
    fn new(constants: &[(u32, u32)]) -> Self {
        let entry = |(i, &(id, _))| vk::SpecializationMapEntry { constant_id: id, offset: 4 * i as u32, size: 4 };
        Self {
            entries: constants.iter().enumerate().map(entry).collect(),
            data: constants.iter().flat_map(|(_, bits)| bits.to_ne_bytes()).collect(),
        }
    }

    fn info(&self) -> vk::SpecializationInfo<'_> {
        vk::SpecializationInfo::default().map_entries(&self.entries).data(&self.data)
    }
}

/// A shader module that lives while a pipeline is made.
struct Module<'a> {
    handle: vk::ShaderModule,
    device: &'a Device,
}

impl<'a> Module<'a> {
    fn new(device: &'a Device, name: &str, spirv: &[u32]) -> Result<Self, GpuError> {
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

/// The layouts of a pipeline.
#[derive(Debug)]
struct Layout {
    device: Device,
    set: vk::DescriptorSetLayout,
    pipeline: vk::PipelineLayout,
    stages: vk::ShaderStageFlags,
}

impl Layout {
    fn new(
        device: &Device,
        name: &str,
        stages: vk::ShaderStageFlags,
        bindings: &[Binding],
        push_bytes: u32,
    ) -> Result<Self, GpuError> {
        let bindings: Vec<_> = bindings
            .iter()
            .enumerate()
            .map(|(i, binding)| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(i as u32)
                    .descriptor_type(binding.descriptor_type())
                    .descriptor_count(1)
                    .stage_flags(stages)
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
        // SAFETY: owned here; what was recorded with it has finished, as `Pipeline` demands.
        unsafe {
            self.device.raw().destroy_pipeline_layout(self.pipeline, None);
            self.device.raw().destroy_descriptor_set_layout(self.set, None);
        }
    }
}
