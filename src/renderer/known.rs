//! What stays from frame to frame: what is known of patches that lie behind others, and what is seen.
//!
//! ```text
//!   scenes that hide     First ─▶ Asks ─▶ Same ─▶ Same, keeps ─▶ Same, keeps ─ … ─▶ Moved ─▶ Same ─▶ Same, keeps
//!   others               made ──▶ keeps ─▶ …                                        made ──▶ keeps
//!                        └──────── one view ────────────────────────────────────┘   └──── another, or an edit ───
//! ```
//!
//! A frame that hides asks once it has drawn: what it is told changes what the next one draws, though not what is seen,
//! and the one after that nothing. All begins anew with new buffers: another scene, another size of the picture, more
//! room.

use crate::frame::Hiding;
use crate::model::Camera;
use crate::picture::FrameSettings;

/// What a frame was told, and of which view.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    pub(super) hiding: Hiding,
    /// What is seen is what the frame before saw.
    pub(super) keeps: bool,
    view: (Camera, FrameSettings),
}

impl Known {
    /// Of the frame that follows one; `edited`: some trim changes between them. `hides`: patches may lie behind others.
    pub(super) fn after(before: Option<Self>, view: (Camera, FrameSettings), edited: bool, hides: bool) -> Self {
        let (camera, settings) = view;
        // which passes are recorded is no part of the view
        let view = (camera, FrameSettings { all_passes: false, ..settings });
        let is_same = |before: &Self| before.view == view && !edited;
        let hiding = match before {
            None => Hiding::First,
            Some(before) if before.hiding == Hiding::First => Hiding::Asks,
            Some(before) if is_same(&before) => Hiding::Same,
            Some(_) => Hiding::Moved,
        };
        let made = before.filter(is_same).is_some_and(|before| !hides || before.hiding == Hiding::Same);
        Self { hiding, keeps: made && !settings.all_passes, view }
    }
}
