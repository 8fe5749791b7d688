//! A whole picture in host memory: device, targets, frame, read-back.

use super::{HeadlessDevice, HeadlessError, HeadlessOptions};
use crate::gpu::{Access, Commands, Device, GpuError, Image, ImageInfo, LowerLimits, Pool, ReadBack, barrier};
use crate::model::{Camera, Colour, LoopAt, Model, TrimLoop};
use crate::picture::{FrameSettings, FrameStats, Outputs, Picture, SceneSettings};
use crate::renderer::{Aovs, EditError, FrameInput, Hit, InstanceError, RenderError, Renderer, TargetFormats, Targets};
use crate::scene::SceneRequest;
use ash::vk;
use bytemuck::Pod;
use glam::DAffine3;
use std::mem::ManuallyDrop;
use std::sync::Arc;
use std::time::Duration;

/// Colour is rendered to 8 bits, encoded by the format.
const COLOUR_FORMAT: vk::Format = vk::Format::R8G8B8A8_SRGB;
/// A frame is recorded again when a buffer was too small; each time they grow to what was needed, so
/// more than a few rounds mean that something else is wrong.
pub(super) const MOST_RETRIES: u32 = 8;

/// Renders models into [`Picture`]s, on a device of its own.
pub struct HeadlessRenderer {
    // drop order: everything made from the device, then the device
    pub(super) renderer: ManuallyDrop<Renderer>,
    targets: ManuallyDrop<Option<TargetImages>>,
    pub(super) device: ManuallyDrop<HeadlessDevice>,
    /// What the renderer draws into.
    pub(super) formats: TargetFormats,
}

/// Images of one size, and the buffers that they are copied to.
pub(super) struct TargetImages {
    pub(super) colour: (Image, ReadBack),
    pub(super) aovs: Option<[(Image, ReadBack); 4]>,
    thickness: Option<(Image, ReadBack)>,
    numbers: Option<[(Image, ReadBack); 3]>,
}

/// Whoever waits for a whole picture has no use for a part of one.
fn renderer(device: &Device, formats: TargetFormats) -> Result<Renderer, GpuError> {
    let mut renderer = Renderer::on(device, formats, 1)?;
    renderer.counts_first = true;
    Ok(renderer)
}

impl HeadlessRenderer {
    /// Makes the device.
    ///
    /// # Errors
    /// [`HeadlessError`]: no loader, no device, no validation layers.
    pub fn new(options: &HeadlessOptions) -> Result<Self, HeadlessError> {
        Self::limited(options, LowerLimits::NONE)
    }

    /// As [`new`](Self::new), with lower limits.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    #[doc(hidden)]
    pub fn limited(options: &HeadlessOptions, lower: LowerLimits) -> Result<Self, HeadlessError> {
        let device = HeadlessDevice::limited(options, lower)?;
        let formats = TargetFormats::new(COLOUR_FORMAT);
        let renderer = renderer(device.device(), formats)?;
        Ok(Self {
            renderer: ManuallyDrop::new(renderer),
            targets: ManuallyDrop::new(None),
            device: ManuallyDrop::new(device),
            formats,
        })
    }

    /// Replaces the model.
    ///
    /// # Errors
    /// [`HeadlessError::Gpu`].
    pub fn upload(&mut self, model: &Model) -> Result<(), HeadlessError> {
        self.upload_with(model, SceneSettings::default())
    }

    /// As [`upload`](Self::upload), with settings that hold as long as the model.
    ///
    /// # Errors
    /// [`HeadlessError::Gpu`].
    pub fn upload_with(&mut self, model: &Model, settings: SceneSettings) -> Result<(), HeadlessError> {
        self.upload_shared(Arc::new(model.clone()), settings, &|_| ())
    }

    /// The same of a model that is not copied; `progress` as in [`Renderer::upload_with_progress`].
    ///
    /// # Errors
    /// [`HeadlessError::Gpu`].
    pub fn upload_shared(
        &mut self,
        model: Arc<Model>,
        settings: SceneSettings,
        progress: &(dyn Fn(usize) + Sync),
    ) -> Result<(), HeadlessError> {
        self.upload_request(model, settings.into(), progress)
    }

    /// As [`upload_with`](Self::upload_with), with baselines in place of the engine's own methods.
    ///
    /// # Errors
    /// [`HeadlessError::Gpu`].
    #[cfg(feature = "baselines")]
    #[doc(hidden)]
    pub fn upload_baseline(
        &mut self,
        model: &Model,
        settings: SceneSettings,
        baseline: crate::baselines::SceneOptions,
    ) -> Result<(), HeadlessError> {
        self.upload_request(Arc::new(model.clone()), SceneRequest { settings, baseline }, &|_| ())
    }

    fn upload_request(
        &mut self,
        model: Arc<Model>,
        request: SceneRequest,
        progress: &(dyn Fn(usize) + Sync),
    ) -> Result<(), HeadlessError> {
        Ok(self.renderer.upload_request(model, request, progress)?)
    }

    /// Replaces a trim loop of the model, which was uploaded as editable; see [`Renderer::edit_loop`].
    ///
    /// # Errors
    /// [`EditError`]; the scene is as it was.
    ///
    /// # Panics
    /// When no model was uploaded.
    pub fn edit_loop(&mut self, at: LoopAt, new: &TrimLoop) -> Result<(), EditError> {
        self.renderer.edit_loop(at, new)
    }

    /// See [`Renderer::set_transform`].
    ///
    /// # Errors
    /// [`InstanceError`]; the scene is as it was.
    ///
    /// # Panics
    /// When no model was uploaded.
    pub fn set_transform(&mut self, instance: usize, transform: DAffine3) -> Result<(), InstanceError> {
        self.renderer.set_transform(instance, transform)
    }

    /// See [`Renderer::set_visible`].
    ///
    /// # Errors
    /// [`InstanceError`]; the scene is as it was.
    ///
    /// # Panics
    /// When no model was uploaded.
    pub fn set_visible(&mut self, instance: usize, visible: bool) -> Result<(), InstanceError> {
        self.renderer.set_visible(instance, visible)
    }

    /// See [`Renderer::set_colour`].
    ///
    /// # Errors
    /// [`InstanceError`]; the scene is as it was.
    ///
    /// # Panics
    /// When no model was uploaded.
    pub fn set_colour(&mut self, instance: usize, colour: Option<Colour>) -> Result<(), InstanceError> {
        self.renderer.set_colour(instance, colour)
    }

    /// See [`Renderer::set_selected`].
    ///
    /// # Errors
    /// [`InstanceError`]; the scene is as it was.
    ///
    /// # Panics
    /// When no model was uploaded.
    pub fn set_selected(&mut self, instance: usize, highlight: Option<Colour>) -> Result<(), InstanceError> {
        self.renderer.set_selected(instance, highlight)
    }

    /// Lets the next picture read back what it shows at a pixel: see [`Renderer::pick`].
    pub fn pick(&mut self, x: u32, y: u32) {
        self.renderer.pick(x, y);
    }

    /// What the last picture shows there: see [`Renderer::picked`].
    pub fn picked(&self) -> Option<Hit> {
        self.renderer.picked(0)
    }

    /// Renders one picture and waits for it.
    ///
    /// # Errors
    /// [`HeadlessError`].
    ///
    /// # Panics
    /// When no model was uploaded.
    pub fn render(
        &mut self,
        camera: &Camera,
        settings: &FrameSettings,
        outputs: Outputs,
    ) -> Result<Picture, HeadlessError> {
        camera.check().map_err(RenderError::from)?;
        self.prepare(camera.size, outputs)?;
        let (mut retries, mut edit_bytes) = (0, 0);
        let stats = loop {
            let report = self.frame(camera, settings)?;
            edit_bytes += report.1.edit_bytes;
            if report.0 {
                break report.1;
            }
            retries += 1;
            if retries > MOST_RETRIES {
                return Err(HeadlessError::NeverComplete);
            }
        };
        Ok(self.read(camera.size, outputs, FrameStats { retries, edit_bytes, ..stats }))
    }

    /// Validation messages so far.
    pub fn messages(&self) -> Vec<String> {
        self.device.messages().iter().map(ToString::to_string).collect()
    }

    /// Names of the buffers, images and pipelines that exist.
    pub fn objects(&self) -> Vec<String> {
        self.renderer.objects()
    }

    /// The same with the bytes that each takes.
    pub fn object_bytes(&self) -> Vec<(String, u64)> {
        self.device.device().object_bytes()
    }

    /// The time that the driver has spent so far on making pipelines: [`Device::pipeline_time`].
    pub fn pipeline_time(&self) -> Duration {
        self.device.device().pipeline_time()
    }

    /// Frees everything and returns all validation messages, those about leaks included.
    pub fn shutdown(mut self) -> Vec<String> {
        // SAFETY: each is taken once, and `self` is forgotten; every frame was waited for.
        let device = unsafe {
            ManuallyDrop::drop(&mut self.renderer);
            ManuallyDrop::drop(&mut self.targets);
            ManuallyDrop::take(&mut self.device)
        };
        std::mem::forget(self);
        device.shutdown().iter().map(ToString::to_string).collect()
    }

    fn frame(&mut self, camera: &Camera, settings: &FrameSettings) -> Result<(bool, FrameStats), HeadlessError> {
        let Some(images) = &*self.targets else { unreachable!("prepared before") };
        let renderer = &mut *self.renderer;
        self.device.try_submit(|cmd| images.record(renderer, cmd, (camera, settings), 0))??;
        let report = self.renderer.report(0)?.expect("a frame was recorded");
        Ok((report.complete, report.stats))
    }

    /// Makes targets of this size, and a renderer that writes these images.
    pub(super) fn prepare(&mut self, size: (u32, u32), outputs: Outputs) -> Result<(), HeadlessError> {
        let thickness = outputs.thickness;
        let Some(source) = self.renderer.source() else { panic!("upload a model before rendering") };
        let mut request = source.request();
        let lacks_thickness = thickness && !request.thickness;
        request.settings.thickness |= thickness;
        // images that one pass makes come together: another choice among them makes no other renderer
        let (points, numbers) = (outputs.has_points(), outputs.has_numbers());
        let outputs = Outputs {
            depth: points,
            face: points,
            uv: points,
            normal: points,
            thickness: request.thickness,
            edge: numbers,
            part: numbers,
            instance: numbers,
        };
        let formats = TargetFormats { outputs, ..self.formats };
        if formats != self.formats || lacks_thickness {
            let source = source.with(request);
            let mut renderer = renderer(self.device.device(), formats)?;
            renderer.upload_source(source, &|_| ())?;
            *self.renderer = renderer;
            self.formats = formats;
            *self.targets = None;
        }
        let fits = |t: &TargetImages| t.colour.0.size() == size && t.thickness.is_some() == thickness;
        if !self.targets.as_ref().is_some_and(fits) {
            *self.targets = None;
            *self.targets = Some(TargetImages::new(self.device.device(), size, formats, thickness)?);
        }
        Ok(())
    }

    fn read(&self, size: (u32, u32), outputs: Outputs, stats: FrameStats) -> Picture {
        let Some(images) = &*self.targets else { unreachable!("prepared before") };
        let count = size.0 as usize * size.1 as usize;
        let aov = |i: usize| images.aovs.as_ref().map(|a| &a[i].1);
        let number = |i: usize| images.numbers.as_ref().map(|n| &n[i].1);
        fn values<T: Pod>(read: Option<&ReadBack>, wanted: bool, count: usize) -> Vec<T> {
            read.filter(|_| wanted).map_or_else(Vec::new, |r| r.values(count))
        }
        let normals: Vec<[f32; 4]> = values(aov(3), outputs.normal, count);
        let has_sun = self.renderer.source().is_some_and(|source| source.request().sun.is_some());
        Picture {
            size,
            colour: images.colour.1.values(count),
            depth: values(aov(0), outputs.depth, count),
            face: values(aov(1), outputs.face, count),
            uv: values(aov(2), outputs.uv, count),
            normal: normals.iter().map(|n| [n[0], n[1], n[2]]).collect(),
            sunlit: if has_sun { normals.iter().map(|n| n[3] > 0.0).collect() } else { Vec::new() },
            edge: values(number(0), outputs.edge, count),
            part: values(number(1), outputs.part, count),
            instance: values(number(2), outputs.instance, count),
            thickness: values(images.thickness.as_ref().map(|t| &t.1), outputs.thickness, count),
            stats,
        }
    }
}

impl Drop for HeadlessRenderer {
    fn drop(&mut self) {
        // SAFETY: dropped once, here, in the order of their dependence; every frame was waited for.
        unsafe {
            ManuallyDrop::drop(&mut self.renderer);
            ManuallyDrop::drop(&mut self.targets);
            ManuallyDrop::drop(&mut self.device);
        }
    }
}

impl TargetImages {
    pub(super) fn new(
        device: &Device,
        size: (u32, u32),
        formats: TargetFormats,
        thickness: bool,
    ) -> Result<Self, GpuError> {
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
        let target = |name: &str, format, bytes: u64| {
            let image = Image::new(device, &ImageInfo { name, size, format, usage, pool: Pool::Transient })?;
            let pixels = u64::from(size.0) * u64::from(size.1);
            Ok::<_, GpuError>((image, ReadBack::new(device, &format!("{name} (read back)"), pixels * bytes)?))
        };
        let colour = target("colour", COLOUR_FORMAT, 4)?;
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
        Ok(Self { colour, aovs, thickness, numbers })
    }

    fn all(&self) -> impl Iterator<Item = &(Image, ReadBack)> {
        let numbers = self.numbers.iter().flatten();
        std::iter::once(&self.colour).chain(self.aovs.iter().flatten()).chain(&self.thickness).chain(numbers)
    }

    /// A frame into them, in a slot that is free, and its way to host memory.
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
        // SAFETY: recording; the slot's last submission was waited for, and this one will be.
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
}
