//! What a scene is made by in place of the engine's own ways: no setting of a host's names it.

use serde::Serialize;

/// How bisection sorts monotone pieces into bands and cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Sorted {
    /// A band ends at every end of a piece; cells hold pieces whose boxes overlap.
    Source,
    /// Fewer bands; cells hold pieces whose boxes within the band overlap.
    Tuned,
}

/// Other ways to trim, each with the number that its accuracy hangs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum TrimMethod {
    /// No test: what a frame costs before it is trimmed.
    Untrimmed,
    /// Monotone pieces, bisected in every pixel.
    Bisect {
        /// Most steps.
        steps: u32,
        /// How they are sorted.
        sorted: Sorted,
    },
    /// A texture of one bit a texel for each face.
    Texture {
        /// Eighths of a texel to a pixel.
        eighths: u32,
    },
}

impl TrimMethod {
    /// As in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Untrimmed => "untrimmed",
            Self::Bisect { .. } => "bisect",
            Self::Texture { .. } => "texture",
        }
    }
}

/// What is done otherwise than a host's [`SceneSettings`](crate::picture::SceneSettings) say.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SceneOptions {
    /// How to trim, in place of [`SceneSettings::trim`](crate::picture::SceneSettings::trim).
    pub trim: Option<TrimMethod>,
    /// Patches are divided by slefes of so many segments, 1 to 9, where
    /// [`FrameSettings::levels`](crate::picture::FrameSettings::levels) says
    /// [`Levels::Bound`](crate::picture::Levels::Bound): see [`factors`](super::factors). The promise is *not* kept.
    pub slefe_segments: Option<usize>,
    /// Before pass `visibility` the same sub-patches are drawn without a trim test, which nobody sees: pass `visibility
    /// untested` tells what tests cost. Not in scenes with anything but patches, and where nothing is trimmed.
    pub untested: bool,
}
