//! Graphics pipelines, with or without tessellation.
//!
//! They draw without vertex buffers: shaders fetch vertices by index. Viewport and scissor are dynamic; attachments are
//! given by format (dynamic rendering).

use super::description::Description;
use super::layout::{Binding, Layout};
use super::pipeline::{Constants, ENTRY, Made, Module};
use super::{Device, GpuError, Named, Pipeline};
use ash::vk;

/// The parameters of a graphics pipeline.
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
    /// The primitive of the vertices: `PATCH_LIST` with tessellation stages.
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
    /// Stencil attachment.
    pub stencil: Option<StencilTest>,
}

/// A colour attachment of a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColourTarget {
    /// Its format.
    pub format: vk::Format,
    /// The combination of a fragment's colour with the attachment's.
    pub blend: Blend,
}

/// The combination of a fragment's colour with the attachment's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blend {
    /// The fragment's colour replaces the target's.
    Replace,
    /// `source + (1 - source alpha) target`, for colours already multiplied by their opacity.
    Over,
    /// `source + target`.
    Add,
    /// The target stays as it is.
    Leave,
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

/// Stencil test of a pipeline, the same for both sides of faces. A fragment passes if the stored bits under the compare
/// mask equal those of the reference; [`Commands::stencil`] sets both masks and the reference.
///
/// [`Commands::stencil`]: super::Commands::stencil
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StencilTest {
    /// Format of the attachment.
    pub format: vk::Format,
    /// The operation of passing fragments on the bits under the write mask; failing fragments change nothing.
    pub pass: vk::StencilOp,
}

impl StencilTest {
    fn state(self) -> vk::StencilOpState {
        vk::StencilOpState::default()
            .compare_op(vk::CompareOp::EQUAL)
            .pass_op(self.pass)
            .fail_op(vk::StencilOp::KEEP)
            .depth_fail_op(vk::StencilOp::KEEP)
    }
}

impl Pipeline {
    /// Makes a graphics pipeline.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`].
    pub fn graphics(device: &Device, info: &GraphicsInfo<'_>) -> Result<Self, GpuError> {
        let description = Description::of_graphics(info);
        if let Some(made) = device.pipeline(&description) {
            return Ok(Self::sharing(made));
        }
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
        let mut tests = vk::PipelineDepthStencilStateCreateInfo::default();
        if let Some(depth) = info.depth {
            tests = tests.depth_test_enable(true).depth_write_enable(depth.write).depth_compare_op(depth.compare);
        }
        if let Some(stencil) = info.stencil {
            tests = tests.stencil_test_enable(true).front(stencil.state()).back(stencil.state());
        }
        let blends: Vec<_> = info.colour.iter().map(|target| target.blend.state()).collect();
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let mut states = vec![vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        if info.stencil.is_some() {
            states.extend([
                vk::DynamicState::STENCIL_REFERENCE,
                vk::DynamicState::STENCIL_COMPARE_MASK,
                vk::DynamicState::STENCIL_WRITE_MASK,
            ]);
        }
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&states);
        let formats: Vec<_> = info.colour.iter().map(|target| target.format).collect();
        let mut rendering = vk::PipelineRenderingCreateInfo::default()
            .color_attachment_formats(&formats)
            .depth_attachment_format(info.depth.map_or(vk::Format::UNDEFINED, |depth| depth.format))
            .stencil_attachment_format(info.stencil.map_or(vk::Format::UNDEFINED, |stencil| stencil.format));
        let mut create = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&vertex_input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .depth_stencil_state(&tests)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(layout.pipeline)
            .push_next(&mut rendering);
        if info.patch_points > 0 {
            create = create.tessellation_state(&tessellation);
        }
        // SAFETY: layout and modules belong to this device and outlive the call.
        let make = || unsafe { device.raw().create_graphics_pipelines(device.pipeline_cache(), &[create], None) };
        let made = device.timing_pipeline(make);
        let handle = made.map_err(|(_, result)| result).named("vkCreateGraphicsPipelines", info.name)?[0];
        Ok(Self::of_made(
            description,
            Made {
                device: device.clone(),
                handle,
                layout,
                point: vk::PipelineBindPoint::GRAPHICS,
                bindings: info.bindings.to_vec(),
                push_bytes: info.push_bytes,
                name: info.name.to_owned(),
            },
        ))
    }
}

impl Blend {
    fn state(self) -> vk::PipelineColorBlendAttachmentState {
        let state = vk::PipelineColorBlendAttachmentState::default().color_write_mask(vk::ColorComponentFlags::RGBA);
        let target = match self {
            Self::Replace => return state,
            Self::Leave => return state.color_write_mask(vk::ColorComponentFlags::empty()),
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
