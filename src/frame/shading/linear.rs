//! The image of linear colour and depth that pass `resolve` draws if later passes change its colours.
//!
//! ```text
//!   resolve ──▶ resolved ──(ambient)──(border_mix)──linear_show──▶ the host's colour
//!                                   └─coverage───────────────────▶
//! ```

use super::linear_show::LinearShow;
use super::resolve;
use crate::frame::Frame;
use crate::frame::common::room::{DRAWN_AND_READ, Room};
use crate::gpu::{Access, Attachment, Commands, Device, GpuError, Image, Load, barrier};
use crate::scene::SceneData;
use std::sync::Arc;

/// The pass; `None` if pass `coverage` draws into the host's colour.
pub(crate) struct Passes {
    show: Option<LinearShow>,
}

impl Passes {
    /// `None` if pass `resolve` draws into the host's colour.
    pub(crate) fn new(device: &Device, data: &SceneData, formats: resolve::Formats) -> Result<Option<Self>, GpuError> {
        if !data.is_mixed() {
            return Ok(None);
        }
        let show = (!data.smooths_trims()).then(|| LinearShow::new(device, formats.colour)).transpose()?;
        Ok(Some(Self { show }))
    }
}

/// The stage.
pub(crate) struct Linear {
    passes: Arc<Passes>,
    /// Linear colour and depth.
    pub resolved: Image,
}

impl Linear {
    pub(crate) fn new(room: &Room<'_>, passes: &Arc<Passes>) -> Result<Self, GpuError> {
        let resolved = room.image("resolved", resolve::BEHIND_FORMAT, DRAWN_AND_READ)?;
        Ok(Self { passes: Arc::clone(passes), resolved })
    }

    /// Draws all pixels into the host's colour. `written`: the last write to `resolved`.
    pub(crate) fn show(&self, frame: &Frame<'_>, cmd: &Commands<'_>, written: Access) {
        let Some(show) = &self.passes.show else { return };
        barrier::images(cmd, &[(&self.resolved, written, Access::FRAGMENT_READ)]);
        show.record(cmd, frame.constants, &self.resolved, frame.colour_over_nothing());
    }
}

impl<'a> Frame<'a> {
    /// The host's colour target, for a pass that blends every pixel over it: loaded, or cleared to zero.
    pub(crate) fn colour_over_nothing(&self) -> Attachment<'a> {
        let load = match self.colour[0].load {
            Load::Discard => Load::ColourF32([0.0; 4]),
            load => load,
        };
        Attachment { load, ..self.colour[0] }
    }
}
