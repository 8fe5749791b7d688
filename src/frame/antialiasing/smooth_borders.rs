//! Smooth borders of all faces.
//!
//! ```text
//!   resolve ──▶ linear colour and depth ──border_mix──▶ linear colour ──linear_show──▶ the host's colour
//!           ──▶ the host's depth; depth, face, (u, v) and normal: those of the pixels' centres, as without the pass
//! ```

use super::border_mix::{self, BorderMix, BorderPixel, Dispatch, Kinds};
use crate::frame::Frame;
use crate::frame::common::room::Room;
use crate::gpu::{Access, Buffer, Commands, Device, GpuError, Image, Resource, barrier};
use crate::scene::{SceneData, SolidData};
use crate::shaders::TrimTest;
use std::sync::Arc;

/// The pass; `None` where no borders are smoothed.
pub(crate) fn pass(device: &Device, data: &SceneData, test: Option<&TrimTest>) -> Result<Option<BorderMix>, GpuError> {
    if !data.smooths_borders() {
        return Ok(None);
    }
    let kinds = Kinds {
        test,
        rational: data.has_rational,
        fine: data.has_fine,
        others: data.has_meshes() || data.solids.kinds().is_some(),
        volume: data.volume.as_ref().and_then(SolidData::kinds),
    };
    BorderMix::new(device, &kinds)
}

/// The stage.
pub(crate) struct SmoothBorders {
    pass: Arc<BorderMix>,
    list: Buffer,
    dispatch: Buffer,
}

impl SmoothBorders {
    pub(crate) fn new(room: &Room<'_>, pass: &Arc<BorderMix>) -> Result<Self, GpuError> {
        Ok(Self {
            pass: Arc::clone(pass),
            list: room.structs::<BorderPixel>("border pixels", room.size.0 * room.size.1)?,
            dispatch: room.indirect::<Dispatch>("border dispatch", 1)?,
        })
    }

    /// Mixes pixels at the borders of faces, in place. `written`: the last write to `resolved` before;
    /// [`Access::COMPUTE_WRITE`] is the last one after.
    pub(crate) fn record(
        &self,
        frame: &Frame<'_>,
        cmd: &Commands<'_>,
        resolved: &Image,
        written: Access,
        test: &[Resource<'_>],
    ) {
        let (w, r) = (Access::COMPUTE_WRITE, Access::COMPUTE_READ);
        cmd.after(r | Access::INDIRECT_READ, Access::TRANSFER_WRITE);
        cmd.fill(&self.dispatch, 0);
        barrier::buffers(cmd, &[(&self.dispatch, Access::TRANSFER_WRITE, r | w), (&self.list, r, w)]);
        barrier::images(cmd, &[(resolved, written, r)]);
        let bindings = border_mix::Bindings {
            frame: frame.constants,
            placed: frame.scene.placed(frame.views),
            visibility: &frame.stages.visibility.image,
            resolved,
            list: &self.list,
            dispatch: &self.dispatch,
            trim: test,
            volume: frame.volume(),
        };
        self.pass.find(cmd, &bindings);
        barrier::buffers(cmd, &[(&self.dispatch, w, r | Access::INDIRECT_READ), (&self.list, w, r | w)]);
        self.pass.mix(cmd, &bindings);
        barrier::buffers(cmd, &[(&self.list, w, r)]);
        barrier::images(cmd, &[(resolved, r, w)]);
        self.pass.write(cmd, &bindings);
    }
}
