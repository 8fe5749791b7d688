//! GPU time and pipeline statistics of named scopes, for each frame slot.
//!
//! ```text
//!   slot s:  queries  2i ─ begin of scope i      statistics query i ─ scope i, when it draws
//!                     2i + 1 ─ end
//! ```

use super::{Commands, Device, GpuError, Named};
use ash::vk;
use vk::QueryPipelineStatisticFlags as Counted;

/// Pipeline statistics of a scope.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Primitives that reached the clipper: the triangles that the tessellator made.
    pub triangles: u64,
    /// Invocations of fragment shaders.
    pub fragments: u64,
    /// Patches of the tessellation control shader.
    pub patches: u64,
    /// Invocations of tessellation evaluation shaders.
    pub tessellated_vertices: u64,
}

/// The cost of one scope.
#[derive(Clone, Debug, PartialEq)]
pub struct ScopeTime {
    /// Its name.
    pub name: String,
    /// Milliseconds between the first and the last command; 0 if the queue has no timestamps.
    pub gpu_ms: f64,
    /// For a scope that draws, on a device with `pipelineStatisticsQuery`.
    pub statistics: Option<Statistics>,
}

/// Counters in the order in which Vulkan returns them, by bit.
const COUNTED: Counted = Counted::from_raw(
    Counted::CLIPPING_INVOCATIONS.as_raw()
        | Counted::FRAGMENT_SHADER_INVOCATIONS.as_raw()
        | Counted::TESSELLATION_CONTROL_SHADER_PATCHES.as_raw()
        | Counted::TESSELLATION_EVALUATION_SHADER_INVOCATIONS.as_raw(),
);

/// Query pools for one frame slot; frees them on drop.
#[derive(Debug)]
pub struct Timestamps {
    device: Device,
    times: vk::QueryPool,
    statistics: Option<vk::QueryPool>,
    scopes: Vec<(String, bool)>,
    capacity: u32,
}

impl Timestamps {
    /// Room for `scopes` scopes in one frame.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`].
    pub fn new(device: &Device, scopes: u32) -> Result<Self, GpuError> {
        let pool = |create: vk::QueryPoolCreateInfo<'_>| {
            // SAFETY: the device is alive while `Device` is.
            unsafe { device.raw().create_query_pool(&create, None) }.named("vkCreateQueryPool", "timestamps")
        };
        let create = vk::QueryPoolCreateInfo::default().query_count(scopes);
        let times = pool(create.query_type(vk::QueryType::TIMESTAMP).query_count(2 * scopes))?;
        let mut this = Self { device: device.clone(), times, statistics: None, scopes: Vec::new(), capacity: scopes };
        if device.pipeline_statistics() {
            let create = create.query_type(vk::QueryType::PIPELINE_STATISTICS).pipeline_statistics(COUNTED);
            this.statistics = Some(pool(create)?);
        }
        Ok(this)
    }

    /// Clears the scopes of the previous frame; the first command of a frame.
    pub fn reset(&mut self, cmd: &Commands<'_>) {
        self.scopes.clear();
        for (pool, count) in [(Some(self.times), 2 * self.capacity), (self.statistics, self.capacity)] {
            if let Some(pool) = pool {
                // SAFETY: recording outside rendering; the frame that used the queries has finished.
                unsafe { self.device.raw().cmd_reset_query_pool(cmd.raw(), pool, 0, count) };
            }
        }
    }

    /// Times and labels the commands of `record`.
    ///
    /// # Panics
    /// If the frame has more scopes than [`new`](Self::new) allows.
    pub fn scope<R>(&mut self, cmd: &Commands<'_>, name: &str, record: impl FnOnce() -> R) -> R {
        self.measure(cmd, name, false, record)
    }

    /// As [`scope`](Self::scope), with statistics, for a scope that draws. Not within `rendering`.
    ///
    /// # Panics
    /// If the frame has more scopes than [`new`](Self::new) allows.
    pub fn drawing<R>(&mut self, cmd: &Commands<'_>, name: &str, record: impl FnOnce() -> R) -> R {
        self.measure(cmd, name, true, record)
    }

    fn measure<R>(&mut self, cmd: &Commands<'_>, name: &str, draws: bool, record: impl FnOnce() -> R) -> R {
        let i = self.scopes.len() as u32;
        assert!(i < self.capacity, "more than {} timed scopes in a frame", self.capacity);
        self.scopes.push((name.to_owned(), draws));
        let device = self.device.raw();
        let statistics = self.statistics.filter(|_| draws);
        let has_times = self.device.timestamp_bits() > 0;
        let stamp = |query| {
            if has_times {
                let stage = vk::PipelineStageFlags2::ALL_COMMANDS;
                // SAFETY: recording; the query was reset in this command buffer.
                unsafe { device.cmd_write_timestamp2(cmd.raw(), stage, self.times, query) };
            }
        };
        stamp(2 * i);
        if let Some(pool) = statistics {
            // SAFETY: recording outside rendering; the query was reset.
            unsafe { device.cmd_begin_query(cmd.raw(), pool, i, vk::QueryControlFlags::empty()) };
        }
        let result = cmd.labelled(name, record);
        if let Some(pool) = statistics {
            // SAFETY: begun above.
            unsafe { device.cmd_end_query(cmd.raw(), pool, i) };
        }
        stamp(2 * i + 1);
        result
    }

    /// The cost of the scopes, in order; call it after the frame's fence. A scope that never ran on the GPU has no time
    /// yet: `VK_NOT_READY`.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`].
    pub fn read(&self) -> Result<Vec<ScopeTime>, GpuError> {
        let device = self.device.raw();
        let mut stamps = vec![[0u64; 2]; self.scopes.len()];
        let bits = self.device.timestamp_bits();
        if bits > 0 && !stamps.is_empty() {
            // SAFETY: the queries exist; their count is that of the slice.
            unsafe {
                device.get_query_pool_results(self.times, 0, stamps.as_flattened_mut(), vk::QueryResultFlags::TYPE_64)
            }
            .named("vkGetQueryPoolResults", "timestamps")?;
        }
        let mask = if bits >= 64 { u64::MAX } else { (1 << bits) - 1 };
        let period_ms = f64::from(self.device.limits().timestamp_period) * 1e-6;
        (0u32..)
            .zip(self.scopes.iter().zip(&stamps))
            .map(|(i, ((name, draws), [begin, end]))| {
                let gpu_ms = (end.wrapping_sub(*begin) & mask) as f64 * period_ms;
                let pool = self.statistics.filter(|_| *draws);
                let statistics = pool.map(|pool| self.read_statistics(pool, i)).transpose()?;
                Ok(ScopeTime { name: name.clone(), gpu_ms, statistics })
            })
            .collect()
    }

    fn read_statistics(&self, pool: vk::QueryPool, query: u32) -> Result<Statistics, GpuError> {
        let mut counts = [[0u64; 4]];
        // SAFETY: the query exists and returns four counters.
        unsafe { self.device.raw().get_query_pool_results(pool, query, &mut counts, vk::QueryResultFlags::TYPE_64) }
            .named("vkGetQueryPoolResults", "pipeline statistics")?;
        let [[triangles, fragments, patches, tessellated_vertices]] = counts;
        Ok(Statistics { triangles, fragments, patches, tessellated_vertices })
    }
}

impl Drop for Timestamps {
    fn drop(&mut self) {
        let Some(device) = self.device.living() else { return };
        // SAFETY: owned here; the frames that used them have finished. Destroying null is allowed.
        unsafe {
            device.destroy_query_pool(self.times, None);
            device.destroy_query_pool(self.statistics.unwrap_or_default(), None);
        }
    }
}
