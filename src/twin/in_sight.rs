//! Twin of `glsl/include/in_sight.glsl`: the listed patch instances, numbered without gaps.

use crate::abi::PatchRun;

/// The patch instance at a place; the first run begins at place 0.
pub fn patch_instance_at(runs: &[PatchRun], place: u32) -> u32 {
    let run = runs[runs.partition_point(|run| run.place <= place) - 1];
    run.patch_instance + place - run.place
}
