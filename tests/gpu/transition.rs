//! The extent of the tessellator's triangles at a side with more segments than the interior.
//!
//! ```text
//!    ├───────┼───────┤  interior, m segments      u of a triangle's vertices, weighted as at a pixel,
//!    │╲  ╱╲  │  ╱╲  ╱│                            has the variance  mean(u²) - mean(u)²,  at most a
//!    ├──┴──┴─┴─┴──┴──┤  side, n segments          quarter of the square of the triangle's extent
//! ```
//!
//! The bound of `twin::factor` needs extents up to `1 / m`. Vulkan leaves the triangles to the driver (*Tessellation*,
//! "Quad Tessellation"), so this measures the driver.

use crate::support::{assert_silent, watched};
use ash::vk;
use selvedge::gpu::{
    Access, Attachment, Blend, ColourTarget, Device, GraphicsInfo, Image, ImageInfo, Load, Pipeline, Pool, ReadBack,
    barrier,
};
use selvedge::headless::HeadlessDevice;

const SIZE: (u32, u32) = (512, 512);
const PIXELS: usize = (SIZE.0 * SIZE.1) as usize;

fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect()
}

fn pipeline(device: &Device) -> Pipeline {
    let stages = [
        (vk::ShaderStageFlags::VERTEX, words(include_bytes!("spirv/transition.vert.spv"))),
        (vk::ShaderStageFlags::TESSELLATION_CONTROL, words(include_bytes!("spirv/transition.tesc.spv"))),
        (vk::ShaderStageFlags::TESSELLATION_EVALUATION, words(include_bytes!("spirv/transition.tese.spv"))),
        (vk::ShaderStageFlags::FRAGMENT, words(include_bytes!("spirv/transition.frag.spv"))),
    ];
    let stages: Vec<_> = stages.iter().map(|(stage, words)| (*stage, words.as_slice())).collect();
    let info = GraphicsInfo {
        name: "transition",
        stages: &stages,
        bindings: &[],
        push_bytes: 24,
        constants: &[],
        topology: vk::PrimitiveTopology::PATCH_LIST,
        patch_points: 1,
        cull: vk::CullModeFlags::NONE,
        front: vk::FrontFace::COUNTER_CLOCKWISE,
        colour: &[ColourTarget { format: vk::Format::R32G32_SFLOAT, blend: Blend::Replace }],
        depth: None,
        stencil: None,
    };
    Pipeline::graphics(device, &info).unwrap()
}

/// A quad drawn again and again.
struct Probe<'a> {
    watched: &'a HeadlessDevice,
    pipeline: Pipeline,
    image: Image,
    back: ReadBack,
}

impl<'a> Probe<'a> {
    fn new(watched: &'a HeadlessDevice) -> Self {
        let device = watched.device();
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
        let format = vk::Format::R32G32_SFLOAT;
        let info = ImageInfo { name: "variance", size: SIZE, format, usage, pool: Pool::Transient };
        let image = Image::new(device, &info).unwrap();
        let back = ReadBack::new(device, "variances", 8 * PIXELS as u64).unwrap();
        Self { watched, pipeline: pipeline(device), image, back }
    }

    /// The largest extents along u and v in cells of the interior, squared, of a quad of `m` x `m` cells
    /// whose sides v = 0 and u = 1 have `n` segments.
    fn reach(&self, m: u32, n: u32) -> f32 {
        let [m, n] = [m, n].map(|x| x as f32);
        let sides_and_interior = [m, n, n, m, m, m];
        self.watched
            .submit(|cmd| {
                let (written, read) = (Access::COLOUR_WRITE, Access::TRANSFER_READ);
                barrier::images(cmd, &[(&self.image, read.discarded(), written)]);
                let colour = [Attachment { image: &self.image, load: Load::ColourF32([0.0; 4]) }];
                cmd.rendering(SIZE, &colour, None, || {
                    cmd.bind(&self.pipeline, &[], bytemuck::cast_slice(&sides_and_interior));
                    cmd.draw(1, 0, 1);
                });
                barrier::images(cmd, &[(&self.image, written, read)]);
                self.back.record_image(cmd, &self.image, vk::ImageAspectFlags::COLOR);
            })
            .unwrap();
        let variances = self.back.values::<[f32; 2]>(PIXELS);
        4.0 * m * m * variances.as_flattened().iter().copied().fold(0.0, f32::max)
    }
}

#[test]
fn powers_of_two_are_joined_within_a_cell() {
    let watched = watched();
    let probe = Probe::new(&watched);
    // variances of a 64th of the domain are small differences of squares near 1
    const ROUNDING: f32 = 64.0 * 64.0 * 4.0 * f32::EPSILON;
    for m in (0..=6).map(|k| 1 << k) {
        for n in (0..=6).map(|k| 1 << k).filter(|&n| n >= m) {
            let reach = probe.reach(m, n);
            assert!(reach > 0.9 && reach <= 1.0 + ROUNDING, "{m} cells, {n} segments: {reach}");
        }
    }
    // the reason for powers of two; it also shows that the probe reports larger extents
    if watched.device().driver().contains("llvmpipe") {
        for (m, n) in [(6, 9), (13, 16), (48, 64)] {
            assert!(probe.reach(m, n) > 2.0, "{m} cells, {n} segments");
        }
    }
    drop(probe);
    assert_silent(watched);
}
