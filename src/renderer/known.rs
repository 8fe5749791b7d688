//! What stays from frame to frame: what is known of patches that lie behind others, what is seen, and the trim table.
//!
//! ```text
//!   scenes that hide     First ─▶ Asks ─▶ Same ─▶ Same, keeps ─▶ Same, keeps ─ … ─▶ Moved ─▶ Same ─▶ Same, keeps
//!   others               made ──▶ keeps ─▶ …                                        made ──▶ keeps
//!                        └──────── one view ────────────────────────────────────┘   └──── another, or an edit ───
//!   table of one view    made ──▶ made ─▶ …                                         made ──▶ made
//!   of many views        made ──▶ keeps ─▶ …                                        keeps, but for an edit
//! ```
//!
//! A frame that hides asks once it has drawn: what it is told changes what the next one draws, though not what is seen,
//! and the one after that nothing. All begins anew with new buffers: another scene, another size of the picture, more
//! room. What a table is made of follows from its density and the tolerance alone (`scene::around`).

use crate::frame::Hiding;
use crate::model::Camera;
use crate::picture::FrameSettings;

/// What a frame was told, and of which view.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    pub(super) hiding: Hiding,
    /// What is seen is what the frame before saw.
    pub(super) keeps: bool,
    /// The trim table is that of the frame before.
    pub(super) keeps_table: bool,
    /// Of a table for many views.
    density: Option<f32>,
    view: (Camera, FrameSettings),
}

impl Known {
    /// Of the frame that follows one. `density`: where the trim table is for many views. `edited`: some trim changes between
    /// them. `hides`: patches may lie behind others.
    pub(super) fn after(
        before: Option<Self>,
        view: (Camera, FrameSettings),
        density: Option<f32>,
        edited: bool,
        hides: bool,
    ) -> Self {
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
        let is_made_for = |before: &Self| {
            let (_, settings_before) = before.view;
            before.density.is_some()
                && before.density == density
                && settings_before.tolerance_px == settings.tolerance_px
        };
        let has_table = before.filter(is_made_for).is_some() && !edited;
        let may_keep = !settings.all_passes;
        Self { hiding, keeps: made && may_keep, keeps_table: has_table && may_keep, density, view }
    }
}
