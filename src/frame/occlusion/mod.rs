//! The frame's part for patches that lie behind others: they are drawn only where that may show.
//!
//! ```text
//!   bound ──taus──▶ hide: what lay behind others a frame ago ─▶ not drawn ─▶ … visibility
//!                                                                                │ depth
//!         farthest: of each tile ◀───────────────────────────────────────────────┘
//!         reveal: of each patch: wherever it could be seen, is there something nearer?
//!           yes ─▶ left out of the next frame          no, and it was not drawn ─▶ drawn now:
//!                                                      split, scan, emit, visibility once more
//! ```
//!
//! So a view is right whatever was known before, and the picture the same bit for bit as with every patch drawn: what is
//! left out would have lost the depth test at each pixel, and its rings lie behind what is seen there. The derivation
//! stands in `twin::occlusion`. Only of faces that have the same depth to the bit another may be drawn first, and seen. A
//! view that is the same as that which told draws once, and asks nothing.

pub(crate) mod cull_early;
pub(crate) mod cull_late;
pub(crate) mod depth_pyramid;

use super::{Frame, TessellationPasses, WRITE_TO_READ, WRITE_TO_WRITE};
use crate::frame::buffers::HiddenBuffers;
use crate::frame::common::reset;
use crate::gpu::{Access, Commands, Device, GpuError, Resource, barrier};
use crate::scene::SceneData;

/// What a frame knows of patches that lie behind others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Hiding {
    /// Nothing, and it asks nothing: the next frame may never come.
    First,
    /// Nothing, but it asks.
    Asks,
    /// What the frame before told of another view.
    Moved,
    /// What a frame told of this view.
    Same,
}

/// The passes of scenes in which patches may lie behind others.
pub(super) struct HiddenPasses {
    cull_early: cull_early::CullEarly,
    depth_pyramid: depth_pyramid::DepthPyramid,
    cull_late: cull_late::CullLate,
    reset: reset::Reset,
}

impl HiddenPasses {
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

/// What they work on.
#[derive(Clone, Copy)]
pub(super) struct HiddenParts<'a> {
    passes: &'a HiddenPasses,
    buffers: &'a HiddenBuffers,
}

impl<'a> Frame<'a> {
    /// `None` where too few patches may lie behind others.
    pub(super) fn hidden(&self) -> Option<HiddenParts<'a>> {
        let (passes, buffers) = self.passes.hidden.as_ref().zip(self.buffers.hidden.as_ref())?;
        Some(HiddenParts { passes, buffers })
    }

    /// The same in a frame that asks.
    pub(super) fn reveals(&self) -> Option<HiddenParts<'a>> {
        self.hidden().filter(|_| matches!(self.hiding, Hiding::Asks | Hiding::Moved))
    }
}

impl<'a> HiddenParts<'a> {
    /// Clears what `hide` reads in a first frame.
    pub(super) fn begin(&self, cmd: &Commands<'_>, hiding: Hiding) {
        if hiding == Hiding::First {
            cmd.fill(&self.buffers.hidden, 0);
        }
    }

    /// After `bound`: takes out what lay behind others.
    pub(super) fn hide(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let (b, h) = (frame.buffers, self.buffers);
        let (w, r) = WRITE_TO_READ;
        let cleared = Access { layout: w.layout, ..Access::TRANSFER_WRITE };
        barrier::buffers(cmd, &[(&b.taus, w, w), (&h.hidden, cleared | w, r), (&b.counters, w, w)]);
        let bindings =
            cull_early::Bindings { frame: frame.constants, hidden: &h.hidden, taus: &b.taus, counters: &b.counters };
        self.passes.cull_early.record(cmd, &bindings, b.counts.items);
        barrier::buffers(cmd, &[(&b.counters, w, w)]);
    }

    /// After `visibility`: what lies behind what it drew; and where something had been left out that does not, that as
    /// well.
    pub(super) fn reveal(
        &self,
        frame: &Frame<'_>,
        cmd: &Commands<'_>,
        tessellation: &TessellationPasses,
        test: &[Resource<'_>],
    ) {
        let (s, b, h) = (frame.scene, frame.buffers, self.buffers);
        let Some(outside) = &s.outside else { unreachable!("made with the passes") };
        let (w, r) = WRITE_TO_READ;
        barrier::images(cmd, &[(&b.depth, Access::DEPTH_WRITE, r)]);
        barrier::buffers(cmd, &[(&h.farthest, r, w)]);
        self.passes
            .depth_pyramid
            .record(cmd, &depth_pyramid::Bindings { frame: frame.constants, depth: &b.depth, farthest: &h.farthest });
        barrier::buffers(
            cmd,
            &[(&h.farthest, w, r), (&b.taus, r, w), (&h.hidden, r, w), (&b.counters, Access::INDIRECT_READ, w)],
        );
        let bindings = cull_late::Bindings {
            frame: frame.constants,
            views: frame.views,
            instances: &s.instances,
            face_instances: &s.face_instances,
            faces: &s.faces,
            patches: &s.patches,
            points: &s.points,
            items: &s.items,
            farthest: &h.farthest,
            taus: &b.taus,
            hidden: &h.hidden,
            outside,
            counters: &b.counters,
        };
        self.passes.cull_late.record(cmd, &bindings, b.counts.items);
        barrier::images(cmd, &[(&b.depth, r, Access::DEPTH_WRITE)]);
        if frame.hiding != Hiding::Moved {
            barrier::buffers(cmd, &[(&b.counters, w, Access::INDIRECT_READ)]);
            return;
        }
        barrier::images(cmd, &[(&b.visibility, Access::COLOUR_WRITE, Access::COLOUR_WRITE)]);
        let (w1, w2) = WRITE_TO_WRITE;
        barrier::buffers(cmd, &[(&b.draws, Access::INDIRECT_READ, w), (&b.counters, w1, w2)]);
        let r_draws = reset::Bindings { frame: frame.constants, draws: &b.draws, counters: &b.counters };
        self.passes.reset.record(cmd, &r_draws, 2 * b.capacities.draws);
        barrier::buffers(
            cmd,
            &[
                (&b.draws, w1, w2),
                (&b.counters, w1, w2),
                (&b.taus, w, r),
                (&b.factors, Access::VERTEX_READ | r, w),
                (&b.sub_patches, Access::VERTEX_READ, w),
                (&b.sub_patch_counts, r, w),
                (&b.vertex_counts, r, w),
                (&b.sub_patch_starts, r, w),
                (&b.vertex_starts, r, w),
            ],
        );
        frame.divide(cmd, tessellation);
        frame.visibility(cmd, test, true);
    }
}
