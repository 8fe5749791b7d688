//! Pass `resolve`: the exact surface at each pixel's centre, its normal, and light.
//!
//! ```text
//!   item, (u, v) of the triangle ──Newton──▶ (u, v) whose exact point projects to the pixel's centre
//!                                   │
//!                                   ├──▶ colour, depth into the host's targets
//!                                   └──▶ depth, face, (u, v), normal images, when asked for
//! ```
//!
//! Reads: everything that `Bindings` names. Writes: the targets.

use crate::gpu::{
    Attachment, Binding, Blend, Buffer, ColourTarget, Commands, DepthTest, Device, GpuError, GraphicsInfo, Image,
    Pipeline, Texels,
};
use crate::shaders;
use ash::vk;

/// Formats of the images of depth, face, (u, v) and normal.
pub(crate) const AOV_FORMATS: [vk::Format; 4] =
    [vk::Format::R32_SFLOAT, vk::Format::R32_UINT, vk::Format::R32G32_SFLOAT, vk::Format::R32G32B32A32_SFLOAT];

/// `constant_id` of `SCENE_HAS_RATIONAL`.
const SCENE_HAS_RATIONAL: u32 = 0;
/// `constant_id` of `HAS_AOVS`.
const HAS_AOVS: u32 = 3;

/// The pass.
pub(crate) struct Resolve {
    pipeline: Pipeline,
}

/// Formats that the host draws into.
#[derive(Clone, Copy)]
pub(crate) struct Formats {
    pub colour: vk::Format,
    pub depth: Option<vk::Format>,
    pub aovs: bool,
}

/// Its buffers and image, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub views: &'a Buffer,
    pub face_instances: &'a Buffer,
    pub faces: &'a Buffer,
    pub patches: &'a Buffer,
    pub items: &'a Buffer,
    pub points: &'a Texels,
    pub instances: &'a Buffer,
    pub visibility: &'a Image,
}

impl Resolve {
    pub(crate) fn new(device: &Device, formats: Formats, rational: bool) -> Result<Self, GpuError> {
        let replace = |format| ColourTarget { format, blend: Blend::Replace };
        let mut colour = vec![replace(formats.colour)];
        if formats.aovs {
            colour.extend(AOV_FORMATS.map(replace));
        }
        let mut bindings = [Binding::Storage; 9];
        bindings[6] = Binding::Texels;
        bindings[8] = Binding::StorageImage;
        let weights = if rational { "rational" } else { "polynomial" };
        let pipeline = Pipeline::graphics(
            device,
            &GraphicsInfo {
                name: &format!("resolve ({weights})"),
                stages: &[
                    (vk::ShaderStageFlags::VERTEX, shaders::RESOLVE_VERT),
                    (vk::ShaderStageFlags::FRAGMENT, shaders::RESOLVE_FRAG),
                ],
                bindings: &bindings,
                push_bytes: 0,
                constants: &[(SCENE_HAS_RATIONAL, u32::from(rational)), (HAS_AOVS, u32::from(formats.aovs))],
                topology: vk::PrimitiveTopology::TRIANGLE_LIST,
                patch_points: 0,
                cull: vk::CullModeFlags::NONE,
                front: vk::FrontFace::COUNTER_CLOCKWISE,
                colour: &colour,
                depth: formats.depth.map(|format| DepthTest {
                    format,
                    compare: vk::CompareOp::GREATER_OR_EQUAL,
                    write: true,
                }),
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One triangle over the targets.
    pub(crate) fn record(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        colour: &[Attachment<'_>],
        depth: Option<Attachment<'_>>,
    ) {
        let size = b.visibility.size();
        cmd.rendering(size, colour, depth, || {
            let buffers = [b.frame, b.views, b.face_instances, b.faces, b.patches, b.items].map(Into::into);
            let rest = [b.points.into(), b.instances.into(), b.visibility.into()];
            let resources: Vec<_> = buffers.into_iter().chain(rest).collect();
            cmd.bind(&self.pipeline, &resources, &[]);
            cmd.draw(3, 0, 1);
        });
    }
}
