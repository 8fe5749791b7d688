//! Pass `mesh`: the triangles of every mesh instance, before the patches and under the same depth test.
//!
//! ```text
//!   vertex k of a draw ──triangles[k]──▶ position ──view of the instance──▶ raster
//!                  └── k / 3 ──▶ triangle ──▶ image: mesh instance, triangle;  depth
//! ```
//!
//! A vertex is transformed once for each of its triangles: only so does a pixel learn its triangle
//! without a geometry shader, which not every device has.
//!
//! Reads: everything that `Bindings` names. Writes: depth and, in scenes without trims, the visibility
//! image; else the image `others`, which pass `heal` looks through. Both begin cleared.

use crate::gpu::{
    Attachment, Binding, Blend, Buffer, ColourTarget, Commands, DepthTest, Device, GpuError, GraphicsInfo, Image, Load,
    Pipeline,
};
use crate::shaders::{self, VOLUME_BUFFERS};
use ash::vk;
use std::ops::Range;

/// `constant_id` of `SOLIDS_HAVE_TORI`.
const SOLIDS_HAVE_TORI: u32 = 5;

/// The pass.
pub(crate) struct Mesh {
    pipeline: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub views: &'a Buffer,
    pub mesh_instances: &'a Buffer,
    pub triangles: &'a Buffer,
    pub positions: &'a Buffer,
    /// The volume that trims the scene; none where there is none.
    pub volume: &'a [&'a Buffer],
}

impl Mesh {
    /// For images of these formats; `volume`: one trims the scene, and whether some surface of it is a torus.
    pub(crate) fn new(
        device: &Device,
        (visibility, depth): (vk::Format, vk::Format),
        volume: Option<bool>,
    ) -> Result<Self, GpuError> {
        let (name, fragment) = match volume {
            None => ("mesh", shaders::MESH_FRAG),
            Some(_) => ("mesh (within a volume)", shaders::MESH_VOLUME_FRAG),
        };
        let pipeline = Pipeline::graphics(
            device,
            &GraphicsInfo {
                name,
                stages: &[
                    (vk::ShaderStageFlags::VERTEX, shaders::MESH_VERT),
                    (vk::ShaderStageFlags::FRAGMENT, fragment),
                ],
                bindings: &vec![Binding::Storage; 5 + volume.map_or(0, |_| VOLUME_BUFFERS)],
                push_bytes: 0,
                constants: &[(SOLIDS_HAVE_TORI, u32::from(volume == Some(true)))],
                topology: vk::PrimitiveTopology::TRIANGLE_LIST,
                patch_points: 0,
                cull: vk::CullModeFlags::NONE,
                front: vk::FrontFace::COUNTER_CLOCKWISE,
                colour: &[ColourTarget { format: visibility, blend: Blend::Replace }],
                depth: Some(DepthTest { format: depth, compare: vk::CompareOp::GREATER, write: true }),
                stencil: None,
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One draw for each of `draws`: a range of corners of the scene's triangles, and the mesh instances
    /// that show them.
    pub(crate) fn record<'d>(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        (seen, depth): (&Image, &Image),
        draws: impl Iterator<Item = &'d (Range<u32>, Range<u32>)>,
    ) {
        let colour = [Attachment { image: seen, load: Load::ColourU32([0; 4]) }];
        let depth = Attachment { image: depth, load: Load::Depth(0.0) };
        cmd.rendering(seen.size(), &colour, Some(depth), || {
            let own = [b.frame, b.views, b.mesh_instances, b.triangles, b.positions];
            let resources: Vec<_> = own.iter().chain(b.volume).map(|&buffer| buffer.into()).collect();
            cmd.bind(&self.pipeline, &resources, &[]);
            for (corners, instances) in draws {
                cmd.draw_instances(corners.clone(), instances.clone());
            }
        });
    }
}
