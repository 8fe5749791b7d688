//! Pass `edge_fold`: outlines of curved faces, as lines.
//!
//! ```text
//!   pixel, and one around that sees a curved face ──look──▶ the exact fold next to the pixel ──test──▶ each pixel's best line
//! ```
//!
//! Two steps, each with a thread for each entry of its list: few searches find a fold. Reads: everything that `Bindings`
//! names. Writes: folds of `starts`; `best`, as pass `edge_line`.

use crate::abi::constants::line_list::{STEP_FOUND, STEP_LOOK};
use crate::bindings::{Placed, SeenSolids};
use crate::frame::common::kernel::Kernel;
use crate::frame::common::line_items::LineItems;
use crate::gpu::{Buffer, Commands, Device, GpuError, Image, Resource};
use crate::scene::MeshBuffers;
use crate::shaders::{self, TrimTest, constant};
use bytemuck::{Pod, Zeroable};

/// The pass.
pub(crate) struct Fold {
    look: Kernel,
    test: Kernel,
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
    pub starts: &'a LineItems,
    /// What the trim test reads, in its order.
    pub trim: &'a [Resource<'a>],
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Params {
    half_px: f32,
    capacity: u32,
}

impl Fold {
    /// `test`: how faces are trimmed; `None` where none is.
    pub(crate) fn new(device: &Device, constants: &[(u32, u32)], test: Option<&TrimTest>) -> Result<Self, GpuError> {
        let tested = test.and_then(|test| test.edge_fold.map(|shader| (test.way, shader)));
        let (way, shader) = tested.unwrap_or(("no trims", &shaders::EDGE_FOLD_PLAIN_COMP));
        let kernel = |name: &str, step: u32| {
            let constants: Vec<_> = constants.iter().copied().chain([(constant::LINE_STEP, step)]).collect();
            Kernel::new(device, &format!("{name} ({way})"), shader, &constants)
        };
        Ok(Self {
            look: kernel("edge_fold", STEP_LOOK)?,
            test: kernel("edge_fold found", STEP_FOUND)?,
            tests: tested.is_some(),
        })
    }

    /// Lines are twice `half_px` wide. `between` stands between both steps.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, half_px: f32, between: impl FnOnce()) {
        let meshes = b.meshes.map_or([b.frame; 3], |m| [&m.instances, &m.triangles, &m.positions]);
        let resources: Vec<_> = [b.frame.into()]
            .into_iter()
            .chain(b.placed.resources())
            .chain([b.visibility.into(), b.meshes_and_solids.into(), b.best.into()])
            .chain(meshes.map(Resource::from))
            .chain(b.solids.resources())
            .chain([Resource::from(&b.starts.buffer)])
            .chain(b.trim.iter().copied().filter(|_| self.tests))
            .collect();
        let params = Params { half_px, capacity: b.starts.capacity };
        let step = |kernel: &Kernel, (arguments, offset): (&Buffer, u64)| {
            kernel.bind(cmd, &resources, bytemuck::bytes_of(&params));
            cmd.dispatch_indirect(arguments, offset);
        };
        step(&self.look, b.starts.of_items());
        between();
        step(&self.test, b.starts.of_found());
    }
}
