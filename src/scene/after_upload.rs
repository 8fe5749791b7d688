//! What stays on the host of a scene that the GPU has: placements, and what changes, views and edits are made from.

use super::SceneData;
use super::solids::SolidData;
use super::sun::SunData;

impl SceneData {
    /// Frees the arrays that the GPU has; the placements and centres stay.
    pub(crate) fn drop_uploaded(&mut self) {
        let (placements, boxes) = (std::mem::take(&mut self.placements), std::mem::take(&mut self.boxes));
        let solids = std::mem::take(&mut self.solids).centres_only();
        let volume = self.volume.take().map(SolidData::centres_only);
        let edit = self.edit.take();
        let sun = self.sun.take().map(SunData::directions_only);
        let trimmed = self.trimmed.take();
        let (hidden, live) = (std::mem::take(&mut self.hidden), std::mem::take(&mut self.live));
        let casts_shadows = self.casts_shadows;
        *self = Self {
            placements,
            boxes,
            hidden,
            live,
            casts_shadows,
            trimmed,
            solids,
            volume,
            edit,
            sun,
            ..Self::default()
        };
    }
}
