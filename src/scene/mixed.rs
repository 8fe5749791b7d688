//! Whether a picture is drawn as linear colours that later passes change before they reach the host's colour.

use super::SceneData;
use crate::picture::{Samples, Smooth, TakenWay};

impl SceneData {
    /// Pass `coverage` mixes pixels at the borders of trimmed faces. The scene has patches, and the exact trim test.
    pub(crate) fn smooths_trims(&self) -> bool {
        self.smooth == Smooth::Trims && self.has_patches && self.trim_way() == Some(TakenWay::Exact)
    }

    /// Pass `border_write` mixes pixels at borders. The scene has something that points are asked for, and one sample a
    /// pixel.
    pub(crate) fn smooths_borders(&self) -> bool {
        let alone = self.samples == Samples::One;
        let asked = self.has_patches || self.has_meshes() || self.has_smooth_solids();
        self.smooth == Smooth::Borders && asked && alone
    }

    /// Pass `border_follow` follows faces' surfaces to points at borders.
    pub(crate) fn follows_borders(&self) -> bool {
        self.smooths_borders() && self.has_followed
    }

    /// The scene has Boolean solids that points are asked for: all operands have equations.
    pub(crate) fn has_smooth_solids(&self) -> bool {
        self.solids.kinds().is_some() && self.solids.operand_leaves.is_empty()
    }

    /// Pass `resolve` draws linear colours and depths for later passes. In scenes with layers it draws them into the
    /// image behind the layers instead.
    pub(crate) fn is_mixed(&self) -> bool {
        self.smooths_trims() || !self.is_layered && (self.smooths_borders() || self.ambient.is_some())
    }
}
