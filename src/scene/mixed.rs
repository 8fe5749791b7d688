//! Which pictures are mixed from what pixels see, before the host gets them.

use super::SceneData;
use crate::picture::{Samples, Smooth, TakenWay};

impl SceneData {
    /// Pass `coverage` mixes pixels at the borders of trimmed faces: there are some that are seen themselves.
    pub(crate) fn smooths_trims(&self) -> bool {
        self.smooth == Smooth::Trims && self.has_patches && self.trim_way() == Some(TakenWay::Exact)
    }

    /// Pass `border_mix` mixes pixels at the borders of faces: there are some, and the picture is of one sample, and opaque.
    pub(crate) fn smooths_borders(&self) -> bool {
        let alone = self.samples == Samples::One && !self.is_layered;
        self.smooth == Smooth::Borders && self.has_patches && alone
    }

    /// Pass `resolve` draws linear colours and depths for passes that change them. Those of what lies behind layers are another
    /// image.
    pub(crate) fn is_mixed(&self) -> bool {
        self.smooths_trims() || self.smooths_borders() || self.ambient.is_some() && !self.is_layered
    }
}
