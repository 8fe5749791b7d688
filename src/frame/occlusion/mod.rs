//! Occlusion culling: patches that other surfaces hide are not drawn. In scenes of many placed parts, nothing is
//! computed for the patches of a part that is hidden as a whole ([`parts`]).
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
//! derivation. One exception: of faces at exactly the same depth, another one may be drawn first and be visible; two
//! rare ones are in `docs/design/culling.md`. If the view has not changed since the last occlusion test, the test is
//! skipped.

pub(crate) mod cull_early;
pub(crate) mod cull_late;
pub(crate) mod cull_parts;
pub(crate) mod depth_pyramid;
pub(crate) mod part_counts;
pub(crate) mod part_runs;
mod parts;

use super::common::room::Room;
use super::common::{PatchList, reset};
use super::{Frame, WRITE_TO_READ};
use crate::abi::{BLOCK, LIST_FIRST, TILE, square_side};
use crate::gpu::{Access, Buffer, Commands, Device, GpuError, Resource, barrier};
use crate::scene::SceneData;
use parts::Parts;
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

impl OcclusionState {
    /// Whether the frame tests which patches are hidden.
    pub(crate) fn tests(self) -> bool {
        matches!(self, Self::Asks | Self::Moved)
    }
}

/// The passes of scenes with occlusion culling.
pub(crate) struct Passes {
    cull_early: cull_early::CullEarly,
    depth_pyramid: depth_pyramid::DepthPyramid,
    cull_late: cull_late::CullLate,
    reset: reset::Reset,
    /// In scenes of many placed parts.
    parts: Option<Arc<parts::Passes>>,
}

impl Passes {
    /// `None` in scenes without occlusion culling.
    pub(super) fn new(device: &Device, data: &SceneData) -> Result<Option<Self>, GpuError> {
        if !data.hides() {
            return Ok(None);
        }
        Ok(Some(Self {
            cull_early: cull_early::CullEarly::new(device, false)?,
            depth_pyramid: depth_pyramid::DepthPyramid::new(device)?,
            cull_late: cull_late::CullLate::new(device, data.has_rational)?,
            reset: reset::Reset::new(device, true)?,
            parts: parts::Passes::new(device, data)?.map(Arc::new),
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
    parts: Option<Parts>,
}

impl Occlusion {
    pub(super) fn new(room: &Room<'_>, passes: &Arc<Passes>) -> Result<Self, GpuError> {
        let levels = [square_side(room.size.into()), TILE, TILE * BLOCK].map(|side| room.squares(side));
        Ok(Self {
            passes: Arc::clone(passes),
            hidden: room.words("hidden patches", room.counts.patch_instances)?,
            farthest: room.words("farthest depths", levels.into_iter().sum())?,
            parts: passes.parts.as_ref().map(|passes| Parts::new(room, passes)).transpose()?,
        })
    }

    /// Clears the results of occlusion tests in a first frame.
    pub(super) fn begin(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        if frame.occlusion == OcclusionState::First {
            cmd.fill(&self.hidden, 0);
            self.parts.iter().for_each(|parts| parts.begin(cmd));
        }
    }

    /// Before `bound`: lists the placed parts that were not hidden in the previous frame.
    pub(super) fn list_parts(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        if let Some(parts) = &self.parts {
            parts.list(frame, cmd, LIST_FIRST);
        }
    }

    /// The patch instances of listed parts; `None` if all parts in sight count as listed.
    pub(super) fn patch_list(&self) -> Option<PatchList<'_>> {
        self.parts.as_ref().map(Parts::patch_list)
    }

    /// After `bound`: removes patches that were hidden in the previous frame.
    pub(super) fn cull_early(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let (taus, counters) = (&frame.stages.tessellation.taus, &frame.stages.common.counters);
        let (w, r) = WRITE_TO_READ;
        let cleared = Access::TRANSFER_WRITE;
        barrier::buffers(cmd, &[(taus, w, w), (&self.hidden, cleared | w, r), (counters, w, w)]);
        let PatchList { runs, threads } = frame.patch_list();
        let bindings = cull_early::Bindings { frame: frame.constants, hidden: &self.hidden, taus, counters, runs };
        self.passes.cull_early.record(cmd, &bindings, threads);
        cmd.after(w, w);
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
        if let Some(parts) = &self.parts {
            parts.cull(frame, cmd, &self.farthest);
            if frame.occlusion == OcclusionState::Moved {
                parts.appear(frame, cmd, &self.hidden);
            }
        }
        let PatchList { runs, threads } = frame.patch_list();
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
            runs,
        };
        self.passes.cull_late.record(cmd, &bindings, threads);
        barrier::images(cmd, &[(&v.depth, r, Access::DEPTH_WRITE)]);
        if frame.occlusion != OcclusionState::Moved {
            cmd.after(w, Access::INDIRECT_READ);
            return;
        }
        barrier::images(cmd, &[(&v.image, Access::COLOUR_WRITE, Access::COLOUR_WRITE)]);
        cmd.after(Access::INDIRECT_READ | w, w);
        let draws = reset::Bindings { frame: frame.constants, draws: &c.draws, counters: &c.counters };
        self.passes.reset.record(cmd, &draws, frame.counts.patch_lists() * frame.capacities.tessellation.draws);
        cmd.after(w, w);
        frame.stages.tessellation.begin_again(cmd);
        frame.stages.tessellation.split(frame, cmd);
        if frame.counts_first {
            c.gate(cmd);
        }
        frame.stages.visibility.patches(frame, cmd, test, true);
    }
}
