//! A whole picture in host memory: device, targets, frame, read-back.

use super::sequence::{Flight, View};
use super::{HeadlessDevice, HeadlessError, HeadlessOptions};
use crate::gpu::{Device, GpuError, LowerLimits};
use crate::model::{Camera, Colour, LoopAt, Model, TrimLoop};
use crate::picture::{FrameSettings, Outputs, Picture, SceneSettings};
use crate::renderer::{EditError, Hit, InstanceError, ModelId, RemoveError, RenderError, Renderer, TargetFormats};
use crate::scene::SceneRequest;
use ash::vk;
use glam::DAffine3;
use std::mem::ManuallyDrop;
use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

/// Colour is rendered to 8 bits, encoded by the format.
const COLOUR_FORMAT: vk::Format = vk::Format::R8G8B8A8_SRGB;

/// What a [`HeadlessRenderer`] calls between two steps of a picture: [`HeadlessRenderer::set_watch`].
pub type Watch = Arc<dyn Fn() + Send + Sync>;

/// Renders models into [`Picture`]s, on a device of its own. The crate's front page has an example.
///
/// It is a host as `docs/embedding.md` has it, around a [`Renderer`]: it makes the device and the images, submits,
/// waits, and draws a frame again that lacked room.
pub struct HeadlessRenderer {
    // drop order: the GPU finishes, then everything made from the device goes, then the device
    /// One for each frame slot of the renderer.
    pub(super) flights: ManuallyDrop<Vec<Flight>>,
    pub(super) renderer: ManuallyDrop<Renderer>,
    pub(super) device: ManuallyDrop<HeadlessDevice>,
    /// What the renderer draws into.
    pub(super) formats: TargetFormats,
    /// What pictures of the next model will have.
    expected: Option<Outputs>,
    watch: Option<Watch>,
}

/// Draws whole pictures only: a frame whose lists overflow draws no patches.
fn renderer(device: &Device, formats: TargetFormats) -> Result<Renderer, GpuError> {
    let mut renderer = Renderer::on(device, formats, 1)?;
    renderer.counts_first = true;
    Ok(renderer)
}

impl HeadlessRenderer {
    /// Makes the device. [`upload`](Self::upload) a model next.
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
        Self::on(HeadlessDevice::limited(options, lower)?)
    }

    /// On a device of the caller's choice.
    ///
    /// # Errors
    /// [`HeadlessError::Gpu`].
    pub fn on(device: HeadlessDevice) -> Result<Self, HeadlessError> {
        let formats = TargetFormats::new(COLOUR_FORMAT);
        let flight = Flight::new(&device)?;
        let renderer = renderer(device.device(), formats)?;
        Ok(Self {
            flights: ManuallyDrop::new(vec![flight]),
            renderer: ManuallyDrop::new(renderer),
            device: ManuallyDrop::new(device),
            formats,
            expected: None,
            watch: None,
        })
    }

    /// The images that pictures of the next model will have: its upload makes what they need. Without this call an
    /// upload makes what the picture before needed, at first the colour alone, and a picture with other images has the
    /// model uploaded anew.
    pub fn expect(&mut self, outputs: Outputs) {
        self.expected = Some(outputs);
    }

    /// Replaces the model; the next picture shows it.
    ///
    /// # Errors
    /// [`HeadlessError::Render`] with the reason of [`Renderer::upload`]; the model before stays.
    pub fn upload(&mut self, model: &Model) -> Result<(), HeadlessError> {
        self.upload_with(model, SceneSettings::default())
    }

    /// As [`upload`](Self::upload), with settings that hold as long as the model.
    ///
    /// # Errors
    /// As [`upload`](Self::upload).
    pub fn upload_with(&mut self, model: &Model, settings: SceneSettings) -> Result<(), HeadlessError> {
        self.upload_shared(Arc::new(model.clone()), settings, &|_| ())
    }

    /// As [`upload_with`](Self::upload_with), of a model that is not copied; `progress` as in
    /// [`Renderer::upload_with_progress`].
    ///
    /// # Errors
    /// As [`upload`](Self::upload).
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
    /// As [`upload`](Self::upload).
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
        mut request: SceneRequest,
        progress: &(dyn Fn(usize) + Sync),
    ) -> Result<(), HeadlessError> {
        let mut formats = self.formats;
        if let Some(outputs) = self.expected {
            request.settings.thickness |= outputs.thickness;
            formats = self.formats_with(outputs, request.settings.thickness);
        }
        if formats == self.formats {
            self.renderer.upload_request(model, request, progress)?;
        } else {
            self.device.device().alive()?;
            self.land()?;
            self.renew(formats, |_, renderer| renderer.upload_request(model, request, progress))?;
        }
        self.expected = None;
        Ok(())
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

    /// Adds a model to the scene: see [`Renderer::add`].
    ///
    /// # Errors
    /// [`HeadlessError::Render`] with the reason of [`Renderer::add`]; the scene is as it was.
    ///
    /// # Panics
    /// When no model was uploaded.
    pub fn add(&mut self, model: &Model) -> Result<ModelId, HeadlessError> {
        Ok(self.renderer.add(model)?)
    }

    /// Removes a model that was added: see [`Renderer::remove`].
    ///
    /// # Errors
    /// [`RemoveError`]; the scene is as it was.
    pub fn remove(&mut self, id: ModelId) -> Result<(), RemoveError> {
        self.renderer.remove(id)
    }

    /// Where the instances of an added model are: see [`Renderer::instances_of`].
    ///
    /// # Errors
    /// [`RemoveError`].
    pub fn instances_of(&self, id: ModelId) -> Result<Range<usize>, RemoveError> {
        self.renderer.instances_of(id)
    }

    /// Lets the next picture read back what it shows at a pixel: see [`Renderer::pick`].
    pub fn pick(&mut self, x: u32, y: u32) {
        self.renderer.pick(x, y);
    }

    /// What the last picture shows there: see [`Renderer::picked`].
    pub fn picked(&self) -> Option<Hit> {
        self.renderer.picked(0)
    }

    /// Renders one picture of the camera's size and waits for it. `outputs` names the images beside the colour. A
    /// choice with other groups among them (points, numbers, thickness) than the picture before has the model uploaded
    /// anew.
    ///
    /// # Errors
    /// [`HeadlessError::Render`] where the camera, the settings or the device's limits exclude the picture;
    /// [`HeadlessError::NeverComplete`]; [`HeadlessError::Gpu`].
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
        self.prepare(outputs)?;
        let view = View { camera, settings, outputs };
        self.start(0, view)?;
        let stats = self.finish(0, view)?;
        Ok(self.view(0, outputs, stats).to_picture())
    }

    /// Lets `watch` be called between two frames of a picture that needs several, and between two faces of a model that
    /// a picture prepares anew. To end the picture, or the sequence of pictures, it unwinds, as by a panic; the renderer
    /// is as it was before, and draws the next one. Frames that the device has begun are drawn to their ends.
    pub fn set_watch(&mut self, watch: Option<Watch>) {
        self.watch = watch;
    }

    /// Between two steps.
    pub(super) fn pause(&self) {
        if let Some(watch) = &self.watch {
            watch();
        }
    }

    /// The model that was uploaded, as edits have made it: see [`Renderer::model`].
    pub fn model(&self) -> Option<&Arc<Model>> {
        self.renderer.model()
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
    pub fn shutdown(self) -> Vec<String> {
        self.into_device().shutdown().iter().map(ToString::to_string).collect()
    }

    /// Frees everything but the device, for another renderer [`on`](Self::on) it.
    pub fn into_device(mut self) -> HeadlessDevice {
        // SAFETY: each is taken once, and `self` is forgotten; flights wait for their frames.
        let device = unsafe {
            ManuallyDrop::drop(&mut self.flights);
            ManuallyDrop::drop(&mut self.renderer);
            ManuallyDrop::take(&mut self.device)
        };
        self.watch = None;
        std::mem::forget(self);
        device
    }

    /// The device, with what the validation layers said of it.
    pub fn device(&self) -> &HeadlessDevice {
        &self.device
    }

    /// Makes a renderer that writes these images. No frame is in flight then.
    pub(super) fn prepare(&mut self, outputs: Outputs) -> Result<(), HeadlessError> {
        self.device.device().alive()?;
        self.land()?; // frames are in flight after a panic in the middle of a sequence
        let Some(source) = self.renderer.source() else { panic!("upload a model before rendering") };
        let mut request = source.request();
        let lacks_thickness = outputs.thickness && !request.thickness;
        request.settings.thickness |= outputs.thickness;
        let formats = self.formats_with(outputs, request.thickness);
        if formats != self.formats || lacks_thickness {
            let source = source.with(request);
            self.renew(formats, |this, renderer| renderer.upload_source(source, &|_| this.pause()))?;
        }
        Ok(())
    }

    /// The formats for pictures with these images, of a scene with or without thickness. Images that one pass makes
    /// come together: another choice among them makes no other renderer.
    fn formats_with(&self, outputs: Outputs, thickness: bool) -> TargetFormats {
        let (points, numbers) = (outputs.has_points(), outputs.has_numbers());
        let outputs = Outputs {
            depth: points,
            face: points,
            uv: points,
            normal: points,
            thickness,
            edge: numbers,
            part: numbers,
            instance: numbers,
        };
        TargetFormats { outputs, ..self.formats }
    }

    /// Another renderer takes the place of this one, which shares its pipelines until then. If `upload` fails, this one
    /// stays.
    fn renew(
        &mut self,
        formats: TargetFormats,
        upload: impl FnOnce(&Self, &mut Renderer) -> Result<(), RenderError>,
    ) -> Result<(), HeadlessError> {
        self.noting(|this| {
            let mut renderer = renderer(this.device.device(), formats)?;
            upload(this, &mut renderer)?;
            if let Some((x, y)) = this.renderer.take_pick() {
                renderer.pick(x, y);
            }
            *this.renderer = renderer;
            this.formats = formats;
            Ok(())
        })
    }
}

impl Drop for HeadlessRenderer {
    fn drop(&mut self) {
        // SAFETY: dropped once, here, in the order of their dependence; flights wait for their frames.
        unsafe {
            ManuallyDrop::drop(&mut self.flights);
            ManuallyDrop::drop(&mut self.renderer);
            ManuallyDrop::drop(&mut self.device);
        }
    }
}
