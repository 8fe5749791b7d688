//! The images that a picture is drawn into, and the host memory that they are copied to.

use crate::gpu::{Access, Commands, Device, GpuError, Image, ImageInfo, Pool, ReadBack, barrier};
use crate::model::Camera;
use crate::picture::{FrameSettings, FrameStats, Outputs, Picture};
use crate::renderer::{Aovs, FrameInput, RenderError, Renderer, TargetFormats, Targets};
use ash::vk;
use bytemuck::Pod;

/// A picture where the GPU has copied it: mapped memory that the CPU caches. Images that [`Outputs`] leaves out are
/// empty.
#[derive(Clone, Debug)]
pub struct PictureView<'a> {
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// As [`Picture::colour`].
    pub colour: &'a [[u8; 4]],
    /// As [`Picture::depth`].
    pub depth: &'a [f32],
    /// As [`Picture::face`].
    pub face: &'a [u32],
    /// As [`Picture::uv`].
    pub uv: &'a [[f32; 2]],
    /// As [`Picture::normal`]. The fourth component is 1, but 0 for background and where
    /// [`sun`](crate::picture::SceneSettings::sun) does not reach.
    pub normal: &'a [[f32; 4]],
    /// As [`Picture::thickness`].
    pub thickness: &'a [f32],
    /// As [`Picture::edge`].
    pub edge: &'a [u32],
    /// As [`Picture::part`].
    pub part: &'a [u32],
    /// As [`Picture::instance`].
    pub instance: &'a [u32],
    /// The frame's statistics.
    pub stats: FrameStats,
    /// The scene has a sun.
    pub(super) has_sun: bool,
}

impl PictureView<'_> {
    /// A picture of one's own: each image is copied once.
    pub fn to_picture(&self) -> Picture {
        let sunlit = if self.has_sun { self.normal.iter().map(|n| n[3] > 0.0).collect() } else { Vec::new() };
        Picture {
            size: self.size,
            colour: self.colour.to_vec(),
            depth: self.depth.to_vec(),
            face: self.face.to_vec(),
            uv: self.uv.to_vec(),
            normal: self.normal.iter().map(|n| [n[0], n[1], n[2]]).collect(),
            sunlit,
            thickness: self.thickness.to_vec(),
            edge: self.edge.to_vec(),
            part: self.part.to_vec(),
            instance: self.instance.to_vec(),
            stats: self.stats.clone(),
        }
    }
}

/// What images there are, and of what size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Kind {
    pub(super) size: (u32, u32),
    pub(super) formats: TargetFormats,
    pub(super) thickness: bool,
}

/// Images, each with the buffer that it is copied to.
pub(super) struct TargetImages {
    kind: Kind,
    colour: (Image, ReadBack),
    aovs: Option<[(Image, ReadBack); 4]>,
    thickness: Option<(Image, ReadBack)>,
    numbers: Option<[(Image, ReadBack); 3]>,
}

impl TargetImages {
    /// Those that are there, or others in their place if they are of another kind. The GPU is not using them.
    pub(super) fn fitting<'a>(images: &'a mut Option<Self>, device: &Device, kind: Kind) -> Result<&'a Self, GpuError> {
        // freed first: both may not fit into memory
        let fitting = images.take().filter(|images| images.kind == kind);
        Ok(images.insert(fitting.map_or_else(|| Self::new(device, kind), Ok)?))
    }

    fn new(device: &Device, kind: Kind) -> Result<Self, GpuError> {
        let Kind { size, formats, thickness } = kind;
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
        let target = |name: &str, format, bytes: u64| {
            let image = Image::new(device, &ImageInfo { name, size, format, usage, pool: Pool::Transient })?;
            let pixels = u64::from(size.0) * u64::from(size.1);
            Ok::<_, GpuError>((image, ReadBack::new(device, &format!("{name} (read back)"), pixels * bytes)?))
        };
        let colour = target("colour", formats.colour, 4)?;
        let [depth, face, uv, normal] = Renderer::AOV_FORMATS;
        let aovs = formats
            .outputs
            .has_points()
            .then(|| {
                Ok::<_, GpuError>([
                    target("depth", depth, 4)?,
                    target("face", face, 4)?,
                    target("uv", uv, 8)?,
                    target("normal", normal, 16)?,
                ])
            })
            .transpose()?;
        let thickness = thickness.then(|| target("thickness", Renderer::THICKNESS_FORMAT, 4)).transpose()?;
        let number = |name| target(name, Renderer::NUMBER_FORMAT, 4);
        let numbers = || Ok::<_, GpuError>([number("edge")?, number("part")?, number("instance")?]);
        let numbers = formats.outputs.has_numbers().then(numbers).transpose()?;
        Ok(Self { kind, colour, aovs, thickness, numbers })
    }

    fn all(&self) -> impl Iterator<Item = &(Image, ReadBack)> {
        let numbers = self.numbers.iter().flatten();
        std::iter::once(&self.colour).chain(self.aovs.iter().flatten()).chain(&self.thickness).chain(numbers)
    }

    /// Records a frame into them, in a slot that is free, and the copies to host memory.
    pub(super) fn record(
        &self,
        renderer: &mut Renderer,
        cmd: &Commands<'_>,
        (camera, settings): (&Camera, &FrameSettings),
        slot: usize,
    ) -> Result<(), RenderError> {
        self.begin(cmd);
        let aov = |i: usize| self.aovs.as_ref().map(|aovs| &aovs[i].0);
        let number = |i: usize| self.numbers.as_ref().map(|numbers| &numbers[i].0);
        let [depth, face, uv, normal] = [0, 1, 2, 3].map(aov);
        let [edge, part, instance] = [0, 1, 2].map(number);
        let aovs = Aovs { depth, face, uv, normal, edge, part, instance };
        let thickness = self.thickness.as_ref().map(|(image, _)| image);
        let targets = Targets { aovs, thickness, ..Targets::new(&self.colour.0) };
        let input = FrameInput { camera, settings: *settings, slot, targets };
        // SAFETY: recording; the slot's last submission was waited for, and frames are submitted as they are recorded.
        unsafe { renderer.record(cmd.raw(), &input) }?;
        self.end(cmd);
        Ok(())
    }

    /// Ready to be drawn into; what they held goes.
    fn begin(&self, cmd: &Commands<'_>) {
        let before = Access::TRANSFER_READ.discarded();
        let barriers: Vec<_> = self.all().map(|(image, _)| (image, before, Access::COLOUR_WRITE)).collect();
        barrier::images(cmd, &barriers);
    }

    /// Copied to host memory.
    fn end(&self, cmd: &Commands<'_>) {
        let barriers: Vec<_> =
            self.all().map(|(image, _)| (image, Access::COLOUR_WRITE, Access::TRANSFER_READ)).collect();
        barrier::images(cmd, &barriers);
        self.all().for_each(|(image, read)| read.record_image(cmd, image, vk::ImageAspectFlags::COLOR));
    }

    /// The copies, after the fence.
    pub(super) fn view(&self, outputs: Outputs, stats: FrameStats, has_sun: bool) -> PictureView<'_> {
        let (width, height) = self.kind.size;
        let count = width as usize * height as usize;
        let aov = |i: usize| self.aovs.as_ref().map(|aovs| &aovs[i].1);
        let number = |i: usize| self.numbers.as_ref().map(|numbers| &numbers[i].1);
        fn slice<T: Pod>(read: Option<&ReadBack>, wanted: bool, count: usize) -> &[T] {
            read.filter(|_| wanted).map_or(&[], |read| read.slice(count))
        }
        PictureView {
            size: self.kind.size,
            colour: self.colour.1.slice(count),
            depth: slice(aov(0), outputs.depth, count),
            face: slice(aov(1), outputs.face, count),
            uv: slice(aov(2), outputs.uv, count),
            normal: slice(aov(3), outputs.normal, count),
            thickness: slice(self.thickness.as_ref().map(|(_, read)| read), outputs.thickness, count),
            edge: slice(number(0), outputs.edge, count),
            part: slice(number(1), outputs.part, count),
            instance: slice(number(2), outputs.instance, count),
            stats,
            has_sun,
        }
    }
}
