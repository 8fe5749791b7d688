//! Pass `edge_fold`: outlines of curved faces, as lines.
//!
//! ```text
//!   pixel, and those beside it ─▶ curved faces that end here ─▶ the exact fold next to the pixel ─▶ each pixel's best line
//! ```
//!
//! Reads: everything that `Bindings` names. Writes: `best`, as pass `edge_line`.

use crate::bindings::{Placed, SeenSolids};
use crate::frame::common::draw::Draw;
use crate::gpu::{Buffer, Commands, Device, GpuError, Image, Pipeline, Resource};
use crate::scene::MeshBuffers;
use crate::shaders::{self, TrimTest};

/// The pass.
pub(crate) struct Fold {
    pipeline: Pipeline,
    /// Whether it reads what a trim test reads.
    tests: bool,
}

/// Its buffers and images, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub placed: Placed<'a>,
    pub visibility: &'a Image,
    pub meshes_and_solids: &'a Image,
    pub best: &'a Image,
    pub meshes: Option<&'a MeshBuffers>,
    pub solids: SeenSolids<'a>,
    /// What the trim test reads, in its order.
    pub trim: &'a [Resource<'a>],
}

impl Fold {
    /// `test`: how faces are trimmed; `None` where none is.
    pub(crate) fn new(device: &Device, constants: &[(u32, u32)], test: Option<&TrimTest>) -> Result<Self, GpuError> {
        let tested = test.and_then(|test| test.edge_fold.map(|shader| (test.way, shader)));
        let (way, shader) = tested.unwrap_or(("no trims", &shaders::EDGE_FOLD_PLAIN_FRAG));
        let name = format!("edge_fold ({way})");
        let draw = Draw::new(&name, &shaders::RESOLVE_VERT, shader);
        Ok(Self { pipeline: Draw { constants, ..draw }.pipeline(device)?, tests: tested.is_some() })
    }

    /// One triangle over a picture of the visibility image's size; lines are twice `half_px` wide.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, half_px: f32) {
        let meshes = b.meshes.map_or([b.frame; 3], |m| [&m.instances, &m.triangles, &m.positions]);
        let resources: Vec<_> = [b.frame.into()]
            .into_iter()
            .chain(b.placed.resources())
            .chain([b.visibility.into(), b.meshes_and_solids.into(), b.best.into()])
            .chain(meshes.map(Resource::from))
            .chain(b.solids.resources())
            .chain(b.trim.iter().copied().filter(|_| self.tests))
            .collect();
        cmd.rendering(b.visibility.size(), &[], None, || {
            cmd.bind(&self.pipeline, &resources, bytemuck::bytes_of(&half_px));
            cmd.draw(3, 0, 1);
        });
    }
}
