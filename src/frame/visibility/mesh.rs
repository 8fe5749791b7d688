//! Pass `mesh`: the triangles of every mesh instance, before the patches and under the same depth test.
//!
//! ```text
//!   vertex k of a draw ──triangles[k]──▶ position ──view of the instance──▶ raster
//!                  └── k / 3 ──▶ triangle ──▶ image: mesh instance, triangle;  depth
//! ```
//!
//! A vertex is transformed once for each of its triangles. Without a geometry shader, which not every device has, a
//! pixel can get its triangle's number only this way.
//!
//! Reads: everything that `Bindings` names. Writes: depth and, in scenes without trims, the visibility image; with
//! trims, the image `meshes_and_solids`, which pass `gap_fill` reads. Both begin cleared.

use crate::bindings::Primitives;
use crate::frame::common::draw::Draw;
use crate::gpu::{
    Attachment, Blend, Buffer, ColourTarget, Commands, DepthTest, Device, GpuError, Image, Load, Pipeline, Resource,
};
use crate::shaders::{self, constant};
use ash::vk;
use std::ops::Range;

/// The pass.
pub(crate) struct Mesh {
    /// For meshes drawn from both sides, and for meshes drawn from outside only.
    both: Option<Pipeline>,
    outward: Option<Pipeline>,
}

/// The kinds of meshes in the scene, and its volume.
#[derive(Clone, Copy)]
pub(crate) struct Kinds {
    /// Meshes drawn from both sides.
    pub both: bool,
    /// Meshes drawn from outside only.
    pub outward: bool,
    /// The most general kind of surface of the volume that trims the scene; `None` without one.
    pub volume: Option<u32>,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub views: &'a Buffer,
    pub mesh_instances: &'a Buffer,
    pub triangles: &'a Buffer,
    pub positions: &'a Buffer,
    /// The volume that trims the scene; `None` without one.
    pub volume: Option<Primitives<'a>>,
}

impl Mesh {
    /// For images of these formats.
    pub(crate) fn new(
        device: &Device,
        (visibility, depth): (vk::Format, vk::Format),
        kinds: Kinds,
    ) -> Result<Self, GpuError> {
        let volume = kinds.volume;
        let (name, fragment) = match volume {
            None => ("mesh", &shaders::MESH_FRAG),
            Some(_) => ("mesh (within a volume)", &shaders::MESH_VOLUME_FRAG),
        };
        let pipeline = |name: &str, cull: vk::CullModeFlags| {
            let draw = Draw {
                constants: &[(constant::SOLIDS_HAVE, volume.unwrap_or_default())],
                cull,
                colour: &[ColourTarget { format: visibility, blend: Blend::Replace }],
                depth: Some(DepthTest { format: depth, compare: vk::CompareOp::GREATER, write: true }),
                ..Draw::new(name, &shaders::MESH_VERT, fragment)
            };
            draw.pipeline(device)
        };
        Ok(Self {
            both: kinds.both.then(|| pipeline(name, vk::CullModeFlags::NONE)).transpose()?,
            outward: kinds.outward.then(|| pipeline("mesh (outside)", vk::CullModeFlags::BACK)).transpose()?,
        })
    }

    /// One draw for each of `draws`: a range of corners of the scene's triangles, and their mesh instances. Draws from
    /// `outward` on are drawn from outside only.
    pub(crate) fn record(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        (seen, depth): (&Image, &Image),
        draws: &[(Range<u32>, Range<u32>)],
        outward: usize,
    ) {
        let colour = [Attachment { image: seen, load: Load::ColourU32([0; 4]) }];
        let depth = Attachment { image: depth, load: Load::Depth(0.0) };
        cmd.rendering(seen.size(), &colour, Some(depth), || {
            let own = [b.frame, b.views, b.mesh_instances, b.triangles, b.positions].map(Resource::from);
            let volume = b.volume.iter().flat_map(Primitives::resources);
            let resources: Vec<_> = own.into_iter().chain(volume).collect();
            let (both, outward) = draws.split_at(outward);
            for (pipeline, draws) in [(&self.both, both), (&self.outward, outward)] {
                let Some(pipeline) = pipeline else { continue };
                cmd.bind(pipeline, &resources, &[]);
                for (corners, instances) in draws {
                    cmd.draw_instances(corners.clone(), instances.clone());
                }
            }
        });
    }
}
