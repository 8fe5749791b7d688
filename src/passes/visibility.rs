//! Pass `visibility`: hardware tessellation of the sub-patches, and the trim test per pixel.
//!
//! ```text
//!   sub-patch ──tesc──▶ levels ──tese──▶ exact surface at the vertices ──▶ triangles
//!        plain    frag  ──────────────────────────────▶ item, (u, v)   depth
//!        trimmed  frag  row of the trim table, search ▶ item, (u, v)   depth, rings apart
//! ```
//!
//! Reads: everything that `Bindings` names but the images. Writes: the visibility image and depth
//! (reversed: 1 at the near plane), which begin cleared or with what is no patch; `rings`, cleared before.

use crate::abi::Counters;
use crate::gpu::{
    Attachment, Binding, Blend, Buffer, ColourTarget, Commands, DepthTest, Device, GpuError, GraphicsInfo, Pipeline,
    Texels,
};
use crate::shaders;
use ash::vk;
use std::mem::offset_of;

/// Format of the visibility image: item + 1, and (u, v) of its patch as two 16-bit numbers.
pub(crate) const VISIBILITY_FORMAT: vk::Format = vk::Format::R32G32_UINT;
/// Format of the pass's own depth image.
pub(crate) const DEPTH_FORMAT: vk::Format = vk::Format::D32_SFLOAT;

/// `constant_id` of `SCENE_HAS_RATIONAL`.
const SCENE_HAS_RATIONAL: u32 = 0;
/// `constant_id` of `TRIMMED`.
const TRIMMED: u32 = 2;

/// The pass: a pipeline for each kind of patch that the scene has.
pub(crate) struct Visibility {
    plain: Option<Pipeline>,
    trimmed: Option<Pipeline>,
}

/// What the scene asks of the pass.
#[derive(Clone, Copy)]
pub(crate) struct Kinds {
    pub rational: bool,
    pub plain: bool,
    pub trimmed: bool,
}

/// Its buffers, in binding order; the trim table only where the scene has one.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub views: &'a Buffer,
    pub face_instances: &'a Buffer,
    pub faces: &'a Buffer,
    pub patches: &'a Buffer,
    pub items: &'a Buffer,
    pub points: &'a Texels,
    pub factors: &'a Buffer,
    pub sub_patches: &'a Buffer,
    pub instances: &'a Buffer,
    pub table: Option<Table<'a>>,
    pub draws: &'a Buffer,
    pub counters: &'a Buffer,
}

/// The trim table, and where rings are found.
pub(crate) struct Table<'a> {
    pub line_starts: &'a Buffer,
    pub row_starts: &'a Buffer,
    pub row_counts: &'a Buffer,
    pub flips: &'a Buffer,
    pub rings: &'a Buffer,
}

impl Visibility {
    pub(crate) fn new(device: &Device, kinds: Kinds) -> Result<Self, GpuError> {
        let pipeline = |trimmed: bool| {
            let fragment = if trimmed { shaders::VISIBILITY_TRIMMED_FRAG } else { shaders::VISIBILITY_FRAG };
            let kind = if trimmed { "trimmed" } else { "plain" };
            let weights = if kinds.rational { "rational" } else { "polynomial" };
            Pipeline::graphics(
                device,
                &GraphicsInfo {
                    name: &format!("visibility ({kind}, {weights})"),
                    stages: &[
                        (vk::ShaderStageFlags::VERTEX, shaders::VISIBILITY_VERT),
                        (vk::ShaderStageFlags::TESSELLATION_CONTROL, shaders::VISIBILITY_TESC),
                        (vk::ShaderStageFlags::TESSELLATION_EVALUATION, shaders::VISIBILITY_TESE),
                        (vk::ShaderStageFlags::FRAGMENT, fragment),
                    ],
                    bindings: &bindings(trimmed),
                    push_bytes: 0,
                    constants: &[(SCENE_HAS_RATIONAL, u32::from(kinds.rational)), (TRIMMED, u32::from(trimmed))],
                    topology: vk::PrimitiveTopology::PATCH_LIST,
                    patch_points: 1,
                    cull: vk::CullModeFlags::NONE,
                    front: vk::FrontFace::COUNTER_CLOCKWISE,
                    colour: &[ColourTarget { format: VISIBILITY_FORMAT, blend: Blend::Replace }],
                    depth: Some(DepthTest { format: DEPTH_FORMAT, compare: vk::CompareOp::GREATER, write: true }),
                },
            )
        };
        Ok(Self {
            plain: kinds.plain.then(|| pipeline(false)).transpose()?,
            trimmed: kinds.trimmed.then(|| pipeline(true)).transpose()?,
        })
    }

    /// Draws both lists; `draw_capacity` draws of each lie in `draws`, plain first.
    pub(crate) fn record(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        (visibility, depth): (Attachment<'_>, Attachment<'_>),
        draw_capacity: u32,
    ) {
        let bytes = u64::from(draw_capacity) * size_of::<vk::DrawIndirectCommand>() as u64;
        let shared = [b.frame, b.views, b.face_instances, b.faces, b.patches, b.items];
        let lists = [b.factors, b.sub_patches, b.instances];
        let shared = || shared.into_iter().map(Into::into).chain([b.points.into()]).chain(lists.map(Into::into));
        cmd.rendering(visibility.image.size(), &[visibility], Some(depth), || {
            if let Some(plain) = &self.plain {
                cmd.bind(plain, &shared().collect::<Vec<_>>(), &[]);
                let count = offset_of!(Counters, plain_draws) as u64;
                cmd.draw_indirect_count(b.draws, 0, b.counters, count, draw_capacity);
            }
            if let (Some(trimmed), Some(t)) = (&self.trimmed, &b.table) {
                let table = [t.line_starts, t.row_starts, t.row_counts, t.flips, t.rings].map(Into::into);
                let resources: Vec<_> = shared().chain(table).collect();
                cmd.bind(trimmed, &resources, &[]);
                let count = offset_of!(Counters, trimmed_draws) as u64;
                cmd.draw_indirect_count(b.draws, bytes, b.counters, count, draw_capacity);
            }
        });
    }
}

/// Bindings of the plain or of the trimmed pipeline.
fn bindings(trimmed: bool) -> Vec<Binding> {
    let mut bindings = vec![Binding::Storage; if trimmed { 15 } else { 10 }];
    bindings[6] = Binding::Texels;
    bindings
}
