//! Images beside the colour, by name.

use selvedge::picture::{Outputs, Picture};
use std::str::FromStr;

/// An image beside the colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Image {
    /// Distance along the view axis, model units; +inf is background.
    Depth,
    /// Number of the face; 0 is background.
    Face,
    /// Parameters in the face's domain; NaN is background.
    Uv,
    /// Unit outward normal, model space; 0 is background.
    Normal,
    /// Length of the ray within solids and closed parts, model units.
    Thickness,
    /// Number of the edge whose line covers the pixel; 0 is none.
    Edge,
    /// Index of the part, plus 1; 0 is none.
    Part,
    /// Index of the instance, plus 1; 0 is none.
    Instance,
}

/// The numbers of an image, row 0 on top, the channels of a pixel together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Values<'a> {
    /// So many `f32` a pixel.
    Floats(usize, &'a [f32]),
    /// One `u32` a pixel.
    Numbers(&'a [u32]),
}

impl Image {
    /// Every image.
    pub const ALL: &'static [Self] =
        &[Self::Depth, Self::Face, Self::Uv, Self::Normal, Self::Thickness, Self::Edge, Self::Part, Self::Instance];

    /// As in command lines and arguments.
    pub fn name(self) -> &'static str {
        match self {
            Self::Depth => "depth",
            Self::Face => "face",
            Self::Uv => "uv",
            Self::Normal => "normal",
            Self::Thickness => "thickness",
            Self::Edge => "edge",
            Self::Part => "part",
            Self::Instance => "instance",
        }
    }

    /// All of these.
    pub fn outputs(images: impl IntoIterator<Item = Self>) -> Outputs {
        let mut outputs = Outputs::default();
        for image in images {
            let wanted = match image {
                Self::Depth => &mut outputs.depth,
                Self::Face => &mut outputs.face,
                Self::Uv => &mut outputs.uv,
                Self::Normal => &mut outputs.normal,
                Self::Thickness => &mut outputs.thickness,
                Self::Edge => &mut outputs.edge,
                Self::Part => &mut outputs.part,
                Self::Instance => &mut outputs.instance,
            };
            *wanted = true;
        }
        outputs
    }

    /// The image of a picture; empty where it was not asked for.
    pub fn of(self, picture: &Picture) -> Values<'_> {
        match self {
            Self::Depth => Values::Floats(1, &picture.depth),
            Self::Face => Values::Numbers(&picture.face),
            Self::Uv => Values::Floats(2, picture.uv.as_flattened()),
            Self::Normal => Values::Floats(3, picture.normal.as_flattened()),
            Self::Thickness => Values::Floats(1, &picture.thickness),
            Self::Edge => Values::Numbers(&picture.edge),
            Self::Part => Values::Numbers(&picture.part),
            Self::Instance => Values::Numbers(&picture.instance),
        }
    }
}

impl FromStr for Image {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.iter().copied().find(|image| image.name() == name);
        found.ok_or_else(|| {
            let names: Vec<_> = Self::ALL.iter().map(|image| image.name()).collect();
            format!("no image is called `{name}`; there are: {}", names.join(", "))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each name requests its own image.
    #[test]
    fn names_and_images_belong_together() {
        for image in Image::ALL {
            assert_eq!(image.name().parse::<Image>(), Ok(*image));
            let picture = Picture {
                depth: vec![1.0],
                face: vec![2],
                uv: vec![[3.0; 2]],
                normal: vec![[4.0; 3]],
                thickness: vec![5.0],
                edge: vec![6],
                part: vec![7],
                instance: vec![8],
                ..Picture::default()
            };
            let place = Image::ALL.iter().position(|other| other == image).unwrap() + 1;
            match image.of(&picture) {
                Values::Floats(channels, values) => assert_eq!(values, vec![place as f32; channels]),
                Values::Numbers(values) => assert_eq!(values, [place as u32]),
            }
            let told = format!("{:?}", Image::outputs([*image]));
            assert!(told.contains(&format!("{}: true", image.name())) && told.matches("true").count() == 1, "{told}");
        }
        assert!("colours".parse::<Image>().unwrap_err().contains("depth, face"));
    }
}
