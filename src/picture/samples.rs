//! How many samples a pixel's colour is made of.

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
