//! Exclusive prefix sums of `u32`: counts become offsets.
//!
//! ```text
//!   values    3  1  4  1 │ 5  9  2  6 │ 5  3            blocks of BLOCK elements (here 4)
//!                        │            │
//!   blocks    0  3  4  8 │ 0  5 14 16 │ 0  5            each workgroup scans its block
//!   sums               9 │         22 │    8            … and stores its sum
//!   sums      0          │ 9          │ 31              one workgroup scans the sums; total = 39
//!   offsets   0  3  4  8 │ 9 14 23 25 │ 31 36           each block adds the sum of all blocks before it
//! ```
//!
//! `offsets[i] = Σ values[j], j < i`, modulo 2³². `offsets` may be the buffer `values`, and `total` may be `offsets` at
//! index `count`, as a table of row starts needs.
//!
//! - READS `values`, `counts`: [`Access::COMPUTE_READ`]; `arguments`: [`Access::INDIRECT_READ`]
//! - WRITES `offsets`, `sums`, `total`: [`Access::COMPUTE_WRITE`]
//! - Twin: [`twin::scan`](crate::twin::scan); parity is exact.
//! - Cost: each value is read once, each offset written twice and read once.
//!
//! Source: G. E. Blelloch, *Prefix Sums and Their Applications*, 1990, sections 1.3 and 1.4; W. D.
//! Hillis, G. L. Steele, *Data Parallel Algorithms*, 1986, for the scan within a workgroup.

use crate::abi::ScanParams;
use crate::frame::common::kernel::Kernel;
use crate::gpu::{Access, Buffer, Commands, Device, GpuError, barrier};
use crate::shaders::{self, constant};

/// Elements that one workgroup scans.
pub const BLOCK: u32 = 1024;

// pass `part_runs` counts workgroups of prefix sums
const _: () = assert!(BLOCK == crate::abi::constants::part_runs::SCAN_BLOCK);

/// Most elements. The elements that fill the last row of workgroups have 32-bit numbers, too.
pub const MAX_COUNT: u32 = 1 << 31;

/// Blocks, and so words of `sums` and workgroups of the indirect arguments, for `count` elements.
pub fn block_count(count: u32) -> u32 {
    count.div_ceil(BLOCK)
}

/// The number of elements.
#[derive(Clone, Copy, Debug)]
pub enum Count<'a> {
    /// Known on the CPU.
    Host(u32),
    /// Counted by an earlier pass.
    Gpu {
        /// Buffer with the count.
        counts: &'a Buffer,
        /// Index of the word in `counts`.
        index: u32,
        /// A `VkDispatchIndirectCommand` of [`block_count`] workgroups in x, or more.
        arguments: &'a Buffer,
        /// Offset in `arguments`, in bytes.
        offset: u64,
        /// Capacity of `values` and `offsets`, in elements; a larger count is cut to it.
        capacity: u32,
    },
}

/// The buffers in binding order. Binding 4 is [`Count::Gpu::counts`].
#[derive(Clone, Copy, Debug)]
pub struct Bindings<'a> {
    /// 0: the values.
    pub values: &'a Buffer,
    /// 1: their prefix sums.
    pub offsets: &'a Buffer,
    /// 2: room for [`block_count`] words.
    pub sums: &'a Buffer,
    /// 3: receives the sum of all values.
    pub total: &'a Buffer,
    /// Index of the word in `total`.
    pub total_index: u32,
}

/// The pass.
#[derive(Debug)]
pub struct Scan {
    by_host: Steps,
    by_gpu: Option<Steps>,
}

#[derive(Debug)]
struct Steps {
    blocks: Kernel,
    sums: Kernel,
    add: Kernel,
}

impl Steps {
    fn new(device: &Device, count_on_gpu: bool) -> Result<Self, GpuError> {
        let step =
            |name, shader| Kernel::new(device, name, shader, &[(constant::COUNT_ON_GPU, u32::from(count_on_gpu))]);
        let [blocks, sums, add] = match count_on_gpu {
            false => ["scan blocks", "scan sums", "scan add"],
            true => ["scan blocks (counted)", "scan sums (counted)", "scan add (counted)"],
        };
        Ok(Self {
            blocks: step(blocks, &shaders::SCAN_BLOCKS_COMP)?,
            sums: step(sums, &shaders::SCAN_SUMS_COMP)?,
            add: step(add, &shaders::SCAN_ADD_COMP)?,
        })
    }
}

impl Scan {
    /// Makes the pipelines; those of [`Count::Gpu`] only if `counts_on_gpu`.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`].
    pub fn new(device: &Device, counts_on_gpu: bool) -> Result<Self, GpuError> {
        let by_gpu = counts_on_gpu.then(|| Steps::new(device, true)).transpose()?;
        Ok(Self { by_host: Steps::new(device, false)?, by_gpu })
    }

    /// Records one prefix sum. Several may follow each other if each has its own buffers.
    ///
    /// # Panics
    /// If a buffer is too short, if there may be more than [`MAX_COUNT`] elements, or if [`Count::Gpu`] was
    /// not announced to [`Scan::new`].
    pub fn record(&self, cmd: &Commands<'_>, count: Count<'_>, bindings: &Bindings<'_>) {
        let Bindings { values, offsets, sums, total, total_index } = *bindings;
        let (steps, most, counts, count_index) = match count {
            // binding 4 needs a buffer; this variant of the shaders does not read it
            Count::Host(count) => (&self.by_host, count, values, 0),
            Count::Gpu { counts, index, capacity, .. } => {
                (self.by_gpu.as_ref().expect("pipelines for counts of the GPU"), capacity, counts, index)
            }
        };
        assert!(most <= MAX_COUNT, "a scan of {most} elements where {MAX_COUNT} are the most");
        for (buffer, words) in [(values, most), (offsets, most), (sums, block_count(most)), (total, total_index + 1)] {
            let room = buffer.bytes() / 4;
            assert!(room >= u64::from(words), "`{}` has room for {room} words, not for {words}", buffer.name());
        }
        let params = ScanParams { count: most, count_index, total_index };
        let resources = [values, offsets, sums, total, counts].map(Into::into);
        let bind = |step: &Kernel| step.bind(cmd, &resources, bytemuck::bytes_of(&params));
        let dispatch = || match count {
            Count::Host(count) => cmd.dispatch(block_count(count)),
            Count::Gpu { arguments, offset, .. } => cmd.dispatch_indirect(arguments, offset),
        };

        bind(&steps.blocks);
        dispatch();
        // `offsets`, too, because `total` may be in it
        let after_step = (Access::COMPUTE_WRITE, Access::COMPUTE_WRITE);
        let between = [(sums, after_step.0, after_step.1), (offsets, after_step.0, after_step.1)];
        barrier::buffers(cmd, &between);
        bind(&steps.sums);
        cmd.dispatch(1);
        barrier::buffers(cmd, &between);
        bind(&steps.add);
        dispatch();
    }
}
