//! Push constants of the prefix sum: twin of `glsl/include/abi/scan.glsl`.

use bytemuck::{Pod, Zeroable};

/// What one prefix sum works on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct ScanParams {
    /// Elements; or, when the GPU holds their count, the most that there may be.
    pub count: u32,
    /// Where in `counts` the GPU holds their count.
    pub count_index: u32,
    /// Where in `total` their sum goes.
    pub total_index: u32,
}
