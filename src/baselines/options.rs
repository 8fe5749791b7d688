//! Options that replace the engine's own ways by baselines. No setting of a host names them.

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

/// Baseline ways to trim, each with the parameter that determines its accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum TrimMethod {
    /// No test: measures a frame without trimming.
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
    /// The name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Untrimmed => "untrimmed",
            Self::Bisect { .. } => "bisect",
            Self::Texture { .. } => "texture",
        }
    }
}

/// Changes to a host's [`SceneSettings`](crate::picture::SceneSettings).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SceneOptions {
    /// How to trim, in place of [`SceneSettings::trim`](crate::picture::SceneSettings::trim).
    pub trim: Option<TrimMethod>,
    /// Patches are divided by slefes of so many segments, 1 to 9, if
    /// [`FrameSettings::levels`](crate::picture::FrameSettings::levels) is
    /// [`Levels::Bound`](crate::picture::Levels::Bound): see [`factors`](super::factors). The promise does *not* hold.
    pub slefe_segments: Option<usize>,
    /// Before pass `visibility`, the same sub-patches are drawn without a trim test and then cleared: the time of pass
    /// `visibility untested` shows the cost of the tests. Only in scenes with nothing but patches, some of them
    /// trimmed.
    pub untested: bool,
    /// Patches of one segment a side are drawn by their corners, or not, in a scene of any size. `None`: in scenes of
    /// many patches.
    pub corners: Option<bool>,
}
