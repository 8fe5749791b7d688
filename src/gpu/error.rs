//! Errors below the passes. A Vulkan error names its call, an allocation its resource.

use super::AllocationError;
use ash::vk;

/// A failure that the caller could not foresee. Misuse panics instead and names the invariant.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// The device is lost. Everything made from it may only be dropped. A new renderer on a new device can draw the
    /// same model.
    #[error("{call} failed for `{resource}`: the device is lost; make a new device and a renderer on it")]
    DeviceLost {
        /// The first function that returned it, as Vulkan spells it.
        call: &'static str,
        /// Name of the object of the call.
        resource: String,
    },
    /// The driver found no memory.
    #[error("{call} failed for `{resource}`: no {memory} memory; draw a smaller picture or fewer parts at once")]
    OutOfMemory {
        /// The function, as Vulkan spells it.
        call: &'static str,
        /// Name of the object of the call.
        resource: String,
        /// The kind of memory that ran out.
        memory: MemoryOwner,
    },
    /// A Vulkan function returned another error.
    #[error("{call} failed for `{resource}`: {result}")]
    Vulkan {
        /// The function, as Vulkan spells it.
        call: &'static str,
        /// Name of the object of the call.
        resource: String,
        /// The returned result.
        result: vk::Result,
    },
    /// The object exceeds the memory budget; nothing was allocated.
    #[error(
        "`{resource}` needs {bytes} bytes, but {left} are left of {most}{of}; give it more, draw a smaller picture or \
         fewer parts at once"
    )]
    OverBudget {
        /// Name of the buffer or image.
        resource: String,
        /// Bytes that it needs.
        bytes: u64,
        /// Bytes that are left.
        left: u64,
        /// Bytes of the whole budget.
        most: u64,
        /// The owner of the budget.
        of: BudgetOwner,
    },
    /// The allocator failed for another reason than a lack of memory.
    #[error("no memory for `{resource}` ({bytes} bytes): {source}")]
    Allocation {
        /// Name of the buffer or image.
        resource: String,
        /// Bytes that it needs.
        bytes: u64,
        /// The allocator's reason.
        source: AllocationError,
    },
    /// A storage buffer larger than the device binds.
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

/// The kind of memory that ran out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MemoryOwner {
    /// The host's: `VK_ERROR_OUT_OF_HOST_MEMORY`.
    Host,
    /// The device's: `VK_ERROR_OUT_OF_DEVICE_MEMORY`.
    Device,
}

impl std::fmt::Display for MemoryOwner {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Host => "host",
            Self::Device => "device",
        })
    }
}

/// The owner of a memory budget.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BudgetOwner {
    /// [`HostDevice::memory_budget`](super::HostDevice::memory_budget).
    Host,
    /// The driver's budget of a heap.
    Heap,
}

impl std::fmt::Display for BudgetOwner {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Host => " that the engine may take",
            Self::Heap => " of the device's heap",
        })
    }
}

impl GpuError {
    /// The device is lost: nothing more can be drawn with it.
    pub fn is_device_lost(&self) -> bool {
        matches!(self, Self::DeviceLost { .. })
    }

    /// Memory ran out. The renderer still works, and a smaller picture or model may fit.
    pub fn is_out_of_memory(&self) -> bool {
        matches!(
            self,
            Self::OutOfMemory { .. } | Self::OverBudget { .. } | Self::Allocation { .. } | Self::TooLarge { .. }
        )
    }

    /// The error of a call for an object.
    fn of(result: vk::Result, call: &'static str, resource: &str) -> Self {
        let resource = resource.to_owned();
        match result {
            vk::Result::ERROR_DEVICE_LOST => Self::DeviceLost { call, resource },
            vk::Result::ERROR_OUT_OF_HOST_MEMORY => Self::OutOfMemory { call, resource, memory: MemoryOwner::Host },
            vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => Self::OutOfMemory { call, resource, memory: MemoryOwner::Device },
            result => Self::Vulkan { call, resource, result },
        }
    }

    /// The error of the allocator.
    pub(super) fn of_allocator(source: AllocationError, resource: &str, bytes: u64) -> Self {
        match source {
            AllocationError::Vulkan { call, result } if TYPED.contains(&result) => Self::of(result, call, resource),
            source => Self::Allocation { resource: resource.to_owned(), bytes, source },
        }
    }
}

/// Results with a [`GpuError`] variant of their own.
const TYPED: [vk::Result; 3] =
    [vk::Result::ERROR_DEVICE_LOST, vk::Result::ERROR_OUT_OF_HOST_MEMORY, vk::Result::ERROR_OUT_OF_DEVICE_MEMORY];

/// Adds call and object to a bare `vk::Result`.
pub(crate) trait Named<T> {
    /// The value, or the error of the call.
    fn named(self, call: &'static str, resource: &str) -> Result<T, GpuError>;
}

impl<T> Named<T> for Result<T, vk::Result> {
    fn named(self, call: &'static str, resource: &str) -> Result<T, GpuError> {
        self.map_err(|result| GpuError::of(result, call, resource))
    }
}
