//! The ways to divide patches that are compared.

use crate::args::Factors;
use selvedge::baselines::factors::Way;
use selvedge::baselines::slefe;
use selvedge::picture::Levels;
use std::fmt;
use std::str::FromStr;

/// How patches are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Divided {
    /// As in other commands.
    By(Factors),
    /// By slefes of so many segments.
    Slefe(usize),
}

impl Divided {
    /// The slefes' segments, for the scene.
    pub fn slefe_segments(self) -> Option<usize> {
        match self {
            Self::By(_) => None,
            Self::Slefe(segments) => Some(segments),
        }
    }

    /// The levels, for the frame.
    pub fn levels(self) -> Levels {
        match self {
            Self::By(Factors(levels)) => levels,
            Self::Slefe(_) => Levels::Bound,
        }
    }

    /// The same without a GPU.
    pub fn way(self) -> Way {
        match self {
            Self::By(Factors(Levels::Bound)) => Way::Bound,
            Self::By(Factors(Levels::Fixed(level))) => Way::Fixed(level as usize),
            Self::Slefe(segments) => Way::Ipass { segments },
        }
    }
}

impl FromStr for Divided {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let divided = match text.strip_prefix("slefe") {
            Some("") => Some(Self::Slefe(slefe::USUAL_SEGMENTS)),
            Some(n) => n.parse().ok().filter(|n| (1..=slefe::MOST_SEGMENTS).contains(n)).map(Self::Slefe),
            None => text.parse().ok().map(Self::By),
        };
        divided.ok_or_else(|| "wants `bound`, a level from 1 to 64, or `slefe`, with 1 to 9 segments behind it".into())
    }
}

impl fmt::Display for Divided {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::By(factors) => factors.fmt(f),
            Self::Slefe(slefe::USUAL_SEGMENTS) => f.write_str("slefe"),
            Self::Slefe(segments) => write!(f, "slefe{segments}"),
        }
    }
}
