//! Smooth edges: several samples a pixel, or mixed pixels at borders.

/// The number of samples whose mean a pixel's colour is.
///
/// The mean is that of linear colours, each clamped to the target's range. The images beside the colour, and the host's
/// depth, are always those of the pixel's centre.
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
    /// Number of samples.
    pub fn count(self) -> u32 {
        match self {
            Self::One => 1,
            Self::Four => 4,
            Self::Eight => 8,
        }
    }

    /// Positions in pixels from the centre, y down; empty for [`One`](Self::One). Source: Vulkan 1.3, section 25.3
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

/// A name that no number of samples has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` samples a pixel: there may be 1, 4 or 8")]
pub struct UnknownSamples(String);

/// The borders that are smooth in pictures of one sample a pixel. A pixel at a border is a mixture, in linear colour,
/// of the surfaces in it. All images but the colour stay those of the pixels' centres, bit for bit. So do pixels away
/// from borders, except that colours above 1 are cut off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Smooth {
    /// None: a pixel shows the surface at its centre.
    #[default]
    None,
    /// Borders of trimmed faces, by the area that the exact trim curves cut from each pixel. Silhouettes of curved
    /// faces, meshes and Boolean solids stay as they are. [`TrimWay::Auto`](super::TrimWay::Auto) then is
    /// [`TrimWay::Exact`](super::TrimWay::Exact). Other settings that exclude it give
    /// [`RenderError::SmoothTrims`](crate::renderer::RenderError::SmoothTrims).
    Trims,
    /// Borders of faces, meshes and Boolean solids, including silhouettes, folds and creases, by sixteen points of each
    /// pixel at a border. At each point, the faces and meshes visible in the surrounding pixels are evaluated exactly,
    /// and so is the whole Boolean expression. Solids cut from meshes or spline parts are smooth only where a face or
    /// mesh in front of them ends. Transparent things keep their rough outlines; what is opaque behind them is smooth.
    /// Pictures with several samples stay as they are.
    Borders,
}

impl Smooth {
    /// All.
    pub const ALL: [Self; 3] = [Self::None, Self::Trims, Self::Borders];

    /// The name in command lines.
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

/// A name that no choice of borders has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("smooth are none, trims or borders, and not `{0}`")]
pub struct UnknownSmooth(String);
