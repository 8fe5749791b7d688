//! Gaps between trimmed faces: pixels that may look through one are listed, and get the face that belongs there.
//!
//! ```text
//!   visibility, border_depths ──gap_find──▶ candidates ──gap_fill──▶ who is seen there ──gap_write──▶ visibility
//! ```

mod capacities;
pub(crate) mod gap_fill;

pub(crate) use capacities::Capacities;

use super::common::room::{COUNTED, Room};
use super::{Frame, WRITE_TO_READ};
use crate::abi::GapCandidate;
use crate::gpu::{Access, Buffer, Commands, Device, GpuError, Image, Resource, barrier};
use crate::scene::{SceneData, SolidData};
use crate::shaders::TrimTest;
use ash::vk;
use std::sync::Arc;

/// Format of [`Gaps::border_depths`]: the bits of reversed depths.
const BORDER_DEPTH_FORMAT: vk::Format = vk::Format::R32_UINT;

/// The passes of scenes with trims, whose test is `test`.
pub(super) fn passes(device: &Device, data: &SceneData, test: &TrimTest) -> Result<gap_fill::GapFill, GpuError> {
    let meshes_and_solids = data.has_meshes() || data.solids.kinds().is_some();
    let volume = data.volume.as_ref().and_then(SolidData::kinds);
    gap_fill::GapFill::new(device, test, (data.has_rational, meshes_and_solids), volume)
}

/// The stage.
pub(crate) struct Gaps {
    passes: Arc<gap_fill::GapFill>,
    /// The depth of the nearest skirt at each pixel; 0 without one.
    pub border_depths: Image,
    candidates: Buffer,
    dispatch: Buffer,
}

impl Gaps {
    pub(super) fn new(room: &Room<'_>, passes: &Arc<gap_fill::GapFill>) -> Result<Self, GpuError> {
        Ok(Self {
            passes: Arc::clone(passes),
            border_depths: room.image("border depths", BORDER_DEPTH_FORMAT, COUNTED)?,
            candidates: room.structs::<GapCandidate>("gap candidates", room.capacities.gaps.candidates)?,
            dispatch: room.indirect::<[u32; 3]>("gap dispatch", 1)?,
        })
    }

    /// Before each drawing.
    pub(super) fn clear(&self, cmd: &Commands<'_>) {
        cmd.fill(&self.dispatch, 0);
        let (read, cleared, drawn) = (Access::COMPUTE_READ, Access::TRANSFER_WRITE, Access::FRAGMENT_WRITE);
        barrier::images(cmd, &[(&self.border_depths, (read | drawn).discarded(), cleared)]);
        cmd.clear(&self.border_depths, 0);
        barrier::images(cmd, &[(&self.border_depths, cleared, drawn)]);
    }

    /// Pixels that look through a gap between faces get the face that belongs there.
    pub(super) fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>, test: &[Resource<'_>]) {
        let (s, c, v) = (frame.scene, &frame.stages.common, &frame.stages.visibility);
        let (w, r) = WRITE_TO_READ;
        let borders = (&self.border_depths, Access::FRAGMENT_WRITE, r);
        barrier::images(cmd, &[(&v.image, Access::COLOUR_WRITE, w), (&v.depth, Access::DEPTH_WRITE, r), borders]);
        if let Some(meshes_and_solids) = &v.meshes_and_solids {
            barrier::images(
                cmd,
                &[(meshes_and_solids, Access::COLOUR_WRITE, Access::COMPUTE_READ | Access::FRAGMENT_READ)],
            );
        }
        barrier::buffers(cmd, &[(&c.counters, Access::INDIRECT_READ, w), (&self.dispatch, Access::TRANSFER_WRITE, w)]);
        let find = gap_fill::FindBindings {
            frame: frame.constants,
            visibility: &v.image,
            candidates: &self.candidates,
            dispatch: &self.dispatch,
            counters: &c.counters,
            depth: &v.depth,
            border_depths: &self.border_depths,
        };
        self.passes.find(cmd, &find);
        barrier::images(cmd, &[(&v.image, w, r)]);
        cmd.after(w, w | r | Access::INDIRECT_READ);
        let fill = gap_fill::Bindings {
            frame: frame.constants,
            placed: s.placed(frame.views),
            visibility: &v.image,
            candidates: &self.candidates,
            counters: &c.counters,
            instances: &s.instances,
            meshes_and_solids: v.meshes_and_solids.as_ref().map(|seen| gap_fill::MeshesAndSolids {
                seen,
                meshes: s.meshes.as_ref().map(|m| gap_fill::Meshes {
                    instances: &m.instances,
                    triangles: &m.triangles,
                    positions: &m.positions,
                }),
            }),
            trim: test,
            volume: frame.volume(),
            dispatch: &self.dispatch,
        };
        self.passes.record(cmd, &fill);
        barrier::images(cmd, &[(&v.image, r, w)]);
        cmd.after(w, r);
        self.passes.show(cmd, &fill);
    }
}
