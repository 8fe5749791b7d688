//! Effects that one frame may leave out of its picture.

/// Effects of a scene. A frame that leaves some out costs less, without an upload: a host does so while a view moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effects {
    /// Smooth borders of [`Smooth::Borders`](super::Smooth::Borders). Those of
    /// [`Smooth::Trims`](super::Smooth::Trims) are not left out.
    pub borders: bool,
    /// Ambient occlusion: [`SceneSettings::ambient`](super::SceneSettings::ambient).
    pub ambient: bool,
    /// Lines along edges: [`SceneSettings::edges`](super::SceneSettings::edges). The image of edges is 0 without them.
    pub lines: bool,
    /// Shadows of [`SceneSettings::sun`](super::SceneSettings::sun): its light reaches all that is turned towards it.
    pub shadows: bool,
}

impl Effects {
    /// No effect.
    pub const NONE: Self = Self { borders: false, ambient: false, lines: false, shadows: false };
}
