//! A renderer on the host's own Vulkan device: it records into the host's command buffers, and never submits.
//!
//! ```text
//!   host's instance, device ──selvedge_host_new──▶ SelvedgeHost ◀──selvedge_host_upload── SelvedgeModel
//!       each frame, per slot:  selvedge_host_record(commands, view, targets) ─▶ the host submits, waits for its fence
//!                              selvedge_host_report(slot) ─▶ complete?
//! ```
//!
//! What changes between frames is in `scene.rs`.

use crate::border::{Failure, SelvedgeStatus, Sized, argument, border, free, given, handle, place, taken};
use crate::model::SelvedgeModel;
use crate::picture::images;
use crate::renderer::{NO_VIEW, SelvedgeView};
use crate::scene::Added;
use selvedge::ash::vk;
use selvedge::ash::vk::Handle;
use selvedge::gpu::{HostDevice, Image, RawDevice, Requirements, load_instance};
use selvedge::model::Model;
use selvedge::picture::SceneSettings;
use selvedge::renderer::{Aovs, FrameInput, Renderer, TargetFormats, Targets};
use std::ffi::{c_char, c_void};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// vkGetInstanceProcAddr.
pub type SelvedgeGetInstanceProcAddr =
    Option<unsafe extern "C" fn(instance: *mut c_void, name: *const c_char) -> Option<unsafe extern "C" fn()>>;

/// A Vulkan device of the host's. All of it outlives the SelvedgeHost.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SelvedgeVulkan {
    /// sizeof(SelvedgeVulkan)
    pub struct_size: usize,
    /// vkGetInstanceProcAddr of the loader.
    pub get_instance_proc_addr: SelvedgeGetInstanceProcAddr,
    /// VkInstance, made for Vulkan 1.3.
    pub instance: *mut c_void,
    /// VkPhysicalDevice that selvedge_vulkan_missing accepts.
    pub physical_device: *mut c_void,
    /// VkDevice with the features that selvedge_vulkan_features sets, and the extension VK_KHR_push_descriptor.
    pub device: *mut c_void,
    /// Queue family of the host's command buffers. It supports graphics and compute.
    pub queue_family: u32,
    /// Frames in flight; 0: 2.
    pub slots: u32,
    /// VkFormat of the colour target.
    pub colour_format: u32,
    /// VkFormat of a depth target of the host's, reversed: 1 near, 0 far. 0: there is none.
    pub depth_format: u32,
    /// Images beside the colour: SELVEDGE_DEPTH | SELVEDGE_NORMAL and so on. With SELVEDGE_THICKNESS rays are followed
    /// through all solids, and closed parts stay as they were uploaded.
    pub outputs: u32,
    /// Most bytes of buffers and images on the device; 0: what its heaps have left, which bounds them in any case.
    pub limit_bytes: u64,
    /// VkPipelineCache with which all pipelines are made; 0: none. It outlives the SelvedgeHost, and meanwhile the host
    /// does not merge into it.
    pub pipeline_cache: u64,
}

/// An image of the host's; 0 where there is none.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SelvedgeTarget {
    /// VkImage with one level and one layer.
    pub image: u64,
    /// VkImageView of all of it.
    pub view: u64,
}

/// The host's images of one frame, all of one size. Before and after the frame, colour images are in layout
/// COLOR_ATTACHMENT_OPTIMAL and the depth target is in DEPTH_STENCIL_ATTACHMENT_OPTIMAL. The host's barriers order its
/// earlier work before reads and writes of these attachments, and its later work after them.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SelvedgeTargets {
    /// sizeof(SelvedgeTargets)
    pub struct_size: usize,
    /// Width of the images, pixels; if width and height are 0, the images have the size of the view. Larger images get
    /// the picture in a rectangle. They need the usage TRANSFER_DST, and TRANSFER_SRC if the view has no background.
    pub width: u32,
    /// Height of the images, pixels.
    pub height: u32,
    /// Column of the images at which the picture's upper left pixel goes.
    pub x: u32,
    /// Row of the images at which the picture's upper left pixel goes.
    pub y: u32,
    /// Of the format that the host gave.
    pub colour: SelvedgeTarget,
    /// Of the depth format that the host gave.
    pub depth_buffer: SelvedgeTarget,
    /// R32_SFLOAT: distance along the view axis, infinite for background.
    pub depth: SelvedgeTarget,
    /// R32_UINT.
    pub face: SelvedgeTarget,
    /// R32G32_SFLOAT.
    pub uv: SelvedgeTarget,
    /// R32G32B32A32_SFLOAT.
    pub normal: SelvedgeTarget,
    /// R32_UINT.
    pub edge: SelvedgeTarget,
    /// R32_UINT.
    pub part: SelvedgeTarget,
    /// R32_UINT.
    pub instance: SelvedgeTarget,
    /// R32_SFLOAT. A frame may leave it out.
    pub thickness: SelvedgeTarget,
}

/// The counts of a finished frame.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct SelvedgeReport {
    /// sizeof(SelvedgeReport)
    pub struct_size: usize,
    /// 1: a frame was recorded into the slot.
    pub recorded: u32,
    /// 1: the frame is whole. 0: a list was too short, and the next frame recorded into the slot has room for all of it; or
    /// a part of a large model was copied first, and the next frames copy the rest.
    pub complete: u32,
    /// Places where the frame could not keep the promise of accuracy.
    pub clamps: u64,
}

/// A renderer on the host's device. Calls of several threads follow each other.
pub struct SelvedgeHost {
    renderer: Mutex<Renderer>,
    added: Mutex<Added>,
    formats: TargetFormats,
    slots: usize,
}

const NO_VULKAN: SelvedgeVulkan = SelvedgeVulkan {
    struct_size: 0,
    get_instance_proc_addr: None,
    instance: std::ptr::null_mut(),
    physical_device: std::ptr::null_mut(),
    device: std::ptr::null_mut(),
    queue_family: 0,
    slots: 0,
    colour_format: 0,
    depth_format: 0,
    outputs: 0,
    limit_bytes: 0,
    pipeline_cache: 0,
};

const NO_TARGET: SelvedgeTarget = SelvedgeTarget { image: 0, view: 0 };

const NO_TARGETS: SelvedgeTargets = SelvedgeTargets {
    struct_size: 0,
    width: 0,
    height: 0,
    x: 0,
    y: 0,
    colour: NO_TARGET,
    depth_buffer: NO_TARGET,
    depth: NO_TARGET,
    face: NO_TARGET,
    uv: NO_TARGET,
    normal: NO_TARGET,
    edge: NO_TARGET,
    part: NO_TARGET,
    instance: NO_TARGET,
    thickness: NO_TARGET,
};

// SAFETY: each begins with its size and consists of numbers and pointers; a null function pointer is `None`
unsafe impl Sized for SelvedgeVulkan {}
// SAFETY: as above
unsafe impl Sized for SelvedgeTargets {}
// SAFETY: as above
unsafe impl Sized for SelvedgeReport {}

pub(crate) fn render(error: impl std::fmt::Display) -> Failure {
    Failure(SelvedgeStatus::Render, error.to_string())
}

impl SelvedgeVulkan {
    /// The handles; that of the device may be null.
    fn raw(&self) -> Result<RawDevice, Failure> {
        let function = self.get_instance_proc_addr.ok_or_else(|| argument("get_instance_proc_addr is null"))?;
        if self.instance.is_null() || self.physical_device.is_null() {
            return Err(argument("the instance or the physical device is a null handle"));
        }
        Ok(RawDevice {
            get_instance_proc_addr: function as *const c_void,
            instance: self.instance as u64,
            physical: self.physical_device as u64,
            device: self.device as u64,
            queue_family: self.queue_family,
        })
    }
}

/// Checks a physical device. If it lacks something, the status is SELVEDGE_STATUS_DEVICE and selvedge_last_error lists
/// what is missing. Only the function, the instance and the physical device of `vulkan` are read.
///
/// # Safety
/// The handles are alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_vulkan_missing(vulkan: *const SelvedgeVulkan) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let missing = unsafe {
            let raw = taken(vulkan, NO_VULKAN)?.raw()?;
            let instance = load_instance(raw.get_instance_proc_addr, raw.instance);
            Requirements::missing(&instance, vk::PhysicalDevice::from_raw(raw.physical))
        };
        if missing.is_empty() {
            return Ok(());
        }
        Err(Failure(SelvedgeStatus::Device, format!("the device lacks {}", missing.join(", "))))
    })
}

/// Sets the features that the device must have, and leaves the others: VkPhysicalDeviceFeatures,
/// VkPhysicalDeviceVulkan12Features and VkPhysicalDeviceVulkan13Features, whose sType and pNext the host sets.
///
/// # Safety
/// Pointers to these structs, or null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_vulkan_features(
    core: *mut c_void,
    vulkan12: *mut c_void,
    vulkan13: *mut c_void,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises; the structs are those of Vulkan's header
        let all = unsafe {
            (
                core.cast::<vk::PhysicalDeviceFeatures>().as_mut(),
                vulkan12.cast::<vk::PhysicalDeviceVulkan12Features<'_>>().as_mut(),
                vulkan13.cast::<vk::PhysicalDeviceVulkan13Features<'_>>().as_mut(),
            )
        };
        let (Some(core), Some(vulkan12), Some(vulkan13)) = all else {
            return Err(argument("a struct of features is a null pointer"));
        };
        Requirements::add_to(core, vulkan12, vulkan13);
        Ok(())
    })
}

/// Makes a renderer on the host's device. The host keeps the device.
///
/// # Safety
/// Pointers are null or point to what they say; the handles are alive until the SelvedgeHost is freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_host_new(
    vulkan: *const SelvedgeVulkan,
    host: *mut *mut SelvedgeHost,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let (place, vulkan) = unsafe { (place(host)?, taken(vulkan, NO_VULKAN)?) };
        let raw = vulkan.raw()?;
        if vulkan.device.is_null() {
            return Err(argument("the device is a null handle"));
        }
        // SAFETY: as the caller promises
        let lent = unsafe { HostDevice::from_raw(raw) };
        let lent = HostDevice {
            pipeline_cache: vk::PipelineCache::from_raw(vulkan.pipeline_cache),
            memory_budget: (vulkan.limit_bytes != 0).then_some(vulkan.limit_bytes),
            ..lent
        };
        // SAFETY: as the caller promises
        let families = unsafe { lent.instance.get_physical_device_queue_family_properties(lent.physical) };
        let family = families.get(vulkan.queue_family as usize);
        if !family.is_some_and(|f| f.queue_flags.contains(Requirements::QUEUE_FLAGS)) {
            return Err(argument(format!("queue family {} is not one for graphics and compute", vulkan.queue_family)));
        }
        let outputs = selvedge_jobs::Image::outputs(images(vulkan.outputs)?);
        let format = |number: u32| vk::Format::from_raw(number as i32);
        let depth = (vulkan.depth_format != 0).then(|| format(vulkan.depth_format));
        if vulkan.colour_format == 0 {
            return Err(argument("colour_format is VK_FORMAT_UNDEFINED"));
        }
        let formats = TargetFormats { colour: format(vulkan.colour_format), depth, outputs };
        let slots = if vulkan.slots == 0 { 2 } else { vulkan.slots as usize };
        // SAFETY: as the caller promises
        let renderer = unsafe { Renderer::new(lent, formats, slots) }.map_err(render)?;
        let (renderer, added) = (Mutex::new(renderer), Mutex::default());
        *place = Box::into_raw(Box::new(SelvedgeHost { renderer, added, formats, slots }));
        Ok(())
    })
}

impl SelvedgeHost {
    pub(crate) fn renderer(&self) -> MutexGuard<'_, Renderer> {
        self.renderer.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn added(&self) -> MutexGuard<'_, Added> {
        self.added.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn slot(&self, slot: u32) -> Result<usize, Failure> {
        let all = self.slots;
        usize::try_from(slot).ok().filter(|slot| *slot < all).ok_or_else(|| argument(format!("slot {slot} of {all}")))
    }

    /// All models of the scene, as changes have made them.
    pub(crate) fn model(&self) -> Result<Arc<Model>, Failure> {
        self.renderer().model().cloned().ok_or_else(|| argument("no model was uploaded"))
    }
}

/// Uploads the model that later frames show. Only samples, edges, line_width, ambient and sun of `view` are read,
/// whether its style shows curvature, and with edges its height: line_width counts pixels of a picture so high. The call
/// does not wait for the GPU: objects that frames in flight use are freed with their slots.
///
/// # Safety
/// Pointers are null or point to what they say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_host_upload(
    host: *const SelvedgeHost,
    model: *const SelvedgeModel,
    view: *const SelvedgeView,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let (host, model, view) = unsafe { (handle("host", host)?, handle("model", model)?, taken(view, NO_VIEW)?) };
        // SAFETY: as the caller promises
        let scene = unsafe { view.scene(host.formats.outputs.edge, &model.loaded.model) }?;
        let scene = SceneSettings { thickness: host.formats.outputs.thickness, ..scene };
        host.renderer().upload_shared(Arc::clone(&model.loaded.model), scene, &|_| ()).map_err(render)?;
        host.added().clear();
        Ok(())
    })
}

/// Records a frame into a VkCommandBuffer of the host's. Only size, camera, style, curvature_range (which a host sets:
/// where it is 0, the whole model is sampled), background and tolerance of `view` are read. With a null background the
/// host's picture stays where no model is drawn. A standard view shows all of the scene as it is then. The frame that was
/// recorded into the slot before has finished.
///
/// # Safety
/// Pointers are null or point to what they say. `commands` is recording, outside rendering, on the host's queue family,
/// and is submitted once. Frames are submitted in the order in which they are recorded. After SELVEDGE_STATUS_RENDER
/// the host resets `commands`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_host_record(
    host: *const SelvedgeHost,
    commands: *mut c_void,
    slot: u32,
    view: *const SelvedgeView,
    targets: *const SelvedgeTargets,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let (host, view, targets) =
            unsafe { (handle("host", host)?, taken(view, NO_VIEW)?, taken(targets, NO_TARGETS)?) };
        if commands.is_null() {
            return Err(argument("the command buffer is a null handle"));
        }
        let (slot, model) = (host.slot(slot)?, host.model()?);
        // SAFETY: as the caller promises
        let (camera, settings) = unsafe { (view.camera_of(&model)?, view.host_frame(&model)?) };
        let whole = camera.size;
        let size = if (targets.width, targets.height) == (0, 0) { whole } else { (targets.width, targets.height) };
        let corner = (size != whole || (targets.x, targets.y) != (0, 0)).then_some((targets.x, targets.y));
        let formats = host.formats;
        let outputs = formats.outputs;
        let [of_depth, of_face, of_uv, of_normal] = Renderer::AOV_FORMATS;
        let number = Renderer::NUMBER_FORMAT;
        let image = |name: &str, target: SelvedgeTarget, format: Option<vk::Format>| match (target.image, format) {
            (0, None) => Ok(None),
            (0, Some(_)) => Err(argument(format!("the frame lacks its image of {name}"))),
            (_, None) => Err(argument(format!("the host was made without an image of {name}"))),
            (_, Some(_)) if target.view == 0 => Err(argument(format!("the image of {name} has no view"))),
            (image, Some(format)) => {
                let (image, view) = (vk::Image::from_raw(image), vk::ImageView::from_raw(target.view));
                // SAFETY: as the caller promises
                Ok(Some(unsafe { Image::borrowed(name, image, view, size, format) }))
            }
        };
        let colour = image("colour", targets.colour, Some(formats.colour))?;
        let buffer = image("the depth buffer", targets.depth_buffer, formats.depth)?;
        let depth = image("depth", targets.depth, outputs.depth.then_some(of_depth))?;
        let face = image("face", targets.face, outputs.face.then_some(of_face))?;
        let uv = image("uv", targets.uv, outputs.uv.then_some(of_uv))?;
        let normal = image("normal", targets.normal, outputs.normal.then_some(of_normal))?;
        let edge = image("edge", targets.edge, outputs.edge.then_some(number))?;
        let part = image("part", targets.part, outputs.part.then_some(number))?;
        let instance = image("instance", targets.instance, outputs.instance.then_some(number))?;
        let wanted = outputs.thickness && targets.thickness.image != 0; // a frame may leave it out
        let thickness = image("thickness", targets.thickness, wanted.then_some(Renderer::THICKNESS_FORMAT))?;
        let Some(colour) = &colour else { return Err(argument("the frame lacks its image of colour")) };
        let aovs = Aovs {
            depth: depth.as_ref(),
            face: face.as_ref(),
            uv: uv.as_ref(),
            normal: normal.as_ref(),
            edge: edge.as_ref(),
            part: part.as_ref(),
            instance: instance.as_ref(),
        };
        let targets = Targets { colour, depth: buffer.as_ref(), aovs, thickness: thickness.as_ref(), corner };
        let input = FrameInput { camera: &camera, settings, slot, targets };
        let commands = vk::CommandBuffer::from_raw(commands as u64);
        // SAFETY: as the caller promises
        unsafe { host.renderer().record(commands, &input) }.map_err(render)
    })
}

/// Fills `report`, whose struct_size is set, with the counts of the frame that was recorded last into the slot. That
/// frame has finished.
///
/// # Safety
/// Pointers are null or point to what they say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_host_report(
    host: *const SelvedgeHost,
    slot: u32,
    report: *mut SelvedgeReport,
) -> SelvedgeStatus {
    border(|| {
        // SAFETY: as the caller promises
        let host = unsafe { handle("host", host) }?;
        let found = host.renderer().report(host.slot(slot)?).map_err(render)?;
        let value = SelvedgeReport {
            struct_size: 0,
            recorded: found.is_some().into(),
            complete: found.as_ref().is_some_and(|found| found.complete).into(),
            clamps: found.map_or(0, |found| found.stats.clamps),
        };
        // SAFETY: as the caller promises
        unsafe { given(report, value) }
    })
}

/// Frees the renderer, and leaves the host's device as it is; null is allowed. The GPU has finished all frames.
///
/// # Safety
/// This library made it, and no other call uses it at the same time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn selvedge_host_free(host: *mut SelvedgeHost) {
    // SAFETY: as the caller promises
    unsafe { free(host) }
}
