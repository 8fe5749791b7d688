//! Divides each patch of the faces in sight, without those of parts that are hidden as a whole, and makes the
//! sub-patches and draws.
//!
//! ```text
//!   occlusion::list_parts: parts that were not hidden, in scenes of many placed parts
//!   bound    tau per patch ──occlusion::cull_early──▶ 0 for patches that were hidden
//!   split    segments per side; the list of each patch: plain, trimmed, by its corners
//!     │(scan) sub-patches, vertices
//!   emit     lists and draws
//! ```
//!
//! In scenes of many patches, plain patches of one segment a side have a list of their own (`scene/corners.rs`). Pass
//! `visibility` draws them by their corners, without tessellation stages.

pub(crate) mod bound;
mod capacities;
mod divide;
pub(crate) mod emit;
pub(crate) mod split;

pub(crate) use capacities::Capacities;

use super::common::PatchList;
use super::common::room::Room;
use super::{Frame, WRITE_TO_READ};
use crate::abi::{Factors, SubPatch};
use crate::gpu::{Access, Buffer, Commands, Device, GpuError};
use crate::scene::SceneData;
use divide::DividePass;
use std::sync::Arc;

/// The passes.
pub(crate) struct Passes {
    divide: DividePass,
    split: split::Split,
    emit: emit::Emit,
}

impl Passes {
    /// `None` in a scene without patches.
    pub(super) fn new(device: &Device, data: &SceneData) -> Result<Option<Self>, GpuError> {
        if data.patch_instances.is_empty() {
            return Ok(None);
        }
        Ok(Some(Self {
            divide: DividePass::new(device, data)?,
            split: split::Split::new(device, !data.links.is_empty())?,
            emit: emit::Emit::new(device)?,
        }))
    }
}

/// The stage. Every pass that draws patches binds its lists. In a scene without patches they are empty, and there are
/// no passes.
pub(crate) struct Tessellation {
    passes: Option<Arc<Passes>>,
    pub taus: Buffer,
    pub factors: Buffer,
    pub sub_patches: Buffer,
    sub_patch_counts: Buffer,
    sub_patch_starts: Buffer,
    vertex_counts: Buffer,
    vertex_starts: Buffer,
}

impl Tessellation {
    pub(super) fn new(room: &Room<'_>, passes: Option<&Arc<Passes>>) -> Result<Self, GpuError> {
        let n = room.counts.patch_instances;
        let counted = room.counts.patch_lists() * n;
        Ok(Self {
            passes: passes.cloned(),
            taus: room.words("taus", n)?,
            factors: room.structs::<Factors>("factors", n)?,
            sub_patches: room.structs::<SubPatch>("sub-patches", room.capacities.tessellation.sub_patches)?,
            sub_patch_counts: room.words("sub-patch counts", counted + 1)?,
            sub_patch_starts: room.words("sub-patch starts", counted + 2)?,
            vertex_counts: room.words("vertex counts", counted + 1)?,
            vertex_starts: room.words("vertex starts", counted + 2)?,
        })
    }

    /// Divides every patch that may be visible.
    pub(super) fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        if self.passes.is_none() {
            return;
        }
        let (w, r) = WRITE_TO_READ;
        if let Some(occlusion) = &frame.stages.occlusion {
            occlusion.list_parts(frame, cmd);
        }
        self.divide(frame, cmd);
        if let Some(occlusion) = &frame.stages.occlusion {
            occlusion.cull_early(frame, cmd);
        }
        cmd.after(w, r);
        self.split(frame, cmd);
    }

    /// Bounds how finely each listed patch must be divided: writes `taus`.
    pub(super) fn divide(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        if let Some(passes) = &self.passes {
            passes.divide.record(frame, cmd, &self.taus);
        }
    }

    /// Makes sub-patches and their draws.
    pub(super) fn split(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let Some(p) = &self.passes else { return };
        let (s, c) = (frame.scene, &frame.stages.common);
        let PatchList { runs, threads } = frame.patch_list();
        let most = (frame.counts.patch_lists(), frame.counts.patch_instances);
        let (w, r) = WRITE_TO_READ;
        let split = split::Bindings {
            frame: frame.constants,
            face_instances: &s.face_instances,
            faces: &s.faces,
            patches: &s.patches,
            patch_instances: &s.patch_instances,
            taus: &self.taus,
            factors: &self.factors,
            sub_patch_counts: &self.sub_patch_counts,
            vertex_counts: &self.vertex_counts,
            runs,
            links: s.links.as_ref(),
        };
        p.split.record(cmd, &split, threads);
        cmd.after(w, r);

        c.scan_listed(cmd, (&self.sub_patch_counts, &self.sub_patch_starts), threads, most);
        c.scan_listed(cmd, (&self.vertex_counts, &self.vertex_starts), threads, most);
        cmd.after(w, r | w);

        let emit = emit::Bindings {
            frame: frame.constants,
            factors: &self.factors,
            sub_patch_starts: &self.sub_patch_starts,
            vertex_starts: &self.vertex_starts,
            sub_patches: &self.sub_patches,
            draws: &c.draws,
            counters: &c.counters,
            runs,
        };
        p.emit.record(cmd, &emit, threads);
        cmd.after(w, Access::VERTEX_READ | Access::INDIRECT_READ | w);
    }

    /// Before patches are divided a second time: the reads of the first division must be complete.
    pub(super) fn begin_again(&self, cmd: &Commands<'_>) {
        let (w, r) = WRITE_TO_READ;
        cmd.after(w | Access::VERTEX_READ, r | w);
    }
}
