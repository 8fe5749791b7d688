//! Twin of `glsl/include/grid.glsl`: the workgroups of a dispatch, in rows as long as the device takes.

use crate::abi::Frame;

/// Arguments of a dispatch of `groups` workgroups, or more: the last row is full.
pub fn grid_of(frame: &Frame, groups: u32) -> [u32; 3] {
    let columns = groups.min(frame.most_groups);
    [columns, if columns == 0 { 1 } else { groups.div_ceil(columns) }, 1]
}
