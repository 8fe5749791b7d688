//! A thread that waits for frames, so that the window does not.

use selvedge::ash::{self, vk};
use std::sync::mpsc::{self, Sender};
use std::thread::{self, JoinHandle};

/// Waits for one fence after another.
pub struct Waiter {
    fences: Option<Sender<vk::Fence>>,
    thread: Option<JoinHandle<()>>,
}

impl Waiter {
    /// The thread calls `done` when a fence is signalled, with Vulkan's result.
    pub fn new(device: ash::Device, done: impl Fn(Result<(), vk::Result>) + Send + 'static) -> Self {
        let (fences, submitted) = mpsc::channel();
        let thread = thread::spawn(move || {
            for fence in submitted {
                // SAFETY: the fence outlives the thread, and is not reset before the answer.
                done(unsafe { device.wait_for_fences(&[fence], true, u64::MAX) });
            }
        });
        Self { fences: Some(fences), thread: Some(thread) }
    }

    /// The fence was submitted.
    pub fn watch(&self, fence: vk::Fence) {
        if let Some(fences) = &self.fences {
            // the thread ends only when this end is dropped
            let _ = fences.send(fence);
        }
    }
}

impl Drop for Waiter {
    fn drop(&mut self) {
        self.fences = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
