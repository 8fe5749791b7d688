//! Occlusion culling: patches that other surfaces hide are not drawn.
//!
//! ```text
//!   bound ──taus──▶ cull_early: hidden in the previous frame ─▶ not drawn ─▶ … visibility
//!                                                                                 │ depth
//!         depth_pyramid: farthest depth of each tile ◀────────────────────────────┘
//!         cull_late: is the whole patch behind surfaces that are drawn?
//!           yes ─▶ not drawn in the next frame       no, and it was not drawn ─▶ drawn now:
//!                                                    split, scan, emit, visibility again
//! ```
//!
//! The picture is the same, bit for bit, as with every patch drawn, whatever the previous frame contained. A culled
//! patch would fail the depth test at each pixel, and its skirts lie behind visible surfaces; `twin::occlusion` has the
//! derivation. One exception: of faces at exactly the same depth, another one may be drawn first and be visible. If the
//! view has not changed since the last occlusion test, the test is skipped.

pub(crate) mod cull_early;
pub(crate) mod cull_late;
pub(crate) mod depth_pyramid;

use super::common::reset;
use super::common::room::Room;
use super::{Frame, WRITE_TO_READ};
use crate::abi::{BLOCK, SQUARE, TILE};
use crate::gpu::{Access, Buffer, Commands, Device, GpuError, Resource, barrier};
use crate::scene::SceneData;
use std::sync::Arc;

/// What a frame may take over from the previous frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OcclusionState {
    /// Nothing. It makes no test, since there may be no next frame.
    First,
    /// Nothing. It makes a test.
    Asks,
    /// The result of a test for another view.
    Moved,
    /// The result of a test for this view.
    Same,
}

/// The passes of scenes with occlusion culling.
pub(crate) struct Passes {
    cull_early: cull_early::CullEarly,
    depth_pyramid: depth_pyramid::DepthPyramid,
    cull_late: cull_late::CullLate,
    reset: reset::Reset,
}

impl Passes {
    /// `None` in scenes without occlusion culling.
    pub(super) fn new(device: &Device, data: &SceneData) -> Result<Option<Self>, GpuError> {
        if !data.hides() {
            return Ok(None);
        }
        Ok(Some(Self {
            cull_early: cull_early::CullEarly::new(device)?,
            depth_pyramid: depth_pyramid::DepthPyramid::new(device)?,
            cull_late: cull_late::CullLate::new(device, data.has_rational)?,
            reset: reset::Reset::new(device, true)?,
        }))
    }
}

/// The stage.
pub(crate) struct Occlusion {
    passes: Arc<Passes>,
    /// One word a patch instance: whether the patch was hidden in the last frame that had it in sight.
    hidden: Buffer,
    /// One float a square of pixels, then one a tile, then one a block of tiles.
    farthest: Buffer,
}

impl Occlusion {
    pub(super) fn new(room: &Room<'_>, passes: &Arc<Passes>) -> Result<Self, GpuError> {
        let levels = [SQUARE, TILE, TILE * BLOCK].map(|side| room.squares(side));
        Ok(Self {
            passes: Arc::clone(passes),
            hidden: room.words("hidden patches", room.counts.patch_instances)?,
            farthest: room.words("farthest depths", levels.into_iter().sum())?,
        })
    }

    /// Clears the input of `cull_early` in a first frame.
    pub(super) fn begin(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        if frame.occlusion == OcclusionState::First {
            cmd.fill(&self.hidden, 0);
        }
    }

    /// After `bound`: removes patches that were hidden in the previous frame.
    pub(super) fn cull_early(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let (taus, counters) = (&frame.stages.tessellation.taus, &frame.stages.common.counters);
        let (w, r) = WRITE_TO_READ;
        let cleared = Access::TRANSFER_WRITE;
        barrier::buffers(cmd, &[(taus, w, w), (&self.hidden, cleared | w, r), (counters, w, w)]);
        let (in_sight, patch_instances) = (frame.in_sight, frame.patch_instances_in_sight);
        let bindings = cull_early::Bindings { frame: frame.constants, hidden: &self.hidden, taus, counters, in_sight };
        self.passes.cull_early.record(cmd, &bindings, patch_instances);
        cmd.after(w, w);
    }

    /// Whether this frame tests which patches are hidden.
    pub(super) fn tests(&self, frame: &Frame<'_>) -> bool {
        matches!(frame.occlusion, OcclusionState::Asks | OcclusionState::Moved)
    }

    /// After `visibility`: finds the hidden patches. Draws patches that were not drawn and may be visible.
    pub(super) fn cull_late(&self, frame: &Frame<'_>, cmd: &Commands<'_>, test: &[Resource<'_>]) {
        let (s, c, v) = (frame.scene, &frame.stages.common, &frame.stages.visibility);
        let taus = &frame.stages.tessellation.taus;
        let (w, r) = WRITE_TO_READ;
        barrier::images(cmd, &[(&v.depth, Access::DEPTH_WRITE, r)]);
        cmd.after(r, w);
        let pyramid = depth_pyramid::Bindings { frame: frame.constants, depth: &v.depth, farthest: &self.farthest };
        self.passes.depth_pyramid.record(cmd, &pyramid);
        cmd.after(w | Access::INDIRECT_READ, r | w);
        let (in_sight, patch_instances) = (frame.in_sight, frame.patch_instances_in_sight);
        let bindings = cull_late::Bindings {
            frame: frame.constants,
            views: frame.views,
            instances: &s.instances,
            face_instances: &s.face_instances,
            faces: &s.faces,
            patches: &s.patches,
            points: &s.points,
            patch_instances: &s.patch_instances,
            farthest: &self.farthest,
            taus,
            hidden: &self.hidden,
            outside: s.outside(),
            counters: &c.counters,
            in_sight,
        };
        self.passes.cull_late.record(cmd, &bindings, patch_instances);
        barrier::images(cmd, &[(&v.depth, r, Access::DEPTH_WRITE)]);
        if frame.occlusion != OcclusionState::Moved {
            cmd.after(w, Access::INDIRECT_READ);
            return;
        }
        barrier::images(cmd, &[(&v.image, Access::COLOUR_WRITE, Access::COLOUR_WRITE)]);
        cmd.after(Access::INDIRECT_READ | w, w);
        let draws = reset::Bindings { frame: frame.constants, draws: &c.draws, counters: &c.counters };
        self.passes.reset.record(cmd, &draws, 2 * frame.capacities.tessellation.draws);
        cmd.after(w, w);
        frame.stages.tessellation.begin_again(cmd);
        frame.stages.tessellation.split(frame, cmd);
        if frame.counts_first {
            c.gate(cmd);
        }
        frame.stages.visibility.patches(frame, cmd, test, true);
    }
}
