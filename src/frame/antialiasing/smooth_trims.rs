//! Smooth borders of trimmed faces.
//!
//! ```text
//!   resolve ──▶ linear colour and depth ──coverage──▶ the host's colour
//!           ──▶ the host's depth; depth, face, (u, v) and normal: those of the pixels' centres, as without the pass
//! ```

use super::coverage;
use crate::frame::Frame;
use crate::frame::shading::resolve;
use crate::gpu::{Access, Commands, Device, GpuError, Image, Resource, barrier};
use crate::scene::SceneData;
use std::sync::Arc;

/// The pass; `None` where no trims are smoothed.
pub(crate) fn pass(
    device: &Device,
    data: &SceneData,
    formats: resolve::Formats,
) -> Result<Option<coverage::Coverage>, GpuError> {
    let make = || coverage::Coverage::new(device, formats.colour, data.has_rational);
    data.smooths_trims().then(make).transpose()
}

/// The stage.
pub(crate) struct SmoothTrims {
    pass: Arc<coverage::Coverage>,
}

impl SmoothTrims {
    pub(crate) fn new(pass: &Arc<coverage::Coverage>) -> Self {
        Self { pass: Arc::clone(pass) }
    }

    /// Mixes pixels at the borders of trimmed faces, and writes all pixels to the host's colour. `written`: the last
    /// write to `resolved` before.
    pub(crate) fn record(
        &self,
        frame: &Frame<'_>,
        cmd: &Commands<'_>,
        resolved: &Image,
        written: Access,
        test: &[Resource<'_>],
    ) {
        barrier::images(cmd, &[(resolved, written, Access::FRAGMENT_READ)]);
        let bindings = coverage::Bindings {
            frame: frame.constants,
            placed: frame.scene.placed(frame.views),
            visibility: &frame.stages.visibility.image,
            resolved,
            trim: test,
        };
        self.pass.record(cmd, &bindings, frame.colour_over_nothing());
    }
}
