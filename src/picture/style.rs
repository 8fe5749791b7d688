//! The look of surfaces.

/// The look of surfaces. Images beside the colour are the same in every style.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[non_exhaustive]
#[repr(u32)]
pub enum Style {
    /// In their colours, in a studio's light or the sun's.
    #[default]
    Shaded = 0,
    /// In one colour, without highlights: only the shape.
    Clay = 1,
    /// Normals as colours: right is red, up is green, towards the eye is blue.
    Normals = 2,
    /// The stripes of a room around the camera's vertical, reflected once. At a jump of the normal the stripes jump; at
    /// a jump of the curvature they have corners.
    Zebra = 3,
}

impl Style {
    /// Every style.
    pub const ALL: &'static [Self] = &[Self::Shaded, Self::Clay, Self::Normals, Self::Zebra];

    /// The name in command lines and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shaded => "shaded",
            Self::Clay => "clay",
            Self::Normals => "normals",
            Self::Zebra => "zebra",
        }
    }
}

impl std::str::FromStr for Style {
    type Err = UnknownStyle;

    fn from_str(name: &str) -> Result<Self, UnknownStyle> {
        Self::ALL.iter().copied().find(|style| style.name() == name).ok_or_else(|| UnknownStyle(name.to_owned()))
    }
}

/// A name that no style has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no style is called `{0}`; there are: {names}", names = Style::ALL.iter().map(|s| s.name()).collect::<Vec<_>>().join(", "))]
pub struct UnknownStyle(String);
