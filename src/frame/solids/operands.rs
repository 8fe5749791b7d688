//! Crossings of rays with operands without equations: fragments of each pixel of a band, counted, stored and sorted.

use super::bands::Band;
use super::buffers::FragmentBuffers;
use super::{SolidParts, operand_mesh, operand_patch, operand_sort};
use crate::abi::TILE;
use crate::frame::common::room::Room;
use crate::frame::{Frame, WRITE_TO_READ};
use crate::gpu::{Access, Commands, Device, GpuError, barrier};
use crate::scene::{BoundaryOperands, SceneData};
use crate::shaders::TrimTest;
use std::sync::Arc;

/// The passes.
pub(super) struct OperandPasses {
    meshes: Option<operand_mesh::OperandMesh>,
    patches: Option<operand_patch::OperandPatch>,
    sort: operand_sort::OperandSort,
}

impl OperandPasses {
    pub(super) fn new(device: &Device, data: &SceneData, trim: Option<&TrimTest>) -> Result<Self, GpuError> {
        let meshes = !data.solids.operand_draws.is_empty();
        let plain = (data.has_plain, !data.links.is_empty());
        let patches = || operand_patch::OperandPatch::new(device, data.has_rational, plain, trim);
        Ok(Self {
            meshes: meshes.then(|| operand_mesh::OperandMesh::new(device)).transpose()?,
            patches: data.has_operands.then(patches).transpose()?,
            sort: operand_sort::OperandSort::new(device)?,
        })
    }
}

/// The passes and their fragments.
pub(super) struct Operands {
    passes: Arc<OperandPasses>,
    pub(super) fragments: FragmentBuffers,
}

impl Operands {
    pub(super) fn new(room: &Room<'_>, passes: &Arc<OperandPasses>) -> Result<Self, GpuError> {
        Ok(Self { passes: Arc::clone(passes), fragments: FragmentBuffers::new(room)? })
    }

    /// Counts, stores and sorts the fragments of a band.
    pub(super) fn record(
        &self,
        frame: &Frame<'_>,
        cmd: &Commands<'_>,
        (solids, boundary_operands): (&SolidParts<'_>, &BoundaryOperands),
        band: &Band,
    ) {
        let (s, stages) = (frame.scene, frame.stages);
        let (c, t) = (&stages.common, &stages.tessellation);
        let (passes, f) = (&self.passes, &self.fragments);
        let size = stages.visibility.image.size();
        let rows = || band.rows.clone();
        let trim = frame.trim_test();
        let meshes = operand_mesh::Bindings {
            frame: frame.constants,
            views: frame.views,
            meshes: &boundary_operands.meshes,
            triangles: &boundary_operands.triangles,
            positions: &boundary_operands.positions,
            planes: &boundary_operands.planes,
            surfaces: &solids.scene.surfaces,
            surface_places: solids.centres.surfaces,
            counts: &f.counts,
            starts: &f.starts,
            fragments: &f.all,
        };
        let patches = operand_patch::Bindings {
            frame: frame.constants,
            placed: s.placed(frame.views),
            factors: &t.factors,
            sub_patches: &t.sub_patches,
            instances: &s.instances,
            counts: &f.counts,
            starts: &f.starts,
            fragments: &f.all,
            trim: &trim,
            links: s.links.as_ref(),
            draws: &c.draws,
            counters: &c.counters,
        };
        let rastered = |fills: bool| {
            if let Some(pass) = &passes.meshes {
                pass.record(cmd, &meshes, (size, rows()), &boundary_operands.draws, fills);
            }
            if let Some(pass) = &passes.patches {
                pass.record(cmd, &patches, (size, rows()), frame.capacities.tessellation.draws, fills);
            }
        };
        let (w, r) = WRITE_TO_READ;
        let drawn = Access::FRAGMENT_WRITE;
        // reads by the drawing before, of another band or another sample
        let followed = Access::FRAGMENT_READ | r;
        barrier::buffers(
            cmd,
            &[
                (&f.counts, Access::TRANSFER_WRITE, drawn),
                (&f.all, followed, drawn),
                (&c.counters, w, Access::INDIRECT_READ),
            ],
        );
        rastered(false);
        cmd.after(drawn | followed, r | w | drawn);
        c.scan(cmd, &f.counts, &f.starts, size.0 * rows().len() as u32);
        cmd.after(w, drawn | Access::FRAGMENT_READ | r);
        rastered(true);
        cmd.after(drawn | Access::INDIRECT_READ, w);
        let sort = operand_sort::Bindings {
            frame: frame.constants,
            leaves: &solids.scene.leaves,
            leaf_centres: solids.centres.leaves,
            operand_leaves: &boundary_operands.leaves,
            starts: &f.starts,
            counts: &f.counts,
            fragments: &f.all,
            counters: &c.counters,
        };
        let [columns, seen] = frame.operand_pixels.clone();
        let first = (seen.start / TILE * TILE).max(band.rows.start);
        let part = first - band.rows.start..seen.end.min(band.rows.end).max(first) - band.rows.start;
        passes.sort.record(cmd, &sort, columns, part);
        cmd.after(w, Access::FRAGMENT_READ | w);
    }
}
