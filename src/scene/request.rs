//! What a scene is made by.

#[cfg(feature = "baselines")]
use crate::baselines::SceneOptions;
use crate::picture::{SceneSettings, TrimWay};
use std::ops::Deref;

/// A host's settings; and, for comparisons, what is done otherwise.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SceneRequest {
    pub settings: SceneSettings,
    #[cfg(feature = "baselines")]
    pub baseline: SceneOptions,
}

impl SceneRequest {
    /// The same, trimmed exactly.
    pub(crate) fn exact(self) -> Self {
        Self { settings: SceneSettings { trim: TrimWay::Exact, ..self.settings }, ..self }
    }
}

impl From<SceneSettings> for SceneRequest {
    fn from(settings: SceneSettings) -> Self {
        Self { settings, ..Self::default() }
    }
}

impl Deref for SceneRequest {
    type Target = SceneSettings;

    fn deref(&self) -> &SceneSettings {
        &self.settings
    }
}
