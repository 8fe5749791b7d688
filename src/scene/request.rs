//! The settings that a scene is made with.

#[cfg(feature = "baselines")]
use crate::baselines::SceneOptions;
use crate::picture::{SceneSettings, TrimWay};
use std::ops::Deref;

/// A host's settings, and the options of baselines.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SceneRequest {
    pub settings: SceneSettings,
    #[cfg(feature = "baselines")]
    pub baseline: SceneOptions,
}

impl SceneRequest {
    /// The same, trimmed exactly.
    pub(crate) fn exact(self) -> Self {
        let mut request = self;
        request.settings.trim = TrimWay::Exact;
        request
    }
}

impl From<SceneSettings> for SceneRequest {
    fn from(settings: SceneSettings) -> Self {
        Self {
            settings,
            #[cfg(feature = "baselines")]
            baseline: SceneOptions::default(),
        }
    }
}

impl Deref for SceneRequest {
    type Target = SceneSettings;

    fn deref(&self) -> &SceneSettings {
        &self.settings
    }
}
