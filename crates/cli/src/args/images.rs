//! Images beside the colour.

use selvedge_jobs::Image;
use std::path::PathBuf;
use std::str::FromStr;

/// An image beside the colour, and the file that it goes to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Aov {
    pub image: Image,
    pub file: PathBuf,
}

impl FromStr for Aov {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = || {
            "wants IMAGE=FILE.npy, the image being depth, face, uv, normal, thickness, edge, part or instance"
                .to_string()
        };
        let (image, file) = text.split_once('=').filter(|(_, file)| !file.is_empty()).ok_or_else(wanted)?;
        Ok(Self { image: image.parse().map_err(|_| wanted())?, file: file.into() })
    }
}
