//! Pass `edge_line`: each pixel's best line along an edge.
//!
//! ```text
//!   chord ─▶ rectangle ─▶ pixel: distance ─▶ share covered
//!                               exact point of the edge, what pixels around it see ─▶ seen, or hidden
//!                                                                          └─▶ seen | share | chord, the largest
//! ```
//!
//! Reads: everything that `Bindings` names. Writes: `best`, cleared to 0 before.

use crate::bindings::{Placed, Primitives, SeenSolids};
use crate::frame::common::draw::Draw;
use crate::gpu::{Buffer, Commands, Device, GpuError, Image, Pipeline, Resource, TexelBuffer};
use crate::scene::{EdgeBuffers, MeshBuffers};
use crate::shaders::{self, EDGE_LINE_PLAIN, TrimTest, constant};
use bytemuck::{Pod, Zeroable};

/// Bytes before the number of draws.
const COUNT_OFFSET: u64 = 16;

/// The pass.
pub(crate) struct Line {
    pipeline: Pipeline,
    /// It reads what the trim test does.
    tests: bool,
}

/// What scenes differ in.
pub(crate) struct Kinds<'a> {
    /// How faces are trimmed; `None` where none is.
    pub test: Option<&'a TrimTest>,
    /// Most general kind of surface of the volume that trims the scene.
    pub volume: Option<u32>,
}

/// Its buffers and images, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub placed: Placed<'a>,
    pub visibility: &'a Image,
    pub meshes_and_solids: &'a Image,
    pub sources: &'a TexelBuffer,
    pub chords: &'a Buffer,
    pub edges: &'a EdgeBuffers,
    pub best: &'a Image,
    pub meshes: Option<&'a MeshBuffers>,
    /// Read where no volume trims the scene.
    pub solids: SeenSolids<'a>,
    /// What the trim test reads, in its order.
    pub trim: &'a [Resource<'a>],
    /// The volume that trims the scene; `None` where there is none.
    pub volume: Option<Primitives<'a>>,
}

/// How lines look that matters to where they are.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Params {
    /// Pixels: of full lines, of thin ones, of bold ones.
    pub half_px: [f32; 3],
    pub hidden: u32,
}

impl Line {
    /// `constants` of passes that follow surfaces.
    pub(crate) fn new(device: &Device, constants: &[(u32, u32)], kinds: &Kinds<'_>) -> Result<Self, GpuError> {
        let tested = kinds.test.and_then(|test| test.edge_line.map(|shaders| (test.way, shaders)));
        let (way, [alone, within]) = tested.unwrap_or(("no trims", EDGE_LINE_PLAIN));
        let (fragment, volume) = if kinds.volume.is_some() { (within, ", within a volume") } else { (alone, "") };
        let of_volume = kinds.volume.map(|kind| (constant::SOLIDS_HAVE, kind));
        let constants: Vec<_> = constants.iter().copied().chain(of_volume).collect();
        let name = format!("edge_line ({way}{volume})");
        let draw = Draw::new(&name, &shaders::EDGE_LINE_VERT, fragment);
        Ok(Self { pipeline: Draw { constants: &constants, ..draw }.pipeline(device)?, tests: tested.is_some() })
    }

    /// What `draw` says, and its number, over a picture of the visibility image's size.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, params: Params, draw: &Buffer) {
        let (e, placed) = (b.edges, b.placed.resources());
        let seen = [b.visibility.into(), b.meshes_and_solids.into(), Resource::from(&e.face_keys), b.sources.into()];
        let edges = [b.chords, &e.piece_instances, &e.pieces, &e.lines, &e.own_faces].map(Resource::from);
        let meshes = b.meshes.map_or([b.frame; 3], |m| [&m.instances, &m.triangles, &m.positions]);
        let resources: Vec<_> = [b.frame.into()]
            .into_iter()
            .chain(placed)
            .chain(seen)
            .chain(edges)
            .chain([Resource::from(&e.points), b.best.into()])
            .chain(meshes.map(Resource::from))
            .chain(b.solids.resources().into_iter().filter(|_| b.volume.is_none()))
            .chain(b.trim.iter().copied().filter(|_| self.tests))
            .chain(b.volume.iter().flat_map(Primitives::resources))
            .collect();
        cmd.rendering(b.visibility.size(), &[], None, || {
            cmd.bind(&self.pipeline, &resources, bytemuck::bytes_of(&params));
            // lavapipe (Mesa 25.0.7) takes the number of draws of a draw without a count from the draw with one before
            // it
            cmd.draw_indirect_count(draw, 0, draw, COUNT_OFFSET, 1);
        });
    }
}
