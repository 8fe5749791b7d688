//! Passes `edge_count` and `edge_emit`: pieces of edges divided into chords, as finely as the view needs.
//!
//! ```text
//!   piece, view ──edge_count──▶ how many chords ──(scan)──▶ where they begin ──edge_emit──▶ chords, draw
//! ```
//!
//! Each piece is walked twice, with the same arithmetic: the list has the order of the pieces, whatever the order of
//! the threads. Chords are within a tenth of a pixel of the curve, in the picture and around it by half a line's width.
//!
//! Reads: everything that `Bindings` names. Writes: `counts`, `chords`, `draw`, `counters`. Twin: `src/twin/edges.rs`.
//! Parity: exact.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError, Resource, TexelBuffer};
use crate::shaders;
use bytemuck::{Pod, Zeroable};

/// Words of the draw and of how many there are.
pub(crate) const DRAW_WORDS: u32 = 5;

/// The passes.
pub(crate) struct Divide {
    count: Kernel,
    emit: Kernel,
}

/// Buffers of both.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub views: &'a Buffer,
    pub piece_instances: &'a Buffer,
    pub pieces: &'a Buffer,
    pub points: &'a TexelBuffer,
    /// Per piece instance.
    pub counts: &'a Buffer,
    /// Their sums, one more.
    pub starts: &'a Buffer,
    pub counters: &'a Buffer,
    pub lines: &'a Buffer,
    pub chords: &'a Buffer,
    pub draw: &'a Buffer,
}

/// How many there are, and how far beyond the picture they are wanted.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Params {
    pub instance_count: u32,
    pub margin_px: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct EmitParams {
    all: Params,
    capacity: u32,
}

impl Divide {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        Ok(Self {
            count: Kernel::new(device, "edge_count", &shaders::EDGE_COUNT_COMP, &[])?,
            emit: Kernel::new(device, "edge_emit", &shaders::EDGE_EMIT_COMP, &[])?,
        })
    }

    /// One thread a piece instance.
    pub(crate) fn count(&self, cmd: &Commands<'_>, b: &Bindings<'_>, params: Params) {
        let [frame, views, piece_instances, pieces] =
            [b.frame, b.views, b.piece_instances, b.pieces].map(Resource::from);
        let [counts, counters, lines] = [b.counts, b.counters, b.lines].map(Resource::from);
        let resources = [frame, views, piece_instances, pieces, b.points.into(), counts, counters, lines];
        self.count.bind(cmd, &resources, bytemuck::bytes_of(&params));
        self.count.dispatch(cmd, params.instance_count);
    }

    /// The same, once `starts` has the sums; `chords` has room for `capacity`.
    pub(crate) fn emit(&self, cmd: &Commands<'_>, b: &Bindings<'_>, params: Params, capacity: u32) {
        let [frame, views, piece_instances, pieces] =
            [b.frame, b.views, b.piece_instances, b.pieces].map(Resource::from);
        let written = [b.starts, b.counters, b.lines, b.chords, b.draw].map(Resource::from);
        let resources =
            [frame, views, piece_instances, pieces, b.points.into()].into_iter().chain(written).collect::<Vec<_>>();
        self.emit.bind(cmd, &resources, bytemuck::bytes_of(&EmitParams { all: params, capacity }));
        self.emit.dispatch(cmd, params.instance_count);
    }
}
