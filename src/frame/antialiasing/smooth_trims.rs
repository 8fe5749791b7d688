//! The frame's part for smooth trims.
//!
//! ```text
//!   resolve ──▶ linear colour and depth ──coverage──▶ the host's colour
//!           ──▶ the host's depth, depth, face, (u, v), normal: those of the pixels' centres, as without it
//! ```

use crate::frame::Frame;
use crate::frame::antialiasing::coverage;
use crate::frame::shading::resolve;
use crate::gpu::{Access, Attachment, Commands, Device, GpuError, Load, Resource, barrier};
use crate::scene::SceneData;

/// `None` where no trims are smoothed.
pub(crate) fn new(
    device: &Device,
    data: &SceneData,
    formats: resolve::Formats,
) -> Result<Option<coverage::Coverage>, GpuError> {
    let make = |()| coverage::Coverage::new(device, formats.colour, data.has_rational);
    data.smooths_trims().then_some(()).map(make).transpose()
}

impl Frame<'_> {
    /// Pixels at the borders of trimmed faces are mixed from what pass `resolve` drew; all go to the host's colour.
    pub(crate) fn coverage(&self, cmd: &Commands<'_>, pass: &coverage::Coverage, test: &[Resource<'_>]) {
        let (s, b) = (self.scene, self.buffers);
        let Some(resolved) = &b.resolved else { unreachable!("made with the pass") };
        barrier::images(cmd, &[(resolved, Access::COLOUR_WRITE, Access::FRAGMENT_READ)]);
        let bindings = coverage::Bindings {
            frame: self.constants,
            placed: s.placed(self.views),
            visibility: &b.visibility,
            resolved,
            trim: test,
        };
        let load = match self.colour[0].load {
            Load::Discard => Load::ColourF32([0.0; 4]),
            load => load,
        };
        pass.record(cmd, &bindings, Attachment { load, ..self.colour[0] });
    }
}
