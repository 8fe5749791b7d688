//! Twin of `glsl/include/in_sight.glsl`: the items in sight, numbered without gaps.

use crate::abi::ItemRun;

/// The item at a place; the first run begins at place 0.
pub fn item_at(runs: &[ItemRun], place: u32) -> u32 {
    let run = runs[runs.partition_point(|run| run.place <= place) - 1];
    run.item + place - run.place
}
