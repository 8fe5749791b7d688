//! A watched device, and the way to and from it.

use bytemuck::Pod;
use selvedge::gpu::{Access, Buffer, Commands, Pool, ReadBack, Uploads, barrier};
use selvedge::headless::{HeadlessDevice, HeadlessOptions};

/// A device under validation and synchronisation validation.
pub fn watched() -> HeadlessDevice {
    let options = HeadlessOptions { validation: true, ..Default::default() };
    HeadlessDevice::new(&options).unwrap_or_else(|error| panic!("these tests need Vulkan: {error}"))
}

/// Shuts the device down; fails the test if the layers reported anything.
pub fn assert_silent(device: HeadlessDevice) {
    let messages = device.shutdown();
    let texts: Vec<_> = messages.iter().map(ToString::to_string).collect();
    assert!(texts.is_empty(), "validation messages:\n{}", texts.join("\n"));
}

/// A storage buffer of `data`, ready for every stage.
pub fn upload<T: Pod>(device: &HeadlessDevice, name: &str, data: &[T]) -> Buffer {
    let record = |cmd: &Commands<'_>| {
        let mut uploads = Uploads::new();
        let buffer = uploads.buffer(cmd.device(), Pool::Transient, name, Buffer::INDIRECT, data).unwrap();
        let staging = uploads.record(cmd, name, u64::MAX).unwrap();
        staging.finish(cmd, Access::COMPUTE_READ);
        (buffer, staging)
    };
    device.submit(record).unwrap().0
}

/// The first `count` values of a buffer that compute shaders wrote.
pub fn read<T: Pod>(device: &HeadlessDevice, buffer: &Buffer, count: usize) -> Vec<T> {
    let bytes = (count * size_of::<T>()) as u64;
    let read_back = ReadBack::new(device.device(), "read back", bytes).unwrap();
    let record = |cmd: &Commands<'_>| {
        barrier::buffers(cmd, &[(buffer, Access::COMPUTE_WRITE, Access::TRANSFER_READ)]);
        read_back.record(cmd, buffer, bytes);
    };
    device.submit(record).unwrap();
    read_back.values(count)
}
