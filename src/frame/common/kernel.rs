//! A compute pipeline whose bindings, workgroup size and constants come from its shader.

use crate::abi::ListDispatches;
use crate::abi::constants::part_runs::THREADS;
use crate::gpu::{Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline, Resource};
use crate::shaders::Shader;
use std::mem::offset_of;

/// Most threads of a dispatch. The threads that fill the last row of workgroups have 32-bit numbers, too.
pub(crate) const MOST_THREADS: u32 = 1 << 31;

/// The number of threads of a pass over patch instances.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Threads<'a> {
    /// Known on the CPU.
    Host(u32),
    /// Counted by an earlier pass, which wrote [`ListDispatches`].
    Gpu(&'a Buffer),
}

impl From<u32> for Threads<'_> {
    fn from(threads: u32) -> Self {
        Self::Host(threads)
    }
}

/// The pipeline of one compute shader.
#[derive(Debug)]
pub(crate) struct Kernel {
    pipeline: Pipeline,
    group: [u32; 3],
}

impl Kernel {
    /// `constants`: specialisation constants, as ids of `shaders::constant` and values; a flag is 0 or 1.
    ///
    /// # Panics
    /// If the shader has no constant of an id.
    pub(crate) fn new(
        device: &Device,
        name: &str,
        shader: &Shader,
        constants: &[(u32, u32)],
    ) -> Result<Self, GpuError> {
        let of_shader = &shader.interface;
        for (id, _) in constants {
            assert!(of_shader.constants.contains(id), "`{name}` has no constant {id}");
        }
        let info = ComputeInfo {
            name,
            spirv: shader.words,
            bindings: of_shader.bindings,
            push_bytes: of_shader.push_bytes,
            constants,
        };
        Ok(Self { pipeline: Pipeline::compute(device, &info)?, group: of_shader.group })
    }

    /// Binds the pipeline, with its resources in binding order and its push constants.
    pub(crate) fn bind(&self, cmd: &Commands<'_>, resources: &[Resource<'_>], push_constants: &[u8]) {
        cmd.bind(&self.pipeline, resources, push_constants);
    }

    /// Dispatches enough workgroups for `threads`; [`Commands::dispatch`] fills their last row.
    pub(crate) fn record(&self, cmd: &Commands<'_>, resources: &[Resource<'_>], threads: u32) {
        self.bind(cmd, resources, &[]);
        self.dispatch(cmd, threads);
    }

    /// As [`record`](Self::record), for a number of threads that may come from the GPU.
    ///
    /// # Panics
    /// If the GPU counted workgroups of another size than the shader has.
    pub(crate) fn record_threads(&self, cmd: &Commands<'_>, resources: &[Resource<'_>], threads: Threads<'_>) {
        match threads {
            Threads::Host(threads) => self.record(cmd, resources, threads),
            Threads::Gpu(dispatches) => {
                assert_eq!(self.group, [THREADS, 1, 1], "pass `part_runs` counts workgroups of {THREADS} threads");
                self.record_indirect(cmd, resources, (dispatches, offset_of!(ListDispatches, threads) as u64));
            }
        }
    }

    /// As [`record`](Self::record), after [`bind`](Self::bind).
    ///
    /// # Panics
    /// If there are more threads than [`MOST_THREADS`].
    pub(crate) fn dispatch(&self, cmd: &Commands<'_>, threads: u32) {
        assert!(threads <= MOST_THREADS, "{threads} threads where {MOST_THREADS} are the most");
        cmd.dispatch(threads.div_ceil(self.group[0]));
    }

    /// Dispatches a row of workgroups for each of `rows` rows of threads, with the pipeline bound last.
    pub(crate) fn dispatch_rows(&self, cmd: &Commands<'_>, [threads, rows]: [u32; 2]) {
        cmd.dispatch_grid([threads.div_ceil(self.group[0]), rows, 1]);
    }

    /// Dispatches a grid of workgroups.
    pub(crate) fn record_grid(&self, cmd: &Commands<'_>, resources: &[Resource<'_>], groups: [u32; 3]) {
        self.bind(cmd, resources, &[]);
        cmd.dispatch_grid(groups);
    }

    /// Dispatches the grid stored at `offset` bytes of `arguments`.
    pub(crate) fn record_indirect(
        &self,
        cmd: &Commands<'_>,
        resources: &[Resource<'_>],
        (arguments, offset): (&Buffer, u64),
    ) {
        self.bind(cmd, resources, &[]);
        cmd.dispatch_indirect(arguments, offset);
    }
}
