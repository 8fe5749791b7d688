//! A tessellated sheet drawn by a graphics pipeline: attachments, push constants, times and statistics.

use crate::support::{assert_silent, upload, watched};
use ash::vk;
use selvedge::gpu::{
    Access, Attachment, Binding, Blend, ColourTarget, DepthTest, Device, GraphicsInfo, Image, ImageInfo, Load,
    Pipeline, Pool, ReadBack, Timestamps, barrier,
};

const SIZE: (u32, u32) = (64, 32);
const PIXELS: usize = (SIZE.0 * SIZE.1) as usize;
const LABEL: u32 = 42;

/// Reads a module of `spirv/`, which `tools/shaders` compiles from `glsl/`.
fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect()
}

fn sheet(device: &Device) -> Pipeline {
    let stages = [
        (vk::ShaderStageFlags::VERTEX, words(include_bytes!("spirv/sheet.vert.spv"))),
        (vk::ShaderStageFlags::TESSELLATION_CONTROL, words(include_bytes!("spirv/sheet.tesc.spv"))),
        (vk::ShaderStageFlags::TESSELLATION_EVALUATION, words(include_bytes!("spirv/sheet.tese.spv"))),
        (vk::ShaderStageFlags::FRAGMENT, words(include_bytes!("spirv/sheet.frag.spv"))),
    ];
    let stages: Vec<_> = stages.iter().map(|(stage, words)| (*stage, words.as_slice())).collect();
    let info = GraphicsInfo {
        name: "sheet",
        stages: &stages,
        bindings: &[Binding::Storage],
        push_bytes: 4,
        constants: &[],
        topology: vk::PrimitiveTopology::PATCH_LIST,
        patch_points: 4,
        cull: vk::CullModeFlags::NONE,
        front: vk::FrontFace::COUNTER_CLOCKWISE,
        colour: &[ColourTarget { format: vk::Format::R32_UINT, blend: Blend::Replace }],
        depth: Some(DepthTest { format: vk::Format::D32_SFLOAT, compare: vk::CompareOp::LESS, write: true }),
        stencil: None,
    };
    Pipeline::graphics(device, &info).unwrap()
}

#[test]
fn a_sheet_covers_half_of_the_picture() {
    let watched = watched();
    let device = watched.device();
    let pipeline = sheet(device);
    let label = upload(&watched, "label", &[LABEL]);
    let image = |name, format, usage| {
        let usage = usage | vk::ImageUsageFlags::TRANSFER_SRC;
        Image::new(device, &ImageInfo { name, size: SIZE, format, usage, pool: Pool::Transient }).unwrap()
    };
    let face = image("face", vk::Format::R32_UINT, vk::ImageUsageFlags::COLOR_ATTACHMENT);
    let depth = image("depth", vk::Format::D32_SFLOAT, vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT);
    let faces = ReadBack::new(device, "faces", 4 * PIXELS as u64).unwrap();
    let depths = ReadBack::new(device, "depths", 4 * PIXELS as u64).unwrap();
    let mut times = Timestamps::new(device, 2).unwrap();

    let factor = 8.0f32;
    watched
        .submit(|cmd| {
            times.reset(cmd);
            barrier::buffers(cmd, &[(&label, Access::TRANSFER_WRITE, Access::FRAGMENT_READ)]);
            barrier::images(
                cmd,
                &[(&face, Access::NONE, Access::COLOUR_WRITE), (&depth, Access::NONE, Access::DEPTH_WRITE)],
            );
            let colour = [Attachment { image: &face, load: Load::ColourU32([0; 4]) }];
            let cleared = Some(Attachment { image: &depth, load: Load::Depth(1.0) });
            times.drawing(cmd, "sheet", || {
                cmd.rendering(SIZE, &colour, cleared, || {
                    cmd.bind(&pipeline, &[(&label).into()], bytemuck::bytes_of(&factor));
                    cmd.draw(4, 0, 1);
                });
            });
            times.scope(cmd, "read back", || {
                barrier::images(
                    cmd,
                    &[
                        (&face, Access::COLOUR_WRITE, Access::TRANSFER_READ),
                        (&depth, Access::DEPTH_WRITE, Access::TRANSFER_READ),
                    ],
                );
                faces.record_image(cmd, &face, vk::ImageAspectFlags::COLOR);
                depths.record_image(cmd, &depth, vk::ImageAspectFlags::DEPTH);
            });
        })
        .unwrap();

    // the sheet ends at y = 0, on the edge between two rows of pixels
    let (upper, lower) = (vec![LABEL; PIXELS / 2], vec![0; PIXELS / 2]);
    assert_eq!(faces.values::<u32>(PIXELS), [upper, lower].concat());
    let (near, far) = (vec![0.25f32; PIXELS / 2], vec![1.0; PIXELS / 2]);
    assert_eq!(depths.values::<f32>(PIXELS), [near, far].concat());

    let scopes = times.read().unwrap();
    assert_eq!(scopes.iter().map(|scope| scope.name.as_str()).collect::<Vec<_>>(), ["sheet", "read back"]);
    assert!(scopes[0].gpu_ms > 0.0 && scopes[0].gpu_ms < 10_000.0, "{scopes:?}");
    assert_eq!(scopes[1].statistics, None);
    if let Some(counted) = scopes[0].statistics {
        // equal spacing: factor² quads of two triangles
        assert_eq!((counted.triangles, counted.patches), (2 * 8 * 8, 1), "{counted:?}");
        assert!(counted.fragments >= PIXELS as u64 / 2, "{counted:?}");
    }
    drop((pipeline, label, face, depth, faces, depths, times));
    assert_silent(watched);
}
