//! Draws the engine's picture, with hovered and selected items marked, into the window's image: one triangle.
//!
//! The images of faces and instances give the marked pixels: nothing of the model is drawn again.

use super::ViewError;
use super::context::Context;
use super::made::Made;
use super::targets::{Targets, buffer, free_buffer};
use crate::pick::Mark;
use ash::vk;
use glam::DVec2;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::Allocation;
use selvedge::{ash, gpu_allocator};

/// `shaders/composite.*`, compiled by `tools/shaders`.
const VERTEX: &[u8] = include_bytes!("../../shaders/composite.vert.spv");
const FRAGMENT: &[u8] = include_bytes!("../../shaders/composite.frag.spv");
/// Most marks; further selected items are listed, and not tinted.
pub const MOST_MARKS: usize = 1024;

/// As the shader has it.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Push {
    origin: [f32; 2],
    scale: [f32; 2],
    hovered: u32,
    count: u32,
}

/// A rectangle of the window, pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ViewRect {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
}

impl ViewRect {
    /// The pixel of a picture at a place of the view.
    pub fn pixel(&self, at: DVec2, picture: (u32, u32)) -> (u32, u32) {
        let of = |size: (u32, u32)| DVec2::new(f64::from(size.0), f64::from(size.1));
        let pixel = at * (of(picture) / of((self.width.max(1), self.height.max(1))));
        (pixel.x.max(0.0) as u32, pixel.y.max(0.0) as u32)
    }
}

/// The pass.
pub struct Composite {
    set: vk::DescriptorSetLayout,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
    /// Linear for colour, nearest for numbers.
    samplers: [vk::Sampler; 2],
    marks: (vk::Buffer, Allocation),
    count: u32,
    hovered: bool,
}

impl Composite {
    /// For a window of this format. If that fails, nothing is left of it.
    pub fn new(context: &Context, format: vk::Format) -> Result<Self, ViewError> {
        let device = &context.device;
        let binding = |i: u32, kind| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(i)
                .descriptor_type(kind)
                .descriptor_count(1)
                .stage_flags(vk::ShaderStageFlags::FRAGMENT)
        };
        let sampled = vk::DescriptorType::COMBINED_IMAGE_SAMPLER;
        let bindings = [
            binding(0, sampled),
            binding(1, sampled),
            binding(2, sampled),
            binding(3, vk::DescriptorType::STORAGE_BUFFER),
        ];
        let flags = vk::DescriptorSetLayoutCreateFlags::PUSH_DESCRIPTOR_KHR;
        let create = vk::DescriptorSetLayoutCreateInfo::default().flags(flags).bindings(&bindings);
        let push = [vk::PushConstantRange::default()
            .stage_flags(vk::ShaderStageFlags::FRAGMENT)
            .size(size_of::<Push>() as u32)];
        let sampler = |filter| {
            let edge = vk::SamplerAddressMode::CLAMP_TO_EDGE;
            let create = vk::SamplerCreateInfo::default()
                .mag_filter(filter)
                .min_filter(filter)
                .address_mode_u(edge)
                .address_mode_v(edge)
                .address_mode_w(edge);
            // SAFETY: the device is alive.
            unsafe { device.create_sampler(&create, None) }
        };
        let bytes = (MOST_MARKS * size_of::<Mark>()) as u64;
        let mut made = Made::default();
        // SAFETY: the device is alive; what is made of what outlives the call, and is destroyed after it.
        unsafe {
            let set = device.create_descriptor_set_layout(&create, None)?;
            made.push(device, move |device| device.destroy_descriptor_set_layout(set, None));
            let sets = [set];
            let create = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets).push_constant_ranges(&push);
            let layout = device.create_pipeline_layout(&create, None)?;
            made.push(device, move |device| device.destroy_pipeline_layout(layout, None));
            let pipeline = pipeline(device, layout, format)?;
            made.push(device, move |device| device.destroy_pipeline(pipeline, None));
            let linear = sampler(vk::Filter::LINEAR)?;
            made.push(device, move |device| device.destroy_sampler(linear, None));
            let nearest = sampler(vk::Filter::NEAREST)?;
            made.push(device, move |device| device.destroy_sampler(nearest, None));
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
            let marks = buffer(context, "marks", bytes, usage, MemoryLocation::CpuToGpu)?;
            made.keep();
            Ok(Self { set, layout, pipeline, samplers: [linear, nearest], marks, count: 0, hovered: false })
        }
    }

    /// Sets the marks; no frame is in flight.
    pub fn mark(&mut self, hovered: Option<Mark>, selected: &[Mark]) {
        let all: Vec<Mark> = hovered.into_iter().chain(selected.iter().copied()).take(MOST_MARKS).collect();
        let bytes: &[u8] = bytemuck::cast_slice(&all);
        if let Some(memory) = self.marks.1.mapped_slice_mut() {
            memory[..bytes.len()].copy_from_slice(bytes);
        }
        (self.count, self.hovered) = (all.len() as u32, hovered.is_some());
    }

    /// Draws the picture into `view`, within rendering.
    pub fn record(&self, context: &Context, targets: &Targets, view: ViewRect) {
        let (device, cmd) = (&context.device, context.cmd);
        let viewport = vk::Viewport {
            x: view.x as f32,
            y: view.y as f32,
            width: view.width as f32,
            height: view.height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        let scissor = vk::Rect2D {
            offset: vk::Offset2D { x: view.x as i32, y: view.y as i32 },
            extent: vk::Extent2D { width: view.width, height: view.height },
        };
        let size = targets.size();
        let push = Push {
            origin: [view.x as f32, view.y as f32],
            scale: [size.0 as f32 / view.width as f32, size.1 as f32 / view.height as f32],
            hovered: u32::from(self.hovered),
            count: self.count,
        };
        let [colour, face, instance] = targets.views();
        let [linear, nearest] = self.samplers;
        let image = |view, sampler| {
            [vk::DescriptorImageInfo { sampler, image_view: view, image_layout: vk::ImageLayout::GENERAL }]
        };
        let images = [image(colour, linear), image(face, nearest), image(instance, nearest)];
        let marks = [vk::DescriptorBufferInfo { buffer: self.marks.0, offset: 0, range: vk::WHOLE_SIZE }];
        let mut writes: Vec<_> = (0..)
            .zip(&images)
            .map(|(i, info)| {
                vk::WriteDescriptorSet::default()
                    .dst_binding(i)
                    .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
                    .image_info(info)
            })
            .collect();
        let storage = vk::DescriptorType::STORAGE_BUFFER;
        writes.push(vk::WriteDescriptorSet::default().dst_binding(3).descriptor_type(storage).buffer_info(&marks));
        let point = vk::PipelineBindPoint::GRAPHICS;
        // SAFETY: recording within rendering; all belongs to this device.
        unsafe {
            device.cmd_bind_pipeline(cmd, point, self.pipeline);
            device.cmd_set_viewport(cmd, 0, &[viewport]);
            device.cmd_set_scissor(cmd, 0, &[scissor]);
            context.push_descriptor.cmd_push_descriptor_set(cmd, point, self.layout, 0, &writes);
            let stage = vk::ShaderStageFlags::FRAGMENT;
            device.cmd_push_constants(cmd, self.layout, stage, 0, bytemuck::bytes_of(&push));
            device.cmd_draw(cmd, 3, 1, 0, 0);
        }
    }

    pub fn destroy(self, context: &Context) {
        // SAFETY: the GPU has finished with it.
        unsafe {
            self.samplers.iter().for_each(|s| context.device.destroy_sampler(*s, None));
            context.device.destroy_pipeline(self.pipeline, None);
            context.device.destroy_pipeline_layout(self.layout, None);
            context.device.destroy_descriptor_set_layout(self.set, None);
        }
        free_buffer(context, self.marks);
    }
}

unsafe fn pipeline(
    device: &ash::Device,
    layout: vk::PipelineLayout,
    format: vk::Format,
) -> Result<vk::Pipeline, ViewError> {
    let module = |spirv: &[u8]| {
        let words: Vec<u32> = spirv.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
        // SAFETY: valid SPIR-V, as `tools/shaders` checks.
        unsafe { device.create_shader_module(&vk::ShaderModuleCreateInfo::default().code(&words), None) }
    };
    // destroyed in any case: the pipeline does not need them once it is made
    let mut modules = Made::default();
    let mut stages = Vec::new();
    for (kind, spirv) in [(vk::ShaderStageFlags::VERTEX, VERTEX), (vk::ShaderStageFlags::FRAGMENT, FRAGMENT)] {
        let module = module(spirv)?;
        // SAFETY: the device outlives this function, at whose end no call uses the module.
        modules.push(device, move |device| unsafe { device.destroy_shader_module(module, None) });
        stages.push(vk::PipelineShaderStageCreateInfo::default().stage(kind).module(module).name(c"main"));
    }
    let vertex = vk::PipelineVertexInputStateCreateInfo::default();
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::TRIANGLE_LIST);
    let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
    let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
    let samples = vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(vk::SampleCountFlags::TYPE_1);
    let blends = [vk::PipelineColorBlendAttachmentState::default().color_write_mask(vk::ColorComponentFlags::RGBA)];
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
    let states = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&states);
    let formats = [format];
    let mut rendering = vk::PipelineRenderingCreateInfo::default().color_attachment_formats(&formats);
    let create = vk::GraphicsPipelineCreateInfo::default()
        .stages(&stages)
        .vertex_input_state(&vertex)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&raster)
        .multisample_state(&samples)
        .color_blend_state(&blend)
        .dynamic_state(&dynamic)
        .layout(layout)
        .push_next(&mut rendering);
    // SAFETY: layout and modules belong to this device and outlive the call.
    unsafe {
        let made = device.create_graphics_pipelines(vk::PipelineCache::null(), &[create], None);
        Ok(made.map_err(|(_, error)| error)?[0])
    }
}
