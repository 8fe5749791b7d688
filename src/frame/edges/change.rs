//! Pass `edge_change`: where what is seen of Boolean solids changes between the centres of pixels side by side.
//!
//! ```text
//!   two pixels ─▶ the surfaces that they see ─▶ where both meet, or the nearer one folds or ends ─▶ share of the way, style
//! ```
//!
//! Of solids that are seen through, it looks at the faces of one number from the eye on, or at the farthest ones.
//!
//! Reads: everything that `Bindings` names. Writes: an image of two words a pixel: to the right, and below.

use crate::bindings::Primitives;
use crate::frame::common::draw::Draw;
use crate::frame::common::layer_faces::Faces;
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
    /// What is seen through, of a pass for that.
    pub layers: Option<(&'a Image, Faces)>,
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
    order: f32,
}

impl Change {
    /// `surfaces`: the most general kind of the solids' surfaces, `abi::SURFACE_*`. `seen_through`: for solids that are
    /// seen through.
    pub(crate) fn new(
        device: &Device,
        data: &SceneData,
        (surfaces, seen_through): (u32, bool),
    ) -> Result<Self, GpuError> {
        let boundary_operands = !data.solids.operand_leaves.is_empty();
        let constants = [
            (constant::SCENE_HAS_RATIONAL, u32::from(data.has_rational)),
            (constant::SCENE_HAS_FINE, u32::from(data.has_fine)),
            (constant::SCENE_HAS_MESHES_OR_SOLIDS, 1),
            (constant::SOLIDS_HAVE, surfaces),
            (constant::SOLIDS_HAVE_BOUNDARY_OPERANDS, u32::from(boundary_operands)),
            (constant::SOLIDS_HAVE_PATCHES, u32::from(data.has_operands)),
            (constant::SCENE_HAS_FACES, u32::from(data.has_patches)),
            (constant::SCENE_HAS_MESHES, u32::from(data.has_meshes())),
        ];
        let colour = [ColourTarget { format: CHANGE_FORMAT, blend: Blend::Replace }];
        let (name, shader) = match seen_through {
            true => ("edge_change (seen through)", &shaders::EDGE_CHANGE_LAYERS_FRAG),
            false => ("edge_change", &shaders::EDGE_CHANGE_FRAG),
        };
        let draw = Draw::new(name, &shaders::RESOLVE_VERT, shader);
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
        let [face_instances, faces, patch_instances]: [&Buffer; 3] = [&s.face_instances, &s.faces, &s.patch_instances];
        let patches: [Resource<'_>; 4] =
            [face_instances.into(), faces.into(), (&s.patches).into(), patch_instances.into()];
        let instances: &Buffer = &s.instances;
        let meshes = s.meshes.as_ref().map_or([b.frame; 3], |m| [&m.instances, &m.triangles, &m.positions]);
        let resources: Vec<_> = [b.frame.into()]
            .into_iter()
            .chain(b.primitives.resources())
            .chain(lists)
            .chain([b.visibility, b.meshes_and_solids].map(Resource::from))
            .chain([instances, b.views].map(Resource::from))
            .chain(boundary_operands.map(Resource::from))
            .chain([b.operand_uv.into()])
            .chain(patches)
            .chain([Resource::from(&s.points)])
            .chain(meshes.map(Resource::from))
            .chain(b.layers.map(|(layers, _)| Resource::from(layers)))
            .collect();
        let order = if matches!(b.layers, Some((_, Faces::Farthest))) { -1.0 } else { 1.0 };
        let params = Params { drawn, lists: u32::from(b.tiles.is_some()), order };
        cmd.rendering_rows((into.image.size(), rows), &[into], None, || {
            cmd.bind(&self.pipeline, &resources, bytemuck::bytes_of(&params));
            cmd.draw(3, 0, 1);
        });
    }
}
