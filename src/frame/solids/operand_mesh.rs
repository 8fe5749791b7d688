//! Pass `operand_mesh`: the crossings of rays with the meshes of operands.
//!
//! ```text
//!   triangles ──raster, no depth test──▶ fragments of each pixel: counted, then stored from the pixel's prefix sum
//!                                        on: operand, side, depth of the triangle's plane
//! ```
//!
//! Reads: everything that `Bindings` names except its outputs. Writes: `counts`; in the second step `counts`, which
//! return to 0, and `fragments`.

use crate::frame::common::draw::Draw;
use crate::gpu::{Buffer, Commands, Device, GpuError, Pipeline, Resource, TexelBuffer};
use crate::shaders::{self, constant};
use std::ops::Range;

/// The pass, in its two steps.
pub(crate) struct OperandMesh {
    count: Pipeline,
    fill: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub views: &'a Buffer,
    pub meshes: &'a Buffer,
    pub triangles: &'a Buffer,
    pub positions: &'a Buffer,
    /// The surface of each triangle that shares its plane.
    pub planes: &'a Buffer,
    pub surfaces: &'a TexelBuffer,
    /// In model axes, relative to the eye.
    pub surface_places: &'a TexelBuffer,
    pub counts: &'a Buffer,
    pub starts: &'a Buffer,
    pub fragments: &'a Buffer,
}

impl OperandMesh {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let pipeline = |name, fills: bool| {
            // triangles are planes
            let constants = [(constant::SOLIDS_HAVE, 0), (constant::FILLS, u32::from(fills))];
            let draw = Draw::new(name, &shaders::OPERAND_MESH_VERT, &shaders::OPERAND_MESH_FRAG);
            Draw { constants: &constants, ..draw }.pipeline(device)
        };
        Ok(Self { count: pipeline("operand mesh (count)", false)?, fill: pipeline("operand mesh (fill)", true)? })
    }

    /// Counts the fragments of each pixel in these rows of a picture of this size, or stores them (`fills`). `draws`
    /// has the corners of each mesh, in order.
    pub(crate) fn record(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        (size, rows): ((u32, u32), Range<u32>),
        draws: &[Range<u32>],
        fills: bool,
    ) {
        let placed = [b.frame, b.views, b.meshes, b.triangles, b.positions];
        let lists = [b.counts, b.starts, b.fragments].map(Resource::from);
        let planes = [b.planes.into(), b.surfaces.into(), b.surface_places.into()];
        let resources: Vec<_> = placed.map(Resource::from).into_iter().chain(planes).chain(lists).collect();
        cmd.rendering_rows((size, rows), &[], None, || {
            cmd.bind(if fills { &self.fill } else { &self.count }, &resources, &[]);
            for (mesh, corners) in (0..).zip(draws) {
                cmd.draw_instances(corners.clone(), mesh..mesh + 1);
            }
        });
    }
}
