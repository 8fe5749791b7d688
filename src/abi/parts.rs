//! Placed parts in sight, and the lists of those whose patches a frame looks at. Twins of `glsl/include/parts.glsl`.

pub use crate::abi::constants::parts::{LIST_ALL, LIST_APPEARING, LIST_FIRST};
use bytemuck::{Pod, Zeroable};

/// A placed part in sight, or a group of its faces.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct PartInSight {
    pub group: u32,
    pub first_patch_instance: u32,
    pub patch_instances: u32,
    pub depth: f32,
    pub low: u32,
    pub high: u32,
}

/// Push constants of the passes over placed parts in sight.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct PartList {
    pub parts: u32,
    pub list: u32,
}

/// The dispatches over the patch instances of listed parts.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct ListDispatches {
    pub threads: [u32; 3],
    pub blocks: [u32; 3],
    pub scanned: u32,
}
