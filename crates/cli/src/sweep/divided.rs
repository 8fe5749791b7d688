//! The ways to divide patches that are compared.

use crate::args::Factors;
use selvedge::baselines::factors::Way;
use selvedge::baselines::slefe;
use selvedge::picture::Levels;
use std::fmt;
use std::str::FromStr;

/// Names of [`Divided::Corners`].
const CORNERS: &str = "corners";
const TESSELLATED: &str = "tessellated";

/// How patches are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Divided {
    /// As in other commands.
    By(Factors),
    /// By slefes of so many segments.
    Slefe(usize),
    /// By the bound. Whether patches of one segment a side are drawn by their corners, in a scene of any size.
    Corners(bool),
}

impl Divided {
    /// For the scene: the slefes' segments, and whether patches are drawn by their corners.
    pub fn scene(self) -> (Option<usize>, Option<bool>) {
        match self {
            Self::By(_) => (None, None),
            Self::Slefe(segments) => (Some(segments), None),
            Self::Corners(corners) => (None, Some(corners)),
        }
    }

    /// The levels, for the frame.
    pub fn levels(self) -> Levels {
        match self {
            Self::By(Factors(levels)) => levels,
            Self::Slefe(_) | Self::Corners(_) => Levels::Bound,
        }
    }

    /// The same without a GPU.
    pub fn way(self) -> Way {
        match self {
            Self::By(Factors(Levels::Bound)) | Self::Corners(_) => Way::Bound,
            Self::By(Factors(Levels::Fixed(level))) => Way::Fixed(level as usize),
            Self::Slefe(segments) => Way::Ipass { segments },
        }
    }
}

impl FromStr for Divided {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let divided = match (text, text.strip_prefix("slefe")) {
            (CORNERS, _) => Some(Self::Corners(true)),
            (TESSELLATED, _) => Some(Self::Corners(false)),
            (_, Some("")) => Some(Self::Slefe(slefe::USUAL_SEGMENTS)),
            (_, Some(n)) => n.parse().ok().filter(|n| (1..=slefe::MOST_SEGMENTS).contains(n)).map(Self::Slefe),
            (_, None) => text.parse().ok().map(Self::By),
        };
        divided.ok_or_else(|| {
            let ways = "`bound`, `corners`, `tessellated`, a level from 1 to 64, or `slefe`";
            format!("wants {ways}, with 1 to 9 segments behind it")
        })
    }
}

impl fmt::Display for Divided {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::By(factors) => factors.fmt(f),
            Self::Slefe(slefe::USUAL_SEGMENTS) => f.write_str("slefe"),
            Self::Slefe(segments) => write!(f, "slefe{segments}"),
            Self::Corners(true) => f.write_str(CORNERS),
            Self::Corners(false) => f.write_str(TESSELLATED),
        }
    }
}
