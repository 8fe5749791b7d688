//! The host's images: their formats, and those of one frame.

use super::RenderError;
use crate::frame::shading::{NOWHERE, resolve};
use crate::frame::{Stages, target};
use crate::gpu::{Attachment, Commands, Image, Load};
use crate::picture::Outputs;
use ash::vk;

/// The most images of [`Targets`].
pub(super) const TARGETS: usize = 10;

/// Formats of the images that the host will pass to [`Renderer::record`](super::Renderer::record).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TargetFormats {
    /// Colour target; an sRGB format encodes by itself, for others the renderer encodes.
    pub colour: vk::Format,
    /// Depth target, if the host wants the model's depth among its own. Reversed: at distance `z` along the view axis
    /// `near (far - z) / (z (far - near))` in a perspective view and `(far - z) / (far - near)` in a parallel one; 1 at
    /// the near plane, 0 at the far one. Tested with `GREATER_OR_EQUAL`, and written.
    pub depth: Option<vk::Format>,
    /// Which other images there are, each of the format that [`Aovs`] and [`Targets`] name. With `thickness` models are
    /// uploaded with [`SceneSettings::thickness`](crate::picture::SceneSettings::thickness); a frame may leave its image
    /// out.
    pub outputs: Outputs,
}

/// The host's images for one frame. All have the camera's size; with a `corner` they may be larger. [`Image::borrowed`]
/// makes them from Vulkan handles.
///
/// Barriers around the frame are the host's: what it did before must be ordered before
/// [`Access::COLOUR_WRITE`](crate::gpu::Access::COLOUR_WRITE) and
/// [`Access::DEPTH_WRITE`](crate::gpu::Access::DEPTH_WRITE), what it does next after them.
#[derive(Clone, Copy, Debug)]
pub struct Targets<'a> {
    /// In layout `COLOR_ATTACHMENT_OPTIMAL` before and after, as all images but `depth`.
    pub colour: &'a Image,
    /// In layout `DEPTH_STENCIL_ATTACHMENT_OPTIMAL` before and after.
    pub depth: Option<&'a Image>,
    /// Images beside the colour.
    pub aovs: Aovs<'a>,
    /// The length of each pixel's ray within solids, between near and far plane and in model units: Boolean solids and
    /// closed parts, where several overlap counted once; 0 where there is none. `R32_SFLOAT`.
    pub thickness: Option<&'a Image>,
    /// The column and row of the picture's upper left pixel, in all images. Pixels outside the rectangle of the
    /// camera's size are not written. The images need the usage `TRANSFER_DST`, and `TRANSFER_SRC` if
    /// [`background`](crate::picture::FrameSettings::background) is `None`. `None`: the picture is the whole image.
    pub corner: Option<(u32, u32)>,
}

/// Images of what each pixel's centre sees, those that [`TargetFormats::outputs`] names.
/// [`Picture`](crate::picture::Picture) says what each holds.
#[derive(Clone, Copy, Debug, Default)]
pub struct Aovs<'a> {
    /// `R32_SFLOAT`.
    pub depth: Option<&'a Image>,
    /// `R32_UINT`.
    pub face: Option<&'a Image>,
    /// `R32G32_SFLOAT`.
    pub uv: Option<&'a Image>,
    /// `R32G32B32A32_SFLOAT`. The fourth component is 1, but 0 for background and where
    /// [`sun`](crate::picture::SceneSettings::sun) does not reach.
    pub normal: Option<&'a Image>,
    /// `R32_UINT`.
    pub edge: Option<&'a Image>,
    /// `R32_UINT`.
    pub part: Option<&'a Image>,
    /// `R32_UINT`.
    pub instance: Option<&'a Image>,
}

impl TargetFormats {
    /// A colour target alone.
    pub fn new(colour: vk::Format) -> Self {
        Self { colour, depth: None, outputs: Outputs::default() }
    }

    /// As the passes want them.
    pub(super) fn of_passes(self) -> resolve::Formats {
        let o = self.outputs;
        let (aovs, numbers) = ([o.depth, o.face, o.uv, o.normal], [o.edge, o.part, o.instance]);
        resolve::Formats { colour: self.colour, depth: self.depth, aovs, numbers }
    }
}

impl<'a> Targets<'a> {
    /// A colour target alone.
    pub fn new(colour: &'a Image) -> Self {
        Self { colour, depth: None, aovs: Aovs::default(), thickness: None, corner: None }
    }

    /// All of them.
    pub(super) fn all(&self) -> [Option<&'a Image>; TARGETS] {
        let Aovs { depth, face, uv, normal, edge, part, instance } = self.aovs;
        [Some(self.colour), self.depth, self.thickness, depth, face, uv, normal, edge, part, instance]
    }

    /// These targets with other, whole images in place of theirs. `other` gets the number in [`Targets::all`].
    pub(super) fn replaced<'b>(&self, other: impl Fn(usize, &Image) -> Option<&'b Image>) -> Targets<'b>
    where
        'a: 'b,
    {
        let all = self.all();
        let of = |nth: usize| all[nth].and_then(|image| other(nth, image));
        let [depth, face, uv, normal, edge, part, instance] = [3, 4, 5, 6, 7, 8, 9].map(of);
        let aovs = Aovs { depth, face, uv, normal, edge, part, instance };
        Targets { colour: of(0).unwrap_or(self.colour), depth: of(1), thickness: of(2), aovs, corner: None }
    }

    fn points(&self) -> [Option<&'a Image>; 4] {
        let Aovs { depth, face, uv, normal, .. } = self.aovs;
        [depth, face, uv, normal]
    }

    fn all_numbers(&self) -> [Option<&'a Image>; 3] {
        let Aovs { edge, part, instance, .. } = self.aovs;
        [edge, part, instance]
    }

    /// Checks that they have the size of the picture, or contain its rectangle.
    ///
    /// # Panics
    /// When they are not those of `formats`.
    pub(super) fn check(&self, formats: &TargetFormats, size: (u32, u32)) -> Result<(), RenderError> {
        for image in self.all().into_iter().flatten() {
            let (width, height) = image.size();
            let holds = |(x, y): (u32, u32)| {
                let fits = |from: u32, length: u32, all: u32| from.checked_add(length).is_some_and(|end| end <= all);
                fits(x, size.0, width) && fits(y, size.1, height)
            };
            let name = || image.name().to_owned();
            match self.corner {
                None if image.size() != size => return Err(RenderError::TargetSize { name: name(), width, height }),
                Some(corner) if !holds(corner) => {
                    return Err(RenderError::TargetCorner { name: name(), width, height, corner, size });
                }
                _ => {}
            }
        }
        let is_there = |image: Option<&Image>| image.is_some();
        let [depth, face, uv, normal] = self.points().map(is_there);
        let [edge, part, instance] = self.all_numbers().map(is_there);
        assert!(self.thickness.is_none() || formats.outputs.thickness, "TargetFormats::outputs has a thickness");
        let thickness = formats.outputs.thickness;
        let outputs = Outputs { depth, face, uv, normal, thickness, edge, part, instance };
        assert_eq!(outputs, formats.outputs, "the targets are those of TargetFormats::outputs");
        assert_eq!(is_there(self.depth), formats.depth.is_some(), "the targets are those of TargetFormats::depth");
        Ok(())
    }

    /// Draws nothing: what pixels without a surface have, into each image. Without a background the host's picture stays,
    /// and only the lengths within solids are cleared.
    pub(super) fn clear(&self, cmd: &Commands<'_>, background: Option<[f32; 4]>) {
        let clear = |image: Option<&Image>, load| {
            if let Some(image) = image {
                cmd.rendering(image.size(), &[Attachment { image, load }], None, || ());
            }
        };
        clear(self.thickness, Load::ColourF32([0.0; 4]));
        let Some(background) = background else { return };
        clear(Some(self.colour), Load::ColourF32(background));
        self.points().into_iter().zip(NOWHERE).for_each(|(image, load)| clear(image, load));
        self.all_numbers().into_iter().for_each(|image| clear(image, Load::ColourU32([0; 4])));
        if let Some(image) = self.depth {
            cmd.rendering(image.size(), &[], Some(Attachment { image, load: Load::Depth(0.0) }), || ());
        }
    }

    /// What pass `resolve` draws into.
    pub(super) fn colours<'b>(&self, formats: &TargetFormats, stages: &'b Stages, keep: bool) -> Vec<Attachment<'b>>
    where
        'a: 'b,
    {
        let aovs = self.points().into_iter().enumerate().filter(|_| formats.outputs.has_points());
        let aovs = aovs.map(|(k, image)| target(image.unwrap_or_else(|| spare(stages, k)), keep));
        [target(self.colour, keep)].into_iter().chain(aovs).collect()
    }

    /// Images of edges, parts and instances, where there is one of them.
    pub(super) fn numbers<'b>(
        &self,
        formats: &TargetFormats,
        stages: &'b Stages,
        keep: bool,
    ) -> Option<[Attachment<'b>; 3]>
    where
        'a: 'b,
    {
        let images = self.all_numbers();
        let of = |k: usize| target(images[k].unwrap_or_else(|| spare(stages, 4 + k)), keep);
        formats.outputs.has_numbers().then(|| [0, 1, 2].map(of))
    }
}

fn spare(stages: &Stages, number: usize) -> &Image {
    stages.spare(number).expect("what the host does not want is drawn into an image of the stage")
}

#[cfg(test)]
mod tests;
