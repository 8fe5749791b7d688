//! Push constants of the prefix sum: twin of `glsl/include/abi/scan.glsl`.

use bytemuck::{Pod, Zeroable};

/// The parameters of one prefix sum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct ScanParams {
    /// Number of elements; if a buffer has the count, the largest possible number.
    pub count: u32,
    /// Index of the count in `counts`.
    pub count_index: u32,
    /// Index of the sum in `total`.
    pub total_index: u32,
}
