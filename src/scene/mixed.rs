//! Whether a picture is drawn as linear colours that later passes change before they reach the host's colour.

use super::SceneData;
use crate::picture::{Samples, Smooth, TakenWay};

impl SceneData {
    /// Pass `coverage` mixes pixels at the borders of trimmed faces. The scene has patches, and the exact trim test.
    pub(crate) fn smooths_trims(&self) -> bool {
        self.smooth == Smooth::Trims && self.has_patches && self.trim_way() == Some(TakenWay::Exact)
    }

    /// Pass `border_mix` mixes pixels at the borders of faces. The scene has patches, one sample a pixel, and no
    /// layers.
    pub(crate) fn smooths_borders(&self) -> bool {
        let alone = self.samples == Samples::One && !self.is_layered;
        self.smooth == Smooth::Borders && self.has_patches && alone
    }

    /// Pass `resolve` draws linear colours and depths for later passes. In scenes with layers it draws them into the
    /// image behind the layers instead.
    pub(crate) fn is_mixed(&self) -> bool {
        self.smooths_trims() || self.smooths_borders() || self.ambient.is_some() && !self.is_layered
    }
}
