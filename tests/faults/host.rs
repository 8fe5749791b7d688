//! A host that loses its device or does not submit a frame, and reports this to the renderer.

use crate::driver::Driver;
use crate::shapes;
use ash::vk;
use ash::vk::Handle;
use glam::DVec3;
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use selvedge::gpu::{Device, GpuAllocator, HostDevice, Image, ImageInfo, Pool, RawDevice, Requirements};
use selvedge::model::Camera;
use selvedge::picture::FrameSettings;
use selvedge::renderer::{FrameInput, RenderError, Renderer, TargetFormats, Targets};
use std::ffi::c_void;
use std::sync::{Arc, Mutex};

const SIZE: (u32, u32) = (48, 32);
const FORMAT: vk::Format = vk::Format::R8G8B8A8_UNORM;

struct Host {
    instance: ash::Instance,
    physical: vk::PhysicalDevice,
    device: ash::Device,
    allocator: Arc<Mutex<Allocator>>,
    entry: ash::Entry,
}

impl Host {
    fn new(driver: &Driver) -> Self {
        let entry = driver.entry();
        // SAFETY: plain Vulkan in its usual order; every struct outlives the call that it is given to.
        unsafe {
            let app = vk::ApplicationInfo::default().api_version(Requirements::API_VERSION);
            let create = vk::InstanceCreateInfo::default().application_info(&app);
            let instance = entry.create_instance(&create, None).unwrap();
            let physical = instance.enumerate_physical_devices().unwrap()[0];
            let device = instance.create_device(physical, &vk::DeviceCreateInfo::default(), None).unwrap();
            let description = AllocatorCreateDesc {
                instance: instance.clone(),
                device: device.clone(),
                physical_device: physical,
                debug_settings: Default::default(),
                buffer_device_address: false,
                allocation_sizes: Default::default(),
            };
            let allocator = Arc::new(Mutex::new(Allocator::new(&description).unwrap()));
            Self { instance, physical, device, allocator, entry }
        }
    }

    fn lend(&self) -> HostDevice {
        HostDevice {
            instance: self.instance.clone(),
            physical: self.physical,
            device: self.device.clone(),
            queue_family: 0,
            allocator: Arc::new(GpuAllocator::new(Arc::clone(&self.allocator))),
            debug_names: false,
            pipeline_statistics: false,
            pipeline_cache: vk::PipelineCache::null(),
            memory_budget: None,
        }
    }
}

impl Host {
    fn raw(&self) -> RawDevice {
        RawDevice {
            get_instance_proc_addr: self.entry.static_fn().get_instance_proc_addr as *const c_void,
            instance: self.instance.handle().as_raw(),
            physical: self.physical.as_raw(),
            device: self.device.handle().as_raw(),
            queue_family: 0,
        }
    }
}

/// The renderer, a target on the host's device, and a camera.
fn drawn(host: &Host) -> (Renderer, Image, Camera) {
    drawn_by(host, 2)
}

fn drawn_by(host: &Host, slots: usize) -> (Renderer, Image, Camera) {
    let model = shapes::cube();
    let camera = Camera::around(model.control_bounds(), DVec3::new(1.0, -1.6, 1.1), DVec3::Z, 0.6, SIZE);
    // SAFETY: the host outlives both.
    let (mut renderer, device) =
        unsafe { (Renderer::new(host.lend(), TargetFormats::new(FORMAT), slots).unwrap(), Device::new(host.lend())) };
    let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT;
    let target =
        Image::new(&device, &ImageInfo { name: "target", size: SIZE, format: FORMAT, usage, pool: Pool::Transient });
    renderer.upload(&model).unwrap();
    (renderer, target.unwrap(), camera)
}

fn record(renderer: &mut Renderer, target: &Image, camera: &Camera, slot: usize) -> Result<(), RenderError> {
    let input = FrameInput { camera, settings: FrameSettings::default(), slot, targets: Targets::new(target) };
    // SAFETY: the null driver looks at no command buffer.
    unsafe { renderer.record(vk::CommandBuffer::null(), &input) }
}

/// After `device_lost` the renderer makes only calls that free, and frees all handles. After `abandon`, when the
/// device's handle is gone, it leaves handles alone.
#[test]
fn a_device_that_the_host_lost_is_not_touched() {
    for is_gone in [false, true] {
        let driver = Driver::new(true);
        let host = Host::new(&driver);
        let (mut renderer, target, camera) = drawn(&host);
        for slot in [0, 1] {
            record(&mut renderer, &target, &camera, slot).unwrap();
        }
        drop(target);
        // the allocator of the test's host frees its memory itself
        let handles = || driver.living().into_iter().filter(|kind| !["-", "vkFreeMemory"].contains(kind)).count();
        let before = handles();
        driver.plan(None);
        if is_gone {
            renderer.abandon()
        } else {
            renderer.device_lost()
        }
        for error in
            [renderer.report(0).unwrap_err().to_string(), renderer.upload(&shapes::plate()).unwrap_err().to_string()]
        {
            assert!(error.starts_with("a call of the host failed for `device`: the device is lost"), "{error}");
        }
        assert!(renderer.picked(0).is_none() && renderer.prepare(&camera).is_err());
        drop(renderer);
        assert_eq!(driver.count(), 0, "no call but those that free");
        assert_eq!(handles(), if is_gone { before } else { 0 }, "of {before} handles");
    }
}

/// The engine's own allocator frees its memory with the renderer, and leaves it when the device's handle is gone.
#[test]
fn an_allocator_of_the_engine_s_own_goes_with_the_renderer() {
    for is_gone in [false, true] {
        let driver = Driver::new(true);
        let host = Host::new(&driver);
        // SAFETY: the host outlives the renderer.
        let renderer = unsafe { Renderer::new(HostDevice::from_raw(host.raw()), TargetFormats::new(FORMAT), 2) };
        let mut renderer = renderer.unwrap();
        renderer.upload(&shapes::cube()).unwrap();
        let memory = || driver.living().into_iter().filter(|kind| *kind == "vkFreeMemory").count();
        let before = memory();
        assert!(before > 0);
        if is_gone {
            renderer.abandon()
        } else {
            renderer.device_lost()
        }
        drop(renderer);
        assert_eq!(memory(), if is_gone { before } else { 0 }, "of {before}");
    }
}

/// A frame that was not submitted has copied nothing, so the next frame copies the scene again. The test counts the
/// buffers that each frame creates.
#[test]
fn a_discarded_frame_is_uploaded_again() {
    let driver = Driver::new(true);
    let host = Host::new(&driver);
    let (mut renderer, target, camera) = drawn(&host);
    let made = |renderer: &mut Renderer, slot| {
        driver.plan(None);
        record(renderer, &target, &camera, slot).unwrap();
        driver.calls().get("vkCreateBuffer").copied().unwrap_or_default()
    };
    let first = made(&mut renderer, 0);
    let second = made(&mut renderer, 1);
    assert!(second < first / 2, "the scene is there: {second} buffers after {first}");
    renderer.discard(1);
    assert!(renderer.report(1).unwrap().is_none());
    let third = made(&mut renderer, 1);
    assert!(third > first / 2, "the scene is made again: {third} buffers after {first}");
    let fourth = made(&mut renderer, 0);
    assert!(fourth < first / 2, "once: {fourth} buffers");
}

/// Of three frames in flight two are discarded. The first may still use what they replaced, so nothing of it is freed.
#[test]
fn what_frames_in_flight_use_outlives_discarded_frames() {
    for order in [[1, 2], [2, 1]] {
        let driver = Driver::new(true);
        let host = Host::new(&driver);
        let (mut renderer, target, camera) = drawn_by(&host, 3);
        for slot in 0..3 {
            record(&mut renderer, &target, &camera, slot).unwrap();
        }
        let handles = |driver: &Driver| driver.living().len();
        let before = handles(&driver);
        order.into_iter().for_each(|slot| renderer.discard(slot));
        // another model takes the place of the first
        renderer.upload(&shapes::cube()).unwrap();
        assert!(handles(&driver) >= before, "{order:?}: {} of {before} handles", handles(&driver));
        // once the first frame has finished, the next frame in its slot frees what it used
        let kept = handles(&driver);
        record(&mut renderer, &target, &camera, 0).unwrap();
        assert!(handles(&driver) < kept, "{order:?}: what the first frame used stays");
    }
}
