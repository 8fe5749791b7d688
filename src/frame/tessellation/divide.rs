//! Computes how finely patches are divided: by pass `bound`, or by a baseline's pass.

use crate::bindings::Bounded;
use crate::frame::Frame;
#[cfg(feature = "baselines")]
use crate::frame::baselines::slefe;
use crate::frame::common::PatchList;
use crate::frame::tessellation::bound;
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::scene::{Division, SceneData};

/// The pass of a scene.
pub(super) enum DividePass {
    Bound(bound::Bound),
    #[cfg(feature = "baselines")]
    Slefe(slefe::BaselineSlefe),
}

impl DividePass {
    pub(super) fn new(device: &Device, data: &SceneData) -> Result<Self, GpuError> {
        let cones = !data.cones.is_empty();
        Ok(match data.division {
            Division::Bound => Self::Bound(bound::Bound::new(device, cones)?),
            #[cfg(feature = "baselines")]
            Division::Slefe(_) => Self::Slefe(slefe::BaselineSlefe::new(device, cones)?),
        })
    }

    /// Writes `taus`, and counts clamps.
    pub(super) fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>, taus: &Buffer) {
        let s = frame.scene;
        let PatchList { runs, threads } = frame.patch_list();
        let bounded = Bounded {
            frame: frame.constants,
            views: frame.views,
            instances: &s.instances,
            face_instances: &s.face_instances,
            faces: &s.faces,
            patches: &s.patches,
            patch_instances: &s.patch_instances,
            taus,
            counters: &frame.stages.common.counters,
            cones: s.cones.as_ref(),
            points: &s.points,
            runs,
        };
        match self {
            Self::Bound(pass) => pass.record(cmd, &bounded, threads),
            #[cfg(feature = "baselines")]
            Self::Slefe(pass) => {
                let bindings = slefe::Bindings { bounded, slefes: s.slefes() };
                pass.record(cmd, &bindings, threads);
            }
        }
    }
}
