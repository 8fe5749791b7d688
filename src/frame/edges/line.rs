//! Pass `edge_line`: each pixel's best line along an edge.
//!
//! ```text
//!   points: pixel, chord ──test──▶ exact point of the edge, what pixels around it see ─▶ seen, or hidden
//!                                                          └─▶ seen | share | chord, the largest
//!   seeds: pixel, chord, face ──look──▶ the fold of the face beside the edge ──test──▶ the same
//! ```
//!
//! Each step has a thread for each entry of its list. Reads: everything that `Bindings` names. Writes: folds of `seeds`;
//! `best`, cleared to 0 before.

use crate::abi::constants::line_list::{STEP_FOUND, STEP_LOOK, STEP_TEST};
use crate::bindings::{Placed, Primitives, SeenSolids};
use crate::frame::common::kernel::Kernel;
use crate::frame::common::line_items::LineItems;
use crate::gpu::{Buffer, Commands, Device, GpuError, Image, Resource, TexelBuffer};
use crate::scene::{EdgeBuffers, MeshBuffers};
use crate::shaders::{EDGE_LINE_PLAIN, TrimTest, constant};
use bytemuck::{Pod, Zeroable};

/// The pass.
pub(crate) struct Line {
    test: Kernel,
    /// Where outlines of curved faces are drawn: looks for folds, and tests what was found.
    folds: Option<[Kernel; 2]>,
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
    pub points: &'a LineItems,
    pub seeds: &'a LineItems,
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

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct ListParams {
    lines: Params,
    capacity: u32,
}

impl Line {
    /// `constants` of passes that follow surfaces; `folds`: outlines of curved faces are drawn.
    pub(crate) fn new(
        device: &Device,
        constants: &[(u32, u32)],
        kinds: &Kinds<'_>,
        folds: bool,
    ) -> Result<Self, GpuError> {
        let tested = kinds.test.and_then(|test| test.edge_line.map(|shaders| (test.way, shaders)));
        let (way, [alone, within]) = tested.unwrap_or(("no trims", EDGE_LINE_PLAIN));
        let (shader, volume) = if kinds.volume.is_some() { (within, ", within a volume") } else { (alone, "") };
        let of_volume = kinds.volume.map(|kind| (constant::SOLIDS_HAVE, kind));
        let kernel = |name: &str, step: u32| {
            let own = of_volume.into_iter().chain([(constant::LINE_STEP, step)]);
            let constants: Vec<_> = constants.iter().copied().chain(own).collect();
            Kernel::new(device, &format!("{name} ({way}{volume})"), shader, &constants)
        };
        let of_folds = || Ok([kernel("edge_line folds", STEP_LOOK)?, kernel("edge_line found", STEP_FOUND)?]);
        Ok(Self {
            test: kernel("edge_line", STEP_TEST)?,
            folds: folds.then(of_folds).transpose()?,
            tests: tested.is_some(),
        })
    }

    /// `between` stands between looking for folds and testing them.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, params: Params, between: impl FnOnce()) {
        let (e, placed) = (b.edges, b.placed.resources());
        let seen = [b.visibility.into(), b.meshes_and_solids.into(), Resource::from(&e.face_keys), b.sources.into()];
        let edges = [b.chords, &e.piece_instances, &e.pieces, &e.lines, &e.own_faces].map(Resource::from);
        let meshes = b.meshes.map_or([b.frame; 3], |m| [&m.instances, &m.triangles, &m.positions]);
        let step = |kernel: &Kernel, list: &LineItems, (arguments, offset): (&Buffer, u64)| {
            let resources: Vec<_> = [b.frame.into()]
                .into_iter()
                .chain(placed)
                .chain(seen)
                .chain(edges)
                .chain([Resource::from(&e.points), b.best.into()])
                .chain(meshes.map(Resource::from))
                .chain([Resource::from(&list.buffer)])
                .chain(b.solids.resources().into_iter().filter(|_| b.volume.is_none()))
                .chain(b.trim.iter().copied().filter(|_| self.tests))
                .chain(b.volume.iter().flat_map(Primitives::resources))
                .collect();
            kernel.bind(cmd, &resources, bytemuck::bytes_of(&ListParams { lines: params, capacity: list.capacity }));
            cmd.dispatch_indirect(arguments, offset);
        };
        step(&self.test, b.points, b.points.of_items());
        let Some([look, test]) = &self.folds else { return };
        step(look, b.seeds, b.seeds.of_items());
        between();
        step(test, b.seeds, b.seeds.of_found());
    }
}
