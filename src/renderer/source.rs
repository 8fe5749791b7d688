//! What was uploaded, as it is now: the model, its settings, and what the host has changed of it since.
//!
//! ```text
//!   upload ─▶ Source ──as it is, or cut out for a near view──▶ Loaded ─▶ frames
//!               ▲                                                 ▲
//!               ╰───── edits, and changes of instances ───────────╯
//! ```

use super::models::Models;
use crate::model::{Camera, Model};
use crate::scene::{DeepZoom, DeepZoomUpload, SceneRequest, Shown};
use std::sync::Arc;

/// The model and what is shown of it.
pub(crate) struct Source {
    pub(super) model: Arc<Model>,
    pub(super) request: SceneRequest,
    /// Of each instance.
    pub(super) shown: Vec<Shown>,
    /// Told from those of other models.
    pub(super) upload: u64,
    /// Those that were added to it.
    pub(super) models: Models,
    pub(super) deep_zoom: DeepZoom,
    /// What this camera sees is loaded.
    approached: Option<Camera>,
}

impl Source {
    /// Of a model that has been checked.
    pub(super) fn new(model: Arc<Model>, request: SceneRequest) -> Self {
        let shown = vec![Shown::default(); model.instances.len()];
        let (models, deep_zoom) = (Models::new(&model), DeepZoom::new(&model));
        Self { model, request, shown, upload: 0, models, deep_zoom, approached: None }
    }

    /// The same, not loaded yet, with another request.
    #[cfg(feature = "headless")]
    pub(crate) fn with(&self, request: SceneRequest) -> Self {
        let (shown, models) = (self.shown.clone(), self.models.clone());
        Self { shown, models, ..Self::new(Arc::clone(&self.model), request) }
    }

    /// The settings that it was uploaded with.
    #[cfg(feature = "headless")]
    pub(crate) fn request(&self) -> SceneRequest {
        self.request
    }

    /// What a view wants loaded in place of what is.
    pub(super) fn wanted(&mut self, camera: &Camera) -> DeepZoomUpload {
        // loops that are being edited stay where they are, and parts are followed through as a whole
        let whole = self.request.editable || self.request.thickness || self.request.highlight.is_some();
        if whole || self.approached.replace(*camera) == Some(*camera) {
            return DeepZoomUpload::Same;
        }
        self.deep_zoom.of(&self.model, &self.shown, camera)
    }

    /// What was wanted last was not loaded, or is no longer so: the next view wants it anew.
    pub(super) fn forget(&mut self) {
        self.approached = None;
        self.deep_zoom.forget();
    }

    /// All of it is loaded.
    pub(super) fn is_whole(&mut self) {
        self.approached = None;
        self.deep_zoom.hold_whole();
        self.models.bounds = self.model.control_bounds();
    }

    /// An instance changed; what is loaded changed with it.
    pub(super) fn moved(&mut self) {
        self.approached = None;
    }
}
