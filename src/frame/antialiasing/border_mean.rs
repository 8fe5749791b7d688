//! Pass `border_mean`: the mean of what the points of a pixel at a border see, in scenes with meshes or Boolean solids.
//!
//! Reads: everything that the bindings name. Writes: the means of `list`.

use crate::frame::common::border_list::ListBindings;
use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError, Image};
use crate::shaders::{self, constant};

/// The pass.
pub(crate) struct BorderMean {
    kernel: Kernel,
}

/// Its buffers and images, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub visibility: &'a Image,
    pub meshes_and_solids: &'a Image,
    /// Linear colour and depth.
    pub resolved: &'a Image,
    pub list: ListBindings<'a>,
    pub points: &'a Buffer,
}

impl BorderMean {
    /// `boundary_operands`: some operand of the scene's solids has no equations.
    pub(crate) fn new(device: &Device, boundary_operands: bool) -> Result<Self, GpuError> {
        let constants = [
            (constant::SCENE_HAS_MESHES_OR_SOLIDS, 1),
            (constant::SOLIDS_HAVE_BOUNDARY_OPERANDS, u32::from(boundary_operands)),
        ];
        Ok(Self { kernel: Kernel::new(device, "border mean", &shaders::BORDER_MEAN_COMP, &constants)? })
    }

    /// One thread a pixel of the list.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>) {
        let images = [b.visibility.into(), b.meshes_and_solids.into(), b.resolved.into()];
        let lists = [b.list.pixels.into(), b.list.grids.into(), b.points.into()];
        let resources: Vec<_> = [b.frame.into()].into_iter().chain(images).chain(lists).collect();
        self.kernel.record_indirect(cmd, &resources, b.list.of_pixels());
    }
}
