//! What a frame may reuse of the frame before: the occlusion test's result, the visibility of each pixel, the trim table.
//!
//! ```text
//!   with occlusion culling   First ─▶ Asks ─▶ Same ─▶ Same, reused ─ … ─▶ Moved ─▶ Same ─▶ Same, reused
//!   without                  drawn ─▶ reused ─ …                          drawn ─▶ reused
//!                            └─────────── one view ──────────────────┘   └── another view, or an edit ──
//!   trim table               built ─▶ reused ─ …                          reused where it serves that view, too
//! ```
//!
//! A frame with occlusion culling tests for occlusion after it has drawn. The result changes which patches the next frame
//! draws, not which faces are seen, so the frame after that may reuse the visibility. New buffers end the history: those
//! of another scene, of another picture size, or larger ones. A trim table follows from the views that it serves and from
//! the tolerance alone (`scene::trimmed`).

use crate::frame::OcclusionState;
use crate::model::Camera;
use crate::picture::FrameSettings;
use crate::scene::TableView;

/// What the last frame left, and the view that it drew.
#[derive(Clone, Copy, Debug)]
pub(super) struct History {
    pub(super) occlusion: OcclusionState,
    /// The visibility of each pixel is that of the frame before.
    pub(super) reuses_view: bool,
    /// The trim table is that of the frame before.
    pub(super) reuses_table: bool,
    /// The view that the trim table is built for, if there is a table.
    pub(super) table: Option<TableView>,
    view: (Camera, FrameSettings),
}

impl History {
    /// The history after the next frame. `table`: the view that its trim table is built for. `edited`: some trim
    /// changes between the two frames, or a placed part moves. `hides`: the scene has occlusion culling.
    pub(super) fn after(
        before: Option<Self>,
        view: (Camera, FrameSettings),
        table: Option<TableView>,
        edited: bool,
        hides: bool,
    ) -> Self {
        let (camera, settings) = view;
        // the choice of passes is no part of the view
        let view = (camera, FrameSettings { all_passes: false, ..settings });
        let is_same = |before: &Self| before.view == view && !edited;
        let occlusion = match before {
            None => OcclusionState::First,
            Some(before) if before.occlusion == OcclusionState::First => OcclusionState::Asks,
            Some(before) if is_same(&before) => OcclusionState::Same,
            Some(_) => OcclusionState::Moved,
        };
        let is_drawn = before.filter(is_same).is_some_and(|before| !hides || before.occlusion == OcclusionState::Same);
        let serves = |before: &Self| {
            let (_, settings_before) = before.view;
            table.is_some() && before.table == table && settings_before.tolerance_px == settings.tolerance_px
        };
        let has_table = before.filter(serves).is_some() && !edited;
        let may_reuse = !settings.all_passes;
        Self { occlusion, reuses_view: is_drawn && may_reuse, reuses_table: has_table && may_reuse, table, view }
    }
}
