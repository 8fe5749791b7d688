//! The window's device and everything that draws on it, one frame at a time.
//!
//! ```text
//!   begin ─▶ engine's picture, if one is due ─▶ composite ─▶ panels ─▶ present      a thread waits for the fence
//!                                   └─▶ pixels under the cursor ─▶ PickBuffer
//! ```

use super::composite::{Composite, ViewRect};
use super::context::{Context, DeviceOptions};
use super::swapchain::{self, Presented, Swapchain};
use super::targets::{Area, FORMATS, PickBuffer, Targets, barrier, record_barriers};
use super::{Failure, Fault, ViewError};
use crate::pick::{Mark, Samples};
use ash::vk;
use egui_ash_renderer::{DynamicRendering, Options, Renderer as PanelRenderer};
use selvedge::ash;
use selvedge::model::Camera;
use selvedge::picture::FrameSettings;
use selvedge::renderer::{FrameInput, RenderError, Renderer};
use std::sync::Arc;
use winit::window::Window;

/// The content of a frame.
pub struct Frame<'a> {
    /// Where the picture is in the window.
    pub view: ViewRect,
    /// The pixel of the picture whose surroundings are read.
    pub pick: Option<(u32, u32)>,
    /// Marks of the hovered and of the selected items.
    pub marks: (Option<Mark>, &'a [Mark]),
    /// Shapes of the panels, and pixels a point.
    pub panels: (&'a [egui::ClippedPrimitive], f32),
    /// Colour where there is no picture, linear.
    pub background: [f32; 4],
    /// A failure to imitate.
    pub fault: Option<Fault>,
}

/// The engine's next picture.
pub struct Picture<'a> {
    pub renderer: &'a mut Renderer,
    /// Its size is that of the picture.
    pub camera: &'a Camera,
    pub settings: FrameSettings,
}

/// Vulkan of one window.
pub struct Screen {
    pub context: Context,
    swapchain: Option<Swapchain>,
    composite: Composite,
    panels: PanelRenderer,
    /// By size: the still picture's and the moving one's.
    targets: Vec<Targets>,
    /// Which of them is shown.
    shown: Option<usize>,
    pick: PickBuffer,
    picked: Option<Area>,
    /// Made anew before the next frame.
    outdated: bool,
}

/// Most sizes of pictures that are kept.
const MOST_TARGETS: usize = 3;

/// What draws on the context's device. If a part fails, those before it are destroyed.
fn parts(context: &Context) -> Result<(Composite, PanelRenderer, PickBuffer), ViewError> {
    let format = swapchain::format(context)?.format;
    let composite = Composite::new(context, format)?;
    let others = || {
        let panels = PanelRenderer::with_gpu_allocator(
            Arc::clone(context.allocator()),
            context.device.clone(),
            DynamicRendering { color_attachment_format: format, depth_attachment_format: None },
            Options { srgb_framebuffer: true, ..Options::default() },
        )?;
        Ok::<_, ViewError>((panels, PickBuffer::new(context)?))
    };
    match others() {
        Ok((panels, pick)) => Ok((composite, panels, pick)),
        Err(error) => {
            composite.destroy(context);
            Err(error)
        }
    }
}

impl Screen {
    pub fn new(window: &Window, options: &DeviceOptions) -> Result<Self, ViewError> {
        let context = Context::new(window, options)?;
        let (composite, panels, pick) = match parts(&context) {
            Ok(parts) => parts,
            Err(error) => {
                context.shutdown();
                return Err(error);
            }
        };
        Ok(Self {
            context,
            swapchain: None,
            composite,
            panels,
            targets: Vec::new(),
            shown: None,
            pick,
            picked: None,
            outdated: true,
        })
    }

    /// A renderer on this device.
    pub fn renderer(&self) -> Result<Renderer, ViewError> {
        // SAFETY: the device meets the requirements; `App` drops the renderer before the screen.
        Ok(unsafe { Renderer::new(self.context.lend(), FORMATS, 1) }?)
    }

    /// The window has another size.
    pub fn resized(&mut self) {
        self.outdated = true;
    }

    /// The next image of the window; `None` while it has no size.
    fn acquire(&mut self, window: &Window) -> Result<Option<u32>, ViewError> {
        for _ in 0..4 {
            if self.outdated {
                self.context.wait();
                let size = window.inner_size();
                let old = self.swapchain.take();
                if size.width == 0 || size.height == 0 {
                    if let Some(old) = old {
                        old.destroy(&self.context);
                    }
                    return Ok(None);
                }
                match Swapchain::new(&self.context, (size.width, size.height), old) {
                    Ok(made) => (self.swapchain, self.outdated) = (made, false),
                    // the surface may be lost at any of these calls, too
                    Err(ViewError::Vulkan(error)) => {
                        self.lost(window, Presented::of(Err(error))?)?;
                        continue;
                    }
                    Err(error) => return Err(error),
                }
            }
            let Some(swapchain) = &self.swapchain else {
                self.outdated = true;
                return Ok(None);
            };
            // SAFETY: nothing waits for the semaphore: one frame is in flight, and it has finished.
            let next = unsafe {
                let fence = vk::Fence::null();
                self.context.swapchains.acquire_next_image(swapchain.handle, u64::MAX, self.context.acquired, fence)
            };
            match next {
                // an image that is only outdated is shown all the same: its semaphore is signalled
                Ok((image, outdated)) => {
                    self.outdated = outdated;
                    return Ok(Some(image));
                }
                Err(error) => self.lost(window, Presented::of(Err(error))?)?,
            }
        }
        Ok(None)
    }

    fn lost(&mut self, window: &Window, what: Presented) -> Result<(), ViewError> {
        self.outdated |= what != Presented::Shown;
        if what == Presented::SurfaceLost {
            tracing::warn!("the surface is lost, and made again");
            self.suspend();
            self.context.make_surface(window)?;
        }
        Ok(())
    }

    /// Frees the swapchain and the surface once the frame in flight is presented. All else stays.
    pub fn suspend(&mut self) {
        self.context.wait();
        if let Some(old) = self.swapchain.take() {
            old.destroy(&self.context);
        }
        self.context.drop_surface();
        self.outdated = true;
    }

    /// There is no surface: nothing may be drawn.
    pub fn is_suspended(&self) -> bool {
        self.context.surface == vk::SurfaceKHR::null()
    }

    /// Makes the surface again; the next frame makes a swapchain.
    pub fn resume(&mut self, window: &Window) -> Result<(), ViewError> {
        self.context.make_surface(window)
    }

    /// Textures of the panels that have changed, before the frame that shows them.
    pub fn set_textures(&mut self, delta: &egui::TexturesDelta) -> Result<(), ViewError> {
        Ok(self.panels.set_textures(self.context.queue, self.context.pool, &delta.set)?)
    }

    /// Frees textures that no later frame shows; the frame before has finished.
    pub fn free_textures(&mut self, ids: &[egui::TextureId]) -> Result<(), ViewError> {
        Ok(self.panels.free_textures(ids)?)
    }

    /// Records and submits a frame; the frame before has finished. False while the window has no size: nothing is drawn.
    ///
    /// # Errors
    /// [`Failure::Picture`] when the engine could not record its picture, or there is no memory for it: the frame is shown
    /// with the picture before.
    pub fn draw(&mut self, window: &Window, picture: Option<Picture<'_>>, frame: &Frame<'_>) -> Result<bool, Failure> {
        let is_full = frame.fault == Some(Fault::Vulkan(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY));
        if let Some(Fault::Vulkan(fault)) = frame.fault.filter(|_| !is_full) {
            self.lost(window, Presented::of(Err(fault))?)?;
        }
        let Some(image) = self.acquire(window)? else { return Ok(false) };
        self.composite.mark(frame.marks.0, frame.marks.1);
        let mut failed = None;
        self.begin()?;
        if let Some(picture) = picture {
            let full = || ViewError::Memory("imitated".to_owned());
            let target = if is_full { Err(full()) } else { self.target(picture.camera.size) };
            let drawn = target.and_then(|target| {
                self.record_into(picture, &self.targets[target])?;
                Ok(target)
            });
            match drawn {
                Ok(target) => self.shown = Some(target),
                Err(error) => {
                    // the recorded commands are discarded
                    self.begin()?;
                    failed = Some(error);
                }
            }
        }
        self.record_window(image, frame)?;
        // by this call Wayland delays the next frame until the window can show it
        window.pre_present_notify();
        let presented = self.submit(image)?;
        self.lost(window, presented)?;
        failed.map_or(Ok(true), |error| Err(Failure::Picture(error)))
    }

    pub(super) fn begin(&self) -> Result<(), ViewError> {
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        let Context { device, cmd, .. } = &self.context;
        // SAFETY: the command buffer is not in use. It may be recording, where a picture failed: it is reset.
        unsafe {
            device.reset_command_buffer(*cmd, vk::CommandBufferResetFlags::empty())?;
            Ok(device.begin_command_buffer(*cmd, &begin)?)
        }
    }

    /// The number of the targets of this size.
    fn target(&mut self, size: (u32, u32)) -> Result<usize, ViewError> {
        if let Some(found) = self.targets.iter().position(|t| t.size() == size) {
            return Ok(found);
        }
        if self.targets.len() == MOST_TARGETS {
            // nothing is in flight: the oldest one that is not shown is freed
            let oldest = usize::from(self.shown == Some(0));
            self.targets.remove(oldest).destroy(&self.context);
            self.shown = self.shown.map(|shown| if shown > oldest { shown - 1 } else { shown });
        }
        self.targets.push(Targets::new(&self.context, size)?);
        Ok(self.targets.len() - 1)
    }

    /// Records the engine's picture into images of its size.
    pub(super) fn record_into(&self, picture: Picture<'_>, targets: &Targets) -> Result<(), RenderError> {
        targets.begin(&self.context);
        let Picture { renderer, camera, settings } = picture;
        let input = FrameInput { camera, settings, slot: 0, targets: targets.engine() };
        // SAFETY: recording; the slot's frame before has finished, and frames are submitted in order.
        unsafe { renderer.record(self.context.cmd, &input) }?;
        targets.end(&self.context);
        Ok(())
    }

    fn record_window(&mut self, image: u32, frame: &Frame<'_>) -> Result<(), ViewError> {
        let Self { context, swapchain, composite, panels, targets, pick, .. } = self;
        let Some(swapchain) = swapchain else { return Ok(()) };
        let (image, view) = swapchain.images[image as usize];
        let extent = vk::Extent2D { width: swapchain.size.0, height: swapchain.size.1 };
        let shown = self.shown.map(|shown| &targets[shown]);
        self.picked = None;
        if let (Some(targets), Some(at)) = (shown, frame.pick) {
            let size = targets.size();
            let area = Area::around((at.0.min(size.0 - 1), at.1.min(size.1 - 1)), size);
            targets.copy(context, pick, area);
            self.picked = Some(area);
        }
        let attachment = (
            vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT,
            vk::AccessFlags2::COLOR_ATTACHMENT_READ | vk::AccessFlags2::COLOR_ATTACHMENT_WRITE,
            vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
        );
        let acquired = (attachment.0, vk::AccessFlags2::NONE, vk::ImageLayout::UNDEFINED);
        let presented = (vk::PipelineStageFlags2::NONE, vk::AccessFlags2::NONE, vk::ImageLayout::PRESENT_SRC_KHR);
        record_barriers(context, &[barrier(image, acquired, attachment)]);
        let clear = vk::ClearValue { color: vk::ClearColorValue { float32: frame.background } };
        let colour = [vk::RenderingAttachmentInfo::default()
            .image_view(view)
            .image_layout(attachment.2)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::STORE)
            .clear_value(clear)];
        let area = vk::Rect2D { extent, ..Default::default() };
        let info = vk::RenderingInfo::default().render_area(area).layer_count(1).color_attachments(&colour);
        let within = frame.view.width > 0
            && frame.view.height > 0
            && frame.view.x + frame.view.width <= extent.width
            && frame.view.y + frame.view.height <= extent.height;
        // SAFETY: recording; the image is in the layout of an attachment.
        unsafe { context.device.cmd_begin_rendering(context.cmd, &info) };
        if let Some(targets) = shown.filter(|_| within) {
            composite.record(context, targets, frame.view);
        }
        let drawn = panels.cmd_draw(context.cmd, extent, frame.panels.1, frame.panels.0);
        // SAFETY: begun above.
        unsafe { context.device.cmd_end_rendering(context.cmd) };
        record_barriers(context, &[barrier(image, attachment, presented)]);
        Ok(drawn?)
    }

    /// Submits the recorded commands, without a window, and waits.
    pub(super) fn submit_and_wait(&self) -> Result<(), ViewError> {
        let Context { device, queue, cmd, fence, .. } = &self.context;
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(*cmd)];
        let submit = vk::SubmitInfo2::default().command_buffer_infos(&commands);
        // SAFETY: the command buffer is recording, the fence not in use.
        unsafe {
            device.end_command_buffer(*cmd)?;
            device.reset_fences(&[*fence])?;
            device.queue_submit2(*queue, &[submit], *fence)?;
            Ok(device.wait_for_fences(&[*fence], true, u64::MAX)?)
        }
    }

    fn submit(&self, image: u32) -> Result<Presented, ViewError> {
        let Some(swapchain) = &self.swapchain else { return Ok(Presented::Outdated) };
        let Context { device, queue, cmd, fence, acquired, .. } = &self.context;
        let stage = vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT;
        let drawn = [swapchain.drawn[image as usize]];
        let wait = [vk::SemaphoreSubmitInfo::default().semaphore(*acquired).stage_mask(stage)];
        let signal =
            [vk::SemaphoreSubmitInfo::default().semaphore(drawn[0]).stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)];
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(*cmd)];
        let submit = vk::SubmitInfo2::default()
            .wait_semaphore_infos(&wait)
            .signal_semaphore_infos(&signal)
            .command_buffer_infos(&commands);
        let (chains, images) = ([swapchain.handle], [image]);
        let present = vk::PresentInfoKHR::default().wait_semaphores(&drawn).swapchains(&chains).image_indices(&images);
        // SAFETY: the command buffer is recording, the fence not in use.
        unsafe {
            device.end_command_buffer(*cmd)?;
            device.reset_fences(&[*fence])?;
            device.queue_submit2(*queue, &[submit], *fence)?;
            Presented::of(self.context.swapchains.queue_present(*queue, &present))
        }
    }

    /// The pixels around the cursor, copied by the frame that has finished.
    pub fn picked(&self) -> Option<Samples> {
        self.picked.map(|area| self.pick.samples(area))
    }

    /// The size of the picture that is shown.
    pub fn shown(&self) -> Option<(u32, u32)> {
        self.shown.map(|shown| self.targets[shown].size())
    }

    /// No picture is shown any more.
    pub fn blank(&mut self) {
        self.shown = None;
    }

    /// Frees everything; returns all messages of the validation layer. The engine's renderer was freed before.
    pub fn shutdown(self) -> Vec<String> {
        let Self { context, swapchain, composite, panels, targets, pick, .. } = self;
        context.wait();
        drop(panels);
        composite.destroy(&context);
        pick.destroy(&context);
        targets.into_iter().for_each(|t| t.destroy(&context));
        if let Some(swapchain) = swapchain {
            swapchain.destroy(&context);
        }
        context.shutdown()
    }
}
