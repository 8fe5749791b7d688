//! The ways to trim and their parameters.

use selvedge::baselines::{SceneOptions, Sorted, TrimMethod};
use selvedge::picture::{SceneSettings, TrimWay};
use serde::Serialize;
use std::fmt;
use std::str::FromStr;

/// A way to trim, the engine's own or one to compare with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(into = "String")]
pub enum Way {
    Own(TrimWay),
    Bisect(Sorted),
    Texture,
    Pretessellated,
}

/// Ways to compare with.
const BASELINES: [Way; 4] =
    [Way::Bisect(Sorted::Source), Way::Bisect(Sorted::Tuned), Way::Texture, Way::Pretessellated];

impl Way {
    /// Every way, the engine's own first.
    pub fn all() -> Vec<Self> {
        TrimWay::ALL.iter().map(|way| Self::Own(*way)).chain(BASELINES).collect()
    }

    /// As in command lines and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Own(way) => way.name(),
            Self::Bisect(Sorted::Source) => "bisect",
            Self::Bisect(Sorted::Tuned) => "bisect-tuned",
            Self::Texture => "texture",
            Self::Pretessellated => "pretessellated",
        }
    }

    /// Whether it promises that no boundary is off by more than half a pixel.
    pub fn promises(self) -> bool {
        matches!(self, Self::Own(_))
    }
}

impl fmt::Display for Way {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl From<Way> for String {
    fn from(way: Way) -> Self {
        way.name().to_owned()
    }
}

impl FromStr for Way {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let names = || Self::all().iter().map(|w| w.name()).collect::<Vec<_>>().join(", ");
        Self::all().into_iter().find(|w| w.name() == text).ok_or_else(|| format!("wants one of {}", names()))
    }
}

/// A way at one setting of its knob.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Contender {
    /// The largest distance of a boundary, pixels.
    Own { way: TrimWay, tolerance_px: f64 },
    /// Most steps.
    Bisect { steps: u32, sorted: Sorted },
    /// Eighths of a texel to a pixel.
    Texture { eighths: u32 },
    /// Deflection relative to the model's diagonal.
    Pretessellated { deflection: f64 },
}

impl Contender {
    /// At its usual accuracy: half a pixel; the steps of the source; so many texels that the error is at most half a
    /// pixel; Open CASCADE's deflection.
    pub fn usual(way: Way) -> Self {
        match way {
            Way::Own(way) => Self::Own { way, tolerance_px: 0.5 },
            Way::Bisect(sorted) => Self::Bisect { steps: selvedge::baselines::bisect::STEPS, sorted },
            Way::Texture => Self::Texture { eighths: 16 },
            Way::Pretessellated => Self::Pretessellated { deflection: 1e-3 },
        }
    }

    /// From coarse to fine.
    pub fn knobs(way: Way) -> Vec<Self> {
        match way {
            Way::Own(way) => [2.0, 1.0, 0.5, 0.25].map(|tolerance_px| Self::Own { way, tolerance_px }).to_vec(),
            Way::Bisect(sorted) => [0, 2, 4, 8, 16].map(|steps| Self::Bisect { steps, sorted }).to_vec(),
            Way::Texture => [4, 8, 16, 32].map(|eighths| Self::Texture { eighths }).to_vec(),
            Way::Pretessellated => [1e-2, 1e-3, 1e-4].map(|deflection| Self::Pretessellated { deflection }).to_vec(),
        }
    }

    pub fn way(self) -> Way {
        match self {
            Self::Own { way, .. } => Way::Own(way),
            Self::Bisect { sorted, .. } => Way::Bisect(sorted),
            Self::Texture { .. } => Way::Texture,
            Self::Pretessellated { .. } => Way::Pretessellated,
        }
    }

    /// The tolerance of the frame; it also holds for surfaces, so it is the same where only the trims are compared.
    pub fn tolerance_px(self) -> f64 {
        if let Self::Own { tolerance_px, .. } = self { tolerance_px } else { 0.5 }
    }

    /// Settings of its scene; a mesh has nothing to trim.
    pub fn scene(self) -> (SceneSettings, SceneOptions) {
        let baseline = |method| SceneOptions { trim: Some(method), ..SceneOptions::default() };
        match self {
            Self::Own { way, .. } => (SceneSettings { trim: way, ..Default::default() }, SceneOptions::default()),
            Self::Bisect { steps, sorted } => (Default::default(), baseline(TrimMethod::Bisect { steps, sorted })),
            Self::Texture { eighths } => (Default::default(), baseline(TrimMethod::Texture { eighths })),
            Self::Pretessellated { .. } => Default::default(),
        }
    }

    /// The knob's name and place.
    pub fn knob(self) -> (&'static str, f64) {
        match self {
            Self::Own { tolerance_px, .. } => ("tolerance, px", tolerance_px),
            Self::Bisect { steps, .. } => ("steps", f64::from(steps)),
            Self::Texture { eighths } => ("texels a pixel", f64::from(eighths) / 8.0),
            Self::Pretessellated { deflection } => ("deflection of the diagonal", deflection),
        }
    }
}
