//! What can go wrong below the passes: a Vulkan failure names its call, an allocation its resource.

use ash::vk;

/// A failure that the caller could not foresee. Misuse panics instead, naming the invariant.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// A Vulkan function returned an error.
    #[error("{call} failed for `{resource}`: {result}")]
    Vulkan {
        /// The function, as Vulkan spells it.
        call: &'static str,
        /// Name of the object that it was called for.
        resource: String,
        /// What it returned.
        result: vk::Result,
    },
    /// The allocator found no memory.
    #[error("no memory for `{resource}` ({bytes} bytes): {source}")]
    Allocation {
        /// Name of the buffer or image.
        resource: String,
        /// Bytes that it needs.
        bytes: u64,
        /// The allocator's reason.
        source: gpu_allocator::AllocationError,
    },
    /// A storage buffer larger than a shader of this device may see.
    #[error(
        "`{resource}` needs {bytes} bytes, but this device binds at most {limit} (maxStorageBufferRange); draw less at once: fewer parts, or a smaller picture"
    )]
    TooLarge {
        /// Name of the buffer.
        resource: String,
        /// Bytes of the request.
        bytes: u64,
        /// The device's limit.
        limit: u64,
    },
}

/// Gives a bare `vk::Result` the name of its call and object.
pub(crate) trait Named<T> {
    /// The value, or [`GpuError::Vulkan`].
    fn named(self, call: &'static str, resource: &str) -> Result<T, GpuError>;
}

impl<T> Named<T> for Result<T, vk::Result> {
    fn named(self, call: &'static str, resource: &str) -> Result<T, GpuError> {
        self.map_err(|result| GpuError::Vulkan { call, resource: resource.to_owned(), result })
    }
}
