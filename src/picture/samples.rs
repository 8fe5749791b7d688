//! How pixels with borders are made: several samples, or borders that are mixed.

/// The number of samples whose mean a pixel's colour is.
///
/// The mean is of linear colours, each clamped to the target's range. The images beside the colour, and the host's
/// depth, are those of the pixel's centre, whatever the number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Samples {
    /// One, at the centre.
    #[default]
    One,
    /// Four, no two in one row or column.
    Four,
    /// Eight, no two in one row or column.
    Eight,
}

impl Samples {
    /// How many.
    pub fn count(self) -> u32 {
        match self {
            Self::One => 1,
            Self::Four => 4,
            Self::Eight => 8,
        }
    }

    /// Where they lie, pixels from the centre, y down; none for [`One`](Self::One). Source: Vulkan 1.3, section 25.3
    /// (standard sample locations).
    pub(crate) fn offsets(self) -> &'static [[f64; 2]] {
        const FOUR: [[f64; 2]; 4] = [[-0.125, -0.375], [0.375, -0.125], [-0.375, 0.125], [0.125, 0.375]];
        const EIGHT: [[f64; 2]; 8] = [
            [0.0625, -0.1875],
            [-0.0625, 0.1875],
            [0.3125, 0.0625],
            [-0.1875, -0.3125],
            [-0.3125, 0.3125],
            [-0.4375, -0.0625],
            [0.1875, 0.4375],
            [0.4375, -0.4375],
        ];
        match self {
            Self::One => &[],
            Self::Four => &FOUR,
            Self::Eight => &EIGHT,
        }
    }
}

impl std::str::FromStr for Samples {
    type Err = UnknownSamples;

    fn from_str(count: &str) -> Result<Self, UnknownSamples> {
        let all = [Self::One, Self::Four, Self::Eight];
        all.into_iter().find(|s| s.count().to_string() == count).ok_or_else(|| UnknownSamples(count.to_owned()))
    }
}

/// No picture has so many samples a pixel.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` samples a pixel: there may be 1, 4 or 8")]
pub struct UnknownSamples(String);

/// Which borders are smooth in pictures of one sample a pixel. Pixels there are mixtures, in linear colour, of what they
/// see. All images but the colour stay those of the pixels' centres, bit for bit, and so do pixels away from borders, but
/// that colours above 1 are cut off there, too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Smooth {
    /// None: a pixel shows what its centre sees.
    #[default]
    None,
    /// Those of trimmed faces, by the area that the exact trim curves cut from each pixel; silhouettes of curved faces,
    /// meshes and Boolean solids stay as they are. [`TrimWay::Auto`](super::TrimWay::Auto) is
    /// [`TrimWay::Exact`](super::TrimWay::Exact) then. What does not go with it is
    /// [`RenderError::SmoothTrims`](crate::renderer::RenderError::SmoothTrims).
    Trims,
    /// Those of faces, meshes and Boolean solids, silhouettes, folds and creases among them, by sixteen points of each
    /// pixel at a border. The faces and meshes that the pixels around see are asked for, and the solids as a whole, exactly.
    /// Rough are solids that are cut from meshes or spline parts, but where a face ends before them, and what is seen
    /// through: behind it, opaque things are smooth. Pictures of several samples stay as they are.
    Borders,
}

impl Smooth {
    /// All.
    pub const ALL: [Self; 3] = [Self::None, Self::Trims, Self::Borders];

    /// What the command line calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Trims => "trims",
            Self::Borders => "borders",
        }
    }
}

impl std::str::FromStr for Smooth {
    type Err = UnknownSmooth;

    fn from_str(name: &str) -> Result<Self, UnknownSmooth> {
        Self::ALL.into_iter().find(|smooth| smooth.name() == name).ok_or_else(|| UnknownSmooth(name.to_owned()))
    }
}

/// No borders are called so.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("smooth are none, trims or borders, and not `{0}`")]
pub struct UnknownSmooth(String);
