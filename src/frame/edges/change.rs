//! Pass `edge_change`: where what is seen of Boolean solids changes between the centres of pixels side by side.
//!
//! ```text
//!   two pixels ─▶ the surfaces that they see ─▶ where both meet, or the nearer one folds or ends ─▶ share of the way, style
//! ```
//!
//! Reads: everything that `Bindings` names. Writes: an image of two words a pixel: to the right, and below.

use crate::bindings::Primitives;
use crate::frame::common::draw::Draw;
use crate::gpu::{
    Attachment, Blend, Buffer, ColourTarget, Commands, Device, GpuError, Image, Pipeline, Resource, TexelBuffer,
};
use crate::scene::{Scene, SceneData};
use crate::shaders::{self, constant};
use ash::vk;
use bytemuck::{Pod, Zeroable};
use std::ops::Range;

/// Of the image of changes.
pub(crate) const CHANGE_FORMAT: vk::Format = vk::Format::R32G32_UINT;

/// The pass.
pub(crate) struct Change {
    pipeline: Pipeline,
}

/// Its buffers and images, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub primitives: Primitives<'a>,
    /// Where each tile's leaves begin, and they; `None` where there are no such lists.
    pub tiles: Option<(&'a TexelBuffer, &'a TexelBuffer)>,
    pub visibility: &'a Image,
    pub meshes_and_solids: &'a Image,
    pub scene: &'a Scene,
    pub views: &'a Buffer,
    /// `None` where every operand has equations.
    pub boundary_operands: Option<BoundaryOperands<'a>>,
    /// (u, v) of spline faces that bound operands; not read where there are none.
    pub operand_uv: &'a Image,
}

/// Of meshes that bound operands, in binding order.
pub(crate) struct BoundaryOperands<'a> {
    pub meshes: &'a Buffer,
    pub triangles: &'a Buffer,
    pub positions: &'a Buffer,
    pub planes: &'a Buffer,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Params {
    drawn: u32,
    lists: u32,
}

impl Change {
    /// `surfaces`: the most general kind of the solids' surfaces, `abi::SURFACE_*`.
    pub(crate) fn new(device: &Device, data: &SceneData, surfaces: u32) -> Result<Self, GpuError> {
        let boundary_operands = !data.solids.operand_leaves.is_empty();
        let constants = [
            (constant::SCENE_HAS_RATIONAL, u32::from(data.has_rational)),
            (constant::SCENE_HAS_FINE, u32::from(data.has_fine)),
            (constant::SCENE_HAS_MESHES_OR_SOLIDS, 1),
            (constant::SOLIDS_HAVE, surfaces),
            (constant::SOLIDS_HAVE_BOUNDARY_OPERANDS, u32::from(boundary_operands)),
            (constant::SOLIDS_HAVE_PATCHES, u32::from(data.has_operands)),
        ];
        let colour = [ColourTarget { format: CHANGE_FORMAT, blend: Blend::Replace }];
        let draw = Draw::new("edge_change", &shaders::RESOLVE_VERT, &shaders::EDGE_CHANGE_FRAG);
        Ok(Self { pipeline: Draw { constants: &constants, colour: &colour, ..draw }.pipeline(device)? })
    }

    /// One triangle over these rows of `into`; `drawn`: `LINES_*`.
    pub(crate) fn record(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        (into, rows): (Attachment<'_>, Range<u32>),
        drawn: u32,
    ) {
        // the shader has these bindings in every scene, and reads them only where there are such operands and lists
        let lists: [Resource<'_>; 2] =
            b.tiles.map_or([b.primitives.leaf_surfaces; 2], |(starts, leaves)| [starts, leaves]).map(Into::into);
        let boundary_operands = b.boundary_operands.as_ref();
        let boundary_operands =
            boundary_operands.map_or([b.frame; 4], |m| [m.meshes, m.triangles, m.positions, m.planes]);
        let s = b.scene;
        let patches: [&Buffer; 4] = [&s.face_instances, &s.faces, &s.patches, &s.patch_instances];
        let instances: &Buffer = &s.instances;
        let resources: Vec<_> = [b.frame.into()]
            .into_iter()
            .chain(b.primitives.resources())
            .chain(lists)
            .chain([b.visibility, b.meshes_and_solids].map(Resource::from))
            .chain([instances, b.views].map(Resource::from))
            .chain(boundary_operands.map(Resource::from))
            .chain([b.operand_uv.into()])
            .chain(patches.map(Resource::from))
            .chain([Resource::from(&s.points)])
            .collect();
        let params = Params { drawn, lists: u32::from(b.tiles.is_some()) };
        cmd.rendering_rows((into.image.size(), rows), &[into], None, || {
            cmd.bind(&self.pipeline, &resources, bytemuck::bytes_of(&params));
            cmd.draw(3, 0, 1);
        });
    }
}
