//! What is known of patches that lie behind others, from frame to frame.

use crate::frame::Hiding;
use crate::model::Camera;
use crate::picture::FrameSettings;

/// What a frame was told, and of which view.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    pub(super) hiding: Hiding,
    view: (Camera, FrameSettings),
}

impl Known {
    /// Of the frame that follows one; `edited`: some trim changes between them.
    pub(super) fn after(before: Option<Self>, view: (Camera, FrameSettings), edited: bool) -> Self {
        let hiding = match before {
            None => Hiding::First,
            Some(before) if before.hiding == Hiding::First => Hiding::Asks,
            Some(before) if before.view == view && !edited => Hiding::Same,
            Some(_) => Hiding::Moved,
        };
        Self { hiding, view }
    }
}
