//! Pass `border_solid`: which side of a Boolean solid each point of a pixel at a border sees.
//!
//! ```text
//!   leaves of the pixel's tile ──▶ spans of the point's ray ──▶ the first event that enters the solid ──▶ points
//! ```
//!
//! Reads: everything that the bindings name. Writes: `points`, nearer than what patches and meshes are there.
//!
//! As exact as pass `solid_events`: both walk by `glsl/include/solid_walk.glsl`. Where a driver ends a ray's loop, the
//! point keeps what was there before.

use crate::abi;
use crate::bindings::Primitives;
use crate::frame::common::border_list::ListBindings;
use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError, Image, Resource, TexelBuffer};
use crate::shaders::{self, constant};

/// What the scene has.
#[derive(Clone, Copy)]
pub(crate) struct Kinds {
    /// The most general kind of surface: `abi::SURFACE_*`.
    pub surfaces: u32,
    /// There are items that rays are followed through.
    pub followed: bool,
    /// The scene has neither patches nor meshes.
    pub first: bool,
}

/// The pass.
pub(crate) struct BorderSolid {
    kernel: Kernel,
}

/// Its buffers and images, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub primitives: Primitives<'a>,
    pub tile_starts: &'a TexelBuffer,
    pub tile_leaves: &'a TexelBuffer,
    pub tile_entries: &'a TexelBuffer,
    pub visibility: &'a Image,
    pub meshes_and_solids: &'a Image,
    /// Linear colour and depth.
    pub resolved: &'a Image,
    pub list: ListBindings<'a>,
    pub points: &'a Buffer,
}

impl BorderSolid {
    pub(crate) fn new(device: &Device, kinds: Kinds) -> Result<Self, GpuError> {
        let constants = [
            (constant::SOLIDS_HAVE, kinds.surfaces),
            (constant::SOLIDS_ARE_FOLLOWED, u32::from(kinds.followed)),
            (constant::SCENE_HAS_MESHES_OR_SOLIDS, 1),
            (constant::ASKS_FIRST, u32::from(kinds.first)),
        ];
        let name = format!("border solid ({})", abi::surface_kind(kinds.surfaces));
        Ok(Self { kernel: Kernel::new(device, &name, &shaders::BORDER_SOLID_COMP, &constants)? })
    }

    /// One thread a point of a pixel of the list.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>) {
        // no leaf has fragments: the list of leaves stands in for theirs
        let tiles: [Resource<'_>; 4] =
            [b.tile_starts.into(), b.tile_leaves.into(), b.tile_entries.into(), b.tile_leaves.into()];
        let images = [b.visibility.into(), b.meshes_and_solids.into(), b.resolved.into()];
        let lists = [b.list.pixels.into(), b.list.grids.into(), b.points.into()];
        let primitives = b.primitives.resources();
        let resources: Vec<_> =
            [b.frame.into()].into_iter().chain(primitives).chain(tiles).chain(images).chain(lists).collect();
        self.kernel.record_indirect(cmd, &resources, b.list.of_points());
    }
}
