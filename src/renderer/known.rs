//! What stays from frame to frame: what is known of patches that lie behind others, what is seen, and the trim table.
//!
//! ```text
//!   scenes that hide     First ─▶ Asks ─▶ Same ─▶ Same, keeps ─▶ Same, keeps ─ … ─▶ Moved ─▶ Same ─▶ Same, keeps
//!   others               made ──▶ keeps ─▶ …                                        made ──▶ keeps
//!                        └──────── one view ────────────────────────────────────┘   └──── another, or an edit ───
//!   trim table           made ──▶ keeps ─▶ …                                        keeps where it serves that, too
//! ```
//!
//! A frame that hides asks once it has drawn: what it is told changes what the next one draws, though not what is seen,
//! and the one after that nothing. All begins anew with new buffers: another scene, another size of the picture, more
//! room. What a table is made of follows from what it serves and the tolerance alone (`scene::trimmed`).

use crate::frame::Hiding;
use crate::model::Camera;
use crate::picture::FrameSettings;
use crate::scene::TableView;

/// What a frame was told, and of which view.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    pub(super) hiding: Hiding,
    /// What is seen is what the frame before saw.
    pub(super) keeps: bool,
    /// The trim table is that of the frame before.
    pub(super) keeps_table: bool,
    /// What that is made of; where there is one.
    pub(super) table: Option<TableView>,
    view: (Camera, FrameSettings),
}

impl Known {
    /// Of the frame that follows one. `table`: what its trim table is made of. `edited`: some trim changes between
    /// them. `hides`: patches may lie behind others.
    pub(super) fn after(
        before: Option<Self>,
        view: (Camera, FrameSettings),
        table: Option<TableView>,
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
            table.is_some() && before.table == table && settings_before.tolerance_px == settings.tolerance_px
        };
        let has_table = before.filter(is_made_for).is_some() && !edited;
        let may_keep = !settings.all_passes;
        Self { hiding, keeps: made && may_keep, keeps_table: has_table && may_keep, table, view }
    }
}
