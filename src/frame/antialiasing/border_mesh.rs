//! Pass `border_mesh`: which triangle each point of a pixel at a border sees.
//!
//! ```text
//!   triangles that the pixels around see ──across their sides──▶ the one that the point's ray meets ──▶ points
//! ```
//!
//! Reads: everything that the bindings name. Writes: `points`, nearer than what patches are there.
//!
//! Exact but for the rounding of a weight, 1e-5 of a triangle, where the triangles that lead there are at most
//! `MOST_CROSSED` and share their sides in twos (`glsl/include/mesh_walk.glsl`).

use crate::bindings::Primitives;
use crate::frame::common::border_list::ListBindings;
use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError, Image, Resource};
use crate::shaders::{self, constant};

/// The pass.
pub(crate) struct BorderMesh {
    kernel: Kernel,
}

/// Its buffers and images, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub views: &'a Buffer,
    pub mesh_instances: &'a Buffer,
    pub triangles: &'a Buffer,
    pub positions: &'a Buffer,
    pub neighbours: &'a Buffer,
    pub visibility: &'a Image,
    pub meshes_and_solids: &'a Image,
    /// Linear colour and depth.
    pub resolved: &'a Image,
    pub list: ListBindings<'a>,
    pub points: &'a Buffer,
    /// The volume that trims the scene; `None` where there is none.
    pub volume: Option<Primitives<'a>>,
}

impl BorderMesh {
    /// `first`: the scene has no patches. `volume`: the most general kind of surface of the volume that trims the
    /// scene.
    pub(crate) fn new(device: &Device, first: bool, volume: Option<u32>) -> Result<Self, GpuError> {
        let (name, shader) = match volume {
            None => ("border mesh", &shaders::BORDER_MESH_COMP),
            Some(_) => ("border mesh (within a volume)", &shaders::BORDER_MESH_VOLUME_COMP),
        };
        let own = [(constant::SCENE_HAS_MESHES_OR_SOLIDS, 1), (constant::ASKS_FIRST, u32::from(first))];
        let of_volume = volume.map(|kind| (constant::SOLIDS_HAVE, kind));
        let constants: Vec<_> = own.into_iter().chain(of_volume).collect();
        Ok(Self { kernel: Kernel::new(device, name, shader, &constants)? })
    }

    /// One thread a pixel of the list.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>) {
        let own = [b.frame, b.views, b.mesh_instances, b.triangles, b.positions, b.neighbours].map(Resource::from);
        let images = [b.visibility.into(), b.meshes_and_solids.into(), b.resolved.into()];
        let lists = [b.list.pixels.into(), b.list.grids.into(), b.points.into()];
        let volume = b.volume.iter().flat_map(Primitives::resources);
        let resources: Vec<_> = own.into_iter().chain(images).chain(lists).chain(volume).collect();
        self.kernel.record_indirect(cmd, &resources, b.list.of_pixels());
    }
}
