//! The host's images: their formats, and those of one frame.

use super::RenderError;
use crate::frame::shading::resolve;
use crate::frame::{Stages, target};
use crate::gpu::{Attachment, Image};
use crate::picture::Outputs;
use ash::vk;

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

/// The host's images for one frame, all of the camera's size: [`Image::borrowed`] makes them of Vulkan
/// handles.
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
        Self { colour, depth: None, aovs: Aovs::default(), thickness: None }
    }

    fn points(&self) -> [Option<&'a Image>; 4] {
        let Aovs { depth, face, uv, normal, .. } = self.aovs;
        [depth, face, uv, normal]
    }

    fn all_numbers(&self) -> [Option<&'a Image>; 3] {
        let Aovs { edge, part, instance, .. } = self.aovs;
        [edge, part, instance]
    }

    /// They have the size of the picture.
    ///
    /// # Panics
    /// When they are not those of `formats`.
    pub(super) fn check(&self, formats: &TargetFormats, size: (u32, u32)) -> Result<(), RenderError> {
        let fixed = [Some(self.colour), self.depth, self.thickness];
        for image in fixed.into_iter().chain(self.points()).chain(self.all_numbers()).flatten() {
            if image.size() != size {
                let (width, height) = image.size();
                return Err(RenderError::TargetSize { name: image.name().to_owned(), width, height });
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

#[cfg(all(test, feature = "headless"))]
mod tests {
    use super::*;
    use crate::gpu::{Access, Device, ImageInfo, Pool, ReadBack, barrier};
    use crate::headless::{HeadlessDevice, HeadlessOptions};
    use crate::model::{Camera, Model};
    use crate::picture::{EdgeSettings, FrameSettings, SceneSettings};
    use crate::renderer::{FrameInput, Renderer};
    use glam::DVec3;

    const SIZE: (u32, u32) = (64, 48);
    const ALL: Outputs = Outputs { edge: true, part: true, instance: true, ..Outputs::ALL };

    fn image(device: &Device, name: &str, format: vk::Format, texel: u64) -> (Image, ReadBack, u64) {
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
        let image = Image::new(device, &ImageInfo { name, size: SIZE, format, usage, pool: Pool::Transient }).unwrap();
        let bytes = u64::from(SIZE.0 * SIZE.1) * texel;
        (image, ReadBack::new(device, name, bytes).unwrap(), bytes)
    }

    /// The images of one frame of these outputs, in the order of their fields behind the colour; empty where there is none.
    fn drawn(device: &HeadlessDevice, model: &Model, settings: SceneSettings, outputs: Outputs) -> Vec<Vec<u8>> {
        let gpu = device.device();
        let formats = TargetFormats { outputs, ..TargetFormats::new(vk::Format::R8G8B8A8_SRGB) };
        let mut renderer = Renderer::on(gpu, formats, 1).unwrap();
        renderer.upload_with(model, settings).unwrap();
        let Outputs { depth, face, uv, normal, edge, part, instance, .. } = outputs;
        let [of_depth, of_face, of_uv, of_normal] = Renderer::AOV_FORMATS;
        let number = Renderer::NUMBER_FORMAT;
        let named = [
            ("colour", true, formats.colour, 4),
            ("depth", depth, of_depth, 4),
            ("face", face, of_face, 4),
            ("uv", uv, of_uv, 8),
            ("normal", normal, of_normal, 16),
            ("edge", edge, number, 4),
            ("part", part, number, 4),
            ("instance", instance, number, 4),
        ];
        let made = named.map(|(name, wanted, format, texel)| wanted.then(|| image(gpu, name, format, texel)));
        let of = |k: usize| made[k].as_ref().map(|(image, ..)| image);
        let [depth, face, uv, normal] = [1, 2, 3, 4].map(of);
        let [edge, part, instance] = [5, 6, 7].map(of);
        let aovs = Aovs { depth, face, uv, normal, edge, part, instance };
        let targets = Targets { aovs, ..Targets::new(of(0).unwrap()) };
        let bounds = model.control_bounds();
        let camera = Camera::around(bounds, DVec3::new(1.0, -1.6, 1.1), DVec3::Z, 0.6, SIZE);
        let input = FrameInput { camera: &camera, settings: FrameSettings::default(), slot: 0, targets };
        let there = || made.iter().flatten();
        while !renderer.report(0).unwrap().is_some_and(|report| report.complete) {
            let recorded = device.try_submit(|cmd| {
                let new = there().map(|(i, ..)| (i, Access::TRANSFER_READ.discarded(), Access::COLOUR_WRITE));
                barrier::images(cmd, &new.collect::<Vec<_>>());
                // SAFETY: recording; the submission is waited for.
                unsafe { renderer.record(cmd.raw(), &input) }?;
                let end = there().map(|(i, ..)| (i, Access::COLOUR_WRITE, Access::TRANSFER_READ));
                barrier::images(cmd, &end.collect::<Vec<_>>());
                there().for_each(|(i, read, _)| read.record_image(cmd, i, vk::ImageAspectFlags::COLOR));
                Ok::<_, RenderError>(())
            });
            recorded.unwrap().unwrap();
        }
        made.iter()
            .map(|made| made.as_ref().map_or_else(Vec::new, |(_, read, bytes)| read.values(*bytes as usize)))
            .collect()
    }

    /// Any choice of images: each is the same as among all of them.
    #[test]
    fn each_image_stands_by_itself() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("samples/bracket.step");
        let mut model = selvedge_io::import::open(&path).unwrap().model;
        let device = HeadlessDevice::new(&HeadlessOptions { device: None, validation: true }).unwrap();
        let one = |k: usize| Outputs {
            depth: k == 0,
            face: k == 1,
            uv: k == 2,
            normal: k == 3,
            edge: k == 4,
            part: k == 5,
            instance: k == 6,
            thickness: false,
        };
        let settings = SceneSettings { edges: Some(EdgeSettings::default()), ..SceneSettings::default() };
        for is_clear in [false, true] {
            if is_clear {
                model.instances[0].colour = Some([0.1, 0.2, 0.9, 0.5]);
            }
            let all = drawn(&device, &model, settings, ALL);
            let some = Outputs { face: true, normal: true, instance: true, ..Outputs::default() };
            let singles = if is_clear { 1..2 } else { 0..7 };
            for outputs in singles.map(one).chain([some]) {
                let own = drawn(&device, &model, settings, outputs);
                for (k, (own, all)) in own.iter().zip(&all).enumerate() {
                    assert!(own.is_empty() || own == all, "image {k} of {outputs:?}, seen through: {is_clear}");
                }
                let wanted = outputs.has_points() || outputs.has_numbers();
                assert_eq!(own[1..].iter().any(|image| !image.is_empty()), wanted);
            }
        }
        let messages = device.shutdown();
        assert!(messages.is_empty(), "{messages:?}");
    }

    #[test]
    fn what_hosts_hold_crosses_threads() {
        fn crosses<T: Send + Sync>() {}
        crosses::<Renderer>();
        crosses::<Image>();
        crosses::<Model>();
        crosses::<Camera>();
        crosses::<RenderError>();
        crosses::<crate::headless::HeadlessRenderer>();
        crosses::<crate::headless::HeadlessError>();
        crosses::<crate::picture::Picture>();
    }
}
