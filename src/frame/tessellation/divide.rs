//! The frame's part that says how finely patches are divided: pass `bound`, or one to compare with in its place.

use crate::bindings::Bounded;
use crate::frame::Frame;
#[cfg(feature = "baselines")]
use crate::frame::baselines::slefe;
use crate::frame::tessellation::bound;
use crate::gpu::{Commands, Device, GpuError};
use crate::scene::{Division, SceneData};

/// The pass of a scene.
pub(crate) enum DividePass {
    Bound(bound::Bound),
    #[cfg(feature = "baselines")]
    Slefe(slefe::BaselineSlefe),
}

impl DividePass {
    pub(crate) fn new(device: &Device, data: &SceneData) -> Result<Self, GpuError> {
        let cones = !data.cones.is_empty();
        Ok(match data.division {
            Division::Bound => Self::Bound(bound::Bound::new(device, cones)?),
            #[cfg(feature = "baselines")]
            Division::Slefe(_) => Self::Slefe(slefe::BaselineSlefe::new(device, cones)?),
        })
    }

    /// Writes `taus`, and counts clamps.
    pub(crate) fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let (s, b) = (frame.scene, frame.buffers);
        let bounded = Bounded {
            frame: frame.constants,
            views: frame.views,
            instances: &s.instances,
            face_instances: &s.face_instances,
            faces: &s.faces,
            patches: &s.patches,
            items: &s.items,
            taus: &b.taus,
            counters: &b.counters,
            cones: s.cones.as_ref(),
            points: &s.points,
        };
        match self {
            Self::Bound(pass) => pass.record(cmd, &bounded, b.counts.items),
            #[cfg(feature = "baselines")]
            Self::Slefe(pass) => {
                let Some(slefes) = &s.slefes else { unreachable!("made with the pass") };
                let bindings = slefe::Bindings { bounded, slefes };
                pass.record(cmd, &bindings, b.counts.items);
            }
        }
    }
}
