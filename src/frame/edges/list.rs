//! Passes `seed_list`, `line_list` and `fold_list`: lists of what passes `edge_line` and `edge_fold` look at.
//!
//! ```text
//!   chord ──seed_list──▶ faces beside it that may fold there           once a view
//!   chord ─▶ rectangle ──line_list──▶ points: pixels that its line covers
//!                                     seeds:  pixels beside which folds are looked for from its edge
//!   pixel, and those around ──fold_list──▶ starts: a pixel, and one around that sees a curved face which may fold between
//! ```
//!
//! Reads: everything that the bindings name. Writes: `chord_seeds`; `points`, `seeds`; `starts`; `counters`.

use super::divide::COUNT_OFFSET;
use crate::abi::LineList;
use crate::abi::constants::fold_list::FOLD_ROWS;
use crate::abi::constants::line_list::{FOUND_WORDS, LINE_ITEM_WORDS};
use crate::bindings::Placed;
use crate::frame::common::draw::Draw;
use crate::frame::common::kernel::Kernel;
use crate::frame::common::room::Room;
use crate::gpu::{Buffer, Commands, Device, GpuError, Image, Pipeline, Resource};
use crate::scene::EdgeBuffers;
use crate::shaders::{self, Shader, constant};
use bytemuck::{Pod, Zeroable};
use std::mem::offset_of;

/// A list of pixels, and of folds that were found from there.
pub(crate) struct List {
    /// [`LineList`], items, folds.
    pub buffer: Buffer,
    /// Items that there is room for.
    pub capacity: u32,
}

/// Bytes of an item, with those of a fold that it may find.
pub(super) const fn item_bytes(finds: bool) -> usize {
    size_of::<u32>() * (LINE_ITEM_WORDS + if finds { FOUND_WORDS } else { 0 }) as usize
}

impl List {
    pub(super) fn new(room: &Room<'_>, name: &str, capacity: u32, finds: bool) -> Result<Self, GpuError> {
        let words = (size_of::<LineList>() + capacity as usize * item_bytes(finds)) / size_of::<u32>();
        Ok(Self { buffer: room.indirect::<u32>(name, words as u32)?, capacity })
    }

    /// Before each drawing.
    pub(super) fn clear(&self, cmd: &Commands<'_>) {
        cmd.fill_first(&self.buffer, (size_of::<LineList>() / size_of::<u32>()) as u64, 0);
    }

    /// The arguments of a thread an item.
    pub(super) fn of_items(&self) -> (&Buffer, u64) {
        (&self.buffer, offset_of!(LineList, grid) as u64)
    }

    /// The arguments of a thread a fold.
    pub(super) fn of_found(&self) -> (&Buffer, u64) {
        (&self.buffer, offset_of!(LineList, found_grid) as u64)
    }
}

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
    pub points: &'a List,
    pub seeds: &'a List,
    pub counters: &'a Buffer,
    /// What pass `seed_list` wrote, where outlines are drawn.
    pub chord_seeds: &'a Buffer,
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
        let resources =
            [b.frame, b.chords, &b.points.buffer, &b.seeds.buffer, b.counters, b.chord_seeds].map(Resource::from);
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
    pub starts: &'a List,
    pub counters: &'a Buffer,
}

impl OfPixels {
    /// `constants` of passes that follow surfaces.
    pub(crate) fn new(device: &Device, constants: &[(u32, u32)]) -> Result<Self, GpuError> {
        let constants = of_shader(constants, &shaders::FOLD_LIST_COMP);
        Ok(Self(Kernel::new(device, "fold_list", &shaders::FOLD_LIST_COMP, &constants)?))
    }

    /// One thread a column of [`FOLD_ROWS`] pixels.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &PixelBindings<'_>) {
        let (width, height) = b.visibility.size();
        let images = [b.visibility, b.meshes_and_solids, b.operand_uv].map(Resource::from);
        let written = [&b.starts.buffer, b.counters].map(Resource::from);
        let resources: Vec<_> =
            [b.frame.into()].into_iter().chain(b.placed.resources()).chain(images).chain(written).collect();
        self.0.bind(cmd, &resources, bytemuck::bytes_of(&b.starts.capacity));
        self.0.dispatch_rows(cmd, [width, height.div_ceil(FOLD_ROWS as u32)]);
    }
}
