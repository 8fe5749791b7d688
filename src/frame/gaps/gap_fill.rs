//! Pass `gap_fill`: pixels that look through a gap between two faces get the face that belongs there.
//!
//! ```text
//!   visibility image, border_depths ──find──▶ list of gap candidates ──fill──▶ decisions ──write──▶ visibility image
//!
//!        ┌───┬───┬───┐     tests the faces of the neighbours, on their exact surfaces at the pixel's
//!        │ A │ A │ B │     centre; the rules stand in glsl/include/gap_decide.glsl
//!        ├───┼───┼───┤
//!        │ A │ ? │ B │     a gap is narrower than the trim table's error, so a neighbour has its face
//!        └───┴───┴───┘
//! ```
//!
//! Each step runs once for each band of rows, which has a list of its own. Reads: everything that the bindings name but
//! what it writes. Writes: `find`: `candidates`, `band`, `counters`, and the mark in the visibility image; `fill`:
//! `candidates`; `write`: the visibility image. All of them at gap candidates only.

use crate::abi::GapBand;
use crate::abi::constants::gap_find::{LANES, ROWS};
use crate::bindings::{Placed, Primitives};
use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError, Image, Resource, Sampler, TexelBuffer};
use crate::shaders::{self, TrimTest, constant};
use ash::vk;
use std::mem::offset_of;
use std::ops::Range;

/// Columns and rows of the picture that a workgroup of the first step looks for gap candidates in. Its first and its
/// last lane are there for the others.
pub(super) const PART: [u32; 2] = [LANES as u32 - 2, ROWS as u32];

/// The pass, in its three steps.
pub(crate) struct GapFill {
    find: Kernel,
    fill: Kernel,
    write: Kernel,
    nearest: Sampler,
}

/// The list of a band.
#[derive(Clone, Copy)]
pub(crate) struct ListBindings<'a> {
    /// [`GapCandidate`](crate::abi::GapCandidate)s.
    pub candidates: &'a Buffer,
    /// [`GapBand`]; zero before.
    pub band: &'a Buffer,
}

impl<'a> ListBindings<'a> {
    /// The arguments of a thread a candidate.
    fn grid(&self) -> (&'a Buffer, u64) {
        (self.band, offset_of!(GapBand, grid) as u64)
    }
}

/// Of the first step, in binding order; the list stands before `counters`.
pub(crate) struct FindBindings<'a> {
    pub frame: &'a Buffer,
    pub visibility: &'a Image,
    pub counters: &'a Buffer,
    pub depth: &'a Image,
    pub border_depths: &'a Image,
}

/// Of the second step, in binding order; the list stands behind `visibility`.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub placed: Placed<'a>,
    pub visibility: &'a Image,
    pub instances: &'a TexelBuffer,
    /// What is no patch; `None` where the scene has nothing else.
    pub meshes_and_solids: Option<MeshesAndSolids<'a>>,
    /// What the trim test reads, in its order.
    pub trim: &'a [Resource<'a>],
    /// The volume that trims the scene; `None` where there is none.
    pub volume: Option<Primitives<'a>>,
}

/// What is no patch, in binding order.
pub(crate) struct MeshesAndSolids<'a> {
    pub seen: &'a Image,
    /// `None` where the scene has no mesh.
    pub meshes: Option<Meshes<'a>>,
}

/// Triangles, and where they are placed.
pub(crate) struct Meshes<'a> {
    pub instances: &'a Buffer,
    pub triangles: &'a Buffer,
    pub positions: &'a Buffer,
}

impl GapFill {
    /// `test`: how faces are trimmed; `meshes_and_solids`: the scene has things that are no patches; `volume`: one
    /// trims the scene, and its most general kind of surface.
    pub(crate) fn new(
        device: &Device,
        test: &TrimTest,
        (rational, meshes_and_solids): (bool, bool),
        volume: Option<u32>,
    ) -> Result<Self, GpuError> {
        let weights = if rational { "rational" } else { "polynomial" };
        let constants = [
            (constant::SCENE_HAS_RATIONAL, u32::from(rational)),
            (constant::SCENE_HAS_MESHES_OR_SOLIDS, u32::from(meshes_and_solids)),
            (constant::SOLIDS_HAVE, volume.unwrap_or_default()),
        ];
        let (fill, within, constants) = match test.within.filter(|_| volume.is_some()) {
            Some(within) => (within.gap_fill, ", within a volume", &constants[..]),
            None => (test.gap_fill, "", &constants[..2]),
        };
        let name = format!("gap fill ({}, {weights}{within})", test.way);
        Ok(Self {
            find: Kernel::new(device, "gap find", &shaders::GAP_FIND_COMP, &[])?,
            fill: Kernel::new(device, &name, fill, constants)?,
            write: Kernel::new(device, "gap write", &shaders::GAP_WRITE_COMP, &[])?,
            nearest: Sampler::new(device, vk::Filter::NEAREST)?,
        })
    }

    /// Lists the gap candidates of some rows. Unless they end with the picture, their number is a multiple of the rows
    /// of [`PART`].
    pub(crate) fn find(&self, cmd: &Commands<'_>, b: &FindBindings<'_>, list: ListBindings<'_>, rows: &Range<u32>) {
        let width = b.visibility.size().0;
        let resources = [
            b.frame.into(),
            b.visibility.into(),
            list.candidates.into(),
            list.band.into(),
            b.counters.into(),
            Resource::Sampled(b.depth, &self.nearest),
            Resource::Sampled(b.border_depths, &self.nearest),
        ];
        self.find.bind(cmd, &resources, bytemuck::bytes_of(&rows.start));
        cmd.dispatch_grid([width.div_ceil(PART[0]), (rows.end - rows.start).div_ceil(PART[1]), 1]);
    }

    /// One thread a gap candidate of a list.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, list: ListBindings<'_>) {
        // the shader has these bindings in every scene, and reads them only where there are others
        let seen = b.meshes_and_solids.as_ref().map_or(b.visibility, |o| o.seen);
        let none = Meshes { instances: b.frame, triangles: b.frame, positions: b.frame };
        let meshes = b.meshes_and_solids.as_ref().and_then(|o| o.meshes.as_ref()).unwrap_or(&none);
        let resources = [
            b.visibility.into(),
            list.candidates.into(),
            list.band.into(),
            b.instances.into(),
            seen.into(),
            meshes.instances.into(),
            meshes.triangles.into(),
            meshes.positions.into(),
        ];
        let trim = b.trim.iter().copied();
        let volume = b.volume.iter().flat_map(Primitives::resources);
        let resources: Vec<_> = [b.frame.into()]
            .into_iter()
            .chain(b.placed.resources())
            .chain(resources)
            .chain(trim)
            .chain(volume)
            .collect();
        self.fill.record_indirect(cmd, &resources, list.grid());
    }

    /// One thread a gap candidate of a list, as in the second step, whose bindings these are.
    pub(crate) fn show(&self, cmd: &Commands<'_>, b: &Bindings<'_>, list: ListBindings<'_>) {
        let resources = [b.frame.into(), b.visibility.into(), list.candidates.into(), list.band.into()];
        self.write.record_indirect(cmd, &resources, list.grid());
    }
}
