//! The look of surfaces.

/// The look of surfaces. Images beside the colour are the same in every style.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
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
    /// Bands of equal angle to the key light, five degrees each: they have corners where normals jump.
    Isophotes = 4,
    /// White, a little darker on surfaces turned from the viewer: a background for lines.
    Technical = 5,
    /// Mean curvature of the exact surface, half the sum of the principal ones: blue where it is hollow as seen, red
    /// where it bulges. [`FrameSettings::curvature_range`](super::FrameSettings::curvature_range) is the end of the
    /// scale. Needs [`SceneSettings::curvature`](super::SceneSettings::curvature). Triangles and
    /// transparent surfaces are grey.
    MeanCurvature = 6,
    /// Gaussian curvature, the product of both: blue where the surface is a saddle, red where it is a bowl or a dome. The
    /// end of the scale is the square of that of the mean.
    GaussianCurvature = 7,
}

impl Style {
    /// Every style.
    pub const ALL: &'static [Self] = &[
        Self::Shaded,
        Self::Clay,
        Self::Technical,
        Self::Normals,
        Self::Zebra,
        Self::Isophotes,
        Self::MeanCurvature,
        Self::GaussianCurvature,
    ];

    /// Whether it shows curvature. A scene draws it only if
    /// [`SceneSettings::curvature`](super::SceneSettings::curvature) is set.
    pub fn is_curvature(self) -> bool {
        matches!(self, Self::MeanCurvature | Self::GaussianCurvature)
    }

    /// The name in command lines and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shaded => "shaded",
            Self::Clay => "clay",
            Self::Normals => "normals",
            Self::Zebra => "zebra",
            Self::Isophotes => "isophotes",
            Self::Technical => "technical",
            Self::MeanCurvature => "mean-curvature",
            Self::GaussianCurvature => "gaussian-curvature",
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
