//! Passes `seed_list`, `line_list` and `fold_list`: lists of what passes `edge_line` and `edge_fold` look at.
//!
//! ```text
//!   chord ──seed_list──▶ faces beside it that may fold there           once a view
//!   chord ─▶ rectangle ──line_list──▶ points: pixels that its line covers, no nearer to the chord before or after it
//!                                     seeds:  pixels beside which folds are looked for from its edge, likewise
//!   pixel, and those around ──fold_list──▶ starts: a pixel, and one around that sees a curved face which may fold between
//! ```
//!
//! Reads: everything that the bindings name. Writes: `chord_seeds`; `points`, `seeds`; `starts`; `counters`.

use crate::abi::constants::fold_list::{FOLD_COLUMNS, FOLD_ROWS};
use crate::bindings::Placed;
use crate::frame::common::draw::Draw;
use crate::frame::common::kernel::Kernel;
use crate::frame::common::line_items::LineItems;
use crate::gpu::{Buffer, Commands, Device, GpuError, Image, Pipeline, Resource};
use crate::scene::EdgeBuffers;
use crate::shaders::{self, Shader, constant};
use bytemuck::{Pod, Zeroable};

/// Bytes before the number of draws.
const COUNT_OFFSET: u64 = 16;

/// Those of the constants that a shader has.
fn of_shader(constants: &[(u32, u32)], shader: &Shader) -> Vec<(u32, u32)> {
    constants.iter().copied().filter(|(id, _)| shader.interface.constants.contains(id)).collect()
}

/// Pass `seed_list`.
pub(crate) struct SeedsOfChords(Kernel);

/// Its buffers, in binding order.
pub(crate) struct SeedBindings<'a> {
    pub frame: &'a Buffer,
    pub placed: Placed<'a>,
    pub chords: &'a Buffer,
    pub edges: &'a EdgeBuffers,
    pub draw: &'a Buffer,
    pub chord_seeds: &'a Buffer,
}

impl SeedsOfChords {
    /// `constants` of passes that follow surfaces.
    pub(crate) fn new(device: &Device, constants: &[(u32, u32)]) -> Result<Self, GpuError> {
        let constants = of_shader(constants, &shaders::SEED_LIST_COMP);
        Ok(Self(Kernel::new(device, "seed_list", &shaders::SEED_LIST_COMP, &constants)?))
    }

    /// One thread a chord; there is room for `capacity`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &SeedBindings<'_>, capacity: u32) {
        let e = b.edges;
        let edges = [b.chords, &e.piece_instances, &e.pieces].map(Resource::from);
        let resources: Vec<_> = [b.frame.into()]
            .into_iter()
            .chain(b.placed.resources())
            .chain(edges)
            .chain([Resource::from(&e.points), b.draw.into(), b.chord_seeds.into()])
            .collect();
        self.0.record(cmd, &resources, capacity);
    }
}

/// Pass `line_list`.
pub(crate) struct OfChords {
    pipeline: Pipeline,
}

/// What it draws.
pub(crate) struct ChordBindings<'a> {
    pub frame: &'a Buffer,
    pub chords: &'a Buffer,
    pub points: &'a LineItems,
    pub seeds: &'a LineItems,
    pub counters: &'a Buffer,
    /// What pass `seed_list` wrote, where outlines are drawn.
    pub chord_seeds: &'a Buffer,
    pub edges: &'a EdgeBuffers,
    /// The draw, and its number.
    pub draw: &'a Buffer,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct ChordParams {
    half_px: [f32; 3],
    capacities: [u32; 2],
}

impl OfChords {
    /// `folds`: outlines of curved faces are drawn.
    pub(crate) fn new(device: &Device, folds: bool) -> Result<Self, GpuError> {
        let constants = [(constant::DRAWS_FOLDS, u32::from(folds))];
        let draw = Draw::new("line_list", &shaders::LINE_LIST_VERT, &shaders::LINE_LIST_FRAG);
        Ok(Self { pipeline: Draw { constants: &constants, ..draw }.pipeline(device)? })
    }

    /// `size`: of the picture.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &ChordBindings<'_>, size: (u32, u32), half_px: [f32; 3]) {
        let lists = [&b.points.buffer, &b.seeds.buffer, b.counters, b.chord_seeds];
        let edges = [&b.edges.piece_instances, &b.edges.pieces, b.draw];
        let resources: Vec<_> = [b.frame, b.chords].into_iter().chain(lists).chain(edges).map(Resource::from).collect();
        let params = ChordParams { half_px, capacities: [b.points.capacity, b.seeds.capacity] };
        cmd.rendering(size, &[], None, || {
            cmd.bind(&self.pipeline, &resources, bytemuck::bytes_of(&params));
            // lavapipe (Mesa 25.0.7) takes the number of draws of a draw without a count from the draw with one before
            // it
            cmd.draw_indirect_count(b.draw, 0, b.draw, COUNT_OFFSET, 1);
        });
    }
}

/// Pass `fold_list`.
pub(crate) struct OfPixels(Kernel);

/// Its buffers and images, in binding order.
pub(crate) struct PixelBindings<'a> {
    pub frame: &'a Buffer,
    pub placed: Placed<'a>,
    pub visibility: &'a Image,
    pub meshes_and_solids: &'a Image,
    pub operand_uv: &'a Image,
    pub starts: &'a LineItems,
    pub counters: &'a Buffer,
}

impl OfPixels {
    /// `constants` of passes that follow surfaces.
    pub(crate) fn new(device: &Device, constants: &[(u32, u32)]) -> Result<Self, GpuError> {
        let constants = of_shader(constants, &shaders::FOLD_LIST_COMP);
        Ok(Self(Kernel::new(device, "fold_list", &shaders::FOLD_LIST_COMP, &constants)?))
    }

    /// One thread a column of [`FOLD_ROWS`] pixels, [`FOLD_COLUMNS`] of which a workgroup lists.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &PixelBindings<'_>) {
        let (width, height) = b.visibility.size();
        let images = [b.visibility, b.meshes_and_solids, b.operand_uv].map(Resource::from);
        let written = [&b.starts.buffer, b.counters].map(Resource::from);
        let resources: Vec<_> =
            [b.frame.into()].into_iter().chain(b.placed.resources()).chain(images).chain(written).collect();
        self.0.bind(cmd, &resources, bytemuck::bytes_of(&b.starts.capacity));
        let groups = width.div_ceil(FOLD_COLUMNS as u32);
        cmd.dispatch_grid([groups, height.div_ceil(FOLD_ROWS as u32), 1]);
    }
}
