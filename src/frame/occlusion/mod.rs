//! Patches that lie behind others: they are drawn only where that may show.
//!
//! ```text
//!   bound ──taus──▶ cull_early: what lay behind others a frame ago ─▶ not drawn ─▶ … visibility
//!                                                                                      │ depth
//!         depth_pyramid: the farthest of each tile ◀───────────────────────────────────┘
//!         cull_late: of each patch: wherever it could be seen, is there something nearer?
//!           yes ─▶ left out of the next frame          no, and it was not drawn ─▶ drawn now:
//!                                                      split, scan, emit, visibility once more
//! ```
//!
//! A view is right whatever the frame before left, and the picture is the same bit for bit as with every patch drawn: what
//! is left out would have lost the depth test at each pixel, and its skirts lie behind what is seen there. The derivation
//! stands in `twin::occlusion`. Only of faces that have the same depth to the bit another may be drawn first, and seen. If
//! the view has not changed since the last occlusion test, the test is skipped.

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

/// What a frame may take from the frames before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OcclusionState {
    /// Nothing, and it makes no test: the next frame may never come.
    First,
    /// Nothing, but it tests.
    Asks,
    /// The result of a test of another view.
    Moved,
    /// The result of a test of this view.
    Same,
}

/// The passes of scenes in which patches may lie behind others.
pub(crate) struct Passes {
    cull_early: cull_early::CullEarly,
    depth_pyramid: depth_pyramid::DepthPyramid,
    cull_late: cull_late::CullLate,
    reset: reset::Reset,
}

impl Passes {
    /// `None` where too few may.
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
    /// A word an item: whether the patch lay behind others in the last frame that had it in sight.
    hidden: Buffer,
    /// A float a square of pixels, then a tile, then a block of tiles.
    farthest: Buffer,
}

impl Occlusion {
    pub(super) fn new(room: &Room<'_>, passes: &Arc<Passes>) -> Result<Self, GpuError> {
        let levels = [SQUARE, TILE, TILE * BLOCK].map(|side| room.squares(side));
        Ok(Self {
            passes: Arc::clone(passes),
            hidden: room.words("hidden patches", room.counts.items)?,
            farthest: room.words("farthest depths", levels.into_iter().sum())?,
        })
    }

    /// Clears what `cull_early` reads in a first frame.
    pub(super) fn begin(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        if frame.occlusion == OcclusionState::First {
            cmd.fill(&self.hidden, 0);
        }
    }

    /// After `bound`: takes out what lay behind others.
    pub(super) fn cull_early(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let (taus, counters) = (&frame.stages.tessellation.taus, &frame.stages.common.counters);
        let (w, r) = WRITE_TO_READ;
        let cleared = Access::TRANSFER_WRITE;
        barrier::buffers(cmd, &[(taus, w, w), (&self.hidden, cleared | w, r), (counters, w, w)]);
        let (in_sight, items) = (frame.in_sight, frame.items_in_sight);
        let bindings = cull_early::Bindings { frame: frame.constants, hidden: &self.hidden, taus, counters, in_sight };
        self.passes.cull_early.record(cmd, &bindings, items);
        cmd.after(w, w);
    }

    /// This frame tests what lies behind what it draws.
    pub(super) fn tests(&self, frame: &Frame<'_>) -> bool {
        matches!(frame.occlusion, OcclusionState::Asks | OcclusionState::Moved)
    }

    /// After `visibility`: what lies behind what it drew; and where something had been left out that does not, that as
    /// well.
    pub(super) fn cull_late(&self, frame: &Frame<'_>, cmd: &Commands<'_>, test: &[Resource<'_>]) {
        let (s, c, v) = (frame.scene, &frame.stages.common, &frame.stages.visibility);
        let taus = &frame.stages.tessellation.taus;
        let (w, r) = WRITE_TO_READ;
        barrier::images(cmd, &[(&v.depth, Access::DEPTH_WRITE, r)]);
        cmd.after(r, w);
        let pyramid = depth_pyramid::Bindings { frame: frame.constants, depth: &v.depth, farthest: &self.farthest };
        self.passes.depth_pyramid.record(cmd, &pyramid);
        cmd.after(w | Access::INDIRECT_READ, r | w);
        let (in_sight, items) = (frame.in_sight, frame.items_in_sight);
        let bindings = cull_late::Bindings {
            frame: frame.constants,
            views: frame.views,
            instances: &s.instances,
            face_instances: &s.face_instances,
            faces: &s.faces,
            patches: &s.patches,
            points: &s.points,
            items: &s.items,
            farthest: &self.farthest,
            taus,
            hidden: &self.hidden,
            outside: s.outside(),
            counters: &c.counters,
            in_sight,
        };
        self.passes.cull_late.record(cmd, &bindings, items);
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
