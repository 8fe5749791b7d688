//! The frame's part for gaps between trimmed faces: the doubtful pixels, listed and then healed.

pub(crate) mod gap_fill;

use super::trim::TrimParts;
use super::{Frame, WRITE_TO_READ};
use crate::gpu::{Access, Commands, Resource, barrier};

impl Frame<'_> {
    /// Pixels that look through a gap between faces get the face that belongs there.
    pub(super) fn heal(&self, cmd: &Commands<'_>, parts: &TrimParts<'_>, test: &[Resource<'_>]) {
        let (s, b) = (self.scene, self.buffers);
        let (p, t) = (parts.passes, parts.buffers);
        let (w, r) = WRITE_TO_READ;
        barrier::images(cmd, &[(&b.visibility, Access::COLOUR_WRITE, w), (&b.depth, Access::DEPTH_WRITE, r)]);
        if let Some(others) = &b.others {
            barrier::images(cmd, &[(others, Access::COLOUR_WRITE, Access::COMPUTE_READ | Access::FRAGMENT_READ)]);
        }
        let cleared = Access { layout: w.layout, ..Access::TRANSFER_WRITE };
        barrier::buffers(
            cmd,
            &[
                (&t.rings, Access::FRAGMENT_WRITE, r),
                (&b.counters, Access::INDIRECT_READ, w),
                (&t.heal_dispatch, cleared, w),
            ],
        );
        let doubts = gap_fill::DoubtBindings {
            frame: self.constants,
            visibility: &b.visibility,
            doubts: &t.doubts,
            dispatch: &t.heal_dispatch,
            counters: &b.counters,
            depth: &b.depth,
            rings: &t.rings,
        };
        p.heal.find(cmd, &doubts);
        barrier::images(cmd, &[(&b.visibility, w, r)]);
        barrier::buffers(cmd, &[(&t.doubts, w, w), (&b.counters, w, r), (&t.heal_dispatch, w, Access::INDIRECT_READ)]);
        let heal = gap_fill::Bindings {
            frame: self.constants,
            placed: s.placed(self.views),
            visibility: &b.visibility,
            doubts: &t.doubts,
            counters: &b.counters,
            instances: &s.instances,
            others: b.others.as_ref().map(|seen| gap_fill::Others {
                seen,
                meshes: s.meshes.as_ref().map(|m| gap_fill::Meshes {
                    instances: &m.instances,
                    triangles: &m.triangles,
                    positions: &m.positions,
                }),
            }),
            trim: test,
            volume: self.volume(),
            dispatch: &t.heal_dispatch,
        };
        p.heal.record(cmd, &heal);
        barrier::images(cmd, &[(&b.visibility, r, w)]);
        barrier::buffers(cmd, &[(&t.doubts, w, r)]);
        p.heal.show(cmd, &heal);
    }
}
